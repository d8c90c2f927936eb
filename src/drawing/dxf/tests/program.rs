//! Drawings as programs: motions of contours, motions written as drawings, and the same motions read again.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::formats::Writer;
use crate::motion::{Act, Offset, Side, Stop, Taper, Travel};
use crate::place::Spot;

fn motion(act: Act) -> Motion {
    Motion { act, block: 1, spot: Spot::default() }
}

fn travel(travel: Travel, element: Element) -> Motion {
    motion(Act::Move { travel, element, upper: None, flag: None })
}

fn written(motions: impl IntoIterator<Item = Motion>) -> String {
    let (mut writer, mut text) = (DxfWriter::new(), Vec::new());
    for motion in motions {
        writer.write(&motion, &mut text).unwrap();
    }
    writer.finish(&mut text).unwrap();
    String::from_utf8(text).unwrap()
}

fn moves(drawing: &Drawing) -> Vec<(Travel, Element)> {
    drawing
        .motions()
        .filter_map(|motion| match motion.act {
            Act::Move { travel, element, .. } => Some((travel, element)),
            _ => None,
        })
        .collect()
}

/// What a drawing's motions are, a word for each.
fn told(drawing: &Drawing) -> Vec<String> {
    drawing
        .motions()
        .map(|motion| match motion.act {
            Act::Move { travel: Travel::Rapid, element, .. } => format!("rapid to {}", element.end()),
            Act::Move { travel: Travel::Cut, element, .. } => format!("cut to {}", element.end()),
            Act::Stop(stop) => format!("{stop:?}"),
            Act::Comment(text) => String::from_utf8_lossy(&text).into_owned(),
            other => format!("{other:?}"),
        })
        .collect()
}

#[test]
fn the_wire_is_cut_and_threaded_between_contours_and_nowhere_else() {
    let drawing = read_text(
        &file("0 CIRCLE|8 OUT|10 0|20 0|40 9|0 CIRCLE|8 HOLE|10 3|20 0|40 2|0 CIRCLE|8 HOLE|10 -4|20 0|40 2"),
        &Options { start: Start::AsDrawn, ..Options::default() },
    );
    let expected = [
        "layer HOLE",
        "rapid to {-2, 0}",
        "cut to {-2, 0}",
        "layer HOLE",
        "Pause",
        "rapid to {5, 0}",
        "Pause",
        "cut to {5, 0}",
        "layer OUT",
        "Pause",
        "rapid to {9, 0}",
        "Pause",
        "cut to {9, 0}",
        "End",
    ];
    assert_eq!(told(&drawing), expected);
    let blocks: Vec<u64> = drawing.motions().map(|m| m.block).collect();
    assert!(blocks.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn a_program_written_as_a_drawing_is_read_in_its_own_order() {
    let p = point;
    let corner = p(10.0, 0.0);
    let circle = Element::Arc { start: corner, end: corner, centre: p(7.0, 4.0), sense: Sense::Clockwise };
    let elements = [
        (Travel::Rapid, line((0.0, 0.0), (10.0, 0.0))),
        (Travel::Cut, circle),
        (Travel::Cut, circle.reversed()),
        (Travel::Rapid, Element::Line { start: corner, end: p(30.0, 5.0) }),
        (Travel::Cut, line((30.0, 5.0), (40.0, 5.0))),
        (
            Travel::Cut,
            Element::Arc {
                start: p(40.0, 5.0),
                end: p(30.0, 5.0),
                centre: p(35.0, 5.0),
                sense: Sense::Clockwise,
            },
        ),
    ];
    let drawing = read_text(&written(elements.map(|(t, e)| travel(t, e))), &Options::default());
    assert_eq!(codes(&drawing), ["in-order"]);
    assert_eq!(drawing.units.known, Known::Stated);
    let found = moves(&drawing);
    assert_eq!(found.len(), elements.len());
    for ((travel, element), (expected_travel, expected)) in found.into_iter().zip(elements) {
        assert_eq!(travel, expected_travel);
        assert_same(&element, &expected, 1e-12);
    }
    let layers: Vec<&str> = drawing.contours.iter().map(|c| c.layer.as_str()).collect();
    assert_eq!(layers, [RAPID, CUT, RAPID, CUT]);
}

#[test]
fn what_is_no_way_stands_in_remarks() {
    let acts = [
        Act::Header(b"%".to_vec().into()),
        Act::Comment(b"first cut\r\n0".to_vec().into()),
        Act::Offset(Offset::On { side: Side::Left, distance: Some(0.1), register: Some(3) }),
        Act::Taper(Taper::On { side: Side::Right, angle: 1.5 }),
        Act::Word(b"C001".to_vec().into()),
        Act::Dwell(0.5),
        Act::Stop(Stop::Pause),
    ];
    let text = written(acts.into_iter().map(motion));
    for remark in
        ["; %", "; first cut  0", "; offset left 0.1 mm register 3", "; taper right 1.5 degrees", "; C001"]
    {
        assert!(text.contains(&format!("999\n{remark}\n")), "{remark} in {text}");
    }
    let drawing = read_text(&text, &Options::default());
    assert_eq!(codes(&drawing), ["in-order", "nothing-to-cut"]);
    // What passes for a remark of the file's own is none.
    let forged = written([motion(Act::Comment(b"clockwise".to_vec().into()))]);
    assert!(!forged.contains("999\nclockwise"));
}

#[test]
fn a_number_that_is_none_is_refused() {
    let (mut writer, mut text) = (DxfWriter::new(), Vec::new());
    let endless = travel(Travel::Cut, line((0.0, 0.0), (f64::INFINITY, 0.0)));
    assert_eq!(writer.write(&endless, &mut text).unwrap_err().to_string(), "a coordinate is not finite");
}

#[test]
fn the_ways_of_the_upper_end_have_a_layer_of_their_own() {
    let lower = line((0.0, 0.0), (10.0, 0.0));
    let act = Act::Move {
        travel: Travel::Cut,
        element: lower,
        upper: Some(line((0.0, 1.0), (10.0, 2.0))),
        flag: None,
    };
    let drawing = read_text(&written([motion(act)]), &Options::default());
    assert_eq!(codes(&drawing), ["upper-end", "in-order"]);
    assert_eq!(moves(&drawing), [(Travel::Cut, lower)]);
}

#[track_caller]
fn assert_same(a: &Element, b: &Element, within: f64) {
    let near = |p: Point, q: Point| (p - q).norm() <= within;
    let same = near(a.start(), b.start()) && near(a.end(), b.end());
    let round = match (a, b) {
        (Element::Arc { centre, sense, .. }, Element::Arc { centre: other, sense: way, .. }) => {
            near(*centre, *other) && sense == way
        }
        (Element::Line { .. }, Element::Line { .. }) => true,
        _ => false,
    };
    assert!(same && round, "{a:?}\n{b:?}");
}

/// A step of a random path: a line, an arc to either side, a circle, or a jump.
#[derive(Clone, Debug)]
enum Step {
    Line(f64, f64),
    Jump(f64, f64),
    Arc { radius: f64, from: f64, sweep: f64, sense: Sense },
    Circle { radius: f64, from: f64, sense: Sense },
}

fn sense() -> impl Strategy<Value = Sense> {
    prop_oneof![Just(Sense::Clockwise), Just(Sense::CounterClockwise)]
}

fn step() -> impl Strategy<Value = Step> {
    let away = || prop_oneof![-500.0..-0.05_f64, 0.05..500.0_f64];
    prop_oneof![
        (away(), away()).prop_map(|(x, y)| Step::Line(x, y)),
        (away(), away()).prop_map(|(x, y)| Step::Jump(x, y)),
        (0.1..300.0_f64, 0.0..TAU, 0.2..6.0_f64, sense())
            .prop_map(|(radius, from, sweep, sense)| Step::Arc { radius, from, sweep, sense }),
        (0.1..300.0_f64, 0.0..TAU, sense()).prop_map(|(radius, from, sense)| Step::Circle {
            radius,
            from,
            sense
        }),
    ]
}

fn walked(steps: &[Step]) -> Vec<(Travel, Element)> {
    let mut at = Point::origin();
    let mut path = Vec::new();
    for step in steps {
        let (travel, element) = match *step {
            Step::Line(x, y) => (Travel::Cut, Element::Line { start: at, end: point(at.x + x, at.y + y) }),
            Step::Jump(x, y) => (Travel::Rapid, Element::Line { start: at, end: point(at.x + x, at.y + y) }),
            Step::Arc { radius, from, sweep, sense } => {
                let way =
                    |angle: f64| crate::geometry::Vector::new(libm::cos(angle), libm::sin(angle)) * radius;
                let centre = at - way(from);
                let turn = if sense == Sense::Clockwise { -sweep } else { sweep };
                (Travel::Cut, Element::Arc { start: at, end: centre + way(from + turn), centre, sense })
            }
            Step::Circle { radius, from, sense } => {
                let centre = at - crate::geometry::Vector::new(libm::cos(from), libm::sin(from)) * radius;
                (Travel::Cut, Element::Arc { start: at, end: at, centre, sense })
            }
        };
        path.push((travel, element));
        at = element.end();
    }
    path
}

proptest! {
    /// Any path comes back from a drawing with every end, centre and sense, within a nanometre's thousandth.
    #[test]
    fn a_path_written_and_read_is_the_same_path(steps in prop::collection::vec(step(), 1..40)) {
        let path = walked(&steps);
        let text = written(path.iter().map(|&(t, e)| travel(t, e)));
        let drawing = read_text(&text, &Options::default());
        let found = moves(&drawing);
        prop_assert_eq!(found.len(), path.len());
        for ((travel, element), (expected_travel, expected)) in found.into_iter().zip(path) {
            prop_assert_eq!(travel, expected_travel);
            assert_same(&element, &expected, 1e-9);
        }
    }
}
