use super::*;
use crate::formats::ReadError;
use crate::geometry::{Path, Sense};
use crate::motion::Travel;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn said(block: u64, act: Act) -> Result<Motion, ReadError> {
    Ok(Motion { act, block, spot: Spot { byte: block * 10, line: block, column: 1 } })
}

fn cut(block: u64, element: Element) -> Result<Motion, ReadError> {
    said(block, Act::Move { travel: Travel::Cut, element, upper: None, flag: None })
}

fn on(block: u64, side: Side, distance: f64) -> Result<Motion, ReadError> {
    said(block, Act::Offset(Offset::On { side, distance: Some(distance), register: None }))
}

/// Straight cuts from node to node, a block each, under an offset that is on from the first cut to the last but one.
fn program(side: Side, distance: f64, nodes: &[(f64, f64)]) -> Vec<Result<Motion, ReadError>> {
    let mut all = vec![on(1, side, distance)];
    let count = nodes.len() as u64 - 1;
    for (block, pair) in (1..).zip(nodes.windows(2)) {
        if block == count {
            all.push(said(block, Act::Offset(Offset::Off)));
        }
        all.push(cut(block, Element::Line { start: p(pair[0].0, pair[0].1), end: p(pair[1].0, pair[1].1) }));
    }
    all
}

fn compensate(motions: Vec<Result<Motion, ReadError>>) -> Vec<Result<Motion, ContourError>> {
    Compensated::new(motions.into_iter(), BTreeMap::from([(7, 0.25)]), Corners::Round).collect()
}

fn elements(motions: Vec<Result<Motion, ContourError>>) -> Vec<(u64, Element)> {
    motions
        .into_iter()
        .filter_map(|motion| match motion.unwrap() {
            Motion { act: Act::Move { element, .. }, block, .. } => Some((block, element)),
            _ => None,
        })
        .collect()
}

fn nodes(elements: &[(u64, Element)]) -> Vec<(f64, f64)> {
    let first = elements[0].1.start();
    let round = |v: f64| (v * 1e6).round() / 1e6 + 0.0;
    let ends = elements.iter().map(|(_, element)| element.end());
    std::iter::once(first).chain(ends).map(|at| (round(at.x), round(at.y))).collect()
}

fn message(motions: Vec<Result<Motion, ReadError>>) -> (u64, String) {
    match compensate(motions).pop() {
        Some(Err(ContourError::Contour { block, message, .. })) => (block, message),
        other => panic!("{other:?}"),
    }
}

/// An L with its inside corner at (4, 4), counter-clockwise from the middle of its lower side.
const ELL: [(f64, f64); 8] =
    [(5.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 9.0), (0.0, 9.0), (0.0, 0.0), (5.0, 0.0)];

#[test]
fn outside_the_wire_goes_round_outside_corners_and_turns_in_the_inside_one() {
    let mut way = vec![(5.0, -3.0)];
    way.extend(ELL);
    way.push((5.0, -3.0));
    let made = elements(compensate(program(Side::Right, 1.0, &way)));
    let expected = [
        (5.0, -3.0),
        (5.0, -1.0),
        (10.0, -1.0),
        (11.0, 0.0),
        (11.0, 4.0),
        (10.0, 5.0),
        (5.0, 5.0),
        (5.0, 9.0),
        (4.0, 10.0),
        (0.0, 10.0),
        (-1.0, 9.0),
        (-1.0, 0.0),
        (0.0, -1.0),
        (5.0, -1.0),
        (5.0, -3.0),
    ];
    assert_eq!(nodes(&made), expected);
    let blocks: Vec<_> = made.iter().map(|(block, _)| *block).collect();
    assert_eq!(blocks, [1, 2, 2, 3, 3, 4, 5, 5, 6, 6, 7, 7, 8, 9]);
    let arc = Element::Arc {
        start: p(10.0, -1.0),
        end: p(11.0, 0.0),
        centre: p(10.0, 0.0),
        sense: Sense::CounterClockwise,
    };
    let Element::Arc { start, centre, sense, .. } = made[2].1 else { panic!() };
    assert!(
        (start - arc.start()).norm() < 1e-9 && centre == p(10.0, 0.0) && sense == Sense::CounterClockwise
    );
}

#[test]
fn inside_the_wire_turns_in_outside_corners_and_goes_round_the_inside_one() {
    let mut way = vec![(5.0, 2.0)];
    way.extend(ELL);
    way.push((5.0, 2.0));
    let made = elements(compensate(program(Side::Left, 0.5, &way)));
    let expected = [
        (5.0, 2.0),
        (5.0, 0.5),
        (9.5, 0.5),
        (9.5, 3.5),
        (4.0, 3.5),
        (3.5, 4.0),
        (3.5, 8.5),
        (0.5, 8.5),
        (0.5, 0.5),
        (5.0, 0.5),
        (5.0, 2.0),
    ];
    assert_eq!(nodes(&made), expected);
    // A negative distance is the other side.
    let other = elements(compensate(program(Side::Right, -0.5, &way)));
    assert_eq!(nodes(&other), expected);
}

#[test]
fn a_contour_begun_at_an_outside_corner_is_left_square_beside_its_end() {
    let way = [(-3.0, -3.0), (0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0), (-3.0, -3.0)];
    let made = nodes(&elements(compensate(program(Side::Right, 1.0, &way))));
    assert_eq!(made[..2], [(-3.0, -3.0), (0.0, -1.0)]);
    assert_eq!(made[made.len() - 2..], [(-1.0, 0.0), (-3.0, -3.0)]);
}

#[test]
fn an_open_run_ends_square_beside_its_ends_and_an_overcut_is_kept() {
    let open = [(0.0, -2.0), (0.0, 0.0), (6.0, 0.0), (6.0, 5.0), (8.0, 5.0)];
    let made = nodes(&elements(compensate(program(Side::Left, 1.0, &open))));
    assert_eq!(made, [(0.0, -2.0), (0.0, 1.0), (5.0, 1.0), (5.0, 5.0), (8.0, 5.0)]);
    // Once round a square and 2 mm on.
    let overcut = [
        (5.0, -3.0),
        (5.0, 0.0),
        (9.0, 0.0),
        (9.0, 9.0),
        (0.0, 9.0),
        (0.0, 0.0),
        (5.0, 0.0),
        (7.0, 0.0),
        (7.0, -3.0),
    ];
    let made = nodes(&elements(compensate(program(Side::Right, 1.0, &overcut))));
    assert_eq!(made[made.len() - 4..], [(0.0, -1.0), (5.0, -1.0), (7.0, -1.0), (7.0, -3.0)]);
}

#[test]
fn what_is_said_between_moves_stays_between_them() {
    let line = |block, a: (f64, f64), b: (f64, f64)| {
        cut(block, Element::Line { start: p(a.0, a.1), end: p(b.0, b.1) })
    };
    let word = |block, text: &[u8]| said(block, Act::Word(text.into()));
    let made = compensate(vec![
        word(1, b"S1"),
        on(1, Side::Left, 0.5),
        word(1, b"S2"),
        line(1, (0.0, -2.0), (0.0, 0.0)),
        word(2, b"S3"),
        line(2, (0.0, 0.0), (5.0, 0.0)),
        said(3, Act::Stop(Stop::Pause)),
        line(3, (5.0, 0.0), (5.0, -5.0)),
        word(4, b"S4"),
        said(4, Act::Offset(Offset::Off)),
        word(4, b"S5"),
        line(4, (5.0, -5.0), (0.0, -5.0)),
        line(5, (0.0, -5.0), (0.0, -2.0)),
    ]);
    let told: Vec<String> = made
        .into_iter()
        .map(|motion| match motion.unwrap().act {
            Act::Move { element: Element::Line { .. }, .. } => "line".to_owned(),
            Act::Move { .. } => "arc".to_owned(),
            Act::Word(text) => String::from_utf8_lossy(&text).into_owned(),
            other => format!("{other:?}"),
        })
        .collect();
    let expected =
        ["S1", "S2", "line", "S3", "line", "arc", "Stop(Pause)", "line", "S4", "S5", "line", "line"];
    assert_eq!(told, expected);
}

#[test]
fn a_register_holds_the_distance_and_one_that_does_not_is_named() {
    let with = |register| {
        let mut motions = program(Side::Left, 1.0, &[(0.0, -2.0), (0.0, 0.0), (5.0, 0.0), (5.0, 5.0)]);
        motions[0] = said(1, Act::Offset(Offset::On { side: Side::Left, distance: None, register }));
        motions
    };
    assert_eq!(nodes(&elements(compensate(with(Some(7)))))[1], (0.0, 0.25));
    assert_eq!(message(with(Some(8))), (1, "register 8 holds no offset that is known here".to_owned()));
    assert_eq!(message(with(None)), (1, "the offset has no distance".to_owned()));
}

#[test]
fn what_cannot_be_done_names_its_block() {
    let arc = |block, start, end, centre, sense| cut(block, Element::Arc { start, end, centre, sense });
    let line = |block, start, end| cut(block, Element::Line { start, end });
    let fillet = |radius: f64| {
        vec![
            on(1, Side::Left, 0.1),
            line(1, p(0.0, 2.0), p(0.0, 0.0)),
            line(2, p(0.0, 0.0), p(5.0 - radius, 0.0)),
            arc(3, p(5.0 - radius, 0.0), p(5.0, radius), p(5.0 - radius, radius), Sense::CounterClockwise),
            line(4, p(5.0, radius), p(5.0, 5.0)),
            said(5, Act::Offset(Offset::Off)),
            line(5, p(5.0, 5.0), p(0.0, 5.0)),
        ]
    };
    assert!(compensate(fillet(0.11)).iter().all(Result::is_ok));
    assert_eq!(
        message(fillet(0.05)),
        (3, "an offset of 0.1000 mm leaves nothing of this element".to_owned())
    );
    let mut bent = fillet(0.5);
    bent[1] = arc(1, p(0.0, 2.0), p(0.0, 0.0), p(0.0, 1.0), Sense::Clockwise);
    assert_eq!(message(bent), (1, "the move after the offset is switched on is not straight".to_owned()));
    let mut out = fillet(0.5);
    out[6] = arc(5, p(5.0, 5.0), p(0.0, 5.0), p(2.5, 5.0), Sense::Clockwise);
    assert_eq!(message(out), (5, "the move after the offset is switched off is not straight".to_owned()));
    let mut changed = fillet(0.5);
    changed.insert(4, on(4, Side::Left, 0.2));
    assert_eq!(message(changed), (4, "the offset changes within a contour".to_owned()));
    let mut same = fillet(0.5);
    same.insert(4, on(4, Side::Left, 0.1));
    assert!(compensate(same).iter().all(Result::is_ok));
    let nothing =
        vec![on(1, Side::Left, 0.1), line(1, p(0.0, 2.0), p(0.0, 0.0)), said(2, Act::Offset(Offset::Off))];
    assert_eq!(message(nothing), (1, "the offset is switched on for no contour".to_owned()));
    // A neck of 0.4, which a wire of 0.5 beside it does not pass.
    let way = [
        (2.0, 1.0),
        (2.0, 0.0),
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
        (0.0, 0.0),
        (2.0, 0.0),
        (2.0, 1.0),
    ];
    let (block, text) = message(program(Side::Left, 0.5, &way));
    assert_eq!(block, 4);
    assert!(text.ends_with("an offset of 0.2000 mm would pass"), "{text}");
}

#[test]
fn a_slot_the_wire_cannot_enter_is_passed_by_and_told() {
    let way = [
        (5.0, -3.0),
        (5.0, 0.0),
        (10.0, 0.0),
        (10.0, 4.9),
        (5.0, 4.9),
        (5.0, 5.1),
        (10.0, 5.1),
        (10.0, 10.0),
        (0.0, 10.0),
        (0.0, 0.0),
        (5.0, 0.0),
        (5.0, -3.0),
    ];
    let motions = program(Side::Right, 0.15, &way);
    let mut compensated = Compensated::new(motions.into_iter(), BTreeMap::new(), Corners::Round);
    assert!(compensated.by_ref().all(|motion| motion.is_ok()));
    let [warning] = compensated.take_warnings()[..] else { panic!() };
    assert_eq!((warning.block, warning.spot.line), (4, 4));
    assert!((warning.unreached.largest - 0.1).abs() < 1e-6);
    let told = "block 4: the wire does not reach the contour at X5.000 Y5.000; the largest offset that does is 0.100 mm";
    assert_eq!(warning.to_string(), told);
}

#[test]
fn without_an_offset_nothing_is_changed() {
    let path = Path::circle(p(0.0, 0.0), 3.0, Sense::Clockwise);
    let motions = vec![
        said(1, Act::Header(b"%".as_slice().into())),
        cut(1, path.elements()[0]),
        said(2, Act::Stop(Stop::End)),
    ];
    let expected: Vec<_> = motions.iter().map(|m| m.as_ref().unwrap().clone()).collect();
    let made: Vec<_> = compensate(motions).into_iter().map(|m| m.unwrap()).collect();
    assert_eq!(made, expected);
}
