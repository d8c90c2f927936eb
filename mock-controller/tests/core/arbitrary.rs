//! Arbitrary bytes into every dialect: no panic, no end without an alarm or a reason, the same result however they come.
//!
//! A bounded run with fixed seeds; what the bytes mean is nobody's concern here, only that the control bears them.

use std::time::Duration;

use mock_controller::{
    ArcCentre, Controller, Dialect, GcodeSettings, LabelSkip, Model, Report, Settings, Taper, Torn,
    UnitWithoutPoint,
};

use crate::gcode::gcode;
use crate::sender::HOUR;
use crate::watch::four_b;

/// The tests' own dice (xorshift64*).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11
    }

    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() % bound as u64).unwrap()
    }

    fn of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.below(words.len())]
    }
}

/// What programs are made of, mostly rightly put together.
fn blocks(dice: &mut Dice, four: bool) -> String {
    let mut text = String::new();
    for _ in 0..dice.below(12) {
        match dice.below(16) {
            0 => text += dice.of(&["DD\n", "D\n", "E", "%\n", "\u{14}", "; B1\n", "(B1B2)", "\n\n", "N 7:"]),
            1 => text.push(char::from(u8::try_from(dice.below(128)).unwrap())),
            _ => {
                let marked = four && dice.below(3) > 0;
                let mut radius = 0;
                for part in 0..3 {
                    let largest = [2, 40, 5000, 100_000][dice.below(4)];
                    let number = if dice.below(4) == 0 { 0 } else { dice.below(largest) };
                    radius += if part < 2 { number } else { 0 };
                    text += &if dice.below(3) == 0 { format!("B{number:06}") } else { format!("B{number}") };
                }
                if marked {
                    text += &if dice.below(4) == 0 { "BL12".to_owned() } else { format!("B{radius}") };
                }
                let flag = if marked { dice.of(&["D", "DD", " D "]) } else { "" };
                let axis = dice.of(&["GX", "GY", "X", "gy"]);
                text += &if dice.below(2) == 0 { format!("{flag}{axis}") } else { format!("{axis}{flag}") };
                text += dice
                    .of(&["L1", "L2", "L3", "L4", "SR1", "SR2", "SR3", "SR4", "NR1", "NR2", "nr3", "NR4"]);
                text += dice.of(&["\n", "", " "]);
            }
        }
    }
    text
}

fn lines(dice: &mut Dice) -> String {
    let mut text = String::new();
    for _ in 0..dice.below(16) {
        if dice.below(3) == 0 {
            let few = [
                "G41", "G42 D1", "G40", "G90", "G91", "G20", "G21", "G92", "G51 T1.", "D2", "H1", "/", "G04",
            ];
            text += dice.of(&few);
        }
        let mut letters = match dice.below(3) {
            0 => {
                text += dice.of(&["G02", "G03"]);
                dice.of(&["XYR", "IJ", "I", "XR"])
            }
            _ => {
                text += dice.of(&["G00", "G01", "g1 "]);
                dice.of(&["XY", "X", "Y", ""])
            }
        };
        if dice.below(12) == 0 {
            letters = dice.of(&["XYIJ", "XI", "XX", "R", "XYR"]);
        }
        for letter in letters.chars() {
            let sign = dice.of(&["", "-", ""]);
            let (whole, behind) = (dice.below(9), dice.below(1000));
            text += &match dice.below(20) {
                0 => format!("{letter}{sign}{behind}"),
                1 => format!("{letter}{sign}{whole}. "),
                _ if letter == 'R' => format!("R{sign}1.{behind:03}"),
                2 => format!("{letter}{sign}{whole}.{behind:03}"),
                _ => format!("{letter}{sign}0.{behind:03}"),
            };
        }
        match dice.below(40) {
            0 => text.push(char::from(u8::try_from(dice.below(128)).unwrap())),
            1 => {
                text += dice.of(&[
                    "%",
                    "\nO7",
                    ":7",
                    "(x)",
                    ";",
                    "\nM98 P7",
                    "\nM98P7L3",
                    "M99",
                    "M02\nO7",
                    "M30",
                ])
            }
            _ => {}
        }
        text.push('\n');
    }
    text
}

fn garbage(dice: &mut Dice) -> Vec<u8> {
    (0..dice.below(300)).map(|_| u8::try_from(dice.next() & 0xFF).unwrap()).collect()
}

/// Puts the bytes in, a few at a time, with the link torn now and then; the report.
fn bear(settings: &Settings, bytes: &[u8], dice: &mut Dice, tears: bool) -> Report {
    let mut control = Controller::new(settings.clone()).unwrap();
    let mut now = Duration::ZERO;
    control.link_opened(now);
    let mut rest = bytes;
    while !rest.is_empty() {
        let (piece, behind) = rest.split_at(rest.len().min(dice.below(40) + 1));
        rest = behind;
        assert_eq!(control.send(piece, now), piece.len());
        now += Duration::from_secs(10);
        control.advance(now);
        let _ = control.receive(now);
        if tears && dice.below(12) == 0 {
            control.link_closed(now);
            control.link_opened(now);
        }
    }
    control.advance(now + HOUR);
    control.report()
}

/// What holds of every report.
fn assert_sound(report: &Report, bytes: &[u8], what: &str) {
    let said = || format!("{what}: {:?}: {report:?}", String::from_utf8_lossy(bytes));
    let [x, y] = report.end_um;
    let reached = x.unsigned_abs() + y.unsigned_abs();
    assert!(reached <= report.pulses && (report.pulses - reached).is_multiple_of(2), "{}", said());
    assert_eq!(report.bytes, bytes.len() as u64, "{}", said());
    assert_eq!(report.alarm.is_some(), report.alarm_detail.is_some(), "{}", said());
    // A diagonal is √2 shorter than its steps, and an interpolator a step or two a block off its line.
    let steps_mm = report.pulses as f64 / 1000.0;
    assert!(report.path_length_mm <= steps_mm + 0.05 * report.blocks as f64 + 0.05, "{}", said());
    assert!(report.path_length_mm.is_finite() && report.sha256.len() == 64, "{}", said());
}

/// Programs of one kind in every setting; how many blocks were cut and how many programs came to an alarm.
fn campaign(all: &[Settings], seed: u64, rounds: usize, program: fn(&mut Dice) -> Vec<u8>) -> (u64, usize) {
    let mut dice = Dice(seed);
    let (mut blocks, mut alarms) = (0, 0);
    for round in 0..rounds {
        let settings = &all[round % all.len()];
        let bytes = program(&mut dice);
        let what = format!("seed {seed}, round {round}");
        let whole = bear(settings, &bytes, &mut dice, false);
        assert_sound(&whole, &bytes, &what);
        blocks += whole.blocks;
        alarms += usize::from(whole.alarm.is_some());
        // However the bytes are parted the same is made of them.
        let again = bear(settings, &bytes, &mut dice, false);
        // Times aside, and what a sender that never listens overran.
        let told = |report: &Report| Report {
            max_overrun_bytes: 0,
            held_seconds: 0.0,
            line_utilisation: None,
            ..report.clone()
        };
        assert_eq!(told(&again), told(&whole), "{what}: {:?}", String::from_utf8_lossy(&bytes));
        assert_sound(&bear(settings, &bytes, &mut dice, true), &bytes, &what);
    }
    (blocks, alarms)
}

fn settings_of_3b() -> Vec<Settings> {
    [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact]
        .into_iter()
        .map(|interpolator| Settings { interpolator, ..Settings::unpaced() })
        .chain([Settings { torn: Torn::Keep, ..Settings::unpaced() }])
        .collect()
}

fn settings_of_4b() -> Vec<Settings> {
    let taper = Some(Taper { degrees: 2.0, height_um: 5000.0 });
    [0.0, 100.0, -70.0]
        .into_iter()
        .map(four_b)
        .chain([Settings { taper, ..four_b(30.0) }, Settings { interpolator: Model::Exact, ..four_b(50.0) }])
        .map(|settings| Settings { torn: Torn::Keep, ..settings })
        .collect()
}

fn settings_of_gcode() -> Vec<Settings> {
    let absolute = GcodeSettings {
        arc_centre: ArcCentre::Absolute,
        unit_without_point: UnitWithoutPoint::Least,
        block_skip: true,
        offset_registers: [("D1".parse().unwrap(), 80.0), ("H1".parse().unwrap(), 20.0)].into(),
        ..GcodeSettings::default()
    };
    let whole = GcodeSettings { unit_without_point: UnitWithoutPoint::Whole, ..GcodeSettings::default() };
    vec![
        gcode(0.0),
        gcode(100.0),
        Settings { gcode: absolute, torn: Torn::Keep, ..gcode(50.0) },
        Settings { gcode: whole, interpolator: Model::Exact, ..gcode(3.0) },
    ]
}

#[test]
fn bytes_of_no_meaning_are_borne_by_every_dialect() {
    let lines = Settings { dialect: Dialect::Gcode, ..Settings::unpaced() };
    let all = [settings_of_3b(), settings_of_4b(), settings_of_gcode(), vec![lines]].concat();
    campaign(&all, 1, 1500, garbage);
    // Behind a leader nothing is skipped any more.
    let (_, alarms) = campaign(&all, 2, 1500, |dice| [b"%\n".to_vec(), garbage(dice)].concat());
    assert!(alarms > 1000, "{alarms}");
}

#[test]
fn blocks_put_together_at_random_are_borne() {
    let three = |dice: &mut Dice| format!("%\n{}", blocks(dice, false)).into_bytes();
    let four = |dice: &mut Dice| format!("%\n{}", blocks(dice, true)).into_bytes();
    for (all, seed, text) in
        [(settings_of_3b(), 3, three as fn(&mut Dice) -> Vec<u8>), (settings_of_4b(), 4, four)]
    {
        let (blocks, alarms) = campaign(&all, seed, 400, text);
        assert!(blocks > 300 && alarms > 150, "{blocks} {alarms}");
    }
}

#[test]
fn lines_put_together_at_random_are_borne() {
    let (blocks, alarms) =
        campaign(&settings_of_gcode(), 5, 500, |dice| format!("%\n{}", lines(dice)).into_bytes());
    assert!(blocks > 300 && alarms > 150, "{blocks} {alarms}");
}

#[test]
fn numbers_at_the_end_of_every_range_are_borne() {
    for (text, settings, alarm) in [
        ("%\nM98 P1 L999999\nM02\nO1\nG91 G01 X60000.\nM99\n%\n", gcode(0.0), "number"),
        ("%\nG01 X999999999999\n", gcode(0.0), "number"),
        ("%\nG92 X-99999. Y99999.\nG92 X-99999.\nG90 G01 X-99998.\n%\n", gcode(0.0), ""),
        ("%\nG02 X0.001 R-250.\n", gcode(0.0), ""),
        ("%\nG41 D999999999999 G01 X1.\nX2.\n%\n", gcode(100.0), "offset"),
        ("%\nM98 P999999999999 L999999999999\nM02\n%\n", gcode(0.0), "call"),
        ("%\nO999999999999 N999999999999 G999999999999\n", gcode(0.0), "word"),
        ("%\nG20 G01 X999999.999999\n", gcode(0.0), "number"),
        ("B99999999999999999999B1B1GXL1\n", Settings { label_skip: LabelSkip::Off, ..four_b(0.0) }, "format"),
        ("%\nB0B99999999B999999GXL1\nDD\n", Settings::unpaced(), "endless-block"),
        ("%\nB0B99999999B999999GXL1\nDD\n", four_b(100.0), "endless-block"),
        ("%\nB99999999B99999999B999999GYNR1\nDD\n", Settings::unpaced(), ""),
        ("%\nBBB1GXL1\nB99999999BB999999B99999999DGXNR1\nDD\n", four_b(100.0), ""),
    ] {
        let report = bear(&settings, text.as_bytes(), &mut Dice(9), false);
        assert_sound(&report, text.as_bytes(), text);
        assert_eq!(report.alarm.as_deref().unwrap_or_default(), alarm, "{text}: {report:?}");
    }
}
