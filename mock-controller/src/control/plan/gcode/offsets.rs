//! D and H: which of the offsets the control holds stands beside the path.
//!
//! - `D0` and `H0` are no offset. Without a number it is the offset keyed in.
//! - Where no registers are keyed in, every other number is the offset keyed in, too; else a number without a register
//!   is the alarm `offset`.
//! - D is an offset's number wherever it stands, and stays in force to the program's end. H is one beside G41 or G42,
//!   and wherever it stands if an H register is keyed in; else it is a condition.
//!
//! Readings of this mock, unverified for any control: some call the offset D, some H (the same wire-EDM controls use
//! H for conditions).
//!
//! Not done: registers that the program sets itself (`H1 = …`, G10).

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use super::{Fault, GcodePlan, Said, Side};
use crate::control::plan::Motion;
use crate::control::settings::Settings;
use crate::dialect::gcode::Word;

/// A place for one offset: D or H, and a number from 1.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Register {
    letter: char,
    number: i64,
}

/// Not the name of a register.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct NotARegister(String);

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.letter, self.number)
    }
}

impl fmt::Display for NotARegister {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} is no register: D or H, and a number from 1 to 9999", self.0)
    }
}

impl std::error::Error for NotARegister {}

impl FromStr for Register {
    type Err = NotARegister;

    fn from_str(name: &str) -> Result<Self, NotARegister> {
        let wrong = || NotARegister(name.to_owned());
        let mut characters = name.chars();
        let letter = characters.next().map(|letter| letter.to_ascii_uppercase());
        let letter = letter.filter(|letter| matches!(letter, 'D' | 'H')).ok_or_else(wrong)?;
        let digits = characters.as_str();
        let is_number = (1..=4).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = if is_number { digits.parse().map_err(|_| wrong())? } else { 0 };
        if number > 0 { Ok(Register { letter, number }) } else { Err(wrong()) }
    }
}

/// What the control holds, µm, none of it negative.
pub(super) struct Offsets {
    keyed_in_um: f64,
    registers: BTreeMap<Register, f64>,
}

impl Offsets {
    pub(super) fn new(settings: &Settings) -> Offsets {
        Offsets { keyed_in_um: settings.wire_offset_um, registers: settings.gcode.offset_registers.clone() }
    }

    /// Whether a word is an offset's number, in a line with G41 or G42 or in another.
    pub(super) fn are_told_by(&self, word: &Word, compensates: bool) -> bool {
        let has_h = || self.registers.keys().any(|register| register.letter == 'H');
        word.letter == 'D' || (word.letter == 'H' && (compensates || has_h()))
    }

    /// The offset by its number.
    pub(super) fn of(&self, word: Option<&Word>) -> Result<f64, Fault> {
        let Some(word) = word else {
            return Ok(self.keyed_in_um);
        };
        match word.number.whole() {
            Some(0) => Ok(0.0),
            Some(number @ 1..) if self.registers.is_empty() && number <= NUMBER_MAX => Ok(self.keyed_in_um),
            number => number
                .and_then(|number| self.registers.get(&Register { letter: word.letter, number }))
                .copied()
                .ok_or_else(|| Fault::new("offset", &format!("{word}: no such offset register"))),
        }
    }
}

impl GcodePlan {
    /// Carries out what a line says of sides and offsets.
    pub(super) fn change_side(&mut self, said: &Said, out: &mut Vec<Motion>) -> Result<(), Fault> {
        self.modal.offset = said.offset.or(self.modal.offset);
        let side = match (said.beside, self.modal.right) {
            (Some(Side::None), _) => {
                self.modal.right = None;
                return self.beside.finish(out);
            }
            (Some(Side::Left), _) => -1.0,
            (Some(Side::Right), _) => 1.0,
            (None, Some(right)) if said.offset.is_some() => right.signum(),
            (None, _) => return Ok(()),
        };
        let right = side * self.offsets.of(self.modal.offset.as_ref())?;
        match self.modal.right.replace(right) {
            Some(held) if held != right => {
                Err(Fault::new("compensation", "the side or the offset changes without G40"))
            }
            Some(_) => Ok(()), // Told again what it was told already.
            None => {
                // Without an offset the path is cut as it stands.
                if right != 0.0 {
                    self.beside.start(right);
                }
                Ok(())
            }
        }
    }
}

/// Four digits are more than any panel shows (a guess).
const NUMBER_MAX: i64 = 9999;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_register_is_d_or_h_and_a_number_from_1() {
        for (text, name) in [("D1", "D1"), ("h0012", "H12"), ("d9999", "D9999")] {
            assert_eq!(text.parse::<Register>().unwrap().to_string(), name);
        }
        for wrong in ["", "D", "D0", "H000", "D-1", "D+1", "1", "E1", "D1.0", "D10000", "DD1", "D 1"] {
            assert!(wrong.parse::<Register>().is_err(), "{wrong}");
        }
    }
}
