//! RTS/CTS: the control's RTS is the sender's CTS; off is a hold.
//!
//! ```text
//!   OFF ──control started──▶ ON ──buffer full──▶ OFF ──room──▶ ON        alarm, reset ─▶ OFF, and DSR off
//! ```
//!
//! The sender's driver or chip stops by itself, after the character that is on the line (domain/4). Nothing is said:
//! that a control is dead and not holding is told by DSR alone. That an alarm takes DSR away is a reading, unverified.

use std::time::Duration;

use super::{Lines, Machine, Out, Stop};

#[derive(Default)]
pub(super) struct RtsCts {
    ready: bool,
    stopped: bool,
}

impl Machine for RtsCts {
    fn start(&mut self, _now: Duration, _out: &mut Out) {
        *self = RtsCts { ready: true, stopped: false };
    }

    fn take(&mut self, byte: u8, _now: Duration, out: &mut Out) {
        out.text.push(byte);
    }

    fn hold(&mut self, held: bool, _now: Duration, _out: &mut Out) {
        self.ready = !held && !self.stopped;
    }

    fn close(&mut self) {
        self.ready = false;
    }

    fn stop(&mut self, _stop: Stop, _out: &mut Out) {
        *self = RtsCts { ready: false, stopped: true };
    }

    fn lines(&self) -> Lines {
        Lines { cts: self.ready, dsr: !self.stopped }
    }

    fn streams(&self) -> bool {
        true
    }
}
