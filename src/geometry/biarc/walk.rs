//! A walk along a curve: values of the parameter close enough that between two of them it hardly turns, cut where it has
//! a corner or a cusp.
//!
//! Pieces are then measured in steps of the walk instead of the curve's own parameter, whatever its speed.

use crate::geometry::curve::{Curve, LOOKS};
use crate::geometry::{Point, Vector, turn};

use super::FitError;

/// All of a curve, in stretches without corners.
#[derive(Debug)]
pub(super) struct Walk {
    start: Point,
    stretches: Vec<Stretch>,
}

/// A part of a curve without corners.
#[derive(Debug)]
pub(super) struct Stretch {
    /// Values of the parameter, rising.
    t: Vec<f64>,
    /// How far the curve has turned at each, either way, radians.
    turned: Vec<f64>,
    /// The directions at both ends, seen from within.
    headings: [Vector; 2],
}

/// A point of a curve and its direction there, of length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) point: Point,
    pub(super) heading: Vector,
}

impl Walk {
    pub(super) fn along(curve: &impl Curve) -> Result<Self, FitError> {
        let [from, to] = curve.range();
        if !(from < to && (to - from).is_finite()) {
            return Err(FitError::Range(from, to));
        }
        let mut marks = vec![from];
        marks.extend(curve.seams().iter().copied().filter(|&t| from < t && t < to));
        marks.push(to);
        marks.dedup();
        let looks = LOOKS.max(LOOKS_WHOLE.div_ceil(marks.len()));
        let mut stretches = Vec::new();
        let mut look = Look { curve, width_min: (to - from) * WIDTH_MIN, t: vec![], turned: vec![] };
        let mut first = look.heading(from, (to - from) * NEAR);
        look.begin(from)?;
        for (n, pair) in marks.windows(2).enumerate() {
            let [low, high] = [pair[0], pair[1]];
            let near = (high - low) * NEAR;
            if n > 0 {
                let (before, after) = (look.heading(low, -near), look.heading(low, near));
                if angle(before, after) > CORNER {
                    look.end(&mut stretches, [first, before]);
                    look.begin(low)?;
                    first = after;
                }
            }
            let mut left = (low, look.heading(low, near));
            for k in 1..=looks {
                let at = if k == looks { high } else { low + (high - low) * k as f64 / looks as f64 };
                let side = if k == looks { -near } else { near };
                let right = (at, look.heading(at, side));
                look.between(left, right, &mut stretches, &mut first)?;
                left = right;
            }
        }
        let last = look.heading(to, -(to - from) * NEAR);
        look.end(&mut stretches, [first, last]);
        Ok(Self { start: curve.point(from), stretches })
    }

    pub(super) fn start(&self) -> Point {
        self.start
    }

    /// The greatest distance of a point of the walk from the start, along an axis; that of the start itself from zero,
    /// where it is beyond all measure.
    pub(super) fn reach(&self, curve: &impl Curve) -> f64 {
        let far = |v: Vector| v.x.abs().max(v.y.abs());
        let steps = self.stretches.iter().flat_map(|stretch| &stretch.t);
        let reach = steps.map(|&t| far(curve.point(t) - self.start)).fold(0.0, f64::max);
        if far(self.start.coords) > super::FAR { far(self.start.coords) } else { reach }
    }

    pub(super) fn stretches(&self) -> impl Iterator<Item = &Stretch> {
        self.stretches.iter()
    }
}

impl Stretch {
    /// How many steps it is long.
    pub(super) fn length(&self) -> f64 {
        (self.t.len() - 1) as f64
    }

    /// The parameter at a step.
    pub(super) fn parameter(&self, step: f64) -> f64 {
        let n = (step.max(0.0) as usize).min(self.t.len() - 2);
        let share = step - n as f64;
        self.t[n] + (self.t[n + 1] - self.t[n]) * share
    }

    /// The point and direction at a step.
    pub(super) fn node(&self, curve: &impl Curve, step: f64) -> Node {
        let t = self.parameter(step);
        let heading = if step <= 0.0 {
            self.headings[0]
        } else if step >= self.length() {
            self.headings[1]
        } else {
            unit(curve.tangent(t)).unwrap_or_else(|| {
                let near = (self.t[self.t.len() - 1] - self.t[0]) * NEAR;
                unit(curve.tangent(t + near)).unwrap_or(self.headings[0])
            })
        };
        Node { point: curve.point(t), heading }
    }

    /// About how many lines it takes within a tolerance: one whose curve bows out by κ·s²/8 is s long.
    pub(super) fn lines_within(&self, curve: &impl Curve, tolerance: f64) -> f64 {
        let mut last = curve.sample(self.t[0]);
        let mut count = 0.0;
        for (t, turned) in self.t.windows(2).zip(self.turned.windows(2)) {
            let next = curve.sample(t[1]);
            count += ((turned[1] - turned[0]) * (next - last).norm() / (8.0 * tolerance)).sqrt();
            last = next;
        }
        count
    }

    /// How far the curve turns from one step to another, radians, at least.
    pub(super) fn turning(&self, from: f64, to: f64) -> f64 {
        let (low, high) = (from.ceil() as usize, to.floor() as usize);
        if low < high { self.turned[high.min(self.turned.len() - 1)] - self.turned[low] } else { 0.0 }
    }
}

/// The walk as it is made.
struct Look<'a, C> {
    curve: &'a C,
    width_min: f64,
    t: Vec<f64>,
    turned: Vec<f64>,
}

impl<C: Curve> Look<'_, C> {
    fn begin(&mut self, t: f64) -> Result<(), FitError> {
        self.t = vec![t];
        self.turned = vec![0.0];
        self.finite(t)
    }

    fn end(&mut self, stretches: &mut Vec<Stretch>, headings: [Vector; 2]) {
        if self.t.len() > 1 {
            let (t, turned) = (std::mem::take(&mut self.t), std::mem::take(&mut self.turned));
            stretches.push(Stretch { t, turned, headings });
        }
    }

    /// Notes what lies between two values, in steps of little turn; a jump of the direction ends the stretch.
    fn between(
        &mut self,
        left: (f64, Vector),
        right: (f64, Vector),
        stretches: &mut Vec<Stretch>,
        first: &mut Vector,
    ) -> Result<(), FitError> {
        let turned = angle(left.1, right.1);
        let middle = 0.5 * (left.0 + right.0);
        let narrow = right.0 - left.0 <= self.width_min || middle <= left.0 || right.0 <= middle;
        let half = (middle, self.heading(middle, (right.0 - left.0) * NEAR));
        // A step that turns at one end only would be measured too coarsely there.
        let halves = [angle(left.1, half.1), angle(half.1, right.1)];
        let uneven = halves[0].max(halves[1]) > EVEN_TURN + UNEVEN * halves[0].min(halves[1]);
        if !(turned > STEP_TURN || uneven) || narrow || self.t.len() > STEPS_MAX {
            if turned > STEP_TURN && narrow {
                // The jump lies between the two values: what is before it ends, what is after it begins.
                self.note(right.0, 0.0)?;
                self.end(stretches, [*first, left.1]);
                self.begin(right.0)?;
                *first = right.1;
                return Ok(());
            }
            return self.note(right.0, turned);
        }
        self.between(left, half, stretches, first)?;
        self.between(half, right, stretches, first)
    }

    fn note(&mut self, t: f64, angle: f64) -> Result<(), FitError> {
        self.finite(t)?;
        self.turned.push(self.turned[self.turned.len() - 1] + angle);
        self.t.push(t);
        Ok(())
    }

    fn finite(&self, t: f64) -> Result<(), FitError> {
        let p = self.curve.point(t);
        if p.x.is_finite() && p.y.is_finite() { Ok(()) } else { Err(FitError::NotFinite(t)) }
    }

    /// The direction at a value; where the point stands still, a little further on.
    fn heading(&self, t: f64, near: f64) -> Vector {
        let at = self.curve.tangent(t);
        let beside = || self.curve.tangent(t + near);
        let far = || self.curve.point(t + near * 1e4) - self.curve.point(t);
        unit(at)
            .or_else(|| unit(beside()))
            .or_else(|| unit(far()).map(|way| if near < 0.0 { -way } else { way }))
            .unwrap_or_else(Vector::zeros)
    }
}

/// The angle between two directions of length 1, radians; a small one by its sine, to a few ten-thousandths of it.
fn angle(a: Vector, b: Vector) -> f64 {
    let sine = (a.x * b.y - a.y * b.x).abs();
    if a.dot(&b) > 0.9 {
        sine * (1.0 + sine * sine * (1.0 / 6.0 + sine * sine * 0.075))
    } else {
        turn(a, b).abs()
    }
}

/// A direction of length 1; none for one too short to have a direction.
fn unit(way: Vector) -> Option<Vector> {
    let length = way.norm();
    (length > STILL && length.is_finite()).then(|| way / length)
}

/// A tangent shorter than this has no direction, mm per unit of the parameter.
const STILL: f64 = 1e-12;
/// How near beside a place its one-sided direction is taken, of the width looked at.
const NEAR: f64 = 1e-9;
/// The least number of places looked at on a whole curve.
const LOOKS_WHOLE: usize = 48;
/// The most that a curve turns in a step, radians.
const STEP_TURN: f64 = 0.25;
/// How uneven the turns of the two halves of a step may be, and what turn never matters, radians.
const UNEVEN: f64 = 2.0;
const EVEN_TURN: f64 = 0.02;
/// A turn at a seam from which on it is a corner, radians.
const CORNER: f64 = 1e-6;
/// A step of this share of the range in which the curve still turns is a jump of its direction.
const WIDTH_MIN: f64 = 1e-11;
/// More steps than this are not taken apart further.
const STEPS_MAX: usize = 1 << 20;
