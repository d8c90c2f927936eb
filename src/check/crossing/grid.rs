//! Which elements of a path come near each other, without comparing all with all.
//!
//! A uniform grid with cells of twice the mean length. Long elements are cut into pieces, so that a piece touches few
//! cells and all pieces together are at most twice as many as the elements.

use super::Stretch;
use crate::geometry::{Element, Point};

/// Calls back for each pair of elements whose bounds overlap in a cell, perhaps more than once.
///
/// False when there are so many pairs that the search was given up.
pub(super) fn pairs(stretch: &Stretch<'_>, mut near: impl FnMut(usize, usize)) -> bool {
    let count = stretch.count();
    if count < 2 {
        return true;
    }
    let total: f64 = (0..count).map(|n| stretch.element(n).length()).sum();
    let cell = 2.0 * (total / count as f64).max(CELL_LEAST_MM);
    let bounds: Vec<Bounds> = (0..count).map(|n| Bounds::of(stretch.element(n).extent())).collect();
    let mut entries: Vec<(u64, u32)> = Vec::with_capacity(3 * count);
    for n in 0..count {
        let first = entries.len();
        add(stretch.element(n), n as u32, cell, &mut entries);
        // Pieces of one element share cells.
        entries[first..].sort_unstable();
        let mut kept = first;
        for at in first..entries.len() {
            if kept == first || entries[kept - 1] != entries[at] {
                entries[kept] = entries[at];
                kept += 1;
            }
        }
        entries.truncate(kept);
    }
    entries.sort_unstable();
    let mut left = PAIRS_LEAST + PAIRS_PER_ELEMENT * count as u64;
    for group in entries.chunk_by(|a, b| a.0 == b.0) {
        for (n, &(_, a)) in group.iter().enumerate() {
            let others = &group[n + 1..];
            let Some(rest) = left.checked_sub(others.len() as u64) else { return false };
            left = rest;
            for &(_, b) in others {
                if bounds[a as usize].overlaps(&bounds[b as usize]) {
                    near(a as usize, b as usize);
                }
            }
        }
    }
    true
}

/// Pairs that are always looked at, and so many more for each element: thicker than any contour that is cut.
const PAIRS_LEAST: u64 = 10_000_000;
const PAIRS_PER_ELEMENT: u64 = 100;

/// The smallest half cell, mm.
const CELL_LEAST_MM: f64 = 0.001;

#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    /// Grown by what counts as touching.
    fn of([min, max]: [Point; 2]) -> Self {
        const TOUCH_MM: f64 = 0.001;
        Self { low: [min.x - TOUCH_MM, min.y - TOUCH_MM], high: [max.x + TOUCH_MM, max.y + TOUCH_MM] }
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }
}

/// Adds the cells an element touches.
fn add(element: &Element, n: u32, cell: f64, entries: &mut Vec<(u64, u32)>) {
    let (length, turn) = (element.length(), element.sweep());
    let pieces = (length / cell).ceil().max((turn / PIECE_TURN).ceil()).clamp(1.0, PIECES_MAX);
    // How far a piece of an arc bulges out over its chord.
    let bulge =
        element.radius().map_or(0.0, |radius| radius * (1.0 - libm::cos(0.5 * turn / pieces))) + 0.001;
    let pieces = pieces as usize;
    let mut from = element.start();
    for piece in 1..=pieces {
        let to = element.at(piece as f64 / pieces as f64);
        let index = |v: f64| (v / cell).floor() as i64;
        let span = |a: f64, b: f64| index(a.min(b) - bulge)..=index(a.max(b) + bulge);
        for x in span(from.x, to.x) {
            for y in span(from.y, to.y) {
                entries.push((key(x, y), n));
            }
        }
        from = to;
    }
}

/// A piece of an arc turns by an eighth of a circle at most.
const PIECE_TURN: f64 = std::f64::consts::FRAC_PI_4;

/// The most pieces of one element.
const PIECES_MAX: f64 = 2_000_000.0;

/// Two cells with one key cost a comparison and nothing else.
fn key(x: i64, y: i64) -> u64 {
    ((x as u64) << 32) | (y as u64 & 0xFFFF_FFFF)
}
