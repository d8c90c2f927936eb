//! G40, G41, G42: the wire beside the path, at corners of every kind.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use mock_controller::{Model, Settings};

use crate::gcode::gcode;
use crate::watch::{Watch, watch};

/// A piece of the nominal outline, µm: a line, or an arc about a centre between two angles, counter-clockwise.
enum Piece {
    Line((f64, f64), (f64, f64)),
    Arc { centre: (f64, f64), radius: f64, from: f64, to: f64 },
}

/// The distance of a point from the nearest piece.
fn distance(pieces: &[Piece], x: f64, y: f64) -> f64 {
    let of = |piece: &Piece| match *piece {
        Piece::Line(a, b) => {
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let along = (((x - a.0) * dx + (y - a.1) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            (x - a.0 - along * dx).hypot(y - a.1 - along * dy)
        }
        Piece::Arc { centre, radius, from, to } => {
            let angle = (y - centre.1).atan2(x - centre.0);
            let turned = (angle - from).rem_euclid(std::f64::consts::TAU);
            if turned <= to - from {
                ((x - centre.0).hypot(y - centre.1) - radius).abs()
            } else {
                let end = |a: f64| (x - centre.0 - radius * a.cos()).hypot(y - centre.1 - radius * a.sin());
                end(from).min(end(to))
            }
        }
    };
    pieces.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// Everything but lead-in and lead-out keeps its distance.
fn assert_beside(watch: &Watch, pieces: &[Piece], offset: f64, what: &str) {
    let last = watch.ends.last().unwrap().number;
    let mut count = 0;
    for &(block, x, y) in &watch.pulses {
        if block == 1 || block == last {
            continue;
        }
        count += 1;
        let found = distance(pieces, x as f64, y as f64);
        assert!((found - offset).abs() <= 2.0, "{what}: block {block} at {x}, {y}: {found} for {offset}");
    }
    assert!(count > 1000);
}

/// From the middle of its bottom, counter-clockwise.
const SQUARE: &str = "X10. Y0.\nX10. Y10.\nX0. Y10.\nX0. Y0.\nX5. Y0.\n";

fn square() -> Vec<Piece> {
    let nodes = [(0.0, 0.0), (10_000.0, 0.0), (10_000.0, 10_000.0), (0.0, 10_000.0)];
    (0..4).map(|k| Piece::Line(nodes[k], nodes[(k + 1) % 4])).collect()
}

#[test]
fn round_a_square_outside_the_corners_are_gone_round_and_inside_cut_off() {
    for model in [Model::Rotated, Model::Strict, Model::Exact] {
        for (offset, side, hole, low) in
            [(100_i64, "G42", "X5. Y-2.", -100), (70, "G41", "X3. Y3.", 70), (1000, "G42", "X5. Y-4.", -1000)]
        {
            let program = format!("%\nG01 {hole}\n{side} D1 X5. Y0.\n{SQUARE}G40 {hole}\nM02\n%\n");
            let settings = Settings { interpolator: model, ..gcode(offset as f64) };
            let (report, mut watch) = watch(settings, &program);
            let what = format!("{model:?} {side} {offset}");
            assert_eq!((report.blocks, report.alarm), (8, None), "{what}");
            assert_eq!(report.end_um, watch.ends[0].end_um, "{what}");
            assert_eq!(watch.bounds(3..=7), [low, 10_000 - low, low, 10_000 - low], "{what}");
            watch.pulses.retain(|pulse| pulse.0 > 2);
            assert_beside(&watch, &square(), offset as f64, &what);
        }
    }
}

#[test]
fn the_same_side_of_the_same_path_does_not_depend_on_the_direction() {
    // Clockwise with the wire on the left is outside.
    let program = "%\nG41 G01 X0. Y5.\nX0. Y10.\nX10.\nY0.\nX0.\nY5.\nG40 X-3. Y5.\n%\n";
    let (report, watch) = watch(gcode(200.0), program);
    assert_eq!((report.blocks, report.alarm, report.end_um), (7, None, [-3000, 5000]));
    assert_eq!(watch.bounds(2..=6), [-200, 10_200, -200, 10_200]);
    assert_beside(&watch, &square(), 200.0, "clockwise");
    assert_eq!(watch.ends[0].end_um, [-200, 5000]);
    // Each corner belongs to the block before it.
    assert_eq!(watch.ends[1].end_um, [0, 10_200]);
    assert_eq!(watch.ends[2].end_um, [10_200, 10_000]);
}

/// An L of lines with a notch, from the middle of its bottom, counter-clockwise.
const ELL: &str = "X20. Y0.\nY10.\nX10.\nY20.\nX0.\nY0.\nX5.\n";

#[test]
fn an_inside_corner_among_outside_corners_and_the_other_way_round() {
    let nodes = [
        (0.0, 0.0),
        (20_000.0, 0.0),
        (20_000.0, 10_000.0),
        (10_000.0, 10_000.0),
        (10_000.0, 20_000.0),
        (0.0, 20_000.0),
    ];
    let pieces: Vec<Piece> = (0..6).map(|k| Piece::Line(nodes[k], nodes[(k + 1) % 6])).collect();
    for (side, offset, low) in
        [("G42", 100_i64, -100), ("G41", 100, 100), ("G42", 33, -33), ("G41", 1500, 1500)]
    {
        let program = format!("%\n{side} G01 X5. Y0.\n{ELL}G40 X4. Y0.\n%\n");
        let (report, watch) = watch(gcode(offset as f64), &program);
        assert_eq!((report.blocks, report.alarm, report.end_um), (9, None, [4000, 0]), "{side}");
        assert_eq!(watch.bounds(2..=8), [low, 20_000 - low, low, 20_000 - low], "{side} {offset}");
        assert_beside(&watch, &pieces, offset as f64, side);
        // Into the notch.
        assert_eq!(watch.ends[3].end_um[0], 10_000 - low, "{side}");
    }
}

#[test]
fn arcs_and_the_corners_between_them_and_lines() {
    // A bulge on the right, a bay at the top, a tangent round on the left.
    let program =
        "X10. Y0.\nG03 X10. Y6. J3.\nG01 X8.\nG03 X4. Y6. I-2. J0.\nG01 X0.\nG03 X0. Y0. J-3.\nG01 X2.\n";
    let bay = program.replace("G03 X4. Y6.", "G02 X4. Y6.");
    let quarter = std::f64::consts::FRAC_PI_2;
    let pieces = |bulges: bool| {
        let (from, to) = if bulges { (0.0, 2.0 * quarter) } else { (2.0 * quarter, 4.0 * quarter) };
        vec![
            Piece::Line((0.0, 0.0), (10_000.0, 0.0)),
            Piece::Arc { centre: (10_000.0, 3000.0), radius: 3000.0, from: -quarter, to: quarter },
            Piece::Line((10_000.0, 6000.0), (8000.0, 6000.0)),
            Piece::Arc { centre: (6000.0, 6000.0), radius: 2000.0, from, to },
            Piece::Line((4000.0, 6000.0), (0.0, 6000.0)),
            Piece::Arc { centre: (0.0, 3000.0), radius: 3000.0, from: quarter, to: 3.0 * quarter },
        ]
    };
    for (text, bulges) in [(program, true), (bay.as_str(), false)] {
        for side in ["G41", "G42"] {
            for offset in [60.0, 250.0] {
                for model in [Model::Rotated, Model::Exact] {
                    let what = format!("{side} {offset} bulges {bulges} {model:?}");
                    let program = format!("%\n{side} G01 X2. Y0.\n{text}G40 G01 X1.\n%\n");
                    let settings = Settings { interpolator: model, ..gcode(offset) };
                    let (report, watch) = watch(settings, &program);
                    assert_eq!((report.alarm, report.blocks), (None, 9), "{what}: {:?}", report.alarm_detail);
                    assert_eq!(report.end_um, [1000, 0], "{what}");
                    assert_beside(&watch, &pieces(bulges), offset, &what);
                }
            }
        }
    }
}

#[test]
fn a_full_circle_beside_the_path_is_a_circle_of_another_radius() {
    for (side, radius) in [("G41", 4900), ("G42", 5100)] {
        let (report, watch) = watch(gcode(100.0), &format!("%\n{side} G01 X5.\nG03 I-5.\nG40 G01 X0.\n%\n"));
        assert_eq!((report.blocks, report.pulses, report.alarm), (3, 10 * radius, None), "{side}");
        let (near, far) = watch.distances(2, 0.0, 0.0);
        assert!(near > radius as f64 - 1.5 && far < radius as f64 + 1.5, "{side}");
    }
}

#[test]
fn without_an_offset_or_with_d0_the_path_is_cut_as_it_stands() {
    let plain = format!("%\nG01 X-1. Y0.\n{SQUARE}X-2.\n%\n");
    let (wanted, wanted_watch) = watch(gcode(0.0), &plain);
    assert_eq!(wanted.alarm, None);
    for (offset, words) in [(0.0, "G41 D1"), (100.0, "G42 D0")] {
        let program = plain.replace("G01 X-1.", &format!("{words} G01 X-1.")).replace("X-2.", "G40 X-2.");
        let (report, watch) = watch(gcode(offset), &program);
        assert_eq!((report.blocks, report.alarm), (wanted.blocks, None));
        assert!(watch.pulses == wanted_watch.pulses, "{words}");
    }
}

#[test]
fn g40_alone_leaves_the_next_line_to_lead_out() {
    let (report, watch) = watch(gcode(100.0), "%\nG42\nG01 X5. Y5.\nX10.\nG40\nX10. Y0.\nX0.\n%\n");
    let ends: Vec<[i64; 2]> = watch.ends.iter().map(|end| end.end_um).collect();
    assert_eq!((ends, report.alarm), (vec![[5000, 4900], [10_000, 4900], [10_000, 0], [0, 0]], None));
}

#[test]
fn what_the_wire_cannot_do_is_an_alarm() {
    for (program, alarm, found) in [
        // A slot of 0.15 mm for a wire that needs 0.2.
        ("G41 G01 X5.\nX10.\nY0.15\nX0.\nG40 Y9.", "interference", "do not meet"),
        ("G41 G01 X5.\nG03 X5. Y0.16 J0.08\nG40 G01 Y9.", "radius", "R 80.0 µm vanishes"),
        ("G41 G03 X5. Y5. I5.", "compensation", "lead-in"),
        ("G41 G01 X5.\nX10.\nG40\nG03 X15. Y5. J5.", "compensation", "lead-out"),
        ("G41 G01 X5.\nX10.\nG42 X15.", "compensation", "without G40"),
        ("G41 G01 X5.\nX10.\nG92 X0.", "compensation", "G92"),
    ] {
        let (report, _) = watch(gcode(100.0), &format!("%\n{program}\n%\n"));
        let detail = report.alarm_detail.unwrap_or_default();
        assert_eq!(report.alarm.as_deref(), Some(alarm), "{program}: {detail}");
        assert!(detail.contains(found), "{program}: {detail}");
    }
}
