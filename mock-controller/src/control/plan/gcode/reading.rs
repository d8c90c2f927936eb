//! How a control reads G-code: what the manuals leave to its parameters.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

use super::Register;
use crate::dialect::gcode::Word;

/// What G-code means on this control, where makers differ.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GcodeSettings {
    /// What I and J are counted from. Default: the arc's start.
    pub arc_centre: ArcCentre,
    /// What a length without a point means. Default: the alarm `number`.
    pub unit_without_point: UnitWithoutPoint,
    /// Lines that begin with `/` are passed over. Default: they are carried out.
    pub block_skip: bool,
    /// Words that are passed over, and counted; every other word that is not acted on is the alarm `word`.
    pub ignored_words: IgnoredWords,
    /// The offsets keyed in by number, µm, not negative. Default: none; then every D and H, where it is an offset's
    /// number, but D0 and H0, is the wire offset.
    pub offset_registers: BTreeMap<Register, f64>,
}

/// What I and J are counted from.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum ArcCentre {
    /// The arc's start.
    #[default]
    Incremental,
    /// The program's zero.
    Absolute,
}

/// What a length without a point means.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum UnitWithoutPoint {
    /// Nothing: the alarm `number`, also for 0.
    #[default]
    Error,
    /// The least unit: 0.001 mm, or 0.0001 inch under G20.
    Least,
    /// mm, or inch under G20.
    Whole,
}

/// A set of words: a letter (`C`), a letter and a number (`M50`), or a range (`M03-M29`).
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct IgnoredWords {
    ranges: BTreeSet<(char, i64, i64)>,
}

impl IgnoredWords {
    /// Whether this word is among them.
    #[must_use]
    pub fn holds(&self, word: &Word) -> bool {
        self.ranges.iter().any(|&(letter, least, most)| {
            letter == word.letter
                && ((least, most) == EVERY
                    || word.number.whole().is_some_and(|n| (least..=most).contains(&n)))
        })
    }
}

impl Default for IgnoredWords {
    /// Conditions C E S H, taper angle T, feed F, P, and the M words that move nothing: M03 to M29, M31 to M97.
    fn default() -> Self {
        let letters = ['C', 'E', 'S', 'H', 'T', 'P', 'F'].map(|letter| (letter, EVERY.0, EVERY.1));
        let ranges = letters.into_iter().chain([('M', 3, 29), ('M', 31, 97)]).collect();
        IgnoredWords { ranges }
    }
}

/// Not a list of words.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct NotAWord(String);

impl fmt::Display for NotAWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} is no letter, letter and number, or range of them", self.0)
    }
}

impl std::error::Error for NotAWord {}

impl FromStr for IgnoredWords {
    type Err = NotAWord;

    /// Reads a list like `C,E,M03-M29`; empty: none.
    fn from_str(list: &str) -> Result<Self, NotAWord> {
        let mut ranges = BTreeSet::new();
        for item in list.split(',').map(str::trim).filter(|item| !item.is_empty()) {
            let range = item.split_once('-').map_or_else(
                || word(item),
                |(least, most)| match (word(least)?, word(most)?) {
                    ((a, least, least_too), (b, most, most_too))
                        if a == b && least == least_too && most == most_too && least <= most =>
                    {
                        Some((a, least, most))
                    }
                    _ => None,
                },
            );
            ranges.insert(range.ok_or_else(|| NotAWord(item.to_owned()))?);
        }
        Ok(IgnoredWords { ranges })
    }
}

fn word(text: &str) -> Option<(char, i64, i64)> {
    let mut characters = text.trim().chars();
    let letter = characters.next().filter(char::is_ascii_alphabetic)?.to_ascii_uppercase();
    let digits = characters.as_str();
    if digits.is_empty() {
        return Some((letter, EVERY.0, EVERY.1));
    }
    let number = digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok())??;
    Some((letter, number, number))
}

/// Every number, whole or not.
const EVERY: (i64, i64) = (i64::MIN, i64::MAX);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dialect::gcode::parse_line;

    fn holds(list: &IgnoredWords, word: &str) -> bool {
        list.holds(&parse_line(word, 1).unwrap().words[0])
    }

    #[test]
    fn a_list_holds_letters_words_and_ranges() {
        let list: IgnoredWords = "c, M03-M29,G54".parse().unwrap();
        for word in ["C1", "C1.5", "M3", "M29", "G54"] {
            assert!(holds(&list, word), "{word}");
        }
        for word in ["M30", "M2", "G55", "E1", "G54.1"] {
            assert!(!holds(&list, word), "{word}");
        }
        assert!(!holds(&"".parse().unwrap(), "F1"));
        for wrong in ["5", "CC", "M1-", "M5-M1", "M1-G5", "M-5", "C-E"] {
            assert!(wrong.parse::<IgnoredWords>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_moves_or_calls_is_not_ignored_by_default() {
        for word in ["M00", "M02", "M30", "M98", "M99", "G05", "U1.", "A1."] {
            assert!(!holds(&IgnoredWords::default(), word), "{word}");
        }
    }
}
