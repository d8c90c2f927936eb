//! G41 and G42 with D or H: which offset is meant, from line to line.

use mock_controller::{GcodeSettings, Settings, SettingsError};

use crate::gcode::gcode;
use crate::watch::{four_b, watch};

/// A G-code control with 30 µm keyed in without a number, and these registers, µm.
fn with(registers: &[(&str, f64)]) -> Settings {
    let offset_registers = registers.iter().map(|&(name, um)| (name.parse().unwrap(), um)).collect();
    Settings { gcode: GcodeSettings { offset_registers, ..GcodeSettings::default() }, ..gcode(30.0) }
}

/// An L from the middle of its bottom and back to the start hole below it, with an inside corner at (10, 10).
const ELL: &str = "X20. Y0.\nY10.\nX10.\nY20.\nX0.\nY0.\nX5.\n";

#[test]
fn a_rough_and_a_skim_pass_have_their_own_offsets_at_inside_and_outside_corners() {
    for words in [["D1", "D2"], ["D01", "D0002"], ["H1", "H2"], ["H001", "H2"]] {
        let letter = &words[0][..1];
        let registers = [(format!("{letter}1"), 180.0), (format!("{letter}2"), 130.0)];
        let registers: Vec<(&str, f64)> = registers.iter().map(|(name, um)| (name.as_str(), *um)).collect();
        let pass = |word: &str| format!("G42 {word} G01 X5. Y0.\n{ELL}G40 X5. Y-3.\n");
        let program = format!("%\nG01 X5. Y-3.\n{}{}M02\n%\n", pass(words[0]), pass(words[1]));
        let (report, watch) = watch(with(&registers), &program);
        assert_eq!((report.blocks, report.alarm, report.end_um), (19, None, [5000, -3000]), "{words:?}");
        for (first, offset) in [(3, 180), (12, 130)] {
            let found = watch.bounds(first..=first + 6);
            assert_eq!(found, [-offset, 20_000 + offset, -offset, 20_000 + offset], "{words:?}");
            // Into the inside corner, and down beside it.
            let inside = watch.ends.iter().find(|end| end.number == first + 2).unwrap().end_um;
            assert_eq!(inside, [10_000 + offset, 10_000 + offset], "{words:?}");
        }
    }
}

#[test]
fn a_number_stays_in_force_and_0_is_none() {
    let registers = [("D1", 180.0), ("D2", 130.0)];
    for (first, then, offset) in [
        ("D2", "G41", 130),
        ("G41 D1", "", 180),
        ("G41", "", 30),
        ("D0", "G41", 0),
        ("D1", "G41 D2", 130),
        ("G41 D0", "", 0),
        ("G41 H0", "", 0),
        ("G41 D1", "G41 D1", 180),
        ("G41 D1", "D1", 180),
        ("D2 G41 G40", "G41", 130),
    ] {
        let program = format!("%\nG01 X0.001\n{first}\n{then} X5. Y0.\nX9.\nG40 X9. Y3.\n%\n");
        let (report, watch) = watch(with(&registers), &program);
        assert_eq!(report.alarm, None, "{first} {then}: {:?}", report.alarm_detail);
        assert_eq!(watch.ends[2].end_um, [9000, offset], "{first} {then}");
    }
    // It ends with its program.
    let (report, watch) = watch(with(&registers), "%\nD1\nG01 X1.\nM02\n%\nG41 G01 X5. Y0.\nX9.\nM02\n%\n");
    assert_eq!((report.alarm, report.programs), (None, 2));
    assert_eq!(watch.ends[2].end_um, [9000, 30]);
}

#[test]
fn without_registers_every_number_but_0_is_the_offset_keyed_in() {
    for (words, offset) in [("G41 D7", 30), ("G41 H7", 30), ("G41 H0", 0), ("G41 D0", 0), ("H7 C3\nG41", 30)]
    {
        let (report, watch) = watch(with(&[]), &format!("%\n{words} G01 X5. Y0.\nX9.\n%\n"));
        assert_eq!(report.alarm, None, "{words}");
        assert_eq!(watch.ends[1].end_um, [9000, offset], "{words}");
        // Apart from G41 an H is a condition, passed over and counted.
        assert_eq!(report.words_passed_over.contains_key("H"), words.starts_with("H7"), "{words}");
    }
}

#[test]
fn a_number_without_a_register_and_an_offset_that_changes_are_alarms() {
    for (program, alarm, found) in [
        ("G41 D3 X5.", "offset", "line 3: D3: no such offset register"),
        ("G41 H1 X5.", "offset", "H1"),
        ("D3\nG41 X5.", "offset", "D3"),
        ("G41 D1.5 X5.", "offset", "D1.5"),
        ("G41 D-1 X5.", "offset", "D-1"),
        ("G41 D1 D2 X5.", "word", "D2: a second offset number"),
        ("G41 D1 H1 X5.", "word", "H1: a second offset number"),
        ("G41 D1 X5. Y0.\nX6.\nD2 X7.", "compensation", "without G40"),
        ("G41 D1 X5. Y0.\nX6.\nG41 D2 X7.", "compensation", "without G40"),
        ("G41 D1 X5. Y0.\nX6.\nG42 X7.", "compensation", "without G40"),
        ("G41 D0 X5. Y0.\nX6.\nD1 X7.", "compensation", "without G40"),
    ] {
        let (report, _) =
            watch(with(&[("D1", 180.0), ("D2", 130.0)]), &format!("%\nG01 X0.001\n{program}\nX9.\n%\n"));
        let detail = report.alarm_detail.unwrap_or_default();
        assert_eq!(report.alarm.as_deref(), Some(alarm), "{program}: {detail}");
        assert!(detail.contains(found), "{program}: {detail}");
    }
}

#[test]
fn registers_that_mean_nothing_are_refused() {
    let registers = with(&[("D1", 180.0)]).gcode;
    let four = Settings { gcode: registers.clone(), ..four_b(0.0) };
    assert_eq!(four.validate(), Err(SettingsError::RegisterDialect("D1".parse().unwrap())));
    for offset_um in [-1.0, 10_001.0, f64::NAN] {
        let wrong = with(&[("D1", offset_um)]).validate();
        assert!(matches!(wrong, Err(SettingsError::Register { .. })), "{offset_um}: {wrong:?}");
    }
}
