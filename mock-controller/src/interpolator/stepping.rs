//! Integer stepping: the sign of F decides, one axis moves, J counts the steps of G.
//!
//! Lines and arcs as the tables of domain/2 print them. Per block F = 0; after the last step of G the block ends,
//! wherever the other axis is.

use super::{Cause, Fault, Travel};
use crate::dialect::three_b::{Axis, Block, Quadrant};

/// The rotated form: the lead axis is X in quadrants 1 and 3, Y in 2 and 4.
pub(super) fn line_rotated(block: &Block, cap: u64, pulse: impl FnMut(i64, i64)) -> Result<Travel, Fault> {
    let lead = match block.quadrant {
        Quadrant::First | Quadrant::Third => Axis::X,
        Quadrant::Second | Quadrant::Fourth => Axis::Y,
    };
    line(block, lead, cap, pulse)
}

/// The mirrored form of some textbooks: X always leads.
pub(super) fn line_mirrored(block: &Block, cap: u64, pulse: impl FnMut(i64, i64)) -> Result<Travel, Fault> {
    line(block, Axis::X, cap, pulse)
}

/// F ≥ 0: step the lead axis, F −= |other|; else step the other, F += |lead|.
fn line(block: &Block, lead: Axis, cap: u64, mut pulse: impl FnMut(i64, i64)) -> Result<Travel, Fault> {
    let (sign_x, sign_y) = block.quadrant.signs();
    let (size_x, size_y) = (i64::from(block.x), i64::from(block.y));
    let mut remaining = block.j;
    let mut f: i64 = 0;
    let mut travel = Travel::default();
    while remaining > 0 {
        if travel.pulses == cap {
            return Err(Fault { cause: Cause::EndlessBlock, travel });
        }
        let steps_lead = f >= 0;
        let steps_x = steps_lead == (lead == Axis::X);
        if steps_x {
            travel.dx += sign_x;
        } else {
            travel.dy += sign_y;
        }
        // The lead axis moves the point to one side of the line by the other's length, and the other way round.
        let change = if steps_x { size_y } else { size_x };
        f += if steps_lead { -change } else { change };
        travel.pulses += 1;
        pulse(travel.dx, travel.dy);
        if steps_x == (block.g == Axis::X) {
            remaining -= 1;
        }
    }
    Ok(travel)
}

/// NR: region by region of the table, looked up again at each step.
pub(super) fn counter_clockwise<const STRICT: bool>(
    block: &Block,
    cap: u64,
    pulse: impl FnMut(i64, i64),
) -> Result<Travel, Fault> {
    arc::<STRICT>(block, cap, pulse, |x, y, inward| {
        if x > 0 && y >= 0 {
            Some(if inward { (Axis::X, -1) } else { (Axis::Y, 1) })
        } else if x <= 0 && y > 0 {
            Some(if inward { (Axis::Y, -1) } else { (Axis::X, -1) })
        } else if x < 0 && y <= 0 {
            Some(if inward { (Axis::X, 1) } else { (Axis::Y, -1) })
        } else if x >= 0 && y < 0 {
            Some(if inward { (Axis::Y, 1) } else { (Axis::X, 1) })
        } else {
            None
        }
    })
}

/// SR: region by region of the table, looked up again at each step.
pub(super) fn clockwise<const STRICT: bool>(
    block: &Block,
    cap: u64,
    pulse: impl FnMut(i64, i64),
) -> Result<Travel, Fault> {
    arc::<STRICT>(block, cap, pulse, |x, y, inward| {
        if x >= 0 && y > 0 {
            Some(if inward { (Axis::Y, -1) } else { (Axis::X, 1) })
        } else if x > 0 && y <= 0 {
            Some(if inward { (Axis::X, -1) } else { (Axis::Y, -1) })
        } else if x <= 0 && y < 0 {
            Some(if inward { (Axis::Y, 1) } else { (Axis::X, -1) })
        } else if x < 0 && y >= 0 {
            Some(if inward { (Axis::X, 1) } else { (Axis::Y, 1) })
        } else {
            None
        }
    })
}

/// Stepping a coordinate v by s (±1): F += 2·s·v + 1, then v += s. (x, y) are from the centre.
#[inline(always)]
fn arc<const STRICT: bool>(
    block: &Block,
    cap: u64,
    mut pulse: impl FnMut(i64, i64),
    region: impl Fn(i64, i64, bool) -> Option<(Axis, i64)>,
) -> Result<Travel, Fault> {
    let (sign_x, sign_y) = block.quadrant.signs();
    let (start_x, start_y) = (sign_x * i64::from(block.x), sign_y * i64::from(block.y));
    let (mut x, mut y) = (start_x, start_y);
    let mut remaining = block.j;
    let mut f: i64 = 0;
    let mut pulses = 0;
    while remaining > 0 {
        let stopped = |cause| Fault { cause, travel: Travel { dx: x - start_x, dy: y - start_y, pulses } };
        if pulses == cap {
            return Err(stopped(Cause::EndlessBlock));
        }
        let inward = if STRICT { f > 0 } else { f >= 0 };
        let Some((axis, step)) = region(x, y, inward) else {
            return Err(stopped(Cause::ArcCentre));
        };
        let steps_x = axis == Axis::X;
        let stepped = if steps_x { x } else { y };
        f += 2 * step * stepped + 1;
        if steps_x {
            x += step;
        } else {
            y += step;
        }
        pulses += 1;
        pulse(x - start_x, y - start_y);
        if steps_x == (block.g == Axis::X) {
            remaining -= 1;
        }
    }
    Ok(Travel { dx: x - start_x, dy: y - start_y, pulses })
}
