//! `--reverse`: the same contours in the other sense, from the same start holes and back to them.

use mock_controller::Model;

use crate::control::{Cut, assert_lies_on, assert_same_cut, cut, cut_3b, four_b, gcode};
use crate::four_b::die;
use crate::shop::{Shop, convert};
use crate::writer::{Order, ell};

/// The other cut of the same contour: the same places and extents, the same end, the area with the other sign.
fn assert_turned_round(backwards: &Cut, forwards: &Cut, what: &str) {
    assert_eq!(backwards.end(), forwards.end(), "{what}: ends");
    let extents = [backwards.extents(), forwards.extents()];
    assert!(extents[0].iter().zip(extents[1]).all(|(a, b)| (a - b).abs() <= 1), "{what}: {extents:?}");
    assert_lies_on(backwards, forwards, 2, what);
    assert_lies_on(forwards, backwards, 2, what);
    let (area, turned) = (forwards.area(), backwards.area());
    let slack = 0.002 * forwards.report.path_length_mm;
    assert!(area.abs() > 10.0 * slack, "{what}: an area that tells no sense, {area}");
    assert!((area + turned).abs() <= slack, "{what}: areas {area} and {turned}");
}

const L: &str = "B0B3000B3000GYL2\nB15000B0B15000GXL1\nB0B10000B10000GYL2\nB10000B0B10000GXL3\nB0B10000B10000GYL2\n\
                 B10000B0B10000GXL3\nB0B20000B20000GYL4\nB5000B0B5000GXL1\nB0B3000B3000GYL4\nDD\n";

/// An L, a pause, the way to the next start hole, a pause, and a circle from its middle.
fn two_contours() -> String {
    let circle = "D\nB30000B0B30000GXL1\nD\nB4000B0B4000GXL1\nB4000B0B16000GYNR1\nB4000B0B4000GXL3\nDD\n";
    L.replace("DD\n", circle)
}

#[test]
fn a_3b_contour_is_cut_backwards_from_its_own_start_hole() {
    let gear = Shop::new().run("generate gear").stdout;
    let no_lead = Shop::new().run("generate gear --lead-in none --teeth 17").stdout;
    for (program, what) in [(gear.as_str(), "gear"), (&no_lead, "no lead-in"), (L, "L")] {
        let forwards = cut_3b(program);
        let once = convert("in.3b", program, "--reverse");
        assert_turned_round(&cut_3b(&once), &forwards, what);
        let twice = convert("in.3b", &once, "--reverse");
        assert_same_cut(&cut_3b(&twice), &forwards, 2, what);
    }
}

#[test]
fn contours_keep_their_order() {
    let program = two_contours();
    let (forwards, backwards) = (cut_3b(&program), cut_3b(&convert("in.3b", &program, "--reverse")));
    assert_turned_round(&backwards, &forwards, "two contours");
    // The L is cut first, its end is the start of the way.
    let way = |cut: &Cut| cut.ends.windows(2).position(|pair| pair == [[0, 0], [30_000, 0]]);
    assert_eq!((way(&forwards), way(&backwards)), (Some(8), Some(8)));
    assert_eq!(backwards.end(), [30_000, 0]);
}

#[test]
fn gcode_backwards_is_compensated_on_the_other_side() {
    let l = "G21 G90\nG92 X5. Y-3.\nG42 D1 G01 X5. Y0.\nX20.\nY10.\nX10.\nY20.\nX0.\nY0.\nX5.\nG40 X5. Y-3.\nM02\n";
    let alone = l.replace("G42 D1 G01", "G42 D1\nG01").replace("G40 X5.", "G40\nX5.");
    let circle = "G21 G90\nG92 X0. Y0.\nG41 D1 G01 X5.\nG03 X5. Y0. I-5. J0.\nM00\nG40 G01 X0.\nM00\nG00 X30.\n\
                  M00\nG42 D1 G01 X32. Y0.\nG02 X32. Y0. I-2. J0.\nG40 G01 X30.\nM02\n";
    for (program, what) in [(l, "L"), (&alone, "G41 alone"), (circle, "two circles")] {
        let once = convert("in.nc", program, "--reverse");
        for offset in [0.0, 100.0] {
            let what = format!("{what}, {offset}\n{once}");
            assert_turned_round(&cut(gcode(offset), &once), &cut(gcode(offset), program), &what);
            let twice = convert("in.nc", &once, "--reverse");
            assert_same_cut(&cut(gcode(offset), &twice), &cut(gcode(offset), program), 2, &what);
        }
        let words = "--to 3b --offset 0.1 --reverse";
        let wire = cut_3b(&convert("in.nc", program, words));
        assert_turned_round(&wire, &cut(gcode(100.0), program), what);
    }
}

#[test]
fn a_4b_contour_backwards_is_beside_its_outline_on_the_same_side() {
    let l = ell(Order::FlagFirst, Model::Rotated, false).text + "DD\n";
    for (program, what) in [(die(), "die"), (l, "L")] {
        let once = convert("in.4b", &program, "--reverse");
        for f in [59.0, -59.0, 300.0, -300.0] {
            let what = format!("{what}, F {f}\n{once}");
            assert_turned_round(&cut(four_b(f), &once), &cut(four_b(f), &program), &what);
        }
        let twice = convert("in.4b", &once, "--reverse");
        assert_same_cut(&cut(four_b(59.0), &twice), &cut(four_b(59.0), &program), 3, what);
        let wire = cut_3b(&convert("in.4b", &program, "--to 3b --offset=-0.1 --reverse"));
        assert_turned_round(&wire, &cut(four_b(-100.0), &program), what);
    }
}

#[test]
fn a_contour_that_does_not_close_is_not_cut_backwards() {
    let shop = Shop::with("in.3b", "B5000B0B5000GXL1\nB0B5000B5000GYL2\nB9000B0B9000GXL1\nDD\n");
    let run = shop.run("convert in.3b --reverse");
    assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{}", run.stderr);
    assert!(run.stderr.contains("a contour that does not come back to where it began"), "{}", run.stderr);
}
