//! An ellipse, or a part of one, by two conjugate half-diameters: what any flat image of a circle is.
//!
//! It does not become arcs here: that is `biarc`'s work.

use std::f64::consts::TAU;

use super::curve::Curve;
use super::{Point, Vector};

/// The points `centre + a cos t + b sin t`, for t from `from` to `to`, radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipse {
    /// The centre.
    pub centre: Point,
    /// From the centre to the point at t = 0.
    pub a: Vector,
    /// From the centre to the point at t = π/2; conjugate to `a`, not always square to it.
    pub b: Vector,
    /// Where t begins.
    pub from: f64,
    /// Where t ends, greater than `from`.
    pub to: f64,
    /// The quarters of the way, so that each is looked at for itself.
    seams: [f64; 3],
}

impl Ellipse {
    /// A part of an ellipse; an end no greater than the start is taken a turn further on.
    #[must_use]
    pub fn new(centre: Point, a: Vector, b: Vector, from: f64, to: f64) -> Self {
        let mut sweep = libm::fmod(to - from, TAU);
        // The rounding of degrees into radians is no turn of its own.
        if sweep <= 1e-12 {
            sweep += TAU;
        }
        let seams = [0.25, 0.5, 0.75].map(|part| from + sweep * part);
        Self { centre, a, b, from, to: from + sweep, seams }
    }

    /// A whole ellipse, counter-clockwise when `b` lies to the left of `a`.
    #[must_use]
    pub fn whole(centre: Point, a: Vector, b: Vector) -> Self {
        Self::new(centre, a, b, 0.0, TAU)
    }

    /// Whether it goes all the way round.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.to - self.from >= TAU - 1e-12
    }
}

impl Curve for Ellipse {
    fn range(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    fn point(&self, t: f64) -> Point {
        let (sin, cos) = libm::sincos(t);
        self.centre + self.a * cos + self.b * sin
    }

    fn tangent(&self, t: f64) -> Vector {
        let (sin, cos) = libm::sincos(t);
        self.b * cos - self.a * sin
    }

    fn seams(&self) -> &[f64] {
        &self.seams
    }
}
