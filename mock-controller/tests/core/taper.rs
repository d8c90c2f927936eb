//! A taper keyed in: the upper guide is cut beside the same outline, at another offset.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use mock_controller::{Dialect, Model, Settings, SettingsError, Taper};

use crate::sender::{Sender, run};
use crate::watch::{four_b, watch};
use crate::writer::{Order, ell};

/// The paper's taper: 4 degrees over 100 mm, A = 6.9927 mm.
const PAPER: Taper = Taper { degrees: 4.0, height_um: 100_000.0 };

fn tapered(wire_offset_um: f64, taper: Taper) -> Settings {
    Settings { taper: Some(taper), ..four_b(wire_offset_um) }
}

fn circle(flag: &str) -> String {
    format!("B20000BB20000B0{flag}GXL1\nB20000B0B80000B20000DGYNR1\nB20000BB20000GXL3\nDD\n")
}

#[test]
fn the_papers_taper_shifts_by_6_99_mm_and_not_6_69() {
    assert!((PAPER.shift_um() - 6992.68).abs() < 0.01, "{}", PAPER.shift_um());
}

#[test]
fn the_flag_on_the_lead_in_declares_the_sense() {
    for (flag, offset_um, lower, upper) in [
        ("D", -100.0, 19_900, 12_907),
        ("DD", -100.0, 19_900, 26_893),
        ("D", 70.0, 20_070, 13_077),
        ("D", 0.0, 20_000, 13_007),
    ] {
        let (report, watch) = watch(tapered(offset_um, PAPER), &circle(flag));
        assert_eq!((report.blocks, report.alarm, report.end_um), (3, None, [0, 0]), "{flag}");
        assert_eq!((report.pulses, report.upper_pulses), (10 * lower, Some(10 * upper)), "{flag}");
        assert_eq!(report.upper_end_um, Some([0, 0]));
        // Above and below keep pace: the same angle at every moment.
        for &(block, [x, y], [u, v]) in &watch.upper {
            let between =
                (x as f64 * v as f64 - y as f64 * u as f64).atan2(x as f64 * u as f64 + y as f64 * v as f64);
            assert!(block != 2 || between.abs() < 3e-4, "{flag}: {x} {y} {u} {v}");
        }
        assert_eq!(watch.upper.len(), 10 * upper as usize);
    }
}

#[test]
fn above_an_outline_with_an_inside_corner_every_side_is_shifted_by_the_difference() {
    let taper = Taper { degrees: 1.0, height_um: 50_000.0 };
    for model in [Model::Rotated, Model::Exact] {
        let writer = ell(Order::FlagFirst, model, false);
        let settings = Settings { interpolator: model, ..tapered(100.0, taper) };
        let (report, watch) = watch(settings, &(writer.text + "DD\n"));
        assert_eq!((report.blocks, report.alarm, report.upper_end_um), (10, None, Some([0, 0])));
        let values =
            |index: usize| watch.upper.iter().filter(|up| (2..10).contains(&up.0)).map(move |up| up.2[index]);
        let shift = 100 - 873;
        for (found, wanted) in [
            (values(0).min(), -shift),
            (values(0).max(), 20_000 + shift),
            (values(1).min(), 5000 - shift),
            (values(1).max(), 25_000 + shift),
        ] {
            assert!((found.unwrap() - wanted).abs() <= 1, "{found:?} {wanted}");
        }
    }
}

#[test]
fn beyond_the_apex_the_upper_guide_runs_on_the_other_side_of_the_centre() {
    // R 5 with A 6.99: 1.993 beyond it; and with A the radius itself, where the guide stands still.
    let program = "B5000BB5000B0DGXL1\nB5000B0B20000B5000DGYNR1\nB5000BB5000GXL3\nDD\n";
    let (report, watched) = watch(tapered(0.0, PAPER), program);
    assert_eq!((report.alarm, report.blocks, report.upper_end_um), (None, 3, Some([0, 0])));
    assert_eq!((report.pulses, report.upper_pulses), (50_000, Some(10 * 1993)));
    for &(block, [x, y], [u, v]) in &watched.upper {
        let apart = ((x - u) as f64).hypot((y - v) as f64);
        assert!(block != 2 || (apart - 6993.0).abs() < 4.0, "{apart} at {x}, {y}");
    }
    let level = Taper { degrees: 45.0, height_um: 5000.0 };
    let (report, _) = watch(tapered(0.0, level), program);
    assert_eq!((report.alarm, report.pulses, report.upper_pulses), (None, 50_000, Some(0)));
}

#[test]
fn a_lead_in_without_a_flag_tells_no_sense() {
    let unflagged = circle("D").replace("B0DGXL1", "GXL1");
    let report = run(tapered(0.0, PAPER), &mut Sender::of(unflagged).window(4096));
    assert_eq!(report.alarm.as_deref(), Some("taper"));
}

#[test]
fn only_4b_has_a_taper_keyed_in_and_only_a_possible_one() {
    let three = Settings { taper: Some(PAPER), ..Settings::unpaced() };
    assert_eq!(three.validate(), Err(SettingsError::TaperDialect));
    let steep = Taper { degrees: 60.0, ..PAPER };
    assert_eq!(tapered(0.0, steep).validate(), Err(SettingsError::Taper(steep)));
    let report = run(
        Settings { dialect: Dialect::FourB, ..Settings::unpaced() },
        &mut Sender::of(circle("D")).window(4096),
    );
    assert_eq!((report.upper_end_um, report.upper_pulses, report.alarm), (None, None, None));
}
