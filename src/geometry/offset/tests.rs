use super::*;
use crate::geometry::{Sense, Vector};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn polygon(nodes: &[(f64, f64)]) -> Path {
    let count = nodes.len();
    let node = |n: usize| p(nodes[n % count].0, nodes[n % count].1);
    Path::new((0..count).map(|n| Element::Line { start: node(n), end: node(n + 1) }).collect()).unwrap()
}

fn square() -> Path {
    polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)])
}

#[test]
fn a_square_grows_with_round_or_sharp_corners_and_shrinks_with_sharp_ones() {
    let outside = offset(&square(), -1.0, Corners::Round).unwrap();
    assert_eq!(outside.outlines.len(), 1);
    assert!((outside.outlines[0].path.area() - (140.0 + std::f64::consts::PI)).abs() < 1e-9);
    assert_eq!(outside.outlines[0].origins[..3], [Origin::Element(0), Origin::Corner(0), Origin::Element(1)]);
    let sharp = offset(&square(), -1.0, Corners::Sharp { limit: 1.5 }).unwrap();
    assert_eq!(sharp.outlines[0].path.elements().len(), 4);
    assert!((sharp.outlines[0].path.area() - 144.0).abs() < 1e-9);
    let inside = offset(&square(), 1.0, Corners::Round).unwrap();
    assert!((inside.outlines[0].path.area() - 64.0).abs() < 1e-9);
    assert_eq!((inside.filled_corners, inside.unreached.len()), (4, 0));
}

#[test]
fn a_corner_sharper_than_the_limit_stays_round() {
    let limited = offset(&square(), -1.0, Corners::Sharp { limit: 1.4 }).unwrap();
    assert_eq!(limited, offset(&square(), -1.0, Corners::Round).unwrap());
}

#[test]
fn a_circle_stays_one_arc_about_its_centre() {
    let circle = Path::circle(p(3.0, 4.0), 5.0, Sense::Clockwise);
    for left in [0.1, -0.1] {
        let found = offset(&circle, left, Corners::Round).unwrap();
        let [Element::Arc { start, end, centre, .. }] = *found.outlines[0].path.elements() else { panic!() };
        assert_eq!((start, centre), (end, p(3.0, 4.0)));
        assert!(((start - centre).norm() - (5.0 + left)).abs() < 1e-9);
        assert!(found.unreached.is_empty());
    }
}

#[test]
fn a_fillet_tighter_than_the_wire_is_told_with_its_radius() {
    let arc = |start, end, centre| Element::Arc { start, end, centre, sense: Sense::CounterClockwise };
    let line = |start, end| Element::Line { start, end };
    let path = Path::new(vec![
        line(p(0.0, 0.0), p(9.95, 0.0)),
        arc(p(9.95, 0.0), p(10.0, 0.05), p(9.95, 0.05)),
        line(p(10.0, 0.05), p(10.0, 9.0)),
        arc(p(10.0, 9.0), p(9.0, 10.0), p(9.0, 9.0)),
        line(p(9.0, 10.0), p(0.0, 10.0)),
        line(p(0.0, 10.0), p(0.0, 0.0)),
    ])
    .unwrap();
    let found = offset(&path, 0.1, Corners::Round).unwrap();
    assert_eq!((found.outlines.len(), found.filled_corners), (1, 2));
    let [fillet] = found.unreached[..] else { panic!("{:?}", found.unreached) };
    assert_eq!((fillet.first, fillet.last), (1, 1));
    assert!((fillet.largest - 0.05).abs() < 1e-9, "{fillet:?}");
    assert!((fillet.at - path.elements()[1].at(0.5)).norm() < 0.01);
    assert!(offset(&path, 0.05 - 1e-4, Corners::Round).unwrap().unreached.is_empty());
}

#[test]
fn a_slot_tells_half_its_width() {
    let path = polygon(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.9),
        (5.0, 4.9),
        (5.0, 5.1),
        (10.0, 5.1),
        (10.0, 10.0),
        (0.0, 10.0),
    ]);
    // Outside the outline, on the right of a counter-clockwise contour, the slot is 0.2 wide.
    let found = offset(&path, -0.15, Corners::Round).unwrap();
    let [slot] = found.unreached[..] else { panic!("{:?}", found.unreached) };
    assert_eq!((slot.first, slot.last), (2, 4));
    assert!((slot.largest - 0.1).abs() < 1e-6, "{slot:?}");
    assert!((slot.at - p(5.0, 5.0)).norm() < 1e-6);
    let fits = offset(&path, -0.099, Corners::Round).unwrap();
    assert_eq!((fits.unreached.len(), fits.filled_corners), (0, 2));
}

/// Two rooms of 4 by 4 with a neck 0.4 high between them.
fn dumbbell() -> Path {
    polygon(&[
        (0.0, 0.0),
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
    ])
}

#[test]
fn a_dumbbell_comes_apart_and_its_neck_is_told() {
    let path = dumbbell();
    let found = offset(&path, 0.5, Corners::Round).unwrap();
    assert_eq!(found.outlines.len(), 2);
    let necks: Vec<_> = found.unreached.iter().map(|run| (run.first, run.last)).collect();
    assert_eq!(necks, [(2, 2), (8, 8)]);
    assert!(found.unreached.iter().all(|neck| (neck.largest - 0.2).abs() < 1e-9), "{:?}", found.unreached);
}

#[test]
fn a_throat_between_two_arcs_is_told_with_half_its_width() {
    // Two noses, 0.3 apart where they are nearest, in the sides of a box.
    let line = |start, end| Element::Line { start, end };
    let nose = |start, end, centre| Element::Arc { start, end, centre, sense: Sense::Clockwise };
    let path = Path::new(vec![
        line(p(0.0, 0.0), p(4.0, 0.0)),
        nose(p(4.0, 0.0), p(8.0, 0.0), p(6.0, 0.0)),
        line(p(8.0, 0.0), p(12.0, 0.0)),
        line(p(12.0, 0.0), p(12.0, 4.3)),
        line(p(12.0, 4.3), p(8.0, 4.3)),
        nose(p(8.0, 4.3), p(4.0, 4.3), p(6.0, 4.3)),
        line(p(4.0, 4.3), p(0.0, 4.3)),
        line(p(0.0, 4.3), p(0.0, 0.0)),
    ])
    .unwrap();
    let found = offset(&path, 0.2, Corners::Round).unwrap();
    assert_eq!((found.outlines.len(), found.filled_corners), (2, 8));
    let told: Vec<_> = found.unreached.iter().map(|run| (run.first, run.last)).collect();
    assert_eq!(told, [(1, 1), (5, 5)]);
    for throat in &found.unreached {
        assert!((throat.largest - 0.15).abs() < 1e-6, "{throat:?}");
        assert!((throat.at.x - 6.0).abs() < 1e-6, "{throat:?}");
    }
}

#[test]
fn nothing_is_left_of_a_contour_narrower_than_the_wire() {
    let path = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)]);
    let found = offset(&path, 2.5, Corners::Round).unwrap();
    assert!(found.outlines.is_empty());
    let [all] = found.unreached[..] else { panic!() };
    assert_eq!((all.first, all.last), (0, 3));
    assert!((all.largest - 2.0).abs() < 1e-6, "{all:?}");
}

#[test]
fn a_contour_that_crosses_itself_is_refused_with_the_place() {
    let bow = polygon(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)]);
    let Err(Impossible::MeetsItself(meetings)) = offset(&bow, 0.1, Corners::Round) else { panic!() };
    assert_eq!((meetings.len(), meetings[0].first, meetings[0].second), (1, 0, 2));
    assert!((meetings[0].at - p(2.0, 2.0)).norm() < 1e-9);
    let error = offset(&bow, 0.1, Corners::Round).unwrap_err().to_string();
    assert_eq!(error, "the contour meets itself at X2.0000 Y2.0000, in its elements 1 and 3");
}

#[test]
fn an_open_contour_is_followed_from_square_to_square() {
    let path = Path::new(vec![
        Element::Line { start: p(0.0, 0.0), end: p(5.0, 0.0) },
        Element::Line { start: p(5.0, 0.0), end: p(5.0, 5.0) },
    ])
    .unwrap();
    let inner = offset(&path, 1.0, Corners::Round).unwrap();
    assert_eq!(inner.filled_corners, 1);
    assert!((inner.outlines[0].path.start() - p(0.0, 1.0)).norm() < 1e-9);
    assert!((inner.outlines[0].path.end() - p(4.0, 5.0)).norm() < 1e-9);
    let outer = offset(&path, -1.0, Corners::Round).unwrap();
    assert!((outer.outlines[0].path.end() - p(6.0, 5.0)).norm() < 1e-9);
    assert_eq!(outer.outlines[0].origins, [Origin::Element(0), Origin::Corner(0), Origin::Element(1)]);
}

#[test]
fn rounding_puts_nodes_on_microns_and_loses_only_what_is_shorter() {
    let path = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0002, 0.0001), (10.0, 5.00049), (0.0, 5.0)]);
    let whole = offset(&path, 0.0, Corners::Round).unwrap();
    let rounded = whole.outlines[0].rounded().unwrap();
    assert_eq!(rounded.origins.iter().map(|o| o.element()).collect::<Vec<_>>(), [0, 2, 3, 4]);
    assert_eq!(rounded.path.elements()[1].end(), p(10.0, 5.0));
}

#[test]
fn numbers_that_are_none_are_refused() {
    for left in [f64::NAN, f64::INFINITY] {
        assert!(matches!(offset(&square(), left, Corners::Round), Err(Impossible::NotFinite(_))));
    }
    let far = polygon(&[(0.0, 0.0), (1e9, 0.0), (0.0, 1.0)]);
    assert_eq!(offset(&far, 0.1, Corners::Round), Err(Impossible::TooFar));
}

#[test]
fn an_outline_begins_beside_the_contours_beginning() {
    let circle = Path::circle(p(0.0, 0.0), 5.0, Sense::CounterClockwise);
    let found = offset(&circle, 1.0, Corners::Round).unwrap();
    assert!((found.outlines[0].path.start() - p(4.0, 0.0)).norm() < 1e-9);
    for first in 0..4 {
        let path = square().begun_at(first);
        let found = offset(&path, -1.0, Corners::Round).unwrap();
        assert_eq!(found.outlines[0].origins[0], Origin::Element(0));
        let beside = path.elements()[0].heading_at_start();
        let square_off = path.start() + Vector::new(beside.y, -beside.x);
        assert!((found.outlines[0].path.start() - square_off).norm() < 1e-9, "{first}");
    }
}

#[test]
fn elements_shorter_than_a_point_do_no_harm() {
    let dust = polygon(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 3e-6),
        (10.0, 6e-6),
        (10.0, 9e-6),
        (10.0, 10.0),
        (0.0, 10.0),
    ]);
    let found = offset(&dust, 1.0, Corners::Round).unwrap();
    assert!((found.outlines[0].path.area() - 64.0).abs() < 1e-6);
    assert!(found.unreached.is_empty(), "{:?}", found.unreached);
    let nothing = polygon(&[(0.0, 0.0), (1e-6, 0.0), (0.0, 1e-6)]);
    assert!(offset(&nothing, 1.0, Corners::Round).is_ok());
    for radius in [0.0, 1e-9, 1e-5, 2e-5] {
        let dot = Path::circle(p(1e4, 0.0), radius, Sense::Clockwise);
        assert!(offset(&dot, 0.1, Corners::Round).is_ok());
        assert!(offset(&dot, -0.1, Corners::Round).is_ok());
    }
}

#[test]
fn an_arc_shrunk_to_a_point_vanishes_and_a_full_circle_does_not() {
    let around = |radius: f64, sweep: f64| {
        let centre = p(2.0, 0.0);
        let start = p(2.0 + radius, 0.0);
        let end = centre + Vector::new(libm::cos(sweep), libm::sin(sweep)) * radius;
        let arc = Element::Arc { start, end, centre, sense: Sense::CounterClockwise };
        Path::new(vec![arc, Element::Line { start: end, end: p(9.0, 0.0) }]).unwrap()
    };
    let rounded = |path: &Path| offset(path, 0.0, Corners::Round).unwrap().outlines[0].rounded().unwrap();
    let origins = |path: &Path| rounded(path).origins;
    // A quarter of a ten-thousandth's radius.
    assert_eq!(origins(&around(1e-4, 1.5)), [Origin::Element(1)]);
    assert_eq!(origins(&around(1.0, 1.5)).len(), 2);
    // Ends a ten-thousandth apart, nearly a whole turn about 1 mm.
    assert_eq!(origins(&around(1.0, std::f64::consts::TAU - 1e-4)).len(), 2);
    let circle = rounded(&Path::circle(p(0.0, 0.0), 1.0, Sense::Clockwise));
    assert!((circle.path.elements()[0].sweep() - std::f64::consts::TAU).abs() < 1e-12);
}

#[test]
fn a_scribble_is_told_with_a_hundred_meetings_and_that_there_may_be_more() {
    // A zigzag of 30 strokes each way, crossed by another: 900 meetings and more.
    let strokes = |flip: bool| {
        (0..30).map(move |n| {
            let (far, along) = (if n % 2 == 0 { 0.0 } else { 40.0 }, f64::from(n) + 5.0);
            if flip { (far - 0.5, along) } else { (along, far) }
        })
    };
    let nodes: Vec<_> = strokes(false).chain(strokes(true)).collect();
    let error = offset(&polygon(&nodes), 0.1, Corners::Round).unwrap_err();
    let Impossible::MeetsItself(meetings) = &error else { panic!("{error}") };
    assert_eq!(meetings.len(), 100);
    assert!(error.to_string().ends_with("(and in 99 more places at least)"), "{error}");
}

#[test]
fn a_bay_that_faces_a_wall_tells_half_the_way_between_them() {
    // A slice of a disc: an arc of radius 10 over a chord, 0.835 high, and the wire half as wide in its middle.
    let height = 10.0 - 84f64.sqrt();
    let slice = Path::new(vec![
        Element::Line { start: p(-4.0, 0.0), end: p(4.0, 0.0) },
        Element::Arc {
            start: p(4.0, 0.0),
            end: p(-4.0, 0.0),
            centre: p(0.0, height - 10.0),
            sense: Sense::CounterClockwise,
        },
    ])
    .unwrap();
    for (path, left) in [(slice.clone(), 0.5), (slice.reversed(), -0.5)] {
        let found = offset(&path, left, Corners::Round).unwrap();
        let [all] = found.unreached[..] else { panic!("{:?}", found.unreached) };
        assert!((all.largest - height / 2.0).abs() < 1e-6, "{all:?}");
        let under = offset(&path, left.signum() * (height / 2.0 - 1e-3), Corners::Round).unwrap();
        assert_eq!(under.outlines.len(), 1);
    }
}

#[test]
fn an_open_contours_corners_are_sharp_between_its_ends_only() {
    let path = Path::new(vec![
        Element::Line { start: p(0.0, 0.0), end: p(5.0, 0.0) },
        Element::Line { start: p(5.0, 0.0), end: p(5.0, 5.0) },
        Element::Line { start: p(5.0, 5.0), end: p(9.0, 5.0) },
        Element::Line { start: p(9.0, 5.0), end: p(9.0, 9.0) },
    ])
    .unwrap();
    let found = offset(&path, -1.0, Corners::Sharp { limit: 1.5 }).unwrap();
    let ends: Vec<Point> = found.outlines[0].path.elements().iter().map(Element::end).collect();
    let expected = [p(6.0, -1.0), p(6.0, 4.0), p(10.0, 4.0), p(10.0, 9.0)];
    assert_eq!(ends.len(), expected.len());
    assert!(ends.iter().zip(&expected).all(|(a, b)| (a - b).norm() < 1e-9), "{ends:?}");
    assert!((found.outlines[0].path.start() - p(0.0, -1.0)).norm() < 1e-9);
}

#[test]
fn corners_that_point_at_each_other_stay_round_where_their_points_would_come_too_near() {
    // Two corners on a diagonal, 2.2 apart: a wire beside them passes at 1, and their points would be 0.8 from the other.
    let near = 10.0 + 2.2 / 2f64.sqrt();
    let path = polygon(&[
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 10.0),
        (5.0, 10.0),
        (5.0, 22.0),
        (near, 22.0),
        (near, near),
        (20.0, near),
        (20.0, 30.0),
        (0.0, 30.0),
    ]);
    let found = offset(&path, -1.0, Corners::Sharp { limit: 1.5 }).unwrap();
    assert_eq!((found.outlines.len(), found.unreached.len()), (1, 0));
    let arcs = found.outlines[0].path.elements().iter().filter(|way| matches!(way, Element::Arc { .. }));
    let centres: Vec<Point> = arcs.map(|arc| arc.extent()[0]).collect();
    assert_eq!(centres.len(), 2, "{centres:?}");
}

#[test]
fn an_arc_over_a_wall_that_goes_on_tells_half_the_way_to_the_wall() {
    // A room with a pocket under an arc: the wall below belongs to both and is touched in the room.
    let radius = (9.0f64 + 9.2 * 9.2).sqrt();
    let mouth = (radius * radius - 1.0).sqrt() - 9.2;
    let path = Path::new(vec![
        Element::Line { start: p(0.0, 0.0), end: p(14.0, 0.0) },
        Element::Arc {
            start: p(14.0, 0.0),
            end: p(10.0, mouth),
            centre: p(11.0, -9.2),
            sense: Sense::CounterClockwise,
        },
        Element::Line { start: p(10.0, mouth), end: p(10.0, 6.0) },
        Element::Line { start: p(10.0, 6.0), end: p(0.0, 6.0) },
        Element::Line { start: p(0.0, 6.0), end: p(0.0, 0.0) },
    ])
    .unwrap();
    let found = offset(&path, 0.5, Corners::Round).unwrap();
    let [pocket] = found.unreached[..] else { panic!("{:?}", found.unreached) };
    assert_eq!((pocket.first, pocket.last), (1, 1));
    assert!((pocket.largest - (radius - 9.2) / 2.0).abs() < 1e-4, "{pocket:?} {}", (radius - 9.2) / 2.0);
}

#[test]
fn half_a_circle_shrunk_to_a_point_vanishes_too() {
    let (start, end) = (p(2.0002, 0.0), p(1.9998, 0.0));
    let arc = Element::Arc { start, end, centre: p(2.0, 0.0), sense: Sense::Clockwise };
    let path = Path::new(vec![arc, Element::Line { start: end, end: p(9.0, 0.0) }]).unwrap();
    let rounded = offset(&path, 0.0, Corners::Round).unwrap().outlines[0].rounded().unwrap();
    assert_eq!(rounded.origins, [Origin::Element(1)]);
}

#[test]
fn an_elements_own_part_comes_before_its_corner_and_both_before_the_next() {
    let orders: Vec<usize> =
        (0..4).flat_map(|n| [Origin::Element(n).order(), Origin::Corner(n).order()]).collect();
    assert!(orders.is_sorted_by(|a, b| a < b), "{orders:?}");
}

#[test]
fn outlines_come_in_the_order_of_the_contour_wherever_it_begins() {
    let path = dumbbell();
    for first in 0..12 {
        let found = offset(&path.clone().begun_at(first), 0.5, Corners::Round).unwrap();
        let begun: Vec<usize> = found.outlines.iter().map(|outline| outline.origins[0].element()).collect();
        assert!(begun.len() == 2 && begun[0] < begun[1], "{first}: {begun:?}");
        // Each begins with the first element of the contour that it runs beside.
        for outline in &found.outlines {
            let least = outline.origins.iter().map(|origin| origin.element()).min();
            assert_eq!(Some(outline.origins[0].element()), least, "{first}");
        }
    }
}

#[test]
fn more_meetings_than_one_are_counted_in_words() {
    let told: Vec<String> = [1, 2, 3, 99, 100].into_iter().map(others).collect();
    let wanted = [
        "",
        " (and in one more place)",
        " (and in 2 more places)",
        " (and in 98 more places)",
        " (and in 99 more places at least)",
    ];
    assert_eq!(told, wanted);
}
