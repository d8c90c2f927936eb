//! shapely against the offsets of outlines.
//!
//! Its buffers are made of many short lines, by another algorithm and other people. Random contours that no one drew by
//! hand go to it, non-convex and with arcs, inside and outside, with round corners and with sharp ones; so do outlines
//! that come apart and lose features.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::io::Write as _;
use std::process::Stdio;

use dripfeed::geometry::offset::{Corners, Impossible, Offset, offset};
use dripfeed::geometry::{Element, Path, Sense};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::contours::{self, Dice};
use crate::python;

/// What shapely makes of a case: of ours first, of its own second where there are two.
#[derive(Debug, Deserialize)]
struct Judged {
    valid: bool,
    areas: [f64; 2],
    /// Empty where nothing is left.
    extents: [Vec<f64>; 2],
    pieces: [[usize; 2]; 2],
    apart: f64,
    length: f64,
    off: f64,
    missed: f64,
    farthest: f64,
}

struct Case {
    name: String,
    path: Path,
    left: f64,
    found: Offset,
    mitre: f64,
}

fn element(element: &Element) -> Value {
    let (start, end) = (element.start(), element.end());
    match *element {
        Element::Line { .. } => json!([start.x, start.y, end.x, end.y]),
        Element::Arc { centre, sense, .. } => {
            let sense = if sense == Sense::CounterClockwise { 1 } else { -1 };
            json!([start.x, start.y, end.x, end.y, centre.x, centre.y, sense])
        }
    }
}

fn elements(path: &Path) -> Vec<Value> {
    path.elements().iter().map(element).collect()
}

/// Asks shapely about counter-clockwise contours.
fn shapely(cases: &[Case]) -> Vec<Judged> {
    let cases: Vec<Value> = cases
        .iter()
        .map(|case| {
            let outlines: Vec<_> = case.found.outlines.iter().map(|outline| elements(&outline.path)).collect();
            json!({"contour": elements(&case.path), "outlines": outlines, "by": -case.left, "mitre": case.mitre})
        })
        .collect();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/peers/offset.py");
    let mut child = python()
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("a Python with shapely");
    child.stdin.take().unwrap().write_all(&serde_json::to_vec(&cases).unwrap()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).unwrap()
}

fn cases(seeds: std::ops::Range<u64>, widest: f64, mitre: f64) -> Vec<Case> {
    let mut cases = Vec::new();
    for seed in seeds {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 4000).between(0.03, widest);
        for left in [by, -by] {
            let corners = if mitre > 0.0 { Corners::Sharp { limit: mitre } } else { Corners::Round };
            let found = match offset(&path, left, corners) {
                Ok(found) => found,
                Err(Impossible::MeetsItself(_)) => continue,
                Err(error) => panic!("{kind} {seed}: {error}"),
            };
            let name = format!("{kind} {seed} by {left:.4}");
            cases.push(Case { name, path: path.clone(), left, found, mitre });
        }
    }
    cases
}

/// A micron.
const UM: f64 = 1e-3;

fn assert_agree(cases: &[Case]) {
    for (case, judged) in cases.iter().zip(shapely(cases)) {
        let name = &case.name;
        assert!(judged.valid, "{name} meets itself");
        assert_eq!(judged.pieces[0], judged.pieces[1], "{name}: {judged:?}");
        // Tips of sharp corners are farther.
        assert!(judged.off < UM || case.mitre > 0.0, "{name}: {judged:?}");
        assert!(judged.missed < UM, "{name}: {judged:?}");
        // shapely simplifies what it buffers, by up to a hundredth of the distance.
        let apart = UM.max(0.01 * case.left.abs());
        assert!(judged.farthest < apart, "{name}: {judged:?}");
        let [ours, theirs] = judged.areas;
        assert!((ours - theirs).abs() <= 2e-4 * judged.length + 1e-9, "{name}: {judged:?}");
        assert!(judged.apart <= 2e-4 * judged.length + 1e-9, "{name}: {judged:?}");
        let [ours, theirs] = &judged.extents;
        assert_eq!(ours.len(), theirs.len(), "{name}: {judged:?}");
        assert!(ours.iter().zip(theirs).all(|(a, b)| (a - b).abs() < apart), "{name}: {judged:?}");
    }
}

#[test]
fn shapely_finds_the_same_outlines_on_both_sides_of_any_contour() {
    let cases = cases(0..160, 2.0, 0.0);
    let split = cases.iter().filter(|case| case.found.outlines.len() > 1).count();
    let lost = cases.iter().filter(|case| !case.found.unreached.is_empty()).count();
    let gone = cases.iter().filter(|case| case.found.outlines.is_empty()).count();
    assert!(
        cases.len() > 250 && split > 15 && lost > 100 && gone > 1,
        "{} {split} {lost} {gone}",
        cases.len()
    );
    assert_agree(&cases);
}

#[test]
fn shapely_finds_the_same_sharp_corners() {
    // At the mouth of what the wire cannot enter arcs meet, not corners; shapely has its corners cover the mouth.
    let mut cases = cases(1000..1160, 0.4, 60.0);
    cases.retain(|case| case.found.unreached.is_empty());
    assert!(cases.len() > 80, "{}", cases.len());
    assert_agree(&cases);
}

#[test]
fn shapely_sees_an_outline_that_is_two_microns_off() {
    let mut cases = cases(2..3, 0.1, 0.0);
    let case = &mut cases[0];
    case.found = offset(&case.path, case.left + 2.0 * UM, Corners::Round).unwrap();
    let judged = shapely(&cases);
    assert!(judged[0].off > 1.5 * UM && judged[0].missed > 1.5 * UM && judged[1].off < UM, "{judged:?}");
}
