//! grbl: each line is answered by `ok`; the sender may count characters against the buffer.
//!
//! ```text
//!   start ─▶ banner        line taken ─▶ ok        ? ─▶ <…>        ! ─▶ hold, ~ ─▶ on        Ctrl-X ─▶ banner, all forgotten
//!   more than 128 characters unread ─▶ they are lost; alarm `buffer-overflow`
//!   alarm ─▶ error:20 for a line that cannot be read, ALARM:1 for the rest        reset ─▶ banner
//! ```
//!
//! A hold of the control is an `ok` that does not come. An empty line is answered as well. The status is short: state and
//! no position, since only what is no answer matters to a sender.
//!
//! Sources: domain/4; banner, real-time characters and the numbers of errors and alarms as grbl 1.1 has them ([recall]).
//! A grbl goes on after `error`; this control, like every other here, does not.

use std::collections::VecDeque;
use std::time::Duration;

use super::{CAN, Machine, Out, Stop};

#[derive(Default)]
pub(super) struct Grbl {
    started: bool,
    buffer: VecDeque<u8>,
    /// `!`
    paused: bool,
}

impl Grbl {
    fn banner(&mut self, out: &mut Out) {
        *self = Grbl { started: true, ..Grbl::default() };
        out.tell(BANNER);
    }
}

impl Machine for Grbl {
    fn start(&mut self, _now: Duration, out: &mut Out) {
        self.banner(out);
    }

    fn take(&mut self, byte: u8, _now: Duration, out: &mut Out) {
        match byte {
            _ if !self.started => out.unread += 1,
            b'?' => {
                let state = if self.paused { "Hold:0" } else { "Run" };
                out.tell(format!("<{state}|Bf:15,{}>\r\n", BUFFER - self.buffer.len()));
            }
            b'!' => self.paused = true,
            b'~' => self.paused = false,
            CAN => {
                out.breaks = true;
                self.banner(out);
            }
            b'\r' => {}
            _ if self.buffer.len() == BUFFER => {
                out.unread += 1;
                out.alarm = Some(("buffer-overflow", format!("more than {BUFFER} characters without an ok")));
            }
            _ => self.buffer.push_back(byte),
        }
    }

    /// A line leaves the buffer only whole, and is answered then.
    fn pull(&mut self, _now: Duration, out: &mut Out) -> bool {
        if self.paused {
            return false;
        }
        let Some(end) = self.buffer.iter().position(|&byte| byte == b'\n') else {
            return false;
        };
        out.text.extend(self.buffer.drain(..=end));
        out.go("ok\r\n");
        true
    }

    fn close(&mut self) {
        *self = Grbl::default();
    }

    fn stop(&mut self, stop: Stop, out: &mut Out) {
        match stop {
            Stop::Alarm("format" | "word" | "number" | "arc") => out.tell("error:20\r\n"),
            Stop::Alarm(_) => out.tell("ALARM:1\r\n"),
            Stop::Reset => out.tell(BANNER),
        }
        self.close();
    }

    fn in_transfer(&self) -> bool {
        !self.buffer.is_empty()
    }
}

/// "Character counting against a 128-byte buffer" (domain/4).
const BUFFER: usize = 128;

const BANNER: &str = "\r\nGrbl 1.1h ['$' for help]\r\n";
