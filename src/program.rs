//! A program as the sender sees it: lines of text pulled one at a time, whatever they are made from.
//!
//! A part is generated, a program is read; neither is ever held. A program is pulled once; to send it again it is made
//! again, and [`Segments`] tells whether it is still the same.

mod expanded;
pub mod verbatim;
pub mod written;

use std::io::BufRead;

use thiserror::Error;

use crate::formats::three_b::read::{Item, Reader};
use crate::formats::three_b::{self, Block, Style};
use crate::formats::{ReadError, WriteError, four_b, gcode};
use crate::part::{Format, Part, Prepared};
use crate::rounding::Made;
use written::Written;

/// A line of program text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// A block; the 3B block it is, where the program is 3B or 4B.
    Block(Option<Block>),
    /// A comment, a program number, a header: sent, but not counted as a block.
    Remark,
    /// `D`: the control pauses and goes on. Not counted as a block.
    Pause,
    /// `DD` or `E`: the control ends the program. Not counted as a block.
    End,
}

impl Line {
    /// What a stop word says.
    fn of_stop_word(word: &str) -> Self {
        if word == "D" { Self::Pause } else { Self::End }
    }
}

/// Why a program cannot go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ProgramError {
    /// The source is not a program.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The format cannot say it.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Something lines can be pulled from.
pub trait Program: Send {
    /// Appends the next line's text, without an end of block; none at the end.
    ///
    /// # Errors
    ///
    /// When the source fails; what was pulled before stands.
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError>;
}

/// The program of a part, in the part's format.
#[must_use]
pub fn generated(prepared: &Prepared) -> Box<dyn Program> {
    match &prepared.part().format {
        Format::ThreeB => Box::new(Generated::new(prepared)),
        Format::FourB => {
            let Part { aim, stop_word: end, style, .. } = *prepared.part();
            let plain = three_b::write::Form { style, aim, end, ..three_b::write::Form::default() };
            let form = four_b::write::Form { plain, ..four_b::write::Form::default() };
            Box::new(Written::new(prepared.motions(), four_b::write::Writer::new(form)))
        }
        Format::Gcode(dialect) => {
            Box::new(Written::new(prepared.motions(), gcode::Writer::new((**dialect).clone())))
        }
    }
}

/// A part, generated in 3B.
pub struct Generated {
    blocks: Box<dyn Iterator<Item = Made> + Send>,
    style: Style,
    stop_word: &'static str,
}

impl Generated {
    /// The program of a part.
    #[must_use]
    pub fn new(prepared: &Prepared) -> Self {
        let part = prepared.part();
        Self { blocks: prepared.blocks(), style: part.style, stop_word: part.stop_word.text() }
    }
}

impl Program for Generated {
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError> {
        if let Some(made) = self.blocks.next() {
            self.style.write(&made.block, text);
            return Ok(Some(Line::Block(Some(made.block))));
        }
        if self.stop_word.is_empty() {
            return Ok(None);
        }
        let word = std::mem::take(&mut self.stop_word);
        text.extend_from_slice(word.as_bytes());
        Ok(Some(Line::of_stop_word(word)))
    }
}

/// A 3B program, read.
pub struct Read<R> {
    reader: Reader<R>,
}

impl<R: BufRead + Send> Read<R> {
    /// The program in a source.
    pub fn new(source: R) -> Self {
        Self { reader: Reader::new(source) }
    }
}

impl<R: BufRead + Send> Program for Read<R> {
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError> {
        Ok(match self.reader.next_item()? {
            Some(Item::Block(block)) => {
                text.extend_from_slice(self.reader.text());
                Some(Line::Block(Some(block)))
            }
            Some(Item::StopWord(word)) => {
                text.extend_from_slice(word.as_bytes());
                Some(Line::of_stop_word(word))
            }
            None => None,
        })
    }
}

/// A program whose blocks are counted.
pub struct Counted {
    program: Box<dyn Program>,
    block: u64,
}

/// A line and the number of its block; a stop word has the number of the block before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbered {
    /// The line.
    pub line: Line,
    /// The block's number, from 1.
    pub block: u64,
}

impl Counted {
    /// Counts a program from its first block.
    #[must_use]
    pub fn new(program: Box<dyn Program>) -> Self {
        Self { program, block: 0 }
    }

    /// Blocks pulled so far.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.block
    }

    /// As [`Program::pull`].
    ///
    /// # Errors
    ///
    /// As [`Program::pull`].
    pub fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Numbered>, ProgramError> {
        let Some(line) = self.program.pull(text)? else { return Ok(None) };
        self.block += u64::from(matches!(line, Line::Block(_)));
        Ok(Some(Numbered { line, block: self.block }))
    }
}

impl Numbered {
    /// Whether the line goes out when block `first` goes first: it, and what comes after it.
    #[must_use]
    pub fn goes_out_from(&self, first: u64) -> bool {
        match self.line {
            Line::Block(_) => self.block >= first,
            Line::Remark | Line::Pause | Line::End => self.block + 1 >= first,
        }
    }
}

/// The chained digest of a program's text, one LF a line, cut into segments.
///
/// A segment's value is H(previous value ‖ text of the segment), so one value vouches for all that came before it. The
/// segments are short at first and grow with the block number, so that a small job is known finely and a long one keeps
/// few values: a segment ends at n when n is a multiple of max(16, the largest power of two ≤ n / 16).
#[derive(Clone, Debug)]
pub struct Segments {
    hasher: blake3::Hasher,
    blocks: u64,
}

impl Default for Segments {
    fn default() -> Self {
        Self { hasher: blake3::Hasher::new(), blocks: 0 }
    }
}

/// A segment's end and the value there.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Segment {
    /// The last block of the segment.
    pub block: u64,
    /// The chained value.
    pub value: blake3::Hash,
}

impl Segments {
    /// Adds a line; returns the segment it ends, if it does.
    pub fn add(&mut self, text: &[u8], line: Line) -> Option<Segment> {
        self.hasher.update(text);
        self.hasher.update(b"\n");
        match line {
            Line::Remark | Line::Pause | Line::End => None,
            Line::Block(_) => {
                self.blocks += 1;
                ends_segment(self.blocks).then(|| self.cut())
            }
        }
    }

    /// The value of all there is, at the program's end.
    pub fn finish(&mut self) -> Segment {
        self.cut()
    }

    fn cut(&mut self) -> Segment {
        let value = self.hasher.finalize();
        self.hasher.reset();
        self.hasher.update(value.as_bytes());
        Segment { block: self.blocks, value }
    }
}

/// Whether a segment ends at a block.
fn ends_segment(block: u64) -> bool {
    let unit = (1u64 << block.max(1).ilog2()) / 16;
    block.is_multiple_of(unit.max(16))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(mut program: impl Program) -> Vec<String> {
        let mut lines = Vec::new();
        let mut text = Vec::new();
        while program.pull(&mut text).unwrap().is_some() {
            lines.push(String::from_utf8(std::mem::take(&mut text)).unwrap());
        }
        lines
    }

    #[test]
    fn what_is_generated_reads_back_as_itself() {
        let prepared = Part::default().prepare().unwrap();
        let generated = lines(Generated::new(&prepared));
        assert_eq!(generated.last().unwrap(), "DD");
        let text = generated.join("\n");
        assert_eq!(lines(Read::new(text.as_bytes())), generated);
    }

    #[test]
    fn segments_grow_with_the_program() {
        let ends: Vec<u64> = (1..2000).filter(|&n| ends_segment(n)).collect();
        assert_eq!(ends[..4], [16, 32, 48, 64]);
        assert!(ends.contains(&512) && ends.contains(&1024) && ends.len() < 70);
    }

    #[test]
    fn one_changed_character_changes_every_value_after_it() {
        let block = Line::Block(Some(Block::line(crate::units::Position::new(1, 2))));
        let values = |changed: usize| -> Vec<Segment> {
            let mut segments = Segments::default();
            (1..=64).filter_map(|n| segments.add(if n == changed { b"C" } else { b"B" }, block)).collect()
        };
        let (a, b) = (values(0), values(20));
        assert_eq!(a[0], b[0]);
        assert!(a[1..].iter().zip(&b[1..]).all(|(a, b)| a != b));
    }
}
