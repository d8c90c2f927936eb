//! A contour divided into stretches, cut first, and tabs, cut last.

use super::refusal::Fault;
use super::{Tab, Tabs};

/// Stretches and tabs in turn, from the contour's beginning to its closing point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Division {
    /// Where pieces begin and end, mm along the contour; from 0 to its length.
    pub(super) marks: Vec<f64>,
    /// What lies behind each mark but the last.
    pub(super) pieces: Vec<Piece>,
}

/// What lies between two marks.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Piece {
    /// Cut first.
    Stretch,
    /// Left uncut at first.
    Tab,
}

impl Division {
    /// The division of a contour of a length, mm.
    pub(super) fn of(length: f64, tabs: &Tabs) -> Result<Self, Fault> {
        let tabs = match tabs {
            Tabs::None => Vec::new(),
            Tabs::Even { count, length: tab } => even(length, *count, *tab)?,
            Tabs::At(tabs) => tabs.clone(),
        };
        let mut division = Self { marks: vec![0.0], pieces: Vec::new() };
        let mut at = 0.0;
        for (n, tab) in tabs.iter().enumerate() {
            let gap = tab.from - at;
            let end = tab.from + tab.length;
            // The first may begin and the last may end at the closing point, but not both.
            if gap < -LEAST || (n > 0 && gap < LEAST) || end > length + LEAST {
                return Err(Fault::TabsOverlap { tab: n + 1, from: tab.from, to: end, length });
            }
            if gap > LEAST {
                division.push(Piece::Stretch, tab.from);
            }
            at = if length - end < LEAST { length } else { end };
            division.push(Piece::Tab, at);
        }
        if at < length {
            division.push(Piece::Stretch, length);
        } else if division.pieces.first() == Some(&Piece::Tab) {
            return Err(Fault::TabsOverlap { tab: 1, from: 0.0, to: division.marks[1], length });
        }
        Ok(division)
    }

    fn push(&mut self, piece: Piece, to: f64) {
        self.pieces.push(piece);
        self.marks.push(to);
    }

    /// The marks at which pieces of a kind begin.
    pub(super) fn of_kind(&self, kind: Piece) -> impl DoubleEndedIterator<Item = usize> {
        self.pieces.iter().enumerate().filter(move |(_, piece)| **piece == kind).map(|(n, _)| n)
    }
}

/// Tabs at equal distances, the last one ending where the contour closes.
fn even(length: f64, count: u32, tab: f64) -> Result<Vec<Tab>, Fault> {
    let taken = f64::from(count) * tab;
    if taken > length - f64::from(count) * LEAST {
        return Err(Fault::TabsTooLong { taken, length });
    }
    let step = length / f64::from(count);
    Ok((1..=count).map(|n| Tab { from: f64::from(n) * step - tab, length: tab }).collect())
}

/// The shortest stretch, mm: a micron.
const LEAST: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::Piece::{Stretch, Tab as Bridge};
    use super::*;

    #[test]
    fn even_tabs_stand_behind_equal_stretches_and_the_last_one_closes() {
        let division = Division::of(40.0, &Tabs::Even { count: 2, length: 1.5 }).unwrap();
        assert_eq!(division.marks, [0.0, 18.5, 20.0, 38.5, 40.0]);
        assert_eq!(division.pieces, [Stretch, Bridge, Stretch, Bridge]);
    }

    #[test]
    fn given_tabs_may_stand_anywhere_even_at_the_beginning() {
        let at =
            |tabs: &[(f64, f64)]| Tabs::At(tabs.iter().map(|&(from, length)| Tab { from, length }).collect());
        let division = Division::of(40.0, &at(&[(0.0, 2.0), (10.0, 1.0)])).unwrap();
        assert_eq!(division.marks, [0.0, 2.0, 10.0, 11.0, 40.0]);
        assert_eq!(division.pieces, [Bridge, Stretch, Bridge, Stretch]);
        for wrong in
            [&[(5.0, 2.0), (6.0, 1.0)][..], &[(39.0, 2.0)], &[(0.0, 1.0), (39.0, 1.0)], &[(-1.0, 2.0)]]
        {
            assert!(matches!(Division::of(40.0, &at(wrong)), Err(Fault::TabsOverlap { .. })), "{wrong:?}");
        }
    }

    #[test]
    fn tabs_that_leave_nothing_to_cut_are_refused() {
        assert!(matches!(
            Division::of(10.0, &Tabs::Even { count: 4, length: 2.5 }),
            Err(Fault::TabsTooLong { .. })
        ));
    }
}
