//! A program's cuts in chains, and the contours that close within a chain.
//!
//! A chain is cut without a stop or a rapid move between. No format says where in a chain the lead-in ends, so it is found:
//! when a cut comes back to a point where the chain has been, what lies between is a *ring*, and what came before is the
//! way in. A ring is handed over and forgotten, so a second pass is a ring of its own and memory is that of the longest
//! ring. What a chain leaves in the end belongs to no ring: ways in and out, and open cuts.
//!
//! ```text
//!  start ──lead-in──▶ ┌── ring ──┐ ──lead-out──▶
//!                     └──────────┘
//! ```
//!
//! It judges nothing.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::modal::State;
use crate::geometry::{Element, Point};
use crate::motion::{Act, Flag, Motion, Side, Stop, Travel};
use crate::place::Spot;

/// One cut of a chain.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// The way.
    pub element: Element,
    /// The block.
    pub block: u64,
    /// Where it stands in the source.
    pub spot: Spot,
    /// 4B's flag.
    pub flag: Option<Flag>,
    /// The side on which the control sets its wire off.
    pub side: Option<Side>,
    /// Whether the wire is tilted.
    pub is_tapered: bool,
    /// Where each model of a 3B control stands at the element's start, seen from there, µm.
    pub drift: Drift,
    along: f64,
}

impl Held {
    /// The way from the chain's start to the element's start, mm.
    #[must_use]
    pub fn along(&self) -> f64 {
        self.along
    }
}

/// Where each model of a 3B control stands, seen from where the program says, µm.
pub type Drift = [[i32; 2]; 4];

/// What a chain is made of.
#[derive(Clone, Copy, Debug)]
pub enum Run<'a> {
    /// A ring has closed.
    Ring {
        /// The cuts since the ring before, or since the chain began: the way in.
        lead: &'a [Held],
        /// The cuts of the ring.
        ring: &'a [Held],
        /// Where each model stands at the ring's end.
        drift: Drift,
    },
    /// Cuts that go somewhere and the same way back enclose nothing.
    Retrace(&'a [Held]),
    /// The chain has ended.
    Rest {
        /// The cuts that belong to no ring.
        held: &'a [Held],
        /// How many of them, at the end, came after the last ring.
        fresh: usize,
        /// How many rings the chain had.
        rings: u64,
    },
    /// The chain has a stretch of so many cuts without a ring that it is not held any longer; these have been.
    TooLong(&'a [Held]),
}

/// The most cuts that are held, some 200 MB with their nodes.
pub const HELD_MAX: usize = 1_000_000;

/// How near a cut must come to a node to be back there, mm: what the models of a 3B control may differ by.
pub const CLOSED_MM: f64 = 0.003;

/// A way shorter than this, mm, is no ring: a handful of short cuts never gets away from its nodes.
const RING_MM: f64 = 0.05;

/// Finds the rings of a program.
#[derive(Debug)]
pub struct Contours {
    held: Vec<Held>,
    held_max: usize,
    /// The first cut that has not been handed over.
    fresh: usize,
    rings: u64,
    /// The chain is passed over to its end.
    is_given_up: bool,
    /// Per cell, the last node in it; and per node, the one before it in its cell.
    cells: HashMap<(i64, i64), u32, BuildHasherDefault<Mixing>>,
    before: Vec<u32>,
    end: Option<Point>,
    drift: Drift,
}

impl Default for Contours {
    fn default() -> Self {
        Self::holding(HELD_MAX)
    }
}

impl Contours {
    /// Finds rings of up to so many cuts, at most [`HELD_MAX`].
    #[must_use]
    pub fn holding(most: usize) -> Self {
        Self {
            held: Vec::new(),
            held_max: most.min(HELD_MAX),
            fresh: 0,
            rings: 0,
            is_given_up: false,
            cells: HashMap::default(),
            before: Vec::new(),
            end: None,
            drift: Drift::default(),
        }
    }

    /// Whether the chain is so long that it is passed over to its end.
    #[must_use]
    pub fn is_given_up(&self) -> bool {
        self.is_given_up
    }

    /// Takes the next motion; `drift` is where the models stand when it is done.
    pub fn see(&mut self, motion: &Motion, state: State, drift: Drift, tell: &mut impl FnMut(Run<'_>)) {
        match &motion.act {
            Act::Move { travel: Travel::Cut, element, flag, .. } => {
                let start = element.start();
                if self.end.is_some_and(|end| (end - start).norm() > CLOSED_MM) {
                    self.break_off(tell);
                }
                let held = Held {
                    element: *element,
                    block: motion.block,
                    spot: motion.spot,
                    flag: *flag,
                    side: state.side,
                    is_tapered: state.is_tapered,
                    drift: self.drift,
                    along: self.held.last().map_or(0.0, |last| last.along + last.element.length()),
                };
                self.drift = drift;
                self.push(held, tell);
            }
            Act::Move { travel: Travel::Rapid, .. } | Act::Stop(Stop::Pause | Stop::End) => {
                self.break_off(tell);
                self.drift = drift;
            }
            Act::Offset(_)
            | Act::Taper(_)
            | Act::Stop(Stop::Optional)
            | Act::Dwell(_)
            | Act::Word(_)
            | Act::Unknown(_)
            | Act::Comment(_)
            | Act::Header(_) => {}
        }
    }

    /// Takes the end of the program.
    pub fn finish(&mut self, tell: &mut impl FnMut(Run<'_>)) {
        self.break_off(tell);
    }

    fn push(&mut self, held: Held, tell: &mut impl FnMut(Run<'_>)) {
        let end = held.element.end();
        self.end = Some(end);
        if self.is_given_up {
            return;
        }
        if self.held.len() == self.held_max {
            tell(Run::TooLong(&self.held));
            self.clear();
            self.is_given_up = true;
            self.end = Some(end);
            return;
        }
        let along = held.along + held.element.length();
        self.add_node(held.element.start());
        self.held.push(held);
        let Some(from) = self.node_at(end, along) else { return };
        let (before, ring) = self.held.split_at(from);
        if encloses_nothing(ring) {
            tell(Run::Retrace(ring));
        } else {
            self.rings += 1;
            tell(Run::Ring { lead: &before[self.fresh.min(from)..], ring, drift: self.drift });
        }
        self.drop_from(from);
        self.fresh = from;
    }

    fn break_off(&mut self, tell: &mut impl FnMut(Run<'_>)) {
        if !self.held.is_empty() || self.rings > 0 {
            let fresh = self.held.len().saturating_sub(self.fresh);
            tell(Run::Rest { held: &self.held, fresh, rings: self.rings });
        }
        self.clear();
    }

    fn clear(&mut self) {
        self.held.clear();
        self.cells.clear();
        self.before.clear();
        (self.fresh, self.rings, self.is_given_up, self.end) = (0, 0, false, None);
    }

    fn add_node(&mut self, point: Point) {
        let node = self.before.len() as u32;
        let last = self.cells.insert(cell(point), node);
        self.before.push(last.unwrap_or(NONE));
    }

    /// Forgets the cuts from one on, and their nodes.
    fn drop_from(&mut self, from: usize) {
        while self.before.len() > from {
            let cell = cell(self.held[self.before.len() - 1].element.start());
            match self.before.pop() {
                Some(NONE) | None => self.cells.remove(&cell),
                Some(before) => self.cells.insert(cell, before),
            };
        }
        self.held.truncate(from);
    }

    /// The node at which the chain is back, if it is: the nearest one that lies far enough back along the way.
    fn node_at(&self, point: Point, along: f64) -> Option<usize> {
        let mut found: Option<(f64, usize)> = None;
        let corner = |dx: f64, dy: f64| cell(Point::new(point.x + dx * CLOSED_MM, point.y + dy * CLOSED_MM));
        let (low, high) = (corner(-1.0, -1.0), corner(1.0, 1.0));
        for x in low.0..=high.0 {
            for y in low.1..=high.1 {
                let mut next = self.cells.get(&(x, y)).copied().unwrap_or(NONE);
                while next != NONE {
                    let held = &self.held[next as usize];
                    let distance = (held.element.start() - point).norm();
                    if distance <= CLOSED_MM
                        && along - held.along >= RING_MM
                        && found.is_none_or(|(least, _)| distance < least)
                    {
                        found = Some((distance, next as usize));
                    }
                    next = self.before[next as usize];
                }
            }
        }
        found.map(|(_, node)| node)
    }
}

/// Whether a ring goes back the way it came, block by block.
fn encloses_nothing(ring: &[Held]) -> bool {
    let (there, back) = ring.split_at(ring.len() / 2);
    let near = |a: Point, b: Point| (a - b).norm() <= CLOSED_MM;
    ring.len().is_multiple_of(2)
        && there.iter().zip(back.iter().rev()).all(|(there, back)| {
            let (there, back) = (&there.element, &back.element);
            near(there.start(), back.end()) && near(there.at(0.5), back.at(0.5))
        })
}

/// The cell of a point; somewhat larger than what counts as the same node.
fn cell(point: Point) -> (i64, i64) {
    let index = |v: f64| (v / (4.0 * CLOSED_MM)).floor() as i64;
    (index(point.x), index(point.y))
}

/// No node.
const NONE: u32 = u32::MAX;

const _: () = assert!(HELD_MAX < NONE as usize);

/// A hasher for cells: numbers of no one's choosing to guard against need no more.
#[derive(Debug, Default)]
struct Mixing(u64);

impl Hasher for Mixing {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_i64(i64::from(byte));
        }
    }

    fn write_i64(&mut self, value: i64) {
        self.0 = (self.0 ^ value as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
    }

    fn finish(&self) -> u64 {
        self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15)
    }
}
