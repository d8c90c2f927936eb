//! Contours of loose pieces: what is drawn twice is used once, ends that meet are joined, and an order to cut in.
//!
//! Pieces are lines, arcs and curves as a drawing has them, in any order and direction. Ends on one layer that meet
//! within the joining distance are joined where exactly two of them do; where more meet, what to cut is not for a program
//! to guess, and the place is told. This is the one part of the program that holds a drawing whole.
//!
//! It does not read drawings, and changes no shape but by moving ends that nearly meet onto one point.

mod chain;
mod doubles;
mod grid;
mod nearest;
mod nesting;
mod order;
mod sequence;

use crate::geometry::{Element, Path, Point, Sense};
use crate::motion::Travel;

use super::finding::{Finding, Severity, named};

/// One way to cut: a closed outline or hole, or an open path.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// The way, in the direction it is cut.
    pub path: Path,
    /// The layer it is drawn on.
    pub layer: String,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// The line of the file that its first entity begins on.
    pub line: u64,
    /// Whether it is cut; positioning is only kept from drawings that say so.
    pub travel: Travel,
    /// How many closed contours of the drawing it lies in: even for outlines, odd for holes.
    pub depth: usize,
}

/// How pieces become contours.
#[derive(Clone, Debug, PartialEq)]
pub struct Joining {
    /// Ends closer than this meet, mm.
    pub join: f64,
    /// In which order.
    pub order: Order,
    /// Where closed contours begin.
    pub start: Start,
    /// In which sense closed contours are run.
    pub direction: Direction,
}

impl Default for Joining {
    /// Ends within 0.005 mm meet; holes first, begun wherever is nearest; each contour as drawn.
    fn default() -> Self {
        Self { join: 0.005, order: Order::HolesFirst, start: Start::Nearest, direction: Direction::default() }
    }
}

/// The order of contours.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Order {
    /// What lies in a contour before the contour itself, and otherwise whatever is nearest next.
    HolesFirst,
    /// By the first entity of each contour.
    AsDrawn,
    /// Entity by entity as they stand, each begun where the last one ended; a new contour wherever none does.
    ///
    /// For drawings that are programs: ends may meet others at will, a lead-in its outline for one.
    InSequence,
}

/// Where closed contours begin.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// With their first entity.
    AsDrawn,
    /// At the node nearest to where the wire stands.
    Nearest,
    /// At given points: the contour nearest to a point begins there; all others as [`Self::Nearest`].
    At(Vec<Point>),
}

/// The sense in which closed contours are run; as drawn where none is given.
///
/// A contour of several entities is drawn in the direction in which the file goes on from its first entity, one of a
/// single entity in that entity's own; an arc or circle of a DXF file has no direction and counts as counter-clockwise.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Direction {
    /// Of outlines.
    pub outlines: Option<Sense>,
    /// Of holes.
    pub holes: Option<Sense>,
}

/// Something drawn in one piece.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Joined elements; not empty.
    pub(super) elements: Vec<Element>,
    pub(super) layer: u32,
    pub(super) line: u64,
    pub(super) travel: Travel,
    /// The sense of a circle, where it is told beside it.
    pub(super) clockwise: bool,
}

impl Piece {
    fn start(&self) -> Point {
        self.elements[0].start()
    }

    fn end(&self) -> Point {
        self.elements[self.elements.len() - 1].end()
    }
}

/// A contour on its way.
#[derive(Clone, Debug)]
struct Chain {
    elements: Vec<Element>,
    layer: u32,
    line: u64,
    travel: Travel,
}

/// Gaps up to this are closed without a word, mm.
const GAP_TOLD: f64 = 0.0005;

/// Makes contours of pieces; `ends_at` is where a sequence is said to end.
pub(super) fn contours(
    pieces: Vec<Piece>,
    layers: &[String],
    joining: &Joining,
    ends_at: Option<Point>,
    report: &mut Vec<Finding>,
) -> Vec<Contour> {
    let chains = if joining.order == Order::InSequence {
        sequence::follow(pieces, joining.join, ends_at, report)
    } else {
        chain::chain(doubles::without(pieces, report), layers, joining.join, report)
    };
    let mut contours: Vec<Contour> = chains
        .into_iter()
        .filter_map(|chain| {
            let Chain { elements, layer, line, travel } = chain;
            let path = Path::new(elements)?;
            let closed = path.is_closed();
            let layer = layers.get(layer as usize).cloned().unwrap_or_default();
            Some(Contour { path, layer, closed, line, travel, depth: 0 })
        })
        .collect();
    let areas: Vec<f64> = contours.iter().map(|c| if c.closed { c.path.area().abs() } else { 0.0 }).collect();
    if joining.order != Order::InSequence {
        for (contour, area) in contours.iter().zip(&areas).filter(|(contour, _)| contour.closed) {
            if *area <= contour.path.length() * GAP_TOLD {
                let start = contour.path.start();
                let message = format!("the contour from {} encloses nothing", named(start));
                let help = "one way may be drawn twice in different pieces: delete one";
                report.push(
                    Finding::new(Severity::Fault, "encloses-nothing", message)
                        .help(help)
                        .at(start)
                        .line(contour.line),
                );
            }
        }
    }
    let parents = nesting::parents(&mut contours, &areas);
    match joining.order {
        Order::InSequence => contours,
        Order::AsDrawn | Order::HolesFirst => order::ordered(contours, &parents, joining, report),
    }
}

#[cfg(test)]
mod tests;
