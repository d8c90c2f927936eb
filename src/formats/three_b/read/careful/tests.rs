use crate::formats::ReadError;
use crate::formats::four_b::{Fourth, Ratio};
use crate::formats::three_b::read::{Beyond, Entry, Item, Reader};
use crate::formats::three_b::{Axis, Block, Motion, Quadrant};
use crate::geometry::Sense;
use crate::motion::Flag;
use crate::place::Place;
use crate::units::Micrometres;

/// Which blocks a text is read as: 3B, or 3B and 4B mixed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum As {
    ThreeB,
    FourB,
}

/// The text with every character on a line of its own: only the careful way can read that.
fn drawn_out(text: &str) -> String {
    text.chars().flat_map(|c| [c, '\n']).collect()
}

fn first(text: &str, grammar: As) -> Result<(Block, Beyond, String), ReadError> {
    let source = text.as_bytes();
    let mut reader = if grammar == As::FourB { Reader::of_four_b(source) } else { Reader::new(source) };
    match reader.next_entry()? {
        Some(Entry::Item(Item::Block(block))) => {
            Ok((block, reader.beyond(), String::from_utf8_lossy(reader.text()).into_owned()))
        }
        other => panic!("{text}: {other:?}"),
    }
}

fn refusal(text: &str, grammar: As) -> (String, Place, String) {
    match first(text, grammar).unwrap_err() {
        ReadError::Program { message, place, help } => (message, place, help.into_owned()),
        ReadError::Io(error) => panic!("{error}"),
    }
}

fn block(x: i64, y: i64, j: i64, g: Axis, motion: Motion) -> Block {
    Block { x: Micrometres(x), y: Micrometres(y), j: Micrometres(j), g, motion }
}

fn radius(um: i64) -> Option<Fourth> {
    Some(Fourth::Radius(Micrometres(um)))
}

fn ratio(text: &str) -> Option<Fourth> {
    Some(Fourth::Ratio(Ratio::parse(text.as_bytes()).unwrap()))
}

#[test]
fn a_block_says_the_same_on_one_line_and_drawn_out_over_many() {
    use Motion::{Arc, Line};
    let nr2 = Arc(Sense::CounterClockwise, Quadrant::Second);
    let sr1 = Arc(Sense::Clockwise, Quadrant::First);
    let quarter = block(0, 5000, 10_000, Axis::X, nr2);
    let east = block(1000, 0, 1000, Axis::X, Line(Quadrant::First));
    let north = block(0, 0, 500, Axis::Y, Line(Quadrant::Second));
    let three_four = block(3000, 4000, 100, Axis::Y, sr1);
    let nothing = (None, None);
    for (text, grammar, wanted, (fourth, flag)) in [
        ("B1000B0B1000GXL1", As::ThreeB, east, nothing),
        ("B1000B0B001000XL1", As::ThreeB, east, nothing),
        ("B1000B0B1000GXL1", As::FourB, east, nothing),
        ("BBB500GYL2", As::ThreeB, north, nothing),
        ("B0B5000B10000GXNR2", As::ThreeB, quarter, nothing),
        ("B3000B4000B100GYSR1", As::FourB, three_four, nothing),
        ("B0B5000B10000B5000DGXNR2", As::FourB, quarter, (radius(5000), Some(Flag::D))),
        ("B0B5000B10000B5000DDGXNR2", As::FourB, quarter, (radius(5000), Some(Flag::DD))),
        ("B0B5000B10000B5000GXDNR2", As::FourB, quarter, (radius(5000), Some(Flag::D))),
        ("B0B5000B10000B5000XDDNR2", As::FourB, quarter, (radius(5000), Some(Flag::DD))),
        ("B3000B4000B100B5005DGYSR1", As::FourB, three_four, (radius(5005), Some(Flag::D))),
        ("B3000B4000B100B4995DGYSR1", As::FourB, three_four, (radius(4995), Some(Flag::D))),
        ("B1000B0B1000BGXL1", As::FourB, east, nothing),
        ("B1000B0B1000BDGXL1", As::FourB, east, (None, Some(Flag::D))),
        ("B1000B0B1000GXDDL1", As::FourB, east, (None, Some(Flag::DD))),
        ("B1000B0B1000B0GXL1", As::FourB, east, (radius(0), None)),
        ("B1000B0B1000BL0.5DGXL1", As::FourB, east, (ratio("0.5"), Some(Flag::D))),
        ("B1000B0B1000L2GXL1", As::FourB, east, (ratio("2"), None)),
        ("B1000B0B1000L12345678.123456DDGXL1", As::FourB, east, (ratio("12345678.123456"), Some(Flag::DD))),
        (
            "B1000000000B0B999999GXL1",
            As::ThreeB,
            block(1_000_000_000, 0, 999_999, Axis::X, Line(Quadrant::First)),
            nothing,
        ),
    ] {
        for text in [text.to_owned(), drawn_out(text)] {
            let found = first(&text, grammar).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!((found.0, found.1), (wanted, Beyond { fourth, flag }), "{text}");
            assert_eq!(found.2, text.replace('\n', ""));
        }
    }
}

#[test]
fn a_block_that_is_none_is_refused_for_the_same_reason_on_one_line_and_drawn_out() {
    for (text, grammar, wanted) in [
        ("B1B2XB3GXL1", As::ThreeB, "expected B, found `X`"),
        ("B1B2B3GBL1", As::ThreeB, "expected the counting axis GX or GY, found `B`"),
        ("B1B2B3GXM1", As::ThreeB, "expected L1-L4, SR1-SR4 or NR1-NR4, found `M`"),
        ("B1B2B3GXS1", As::ThreeB, "expected R, found `1`"),
        ("B1B2B3GXL0", As::ThreeB, "expected the digit 1, 2, 3 or 4, found `0`"),
        ("B1B2B3GXNR5", As::ThreeB, "expected the digit 1, 2, 3 or 4, found `5`"),
        ("B1B2B3GX\u{1}", As::ThreeB, "expected L1-L4, SR1-SR4 or NR1-NR4, found byte 01h"),
        ("B1B2", As::ThreeB, "expected B, found the end of the program"),
        ("B1B0B1000000GXL1", As::ThreeB, "J is larger than 999999 µm, or written with too many zeros"),
        ("B1000000001B0B1GXL1", As::ThreeB, "X is larger than 1000000000 µm, or written with too many zeros"),
        ("B1B2,5B3GXL1", As::ThreeB, "Y holds `,`: 3B numbers are whole micrometres without sign"),
        ("B1000B0B1000L2GXL1", As::ThreeB, "expected the counting axis GX or GY, found `L`"),
        ("B1000B0B1000DGXL1", As::ThreeB, "expected the counting axis GX or GY, found `D`"),
        ("B1000B0B1000GXDL1", As::ThreeB, "expected L1-L4, SR1-SR4 or NR1-NR4, found `D`"),
        ("B1000B0B1000BGXL1", As::ThreeB, "a fourth B: this is a 4B block, and only 3B is read here"),
        ("B0B0B500GYL1", As::ThreeB, "the block never moves along its counting axis, so it would never end"),
        ("B0B5B9B5DGXDNR2", As::FourB, "a second flag in one block"),
        ("B0B5B9B5DDDGXNR2", As::FourB, "expected the counting axis GX or GY, found `D`"),
        ("B0B5B9B5GXNR2", As::FourB, "an arc with a radius and no flag"),
        ("B0B5B9DGXNR2", As::FourB, "an arc with a flag and no radius"),
        ("B0B5B9L1DGXNR2", As::FourB, "an arc with a flag and no radius"),
        ("B0B5B9L1GXNR2", As::FourB, "an arc with a flag and no radius"),
        ("B5B0B5B5DGXL1", As::FourB, "a straight line with a radius"),
        ("B3000B4000B100B5006DGYSR1", As::FourB, "R is not the radius of the circle through X, Y"),
        ("B3000B4000B100B4994DGYSR1", As::FourB, "R is not the radius of the circle through X, Y"),
        ("B0B4000B100B5000DGXSR1", As::FourB, "R is not the radius of the circle through X, Y"),
        ("B5B0B5BLDGXL1", As::FourB, "L without a ratio of taper"),
        ("B5B0B5L12345678.1234567DGXL1", As::FourB, "L without a ratio of taper"),
        ("B5B0B5L0.5.5DGXL1", As::FourB, "expected the counting axis GX or GY, found `.`"),
    ] {
        for text in [text.to_owned(), drawn_out(text)] {
            let (message, place, help) = refusal(&text, grammar);
            assert_eq!(message, wanted, "{text}");
            assert!(!help.is_empty() && place.width > 0);
        }
    }
}

#[test]
fn what_a_block_should_look_like_is_shown_for_the_grammar_in_use() {
    assert!(refusal("B1B2B3GQL1", As::ThreeB).2.contains("a 3B block is `B X B Y B J G Z`"));
    assert!(refusal("B1B2B3GQL1", As::FourB).2.contains("a 4B block is `B X B Y B J B R D|DD G Z`"));
}

#[test]
fn what_is_wrong_with_a_whole_block_underlines_the_block_or_its_last_line() {
    for (text, line, column, width) in [
        ("B1B0B1GXL1 B0B5B9B5GXNR2 D", 1, 1, 0),
        ("  B0B5B9B5GXNR2 D", 1, 3, 13),
        ("  B0B5B9\n B5GXNR2 D", 2, 1, 8),
        ("  B0B0B500GYL1 D", 1, 3, 12),
    ] {
        if width == 0 {
            assert!(first(text, As::FourB).is_ok());
            continue;
        }
        let (message, place, _) = refusal(text, As::FourB);
        assert_eq!((place.line, place.column, place.width), (line, column, width), "{message}");
    }
}

#[test]
fn a_number_too_large_is_underlined_from_its_first_digit() {
    let (_, place, _) = refusal("B1B0B10000009GXL1", As::ThreeB);
    assert_eq!((place.column, place.width), (6, 7));
    let (_, place, _) = refusal("B12345678912B0B1GXL1", As::ThreeB);
    assert_eq!((place.column, place.width), (2, 11 - 1));
}

#[test]
fn a_blocks_numbers_may_take_two_hundred_bytes_with_their_zeros() {
    let numbers = |x: usize, y: usize| format!("B{}B{}B1GXL1", "0".repeat(x - 1) + "1", "0".repeat(y));
    // 1 + 100 + 1 + 96 + 2 are 200 bytes.
    assert!(first(&numbers(100, 96), As::ThreeB).is_ok());
    for (x, y) in [(100, 97), (197, 0), (198, 0), (199, 0), (250, 1)] {
        assert!(refusal(&numbers(x, y), As::ThreeB).0.contains("too many zeros"), "{x} {y}");
    }
    assert!(first(&numbers(196, 0), As::ThreeB).is_ok());
}
