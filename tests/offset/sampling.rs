//! The oracle for any contour: points.
//!
//! Sound: every point of an outline lies at the offset from the contour and on the wire's side. Complete: every point
//! at the offset square beside the contour, or about a corner, that is nowhere nearer, lies on an outline.

use dripfeed::geometry::offset::{Corners, Impossible, Offset, offset};
use dripfeed::geometry::{Path, Point};

use crate::contours::{self, Dice};
use crate::measure::{distance, is_inside, samples};

/// A micron.
const UM: f64 = 1e-3;
const CONTOURS: u64 = 240;

#[test]
fn every_outline_of_any_contour_lies_at_the_offset_and_nothing_of_it_is_missing() {
    let (mut split, mut lost, mut gone, mut judged) = (0, 0, 0, 0);
    for seed in 0..CONTOURS {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 1000).between(0.03, 1.3);
        for (path, left) in [(path.clone(), by), (path.clone(), -by), (path.reversed(), by)] {
            let found = match offset(&path, left, Corners::Round) {
                Ok(found) => found,
                // A star may cross itself at a narrow ray; it is refused, not guessed at.
                Err(Impossible::MeetsItself(_)) => continue,
                Err(error) => panic!("{kind} {seed}: {error}"),
            };
            judged += 1;
            split += usize::from(found.outlines.len() > 1);
            lost += usize::from(!found.unreached.is_empty());
            gone += usize::from(found.outlines.is_empty());
            if let Err(what) = fault(&path, left, &found) {
                panic!("{kind} {seed} by {left}: {what}");
            }
        }
    }
    assert!(judged > 600 && split > 40 && lost > 200 && gone > 5, "{judged} {split} {lost} {gone}");
}

#[test]
fn the_oracle_sees_a_lost_outline_a_micron_and_the_wrong_side() {
    let (_, path) = contours::any(2);
    let right = offset(&path, 0.1, Corners::Round).unwrap();
    assert_eq!(fault(&path, 0.1, &right), Ok(()));
    let near = offset(&path, 0.1 + 1.5 * UM, Corners::Round).unwrap();
    assert!(fault(&path, 0.1, &near).is_err());
    let mut lost = right.clone();
    lost.outlines.clear();
    assert!(fault(&path, 0.1, &lost).is_err());
    let other = offset(&path, -0.1, Corners::Round).unwrap();
    assert!(fault(&path, 0.1, &other).is_err());
}

/// What is wrong with the offset of a closed contour.
pub(crate) fn fault(path: &Path, left: f64, found: &Offset) -> Result<(), String> {
    let by = left.abs();
    let inside = (left > 0.0) == (path.area() > 0.0);
    for outline in &found.outlines {
        if !outline.path.is_closed() {
            return Err("an outline is open".to_owned());
        }
        let steps = outline.path.elements().windows(2);
        if let Some(pair) = steps.into_iter().find(|pair| pair[0].end() != pair[1].start()) {
            return Err(format!("a gap at {}", pair[0].end()));
        }
        for element in outline.path.elements() {
            for (point, _) in samples(element, 12) {
                let off = distance(path, point) - by;
                if off.abs() > UM {
                    return Err(format!("{point} is off by {off}"));
                }
                if is_inside(path, point) != inside {
                    return Err(format!("{point} is on the wrong side"));
                }
            }
        }
    }
    for candidate in candidates(path, left) {
        let off = found.outlines.iter().map(|o| distance(&o.path, candidate)).fold(f64::INFINITY, f64::min);
        if off > UM {
            return Err(format!("{candidate} is missing by {off}"));
        }
    }
    Ok(())
}

/// Points the wire's centre must pass: at the offset from one place of the contour and nowhere nearer to any other.
fn candidates(path: &Path, left: f64) -> Vec<Point> {
    let by = left.abs();
    let inside = (left > 0.0) == (path.area() > 0.0);
    let mut found = Vec::new();
    for element in path.elements() {
        found.extend(
            samples(element, 16).into_iter().map(|(p, n)| Point::new(p.x + n.x * left, p.y + n.y * left)),
        );
        let corner = element.end();
        found.extend((0..24).map(|n| {
            let angle = std::f64::consts::TAU * n as f64 / 24.0;
            Point::new(corner.x + by * libm::cos(angle), corner.y + by * libm::sin(angle))
        }));
    }
    // What is nearer by less than a tenth of a micron is neither here nor there.
    found.retain(|&point| distance(path, point) > by - 1e-7 && is_inside(path, point) == inside);
    // An outline too small to be a path of the wire: all of it within a micron.
    found
}
