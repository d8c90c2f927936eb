//! What a control does with one block: pulses, 1 µm each, one axis at a time.
//!
//! No maker says which variant of the point-by-point comparison method a given control runs, so there are four
//! [`Model`]s. All are carried out as steps, slowly and obviously, never by the closed form: this is the thing
//! cleverer code is compared with.
//!
//! It knows one block at a time, keeps no absolute position, and never snaps to a nominal end.
//!
//! Source: domain/2, "Execution: the point-by-point comparison method".

pub mod exact;
pub mod length;
pub mod stepping;

use std::fmt;

use crate::dialect::three_b::{Block, Kind};

/// How a control's interpolator behaves. Unverified for any control: a value to be chosen, and tried.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, PartialEq)]
pub enum Model {
    /// Lines lead with X in quadrants 1 and 3, with Y in 2 and 4; arcs step inward when F ≥ 0.
    #[default]
    Rotated,
    /// Lines always lead with X; arcs as `Rotated`.
    Mirrored,
    /// Lines as `Rotated`; arcs step inward only when F > 0.
    Strict,
    /// The true line and the true circle, ended where the travel along G reaches J, the end rounded to the nearest
    /// µm, halves away from zero.
    Exact,
}

/// Where a block ended, from where it began.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Travel {
    /// Along X, µm.
    pub dx: i64,
    /// Along Y, µm.
    pub dy: i64,
    /// Steps taken, one axis and 1 µm each.
    pub pulses: u64,
}

/// Why a block could not be carried out.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Cause {
    /// The step cap was reached before J was used up.
    EndlessBlock,
    /// An arc stands on its own centre, which lies in no region.
    ArcCentre,
}

/// A block that stopped before J was used up, and how far it had come.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Fault {
    /// Why.
    pub cause: Cause,
    /// What had been stepped until then.
    pub travel: Travel,
}

impl Cause {
    /// The alarm's name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Cause::EndlessBlock => "endless-block",
            Cause::ArcCentre => "arc-centre",
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} after {} pulses", self.cause, self.travel.pulses)
    }
}

impl std::error::Error for Fault {}

/// Carries out one block. `pulse` is told the place after each step, in µm from where the block began.
///
/// # Errors
///
/// [`Fault`] when the block reaches [`step_cap`], or an arc stands on its centre.
pub fn run(model: Model, block: &Block, pulse: impl FnMut(i64, i64)) -> Result<Travel, Fault> {
    let cap = step_cap(block);
    match (model, block.kind) {
        (Model::Rotated | Model::Strict, Kind::Line) => stepping::line_rotated(block, cap, pulse),
        (Model::Mirrored, Kind::Line) => stepping::line_mirrored(block, cap, pulse),
        (Model::Rotated | Model::Mirrored, Kind::Clockwise) => {
            stepping::clockwise::<false>(block, cap, pulse)
        }
        (Model::Rotated | Model::Mirrored, Kind::CounterClockwise) => {
            stepping::counter_clockwise::<false>(block, cap, pulse)
        }
        (Model::Strict, Kind::Clockwise) => stepping::clockwise::<true>(block, cap, pulse),
        (Model::Strict, Kind::CounterClockwise) => stepping::counter_clockwise::<true>(block, cap, pulse),
        (Model::Exact, Kind::Line) => exact::line(block, pulse),
        (Model::Exact, Kind::Clockwise | Kind::CounterClockwise) => exact::arc(block, pulse),
    }
}

/// Most steps a block may take.
///
/// A right block takes at most about J + X + Y of them; a block whose G can never step would take for ever. The factor
/// is a guess, large enough to let a mildly wrong block run off as it would on a real table; but 20 m beyond what J
/// allows are beyond any machine.
#[must_use]
pub fn step_cap(block: &Block) -> u64 {
    let j = u64::from(block.j);
    let mildly_wrong = 64 * (u64::from(block.x) + u64::from(block.y) + j) + 1024;
    mildly_wrong.min(8 * j + 20_000_000)
}
