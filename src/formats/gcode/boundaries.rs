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
    pub fn next_boundary(&mut self) -> Result<Option<Boundary>, ReadError> {
        while let Some(line) = self.lines.next_line()? {
            let label = match line.bytes.first() {
                None => continue,
                Some(b'N') => match label(&line.bytes[1..]) {
                    Some(label) => Some(label),
                    None => {
                        words::cut(line.bytes, &mut self.words).map_err(|e| unclosed(&line, e))?;
                        label_of(&self.words)
                    }
                },
                Some(first) if first.is_ascii_uppercase() && !self.dialect.names_program(*first) => None,
                Some(_) => {
                    words::cut(line.bytes, &mut self.words).map_err(|e| unclosed(&line, e))?;
                    if !counts(&self.words, self.dialect) {
                        continue;
                    }
                    label_of(&self.words)
                }
            };
            self.block += 1;
            return Ok(Some(Boundary { block: self.block, label, spot: line.spot(0) }));
        }
        Ok(None)
    }
}

impl<R: Read> Iterator for Boundaries<'_, R> {
    type Item = Result<Boundary, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_boundary().transpose()
    }
}

/// The number at the start of a text, when it is a plain one.
fn label(text: &[u8]) -> Option<u32> {
    let mut label = 0u32;
    for (n, byte) in text.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            let plain = n > 0 && n < 10 && *byte != b'.';
            return plain.then_some(label);
        }
        label = label.wrapping_mul(10).wrapping_add(u32::from(digit));
    }
    (0 < text.len() && text.len() < 10).then_some(label)
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
