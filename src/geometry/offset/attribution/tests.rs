use super::*;
use crate::geometry::Vector;
use cavalier_contours::polyline::{PlineCreation, PlineSourceMut};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(start: Point, end: Point) -> Element {
    Element::Line { start, end }
}

fn segment(from: Point, to: Point, bulge: f64) -> Segment {
    Segment::between(PlineVertex::new(from.x, from.y, bulge), PlineVertex::new(to.x, to.y, 0.0))
}

/// The segment about a centre from one angle over a turn, positive counter-clockwise.
fn round(centre: Point, radius: f64, from: f64, turn: f64) -> Segment {
    let at = |angle: f64| centre + Vector::new(libm::cos(angle), libm::sin(angle)) * radius;
    segment(at(from), at(from + turn), libm::tan(turn / 4.0))
}

fn source(elements: Vec<Element>, left: f64) -> Source {
    Source::new(&Path::new(elements).unwrap(), left)
}

/// Within and beyond what a node may be off.
const WITHIN: f64 = 4e-5;
const BEYOND: f64 = 6e-5;

#[test]
fn the_middle_of_a_segment_lies_on_its_arc() {
    for turn in [0.1, 1.0, 3.0, -0.4, -2.5] {
        let found = round(p(3.0, -1.0), 2.0, 0.8, turn);
        let middle =
            p(3.0, -1.0) + Vector::new(libm::cos(0.8 + turn / 2.0), libm::sin(0.8 + turn / 2.0)) * 2.0;
        assert!((found.middle - middle).norm() < 1e-12, "{turn}");
        assert!(found.is_on(p(3.0, -1.0), 2.0), "{turn}");
        let sense = if turn > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
        assert_eq!(found.sense(), Some(sense));
    }
    let straight = segment(p(0.0, 0.0), p(4.0, 2.0), 0.0);
    assert_eq!((straight.middle, straight.sense()), (p(2.0, 1.0), None));
}

#[test]
fn a_segment_is_on_a_circle_if_all_three_of_its_points_are() {
    let centre = p(1.0, 2.0);
    for (radius, off, wanted) in [
        (3.0, WITHIN, true),
        (3.0, -WITHIN, true),
        (3.0, BEYOND, false),
        (3.0, -BEYOND, false),
        (0.01, WITHIN, true),
        (0.01, BEYOND, false),
        (500.0, WITHIN, true),
        (500.0, -BEYOND, false),
    ] {
        assert_eq!(round(centre, radius + off, 0.3, 1.1).is_on(centre, radius), wanted, "{radius} {off}");
    }
    let good = round(centre, 3.0, 0.3, 1.1);
    let moved = |p: Point| centre + (p - centre) * 1.001;
    for bad in [
        Segment { from: moved(good.from), ..round(centre, 3.0, 0.3, 1.1) },
        Segment { middle: moved(good.middle), ..round(centre, 3.0, 0.3, 1.1) },
        Segment { to: moved(good.to), ..round(centre, 3.0, 0.3, 1.1) },
    ] {
        assert!(!bad.is_on(centre, 3.0));
    }
}

#[test]
fn a_straight_is_beside_a_line_at_the_offset_on_its_side_within_its_ends_and_its_way() {
    // A line of 5 mm up a 3-4-5 slope; beside it is seen along it and to its left.
    let (along, aside) = (Vector::new(0.6, 0.8), Vector::new(-0.8, 0.6));
    let start = p(2.0, 1.0);
    for left in [0.5, -0.5] {
        let source = source(vec![line(start, start + along * 5.0)], left);
        let beside = |from: (f64, f64), to: (f64, f64)| {
            let at = |(far, off): (f64, f64)| start + along * far + aside * (left + off);
            source.is_beside(&segment(at(from), at(to), 0.0), 0)
        };
        for (from, to, wanted) in [
            ((0.0, 0.0), (5.0, 0.0), true),
            ((1.0, 0.0), (2.0, 0.0), true),
            ((2.0, 0.0), (1.0, 0.0), false),
            ((1.0, WITHIN), (2.0, -WITHIN), true),
            ((1.0, BEYOND), (2.0, 0.0), false),
            ((1.0, 0.0), (2.0, BEYOND), false),
            ((1.0, 0.0), (2.0, -BEYOND), false),
            ((-WITHIN / 5.0, 0.0), (5.0, 0.0), true),
            ((-BEYOND, 0.0), (5.0, 0.0), false),
            ((0.0, 0.0), (5.0 + WITHIN, 0.0), true),
            ((0.0, 0.0), (5.0 + BEYOND, 0.0), false),
            ((1.0, -2.0 * left), (2.0, -2.0 * left), false),
            ((6.0, 0.0), (7.0, 0.0), false),
            ((-2.0, 0.0), (-1.0, 0.0), false),
        ] {
            assert_eq!(beside(from, to), wanted, "{from:?} {to:?} {left}");
        }
        let arc = segment(start + aside * left, start + along * 5.0 + aside * left, 1e-3);
        assert!(!source.is_beside(&arc, 0));
    }
}

#[test]
fn an_arc_is_beside_an_arc_of_its_sense_and_centre_within_its_ends() {
    let centre = p(1.0, 1.0);
    let at = |angle: f64| centre + Vector::new(libm::cos(angle), libm::sin(angle)) * 2.0;
    for (sense, sign) in [(Sense::CounterClockwise, 1.0), (Sense::Clockwise, -1.0)] {
        let element = Element::Arc { start: at(0.5), end: at(0.5 + 1.5 * sign), centre, sense };
        for left in [0.3, -0.3] {
            let source = source(vec![element], left);
            let radius = 2.0 - left * sign;
            let beside =
                |radius: f64, from: f64, turn: f64| source.is_beside(&round(centre, radius, from, turn), 0);
            assert!(beside(radius, 0.5, 1.5 * sign) && beside(radius, 0.5 + 0.4 * sign, 0.5 * sign));
            assert!(beside(radius + WITHIN, 0.5, 1.5 * sign) && !beside(radius + BEYOND, 0.5, 1.5 * sign));
            assert!(!beside(2.0, 0.5, 1.5 * sign) && !beside(2.0 + left * sign, 0.5, 1.5 * sign));
            // Run the other way, before the start, behind the end.
            assert!(!beside(radius, 0.5 + 1.5 * sign, -1.5 * sign));
            assert!(
                !beside(radius, 0.5 - 0.6 * sign, 0.5 * sign)
                    && !beside(radius, 0.5 + 1.6 * sign, 0.5 * sign)
            );
            // Half-way a ten-thousandth of a millimetre and more outside of the ends, and hardly outside.
            let half = |off: f64| round(centre, radius, 0.5 + (off - 0.05) * sign, 0.1 * sign);
            assert!(source.is_beside(&half(1e-9), 0) && source.is_beside(&half(-1e-9), 0));
            assert!(!source.is_beside(&half(-1e-3), 0));
            let half = |off: f64| round(centre, radius, 0.5 + (1.5 - off - 0.05) * sign, 0.1 * sign);
            assert!(source.is_beside(&half(-1e-9), 0) && !source.is_beside(&half(-1e-3), 0));
        }
    }
}

#[test]
fn an_arc_about_a_corner_goes_round_it_on_the_outside() {
    for (left, turn) in [(-0.5, 1.0), (0.5, -1.0)] {
        let corner = p(5.0, 0.0);
        let source = source(vec![line(p(0.0, 0.0), corner), line(corner, p(5.0, 4.0))], left);
        assert!(source.is_beside(&round(corner, 0.5, 0.2, turn), 1));
        assert!(source.is_beside(&round(corner, 0.5 + WITHIN, 0.2, turn), 1));
        assert!(!source.is_beside(&round(corner, 0.5 + BEYOND, 0.2, turn), 1));
        assert!(!source.is_beside(&round(corner, 0.5, 0.2, -turn), 1));
        assert!(!source.is_beside(&round(p(0.0, 0.0), 0.5, 0.2, turn), 1));
        assert!(!source.is_beside(&segment(p(5.0, -0.5), p(5.5, 0.0), 0.0), 1));
    }
}

#[test]
fn whatever_was_found_last_a_segment_is_given_to_what_it_runs_beside() {
    let nodes = [p(0.0, 0.0), p(6.0, 0.0), p(6.0, 4.0), p(0.0, 4.0)];
    let square = source((0..4).map(|n| line(nodes[n], nodes[(n + 1) % 4])).collect(), -0.5);
    let beside = |n: usize| {
        let (start, end) = (nodes[n], nodes[(n + 1) % 4]);
        let way = (end - start).normalize();
        let out = Vector::new(way.y, -way.x) * 0.5;
        segment(start + out, end + out, 0.0)
    };
    let about =
        |n: usize| round(nodes[(n + 1) % 4], 0.5, (n as f64 - 1.0) * std::f64::consts::FRAC_PI_2, 1.5);
    for last in (0..8).map(Some).chain([None]) {
        for n in 0..4 {
            let (line, corner) = (square.key_of(&beside(n), last), square.key_of(&about(n), last));
            assert_eq!((line.number, line.is_exact), (2 * n, true), "{last:?}");
            assert_eq!((corner.number, corner.is_exact), (2 * n + 1, true), "{last:?}");
            assert_eq!(square.origin(line.number), Origin::Element(n));
            assert_eq!(square.origin(corner.number), Origin::Corner(n));
            let stray = segment(beside(n).middle + Vector::new(0.01, 0.01), beside(n).middle, 0.0);
            let nearest = square.key_of(&stray, last);
            assert_eq!((nearest.number, nearest.is_exact), (2 * n, false), "{last:?}");
        }
    }
}

#[test]
fn an_arc_gets_the_very_centre_of_what_it_runs_beside_and_a_stray_one_its_own() {
    let centre = p(1.0, 1.0);
    let bend = Element::Arc { start: p(3.0, 1.0), end: p(1.0, 3.0), centre, sense: Sense::CounterClockwise };
    let source = source(vec![bend, line(p(1.0, 3.0), p(-4.0, 3.0))], -0.5);
    let off = round(p(1.0 + 1e-7, 1.0), 2.5, 0.1, 1.0);
    let key = |number, is_exact| Key { number, is_exact };
    let centre_of = |element| match element {
        Element::Arc { centre, .. } => centre,
        Element::Line { .. } => panic!("an arc"),
    };
    assert_eq!(centre_of(source.element(&off, key(0, true))), centre);
    assert_eq!(centre_of(source.element(&off, key(1, true))), p(1.0, 3.0));
    assert_eq!(centre_of(source.element(&off, key(2, true))), p(-4.0, 3.0));
    for number in 0..3 {
        let own = centre_of(source.element(&off, key(number, false)));
        assert!((own - p(1.0 + 1e-7, 1.0)).norm() < 1e-10);
    }
    let straight = segment(p(1.0, 3.5), p(0.0, 3.5), 0.0);
    assert_eq!(source.element(&straight, key(2, true)), line(p(1.0, 3.5), p(0.0, 3.5)));
}

#[test]
fn neighbours_that_are_one_way_are_made_one_and_others_are_not() {
    let arc = |from: f64, to: f64, centre: Point, sense| {
        let at = |angle: f64| centre + Vector::new(libm::cos(angle), libm::sin(angle));
        Element::Arc { start: at(from), end: at(to), centre, sense }
    };
    let ccw = Sense::CounterClockwise;
    let (a, b, c) = (p(0.0, 0.0), p(1.0, 0.0), p(3.0, 0.0));
    let o = Origin::Element;
    let first = arc(0.0, 1.0, a, ccw);
    let second = arc(1.0, 2.0, a, ccw);
    let third = arc(2.0, 3.0, a, ccw);
    for (elements, origins, wanted) in [
        (vec![line(a, b), line(b, c)], vec![o(0), o(0)], vec![line(a, c)]),
        (vec![line(a, b), line(b, c)], vec![o(0), o(1)], vec![line(a, b), line(b, c)]),
        (vec![first, second, third], vec![o(4), o(4), o(4)], vec![arc(0.0, 3.0, a, ccw)]),
        (vec![first, second, third], vec![o(4), o(4), o(5)], vec![arc(0.0, 2.0, a, ccw), third]),
        (vec![first, arc(1.0, 2.0, b, ccw)], vec![o(4), o(4)], vec![first, arc(1.0, 2.0, b, ccw)]),
        (
            vec![first, arc(1.0, 0.5, a, Sense::Clockwise)],
            vec![o(4), o(4)],
            vec![first, arc(1.0, 0.5, a, Sense::Clockwise)],
        ),
        (vec![first, line(first.end(), c)], vec![o(1), o(1)], vec![first, line(first.end(), c)]),
        (vec![line(a, b)], vec![o(0)], vec![line(a, b)]),
        (vec![], vec![], vec![]),
    ] {
        let (mut elements, mut origins) = (elements, origins);
        merge(&mut elements, &mut origins);
        assert_eq!((elements.len(), origins.len()), (wanted.len(), wanted.len()));
        for (found, wanted) in elements.iter().zip(&wanted) {
            assert!((found.start() - wanted.start()).norm() + (found.end() - wanted.end()).norm() < 1e-12);
            assert!((found.length() - wanted.length()).abs() < 1e-12);
        }
    }
}

#[test]
fn wherever_the_library_opened_a_ring_it_begins_beside_the_contours_beginning() {
    let nodes = [p(0.0, 0.0), p(6.0, 0.0), p(6.0, 4.0), p(0.0, 4.0)];
    let square = source((0..4).map(|n| line(nodes[n], nodes[(n + 1) % 4])).collect(), 0.5);
    let inner = [p(0.5, 0.5), p(5.5, 0.5), p(5.5, 3.5), p(0.5, 3.5)];
    let whole: Vec<Element> = (0..4).map(|n| line(inner[n], inner[(n + 1) % 4])).collect();
    let origins: Vec<Origin> = (0..4).map(Origin::Element).collect();
    // With the first side cut in two or in three, and opened at any of its places.
    for extra in [&[][..], &[p(2.0, 0.5)], &[p(2.0, 0.5), p(4.0, 0.5)]] {
        let mut ring = vec![inner[0]];
        ring.extend(extra);
        ring.extend(&inner[1..]);
        for first in 0..ring.len() {
            ring.rotate_left(usize::from(first > 0));
            let mut found = Polyline::with_capacity(8, true);
            for node in &ring {
                found.add(node.x, node.y, 0.0);
            }
            let outline = outline(&square, &found).unwrap();
            assert_eq!(outline.path.elements(), whole, "{first} {extra:?}");
            assert_eq!(outline.origins, origins);
        }
    }
    // An open one stays as it was found.
    let way = source(vec![line(p(0.0, 0.0), p(6.0, 0.0)), line(p(6.0, 0.0), p(6.0, 4.0))], 0.5);
    let mut found = Polyline::with_capacity(2, false);
    for node in [p(5.5, 1.0), p(5.5, 4.0)] {
        found.add(node.x, node.y, 0.0);
    }
    let outline = outline(&way, &found).unwrap();
    assert_eq!(outline.path.elements(), [line(p(5.5, 1.0), p(5.5, 4.0))]);
    assert_eq!(outline.origins, [Origin::Element(1)]);
}

#[test]
fn a_small_circle_is_told_from_one_a_little_larger() {
    // The radius is far less than what a node may be off is of a large one: only the difference counts.
    let centre = p(0.0, 0.0);
    for radius in [1e-3, 0.1, 1.0, 40.0, 5000.0] {
        for (off, wanted) in [(WITHIN, true), (BEYOND, false)] {
            assert_eq!(round(centre, radius + off, 0.3, 1.1).is_on(centre, radius), wanted, "{radius} {off}");
        }
    }
}

#[test]
fn a_stray_segment_is_given_to_what_lies_at_the_offset_and_not_to_what_lies_nearer() {
    // Half a millimetre above the floor, and nearer to the wall.
    let source = source(vec![line(p(0.0, 0.0), p(6.0, 0.0)), line(p(6.0, 0.0), p(6.0, 4.0))], 0.5);
    let stray = segment(p(5.6, 0.4), p(5.8, 0.6), 0.0);
    let key = source.key_of(&stray, None);
    assert_eq!((key.number, key.is_exact), (0, false));
}
