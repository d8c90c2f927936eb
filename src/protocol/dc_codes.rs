//! DC1-DC4 (XON/XOFF at the application's level): the control starts, stops and ends the transfer.
//!
//! ```text
//!  AwaitingStart ──────DC1──────────▶ Feeding ──DC3──▶ Held ──DC1──▶ Feeding
//!        │                              │ all handed over      └─SYN, NAK─▶ failed, for good
//!        │ profile starts at once       ▼
//!        └─────────────────────────▶ Draining ──line empty, 0.3 s──▶ done
//!
//!  DC3 with nothing left:               the end of the transfer, not a hold → Draining
//!  DC3 with only the trailer left,
//!  after the program's stop word:       Lingering ──DC1──▶ Feeding
//!                                           └──5 s of silence──▶ done, trailer not wanted
//! ```
//!
//! The control's characters carry even parity in bit 8 when the port runs with eight data bits, so DC3 may come as 93h;
//! only the low seven bits are compared. A second DC1 is not a second start (Haas repeats it every 5 s). A hold has no
//! time limit. SYN (reset) and NAK (alarm) are final wherever they come once the transfer has begun. Source: Fanuc and
//! Haas reader/puncher manuals as worked out in `docs/protocols.md`; that DC2 and DC4 from the control change nothing
//! while it reads is unverified.
//!
//! Nothing on the way *to* the control is interpreted: in EIA code the digit 3 is 13h.

use std::collections::VecDeque;
use std::time::Duration;

use super::pacing::{Pace, Pacer};
use super::{Command, Ending, Event, Failure, Phase, ProgramEnd, Protocol, Tally, Torn, TornLine};

/// What the profile and the job say about the conversation.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How the line is paced.
    pub pace: Pace,
    /// Whether to wait for DC1 before the first byte.
    pub wait_for_start: bool,
    /// How long to wait for it; none waits without limit, visibly.
    pub start_timeout: Option<Duration>,
    /// Bytes before the first block.
    pub leader: Vec<u8>,
    /// Bytes after the last block.
    pub trailer: Vec<u8>,
}

/// The sender's end of a DC1-DC4 conversation.
#[derive(Debug)]
pub struct DcCodes {
    settings: Settings,
    state: State,
    pacer: Pacer,
    /// Bytes not yet handed over, from `start` on.
    text: Vec<u8>,
    start: usize,
    /// Where each block in `text` ends, as a count of bytes since the job began, with its number.
    ends: VecDeque<(u64, u64)>,
    /// Bytes handed over, and where the current block began.
    handed: u64,
    block_began: u64,
    /// The last block handed over whole; a line that still has its number is a stop word.
    transmitted: u64,
    source_finished: Option<ProgramEnd>,
    /// Bytes of the trailer among those not yet handed over.
    trailer_left: usize,
    stopping: bool,
    events: VecDeque<Event>,
    tally: Tally,
    /// Bytes handed over when the control last let us go, to bound the overrun.
    handed_at_release: u64,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    AwaitingStart { since: Duration },
    Feeding,
    Held { since: Duration },
    Draining { until: Duration },
    Lingering { until: Duration },
    Ended,
}

impl DcCodes {
    /// A machine that begins at `now`.
    #[must_use]
    pub fn new(settings: Settings, now: Duration) -> Self {
        let wait = settings.wait_for_start;
        let mut machine = Self {
            state: State::AwaitingStart { since: now },
            pacer: Pacer::new(settings.pace),
            text: settings.leader.clone(),
            start: 0,
            ends: VecDeque::new(),
            handed: 0,
            block_began: settings.leader.len() as u64,
            transmitted: 0,
            source_finished: None,
            trailer_left: 0,
            stopping: false,
            events: VecDeque::new(),
            tally: Tally::default(),
            handed_at_release: 0,
            settings,
        };
        if !wait {
            machine.begin();
        }
        machine
    }

    fn begin(&mut self) {
        self.state = State::Feeding;
        self.events.push_back(Event::Started);
    }

    fn left(&self) -> usize {
        self.text.len() - self.start
    }

    fn end(&mut self, ending: Ending, now: Duration) {
        self.end_hold(now);
        self.state = State::Ended;
        self.events.push_back(Event::Ended(ending));
    }

    fn torn(&self) -> Option<Torn> {
        let bytes = self.handed.checked_sub(self.block_began)? as usize;
        let (_, block) = *self.ends.front()?;
        let line =
            if block == self.transmitted { TornLine::StopWordAfter(block) } else { TornLine::Block(block) };
        (bytes > 0).then_some(Torn { line, bytes })
    }

    fn fail(&mut self, failure: Failure, now: Duration) {
        let torn = self.torn();
        self.end(Ending::Failed { failure, torn }, now);
    }

    /// Whether everything there will ever be has been handed over.
    fn is_all_handed(&self) -> bool {
        self.source_finished.is_some() && self.left() == 0
    }

    fn is_only_trailer_left(&self) -> bool {
        self.source_finished.is_some() && self.left() > 0 && self.left() == self.trailer_left
    }

    /// Settles into draining or ends, if the moment has come.
    fn settle(&mut self, now: Duration) {
        if self.stopping
            && self.torn().is_none()
            && !matches!(self.state, State::Draining { .. } | State::Ended)
        {
            // A boundary: what is left stays unsent, and what the driver has runs out first.
            self.end_hold(now);
            self.state = State::Draining { until: self.pacer.free_at().max(now) };
        }
        match self.state {
            State::Feeding if self.is_all_handed() => self.drain(now),
            State::Draining { until } if now >= until => {
                let stopped = self.stopping && !self.is_all_handed();
                let ending =
                    if stopped { Ending::Stopped { torn: None } } else { Ending::Done { trailer_unsent: 0 } };
                self.end(ending, now);
            }
            State::Lingering { until } if now >= until => self.end_without_trailer(now),
            State::AwaitingStart { since } => {
                if let Some(limit) = self.settings.start_timeout
                    && now >= since + limit
                {
                    self.end(Ending::Failed { failure: Failure::NeverStarted(limit), torn: None }, now);
                }
            }
            State::Feeding
            | State::Held { .. }
            | State::Draining { .. }
            | State::Lingering { .. }
            | State::Ended => {}
        }
    }

    fn drain(&mut self, now: Duration) {
        let listen = self.settings.pace.latency + LISTEN;
        self.state = State::Draining { until: self.pacer.free_at().max(now) + listen };
    }

    fn end_without_trailer(&mut self, now: Duration) {
        let trailer_unsent = self.left();
        self.end(Ending::Done { trailer_unsent }, now);
    }

    fn end_hold(&mut self, now: Duration) {
        if let State::Held { since } = self.state {
            self.tally.held += now.saturating_sub(since);
        }
    }

    fn release(&mut self, since: Duration, now: Duration) {
        let held = now.saturating_sub(since);
        self.end_hold(now);
        self.handed_at_release = self.handed;
        self.state = State::Feeding;
        self.events.push_back(Event::Released { held });
    }

    fn hold(&mut self, now: Duration) {
        // The DC3 left the control one latency ago; whatever is completed after that is overrun.
        let since_release = (self.handed - self.handed_at_release) as usize;
        let overrun =
            self.pacer.completed_after(now.saturating_sub(self.settings.pace.latency), since_release);
        self.tally.max_overrun_bytes = self.tally.max_overrun_bytes.max(overrun as u64);
        if self.is_only_trailer_left() && self.source_finished == Some(ProgramEnd::StopWord) {
            self.state = State::Lingering { until: now + LINGER };
            return;
        }
        if self.is_all_handed() {
            // The last byte is out: this DC3 ends the transfer.
            self.drain(now);
            return;
        }
        self.tally.holds += 1;
        self.state = State::Held { since: now };
        self.events.push_back(Event::Held);
    }

    fn character(&mut self, byte: u8, now: Duration) {
        let code = byte & 0x7F;
        match self.state {
            State::AwaitingStart { .. } => {
                // Whatever else the control says before it asks, such as the DC3 that ended its last transfer, is not ours.
                if code == DC1 {
                    self.begin();
                }
            }
            State::Feeding => match code {
                DC3 => self.hold(now),
                SYN => self.fail(Failure::ControlReset, now),
                NAK => self.fail(Failure::ControlAlarm, now),
                // A second DC1 is not a second start; DC2 and DC4 concern the control's own punch.
                _ => {}
            },
            State::Held { since } => match code {
                DC1 => self.release(since, now),
                SYN => self.fail(Failure::ControlReset, now),
                NAK => self.fail(Failure::ControlAlarm, now),
                // A repeated DC3 changes nothing.
                _ => {}
            },
            State::Draining { .. } => match code {
                SYN => self.fail(Failure::ControlReset, now),
                NAK => self.fail(Failure::ControlAlarm, now),
                // DC3 after the last byte is the end of the transfer.
                _ => {}
            },
            State::Lingering { .. } => match code {
                DC1 => self.state = State::Feeding,
                SYN => self.fail(Failure::ControlReset, now),
                NAK => self.fail(Failure::ControlAlarm, now),
                _ => {}
            },
            // Nothing after the end concerns this job.
            State::Ended => {}
        }
    }
}

impl Protocol for DcCodes {
    fn wants_block(&self, now: Duration) -> bool {
        let ahead = self.left() + self.pacer.unsent(now);
        match self.state {
            // Before the start one block is fetched, so that a program that cannot even begin is known by then.
            State::AwaitingStart { .. } => {
                self.source_finished.is_none() && !self.stopping && self.ends.is_empty()
            }
            State::Feeding | State::Held { .. } => {
                self.source_finished.is_none() && !self.stopping && ahead < self.settings.pace.window
            }
            State::Draining { .. } | State::Lingering { .. } | State::Ended => false,
        }
    }

    fn offer_block(&mut self, number: u64, bytes: &[u8]) {
        if self.start == self.text.len() {
            self.text.clear();
            self.start = 0;
        } else if self.start >= COMPACT_AT {
            self.text.drain(..self.start);
            self.start = 0;
        }
        self.text.extend_from_slice(bytes);
        self.ends.push_back((self.handed + self.left() as u64, number));
    }

    fn finish(&mut self, end: ProgramEnd) {
        if self.source_finished.is_some() {
            return;
        }
        self.source_finished = Some(end);
        self.text.extend_from_slice(&self.settings.trailer);
        self.trailer_left = self.settings.trailer.len();
        // Held since the last line: what looked like a hold may have been the end.
        if let State::Held { since } = self.state {
            if self.is_all_handed() {
                self.drain(since);
            } else if self.is_only_trailer_left() && end == ProgramEnd::StopWord {
                self.state = State::Lingering { until: since + LINGER };
            }
        }
    }

    fn handle_received(&mut self, bytes: &[u8], now: Duration) {
        for &byte in bytes {
            self.character(byte, now);
        }
        self.settle(now);
    }

    fn handle_transmitted(&mut self, count: usize, now: Duration) {
        self.start += count;
        assert!(self.start <= self.text.len(), "the link took more bytes than it was offered");
        self.handed += count as u64;
        self.tally.bytes += count as u64;
        self.tally.last_byte = Some((now, self.tally.held));
        self.trailer_left = self.trailer_left.min(self.left());
        self.pacer.handed(count, now);
        let mut transmitted = None;
        while let Some(&(end, block)) = self.ends.front() {
            if end > self.handed {
                break;
            }
            self.block_began = end;
            transmitted = Some(block);
            self.ends.pop_front();
        }
        if let Some(block) = transmitted {
            self.transmitted = block;
            self.events.push_back(Event::Transmitted { block });
        }
        self.settle(now);
    }

    fn handle_command(&mut self, command: Command, now: Duration) {
        match (command, self.state) {
            (_, State::Ended) => {}
            (Command::StopAtBlock, _) => self.stopping = true,
            (Command::StopNow, _) => {
                let torn = self.torn();
                self.end(Ending::Stopped { torn }, now);
            }
        }
        self.settle(now);
    }

    fn handle_link_lost(&mut self, now: Duration) {
        match self.state {
            State::Ended => {}
            // All the control wants is there; a link that goes now takes nothing with it.
            State::Lingering { .. } => self.end_without_trailer(now),
            State::Draining { .. } if self.is_all_handed() && now >= self.pacer.free_at() => {
                self.end(Ending::Done { trailer_unsent: 0 }, now);
            }
            State::AwaitingStart { .. } | State::Feeding | State::Held { .. } | State::Draining { .. } => {
                self.fail(Failure::LinkLost, now);
            }
        }
    }

    fn handle_timeout(&mut self, now: Duration) {
        self.settle(now);
    }

    fn poll_transmit(&self, now: Duration) -> &[u8] {
        if self.state != State::Feeding {
            return &[];
        }
        let mut room = self.pacer.room(now).min(self.left());
        if self.stopping {
            // No further than the end of the block in hand.
            let boundary = match self.ends.front() {
                Some(&(end, _)) if self.torn().is_some() => (end - self.handed) as usize,
                _ => 0,
            };
            room = room.min(boundary);
        }
        &self.text[self.start..self.start + room]
    }

    fn poll_timeout(&self, now: Duration) -> Option<Duration> {
        match self.state {
            State::AwaitingStart { since } => self.settings.start_timeout.map(|limit| since + limit),
            // Waiting for the source; the link's loop wakes when a block is there.
            State::Feeding if self.left() == 0 && self.wants_block(now) => None,
            State::Feeding => self.pacer.room_at(now),
            State::Held { .. } => None,
            State::Draining { until } => Some(until),
            State::Lingering { until } => Some(until),
            State::Ended => None,
        }
    }

    fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn phase(&self) -> Phase {
        match self.state {
            State::AwaitingStart { since } => Phase::AwaitingStart { since },
            State::Feeding => Phase::Feeding,
            State::Held { since } => Phase::Held { since },
            State::Draining { .. } => Phase::Draining,
            State::Lingering { until } => Phase::Lingering { until },
            State::Ended => Phase::Ended,
        }
    }

    fn tally(&self) -> Tally {
        self.tally
    }
}

/// Device control 1: start, go on.
const DC1: u8 = 0x11;
/// Device control 3: stop.
const DC3: u8 = 0x13;
/// Negative acknowledge: on these controls, an alarm.
const NAK: u8 = 0x15;
/// Synchronous idle: on these controls, a reset.
const SYN: u8 = 0x16;

/// How long the control is listened to once the line is empty: it may still answer the last bytes with an alarm. A guess.
const LISTEN: Duration = Duration::from_millis(300);

/// How long a control that stopped at the stop word may still ask for the trailer. A guess: Haas repeats DC1 every 5 s.
const LINGER: Duration = Duration::from_secs(5);

/// Bytes handed over that are kept in front of the text before it is moved up.
const COMPACT_AT: usize = 65_536;

#[cfg(test)]
mod tests;
