//! G-code: words, units, lines, arcs, and what is refused.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use std::f64::consts::PI;
use std::time::Duration;

use mock_controller::{
    ArcCentre, Controller, Dialect, GcodeSettings, Model, Report, Settings, SettingsError, Torn,
    UnitWithoutPoint,
};

use crate::sender::{HOUR, Sender, run, sha256};
use crate::watch::{Watch, watch};

pub(crate) fn gcode(wire_offset_um: f64) -> Settings {
    Settings { dialect: Dialect::Gcode, wire_offset_um, ..Settings::unpaced() }
}

fn read_as(reading: GcodeSettings, program: &str) -> (Report, Watch) {
    watch(Settings { gcode: reading, ..gcode(0.0) }, program)
}

fn cut(program: &str) -> (Report, Watch) {
    read_as(GcodeSettings::default(), program)
}

fn ends(program: &str) -> Vec<[i64; 2]> {
    let (report, watch) = cut(&format!("%\n{program}\n%\n"));
    assert_eq!((report.alarm, report.programs), (None, 1), "{program}: {:?}", report.alarm_detail);
    watch.ends.iter().map(|end| end.end_um).collect()
}

#[test]
fn lines_are_absolute_or_incremental_and_modal() {
    assert_eq!(ends("G01 X1.5 Y-.25\nX0.\nY2."), [[1500, -250], [0, -250], [0, 2000]]);
    assert_eq!(ends("G91 G00 X1. Y1.\nX1.\nG90 X0. Y0."), [[1000, 1000], [2000, 1000], [0, 0]]);
    assert_eq!(ends("g1x1.(half)y2.;rest\nN20 G90 X2."), [[1000, 2000], [2000, 2000]]);
    let (report, _) = cut("%\nG01 X3. Y4.\nX0. Y0.\n%\n");
    assert_eq!((report.pulses, report.blocks), (14_000, 2));
    assert!((report.path_length_mm - 10.0).abs() < 1e-9);
}

#[test]
fn targets_are_rounded_halves_away_from_zero_and_never_accumulated() {
    let expected = [[1, -1], [1001, -1001], [2, 0]];
    assert_eq!(ends("G01 X0.0005 Y-0.0005\nX1.0005 Y-1.0005\nX0.002499 Y0.000499"), expected);
    // Five times 0.4 µm is 2 µm; what is not yet a micron is no motion.
    assert_eq!(ends(&format!("G91 G01\n{}", "X0.0004\n".repeat(5))), [[1, 0], [2, 0]]);
    assert_eq!(
        ends("G20 G01 X1. Y-0.0001\nG91 X0.0001\nX.0001\nG21 X0.001"),
        [[25_400, -3], [25_403, -3], [25_405, -3], [25_406, -3]]
    );
}

#[test]
fn full_circles_and_arcs_end_where_they_should_in_every_model() {
    for model in [Model::Rotated, Model::Strict, Model::Exact] {
        for (program, pulses, end, length) in [
            ("G03 I-5.", 40_000, [0, 0], 10.0 * PI),
            ("G02 J5.", 40_000, [0, 0], 10.0 * PI),
            ("G02 X0. Y0. I3. J4.", 40_000, [0, 0], 10.0 * PI),
            ("G03 X-5. Y5. I-5.", 10_000, [-5000, 5000], 2.5 * PI),
            ("G03 X-5. Y5. I-5. J0.", 10_000, [-5000, 5000], 2.5 * PI),
            ("G02 X-5. Y5. I-5. J0.", 30_000, [-5000, 5000], 7.5 * PI),
            ("G03 X-5. Y5. R5.", 10_000, [-5000, 5000], 2.5 * PI),
            ("G03 X-5. Y5. R-5.", 30_000, [-5000, 5000], 7.5 * PI),
            ("G02 X-5. Y5. R5.", 10_000, [-5000, 5000], 2.5 * PI),
            ("G02 X-5. Y5. R-5.", 30_000, [-5000, 5000], 7.5 * PI),
            ("G02 X10. Y0. R5.", 20_000, [10_000, 0], 5.0 * PI),
            ("G91 G02 X10. R5.", 20_000, [10_000, 0], 5.0 * PI),
        ] {
            let settings = Settings { interpolator: model, ..gcode(0.0) };
            let (report, watch) = watch(settings, &format!("%\n{program}\n%\n"));
            assert_eq!((report.blocks, report.end_um, report.alarm), (1, end, None), "{program}");
            assert!(report.pulses.abs_diff(pulses) <= 4, "{program}: {}", report.pulses);
            assert!((report.path_length_mm - length).abs() < 2e-3, "{program}: {}", report.path_length_mm);
            assert_eq!(watch.ends.len(), 1);
        }
    }
}

#[test]
fn an_arc_whose_end_is_a_little_off_its_circle_still_ends_there() {
    assert_eq!(
        ends("G01 X10.\nG03 X0. Y10.003 I-10.\nX-10. Y-.002 J-10."),
        [[10_000, 0], [0, 10_003], [-10_000, -2]]
    );
}

#[test]
fn the_four_arcs_of_a_radius_between_two_points_lie_on_their_four_circles() {
    // Chord of 6 along X, R 5: the centres are 4 above and below its middle.
    for (words, y, furthest) in [
        ("G03 X6. R5.", 4000.0, -1000),
        ("G02 X6. R-5.", 4000.0, 9000),
        ("G02 X6. R5.", -4000.0, 1000),
        ("G03 X6. R-5.", -4000.0, -9000),
    ] {
        let (report, watch) = cut(&format!("%\n{words}\n%\n"));
        assert_eq!((report.end_um, report.alarm), ([6000, 0], None), "{words}");
        let (near, far) = watch.distances(1, 3000.0, y);
        assert!(near > 4998.5 && far < 5001.5, "{words}: {near} {far}");
        let [_, _, bottom, top] = watch.bounds(1..=1);
        let reached = if furthest < 0 { bottom } else { top };
        assert!((reached - furthest).abs() <= 1, "{words}: {reached}");
    }
}

#[test]
fn a_chain_of_arcs_off_the_axes_ends_on_its_rounded_targets() {
    let mut program = String::from("%\nG01 X10.\n");
    let mut wanted = vec![[10_000, 0]];
    for k in 1..=36 {
        let angle = f64::from(k) * PI / 18.0;
        let before = angle - PI / 18.0;
        let (x, y) = (10.0 * angle.cos(), 10.0 * angle.sin());
        program +=
            &format!("G03 X{x:.3} Y{y:.3} I{:.3} J{:.3}\n", -10.0 * before.cos(), -10.0 * before.sin());
        wanted.push([(x * 1000.0).round() as i64, (y * 1000.0).round() as i64]);
    }
    let (report, watch) = cut(&(program + "%\n"));
    assert_eq!((report.blocks, report.alarm), (37, None));
    assert_eq!(watch.ends.iter().map(|end| end.end_um).collect::<Vec<_>>(), wanted);
    for block in 2..=37 {
        let (near, far) = watch.distances(block, 0.0, 0.0);
        assert!(near > 9997.5 && far < 10_002.5, "{block}: {near} {far}");
    }
    assert!((report.path_length_mm - 10.0 - 20.0 * PI).abs() < 0.01);
}

#[test]
fn what_a_length_without_a_point_means_is_a_parameter() {
    let (report, _) = cut("%\nG01 X1.\nY10\n%\n");
    assert_eq!((report.blocks, report.alarm.as_deref()), (1, Some("number")));
    assert_eq!(report.alarm_detail.unwrap(), "block 2, line 3: Y10: a length without a point");
    for (unit, program, end) in [
        (UnitWithoutPoint::Least, "G01 X10 Y-2.", [10, -2000]),
        (UnitWithoutPoint::Least, "G20 G01 X10 Y1.", [25, 25_400]),
        (UnitWithoutPoint::Whole, "G01 X10 Y-2.", [10_000, -2000]),
        (UnitWithoutPoint::Whole, "G20 G01 X1", [25_400, 0]),
    ] {
        let reading = GcodeSettings { unit_without_point: unit, ..GcodeSettings::default() };
        let (report, _) = read_as(reading, &format!("%\n{program}\n%\n"));
        assert_eq!((report.end_um, report.alarm), (end, None), "{unit:?} {program}");
    }
}

#[test]
fn centres_may_be_absolute_lines_skipped_and_zero_moved() {
    let absolute = GcodeSettings { arc_centre: ArcCentre::Absolute, ..GcodeSettings::default() };
    let (report, watch) = read_as(absolute, "%\nG01 X10.\nG03 X0. Y10. I0. J0.\n%\n");
    assert_eq!((report.end_um, report.alarm), ([0, 10_000], None));
    assert!(watch.distances(2, 0.0, 0.0).0 > 9998.0);
    let program = "%\nG01 X1.\n/X5.\nY1.\n%\n";
    assert_eq!(cut(program).0.end_um, [5000, 1000]);
    let skipping = GcodeSettings { block_skip: true, ..GcodeSettings::default() };
    assert_eq!(read_as(skipping, program).0.end_um, [1000, 1000]);
    assert_eq!(ends("G92 X10. Y10.\nG01 X11. Y10.\nG92 X0.\nX-1. Y0."), [[1000, 0], [0, -10_000]]);
    assert_eq!(ends("G01 X1.\nG04 X5.\nG04 P500\nM00\nM01\nX2."), [[1000, 0], [2000, 0]]);
}

#[test]
fn nothing_is_ignored_in_silence() {
    for (line, alarm, found) in [
        ("G05 X1.", "word", "line 3: G05"),
        ("G54", "word", "G54"),
        ("G28", "word", "G28"),
        ("G01 X1. U1.", "word", "U1."),
        ("G01 X1. A2.", "word", "A2."),
        ("G01 Z1.", "word", "Z1."),
        ("G01 Q1.", "word", "Q1."),
        ("G02 X9. Y0. K1.", "word", "K1."),
        ("G01 X1. I1.", "word", "I1.: without an arc"),
        ("G01 G02 X1. I1.", "word", "G02: a second motion"),
        ("X1. X2.", "word", "X2.: X twice"),
        ("G01 X999999.", "number", "beyond 100 m"),
        ("G02 X9.", "arc", "neither"),
        ("G02 X9. I1. R5.", "arc", "both"),
        ("G02 R5.", "arc", "end at the start"),
        ("G02 X99. R5.", "arc", "apart"),
        ("G03 X9. Y9. I5.", "arc", "radius 5000.0 µm at the start"),
        ("G02 I0.", "arc", "radius 0.0"),
        ("M99", "call", "main program"),
        ("G01 X1. %", "format", "line 3, column 9"),
        ("G01 X", "format", "column 6"),
        ("#1=5", "format", "column 1"),
    ] {
        let (report, _) = cut(&format!("%\nG01 X0.5\n{line}\nG01 X2.\n%\n"));
        let detail = report.alarm_detail.unwrap_or_default();
        assert_eq!((report.alarm.as_deref(), report.blocks), (Some(alarm), 1), "{line}: {detail}");
        assert!(detail.contains(found), "{line}: {detail}");
    }
    let (report, _) = cut("%\nX1.\n%\n");
    assert_eq!((report.alarm.as_deref(), report.blocks), (Some("word"), 0));
}

#[test]
fn conditions_are_passed_over_and_counted_and_the_list_is_a_parameter() {
    let program = "%\nG17 C5 E1022 S3 H1\nM50 M03\nG51 T1.5\nG52 A1.\nG01 X1. F5.\nF6.\nG50 M21\n%\n";
    let (report, _) = cut(program);
    assert_eq!((report.alarm, report.end_um), (None, [1000, 0]));
    let counts: Vec<(&str, u64)> =
        report.words_passed_over.iter().map(|(word, &count)| (word.as_str(), count)).collect();
    let wanted = [
        ("A", 1),
        ("C", 1),
        ("E", 1),
        ("F", 2),
        ("G50", 1),
        ("G51", 1),
        ("G52", 1),
        ("H", 1),
        ("M03", 1),
        ("M21", 1),
        ("M50", 1),
        ("S", 1),
        ("T", 1),
    ];
    assert_eq!(counts, wanted);
    // Under G51 and G52 the angle may change alone; after G50, or in the next program, it means nothing.
    let inclined = "%\nG51 A1.\nG01 X1. A2.\nG52 A0.5\nX2. T3.\n";
    let (report, _) = cut(&format!("{inclined}%\n"));
    assert_eq!((report.alarm, report.words_passed_over["A"], report.end_um), (None, 3, [2000, 0]));
    for after in ["G50 A0.\nX3. A1.\n%\n", "M02\n%\nG01 X3. A1.\n%\n"] {
        let (report, _) = cut(&format!("{inclined}{after}"));
        assert_eq!((report.alarm.as_deref(), report.end_um), (Some("word"), [2000, 0]), "{after}");
    }
    let strict = GcodeSettings { ignored_words: "C".parse().unwrap(), ..GcodeSettings::default() };
    let (report, _) = read_as(strict, program);
    assert_eq!((report.alarm.as_deref(), report.blocks), (Some("word"), 0));
    assert!(report.alarm_detail.unwrap().ends_with("E1022"));
    let work_offsets =
        GcodeSettings { ignored_words: "G54-G59".parse().unwrap(), ..GcodeSettings::default() };
    let (report, _) = read_as(work_offsets, "%\nG54 G01 X1.\n%\n");
    assert_eq!((report.alarm, report.end_um), (None, [1000, 0]));
}

#[test]
fn a_program_ends_at_percent_dc4_m02_and_m30_and_is_digested_without_its_percent_lines() {
    let text = "O0001 (PLATE)\nG01 X1.\nY1. ; up\n";
    for (end, last) in [
        ("%\n", ""),
        ("M02\n", "M02\n"),
        ("M30\n%\n", "M30\n"),
        ("\u{14}", ""),
        ("N9 M2\n\n%\n\u{14}", "N9 M2\n"),
    ] {
        for leader in ["", "%\n", "\0\0%\r\n", "\n\n"] {
            let program = format!("{leader}{text}{end}");
            for program in [program.clone(), program.replace('\n', "\r\n"), program.replace('\n', "\n\r\r")] {
                let (report, _) = cut(&program);
                let found = (report.blocks, report.programs, report.alarm.as_deref());
                assert_eq!(found, (2, 1, None), "{program:?}");
                assert_eq!(report.sha256, sha256(&format!("{text}{last}")), "{program:?}");
            }
        }
    }
    let (report, _) = cut("%\nG01 X1.\n");
    assert_eq!((report.blocks, report.programs), (1, 0));
    // What was modal ends with its program.
    let (report, _) = cut("%\nG91 G20 G01 X1.\nM02\n%\nO2\nG01 X1.\nM02\n%\n");
    assert_eq!((report.programs, report.end_um, report.alarm), (2, [1000, 0], None));
    // A label is no line.
    let (report, _) = cut("PLATE 7\nG01 X1.\n%\n");
    assert_eq!((report.skipped, report.blocks, report.alarm), (6, 1, None));
}

#[test]
fn subprograms_behind_the_main_program_are_called_and_call_each_other() {
    let program =
        "%\nO1\nG91 G01 X1.\nM98 P10 L3\nX1.\nM98 P0011\nM02\nO10\nY1.\nM98 P11\nM99\nO11\nX-0.5\nM99\n%\n";
    let (report, watch) = cut(program);
    assert_eq!((report.alarm, report.programs, report.blocks), (None, 1, 9));
    assert_eq!(report.end_um, [1000 - 1500 + 1000 - 500, 3000]);
    assert_eq!(watch.ends[1].end_um, [1000, 1000]);
    for (program, found) in [
        ("M98 P7\nM02\n", "no subprogram O7"),
        ("M98 P7\nM02\nO7\nM98 P7\nM99\n", "O7 called 4 deep"),
        ("M98\nM02\n", "M98 without P"),
        ("M98 P7\nO7\nM99\n", "neither M02 nor M30"),
        ("M98 P7\nM02\nO7\nM99\nO7\nM99\n", "O7 twice"),
        ("M98 P7\nM02\nX1.\nM99\n", "no O in front"),
        ("M98 P7 L9999999\nM02\nO7\nG04\nM99\n", "too many lines"),
    ] {
        let (report, _) = cut(&format!("%\n{program}%\n"));
        assert_eq!(report.alarm.as_deref(), Some("call"), "{program}");
        assert!(report.alarm_detail.unwrap().contains(found), "{program}");
    }
}

#[test]
fn settings_that_mean_nothing_are_refused() {
    assert_eq!(gcode(-70.0).validate(), Err(SettingsError::NegativeOffset(-70.0)));
}

/// One connection: opens, sends all at once, closes at once.
fn connect(control: &mut Controller, now: Duration, text: &str) {
    control.link_opened(now);
    assert_eq!(control.send(text.as_bytes(), now), text.len());
    control.link_closed(now);
}

#[test]
fn an_unfinished_line_is_dropped_or_joins_the_next_bytes() {
    for (torn, next, blocks, end, dropped) in [
        (Torn::Drop, "0.\nY1.\n%\n", 2, [1000, 1000], 1),
        (Torn::Keep, "0.\nY1.\n%\n", 3, [20_000, 1000], 0),
        (Torn::Keep, "%\nY1.\n%\n", 2, [1000, 1000], 1),
    ] {
        let settings = Settings { dialect: Dialect::Gcode, torn, ..Settings::default() };
        let mut control = Controller::new(settings).unwrap();
        connect(&mut control, Duration::ZERO, "%\nG01 X1.\nX2");
        connect(&mut control, HOUR, next);
        control.advance(2 * HOUR);
        let report = control.report();
        assert_eq!((report.blocks, report.end_um, report.torn), (blocks, end, dropped), "{torn:?} {next:?}");
        assert_eq!((report.alarm, report.programs), (None, 1), "{torn:?} {next:?}");
    }
}

#[test]
fn a_paced_program_is_held_and_loses_nothing() {
    let line = "G91 G01 X0.010\n";
    let program = format!("%\n{}M02\n%\n", line.repeat(200));
    let mut sender = Sender::of(program.clone());
    let report = run(Settings { dialect: Dialect::Gcode, ..Settings::default() }, &mut sender);
    assert_eq!((report.blocks, report.end_um, report.alarm, report.programs), (200, [2000, 0], None, 1));
    assert!(report.holds >= 3, "{}", report.holds);
    assert_eq!(report.sha256, sha256(&program.replace("%\n", "")));
    let mut heedless = Sender::of(program).heedless();
    let report = run(Settings { dialect: Dialect::Gcode, ..Settings::default() }, &mut heedless);
    assert_eq!(report.alarm.as_deref(), Some("overrun"));
}

#[test]
fn after_a_reset_the_programs_zero_is_where_it_was() {
    let settings = Settings { reset_at_block: Some(2), ..gcode(0.0) };
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    Sender::of("%\nG01 X1.\nX2.\n%\n").window(4096).feed(&mut control, Duration::ZERO, HOUR);
    assert_eq!((control.blocks(), control.position_um()), (1, [1000, 0]));
    control.link_closed(HOUR);
    control.link_opened(HOUR);
    Sender::of("%\nG01 X2. Y1.\n%\n").window(4096).feed(&mut control, HOUR, 2 * HOUR);
    assert_eq!((control.blocks(), control.position_um(), control.alarm()), (2, [2000, 1000], None));
}

#[test]
fn machine_words_like_a_pump_are_passed_over_and_counted() {
    let (report, _) = watch(gcode(0.0), "%\nT84\nT86\nG01 X1.\nT85\nC777\nM02\n%\n");
    assert_eq!((report.blocks, report.alarm), (1, None));
    let counted: Vec<(&str, u64)> =
        report.words_passed_over.iter().map(|(word, &count)| (word.as_str(), count)).collect();
    assert_eq!(counted, [("C", 1), ("T", 3)]);
}
