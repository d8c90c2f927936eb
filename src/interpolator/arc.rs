//! The end of an arc under each model, quadrant by quadrant.
//!
//! Every quadrant of NR and SR is the same picture turned or mirrored: `u` falls to 0 while `v` grows. Within it a
//! column `c` is left at the first `v` where the point (c, v) no longer lies inside the circle, and a row `r` at the
//! first `u` where (u, r) does; both are square roots. A block runs through at most five quadrants after whole turns
//! have been taken off its count.

use super::Fault;
use crate::formats::three_b::Axis;
use crate::geometry::Sense;
use crate::units::Position;

/// How a model bends round its circle: what it does where F = 0.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Bend {
    /// Steps inward when F ≥ 0.
    Inward,
    /// Steps inward only when F > 0.
    Outward,
    /// Runs on the true circle; ends are rounded to the micron, halves away from zero.
    True,
}

/// One quadrant's share of a circle: the point (u, v) with u falling and v growing.
#[derive(Clone, Copy, Debug)]
pub struct Branch {
    start: Position,
    sense: Sense,
    /// How many quarter turns counter-clockwise the branch lies from that of NR1 (NR), or of SR1 (SR).
    quarter: u8,
    u: i64,
    v: i64,
    rr: i64,
}

impl Branch {
    /// The branch on which an arc starting at `start` (from its centre) runs first.
    ///
    /// # Errors
    ///
    /// [`Fault::Centre`] when the arc has no radius.
    pub fn at(start: Position, sense: Sense) -> Result<Self, Fault> {
        let (quarter, u, v) = Self::frame(start, sense).ok_or(Fault::Centre)?;
        let (x, y) = (start.x.0, start.y.0);
        Ok(Self { start, sense, quarter, u, v, rr: x * x + y * y })
    }

    /// The quarter and the (u, v) of a point seen from the centre; none at the centre itself.
    #[must_use]
    pub fn frame(point: Position, sense: Sense) -> Option<(u8, i64, i64)> {
        // SR is NR with x and y exchanged.
        let (a, b) = match sense {
            Sense::CounterClockwise => (point.x.0, point.y.0),
            Sense::Clockwise => (point.y.0, point.x.0),
        };
        match (a, b) {
            (a, b) if a > 0 && b >= 0 => Some((0, a, b)),
            (a, b) if a <= 0 && b > 0 => Some((1, b, -a)),
            (a, b) if a < 0 && b <= 0 => Some((2, -a, -b)),
            (a, b) if a >= 0 && b < 0 => Some((3, -b, a)),
            _ => None,
        }
    }

    /// The point (u, v) of a quarter, seen from the centre.
    fn unframe(&self, quarter: u8, u: i64, v: i64) -> Position {
        let (a, b) = match quarter & 3 {
            0 => (u, v),
            1 => (-v, u),
            2 => (-u, -v),
            _ => (v, -u),
        };
        match self.sense {
            Sense::CounterClockwise => Position::new(a, b),
            Sense::Clockwise => Position::new(b, a),
        }
    }

    /// Whether `g` is the axis that falls (u) in the quarter.
    fn counts_u(&self, quarter: u8, g: Axis) -> bool {
        let even = quarter & 1 == 0;
        match (self.sense, g) {
            (Sense::CounterClockwise, Axis::X) | (Sense::Clockwise, Axis::Y) => even,
            (Sense::CounterClockwise, Axis::Y) | (Sense::Clockwise, Axis::X) => !even,
        }
    }

    /// The displacement after a travel of `j` > 0 along `g`.
    ///
    /// # Errors
    ///
    /// [`Fault::Centre`] when the path reaches the centre.
    pub fn travel(&self, bend: Bend, g: Axis, j: i64) -> Result<Position, Fault> {
        let end = match bend {
            Bend::Inward => self.walk::<false>(j, g)?,
            Bend::Outward => self.walk::<true>(j, g)?,
            Bend::True => self.walk_true(j, g),
        };
        Ok(end - self.start)
    }

    fn walk<const OUTWARD: bool>(&self, j: i64, g: Axis) -> Result<Position, Fault> {
        let (mut quarter, mut u, mut v, mut j) = (self.quarter, self.u, self.v, j);
        // Every quadrant is left at the same height: that of the column next to the axis.
        let top = rise::<OUTWARD>(self.rr, 1);
        let mut whole_turns_taken_off = false;
        loop {
            let travel = if self.counts_u(quarter, g) {
                if j <= u {
                    return Ok(self.unframe(quarter, u - j, v.max(rise::<OUTWARD>(self.rr, u - j + 1))));
                }
                u
            } else {
                if j <= top - v {
                    return Ok(self.unframe(quarter, u.min(fall::<OUTWARD>(self.rr, v + j - 1)), v + j));
                }
                top - v
            };
            if top == 0 {
                return Err(Fault::Centre);
            }
            j -= travel;
            if !whole_turns_taken_off {
                // From an axis on, a whole turn counts four times the height and comes back to the same point.
                j = (j - 1) % (4 * top) + 1;
                whole_turns_taken_off = true;
            }
            quarter = (quarter + 1) & 3;
            (u, v) = (top, 0);
        }
    }

    fn walk_true(&self, j: i64, g: Axis) -> Position {
        let rr = self.rr as f64;
        let radius = rr.sqrt();
        let (mut quarter, mut u, mut v) = (self.quarter, self.u as f64, self.v as f64);
        let mut j = j as f64;
        loop {
            let counts_u = self.counts_u(quarter, g);
            let travel = if counts_u { u } else { radius - v };
            if j <= travel {
                if counts_u {
                    u -= j;
                    v = (rr - u * u).max(0.0).sqrt();
                } else {
                    v += j;
                    u = (rr - v * v).max(0.0).sqrt();
                }
                return self.unframe(quarter, u.round() as i64, v.round() as i64);
            }
            j -= travel;
            if j > 4.0 * radius {
                j -= (j / (4.0 * radius)).floor() * 4.0 * radius;
            }
            quarter = (quarter + 1) & 3;
            (u, v) = (radius, 0.0);
        }
    }

    /// The count along `g` after which the path stands level with `end`, a point (u, v) of the branch reached after
    /// `quarters` quarter turns. Not positive when that point is not ahead of the start.
    #[must_use]
    pub fn count_to(&self, bend: Bend, g: Axis, quarters: u8, end: (i64, i64)) -> i64 {
        let top = self.top(bend);
        let (mut u, mut v, mut quarter, mut count) = (self.u as f64, self.v as f64, self.quarter, 0.0);
        for _ in 0..quarters {
            count += if self.counts_u(quarter, g) { u } else { top - v };
            (u, v) = (top, 0.0);
            quarter = (quarter + 1) & 3;
        }
        count += if self.counts_u(quarter, g) { u - end.0 as f64 } else { end.1 as f64 - v };
        count.round() as i64
    }

    /// The count of a whole turn, along either axis.
    #[must_use]
    pub fn turn(&self, bend: Bend) -> f64 {
        4.0 * self.top(bend)
    }

    /// The height at which every quadrant but the first is entered.
    fn top(&self, bend: Bend) -> f64 {
        match bend {
            Bend::Inward => rise::<false>(self.rr, 1) as f64,
            Bend::Outward => rise::<true>(self.rr, 1) as f64,
            Bend::True => (self.rr as f64).sqrt(),
        }
    }

    /// The quarter (0-3) in which the branch lies.
    #[must_use]
    pub fn quarter(&self) -> u8 {
        self.quarter
    }

    /// The axis that falls towards 0 in a quarter; the other one grows.
    #[must_use]
    pub fn falling_axis(&self, quarter: u8) -> Axis {
        if self.counts_u(quarter, Axis::X) { Axis::X } else { Axis::Y }
    }
}

/// The first v at which column `c` is left: where c² + v² ≥ R², or > R² for the outward bend.
fn rise<const OUTWARD: bool>(rr: i64, c: i64) -> i64 {
    let room = rr - c * c;
    match OUTWARD {
        false => ceil_sqrt(room),
        true if room < 0 => 0,
        true => floor_sqrt(room) + 1,
    }
}

/// The first u at which row `r` is left: where u² + r² < R², or ≤ R² for the outward bend.
fn fall<const OUTWARD: bool>(rr: i64, r: i64) -> i64 {
    let room = rr - r * r;
    if OUTWARD { floor_sqrt(room) } else { ceil_sqrt(room) - 1 }
}

/// ⌊√n⌋, 0 for n ≤ 0. Exact: the floating root is off by at most one for n < 2⁶³.
fn floor_sqrt(n: i64) -> i64 {
    if n <= 0 {
        return 0;
    }
    let root = (n as f64).sqrt() as i64;
    if root * root > n {
        root - 1
    } else if (root + 1) * (root + 1) <= n {
        root + 1
    } else {
        root
    }
}

/// ⌈√n⌉, 0 for n ≤ 0.
fn ceil_sqrt(n: i64) -> i64 {
    let root = floor_sqrt(n);
    if root * root < n { root + 1 } else { root }
}
