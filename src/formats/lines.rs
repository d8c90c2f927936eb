//! A source cut into lines, fast and in constant memory, each with its number and the byte it begins at.
//!
//! A line ends at LF, CR or CR LF. A UTF-8 byte order mark is passed over; UTF-16 is recognised and refused, and so is a
//! line of more than [`LINE_BYTES_MAX`]: a line is held whole, a program never.

use std::io::Read;

use super::ReadError;
use crate::place::{Place, Spot};

/// The longest line that is held; a longer one is an error, not a buffer.
pub const LINE_BYTES_MAX: usize = 65_536;

/// Cuts a source into lines.
#[derive(Debug)]
pub struct Lines<R> {
    source: R,
    buffer: Box<[u8]>,
    /// What of the buffer is filled and not yet given out.
    from: usize,
    to: usize,
    /// Where in the source the buffer begins.
    buffer_byte: u64,
    /// Number of the line last given out.
    number: u64,
    /// Where in the buffer the line last given out stands.
    line: (usize, usize),
    /// The last line ended with CR: an LF right behind it is the same end.
    after_cr: bool,
    /// Whether what is buffered holds a CR.
    has_returns: bool,
    exhausted: bool,
}

/// A line without its end.
#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    /// The bytes.
    pub bytes: &'a [u8],
    /// Its number, from 1.
    pub number: u64,
    /// The byte of the source it begins at.
    pub byte: u64,
}

impl Line<'_> {
    /// Where something at an offset of the line stands.
    #[must_use]
    pub fn spot(&self, at: usize) -> Spot {
        Spot { byte: self.byte + at as u64, line: self.number, column: at as u64 + 1 }
    }

    /// The place of `width` bytes at an offset of the line.
    #[must_use]
    pub fn place(&self, at: usize, width: usize) -> Place {
        Place::in_line(self.bytes, self.number, self.byte, at.min(self.bytes.len()), width)
    }
}

impl<R: Read> Lines<R> {
    /// The lines of a source from its start.
    pub fn new(source: R) -> Self {
        Self {
            source,
            buffer: vec![0; BUFFER_BYTES].into_boxed_slice(),
            from: 0,
            to: 0,
            buffer_byte: 0,
            number: 0,
            line: (0, 0),
            after_cr: false,
            has_returns: true,
            exhausted: false,
        }
    }

    /// The next line; none at the end of the source.
    ///
    /// # Errors
    ///
    /// When the source fails, is UTF-16, or has a line that is too long.
    #[inline]
    pub fn next_line(&mut self) -> Result<Option<Line<'_>>, ReadError> {
        Ok(if self.advance()? { Some(self.line()) } else { None })
    }

    /// Goes on to the next line; false at the end of the source.
    ///
    /// # Errors
    ///
    /// As [`Self::next_line`].
    #[inline]
    pub fn advance(&mut self) -> Result<bool, ReadError> {
        // Nearly every line ends in what is buffered, and nearly every source knows no CR.
        if !self.has_returns
            && let Some(length) = memchr::memchr(b'\n', &self.buffer[self.from..self.to])
            && length <= LINE_BYTES_MAX
        {
            self.line = (self.from, self.from + length);
            self.from += length + 1;
            self.number += 1;
            return Ok(true);
        }
        self.advance_slowly()
    }

    /// The line that was last gone on to.
    #[inline]
    #[must_use]
    pub fn line(&self) -> Line<'_> {
        let (start, end) = self.line;
        Line { bytes: &self.buffer[start..end], number: self.number, byte: self.buffer_byte + start as u64 }
    }

    fn advance_slowly(&mut self) -> Result<bool, ReadError> {
        if self.number == 0 && self.buffer_byte == 0 && self.to == 0 {
            self.open()?;
        }
        let mut searched = self.from;
        let end = loop {
            if self.after_cr && self.from < self.to {
                self.after_cr = false;
                if self.buffer[self.from] == b'\n' {
                    self.from += 1;
                    searched = self.from;
                }
            }
            if let Some(found) = memchr::memchr2(b'\n', b'\r', &self.buffer[searched..self.to]) {
                break searched + found;
            }
            if self.to - self.from > LINE_BYTES_MAX {
                return Err(self.too_long());
            }
            searched = self.to - self.from;
            if !self.fill()? {
                if self.from == self.to {
                    return Ok(false);
                }
                break self.to;
            }
            // `fill` has moved what is left to the front.
        };
        if end - self.from > LINE_BYTES_MAX {
            return Err(self.too_long());
        }
        let start = self.from;
        self.after_cr = self.buffer.get(end) == Some(&b'\r') && end < self.to;
        self.from = (end + 1).min(self.to);
        self.line = (start, end);
        self.number += 1;
        Ok(true)
    }

    /// Looks at the first bytes for a mark that tells the character code.
    fn open(&mut self) -> Result<(), ReadError> {
        while self.to < 3 && self.fill()? {}
        match self.buffer[..self.to] {
            [0xEF, 0xBB, 0xBF, ..] => self.from = 3,
            [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => {
                return Err(ReadError::Program {
                    message: "the text is UTF-16, two bytes a character".into(),
                    place: Place::in_line(&[], 1, 0, 0, 1),
                    help: "save it again as plain text (ASCII, UTF-8 or GBK)".into(),
                });
            }
            _ => {}
        }
        Ok(())
    }

    /// Moves what is left to the front and reads more behind it; false at the end of the source.
    fn fill(&mut self) -> Result<bool, ReadError> {
        if self.exhausted {
            // What is left stays in front, as after any fill.
            self.shift();
            return Ok(false);
        }
        self.shift();
        loop {
            match self.source.read(&mut self.buffer[self.to..]) {
                Ok(0) => {
                    self.exhausted = true;
                    return Ok(false);
                }
                Ok(count) => {
                    self.to += count;
                    self.has_returns =
                        self.after_cr || memchr::memchr(b'\r', &self.buffer[..self.to]).is_some();
                    return Ok(true);
                }
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
    }

    fn shift(&mut self) {
        self.buffer.copy_within(self.from..self.to, 0);
        self.buffer_byte += self.from as u64;
        self.to -= self.from;
        self.from = 0;
    }

    fn too_long(&self) -> ReadError {
        let line = &self.buffer[self.from..self.to];
        let byte = self.buffer_byte + self.from as u64;
        ReadError::Program {
            message: format!("the line is longer than {LINE_BYTES_MAX} bytes"),
            place: Place::in_line(line, self.number + 1, byte, LINE_BYTES_MAX, 1),
            help: "break it".into(),
        }
    }
}

/// Large enough that a long line and a good read fit.
const BUFFER_BYTES: usize = 4 * LINE_BYTES_MAX;

#[cfg(test)]
mod tests {
    use super::*;

    /// A source that gives a few bytes at a time.
    struct Drip<'a>(&'a [u8], usize);

    impl Read for Drip<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let count = self.1.min(self.0.len()).min(buffer.len());
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    fn lines(text: &[u8], drip: usize) -> Vec<(Vec<u8>, u64, u64)> {
        let mut lines = Lines::new(Drip(text, drip));
        let mut found = Vec::new();
        while let Some(line) = lines.next_line().unwrap() {
            found.push((line.bytes.to_vec(), line.number, line.byte));
        }
        found
    }

    #[test]
    fn every_line_end_is_one_and_places_count_from_the_source() {
        let text = b"\xEF\xBB\xBFone\ntwo\r\nthree\rfour\n\nsix";
        let expected: Vec<(Vec<u8>, u64, u64)> = vec![
            (b"one".to_vec(), 1, 3),
            (b"two".to_vec(), 2, 7),
            (b"three".to_vec(), 3, 12),
            (b"four".to_vec(), 4, 18),
            (b"".to_vec(), 5, 23),
            (b"six".to_vec(), 6, 24),
        ];
        for drip in [1, 2, 3, 100] {
            assert_eq!(lines(text, drip), expected, "{drip} bytes at a time");
        }
        assert_eq!(lines(b"", 1), []);
        assert_eq!(lines(b"\n", 1).len(), 1);
    }

    #[test]
    fn lines_cross_the_buffer_whole() {
        let line = "x".repeat(1000) + "\r\n";
        let text = line.repeat(1000);
        let found = lines(text.as_bytes(), 70_001);
        assert_eq!(found.len(), 1000);
        assert!(found.iter().enumerate().all(|(n, l)| l.0.len() == 1000 && l.2 == 1002 * n as u64));
    }

    #[test]
    fn a_line_too_long_and_utf_16_are_refused() {
        let refused = |text: &[u8]| Lines::new(text).next_line().unwrap_err().to_string();
        assert!(lines(&vec![b'x'; LINE_BYTES_MAX], 1 << 20).len() == 1);
        assert!(refused(&vec![b'x'; LINE_BYTES_MAX + 1]).contains("longer than 65536"));
        assert!(refused(b"\xFF\xFEG\x000\x00").contains("UTF-16"));
    }
}
