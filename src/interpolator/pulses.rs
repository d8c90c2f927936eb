//! The single pulses a control makes on its way through a block.
//!
//! Where the closed form tells the end of a block, this tells the way: one position a pulse, each 1 µm from the one before
//! along one axis, the last of them the model's [`displacement`](Model::displacement). Lines and arcs of the integer models
//! are stepped as the point-by-point comparison method steps them; `exact` has no pulses of its own, so its way is the
//! true curve, rounded anew at each micron of travel along G.
//!
//! A block that could not be run to its end is refused before its first pulse.

use super::{Fault, Model};
use crate::formats::three_b::{Axis, Block, Motion, Quadrant};
use crate::geometry::Sense;
use crate::units::{Micrometres, Position};

/// The pulses of a block: where the wire is after each, seen from the block's start.
#[derive(Clone, Debug)]
pub struct Pulses {
    at: Position,
    /// Travel along G that is left.
    left: i64,
    g: Axis,
    way: Way,
}

#[derive(Clone, Debug)]
enum Way {
    Line(Line),
    Arc(Arc),
    Exact { block: Block, target: Position, travelled: i64 },
}

#[derive(Clone, Debug)]
struct Line {
    x_leads: bool,
    /// The leading axis and the other, µm.
    lead: i64,
    other: i64,
    signs: (i64, i64),
    f: i64,
}

#[derive(Clone, Debug)]
struct Arc {
    sense: Sense,
    is_strict: bool,
    /// Seen from the centre.
    x: i64,
    y: i64,
    f: i64,
}

impl Model {
    /// The pulses of a block.
    ///
    /// # Errors
    ///
    /// As [`Model::displacement`].
    pub fn pulses(self, block: &Block) -> Result<Pulses, Fault> {
        // What the closed form can end, stepping ends too.
        self.displacement(block)?;
        let way = match (self, block.motion) {
            (Self::Exact, _) => Way::Exact { block: *block, target: Position::default(), travelled: 0 },
            (Self::Rotated | Self::Mirrored | Self::Strict, Motion::Line(quadrant)) => {
                let x_leads = self == Self::Mirrored || matches!(quadrant, Quadrant::First | Quadrant::Third);
                let (lead, other) = if x_leads { (block.x.0, block.y.0) } else { (block.y.0, block.x.0) };
                Way::Line(Line { x_leads, lead, other, signs: quadrant.signs(), f: 0 })
            }
            (Self::Rotated | Self::Mirrored | Self::Strict, Motion::Arc(sense, _)) => {
                let start = block.signed();
                Way::Arc(Arc { sense, is_strict: self == Self::Strict, x: start.x.0, y: start.y.0, f: 0 })
            }
        };
        Ok(Pulses { at: Position::default(), left: block.j.0, g: block.g, way })
    }
}

impl Iterator for Pulses {
    type Item = Position;

    #[inline]
    fn next(&mut self) -> Option<Position> {
        let (axis, sign) = match &mut self.way {
            Way::Line(line) if self.left > 0 => line.step(),
            Way::Arc(arc) if self.left > 0 => arc.step()?,
            Way::Line(_) | Way::Arc(_) => return None,
            Way::Exact { block, target, travelled } => exact_step(block, target, travelled, self.at)?,
        };
        match axis {
            Axis::X => self.at.x.0 += sign,
            Axis::Y => self.at.y.0 += sign,
        }
        self.left -= i64::from(axis == self.g);
        Some(self.at)
    }
}

impl Line {
    #[inline]
    fn step(&mut self) -> (Axis, i64) {
        let leads = self.f >= 0;
        self.f += if leads { -self.other } else { self.lead };
        if leads == self.x_leads { (Axis::X, self.signs.0) } else { (Axis::Y, self.signs.1) }
    }
}

impl Arc {
    /// The next step; none on the centre, which lies in no quadrant.
    #[inline]
    fn step(&mut self) -> Option<(Axis, i64)> {
        let (x, y) = (self.x, self.y);
        let inward = if self.is_strict { self.f > 0 } else { self.f >= 0 };
        let pick = |inner: (Axis, i64), outer: (Axis, i64)| if inward { inner } else { outer };
        let (axis, sign) = match self.sense {
            Sense::CounterClockwise => match (x, y) {
                (x, y) if x > 0 && y >= 0 => pick((Axis::X, -1), (Axis::Y, 1)),
                (x, y) if x <= 0 && y > 0 => pick((Axis::Y, -1), (Axis::X, -1)),
                (x, y) if x < 0 && y <= 0 => pick((Axis::X, 1), (Axis::Y, -1)),
                (x, y) if x >= 0 && y < 0 => pick((Axis::Y, 1), (Axis::X, 1)),
                _ => return None,
            },
            Sense::Clockwise => match (x, y) {
                (x, y) if x >= 0 && y > 0 => pick((Axis::Y, -1), (Axis::X, 1)),
                (x, y) if x > 0 && y <= 0 => pick((Axis::X, -1), (Axis::Y, -1)),
                (x, y) if x <= 0 && y < 0 => pick((Axis::Y, 1), (Axis::X, -1)),
                (x, y) if x < 0 && y >= 0 => pick((Axis::X, 1), (Axis::Y, 1)),
                _ => return None,
            },
        };
        let v = match axis {
            Axis::X => &mut self.x,
            Axis::Y => &mut self.y,
        };
        self.f += 2 * sign * *v + 1;
        *v += sign;
        Some((axis, sign))
    }
}

/// A step towards where the true curve is at the next micron of travel: of the two there may be, the one nearer to it.
fn exact_step(
    block: &Block,
    target: &mut Position,
    travelled: &mut i64,
    at: Position,
) -> Option<(Axis, i64)> {
    while *target == at {
        if *travelled >= block.j.0 {
            return None;
        }
        *travelled += 1;
        // Shorter travels of a block that ends end too.
        *target = Model::Exact.displacement(&Block { j: Micrometres(*travelled), ..*block }).ok()?;
    }
    let way = *target - at;
    let (x, y) = ((Axis::X, way.x.0.signum()), (Axis::Y, way.y.0.signum()));
    let takes_x = match (way.x.0, way.y.0) {
        (_, 0) => true,
        (0, _) => false,
        (_, _) => {
            off_curve(block, at + Position::new(x.1, 0)) <= off_curve(block, at + Position::new(0, y.1))
        }
    };
    Some(if takes_x { x } else { y })
}

/// How far a position is from a block's true curve, in a measure that only compares.
fn off_curve(block: &Block, at: Position) -> i128 {
    let square = |p: Position| {
        let (x, y) = (i128::from(p.x.0), i128::from(p.y.0));
        x * x + y * y
    };
    let way = block.signed();
    match block.motion {
        Motion::Line(_) => {
            (i128::from(way.x.0) * i128::from(at.y.0) - i128::from(way.y.0) * i128::from(at.x.0)).abs()
        }
        Motion::Arc(..) => (square(at + way) - square(way)).abs(),
    }
}
