//! A curve as a formula: a point and a direction for every value of a parameter.
//!
//! Ellipses and splines of drawings, involutes and cams are all this to [`super::biarc`], which makes lines and arcs of
//! them. A curve knows nothing of tolerances or blocks.

use super::{Point, Vector};

/// A directed curve in the plane.
pub trait Curve {
    /// Where the parameter begins and ends; the first is the smaller.
    fn range(&self) -> [f64; 2];

    /// The point at a value of the parameter, mm.
    fn point(&self, t: f64) -> Point;

    /// The point to measure by, which may be off [`Self::point`] by a millionth of a micron and be found sooner.
    fn sample(&self, t: f64) -> Point {
        self.point(t)
    }

    /// The direction of motion at a value of the parameter, of any length; zero where the point stands still.
    fn tangent(&self, t: f64) -> Vector;

    /// Values inside the range, rising, where one formula ends and the next begins: knots, corners, the ends of dwells.
    ///
    /// Between two of them the curve is looked at in at least [`LOOKS`] places; what is narrower than that is to be
    /// announced here.
    fn seams(&self) -> &[f64] {
        &[]
    }
}

/// The least number of places in which a stretch between two seams is looked at.
pub const LOOKS: usize = 8;
