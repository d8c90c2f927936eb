//! Reading 4B, and the 3B blocks among it: one block at a time, with its place.
//!
//! The reader is that of 3B, which takes a fourth B and a flag where they are allowed. The flag stands before G or behind
//! it; inside a block `DD` is the flag, between blocks the stop word. What the flag and the offset make of the path is
//! [`super::offset`].

use std::io;

use super::Block;
use crate::formats::ReadError;
use crate::formats::three_b::read as three_b;
use crate::place::Spot;

/// Anything a 4B source says.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// A block; its text is in [`Reader::text`].
    Block(Block),
    /// `DD`, `D` or `E`.
    StopWord(&'static str),
    /// A remark; [`Reader::text`] has it without its brackets or semicolon.
    Comment,
    /// A header line, a row of stars, or `%`; [`Reader::text`] has it as it stands.
    Header,
    /// A line number (`N 12:`); [`Reader::text`] has its digits.
    Number,
}

/// Reads a 4B program.
#[derive(Debug)]
pub struct Reader<R> {
    reader: three_b::Reader<R>,
}

impl<R: io::Read> Reader<R> {
    /// A reader at the start of a program.
    pub fn new(input: R) -> Self {
        Self { reader: three_b::Reader::of_four_b(input) }
    }

    /// The next thing the source says; none at its end.
    ///
    /// # Errors
    ///
    /// With the place of the first thing that is neither 3B nor 4B, or of a block no control can run.
    pub fn next_entry(&mut self) -> Result<Option<Entry>, ReadError> {
        Ok(self.reader.next_entry()?.map(|entry| match entry {
            three_b::Entry::Item(three_b::Item::Block(block)) => {
                let beyond = self.reader.beyond();
                Entry::Block(Block { block, fourth: beyond.fourth, flag: beyond.flag })
            }
            three_b::Entry::Item(three_b::Item::StopWord(word)) => Entry::StopWord(word),
            three_b::Entry::Comment => Entry::Comment,
            three_b::Entry::Header => Entry::Header,
            three_b::Entry::Number => Entry::Number,
        }))
    }

    /// The text of what was just read: of a block as it stands in the source without white space, in capitals.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        self.reader.text()
    }

    /// Where what was just read begins.
    #[must_use]
    pub fn spot(&self) -> Spot {
        self.reader.spot()
    }

    /// The byte of the source behind what was just read.
    #[must_use]
    pub fn end_byte(&self) -> u64 {
        self.reader.end_byte()
    }
}
