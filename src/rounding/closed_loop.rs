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

/// Blocks chosen one by one for elements that are pulled.
#[derive(Debug)]
pub struct ClosedLoop<I> {
    steps: I,
    chooser: Chooser,
    role: Role,
    /// Where the contour in work was opened.
    opened: Position,
}

/// Chooses the blocks of one element at a time, each from where the last one really ended.
///
/// After [`Chooser::give`], [`Chooser::next_block`] is pulled until there is none.
#[derive(Debug)]
pub struct Chooser {
    stand: Stand,
    /// Pieces of the current element still to be made into blocks, first first.
    pieces: VecDeque<Element>,
    /// Where the last piece has to end, whatever theory says.
    home: Option<Position>,
    exact_nodes: bool,
}

/// A block and where theory wants it to end.
#[derive(Clone, Copy, Debug)]
pub struct Chosen {
    /// The block.
    pub block: Block,
    /// Where the path is when the block ends, mm.
    pub target: Point,
    /// Whether the target is the end of the element.
    pub at_node: bool,
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
    /// Whether the block that theory itself would be is tried first.
    theory_first: bool,
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
/// A node so near to a whole micron is one, µm: a hundredth of a nanometre, which is more than reckoning a drawing's arc
/// from its angles is out by, and less than any drawing hits by chance.
const WHOLE_UM: f64 = 1e-5;

impl Chooser {
    /// Chooses blocks for a control of the kind aimed at, with the wire standing at `origin`.
    #[must_use]
    pub fn new(origin: Position, aim: Aim) -> Self {
        Self { stand: Stand { aim, at: origin }, pieces: VecDeque::new(), home: None, exact_nodes: false }
    }

    /// The same chooser; where a node is a whole micron, as another 3B program's are, no other will do
    /// on a control of one model. That may take a second block. With every model aimed at, it is tried first.
    #[must_use]
    pub fn with_exact_nodes(mut self) -> Self {
        self.exact_nodes = true;
        self
    }

    /// Where the control stands after the blocks chosen so far.
    #[must_use]
    pub fn stands(&self) -> Position {
        self.stand.at
    }

    /// Gives the next element; with a `home`, it has to end there exactly: a contour closes.
    #[inline]
    pub fn give(&mut self, element: Element, home: Option<Position>) {
        self.home = home;
        self.pieces.extend(pieces::countable(element));
    }

    /// The next block of the element given; none when it is done.
    #[inline]
    pub fn next_block(&mut self) -> Option<Chosen> {
        while let Some(piece) = self.pieces.pop_front() {
            let end = piece.end();
            let Some(choice) = self.make(piece) else { continue };
            self.stand.at = choice.end;
            return Some(Chosen {
                block: choice.block,
                // If the piece was split, the rest of it is in front and the block ends where that begins.
                target: self.pieces.front().map_or(end, Element::start),
                at_node: self.pieces.is_empty(),
            });
        }
        None
    }

    /// Makes the next piece into a block; none when it is too short to move the control at all.
    fn make(&mut self, piece: Element) -> Option<Choice> {
        let goal = match self.home {
            Some(home) if self.pieces.is_empty() => {
                Goal { theory_first: self.exact_nodes, ..Goal::home(home) }
            }
            Some(_) | None if self.exact_nodes => Goal::node(piece.end(), self.stand.aim),
            Some(_) | None => Goal::near(piece.end()),
        };
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

impl<I: Iterator<Item = Step>> ClosedLoop<I> {
    /// Chooses blocks for the elements as they come, with the wire standing at `origin`.
    pub fn new(steps: I, origin: Position, aim: Aim) -> Self {
        Self { steps, chooser: Chooser::new(origin, aim), role: Role::LeadIn, opened: origin }
    }
}

/// No single block cuts the piece within the limit.
#[derive(Clone, Copy, Debug)]
struct NoneFits;

impl<I: Iterator<Item = Step>> Iterator for ClosedLoop<I> {
    type Item = Made;

    fn next(&mut self) -> Option<Made> {
        loop {
            if let Some(Chosen { block, target, at_node }) = self.chooser.next_block() {
                return Some(Made { block, target, at_node, role: self.role });
            }
            let step = self.steps.next()?;
            self.role = step.role;
            if step.role == Role::Opening {
                self.opened = self.chooser.stands();
            }
            self.chooser.give(step.element, (step.role == Role::Closing).then_some(self.opened));
        }
    }
}

impl Goal {
    fn near(point: Point) -> Self {
        Self {
            at: Position::nearest(point),
            x_um: point.x * 1000.0,
            y_um: point.y * 1000.0,
            exactly: false,
            theory_first: false,
        }
    }

    /// A node that may be a whole micron, and is then meant.
    fn node(point: Point, aim: Aim) -> Self {
        let near = Self::near(point);
        if near.at.distance_um(point) > WHOLE_UM {
            return near;
        }
        Self { exactly: matches!(aim, Aim::One(_)), theory_first: true, ..Self::home(near.at) }
    }

    fn home(at: Position) -> Self {
        Self { at, x_um: at.x.0 as f64, y_um: at.y.0 as f64, exactly: true, theory_first: false }
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
