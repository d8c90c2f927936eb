//! The control and its protocol's machine: what the machine is told, and what becomes of what it wants.

use std::time::Duration;

use super::Controller;
use super::protocol::{Lines, Machine, Means, Out, Stop};
use super::settings::Handshake;
use crate::line::back::{Meaning, Outgoing};
use crate::line::fault::FaultKind;
use crate::observer::Observer;

impl<O: Observer> Controller<O> {
    /// The control's lines, as the sender sees them.
    #[must_use]
    pub fn lines(&self) -> Lines {
        if self.flow.dropped {
            return Lines { cts: false, dsr: false };
        }
        self.talk.as_ref().map_or(Lines::ON, |machine| machine.lines())
    }

    /// The sender's DTR goes on or off. Off while a program is being read is the alarm `dsr` (Fanuc's 086, domain/4).
    pub fn sender_ready(&mut self, on: bool, now: Duration) {
        self.advance(now);
        let was_on = std::mem::replace(&mut self.flow.sender_ready, on);
        if was_on && !on && self.flow.reading && self.tally.characters > 0 && !self.reader.is_after_end() {
            self.raise("dsr", Some(format!("block {}: the sender's DTR went off", self.tally.blocks + 1)));
        }
    }

    /// Fault: the line that says "ready" breaks, both ways.
    pub(super) fn drop_ready(&mut self) {
        self.flow.dropped = true;
        self.raise("dsr", Some(format!("block {}: DSR dropped", self.tally.blocks + 1)));
    }

    /// Lets the driver go on or stops it, where it obeys a line by itself.
    pub(super) fn gate(&mut self) {
        let Lines { cts, dsr } = self.lines();
        let open = match self.settings.handshake {
            Handshake::Ignored => true,
            Handshake::Cts => cts,
            Handshake::Both => cts && dsr,
        };
        self.forward.gate(open, self.now);
    }

    /// Whether there is a machine at all.
    pub(super) fn has_machine(&self) -> bool {
        self.talk.is_some()
    }

    pub(super) fn streams(&self) -> bool {
        self.talk.as_ref().is_none_or(|machine| machine.streams())
    }

    pub(super) fn in_transfer(&self) -> bool {
        self.talk.as_ref().is_some_and(|machine| machine.in_transfer())
    }

    /// When the machine wants to be called.
    pub(super) fn machine_due(&self) -> Option<Duration> {
        let due = self.talk.as_ref().filter(|_| self.is_running() && !self.flow.deaf)?.due();
        due.map(|at| at.max(self.now))
    }

    pub(super) fn machine_time(&mut self) {
        self.tell(|machine, now, out| machine.time(now, out));
        self.pull_text();
    }

    pub(super) fn machine_start(&mut self) {
        self.tell(|machine, now, out| machine.start(now, out));
    }

    /// A character for the machine.
    pub(super) fn machine_takes(&mut self, byte: u8) {
        self.tell(|machine, now, out| machine.take(byte, now, out));
        self.pull_text();
    }

    /// The link has closed.
    pub(super) fn machine_close(&mut self) {
        if let Some(machine) = &mut self.talk {
            machine.close();
        }
        self.flow.line_on_at = None;
    }

    /// The buffer has filled.
    pub(super) fn machine_holds(&mut self) {
        self.utilisation.hold_begins(self.now);
        if self.streams() {
            self.begin_overrun();
            // The sender does not see the line going off.
            if self.faults.strikes(FaultKind::XoffLost) {
                return;
            }
        }
        self.tell(|machine, now, out| machine.hold(true, now, out));
    }

    /// The buffer has room again.
    pub(super) fn machine_goes_on(&mut self) {
        if self.streams() {
            if self.faults.strikes(FaultKind::XonLost) {
                return;
            }
            if self.faults.strikes(FaultKind::XonLate) {
                let late = self.faults.pick_milliseconds(FaultKind::XonLate, 500, 5000);
                self.flow.line_on_at = Some(self.now + late);
                return;
            }
        }
        self.line_on();
    }

    pub(super) fn line_on(&mut self) {
        self.flow.line_on_at = None;
        self.flow.overrun = None;
        self.utilisation.hold_ends(self.now + self.settings.latency);
        self.tell(|machine, now, out| machine.hold(false, now, out));
        self.pull_text();
    }

    /// The control stops; true: the machine has said so.
    pub(super) fn machine_stops(&mut self, stop: Stop) -> bool {
        let Some(machine) = &mut self.talk else {
            return false;
        };
        let mut out = Out::default();
        machine.stop(stop, &mut out);
        let times = if stop == Stop::Alarm("nak-storm") { 20 } else { 1 };
        for _ in 0..times {
            for (bytes, _) in &out.say {
                self.say_bytes(bytes, Meaning::Other, false, Duration::ZERO);
            }
        }
        true
    }

    /// As long as the buffer has room, the machine gives what it has.
    fn pull_text(&mut self) {
        // Taking up a block drains the buffer, which comes back here.
        if std::mem::replace(&mut self.flow.pulling, true) {
            return;
        }
        let mut goes_on = true;
        while goes_on && !self.flow.held && self.is_running() && !self.flow.deaf {
            goes_on = self.tell(|machine, now, out| machine.pull(now, out)).unwrap_or(false);
        }
        self.flow.pulling = false;
    }

    fn tell<R>(&mut self, what: impl FnOnce(&mut dyn Machine, Duration, &mut Out) -> R) -> Option<R> {
        let mut out = Out::default();
        let machine = self.talk.as_mut()?;
        let result = what(machine.as_mut(), self.now, &mut out);
        self.carry_out(out);
        Some(result)
    }

    fn carry_out(&mut self, out: Out) {
        self.tally.unread += out.unread;
        for byte in out.text {
            if self.is_running() && !self.flow.deaf {
                self.read(byte);
            }
        }
        if out.ends {
            // As if the program's text ended in a line end and DC4, whatever it ended in.
            self.read_plain(b'\n');
            self.read_plain(DC4);
        }
        if out.breaks {
            self.reader.link_closed(self.settings.torn, &mut self.text);
            self.drained();
        }
        if let Some((name, found)) = out.alarm {
            return self.raise(name, Some(format!("block {}, {found}", self.tally.blocks + 1)));
        }
        if !self.is_running() || self.flow.deaf {
            return;
        }
        for (bytes, means) in out.say {
            self.answer(&bytes, means);
        }
    }

    /// Says something, if the line lets it.
    fn answer(&mut self, bytes: &[u8], means: Means) {
        let (meaning, lost) = match means {
            Means::Go => (Meaning::Go, self.faults.strikes(FaultKind::XonLost)),
            Means::Stop => (Meaning::Other, self.faults.strikes(FaultKind::XoffLost)),
            Means::Other => (Meaning::Other, false),
        };
        let late = match means == Means::Go && self.faults.strikes(FaultKind::XonLate) {
            true => self.faults.pick_milliseconds(FaultKind::XonLate, 500, 5000),
            false => Duration::ZERO,
        };
        self.say_bytes(bytes, meaning, lost, late);
        if means == Means::Go && self.faults.strikes(FaultKind::XonDouble) {
            self.say_bytes(bytes, meaning, lost, late);
        }
    }

    fn say_bytes(&mut self, bytes: &[u8], meaning: Meaning, lost: bool, late: Duration) {
        for (index, &byte) in bytes.iter().enumerate() {
            // The last character carries the meaning.
            let meaning = if index + 1 == bytes.len() { meaning } else { Meaning::Other };
            let byte = self.with_parity(byte);
            self.back.put(Outgoing { byte, meaning, lost, not_before: self.now + late }, self.now);
        }
    }
}

const DC4: u8 = 0x14;
