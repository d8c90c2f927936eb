//! A block as a macro program makes it: words with their values, before they are spelled.

use super::number::Number;
use crate::formats::gcode::numbers;
use crate::place::Spot;

/// A block that was made. One is used again for every block.
#[derive(Clone, Debug)]
pub struct Block<N> {
    /// Which source block made it: an index into the program, the same for every turn of a loop.
    pub source: u32,
    /// Where that source block stands.
    pub spot: Spot,
    /// The level of `/` in front, 0 where there is none; `/` alone is level 1.
    pub skip: u8,
    /// Its N number, where it has one.
    pub number: Option<u64>,
    /// The words in source order, those with a null value left out.
    pub words: Vec<Word<N>>,
    /// Remarks, as ranges into the source's text, brackets left out; those in front of all words too.
    pub remarks: Vec<(u32, u32)>,
}

/// A word that was made.
#[derive(Clone, Copy, Debug)]
pub struct Word<N> {
    /// Its capital letter.
    pub letter: u8,
    /// What it says.
    pub amount: Amount<N>,
}

/// The number of a word.
#[derive(Clone, Copy, Debug)]
pub enum Amount<N> {
    /// As it is written in the program: `G01`, `F200`, `X25`. What a missing point means is the printer's to know.
    Written {
        /// Its value.
        number: numbers::Number,
        /// Where its digits (with their sign) stand in the text of its source, without blanks: from, to. Nowhere (0, 0)
        /// for the M00 of `#3006`.
        digits: (u32, u32),
    },
    /// Computed: `X[#101]`, `X#1`, `X-#1`; a length in the program's unit, an angle in degrees.
    Computed(N),
}

impl<N: Number> Word<N> {
    /// Its number where it is a whole one: of a code.
    #[must_use]
    pub fn whole(&self) -> Option<i64> {
        match self.amount {
            Amount::Written { number, .. } => (number.decimals == 0).then_some(number.mantissa),
            Amount::Computed(value) => value.as_whole(),
        }
    }
}

impl<N> Default for Block<N> {
    fn default() -> Self {
        Self {
            source: 0,
            spot: Spot::default(),
            skip: 0,
            number: None,
            words: Vec::new(),
            remarks: Vec::new(),
        }
    }
}

/// What a turn of the expansion came to.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Turn {
    /// A block was made.
    Block,
    /// The fuel ran out before a block was made; go on when there is time again.
    Working,
    /// The program ended; its last block (M02, M30, M99 as the last of a repetition) was made before.
    End,
}
