//! Points in square cells, so that those near a place are found without looking at all.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use crate::geometry::Point;

/// Points with a number each.
#[derive(Debug)]
pub(super) struct Grid {
    /// How far near is, mm.
    reach: f64,
    /// The last point of each cell.
    cells: HashMap<(i64, i64), u32, BuildHasherDefault<Mixer>>,
    points: Vec<Held>,
}

#[derive(Debug)]
struct Held {
    point: Point,
    number: u32,
    /// The point before it in its cell.
    before: u32,
}

const NONE: u32 = u32::MAX;

impl Grid {
    pub(super) fn new(reach: f64, count: usize) -> Self {
        Self {
            reach,
            cells: HashMap::with_capacity_and_hasher(count, BuildHasherDefault::default()),
            points: Vec::with_capacity(count),
        }
    }

    pub(super) fn insert(&mut self, point: Point, number: u32) {
        let next = self.points.len() as u32;
        let before = self.cells.insert(self.cell(point.x, point.y), next).unwrap_or(NONE);
        self.points.push(Held { point, number, before });
    }

    /// The numbers of points within reach; of very many in one cell, the last ones.
    pub(super) fn near(&self, point: Point) -> impl Iterator<Item = u32> {
        let (low, high) = (
            self.cell(point.x - self.reach, point.y - self.reach),
            self.cell(point.x + self.reach, point.y + self.reach),
        );
        let columns = low.0..=high.0;
        columns.flat_map(move |x| (low.1..=high.1).map(move |y| (x, y))).flat_map(move |cell| {
            let mut at = self.cells.get(&cell).copied().unwrap_or(NONE);
            let mut left = LOOKED_AT;
            std::iter::from_fn(move || {
                while at != NONE && left > 0 {
                    let held = &self.points[at as usize];
                    at = held.before;
                    left -= 1;
                    if (held.point - point).norm_squared() <= self.reach * self.reach {
                        return Some(held.number);
                    }
                }
                None
            })
        })
    }

    fn cell(&self, x: f64, y: f64) -> (i64, i64) {
        // Cells larger than the reach: most places are near to one cell only.
        let size = 8.0 * self.reach;
        ((x / size).floor() as i64, (y / size).floor() as i64)
    }
}

/// Points of a cell that are looked at: a drawing has a few, a file made to be slow may have thousands.
const LOOKED_AT: u32 = 64;

/// Two whole numbers mixed into one; the numbers of cells need no more.
#[derive(Debug, Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_i64(i64::from(byte));
        }
    }

    fn write_i64(&mut self, number: i64) {
        self.0 = (self.0 ^ number as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.0 ^= self.0 >> 29;
    }
}
