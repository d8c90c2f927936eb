//! Each finding on a small program, and on its twin that is in order.

use super::*;
use crate::geometry::{Element, Point, Sense};
use crate::motion::{Act, Flag, Offset, Side, Stop, Taper, Travel as Way};
use crate::tape::{Code, Tape};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(from: (f64, f64), to: (f64, f64)) -> Act {
    moved(Way::Cut, Element::Line { start: p(from.0, from.1), end: p(to.0, to.1) }, None)
}

fn rapid(from: (f64, f64), to: (f64, f64)) -> Act {
    moved(Way::Rapid, Element::Line { start: p(from.0, from.1), end: p(to.0, to.1) }, None)
}

fn moved(travel: Way, element: Element, flag: Option<Flag>) -> Act {
    Act::Move { travel, element, upper: None, flag }
}

fn arc(from: (f64, f64), to: (f64, f64), centre: (f64, f64), sense: Sense) -> Element {
    Element::Arc { start: p(from.0, from.1), end: p(to.0, to.1), centre: p(centre.0, centre.1), sense }
}

/// Lines through points, one block each.
fn through(points: &[(f64, f64)]) -> Vec<Act> {
    points.windows(2).map(|pair| line(pair[0], pair[1])).collect()
}

fn report(settings: Settings, acts: &[Act]) -> Report {
    let mut check = Check::new(settings);
    let mut block = 0;
    for (n, act) in acts.iter().enumerate() {
        block += u64::from(matches!(act, Act::Move { .. }));
        let line = n as u64 + 1;
        let spot = Spot { byte: 10 * n as u64, line, column: 1 };
        check.see(&Motion { act: act.clone(), block, spot }, None);
    }
    check.finish()
}

fn found(settings: Settings, acts: &[Act]) -> Vec<(&'static str, u64)> {
    report(settings, acts).findings.iter().map(|finding| (finding.code, finding.spot.line)).collect()
}

fn codes(acts: &[Act]) -> Vec<&'static str> {
    let mut acts = acts.to_vec();
    acts.push(Act::Stop(Stop::End));
    found(Settings { format: Format::GCode, ..Settings::default() }, &acts)
        .into_iter()
        .map(|(code, _)| code)
        .collect()
}

/// A square of 10 mm with its lead-in from the left, counter-clockwise, from its lower left corner.
const SQUARE: [(f64, f64); 6] = [(-5.0, 0.0), (0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)];

#[test]
fn a_square_in_order_has_no_finding() {
    assert_eq!(codes(&through(&SQUARE)), [""; 0]);
    let mut out_and_in_again = SQUARE.to_vec();
    out_and_in_again.push((-5.0, 0.0));
    assert_eq!(codes(&through(&out_and_in_again)), [""; 0]);
    let twice: Vec<_> = SQUARE.iter().chain(&SQUARE[2..]).copied().collect();
    assert_eq!(codes(&through(&twice)), [""; 0]);
    let overcut: Vec<_> = SQUARE.iter().copied().chain([(2.0, 0.0)]).collect();
    assert_eq!(codes(&through(&overcut)), [""; 0]);
}

#[test]
fn arcs_whose_radii_disagree_by_more_than_3_um_are_told() {
    let end = |x: f64| moved(Way::Cut, arc((5.0, 0.0), (x, 0.0), (0.0, 0.0), Sense::Clockwise), None);
    let back = |x: f64| line((x, 0.0), (5.0, 0.0));
    assert_eq!(codes(&[end(-5.0029), back(-5.0029)]), [""; 0]);
    assert_eq!(codes(&[end(-5.0031), back(-5.0031)]), ["arc-radii"]);
    let none = moved(Way::Cut, arc((5.0, 0.0), (5.0, 0.0), (5.0, 0.0), Sense::Clockwise), None);
    assert!(codes(&[none, back(5.0)]).contains(&"arc-no-radius"));
}

#[test]
fn a_gap_is_an_error_its_rounding_a_warning_and_an_open_cut_a_warning() {
    let ending = |x: f64| {
        let mut points = SQUARE;
        points[5] = (x, 0.0);
        let mut acts = through(&points);
        acts.push(Act::Stop(Stop::End));
        report(Settings::default(), &acts).findings
    };
    assert_eq!(ending(0.0029), []);
    for (x, code, severity) in [
        (0.0031, "contour-gap", Severity::Warning),
        (0.011, "contour-gap", Severity::Error),
        (0.9, "contour-gap", Severity::Error),
        (3.0, "contour-open", Severity::Warning),
    ] {
        let findings = ending(x);
        assert_eq!(findings.len(), 1, "{x}: {findings:?}");
        assert_eq!((findings[0].code, findings[0].severity, findings[0].block), (code, severity, 5));
    }
}

#[test]
fn a_second_contour_behind_a_rapid_move_is_looked_at_by_itself() {
    let mut acts = through(&SQUARE);
    acts.push(rapid((0.0, 0.0), (30.0, 0.0)));
    let shifted = |by: f64| SQUARE.map(|(x, y)| (x + 35.0, y * by));
    acts.extend(through(&shifted(1.0)));
    assert_eq!(codes(&acts), [""; 0]);
    acts.truncate(acts.len() - 1);
    assert_eq!(codes(&acts), ["contour-open"]);
}

#[test]
fn a_path_that_crosses_itself_is_told_with_both_blocks() {
    let bow = [(-5.0, 0.0), (0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0), (0.0, 0.0)];
    let mut acts = through(&bow);
    acts.push(Act::Stop(Stop::End));
    let findings = report(Settings::default(), &acts).findings;
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!((findings[0].code, findings[0].block), ("crossing", 4));
    assert_eq!(findings[0].message, "the path crosses block 2 at 5.000, 5.000 mm");
}

#[test]
fn a_lead_in_is_judged_by_the_side_that_is_kept() {
    let keeping =
        |kept| found(Settings { kept: Some(kept), ..Settings::default() }, &ended(&through(&SQUARE)));
    assert_eq!(keeping(Kept::Inside), []);
    assert_eq!(keeping(Kept::Outside), [("lead-in-through-part", 1)]);
    for (side, expected) in [(Side::Right, vec![]), (Side::Left, vec![("lead-in-through-part", 2)])] {
        let mut acts = vec![Act::Offset(Offset::On { side, distance: Some(0.1), register: None })];
        acts.extend(through(&SQUARE));
        acts.push(Act::Offset(Offset::Off));
        acts.push(line((0.0, 0.0), (-5.0, 0.0)));
        assert_eq!(found(Settings::default(), &ended(&acts)), expected, "{side:?}");
    }
}

fn ended(acts: &[Act]) -> Vec<Act> {
    acts.iter().cloned().chain([Act::Stop(Stop::End)]).collect()
}

#[test]
fn a_program_wider_than_the_machine_or_of_an_unlikely_size_is_told() {
    let travelling = |x, y| {
        let travel = Travel { x: Some(x), y: Some(y) };
        found(Settings { travel, ..Settings::default() }, &ended(&through(&SQUARE)))
    };
    assert_eq!(travelling(15.0, 10.0), []);
    assert_eq!(travelling(14.9, 10.0), [("travel", 2)]);
    assert_eq!(travelling(15.0, 9.9), [("travel", 3)]);
    let scaled = |by: f64| codes(&through(&SQUARE.map(|(x, y)| (x * by, y * by))));
    assert_eq!(scaled(0.006), ["unit"]);
    assert_eq!(scaled(200.0), ["unit"]);
    assert_eq!(scaled(0.01), [""; 0]);
}

#[test]
fn modes_left_on_and_words_out_of_place_are_told() {
    let square = through(&SQUARE);
    let on = Act::Offset(Offset::On { side: Side::Right, distance: None, register: Some(1) });
    let tilted = |angle| Act::Taper(Taper::On { side: Side::Left, angle });
    assert_eq!(found(Settings::default(), &square), [("no-end", 5)]);
    assert_eq!(found(Settings::default(), &ended(&[])), [("no-cut", 0)]);
    let with = |first: Act| ended(&[vec![first], square.clone()].concat());
    assert_eq!(found(Settings::default(), &with(on.clone())), [("offset-left-on", 1)]);
    assert_eq!(found(Settings::default(), &with(tilted(2.0))), [("taper-left-on", 1)]);
    assert_eq!(found(Settings::default(), &with(tilted(0.0))), []);
    assert_eq!(found(Settings::default(), &with(Act::Unknown(b"Q7"[..].into()))), [("unknown-word", 1)]);
    let after =
        [ended(&square), vec![line((0.0, 0.0), (-1.0, 0.0)), line((-1.0, 0.0), (-2.0, 0.0))]].concat();
    assert_eq!(found(Settings::default(), &after), [("after-end", 7), ("contour-open", 8)]);
    let round = moved(Way::Cut, arc((0.0, 0.0), (0.0, 0.0), (5.0, 0.0), Sense::Clockwise), None);
    assert_eq!(
        found(
            Settings::default(),
            &ended(&[on.clone(), round, Act::Offset(Offset::Off), line((0.0, 0.0), (-5.0, 0.0))])
        ),
        [("offset-on-arc", 2)]
    );
    let away = [vec![on], square, vec![rapid((0.0, 0.0), (9.0, 40.0)), Act::Offset(Offset::Off)]].concat();
    assert_eq!(found(Settings::default(), &ended(&away)), [("rapid-with-offset", 7)]);
}

#[test]
fn a_taper_beyond_the_machine_is_told() {
    let tilted = |angle, most| {
        let acts = [
            vec![Act::Taper(Taper::On { side: Side::Left, angle })],
            through(&SQUARE),
            vec![Act::Taper(Taper::Off)],
        ];
        found(Settings { taper_max: most, ..Settings::default() }, &ended(&acts.concat()))
    };
    assert_eq!(tilted(4.0, Some(4.0)), []);
    assert_eq!(tilted(4.1, Some(4.0)), [("taper-limit", 1)]);
    assert_eq!(tilted(30.0, None), []);
    assert_eq!(tilted(90.0, None), [("taper-limit", 1)]);
}

#[test]
fn numbers_with_too_many_digits_are_told_by_format() {
    let far = ended(&through(&[(0.0, 0.0), (1000.0, 0.0), (0.0, 0.0)]));
    let long = |format, by: f64| {
        let far = ended(&through(&[(0.0, 0.0), (by, 0.0), (0.0, 0.0)]));
        let codes: Vec<_> = found(Settings { format, ..Settings::default() }, &far)
            .into_iter()
            .map(|(code, _)| code)
            .filter(|code| code.starts_with("number"))
            .collect();
        codes
    };
    assert!(found(Settings::default(), &far).contains(&("number-digits", 1)));
    assert_eq!(long(Format::ThreeB, 999.999), [""; 0]);
    assert_eq!(long(Format::GCode, 99_999.999), [""; 0]);
    assert_eq!(long(Format::GCode, 100_000.0), ["number-limit"]);
}

#[test]
fn a_corner_of_a_4b_contour_is_told_and_a_round_one_is_not() {
    let flagged = |corner: f64| {
        let (d, s) = (Some(Flag::D), Sense::CounterClockwise);
        let points = [(0.0, -6.0), (5.0, -6.0 + corner)];
        ended(&[
            moved(Way::Cut, Element::Line { start: p(0.0, -9.0), end: p(0.0, -6.0) }, Some(Flag::D)),
            line(points[0], points[1]),
            moved(Way::Cut, arc(points[1], (5.0, 6.0), (5.0, 0.0), s), d),
            line((5.0, 6.0), (0.0, 6.0)),
            moved(Way::Cut, arc((0.0, 6.0), (0.0, -6.0), (0.0, 0.0), s), d),
        ])
    };
    assert_eq!(found(Settings { format: Format::FourB, ..Settings::default() }, &flagged(0.0)), []);
    let cornered = found(Settings { format: Format::FourB, ..Settings::default() }, &flagged(0.02));
    assert!(cornered.iter().any(|(code, _)| *code == "not-tangent"), "{cornered:?}");
    assert!(!cornered.contains(&("not-tangent", 1)), "the lead-in may meet the contour at any angle");
}

#[test]
fn characters_the_tape_lacks_are_told_where_they_stand() {
    let tape = Tape { code: Code::Ascii, end_of_block: b"\n", leader: String::new(), trailer: String::new() };
    let mut check = Check::new(Settings { tape: Some(tape), ..Settings::default() });
    let spot = Spot { byte: 100, line: 7, column: 3 };
    check.see_text(b"G01 X1.5", 1, spot);
    check.see_text(b"G01 x1.5", 2, spot);
    let findings = check.finish().findings;
    assert_eq!((findings[0].code, findings[0].spot), ("tape-code", Spot { byte: 104, line: 7, column: 7 }));
    assert_eq!(findings.iter().filter(|finding| finding.code == "tape-code").count(), 1);
}

#[test]
fn restart_points_are_where_nothing_is_on() {
    let on = Act::Offset(Offset::On { side: Side::Right, distance: None, register: Some(1) });
    let mut acts = through(&SQUARE);
    acts.extend(through(&SQUARE[1..]));
    acts.extend([Act::Stop(Stop::Pause), on]);
    acts.extend(through(&SQUARE[1..]));
    let report = report(Settings { restart_points: true, ..Settings::default() }, &ended(&acts));
    let points: Vec<_> = report.restart_points.iter().map(|point| (point.block, point.at)).collect();
    assert_eq!(points, [(1, p(-5.0, 0.0)), (2, p(0.0, 0.0)), (6, p(0.0, 0.0))]);
}

#[test]
fn after_something_unreadable_only_syntax_is_checked() {
    let mut check = Check::new(Settings::default());
    let place = crate::place::Place::in_text("one\ntwo", 5, 7);
    let error = || ReadError::Program { message: "no".into(), place: place.clone(), help: "".into() };
    assert!(check.see_error(&error()));
    check.see(&Motion { act: line((0.0, 0.0), (9.0, 9.0)), block: 1, spot: Spot::default() }, None);
    let mut went_on = 0;
    while check.see_error(&error()) {
        went_on += 1;
        assert!(went_on < 2000, "a reader that stands still is given up");
    }
    let report = check.finish();
    assert!(report.unreadable);
    assert!(report.findings.iter().all(|finding| finding.code == "syntax" && finding.width == 2));
    assert_eq!(report.more, [("syntax", report.errors - report.findings.len() as u64)]);
}
