//! A place in a text someone wrote: line, column, byte, and enough of the line to put a caret under it.

use std::fmt;
use std::io::{self, Read, Seek, SeekFrom};

/// Where in a source something stands, in numbers alone: what a reader keeps for every block.
#[derive(Clone, Copy, Debug, Default, Eq, Ord, PartialEq, PartialOrd)]
pub struct Spot {
    /// Offset from the start of the source, in bytes.
    pub byte: u64,
    /// Line, from 1; 0 for what no one wrote.
    pub line: u64,
    /// Column, from 1, in bytes.
    pub column: u64,
}

/// Where in a source something stands, with the text to show for it.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Place {
    /// Line, from 1.
    pub line: u64,
    /// Column, from 1, in bytes.
    pub column: u64,
    /// Offset from the start of the source, in bytes.
    pub byte: u64,
    /// The line, or the part of a long line round the place, at most 70 bytes; bytes that are not printable ASCII are shown as a full stop.
    pub excerpt: String,
    /// Where in `excerpt` the caret goes, in bytes.
    pub caret: usize,
    /// How many bytes of `excerpt` are meant, at least 1.
    pub width: usize,
}

impl Place {
    /// The place of the bytes `start..end` of a text held in memory.
    #[must_use]
    pub fn in_text(text: &str, start: usize, end: usize) -> Self {
        let start = start.min(text.len());
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let line = 1 + text[..line_start].bytes().filter(|&b| b == b'\n').count() as u64;
        Self::in_line(
            &text.as_bytes()[line_start..line_end],
            line,
            line_start as u64,
            start - line_start,
            end.saturating_sub(start),
        )
    }

    /// Where it is, without the text.
    #[must_use]
    pub fn spot(&self) -> Spot {
        Spot { byte: self.byte, line: self.line, column: self.column }
    }

    /// The place of `width` bytes at a spot, its line read again from the source: a reader holds no text it has passed.
    ///
    /// # Errors
    ///
    /// When the source cannot be read there.
    pub fn read_again(source: &mut (impl Read + Seek), spot: Spot, width: usize) -> io::Result<Self> {
        let before = (spot.column.max(1) - 1).min(EXCERPT_BEFORE as u64);
        source.seek(SeekFrom::Start(spot.byte - before))?;
        let mut bytes = Vec::new();
        source.take(before + EXCERPT_AFTER as u64).read_to_end(&mut bytes)?;
        let start = before as usize;
        let end = bytes[start.min(bytes.len())..].iter().position(|b| matches!(b, b'\n' | b'\r'));
        bytes.truncate(end.map_or(bytes.len(), |end| start + end));
        let mut place = Self::in_line(&bytes, spot.line, spot.byte - before, start, width);
        place.column = spot.column;
        Ok(place)
    }

    /// The place of `width` bytes at `at` in a line that begins at byte `line_byte` of its source.
    #[must_use]
    pub fn in_line(line: &[u8], number: u64, line_byte: u64, at: usize, width: usize) -> Self {
        let from = at.saturating_sub(EXCERPT_BEFORE);
        let to = line.len().min(at + EXCERPT_AFTER);
        let shown = |bytes: &[u8]| -> String {
            bytes.iter().map(|&b| if (b' '..=b'~').contains(&b) { b as char } else { '.' }).collect()
        };
        let mut excerpt = shown(line.get(from..to).unwrap_or_default());
        // What is missing at the end of a line is shown behind it.
        let width = if at >= line.len() {
            excerpt.push(' ');
            1
        } else {
            width.clamp(1, to - at)
        };
        Self {
            line: number,
            column: at as u64 + 1,
            byte: line_byte + at as u64,
            excerpt,
            caret: at - from,
            width,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// Bytes of a long line shown before the place.
const EXCERPT_BEFORE: usize = 40;
/// Bytes of a long line shown from the place on.
const EXCERPT_AFTER: usize = 30;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_counts_lines_columns_and_bytes() {
        let place = Place::in_text("one\ntwo three\n", 8, 13);
        assert_eq!((place.line, place.column, place.byte), (2, 5, 8));
        assert_eq!((place.excerpt.as_str(), place.caret, place.width), ("two three", 4, 5));
    }

    #[test]
    fn a_spot_is_shown_again_from_the_source() {
        let text = "one\r\ntwo three\r\nfour";
        let first = Place::in_text("one\r\ntwo three", 9, 14);
        let again = Place::read_again(&mut io::Cursor::new(text), first.spot(), 5).unwrap();
        assert_eq!(again, first);
    }

    #[test]
    fn a_long_line_is_shown_in_part() {
        let line = "x".repeat(5000);
        let place = Place::in_line(line.as_bytes(), 1, 0, 3000, 1);
        assert_eq!(place.column, 3001);
        assert!(place.excerpt.len() <= 100);
    }
}
