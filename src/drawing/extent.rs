//! An upright rectangle in millimetres, Y up.
//!
//! Windows, frames, bounds and clips are all of this one kind. It is never empty inside out: `min` is the lower left
//! corner and `max` the upper right one, and a single point is an extent without size. It knows no rotation.

/// An upright rectangle: lower left and upper right corner, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The lower left corner.
    pub min: [f64; 2],
    /// The upper right corner.
    pub max: [f64; 2],
}

impl Extent {
    /// Returns the extent that spans two corners, given in any order.
    #[must_use]
    pub fn between(a: [f64; 2], b: [f64; 2]) -> Self {
        Self { min: [a[0].min(b[0]), a[1].min(b[1])], max: [a[0].max(b[0]), a[1].max(b[1])] }
    }

    /// Returns the extent with its lower left corner at `corner`.
    #[must_use]
    pub fn sized(corner: [f64; 2], width: f64, height: f64) -> Self {
        Self::between(corner, [corner[0] + width, corner[1] + height])
    }

    /// Returns the extent of the given size around `centre`.
    #[must_use]
    pub fn around(centre: [f64; 2], width: f64, height: f64) -> Self {
        Self::sized([centre[0] - width / 2.0, centre[1] - height / 2.0], width, height)
    }

    /// Returns the smallest extent that holds every point; nothing for no points.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = [f64; 2]>) -> Option<Self> {
        points.into_iter().map(|p| Self { min: p, max: p }).reduce(Self::united)
    }

    /// Width in millimetres.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.max[0] - self.min[0]
    }

    /// Height in millimetres.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.max[1] - self.min[1]
    }

    /// The centre.
    #[must_use]
    pub fn centre(&self) -> [f64; 2] {
        [(self.min[0] + self.max[0]) / 2.0, (self.min[1] + self.max[1]) / 2.0]
    }

    /// Returns the extent with a margin of `by` millimetres on each side.
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        Self { min: [self.min[0] - by, self.min[1] - by], max: [self.max[0] + by, self.max[1] + by] }
    }

    /// Returns the smallest extent that holds both.
    #[must_use]
    pub fn united(self, other: Self) -> Self {
        Self {
            min: [self.min[0].min(other.min[0]), self.min[1].min(other.min[1])],
            max: [self.max[0].max(other.max[0]), self.max[1].max(other.max[1])],
        }
    }

    /// Says whether the two have a point in common, edges included.
    #[must_use]
    pub fn touches(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_may_be_given_in_any_order() {
        let extent = Extent::between([3.0, -1.0], [-2.0, 4.0]);
        assert_eq!(extent, Extent { min: [-2.0, -1.0], max: [3.0, 4.0] });
        assert_eq!((extent.width(), extent.height(), extent.centre()), (5.0, 5.0, [0.5, 1.5]));
    }

    #[test]
    fn extents_that_share_an_edge_touch_and_those_apart_do_not() {
        let left = Extent::sized([0.0, 0.0], 1.0, 1.0);
        assert!(left.touches(&Extent::sized([1.0, 0.0], 1.0, 1.0)));
        assert!(!left.touches(&Extent::sized([1.1, 0.0], 1.0, 1.0)));
        assert!(left.grown(0.2).touches(&Extent::sized([1.1, 0.0], 1.0, 1.0)));
    }

    #[test]
    fn no_points_have_no_extent() {
        assert_eq!(Extent::of([]), None);
    }
}
