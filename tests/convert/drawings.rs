//! A drawing of a plate with a hole, cut by a plan: the mock's extents against formulas, and its end against the plan.

use std::f64::consts::PI;

use crate::control::{Cut, assert_same_cut, cut, cut_3b, gcode};
use crate::shop::{Run, Shop};

/// 40 × 30 mm from the origin, and a hole of R6 about (12, 15).
const PLATE: &str = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nCUT\n\
                     90\n4\n70\n1\n10\n0\n20\n0\n10\n40\n20\n0\n10\n40\n20\n30\n10\n0\n20\n30\n0\nCIRCLE\n8\nCUT\n10\n12\n20\n15\n\
                     40\n6\n0\nENDSEC\n0\nEOF\n";
/// The hole is entered from its middle, the outline from below.
const HOLES: &str = "--start 12,15 --start 20,-3";

fn planned(words: &str) -> Run {
    let run = Shop::with("plate.dxf", PLATE).run(&format!("convert plate.dxf {words}"));
    assert_eq!(run.code, Some(0), "{words}: {}", run.stderr);
    run
}

/// The extents of the hole and of the outline, µm from (12, 15), each at its offset; what is on the way from one start
/// hole to the other is passed by.
fn assert_measures(cut: &Cut, [of_hole, of_outline]: [i64; 2], what: &str) {
    let hole = cut.extents_where(|[x, y]| x.abs() < 7000 && y.abs() < 7000 && (x < 2000 || y > -4000));
    let outline = cut.extents_where(|[x, y]| x > 12_000 || y > 8000 || x < -8000);
    let (r, o) = (6000 - of_hole, of_outline);
    let wanted = [-12_000 - o, 28_000 + o, -15_000 - o, 15_000 + o];
    for (found, wanted) in hole.into_iter().zip([-r, r, -r, r]).chain(outline.into_iter().zip(wanted)) {
        assert!((found - wanted).abs() <= 1, "{what}: {found} for {wanted}; {hole:?} {outline:?}");
    }
}

#[test]
fn hole_and_outline_measure_what_the_offset_says_and_end_where_the_plan_does() {
    for offset in [50, 100, 250] {
        let words = format!("--offset 0.{offset:03} {HOLES}");
        let (blocks, program) =
            (planned(&format!("--to 3b {words}")), planned(&format!("--to gcode {words}")));
        for (cut, what) in [(cut_3b(&blocks.stdout), "3B"), (cut(gcode(0.0), &program.stdout), "G-code")] {
            let what = format!("{what}, {offset}");
            assert_measures(&cut, [offset; 2], &what);
            // Back in the start hole of the outline: (20, -3), from (12, 15).
            assert_eq!(cut.end(), [8000, -18_000], "{what}");
            let (wide, high, r) = (
                f64::from(40_000 + 2 * offset as i32),
                f64::from(30_000 + 2 * offset as i32),
                6000.0 - offset as f64,
            );
            let corners = (4.0 - PI) * (offset * offset) as f64;
            let area = (wide * high - corners + PI * r * r) / 1e6;
            assert!((cut.area() - area).abs() < 0.3, "{what}: {} for {area}", cut.area());
        }
        for said in [
            "start hole X12.000 Y15.000, given",
            "start hole X20.000 Y-3.000, given",
            "wire on the left",
            "wire on the right",
        ] {
            assert!(blocks.stderr.contains(said), "{said}: {}", blocks.stderr);
        }
        assert_same_cut(&cut_3b(&blocks.stdout), &cut(gcode(0.0), &program.stdout), 2, &words);
    }
}

#[test]
fn every_pass_has_its_own_offset_and_the_one_back_the_other_sense() {
    let text = planned(&format!("--to gcode --passes 0.2=S1,0.1:back=S2 {HOLES}")).stdout;
    let whole = cut(gcode(0.0), &text);
    // The wire comes farthest out in the hole in the skim, about the outline in the rough pass.
    assert_measures(&whole, [100, 200], "both passes");
    // The rough passes alone, and the skims alone, each from a start hole and back to it.
    let mut passes: [String; 2] = Default::default();
    let mut pass = 0;
    for line in text.lines().filter(|line| !line.starts_with("M02")) {
        match line {
            "S1" => pass = 0,
            "S2" => pass = 1,
            _ if line.starts_with("G01") || line.starts_with("G02") || line.starts_with("G03") => {
                passes[pass] += &format!("{line}\n")
            }
            _ => {
                passes[0] += &format!("{line}\n");
                passes[1] += &format!("{line}\n");
            }
        }
    }
    for (pass, (offset, sense)) in passes.iter().zip([(200_i64, 1.0), (100, -1.0)]) {
        let cut = cut(gcode(0.0), &format!("{pass}M02\n"));
        assert_measures(&cut, [offset; 2], pass);
        let r = 6.0 - offset as f64 / 1000.0;
        assert!(cut.area() * sense > 1200.0 + PI * r * r, "{}", cut.area());
    }
}

#[test]
fn tabs_are_left_by_the_first_pass_and_cut_last() {
    // One tab of 2 mm in the right side of the outline, from (40, 10) to (40, 12): 50 mm along the contour.
    let shop = Shop::with("plate.dxf", PLATE.replace("CIRCLE\n8\nCUT\n10\n12\n20\n15\n40\n6\n0\n", ""));
    for (words, stop) in [("--to gcode", "M00"), ("--to 3b", "D")] {
        let run =
            shop.run(&format!("convert plate.dxf {words} --offset 0.1 --lead-in straight:3 --tabs @50+2"));
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stderr.contains("tab 1: X40.000 Y10.000 to X40.000 Y12.000, 2.000 mm"), "{}", run.stderr);
        let settings = || {
            if stop == "D" { crate::control::three_b(mock_controller::Model::Rotated) } else { gcode(0.0) }
        };
        let whole = cut(settings(), &run.stdout);
        let last_stop = run.stdout.rfind(&format!("\n{stop}\n")).unwrap();
        let before = cut(settings(), &run.stdout[..=last_stop]);
        // 3B begins in the start hole, (0, -3.1), G-code at the origin and goes there.
        let up = if stop == "D" { 3100 } else { 0 };
        let is_in_tab =
            |[x, y]: [i64; 2]| (40_090..40_105).contains(&x) && (10_150..11_850).contains(&(y - up));
        // The way between start holes may cross the tab; only the cut of it runs along.
        let along = |cut: &Cut| cut.pulses.iter().filter(|place| is_in_tab(**place)).count();
        assert!(along(&before) < 100, "{} µm of the tab are cut\n{}", along(&before), run.stdout);
        assert!(along(&whole) > 1600, "{} µm of the tab are cut\n{}", along(&whole), run.stdout);
        let [left, _, _, top] = whole.extents();
        let [_, right, _, _] = whole.extents_where(|[x, y]| x < 41_000 && y - up > 20_000);
        for (found, wanted) in [(left, -100), (right, 40_100), (top - up, 30_100)] {
            assert!((found - wanted).abs() <= 1, "{found} for {wanted}\n{}", run.stdout);
        }
    }
}

#[test]
fn a_plan_backwards_is_the_same_plan_in_the_other_sense() {
    let words = format!("--to 3b --offset 0.1 {HOLES}");
    let (there, back) =
        (cut_3b(&planned(&words).stdout), cut_3b(&planned(&format!("{words} --reverse")).stdout));
    assert_eq!(back.end(), there.end());
    assert_measures(&back, [100; 2], "backwards");
    assert!((back.area() + there.area()).abs() < 0.4, "{} {}", back.area(), there.area());
}

#[test]
fn a_drawing_without_an_offset_is_cut_on_its_lines() {
    for cut in [cut_3b(&planned("--to 3b").stdout), cut(gcode(0.0), &planned("--to gcode").stdout)] {
        let [left, right, bottom, top] = cut.extents();
        assert!(
            (right - left - 40_000).abs() <= 1 && (top - bottom - 30_000).abs() <= 1,
            "{:?}",
            cut.extents()
        );
        // The circle and the outline run counter-clockwise; the ways between enclose the rest.
        assert!(cut.report.path_length_mm > 140.0 + 12.0 * PI, "{}", cut.report.path_length_mm);
    }
}
