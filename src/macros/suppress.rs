//! Which words say again what is in force: those that `--suppress` leaves out.
//!
//! Left out are G00-G03 and G90, G91 that are in force, a feed that is, and a coordinate of G00, G01 under G90 that is
//! where the machine stands already. A block with any other G word is written whole, and what it may have changed is
//! taken as unknown; so is where the machine stands behind a word that may move it (M06, say). A block never vanishes: its
//! first word stays, so that blocks count alike with and without it.

use super::block::{Amount, Word};
use super::form::Form;
use super::number::Number;

/// What is in force, as far as words have said.
#[derive(Clone, Debug, Default)]
pub(super) struct InForce {
    motion: Option<i64>,
    distance: Option<i64>,
    feed: Option<Said>,
    /// X, Y, Z in units of the last decimal printed.
    axes: [Option<i64>; 3],
}

/// A number, to be compared with the next one.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Said {
    Written { mantissa: i64, decimals: u8, point: bool },
    Computed(i64),
}

impl InForce {
    /// The words to leave out, a bit each, and notes what the block puts in force. Words beyond the 63rd are never left out.
    pub(super) fn dropped<N: Number>(&mut self, form: &Form, unit: usize, words: &[Word<N>]) -> u64 {
        let codes = || words.iter().filter(|word| word.letter == b'G').map(Word::whole);
        let is_plain = codes().all(|code| matches!(code, Some(0..=3 | 17..=19 | 90 | 91 | 94)));
        if !is_plain {
            // Coordinates mean something else here, or the block changes what they are counted from.
            let keeps = |code: Option<i64>| matches!(code, Some(0..=4 | 10 | 17..=30 | 40..=59 | 90..=99));
            let motion = self.motion.filter(|_| codes().all(keeps));
            *self = Self { distance: self.distance, motion, ..Self::default() };
            for code in codes().flatten() {
                match code {
                    0..=3 => self.motion = Some(code),
                    90 | 91 => self.distance = Some(code),
                    _ => {}
                }
            }
            return 0;
        }
        let mut dropped = 0;
        let mut bit = 1u64;
        // The modal words first: they hold for the whole block, wherever in it they stand.
        for word in words {
            match (word.letter, word.whole()) {
                (b'G', Some(code @ 0..=3)) => {
                    dropped |= if self.motion.replace(code) == Some(code) { bit } else { 0 };
                }
                (b'G', Some(code @ (90 | 91))) => {
                    dropped |= if self.distance.replace(code) == Some(code) { bit } else { 0 };
                    if code == 91 {
                        self.axes = [None; 3];
                    }
                }
                _ => {}
            }
            bit <<= 1;
        }
        let is_straight = matches!(self.motion, Some(0 | 1));
        let mut bit = 1u64;
        for word in words {
            match word.letter {
                b'F' => {
                    let said = said(word);
                    if said.is_some() && self.feed == said {
                        dropped |= bit;
                    }
                    self.feed = said;
                }
                b'X'..=b'Z' => {
                    let axis = &mut self.axes[usize::from(word.letter - b'X')];
                    let value = match word.amount {
                        Amount::Written { number, .. } => form.value(unit, number),
                        Amount::Computed(value) => value.at_decimals(form.decimals[unit]),
                    };
                    if self.distance == Some(90) {
                        if value.is_some() && *axis == value && is_straight {
                            dropped |= bit;
                        }
                        *axis = value;
                    } else {
                        *axis = None;
                    }
                }
                _ => {}
            }
            bit <<= 1;
        }
        // A tool change, a subprogram, a word of the machine may move it.
        if words
            .iter()
            .any(|word| !matches!(word.letter, b'F'..=b'G' | b'I'..=b'K' | b'N' | b'R'..=b'S' | b'X'..=b'Z'))
        {
            self.axes = [None; 3];
        }
        let all = if words.len() >= 64 { u64::MAX } else { (1 << words.len()) - 1 };
        if dropped & all == all { dropped & !1 } else { dropped }
    }
}

fn said<N: Number>(word: &Word<N>) -> Option<Said> {
    match word.amount {
        Amount::Written { number, .. } => {
            Some(Said::Written { mantissa: number.mantissa, decimals: number.decimals, point: number.point })
        }
        Amount::Computed(value) => value.at_decimals(3).map(Said::Computed),
    }
}
