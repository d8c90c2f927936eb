//! What 3B blocks mean, vector by vector, from the text of a block to where the wire goes.

use dripfeed::formats::three_b::motions::Motions;
use dripfeed::formats::three_b::read::{Item, Reader};
use dripfeed::geometry::{Element, Point, Sense};
use dripfeed::interpolator::Model;
use dripfeed::motion::{Act, Stop};
use dripfeed::rounding::Aim;

use crate::programs::{MODELS, ends, motions, written};

/// Where a program leads, and what way, under a model.
fn ways(text: &str, model: Model) -> Vec<Element> {
    let moves = motions(text, model).into_iter().filter_map(|motion| match motion.act {
        Act::Move { element, .. } => Some(element),
        _ => None,
    });
    moves.collect()
}

fn end(text: &str, model: Model) -> (i64, i64) {
    let at = ways(text, model).last().map_or(Point::origin(), Element::end);
    ((at.x * 1000.0).round() as i64, (at.y * 1000.0).round() as i64)
}

#[test]
fn the_trades_circle_run_together_goes_out_round_and_back() {
    let text = "B9900B0B9900GXL1B9900B0B39600GYNR1B9900B0B9900GXL3";
    for (model, _) in MODELS {
        let ways = ways(text, model);
        assert_eq!(ways[0], Element::Line { start: Point::origin(), end: Point::new(9.9, 0.0) });
        let rim = Point::new(9.9, 0.0);
        assert_eq!(
            ways[1],
            Element::Arc { start: rim, end: rim, centre: Point::origin(), sense: Sense::CounterClockwise }
        );
        assert_eq!(ways[2], ways[0].reversed());
    }
}

#[test]
fn an_empty_number_is_0_and_axis_lines_have_it_or_the_length() {
    for (text, expected) in [
        ("BBB9900GXL1", (9900, 0)),
        ("B9900BB9900GXL1", (9900, 0)),
        ("BBB500GYL2", (0, 500)),
        ("B0B500B500GYL2", (0, 500)),
        ("BBB7GXL3", (-7, 0)),
        ("B0B0B000006YL4", (0, -6)),
    ] {
        for model in [Model::Rotated, Model::Exact] {
            assert_eq!(end(text, model), expected, "{text} {model:?}");
        }
    }
    // The form that always leads with X is the one micron off that the source tells of.
    assert_eq!(end("B0B500B500GYL2", Model::Mirrored), (-1, 500));
}

#[test]
fn padding_letters_and_white_space_do_not_matter() {
    let plain = end("B579B6617B006617GYL2", Model::Rotated);
    assert_eq!(plain, (-579, 6617));
    for text in [
        "B579B6617B6617GYL2",
        "b579 b6617 b006617 y l2",
        "B579\nB6617\nB006617\nG Y\nL\n2",
        "B0579B06617B6617YL2",
    ] {
        assert_eq!(end(text, Model::Rotated), plain, "{text}");
    }
}

#[test]
fn a_digit_opens_its_quadrant_with_its_first_axis() {
    // A line along an axis belongs to the quadrant that begins there.
    for (x, y, digit) in
        [(5, 0, 1), (0, 5, 2), (-5, 0, 3), (0, -5, 4), (3, 4, 1), (-3, 4, 2), (-3, -4, 3), (3, -4, 4)]
    {
        let axis = if i64::abs(x) > i64::abs(y) { 'X' } else { 'Y' };
        let j = i64::abs(x).max(i64::abs(y));
        let text = format!("B{}B{}B{j:06}G{axis}L{digit}", x.abs(), y.abs());
        assert_eq!(end(&text, Model::Rotated), (x, y), "{text}");
        assert_eq!(written(&motions(&text, Model::Rotated), Aim::One(Model::Rotated)), text + "\nDD\n");
    }
    // An arc belongs to the quadrant it enters: a quarter from each axis ends on the next.
    for (start, counter, clockwise) in [
        ((4000, 0), "NR1", "SR4"),
        ((0, 4000), "NR2", "SR1"),
        ((-4000, 0), "NR3", "SR2"),
        ((0, -4000), "NR4", "SR3"),
    ] {
        for (word, turned) in [(counter, (-start.1, start.0)), (clockwise, (start.1, -start.0))] {
            let axis = if turned.0 == 0 { 'X' } else { 'Y' };
            let text = format!("B{}B{}B004000G{axis}{word}", i64::abs(start.0), i64::abs(start.1));
            assert_eq!(end(&text, Model::Exact), (turned.0 - start.0, turned.1 - start.1), "{text}");
            let again = written(&motions(&text, Model::Exact), Aim::One(Model::Exact));
            assert!(again.contains(word), "{text} {again}");
        }
    }
}

#[test]
fn a_tie_counted_along_the_other_axis_is_a_micron_off() {
    for (right, wrong) in [("GYL1", "GXL1"), ("GXL2", "GYL2"), ("GYL3", "GXL3"), ("GXL4", "GYL4")] {
        let ended = |word: &str| end(&format!("B500B500B500{word}"), Model::Rotated);
        let (right, wrong) = (ended(right), ended(wrong));
        assert_eq!((right.0.abs(), right.1.abs()), (500, 500));
        assert_eq!((right.0 - wrong.0).abs() + (right.1 - wrong.1).abs(), 1, "{wrong:?}");
    }
}

#[test]
fn a_full_circle_counted_along_the_wrong_axis_stops_140_um_short() {
    assert_eq!(end("B9900B0B39600GYNR1", Model::Rotated), (0, 0));
    let (x, y) = end("B9900B0B39600GXNR1", Model::Rotated);
    let short = libm::hypot(x as f64, y as f64);
    assert!((138.0..142.0).contains(&short), "{x} {y}");
}

#[test]
fn an_arc_over_several_quadrants_counts_every_quadrant() {
    // From (30, 0) counter-clockwise over 270° to (0, −30), G the smaller coordinate of the end: 30 + 60 along X.
    let text = "B30000B0B090000GXNR1";
    assert_eq!(end(text, Model::Exact), (-30_000, -30_000));
    assert!((ways(text, Model::Exact)[0].sweep().to_degrees() - 270.0).abs() < 1e-9);
    assert_eq!(written(&motions(text, Model::Exact), Aim::One(Model::Exact)), format!("{text}\nDD\n"));
}

#[test]
fn six_digits_of_j_hold_a_circle_of_249_999_mm() {
    let largest = "B249999B0B999996GYNR1";
    assert_eq!(end(largest, Model::Rotated), (0, 0));
    assert_eq!(
        written(&motions(largest, Model::Rotated), Aim::One(Model::Rotated)),
        format!("{largest}\nDD\n")
    );
    let refused = Motions::of_three_b(&b"B250000B0B1000000GYNR1"[..], Model::Rotated).next().unwrap();
    assert!(refused.unwrap_err().to_string().contains("J is larger than 999999"));
}

#[test]
fn a_count_of_0_is_no_motion_and_a_block_that_never_counts_is_refused() {
    assert_eq!(end("B500B0B0GXL1", Model::Rotated), (0, 0));
    for text in ["B0B0B500GYL1", "B0B0B5GXNR1", "B1B0B9GXNR1"] {
        let read: Result<Vec<_>, _> = Motions::of_three_b(text.as_bytes(), Model::Rotated).collect();
        assert!(read.is_err(), "{text}");
    }
}

#[test]
fn stop_words_and_listings_are_told_from_blocks() {
    let listing = "*******\nStart Point =  0.000, 0.000 ; B12 B0\nProgram BX = 1, GX L1 DD none\n\
                   N   1: B 5000 B 0 B 5000 GX L1 ;  5.000,  0.000\nN   2: D\nN   3: B0 B5000 B5000 GY L2 ; 5.000, 5.000\nE\n";
    let mut reader = Reader::new(listing.as_bytes());
    let (mut blocks, mut stops) = (0, Vec::new());
    while let Ok(Some(item)) = reader.next_item() {
        match item {
            Item::Block(_) => blocks += 1,
            Item::StopWord(word) => stops.push(word),
        }
    }
    assert!(blocks == 2 && stops == ["D", "E"], "{blocks} {stops:?}");
    let stops: Vec<Stop> = motions(listing, Model::Rotated)
        .into_iter()
        .filter_map(|motion| if let Act::Stop(stop) = motion.act { Some(stop) } else { None })
        .collect();
    assert_eq!(stops, [Stop::Pause, Stop::End]);
}

#[test]
fn the_models_walk_the_sources_small_arcs_as_it_prints_them() {
    // Counter-clockwise (4, 0) → (0, 4) and clockwise (0, 6) → (6, 0), each cut short after every count.
    let (mut x, mut y) = (4, 0);
    for (j, step) in
        [(-1, 0), (0, 1), (0, 1), (0, 1), (-1, 0), (0, 1), (-1, 0), (-1, 0)].iter().scan(0, |j, step| {
            *j += i64::from(step.0 != 0);
            Some((*j, *step))
        })
    {
        (x, y) = (x + step.0, y + step.1);
        if step.0 != 0 {
            let text = format!("B4B0B{j}GXNR1");
            assert_eq!(ends(&text, MODELS[0].1), [(x - 4, y)], "{text}");
            assert_eq!(end(&text, Model::Rotated), (x - 4, y), "{text}");
        }
    }
    assert_eq!(end("B0B6B6GYSR1", Model::Rotated), (6, -6));
    // Counted along the other axis it is over at the ninth of its twelve pulses.
    assert_eq!(end("B0B6B6GXSR1", Model::Rotated), (6, -3));
}
