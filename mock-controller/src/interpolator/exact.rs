//! The true line and the true circle, cut into 1 µm pulses.
//!
//! The end is the point of the true curve at which the travel along G reaches J, rounded to the nearest µm, halves
//! away from zero. After G has turned round at an extremum of a circle whose radius is not a whole number, both
//! coordinates of the end are rounded. In between, the pulses visit, in order, the unit squares around whole
//! coordinates that the curve itself passes through.
//!
//! Source: domain/2, the table of models, `exact`. That table gives the end only; the order of the pulses is a choice
//! made here.

use super::{Cause, Fault, Travel};
use crate::dialect::three_b::{Axis, Block, Kind, Quadrant};

/// The line through (X, Y), from its start to where G has travelled J.
///
/// A line with X = Y = 0 runs along the axis its digit stands for (+X is 1, +Y 2, −X 3, −Y 4).
pub(super) fn line(block: &Block, pulse: impl FnMut(i64, i64)) -> Result<Travel, Fault> {
    if block.j == 0 {
        return Ok(Travel::default());
    }
    let (size_x, size_y) = match (block.x, block.y, block.quadrant) {
        (0, 0, Quadrant::First | Quadrant::Third) => (1, 0),
        (0, 0, Quadrant::Second | Quadrant::Fourth) => (0, 1),
        (x, y, _) => (i128::from(x), i128::from(y)),
    };
    let (along, across) = match block.g {
        Axis::X => (size_x, size_y),
        Axis::Y => (size_y, size_x),
    };
    if along == 0 {
        return Err(Fault { cause: Cause::EndlessBlock, travel: Travel::default() });
    }
    let j = i128::from(block.j);
    // across · J / along, halves upwards: both are sizes, so upwards is away from zero.
    let other = (2 * across * j + along) / (2 * along);
    if other > OTHER_MAX_UM {
        return Err(Fault { cause: Cause::EndlessBlock, travel: Travel::default() });
    }
    let (end_x, end_y) = match block.g {
        Axis::X => (j, other),
        Axis::Y => (other, j),
    };
    let mut staircase = Staircase::new(pulse);
    let (mut x, mut y) = (0, 0);
    while (x, y) != (end_x, end_y) {
        // Does the line leave the square around (x, y) through its X side before its Y side?
        let through_x = (2 * x + 1) * size_y <= (2 * y + 1) * size_x;
        let steps_x = y == end_y || (x != end_x && through_x);
        if steps_x {
            x += 1;
            staircase.step(Axis::X, block.quadrant.signs().0);
        } else {
            y += 1;
            staircase.step(Axis::Y, block.quadrant.signs().1);
        }
    }
    Ok(staircase.travel)
}

/// The circle through (X, Y) around the origin, quadrant by quadrant, until G has travelled J.
pub(super) fn arc(block: &Block, pulse: impl FnMut(i64, i64)) -> Result<Travel, Fault> {
    if block.j == 0 {
        return Ok(Travel::default());
    }
    let Some(walk) = Walk::new(block) else {
        return Err(Fault { cause: Cause::ArcCentre, travel: Travel::default() });
    };
    let radius_squared = i128::from(block.x).pow(2) + i128::from(block.y).pow(2);
    let (sign_x, sign_y) = block.quadrant.signs();
    let (mut x, mut y) = (sign_x * i64::from(block.x), sign_y * i64::from(block.y));
    let mut staircase = Staircase::new(pulse);
    for piece in walk {
        let (end_x, end_y) = (round(piece.to.0), round(piece.to.1));
        while (x, y) != (end_x, end_y) {
            // The corner of the square around (x, y) that lies ahead: the curve leaves the square on the side of the
            // axis that moves inward if the corner lies outside the circle. Doubled, so that it is whole; the two
            // sides are never equal, since the sum of two odd squares is no multiple of 4.
            let corner_x = i128::from(2 * x + piece.step_x);
            let corner_y = i128::from(2 * y + piece.step_y);
            let outside = corner_x * corner_x + corner_y * corner_y > 4 * radius_squared;
            let steps_x = y == end_y || (x != end_x && outside == (piece.inward == Axis::X));
            if steps_x {
                x += piece.step_x;
                staircase.step(Axis::X, piece.step_x);
            } else {
                y += piece.step_y;
                staircase.step(Axis::Y, piece.step_y);
            }
        }
    }
    Ok(staircase.travel)
}

/// The one rounding rule: to the nearest, halves away from zero.
#[expect(clippy::cast_possible_truncation, reason = "a coordinate is far below 2^53 µm")]
fn round(coordinate: f64) -> i64 {
    coordinate.round() as i64
}

/// Counts the pulses and tells of them.
struct Staircase<P: FnMut(i64, i64)> {
    travel: Travel,
    pulse: P,
}

impl<P: FnMut(i64, i64)> Staircase<P> {
    fn new(pulse: P) -> Self {
        Staircase { travel: Travel::default(), pulse }
    }

    fn step(&mut self, axis: Axis, step: i64) {
        match axis {
            Axis::X => self.travel.dx += step,
            Axis::Y => self.travel.dy += step,
        }
        self.travel.pulses += 1;
        (self.pulse)(self.travel.dx, self.travel.dy);
    }
}

/// The part of an arc that lies in one quadrant, in real numbers from the centre, µm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) from: (f64, f64),
    pub(super) to: (f64, f64),
    step_x: i64,
    step_y: i64,
    /// The axis along which this quadrant's motion comes nearer to zero.
    inward: Axis,
}

/// Walks round the true circle, one quadrant a turn, until J is used up.
pub(super) struct Walk {
    clockwise: bool,
    g: Axis,
    radius: f64,
    radius_squared: f64,
    quadrant: Quadrant,
    at: (f64, f64),
    remaining: f64,
}

impl Walk {
    /// `None` if the arc's start is its centre.
    pub(super) fn new(block: &Block) -> Option<Walk> {
        let (sign_x, sign_y) = block.quadrant.signs();
        let (x, y) = (sign_x * i64::from(block.x), sign_y * i64::from(block.y));
        let clockwise = block.kind == Kind::Clockwise;
        let quadrant = if clockwise {
            match (x, y) {
                (0, 0) => return None,
                (0.., 1..) => Quadrant::First,
                (1.., ..=0) => Quadrant::Fourth,
                (..=0, ..=-1) => Quadrant::Third,
                (..=-1, 0..) => Quadrant::Second,
            }
        } else {
            match (x, y) {
                (0, 0) => return None,
                (1.., 0..) => Quadrant::First,
                (..=0, 1..) => Quadrant::Second,
                (..=-1, ..=0) => Quadrant::Third,
                (0.., ..=-1) => Quadrant::Fourth,
            }
        };
        let (x, y) = (f64::from(block.x) * sign(sign_x), f64::from(block.y) * sign(sign_y));
        let radius_squared = x * x + y * y;
        Some(Walk {
            clockwise,
            g: block.g,
            radius: radius_squared.sqrt(),
            radius_squared,
            quadrant,
            at: (x, y),
            remaining: f64::from(block.j),
        })
    }

    /// Where the motion leaves its quadrant, and the quadrant after it.
    fn exit(&self) -> ((f64, f64), Quadrant) {
        let r = self.radius;
        match (self.clockwise, self.quadrant) {
            (false, Quadrant::First) => ((0.0, r), Quadrant::Second),
            (false, Quadrant::Second) => ((-r, 0.0), Quadrant::Third),
            (false, Quadrant::Third) => ((0.0, -r), Quadrant::Fourth),
            (false, Quadrant::Fourth) => ((r, 0.0), Quadrant::First),
            (true, Quadrant::First) => ((r, 0.0), Quadrant::Fourth),
            (true, Quadrant::Fourth) => ((0.0, -r), Quadrant::Third),
            (true, Quadrant::Third) => ((-r, 0.0), Quadrant::Second),
            (true, Quadrant::Second) => ((0.0, r), Quadrant::First),
        }
    }
}

impl Iterator for Walk {
    type Item = Piece;

    fn next(&mut self) -> Option<Piece> {
        if self.remaining <= 0.0 {
            return None;
        }
        let from = self.at;
        let (exit, next) = self.exit();
        let (sign_x, sign_y) = self.quadrant.signs();
        // Inward is the axis whose exit is at zero.
        let inward = if exit.0 == 0.0 { Axis::X } else { Axis::Y };
        let (step_x, step_y) = match inward {
            Axis::X => (-sign_x, sign_y),
            Axis::Y => (sign_x, -sign_y),
        };
        let available = match self.g {
            Axis::X => (exit.0 - from.0).abs(),
            Axis::Y => (exit.1 - from.1).abs(),
        };
        let to = if self.remaining > available {
            exit
        } else {
            let other = |g: f64| (self.radius_squared - g * g).max(0.0).sqrt();
            match self.g {
                Axis::X => {
                    let x = from.0 + sign(step_x) * self.remaining;
                    (x, sign(sign_y) * other(x))
                }
                Axis::Y => {
                    let y = from.1 + sign(step_y) * self.remaining;
                    (sign(sign_x) * other(y), y)
                }
            }
        };
        self.remaining -= available;
        self.at = exit;
        self.quadrant = next;
        Some(Piece { from, to, step_x, step_y, inward })
    }
}

fn sign(step: i64) -> f64 {
    if step < 0 { -1.0 } else { 1.0 }
}

/// Most travel of a line's other axis, µm (a guess, 10 m): a flat line with the wrong G would run to the next village.
const OTHER_MAX_UM: i128 = 10_000_000;
