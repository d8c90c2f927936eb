//! Where an entity lies: the flat map from its own coordinates to the drawing's, in mm.

use crate::geometry::{Point, Vector};

use super::entity::{Facing, Insert};

/// x ↦ M x + by, M's columns being the images of the two axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) x: Vector,
    pub(super) y: Vector,
    pub(super) by: Vector,
}

impl Placement {
    /// Only made larger.
    pub(super) fn scaled(scale: f64) -> Self {
        Self { x: Vector::new(scale, 0.0), y: Vector::new(0.0, scale), by: Vector::zeros() }
    }

    pub(super) fn direction(&self, v: Vector) -> Vector {
        self.x * v.x + self.y * v.y
    }

    pub(super) fn point(&self, [x, y]: [f64; 2]) -> Point {
        Point::from(self.x * x + self.y * y + self.by)
    }

    /// First `inner`, then this.
    fn after(&self, inner: &Self) -> Self {
        Self {
            x: self.direction(inner.x),
            y: self.direction(inner.y),
            by: self.direction(inner.by) + self.by,
        }
    }

    /// That of an entity that looks up or down; none for a tilted one.
    pub(super) fn facing(&self, facing: Facing) -> Option<Self> {
        match facing {
            Facing::Up => Some(*self),
            // The arbitrary axis algorithm: X is (0, 1, 0) × N, and here it points to −X.
            Facing::Down => Some(Self { x: -self.x, ..*self }),
            Facing::Tilted => None,
        }
    }

    /// That of a block's entities in one cell of an insert; none for a tilted one.
    pub(super) fn inserted(&self, insert: &Insert, base: [f64; 2], [column, row]: [i16; 2]) -> Option<Self> {
        let outer = self.facing(insert.facing)?;
        let turn = direction(insert.rotation);
        let turned = |x: f64, y: f64| Vector::new(x * turn.x - y * turn.y, x * turn.y + y * turn.x);
        let [sx, sy] = insert.scale;
        let cell = turned(f64::from(column) * insert.spacing[0], f64::from(row) * insert.spacing[1]);
        let (x, y) = (turned(sx, 0.0), turned(0.0, sy));
        let by = Vector::new(insert.at[0], insert.at[1]) + cell - x * base[0] - y * base[1];
        Some(outer.after(&Self { x, y, by }))
    }

    /// Whether circles stay circles.
    pub(super) fn keeps_circles(&self) -> bool {
        let size = self.x.norm_squared().max(self.y.norm_squared());
        self.x.dot(&self.y).abs() <= 1e-12 * size
            && (self.x.norm_squared() - self.y.norm_squared()).abs() <= 1e-12 * size
    }

    /// Whether left becomes right.
    pub(super) fn mirrors(&self) -> bool {
        self.x.x * self.y.y - self.x.y * self.y.x < 0.0
    }

    pub(super) fn is_finite(&self) -> bool {
        [self.x, self.y, self.by].iter().all(|v| v.x.is_finite() && v.y.is_finite())
    }
}

/// The direction at an angle in degrees, counter-clockwise from +X; exact on the axes.
pub(super) fn direction(degrees: f64) -> Vector {
    let turn = libm::fmod(degrees, 360.0);
    let turn = if turn < 0.0 { turn + 360.0 } else { turn };
    match turn {
        0.0 | 360.0 => Vector::new(1.0, 0.0),
        90.0 => Vector::new(0.0, 1.0),
        180.0 => Vector::new(-1.0, 0.0),
        270.0 => Vector::new(0.0, -1.0),
        _ => {
            let (sin, cos) = libm::sincos(turn.to_radians());
            Vector::new(cos, sin)
        }
    }
}
