//! The 1990 paper's rounding: X, Y and J of every block on their own.
//!
//! Simple, and what the paper's table shows; but each block's remainder stays in the path, so the printed gear leaves
//! its nodes by up to 15 µm. Use it to reproduce old programs.

use super::{Made, Step, pieces};
use crate::formats::three_b::{Axis, Block};
use crate::geometry::{Element, Point, Sense, Vector};
use crate::units::{Micrometres, Position};

/// Blocks rounded one by one.
#[derive(Debug)]
pub struct PerBlock<I> {
    steps: I,
    pieces: std::collections::VecDeque<Element>,
    step: Option<Step>,
}

impl<I: Iterator<Item = Step>> PerBlock<I> {
    /// Rounds the elements as they come.
    pub fn new(steps: I) -> Self {
        Self { steps, pieces: std::collections::VecDeque::new(), step: None }
    }
}

impl<I: Iterator<Item = Step>> Iterator for PerBlock<I> {
    type Item = Made;

    fn next(&mut self) -> Option<Made> {
        loop {
            if let (Some(piece), Some(step)) = (self.pieces.pop_front(), self.step) {
                let block = block(&piece);
                if block.j == Micrometres(0) {
                    // Shorter than half a micron: a block without motion says nothing.
                    continue;
                }
                return Some(Made {
                    block,
                    target: piece.end(),
                    at_node: self.pieces.is_empty(),
                    role: step.role,
                });
            }
            let step = self.steps.next()?;
            self.pieces.extend(pieces::countable(step.element));
            self.step = Some(step);
        }
    }
}

/// The element as one block, every number rounded by itself.
fn block(element: &Element) -> Block {
    match *element {
        Element::Line { start, end } => Block::line(Position::nearest(Point::from(end - start))),
        Element::Arc { start, end, centre, sense } => {
            let (from, to) = (start - centre, end - centre);
            let g = if to.x.abs() < to.y.abs() { Axis::X } else { Axis::Y };
            let travel = travel(from, to, sense, g);
            Block::arc(Position::nearest(Point::from(from)), sense, g, Micrometres::nearest(travel))
        }
    }
}

/// The way an arc goes along an axis, the sum over its quadrants; mm.
fn travel(from: Vector, to: Vector, sense: Sense, g: Axis) -> f64 {
    let radius = from.norm();
    // Turned so that the counted axis is the cosine and the arc runs counter-clockwise.
    let turned = |p: Vector| match (g, sense) {
        (Axis::X, Sense::CounterClockwise) => p,
        (Axis::X, Sense::Clockwise) => Vector::new(p.x, -p.y),
        (Axis::Y, Sense::CounterClockwise) => Vector::new(p.y, -p.x),
        (Axis::Y, Sense::Clockwise) => Vector::new(p.y, p.x),
    };
    let (a, b) = (turned(from), turned(to));
    let full = crate::geometry::sweep(a, b, Sense::CounterClockwise) > std::f64::consts::PI;
    match (a.y >= 0.0, b.y >= 0.0) {
        // Both on the upper half, where x falls: either straight on, or all the way round.
        (true, true) if !full => a.x - b.x,
        (true, true) => (a.x + radius) + 2.0 * radius + (radius - b.x),
        (true, false) => (a.x + radius) + (b.x + radius),
        (false, true) => (radius - a.x) + (radius - b.x),
        (false, false) if !full => b.x - a.x,
        (false, false) => (radius - a.x) + 2.0 * radius + (b.x + radius),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn travel_sums_the_projections_of_every_quadrant() {
        let p = Vector::new;
        let ccw = |a, b, g| travel(a, b, Sense::CounterClockwise, g);
        assert!((ccw(p(5.0, 0.0), p(0.0, 5.0), Axis::X) - 5.0).abs() < 1e-12);
        assert!((ccw(p(5.0, 0.0), p(0.0, -5.0), Axis::X) - 15.0).abs() < 1e-12);
        assert!((ccw(p(5.0, 0.0), p(5.0, 0.0), Axis::Y) - 20.0).abs() < 1e-12);
        assert!((ccw(p(3.0, 4.0), p(-3.0, 4.0), Axis::Y) - 2.0).abs() < 1e-12);
        assert!((travel(p(-3.0, 4.0), p(3.0, 4.0), Sense::Clockwise, Axis::Y) - 2.0).abs() < 1e-12);
        assert!(
            (travel(p(3.0, 4.0), p(-3.0, 4.0), Sense::Clockwise, Axis::X) - (2.0 + 10.0 + 2.0)).abs() < 1e-12
        );
    }
}
