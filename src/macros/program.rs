//! A macro program with the programs it calls, read whole and ready to run.
//!
//! A text holds one program or several, each behind its O number. What is called and stands in none of them is asked for
//! by number ([`Programs`]) before anything runs. All that can be found wrong with the texts is found here; what depends
//! on values is found by running.

use std::collections::BTreeSet;

use super::code::Code;
use super::findings::{At, Fault, Finding, MacroError};
use super::options::Options;
use super::reader::Reader;
use crate::check::Severity;
use crate::place::{Place, Spot};

/// Where programs come from that are called and not in the text.
pub trait Programs {
    /// The text of a program; none where there is no such program.
    ///
    /// # Errors
    ///
    /// When it is there and cannot be read, in words.
    fn load(&mut self, number: u32) -> Result<Option<Vec<u8>>, String>;

    /// Which programs there are. All of them are loaded where a call computes the number.
    ///
    /// # Errors
    ///
    /// When that cannot be found out, in words.
    fn numbers(&mut self) -> Result<Vec<u32>, String> {
        Ok(Vec::new())
    }
}

/// No programs beside the text.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoPrograms;

impl Programs for NoPrograms {
    fn load(&mut self, _: u32) -> Result<Option<Vec<u8>>, String> {
        Ok(None)
    }
}

/// A program that can be run.
#[derive(Clone, Debug)]
pub struct Program {
    pub(super) files: Vec<File>,
    pub(super) units: Vec<Unit>,
    pub(super) code: Code,
    pub(super) lines: Vec<SourceBlock>,
    remarks: Vec<(u32, u32)>,
    pub(super) options: Options,
    findings: Vec<Finding>,
    /// Where something may go on that did not come from the line in front, as far as that is written.
    pub(super) targets: BTreeSet<u32>,
}

/// A text.
#[derive(Clone, Debug)]
pub(super) struct File {
    pub text: Box<[u8]>,
    /// The program it was loaded for; none for the main text.
    pub number: Option<u32>,
}

/// One program of a text.
#[derive(Clone, Debug)]
pub(super) struct Unit {
    pub number: Option<u32>,
    pub entry: u32,
    /// Behind its last operation.
    pub end: u32,
    /// Its N numbers by number, those of one number in the order they stand.
    pub labels: Vec<Label>,
    pub at: At,
}

/// An N number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label {
    pub number: u64,
    pub pc: u32,
    pub at: At,
}

/// A line that makes a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct SourceBlock {
    pub file: u16,
    pub spot: Spot,
    pub end: u32,
    pub number: Option<u64>,
    pub skip: u8,
    pub first_remark: u32,
    pub remark_count: u16,
}

impl Program {
    /// Reads a text and the programs it calls.
    ///
    /// # Errors
    ///
    /// Everything wrong with them, in the order of the text, at most fifty.
    pub fn parse(
        text: &[u8],
        programs: &mut dyn Programs,
        options: &Options,
    ) -> Result<Self, Vec<MacroError>> {
        let mut reader = Reader::new(options);
        reader.file(text, None);
        reader.calls(programs);
        let Reader { files, units, code, lines, remarks, faults, warnings, targets, .. } = reader;
        if !faults.is_empty() {
            return Err(faults.into_iter().map(|fault| shown(&files, fault)).collect());
        }
        let findings = warnings
            .into_iter()
            .map(|fault| Finding { severity: Severity::Warning, error: shown(&files, fault) })
            .collect();
        let options = options.clone();
        Ok(Self { files, units, code, lines, remarks, options, findings, targets })
    }

    /// What was found wrong without being an error.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The text of the line a block was made from.
    #[must_use]
    pub fn line(&self, source: u32) -> &[u8] {
        let block = &self.lines[source as usize];
        let start = block.spot.byte + 1 - block.spot.column;
        &self.files[usize::from(block.file)].text[start as usize..block.end as usize]
    }

    /// A stretch of the text a block was made from: a remark, as [`Block::remarks`](super::block::Block) names it, or the
    /// digits of a word.
    #[must_use]
    pub fn text(&self, source: u32, range: (u32, u32)) -> &[u8] {
        let file = usize::from(self.lines[source as usize].file);
        &self.files[file].text[range.0 as usize..range.1 as usize]
    }

    /// Its texts: the main one, and those that were loaded.
    pub fn texts(&self) -> impl Iterator<Item = &[u8]> {
        self.files.iter().map(|file| &*file.text)
    }

    /// The whole text a block was made from, which the places in [`Block`](super::block::Block) are counted in.
    #[must_use]
    pub fn source_text(&self, source: u32) -> &[u8] {
        &self.files[usize::from(self.lines[source as usize].file)].text
    }

    /// The program a line stands in, where that was loaded from beside the main one.
    #[must_use]
    pub fn file_of(&self, source: u32) -> Option<u32> {
        self.files[usize::from(self.lines[source as usize].file)].number
    }

    /// The O number of the main program.
    #[must_use]
    pub fn number(&self) -> Option<u32> {
        self.units.first()?.number
    }

    pub(super) fn remarks_of(&self, source: u32) -> &[(u32, u32)] {
        let block = &self.lines[source as usize];
        &self.remarks[block.first_remark as usize..][..usize::from(block.remark_count)]
    }

    pub(super) fn shown(&self, fault: Fault) -> MacroError {
        shown(&self.files, fault)
    }

    /// The unit an operation belongs to.
    pub(super) fn unit_of(&self, pc: u32) -> &Unit {
        let at = self.units.partition_point(|unit| unit.end <= pc);
        &self.units[at.min(self.units.len() - 1)]
    }

    pub(super) fn text_at(&self, at: At) -> String {
        let bytes = &self.files[usize::from(at.file)].text[at.start as usize..at.end as usize];
        String::from_utf8_lossy(bytes).trim().to_owned()
    }
}

impl Unit {
    /// Where a GOTO at an operation finds an N number: forwards first, then from the start.
    pub(super) fn label(&self, number: u64, from: u32) -> Option<&Label> {
        let same = self.labels_of(number);
        same.iter().find(|label| label.pc > from).or_else(|| same.first())
    }

    /// Every place of an N number.
    pub(super) fn labels_of(&self, number: u64) -> &[Label] {
        let first = self.labels.partition_point(|label| label.number < number);
        let end = self.labels.partition_point(|label| label.number <= number);
        &self.labels[first..end]
    }
}

/// The lines of a text, without their ends.
pub(super) fn lines(text: &[u8], start: usize) -> impl Iterator<Item = (u32, u32)> + '_ {
    let mut at = start;
    std::iter::from_fn(move || {
        if at >= text.len() {
            return None;
        }
        let from = at;
        let to = memchr::memchr2(b'\n', b'\r', &text[at..]).map_or(text.len(), |n| at + n);
        at = to + 1;
        if text.get(to) == Some(&b'\r') && text.get(to + 1) == Some(&b'\n') {
            at += 1;
        }
        Some((from as u32, to as u32))
    })
}

pub(super) fn place(text: &[u8], at: At) -> Spot {
    let start = (at.start as usize).min(text.len());
    let (mut line, mut begins) = (1, 0);
    for (from, _) in lines(&text[..start], 0) {
        begins = from as usize;
        line += 1;
    }
    let ended = start > 0 && matches!(text[start - 1], b'\n' | b'\r');
    if start > 0 && !ended {
        line -= 1;
    } else {
        begins = start;
    }
    Spot { byte: start as u64, line, column: (start - begins) as u64 + 1 }
}

fn shown(files: &[File], fault: Fault) -> MacroError {
    let Fault { code, message, at, help } = fault;
    let Some(file) = files.get(usize::from(at.file)) else {
        let place = Place::in_line(b"", 0, 0, 0, 1);
        return MacroError { code, message, place, help, program: None };
    };
    let spot = place(&file.text, at);
    let begins = (spot.byte + 1 - spot.column) as usize;
    let end = memchr::memchr2(b'\n', b'\r', &file.text[begins..]).map_or(file.text.len(), |n| begins + n);
    let width = (at.end.saturating_sub(at.start) as usize).max(1);
    let place =
        Place::in_line(&file.text[begins..end], spot.line, begins as u64, spot.column as usize - 1, width);
    MacroError { code, message, place, help, program: file.number }
}
