//! The micron, and the one rule by which a length becomes a whole number of them.
//!
//! A 3B control counts pulses of 1 µm, so from the block on every coordinate is an integer. Geometry above the
//! block works in millimetres as `f64`; [`Micrometres::nearest`] is the only bridge, and nothing else in the
//! program rounds a length.

use std::fmt;
use std::ops::{Add, AddAssign, Neg, Sub};

/// A signed length in whole micrometres, the pulse of a 3B control.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub struct Micrometres(pub i64);

impl Micrometres {
    /// The micron nearest to a length in millimetres, halves away from zero.
    ///
    /// The remainder is dropped here; a writer that must not let it add up rounds absolute nodes, not differences.
    #[must_use]
    pub fn nearest(millimetres: f64) -> Self {
        Self((millimetres * 1000.0).round() as i64)
    }

    /// The same length in millimetres.
    #[must_use]
    pub fn millimetres(self) -> f64 {
        self.0 as f64 / 1000.0
    }

    /// The length without its sign.
    #[must_use]
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }
}

impl Add for Micrometres {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl AddAssign for Micrometres {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl Sub for Micrometres {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Neg for Micrometres {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl fmt::Display for Micrometres {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A position or displacement on the table, in micrometres.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, PartialEq)]
pub struct Position {
    /// Along the table's X.
    pub x: Micrometres,
    /// Along the table's Y.
    pub y: Micrometres,
}

impl Position {
    /// A position from whole microns.
    #[must_use]
    pub fn new(x: i64, y: i64) -> Self {
        Self { x: Micrometres(x), y: Micrometres(y) }
    }

    /// The lattice point nearest to a point in millimetres.
    #[must_use]
    pub fn nearest(point: nalgebra::Point2<f64>) -> Self {
        Self { x: Micrometres::nearest(point.x), y: Micrometres::nearest(point.y) }
    }

    /// How far the position is from a point given in millimetres; the result is in micrometres.
    #[must_use]
    pub fn distance_um(self, point: nalgebra::Point2<f64>) -> f64 {
        let dx = self.x.0 as f64 - point.x * 1000.0;
        let dy = self.y.0 as f64 - point.y * 1000.0;
        (dx * dx + dy * dy).sqrt()
    }
}

impl Add for Position {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl AddAssign for Position {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Position {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_round_away_from_zero() {
        assert_eq!(Micrometres::nearest(0.0005), Micrometres(1));
        assert_eq!(Micrometres::nearest(-0.0005), Micrometres(-1));
        assert_eq!(Micrometres::nearest(0.000_499_9), Micrometres(0));
        assert_eq!(Micrometres::nearest(6.6424), Micrometres(6642));
    }
}
