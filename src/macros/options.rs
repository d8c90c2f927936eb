//! How a program is read and run, where controls differ or only the machine knows.

use crate::formats::gcode::numbers::Unit;

/// The choices.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Options {
    /// Whose rules hold where the two makers differ.
    pub control: Control,
    /// The most steps without a block before a program is taken for one that does not end.
    pub budget: u64,
    /// How often a main program that ends with M99 runs; none refuses it.
    pub repeat: Option<u64>,
    /// What `#3011` (year, month, day) and `#3012` (hour, minute, second) say; none refuses them.
    pub date_time: Option<(u32, u32)>,
    /// What `/` in front of a block does.
    pub skip: Skip,
    /// What `;` with text behind it is.
    pub semicolon: Semicolon,
    /// Whether lines of remarks alone are made into blocks without words.
    pub remarks: bool,
    /// What an argument or a coordinate without a point is.
    pub pointless: Pointless,
    /// The unit in force where a program begins.
    pub unit: Unit,
    /// The letters of the axes of `#5001`, `#5002`…
    pub axes: Vec<u8>,
    /// The G codes in force where a program begins, in tenths: 900 is G90.
    pub in_force: Vec<u16>,
    /// How deep macro calls (G65, G66) may be: four levels, Fanuc B-63684EN/01, page 278.
    pub macro_levels: u8,
    /// How deep calls of all kinds may be.
    pub levels: u8,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            control: Control::Fanuc,
            budget: 100_000_000,
            repeat: None,
            date_time: None,
            skip: Skip::Kept,
            semicolon: Semicolon::Refused,
            remarks: true,
            pointless: Pointless::Refused,
            unit: Unit::Millimetre,
            axes: b"XYZ".to_vec(),
            in_force: Vec::new(),
            macro_levels: 4,
            levels: 14,
        }
    }
}

/// A maker.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Control {
    /// A condition is no number.
    Fanuc,
    /// A condition is 1 or 0, and a number is a condition (96-8000, conditional expressions).
    Haas,
}

/// The switches of block skip.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Skip {
    /// Not known: blocks keep their `/`, and what cannot keep it is refused.
    Kept,
    /// Known: bit n is the switch of level n; blocks behind a switch that is on are left out, others lose their `/`.
    Switches(u16),
}

/// What stands behind `;`.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Semicolon {
    /// A remark, but for text that reads as a block: that is refused.
    Refused,
    /// `;` is the end of a block, the next one follows.
    EndOfBlock,
    /// A remark in any case.
    Remark,
}

/// A number without a point.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Pointless {
    /// Refused where it makes a difference.
    Refused,
    /// `X25` is 25.
    Whole,
    /// `X25` is 25 of the least increment: 0.001 mm or degrees, 0.0001 inch.
    LeastIncrement,
}

/// How many decimals the least increment of a letter's word has.
pub(super) fn decimals(letter: u8, unit: Unit) -> u8 {
    match letter {
        b'A' | b'B' | b'C' => 3,
        b'D' | b'E' | b'G' | b'H' | b'L' | b'M' | b'N' | b'O' | b'P' | b'S' | b'T' => 0,
        _ => match unit {
            Unit::Millimetre => 3,
            Unit::Inch => 4,
        },
    }
}
