//! What the wire cannot enter, checked against what it can: the offset told is the last that reaches.

use std::collections::BTreeSet;

use dripfeed::geometry::Path;
use dripfeed::geometry::offset::{Corners, Offset, Origin, Unreached, offset};

use crate::contours::{self, Dice};

/// A micron.
const UM: f64 = 1e-3;

#[test]
fn the_largest_offset_told_reaches_and_a_micron_more_does_not() {
    let mut judged = 0;
    for seed in 0..120 {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 5000).between(0.1, 1.0);
        for left in [by, -by] {
            let Ok(found) = offset(&path, left, Corners::Round) else { continue };
            let reached = touched(&found);
            for run in &found.unreached {
                let elements = elements(run, path.elements().len());
                // A throat is judged by its own test: its elements are touched on both sides of it.
                if elements.iter().any(|element| reached.contains(element)) {
                    continue;
                }
                judged += 1;
                let at = |by: f64| touched(&offset(&path, by * left.signum(), Corners::Round).unwrap());
                assert!(run.largest < by, "{kind} {seed} {run:?}");
                let under = at(run.largest - UM);
                assert!(
                    elements.iter().all(|element| under.contains(element)),
                    "{kind} {seed} {left} {run:?}"
                );
                let over = at(run.largest + UM);
                assert!(
                    !elements.iter().all(|element| over.contains(element)),
                    "{kind} {seed} {left} {run:?}"
                );
                assert!(path.distance(run.at) < 1e-9, "{kind} {seed} {run:?}");
            }
        }
    }
    assert!(judged > 150, "{judged}");
}

#[test]
fn no_element_is_lost_in_silence() {
    for seed in 0..120 {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 9000).between(0.1, 1.0);
        for left in [by, -by] {
            let Ok(found) = offset(&path, left, Corners::Round) else { continue };
            let reached = touched(&found);
            let told: BTreeSet<usize> =
                found.unreached.iter().flat_map(|run| elements(run, path.elements().len())).collect();
            for (n, element) in path.elements().iter().enumerate() {
                let stays = wire_misses(&found, &path, n) - by;
                if !reached.contains(&n) && !told.contains(&n) {
                    assert!(
                        stays < UM,
                        "{kind} {seed} {left}: element {n}, {} long, {stays}",
                        element.length()
                    );
                }
            }
        }
    }
}

#[test]
fn nothing_is_told_that_the_wire_reaches() {
    let mut told = 0;
    for seed in 0..200 {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 13_000).between(0.05, 1.0);
        for left in [by, -by] {
            let Ok(found) = offset(&path, left, Corners::Round) else { continue };
            for run in &found.unreached {
                told += 1;
                let stays = elements(run, path.elements().len())
                    .into_iter()
                    .flat_map(|n| (0..=200).map(move |step| (n, f64::from(step) / 200.0)))
                    .map(|(n, at)| path.elements()[n].at(at))
                    .map(|point| found.outlines.iter().map(|o| o.path.distance(point)).fold(9e9, f64::min))
                    .fold(0.0, f64::max);
                assert!(stays > by + 0.5 * UM, "{kind} {seed} {left}: {run:?}, {stays}");
            }
        }
    }
    assert!(told > 300, "{told}");
}

/// How far the middle of an element is from the wire.
fn wire_misses(found: &Offset, path: &Path, element: usize) -> f64 {
    let middle = path.elements()[element].at(0.5);
    found.outlines.iter().map(|outline| outline.path.distance(middle)).fold(f64::INFINITY, f64::min)
}

fn touched(found: &Offset) -> BTreeSet<usize> {
    let origins = found.outlines.iter().flat_map(|outline| &outline.origins);
    origins
        .filter_map(|origin| match origin {
            Origin::Element(n) => Some(*n),
            Origin::Corner(_) => None,
        })
        .collect()
}

fn elements(run: &Unreached, count: usize) -> Vec<usize> {
    let steps = (run.last + count - run.first) % count;
    (0..=steps).map(|n| (run.first + n) % count).collect()
}
