//! Fanuc's remote buffer, protocol A: the buffer asks, the host answers; every message has a sum.
//!
//! ```text
//!   message: sum (2 hex digits) command (3) data end      sum: low byte of all from command through end
//!
//!   INITIAL ──SYN──▶ host: SYN ─▶ SYN again after Tp      RDY ─▶ STATUS
//!   STATUS  ──SAT──▶ host: SET ─▶ WANTING                 CLB ─▶ buffer cleared, WANTING
//!   WANTING ──GTD──▶ host: DAT ─▶ taken ─▶ GTD, or SAT every Tp while the buffer is full
//!                          WAT ─▶ GTD after Tp            EOD ─▶ DONE
//!   any     wrong sum, or 1 s of silence inside a message ─▶ RTY       host: RTY ─▶ the last message again
//!           no answer at all for Tr ─▶ the last message again; ten in a row of these, but for SYN ─▶ alarm `retries`
//!   alarm ─▶ ALM      reset ─▶ RST
//! ```
//!
//! Sources: domain/4; the table of commands in Fanuc's "Remote Buffer Descriptions" for the Series 15i (B-63322EN-1,
//! 4.4). What SAT and SET hold was not to be had: SAT is said without data, and the data of SET is not looked at. Tp and
//! Tr are guesses, unverified, as is the end code's default. RDI and SDO (signals of the machine) are answered by RTY.

use std::collections::VecDeque;
use std::time::Duration;

use super::{ETX, Machine, Out, RETRIES, Stop};

/// What ends a message: a parameter of the control.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum EndCode {
    /// 0D. Unverified as a default.
    #[default]
    Cr,
    /// 03.
    Etx,
}

impl EndCode {
    fn byte(self) -> u8 {
        match self {
            EndCode::Cr => b'\r',
            EndCode::Etx => ETX,
        }
    }
}

pub(super) struct FanucA {
    end: EndCode,
    state: State,
    message: Vec<u8>,
    last: Duration,
    /// The last command said.
    said: &'static [u8; 3],
    /// It has not been answered.
    awaits: bool,
    /// When the next is said, or the last again if it awaits an answer.
    next: Option<Duration>,
    errors: u32,
    waiting: VecDeque<u8>,
    owes: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Idle,
    Initial,
    Status,
    Wanting,
    Done,
}

impl FanucA {
    pub(super) fn new(end: EndCode) -> FanucA {
        FanucA {
            end,
            state: State::Idle,
            message: Vec::new(),
            last: Duration::ZERO,
            said: b"SYN",
            awaits: false,
            next: None,
            errors: 0,
            waiting: VecDeque::new(),
            owes: false,
        }
    }

    fn message(&self, command: [u8; 3]) -> Vec<u8> {
        let rest = [&command[..], &[self.end.byte()]].concat();
        let sum = rest.iter().fold(0_u8, |sum, &byte| sum.wrapping_add(byte));
        [format!("{sum:02X}").as_bytes(), &rest].concat()
    }

    fn say(&mut self, command: &'static [u8; 3], now: Duration, out: &mut Out) {
        self.said = command;
        self.awaits = true;
        self.next = Some(now + TR);
        out.go(self.message(*command));
    }

    fn retry(&mut self, now: Duration, out: &mut Out) {
        self.message.clear();
        if self.failed(out) {
            return;
        }
        self.next = Some(now + TR);
        out.halt(self.message(*b"RTY"));
    }

    /// Counts an error; true: it was one too many.
    fn failed(&mut self, out: &mut Out) -> bool {
        self.errors += 1;
        let fails = self.errors > RETRIES;
        if fails {
            out.alarm = Some(("retries", format!("no right message in {RETRIES} tries")));
        }
        fails
    }

    fn complete(&mut self, now: Duration, out: &mut Out) {
        let message = std::mem::take(&mut self.message);
        let Some((sum, rest)) = message.split_at_checked(2) else {
            return self.retry(now, out);
        };
        let wanted = format!("{:02X}", rest.iter().fold(0_u8, |sum, &byte| sum.wrapping_add(byte)));
        if !sum.eq_ignore_ascii_case(wanted.as_bytes()) || rest.len() < 4 {
            return self.retry(now, out);
        }
        let (command, data) = rest.split_at(3);
        let data = &data[..data.len() - 1];
        if command == b"RTY" {
            if !self.failed(out) {
                let said = self.said;
                self.say(said, now, out);
            }
            return;
        }
        self.errors = 0;
        self.awaits = false;
        match (self.state, command) {
            (State::Initial, b"SYN") => self.next = Some(now + TP),
            (State::Initial, b"RDY") => {
                self.state = State::Status;
                self.say(b"SAT", now, out);
            }
            (State::Status | State::Wanting, b"SET" | b"CLB") if self.said == b"SAT" => {
                self.state = State::Wanting;
                if self.owes {
                    self.next = Some(now + TP);
                } else {
                    self.say(b"GTD", now, out);
                }
            }
            (State::Wanting, b"DAT") if self.said == b"GTD" && !self.owes => {
                self.waiting.extend(data);
                self.owes = true;
                self.next = Some(now + TP);
            }
            (State::Wanting, b"WAT") if self.said == b"GTD" => self.next = Some(now + TP),
            (State::Wanting, b"EOD") if self.said == b"GTD" => {
                out.ends = true;
                self.next = None;
                self.state = State::Done;
            }
            // AAL and ARS follow an alarm, after which nothing is heard; the rest fits nothing that was asked.
            _ => self.retry(now, out),
        }
    }
}

impl Machine for FanucA {
    fn start(&mut self, now: Duration, out: &mut Out) {
        *self = FanucA { state: State::Initial, ..FanucA::new(self.end) };
        self.say(b"SYN", now, out);
    }

    fn take(&mut self, byte: u8, now: Duration, out: &mut Out) {
        self.last = now;
        if matches!(self.state, State::Idle | State::Done) {
            return;
        }
        self.message.push(byte);
        if byte == self.end.byte() {
            self.complete(now, out);
        } else if self.message.len() > MESSAGE_MAX {
            self.retry(now, out);
        }
    }

    fn pull(&mut self, now: Duration, out: &mut Out) -> bool {
        if let Some(byte) = self.waiting.pop_front() {
            out.text.push(byte);
            return true;
        }
        // With a SAT under way the next GTD waits for its answer.
        if std::mem::take(&mut self.owes) && !self.awaits {
            self.say(b"GTD", now, out);
        }
        false
    }

    fn due(&self) -> Option<Duration> {
        if self.message.is_empty() { self.next } else { Some(self.last + SILENCE) }
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if self.due().is_none_or(|due| now < due) {
            return;
        }
        if !self.message.is_empty() {
            return self.retry(now, out);
        }
        match self.state {
            State::Idle | State::Done => {}
            // The host may come up as late as it likes.
            State::Initial => self.say(b"SYN", now, out),
            State::Status | State::Wanting if self.awaits => {
                let said = self.said;
                if !self.failed(out) {
                    self.say(said, now, out);
                }
            }
            // Full still: the host is told that the buffer lives.
            State::Wanting if self.owes => self.say(b"SAT", now, out),
            State::Status | State::Wanting => self.say(b"GTD", now, out),
        }
    }

    fn close(&mut self) {
        *self = FanucA::new(self.end);
    }

    fn stop(&mut self, stop: Stop, out: &mut Out) {
        out.tell(self.message(match stop {
            Stop::Alarm(_) => *b"ALM",
            Stop::Reset => *b"RST",
        }));
        self.close();
    }

    fn in_transfer(&self) -> bool {
        matches!(self.state, State::Status | State::Wanting)
    }
}

/// Between two messages when there is nothing to do. A guess, unverified.
const TP: Duration = Duration::from_secs(1);

/// The longest wait for an answer. A guess, unverified.
const TR: Duration = Duration::from_secs(10);

/// Inside a message. A guess.
const SILENCE: Duration = Duration::from_secs(1);

/// A guess; it bounds the memory.
const MESSAGE_MAX: usize = 8192;
