//! Tape: an adapter that stands in for a tape reader, without memory of its own.
//!
//! ```text
//!   answer       ASKING ──"next" (a byte, or CTS going on)──▶ one character ──reader's pace──▶ ASKING
//!                held: it does not ask           a character nobody asked for is lost: alarm `unasked`
//!   synchronous  RUN LINE ON (CTS) ──characters at the reader's pace──▶ one after the other
//!                held: run line off              a character sooner than the pace: alarm `reader-speed`
//! ```
//!
//! Exact images over RTS/CTS, DTR/DSR or DC codes are those protocols with a tape's code; this one is the rest. The
//! control does not read backwards, and the adapter never asks for the tape's beginning again.
//!
//! Source: domain/4, "Tape port", all of it [recall]. A control's alarm is not told by a reader: it stops asking, and its
//! run line is off. A pace too fast by a tenth is borne (a guess), for motors are no quartz.

use std::time::Duration;

use super::{DC1, Lines, Machine, Out, Stop};

/// How the adapter gets its characters.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum TapePacing {
    /// It asks for each (应答).
    Answer {
        /// With what.
        next: Next,
        /// Characters a second the reader turns at most; `None`: as fast as they come.
        per_second: Option<u32>,
    },
    /// They are offered at the reader's pace while the run line is on (同步).
    Synchronous {
        /// Characters a second.
        per_second: u32,
    },
}

/// How "next" is said.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Next {
    /// By this byte.
    Byte(u8),
    /// CTS goes on; with the character it goes off.
    Cts,
}

impl Default for TapePacing {
    fn default() -> TapePacing {
        TapePacing::Answer { next: Next::Byte(DC1), per_second: None }
    }
}

pub(super) struct Tape {
    pacing: TapePacing,
    on: bool,
    held: bool,
    /// A character has been asked for and has not come.
    asked: bool,
    /// When the reader is ready for the next one.
    ready: Option<Duration>,
    last: Option<Duration>,
}

impl Tape {
    pub(super) fn new(pacing: TapePacing) -> Tape {
        Tape { pacing, on: false, held: false, asked: false, ready: None, last: None }
    }

    fn ask(&mut self, out: &mut Out) {
        self.ready = None;
        if let TapePacing::Answer { next, .. } = self.pacing
            && self.on
            && !self.held
            && !self.asked
        {
            self.asked = true;
            if let Next::Byte(byte) = next {
                out.go([byte]);
            }
        }
    }

    fn answered(&mut self, byte: u8, per_second: Option<u32>, now: Duration, out: &mut Out) {
        if !std::mem::take(&mut self.asked) {
            out.unread += 1;
            out.alarm =
                Some(("unasked", format!("the character {byte:02X} came without having been asked for")));
            return;
        }
        out.text.push(byte);
        self.ready = Some(now + per_second.map_or(Duration::ZERO, turn));
    }

    fn synchronous(&mut self, byte: u8, per_second: u32, now: Duration, out: &mut Out) {
        let turn = turn(per_second);
        if let Some(last) = self.last.replace(now)
            && now < last + turn - turn / 10
        {
            let found = format!("{:.1} ms after the last, at {per_second} a second", millis(now - last));
            out.alarm = Some(("reader-speed", found));
            return;
        }
        out.text.push(byte);
    }
}

fn turn(per_second: u32) -> Duration {
    Duration::from_secs(1) / per_second.max(1)
}

fn millis(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

impl Machine for Tape {
    fn start(&mut self, _now: Duration, out: &mut Out) {
        *self = Tape { on: true, held: self.held, ..Tape::new(self.pacing) };
        self.ask(out);
    }

    fn take(&mut self, byte: u8, now: Duration, out: &mut Out) {
        match self.pacing {
            TapePacing::Answer { per_second, .. } => self.answered(byte, per_second, now, out),
            TapePacing::Synchronous { per_second } => self.synchronous(byte, per_second, now, out),
        }
    }

    fn hold(&mut self, held: bool, _now: Duration, out: &mut Out) {
        self.held = held;
        if !held && self.ready.is_none() {
            self.ask(out);
        }
    }

    fn due(&self) -> Option<Duration> {
        self.ready
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if self.ready.is_some_and(|ready| now >= ready) {
            self.ask(out);
        }
    }

    fn close(&mut self) {
        *self = Tape { held: self.held, ..Tape::new(self.pacing) };
    }

    fn stop(&mut self, _stop: Stop, _out: &mut Out) {
        self.close();
    }

    fn lines(&self) -> Lines {
        let cts = match self.pacing {
            TapePacing::Answer { next: Next::Byte(_), .. } => true,
            TapePacing::Answer { next: Next::Cts, .. } => self.asked,
            TapePacing::Synchronous { .. } => self.on && !self.held,
        };
        Lines { cts, dsr: true }
    }

    fn streams(&self) -> bool {
        true
    }
}
