//! Answer: each block is answered, or asked for.
//!
//! ```text
//!   LISTENING ──end of block──▶ FULL ──the buffer has taken it──▶ ACK ─▶ LISTENING
//!             └─end of a block with a parity error─▶ NAK
//!   with a request character: it is said at the start and in place of ACK
//! ```
//!
//! A block is what an end of block ends, with something in it: the line of a `%` is one, an empty line is none. While the
//! control is full it does not listen: what comes unasked is lost, and counted. A block that comes twice because its ACK
//! was lost is cut twice, for nothing tells it from a new one; that is the protocol's weakness and not mended here.
//!
//! Source: domain/4, "Per-block answer". That an alarm is told by CAN and a reset by SYN is a reading (SYN from Fanuc's
//! protocol B), unverified. That `%` alone is handed on before its line ends lets a trailer without an end end a program.

use std::collections::VecDeque;
use std::time::Duration;

use super::{ACK, CAN, Machine, NAK, Out, Stop};

/// What is said after a block: values of the machine.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct AnswerBytes {
    /// After a good block. Default 06.
    pub ack: u8,
    /// After a broken one. Default 15.
    pub nak: u8,
    /// Before each block, in place of `ack`. Default: none.
    pub request: Option<u8>,
}

impl Default for AnswerBytes {
    fn default() -> AnswerBytes {
        AnswerBytes { ack: ACK, nak: NAK, request: None }
    }
}

pub(super) struct Answer {
    bytes: AnswerBytes,
    end_of_block: u8,
    block: Vec<u8>,
    /// Something has come since the last end of block.
    begun: bool,
    broken: bool,
    waiting: VecDeque<u8>,
    owes: bool,
}

impl Answer {
    pub(super) fn new(bytes: AnswerBytes, end_of_block: u8) -> Answer {
        let (block, waiting) = (Vec::new(), VecDeque::new());
        Answer { bytes, end_of_block, block, begun: false, broken: false, waiting, owes: false }
    }
}

impl Machine for Answer {
    fn start(&mut self, _now: Duration, out: &mut Out) {
        self.close();
        if let Some(request) = self.bytes.request {
            out.go([request]);
        }
    }

    fn take(&mut self, byte: u8, _now: Duration, out: &mut Out) {
        if self.owes {
            out.unread += 1;
            return;
        }
        if byte == self.end_of_block {
            let broken = std::mem::take(&mut self.broken);
            let begun = std::mem::take(&mut self.begun);
            if broken {
                self.block.clear();
                out.halt([self.bytes.nak]);
                return;
            }
            self.block.push(byte);
            self.waiting.extend(self.block.drain(..));
            self.owes = begun;
            return;
        }
        // NUL is a leader's, or stands for a character with a parity error.
        self.broken |= byte == 0 && self.begun;
        self.begun |= !matches!(byte, 0 | b'\r' | b' ');
        self.block.push(byte);
        let is_percent = self.block.iter().filter(|&&byte| byte != 0).eq([&b'%']);
        if is_percent || self.block.len() > BLOCK_MAX {
            self.waiting.extend(self.block.drain(..));
        }
    }

    fn pull(&mut self, _now: Duration, out: &mut Out) -> bool {
        if let Some(byte) = self.waiting.pop_front() {
            out.text.push(byte);
            return true;
        }
        if std::mem::take(&mut self.owes) {
            out.go([self.bytes.request.unwrap_or(self.bytes.ack)]);
        }
        false
    }

    fn close(&mut self) {
        *self = Answer::new(self.bytes, self.end_of_block);
    }

    fn stop(&mut self, stop: Stop, out: &mut Out) {
        self.close();
        out.tell([match stop {
            Stop::Alarm(_) => CAN,
            Stop::Reset => SYN,
        }]);
    }

    fn in_transfer(&self) -> bool {
        self.owes || !self.waiting.is_empty()
    }
}

const SYN: u8 = 0x16;

/// A longer block is handed on in pieces, and then cannot be asked for again. A guess; it bounds the memory.
const BLOCK_MAX: usize = 65_536;
