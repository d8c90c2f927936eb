use super::*;
use crate::geometry::Path;
use crate::geometry::offset::source::Bend;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(start: Point, end: Point) -> Element {
    Element::Line { start, end }
}

fn source(elements: Vec<Element>, left: f64) -> (Source, Path) {
    let path = Path::new(elements).unwrap();
    (Source::new(&path, left), path)
}

fn straight(start: Point, end: Point) -> Piece {
    Piece { element: 0, start, end, length: (end - start).norm(), bend: None }
}

fn bent(centre: Point, radius: f64, from: f64, turn: f64) -> Piece {
    let at = |angle: f64| centre + Vector::new(libm::cos(angle), libm::sin(angle)) * radius;
    let sense = if turn > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
    let (start, end) = (at(from), at(from + turn));
    Piece { element: 0, start, end, length: (end - start).norm(), bend: Some(Bend { centre, radius, sense }) }
}

/// Places on a piece, close together.
fn places(piece: &Piece, count: usize) -> Vec<Point> {
    let way = match piece.bend {
        None => line(piece.start, piece.end),
        Some(bend) => {
            Element::Arc { start: piece.start, end: piece.end, centre: bend.centre, sense: bend.sense }
        }
    };
    (0..=count).map(|n| way.at(n as f64 / count as f64)).collect()
}

/// Whether a circle that touches at a point, on the side of the normal, holds none of the places.
fn is_empty(point: Point, normal: Vector, radius: f64, places: &[Point]) -> bool {
    places.iter().all(|place| (place - (point + normal * radius)).norm() >= radius)
}

#[test]
fn the_circle_that_just_touches_a_piece_is_empty_and_a_larger_one_is_not() {
    let mut state = 7u64;
    let mut number = |low: f64, high: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 40) as f64 / (1u64 << 24) as f64
    };
    let (mut touching, mut within) = (0, 0);
    for n in 0..240 {
        let piece = if n % 3 == 0 {
            straight(p(number(-5.0, 5.0), number(-5.0, 5.0)), p(number(-5.0, 5.0), number(-5.0, 5.0)))
        } else {
            let turn = number(0.1, 3.1) * if n % 3 == 1 { 1.0 } else { -1.0 };
            bent(p(number(-4.0, 4.0), number(-4.0, 4.0)), number(0.2, 4.0), number(0.0, 6.2), turn)
        };
        let angle = number(0.0, 6.2);
        let (point, normal) =
            (p(number(-4.0, 4.0), number(-4.0, 4.0)), Vector::new(libm::cos(angle), libm::sin(angle)));
        let all = places(&piece, 1000);
        if all.iter().any(|place| (place - point).norm() < 0.05) {
            continue;
        }
        let found = limit(point, normal, &piece);
        let largest = found.min(1000.0);
        assert!(is_empty(point, normal, largest * (1.0 - 1e-5), &all), "{n} {found}");
        if found < 500.0 {
            touching += 1;
            assert!(!is_empty(point, normal, largest * 1.005 + 1e-3, &all), "{n} {found}");
            let ends = at_point(point, normal, piece.start).min(at_point(point, normal, piece.end));
            within += u32::from(found < ends - 1e-3);
        }
    }
    // Many touch, and many of these between the ends of the piece.
    assert!(touching > 80 && within > 30, "{touching} {within}");
}

#[test]
fn circles_that_touch_a_point_a_line_and_an_arc_are_as_large_as_geometry_says() {
    let (origin, up) = (Point::origin(), Vector::new(0.0, 1.0));
    // Through (0, 2) straight ahead: 1. Through (3, 3): 9 + 9 over 2 · 3. Level with the point or behind it: never.
    assert_eq!((at_point(origin, up, p(0.0, 2.0)), at_point(origin, up, p(3.0, 3.0))), (1.0, 3.0));
    assert_eq!(at_point(origin, up, p(3.0, 0.0)), f64::INFINITY);
    assert_eq!(at_point(origin, up, p(3.0, -1.0)), f64::INFINITY);
    assert_eq!(at_point(origin, up, origin), f64::INFINITY);
    // A wall across at height 3, whichever way it runs, is touched with 1.5; one that ends short of it is not.
    for (start, end, wanted) in [
        (p(-9.0, 3.0), p(9.0, 3.0), 1.5),
        (p(9.0, 3.0), p(-9.0, 3.0), 1.5),
        (p(0.0, 3.0), p(9.0, 3.0), 1.5),
        (p(-9.0, 3.0), p(0.0, 3.0), 1.5),
        (p(0.5, 3.0), p(9.0, 3.0), f64::INFINITY),
        (p(-9.0, 3.0), p(-0.5, 3.0), f64::INFINITY),
        (p(4.0, -9.0), p(4.0, 9.0), 4.0),
        (p(-9.0, -3.0), p(9.0, -3.0), f64::INFINITY),
    ] {
        assert_eq!(at_line(origin, up, &straight(start, end)), wanted, "{start} {end}");
    }
    // Half circles of radius 2 about (0, 7): touched from outside with 2.5, from within the bowl with 4.5.
    use std::f64::consts::PI;
    for (from, turn, wanted) in [(PI, PI, 2.5), (0.0, -PI, 2.5)] {
        assert!((limit(origin, up, &bent(p(0.0, 7.0), 2.0, from, turn)) - wanted).abs() < 1e-12);
    }
    for (from, turn) in [(0.0, PI), (PI, -PI)] {
        // The ends at (±2, 7) are met first: (4 + 49) / 14.
        assert!((limit(origin, up, &bent(p(0.0, 7.0), 2.0, from, turn)) - 53.0 / 14.0).abs() < 1e-12);
    }
    // In a bowl of radius 5 about (0, 3): from its axis the far side is met with half of 8.
    assert!((limit(origin, up, &bent(p(0.0, 3.0), 5.0, 0.0, PI)) - 4.0).abs() < 1e-12);
}

#[test]
fn the_middle_of_a_hump_is_found_to_a_millionth() {
    for top in [0.0, 0.1, 0.5, 0.777, 1.0, -3.0] {
        let found = highest(&|x| -(x - top) * (x - top), 0.0, 1.0);
        assert!((found - top.max(0.0)).abs() < 2e-6, "{top} {found}");
        let found = highest(&|x| -(x - top).abs(), -4.0, 4.0);
        assert!((found - top).abs() < 1e-5, "{top} {found}");
    }
}

#[test]
fn a_slot_is_touched_at_its_bottom_by_half_its_width_and_no_more_than_the_wire() {
    let slot = |width: f64| {
        vec![
            line(p(0.0, 5.0), p(0.0, 0.0)),
            line(p(0.0, 0.0), p(width, 0.0)),
            line(p(width, 0.0), p(width, 5.0)),
        ]
    };
    for (width, left, wanted) in [(2.0, 3.0, 1.0), (2.0, 0.4, 0.4), (0.3, 0.2, 0.15)] {
        let (source, path) = source(slot(width), left);
        assert!((source.reach_of(1, &path.elements()[1]) - wanted).abs() < 1e-6, "{width} {left}");
    }
    // Seen from outside nothing is in the way.
    let (source, path) = source(slot(2.0), -3.0);
    assert_eq!(source.reach_of(1, &path.elements()[1]), 3.0);
}

#[test]
fn an_arc_is_touched_from_within_by_its_own_radius_and_from_outside_by_any() {
    let arc =
        |sense| vec![Element::Arc { start: p(2.0, 0.0), end: p(-2.0, 0.0), centre: Point::origin(), sense }];
    for (sense, left, wanted) in [
        (Sense::CounterClockwise, 3.0, 2.0),
        (Sense::CounterClockwise, 1.0, 1.0),
        (Sense::CounterClockwise, -3.0, 3.0),
        (Sense::Clockwise, -3.0, 2.0),
        (Sense::Clockwise, 3.0, 3.0),
    ] {
        let (source, path) = source(arc(sense), left);
        assert!((source.reach_of(0, &path.elements()[0]) - wanted).abs() < 1e-9, "{sense:?} {left}");
    }
}

#[test]
fn under_a_sloping_roof_the_throat_is_at_the_lower_end_of_the_part_looked_at() {
    // A floor from (0, 0) to (10, 0) under a roof that rises from 1 by a tenth; a circle on the floor at x touches it
    // with (1 + x / 10) cos / (1 + cos) of the slope.
    let slope = libm::atan(0.1);
    let under = |x: f64| (1.0 + 0.1 * x) * libm::cos(slope) / (1.0 + libm::cos(slope));
    let elements = vec![
        line(p(0.0, 0.0), p(10.0, 0.0)),
        line(p(10.0, 0.0), p(20.0, 3.0)),
        line(p(20.0, 3.0), p(-10.0, 0.0)),
    ];
    let (source, path) = source(elements, 5.0);
    let floor = &path.elements()[0];
    for (from, to) in [(0.2, 0.8), (0.0, 0.5), (0.5, 1.0), (0.3, 0.3)] {
        let found = source.throat(floor, [from, to], &|element| element != 2);
        assert!((found - under(10.0 * from)).abs() < 1e-6, "{from} {to}: {found} {}", under(10.0 * from));
    }
    // From the left, where the roof meets the floor's line at (−10, 0), no circle is larger than half the height.
    let highest = source.reach_of(0, floor);
    assert!((highest - under(10.0)).abs() < 0.02 || highest > under(9.6), "{highest}");
    // With nothing that counts, the wire itself.
    assert_eq!(source.throat(floor, [0.2, 0.8], &|_| true), 5.0);
}

#[test]
fn between_two_noses_the_throat_is_where_they_are_nearest() {
    // Floor y = 0, a nose of radius 2 about (6, 2.3) hangs over it: narrowest under the middle, 0.3 high.
    let nose =
        Element::Arc { start: p(8.0, 2.3), end: p(4.0, 2.3), centre: p(6.0, 2.3), sense: Sense::Clockwise };
    let elements = vec![
        line(p(0.0, 0.0), p(12.0, 0.0)),
        line(p(12.0, 0.0), p(8.0, 2.3)),
        nose,
        line(p(4.0, 2.3), p(0.0, 2.3)),
    ];
    let (source, path) = source(elements, 1.0);
    for [from, to] in [[0.1, 0.9], [0.35, 0.8], [0.4, 0.52]] {
        let found = source.throat(&path.elements()[0], [from, to], &|element| element != 2);
        assert!((found - 0.15).abs() < 1e-8, "{from} {to} {found}");
    }
}

#[test]
fn under_a_falling_roof_the_throat_is_at_the_far_end_of_the_part_looked_at() {
    let slope = libm::atan(0.1);
    let under = |x: f64| (2.0 - 0.1 * x) * libm::cos(slope) / (1.0 + libm::cos(slope));
    let elements = vec![
        line(p(0.0, 0.0), p(10.0, 0.0)),
        line(p(10.0, 0.0), p(20.0, 0.0)),
        line(p(20.0, 0.0), p(-10.0, 3.0)),
    ];
    let (source, path) = source(elements, 5.0);
    for (from, to) in [(0.2, 0.8), (0.1, 0.5), (0.5, 0.9)] {
        let found = source.throat(&path.elements()[0], [from, to], &|element| element != 2);
        assert!((found - under(10.0 * to)).abs() < 1e-6, "{from} {to}: {found} {}", under(10.0 * to));
    }
}

#[test]
fn the_largest_wire_of_a_triangle_is_its_inscribed_circle() {
    // Sides of 3, 4 and 5: a circle of 1 touches all three, the first of them at a quarter, a third or two fifths or so.
    let nodes = [p(0.0, 0.0), p(4.0, 0.0), p(0.0, 3.0)];
    let sides = (0..3).map(|n| line(nodes[n], nodes[(n + 1) % 3])).collect();
    let (source, path) = source(sides, 2.0);
    for (n, side) in path.elements().iter().enumerate() {
        let found = source.reach_of(n, side);
        assert!((found - 1.0).abs() < 1e-6, "{n}: {found}");
    }
}
