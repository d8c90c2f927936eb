//! The cut a 3B control would make, pulse by pulse, and where it strays farthest from the programmed path.
//!
//! Each block begins where the last one really ended. How far a pulse is from the path is measured from the block's own
//! line or circle; the last pulse also from the block's end, so that one which stops short is seen.

use super::layer::Thinned;
use crate::drawing::Outline;
use crate::formats::three_b::Block;
use crate::geometry::{Element, Point};
use crate::interpolator::{Fault, Model};
use crate::units::Position;

/// The place where a cut is farthest from its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// How far, µm.
    pub um: f64,
    /// Where the wire is then, mm.
    pub at: Point,
    /// In which block.
    pub block: u64,
}

/// Runs a model's pulses.
#[derive(Debug)]
pub(super) struct Simulation {
    model: Model,
    stands: Position,
    drawn: (i64, i64),
    path: Thinned,
    pulses: u64,
    largest: Option<Deviation>,
}

impl Simulation {
    pub(super) fn new(model: Model) -> Self {
        let mut path = Thinned::new();
        path.go_to((0, 0));
        Self { model, stands: Position::default(), drawn: (0, 0), path, pulses: 0, largest: None }
    }

    pub(super) fn model(&self) -> Model {
        self.model
    }

    pub(super) fn pulses(&self) -> u64 {
        self.pulses
    }

    pub(super) fn largest(&self) -> Option<Deviation> {
        self.largest
    }

    /// Runs a block along the element the program means.
    pub(super) fn see(&mut self, block: &Block, element: &Element, number: u64) -> Result<(), Fault> {
        let pulses = self.model.pulses(block)?;
        let from = self.stands;
        let gauge = Gauge::of(element);
        let (mut low, mut high) = ((f64::INFINITY, from), (f64::NEG_INFINITY, from));
        // A point is drawn when the wire is clear of the last one; the thinning does the rest.
        let clear = (self.path.tolerance_um() / 2.0) as i64;
        let mut at = from;
        let (path, drawn, mut count) = (&mut self.path, &mut self.drawn, 0);
        pulses.for_each(|pulse| {
            at = from + pulse;
            count += 1;
            let measured = gauge.measure(at);
            if measured < low.0 {
                low = (measured, at);
            }
            if measured > high.0 {
                high = (measured, at);
            }
            let (x, y) = (at.x.0, at.y.0);
            if (x - drawn.0).abs() > clear || (y - drawn.1).abs() > clear {
                *drawn = (x, y);
                path.push((x, y));
            }
        });
        self.pulses += count;
        let (mut worst, mut worst_at) = (-1.0, from);
        for (measured, at) in [low, high] {
            if measured.is_finite() && gauge.off_um(measured) > worst {
                (worst, worst_at) = (gauge.off_um(measured), at);
            }
        }
        self.drawn = (at.x.0, at.y.0);
        self.path.push(self.drawn);
        self.stands = at;
        let short = at.distance_um(element.end());
        if short > worst {
            (worst, worst_at) = (short, at);
        }
        if self.largest.is_none_or(|largest| worst > largest.um) {
            let point = Point::new(worst_at.x.millimetres(), worst_at.y.millimetres());
            self.largest = Some(Deviation { um: worst, at: point, block: number });
        }
        Ok(())
    }

    /// Lets go what has been drawn of the run in work: nothing was cut there.
    pub(super) fn forget_run(&mut self) {
        self.path.forget_run();
    }

    /// Ends a run where a contour has closed.
    pub(super) fn end_run(&mut self) {
        self.path.end_run();
        self.path.push(self.drawn);
    }

    /// The runs drawn, and how far they may be from the pulses, µm.
    pub(super) fn finish(self) -> (Vec<Outline>, f64) {
        self.path.finish()
    }
}

/// Measures how far positions are from an element's own line or circle.
#[derive(Clone, Copy, Debug)]
enum Gauge {
    Line { from: [f64; 2], across: [f64; 2] },
    Circle { centre: [f64; 2], radius: f64 },
}

impl Gauge {
    fn of(element: &Element) -> Self {
        let um = |p: Point| [p.x * 1000.0, p.y * 1000.0];
        match *element {
            Element::Line { start, .. } => {
                let ahead = element.heading_at_start();
                Self::Line { from: um(start), across: [-ahead.y, ahead.x] }
            }
            Element::Arc { start, centre, .. } => {
                Self::Circle { centre: um(centre), radius: (start - centre).norm() * 1000.0 }
            }
        }
    }

    /// A number that grows from one side of the element to the other, cheap enough for each pulse.
    #[inline]
    fn measure(&self, at: Position) -> f64 {
        let seen = |from: &[f64; 2]| [at.x.0 as f64 - from[0], at.y.0 as f64 - from[1]];
        match self {
            Self::Line { from, across } => {
                let [x, y] = seen(from);
                x * across[0] + y * across[1]
            }
            Self::Circle { centre, .. } => {
                let [x, y] = seen(centre);
                x * x + y * y
            }
        }
    }

    /// The distance that a measure stands for, µm.
    fn off_um(&self, measured: f64) -> f64 {
        match self {
            Self::Line { .. } => measured.abs(),
            Self::Circle { radius, .. } => (measured.sqrt() - radius).abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::three_b::Axis;
    use crate::geometry::Sense;
    use crate::units::Micrometres;

    fn circle(g: Axis) -> (Block, Element) {
        let start = Point::new(0.0, 0.0);
        let centre = Point::new(-9.9, 0.0);
        let block = Block::arc(Position::new(9900, 0), Sense::CounterClockwise, g, Micrometres(39_600));
        (block, Element::Arc { start, end: start, centre, sense: Sense::CounterClockwise })
    }

    #[test]
    fn a_circle_is_cut_within_a_micron_and_the_place_is_told() {
        let mut simulation = Simulation::new(Model::Rotated);
        let (block, element) = circle(Axis::Y);
        simulation.see(&block, &element, 7).unwrap();
        let largest = simulation.largest().unwrap();
        assert!(0.5 < largest.um && largest.um < 1.2, "{largest:?}");
        let off = ((largest.at - Point::new(-9.9, 0.0)).norm() - 9.9).abs() * 1000.0;
        assert!((off - largest.um).abs() < 1e-6 && largest.block == 7);
        assert_eq!(simulation.pulses(), 8 * 9900);
    }

    #[test]
    fn a_block_that_stops_short_is_the_farthest_off() {
        let mut simulation = Simulation::new(Model::Rotated);
        let (block, element) = circle(Axis::X);
        simulation.see(&block, &element, 1).unwrap();
        let largest = simulation.largest().unwrap();
        assert!((139.0..143.0).contains(&largest.um), "{largest:?}");
    }

    #[test]
    fn what_is_drawn_is_near_the_pulses() {
        let mut simulation = Simulation::new(Model::Strict);
        let (block, element) = circle(Axis::Y);
        simulation.see(&block, &element, 1).unwrap();
        let (runs, off) = simulation.finish();
        assert!(off <= 1.6 && runs.len() == 1);
        let extent = runs[0].extent();
        for (found, expected) in [(extent.min[0], -19.8), (extent.max[0], 0.0), (extent.max[1], 9.9)] {
            assert!((found - expected).abs() < 0.0025, "{extent:?}");
        }
    }
}
