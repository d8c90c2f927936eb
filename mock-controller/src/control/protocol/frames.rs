//! Frames: numbered, with a length and a CRC; stop-and-wait or go-back-N as the window says.
//!
//! ```text
//!   ASKING ──R every 5 s──▶ first good frame ─▶ OPEN
//!   OPEN   D, E as wanted ─▶ taken ─▶ A          already had ─▶ A        broken, or ahead ─▶ N, once
//!          no room ─▶ A with window 0            5 s in which nothing was said ─▶ A again
//!          E, all taken ─▶ A ─▶ DONE             alarm, reset ─▶ X
//! ```
//!
//! Source: `docs/protocols.md`, "Frames: wire format", which is all that both sides share.

use std::collections::VecDeque;
use std::time::Duration;

use super::crc16::crc16;
use super::{Machine, Out, Stop};

pub(super) struct Frames {
    window: u8,
    body: Vec<u8>,
    escaped: bool,
    /// Between two flags.
    inside: bool,
    state: State,
    wanted: u16,
    /// Frames the buffer has not taken, the first one perhaps in part.
    waiting: VecDeque<Vec<u8>>,
    owes: bool,
    held: bool,
    /// No second N before.
    asked: Option<Duration>,
    /// When something was last said.
    said: Duration,
    ended: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Idle,
    Asking,
    Open,
    Done,
}

impl Frames {
    pub(super) fn new(window: u8) -> Frames {
        Frames {
            window,
            body: Vec::new(),
            escaped: false,
            inside: false,
            state: State::Idle,
            wanted: 1,
            waiting: VecDeque::new(),
            owes: false,
            held: false,
            asked: None,
            said: Duration::ZERO,
            ended: false,
        }
    }

    fn body_complete(&mut self, now: Duration, out: &mut Out) {
        let body = std::mem::take(&mut self.body);
        let broken = std::mem::take(&mut self.escaped);
        if body.is_empty() && !broken {
            return;
        }
        match parse(&body).filter(|_| !broken) {
            None => self.again(now, out),
            Some((b'D' | b'E', number, payload)) => self.numbered(body[0], number, payload, now, out),
            Some((b'X', ..)) => {
                out.breaks = true;
                self.waiting.clear();
                self.owes = false;
                self.state = State::Done;
            }
            // Kinds of another age.
            Some(_) => {}
        }
    }

    fn numbered(&mut self, kind: u8, number: u16, payload: &[u8], now: Duration, out: &mut Out) {
        let ahead = number.wrapping_sub(self.wanted);
        if ahead >= 0x8000 {
            // Had already: its A was lost, or is owed still.
            if !self.owes {
                self.accept(now, out);
            }
            return;
        }
        if ahead > 0 || self.ended {
            return self.again(now, out);
        }
        if self.waiting.len() >= usize::from(self.window) {
            // Beyond the window: there is no place for it.
            return self.again(now, out);
        }
        self.state = State::Open;
        self.asked = None;
        self.wanted = self.wanted.wrapping_add(1);
        self.ended = kind == b'E';
        self.waiting.push_back(payload.to_vec());
        self.owes = true;
        if self.held {
            self.accept(now, out);
        }
    }

    fn accept(&mut self, now: Duration, out: &mut Out) {
        self.owes = false;
        self.said = now;
        let taken = u8::try_from(self.waiting.len()).unwrap_or(u8::MAX);
        let window = self.window.saturating_sub(taken);
        out.go(frame(b'A', self.wanted.wrapping_sub(1), &[window]));
    }

    fn again(&mut self, now: Duration, out: &mut Out) {
        if self.state == State::Done || self.asked.is_some_and(|until| now < until) {
            return;
        }
        self.asked = Some(now + ASK_AGAIN);
        self.said = now;
        out.halt(frame(b'N', self.wanted, &[]));
    }

    fn ready(&mut self, now: Duration, out: &mut Out) {
        self.said = now;
        out.go(frame(b'R', self.wanted, &[self.window]));
    }
}

/// Kind, number and payload of a body that is right.
fn parse(body: &[u8]) -> Option<(u8, u16, &[u8])> {
    let [kind, n1, n2, l1, l2, rest @ ..] = body else {
        return None;
    };
    let length = usize::from(u16::from_be_bytes([*l1, *l2]));
    let payload = rest.get(..length)?;
    let told = rest.get(length..).filter(|told| told.len() == 2)?;
    let is_right = length <= PAYLOAD_MAX && crc16(&body[..5 + length]).to_be_bytes() == *told;
    is_right.then(|| (*kind, u16::from_be_bytes([*n1, *n2]), payload))
}

fn frame(kind: u8, number: u16, payload: &[u8]) -> Vec<u8> {
    let [n1, n2] = number.to_be_bytes();
    let [l1, l2] = u16::try_from(payload.len()).unwrap_or(u16::MAX).to_be_bytes();
    let mut body = vec![kind, n1, n2, l1, l2];
    body.extend_from_slice(payload);
    body.extend(crc16(&body).to_be_bytes());
    let mut frame = vec![FLAG];
    for byte in body {
        if matches!(byte, 0x11 | 0x13 | ESCAPE | FLAG | 0x91 | 0x93) {
            frame.extend([ESCAPE, byte ^ 0x20]);
        } else {
            frame.push(byte);
        }
    }
    frame.push(FLAG);
    frame
}

impl Machine for Frames {
    fn start(&mut self, now: Duration, out: &mut Out) {
        self.close();
        self.state = State::Asking;
        self.ready(now, out);
    }

    fn take(&mut self, byte: u8, now: Duration, out: &mut Out) {
        match byte {
            FLAG => {
                if self.inside {
                    self.body_complete(now, out);
                }
                self.inside = true;
                self.body.clear();
                self.escaped = false;
            }
            // Before the first flag, and after a frame without an end, there is no body.
            _ if !self.inside => {}
            _ if self.body.len() > BODY_MAX => {
                self.inside = false;
                self.body.clear();
                self.again(now, out);
            }
            ESCAPE if !self.escaped => self.escaped = true,
            _ => {
                let escaped = std::mem::take(&mut self.escaped);
                self.body.push(if escaped { byte ^ 0x20 } else { byte });
            }
        }
    }

    fn pull(&mut self, now: Duration, out: &mut Out) -> bool {
        match self.waiting.front_mut() {
            Some(payload) if !payload.is_empty() => {
                out.text.push(payload.remove(0));
                true
            }
            Some(_) => {
                self.waiting.pop_front();
                self.owes = true;
                if self.ended && self.waiting.is_empty() {
                    out.ends = true;
                    self.accept(now, out);
                    self.state = State::Done;
                }
                true
            }
            None => {
                if self.owes {
                    self.accept(now, out);
                }
                false
            }
        }
    }

    fn hold(&mut self, held: bool, now: Duration, out: &mut Out) {
        self.held = held;
        if held && self.owes {
            self.accept(now, out);
        }
    }

    fn due(&self) -> Option<Duration> {
        match self.state {
            State::Asking | State::Open => Some(self.said + SILENCE),
            State::Idle | State::Done => None,
        }
    }

    fn time(&mut self, now: Duration, out: &mut Out) {
        if now < self.said + SILENCE {
            return;
        }
        match self.state {
            State::Asking => self.ready(now, out),
            State::Open => self.accept(now, out),
            State::Idle | State::Done => {}
        }
    }

    fn close(&mut self) {
        *self = Frames::new(self.window);
    }

    fn stop(&mut self, stop: Stop, out: &mut Out) {
        self.close();
        out.tell(frame(
            b'X',
            0,
            match stop {
                Stop::Alarm(name) => name.as_bytes(),
                Stop::Reset => b"reset",
            },
        ));
    }

    fn in_transfer(&self) -> bool {
        self.state == State::Open
    }
}

const FLAG: u8 = 0x7E;
const ESCAPE: u8 = 0x7D;
const PAYLOAD_MAX: usize = 1024;
const BODY_MAX: usize = 5 + PAYLOAD_MAX + 2;

/// After this long in which it has said nothing it says the last again.
const SILENCE: Duration = Duration::from_secs(5);

/// Between two N.
const ASK_AGAIN: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::frame;

    #[test]
    fn the_examples_of_the_wire_format() {
        for (made, bytes) in [
            (frame(b'R', 1, &[1]), "7E 52 00 01 00 01 01 AE 70 7E"),
            (frame(b'A', 1, &[0]), "7E 41 00 01 00 01 00 6A 35 7E"),
            (frame(b'N', 2, &[]), "7E 4E 00 02 00 00 B0 A0 7E"),
            (frame(b'D', 17, b"}~\x13"), "7E 44 00 7D 31 00 03 7D 5D 7D 5E 7D 33 AE 18 7E"),
            (frame(b'X', 0, b"format"), "7E 58 00 00 00 06 66 6F 72 6D 61 74 CC B0 7E"),
        ] {
            let made: Vec<String> = made.iter().map(|byte| format!("{byte:02X}")).collect();
            assert_eq!(made.join(" "), bytes);
        }
    }
}
