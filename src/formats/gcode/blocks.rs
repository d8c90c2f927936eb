//! Blocks with their place, words and modal state, one at a time, without an allocation a block.

use std::io::Read;

use super::boundaries::{counts, label_of, unclosed};
use super::dialect::Dialect;
use super::modal::Modal;
use super::words::{self, Word};
use crate::formats::ReadError;
use crate::formats::lines::{Line, Lines};

/// Reads a program line by line.
#[derive(Debug)]
pub struct Blocks<'d, R> {
    lines: Lines<R>,
    dialect: &'d Dialect,
    words: Vec<Word>,
    modal: Modal,
    block: u64,
    counts: bool,
}

/// A line of a program and what it says.
#[derive(Clone, Copy, Debug)]
pub struct Block<'a> {
    /// The line.
    pub line: Line<'a>,
    /// Its words, and what stands between them.
    pub words: &'a [Word],
    /// What is in force once it is executed.
    pub modal: &'a Modal,
    /// The number of the block, from 1; of a line that is none, that of the last one.
    pub number: u64,
    /// Whether the line counts as a block.
    pub counts: bool,
}

impl Block<'_> {
    /// The number of its N word.
    #[must_use]
    pub fn label(&self) -> Option<u32> {
        label_of(self.words)
    }
}

impl<'d, R: Read> Blocks<'d, R> {
    /// The blocks of a program from its start.
    pub fn new(source: R, dialect: &'d Dialect) -> Self {
        Self {
            lines: Lines::new(source),
            dialect,
            words: Vec::new(),
            modal: Modal::at_start(dialect),
            block: 0,
            counts: false,
        }
    }

    /// The next line, also one that is no block; none at the end of the source.
    ///
    /// # Errors
    ///
    /// When the source fails, is UTF-16, or has a line that is too long or with a remark that is not closed.
    #[inline]
    pub fn next_block(&mut self) -> Result<Option<Block<'_>>, ReadError> {
        Ok(if self.advance()? { Some(self.block()) } else { None })
    }

    /// The line that was last read.
    #[inline]
    fn block(&self) -> Block<'_> {
        Block {
            line: self.lines.line(),
            words: &self.words,
            modal: &self.modal,
            number: self.block,
            counts: self.counts,
        }
    }

    /// Reads the next line; false at the end of the source.
    fn advance(&mut self) -> Result<bool, ReadError> {
        if !self.lines.advance()? {
            return Ok(false);
        }
        let line = self.lines.line();
        words::cut(line.bytes, &mut self.words).map_err(|e| unclosed(&line, e))?;
        self.counts = counts(&self.words, self.dialect);
        self.block += u64::from(self.counts);
        self.modal.take_in(&self.words, self.dialect);
        Ok(true)
    }
}
