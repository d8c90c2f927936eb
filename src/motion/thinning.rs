//! Chains of short lines merged into fewer lines and arcs, within a tolerance.
//!
//! A program that was computed cuts a curve as thousands of lines, each a block for a slow line to carry. From where the last
//! element ended, the longest line and the longest arc are sought that keep to the tolerance, and the one that stands for
//! more lines is taken. Every element ends on a point of the program.
//!
//! The tolerance holds both ways: no point of the program is farther from what replaces it, and no point of that farther
//! from the program, and both run the same way. It holds before printing, which rounds ends and centres to the machine's
//! decimals.
//!
//! At most [`LINES_MAX`] lines are looked ahead, so memory does not grow with the program. Only cuts in a straight line are
//! merged, and only where nothing is said between them; a feed repeated word for word says nothing. The first move
//! behind a change of offset or taper stays as it is, as that comes into effect on its way. It does not find the fewest
//! elements, and does not make them join smoothly.

mod fit;

use std::collections::VecDeque;

use super::{Act, Motion, Text, Travel};
use crate::geometry::{Element, Point};

/// How a chain is thinned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinning {
    /// How far the path may be from the programmed one, mm; a positive length.
    pub tolerance: f64,
    /// What is made.
    pub made: Made,
    /// The greatest radius of an arc, mm: controls have one.
    pub radius_max: f64,
}

/// What lines are merged into.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Made {
    /// Lines alone.
    Lines,
    /// Lines and arcs, each arc at most 170 degrees.
    LinesAndArcs,
}

/// So many lines are held until what stands for the first of them is decided.
pub const LINES_MAX: usize = 1024;

/// Motions with their chains of lines thinned.
#[derive(Debug)]
pub struct Thinned<I: Iterator> {
    motions: I,
    thinning: Thinning,
    /// The chain in work: its moves, and the points from where the first begins.
    moves: VecDeque<Motion>,
    points: VecDeque<Point>,
    /// Whether the next move stays as it is.
    is_next_kept: bool,
    /// The feed that was said last.
    feed: Option<Text>,
    ready: VecDeque<I::Item>,
}

/// Thins the chains of a program.
pub fn thinned<I: Iterator>(motions: I, thinning: Thinning) -> Thinned<I> {
    let tolerance = thinning.tolerance;
    assert!(
        tolerance > 0.0 && tolerance.is_finite(),
        "a tolerance of {tolerance} mm is not a positive length"
    );
    Thinned {
        motions,
        thinning,
        moves: VecDeque::new(),
        points: VecDeque::new(),
        is_next_kept: false,
        feed: None,
        ready: VecDeque::new(),
    }
}

impl<I, E> Thinned<I>
where
    I: Iterator<Item = Result<Motion, E>>,
{
    fn take(&mut self, motion: Motion) {
        match &motion.act {
            &Act::Move {
                travel: Travel::Cut,
                element: Element::Line { start, end },
                upper: None,
                flag: None,
            } if !self.is_next_kept => {
                if self.points.back().is_some_and(|last| *last != start) {
                    self.finish_chain();
                }
                if self.points.is_empty() {
                    self.points.push_back(start);
                }
                self.points.push_back(end);
                self.moves.push_back(motion);
                if self.moves.len() >= LINES_MAX {
                    self.merge_first();
                }
            }
            Act::Word(word) if word.first() == Some(&b'F') => {
                if self.feed.as_ref() == Some(word) {
                    return;
                }
                self.feed = Some(word.clone());
                self.pass(motion);
            }
            _ => self.pass(motion),
        }
    }

    /// What is no line of a chain ends the one in work.
    fn pass(&mut self, motion: Motion) {
        self.finish_chain();
        match motion.act {
            Act::Offset(_) | Act::Taper(_) => self.is_next_kept = true,
            Act::Move { .. } => self.is_next_kept = false,
            _ => {}
        }
        self.ready.push_back(Ok(motion));
    }

    fn finish_chain(&mut self) {
        while !self.moves.is_empty() {
            self.merge_first();
        }
        self.points.clear();
    }

    /// Decides what stands for the first lines of the chain.
    fn merge_first(&mut self) {
        let (count, element) = self.thinning.longest(self.points.make_contiguous());
        self.points.drain(..count);
        let Some(last) = self.moves.drain(..count).next_back() else { return };
        self.ready.push_back(Ok(match element {
            // It ends where the last of them ends, so it is that one's block.
            Some(element) => Motion {
                act: Act::Move { travel: Travel::Cut, element, upper: None, flag: None },
                block: last.block,
                spot: last.spot,
            },
            None => last,
        }));
    }
}

impl<I, E> Iterator for Thinned<I>
where
    I: Iterator<Item = Result<Motion, E>>,
{
    type Item = Result<Motion, E>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.ready.is_empty() {
            match self.motions.next() {
                Some(Ok(motion)) => self.take(motion),
                Some(Err(error)) => {
                    self.finish_chain();
                    self.ready.push_back(Err(error));
                }
                None if self.moves.is_empty() => return None,
                None => self.finish_chain(),
            }
        }
        self.ready.pop_front()
    }
}

#[cfg(test)]
mod tests;
