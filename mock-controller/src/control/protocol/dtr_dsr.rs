//! DTR/DSR: the control's DTR is the sender's DSR; off is a hold.
//!
//! ```text
//!   OFF ──control started──▶ ON ──buffer full──▶ OFF ──room──▶ ON        alarm, reset ─▶ OFF, and CTS off
//! ```
//!
//! No driver stops by itself: "DSR must be polled between small writes" (domain/4). What comes after DSR went off is
//! counted as what comes after DC3 is. That an alarm takes CTS away too is a reading, unverified.

use std::time::Duration;

use super::{Lines, Machine, Out, Stop};

#[derive(Default)]
pub(super) struct DtrDsr {
    ready: bool,
    stopped: bool,
}

impl Machine for DtrDsr {
    fn start(&mut self, _now: Duration, _out: &mut Out) {
        *self = DtrDsr { ready: true, stopped: false };
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
        *self = DtrDsr { ready: false, stopped: true };
    }

    fn lines(&self) -> Lines {
        Lines { cts: !self.stopped, dsr: self.ready }
    }

    fn streams(&self) -> bool {
        true
    }
}
