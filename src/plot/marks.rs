//! Block numbers and arrow heads along the path, as many as a page can carry.
//!
//! Places are offered block by block and thinned out as they come: when there are too many, every other one is let go.
//! Numbers that would lie over each other are left out at the end.

use crate::drawing::text_width;
use crate::geometry::{Point, Vector};

/// A place on the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    pub(super) block: u64,
    pub(super) at: Point,
    pub(super) heading: Vector,
    /// Away from the part, as far as it is known.
    pub(super) aside: Vector,
}

/// Places at every so many blocks.
#[derive(Debug)]
pub(super) struct Marks {
    every: u64,
    kind: Kind,
    most: usize,
    /// With what says whether each is due: its block, or how many were offered before it.
    kept: Vec<(u64, Mark)>,
    offered: u64,
    /// Places of a fixed density that found no room.
    pub(super) left_out: u64,
}

/// Which blocks are marked.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Kind {
    /// The first and round ones, so many as there is room for.
    Numbers,
    /// The first and every so many, as asked for.
    Fixed,
    /// Ones between, clear of the numbers.
    Between,
}

impl Kind {
    fn is_due(self, number: u64, every: u64) -> bool {
        match self {
            Self::Numbers | Self::Fixed => number == 1 || number.is_multiple_of(every),
            Self::Between => number % every == BETWEEN % every,
        }
    }
}

impl Marks {
    /// Numbers, at most so many, as evenly as may be.
    pub(super) fn up_to(most: usize) -> Self {
        Self { every: 1, kind: Kind::Numbers, most, kept: Vec::new(), offered: 0, left_out: 0 }
    }

    /// Marks between the numbers, at most so many.
    pub(super) fn between(most: usize) -> Self {
        Self { kind: Kind::Between, ..Self::up_to(most) }
    }

    /// At every so many blocks; none at all for 0.
    pub(super) fn every(every: u64) -> Self {
        Self { every, kind: Kind::Fixed, ..Self::up_to(FIXED_MAX) }
    }

    pub(super) fn offer(&mut self, mark: Mark) {
        self.offered += 1;
        let number = if self.kind == Kind::Between { self.offered } else { mark.block };
        if self.every == 0 || !self.kind.is_due(number, self.every) {
            return;
        }
        if self.kept.len() == self.most {
            if self.kind == Kind::Fixed {
                self.left_out += 1;
                return;
            }
            let (kind, every) = (self.kind, next_round(self.every));
            self.every = every;
            self.kept.retain(|(number, _)| kind.is_due(*number, every));
            // The same block again and again, as when a part is repeated without end, leaves no room.
            if !kind.is_due(number, every) || self.kept.len() == self.most {
                return;
            }
        }
        self.kept.push((number, mark));
    }

    pub(super) fn kept(&self) -> impl Iterator<Item = &Mark> {
        self.kept.iter().map(|(_, mark)| mark)
    }

    /// Those that lie farther than so many model millimetres from all earlier ones.
    pub(super) fn clear_of_each_other(&self, apart: f64) -> Vec<Mark> {
        let mut shown: Vec<Mark> = Vec::new();
        for mark in self.kept() {
            if shown.iter().all(|other| (other.at - mark.at).norm() > apart) {
                shown.push(*mark);
            }
        }
        shown
    }

    /// Those whose numbers do not lie over an earlier one, in letters of a height; `pen` is model per page millimetre.
    ///
    /// Each with how far its middle is from the path, page millimetres.
    pub(super) fn apart(&self, height: f64, pen: f64) -> Vec<(Mark, String, f64)> {
        let mut shown: Vec<([f64; 4], Mark, String, f64)> = Vec::new();
        for mark in self.kept() {
            let text = mark.block.to_string();
            let half = [text_width(&text, height) / 2.0 + GAP, height / 2.0 + GAP];
            let away = CLEAR + mark.aside.x.abs() * half[0] + mark.aside.y.abs() * half[1];
            let centre = mark.at + mark.aside * (away * pen);
            let half = half.map(|side| side * pen);
            let own = [centre.x - half[0], centre.y - half[1], centre.x + half[0], centre.y + half[1]];
            let is_free = shown.iter().all(|(other, ..)| {
                own[0] > other[2] || own[2] < other[0] || own[1] > other[3] || own[3] < other[1]
            });
            if is_free {
                shown.push((own, *mark, text, away));
            }
        }
        shown.into_iter().map(|(_, mark, text, away)| (mark, text, away)).collect()
    }
}

/// From the path to a number, page millimetres.
const CLEAR: f64 = 0.4;

/// The last digit of a cut that is marked between numbers.
const BETWEEN: u64 = 7;

/// Between two numbers, page millimetres.
const GAP: f64 = 0.8;

/// The most numbers of a density that was asked for: they take some 2 MB.
const FIXED_MAX: usize = 2000;

/// 1, 2, 10, 20, 100 …: each a multiple of the one before, so that what is kept stays even.
fn next_round(every: u64) -> u64 {
    let mut decade = 1;
    while decade * 10 <= every {
        decade *= 10;
    }
    if every == decade { 2 * decade } else { 10 * decade }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(block: u64) -> Mark {
        let at = Point::new(block as f64, 0.0);
        Mark { block, at, heading: Vector::new(1.0, 0.0), aside: Vector::new(0.0, 1.0) }
    }

    #[test]
    fn numbers_stand_at_round_distances_however_many_blocks_there_are() {
        let mut marks = Marks::up_to(40);
        (1..=100_000).for_each(|block| marks.offer(mark(block)));
        let blocks: Vec<u64> = marks.kept().map(|mark| mark.block).collect();
        assert_eq!((blocks[0], blocks[1], blocks[2], blocks.len()), (1, 10_000, 20_000, 11));
        let mut fixed = Marks::every(7);
        (1..=20).for_each(|block| fixed.offer(mark(block)));
        assert_eq!(fixed.kept().map(|mark| mark.block).collect::<Vec<_>>(), [1, 7, 14]);
        let mut between = Marks::between(16);
        (1..=265).for_each(|block| between.offer(mark(block)));
        assert!(between.kept().all(|mark| mark.block % 20 == 7));
        assert_eq!(between.kept().count(), 13);
        let mut none = Marks::every(0);
        none.offer(mark(1));
        assert!(none.kept().next().is_none());
    }

    #[test]
    fn numbers_over_each_other_are_left_out() {
        let mut marks = Marks::every(1);
        (1..=20).for_each(|block| marks.offer(mark(block)));
        assert_eq!(marks.apart(2.2, 0.001).len(), 20);
        let shown = marks.apart(2.2, 1.0);
        assert!((3..=6).contains(&shown.len()), "{}", shown.len());
    }
}
