//! The last word on a feed: the journal's end record, the report's figures, and what the operator reads.

use std::time::Duration;

use serde_json::json;

use super::failure::{Exit, Failure};
use super::feeding::time_of_day;
use crate::journal::{Ended, How};
use crate::link::feed::{Outcome, Snapshot, SourceError, SourceFault};
use crate::protocol::{self, Ending, Torn, TornLine};

/// How a feed ended, for the journal.
pub(super) fn ended(outcome: &Outcome) -> Ended {
    let (how, reason, torn) = match &outcome.ending {
        Ending::Done { .. } => (How::Done, "all sent".to_owned(), None),
        Ending::Stopped { torn } if outcome.source_error.is_some() => {
            (How::Failed, "the program is at fault".to_owned(), *torn)
        }
        Ending::Stopped { torn } => (How::Stopped, "stopped by the operator".to_owned(), *torn),
        Ending::Failed { failure, torn } => (How::Failed, failure.to_string(), *torn),
    };
    let torn_bytes = torn.map_or(0, |Torn { bytes, .. }| bytes as u64);
    let Snapshot { block, tally, .. } = outcome.last;
    Ended { how, reason, block, torn_bytes, bytes: tally.bytes, at: time_of_day() }
}

/// The figures of a feed, with the names of the contract.
pub(super) fn report(outcome: &Outcome, from_block: u64, character: Option<Duration>) -> serde_json::Value {
    let Snapshot { now, block, tally, first_byte, .. } = outcome.last;
    let (last_byte, held) = tally.last_byte.unwrap_or((now, tally.held));
    // From the first byte to the last one's own end on the wire, less what the control held in between.
    let sending = (last_byte + character.unwrap_or_default())
        .saturating_sub(first_byte.unwrap_or(now))
        .saturating_sub(held);
    let utilisation = character.map(|character| {
        (character.as_secs_f64() * tally.bytes as f64 / sending.as_secs_f64().max(1e-9)).min(1.0)
    });
    json!({
        "blocks": block + 1 - from_block.min(block + 1),
        "bytes": tally.bytes,
        "seconds": now.as_secs_f64(),
        "held_seconds": tally.held.as_secs_f64(),
        "holds": tally.holds,
        // Without a wire-time model nothing is known of it.
        "max_overrun_bytes": character.map(|_| tally.max_overrun_bytes),
        "line_utilisation": utilisation,
        "first_byte_ms": first_byte.map(|at| at.as_secs_f64() * 1e3),
    })
}

/// The last word on a feed.
pub(super) fn conclude(
    outcome: Outcome,
    job: &str,
    resume: Option<&str>,
    source: &str,
) -> Result<(), Failure> {
    let block = outcome.last.block;
    let after = format!("block {block} was the last one sent whole");
    let torn_words = |torn: Option<Torn>| match torn {
        Some(Torn { line: TornLine::Block(block), bytes }) => {
            format!("; block {block} is torn, {bytes} bytes of it were sent")
        }
        Some(Torn { line: TornLine::StopWordAfter(_), bytes }) => {
            format!("; the stop word after it is torn, {bytes} bytes of it were sent")
        }
        None => String::new(),
    };
    // Where everything sent stands in the control, the next block is known; where it may be lost, only the control knows.
    let known = |failure: Failure| {
        failure.resume_with(resume.map(|line| format!("{line} --from-block {}", block + 1)))
    };
    let asked = |failure: Failure| failure.resume_with(resume.map(str::to_owned));
    match outcome.ending {
        Ending::Done { trailer_unsent } => {
            if trailer_unsent > 0 {
                say!(
                    "the control stopped reading at the stop word; {trailer_unsent} bytes of trailer were not wanted"
                );
            }
            say!("done: job {job}, all blocks to {block} handed over");
            Ok(())
        }
        Ending::Stopped { torn: None } if outcome.source_error.is_some() => Err(outcome
            .source_error
            .map_or_else(|| Failure::new(Exit::Ours, ""), |e| known(source_failure(e, source)))),
        Ending::Stopped { torn: None } => Err(known(
            Failure::new(Exit::Stopped, format!("stopped by the operator: {after}"))
                .help("if the control's screen shows another block, name the one after that"),
        )),
        Ending::Stopped { torn } => Err(asked(
            Failure::new(Exit::Stopped, format!("stopped by the operator: {after}{}", torn_words(torn)))
                .help("the control's own screen says which block it executed last; name the one after it"),
        )),
        Ending::Failed { failure, torn } => {
            let what = match (failure, &outcome.link_error) {
                (protocol::Failure::LinkLost, Some(error)) => error.to_string(),
                (failure, _) => failure.to_string(),
            };
            let exit = match failure {
                protocol::Failure::ControlReset | protocol::Failure::ControlAlarm => Exit::Control,
                protocol::Failure::LinkLost | protocol::Failure::NeverStarted(_) => Exit::Link,
            };
            let help = match failure {
                protocol::Failure::NeverStarted(_) => {
                    "start reading at the control; if it asked before this job was armed, use --set start=at-once"
                }
                protocol::Failure::ControlReset | protocol::Failure::ControlAlarm => {
                    "clear the alarm at the control, and read there which block it executed last: name the one after it"
                }
                protocol::Failure::LinkLost => {
                    "mend the link; the control's own screen says which block it executed last: name the one after it"
                }
            };
            let sent = match failure {
                protocol::Failure::NeverStarted(_) => "; nothing was sent".to_owned(),
                protocol::Failure::LinkLost
                | protocol::Failure::ControlReset
                | protocol::Failure::ControlAlarm => format!(": {after}{}", torn_words(torn)),
            };
            let failed = Failure::new(exit, format!("{what}{sent}")).help(help);
            Err(match failure {
                protocol::Failure::NeverStarted(_) => known(failed),
                protocol::Failure::LinkLost
                | protocol::Failure::ControlReset
                | protocol::Failure::ControlAlarm => asked(failed),
            })
        }
    }
}

/// The fault of a program that was found while it was fed.
fn source_failure(error: SourceError, source: &str) -> Failure {
    let place = format!("block {} cannot be made and was not sent", error.block);
    match error.fault {
        SourceFault::Program(error) => {
            let mut failure = Failure::program(source, error);
            failure.prefix(&place);
            failure
        }
        SourceFault::Tape(error) => Failure::new(Exit::Program, format!("{place}: {error}")),
        SourceFault::Empty => Failure::new(Exit::Program, format!("{source} holds no block")),
        SourceFault::PastEnd { blocks } => super::feeding::no_such_block(error.block, blocks),
        SourceFault::ProducerDied => {
            Failure::new(Exit::Ours, format!("{place}: its maker stopped without a word"))
        }
    }
}
