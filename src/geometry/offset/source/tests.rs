use super::*;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

/// The arc about a centre from one angle over a turn, positive counter-clockwise.
fn arc(centre: Point, radius: f64, from: f64, turn: f64) -> Element {
    let at = |angle: f64| centre + Vector::new(libm::cos(angle), libm::sin(angle)) * radius;
    let sense = if turn > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
    Element::Arc { start: at(from), end: at(from + turn), centre, sense }
}

#[test]
fn bulges_are_the_tangent_of_a_quarter_of_the_angle_swept() {
    for turn in [0.01, 0.5, 1.0, 1.57, 2.0, 3.0, 3.1] {
        for turn in [turn, -turn] {
            for radius in [0.1, 3.0, 500.0] {
                let element = arc(p(1.0, -2.0), radius, 0.7, turn);
                let source = Source::new(&Path::new(vec![element]).unwrap(), 0.05);
                let vertices: Vec<_> = source.polyline.iter_vertexes().collect();
                assert_eq!((vertices.len(), source.pieces.len(), source.elements), (2, 1, 1));
                assert!((vertices[0].bulge - libm::tan(turn / 4.0)).abs() < 1e-9, "{turn} {radius}");
                let piece = source.pieces[0];
                assert_eq!((piece.start, piece.end), (element.start(), element.end()));
                let chord = 2.0 * radius * libm::sin(turn.abs() / 2.0);
                assert!((piece.length - chord).abs() < 1e-9 * radius);
                let bend = piece.bend.unwrap();
                assert_eq!(bend.centre, p(1.0, -2.0));
                assert!((bend.radius - radius).abs() < 1e-9);
                assert!((bend.radius_beside(0.05) - (radius - 0.05 * turn.signum())).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn arcs_beyond_half_a_circle_are_two_pieces_that_meet_in_the_middle() {
    for turn in [3.2, 4.5, 6.0, 6.2] {
        for turn in [turn, -turn] {
            let element = arc(p(2.0, 0.0), 3.0, 0.3, turn);
            let source = Source::new(&Path::new(vec![element]).unwrap(), 0.05);
            let [first, second] = source.pieces[..] else { panic!("{turn}: {}", source.pieces.len()) };
            assert_eq!((first.start, first.end, second.end), (element.start(), second.start, element.end()));
            let middle =
                p(2.0, 0.0) + Vector::new(libm::cos(0.3 + turn / 2.0), libm::sin(0.3 + turn / 2.0)) * 3.0;
            assert!((first.end - middle).norm() < 1e-9, "{turn}");
            for vertex in source.polyline.iter_vertexes().take(2) {
                assert!((vertex.bulge - libm::tan(turn / 8.0)).abs() < 1e-9, "{turn}");
            }
        }
    }
    for sense in [Sense::Clockwise, Sense::CounterClockwise] {
        let circle = Source::new(&Path::circle(p(2.0, 0.0), 3.0, sense), 0.05);
        assert_eq!((circle.pieces.len(), circle.pieces[1].end), (2, circle.pieces[0].start));
        let way = circle.pieces[0].end - circle.pieces[0].start;
        assert!((way.norm() - 6.0).abs() < 1e-9 && (circle.pieces[0].length - 6.0).abs() < 1e-9);
        for vertex in circle.polyline.iter_vertexes() {
            assert!((vertex.bulge.abs() - 1.0).abs() < 1e-9);
            assert_eq!(vertex.bulge > 0.0, sense == Sense::CounterClockwise);
        }
    }
}

#[test]
fn half_a_circle_is_one_piece_even_where_it_comes_out_a_rounding_beyond() {
    for nudge in [0.0, 1e-12, -1e-12, 2e-10] {
        for sign in [1.0, -1.0] {
            let turn = (std::f64::consts::PI + nudge) * sign;
            let source = Source::new(&Path::new(vec![arc(p(0.0, 0.0), 4.0, 0.2, turn)]).unwrap(), 0.05);
            assert_eq!(source.pieces.len(), 1, "{nudge} {sign}");
        }
    }
    // A hundred-millionth of a turn beyond is beyond.
    let beyond = arc(p(0.0, 0.0), 4.0, 0.2, std::f64::consts::PI + 1e-7);
    assert_eq!(Source::new(&Path::new(vec![beyond]).unwrap(), 0.05).pieces.len(), 2);
}

#[test]
fn what_is_shorter_than_a_point_is_left_out_and_the_next_piece_begins_before_it() {
    let line = |a: (f64, f64), b: (f64, f64)| Element::Line { start: p(a.0, a.1), end: p(b.0, b.1) };
    let path = Path::new(vec![
        line((0.0, 0.0), (5.0, 0.0)),
        line((5.0, 0.0), (5.000_005, 0.0)),
        line((5.000_005, 0.0), (5.0, 4.0)),
        line((5.0, 4.0), (5.0, 4.000_02)),
        line((5.0, 4.000_02), (0.0, 0.0)),
    ])
    .unwrap();
    let source = Source::new(&path, 1.0);
    let elements: Vec<usize> = source.pieces.iter().map(|piece| piece.element).collect();
    assert_eq!((elements, source.elements), (vec![0, 2, 3, 4], 5));
    assert_eq!((source.pieces[1].start, source.pieces[1].end), (p(5.0, 0.0), p(5.0, 4.0)));
    assert_eq!(source.polyline.vertex_count(), 4);
    assert_eq!(source.pieces[0].bend.is_none(), source.pieces[3].bend.is_none());
    // A contour that ends a rounding from its start in what is left out still closes in one point.
    let open = Path::new(vec![line((0.0, 0.0), (5.0, 0.0)), line((5.0, 0.0), (5.0, 4.0))]).unwrap();
    let source = Source::new(&open, 1.0);
    let last = source.polyline.iter_vertexes().next_back().unwrap();
    assert_eq!((source.polyline.vertex_count(), last.x, last.y, last.bulge), (3, 5.0, 4.0, 0.0));
}

#[test]
fn a_circle_that_misses_an_end_by_a_rounding_is_drawn_through_both() {
    for (miss, kept) in [(0.0, true), (5e-10, true), (1e-6, false), (-1e-5, false)] {
        let (start, end, centre) = (p(3.0, 0.0), p(0.0, 3.0 + miss), Point::origin());
        for (element, sign) in [
            (Element::Arc { start, end, centre, sense: Sense::CounterClockwise }, 1.0),
            (Element::Arc { start: end, end: start, centre, sense: Sense::Clockwise }, -1.0),
        ] {
            let source = Source::new(&Path::new(vec![element]).unwrap(), 0.05 * sign);
            let bend = source.pieces[0].bend.unwrap();
            assert_eq!(bend.centre == centre, kept, "{miss}");
            let (from, to) = (element.start() - bend.centre, element.end() - bend.centre);
            assert!((from.norm() - bend.radius).abs() < 1e-9 && (to.norm() - bend.radius).abs() < 1e-9);
            assert!((bend.centre - centre).norm() <= miss.abs());
        }
    }
}

#[test]
fn a_cross_product_is_positive_to_the_left() {
    assert_eq!(cross(Vector::new(2.0, 0.0), Vector::new(5.0, 3.0)), 6.0);
    assert_eq!(cross(Vector::new(1.0, 2.0), Vector::new(3.0, 4.0)), -2.0);
}
