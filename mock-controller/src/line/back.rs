//! Control to sender: what the control says, one character at a time, then late by the latency.

use std::collections::VecDeque;
use std::time::Duration;

use super::pace::Pace;

pub(crate) struct Back {
    pace: Pace,
    latency: Duration,
    waiting: VecDeque<Outgoing>,
    sending: Option<(Outgoing, Duration)>,
    arriving: VecDeque<(Duration, u8)>,
    connected: bool,
}

/// A character the control has decided to send.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outgoing {
    pub(crate) byte: u8,
    pub(crate) meaning: Meaning,
    /// Lost on the line: it leaves the control and never arrives.
    pub(crate) lost: bool,
    /// The control does not begin to send it before.
    pub(crate) not_before: Duration,
}

/// What the control means by a character; of interest at the instant its stop bit has left.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Meaning {
    /// DC1.
    Go,
    /// DC3 that asks for silence.
    Hold,
    /// DC3 after the program's end.
    EndOfTransfer,
    /// NAK, SYN, echoes.
    Other,
}

impl Back {
    pub(crate) fn new(pace: Pace, latency: Duration) -> Self {
        let (waiting, arriving) = (VecDeque::new(), VecDeque::new());
        Back { pace, latency, waiting, sending: None, arriving, connected: false }
    }

    pub(crate) fn put(&mut self, outgoing: Outgoing, now: Duration) {
        self.waiting.push_back(outgoing);
        self.begin(now);
    }

    fn begin(&mut self, now: Duration) {
        if self.sending.is_none()
            && let Some(next) = self.waiting.pop_front()
        {
            self.sending = Some((next, now.max(next.not_before) + self.pace.character()));
        }
    }

    /// When the stop bit of the character being sent leaves the control.
    pub(crate) fn completion(&self) -> Option<Duration> {
        self.sending.map(|(_, at)| at)
    }

    /// The character being sent has left: what it meant, and when it reaches the sender's program.
    pub(crate) fn complete(&mut self) -> Option<(Meaning, Duration)> {
        let (sent, at) = self.sending.take()?;
        let arrival = at + self.latency;
        if self.connected && !sent.lost {
            self.arriving.push_back((arrival, sent.byte));
        }
        self.begin(at);
        Some((sent.meaning, arrival))
    }

    pub(crate) fn arrival(&self) -> Option<Duration> {
        self.arriving.front().map(|&(at, _)| at)
    }

    pub(crate) fn arrived(&mut self, now: Duration) -> Vec<u8> {
        let mut bytes = Vec::new();
        while let Some(&(at, byte)) = self.arriving.front()
            && at <= now
        {
            bytes.push(byte);
            self.arriving.pop_front();
        }
        bytes
    }

    pub(crate) fn connect(&mut self) {
        self.connected = true;
    }

    /// Nobody listens: what was on its way to the sender's program is lost.
    pub(crate) fn disconnect(&mut self) {
        self.connected = false;
        self.arriving.clear();
    }

    pub(crate) fn is_idle(&self) -> bool {
        self.sending.is_none() && self.waiting.is_empty()
    }
}
