//! A line without blanks and remarks, in capitals, each byte with its place.
//!
//! Blanks mean nothing to a control, `WHILE [ #1 GT 25 ]` and `WHILE[#1GT25]` are the same, and a remark may stand
//! anywhere. So both are taken out before anything is read. A blank between two digits is the exception: whoever wrote it
//! meant two numbers, and a control reads one; it is remembered and refused.

use super::findings::{At, Fault};
use super::options::Semicolon;

/// A line made ready to be read. One is used again for every line.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    pub bytes: Vec<u8>,
    /// Where in the text each byte stands.
    places: Vec<u32>,
    /// Remarks: their text, and how many of `bytes` stand before them.
    pub remarks: Vec<(u32, u32, usize)>,
    file: u16,
    end: u32,
}

/// What stands behind a line's text.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Rest {
    /// Nothing.
    End,
    /// A semicolon at this byte of the text, and something that is not blank.
    Semicolon(u32),
}

impl Line {
    /// Reads the bytes `start..end` of a text.
    pub(super) fn read(
        &mut self,
        text: &[u8],
        file: u16,
        start: u32,
        end: u32,
        semicolon: Semicolon,
    ) -> Result<Rest, Fault> {
        self.bytes.clear();
        self.places.clear();
        self.remarks.clear();
        (self.file, self.end) = (file, end);
        let mut at = start;
        while at < end {
            let byte = text[at as usize];
            match byte {
                // NUL is the blank tape of a leader, 0x1A the end mark of old files.
                b' ' | b'\t' | 0 | 0x1A | 0x0B | 0x0C => at += 1,
                b'(' => {
                    let rest = &text[at as usize + 1..end as usize];
                    let Some(length) = memchr::memchr(b')', rest) else {
                        return Err(Fault::syntax(
                            At { file, start: at, end: at + 1 },
                            "the remark is not closed",
                            "close it with `)` on the same line",
                        ));
                    };
                    self.remarks.push((at + 1, at + 1 + length as u32, self.bytes.len()));
                    at += length as u32 + 2;
                }
                b';' => {
                    let rest = &text[at as usize + 1..end as usize];
                    if rest.iter().all(|b| b.is_ascii_whitespace() || matches!(b, b';' | 0 | 0x1A)) {
                        break;
                    }
                    if semicolon == Semicolon::Remark {
                        self.remarks.push((at + 1, end, self.bytes.len()));
                        break;
                    }
                    self.end = at;
                    return Ok(Rest::Semicolon(at));
                }
                b'!'..=b'~' => {
                    self.bytes.push(byte.to_ascii_uppercase());
                    self.places.push(at);
                    at += 1;
                }
                _ => {
                    return Err(Fault::syntax(
                        At { file, start: at, end: at + 1 },
                        format!("the byte 0x{byte:02X} is no character of a program"),
                        "only remarks in brackets may hold others than ASCII",
                    ));
                }
            }
        }
        Ok(Rest::End)
    }

    /// The place of the bytes `from..to` of this line.
    pub(super) fn at(&self, from: usize, to: usize) -> At {
        let start = self.places.get(from).copied().unwrap_or(self.end);
        let last = to.max(from + 1) - 1;
        let end = self.places.get(last).map_or(start + 1, |at| at + 1);
        At { file: self.file, start, end }
    }

    /// The first byte from `from` to `to` with a blank or remark in front of it, the byte at `from` aside.
    pub(super) fn gap(&self, from: usize, to: usize) -> Option<usize> {
        (from + 1..to.min(self.places.len())).find(|&n| self.places[n] != self.places[n - 1] + 1)
    }

    /// The first remark behind the byte `from`.
    pub(super) fn remark_behind(&self, from: usize) -> Option<At> {
        let (start, end, _) = self.remarks.iter().find(|(_, _, at)| *at >= from)?;
        Some(At { file: self.file, start: *start, end: *end })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Line, Result<Rest, Fault>) {
        let mut line = Line::default();
        let rest = line.read(text.as_bytes(), 0, 0, text.len() as u32, Semicolon::Refused);
        (line, rest)
    }

    #[test]
    fn blanks_and_remarks_go_and_places_stay() {
        let (line, rest) = read("while [ #1 (width) gt 25 ] do1 (over) ;");
        assert_eq!(rest.unwrap(), Rest::End);
        assert_eq!(line.bytes, b"WHILE[#1GT25]DO1");
        assert_eq!(line.at(6, 8), At { file: 0, start: 8, end: 10 });
        assert_eq!(line.remarks.len(), 2);
        assert_eq!(line.remark_behind(12), Some(At { file: 0, start: 32, end: 36 }));
        assert_eq!(line.gap(6, 8), None);
        assert_eq!(line.gap(6, 9), Some(8), "the remark stands before GT");
    }

    #[test]
    fn what_is_no_text_is_refused() {
        assert!(read("G01 (X1.").1.unwrap_err().message.contains("not closed"));
        assert!(read("G01 \u{e9}").1.unwrap_err().message.contains("0xC3"));
        assert_eq!(read("#1=1 ; #2=2").1.unwrap(), Rest::Semicolon(5));
        assert!(read("(\u{e9})").1.is_ok());
    }
}
