//! The tests' own writer of 4B: an outline of absolute nodes in, blocks out, each from where the last one really ends.

#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use std::fmt::Write as _;

use mock_controller::interpolator::run;
use mock_controller::{Axis, Block, Kind, Model, Quadrant};

/// Where the flag stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Order {
    FlagFirst,
    AxisFirst,
}

pub(crate) struct Writer {
    pub(crate) text: String,
    /// Where the wire stands at F = 0, µm.
    pub(crate) at: (i64, i64),
    pub(crate) blocks: u64,
    order: Order,
    model: Model,
}

impl Writer {
    pub(crate) fn new(order: Order) -> Writer {
        Writer { text: "%\n".to_owned(), at: (0, 0), blocks: 0, order, model: Model::Rotated }
    }

    pub(crate) fn in_model(self, model: Model) -> Writer {
        Writer { model, ..self }
    }

    /// A plain line to an absolute place.
    pub(crate) fn line(&mut self, x: i64, y: i64) {
        let block = self.straight(x, y);
        self.put(&block, None);
    }

    /// A lead-in with `B0` and a flag.
    pub(crate) fn lead_in(&mut self, x: i64, y: i64, flag: &str) {
        let block = self.straight(x, y);
        self.put(&block, Some((0, flag)));
    }

    /// An arc about a centre to an absolute place, through `sweep` radians.
    pub(crate) fn arc(&mut self, kind: Kind, flag: &str, centre: (f64, f64), to: (f64, f64), sweep: f64) {
        let centre = (centre.0.round() as i64, centre.1.round() as i64);
        let start = (self.at.0 - centre.0, self.at.1 - centre.1);
        let radius = ((start.0 * start.0 + start.1 * start.1) as f64).sqrt();
        let end = (to.0 - centre.0 as f64, to.1 - centre.1 as f64);
        let g = if end.0.abs() < end.1.abs() { Axis::X } else { Axis::Y };
        let clockwise = kind == Kind::Clockwise;
        let quadrant = match (start.0.signum(), start.1.signum(), clockwise) {
            (1, 0 | 1, false) | (0 | 1, 1, true) => Quadrant::First,
            (0 | -1, 1, false) | (-1, 0 | 1, true) => Quadrant::Second,
            (-1, 0 | -1, false) | (0 | -1, -1, true) => Quadrant::Third,
            _ => Quadrant::Fourth,
        };
        // J by walking the arc in small steps, then the neighbour whose end is nearest.
        let sign = if clockwise { -1.0 } else { 1.0 };
        let angle = (start.1 as f64).atan2(start.0 as f64);
        let places = 20_000;
        let along = |step: i32| {
            let angle = angle + sign * sweep * f64::from(step) / f64::from(places);
            if g == Axis::X { radius * angle.cos() } else { radius * angle.sin() }
        };
        let travelled: f64 = (0..places).map(|step| (along(step + 1) - along(step)).abs()).sum();
        let size = |v: i64| u32::try_from(v.abs()).unwrap();
        let block = |j| Block { x: size(start.0), y: size(start.1), j, g, kind, quadrant };
        let j = travelled.round() as u32;
        let off = |j: u32| {
            let travel = run(self.model, &block(j), |_, _| {}).unwrap();
            let x = (self.at.0 + travel.dx) as f64 - to.0;
            let y = (self.at.1 + travel.dy) as f64 - to.1;
            x * x + y * y
        };
        let best = (j - 8..=j + 8).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap();
        self.put(&block(best), Some((radius.round() as u32, flag)));
    }

    fn straight(&self, x: i64, y: i64) -> Block {
        let (dx, dy) = (x - self.at.0, y - self.at.1);
        let size = |v: i64| u32::try_from(v.abs()).unwrap();
        let quadrant = match (dx.signum(), dy.signum()) {
            (1, 0 | 1) => Quadrant::First,
            (0 | -1, 1) => Quadrant::Second,
            (-1, 0 | -1) => Quadrant::Third,
            _ => Quadrant::Fourth,
        };
        let odd = matches!(quadrant, Quadrant::First | Quadrant::Third);
        let g = if size(dx) > size(dy) || (size(dx) == size(dy) && !odd) { Axis::X } else { Axis::Y };
        Block { x: size(dx), y: size(dy), j: size(dx).max(size(dy)), g, kind: Kind::Line, quadrant }
    }

    fn put(&mut self, block: &Block, fourth: Option<(u32, &str)>) {
        let travel = run(self.model, block, |_, _| {}).unwrap();
        self.at = (self.at.0 + travel.dx, self.at.1 + travel.dy);
        self.blocks += 1;
        let plain = block.to_string();
        let (numbers, words) = plain.split_at(plain.find('G').unwrap());
        let (axis, z) = words.split_at(2);
        let _ = match (fourth, self.order) {
            (None, _) => writeln!(self.text, "{plain}"),
            (Some((r, flag)), Order::FlagFirst) => writeln!(self.text, "{numbers}B{r}{flag}{axis}{z}"),
            (Some((r, flag)), Order::AxisFirst) => writeln!(self.text, "{numbers}B{r}{axis}{flag}{z}"),
        };
    }
}

/// An L of 20 × 20 mm from (0, 5) to (20, 25) with a notch of 10 × 10 at its right top, every corner rounded by 5; from
/// a start hole at (0, 0) and back. Blocks: 1 the lead-in, 2 the bottom, 3 and 4 the right corners, 5 the inside corner,
/// 6 and 7 the top corners, 8 the left side, 9 the last corner, 10 the lead-out. `mirrored`: x negative, clockwise.
pub(crate) fn ell(order: Order, model: Model, mirrored: bool) -> Writer {
    use Kind::{Clockwise, CounterClockwise};
    let sign = if mirrored { -1 } else { 1 };
    let (convex, concave) =
        if mirrored { (Clockwise, CounterClockwise) } else { (CounterClockwise, Clockwise) };
    let mut writer = Writer::new(order).in_model(model);
    let quarter = std::f64::consts::FRAC_PI_2;
    let mm = |x: i64, y: i64| ((sign * x * 1000) as f64, (y * 1000) as f64);
    writer.lead_in(sign * 5000, 5000, "D");
    writer.line(sign * 15_000, 5000);
    writer.arc(convex, "D", mm(15, 10), mm(20, 10), quarter);
    writer.arc(convex, "D", mm(15, 10), mm(15, 15), quarter);
    writer.arc(concave, "DD", mm(15, 20), mm(10, 20), quarter);
    writer.arc(convex, "D", mm(5, 20), mm(5, 25), quarter);
    writer.arc(convex, "D", mm(5, 20), mm(0, 20), quarter);
    writer.line(0, 10_000);
    writer.arc(convex, "D", mm(5, 10), mm(5, 5), quarter);
    writer.line(0, 0);
    writer
}
