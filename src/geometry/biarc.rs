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
use walk::{Stretch, Walk};

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
    #[error("the curve has no finite point at parameter {0}")]
    NotFinite(f64),
    /// The curve goes where no length is measured.
    #[error("the curve leads to a point {0:e} mm out")]
    Far(f64),
    /// Neither lines nor arcs follow it.
    #[error("the curve cannot be followed at parameter {0}")]
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
    // The deviation of a biarc grows with the third power of its length, that of a chord with the second.
    let root = |ratio: f64| match shape {
        Shape::Chord => ratio.sqrt(),
        Shape::Biarc => libm::cbrt(ratio),
    };
    let whole = stretch.length();
    let mut elements: Vec<Element> = Vec::new();
    let mut bridges = 0;
    let mut at = 0.0;
    let mut node = stretch.node(curve, 0.0);
    node.point = start;
    let mut step = whole.min(FIRST_STEP);
    while at < whole {
        let mut good: Option<Good> = None;
        let mut bad = whole;
        let mut bad_seen = false;
        let limit = fit.tolerance * MARGIN;
        let ratio_of = |deviation: f64| fit.tolerance / deviation.max(fit.tolerance * 1e-6);
        for attempt in 0..TRIES {
            let mut to = (at + step).min(whole);
            if whole - to < 1e-9 * whole {
                to = whole;
            }
            let mut goal = stretch.node(curve, to);
            if to >= whole {
                goal.point = end;
            }
            let made = match shape {
                Shape::Chord => Some(Pieces::chord(node.point, goal.point)),
                Shape::Biarc if stretch.turning(at, to) > TURN_MAX => None,
                Shape::Biarc => Pieces::biarc(curve, stretch, [at, to], [node, goal], fit.radius_max),
            };
            // A glance finds the length; what is taken is measured.
            let measured = |pieces: &Pieces| pieces.deviation(curve, stretch, [at, to], fit.tolerance);
            let long_enough = |deviation: f64| to >= whole || ratio_of(deviation) < GOOD_ENOUGH;
            let mut is_measured = attempt >= GLANCES;
            let mut deviation = match &made {
                None => f64::INFINITY,
                Some(pieces) if is_measured => measured(pieces),
                Some(pieces) => pieces.glance(curve, stretch, [at, to]),
            };
            if let Some(pieces) = &made
                && !is_measured
                && deviation <= limit
                && long_enough(deviation)
            {
                (deviation, is_measured) = (measured(pieces), true);
            }
            let ratio = ratio_of(deviation);
            match made {
                Some(pieces) if deviation <= limit => {
                    good = Some(Good { to, pieces, is_measured });
                    if is_measured && long_enough(deviation) {
                        break;
                    }
                    step = (to - at) * (root(ratio) * 0.985).clamp(1.02, 8.0);
                }
                _ => {
                    bad = bad.min(to);
                    bad_seen = true;
                    let guess = if ratio > 0.0 { root(ratio) * 0.97 } else { 0.0 };
                    step = (to - at) * guess.clamp(0.2, 0.95);
                }
            }
            if bad_seen {
                // Between what was good and what was not.
                let high = bad - at;
                if let Some(found) = &mut good
                    && high - (found.to - at) < 0.04 * high
                {
                    if found.is_kept(curve, stretch, at, fit.tolerance) {
                        found.is_measured = true;
                        break;
                    }
                    bad = found.to;
                    good = None;
                }
                let high = bad - at;
                let low = good.as_ref().map_or(0.0, |found| found.to - at);
                if !(low < step && step < high) {
                    step = 0.5 * (low + high);
                }
            }
            if at + step <= at {
                break;
            }
        }
        let (to, made) = match good {
            Some(found) if found.is_kept(curve, stretch, at, fit.tolerance) => (found.to, found.pieces),
            _ => {
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

/// What fits so far, from where the last piece ended.
struct Good {
    to: f64,
    pieces: Pieces,
    is_measured: bool,
}

impl Good {
    /// Whether it keeps the tolerance, measured if it has only been glanced at.
    fn is_kept(&self, curve: &impl Curve, stretch: &Stretch, at: f64, tolerance: f64) -> bool {
        self.is_measured
            || self.pieces.deviation(curve, stretch, [at, self.to], tolerance) <= tolerance * MARGIN
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
/// The most that a piece turns, radians: each of its arcs less than half a circle.
const TURN_MAX: f64 = 3.0;

#[cfg(test)]
mod tests;
