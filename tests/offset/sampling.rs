//! The oracle for any contour: points.
//!
//! Sound: every point of an outline lies at the offset from the contour and on the wire's side. Complete: every point
//! at the offset square beside the contour, or about a corner, that is nowhere nearer, lies on an outline.

use dripfeed::geometry::offset::{Corners, Impossible, Offset, Origin, offset};
use dripfeed::geometry::{Element, Path, Point};

use crate::contours::{self, Dice};
use crate::measure::{Inside, distance, samples};

/// A micron.
const UM: f64 = 1e-3;
const CONTOURS: u64 = 200;

#[test]
fn every_outline_of_any_contour_lies_at_the_offset_and_nothing_of_it_is_missing() {
    let (mut split, mut lost, mut gone, mut judged) = (0, 0, 0, 0);
    for seed in 0..CONTOURS {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 1000).between(0.03, 2.0);
        // Inside, outside, and inside again by the other sign.
        for (path, left) in [(path.clone(), by), (path.clone(), -by), (path.reversed(), -by)] {
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
    assert!(judged > 500 && split > 30 && lost > 200 && gone > 5, "{judged} {split} {lost} {gone}");
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

#[test]
fn arcs_keep_the_very_centres_of_the_contour_and_of_its_corners() {
    let (mut arcs, mut corners) = (0, 0);
    for seed in 0..CONTOURS {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 3000).between(0.03, 0.6);
        for left in [by, -by] {
            let Ok(found) = offset(&path, left, Corners::Round) else { continue };
            let ways = found.outlines.iter().flat_map(|o| o.path.elements().iter().zip(&o.origins));
            for (way, origin) in ways {
                let beside = path.elements()[origin.element()];
                match (origin, way, beside) {
                    (Origin::Element(_), Element::Line { .. }, Element::Line { .. }) => {}
                    (Origin::Element(_), Element::Arc { centre, .. }, Element::Arc { centre: own, .. }) => {
                        arcs += 1;
                        assert_eq!(*centre, own, "{kind} {seed} {left}");
                    }
                    (Origin::Corner(_), Element::Arc { centre, .. }, _) => {
                        corners += 1;
                        assert_eq!(*centre, beside.end(), "{kind} {seed} {left}");
                    }
                    other => panic!("{kind} {seed} {left}: {other:?}"),
                }
            }
        }
    }
    assert!(arcs > 1000 && corners > 300, "{arcs} {corners}");
}

#[test]
fn a_sharp_corner_never_comes_nearer_and_its_straights_are_tangents() {
    let mut sharper = 0;
    for seed in 0..CONTOURS {
        let (kind, path) = contours::any(seed);
        let by = Dice::new(seed + 5000).between(0.03, 1.0);
        for left in [by, -by] {
            let Ok(found) = offset(&path, left, Corners::Sharp { limit: 2.0 }) else { continue };
            for outline in &found.outlines {
                for (way, origin) in outline.path.elements().iter().zip(&outline.origins) {
                    for (point, _) in samples(way, 40) {
                        let off = distance(&path, point) - by;
                        assert!(off > -UM && off < by + UM, "{kind} {seed} {left}: {point} is off by {off}");
                        let own = path.elements()[origin.element()].distance(point);
                        assert!(own > by - UM && own < 2.0 * by + UM, "{kind} {seed} {left}: {own}");
                        sharper += usize::from(off > UM);
                    }
                }
            }
        }
    }
    assert!(sharper > 500, "{sharper}");
}

#[test]
fn ends_that_miss_their_circle_by_a_rounding_do_no_more_harm_than_that() {
    let rounded = |p: Point| Point::new((p.x * 1e3).round() / 1e3, (p.y * 1e3).round() / 1e3);
    let mut judged = 0;
    for seed in 0..CONTOURS {
        let (kind, path) = contours::any(seed);
        let elements = path.elements().iter().map(|element| match *element {
            Element::Line { start, end } => Element::Line { start: rounded(start), end: rounded(end) },
            Element::Arc { start, end, centre, sense } => {
                Element::Arc { start: rounded(start), end: rounded(end), centre: rounded(centre), sense }
            }
        });
        let near = Path::new(elements.collect()).unwrap();
        let by = Dice::new(seed + 7000).between(0.03, 0.6);
        for left in [by, -by] {
            let Ok(found) = offset(&near, left, Corners::Round) else { continue };
            judged += 1;
            for way in found.outlines.iter().flat_map(|o| o.path.elements()) {
                for (point, _) in samples(way, 8) {
                    let off = distance(&path, point) - by;
                    assert!(off.abs() < 2.5 * UM, "{kind} {seed} {left}: {point} is off by {off}");
                }
            }
        }
    }
    assert!(judged > 300, "{judged}");
}

/// What is wrong with the offset of a closed contour.
pub(crate) fn fault(path: &Path, left: f64, found: &Offset) -> Result<(), String> {
    let by = left.abs();
    let side = (left > 0.0) == (path.area() > 0.0);
    let inside = Inside::of(path);
    for outline in &found.outlines {
        if !outline.path.is_closed() {
            return Err("an outline is open".to_owned());
        }
        let steps = outline.path.elements().windows(2);
        if let Some(pair) = steps.into_iter().find(|pair| pair[0].end() != pair[1].start()) {
            return Err(format!("a gap at {}", pair[0].end()));
        }
        for element in outline.path.elements() {
            for (point, _) in samples(element, 8) {
                let off = distance(path, point) - by;
                if off.abs() > UM {
                    return Err(format!("{point} is off by {off}"));
                }
                if inside.has(point) != side {
                    return Err(format!("{point} is on the wrong side"));
                }
            }
        }
    }
    for candidate in candidates(path, left, &inside, side) {
        let off = found.outlines.iter().map(|o| distance(&o.path, candidate)).fold(f64::INFINITY, f64::min);
        if off > UM {
            return Err(format!("{candidate} is missing by {off}"));
        }
    }
    Ok(())
}

/// Points the wire's centre must pass: at the offset from one place of the contour and nowhere nearer to any other.
fn candidates(path: &Path, left: f64, inside: &Inside, side: bool) -> Vec<Point> {
    let by = left.abs();
    let mut found = Vec::new();
    for element in path.elements() {
        let beside = samples(element, 12).into_iter();
        found.extend(beside.map(|(p, n)| Point::new(p.x + n.x * left, p.y + n.y * left)));
        let corner = element.end();
        found.extend((0..24).map(|n| {
            let angle = std::f64::consts::TAU * n as f64 / 24.0;
            Point::new(corner.x + by * libm::cos(angle), corner.y + by * libm::sin(angle))
        }));
    }
    // What is nearer by less than a tenth of a nanometre is neither here nor there.
    found.retain(|&point| distance(path, point) > by - 1e-7 && inside.has(point) == side);
    found
}

#[test]
fn a_contour_that_crosses_itself_is_always_refused() {
    let mut crossed = 0;
    for seed in 0..300 {
        let mut dice = Dice::new(seed);
        let count = 4 + dice.up_to(8);
        let nodes: Vec<_> =
            (0..count).map(|_| Point::new(dice.between(-9.0, 9.0), dice.between(-9.0, 9.0))).collect();
        let cuts = |a: usize, b: usize| {
            let (p, q, r, s) = (nodes[a], nodes[(a + 1) % count], nodes[b], nodes[(b + 1) % count]);
            let turn =
                |p: Point, q: Point, r: Point| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0.0;
            turn(p, q, r) != turn(p, q, s) && turn(r, s, p) != turn(r, s, q)
        };
        let far = |a: usize, b: usize| b > a + 1 && (a > 0 || b + 1 < count);
        let crosses = (0..count).any(|a| (0..count).any(|b| far(a, b) && cuts(a, b)));
        let path = contours::filleted(&nodes, &vec![0.0; count]);
        for by in [0.001, 0.1, 1.0, -0.001, -0.1, -1.0] {
            let refused = matches!(offset(&path, by, Corners::Round), Err(Impossible::MeetsItself(_)));
            assert_eq!(refused, crosses, "{seed} by {by}");
        }
        crossed += usize::from(crosses);
    }
    assert!(crossed > 100 && crossed < 300, "{crossed}");
}
