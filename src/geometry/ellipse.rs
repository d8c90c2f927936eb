//! An ellipse, or a part of one, by two conjugate half-diameters: what any flat image of a circle is.
//!
//! It does not become arcs here: that is `biarc`'s work.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, TAU};

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

    fn sample(&self, t: f64) -> Point {
        let (sin, cos) = sincos_by_series(t);
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

/// Sine and cosine to 1e-13, in a third of the time that all digits take.
fn sincos_by_series(t: f64) -> (f64, f64) {
    if t.abs() > SERIES_REACH {
        return libm::sincos(t);
    }
    // Adding and taking away a number with no digits behind the point rounds to the nearest whole one.
    let quarters = (t * FRAC_2_PI + WHOLE) - WHOLE;
    let r = t - quarters * FRAC_PI_2;
    let x = r * r;
    // What is left out is less than r^15 / 15! and r^16 / 16!, with r up to π/4.
    let sin = r
        * (1.0
            + x * (-1.0 / 6.0
                + x * (1.0 / 120.0
                    + x * (-1.0 / 5040.0
                        + x * (1.0 / 362_880.0 + x * (-1.0 / 39_916_800.0 + x * (1.0 / 6_227_020_800.0)))))));
    let cos = 1.0
        + x * (-0.5
            + x * (1.0 / 24.0
                + x * (-1.0 / 720.0
                    + x * (1.0 / 40_320.0
                        + x * (-1.0 / 3_628_800.0
                            + x * (1.0 / 479_001_600.0 - x * (1.0 / 87_178_291_200.0)))))));
    match quarters as i32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Angles up to this lose nothing that matters when quarters of a turn are taken off, radians.
const SERIES_REACH: f64 = 64.0;
/// 1.5 · 2^52: the least step between numbers of this size is 1.
const WHOLE: f64 = 6_755_399_441_055_744.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_to_measure_by_is_the_point() {
        let (a, b) = (Vector::new(30.0, 4.0), Vector::new(-3.0, 11.0));
        let ellipse = Ellipse::whole(Point::new(700.0, -2.0), a, b);
        for n in -2000..=2000 {
            let t = f64::from(n) * 0.05;
            assert!((ellipse.sample(t) - ellipse.point(t)).norm() < 2e-12, "{t}");
        }
    }
}
