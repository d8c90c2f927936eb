//! Each block chosen from where the control really stands.
//!
//! For every element the target node is rounded, not the block. The block's numbers are then tried in the order of
//! how likely they are to be right, each by asking the interpolator where it would end: first the start-from-centre
//! X, Y of the circle through the control's position and the target, then its integer neighbours; for each, the count
//! J that stands level with the target follows from the circle. The nearest end is kept, and the next block starts
//! from it, so remainders never add up.
//!
//! Aimed at [`Aim::Any`], only blocks on which every model of the control ends on the same micron are used, so that one
//! position serves them all. An arc that no such block can cut is split, at an axis of its centre if it crosses one,
//! else in the middle: that is where the models part, for they turn round an extremum of the circle at heights up to a
//! micron apart.

mod arc;
mod line;

use std::collections::VecDeque;

use super::{Aim, Made, Role, Step, pieces};
use crate::formats::three_b::Block;
use crate::geometry::{Element, Point};
use crate::units::Position;

/// Blocks chosen one by one, each from where the last one really ended.
#[derive(Debug)]
pub struct ClosedLoop<I> {
    steps: I,
    stand: Stand,
    /// Pieces of the current element still to be made into blocks, first first.
    pieces: VecDeque<Element>,
    role: Role,
    /// Where the contour in work was opened.
    opened: Position,
}

/// Where the control stands, under the one model it is or under every model it may be.
#[derive(Clone, Copy, Debug)]
struct Stand {
    aim: Aim,
    at: Position,
}

/// Where a block should end.
#[derive(Clone, Copy, Debug)]
struct Goal {
    /// The lattice point nearest to theory.
    at: Position,
    /// Theory, µm.
    x_um: f64,
    y_um: f64,
    /// Whether nothing but `at` will do: the contour closes here.
    exactly: bool,
}

/// A candidate block and where it would leave the control.
#[derive(Clone, Copy, Debug)]
struct Choice {
    block: Block,
    end: Position,
    /// The distance from the goal, squared, µm².
    error: f64,
}

/// The largest distance from theory that a block may leave where another choice is to be had, µm. Under one model the
/// bound is 1.05, under every model 1.5; what is left of it is margin.
const LIMIT_UM: f64 = 1.045;
/// The same when every model has to agree, µm.
const LIMIT_ANY_UM: f64 = 1.4;

impl<I: Iterator<Item = Step>> ClosedLoop<I> {
    /// Chooses blocks for the elements as they come, with the wire standing at `origin`.
    pub fn new(steps: I, origin: Position, aim: Aim) -> Self {
        Self {
            steps,
            stand: Stand { aim, at: origin },
            pieces: VecDeque::new(),
            role: Role::LeadIn,
            opened: origin,
        }
    }

    /// Makes the next piece into a block; none when it is too short to move the control at all.
    fn make(&mut self, piece: Element) -> Option<Choice> {
        let closes = self.role == Role::Closing && self.pieces.is_empty();
        let goal = if closes { Goal::home(self.opened) } else { Goal::near(piece.end()) };
        let found = match piece {
            Element::Line { .. } => line::choose(self.stand, goal),
            Element::Arc { start, end, centre, sense } => {
                arc::choose(self.stand, goal, arc::Shape::new(start, end, centre, sense))
            }
        };
        let (first, rest) = match (found, piece) {
            (Ok(choice), _) => return choice,
            (Err(NoneFits), Element::Line { start, end }) => {
                let Some(by) = line::detour(self.stand, goal) else { return line::nearest(self.stand, goal) };
                (Element::Line { start, end: by }, Element::Line { start: by, end })
            }
            (Err(NoneFits), Element::Arc { start, end, .. }) => match arc::split(&piece) {
                Some(pieces) => pieces,
                // Flatter than the lattice can show: its chord is the same cut.
                None => return self.make(Element::Line { start, end }),
            },
        };
        self.pieces.push_front(rest);
        self.make(first)
    }
}

/// No single block cuts the piece within the limit.
#[derive(Clone, Copy, Debug)]
struct NoneFits;

impl<I: Iterator<Item = Step>> Iterator for ClosedLoop<I> {
    type Item = Made;

    fn next(&mut self) -> Option<Made> {
        loop {
            while let Some(piece) = self.pieces.pop_front() {
                let end = piece.end();
                let Some(choice) = self.make(piece) else { continue };
                self.stand.at = choice.end;
                return Some(Made {
                    block: choice.block,
                    // If the piece was split, the rest of it is in front and the block ends where that begins.
                    target: self.pieces.front().map_or(end, Element::start),
                    at_node: self.pieces.is_empty(),
                    role: self.role,
                });
            }
            let step = self.steps.next()?;
            self.role = step.role;
            if step.role == Role::Opening {
                self.opened = self.stand.at;
            }
            self.pieces.extend(pieces::countable(step.element));
        }
    }
}

impl Goal {
    fn near(point: Point) -> Self {
        Self { at: Position::nearest(point), x_um: point.x * 1000.0, y_um: point.y * 1000.0, exactly: false }
    }

    fn home(at: Position) -> Self {
        Self { at, x_um: at.x.0 as f64, y_um: at.y.0 as f64, exactly: true }
    }

    /// The squared distance of a position from theory, µm².
    fn error(&self, p: Position) -> f64 {
        let (dx, dy) = (p.x.0 as f64 - self.x_um, p.y.0 as f64 - self.y_um);
        dx * dx + dy * dy
    }

    /// Whether a position will do.
    fn admits(&self, p: Position, limit_um: f64) -> bool {
        if self.exactly { p == self.at } else { self.error(p) <= limit_um * limit_um }
    }
}

impl Stand {
    fn limit_um(&self) -> f64 {
        match self.aim {
            Aim::One(_) => LIMIT_UM,
            Aim::Any => LIMIT_ANY_UM,
        }
    }
}
