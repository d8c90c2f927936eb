use super::*;
use crate::geometry::Vector;
use crate::geometry::offset::{Corners, offset};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(start: Point, end: Point) -> Element {
    Element::Line { start, end }
}

/// A wedge that turns by an angle at (10, 0), run along X and then to the left, set off to its right.
fn wedge(turn: f64, limit: f64) -> Outline {
    let corner = p(10.0, 0.0);
    let far = corner + Vector::new(libm::cos(turn), libm::sin(turn)) * 10.0;
    let path = Path::new(vec![line(p(0.0, 0.0), corner), line(corner, far)]).unwrap();
    offset(&path, -0.5, Corners::Sharp { limit }).unwrap().outlines.remove(0)
}

#[test]
fn the_point_of_a_corner_lies_where_both_straights_meet_and_stays_within_the_limit() {
    for turn in [0.2, 0.7, 1.2, 1.57, 2.0, 2.6] {
        // The offset over the cosine of half the turn, on the line that halves the corner.
        let far = 1.0 / libm::cos(turn / 2.0);
        let sharp = wedge(turn, far + 1e-9);
        let [first, second] = sharp.path.elements() else { panic!("{turn}: {sharp:?}") };
        let half = turn / 2.0 - std::f64::consts::FRAC_PI_2;
        let tip = p(10.0, 0.0) + Vector::new(libm::cos(half), libm::sin(half)) * (0.5 * far);
        assert!((first.end() - tip).norm() < 1e-9 && (second.start() - tip).norm() < 1e-9, "{turn}");
        assert!((first.start() - p(0.0, -0.5)).norm() < 1e-9);
        assert_eq!(sharp.origins, [Origin::Element(0), Origin::Element(1)]);
        let round = wedge(turn, far - 1e-9);
        assert!(matches!(round.path.elements()[1], Element::Arc { .. }), "{turn}");
        assert_eq!(round.origins[1], Origin::Corner(0));
    }
}

#[test]
fn beside_an_arc_the_point_has_a_straight_of_its_own() {
    // A half disc on its chord: corners between a line and an arc, a right angle each.
    let disc = Path::new(vec![
        line(p(-2.0, 0.0), p(2.0, 0.0)),
        Element::Arc {
            start: p(2.0, 0.0),
            end: p(-2.0, 0.0),
            centre: p(0.0, 0.0),
            sense: crate::geometry::Sense::CounterClockwise,
        },
    ])
    .unwrap();
    for first in [0, 1] {
        let path = disc.clone().begun_at(first);
        let outline = offset(&path, -0.5, Corners::Sharp { limit: 1.5 }).unwrap().outlines.remove(0);
        // A line to both points, and from each of them half a millimetre up to the arc.
        let ways = outline.path.elements();
        assert_eq!(ways.len(), 4, "{ways:?}");
        let lengths = |wanted: f64| ways.iter().filter(|way| (way.length() - wanted).abs() < 1e-9).count();
        assert_eq!((lengths(5.0), lengths(0.5), lengths(2.5 * std::f64::consts::PI)), (1, 2, 1), "{ways:?}");
        for tip in [p(2.5, -0.5), p(-2.5, -0.5)] {
            assert!(ways.iter().any(|way| (way.end() - tip).norm() < 1e-9), "{tip}");
        }
        assert!(outline.path.is_closed());
        let corners = outline.origins.iter().filter(|origin| matches!(origin, Origin::Corner(_))).count();
        assert_eq!(corners, 2, "{:?}", outline.origins);
    }
}

#[test]
fn corners_of_a_polygon_are_all_sharp_wherever_it_begins() {
    let count = 5;
    let at = |n: usize| {
        let angle = n as f64 * std::f64::consts::TAU / count as f64;
        p(3.0 * libm::cos(angle), 3.0 * libm::sin(angle))
    };
    let polygon = Path::new((0..count).map(|n| line(at(n), at((n + 1) % count))).collect()).unwrap();
    for first in 0..count {
        let path = polygon.clone().begun_at(first);
        let outline = offset(&path, -0.4, Corners::Sharp { limit: 1.5 }).unwrap().outlines.remove(0);
        assert_eq!(outline.path.elements().len(), count);
        // A larger polygon about the same centre: the apothem grows by the offset.
        let apothem = 3.0 * libm::cos(std::f64::consts::PI / count as f64);
        let circumradius = 3.0 * (apothem + 0.4) / apothem;
        for way in outline.path.elements() {
            assert!((way.start().coords.norm() - circumradius).abs() < 1e-9);
        }
        let origins: Vec<usize> = outline.origins.iter().map(|origin| origin.element()).collect();
        assert_eq!(origins, (0..count).collect::<Vec<_>>());
    }
}

#[test]
fn a_corner_arc_that_something_else_cut_short_stays_round() {
    // A corner whose wire is stopped by a wall: the arc has no tangent in common with the way along the wall.
    let path = Path::new(vec![
        line(p(0.0, 0.0), p(10.0, 0.0)),
        line(p(10.0, 0.0), p(10.0, 5.0)),
        line(p(10.0, 5.0), p(10.7, 5.0)),
        line(p(10.7, 5.0), p(10.7, -5.0)),
    ])
    .unwrap();
    let found = offset(&path, -0.5, Corners::Sharp { limit: 1.5 }).unwrap();
    for outline in &found.outlines {
        for (way, origin) in outline.path.elements().iter().zip(&outline.origins) {
            if *origin == Origin::Corner(0) {
                let Element::Arc { centre, .. } = *way else { panic!("{way:?}") };
                assert_eq!(centre, p(10.0, 0.0));
            }
            // Nowhere nearer to the contour than the wire may be.
            for n in 0..=50 {
                let point = way.at(f64::from(n) / 50.0);
                let near =
                    path.elements().iter().map(|wall| wall.distance(point)).fold(f64::INFINITY, f64::min);
                assert!(near > 0.4999, "{way:?} {near}");
            }
        }
    }
}

#[test]
fn a_straight_is_free_as_far_as_the_wire_keeps_its_distance() {
    let wall = Path::new(vec![line(p(0.0, 0.0), p(10.0, 0.0)), line(p(10.0, 0.0), p(10.0, 10.0))]).unwrap();
    for left in [0.5, -0.5] {
        let source = Source::new(&wall, left);
        for (from, to, wanted) in [
            (p(1.0, 0.5), p(9.0, 0.5), true),
            (p(1.0, 0.499_95), p(9.0, 0.499_95), true),
            (p(1.0, 0.499_8), p(9.0, 0.499_8), false),
            (p(1.0, 0.6), p(9.0, 0.3), false),
            (p(1.0, 0.3), p(9.0, 0.6), false),
            (p(1.0, 3.0), p(1.0, -3.0), false),
            (p(-0.5, -3.0), p(-0.5, 3.0), true),
            (p(-0.49, -3.0), p(-0.49, 3.0), false),
            (p(10.5, 0.0), p(10.5, 10.0), true),
            (p(10.3, 5.0), p(12.0, 5.0), false),
            (p(12.0, 5.0), p(10.3, 5.0), false),
            (p(40.0, 40.0), p(50.0, 40.0), true),
        ] {
            assert_eq!(source.is_free(from, to), wanted, "{from} {to} {left}");
        }
    }
    // A post beside the way, met only half-way along it.
    let post = Path::new(vec![line(p(5.0, 0.4), p(5.0, 4.0))]).unwrap();
    let source = Source::new(&post, 0.5);
    assert!(!source.is_free(p(4.0, 0.0), p(6.0, 0.0)) && source.is_free(p(4.0, -0.1), p(6.0, -0.1)));
    assert!(!source.is_free(p(4.6, 0.0), p(5.4, 0.0)));
}

/// The arc of half a millimetre about a corner on the wire's right, from one angle to another, degrees.
fn about(corner: Point, from: f64, to: f64) -> Element {
    let at = |angle: f64| {
        let angle = angle.to_radians();
        corner + Vector::new(libm::cos(angle), libm::sin(angle)) * 0.5
    };
    Element::Arc {
        start: at(from),
        end: at(to),
        centre: corner,
        sense: crate::geometry::Sense::CounterClockwise,
    }
}

#[test]
fn a_corner_arc_at_the_end_of_an_open_outline_has_no_neighbour_to_run_into() {
    use Origin::{Corner, Element as Beside};
    // The last way of the one runs as its first arc begins, the first way of the other as its last arc ends.
    let (o, b) = (p(0.0, 0.0), p(0.0, 4.5));
    let contour = vec![line(p(-3.0, 0.0), o), line(o, b), line(b, p(3.0, 4.5))];
    let first = about(o, -90.0, 0.0);
    let ways = vec![first, line(first.end(), p(0.5, 4.0)), line(p(0.5, 4.0), p(3.0, 4.0))];
    let begins = (contour, ways, vec![Corner(0), Beside(1), Beside(2)]);
    let (b, c) = (p(0.0, 3.0), p(3.0, 3.0));
    let contour = vec![line(o, b), line(b, c), line(c, p(3.0, 6.0))];
    let last = about(c, -90.0, 0.0);
    let ways = vec![line(p(0.5, 0.0), p(0.5, 2.5)), line(p(0.5, 2.5), last.start()), last];
    let ends = (contour, ways, vec![Beside(0), Beside(1), Corner(1)]);
    for (contour, ways, origins) in [begins, ends] {
        let source = Source::new(&Path::new(contour).unwrap(), -0.5);
        let outline = Outline { path: Path::new(ways).unwrap(), origins };
        assert_eq!(sharpened(outline.clone(), &source, 1.5), outline);
    }
}

#[test]
fn a_corner_arc_stays_where_either_of_its_neighbours_meets_it_at_an_angle() {
    let corner = p(10.0, 0.0);
    let contour = Path::new(vec![line(p(0.0, 0.0), corner), line(corner, p(10.0, 9.0))]).unwrap();
    let source = Source::new(&contour, -0.5);
    for (from, to, stays) in
        [(-90.0, 0.0, false), (-80.0, 0.0, true), (-90.0, -10.0, true), (-90.01, 0.0, true)]
    {
        let arc = about(corner, from, to);
        let ways = vec![
            line(arc.start() - Vector::new(8.0, 0.0), arc.start()),
            arc,
            line(arc.end(), arc.end() + Vector::new(0.0, 8.0)),
        ];
        let origins = vec![Origin::Element(0), Origin::Corner(0), Origin::Element(1)];
        let outline = Outline { path: Path::new(ways).unwrap(), origins };
        let found = sharpened(outline.clone(), &source, 1.5);
        assert_eq!(found == outline, stays, "{from} {to}: {found:?}");
    }
}
