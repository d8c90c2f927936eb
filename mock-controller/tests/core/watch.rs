//! What a control cut, pulse by pulse and block by block.

#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use std::time::Duration;

use mock_controller::{BlockEnd, Controller, Dialect, Observer, Report, Settings};

use crate::sender::{HOUR, Sender};

#[derive(Default)]
pub(crate) struct Watch {
    /// Block, x, y.
    pub(crate) pulses: Vec<(u64, i64, i64)>,
    pub(crate) ends: Vec<BlockEnd>,
    /// Block, x and y of the last pulse below, then u and v.
    pub(crate) upper: Vec<(u64, [i64; 2], [i64; 2])>,
}

impl Observer for Watch {
    fn pulse(&mut self, _at: Duration, block: u64, x_um: i64, y_um: i64) {
        self.pulses.push((block, x_um, y_um));
    }

    fn upper_pulse(&mut self, _at: Duration, block: u64, u_um: i64, v_um: i64) {
        let (_, x, y) = self.pulses.last().copied().unwrap_or_default();
        self.upper.push((block, [x, y], [u_um, v_um]));
    }

    fn block_end(&mut self, end: &BlockEnd) {
        self.ends.push(*end);
    }
}

impl Watch {
    /// Left, right, bottom, top of what these blocks cut.
    pub(crate) fn bounds(&self, blocks: std::ops::RangeInclusive<u64>) -> [i64; 4] {
        let of = |value: fn(&(u64, i64, i64)) -> i64| {
            let values = || self.pulses.iter().filter(|pulse| blocks.contains(&pulse.0)).map(value);
            (values().min().unwrap(), values().max().unwrap())
        };
        let ((left, right), (bottom, top)) = (of(|pulse| pulse.1), of(|pulse| pulse.2));
        [left, right, bottom, top]
    }

    /// Least and greatest distance of a block's pulses from a point.
    pub(crate) fn distances(&self, block: u64, x: f64, y: f64) -> (f64, f64) {
        let far = |&(_, px, py): &(u64, i64, i64)| ((px as f64 - x).powi(2) + (py as f64 - y).powi(2)).sqrt();
        let distances: Vec<f64> = self.pulses.iter().filter(|pulse| pulse.0 == block).map(far).collect();
        assert!(!distances.is_empty(), "block {block} was not cut");
        (
            distances.iter().copied().fold(f64::INFINITY, f64::min),
            distances.iter().copied().fold(0.0, f64::max),
        )
    }
}

/// Runs a program at once on an unpaced line, watched.
pub(crate) fn watch(settings: Settings, program: &str) -> (Report, Watch) {
    let mut watch = Watch::default();
    let mut control = Controller::observed(settings, &mut watch).unwrap();
    control.link_opened(Duration::ZERO);
    let mut sender = Sender::of(program).window(4096);
    sender.feed(&mut control, Duration::ZERO, HOUR);
    let report = control.report();
    drop(control);
    for pair in watch.pulses.windows(2) {
        assert_eq!((pair[1].1 - pair[0].1).abs() + (pair[1].2 - pair[0].2).abs(), 1, "one step of one axis");
    }
    (report, watch)
}

/// An unpaced 4B control that holds this offset.
pub(crate) fn four_b(wire_offset_um: f64) -> Settings {
    Settings { dialect: Dialect::FourB, wire_offset_um, ..Settings::unpaced() }
}
