//! The cut a 3B control would make, pulse by pulse, and where it strays farthest from the programmed path.
//!
//! Each block begins where the last one really ended. How far a pulse is from the path is measured from the block's own
//! line or circle; the last pulse also from the block's end, so that one which stops short is seen.
//!
//! A block that begins as one before it did, a part repeated, is not run again: what came of it is remembered.

use std::collections::HashMap;

use super::layer::{FINEST_UM, Thinned};
use crate::drawing::{Outline, Thinning};
use crate::formats::three_b::{Axis, Block, Motion};
use crate::geometry::{Element, Point, Sense};
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

/// What comes of a block, seen from where it begins.
#[derive(Clone, Debug)]
struct Outcome {
    pulses: u64,
    /// How far the farthest place is from the path, µm, and where.
    worst: (f64, Position),
    end: Position,
    /// The way, thinned.
    points: Box<[(i64, i64)]>,
}

/// The most blocks that are remembered, and the most points of theirs: some 30 MB in all.
const KNOWN_MAX: usize = 20_000;
const KNOWN_POINTS_MAX: usize = 1_000_000;

/// Runs a model's pulses.
#[derive(Debug)]
pub(super) struct Simulation {
    model: Model,
    stands: Position,
    path: Thinned,
    known: HashMap<[i64; 6], Outcome>,
    /// Points held in what is known.
    known_points: usize,
    pulses: u64,
    largest: Option<Deviation>,
}

impl Simulation {
    pub(super) fn new(model: Model) -> Self {
        let mut path = Thinned::new();
        path.go_to((0, 0));
        Self {
            model,
            stands: Position::default(),
            path,
            known: HashMap::new(),
            known_points: 0,
            pulses: 0,
            largest: None,
        }
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

    /// Runs a block along the element the program means by it, which is the same for the same block.
    pub(super) fn see(&mut self, block: &Block, element: &Element, number: u64) -> Result<(), Fault> {
        let key = key(block, self.stands - Position::nearest(element.start()));
        if let Some(outcome) = self.known.get(&key) {
            draw(&mut self.path, self.stands, outcome);
            let Outcome { pulses, worst, end, .. } = *outcome;
            self.go_on(pulses, worst, end, number);
            return Ok(());
        }
        let outcome = self.run(block, element)?;
        draw(&mut self.path, self.stands, &outcome);
        self.go_on(outcome.pulses, outcome.worst, outcome.end, number);
        let points = self.known_points + outcome.points.len();
        if self.known.len() < KNOWN_MAX && points <= KNOWN_POINTS_MAX {
            self.known_points = points;
            self.known.insert(key, outcome);
        }
        Ok(())
    }

    fn run(&self, block: &Block, element: &Element) -> Result<Outcome, Fault> {
        let from = self.stands;
        let gauge = Gauge::of(element);
        let (mut low, mut high) = ((f64::INFINITY, from), (f64::NEG_INFINITY, from));
        let mut way = Way::new(self.path.tolerance_um());
        let (mut at, mut pulses) = (from, 0);
        self.model.pulses(block)?.for_each(|pulse| {
            at = from + pulse;
            pulses += 1;
            let measured = gauge.measure(at);
            if measured < low.0 {
                low = (measured, at);
            }
            if measured > high.0 {
                high = (measured, at);
            }
            way.go((pulse.x.0, pulse.y.0));
        });
        let mut worst = (-1.0, from);
        for (measured, at) in [low, high] {
            if measured.is_finite() && gauge.off_um(measured) > worst.0 {
                worst = (gauge.off_um(measured), at);
            }
        }
        let short = at.distance_um(element.end());
        if short > worst.0 {
            worst = (short, at);
        }
        let end = at - from;
        Ok(Outcome { pulses, worst: (worst.0, worst.1 - from), end, points: way.finish((end.x.0, end.y.0)) })
    }

    fn go_on(&mut self, pulses: u64, (um, place): (f64, Position), end: Position, block: u64) {
        if self.largest.is_none_or(|largest| um > largest.um) {
            let at = self.stands + place;
            let at = Point::new(at.x.millimetres(), at.y.millimetres());
            self.largest = Some(Deviation { um, at, block });
        }
        self.pulses += pulses;
        self.stands += end;
    }

    /// Lets go what has been drawn of the run in work: nothing was cut there.
    pub(super) fn forget_run(&mut self) {
        self.path.forget_run();
    }

    /// Ends a run where a contour has closed.
    pub(super) fn end_run(&mut self) {
        self.path.end_run();
        self.path.push((self.stands.x.0, self.stands.y.0));
    }

    /// The runs drawn, and how far they may be from the pulses, µm.
    pub(super) fn finish(self) -> (Vec<Outline>, f64) {
        let (runs, off) = self.path.finish();
        // Each block's way has been thinned before; at most by half as much.
        (runs, 1.5 * off)
    }
}

fn draw(path: &mut Thinned, from: Position, outcome: &Outcome) {
    for &(x, y) in &outcome.points {
        path.push((from.x.0 + x, from.y.0 + y));
    }
}

/// Equal for blocks that are run alike: their numbers, and from where the program has them begin to where they do.
fn key(block: &Block, off: Position) -> [i64; 6] {
    let (kind, quadrant) = match block.motion {
        Motion::Line(quadrant) => (0, quadrant),
        Motion::Arc(Sense::Clockwise, quadrant) => (1, quadrant),
        Motion::Arc(Sense::CounterClockwise, quadrant) => (2, quadrant),
    };
    let (x, y) = quadrant.signs();
    let code = kind * 8 + i64::from(x > 0) * 4 + i64::from(y > 0) * 2 + i64::from(block.g == Axis::X);
    [block.x.0, block.y.0, block.j.0, code, off.x.0, off.y.0]
}

/// The way of a block, so finely that it is within a tolerance of the pulses.
enum Way {
    /// Thinned pulse by pulse.
    Fine(Thinning),
    /// A point when the wire is clear of the last one, in each axis.
    Coarse { clear: i64, last: (i64, i64), points: Vec<(i64, i64)> },
}

impl Way {
    fn new(tolerance_um: f64) -> Self {
        if tolerance_um < COARSE_UM {
            let mut fine = Thinning::new(FINEST_UM);
            fine.push((0, 0));
            Self::Fine(fine)
        } else {
            Self::Coarse { clear: (tolerance_um / 2.0) as i64, last: (0, 0), points: Vec::new() }
        }
    }

    #[inline]
    fn go(&mut self, (x, y): (i64, i64)) {
        match self {
            Self::Fine(fine) => fine.push((x, y)),
            Self::Coarse { clear, last, points } => {
                if (x - last.0).abs() > *clear || (y - last.1).abs() > *clear {
                    *last = (x, y);
                    points.push((x, y));
                }
            }
        }
    }

    fn finish(self, end: (i64, i64)) -> Box<[(i64, i64)]> {
        match self {
            Self::Fine(fine) => fine.finish().into(),
            Self::Coarse { mut points, .. } => {
                points.push(end);
                points.into()
            }
        }
    }
}

/// From this tolerance on pulses are skipped.
const COARSE_UM: f64 = 2.0;

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
        assert!(off <= 2.4 && runs.len() == 1);
        let extent = runs[0].extent();
        for (found, expected) in [(extent.min[0], -19.8), (extent.max[0], 0.0), (extent.max[1], 9.9)] {
            assert!((found - expected).abs() < 0.0025, "{extent:?}");
        }
    }

    #[test]
    fn a_block_met_again_is_run_as_if_it_were_new() {
        // A model that strays, so that every turn begins elsewhere until it has come round.
        let (block, element) = circle(Axis::Y);
        let mut remembering = Simulation::new(Model::Strict);
        let mut forgetting = Simulation::new(Model::Strict);
        for number in 1..=5 {
            remembering.see(&block, &element, number).unwrap();
            forgetting.see(&block, &element, number).unwrap();
            forgetting.known.clear();
        }
        assert!(remembering.known.len() < 5);
        assert_eq!(remembering.stands, forgetting.stands);
        assert_eq!(
            (remembering.largest, remembering.pulses, remembering.finish()),
            (forgetting.largest, forgetting.pulses, forgetting.finish())
        );
    }
}
