//! How made blocks are spelled: decimals, points, N numbers, remarks, as a machine wants them.
//!
//! What a letter's number is (a length, an angle, a whole code) is the dialect's to say; for letters it does not know
//! (Z of a mill, say) the usual reading of milling controls stands in.

use crate::formats::gcode::Dialect;
use crate::formats::gcode::dialect::Role;

/// How blocks are spelled.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// Digits behind the point of lengths and angles: in millimetres, in inches.
    pub decimals: [u8; 2],
    /// Whether a length or an angle has a point.
    pub point: Point,
    /// Whether zeros at the end are written: `24.980` or `24.98`, `25.000` or `25.`.
    pub trailing_zeros: bool,
    /// Whether `0.5` or `.5`.
    pub leading_zero: bool,
    /// What becomes of N numbers.
    pub numbers: Numbering,
    /// Whether remarks are written.
    pub remarks: bool,
    /// Whether blanks stand between words.
    pub blanks: bool,
    /// The longest line the control takes, without its end; none: no limit is known.
    pub line_max: Option<usize>,
    /// What a written length without a point counts, nanometres, by unit: mm, inch. None: it goes out as it is written.
    pub without_point: [Option<i64>; 2],
    /// What the number of a letter is.
    pub amounts: [AmountOf; 26],
}

/// When a point is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Point {
    /// In every length and angle.
    Always,
    /// Never: numbers are whole least increments, `24980` for 24.980.
    Never,
}

/// What becomes of N numbers.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Numbering {
    /// Those of the source; in a loop the same comes again and again.
    Keep,
    /// None is written.
    Strip,
    /// Every block gets the next one.
    Count {
        /// From one block to the next; the first has this too.
        step: u32,
        /// The largest; behind it they begin again.
        last: u32,
    },
}

/// What the number of a letter is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum AmountOf {
    /// A length, or an angle: with a point.
    Length,
    /// A feed: with a point only where it is no whole number.
    Feed,
    /// G: a whole number or one with a decimal, as G54.1.
    Code,
    /// A whole number.
    Whole,
}

impl Default for Form {
    fn default() -> Self {
        Self {
            decimals: [3, 4],
            point: Point::Always,
            trailing_zeros: true,
            leading_zero: true,
            numbers: Numbering::Keep,
            remarks: true,
            blanks: true,
            line_max: None,
            without_point: [None; 2],
            amounts: std::array::from_fn(|n| usual(b'A' + n as u8)),
        }
    }
}

impl Form {
    /// The same for the letters of a dialect.
    #[must_use]
    pub fn of_dialect(mut self, dialect: &Dialect) -> Self {
        for (letter, amount) in (b'A'..=b'Z').zip(&mut self.amounts) {
            *amount = match dialect.role(letter) {
                Role::Length(_) | Role::Angle | Role::OffsetValue => AmountOf::Length,
                Role::Feed => AmountOf::Feed,
                Role::Kept | Role::Register | Role::Number => AmountOf::Whole,
                Role::Refused | Role::Unknown => usual(letter),
            };
        }
        self
    }

    /// What the number of a letter is.
    #[inline]
    #[must_use]
    pub fn amount(&self, letter: u8) -> AmountOf {
        self.amounts.get(usize::from(letter.wrapping_sub(b'A'))).copied().unwrap_or(AmountOf::Whole)
    }
}

/// What milling controls take the number of a letter for.
fn usual(letter: u8) -> AmountOf {
    match letter {
        b'X' | b'Y' | b'Z' | b'U' | b'V' | b'W' | b'I' | b'J' | b'K' | b'R' | b'Q' | b'A' | b'B' | b'C' => {
            AmountOf::Length
        }
        b'F' | b'E' => AmountOf::Feed,
        b'G' => AmountOf::Code,
        _ => AmountOf::Whole,
    }
}
