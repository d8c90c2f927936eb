//! 4B: the mock keys in one offset and another and cuts the outline beside; `convert --offset` must come to the same, and
//! both to the formulas: an outer dimension grows by the offset at outside corners and shrinks at inside corners.

use mock_controller::Model;

use crate::control::{Cut, Place, assert_same_cut, cut, cut_3b, four_b};
use crate::shop::{Shop, convert};
use crate::writer::{Order, ell};

const OFFSETS_UM: [i64; 6] = [100, -100, 59, -59, 700, -700];

/// The die of the examples as it goes to a control: `send` takes the remarks and block numbers of the listing off.
pub(crate) fn die() -> String {
    let path = format!("{}/docs/examples/die.4b", env!("CARGO_MANIFEST_DIR"));
    let run = Shop::new().run(&format!("send {path} --dry-run"));
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    run.stdout
}

/// What `convert` makes of a 4B program with an offset keyed in, in 3B.
fn wire(program: &str, offset_um: i64) -> Cut {
    let words = format!("--to 3b --offset={}", offset_um as f64 / 1000.0);
    cut_3b(&convert("in.4b", program, &words))
}

fn near(found: i64, wanted: i64, what: &str) {
    assert!((found - wanted).abs() <= 1, "{what}: {found} for {wanted}");
}

/// The L of `writer::ell`, mm: 20 × 20 from (0, 5), without 10 × 10 at its right top, corners R5.
fn assert_ell(cut: &Cut, f: i64, what: &str) {
    let [_, right, _, top] = cut.extents();
    // The start hole lies below the left side.
    let [left, ..] = cut.extents_where(|[_, y]| y > 9000);
    near(left, -f, &format!("{what}: left"));
    near(right, 20_000 + f, &format!("{what}: right"));
    near(top, 25_000 + f, &format!("{what}: top"));
    let [_, _, bottom, _] = cut.extents_where(|[x, y]| (8000..12_000).contains(&x) && y < 9000);
    near(bottom, 5000 - f, &format!("{what}: bottom"));
    // The notch, whose inside corner is an arc about (15, 20).
    let [_, _, _, over] = cut.extents_where(|[x, _]| x > 15_000);
    near(over, 15_000 + f, &format!("{what}: below the notch"));
    let [_, beside, _, _] = cut.extents_where(|[_, y]| y > 20_000);
    near(beside, 10_000 + f, &format!("{what}: beside the notch"));
    assert_round(
        cut,
        [15_000, 20_000],
        5000 - f,
        |[x, y]| x > 10_600 && x < 14_400 && y > 15_600 && y < 19_400,
        what,
    );
    assert_round(cut, [15_000, 10_000], 5000 + f, |[x, y]| x > 15_500 && y < 9500, what);
    assert_eq!(cut.end(), [0, 0], "{what}");
}

/// What is cut where it is looked at lies on a circle.
fn assert_round(cut: &Cut, [x, y]: Place, radius: i64, is_looked_at: impl Fn(Place) -> bool, what: &str) {
    let there: Vec<Place> = cut.pulses.iter().copied().filter(|place| is_looked_at(*place)).collect();
    assert!(there.len() > 100, "{what}: nothing is cut about {x}, {y}");
    for [px, py] in there {
        let (dx, dy) = ((px - x) as f64, (py - y) as f64);
        let found = (dx * dx + dy * dy).sqrt();
        assert!((found - radius as f64).abs() <= 3.0, "{what}: {found} µm from {x}, {y}, for {radius}");
    }
}

#[test]
fn an_l_with_an_inside_corner_measures_what_the_offset_says() {
    for order in [Order::FlagFirst, Order::AxisFirst] {
        let program = ell(order, Model::Rotated, false).text + "DD\n";
        for f in OFFSETS_UM {
            let what = format!("{order:?}, F {f}");
            let (mock, ours) = (cut(four_b(f as f64), &program), wire(&program, f));
            assert_ell(&mock, f, &format!("the control, {what}"));
            assert_ell(&ours, f, &format!("convert, {what}"));
            assert_same_cut(&ours, &mock, 3, &what);
        }
    }
}

#[test]
fn the_die_of_the_examples_measures_what_the_offset_says() {
    // The lead-in of the die runs down from the middle; the bow of R10 bulges in about (0, 20.6).
    for f in [-59, 59, -100, 100] {
        for (who, cut) in [("control", cut(four_b(f as f64), &die())), ("convert", wire(&die(), f))] {
            let what = format!("{who}, F {f}");
            let sides = cut.extents();
            for (side, wanted) in sides.into_iter().zip([-20_000 - f, 20_000 + f, -15_000 - f, 15_000 + f]) {
                near(side, wanted, &what);
            }
            let [_, _, lowest, _] = cut.extents_where(|[x, y]| x.abs() < 5000 && y > 5000);
            near(lowest, 10_600 + f, &format!("{what}: the bow"));
            assert_round(&cut, [0, 20_600], 10_000 - f, |[x, y]| x.abs() < 7000 && y > 5000, &what);
            assert_round(&cut, [19_000, 14_000], 1000 + f, |[x, y]| x > 19_200 && y > 14_200, &what);
            assert_eq!(cut.end(), [0, 0], "{what}");
        }
        assert_same_cut(&wire(&die(), f), &cut(four_b(f as f64), &die()), 3, &format!("F {f}"));
    }
}

/// From a start hole round an L with sharp corners and back: (0,0) (0,3) (15,3) (15,13) (5,13) (5,23) (-5,23) (-5,3).
const SHARP: &str = "B0B3000B3000GYL2\nB15000B0B15000GXL1\nB0B10000B10000GYL2\nB10000B0B10000GXL3\nB0B10000B10000GYL2\n\
                     B10000B0B10000GXL3\nB0B20000B20000GYL4\nB5000B0B5000GXL1\nB0B3000B3000GYL4\nDD\n";

#[test]
fn sharp_corners_are_rounded_on_request_and_then_take_any_offset() {
    let program = convert("in.3b", SHARP, "--to 4b --round-corners 1 --offset 0.1 --side right");
    for f in [100, -100, 250, -250] {
        for (who, cut) in [("control", cut(four_b(f as f64), &program)), ("convert", wire(&program, f))] {
            let what = format!("{who}, F {f}");
            let [left, right, _, top] = cut.extents();
            near(left, -5000 - f, &what);
            near(right, 15_000 + f, &what);
            near(top, 23_000 + f, &what);
            let [_, _, _, over] = cut.extents_where(|[x, _]| x > 8000);
            near(over, 13_000 + f, &format!("{what}: below the notch"));
            let [_, beside, _, _] = cut.extents_where(|[_, y]| y > 15_000);
            near(beside, 5000 + f, &format!("{what}: beside the notch"));
            assert_round(
                &cut,
                [6000, 14_000],
                1000 - f,
                |[x, y]| x > 5000 + f && x < 5900 && y > 13_000 + f && y < 13_900,
                &what,
            );
            assert_round(&cut, [14_000, 4000], 1000 + f, |[x, y]| x > 14_100 && y < 3900, &what);
            assert_eq!(cut.end(), [0, 0], "{what}");
        }
        let (ours, mock) = (wire(&program, f), cut(four_b(f as f64), &program));
        assert_same_cut(&ours, &mock, 3, &format!("F {f}"));
    }
}

#[test]
fn four_b_written_again_is_cut_the_same_under_any_offset() {
    let l = ell(Order::AxisFirst, Model::Rotated, false).text + "DD\n";
    for program in [die(), l, convert("in.3b", SHARP, "--to 4b --round-corners 1")] {
        let again = convert("in.4b", &program, "--to 4b");
        for f in [0.0, 59.0, -100.0] {
            assert_same_cut(
                &cut(four_b(f), &again),
                &cut(four_b(f), &program),
                3,
                &format!("F {f}\n{again}"),
            );
        }
    }
}

#[test]
fn an_offset_put_on_gcode_is_the_one_to_key_in_for_4b() {
    // An L with R2 in all corners but the one where the lead-in ends, which lies in a side.
    let text = "G21 G90\nG92 X5. Y-3.\nG42 D1 G01 X5. Y0.\nX18.\nG03 X20. Y2. I0. J2.\nG01 Y8.\nG03 X18. Y10. I-2. J0.\n\
                G01 X12.\nG02 X10. Y12. I0. J2.\nG01 Y18.\nG03 X8. Y20. I-2. J0.\nG01 X2.\nG03 X0. Y18. I0. J-2.\n\
                G01 Y2.\nG03 X2. Y0. I2. J0.\nG01 X5.\nG40 Y-3.\nM02\n";
    let shop = Shop::with("in.nc", text);
    let run = shop.run("convert in.nc --to 4b --register 1=0.1");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stderr.contains("key into the control: F = +"), "{}", run.stderr);
    let by_control = cut(four_b(100.0), &run.stdout);
    assert_same_cut(&cut(crate::control::gcode(100.0), text), &by_control, 3, &run.stdout);
}
