//! The wire's path under G41 and G42 against the contour as programmed: points, and one way against the other.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;

use dripfeed::compensation::{Compensated, local};
use dripfeed::formats::ReadError;
use dripfeed::geometry::offset::{Corners, Origin, offset};
use dripfeed::geometry::{Element, Path, Point};
use dripfeed::motion::runs::ContourError;
use dripfeed::motion::{Act, Motion, Offset, Side, Travel};
use dripfeed::place::Spot;

use crate::contours::{self, Dice};
use crate::measure::{Inside, distance, samples};

/// A micron.
const UM: f64 = 1e-3;

/// The contour begun in the middle of one of its straights, so that the wire leads in to a smooth place.
pub(crate) fn begun_on_a_straight(path: &Path) -> Path {
    let longest = (0..path.elements().len())
        .filter(|&n| matches!(path.elements()[n], Element::Line { .. }))
        .max_by(|&a, &b| path.elements()[a].length().total_cmp(&path.elements()[b].length()))
        .unwrap();
    let begun = path.clone().begun_at(longest);
    let mut elements = begun.elements().to_vec();
    let (start, middle, end) = (elements[0].start(), elements[0].at(0.5), elements[0].end());
    elements[0] = Element::Line { start: middle, end };
    elements.push(Element::Line { start, end: middle });
    Path::new(elements).unwrap()
}

/// A program: on, a lead-in from a hole beside the start, the contour, off, the way back.
fn program(contour: &[Element], side: Side) -> Vec<Result<Motion, ReadError>> {
    let (start, end) = (contour[0].start(), contour[contour.len() - 1].end());
    let hole = Point::new(start.x + 20.0, start.y);
    let moves = std::iter::once(Element::Line { start: hole, end: start })
        .chain(contour.iter().copied())
        .chain([Element::Line { start: end, end: hole }]);
    let said = |block, act| Ok(Motion { act, block, spot: Spot { byte: 0, line: block, column: 1 } });
    let count = contour.len() as u64 + 2;
    let mut all = vec![said(1, Act::Offset(Offset::On { side, distance: None, register: Some(3) }))];
    for (block, element) in (1..).zip(moves) {
        if block == count {
            all.push(said(block, Act::Offset(Offset::Off)));
        }
        all.push(said(block, Act::Move { travel: Travel::Cut, element, upper: None, flag: None }));
    }
    assert_eq!(all.len() as u64, count + 2);
    all
}

#[test]
fn the_wire_keeps_its_distance_and_its_side_all_along_any_contour() {
    let (mut done, mut passed, mut refused) = (0, 0, 0);
    for seed in 0..160 {
        let (kind, path) = contours::any(seed);
        let path = begun_on_a_straight(&path);
        let by = Dice::new(seed + 77).between(0.03, 0.7);
        let inside = Inside::of(&path);
        for side in [Side::Left, Side::Right] {
            let registers = BTreeMap::from([(3, by)]);
            let motions = program(path.elements(), side);
            let mut compensated = Compensated::new(motions.into_iter(), registers, Corners::Round);
            let made: Result<Vec<Motion>, ContourError> = compensated.by_ref().collect();
            let Ok(made) = made else {
                refused += 1;
                continue;
            };
            done += 1;
            passed += usize::from(!compensated.take_warnings().is_empty());
            let ways: Vec<(u64, Element)> = made
                .iter()
                .map(|motion| match motion.act {
                    Act::Move { element, .. } => (motion.block, element),
                    ref other => panic!("{other:?}"),
                })
                .collect();
            for pair in ways.windows(2) {
                assert_eq!(pair[0].1.end(), pair[1].1.start(), "{kind} {seed}");
                assert!(pair[0].0 <= pair[1].0, "{kind} {seed}");
            }
            let last = ways.len() - 1;
            assert_eq!((ways[0].0, ways[last].0), (1, path.elements().len() as u64 + 2));
            for (block, way) in &ways[1..last] {
                let own = path.elements()[*block as usize - 2];
                for (point, _) in samples(way, 9) {
                    let off = distance(&path, point) - by;
                    assert!(off.abs() < UM, "{kind} {seed} {side:?} by {by}: off by {off} in block {block}");
                    assert_eq!(inside.has(point), side == Side::Left, "{kind} {seed} {side:?}");
                    // The block is the one the wire runs beside.
                    assert!((own.distance(point) - by).abs() < UM, "{kind} {seed} block {block}");
                }
            }
        }
    }
    assert!(done > 150 && passed > 50 && refused > 10, "{done} {passed} {refused}");
}

#[test]
fn corner_by_corner_is_the_same_where_nothing_is_in_the_way() {
    let (mut same, mut vanished) = (0, 0);
    for seed in 0..200 {
        let (kind, path) = contours::any(seed);
        let path = begun_on_a_straight(&path);
        let by = Dice::new(seed + 99).between(0.02, 0.3);
        for left in [by, -by] {
            let Ok(whole) = offset(&path, left, Corners::Round) else { continue };
            match local::beside(path.elements(), left, Corners::Round) {
                Ok(ways) if whole.unreached.is_empty() && whole.outlines.len() == 1 => {
                    let nodes: Vec<Point> = ways.iter().map(|(way, _)| way.end()).collect();
                    let theirs = &whole.outlines[0];
                    assert_eq!(ways.len(), theirs.origins.len(), "{kind} {seed} {left}");
                    for (n, node) in nodes.iter().enumerate() {
                        let off = (node - theirs.path.elements()[n].end()).norm();
                        assert!(off < 0.1 * UM, "{kind} {seed} {left}: node {n} off by {off}");
                    }
                    same += 1;
                }
                // What lies farther along is not seen corner by corner.
                Ok(_) => {}
                Err(local::Vanishes(element)) => {
                    let touched = whole.outlines.iter().flat_map(|outline| &outline.origins);
                    let touched = touched.filter(|origin| **origin == Origin::Element(element)).count();
                    assert!(touched == 0 || !whole.unreached.is_empty(), "{kind} {seed} {left}: {element}");
                    vanished += 1;
                }
            }
        }
    }
    assert!(same > 100 && vanished > 50, "{same} {vanished}");
}
