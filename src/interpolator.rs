//! Where a control ends up after a block, known without stepping.
//!
//! A 3B control moves by the point-by-point comparison method: one pulse at a time, no final snap. No maker documents
//! which variant a given control runs, so the variant is a [`Model`], a value of the machine profile, *unverified*
//! until a calibration cut settles it. The end of a block follows in closed form from `F = x² + y² − R²`, which holds
//! at every step of an arc, so the cost of a block does not grow with its length; the tests prove the closed form
//! against stepping. Individual pulses are not here.

mod arc;
mod line;

use thiserror::Error;

use crate::formats::three_b::{Block, Motion};
use crate::units::Position;

pub use arc::{Bend, Branch};

/// The coordinate beyond which a block is refused, so that squares stay within 64 bits: 1 km.
pub const COORDINATE_MAX: i64 = 1_000_000_000;

/// A variant of the point-by-point comparison method.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Model {
    /// Lines led by X in L1, L3 and by Y in L2, L4; arcs step inward when F ≥ 0.
    Rotated,
    /// Lines always led by X; arcs as `Rotated`.
    Mirrored,
    /// As `Rotated`, but arcs step inward only when F > 0.
    Strict,
    /// The true line or circle, ended where the travel along G reaches J, then rounded to the micron.
    Exact,
}

impl Model {
    /// Every model, in the order they are reported.
    pub const ALL: [Self; 4] = [Self::Rotated, Self::Mirrored, Self::Strict, Self::Exact];

    /// The name used on the command line and in profiles.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rotated => "rotated",
            Self::Mirrored => "mirrored",
            Self::Strict => "strict",
            Self::Exact => "exact",
        }
    }

    /// How the model bends round a circle.
    #[must_use]
    pub fn bend(self) -> Bend {
        match self {
            Self::Rotated | Self::Mirrored => Bend::Inward,
            Self::Strict => Bend::Outward,
            Self::Exact => Bend::True,
        }
    }

    /// The displacement the block makes under this model.
    ///
    /// # Errors
    ///
    /// When the block can never use up its count, steps onto the centre, or is larger than [`COORDINATE_MAX`].
    pub fn displacement(self, block: &Block) -> Result<Position, Fault> {
        if block.x.0.max(block.y.0).max(block.j.0) > COORDINATE_MAX {
            return Err(Fault::TooLarge);
        }
        if block.j.0 == 0 {
            return Ok(Position::default());
        }
        match block.motion {
            Motion::Line(quadrant) => line::displacement(self, block, quadrant),
            Motion::Arc(sense, _) => Branch::at(block.signed(), sense)
                .and_then(|branch| branch.travel(self.bend(), block.g, block.j.0)),
        }
    }
}

/// Whether a control of the `rotated` model can run a block to its end: what [`Model::displacement`] finds out, without
/// working out where that end is. The block's numbers are taken to be within [`COORDINATE_MAX`].
#[must_use]
#[inline]
pub fn comes_to_an_end(block: &Block) -> bool {
    match block.motion {
        // A line that steps its counting axis at all uses up any count; an arc of more than a micron goes round for ever.
        Motion::Line(_) if block.counted().0 != 0 => true,
        Motion::Arc(..) if block.x.0 + block.y.0 > 1 => true,
        Motion::Line(_) | Motion::Arc(..) => Model::Rotated.displacement(block).is_ok(),
    }
}

/// Why a block cannot be run to its end.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// The counting axis is never stepped, so the control would run for ever.
    #[error("the block never moves along its counting axis, so it would never end")]
    Endless,
    /// The path reaches the arc's centre, which lies in no quadrant.
    #[error("the arc is so small that it steps onto its own centre")]
    Centre,
    /// A number is beyond [`COORDINATE_MAX`].
    #[error("a number of the block is beyond 1 000 000 000 µm")]
    TooLarge,
}

#[cfg(test)]
mod tests;
