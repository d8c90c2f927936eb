//! Heidenhain's blockwise transfer (FE1): a header, then one line of program a block, each with a block check character.
//!
//! ```text
//!   HEADER ──SOH H name E ETB BCC DC1──▶ ACK ─▶ BLOCKS
//!   BLOCKS ──STX line ETB BCC DC1──▶ ACK, once the buffer has taken it      ──ETX EOT──▶ DONE
//!   either   wrong BCC, or 2 s of silence inside a block ─▶ NAK, more than 3 for one block ─▶ EOT, alarm `retries`
//! ```
//!
//! BCC is the XOR of everything from SOH or STX through ETB. Where it would be below 20h a blank stands before ETB; the
//! blank belongs to the line and does no harm. Flow is by ACK and NAK alone: a hold is an ACK that does not come.
//! A block that comes again because its ACK was lost is taken, and cut, twice: a line has no number that the protocol
//! knows, and two lines of a program may be equal. That is the protocol's weakness and not mended here.
//!
//! Sources: domain/4; Heidenhain's technical manuals of the TNC 306, 360 and 407 (header with `E` or `M`, three
//! repetitions, ETX EOT at the end, EOT to the external device in the event of an error). The silence
//! is a guess.

use std::collections::VecDeque;
use std::time::Duration;

use super::{ACK, DC1, EOT, ETB, ETX, Machine, NAK, Out, SOH, STX, Stop};

#[derive(Default)]
pub(super) struct Heidenhain {
    state: State,
    block: Vec<u8>,
    part: Part,
    last: Duration,
    refused: u32,
    waiting: VecDeque<u8>,
    owes: bool,
}

#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum State {
    #[default]
    Idle,
    Header,
    Blocks,
    Ending,
    Done,
}

/// Where in a block the last byte was.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum Part {
    #[default]
    Between,
    Text,
    Check,
    /// BCC has come; whether it was right; DC1 is missing.
    Turn {
        right: bool,
    },
    /// Something that is no block: read past until DC1 or a silence.
    Noise,
}

impl Heidenhain {
    fn is_open(&self) -> bool {
        matches!(self.state, State::Header | State::Blocks)
    }

    fn refuse(&mut self, out: &mut Out) {
        self.block.clear();
        self.part = Part::Between;
        self.refused += 1;
        if self.refused > REPEATS {
            out.alarm = Some(("retries", format!("a block came {} times and never whole", REPEATS + 1)));
            return;
        }
        out.halt([NAK]);
    }

    fn complete(&mut self, out: &mut Out) {
        let block = std::mem::take(&mut self.block);
        self.part = Part::Between;
        let opens = if self.state == State::Header { SOH } else { STX };
        if self.state == State::Blocks && block[0] == SOH {
            // The header again: its ACK was lost.
            out.go([ACK]);
            return;
        }
        if block[0] != opens {
            return self.refuse(out);
        }
        self.refused = 0;
        if block[0] == SOH {
            self.state = State::Blocks;
            out.go([ACK]);
            return;
        }
        self.waiting.extend(&block[1..block.len() - 1]);
        if !block[..block.len() - 1].ends_with(b"\n") {
            self.waiting.push_back(b'\n');
        }
        self.owes = true;
    }
}

impl Machine for Heidenhain {
    fn start(&mut self, _now: Duration, _out: &mut Out) {
        *self = Heidenhain { state: State::Header, ..Heidenhain::default() };
    }

    fn take(&mut self, byte: u8, now: Duration, out: &mut Out) {
        self.last = now;
        if self.state == State::Ending && byte == EOT {
            out.ends = true;
            self.state = State::Done;
            return;
        }
        if !self.is_open() {
            return;
        }
        if self.owes {
            out.unread += 1;
            return;
        }
        match self.part {
            Part::Between => match byte {
                SOH | STX => {
                    self.block.push(byte);
                    self.part = Part::Text;
                }
                ETX if self.state == State::Blocks => self.state = State::Ending,
                EOT => {
                    out.breaks = true;
                    self.state = State::Done;
                }
                _ => self.part = Part::Noise,
            },
            Part::Text => {
                self.block.push(byte);
                if byte == ETB {
                    self.part = Part::Check;
                } else if self.block.len() > BLOCK_MAX {
                    self.part = Part::Noise;
                }
            }
            Part::Check => {
                let right = self.block.iter().fold(0, |check, byte| check ^ byte) == byte;
                self.part = Part::Turn { right };
            }
            Part::Turn { right: true } if byte == DC1 => self.complete(out),
            Part::Turn { right: false } | Part::Noise if byte == DC1 => self.refuse(out),
            Part::Turn { .. } => self.part = Part::Noise,
            Part::Noise => {}
        }
    }

    fn pull(&mut self, _now: Duration, out: &mut Out) -> bool {
        if let Some(byte) = self.waiting.pop_front() {
            out.text.push(byte);
            return true;
        }
        if std::mem::take(&mut self.owes) {
            out.go([ACK]);
        }
        false
    }

    fn due(&self) -> Option<Duration> {
        let waits = (self.is_open() && self.part != Part::Between) || self.state == State::Ending;
        waits.then_some(self.last + SILENCE)
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if self.due().is_none_or(|due| now < due) {
            return;
        }
        if self.state == State::Ending {
            // ETX has said it; its EOT was lost.
            out.ends = true;
            self.state = State::Done;
        } else {
            self.refuse(out);
        }
    }

    fn close(&mut self) {
        *self = Heidenhain::default();
    }

    fn stop(&mut self, _stop: Stop, out: &mut Out) {
        out.tell([EOT]);
        self.close();
    }

    fn in_transfer(&self) -> bool {
        matches!(self.state, State::Blocks | State::Ending) || self.owes
    }
}

/// "≤ 3 repeats" (domain/4).
const REPEATS: u32 = 3;

const SILENCE: Duration = Duration::from_secs(2);

/// A guess; it bounds the memory.
const BLOCK_MAX: usize = 4096;
