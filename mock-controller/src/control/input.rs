//! What arrives: characters, with whatever the line did to them, and the link's openings and closings among them.

use super::Controller;
use super::code::NoCharacter;
use super::cutter::Item;
use super::reader::Read;
use crate::dialect::Dialect;
use crate::line::fault::FaultKind;
use crate::line::forward::Mark;
use crate::line::pace::Pace;
use crate::observer::Observer;
use std::time::Duration;

impl<O: Observer> Controller<O> {
    /// When the next character is complete. An unpaced line carries nothing during a hold, nor before what the control
    /// has to say has left it.
    pub(super) fn character_due(&self) -> Option<Duration> {
        // A machine that answers takes what comes in any case, and what it owes is what holds the sender.
        let held = (self.flow.held && self.is_running() && self.streams()) || !self.back.is_idle();
        if self.settings.pace == Pace::Unpaced && held {
            return None;
        }
        self.forward.completion().map(|at| at.max(self.now))
    }

    /// A character has left the shift register.
    pub(super) fn character(&mut self) {
        let Some(byte) = self.forward.complete() else {
            return;
        };
        if !self.faults.on_characters() {
            return self.arrives(byte);
        }
        if self.faults.strikes(FaultKind::Disconnect) {
            return self.pull();
        }
        if self.faults.strikes(FaultKind::DsrDrop) {
            return self.drop_ready();
        }
        if self.faults.strikes(FaultKind::Drop) {
            return;
        }
        if self.faults.strikes(FaultKind::Insert) {
            let foreign = u8::try_from(self.faults.pick(FaultKind::Insert, 0x60)).unwrap_or(0) + 0x20;
            self.arrives(foreign);
        }
        let mut byte = byte;
        if self.faults.strikes(FaultKind::Flip) {
            byte ^= 1 << self.faults.pick(FaultKind::Flip, 7);
        }
        if self.faults.strikes(FaultKind::Parity) {
            // Where blocks are checked, a character with wrong parity arrives as NUL, and the check finds it.
            if self.has_machine() && !self.streams() {
                byte = 0x00;
            } else {
                let number = self.tally.characters + 1;
                self.raise("parity", Some(format!("character {number}")));
            }
        }
        if self.faults.strikes(FaultKind::Echo) {
            self.echo(byte);
        }
        self.arrives(byte);
        if self.faults.strikes(FaultKind::Double) {
            self.arrives(byte);
        }
    }

    /// A character is complete at the receiver.
    fn arrives(&mut self, byte: u8) {
        self.tally.characters += 1;
        self.utilisation.character(self.now, self.settings.pace.character());
        self.flow.last_character = self.now;
        self.count_overrun();
        if !self.flow.reading || self.flow.deaf || !self.is_running() {
            self.tally.unread += 1;
            return;
        }
        self.flow.go_at = None;
        if self.has_machine() {
            return self.machine_takes(byte);
        }
        self.read(byte);
    }

    /// A character of the program, as it is coded.
    pub(super) fn read(&mut self, byte: u8) {
        match self.decoder.take(byte) {
            Ok(token) => token.bytes().for_each(|c| self.read_plain(c)),
            Err(NoCharacter { alarm, found }) => {
                let detail =
                    format!("block {}, character {}: {found}", self.tally.blocks + 1, self.tally.characters);
                self.raise(alarm, Some(detail));
            }
        }
    }

    /// A character of the program, decoded.
    pub(super) fn read_plain(&mut self, c: u8) {
        if !self.is_running() || self.flow.deaf {
            return;
        }
        let read = self.reader.push(c, &mut self.text, &mut self.observer);
        if self.reader.take_pause() && self.settings.dialect == Dialect::FourB {
            self.enqueue(Item::Pause, 0);
        }
        let item = match read {
            Read::Nothing => return self.filled(),
            Read::Block(block) => Item::Block(block),
            Read::Line(line) => Item::Line(line),
            Read::End => Item::End,
            Read::Malformed(found) => Item::Malformed(found),
        };
        if !self.reader.is_after_end() {
            self.flow.end_said = false;
        }
        let characters = self.reader.take_characters();
        self.enqueue(item, characters);
        if self.reader.take_end() {
            self.enqueue(Item::End, 0);
        }
        self.filled();
        self.take_up();
    }

    /// Everything put in before the link opened or closed has arrived.
    pub(super) fn link_changes(&mut self) {
        match self.forward.due_mark() {
            Some(Mark::Opened) => {
                self.tally.connections += 1;
                self.await_start();
            }
            Some(Mark::Closed) => self.unplugged(),
            None => {}
        }
    }

    /// Fault: the cable is pulled.
    fn pull(&mut self) {
        self.forward.cut();
        self.back.disconnect();
        self.flow.link_up = false;
        self.flow.pulled = true;
        self.unplugged();
    }

    fn unplugged(&mut self) {
        self.flow.go_at = None;
        self.flow.overrun = None;
        self.flow.reading = false;
        self.machine_close();
        self.decoder.clear();
        self.reader.link_closed(self.settings.torn, &mut self.text);
        // What was left of a block no longer fills the buffer.
        self.drained();
    }
}
