use super::*;
use crate::geometry::offset::{Corners, offset};
use crate::geometry::{Sense, Vector};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(start: Point, end: Point) -> Element {
    Element::Line { start, end }
}

fn on(centre: Point, radius: f64, angle: f64) -> Point {
    centre + Vector::new(libm::cos(angle), libm::sin(angle)) * radius
}

#[test]
fn a_point_beside_an_element_stands_at_a_fraction_of_its_way() {
    let element = line(p(1.0, 1.0), p(5.0, 4.0));
    for (fraction, aside, wanted) in
        [(0.3, 2.0, 0.3), (0.3, -7.0, 0.3), (0.0, 1.0, 0.0), (-0.2, 1.0, 0.0), (1.4, 1.0, 1.0)]
    {
        let point = p(1.0, 1.0) + Vector::new(4.0, 3.0) * fraction + Vector::new(-0.6, 0.8) * aside;
        assert!((fraction_beside(&element, point) - wanted).abs() < 1e-12, "{fraction} {aside}");
    }
    let centre = p(2.0, -1.0);
    for (sense, sign) in [(Sense::CounterClockwise, 1.0), (Sense::Clockwise, -1.0)] {
        for from in [0.0, 1.0, 5.0] {
            let whole = 2.4;
            let (start, end) = (on(centre, 3.0, from), on(centre, 3.0, from + whole * sign));
            let arc = Element::Arc { start, end, centre, sense };
            // Behind the end as far as the middle of what is not the arc it is the end, from there on the start.
            let rest = std::f64::consts::TAU - whole;
            for (turned, wanted) in [
                (0.6, 0.25),
                (1.2, 0.5),
                (2.399, 2.399 / 2.4),
                (2.4 + 0.1, 1.0),
                (2.4 + 0.49 * rest, 1.0),
                (2.4 + 0.51 * rest, 0.0),
                (-0.1, 0.0),
                (-1e-12, 0.0),
                (1e-12, 0.0),
            ] {
                for radius in [0.5, 3.0, 9.0] {
                    let found = fraction_beside(&arc, on(centre, radius, from + turned * sign));
                    assert!((found - wanted).abs() < 1e-9, "{sense:?} {from} {turned}: {found}");
                }
            }
        }
        let start = on(centre, 3.0, 0.4);
        let circle = Element::Arc { start, end: start, centre, sense };
        let quarter = on(centre, 1.0, 0.4 + 0.5 * std::f64::consts::PI * sign);
        assert!((fraction_beside(&circle, quarter) - 0.25).abs() < 1e-9);
        assert!(fraction_beside(&circle, on(centre, 1.0, 0.4)) < 1e-12);
    }
}

#[test]
fn the_ends_of_an_open_contour_that_no_wire_reaches_are_told() {
    // A hook that bends back over its own beginning, 0.4 apart: the wire of 0.5 passes neither.
    let path = Path::new(vec![
        line(p(0.0, 0.0), p(10.0, 0.0)),
        line(p(10.0, 0.0), p(10.0, 0.4)),
        line(p(10.0, 0.4), p(4.0, 0.4)),
    ])
    .unwrap();
    let found = offset(&path, 0.5, Corners::Round).unwrap();
    let told: Vec<_> = found.unreached.iter().map(|run| (run.first, run.last)).collect();
    assert!(told.iter().any(|&(first, last)| first <= 1 && last >= 1), "{told:?}");
    for run in &found.unreached {
        assert!(run.largest < 0.5 && run.largest > 0.0, "{run:?}");
        // What is told stands on the contour.
        let off = path.elements().iter().map(|way| way.distance(run.at)).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-9, "{run:?}");
    }
    let wide = offset(&path, 0.19, Corners::Round).unwrap();
    assert!(wide.unreached.is_empty() && wide.filled_corners == 2, "{wide:?}");
}

#[test]
fn corners_that_the_wire_fills_are_counted_where_they_are_inside_and_sharp() {
    // A room of six walls with one corner that juts in: five inside corners, one outside.
    let nodes = [(0.0, 0.0), (9.0, 0.0), (9.0, 5.0), (4.0, 5.0), (4.0, 9.0), (0.0, 9.0)];
    let at = |n: usize| p(nodes[n % 6].0, nodes[n % 6].1);
    let path = Path::new((0..6).map(|n| line(at(n), at(n + 1))).collect()).unwrap();
    for first in 0..6 {
        let path = path.clone().begun_at(first);
        let inside = offset(&path, 0.5, Corners::Round).unwrap();
        assert_eq!((inside.filled_corners, inside.unreached.len()), (5, 0), "{first}");
        let outside = offset(&path, -0.5, Corners::Round).unwrap();
        assert_eq!((outside.filled_corners, outside.unreached.len()), (1, 0), "{first}");
    }
    // Turned by so little that less than a micron stays, a corner is none: 0.5 / cos of half the turn less 0.5.
    for (turn, wanted) in [(0.12, 0), (0.14, 1)] {
        let far = p(10.0, 0.0) + Vector::new(libm::cos(turn), libm::sin(turn)) * 10.0;
        let bent = Path::new(vec![line(p(0.0, 0.0), p(10.0, 0.0)), line(p(10.0, 0.0), far)]).unwrap();
        assert_eq!(offset(&bent, 0.5, Corners::Round).unwrap().filled_corners, wanted, "{turn}");
    }
}

#[test]
fn a_slot_over_the_contours_beginning_is_told_from_its_last_element_to_its_first() {
    let nodes = [
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.9),
        (5.0, 4.9),
        (5.0, 5.1),
        (10.0, 5.1),
        (10.0, 10.0),
        (0.0, 10.0),
    ];
    let at = |n: usize| p(nodes[n % 8].0, nodes[n % 8].1);
    let path = Path::new((0..8).map(|n| line(at(n), at(n + 1))).collect()).unwrap();
    for first in 0..8 {
        let path = path.clone().begun_at(first);
        let found = offset(&path, -0.15, Corners::Round).unwrap();
        let [slot] = found.unreached[..] else { panic!("{first}: {:?}", found.unreached) };
        let renumbered = |n: usize| (n + 8 - first) % 8;
        assert_eq!((slot.first, slot.last), (renumbered(2), renumbered(4)), "{first}");
        assert!((slot.largest - 0.1).abs() < 1e-6 && (slot.at - p(5.0, 5.0)).norm() < 1e-6, "{slot:?}");
    }
}

/// Two bends with a short way between them, which the wire of 0.5 passes over: it turns once, off the middle by
/// 0.5 (1 / cos of half the turn - 1) less the sagitta of the short way. Below a micron nothing is told.
#[test]
fn a_short_way_between_two_bends_is_told_where_more_than_a_micron_stays() {
    for (bend, wanted) in [(0.04, 0), (0.12, 1)] {
        let along = |angle: f64, length: f64| Vector::new(libm::cos(angle), libm::sin(angle)) * length;
        let short = 0.5 * bend * 0.6;
        let second = p(10.0, 0.0) + along(bend, short);
        let path = Path::new(vec![
            line(p(0.0, 0.0), p(10.0, 0.0)),
            line(p(10.0, 0.0), second),
            line(second, second + along(2.0 * bend, 10.0)),
        ])
        .unwrap();
        let found = offset(&path, 0.5, Corners::Round).unwrap();
        assert_eq!(found.unreached.len(), wanted, "{bend}: {:?}", found.unreached);
        if let [run] = found.unreached[..] {
            assert_eq!((run.first, run.last), (1, 1), "{run:?}");
        }
    }
}

/// Two rooms with a passage 0.6 high between them: the wire of 0.5 cuts both, and a stretch of the floor they share is
/// told though the wire runs beside it before and behind; 0.3 passes.
#[test]
fn a_stretch_of_one_wall_is_told_where_it_is_run_beside_on_both_its_sides() {
    let nodes =
        [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (6.0, 4.0), (6.0, 0.6), (4.0, 0.6), (4.0, 4.0), (0.0, 4.0)];
    let at = |n: usize| p(nodes[n % 8].0, nodes[n % 8].1);
    let path = Path::new((0..8).map(|n| line(at(n), at(n + 1))).collect()).unwrap();
    let found = offset(&path, 0.5, Corners::Round).unwrap();
    assert_eq!(found.outlines.len(), 2);
    let floor: Vec<_> = found.unreached.iter().filter(|run| (run.first, run.last) == (0, 0)).collect();
    let [floor] = floor[..] else { panic!("{:?}", found.unreached) };
    assert!((floor.at - p(5.0, 0.0)).norm() < 1e-6 && (floor.largest - 0.3).abs() < 1e-6, "{floor:?}");
    assert!(offset(&path, 0.29, Corners::Round).unwrap().unreached.is_empty());
}

/// A wedge whose tip stands before a corner parts the room in two: what both rooms lack of the corner's walls is told,
/// and is no corner that one wire fills.
#[test]
fn a_corner_that_lies_between_two_outlines_is_told() {
    for tip in [(0.5, 0.5), (0.45, 0.6), (0.65, 0.42)] {
        let nodes = [(0.0, 0.0), (10.0, 0.0), (10.0, 9.0), tip, (9.0, 20.0), (0.0, 20.0)];
        let at = |n: usize| p(nodes[n % 6].0, nodes[n % 6].1);
        let path = Path::new((0..6).map(|n| line(at(n), at(n + 1))).collect()).unwrap();
        for first in 0..6 {
            let found = offset(&path.clone().begun_at(first), 0.4, Corners::Round).unwrap();
            assert_eq!(found.outlines.len(), 2);
            let [last, next] = [5, 0].map(|n: usize| (n + 6 - first) % 6);
            let corner = found.unreached.iter().find(|run| (run.first, run.last) == (last, next));
            let corner = corner.unwrap_or_else(|| panic!("{first}: {:?}", found.unreached));
            // As far as the wires come to the corner on either wall; the middle is as far from both.
            let nearest = |element: usize, along: fn(Point) -> f64| {
                let ways = found.outlines.iter().flat_map(|o| o.path.elements().iter().zip(&o.origins));
                let beside = ways.filter(|(_, origin)| **origin == Origin::Element(element));
                beside.map(|(way, _)| along(way.start()).min(along(way.end()))).fold(f64::INFINITY, f64::min)
            };
            let (down, right) = (nearest(last, |p| p.y), nearest(next, |p| p.x));
            let half = (down - right) / 2.0;
            let middle = if half > 0.0 { p(0.0, half) } else { p(-half, 0.0) };
            assert!((corner.at - middle).norm() < 1e-6, "{corner:?} {middle:?}");
        }
    }
}
