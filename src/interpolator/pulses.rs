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

/// A step: one of the two is ±1, the other 0. What is added needs no branch, and which axis is next cannot be foretold.
type Step = (i64, i64);

#[derive(Clone, Debug)]
struct Line {
    /// The leading axis and the other, µm, and a step along each.
    lead: i64,
    other: i64,
    along: Step,
    aside: Step,
    f: i64,
}

#[derive(Clone, Debug)]
struct Arc {
    sense: Sense,
    /// Steps inward from this F on.
    inward_from: i64,
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
                let (x, y) = ((block.x.0, (quadrant.signs().0, 0)), (block.y.0, (0, quadrant.signs().1)));
                let ((lead, along), (other, aside)) = if x_leads { (x, y) } else { (y, x) };
                Way::Line(Line { lead, other, along, aside, f: 0 })
            }
            (Self::Rotated | Self::Mirrored | Self::Strict, Motion::Arc(sense, _)) => {
                let start = block.signed();
                let inward_from = i64::from(self == Self::Strict);
                Way::Arc(Arc { sense, inward_from, x: start.x.0, y: start.y.0, f: 0 })
            }
        };
        Ok(Pulses { at: Position::default(), left: block.j.0, g: block.g, way })
    }
}

impl Iterator for Pulses {
    type Item = Position;

    #[inline]
    fn next(&mut self) -> Option<Position> {
        let step = match &mut self.way {
            Way::Line(line) if self.left > 0 => line.step(),
            Way::Arc(arc) if self.left > 0 => arc.step()?,
            Way::Line(_) | Way::Arc(_) => return None,
            Way::Exact { block, target, travelled } => exact_step(block, target, travelled, self.at)?,
        };
        Some(self.go(step))
    }

    /// The same pulses, faster: what kind of way it is, is asked once a block.
    #[inline]
    fn fold<T, F: FnMut(T, Position) -> T>(mut self, first: T, mut each: F) -> T {
        let mut all = first;
        match self.way.clone() {
            Way::Line(mut line) => {
                while self.left > 0 {
                    all = each(all, self.go(line.step()));
                }
            }
            Way::Arc(mut arc) => {
                while self.left > 0
                    && let Some(step) = arc.step()
                {
                    all = each(all, self.go(step));
                }
            }
            Way::Exact { .. } => {
                for position in self {
                    all = each(all, position);
                }
            }
        }
        all
    }
}

impl Pulses {
    #[inline]
    fn go(&mut self, (x, y): Step) -> Position {
        self.at.x.0 += x;
        self.at.y.0 += y;
        self.left -= match self.g {
            Axis::X => x.abs(),
            Axis::Y => y.abs(),
        };
        self.at
    }
}

impl Line {
    #[inline]
    fn step(&mut self) -> Step {
        let leads = self.f >= 0;
        self.f += if leads { -self.other } else { self.lead };
        if leads { self.along } else { self.aside }
    }
}

impl Arc {
    /// The next step; none on the centre, which lies in no quadrant.
    #[inline]
    fn step(&mut self) -> Option<Step> {
        const LEFT: Step = (-1, 0);
        const RIGHT: Step = (1, 0);
        const UP: Step = (0, 1);
        const DOWN: Step = (0, -1);
        let (inner, outer) = match self.sense {
            Sense::CounterClockwise => match (self.x, self.y) {
                (x, y) if x > 0 && y >= 0 => (LEFT, UP),
                (x, y) if x <= 0 && y > 0 => (DOWN, LEFT),
                (x, y) if x < 0 && y <= 0 => (RIGHT, DOWN),
                (x, y) if x >= 0 && y < 0 => (UP, RIGHT),
                _ => return None,
            },
            Sense::Clockwise => match (self.x, self.y) {
                (x, y) if x >= 0 && y > 0 => (DOWN, RIGHT),
                (x, y) if x > 0 && y <= 0 => (LEFT, DOWN),
                (x, y) if x <= 0 && y < 0 => (UP, LEFT),
                (x, y) if x < 0 && y >= 0 => (RIGHT, UP),
                _ => return None,
            },
        };
        let inward = self.f >= self.inward_from;
        let step = (if inward { inner.0 } else { outer.0 }, if inward { inner.1 } else { outer.1 });
        self.f += 2 * (step.0 * self.x + step.1 * self.y) + 1;
        self.x += step.0;
        self.y += step.1;
        Some(step)
    }
}

/// A step towards where the true curve is at the next micron of travel: of the two there may be, the one nearer to it.
fn exact_step(block: &Block, target: &mut Position, travelled: &mut i64, at: Position) -> Option<Step> {
    while *target == at {
        if *travelled >= block.j.0 {
            return None;
        }
        *travelled += 1;
        // Shorter travels of a block that ends end too.
        *target = Model::Exact.displacement(&Block { j: Micrometres(*travelled), ..*block }).ok()?;
    }
    let way = *target - at;
    let (x, y) = (way.x.0.signum(), way.y.0.signum());
    let takes_x = match (way.x.0, way.y.0) {
        (_, 0) => true,
        (0, _) => false,
        (_, _) => off_curve(block, at + Position::new(x, 0)) <= off_curve(block, at + Position::new(0, y)),
    };
    Some(if takes_x { (x, 0) } else { (0, y) })
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
