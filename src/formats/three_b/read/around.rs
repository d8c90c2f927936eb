//! What stands around blocks: stop words, remarks, line numbers, header lines.

use std::io;

use super::{Entry, Item, Reader, Text};
use crate::formats::ReadError;

impl<R: io::Read> Reader<R> {
    /// What begins with `byte`, which is not blank.
    pub(super) fn entry(&mut self, byte: u8) -> Result<Entry, ReadError> {
        match byte {
            b'%' => Ok(self.passed(Entry::Header, self.at, self.at + 1)),
            b';' => {
                let end = self.line_end();
                Ok(self.remark(self.at + 1, end, end))
            }
            b'(' => {
                let end = self.line_end();
                let inside = &self.pieces.piece()[self.at + 1..end];
                let close = inside.iter().position(|&b| b == b')').map(|n| self.at + 1 + n);
                Ok(self.remark(self.at + 1, close.unwrap_or(end), close.map_or(end, |n| n + 1)))
            }
            b'*' => self.row_of_stars(),
            b'N' | b'n' => match self.line_number() {
                Some(entry) => Ok(entry),
                None => self.header(),
            },
            b'B' | b'b' if self.block_follows() => self.block().map(|block| Entry::Item(Item::Block(block))),
            b'D' | b'd' | b'E' | b'e' => match self.stop_word() {
                Some(word) => {
                    if word != "D" {
                        self.ended_by = Some(word);
                    }
                    Ok(Entry::Item(Item::StopWord(word)))
                }
                None => self.header(),
            },
            _ => self.header(),
        }
    }

    fn passed(&mut self, entry: Entry, from: usize, to: usize) -> Entry {
        self.text = Text::AsItStands { from, to };
        self.at = self.at.max(to);
        entry
    }

    fn remark(&mut self, from: usize, to: usize, end: usize) -> Entry {
        self.text = Text::AsItStands { from, to };
        self.at = end;
        Entry::Comment
    }

    /// Where the line's words end: before the blanks that are passed over between entries, and no others.
    fn line_end(&self) -> usize {
        let rest = &self.pieces.piece()[self.at..];
        let last = rest.iter().rposition(|b| !matches!(b, b' ' | b'\t' | b'\r' | b'\n'));
        self.at + last.map_or(0, |last| last + 1)
    }

    /// `N 12:` of a listing.
    fn line_number(&mut self) -> Option<Entry> {
        let rest = &self.pieces.piece()[self.at + 1..];
        let length = rest.iter().take_while(|b| b.is_ascii_digit() || **b == b' ').count();
        if rest.get(length) != Some(&b':') {
            return None;
        }
        let before = rest[..length].iter().position(u8::is_ascii_digit)?;
        let from = self.at + 1 + before;
        let digits = rest[before..length].trim_ascii_end().len();
        self.text = Text::AsItStands { from, to: from + digits };
        self.at += length + 2;
        Some(Entry::Number)
    }

    /// Whether the B here opens a block: a number or another B comes after it.
    fn block_follows(&self) -> bool {
        let next = self.pieces.piece()[self.at + 1..].iter().find(|b| !b.is_ascii_whitespace());
        next.is_none_or(|b| matches!(b, b'0'..=b'9' | b'B' | b'b' | b'-' | b'+' | b'.'))
    }

    fn stop_word(&mut self) -> Option<&'static str> {
        let rest = &self.pieces.piece()[self.at..];
        let word = ["DD", "D", "E"].into_iter().find(|word| {
            let Some((start, after)) = rest.split_at_checked(word.len()) else { return false };
            let ends = matches!(
                after.first(),
                None | Some(b' ' | b'\t' | b'\r' | b'\n' | b';' | b'(' | b'%' | b'B' | b'b' | 0 | 0x1A)
            );
            start.eq_ignore_ascii_case(word.as_bytes()) && ends
        })?;
        self.text = Text::AsItStands { from: self.at, to: self.at + word.len() };
        self.at += word.len();
        Some(word)
    }

    /// A row of stars, with or without words between them; a block among them is not decoration.
    fn row_of_stars(&mut self) -> Result<Entry, ReadError> {
        let end = self.line_end();
        let rest = &self.pieces.piece()[self.at..end];
        if holds_block_pattern(rest) {
            return Err(self.error(
                self.at,
                end - self.at,
                "a block behind a `*`",
                "put remarks in ( ) or after ;",
            ));
        }
        Ok(self.passed(Entry::Header, self.at, end))
    }

    /// A line of words: kept out of the program if it is a header, else an error.
    fn header(&mut self) -> Result<Entry, ReadError> {
        let end = self.line_end();
        let rest = &self.pieces.piece()[self.at..end];
        let words = rest.split(|&b| b == b';' || b == b'(').next().unwrap_or_default();
        if !words.contains(&b'=') || holds_block_pattern(words) {
            return Err(self.error(
                self.at,
                end - self.at,
                "neither a 3B block nor a comment",
                "a block is `B X B Y B J G Z`, such as B579B6617B006617GYL2; put remarks in ( ) or after ;",
            ));
        }
        Ok(self.passed(Entry::Header, self.at, end))
    }
}

/// Whether words hold three B with nothing but digits and blanks between them: a block, whatever stands around it.
pub(in crate::formats) fn holds_block_pattern(words: &[u8]) -> bool {
    let mut found = 0;
    for byte in words {
        match byte {
            b'B' | b'b' => found += 1,
            b'0'..=b'9' | b' ' | b'\t' => {}
            _ => found = 0,
        }
        if found == 3 {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests;
