//! XMODEM, the receiving side: with a sum, with a CRC, and with packets of 1024.
//!
//! ```text
//!   ASKING ──NAK or C, every 10 or 3 s, without an end──▶ packet 1 ─▶ RECEIVING
//!   RECEIVING  right number, once the buffer has taken it ─▶ ACK      the one before ─▶ ACK, not taken again
//!              broken, or 10 s of silence ─▶ NAK, ten times running ─▶ CAN CAN, alarm `retries`
//!              another number ─▶ CAN CAN, alarm `sequence`            EOT ─▶ ACK ─▶ DONE    CAN CAN ─▶ DONE
//!   DONE       EOT ─▶ ACK, for the first ACK may have been lost
//! ```
//!
//! A control holds by not answering a packet. Padding (1A) at the end of a packet is no program; that the program itself
//! ends in none is taken for granted. With a sum packets of 1024 are noise, as with a CRC unless they are asked for.
//!
//! Sources: domain/4; that the receiver asks every 10 s (NAK) or 3 s (C) is the protocol's usage ([recall]).

use std::collections::VecDeque;
use std::time::Duration;

use super::packet::{Check, Heard, Packets};
use super::{ACK, CAN, Machine, NAK, Out, RETRIES, SUB, Stop};

pub(super) struct Xmodem {
    check: Check,
    packets: Packets,
    state: State,
    /// The number of the next packet.
    wanted: u8,
    /// What the buffer has not taken of the last packet.
    waiting: VecDeque<u8>,
    owes: bool,
    errors: u32,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Idle,
    Asking { next: Duration },
    Receiving { until: Duration },
    Done,
}

impl Xmodem {
    pub(super) fn new(check: Check, long: bool) -> Xmodem {
        Xmodem {
            check,
            packets: Packets::new(check, long),
            state: State::Idle,
            wanted: 1,
            waiting: VecDeque::new(),
            owes: false,
            errors: 0,
        }
    }

    fn ask(&mut self, now: Duration, out: &mut Out) {
        let (with, every) = if self.check == Check::Sum { (NAK, 10) } else { (b'C', 3) };
        out.go([with]);
        self.state = State::Asking { next: now + Duration::from_secs(every) };
    }

    fn heard(&mut self, heard: Heard, now: Duration, out: &mut Out) {
        match (heard, self.state) {
            (Heard::Nothing, _) | (_, State::Idle) => {}
            (Heard::End, State::Done) => out.go([ACK]),
            (_, State::Done) => {}
            (Heard::Packet { number, data }, State::Asking { .. } | State::Receiving { .. }) => {
                self.packet(number, data, now, out);
            }
            (Heard::End, State::Asking { .. } | State::Receiving { .. }) => {
                out.ends = true;
                out.go([ACK]);
                self.state = State::Done;
            }
            (Heard::Cancelled, State::Asking { .. } | State::Receiving { .. }) => {
                out.breaks = true;
                self.waiting.clear();
                self.owes = false;
                self.state = State::Done;
            }
            (Heard::Broken, State::Asking { .. }) => self.ask(now, out),
            (Heard::Broken, State::Receiving { .. }) => self.again(now, out),
        }
    }

    fn packet(&mut self, number: u8, mut data: Vec<u8>, now: Duration, out: &mut Out) {
        if number == self.wanted.wrapping_sub(1) {
            // It comes again because its ACK was lost or is owed still.
            if !self.owes && matches!(self.state, State::Receiving { .. }) {
                out.go([ACK]);
                self.state = State::Receiving { until: now + PATIENCE };
            }
            return;
        }
        if number != self.wanted {
            out.alarm = Some(("sequence", format!("packet {number} for {}", self.wanted)));
            return;
        }
        while data.last() == Some(&SUB) {
            data.pop();
        }
        self.waiting.extend(data);
        self.wanted = self.wanted.wrapping_add(1);
        self.owes = true;
        self.errors = 0;
        self.state = State::Receiving { until: now + PATIENCE };
    }

    fn again(&mut self, now: Duration, out: &mut Out) {
        self.errors += 1;
        if self.errors > RETRIES {
            out.alarm =
                Some(("retries", format!("packet {} came {RETRIES} times and never whole", self.wanted)));
            return;
        }
        out.halt([NAK]);
        self.state = State::Receiving { until: now + PATIENCE };
    }
}

impl Machine for Xmodem {
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
            self.state = State::Receiving { until: now + PATIENCE };
        }
        false
    }

    fn due(&self) -> Option<Duration> {
        let own = match self.state {
            State::Idle | State::Done => None,
            State::Asking { next } => Some(next),
            // The control's own turn has no end.
            State::Receiving { until } => (!self.owes).then_some(until),
        };
        // Inside a packet it is the packet that is late.
        self.packets.due().or(own)
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if self.packets.due().is_some() {
            let heard = self.packets.silent(now);
            return self.heard(heard, now, out);
        }
        match self.state {
            State::Asking { next } if now >= next => self.ask(now, out),
            State::Receiving { until } if now >= until && !self.owes => self.again(now, out),
            State::Asking { .. } | State::Receiving { .. } | State::Idle | State::Done => {}
        }
    }

    fn close(&mut self) {
        self.packets.clear();
        self.state = State::Idle;
        self.wanted = 1;
        self.waiting.clear();
        self.owes = false;
        self.errors = 0;
    }

    fn stop(&mut self, _stop: Stop, out: &mut Out) {
        out.tell([CAN, CAN]);
        self.close();
    }

    fn in_transfer(&self) -> bool {
        matches!(self.state, State::Receiving { .. }) || self.owes
    }
}

/// Between packets, before one is asked for again.
const PATIENCE: Duration = Duration::from_secs(10);
