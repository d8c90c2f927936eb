//! Marlin: lines with a number and a sum, each answered by `ok`, or asked for again.
//!
//! ```text
//!   start ─▶ start        N<last+1> line*xor ─▶ ok, once the buffer has taken it
//!   wrong number, wrong sum, no sum ─▶ Error:…, Resend: <last+1>, ok         M110 N<n> ─▶ last is n, ok
//!   full ─▶ echo:busy: processing, every 2 s                              alarm ─▶ Error:Printer halted. kill() called!
//! ```
//!
//! The sum is the XOR of everything in front of `*`. A line without a number is taken without a check, as Marlin does.
//! What has come behind a wrong line is thrown away with it. Comments behind `;` are no part of a line.
//!
//! Sources: domain/4; the words as Marlin 2 has them ([recall]).

use std::collections::VecDeque;
use std::time::Duration;

use super::{Machine, Out, Stop};

#[derive(Default)]
pub(super) struct Marlin {
    started: bool,
    line: Vec<u8>,
    last: u64,
    waiting: VecDeque<u8>,
    owes: bool,
    held: bool,
    /// Lines that came while one is being taken.
    behind: VecDeque<u8>,
    busy_at: Option<Duration>,
}

impl Marlin {
    fn character(&mut self, byte: u8, out: &mut Out) {
        if byte != b'\n' {
            if self.line.len() < LINE_MAX {
                self.line.push(byte);
            }
            return;
        }
        let line = std::mem::take(&mut self.line);
        let text: Vec<u8> = line.split(|&byte| byte == b';').next().unwrap_or_default().trim_ascii().to_vec();
        if !text.is_empty() {
            match self.checked(&text) {
                Ok(None) => out.go("ok\n"),
                Ok(Some(words)) => {
                    self.waiting.extend(words);
                    self.waiting.push_back(b'\n');
                    self.owes = true;
                }
                Err(wrong) => {
                    self.behind.clear();
                    out.halt(format!(
                        "Error:{wrong}, Last Line: {}\nResend: {}\nok\n",
                        self.last,
                        self.last + 1
                    ));
                }
            }
        }
    }

    /// The words of a line; `None`: it was for the protocol alone.
    fn checked(&mut self, text: &[u8]) -> Result<Option<Vec<u8>>, &'static str> {
        let star = text.iter().rposition(|&byte| byte == b'*');
        let Some(numbered) = text.strip_prefix(b"N") else {
            return if star.is_some() {
                Err("No Line Number with checksum")
            } else {
                Ok(Some(text.to_vec()))
            };
        };
        let digits = numbered.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let number = decimal(&numbered[..digits]);
        let star = star.ok_or("No Checksum with line number")?;
        let sum = text[..star].iter().fold(0, |sum, byte| sum ^ byte);
        if decimal(text[star + 1..].trim_ascii()) != Some(u64::from(sum)) {
            return Err("checksum mismatch");
        }
        let words = text[1 + digits..star].trim_ascii();
        if let Some(rest) = words.strip_prefix(b"M110") {
            let told = rest.trim_ascii().strip_prefix(b"N").and_then(decimal);
            self.last = told.or(number).unwrap_or(self.last);
            return Ok(None);
        }
        if number != Some(self.last + 1) {
            return Err("Line Number is not Last Line Number+1");
        }
        self.last += 1;
        Ok(Some(words.to_vec()))
    }
}

fn decimal(digits: &[u8]) -> Option<u64> {
    std::str::from_utf8(digits).ok()?.parse().ok()
}

impl Machine for Marlin {
    fn start(&mut self, _now: Duration, out: &mut Out) {
        *self = Marlin { started: true, ..Marlin::default() };
        out.tell("start\n");
    }

    fn take(&mut self, byte: u8, _now: Duration, out: &mut Out) {
        match byte {
            _ if !self.started => out.unread += 1,
            b'\r' => {}
            _ if self.behind.len() >= BUFFER => out.unread += 1,
            _ => self.behind.push_back(byte),
        }
    }

    fn pull(&mut self, _now: Duration, out: &mut Out) -> bool {
        if let Some(byte) = self.waiting.pop_front() {
            out.text.push(byte);
            return true;
        }
        if std::mem::take(&mut self.owes) {
            out.go("ok\n");
            return true;
        }
        match self.behind.pop_front() {
            Some(byte) => {
                self.character(byte, out);
                true
            }
            None => false,
        }
    }

    fn hold(&mut self, held: bool, now: Duration, _out: &mut Out) {
        self.held = held;
        self.busy_at = held.then_some(now + BUSY);
    }

    fn due(&self) -> Option<Duration> {
        self.busy_at
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if self.busy_at.is_some_and(|at| now >= at) {
            out.tell("echo:busy: processing\n");
            self.busy_at = Some(now + BUSY);
        }
    }

    fn close(&mut self) {
        *self = Marlin { held: self.held, ..Marlin::default() };
    }

    fn stop(&mut self, stop: Stop, out: &mut Out) {
        self.close();
        self.busy_at = None;
        out.tell(match stop {
            Stop::Alarm(_) => "Error:Printer halted. kill() called!\n",
            Stop::Reset => "start\n",
        });
    }

    fn in_transfer(&self) -> bool {
        self.owes || !self.behind.is_empty()
    }
}

/// Between two signs of life of a control that is full.
const BUSY: Duration = Duration::from_secs(2);

/// Characters that may wait; more are lost. Marlin's receive buffer is of this order ([recall]).
const BUFFER: usize = 128;

/// A guess; a longer line loses its rest, and its sum does not fit.
const LINE_MAX: usize = 4096;
