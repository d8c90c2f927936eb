//! Loose pieces, joined and ordered.

use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::geometry::Vector;

fn point(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(start: (f64, f64), end: (f64, f64)) -> Element {
    Element::Line { start: point(start.0, start.1), end: point(end.0, end.1) }
}

/// Pieces of one element each, numbered as their lines.
fn pieces(elements: impl IntoIterator<Item = Element>) -> Vec<Piece> {
    let piece = |(n, element): (usize, Element)| Piece {
        elements: vec![element],
        layer: 0,
        line: n as u64 + 1,
        travel: Travel::Cut,
        clockwise: false,
    };
    elements.into_iter().enumerate().map(piece).collect()
}

fn joined(elements: impl IntoIterator<Item = Element>, joining: &Joining) -> (Vec<Contour>, Vec<Finding>) {
    let mut report = Vec::new();
    let contours = contours(pieces(elements), &["0".to_string()], joining, None, &mut report);
    (contours, report)
}

fn as_drawn() -> Joining {
    Joining { order: Order::AsDrawn, start: Start::AsDrawn, ..Joining::default() }
}

/// The sides of a square, counter-clockwise from its lower left corner.
fn square(x: f64, y: f64, side: f64) -> Vec<Element> {
    let corners = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)];
    (0..4).map(|n| line(corners[n], corners[(n + 1) % 4])).collect()
}

fn circle(x: f64, y: f64, radius: f64) -> Element {
    Path::circle(point(x, y), radius, Sense::CounterClockwise).elements()[0]
}

fn messages(report: &[Finding]) -> Vec<&str> {
    report.iter().map(|finding| finding.message.as_str()).collect()
}

#[test]
fn pieces_in_any_order_and_direction_become_the_contour_they_are_drawn_as() {
    let [a, b, c, d] = square(0.0, 0.0, 10.0).try_into().unwrap();
    let (contours, report) = joined([a, c.reversed(), d, b.reversed()], &as_drawn());
    assert!(report.is_empty(), "{report:#?}");
    assert_eq!(contours.len(), 1);
    assert!(contours[0].closed);
    // Begun with the first piece, and on to the one that is drawn earlier of its two neighbours.
    assert_eq!(
        contours[0].path,
        Path::new(vec![a.reversed(), d.reversed(), c.reversed(), b.reversed()]).unwrap()
    );
}

#[test]
fn a_gap_within_the_tolerance_is_closed_and_told_with_its_coordinates() {
    let sides =
        [line((0.0, 0.0), (10.0, 0.0)), line((10.0, 0.004), (0.0, 8.0)), line((0.0, 8.0), (0.0, 0.0))];
    let (contours, report) = joined(sides, &as_drawn());
    assert!(contours[0].closed);
    assert_eq!(
        messages(&report),
        ["a gap of 0.0040 mm is closed between (10.0000, 0.0000) and (10.0000, 0.0040)"]
    );
    assert_eq!((report[0].severity, report[0].line), (Severity::Warning, 2));
    assert_eq!(contours[0].path.elements()[0].end(), point(10.0, 0.002));
    // The same gap under a smaller tolerance is left open.
    let (contours, report) = joined(sides, &Joining { join: 0.003, ..as_drawn() });
    assert!(!contours[0].closed);
    assert_eq!(
        messages(&report),
        [
            "an open end at (10.0000, 0.0000) is 0.0040 mm from another at (10.0000, 0.0040)",
            "an open end at (10.0000, 0.0040) is 0.0040 mm from another at (10.0000, 0.0000)",
        ]
    );
    assert_eq!(report[0].help, "draw the ends on one point, or set `join` larger");
}

#[test]
fn a_rounding_is_closed_without_a_word() {
    let sides =
        [line((0.0, 0.0), (10.0, 0.0)), line((10.0, 0.0004), (0.0, 8.0)), line((0.0, 8.0), (0.0, 0.0))];
    let (contours, report) = joined(sides, &as_drawn());
    assert!(contours[0].closed && report.is_empty(), "{report:#?}");
}

#[test]
fn an_arc_keeps_its_shape_where_its_end_is_moved() {
    let arc = Element::Arc {
        start: point(10.0, 0.0),
        end: point(0.0, 10.0),
        centre: point(0.0, 0.0),
        sense: Sense::CounterClockwise,
    };
    let (contours, _) =
        joined([arc, line((0.0, 10.004), (0.0, 0.0)), line((0.0, 0.0), (10.0, 0.0))], &as_drawn());
    let moved = contours[0].path.elements()[0];
    assert!((moved.end() - point(0.0, 10.002)).norm() < 1e-12);
    let Element::Arc { start, end, centre, .. } = moved else { panic!() };
    assert!(((start - centre).norm() - (end - centre).norm()).abs() < 1e-12);
    assert!((0..=100).all(|n| arc.distance(moved.at(f64::from(n) / 100.0)) <= 0.004));
}

#[test]
fn where_three_ends_meet_the_place_is_a_fault() {
    let mut elements = square(0.0, 0.0, 10.0);
    elements.push(line((10.0, 10.0), (15.0, 15.0)));
    let (contours, report) = joined(elements, &as_drawn());
    assert_eq!(messages(&report)[0], "3 ends meet at (10.0000, 10.0000)");
    assert_eq!((report[0].severity, report[0].code), (Severity::Fault, "branch"));
    assert!(report[0].help.contains("lines 2, 3, 5"), "{}", report[0].help);
    assert_eq!(contours.iter().map(|c| c.path.elements().len()).sum::<usize>(), 5, "nothing is lost");
    assert_eq!(contours.len(), 2, "none goes on over the branch");
}

#[test]
fn what_is_drawn_twice_is_used_once_and_told() {
    let mut elements = square(0.0, 0.0, 10.0);
    elements.push(elements[2].reversed());
    elements.push(circle(5.0, 5.0, 2.0));
    let turned = Path::new(vec![circle(5.0, 5.0, 2.0)]).unwrap();
    let from_left = Element::Arc {
        start: point(3.0, 5.0),
        end: point(3.0, 5.0),
        centre: point(5.0, 5.0),
        sense: Sense::Clockwise,
    };
    assert!((turned.length() - from_left.length()).abs() < 1e-12);
    elements.push(from_left);
    let (contours, report) = joined(elements, &as_drawn());
    assert_eq!(contours.len(), 2);
    assert!(contours.iter().all(|c| c.closed));
    assert_eq!(
        messages(&report),
        [
            "what is drawn through (5.0000, 10.0000) is drawn twice and used once",
            "what is drawn through (7.0000, 5.0000) is drawn twice and used once",
        ]
    );
    assert!(report.iter().all(|f| f.severity == Severity::Warning));
    assert_eq!(report[0].help, "it is drawn on line 3 of the file and on line 5");
}

#[test]
fn a_contour_drawn_over_in_part_is_a_fault() {
    let whole =
        Piece { elements: square(0.0, 0.0, 10.0), layer: 0, line: 1, travel: Travel::Cut, clockwise: false };
    let mut over = whole.clone();
    over.elements[2] = line((10.0, 10.0), (3.0, 12.0));
    over.elements[3] = line((3.0, 12.0), (0.0, 0.0));
    over.line = 7;
    let mut report = Vec::new();
    contours(vec![whole, over], &["0".to_string()], &as_drawn(), None, &mut report);
    let fault = report.iter().find(|f| f.code == "partly-drawn-twice").unwrap();
    assert_eq!(fault.severity, Severity::Fault);
    assert_eq!(fault.message, "2 of 4 elements from (5.0000, 0.0000) on are drawn twice");
}

#[test]
fn a_way_there_and_back_encloses_nothing_and_is_a_fault() {
    let there = line((0.0, 0.0), (10.0, 0.0));
    let back = [line((10.0, 0.0), (4.0, 0.0)), line((4.0, 0.0), (0.0, 0.0))];
    let (_, report) = joined([there, back[0], back[1]], &as_drawn());
    assert_eq!(messages(&report), ["the contour from (0.0000, 0.0000) encloses nothing"]);
}

#[test]
fn holes_come_before_what_they_lie_in_however_deep() {
    // Drawn from the outside in: a plate, a window in it, an island in the window, a hole in the island.
    let mut elements = square(0.0, 0.0, 100.0);
    elements.extend(square(10.0, 10.0, 80.0));
    elements.extend(square(20.0, 20.0, 60.0));
    elements.push(circle(50.0, 50.0, 5.0));
    elements.push(circle(95.0, 5.0, 2.0));
    let (contours, report) = joined(elements, &Joining::default());
    assert!(report.is_empty());
    let order: Vec<(usize, u64)> = contours.iter().map(|c| (c.depth, c.line)).collect();
    let place = |line: u64| order.iter().position(|&(_, l)| l == line).unwrap();
    assert!(
        place(13) < place(9) && place(9) < place(5) && place(5) < place(1) && place(14) < place(1),
        "{order:?}"
    );
    let depths: Vec<usize> = [1, 5, 9, 13, 14].map(|line| order[place(line)].0).to_vec();
    assert_eq!(depths, [0, 1, 2, 3, 1]);
}

#[test]
fn the_next_contour_is_the_nearest_and_begins_at_its_nearest_node() {
    let mut elements = square(100.0, 0.0, 10.0);
    elements.extend(square(20.0, 0.0, 10.0));
    elements.extend(square(60.0, 0.0, 10.0));
    let (contours, _) = joined(elements, &Joining::default());
    let starts: Vec<f64> = contours.iter().map(|c| c.path.start().x).collect();
    assert_eq!(starts, [20.0, 60.0, 100.0]);
}

#[test]
fn directions_are_as_drawn_or_as_given() {
    let mut elements: Vec<Element> =
        square(0.0, 0.0, 100.0).into_iter().rev().map(Element::reversed).collect();
    elements.push(circle(50.0, 50.0, 5.0));
    let senses = |direction: Direction| -> Vec<Sense> {
        let (contours, _) = joined(elements.clone(), &Joining { direction, ..Joining::default() });
        contours.iter().map(|c| c.path.sense()).collect()
    };
    use Sense::{Clockwise, CounterClockwise};
    assert_eq!(senses(Direction::default()), [CounterClockwise, Clockwise]);
    assert_eq!(
        senses(Direction { outlines: Some(CounterClockwise), holes: Some(Clockwise) }),
        [Clockwise, CounterClockwise]
    );
    assert_eq!(senses(Direction { outlines: Some(CounterClockwise), holes: None }), [CounterClockwise; 2]);
}

#[test]
fn a_start_may_be_given_on_a_node_within_an_element_or_on_a_circle() {
    let begun = |element: Vec<Element>, at: Point| {
        let (mut contours, report) =
            joined(element, &Joining { start: Start::At(vec![at]), ..Joining::default() });
        assert!(report.is_empty(), "{report:#?}");
        contours.remove(0).path
    };
    let node = begun(square(0.0, 0.0, 10.0), point(10.0, 10.0));
    assert_eq!((node.start(), node.elements().len()), (point(10.0, 10.0), 4));
    let within = begun(square(0.0, 0.0, 10.0), point(10.0, 4.0));
    assert_eq!(
        (within.start(), within.end(), within.elements().len()),
        (point(10.0, 4.0), point(10.0, 4.0), 5)
    );
    assert!((within.area() - 100.0).abs() < 1e-12);
    let round = begun(vec![circle(0.0, 0.0, 5.0)], point(0.0, -5.0));
    assert_eq!(round.elements().len(), 1);
    assert!((round.start() - point(0.0, -5.0)).norm() < 1e-12);
    let arcs = vec![
        Element::Arc {
            start: point(5.0, 0.0),
            end: point(-5.0, 0.0),
            centre: point(0.0, 0.0),
            sense: Sense::CounterClockwise,
        },
        line((-5.0, 0.0), (5.0, 0.0)),
    ];
    let split = begun(arcs, point(0.0, 5.0));
    assert_eq!(split.elements().len(), 3);
    assert!((split.area() - 12.5 * PI).abs() < 1e-12);
}

#[test]
fn a_start_beside_every_contour_or_given_twice_is_told() {
    let starts = |points: Vec<Point>, elements: Vec<Element>| {
        let (_, report) = joined(elements, &Joining { start: Start::At(points), ..Joining::default() });
        report.into_iter().map(|f| f.message).collect::<Vec<_>>()
    };
    assert_eq!(
        starts(vec![point(5.0, -1.0), point(0.0, 0.0)], square(0.0, 0.0, 10.0)),
        [
            "the start (5.0000, -1.0000) lies 1.0000 mm beside the nearest contour",
            "the contour at (0.0000, 0.0000) is given a second start",
        ]
    );
    assert_eq!(
        starts(vec![point(1.0, 2.0)], vec![line((0.0, 0.0), (9.0, 0.0))])[2..],
        ["no closed contour could begin at (1.0000, 2.0000)"]
    );
}

#[test]
fn a_chain_of_pieces_shorter_than_the_tolerance_stays_whole() {
    // A circle of radius 1 drawn with 10 000 lines of 0.0006 mm.
    let count = 10_000;
    let at = |n: usize| {
        let angle = 2.0 * PI * (n % count) as f64 / count as f64;
        (libm::cos(angle), libm::sin(angle))
    };
    let (contours, report) = joined((0..count).map(|n| line(at(n), at(n + 1))), &as_drawn());
    assert!(report.is_empty());
    assert_eq!((contours.len(), contours[0].closed, contours[0].path.elements().len()), (1, true, count));
}

/// Squares and circles in a field, and an order to draw their pieces in.
fn field() -> impl Strategy<Value = (Vec<Element>, usize)> {
    prop::collection::vec((0.5..9.0_f64, any::<bool>(), any::<bool>()), 1..30).prop_flat_map(|shapes| {
        let count = shapes.len();
        let elements: Vec<Element> = shapes
            .iter()
            .enumerate()
            .flat_map(|(n, &(size, round, turned))| {
                let (x, y) = ((n % 6) as f64 * 10.0, (n / 6) as f64 * 10.0);
                let shape =
                    if round { vec![circle(x + 4.5, y + 4.5, size / 2.0)] } else { square(x, y, size) };
                shape.into_iter().map(move |e| if turned { e.reversed() } else { e })
            })
            .collect();
        (Just(elements).prop_shuffle(), Just(count))
    })
}

proptest! {
    /// However they are shuffled, shapes come back closed, each once, with all their length, area and nothing to tell.
    #[test]
    fn shuffled_shapes_are_found_again((elements, count) in field()) {
        let (contours, report) = joined(elements.clone(), &Joining::default());
        prop_assert!(report.is_empty(), "{:?}", report);
        prop_assert_eq!(contours.len(), count);
        prop_assert!(contours.iter().all(|c| c.closed && c.depth == 0));
        let length = |e: &[Element]| e.iter().map(Element::length).sum::<f64>();
        let found: f64 = contours.iter().map(|c| c.path.length()).sum();
        prop_assert!((found - length(&elements)).abs() < 1e-9);
    }

    /// Ends displaced by less than the tolerance are joined all the same, and no point moves farther than it.
    #[test]
    fn displaced_ends_are_joined(by in prop::collection::vec((-0.0017..0.0017_f64, -0.0017..0.0017_f64), 8)) {
        let sides = square(0.0, 0.0, 10.0);
        let moved = sides.iter().enumerate().map(|(n, side)| {
            let away = |k: usize| Vector::new(by[k].0, by[k].1);
            Element::Line { start: side.start() + away(2 * n), end: side.end() + away(2 * n + 1) }
        });
        let (contours, _) = joined(moved, &Joining::default());
        prop_assert_eq!(contours.len(), 1);
        prop_assert!(contours[0].closed);
        for (n, side) in contours[0].path.elements().iter().enumerate() {
            prop_assert!((side.start() - sides[n].start()).norm() < 0.005);
        }
    }
}
