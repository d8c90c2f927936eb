//! The packets of XMODEM and YMODEM as they come off the line: `SOH n ~n 128 check` or `STX n ~n 1024 check`.
//!
//! What begins as no packet does, or does not go on as one, is read past until the line has been silent for a second:
//! then the packet is broken. An EOT counts once nothing has followed it for a while, lest the number of a packet whose
//! SOH was lost be taken for one.
//!
//! Source: domain/4; the silences are the usual ones of the protocol ([recall]).

use std::time::Duration;

use super::crc16::crc16;
use super::{CAN, EOT, SOH, STX};

/// How a packet is checked.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Check {
    /// One byte: the sum of the data.
    Sum,
    /// Two: CRC-16/XMODEM, high byte first.
    Crc,
}

/// What one more byte, or silence, made of it.
#[derive(Debug, Eq, PartialEq)]
pub(super) enum Heard {
    Nothing,
    Packet { number: u8, data: Vec<u8> },
    End,
    Cancelled,
    Broken,
}

pub(super) struct Packets {
    check: Check,
    long: bool,
    state: State,
    last: Duration,
}

enum State {
    Between,
    Inside(Vec<u8>),
    /// EOT, or the first CAN.
    Single(u8),
    Noise,
}

impl Packets {
    pub(super) fn new(check: Check, long: bool) -> Packets {
        Packets { check, long, state: State::Between, last: Duration::ZERO }
    }

    pub(super) fn clear(&mut self) {
        self.state = State::Between;
    }

    pub(super) fn take(&mut self, byte: u8, now: Duration) -> Heard {
        self.last = now;
        match &mut self.state {
            State::Between => {
                self.state = match byte {
                    SOH => State::Inside(vec![byte]),
                    STX if self.long => State::Inside(vec![byte]),
                    EOT | CAN => State::Single(byte),
                    _ => State::Noise,
                };
                Heard::Nothing
            }
            State::Single(CAN) if byte == CAN => {
                self.state = State::Between;
                Heard::Cancelled
            }
            // EOT again: the sender did not wait for the silence.
            State::Single(EOT) if byte == EOT => Heard::Nothing,
            State::Single(_) => {
                self.state = State::Noise;
                Heard::Nothing
            }
            State::Inside(bytes) => {
                bytes.push(byte);
                let size = if bytes[0] == STX { 1024 } else { 128 };
                let check = if self.check == Check::Sum { 1 } else { 2 };
                if bytes.len() < 3 + size + check {
                    return Heard::Nothing;
                }
                let (data, told) = bytes[3..].split_at(size);
                let is_right = bytes[1] == !bytes[2]
                    && match self.check {
                        Check::Sum => told[0] == data.iter().fold(0_u8, |sum, &byte| sum.wrapping_add(byte)),
                        Check::Crc => told == crc16(data).to_be_bytes(),
                    };
                if is_right {
                    let heard = Heard::Packet { number: bytes[1], data: data.to_vec() };
                    self.state = State::Between;
                    return heard;
                }
                self.state = State::Noise;
                Heard::Nothing
            }
            State::Noise => Heard::Nothing,
        }
    }

    pub(super) fn due(&self) -> Option<Duration> {
        match self.state {
            State::Between => None,
            State::Single(EOT) => Some(self.last + ALONE),
            State::Single(_) | State::Inside(_) | State::Noise => Some(self.last + SILENCE),
        }
    }

    /// The silence has come.
    pub(super) fn silent(&mut self, now: Duration) -> Heard {
        if self.due().is_none_or(|due| now < due) {
            return Heard::Nothing;
        }
        match std::mem::replace(&mut self.state, State::Between) {
            State::Between => Heard::Nothing,
            State::Single(EOT) => Heard::End,
            State::Single(_) | State::Inside(_) | State::Noise => Heard::Broken,
        }
    }
}

/// A packet is given up, and noise is over, after this long without a byte.
const SILENCE: Duration = Duration::from_secs(1);

/// After an EOT. A guess.
const ALONE: Duration = Duration::from_millis(100);
