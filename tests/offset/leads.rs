//! Runs that never close: with arcs to lead in and out, with an overcut, or with a tab left standing.
//!
//! They are offset corner by corner, as a control does it. What a control would cut into without a word must be said.

use std::collections::BTreeMap;

use dripfeed::compensation::{Compensated, Fate, Warning};
use dripfeed::formats::ReadError;
use dripfeed::geometry::offset::{Corners, Origin, offset};
use dripfeed::geometry::{Element, Path, Point, Sense, Vector};
use dripfeed::motion::runs::ContourError;
use dripfeed::motion::{Act, Motion, Offset, Side, Travel};
use dripfeed::place::Spot;

use crate::compensation::begun_on_a_straight;
use crate::contours::{self, Dice};
use crate::measure::{distance, distance_from, samples};

/// A micron.
const UM: f64 = 1e-3;

/// A straight move with the offset on, the elements, and a straight move with it off.
fn program(elements: &[Element], side: Side, by: f64) -> Vec<Result<Motion, ReadError>> {
    let (start, end) = (elements[0].start(), elements[elements.len() - 1].end());
    let hole = start + elements[0].heading_at_start() * -3.0;
    let said = |block, act| Ok(Motion { act, block, spot: Spot { byte: 0, line: block, column: 1 } });
    let cut =
        |block, element| said(block, Act::Move { travel: Travel::Cut, element, upper: None, flag: None });
    let mut all = vec![
        said(1, Act::Offset(Offset::On { side, distance: Some(by), register: None })),
        cut(1, Element::Line { start: hole, end: start }),
    ];
    all.extend((2..).zip(elements).map(|(block, element)| cut(block, *element)));
    let last = elements.len() as u64 + 2;
    all.push(said(last, Act::Offset(Offset::Off)));
    all.push(cut(last, Element::Line { start: end, end: hole }));
    all
}

type Made = (Result<Vec<Motion>, ContourError>, Vec<Warning>);

fn wire(elements: &[Element], side: Side, by: f64) -> Made {
    let motions = program(elements, side, by).into_iter();
    let mut compensated = Compensated::new(motions, BTreeMap::new(), Corners::Round);
    let made = compensated.by_ref().collect();
    (made, compensated.take_warnings())
}

/// The ways beside the elements.
fn ways(made: &[Motion], elements: usize) -> Vec<Element> {
    made.iter()
        .filter(|motion| motion.block > 1 && motion.block < elements as u64 + 2)
        .filter_map(|motion| match motion.act {
            Act::Move { element, .. } => Some(element),
            _ => None,
        })
        .collect()
}

/// Quarters of a circle on the wire's side, onto a contour and off it, tangent to it at its start.
fn with_arcs(contour: &Path, side: Side, radius: f64) -> Vec<Element> {
    let first = &contour.elements()[0];
    let (at, ahead) = (first.start(), first.heading_at_start());
    let turn = if side == Side::Left { 1.0 } else { -1.0 };
    let sideways = turned(ahead) * turn;
    let sense = if side == Side::Left { Sense::CounterClockwise } else { Sense::Clockwise };
    let centre = at + sideways * radius;
    let lead_in = Element::Arc { start: centre - ahead * radius, end: at, centre, sense };
    let lead_out = Element::Arc { start: at, end: centre + ahead * radius, centre, sense };
    let mut all = vec![lead_in];
    all.extend(contour.elements());
    all.push(lead_out);
    all
}

fn turned(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

#[test]
fn with_arcs_to_lead_in_and_out_the_wire_keeps_its_distance_or_the_program_is_refused() {
    let (mut done, mut refused) = (0, 0);
    for seed in 0..200 {
        let (kind, path) = contours::any(seed);
        let path = begun_on_a_straight(&path);
        let by = Dice::new(seed + 177).between(0.02, 0.4);
        for side in [Side::Left, Side::Right] {
            let left = if side == Side::Left { by } else { -by };
            let Ok(whole) = offset(&path, left, Corners::Round) else { continue };
            let elements = with_arcs(&path, side, by + 0.5);
            let (made, warnings) = wire(&elements, side, by);
            assert!(warnings.is_empty(), "{kind} {seed} {side:?}: {warnings:?}");
            match made {
                Ok(made) => {
                    done += 1;
                    assert!(whole.unreached.is_empty(), "{kind} {seed} {side:?}: {:?}", whole.unreached);
                    let ways = ways(&made, elements.len());
                    // Where the arcs lead in the waste is nothing to do with the contour.
                    let beside = &ways[1..ways.len() - 1];
                    for point in beside.iter().flat_map(|way| samples(way, 9)).map(|(point, _)| point) {
                        let off = distance(&path, point) - by;
                        assert!(off.abs() < UM, "{kind} {seed} {side:?} by {by}: off by {off}");
                    }
                    for way in &whole.outlines[0].path.elements()[1..] {
                        let off = distance_from(&ways, way.start());
                        assert!(off < UM, "{kind} {seed} {side:?}: {} is missed by {off}", way.start());
                    }
                }
                Err(error) => {
                    refused += 1;
                    let ContourError::Contour { block, .. } = error else { panic!("{error}") };
                    let element = block as usize - 3;
                    let count = path.elements().len();
                    // The element is one of a part not reached, or next to it; or so little of it is not that no one is told.
                    let is_told = whole.unreached.iter().any(|part| {
                        let steps = (part.last + count - part.first) % count;
                        (element + count + 1 - part.first) % count <= steps + 2
                    });
                    let mut origins = whole.outlines.iter().flat_map(|outline| &outline.origins);
                    let missed = is_told || !origins.any(|origin| *origin == Origin::Element(element));
                    assert!(missed, "{kind} {seed} {side:?}: {error} in {block}: {:?}", whole.unreached);
                }
            }
        }
    }
    assert!(done > 100 && refused > 100, "{done} {refused}");
}

#[test]
fn a_neck_that_no_corner_shows_is_refused_with_the_offset_that_would_pass() {
    let p = Point::new;
    let nodes = [
        (2.0, 0.0),
        (4.0, 0.0),
        (4.0, 1.8),
        (8.0, 1.8),
        (8.0, 0.0),
        (12.0, 0.0),
        (12.0, 4.0),
        (8.0, 4.0),
        (8.0, 2.2),
        (4.0, 2.2),
        (4.0, 4.0),
        (0.0, 4.0),
        (0.0, 0.0),
        (2.0, 0.0),
    ];
    let line =
        |pair: &[(f64, f64)]| Element::Line { start: p(pair[0].0, pair[0].1), end: p(pair[1].0, pair[1].1) };
    let contour = Path::new(nodes.windows(2).map(line).collect()).unwrap();
    let (made, _) = wire(&with_arcs(&contour, Side::Left, 1.0), Side::Left, 0.3);
    let Err(ContourError::Contour { message, block, help, .. }) = made else { panic!("{made:?}") };
    assert_eq!(message, "the wire cannot enter the contour here; an offset of at most 0.2000 mm would");
    // Blocks 1 and 2 lead in; the neck's lower side is the third of the contour.
    assert_eq!(block, 5);
    assert!(help.contains("straight"), "{help}");
    let (made, warnings) = wire(&with_arcs(&contour, Side::Left, 1.0), Side::Left, 0.199);
    assert!(made.is_ok() && warnings.is_empty());
}

#[test]
fn a_run_with_a_tab_left_standing_tells_what_it_cuts_into_and_nothing_else() {
    let (mut clean, mut told) = (0, 0);
    for seed in 0..400 {
        // Every other one a dumbbell: its neck shows at no corner.
        let (kind, path) = contours::any(if seed % 2 == 0 { 2 * seed + 2 } else { seed });
        let path = begun_on_a_straight(&path);
        let by = Dice::new(seed + 277).between(0.02, 0.8);
        // The last piece of straight stays.
        let elements = &path.elements()[..path.elements().len() - 1];
        for side in [Side::Left, Side::Right] {
            let (made, warnings) = wire(elements, side, by);
            let Ok(made) = made else { continue };
            let ways = ways(&made, elements.len());
            let nearest = ways
                .iter()
                .flat_map(|way| samples(way, 60))
                .map(|(point, _)| distance_from(elements, point))
                .fold(f64::INFINITY, f64::min);
            if warnings.is_empty() {
                clean += 1;
                assert!(nearest > by - UM, "{kind} {seed} {side:?} by {by}: {nearest}");
            } else {
                told += 1;
                assert!(warnings.iter().all(|warning| warning.fate == Fate::CutInto), "{kind} {seed}");
                let text = warnings[0].to_string();
                assert!(text.contains(": the wire cuts into the contour at X"), "{text}");
                assert!(nearest < by - 0.1 * UM, "{kind} {seed} {side:?} by {by}: {nearest} {text}");
            }
        }
    }
    assert!(clean > 200 && told > 8, "{clean} {told}");
}
