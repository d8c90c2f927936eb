//! Someone who watches the control cut.
//!
//! The default methods do nothing. Whoever does not want pulses says so, and the interpolator runs at full speed.

use std::time::Duration;

use crate::dialect::three_b::Block;

/// Watches a [`crate::Controller`]. Positions are µm from where the wire stood before the first block.
pub trait Observer {
    /// Whether [`Observer::pulse`] is to be called at all.
    fn wants_pulses(&self) -> bool {
        true
    }

    /// One step of one axis; `at` is spread evenly over the block's cutting time.
    fn pulse(&mut self, at: Duration, block: u64, x_um: i64, y_um: i64) {
        let _ = (at, block, x_um, y_um);
    }

    /// As [`Observer::pulse`], of the upper guide's axes; only with a taper. Its steps and those of the plane of the program
    /// are told in the order in which they are taken, in proportion.
    fn upper_pulse(&mut self, at: Duration, block: u64, u_um: i64, v_um: i64) {
        let _ = (at, block, u_um, v_um);
    }

    /// A block has been executed complete.
    fn block_end(&mut self, end: &BlockEnd) {
        let _ = end;
    }

    /// A piece of the decoded program text, as it is digested.
    fn text(&mut self, text: &[u8]) {
        let _ = text;
    }
}

/// One block, executed complete.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct BlockEnd {
    /// Its number, from 1; it goes on over programs and connections.
    pub number: u64,
    /// What was executed.
    pub block: Block,
    /// Where it began, µm.
    pub start_um: [i64; 2],
    /// Where it ended, µm.
    pub end_um: [i64; 2],
    /// Pulses it took.
    pub pulses: u64,
    /// When cutting began.
    pub began: Duration,
    /// When cutting ended.
    pub ended: Duration,
}

/// Nobody watches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn wants_pulses(&self) -> bool {
        false
    }
}

impl<O: Observer + ?Sized> Observer for &mut O {
    fn wants_pulses(&self) -> bool {
        (**self).wants_pulses()
    }

    fn pulse(&mut self, at: Duration, block: u64, x_um: i64, y_um: i64) {
        (**self).pulse(at, block, x_um, y_um);
    }

    fn upper_pulse(&mut self, at: Duration, block: u64, u_um: i64, v_um: i64) {
        (**self).upper_pulse(at, block, u_um, v_um);
    }

    fn block_end(&mut self, end: &BlockEnd) {
        (**self).block_end(end);
    }

    fn text(&mut self, text: &[u8]) {
        (**self).text(text);
    }
}

impl<O: Observer + ?Sized> Observer for Box<O> {
    fn wants_pulses(&self) -> bool {
        (**self).wants_pulses()
    }

    fn pulse(&mut self, at: Duration, block: u64, x_um: i64, y_um: i64) {
        (**self).pulse(at, block, x_um, y_um);
    }

    fn upper_pulse(&mut self, at: Duration, block: u64, u_um: i64, v_um: i64) {
        (**self).upper_pulse(at, block, u_um, v_um);
    }

    fn block_end(&mut self, end: &BlockEnd) {
        (**self).block_end(end);
    }

    fn text(&mut self, text: &[u8]) {
        (**self).text(text);
    }
}

/// Watches if there is anyone.
impl<O: Observer> Observer for Option<O> {
    fn wants_pulses(&self) -> bool {
        self.as_ref().is_some_and(Observer::wants_pulses)
    }

    fn pulse(&mut self, at: Duration, block: u64, x_um: i64, y_um: i64) {
        if let Some(observer) = self {
            observer.pulse(at, block, x_um, y_um);
        }
    }

    fn upper_pulse(&mut self, at: Duration, block: u64, u_um: i64, v_um: i64) {
        if let Some(observer) = self {
            observer.upper_pulse(at, block, u_um, v_um);
        }
    }

    fn block_end(&mut self, end: &BlockEnd) {
        if let Some(observer) = self {
            observer.block_end(end);
        }
    }

    fn text(&mut self, text: &[u8]) {
        if let Some(observer) = self {
            observer.text(text);
        }
    }
}

/// Two who watch; pulses go to whoever wants them.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn wants_pulses(&self) -> bool {
        self.0.wants_pulses() || self.1.wants_pulses()
    }

    fn pulse(&mut self, at: Duration, block: u64, x_um: i64, y_um: i64) {
        if self.0.wants_pulses() {
            self.0.pulse(at, block, x_um, y_um);
        }
        if self.1.wants_pulses() {
            self.1.pulse(at, block, x_um, y_um);
        }
    }

    fn upper_pulse(&mut self, at: Duration, block: u64, u_um: i64, v_um: i64) {
        if self.0.wants_pulses() {
            self.0.upper_pulse(at, block, u_um, v_um);
        }
        if self.1.wants_pulses() {
            self.1.upper_pulse(at, block, u_um, v_um);
        }
    }

    fn block_end(&mut self, end: &BlockEnd) {
        self.0.block_end(end);
        self.1.block_end(end);
    }

    fn text(&mut self, text: &[u8]) {
        self.0.text(text);
        self.1.text(text);
    }
}
