//! YMODEM, the receiving side: for each file a packet 0 with its name and length, then packets as XMODEM-1K has them.
//!
//! ```text
//!   ASKING ──C every 3 s──▶ packet 0 with a name ─▶ ACK C ─▶ DATA       packet 0 without one ─▶ ACK ─▶ DONE
//!   DATA   right number, once the buffer has taken it ─▶ ACK             packet 0 again ─▶ ACK C
//!          broken, or 10 s of silence ─▶ NAK (C before the first), ten times running ─▶ CAN CAN, alarm `retries`
//!          EOT ─▶ NAK, EOT ─▶ ACK C ─▶ ASKING: each file is a program
//!          another number ─▶ CAN CAN, alarm `sequence`      fewer bytes than its length ─▶ alarm `size`
//! ```
//!
//! What is beyond the length is padding; without a length 1A at the end of a packet is.
//!
//! Sources: domain/4; name, length and the NAK to the first EOT are the protocol's usage ([recall]). A sender that never
//! says that no file follows is let go after ten C.

use std::collections::VecDeque;
use std::time::Duration;

use super::packet::{Check, Heard, Packets};
use super::{ACK, CAN, Machine, NAK, Out, RETRIES, SUB, Stop};

pub(super) struct Ymodem {
    packets: Packets,
    state: State,
    wanted: u8,
    waiting: VecDeque<u8>,
    owes: bool,
    errors: u32,
    /// Bytes of the file that have not come, if its length was told.
    left: Option<u64>,
    /// The first EOT has come.
    ending: bool,
    /// A file has come on this link.
    had_file: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Idle,
    Asking { next: Duration },
    Data { until: Duration },
    Done,
}

impl Default for Ymodem {
    fn default() -> Ymodem {
        Ymodem {
            packets: Packets::new(Check::Crc, true),
            state: State::Idle,
            wanted: 0,
            waiting: VecDeque::new(),
            owes: false,
            errors: 0,
            left: None,
            ending: false,
            had_file: false,
        }
    }
}

impl Ymodem {
    fn ask(&mut self, now: Duration, out: &mut Out) {
        self.errors += u32::from(self.had_file);
        if self.errors > RETRIES {
            self.state = State::Done;
            return;
        }
        out.go([b'C']);
        self.state = State::Asking { next: now + ASK };
    }

    fn heard(&mut self, heard: Heard, now: Duration, out: &mut Out) {
        match (self.state, heard) {
            (_, Heard::Nothing) | (State::Idle, _) => {}
            (State::Done, Heard::Packet { .. }) => out.go([ACK]),
            (State::Done, _) => {}
            (State::Asking { .. }, Heard::Packet { number: 0, data }) => self.header(&data, now, out),
            (State::Asking { .. }, Heard::Packet { number, .. }) => {
                out.alarm = Some(("sequence", format!("packet {number} before packet 0")));
            }
            (State::Asking { .. }, Heard::End) if self.had_file => out.go([ACK, b'C']),
            (State::Asking { .. }, Heard::End | Heard::Broken) => self.ask(now, out),
            (State::Data { .. }, Heard::Packet { number, data }) => self.packet(number, data, now, out),
            (State::Data { .. }, Heard::Broken) => self.again(now, out),
            (State::Data { .. }, Heard::End) if self.ending => self.file_ends(now, out),
            (State::Data { .. }, Heard::End) => {
                self.ending = true;
                out.go([NAK]);
                self.state = State::Data { until: now + PATIENCE };
            }
            (State::Asking { .. } | State::Data { .. }, Heard::Cancelled) => {
                out.breaks = true;
                self.waiting.clear();
                self.owes = false;
                self.state = State::Done;
            }
        }
    }

    fn header(&mut self, data: &[u8], now: Duration, out: &mut Out) {
        if data[0] == 0 {
            out.go([ACK]);
            self.state = State::Done;
            return;
        }
        let rest = data.split(|&byte| byte == 0).nth(1).unwrap_or_default();
        let digits = rest.split(|byte| !byte.is_ascii_digit()).next().unwrap_or_default();
        self.left = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
        self.wanted = 1;
        self.errors = 0;
        self.ending = false;
        out.go([ACK, b'C']);
        self.state = State::Data { until: now + PATIENCE };
    }

    fn packet(&mut self, number: u8, mut data: Vec<u8>, now: Duration, out: &mut Out) {
        self.state = State::Data { until: now + PATIENCE };
        if number == self.wanted.wrapping_sub(1) {
            // Number 0 may be packet 256 or the header: the header comes again only before the first.
            match (self.owes, number) {
                (true, _) => {}
                (false, 0) if self.wanted == 1 && self.left.is_some_and(|left| left > 0) => {
                    out.go([ACK, b'C'])
                }
                (false, _) => out.go([ACK]),
            }
            return;
        }
        if number != self.wanted {
            out.alarm = Some(("sequence", format!("packet {number} for {}", self.wanted)));
            return;
        }
        match &mut self.left {
            Some(left) => {
                data.truncate(usize::try_from(*left).unwrap_or(usize::MAX));
                *left -= data.len() as u64;
            }
            None => {
                while data.last() == Some(&SUB) {
                    data.pop();
                }
            }
        }
        self.waiting.extend(data);
        self.wanted = self.wanted.wrapping_add(1);
        self.owes = true;
        self.errors = 0;
        self.ending = false;
    }

    fn file_ends(&mut self, now: Duration, out: &mut Out) {
        if let Some(left @ 1..) = self.left {
            out.alarm = Some(("size", format!("{left} bytes of the file never came")));
            return;
        }
        out.ends = true;
        out.go([ACK]);
        self.had_file = true;
        self.errors = 0;
        self.ask(now, out);
    }

    fn again(&mut self, now: Duration, out: &mut Out) {
        self.errors += 1;
        if self.errors > RETRIES {
            out.alarm =
                Some(("retries", format!("packet {} came {RETRIES} times and never whole", self.wanted)));
            return;
        }
        out.halt([NAK]);
        self.state = State::Data { until: now + PATIENCE };
    }
}

impl Machine for Ymodem {
    fn start(&mut self, now: Duration, out: &mut Out) {
        self.close();
        self.ask(now, out);
    }

    fn take(&mut self, byte: u8, now: Duration, out: &mut Out) {
        let heard = self.packets.take(byte, now);
        self.heard(heard, now, out);
    }

    fn pull(&mut self, now: Duration, out: &mut Out) -> bool {
        if let Some(byte) = self.waiting.pop_front() {
            out.text.push(byte);
            return true;
        }
        if std::mem::take(&mut self.owes) {
            out.go([ACK]);
            self.state = State::Data { until: now + PATIENCE };
        }
        false
    }

    fn due(&self) -> Option<Duration> {
        let own = match self.state {
            State::Idle | State::Done => None,
            State::Asking { next } => Some(next),
            State::Data { until } => (!self.owes).then_some(until),
        };
        self.packets.due().or(own)
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if self.packets.due().is_some() {
            let heard = self.packets.silent(now);
            return self.heard(heard, now, out);
        }
        match self.state {
            State::Asking { next } if now >= next => self.ask(now, out),
            State::Data { until } if now >= until && !self.owes => self.again(now, out),
            State::Asking { .. } | State::Data { .. } | State::Idle | State::Done => {}
        }
    }

    fn close(&mut self) {
        *self = Ymodem::default();
    }

    fn stop(&mut self, _stop: Stop, out: &mut Out) {
        out.tell([CAN, CAN]);
        self.close();
    }

    fn in_transfer(&self) -> bool {
        self.owes
            || matches!(self.state, State::Data { .. })
            || (self.had_file && matches!(self.state, State::Asking { .. }))
    }
}

const ASK: Duration = Duration::from_secs(3);

/// Between packets, before one is asked for again.
const PATIENCE: Duration = Duration::from_secs(10);
