//! The printed text: one block a line that any reader of 3B takes, a stop word at the end, the direction of cut.

use mock_controller::{Kind, parse_block};

use crate::binary::dripfeed;
use crate::execution::read;
use crate::outlines::generate;
use crate::part::PAPERS_PART;
use crate::theory::Direction;

#[test]
fn every_line_is_one_block_and_the_last_is_the_stop_word() {
    for (end, wanted) in [("DD", Some("DD")), ("D", Some("D")), ("E", Some("E")), ("none", None)] {
        let run = dripfeed(&["generate", "gear", "--end", end]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stdout.ends_with('\n'));
        let program = read(&run.stdout);
        assert_eq!(program.stop.as_deref(), wanted);
        assert_eq!(run.stdout.lines().count(), program.blocks.len() + usize::from(wanted.is_some()));
    }
    let silent = dripfeed(&["generate", "gear"]).stdout;
    assert_eq!(silent, dripfeed(&["generate", "gear", "--end", "DD"]).stdout);
}

/// J in six digits for old controls, X and Y unpadded, no blank, capital letters: as the paper pads, in the trade's words.
#[test]
fn a_block_is_printed_without_blanks_and_with_six_digits_of_j() {
    for rounding in ["closed-loop", "per-block"] {
        let text = dripfeed(&["generate", "gear", "--rounding", rounding, "--end", "none"]).stdout;
        for line in text.lines() {
            let block = parse_block(line).expect("a block");
            let plain = block.to_string();
            let (numbers, _) = plain.rsplit_once('G').expect("a G");
            let (x_and_y, j) = numbers.rsplit_once('B').expect("a J");
            assert_eq!(line, plain.replacen(&format!("{x_and_y}B{j}G"), &format!("{x_and_y}B{j:0>6}G"), 1));
        }
    }
}

#[test]
fn the_3b_format_is_what_is_printed_when_nothing_is_said() {
    let said = dripfeed(&["generate", "gear", "--format", "3b"]).stdout;
    assert_eq!(dripfeed(&["generate", "gear"]).stdout, said);
}

#[test]
fn the_papers_options_are_the_defaults() {
    let silent = dripfeed(&["generate", "gear"]).stdout;
    let (said, run) = generate(&PAPERS_PART, &["--direction=cw", "--lead-in=centre", "--repeat=1"]);
    assert_eq!(read(&silent).blocks, said.blocks);
    assert_eq!(silent, run.stdout);
}

/// Each arc turned over, clockwise becoming counter-clockwise; a mirrored block has the numbers of the block it mirrors.
#[test]
fn counter_clockwise_is_the_mirror_image() {
    let mut mirrored = PAPERS_PART;
    mirrored.gear.direction = Direction::CounterClockwise;
    let (clockwise, _) = generate(&PAPERS_PART, &["--rounding=per-block"]);
    let (counter, _) = generate(&mirrored, &["--rounding=per-block"]);
    assert_eq!(clockwise.blocks.len(), counter.blocks.len());
    for (block, image) in clockwise.blocks.iter().zip(&counter.blocks) {
        assert_eq!((block.x, block.y, block.j, block.g), (image.x, image.y, image.j, image.g));
        let turned = match block.kind {
            Kind::Line => Kind::Line,
            Kind::Clockwise => Kind::CounterClockwise,
            Kind::CounterClockwise => Kind::Clockwise,
        };
        assert_eq!(image.kind, turned, "{block} {image}");
    }
}

#[test]
fn blocks_go_to_standard_output_and_nothing_else_does() {
    let run = dripfeed(&["generate", "gear"]);
    assert!(run.stdout.lines().all(|line| line == "DD" || parse_block(line).is_ok()));
    assert!(run.stderr.contains("warning") && run.stderr.contains("node error"), "{}", run.stderr);
}
