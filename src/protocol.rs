//! Protocols as machines without input or output: told what happened and when, asked what to do next.
//!
//! Every machine keeps the same contract. After any `handle_*`, drain `poll_transmit`, `poll_event` and, if
//! [`Protocol::wants_block`], offer a block, before waiting until `poll_timeout` at the latest. Time is a [`Duration`]
//! since the job began and never runs backwards. Bytes looked at are not bytes sent: progress moves only in
//! `handle_transmitted`, with the count the link really took.
//!
//! Only [`dc_codes`] is here yet. Clocks, ports and threads are not here at all.

#![warn(clippy::wildcard_enum_match_arm)]

pub mod dc_codes;
pub mod pacing;

use std::time::Duration;

use thiserror::Error;

/// What an operator may say to a running job.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Command {
    /// Stop when the block in hand has been sent whole.
    StopAtBlock,
    /// Stop at once, in mid-block if need be.
    StopNow,
}

/// What a protocol reports, for the journal and the screen.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Event {
    /// The control asked for the program, or the profile starts at once.
    Started,
    /// The control stopped the sender.
    Held,
    /// The control let the sender go on.
    Released {
        /// How long it had been held.
        held: Duration,
    },
    /// Every byte of the blocks up to this one has been handed to the link.
    Transmitted {
        /// The block, numbered from 1 as emitted.
        block: u64,
    },
    /// The job is over.
    Ended(Ending),
}

/// How a job ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Ending {
    /// All that there was to send is on the line, and the line is empty.
    Done {
        /// Bytes of the trailer the control no longer wanted, having stopped at the program's stop word.
        trailer_unsent: usize,
    },
    /// The operator stopped it.
    Stopped {
        /// The block that was cut in two, if any.
        torn: Option<Torn>,
    },
    /// Something else did.
    Failed {
        /// What.
        failure: Failure,
        /// The block that was cut in two, if any.
        torn: Option<Torn>,
    },
}

/// A line of which the control has a part.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Torn {
    /// What of the program it is.
    pub line: TornLine,
    /// How many of its bytes were handed to the link.
    pub bytes: usize,
}

/// See [`Torn`].
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum TornLine {
    /// This block.
    Block(u64),
    /// The stop word after this block.
    StopWordAfter(u64),
}

/// What a program ends with.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ProgramEnd {
    /// A stop word, at which a control may stop reading.
    StopWord,
    /// A block: the control needs the trailer to know that this is the end.
    Block,
}

/// Why a job failed on the line.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// SYN: the control was reset.
    #[error("the control was reset (it sent SYN)")]
    ControlReset,
    /// NAK: the control raised an alarm.
    #[error("the control raised an alarm (it sent NAK)")]
    ControlAlarm,
    /// The link went away.
    #[error("the link was lost")]
    LinkLost,
    /// The control did not ask for the program within the profile's `start_timeout_s`.
    #[error("the control did not ask for the program within {} s", .0.as_secs())]
    NeverStarted(Duration),
}

/// What the line is doing, for the screen.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Phase {
    /// Waiting for the control to ask; without limit unless the profile sets one.
    AwaitingStart {
        /// Since when.
        since: Duration,
    },
    /// Sending.
    Feeding,
    /// Stopped by the control; without limit.
    Held {
        /// Since when.
        since: Duration,
    },
    /// Everything handed over; waiting for the line to run empty.
    Draining,
    /// Only the trailer is left and the control stopped reading; it has until then to ask for it.
    Lingering {
        /// Until when.
        until: Duration,
    },
    /// Over.
    Ended,
}

/// One end of a conversation with a control.
pub trait Protocol: Send {
    /// Whether the machine has room for another block: less than the window is waiting here and on the wire.
    fn wants_block(&self, now: Duration) -> bool;
    /// Gives the next line: the number of its block and the bytes that go on the line, end of block included. A stop word
    /// comes with the number of the block before it.
    fn offer_block(&mut self, number: u64, bytes: &[u8]);
    /// Says that there are no more lines, and what the last one was.
    fn finish(&mut self, end: ProgramEnd);

    /// The control spoke.
    fn handle_received(&mut self, bytes: &[u8], now: Duration);
    /// The link took `count` of the bytes last returned by `poll_transmit`.
    fn handle_transmitted(&mut self, count: usize, now: Duration);
    /// The operator spoke.
    fn handle_command(&mut self, command: Command, now: Duration);
    /// The link went away.
    fn handle_link_lost(&mut self, now: Duration);
    /// Time passed.
    fn handle_timeout(&mut self, now: Duration);

    /// The bytes that may be handed to the link now; looking does not send them.
    fn poll_transmit(&self, now: Duration) -> &[u8];
    /// When to call `handle_timeout` at the latest; none when only the control or the operator can change anything.
    fn poll_timeout(&self, now: Duration) -> Option<Duration>;
    /// The next thing to report.
    fn poll_event(&mut self) -> Option<Event>;

    /// What the line is doing.
    fn phase(&self) -> Phase;
    /// Figures of the line so far.
    fn tally(&self) -> Tally;
}

/// Figures a protocol keeps.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Tally {
    /// Bytes handed to the link, leader and trailer included.
    pub bytes: u64,
    /// When the last of them was, and how long the sender had been held by then.
    pub last_byte: Option<(Duration, Duration)>,
    /// Time held by the control; a hold counts once it is over.
    pub held: Duration,
    /// Holds.
    pub holds: u64,
    /// Most characters the wire-time model puts on the line after a DC3 had left the control.
    pub max_overrun_bytes: u64,
}
