//! Points, lines and arcs in the plane, in millimetres, and the directed elements a contour is made of.
//!
//! An element knows its ends exactly: the end of one and the start of the next are the same `f64` bits, so a closed
//! contour is closed by construction. Trigonometry comes from `libm`, so that the same part gives the same blocks
//! on every platform.

pub mod biarc;
pub mod curve;
pub mod ellipse;
mod measure;
pub mod offset;
pub mod path;
pub mod spline;

pub use measure::turn;
pub use path::Path;

use nalgebra::{Point2, Vector2};

/// A point in the plane, millimetres.
pub type Point = Point2<f64>;
/// A displacement in the plane, millimetres.
pub type Vector = Vector2<f64>;

/// The sense in which an arc is run.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Sense {
    /// Clockwise: 3B's SR.
    Clockwise,
    /// Counter-clockwise: 3B's NR.
    CounterClockwise,
}

impl Sense {
    /// The other sense.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Clockwise => Self::CounterClockwise,
            Self::CounterClockwise => Self::Clockwise,
        }
    }
}

/// One directed element of a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Element {
    /// A straight line from `start` to `end`.
    Line {
        /// Where it begins.
        start: Point,
        /// Where it ends.
        end: Point,
    },
    /// A circular arc from `start` to `end`; equal ends mean the full circle.
    Arc {
        /// Where it begins.
        start: Point,
        /// Where it ends.
        end: Point,
        /// The centre of its circle.
        centre: Point,
        /// The sense in which it is run.
        sense: Sense,
    },
}

impl Element {
    /// Where the element begins.
    #[must_use]
    pub fn start(&self) -> Point {
        match *self {
            Self::Line { start, .. } | Self::Arc { start, .. } => start,
        }
    }

    /// Where the element ends.
    #[must_use]
    pub fn end(&self) -> Point {
        match *self {
            Self::Line { end, .. } | Self::Arc { end, .. } => end,
        }
    }

    /// The same way run backwards.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Line { start, end } => Self::Line { start: end, end: start },
            Self::Arc { start, end, centre, sense } => {
                Self::Arc { start: end, end: start, centre, sense: sense.reversed() }
            }
        }
    }

    /// The mirror image in the Y axis (x → −x), run in the mirrored order of points.
    #[must_use]
    pub fn mirrored(self) -> Self {
        let flip = |p: Point| Point::new(-p.x, p.y);
        match self {
            Self::Line { start, end } => Self::Line { start: flip(start), end: flip(end) },
            Self::Arc { start, end, centre, sense } => Self::Arc {
                start: flip(start),
                end: flip(end),
                centre: flip(centre),
                sense: sense.reversed(),
            },
        }
    }

    /// The angle an arc sweeps, radians in (0, 2π]; 0 for a line.
    #[must_use]
    pub fn sweep(&self) -> f64 {
        match *self {
            Self::Line { .. } => 0.0,
            Self::Arc { start, end, centre, sense } => sweep(start - centre, end - centre, sense),
        }
    }
}

/// The angle from direction `from` to direction `to` in the given sense, radians in (0, 2π].
#[must_use]
pub fn sweep(from: Vector, to: Vector, sense: Sense) -> f64 {
    let cross = from.x * to.y - from.y * to.x;
    let dot = from.dot(&to);
    let turn = match sense {
        Sense::CounterClockwise => libm::atan2(cross, dot),
        Sense::Clockwise => libm::atan2(-cross, dot),
    };
    if turn > 0.0 { turn } else { turn + 2.0 * std::f64::consts::PI }
}

/// A rotation about the origin, kept as its cosine and sine so that one evaluation serves a whole tooth.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// The rotation by −2π·k/z: the k-th of z equal steps, clockwise. Steps are never accumulated.
    #[must_use]
    pub fn clockwise_step(k: u64, z: u64) -> Self {
        let angle = -2.0 * std::f64::consts::PI * ((k % z) as f64) / z as f64;
        let (sin, cos) = libm::sincos(angle);
        Self { cos, sin }
    }

    /// The image of a point.
    #[must_use]
    pub fn apply(self, p: Point) -> Point {
        Point::new(p.x * self.cos - p.y * self.sin, p.x * self.sin + p.y * self.cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_has_a_quarter_sweep_in_its_own_sense() {
        let (e, n) = (Vector::new(1.0, 0.0), Vector::new(0.0, 1.0));
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!((sweep(e, n, Sense::CounterClockwise) - quarter).abs() < 1e-15);
        assert!((sweep(e, n, Sense::Clockwise) - 3.0 * quarter).abs() < 1e-15);
    }

    #[test]
    fn equal_ends_are_a_full_circle() {
        let e = Vector::new(3.0, 4.0);
        assert!((sweep(e, e, Sense::Clockwise) - 4.0 * std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn the_last_step_of_a_full_turn_is_the_first() {
        let p = Point::new(1.25, -7.5);
        assert_eq!(Rotation::clockwise_step(36, 36).apply(p), Rotation::clockwise_step(0, 36).apply(p));
    }
}
