//! May this job go on, and from where: a pure decision, laid out as a table.
//!
//! | case | when | answer |
//! |---|---|---|
//! | A | the program made again differs from what the journal vouches for, or its source has changed and nothing vouches for all that may have been sent | refused: changed |
//! | B | the operator names block 0 or one past the program's end | refused: no such block |
//! | C | the operator names a block beyond the last that may have been sent, plus one | refused: blocks would be skipped |
//! | D | the job is done and no block is named | refused: nothing is left |
//! | E | no block is named | a question: the interval is shown and the operator decides |
//! | F | a partial block may stand in the control and nothing in the resumed stream would discard it | refused until the operator says the control was cleared |
//! | G | otherwise | a plan |
//!
//! The first case that holds decides. Refusing is a normal answer; a plan never contains motion the operator did not
//! name. What a control executed is known only from its own screen: the interval from the last block surely accepted
//! (none, over DC codes) to the horizon is the most that can be said here.

use thiserror::Error;

use super::history::History;

/// What is known of the program, made again.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Its blocks.
    pub blocks: u64,
    /// The first segment whose value differs from the journal's, by its last block; none when all agree.
    pub differs_at: Option<u64>,
    /// Whether the source is the same, byte for byte.
    pub same_source: bool,
}

/// What the operator says.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Answer {
    /// The block to send first.
    pub from_block: Option<u64>,
    /// Whether the control was reset or cleared, so that no partial block stands in it.
    pub control_cleared: bool,
}

/// What may follow.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Plan {
    /// The block sent first.
    pub from_block: u64,
    /// Blocks that go out a second time, if they were sent at all.
    pub repeated: u64,
}

/// Why a job is not resumed.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// A.
    #[error("the program is not the one that was sent: it differs within blocks {first} to {last}")]
    Changed {
        /// The first block of the differing segment.
        first: u64,
        /// Its last block.
        last: u64,
    },
    /// A, where the journal's segments do not reach far enough to tell.
    #[error(
        "the source has changed, and nothing vouches for blocks {first} to {last}, which may have been sent"
    )]
    Unvouched {
        /// The first block nothing vouches for.
        first: u64,
        /// The last block that may have been sent.
        last: u64,
    },
    /// B.
    #[error("block {block} does not exist: the program has blocks 1 to {blocks}")]
    NoSuchBlock {
        /// What was named.
        block: u64,
        /// The program's blocks.
        blocks: u64,
    },
    /// C.
    #[error(
        "block {block} cannot be next: no block after {horizon} was ever sent, so blocks would be skipped"
    )]
    WouldSkip {
        /// What was named.
        block: u64,
        /// The last block that may have been sent.
        horizon: u64,
    },
    /// D.
    #[error("the job is done: all {blocks} blocks were sent")]
    Done {
        /// The program's blocks.
        blocks: u64,
    },
    /// E.
    #[error(
        "which block comes next is for the operator to say: the control has executed between {accepted} and {horizon} blocks"
    )]
    AskBlock {
        /// The last block surely accepted.
        accepted: u64,
        /// The last block that may have been sent.
        horizon: u64,
    },
    /// F.
    #[error("a part of a block may stand in the control, and nothing in this format would discard it")]
    MayBeTorn,
}

/// Decides; see the table above.
///
/// `discards_partial` says whether the resumed stream begins with an end of block, which makes a control drop what it
/// has of a torn block.
///
/// # Errors
///
/// With the refusal, which is a normal answer.
pub fn decide(
    history: &History,
    program: &Program,
    answer: Answer,
    discards_partial: bool,
) -> Result<Plan, Refusal> {
    if let Some(last) = program.differs_at {
        let before = history.segments.iter().map(|(block, _)| *block).take_while(|b| *b < last).last();
        return Err(Refusal::Changed { first: before.unwrap_or(0) + 1, last });
    }
    let vouched = match &history.whole {
        Some((blocks, _)) => *blocks,
        None => history.segments.last().map_or(0, |(block, _)| *block),
    };
    let reached = history.horizon.min(program.blocks);
    if !program.same_source && vouched < reached {
        return Err(Refusal::Unvouched { first: vouched + 1, last: reached });
    }
    let done = history.state() == "done";
    let Some(block) = answer.from_block else {
        return Err(if done {
            Refusal::Done { blocks: program.blocks }
        } else {
            // Over DC codes nothing is ever acknowledged, so no block is surely accepted.
            Refusal::AskBlock {
                accepted: history.job.from_block.saturating_sub(1),
                horizon: history.horizon.min(program.blocks),
            }
        });
    };
    // One past the last block sends the stop word alone.
    if block == 0 || block > program.blocks + 1 {
        return Err(Refusal::NoSuchBlock { block, blocks: program.blocks });
    }
    if block > history.horizon + 1 {
        return Err(Refusal::WouldSkip { block, horizon: history.horizon });
    }
    if history.may_be_torn && !discards_partial && !answer.control_cleared {
        return Err(Refusal::MayBeTorn);
    }
    Ok(Plan { from_block: block, repeated: (history.horizon.min(program.blocks) + 1).saturating_sub(block) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::journal::history::tests;
    use crate::journal::{Ended, How};

    fn history() -> History {
        History { segments: vec![(16, String::new()), (32, String::new())], ..tests::history(40, 30) }
    }

    fn program() -> Program {
        Program { blocks: 253, differs_at: None, same_source: true }
    }

    fn from(block: u64) -> Answer {
        Answer { from_block: Some(block), control_cleared: false }
    }

    #[test]
    fn a_a_changed_program_is_refused_with_its_first_differing_segment() {
        let changed = Program { differs_at: Some(32), ..program() };
        let refusal = decide(&history(), &changed, from(20), true).unwrap_err();
        assert_eq!(refusal, Refusal::Changed { first: 17, last: 32 });
    }

    #[test]
    fn a_a_changed_source_is_refused_where_no_segment_vouches_for_it() {
        let changed = Program { same_source: false, ..program() };
        let refusal = decide(&history(), &changed, from(20), true).unwrap_err();
        assert_eq!(refusal, Refusal::Unvouched { first: 33, last: 40 });
        let vouched = History { whole: Some((253, String::new())), ..history() };
        assert!(decide(&vouched, &changed, from(20), true).is_ok());
    }

    #[test]
    fn b_a_block_that_does_not_exist_is_refused() {
        assert!(matches!(decide(&history(), &program(), from(0), true), Err(Refusal::NoSuchBlock { .. })));
        let short = Program { blocks: 20, ..program() };
        assert!(matches!(decide(&history(), &short, from(22), true), Err(Refusal::NoSuchBlock { .. })));
        assert!(decide(&history(), &short, from(21), true).is_ok());
    }

    #[test]
    fn c_blocks_that_were_never_sent_are_not_skipped() {
        assert!(decide(&history(), &program(), from(41), true).is_ok());
        let refusal = decide(&history(), &program(), from(42), true).unwrap_err();
        assert_eq!(refusal, Refusal::WouldSkip { block: 42, horizon: 40 });
    }

    #[test]
    fn d_a_finished_job_has_nothing_left() {
        let ended = Ended {
            how: How::Done,
            reason: String::new(),
            block: 253,
            torn_bytes: 0,
            bytes: 5000,
            at: String::new(),
        };
        let done = History { ended: Some(ended), horizon: 253, ..history() };
        assert_eq!(decide(&done, &program(), Answer::default(), true), Err(Refusal::Done { blocks: 253 }));
        assert!(decide(&done, &program(), from(1), true).is_ok());
    }

    #[test]
    fn e_without_a_block_the_operator_is_asked() {
        let refusal = decide(&history(), &program(), Answer::default(), true).unwrap_err();
        assert_eq!(refusal, Refusal::AskBlock { accepted: 0, horizon: 40 });
    }

    #[test]
    fn f_a_partial_block_that_nothing_discards_must_be_cleared_first() {
        assert_eq!(decide(&history(), &program(), from(31), false), Err(Refusal::MayBeTorn));
        let cleared = Answer { from_block: Some(31), control_cleared: true };
        assert!(decide(&history(), &program(), cleared, false).is_ok());
    }

    #[test]
    fn g_the_plan_says_what_goes_out_a_second_time() {
        let plan = decide(&history(), &program(), from(31), true).unwrap();
        assert_eq!(plan, Plan { from_block: 31, repeated: 10 });
    }

    #[test]
    fn a_a_changed_source_may_go_on_where_segments_vouch_for_all_that_was_sent() {
        let changed = Program { same_source: false, ..program() };
        let vouched = History { horizon: 32, ..history() };
        assert_eq!(decide(&vouched, &changed, from(20), true), Ok(Plan { from_block: 20, repeated: 13 }));
    }
}
