//! Programs that go to the control as they are written: 4B, and G-code without macros.
//!
//! Each line is read for what is wrong with it before it is given out, so nothing that cannot be read is ever fed. Blank
//! lines carry nothing and are passed over; so are `%` lines, since a tape's leader and trailer are the profile's.

use std::io;

use super::{Line, Program, ProgramError};
use crate::formats::four_b::{Entry, Reader};
use crate::formats::gcode::{Dialect, Library, Motions};

/// A 4B program.
pub struct FourB<R> {
    reader: Reader<R>,
}

impl<R: io::Read> FourB<R> {
    /// The program in a source.
    pub fn new(source: R) -> Self {
        Self { reader: Reader::new(source) }
    }
}

impl<R: io::Read + Send> Program for FourB<R> {
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError> {
        loop {
            let Some(entry) = self.reader.next_entry()? else { return Ok(None) };
            let line = match entry {
                Entry::Block(_) => Line::Block(None),
                Entry::StopWord(word) => Line::of_stop_word(word),
                Entry::Comment | Entry::Header | Entry::Number => continue,
            };
            text.extend_from_slice(self.reader.text());
            return Ok(Some(line));
        }
    }
}

/// A G-code program.
pub struct Gcode<R> {
    motions: Motions<R>,
}

impl<R: io::Read> Gcode<R> {
    /// The program in a source, with the subprograms it may call.
    pub fn new(source: R, dialect: Dialect, library: Library) -> Self {
        Self { motions: Motions::with_library(source, dialect, library) }
    }
}

impl<R: io::Read + Send> Program for Gcode<R> {
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError> {
        while let Some((line, is_block)) = self.motions.next_line()? {
            let bytes = line.bytes.trim_ascii();
            if bytes.is_empty() || bytes.iter().all(|b| *b == b'%') {
                continue;
            }
            text.extend_from_slice(bytes);
            return Ok(Some(if is_block { Line::Block(None) } else { Line::Remark }));
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(mut program: impl Program) -> Vec<(String, Line)> {
        let (mut lines, mut text) = (Vec::new(), Vec::new());
        while let Some(line) = program.pull(&mut text).unwrap() {
            lines.push((String::from_utf8(std::mem::take(&mut text)).unwrap(), line));
        }
        lines
    }

    #[test]
    fn gcode_goes_out_as_it_stands_but_for_percent_signs_and_blank_lines() {
        let source =
            "%\r\nO0012 (RING)\r\nN1 G21 G90\r\n\r\n (cut)\r\nG1 x1.5 Y-.5 ; slowly\r\n/M00\r\nM02\r\n%\r\n";
        let program = Gcode::new(source.as_bytes(), Dialect::generic().unwrap(), Library::default());
        let block = Line::Block(None);
        let expected = [
            ("O0012 (RING)", Line::Remark),
            ("N1 G21 G90", block),
            ("(cut)", Line::Remark),
            ("G1 x1.5 Y-.5 ; slowly", block),
            ("/M00", block),
            ("M02", block),
        ];
        assert_eq!(lines(program), expected.map(|(text, line)| (text.to_owned(), line)));
    }

    #[test]
    fn what_cannot_be_read_is_not_given_out() {
        let mut program =
            Gcode::new(&b"G21 G90\nG1 X#101\nG1 X2.\n"[..], Dialect::generic().unwrap(), Library::default());
        let mut text = Vec::new();
        assert_eq!(program.pull(&mut text).unwrap(), Some(Line::Block(None)));
        text.clear();
        assert!(program.pull(&mut text).is_err());
        assert_eq!(text, b"");
    }

    #[test]
    fn four_b_goes_out_block_by_block() {
        let program =
            FourB::new(&b"; die\nN 1: B 5000 B 0 B 5000 GX L1  B3000B4000B10000B5000DDGXNR1\nDD\n"[..]);
        let block = Line::Block(None);
        let expected =
            [("B5000B0B5000GXL1", block), ("B3000B4000B10000B5000DDGXNR1", block), ("DD", Line::End)];
        assert_eq!(lines(program), expected.map(|(text, line)| (text.to_owned(), line)));
    }
}
