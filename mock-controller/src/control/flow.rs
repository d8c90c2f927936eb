//! DC1, DC3, NAK, SYN: what the control says, and when.
//!
//! A hold's overrun is counted from the instant DC3's stop bit has left the control to the instant the next DC1's has.
//! The DC3 after a program's end goes out once the line has been silent for a while, so that a trailer of any length
//! is still taken; it begins no hold.

use std::time::Duration;

use super::Controller;
use super::plan::Plan;
use super::protocol::Stop;
use super::settings::Start;
use crate::line::back::{Meaning, Outgoing};
use crate::line::fault::FaultKind;
use crate::observer::Observer;

#[derive(Clone, Debug, Default)]
pub(super) struct Flow {
    pub(super) link_up: bool,
    pub(super) pulled: bool,
    /// Whether what arrives is read at all.
    pub(super) reading: bool,
    /// Reset: nothing is read until the link opens anew.
    pub(super) deaf: bool,
    /// When the next DC1 of a waiting control goes out.
    pub(super) go_at: Option<Duration>,
    pub(super) held: bool,
    /// Characters since DC3 left, while they count.
    pub(super) overrun: Option<Overrun>,
    pub(super) last_character: Duration,
    /// When the last DC1 reached the sender's program.
    pub(super) last_go: Duration,
    /// The DC3 after the program's end has been sent.
    pub(super) end_said: bool,
    /// The line that says "ready" has broken.
    pub(super) dropped: bool,
    /// The sender's DTR.
    pub(super) sender_ready: bool,
    /// The machine is being asked for what it has.
    pub(super) pulling: bool,
    /// When a line that is late goes on.
    pub(super) line_on_at: Option<Duration>,
}

/// Characters that have come since DC3 left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overrun {
    since: Duration,
    characters: u64,
}

impl<O: Observer> Controller<O> {
    /// Whether the control is cutting at all.
    pub(super) fn is_running(&self) -> bool {
        self.tally.alarm.is_none()
    }

    /// The link has opened: the operator starts the control after a while, or never.
    pub(super) fn await_start(&mut self) {
        self.flow.reading = false;
        self.flow.deaf = false;
        self.flow.go_at = match self.settings.start {
            Start::After(delay) if self.is_running() => Some(self.now + delay),
            Start::After(_) | Start::Never => None,
        };
    }

    /// A waiting control asks for the program, first or again.
    pub(super) fn go(&mut self) {
        self.flow.reading = true;
        if self.has_machine() {
            self.flow.go_at = None;
            return self.machine_start();
        }
        self.flow.go_at = Some(self.now + GO_AGAIN);
        // A control whose buffer is still full asks when it has drained.
        if !self.flow.held {
            self.say_go();
        }
    }

    /// The buffer has filled by a character.
    pub(super) fn filled(&mut self) {
        if !self.is_running() {
            return;
        }
        let fill = self.buffered();
        if fill > self.settings.buffer_bytes {
            let detail = format!("block {}: {fill} characters", self.tally.blocks + 1);
            return self.raise("buffer-overflow", Some(detail));
        }
        if !self.flow.held && fill >= self.settings.xoff_at && !self.is_starving() {
            self.flow.held = true;
            self.tally.holds += 1;
            if self.has_machine() {
                return self.machine_holds();
            }
            let lost = self.faults.strikes(FaultKind::XoffLost);
            self.say(DC3, Meaning::Hold, lost, Duration::ZERO);
        }
    }

    /// An item has been taken out of the buffer.
    pub(super) fn drained(&mut self) {
        if self.flow.held && self.is_running() && self.buffered() <= self.settings.xon_at {
            self.release();
        }
    }

    /// Nothing is left to cut: whatever the fill, more is needed to complete a block.
    pub(super) fn starved(&mut self) {
        if self.flow.held && self.is_running() && self.is_starving() {
            self.release();
        }
    }

    /// A control that has nothing to cut does not ask for silence.
    fn is_starving(&self) -> bool {
        self.cut.is_none() && self.queue.is_empty()
    }

    fn release(&mut self) {
        self.flow.held = false;
        if self.has_machine() {
            return self.machine_goes_on();
        }
        self.say_go();
        if self.flow.go_at.is_some() {
            self.flow.go_at = Some(self.now + GO_AGAIN);
        }
    }

    fn say_go(&mut self) {
        let lost = self.faults.strikes(FaultKind::XonLost);
        let late = match self.faults.strikes(FaultKind::XonLate) {
            true => self.faults.pick_milliseconds(FaultKind::XonLate, 500, 5000),
            false => Duration::ZERO,
        };
        self.say(DC1, Meaning::Go, lost, late);
        if self.faults.strikes(FaultKind::XonDouble) {
            self.say(DC1, Meaning::Go, lost, late);
        }
    }

    fn say(&mut self, code: u8, meaning: Meaning, lost: bool, late: Duration) {
        let byte = self.with_parity(code);
        self.back.put(Outgoing { byte, meaning, lost, not_before: self.now + late }, self.now);
    }

    /// What a control with even parity in bit 8 sends for a character.
    pub(super) fn with_parity(&self, code: u8) -> u8 {
        if self.settings.dc3_parity { with_even_parity(code) } else { code }
    }

    /// A hold begins without a character.
    pub(super) fn begin_overrun(&mut self) {
        self.flow.overrun = Some(Overrun { since: self.now, characters: 0 });
    }

    /// Sends a character back as it came.
    pub(super) fn echo(&mut self, byte: u8) {
        let echo = Outgoing { byte, meaning: Meaning::Other, lost: false, not_before: self.now };
        self.back.put(echo, self.now);
    }

    /// A stop bit has left the control.
    pub(super) fn sent(&mut self) {
        match self.back.complete() {
            Some((Meaning::Hold, _)) => {
                self.flow.overrun = Some(Overrun { since: self.now, characters: 0 });
                self.utilisation.hold_begins(self.now);
            }
            Some((Meaning::Go, arrival)) => {
                self.flow.overrun = None;
                self.flow.last_go = arrival;
                self.utilisation.hold_ends(arrival);
            }
            Some((Meaning::EndOfTransfer | Meaning::Other, _)) | None => {}
        }
    }

    /// A character has arrived while, perhaps, none should.
    pub(super) fn count_overrun(&mut self) {
        let Some(overrun) = &mut self.flow.overrun else {
            return;
        };
        if self.now <= overrun.since + SAME_INSTANT {
            return;
        }
        overrun.characters += 1;
        let overrun = overrun.characters;
        self.tally.max_overrun = self.tally.max_overrun.max(overrun);
        // After a reset there is no buffer to overrun; it is only counted.
        if overrun > self.settings.overrun_limit && self.is_running() && !self.flow.deaf {
            let detail = format!("block {}: {overrun} characters after DC3", self.tally.blocks + 1);
            self.raise("overrun", Some(detail));
        }
    }

    /// Stops the control for good: DC3, then NAK. The block being cut is broken off and not counted.
    pub(super) fn raise(&mut self, name: &'static str, detail: Option<String>) {
        if !self.is_running() {
            return;
        }
        self.tally.alarm = Some(name);
        self.tally.alarm_detail = detail;
        self.cut = None;
        self.flow.go_at = None;
        if !self.machine_stops(Stop::Alarm(name)) {
            self.say_stop(NAK, if name == "nak-storm" { 20 } else { 1 });
        }
    }

    /// Clears everything that has not been cut: DC3, then SYN.
    pub(super) fn reset(&mut self) {
        self.tally.resets += 1;
        self.queue.clear();
        self.queued_characters = 0;
        self.reader.reset(&mut self.text);
        self.decoder.clear();
        self.plan = Plan::new(&self.settings, self.position_um());
        self.flow.deaf = true;
        self.flow.held = false;
        self.flow.go_at = None;
        if !self.machine_stops(Stop::Reset) {
            self.say_stop(SYN, 1);
        }
    }

    fn say_stop(&mut self, code: u8, times: u32) {
        // A hold that is on goes on; its overrun is counted from its own DC3.
        let meaning = if self.flow.overrun.is_some() { Meaning::Other } else { Meaning::Hold };
        self.say(DC3, meaning, false, Duration::ZERO);
        for _ in 0..times {
            self.say(code, Meaning::Other, false, Duration::ZERO);
        }
    }

    /// When the DC3 after the program's end goes out.
    pub(super) fn end_of_transfer_due(&self) -> Option<Duration> {
        let due = self.reader.is_after_end()
            && !self.flow.end_said
            && !self.flow.held
            && !self.in_transfer()
            && self.is_running();
        let silence = END_SILENCE + 2 * self.settings.latency + self.settings.pace.time_of(10);
        due.then(|| self.flow.last_character.max(self.flow.last_go) + silence)
    }

    pub(super) fn end_of_transfer(&mut self) {
        self.flow.end_said = true;
        if self.has_machine() {
            return;
        }
        self.say(DC3, Meaning::EndOfTransfer, false, Duration::ZERO);
    }
}

/// Bit 8 set where the number of ones is odd: 0x93, 0x95, 0x96; 0x11 as it is (domain/4, rule 2).
fn with_even_parity(code: u8) -> u8 {
    if code.count_ones() % 2 == 1 { code | 0x80 } else { code }
}

const DC1: u8 = 0x11;
const DC3: u8 = 0x13;
const NAK: u8 = 0x15;
const SYN: u8 = 0x16;

/// "Haas repeats DC1 after 5 s of silence" (domain/4, rule 3, [man]).
const GO_AGAIN: Duration = Duration::from_secs(5);

/// A character that completes together with DC3's stop bit is no overrun; both times are rounded to the nanosecond.
const SAME_INSTANT: Duration = Duration::from_nanos(2);

/// How long the line must have been silent after a program's end before the control says that it has heard it. A guess:
/// longer than any pause between a stop word and its trailer, shorter than anyone waits.
const END_SILENCE: Duration = Duration::from_millis(100);
