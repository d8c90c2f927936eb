//! Offsets against formulas: rectangles, slots, rings, regular polygons.

use std::f64::consts::PI;

use dripfeed::geometry::offset::{Corners, offset};
use dripfeed::geometry::{Element, Path, Point, Sense};

use crate::contours::{Dice, filleted};

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

#[test]
fn rectangles_with_fillets_have_the_area_and_extent_of_the_formula() {
    for seed in 0..60 {
        let mut dice = Dice::new(seed);
        let (a, b) = (dice.between(2.0, 30.0), dice.between(2.0, 30.0));
        let (x, y) = (dice.between(-500.0, 500.0), dice.between(-500.0, 500.0));
        let fillet = dice.between(0.2, 0.9);
        let corners = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)];
        let nodes: Vec<_> = corners.iter().map(|&(u, v)| Point::new(x + u, y + v)).collect();
        let path = filleted(&nodes, &[fillet; 4]);
        for left in [dice.between(0.01, 0.19), -dice.between(0.01, 3.0)] {
            let found = offset(&path, left, Corners::Round).unwrap();
            assert_eq!((found.outlines.len(), found.unreached.len(), found.filled_corners), (1, 0, 0));
            let outline = &found.outlines[0].path;
            assert_eq!(outline.elements().len(), 8, "{seed}");
            let (a, b, r) = (a - 2.0 * left, b - 2.0 * left, fillet - left);
            assert!(close(outline.area(), a * b - (4.0 - PI) * r * r), "{seed} {left}");
            let [low, high] = outline.extent();
            assert!(close(low.x, x + left) && close(low.y, y + left), "{seed} {left}");
            assert!(close(high.x - low.x, a) && close(high.y - low.y, b), "{seed} {left}");
            for element in outline.elements() {
                if let Element::Arc { start, end, centre, .. } = element {
                    assert!(((start - centre).norm() - r).abs() < 1e-9, "{seed} {left}");
                    assert!(((end - centre).norm() - r).abs() < 1e-9, "{seed} {left}");
                }
            }
        }
    }
}

#[test]
fn a_slot_with_round_ends_shrinks_to_its_middle_line_and_not_beyond() {
    let p = Point::new;
    let end = |start, end, centre| Element::Arc { start, end, centre, sense: Sense::Clockwise };
    let slot = Path::new(vec![
        Element::Line { start: p(0.0, 1.0), end: p(6.0, 1.0) },
        end(p(6.0, 1.0), p(6.0, -1.0), p(6.0, 0.0)),
        Element::Line { start: p(6.0, -1.0), end: p(0.0, -1.0) },
        end(p(0.0, -1.0), p(0.0, 1.0), p(0.0, 0.0)),
    ])
    .unwrap();
    let inside = offset(&slot, -0.75, Corners::Round).unwrap();
    assert!(close(inside.outlines[0].path.area(), -(6.0 * 0.5 + PI * 0.25 * 0.25)));
    let gone = offset(&slot, -1.001, Corners::Round).unwrap();
    assert!(gone.outlines.is_empty());
    assert!(close(gone.unreached[0].largest, 1.0));
    let outside = offset(&slot, 0.75, Corners::Round).unwrap();
    assert!(close(outside.outlines[0].path.area(), -(6.0 * 3.5 + PI * 1.75 * 1.75)));
}

#[test]
fn a_ring_with_a_gap_closes_when_the_gap_is_filled() {
    // A C: outside radius 5, inside radius 4, its ends 0.5 apart; filled from outside, a ring and a hole are left.
    let p = Point::new;
    let x = |radius: f64| (radius * radius - 0.0625f64).sqrt();
    let (outer, inner) = (x(5.0), x(4.0));
    let o = p(0.0, 0.0);
    let c = Path::new(vec![
        Element::Arc {
            start: p(outer, 0.25),
            end: p(outer, -0.25),
            centre: o,
            sense: Sense::CounterClockwise,
        },
        Element::Line { start: p(outer, -0.25), end: p(inner, -0.25) },
        Element::Arc { start: p(inner, -0.25), end: p(inner, 0.25), centre: o, sense: Sense::Clockwise },
        Element::Line { start: p(inner, 0.25), end: p(outer, 0.25) },
    ])
    .unwrap();
    let found = offset(&c, -0.4, Corners::Round).unwrap();
    assert_eq!(found.outlines.len(), 2);
    let areas: Vec<f64> = found.outlines.iter().map(|o| o.path.area()).collect();
    // Outside: the whole disc of 5.4 but for the notch between two corner arcs; inside: a disc of 3.6 with a notch.
    assert!(areas[0] > 0.0 && areas[0] < PI * 5.4 * 5.4 && areas[0] > PI * 5.4 * 5.4 - 0.1, "{areas:?}");
    assert!(areas[1] < 0.0 && -areas[1] > PI * 3.6 * 3.6 && -areas[1] < PI * 3.6 * 3.6 + 0.1, "{areas:?}");
    let walls: Vec<_> = found.unreached.iter().map(|run| (run.first, run.last)).collect();
    assert_eq!(walls, [(1, 1), (3, 3)]);
    assert!(found.unreached.iter().all(|wall| close(wall.largest, 0.25)), "{:?}", found.unreached);
}

#[test]
fn regular_polygons_grow_by_perimeter_and_circle_and_shrink_by_similarity() {
    for sides in 3..20_u32 {
        let nodes: Vec<_> = (0..sides)
            .map(|n| {
                let angle = 2.0 * PI * f64::from(n) / f64::from(sides);
                Point::new(5.0 * libm::cos(angle), 5.0 * libm::sin(angle))
            })
            .collect();
        let path = filleted(&nodes, &vec![0.0; nodes.len()]);
        let (area, length) = (path.area(), path.length());
        let outside = offset(&path, -0.7, Corners::Round).unwrap();
        assert!(close(outside.outlines[0].path.area(), area + 0.7 * length + PI * 0.49), "{sides}");
        let apothem = 5.0 * libm::cos(PI / f64::from(sides));
        let inside = offset(&path, 0.7, Corners::Round).unwrap();
        let scale = (apothem - 0.7) / apothem;
        assert!(close(inside.outlines[0].path.area(), area * scale * scale), "{sides}");
        assert_eq!(inside.filled_corners, sides as usize);
        let sharp = offset(&path, -0.7, Corners::Sharp { limit: 3.0 }).unwrap();
        let scale = (apothem + 0.7) / apothem;
        assert!(close(sharp.outlines[0].path.area(), area * scale * scale), "{sides}");
        assert_eq!(sharp.outlines[0].path.elements().len(), sides as usize);
    }
}

#[test]
fn a_gear_offset_here_is_the_gear_made_with_its_offset() {
    use dripfeed::shapes::cycloid_gear::{CycloidGear, Direction, Trim};
    let gear = CycloidGear::default();
    let made = |by| {
        let outline = gear.outline(by, Direction::Clockwise, Trim::Refuse).unwrap();
        Path::new(outline.elements().collect()).unwrap()
    };
    let found = offset(&made(0.0), 0.07, Corners::Round).unwrap();
    let theirs = made(0.07);
    assert_eq!(found.outlines.len(), 1);
    let ours = &found.outlines[0].path;
    assert_eq!(ours.elements().len(), 252);
    for (ours, theirs) in ours.elements().iter().zip(theirs.elements()) {
        assert!((ours.start() - theirs.start()).norm() < 1e-6);
        assert_eq!(ours.radius().is_some(), theirs.radius().is_some());
        if let (Some(a), Some(b)) = (ours.radius(), theirs.radius()) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}
