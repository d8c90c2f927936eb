//! Where the blocks of a program begin and what numbers they bear, and nothing else: fast enough to run ahead of a feed.
//!
//! A line is a block when it holds anything but blanks, remarks, a `%` line or the word that names a program; so a line
//! with an N word alone is one. [`super::Blocks`] counts the same way.

use std::io::Read;

use super::dialect::Dialect;
use super::words::{self, Kind, Word};
use crate::formats::ReadError;
use crate::formats::lines::{Line, Lines};
use crate::place::Spot;

/// Finds the blocks of a program.
#[derive(Debug)]
pub struct Boundaries<'d, R> {
    lines: Lines<R>,
    dialect: &'d Dialect,
    block: u64,
    words: Vec<Word>,
}

/// Where a block begins.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Boundary {
    /// Its number, from 1.
    pub block: u64,
    /// The number behind N, where it has one that is whole and short enough.
    pub label: Option<u32>,
    /// Where its line begins.
    pub spot: Spot,
}

impl<'d, R: Read> Boundaries<'d, R> {
    /// The blocks of a program from its start.
    pub fn new(source: R, dialect: &'d Dialect) -> Self {
        Self { lines: Lines::new(source), dialect, block: 0, words: Vec::new() }
    }

    /// The next block; none at the end of the source.
    ///
    /// # Errors
    ///
    /// When the source fails, is UTF-16, or has a line that is too long or with a remark that is not closed.
    #[inline]
    pub fn next_boundary(&mut self) -> Result<Option<Boundary>, ReadError> {
        while self.lines.advance()? {
            let line = self.lines.line();
            let label = match line.bytes.first() {
                Some(b'N') => label(&line.bytes[1..]),
                Some(first) if first.is_ascii_uppercase() && !self.dialect.names_program(*first) => NONE,
                _ => ASK,
            };
            let label = match label {
                ASK => match self.look_closely()? {
                    Some(label) => label,
                    None => continue,
                },
                NONE => None,
                label => u32::try_from(label).ok(),
            };
            self.block += 1;
            return Ok(Some(Boundary { block: self.block, label, spot: self.lines.line().spot(0) }));
        }
        Ok(None)
    }

    /// Whether the line is a block, and its number, by all its words.
    #[cold]
    fn look_closely(&mut self) -> Result<Option<Option<u32>>, ReadError> {
        let line = self.lines.line();
        words::cut(line.bytes, &mut self.words).map_err(|e| unclosed(&line, e))?;
        Ok(counts(&self.words, self.dialect).then(|| label_of(&self.words)))
    }
}

impl<R: Read> Iterator for Boundaries<'_, R> {
    type Item = Result<Boundary, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_boundary().transpose()
    }
}

/// A block without a number, or one that must be looked at word by word; beyond every number.
const NONE: u64 = u64::MAX;
/// See [`NONE`].
const ASK: u64 = u64::MAX - 1;

/// The number at the start of a text, when it is a plain one.
#[inline]
fn label(text: &[u8]) -> u64 {
    let mut label = 0u64;
    for (n, byte) in text.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            // `N2 = 5` sets something, and a point makes another number of it.
            let next = if *byte == b' ' { text.get(n + 1).copied().unwrap_or(b' ') } else { *byte };
            return if n > 0 && next.is_ascii_alphabetic() { label } else { ASK };
        }
        if n > 8 {
            return ASK;
        }
        label = label * 10 + u64::from(digit);
    }
    if text.is_empty() { ASK } else { label }
}

/// Whether a line with these words is a block.
pub(super) fn counts(words: &[Word], dialect: &Dialect) -> bool {
    let mut names = 0;
    for word in words {
        match word.kind {
            Kind::Comment | Kind::Percent => {}
            // The word that names a program stands alone.
            Kind::Word if dialect.names_program(word.letter) && names == 0 => names = 1,
            _ => return true,
        }
    }
    false
}

/// The number of the first N word, where only a skip stands before it.
pub(super) fn label_of(words: &[Word]) -> Option<u32> {
    let first = words.iter().find(|w| !matches!(w.kind, Kind::Comment | Kind::Skip))?;
    if first.letter == b'N' { first.whole() } else { None }
}

/// The error about a remark that is not closed.
pub(super) fn unclosed(line: &Line<'_>, unclosed: words::Unclosed) -> ReadError {
    ReadError::Program {
        message: "the remark is not closed".into(),
        place: line.place(unclosed.at, line.bytes.len().saturating_sub(unclosed.at)),
        help: "put `)` behind it: what it swallows could be a motion".into(),
    }
}
