use super::*;
use crate::formats::three_b::Axis;
use crate::geometry::Vector;

const MODELS: [Model; 2] = [Model::Rotated, Model::Exact];

fn told(text: &str, model: Model) -> Vec<Motion> {
    Motions::of_three_b(text.as_bytes(), model).map(|motion| motion.unwrap()).collect()
}

fn element(motion: &Motion) -> Element {
    let Act::Move { element, .. } = motion.act else { panic!("{motion:?} is a move") };
    element
}

fn elements(text: &str, model: Model) -> Vec<Element> {
    told(text, model).iter().map(element).collect()
}

/// The ends of lines and arcs, in whole microns.
fn ends(elements: &[Element]) -> Vec<Position> {
    elements.iter().map(|element| Position::nearest(element.end())).collect()
}

#[test]
fn half_and_whole_turns_end_where_the_circle_says() {
    // About (−5, 0) from (0, 0): every half turn counts 10 mm along Y.
    for model in MODELS {
        for (j, wanted) in [
            (10_000, vec![(-10_000, 0)]),
            (20_000, vec![(0, 0)]),
            (30_000, vec![(-10_000, 0), (0, 0), (-10_000, 0)]),
            (40_000, vec![(-10_000, 0), (0, 0), (-10_000, 0), (0, 0)]),
        ] {
            let found = elements(&format!("B5000B0B{j}GYNR1"), model);
            assert_eq!(found.len(), wanted.len(), "{j}");
            for (way, (x, y)) in found.iter().zip(wanted) {
                let Element::Arc { centre, sense, .. } = *way else { panic!("{way:?} is an arc") };
                assert_eq!((centre, sense), (Point::new(-5.0, 0.0), Sense::CounterClockwise));
                assert_eq!(Position::nearest(way.end()), Position::new(x, y), "{j} {model:?}");
            }
        }
    }
}

#[test]
fn an_arc_is_as_long_as_its_count_says_however_it_is_told() {
    // Turns of a circle of 3 mm from a point on an axis, both ways; the count of a turn is 12 mm along either axis.
    for model in MODELS {
        for (turns, pieces) in [
            (0.001, 1),
            (0.25, 1),
            (0.5, 1),
            (0.75, 1),
            (0.9, 1),
            (0.999, 1),
            (1.0, 1),
            (1.001, 2),
            (1.125, 2),
            (1.249, 2),
            (1.25, 3),
            (1.5, 3),
            (1.75, 4),
            (2.0, 4),
            (2.25, 5),
        ] {
            let whole = (turns * 4.0f64).floor();
            // Within a quarter the count is a sine or what is left of a cosine; Y grows first from (3, 0).
            let rest = (turns * 4.0 - whole).clamp(0.0, 1.0);
            let within = if whole % 2.0 == 0.0 { libm::asin(rest) } else { libm::acos(1.0 - rest) };
            let wanted = 3.0 * (whole * std::f64::consts::FRAC_PI_2 + within);
            let j = (12_000.0 * turns).round();
            for text in [format!("B3000B0B{j}GYNR1"), format!("B3000B0B{j}GYSR4")] {
                let found = elements(&text, model);
                let length: f64 = found.iter().map(Element::length).sum();
                assert_eq!(found.len(), pieces, "{text} {model:?}");
                // An end may lie a micron beside its circle, where the circle runs flat that is more along it.
                assert!((length - wanted).abs() < 0.08, "{text} {model:?}: {length} {wanted}");
                assert!(found.windows(2).all(|pair| pair[0].end() == pair[1].start()));
            }
        }
    }
}

#[test]
fn away_from_the_axes_and_from_the_start_arcs_are_as_long_as_their_turns_too() {
    // From (3, 4) about the centre, 5 mm of radius; half a turn is twice the radius along either axis, wherever it begins.
    for (turns, count) in [(0.5, 10_000), (1.0, 20_000), (1.5, 30_000), (2.0, 40_000)] {
        for block in [format!("B3000B4000B{count}GXNR1"), format!("B3000B4000B{count}GYSR1")] {
            let found = elements(&format!("B7000B3000B7000GXL4{block}"), Model::Rotated);
            let length: f64 = found[1..].iter().map(Element::length).sum();
            let wanted = turns * 10.0 * std::f64::consts::PI;
            assert!((length - wanted).abs() < 0.02, "{block}: {length} {wanted}");
        }
    }
    // Down from 4 to 3 by X from 3 to 4, an arc of the angle between the two; and the same beyond a turn.
    let angle = libm::atan2(4.0, 3.0) - libm::atan2(3.0, 4.0);
    for (turns, count) in [(0.0, 1000), (1.0, 21_000)] {
        for block in [
            format!("B3000B4000B{count}GYSR1"),
            format!("B4000B3000B{count}GXNR1"),
            format!("B4000B3000B{count}GYNR1"),
            format!("B3000B4000B{count}GXSR1"),
        ] {
            let found = elements(&format!("B9000B20000B20000GYL1{block}"), Model::Rotated);
            let length: f64 = found[1..].iter().map(Element::length).sum();
            let wanted = 5.0 * (angle + turns * std::f64::consts::TAU);
            assert!(found[1..].iter().all(|way| matches!(way, Element::Arc { .. })), "{block}");
            assert!((length - wanted).abs() < 0.02, "{block}: {length} {wanted}");
        }
    }
}

#[test]
fn equal_pieces_of_a_count_lie_where_the_circle_has_used_it_up() {
    // Two and a half turns of 1 mm, counted along X from (1, 0): five half turns, 2 mm of X each.
    let found = elements("B1000B0B10000GXNR1", Model::Exact);
    let wanted = [(-2000, 0), (0, 0), (-2000, 0), (0, 0), (-2000, 0)].map(|(x, y)| Position::new(x, y));
    assert_eq!(ends(&found), wanted);
}

#[test]
fn an_arc_of_a_pulse_or_two_that_gets_nowhere_ahead_is_a_line_and_not_a_turn() {
    // Where the circle runs along X, one pulse of Y comes after many of X; none of these is a fifth of a turn.
    for text in
        ["B0B5000B1GXSR1", "B0B5000B1GYSR1", "B5000B0B1GXNR1", "B5000B0B1GYNR1", "B3B4B1GXNR1", "B3B4B1GYSR1"]
    {
        for model in Model::ALL {
            let length: f64 = elements(text, model).iter().map(Element::length).sum();
            assert!(length < 0.2, "{text} {model:?}: {length}");
        }
    }
}

#[test]
fn a_count_of_nothing_moves_nothing_whatever_the_radius() {
    for radius in [0, 1, 2, 5000] {
        for model in Model::ALL {
            let found = elements(&format!("B{radius}B0B0GXNR1B0B{radius}B0GYSR1"), model);
            let still = Element::Line { start: Point::origin(), end: Point::origin() };
            assert_eq!(found, [still, still], "{radius} {model:?}");
        }
    }
}

#[test]
fn blocks_are_counted_and_stops_and_remarks_belong_to_the_block_before_them() {
    let text = "%\nB1000B0B1000GXL1 ; out\nB0B500B500GYL2\nB1000B0B1000GXL3\nD\n";
    let told = told(text, Model::Rotated);
    let blocks: Vec<u64> = told.iter().map(|motion| motion.block).collect();
    assert_eq!(blocks, [0, 1, 1, 2, 3, 3]);
    let lines: Vec<u64> = told.iter().map(|motion| motion.spot.line).collect();
    assert_eq!(lines, [1, 2, 2, 3, 4, 5]);
    assert_eq!(told[5].act, Act::Stop(Stop::Pause));
}

#[test]
fn the_last_block_and_its_text_are_those_of_the_motion_just_told() {
    let circle = "B1000B0B08000GYNR1";
    let source = format!("b0 b500b500 gyl2\n{circle}\nDD\n");
    let mut motions = Motions::of_three_b(source.as_bytes(), Model::Rotated);
    assert_eq!((motions.last_block(), motions.stands()), (None, Position::new(0, 0)));
    motions.next().unwrap().unwrap();
    assert_eq!(motions.last_block(), Some(Block::line(Position::new(0, 500))));
    assert_eq!((motions.text(), motions.stands()), (&b"B0B500B500GYL2"[..], Position::new(0, 500)));
    // Two turns are four pieces of one block.
    for (piece, stands) in [(0, -2000), (1, 0), (2, -2000), (3, 0)] {
        motions.next().unwrap().unwrap();
        assert_eq!(motions.last_block().is_some(), piece == 0, "{piece}");
        assert_eq!((motions.text(), motions.stands()), (circle.as_bytes(), Position::new(stands, 500)));
    }
    assert_eq!(motions.next().unwrap().unwrap().act, Act::Stop(Stop::End));
    assert_eq!((motions.last_block(), motions.text()), (None, &b"DD"[..]));
    assert!(motions.next().is_none());
}

#[test]
fn behind_an_error_the_program_goes_on_from_where_the_control_stands() {
    for four_b in [false, true] {
        let of = |text: &'static str| {
            let source = text.as_bytes();
            if four_b {
                Motions::of_four_b(source, Model::Rotated)
            } else {
                Motions::of_three_b(source, Model::Rotated)
            }
        };
        let mut motions = of("B1000B0B1000GXL1\nB1000B0B8000GYNR1\nB7Q");
        // The error is met within the round, and nothing of the round is told again.
        motions.next().unwrap().unwrap();
        motions.next().unwrap().unwrap();
        motions.go_on_from(&b"B7Q"[..]);
        assert!(motions.next().unwrap().is_err());
        assert!(motions.next().is_none());
        motions.go_on_from(&b"B0B500B500GYL2\nB1000B0B1000B1000DGXNR1\n"[..]);
        let next = motions.next().unwrap().unwrap();
        let (start, end) = (Point::new(-1.0, 0.0), Point::new(-1.0, 0.5));
        assert_eq!((element(&next), next.block), (Element::Line { start, end }, 3));
        // A fourth B is read where 4B is, and refused where only 3B is.
        match motions.next().unwrap() {
            Ok(arc) => {
                assert!(four_b);
                let Act::Move { flag, .. } = arc.act else { panic!("{arc:?} is a move") };
                assert_eq!(flag, Some(Flag::D));
            }
            Err(error) => assert!(!four_b && error.to_string().contains("4B"), "{error}"),
        }
    }
}

#[test]
fn a_kilometre_from_the_start_is_reached_and_not_passed() {
    for (at, block, back) in [
        ((COORDINATE_MAX - 1000, 0), "B1000B0B1000GXL1", "B1000B0B1000GXL3"),
        ((0, 1000 - COORDINATE_MAX), "B0B1000B1000GYL4", "B0B1000B1000GYL2"),
    ] {
        let source = format!("{block}{back}{block}{block} ; beyond what any machine can reach");
        let mut motions = Motions::of_three_b(source.as_bytes(), Model::Rotated);
        motions.at = Position::new(at.0, at.1);
        for _ in 0..3 {
            motions.next().unwrap().unwrap();
        }
        let error = motions.next().unwrap().unwrap_err();
        assert!(error.to_string().contains("more than a kilometre"), "{error}");
        let ReadError::Program { place, .. } = error else { panic!("{error}") };
        assert_eq!((place.line, place.column, place.width), (1, 3 * 16 + 1, 16));
    }
}

#[test]
fn a_ratio_of_taper_is_told_before_the_way_of_its_block() {
    let source = &b"B0B5000B5000L0.5DGYL2\nB1000B0B1000GXL1"[..];
    let told: Vec<_> = Motions::of_four_b(source, Model::Rotated).map(|motion| motion.unwrap()).collect();
    assert_eq!(told.len(), 3);
    assert_eq!(told[0].act, Act::Word(b"L0.5".as_slice().into()));
    let Act::Move { flag, element, travel, upper } = told[1].act.clone() else { panic!("{told:?}") };
    assert_eq!((flag, travel, upper), (Some(Flag::D), Travel::Cut, None));
    assert_eq!(element.end() - element.start(), Vector::new(0.0, 5.0));
    assert_eq!(told.iter().map(|motion| motion.block).collect::<Vec<_>>(), [1, 1, 2]);
}

#[test]
fn a_line_number_is_a_header_and_a_remark_is_itself() {
    let told = told("N  7: B1000B0B1000GXL1 (one)\n", Model::Rotated);
    assert_eq!(told[0].act, Act::Header(b"N7".as_slice().into()));
    assert_eq!(told[2].act, Act::Comment(b"one".as_slice().into()));
}

#[test]
fn the_count_of_a_quarter_turn_leads_ahead_of_the_start_at_once_and_a_turn_later() {
    let (mut tried, size) = (0, 12i64);
    for (x, y) in (-size..=size).flat_map(|x| (-size..=size).map(move |y| (x, y))).filter(|at| *at != (0, 0))
    {
        for (sense, sign) in [(Sense::CounterClockwise, 1), (Sense::Clockwise, -1)] {
            for (model, g) in Model::ALL.into_iter().flat_map(|m| [(m, Axis::X), (m, Axis::Y)]) {
                let start = Position::new(x, y);
                let turn = Branch::at(start, sense).unwrap().turn(model.bend());
                for j in [turn / 4.0, turn * 1.25].into_iter().filter(|j| *j >= 1.0 && j.fract() == 0.0) {
                    let block = Block::arc(start, sense, g, Micrometres(j as i64));
                    let Ok(moved) = model.displacement(&block) else { continue };
                    assert!(sign * (x * moved.y.0 - y * moved.x.0) > 0, "{block:?} {model:?} {moved:?}");
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 5000, "{tried}");
}
