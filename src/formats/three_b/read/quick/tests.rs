use super::*;

fn three_b(text: &str) -> Option<(Block, Beyond, usize)> {
    block::<false>(text.as_bytes())
}

fn four_b(text: &str) -> Option<(Block, Beyond, usize)> {
    block::<true>(text.as_bytes())
}

fn of(x: i64, y: i64, j: i64, g: Axis, motion: Motion) -> Block {
    Block { x: Micrometres(x), y: Micrometres(y), j: Micrometres(j), g, motion }
}

#[test]
fn a_plain_block_is_taken_in_one_go_and_no_more_of_its_line() {
    let (first, third) = (Motion::Line(Quadrant::First), Motion::Line(Quadrant::Third));
    let nr4 = Motion::Arc(Sense::CounterClockwise, Quadrant::Fourth);
    let sr2 = Motion::Arc(Sense::Clockwise, Quadrant::Second);
    for (text, wanted) in [
        ("B579B6617B006617GYL3", of(579, 6617, 6617, Axis::Y, third)),
        ("BBB9900GXL1", of(0, 0, 9900, Axis::X, first)),
        ("B1B2B3XL1", of(1, 2, 3, Axis::X, first)),
        ("B1B2B3YL3", of(1, 2, 3, Axis::Y, third)),
        ("B999999999B0B999999GXL1", of(999_999_999, 0, 999_999, Axis::X, first)),
        ("B0B9900B39600GXNR4", of(0, 9900, 39_600, Axis::X, nr4)),
        ("B9900B0B39600GYSR2", of(9900, 0, 39_600, Axis::Y, sr2)),
    ] {
        for behind in ["", "\n", " DD\n", "B1B0B1GXL1", "D"] {
            let line = format!("{text}{behind}");
            let wanted = Some((wanted, Beyond::default(), text.len()));
            assert_eq!((three_b(&line), four_b(&line)), (wanted, wanted), "{line}");
        }
    }
}

#[test]
fn radius_and_flag_of_a_4b_block_are_taken_with_it() {
    let arc = of(0, 5000, 10_000, Axis::X, Motion::Arc(Sense::CounterClockwise, Quadrant::Second));
    let line = of(1000, 0, 1000, Axis::X, Motion::Line(Quadrant::First));
    let radius = |um| Some(Fourth::Radius(Micrometres(um)));
    for (text, block, fourth, flag) in [
        ("B0B5000B10000B5000DGXNR2", arc, radius(5000), Some(Flag::D)),
        ("B0B5000B10000B5000DDGXNR2", arc, radius(5000), Some(Flag::DD)),
        ("B0B5000B10000B5000GXDNR2", arc, radius(5000), Some(Flag::D)),
        ("B0B5000B10000B5000XDDNR2", arc, radius(5000), Some(Flag::DD)),
        ("B1000B0B1000B0GXL1", line, radius(0), None),
        ("B1000B0B1000BGXL1", line, None, None),
        ("B1000B0B1000BDGXL1", line, None, Some(Flag::D)),
        ("B1000B0B1000DDXL1", line, None, Some(Flag::DD)),
    ] {
        for behind in ["", "DD\n", "B1B0B1GXL1"] {
            let found = four_b(&format!("{text}{behind}"));
            assert_eq!(found, Some((block, Beyond { fourth, flag }, text.len())), "{text}{behind}");
        }
        assert_eq!(three_b(text), None, "{text}");
    }
}

#[test]
fn what_is_no_plain_block_is_left_to_the_careful_way() {
    for text in [
        "",
        "B",
        "B1",
        "B1B2B3",
        "B1B2B3G",
        "B1B2B3GX",
        "B1B2B3GXL",
        "B1B2B3GXNR",
        "1B2B3GXL1",
        "B1B2B3GZL1",
        "B1B2B3GXQ1",
        "B1B2B3GXL0",
        "B1B2B3GXL5",
        "B1B2B3GXS1",
        "b1b2b3gxl1",
        "B1 B2 B3 GX L1",
        "B-1B2B3GXL1",
        "B1234567890B0B1GXL1",
        "B0B1234567890B1GYL2",
        "B1B0B1234567GXL1",
        "B0B0B500GYL1",
        "B1B0B9GXNR1",
    ] {
        assert_eq!((three_b(text), four_b(text)), (None, None), "{text}");
    }
    for text in [
        "B0B5B9B5DGXDNR2",
        "B0B5B9B5GXNR2",
        "B0B5B9DGXNR2",
        "B5B0B5B5DGXL1",
        "B5B0B5BL1GXL1",
        "B0B5B9B15DGXNR2",
    ] {
        assert_eq!((three_b(text), four_b(text)), (None, None), "{text}");
    }
}

#[test]
fn blanks_are_squeezed_out_and_found_again() {
    let squeezed = |line: &str| {
        let mut text = b"of the last line".to_vec();
        squeeze(line.as_bytes(), &mut text);
        String::from_utf8(text).unwrap()
    };
    assert_eq!(squeezed("b 1\tb2 b3\r gx \0l1 d"), "B1B2B3GXL1D");
    for behind in ["\nB9", ";B9", " ;B9", "(B9)"] {
        assert_eq!(squeezed(&format!("B1 B2{behind}")), "B1B2");
    }
    // A line of blocks is not squeezed to its end for the first of them.
    assert_eq!(squeezed(&"B1".repeat(1000)).len(), 96);
    for (line, length, wanted) in [("B 1 B2 ", 1, 1), ("B 1 B2 ", 2, 3), ("B 1 B2 ", 3, 5), ("B 1 B2 ", 4, 6)]
    {
        assert_eq!(spread(line.as_bytes(), length), wanted, "{line} {length}");
    }
}
