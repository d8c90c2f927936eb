//! A source cut into lines, and a line of blocks that run together, however long, into pieces of whole blocks.
//!
//! That is what sets it apart from [`crate::formats::lines`], which refuses every long line. The piece in work stays in
//! the buffer until the next is asked for, so that an error can show it.

use std::io::{self, Read};

use crate::formats::ReadError;
use crate::place::{Place, Spot};

/// The longest line that is held; a longer one is an error, not a buffer, unless it is of blocks that run together.
pub const LINE_BYTES_MAX: usize = 65_536;

/// Cuts a source into pieces.
#[derive(Debug)]
pub(super) struct Pieces<R> {
    source: R,
    buffer: Box<[u8]>,
    /// The piece in work, its line end included.
    from: usize,
    end: usize,
    /// How much of the buffer is filled.
    filled: usize,
    exhausted: bool,
    /// Byte of the source at which the piece begins.
    byte: u64,
    line: u64,
    /// Columns of the line before the piece.
    column: u64,
}

impl<R: Read> Pieces<R> {
    pub(super) fn new(source: R) -> Self {
        Self {
            source,
            buffer: vec![0; BUFFER_BYTES].into_boxed_slice(),
            from: 0,
            end: 0,
            filled: 0,
            exhausted: false,
            byte: 0,
            line: 0,
            column: 0,
        }
    }

    /// Goes on to the next piece; false at the end of the source.
    pub(super) fn next_piece(&mut self) -> Result<bool, ReadError> {
        let passed = (self.end - self.from) as u64;
        self.byte += passed;
        if passed > 0 && self.buffer[self.end - 1] != b'\n' {
            self.column += passed;
        } else {
            self.line += 1;
            self.column = 0;
        }
        self.from = self.end;
        let mut searched = self.from;
        loop {
            let stop = self.filled.min(self.from + LINE_BYTES_MAX);
            if let Some(found) = memchr::memchr(b'\n', self.buffer.get(searched..stop).unwrap_or_default()) {
                self.end = searched + found + 1;
                break;
            }
            searched = stop;
            if self.filled - self.from > LINE_BYTES_MAX {
                self.cut_long_line()?;
                break;
            }
            let kept = searched - self.from;
            self.end = self.filled;
            if !self.fill()? {
                self.end = self.filled;
                break;
            }
            // The piece stands at the front now.
            searched = kept;
        }
        if self.byte == 0 {
            self.refuse_utf_16()?;
        }
        Ok(self.end > self.from)
    }

    /// Whether anything comes after the piece in work.
    pub(super) fn has_more(&mut self) -> Result<bool, ReadError> {
        Ok(self.end < self.filled || self.fill()?)
    }

    /// The piece in work, its line end included.
    #[inline]
    pub(super) fn piece(&self) -> &[u8] {
        &self.buffer[self.from..self.end]
    }

    /// Byte of the source at which the piece begins.
    pub(super) fn byte(&self) -> u64 {
        self.byte
    }

    /// Number of the line the piece belongs to.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// Where something at an offset of the piece stands.
    #[inline]
    pub(super) fn spot(&self, at: usize) -> Spot {
        Spot { byte: self.byte + at as u64, line: self.line, column: self.column + at as u64 + 1 }
    }

    pub(super) fn place(&self, at: usize, width: usize) -> Place {
        let piece = self.piece();
        let piece = piece.strip_suffix(b"\n").unwrap_or(piece);
        let piece = piece.strip_suffix(b"\r").unwrap_or(piece);
        let mut place = Place::in_line(piece, self.line, self.byte, at.min(piece.len()), width);
        place.column += self.column;
        place
    }

    fn cut_long_line(&mut self) -> Result<(), ReadError> {
        self.end = self.from + LINE_BYTES_MAX + 1;
        match end_of_last_block(self.piece()) {
            Some(length) => {
                self.end = self.from + length;
                Ok(())
            }
            None => Err(ReadError::Program {
                message: format!("the line is longer than {LINE_BYTES_MAX} bytes and not of blocks alone"),
                place: self.place(LINE_BYTES_MAX, 1),
                help: "break it; only blocks may run together at any length".into(),
            }),
        }
    }

    fn refuse_utf_16(&self) -> Result<(), ReadError> {
        match self.piece() {
            [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => Err(ReadError::Program {
                message: "the text is UTF-16, two bytes a character".into(),
                place: self.place(0, 2),
                help: "save it again as plain text (ASCII, UTF-8 or GBK)".into(),
            }),
            _ => Ok(()),
        }
    }

    /// Reads more behind what there is, the piece in work moved to the front; false at the end of the source.
    fn fill(&mut self) -> Result<bool, ReadError> {
        if self.exhausted {
            return Ok(false);
        }
        self.buffer.copy_within(self.from..self.filled, 0);
        self.end -= self.from;
        self.filled -= self.from;
        self.from = 0;
        loop {
            match self.source.read(&mut self.buffer[self.filled..]) {
                Ok(0) => {
                    self.exhausted = true;
                    return Ok(false);
                }
                Ok(count) => {
                    self.filled += count;
                    return Ok(true);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
    }
}

/// Where the last whole block of a piece of line ends, if the piece is of blocks alone.
fn end_of_last_block(piece: &[u8]) -> Option<usize> {
    if piece.iter().any(|byte| matches!(byte, b';' | b'(' | b'*' | b'=' | b'%')) {
        return None;
    }
    let ends = |pair: &[u8]| matches!(pair, [b'L' | b'l' | b'R' | b'r', b'1'..=b'4']);
    piece.windows(2).rposition(ends).map(|at| at + 2)
}

/// Large enough that a long line and a good read fit.
const BUFFER_BYTES: usize = 3 * LINE_BYTES_MAX;

#[cfg(test)]
mod tests;
