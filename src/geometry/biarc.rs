//! Lines and tangent biarcs for a curve, within a stated tolerance and in as few elements as can be.
//!
//! A biarc is two arcs that meet in one direction; it begins and ends on the curve, in the curve's directions, so a
//! smooth curve gives a smooth path. The longest piece that keeps the tolerance is taken, then the next: the deviation
//! of a piece is measured against the curve, in many places, and the length of the next try follows from it. Corners
//! and cusps end a piece. Arcs on one circle become one, so a circle drawn as a spline is cut as a circle.
//!
//! What is measured is the distance of the curve's points from the elements. Elements are never longer than a turn of
//! three radians, and run along the curve, so nothing of them lies elsewhere.

mod pair;
mod walk;

use thiserror::Error;

use super::curve::Curve;
use super::{Element, Point};
use pair::Pieces;
use walk::{Node, Stretch, Walk};

/// How a curve becomes elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The greatest distance of the curve from its elements, mm.
    pub tolerance: f64,
    /// Which elements.
    pub elements: Elements,
    /// The greatest radius of an arc, mm; a line stands for a flatter one where the tolerance allows it.
    ///
    /// Without a limit, a path is smooth to 1e-9 rad wherever its curve is, and nearly straight parts give radii of
    /// kilometres, which a control may refuse.
    pub radius_max: f64,
}

/// What a curve is made into.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Elements {
    /// Straight lines from point to point of the curve.
    Lines,
    /// Biarcs, and lines where the curve is straight.
    Biarcs,
    /// Whichever is fewer, between any two corners of the curve.
    #[default]
    Fewest,
}

impl Fit {
    /// The fewest elements within a tolerance in mm, with arcs of any radius.
    #[must_use]
    pub fn within(tolerance: f64) -> Self {
        Self { tolerance, elements: Elements::Fewest, radius_max: f64::INFINITY }
    }
}

/// Why a curve has no elements.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// The tolerance is none.
    #[error("a tolerance of {0} mm is not a positive length")]
    Tolerance(f64),
    /// The range has no length.
    #[error("the curve's parameter goes from {0} to {1}")]
    Range(f64, f64),
    /// The curve has no point somewhere.
    #[error("the curve has no finite point at parameter {0:e}")]
    NotFinite(f64),
    /// The curve goes where no length is measured.
    #[error("the curve leads to a point {0:e} mm out")]
    Far(f64),
    /// Neither lines nor arcs follow it.
    #[error("the curve cannot be followed at parameter {0:e}")]
    Lost(f64),
    /// It would take more elements than [`ELEMENTS_MAX`].
    #[error("the curve takes more than {ELEMENTS_MAX} elements")]
    TooMany,
}

/// The most elements a curve may take: a guard against a tolerance far too small for the curve.
pub const ELEMENTS_MAX: usize = 100_000;

/// A curve no point of which is farther than this from its start is none, mm.
const POINT_WITHIN: f64 = 1e-6;
/// Beyond this the squares of lengths are no longer numbers, mm.
const FAR: f64 = 1e100;
/// More places than this that are bridged by a line are no jumps of a curve but a curve that cannot be followed.
const BRIDGES_MAX: usize = 64;

/// Two ends of a curve this close are one, mm: a closed curve is closed to the bit.
const CLOSED_WITHIN: f64 = 1e-9;

/// The elements of a curve; each begins on the very point where the last one ended. None for a curve that is a point.
///
/// # Errors
///
/// When the curve or the tolerance is not fit for it.
pub fn fit(curve: &impl Curve, fit: &Fit) -> Result<Vec<Element>, FitError> {
    if !(fit.tolerance > 0.0 && fit.tolerance.is_finite()) {
        return Err(FitError::Tolerance(fit.tolerance));
    }
    let walk = Walk::along(curve)?;
    match walk.reach(curve) {
        far if far > FAR => return Err(FitError::Far(far)),
        // A curve this small is a point.
        near if near <= POINT_WITHIN => return Ok(Vec::new()),
        _ => {}
    }
    let mut elements = Vec::new();
    let mut node = walk.start();
    let mut stretches = walk.stretches().peekable();
    while let Some(stretch) = stretches.next() {
        let mut last = stretch.node(curve, stretch.length()).point;
        if stretches.peek().is_none() && (last - walk.start()).norm() <= CLOSED_WITHIN {
            last = walk.start();
        }
        let ends = [node, last];
        let lines = |count_max| pieces(curve, stretch, fit, ends, Shape::Chord, count_max);
        let biarcs = || pieces(curve, stretch, fit, ends, Shape::Biarc, ELEMENTS_MAX);
        let made = match fit.elements {
            Elements::Lines => lines(ELEMENTS_MAX)?,
            Elements::Biarcs => biarcs()?,
            Elements::Fewest => {
                let biarcs = biarcs()?;
                // Lines are not tried where they take far more, and given up as soon as they are not fewer.
                let count = biarcs.len();
                if count == 1 || stretch.lines_within(curve, fit.tolerance) > LINES_HOPELESS * count as f64 {
                    biarcs
                } else {
                    match lines(count - 1) {
                        Ok(lines) => lines,
                        Err(FitError::TooMany) => biarcs,
                        Err(other) => return Err(other),
                    }
                }
            }
        };
        if elements.len() + made.len() > ELEMENTS_MAX {
            return Err(FitError::TooMany);
        }
        elements.extend(made);
        node = last;
    }
    Ok(elements)
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Shape {
    Chord,
    Biarc,
}

/// The elements of a stretch without corners, greedily the longest first.
fn pieces(
    curve: &impl Curve,
    stretch: &Stretch,
    fit: &Fit,
    [start, end]: [Point; 2],
    shape: Shape,
    count_max: usize,
) -> Result<Vec<Element>, FitError> {
    let search = Search { curve, stretch, fit, shape, end };
    let whole = stretch.length();
    let mut elements: Vec<Element> = Vec::new();
    let mut bridges = 0;
    let mut at = 0.0;
    let mut node = stretch.node(curve, 0.0);
    node.point = start;
    let mut step = whole.min(FIRST_STEP);
    while at < whole {
        let (to, made) = match search.longest(at, node, step) {
            Ok(found) => (found.to, found.pieces),
            Err(step) => {
                // Shorter than any step that could be told apart: a jump of the curve, bridged by a line.
                bridges += 1;
                if bridges > BRIDGES_MAX {
                    return Err(FitError::Lost(stretch.parameter(at)));
                }
                let to = (at + step.max(whole * 1e-12)).min(whole);
                let goal = if to >= whole { end } else { stretch.node(curve, to).point };
                (to, Pieces::chord(node.point, goal))
            }
        };
        for element in made.elements() {
            if element.start() == element.end() {
                continue;
            }
            match elements.last_mut().and_then(|last| pair::merged(last, &element)) {
                Some(one) => {
                    elements.pop();
                    elements.push(one);
                }
                None => elements.push(element),
            }
        }
        if elements.len() > count_max {
            return Err(FitError::TooMany);
        }
        step = (to - at).max(whole * 1e-6);
        at = to;
        node = stretch.node(curve, to);
        node.point = made.end();
    }
    Ok(elements)
}

/// The search for the longest piece that keeps the tolerance.
struct Search<'a, C> {
    curve: &'a C,
    stretch: &'a Stretch,
    fit: &'a Fit,
    shape: Shape,
    /// Where the stretch ends.
    end: Point,
}

/// What fits so far.
struct Good {
    to: f64,
    pieces: Pieces,
    deviation: f64,
    is_measured: bool,
}

impl<C: Curve> Search<'_, C> {
    /// The longest piece from a place on, to within four hundredths; the length of the next try where none was found.
    ///
    /// A glance at a few places finds the length; what is taken is measured.
    fn longest(&self, at: f64, node: Node, mut step: f64) -> Result<Good, f64> {
        let whole = self.stretch.length();
        let (tolerance, limit) = (self.fit.tolerance, self.fit.tolerance * MARGIN);
        let mut good: Option<Good> = None;
        // The shortest length that does not keep the tolerance, and by how much.
        let mut bad: Option<(f64, f64)> = None;
        // Tries in a row on one side of the length sought: below zero when they were too long.
        let mut side = 0;
        let mut refused = 0;
        for attempt in 0..TRIES {
            let mut to = (at + step).min(whole);
            if whole - to < 1e-9 * whole {
                to = whole;
            }
            let made = self.piece([at, to], node);
            let mut deviation =
                made.map_or(f64::INFINITY, |pieces| pieces.glance(self.curve, self.stretch, [at, to]));
            let is_long = |deviation: f64| to >= whole || deviation * GOOD_ENOUGH > tolerance;
            let mut is_measured = false;
            if let Some(pieces) = &made
                && deviation <= limit
                && (is_long(deviation) || attempt >= GLANCES)
            {
                deviation = pieces.deviation(self.curve, self.stretch, [at, to], tolerance);
                is_measured = true;
            }
            match made {
                Some(pieces) if deviation <= limit => {
                    good = Some(Good { to, pieces, deviation, is_measured });
                    side = side.max(0) + 1;
                    if is_measured && is_long(deviation) {
                        break;
                    }
                }
                _ => {
                    if bad.is_none_or(|(length, _)| to - at < length) {
                        bad = Some((to - at, deviation));
                    }
                    side = side.min(0) - 1;
                }
            }
            if let (Some(found), Some((high, _))) = (&mut good, bad)
                && high - (found.to - at) < NARROW * high
            {
                if self.is_kept(at, found) {
                    found.is_measured = true;
                    break;
                }
                // What a glance takes to fit and a measure does not, again and again, is far from fitting: about half.
                refused += 1;
                let more = if refused > 1 { 8.0 * tolerance } else { found.deviation.max(tolerance) };
                bad = Some((found.to - at, more));
                good = None;
            }
            step = self.next(good.as_ref().map(|found| (found.to - at, found.deviation)), bad, side);
            if at + step <= at {
                break;
            }
        }
        match good {
            Some(found) if self.is_kept(at, &found) => Ok(found),
            _ => Err(step),
        }
    }

    /// One piece, where there is one.
    fn piece(&self, [at, to]: [f64; 2], node: Node) -> Option<Pieces> {
        if self.shape == Shape::Biarc && self.stretch.turning(at, to) > TURN_MAX {
            return None;
        }
        let mut goal = self.stretch.node(self.curve, to);
        if to >= self.stretch.length() {
            goal.point = self.end;
        }
        match self.shape {
            Shape::Chord => Some(Pieces::chord(node.point, goal.point)),
            Shape::Biarc => {
                Pieces::biarc(self.curve, self.stretch, [at, to], [node, goal], self.fit.radius_max)
            }
        }
    }

    /// Whether it keeps the tolerance, measured if it has only been glanced at.
    fn is_kept(&self, at: f64, found: &Good) -> bool {
        let measured =
            || found.pieces.deviation(self.curve, self.stretch, [at, found.to], self.fit.tolerance);
        found.is_measured || measured() <= self.fit.tolerance * MARGIN
    }

    /// The length of the next try, from lengths that kept the tolerance and did not, and their deviations.
    fn next(&self, good: Option<(f64, f64)>, bad: Option<(f64, f64)>, side: i32) -> f64 {
        // The deviation of a biarc grows with the third power of its length, that of a chord with the second.
        let root = |deviation: f64| match self.shape {
            Shape::Chord => (deviation / self.fit.tolerance).sqrt(),
            Shape::Biarc => libm::cbrt(deviation / self.fit.tolerance),
        };
        match (good, bad) {
            (Some((low, less)), None) => low * (root(self.fit.tolerance * AIM) / root(less)).clamp(1.02, 8.0),
            (None, Some((high, more))) => {
                let least = if side < -2 { 0.5 } else { 0.95 };
                high * (root(self.fit.tolerance * AIM) / root(more)).clamp(0.2, least)
            }
            (Some((low, less)), Some((high, more))) => {
                let (below, above) = (root(less), root(more));
                // So the roots lie on a line. Where that has misled twice, the middle is taken.
                let share = (root(self.fit.tolerance * AIM) - below) / (above - below);
                let share = if side.abs() < 3 && share > 0.0 { share.clamp(0.1, 0.9) } else { 0.5 };
                low + (high - low) * share
            }
            (None, None) => self.stretch.length(),
        }
    }
}

/// The length of the first try, in steps of the walk.
const FIRST_STEP: f64 = 6.0;
/// Tries for one piece: each narrows the length; more than this find nothing better.
const TRIES: usize = 48;
/// Tries in which a glance is enough until the length is found.
const GLANCES: usize = 12;
/// Lines that are estimated to be this many times as many as biarcs are not tried: the estimate is good to a few parts in
/// ten where a curve turns unevenly.
const LINES_HOPELESS: f64 = 1.8;
/// What of the tolerance is used: a peak between the places measured is known to about a hundredth.
const MARGIN: f64 = 0.98;
/// A piece with a tolerance no larger than this times its deviation is long enough: within four hundredths.
const GOOD_ENOUGH: f64 = 1.12;
/// The deviation that is tried for, in tolerances: in the middle of what is good enough.
const AIM: f64 = 0.935;
/// A length known to within this part of itself is not narrowed further.
const NARROW: f64 = 0.04;
/// The most that a piece turns, radians: each of its arcs less than half a circle.
const TURN_MAX: f64 = 3.0;

#[cfg(test)]
mod tests;
