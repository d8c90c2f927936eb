//! The end of a straight line under each model.
//!
//! One axis leads: while F ≥ 0 it is stepped and F falls by the other coordinate, else the other is stepped and F
//! grows by the leading one; so F = (other steps)·|lead| − (lead steps)·|other|, and the count of one axis at a given
//! count of the other is a division.

use super::{Fault, Model};
use crate::formats::three_b::{Axis, Block, Quadrant};
use crate::units::Position;

pub(super) fn displacement(model: Model, block: &Block, quadrant: Quadrant) -> Result<Position, Fault> {
    let (x, y, j) = (block.x.0, block.y.0, block.j.0);
    let lead = match (model, quadrant) {
        (Model::Mirrored, _) | (_, Quadrant::First | Quadrant::Third) => Axis::X,
        (_, Quadrant::Second | Quadrant::Fourth) => Axis::Y,
    };
    let (counted, across) = match block.g {
        Axis::X => (x, y),
        Axis::Y => (y, x),
    };
    let other = match model {
        Model::Exact => exact(counted, across, j, lead == block.g)?,
        Model::Rotated | Model::Mirrored | Model::Strict if lead == block.g => {
            other_steps(counted, across, j)?
        }
        Model::Rotated | Model::Mirrored | Model::Strict => lead_steps(across, counted, j)?,
    };
    let (sx, sy) = quadrant.signs();
    Ok(match block.g {
        Axis::X => Position::new(sx * j, sy * other),
        Axis::Y => Position::new(sx * other, sy * j),
    })
}

/// Steps of the other axis before the `j`-th step of the leading one.
fn other_steps(lead: i64, other: i64, j: i64) -> Result<i64, Fault> {
    match (lead, other) {
        (_, 0) => Ok(0),
        // The first lead step makes F negative, and nothing makes it grow again.
        (0, _) if j == 1 => Ok(0),
        (0, _) => Err(Fault::Endless),
        (lead, other) => Ok(((j - 1) * other + lead - 1) / lead),
    }
}

/// Steps of the leading axis before the `j`-th step of the other.
fn lead_steps(lead: i64, other: i64, j: i64) -> Result<i64, Fault> {
    if other == 0 { Err(Fault::Endless) } else { Ok((j - 1) * lead / other + 1) }
}

/// The true line at travel `j`, the other coordinate rounded, halves away from zero.
fn exact(counted: i64, across: i64, j: i64, on_own_axis: bool) -> Result<i64, Fault> {
    match (counted, across) {
        (0, 0) if on_own_axis => Ok(0),
        (0, _) => Err(Fault::Endless),
        (counted, across) => Ok((2 * j * across + counted) / (2 * counted)),
    }
}
