//! 4B to motions, to the wire's path, to 3B, and back to 4B.

use dripfeed::formats::four_b::offset::{Keyed, beside};
use dripfeed::formats::four_b::write::{Form, ToKey, Writer};
use dripfeed::formats::four_b::{Entry, Fourth, Order, Reader};
use dripfeed::formats::three_b::StopWord;
use dripfeed::formats::three_b::motions::Motions;
use dripfeed::formats::three_b::write::{Numbers, Remarks};
use dripfeed::formats::{WriteError, Writer as _};
use dripfeed::geometry::{Element, Path, Point, Sense};
use dripfeed::interpolator::Model;
use dripfeed::motion::reverse::reversed;
use dripfeed::motion::runs::ContourError;
use dripfeed::motion::{Act, Flag, Motion, Offset, Side, Stop, Taper, Travel};
use dripfeed::place::Spot;
use dripfeed::rounding::Aim;

use crate::programs::{MODELS, ends, written};

/// 40 by 30 mm, corners R5, and in the upper side a bow of R5 that bulges in between two more arcs of R5: convex and
/// concave arcs alike, run counter-clockwise from a hole in the middle.
const OUTLINE: [&str; 14] = [
    "B0B15000B015000BDGYL4",
    "B15000B0B015000GXL1",
    "B0B5000B005000B5000DGYNR4",
    "B0B20000B020000GYL2",
    "B5000B0B005000B5000DGXNR1",
    "B7000B0B007000GXL3",
    "B0B5000B002000B5000DGYNR2",
    "B4000B3000B004000B5000DDGYSR4",
    "B4000B3000B004000B5000DGXNR1",
    "B7000B0B007000GXL3",
    "B0B5000B005000B5000DGYNR2",
    "B0B20000B020000GYL4",
    "B5000B0B005000B5000DGXNR3",
    "B15000B0B015000GXL1",
];
const LEAD_OUT: &str = "B0B15000B015000GYL2";

fn outline() -> String {
    [&OUTLINE[..], &[LEAD_OUT, "DD"]].concat().join("\n") + "\n"
}

fn motions(text: &str) -> Vec<Motion> {
    let motions = Motions::of_four_b(text.as_bytes(), Model::Rotated);
    motions.map(|motion| Motion { spot: Spot::default(), ..motion.expect("the program is 4B") }).collect()
}

fn wire(motions: &[Motion], keyed: Keyed) -> Result<Vec<Motion>, ContourError> {
    beside(motions.iter().cloned().map(Ok::<_, ContourError>), keyed).collect()
}

fn offset(mm: f64) -> Keyed {
    Keyed { offset: mm, taper: None }
}

fn elements(motions: &[Motion]) -> Vec<Element> {
    let moves = motions.iter().filter_map(|motion| match motion.act {
        Act::Move { element, .. } => Some(element),
        _ => None,
    });
    moves.collect()
}

fn uppers(motions: &[Motion]) -> Vec<Element> {
    let moves = motions.iter().filter_map(|motion| match motion.act {
        Act::Move { upper, .. } => upper,
        _ => None,
    });
    moves.collect()
}

fn radii(elements: &[Element]) -> Vec<i64> {
    elements.iter().filter_map(Element::radius).map(|mm| (mm * 1000.0).round() as i64).collect()
}

/// The outline between one lead-in and one lead-out.
fn between_leads(elements: &[Element]) -> Path {
    Path::new(elements[1..elements.len() - 1].to_vec()).expect("the elements follow one another")
}

fn write(form: Form, motions: &[Motion]) -> Result<(String, Writer), WriteError> {
    let (mut writer, mut text) = (Writer::new(form), Vec::new());
    motions.iter().try_for_each(|motion| writer.write(motion, &mut text))?;
    writer.finish(&mut text)?;
    Ok((String::from_utf8(text).expect("4B is ASCII"), writer))
}

fn rotated() -> Form {
    let mut form = Form::default();
    form.plain.aim = Aim::One(Model::Rotated);
    form
}

fn without_flags(mut motions: Vec<Motion>) -> Vec<Motion> {
    for motion in &mut motions {
        if let Act::Move { flag, element: Element::Arc { .. }, .. } = &mut motion.act {
            *flag = None;
        }
    }
    motions
}

/// Every point of the way of the wire is as far from the outline as the offset, to within a micron, and on its side.
fn assert_runs_beside(outline: &Path, way: &Path, offset: f64) {
    assert_runs_within(outline, way, offset, 0.001);
}

fn assert_runs_within(outline: &Path, way: &Path, offset: f64, tolerance: f64) {
    for element in way.elements() {
        for n in 0..=200 {
            let at = element.at(f64::from(n) / 200.0);
            let distance = outline.distance(at);
            assert!((distance - offset.abs()).abs() < tolerance, "{distance} at {at}");
            assert_eq!(outline.contains(at), offset < 0.0, "{at}");
        }
    }
}

#[test]
fn the_sources_vectors_of_d_and_dd_hold() {
    // Punch, F = +0.1: convex 5 → 5.1, concave 5 → 4.9; die, F = −0.1: convex 5 → 4.9, concave 5 → 5.1.
    for (keyed, convex, concave) in [(0.1, 5100, 4900), (-0.1, 4900, 5100)] {
        let way = elements(&wire(&motions(&outline()), offset(keyed)).unwrap());
        assert_eq!(radii(&way), [convex, convex, convex, concave, convex, convex, convex]);
    }
    assert_eq!(radii(&elements(&wire(&motions(&outline()), offset(0.0)).unwrap())), [5000; 7]);
}

#[test]
fn the_wire_runs_beside_the_outline_and_is_led_there_and_back() {
    let program = motions(&outline());
    let backwards: Vec<Motion> =
        reversed(program.iter().cloned().map(Ok::<_, ContourError>)).map(Result::unwrap).collect();
    for program in [program, backwards] {
        let nominal = between_leads(&elements(&program));
        for keyed in [0.059, 0.1, 2.5, -0.059, -0.1, -2.5] {
            let way = wire(&program, offset(keyed)).unwrap();
            assert!(way.iter().all(|motion| !matches!(motion.act, Act::Move { flag: Some(_), .. })));
            let elements = elements(&way);
            let round = between_leads(&elements);
            assert!(round.is_closed());
            assert_runs_beside(&nominal, &round, keyed);
            let (lead_in, lead_out) = (elements[0], elements[elements.len() - 1]);
            assert_eq!((lead_in.start(), lead_out.end()), (Point::origin(), Point::origin()));
            assert_eq!((lead_in.end(), lead_out.start()), (round.start(), round.end()));
        }
    }
}

#[test]
fn a_control_that_cuts_the_wires_path_makes_the_part_larger_by_the_offset() {
    // Outer dimensions at an outside corner and at the bottom of the bow, on the mock's own interpolators.
    for keyed in [100, -100] {
        let way = wire(&motions(&outline()), offset(f64::from(keyed) / 1000.0)).unwrap();
        let text = written(&way, Aim::Any);
        for (_, mock) in MODELS {
            let ends = ends(&text, mock);
            assert_eq!(ends.last(), Some(&(0, 0)), "{text}");
            let keyed = i64::from(keyed);
            let (right, top) = (ends.iter().map(|e| e.0).max(), ends.iter().map(|e| e.1).max());
            assert!((right.unwrap() - 20_000 - keyed).abs() <= 1, "{text}");
            assert!((top.unwrap() - 15_000 - keyed).abs() <= 1, "{text}");
        }
        // The bow bulges down to y = 11, whose arc is one element.
        let bow = elements(&way)[7];
        assert!((bow.extent()[0].y - 11.0 - f64::from(keyed) / 1000.0).abs() < 1e-9);
    }
}

#[test]
fn both_field_orders_say_the_same() {
    let mut other = outline();
    for axis in ["GX", "GY"] {
        for flag in ["DD", "D"] {
            other = other.replace(&format!("{flag}{axis}"), &format!("{axis}{flag}"));
        }
    }
    assert!(other.contains("B5000GYDDSR4") && other.contains("BGYDL4"), "{other}");
    assert_eq!(motions(&outline()), motions(&other));
    let form = Form { order: Order::FlagBehindAxis, ..rotated() };
    assert_eq!(write(form, &motions(&other)).unwrap().0, other);
    assert_eq!(write(rotated(), &motions(&other)).unwrap().0, outline());
}

#[test]
fn the_stop_word_is_told_from_the_flag_by_its_position() {
    let text = "b0b5000b10000b5000ddgxnr2 dd";
    let mut reader = Reader::new(text.as_bytes());
    let Some(Entry::Block(block)) = reader.next_entry().unwrap() else { panic!("no block") };
    assert_eq!((block.flag, block.fourth.is_some()), (Some(Flag::DD), true));
    assert_eq!(reader.next_entry().unwrap(), Some(Entry::StopWord("DD")));
    for (text, flag, stop) in [
        ("B0B5000B10000B5000DGXNR2D\n", Flag::D, Stop::Pause),
        ("B0B5000B10000B5000GXDNR2DD", Flag::D, Stop::End),
        ("B0B5000B10000B5000\nDD\nGXNR2\nD", Flag::DD, Stop::Pause),
        ("B0B5000B005000BDDGYL2DD", Flag::DD, Stop::End),
    ] {
        let read = motions(text);
        let last = read.last().unwrap();
        assert!(matches!(read[0].act, Act::Move { flag: Some(found), .. } if found == flag), "{text}");
        assert_eq!(last.act, Act::Stop(stop), "{text}");
    }
}

#[test]
fn a_ratio_of_taper_may_stand_in_place_of_r() {
    for text in ["B0B5000B005000BL0.5DGYL2\nDD\n", "B0B5000B5000 L0.5 D GY L2 DD"] {
        let read = motions(text);
        assert_eq!(read[0].act, Act::Word(b"L0.5".as_slice().into()));
        assert!(matches!(read[1].act, Act::Move { flag: Some(Flag::D), .. }));
        assert_eq!(write(rotated(), &read).unwrap().0, "B0B5000B005000BL0.5DGYL2\nDD\n");
    }
    let on_an_arc = [&motions("B0B5000B5000BL2DGYL2")[..1], &motions("B0B5B20B5DGXNR2")].concat();
    assert!(write(rotated(), &on_an_arc).unwrap_err().message.contains("ratio of taper on an arc"));
    let alone = write(rotated(), &on_an_arc[..1]).unwrap().1;
    assert_eq!(alone.lost().iter().next().unwrap().kind, "ratio of taper that has no block");
}

#[test]
fn a_4b_program_written_again_is_the_same_program() {
    let text = "; outside, then a slot\n".to_owned()
        + &outline().replace("DD\n", "").replace("B5000GYSR4", "B5000DDGYSR4")
        + "D\nB50000B0B050000GXL1\nD\n(slot)\nN  12: B0B5000B005000BDDGYL2\nB5000B0B020000B5000DDGYSR4\nE\n";
    let mut form = rotated();
    (form.plain.remarks, form.plain.numbers, form.plain.end) =
        (Remarks::Brackets, Numbers::AsRead, StopWord::E);
    let read = motions(&text);
    let (again, writer) = write(form, &read).unwrap();
    assert_eq!(again, text.replace("; outside, then a slot", "( outside, then a slot)"));
    assert!(writer.lost().is_empty(), "{:?}", writer.lost());
    assert_eq!(motions(&again), read);
}

#[test]
fn flags_come_from_what_the_outline_encloses() {
    let plain = without_flags(motions(&outline()));
    assert_eq!(write(rotated(), &plain).unwrap().0, outline());
    // Run the other way, every arc turns the other way and is as convex as before.
    let backwards: Vec<Motion> =
        reversed(plain.into_iter().map(Ok::<_, ContourError>)).map(Result::unwrap).collect();
    let text = write(rotated(), &backwards).unwrap().0;
    let flags: Vec<&str> = text.lines().filter(|line| line.contains('R')).collect();
    assert_eq!(flags.len(), 7, "{text}");
    for line in flags {
        assert_eq!(line.contains("DD"), line.contains("NR"), "{text}");
    }
}

#[test]
fn an_offset_in_the_program_is_told_to_be_keyed_in() {
    let on = |side, distance| Motion {
        act: Act::Offset(Offset::On { side, distance, register: Some(1) }),
        block: 0,
        spot: Spot::default(),
    };
    for (side, distance, outside, kept, remark) in [
        (Side::Right, Some(0.1), true, Some(0.1), "key in F = +0.100 mm: the wire outside"),
        (Side::Left, Some(0.1), false, Some(0.1), "key in F = -0.100 mm: the wire inside"),
        (Side::Left, Some(-0.1), true, Some(0.1), "key in F = +0.100 mm: the wire outside"),
        (Side::Left, None, false, None, "key in F = -the register: the wire inside"),
    ] {
        let mut program = vec![on(side, distance)];
        program.extend(without_flags(motions(&outline())));
        let mut form = rotated();
        form.plain.remarks = Remarks::Brackets;
        let (text, writer) = write(form, &program).unwrap();
        assert!(text.starts_with(&format!("( {remark} )\n{}", OUTLINE[0])), "{text}");
        assert_eq!(writer.keyed(), Some(ToKey { outside, distance: kept }));
        assert_eq!(writer.lost().iter().count(), 1);
    }
    // Two contours that want two offsets are two programs.
    let contour = without_flags(motions(&outline().replace("DD\n", "")));
    let pause = Motion { act: Act::Stop(Stop::Pause), block: 0, spot: Spot::default() };
    let mut program = vec![on(Side::Right, Some(0.1))];
    program.extend(contour.clone());
    program.extend([pause, on(Side::Left, Some(0.1))]);
    program.extend(contour);
    let refused = write(rotated(), &program).unwrap_err();
    assert!(refused.message.contains("another offset"), "{refused}");
}

/// A square of 10 mm about the origin from a hole at the origin, begun in its corner.
fn square() -> Vec<Motion> {
    let nodes = [(0.0, 0.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0), (-5.0, -5.0), (5.0, -5.0), (0.0, 0.0)];
    let line = |pair: &[(f64, f64)], n: usize| Motion {
        act: Act::Move {
            travel: Travel::Cut,
            element: Element::Line {
                start: Point::new(pair[0].0, pair[0].1),
                end: Point::new(pair[1].0, pair[1].1),
            },
            upper: None,
            flag: None,
        },
        block: n as u64 + 1,
        spot: Spot { byte: 10 * n as u64, line: n as u64 + 1, column: 1 },
    };
    nodes.windows(2).enumerate().map(|(n, pair)| line(pair, n)).collect()
}

#[test]
fn a_corner_is_refused_with_its_place_or_gets_an_arc() {
    let refused = write(rotated(), &square()).unwrap_err();
    assert!(refused.message.contains("a corner of 90.00°"), "{refused}");
    assert_eq!(refused.spot.line, 3);

    let form = Form { corners: Some(1.0), ..rotated() };
    let (text, writer) = write(form, &square()).unwrap();
    assert_eq!(writer.stands().x.0.abs() + writer.stands().y.0.abs(), 0);
    let expected = [
        "B5000B4000B005000GXL4",
        "B0B8000B008000GYL2",
        "B1000B0B001000B1000DGXNR1",
        "B8000B0B008000GXL3",
        "B0B1000B001000B1000DGYNR2",
        "B0B8000B008000GYL4",
        "B1000B0B001000B1000DGXNR3",
        "B8000B0B008000GXL1",
        "B0B1000B001000B1000DGYNR4",
        "B5000B4000B005000GXL2",
        "DD",
    ];
    assert_eq!(text.lines().collect::<Vec<_>>(), expected);
    let nominal = between_leads(&elements(&motions(&text)));
    for keyed in [1.5, -0.9] {
        let way = wire(&motions(&text), offset(keyed)).unwrap();
        assert_runs_beside(&nominal, &between_leads(&elements(&way)), keyed);
    }
    // The largest arcs that fit touch one another; larger ones do not fit.
    let (text, _) = write(Form { corners: Some(5.0), ..rotated() }, &square()).unwrap();
    assert_eq!(text.lines().filter(|line| line.contains("B5000D")).count(), 4, "{text}");
    let refused = write(Form { corners: Some(5.1), ..rotated() }, &square()).unwrap_err();
    assert!(refused.message.contains("no room for an arc of 5.1 mm"), "{refused}");
    assert!(refused.spot.line > 1);
}

#[test]
fn corners_between_lines_and_arcs_get_tangent_arcs_too() {
    // A half disc with a round bay in its flat side: line to arc, arc to line, arc to arc, inside and outside corners.
    let p = Point::new;
    let arc = |start, end, centre, sense| Element::Arc { start, end, centre, sense };
    let outline = [
        Element::Line { start: p(0.0, -20.0), end: p(0.0, -10.0) },
        Element::Line { start: p(0.0, -10.0), end: p(10.0, -10.0) },
        arc(p(10.0, -10.0), p(10.0, 10.0), p(10.0, 0.0), Sense::CounterClockwise),
        arc(p(10.0, 10.0), p(0.0, 10.0), p(5.0, 10.0), Sense::Clockwise),
        Element::Line { start: p(0.0, 10.0), end: p(-8.0, 10.0) },
        Element::Line { start: p(-8.0, 10.0), end: p(-8.0, -10.0) },
        Element::Line { start: p(-8.0, -10.0), end: p(0.0, -10.0) },
        Element::Line { start: p(0.0, -10.0), end: p(0.0, -20.0) },
    ];
    let program: Vec<Motion> = outline
        .iter()
        .map(|&element| Motion {
            act: Act::Move { travel: Travel::Cut, element, upper: None, flag: None },
            block: 1,
            spot: Spot::default(),
        })
        .collect();
    let (text, _) = write(Form { corners: Some(0.8), ..rotated() }, &program).unwrap();
    assert_eq!(text.lines().filter(|line| line.contains("B800D")).count(), 4, "{text}");
    let read = motions(&text);
    let nominal = between_leads(&elements(&read));
    let whole = Path::new(outline[1..7].to_vec()).unwrap();
    for element in nominal.elements().iter().filter(|e| e.radius().is_none_or(|r| r > 1.0)) {
        // Read again, the program begins at zero.
        let at = element.at(0.5);
        assert!(whole.distance(Point::new(at.x, at.y - 20.0)) < 0.002, "{element:?}");
    }
    for keyed in [0.3, -0.3] {
        let way = wire(&read, offset(keyed)).unwrap();
        assert_runs_beside(&nominal, &between_leads(&elements(&way)), keyed);
    }
}

#[test]
fn a_taper_tilts_the_wire_by_the_flag_of_the_lead_in() {
    for (flag, upper) in [("D", -0.1 - 0.5), ("DD", -0.1 + 0.5)] {
        let text = outline().replace("BDGYL4", &format!("B{flag}GYL4"));
        let way = wire(&motions(&text), Keyed { offset: -0.1, taper: Some(0.5) }).unwrap();
        let nominal = between_leads(&elements(&motions(&text)));
        assert_runs_beside(&nominal, &between_leads(&elements(&way)), -0.1);
        let uppers = uppers(&way);
        assert_eq!(uppers.len(), 15);
        assert_runs_beside(&nominal, &between_leads(&uppers), upper);
        assert_eq!((uppers[0].start(), uppers[14].end()), (Point::origin(), Point::origin()));
    }
    let unflagged = outline().replace("BDGYL4", "GYL4");
    let refused = wire(&motions(&unflagged), Keyed { offset: 0.0, taper: Some(0.5) }).unwrap_err();
    assert!(refused.to_string().contains("does not say its sense"), "{refused}");
}

#[test]
fn what_cannot_be_set_off_is_refused_with_its_block() {
    let without_lead_in = OUTLINE[1..].join("\n");
    let corner = outline().replace(OUTLINE[2], "B5000B5000B005000GYL1");
    // A piece of a micron is no way round a corner.
    let hidden = outline().replace(OUTLINE[2], "B4999B4999B004999GYL1B1B0B1GXL1B0B1B1GYL2");
    for (text, keyed, block, wanted) in [
        (outline(), -5.0, 3, "the radius of 5.000 mm becomes 0.000 mm"),
        (outline(), 5.0, 8, "the radius of 5.000 mm becomes 0.000 mm"),
        (outline().replace("B5000DDG", "B5000DG"), 0.1, 8, "on the other side"),
        (outline().replace("B005000B5000DGXNR1", "B005000GXNR1"), 0.1, 5, "without a flag"),
        (without_lead_in, 0.1, 1, "no straight move leads"),
        (corner, 0.1, 3, "a corner of 45.00°"),
        (hidden, 0.1, 3, "a corner of 45.00°"),
        ("B0B5000B5000GYL2 B5000B0B5000GXL1 B0B9000B9000GYL2".into(), 0.1, 2, "no arc"),
        (outline(), f64::NAN, 1, "no number"),
    ] {
        let refused = wire(&motions(&text), offset(keyed)).unwrap_err().to_string();
        assert!(refused.contains(wanted) && refused.contains(&format!("block {block}:")), "{refused}");
    }
    let mut tilted = motions(&outline());
    tilted.insert(
        0,
        Motion { act: Act::Taper(Taper::On { side: Side::Left, angle: 1.0 }), ..tilted[0].clone() },
    );
    assert!(write(rotated(), &tilted).unwrap_err().message.contains("on its panel"));
    let wrong = motions(&outline().replace("B5000DDG", "B5000DG"));
    assert!(write(rotated(), &wrong).unwrap_err().message.contains("on the other side"));
}

#[test]
fn pieces_of_a_micron_that_close_a_contour_do_not_turn_the_wire() {
    // The last line ends a micron low, and a block of a micron brings it home.
    let text = outline().replace(
        "B15000B0B015000GXL1\nB0B15000B015000GYL2",
        "B15000B1B015000GXL4\nB0B1B1GYL2\nB0B15000B015000GYL2",
    );
    assert_eq!(text.lines().count(), 17);
    let nominal = between_leads(&elements(&motions(&text)));
    for keyed in [0.5, -0.5] {
        let way = between_leads(&elements(&wire(&motions(&text), offset(keyed)).unwrap()));
        assert!(way.is_closed());
        // The step of a micron is in the outline itself.
        assert_runs_within(&nominal, &way, keyed, 0.0011);
    }
}

#[test]
fn an_overlap_past_the_closing_point_and_several_contours_are_set_off() {
    // 1 mm past where the outline began, and back to the hole.
    let overlapping =
        [&OUTLINE[..], &["B1000B0B001000GXL1", "B1000B15000B015000GYL2", "D"]].concat().join("\n")
            + "\nB60000B0B060000GXL1\nD\n"
            + &outline();
    let read = motions(&overlapping);
    let way = elements(&wire(&read, offset(0.1)).unwrap());
    let nominal = Path::new(elements(&read)[1..14].to_vec()).unwrap();
    for element in &way[1..15] {
        for n in 0..=50 {
            let distance = nominal.distance(element.at(f64::from(n) / 50.0));
            assert!((distance - 0.1).abs() < 0.001, "{distance}");
        }
    }
    assert_eq!(way[15].end(), Point::origin());
    assert_eq!((way[16].start(), way[16].end()), (Point::origin(), Point::new(60.0, 0.0)));
    assert_eq!(radii(&way[17..]), [5100, 5100, 5100, 4900, 5100, 5100, 5100]);
    assert!(way.windows(2).all(|pair| pair[0].end() == pair[1].start()));
}

/// F and A of the source's die, worked out: the paper prints 0.055 and 6.69.
#[test]
fn the_reconstructed_die_closes_runs_on_and_is_cut_at_its_offset() {
    let text = include_str!("../../docs/examples/die.4b");
    assert!(text.lines().next().unwrap().contains("RECONSTRUCTION"));
    let keyed =
        Keyed { offset: -Keyed::offset_for(0.15, 0.014, 0.03), taper: Some(Keyed::taper_for(100.0, 4.0)) };
    assert!((keyed.offset + 0.059).abs() < 1e-12 && (keyed.taper.unwrap() - 6.992_681).abs() < 1e-6);

    // The block that each block says is what every model of a control makes of it.
    let three_b: String = text
        .lines()
        .filter_map(|line| line.split_once(": "))
        .map(|(_, block)| {
            let fourth = block.match_indices('B').nth(3).map(|(at, _)| at);
            let axis = block.find('G').unwrap_or(0);
            block[..fourth.unwrap_or(axis)].to_owned() + &block[axis..] + "\n"
        })
        .collect();
    for (_, mock) in MODELS {
        assert_eq!(ends(&three_b, mock).last(), Some(&(0, 0)));
    }

    let read = motions(text);
    assert_eq!(read.iter().filter(|motion| matches!(motion.act, Act::Comment(_))).count(), 7);
    let nominal = between_leads(&elements(&read));
    assert!(nominal.is_closed());
    assert_eq!(nominal.extent(), [Point::new(-20.0, -15.0), Point::new(20.0, 15.0)]);
    let nodes = nominal.elements().iter().zip(nominal.elements().iter().cycle().skip(1));
    for (before, after) in nodes {
        assert!((before.heading_at_end() - after.heading_at_start()).norm() < 1e-9, "{before:?} {after:?}");
    }
    let way = wire(&read, offset(keyed.offset)).unwrap();
    assert_eq!(radii(&elements(&way)), [941, 941, 941, 10_059, 941, 941, 941]);
    assert_runs_beside(&nominal, &between_leads(&elements(&way)), -0.059);

    // The upper end runs A beside the lower one all the way: over 100 mm that is 4 degrees.
    let tilted = wire(&read, keyed).unwrap();
    let pairs = between_leads(&elements(&tilted));
    for (lower, upper) in pairs.elements().iter().zip(between_leads(&uppers(&tilted)).elements()) {
        for n in 0..=10 {
            let lean = (upper.at(f64::from(n) / 10.0) - lower.at(f64::from(n) / 10.0)).norm();
            assert!((libm::atan2(lean, 100.0).to_degrees() - 4.0).abs() < 1e-5, "{lean}");
        }
    }

    let mut reader = Reader::new(text.as_bytes());
    let mut fourths = Vec::new();
    while let Some(entry) = reader.next_entry().unwrap() {
        if let Entry::Block(block) = entry
            && let Some(Fourth::Radius(radius)) = block.fourth
        {
            fourths.push((radius.0, block.flag));
        }
    }
    assert_eq!(fourths.len(), 7);
    assert!(fourths.iter().all(|&(r, flag)| (r == 10_000) == (flag == Some(Flag::DD))), "{fourths:?}");
}
