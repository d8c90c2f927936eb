use super::*;
use crate::formats::Writer as _;
use crate::formats::three_b::write::{Form, Writer};
use crate::geometry::Sense;
use crate::interpolator::Model;
use crate::motion::{Act, Motion, Stop};

fn motion(act: Act) -> Motion {
    Motion { act, block: 1, spot: Spot { byte: 0, line: 1, column: 1 } }
}

fn cut(element: Element) -> Motion {
    motion(Act::Move { travel: Travel::Cut, element, upper: None, flag: None })
}

fn line(from: (f64, f64), to: (f64, f64)) -> Element {
    Element::Line { start: Point::new(from.0, from.1), end: Point::new(to.0, to.1) }
}

/// The counter-clockwise arc that stands off its chord by half the chord times the bulge.
fn arc(start: Point, end: Point, bulge: f64) -> Element {
    let way = end - start;
    let aside = (1.0 - bulge * bulge) / (4.0 * bulge);
    let centre = start + way * 0.5 + Vector::new(-way.y, way.x) * aside;
    Element::Arc { start, end, centre, sense: Sense::CounterClockwise }
}

fn written(form: Form, elements: &[Element]) -> Result<String, WriteError> {
    let (mut writer, mut text) = (Writer::new(form), Vec::new());
    for &element in elements {
        writer.write(&cut(element), &mut text)?;
    }
    Ok(String::from_utf8(text).unwrap())
}

fn rotated() -> Form {
    Form { aim: Aim::One(Model::Rotated), ..Form::default() }
}

/// Numbers between 0 and 1 without end.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    }
}

/// A writer that is led in by so many arcs and goes three times round a loop of three others, with a pause behind the
/// arcs named; where it stands when the loop opens and after each turn, and where the node of the opening is nearest to.
fn rounds(writer: &mut Writer, seed: u64, lead: usize, pauses: &[usize]) -> ([Position; 4], Position, Point) {
    let mut number = numbers(seed);
    let mut node = || Point::new(2.0 + number(), 3.0 + number());
    let nodes: Vec<Point> = (0..lead + 3).map(|_| node()).collect();
    rounds_through(writer, &nodes, lead, pauses)
}

fn rounds_through(
    writer: &mut Writer,
    nodes: &[Point],
    lead: usize,
    pauses: &[usize],
) -> ([Position; 4], Position, Point) {
    let mut text = Vec::new();
    for pair in nodes[..=lead].windows(2) {
        writer.write(&cut(arc(pair[0], pair[1], 0.3)), &mut text).unwrap();
    }
    let loop_nodes = &nodes[lead..];
    let opened = if lead == 0 { Position::nearest(nodes[0]) } else { writer.stands() };
    let mut stands = [opened; 4];
    for turn in &mut stands[1..] {
        for n in 0..3 {
            writer.write(&cut(arc(loop_nodes[n], loop_nodes[(n + 1) % 3], 0.3)), &mut text).unwrap();
            if pauses.contains(&n) {
                writer.write(&motion(Act::Stop(Stop::Pause)), &mut text).unwrap();
            }
        }
        *turn = writer.stands();
    }
    (stands, Position::nearest(nodes[lead]), nodes[lead])
}

#[test]
fn whatever_leads_in_a_contour_closes_on_the_micron_where_it_opened_turn_after_turn() {
    // A pause on one of the first nodes may be the end of a contour; one behind them is a stop on the way round.
    for (leads, pauses) in [(0..4, &[][..]), (3..4, &[0]), (3..4, &[1])] {
        let (mut elsewhere, mut tried) = (0, 0);
        for seed in 1..60 {
            for lead in leads.clone() {
                let (stands, nearest, _) = rounds(&mut Writer::new(Form::default()), seed, lead, pauses);
                assert_eq!(stands, [stands[0]; 4], "{seed} {lead} {pauses:?}");
                elsewhere += u32::from(stands[0] != nearest);
                tried += 1;
            }
        }
        // On the nearest micron it would have closed without being told to.
        assert!(elsewhere > tried / 20, "{elsewhere} of {tried}");
    }
}

#[test]
fn where_one_contour_ends_in_a_pause_the_next_closes_as_well() {
    let mut elsewhere = 0;
    for seed in 1..120 {
        let mut writer = Writer::new(Form::default());
        let (_, _, at) = rounds(&mut writer, seed, 3, &[]);
        writer.write(&motion(Act::Stop(Stop::Pause)), &mut Vec::new()).unwrap();
        let mut number = numbers(seed + 1000);
        let mut nodes = vec![at];
        nodes.extend((0..3).map(|_| Point::new(2.0 + number(), 3.0 + number())));
        let (stands, nearest, _) = rounds_through(&mut writer, &nodes, 1, &[]);
        assert_eq!(stands, [stands[0]; 4], "{seed}");
        elsewhere += u32::from(stands[0] != nearest);
    }
    assert!(elsewhere > 10, "{elsewhere}");
}

#[test]
fn a_full_circle_ends_where_it_began_whatever_came_before() {
    let mut elsewhere = 0;
    for seed in 1..80 {
        let mut number = numbers(seed);
        let mut node = || Point::new(2.0 + number(), 3.0 + number());
        let nodes: Vec<Point> = (0..7).map(|_| node()).collect();
        let mut writer = Writer::new(Form::default());
        let mut text = Vec::new();
        for pair in nodes[..6].windows(2) {
            writer.write(&cut(arc(pair[0], pair[1], 0.3)), &mut text).unwrap();
        }
        let stood = writer.stands();
        let (start, centre) = (nodes[5], nodes[6]);
        let circle = Element::Arc { start, end: start, centre, sense: Sense::Clockwise };
        writer.write(&cut(circle), &mut text).unwrap();
        assert_eq!(writer.stands(), stood, "{seed}");
        elsewhere += u32::from(stood != Position::nearest(start));
    }
    assert!(elsewhere > 5, "{elsewhere}");
}

#[test]
fn a_gap_of_three_microns_is_rounding_and_a_larger_one_is_refused() {
    let to = |start: (f64, f64)| written(rotated(), &[line((1.0, 1.0), (0.0, 0.0)), line(start, (0.0, 5.0))]);
    for start in [(0.003, 0.0), (-0.003, 0.0), (0.0, -0.003), (0.0018, 0.0024)] {
        assert!(to(start).is_ok(), "{start:?}");
    }
    for start in [(0.00301, 0.0), (0.0, 0.0031), (0.0022, 0.0022)] {
        assert!(to(start).unwrap_err().message.contains("ended at (0.000, 0.000)"), "{start:?}");
    }
    // The gap is seen where it is, not about the origin.
    let away = [line((0.0, 0.0), (500.0, 500.0)), line((500.0, 500.002), (500.0, 501.0))];
    assert!(written(rotated(), &away).is_ok());
}

/// A clockwise arc of a radius from (−half, 0) to (half, 0), over its chord.
fn flat(radius: f64, half: f64) -> Element {
    let centre = Point::new(0.0, -(radius * radius - half * half).sqrt());
    Element::Arc {
        start: Point::new(-half, 0.0),
        end: Point::new(half, 0.0),
        centre,
        sense: Sense::Clockwise,
    }
}

#[test]
fn a_circle_of_eight_digits_is_a_block_and_a_larger_one_is_chords() {
    // About (0, −99 999): X and Y of the start are 0 and 99 999 000 µm, eight digits.
    let quarter = |radius: f64| Element::Arc {
        start: Point::origin(),
        end: Point::new(radius * 0.6, radius * 0.8 - radius),
        centre: Point::new(0.0, -radius),
        sense: Sense::Clockwise,
    };
    assert_eq!((chords(&quarter(99_999.0)), chords(&quarter(50_000.0))), (0, 0));
    assert!(chords(&quarter(99_999.01)) > 4000);
    assert_eq!(chords(&line((0.0, 0.0), (1e6, 1e6))), 0);
    let block = written(rotated(), &[flat(99_000.0, 50.0)]).unwrap();
    assert!(block.contains("SR"), "{block}");
}

#[test]
fn chords_bow_out_by_a_quarter_of_a_micron_and_are_no_more_than_that_takes() {
    for (radius, half) in [(2e6, 500.0), (1e5, 300.0), (1e9, 20_000.0), (1e9, 1.0)] {
        let way = flat(radius, half);
        let count = chords(&way);
        // An arc over a chord c is c² / 8r high.
        let bow = |count: u64| {
            let chord = 2.0 * half / count as f64;
            chord * chord / (8.0 * radius)
        };
        assert!(bow(count) < 0.000_250_1, "{radius} {half}: {count}");
        assert!(count == 1 || bow(count - 1) > 0.000_249_9, "{radius} {half}: {count}");
    }
}

#[test]
fn the_nodes_of_chords_lie_on_the_arc_one_behind_the_other() {
    let (radius, half) = (2e6, 500.0);
    let text = written(rotated(), &[flat(radius, half)]).unwrap();
    let (mut x, mut y) = (-500_000.0f64, 0.0f64);
    let mut count = 0;
    for block in text.lines() {
        // Every chord runs to the right: up in the first half (L1), down in the second (L4).
        let numbers: Vec<f64> =
            block[1..block.find('G').unwrap()].split('B').map(|n| n.parse().unwrap()).collect();
        x += numbers[0];
        y += if block.ends_with("L1") { numbers[1] } else { -numbers[1] };
        count += 1;
        let rise = half * half / (2.0 * radius) * 1000.0 - x * x / (2.0 * radius * 1000.0);
        assert!((y - rise).abs() < 1.0, "{block}: {x} {y} {rise}");
        assert!(numbers[0] > 60_000.0 && numbers[0] < 63_300.0, "{block}");
    }
    assert_eq!((count, x, y), (16, 500_000.0, 0.0));
}

#[test]
fn a_contour_closed_by_chords_closes_on_the_micron_where_it_opened() {
    let mut elsewhere = 0;
    for seed in 1..60 {
        let mut number = numbers(seed);
        let mut node = |x: f64| Point::new(x + number(), number());
        let (first, left, right) = (node(-1.0), node(-400.0), node(400.0));
        let mut writer = Writer::new(Form::default());
        let mut text = Vec::new();
        let near = |radius: f64| radius / (right - left).norm();
        // The bulge of an arc far larger than its chord is a quarter of the chord over the radius.
        let elements =
            [arc(first, left, 0.3), arc(left, right, 0.25 / near(2e5)), arc(right, left, 0.25 / near(3e5))];
        writer.write(&cut(elements[0]), &mut text).unwrap();
        let opened = writer.stands();
        for element in &elements[1..] {
            writer.write(&cut(*element), &mut text).unwrap();
        }
        assert_eq!(writer.stands(), opened, "{seed}");
        elsewhere += u32::from(opened != Position::nearest(left));
    }
    assert!(elsewhere > 3, "{elsewhere}");
}

#[test]
fn a_kilometre_each_way_and_a_thousand_of_radius_are_reached_and_no_more() {
    let spot = Spot { byte: 0, line: 1, column: 1 };
    let reached = |element: Element| within_reach(&element, spot).is_ok();
    let (far, beyond) = (1e6, 1e6 + 1.0);
    for sign in [1.0, -1.0] {
        assert!(reached(line((sign * far, sign * far), (-sign * far, far))));
        for place in [(sign * beyond, 0.0), (0.0, sign * beyond)] {
            assert!(!reached(line(place, (0.0, 0.0))) && !reached(line((0.0, 0.0), place)), "{place:?}");
        }
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(!reached(line((bad, 0.0), (0.0, 0.0))) && !reached(line((0.0, 0.0), (0.0, bad))));
        let centre = Point::new(bad, 0.0);
        let (start, end) = (Point::origin(), Point::new(1.0, 0.0));
        assert!(!reached(Element::Arc { start, end, centre, sense: Sense::Clockwise }));
    }
    assert!(reached(flat(5.0, 3.0)) && reached(flat(1e9, 3.0)) && !reached(flat(1.01e9, 3.0)));
    // A circle about a far centre, from top to bottom: its ends are within reach, the middle of its way is not.
    let bowed = |out: f64, radius: f64| {
        let centre = Point::new(out - radius, 0.0);
        let x = centre.x + 0.6 * radius;
        let (start, end) = (Point::new(x, 0.8 * radius), Point::new(x, -0.8 * radius));
        Element::Arc { start, end, centre, sense: Sense::Clockwise }
    };
    assert!(reached(bowed(999_999.0, 500_000.0)) && !reached(bowed(1_000_001.0, 500_000.0)));
    assert!(reached(bowed(999_999.0, 50_000.0)));
}
