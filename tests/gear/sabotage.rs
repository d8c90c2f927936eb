//! The checks of this directory, tried on programs spoilt on purpose: each must notice.

use mock_controller::{Block, Kind, Model, Quadrant};

use crate::execution::{MODELS, execute, largest_deviation_um, promise_kept, pulses};
use crate::outlines::generate;
use crate::part::PAPERS_PART;

fn papers_blocks(interpolator: &str) -> Vec<Block> {
    generate(&PAPERS_PART, &["--interpolator", interpolator]).0.blocks
}

fn end(model: Model, blocks: &[Block]) -> [i64; 2] {
    *execute(model, blocks, [0, 0]).expect("the program can be executed").last().expect("a place after it")
}

#[test]
fn any_one_j_changed_by_1_leaves_the_outline_open_under_every_model() {
    let blocks = papers_blocks("any");
    for model in MODELS {
        let right = end(model, &blocks);
        for index in 0..blocks.len() {
            let mut spoilt = blocks.clone();
            spoilt[index].j += 1;
            assert_ne!(end(model, &spoilt), right, "block {} under {model:?}", index + 1);
        }
    }
}

#[test]
fn any_one_j_changed_by_1_breaks_the_promise() {
    for interpolator in ["rotated", "mirrored", "strict", "exact"] {
        let blocks = papers_blocks(interpolator);
        // The lead-in only shifts the outline as a whole: its J has the next test.
        for index in (1..blocks.len()).step_by(3) {
            let mut spoilt = blocks.clone();
            spoilt[index].j -= 1;
            let verdict = promise_kept(&spoilt, &PAPERS_PART.path(), interpolator);
            assert!(verdict.is_err(), "{interpolator}: block {} spoilt, unnoticed", index + 1);
        }
    }
}

#[test]
fn a_lead_in_2_um_short_breaks_the_promise() {
    for interpolator in ["any", "rotated", "mirrored", "strict", "exact"] {
        let mut blocks = papers_blocks(interpolator);
        blocks[0].j -= 2;
        let verdict = promise_kept(&blocks, &PAPERS_PART.path(), interpolator);
        assert!(verdict.is_err(), "{interpolator}");
    }
}

#[test]
fn one_block_skipped_changes_the_pulses_and_breaks_the_promise() {
    let blocks = papers_blocks("any");
    for index in 0..blocks.len() {
        let mut spoilt = blocks.clone();
        spoilt.remove(index);
        for model in MODELS {
            assert!(pulses(model, &spoilt) < pulses(model, &blocks), "block {}", index + 1);
        }
        let verdict = promise_kept(&spoilt, &PAPERS_PART.path(), "any");
        assert!(verdict.is_err(), "block {} skipped, unnoticed", index + 1);
    }
}

/// The closed outline ends where it began whatever is skipped in whole turns: only the pulses and the alignment tell.
#[test]
fn one_turn_of_two_skipped_is_noticed() {
    let mut part = PAPERS_PART;
    part.repeat = 2;
    let (program, _) = generate(&part, &[]);
    let once = papers_blocks("any");
    assert_eq!(end(Model::Rotated, &once), end(Model::Rotated, &program.blocks));
    assert!(promise_kept(&program.blocks, &part.path(), "any").is_ok());
    assert!(promise_kept(&once, &part.path(), "any").is_err());
}

#[test]
fn the_papers_own_rounding_does_not_keep_the_promise_of_closed_loop() {
    let (program, _) = generate(&PAPERS_PART, &["--rounding", "per-block"]);
    for interpolator in ["any", "rotated", "mirrored", "strict", "exact"] {
        assert!(promise_kept(&program.blocks, &PAPERS_PART.path(), interpolator).is_err(), "{interpolator}");
    }
}

#[test]
fn the_same_blocks_laid_against_another_gear_break_the_promise() {
    let blocks = papers_blocks("any");
    let mut other = PAPERS_PART;
    other.gear.kp = 2.01;
    assert!(promise_kept(&blocks, &other.path(), "any").is_err());
    let mut other = PAPERS_PART;
    other.gear.offset = 0.072;
    assert!(promise_kept(&blocks, &other.path(), "any").is_err());
}

/// A tip flank bulging the wrong way ends in the right place: only the path between the nodes tells.
#[test]
fn a_straight_line_where_an_arc_should_be_leaves_the_outline() {
    let blocks = papers_blocks("rotated");
    let path = PAPERS_PART.path();
    let measured = promise_kept(&blocks, &path, "rotated").expect("the program is right");
    let index = blocks.iter().position(|block| block.kind == Kind::Clockwise).expect("a tip flank");
    let places = execute(Model::Rotated, &blocks, path.start).expect("the program can be executed");
    let [dx, dy] = [0, 1].map(|axis| places[index + 1][axis] - places[index][axis]);
    let mut spoilt = blocks.clone();
    spoilt[index] = straight(dx, dy);
    assert_eq!(end(Model::Rotated, &spoilt), end(Model::Rotated, &blocks));
    assert!(promise_kept(&spoilt, &path, "rotated").is_ok());
    let largest = largest_deviation_um(Model::Rotated, &spoilt, &path, &measured.element_of_block);
    assert!(largest > 10.0, "{largest:.3} µm");
}

fn straight(dx: i64, dy: i64) -> Block {
    let size = |length: i64| u32::try_from(length.abs()).expect("a short line");
    let (x, y) = (size(dx), size(dy));
    let quadrant = match (dx > 0, dy > 0) {
        (true, true) => Quadrant::First,
        (false, true) => Quadrant::Second,
        (false, false) => Quadrant::Third,
        (true, false) => Quadrant::Fourth,
    };
    let g = if x > y { mock_controller::Axis::X } else { mock_controller::Axis::Y };
    Block { x, y, j: x.max(y), g, kind: Kind::Line, quadrant }
}
