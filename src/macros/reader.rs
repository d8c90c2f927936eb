//! Reads texts line by line into operations, and tells one program of a text from the next.
//!
//! What is wrong with a line does not stop the reading: everything is told in one run. What needs a whole program (loops
//! that close, N numbers that are gone to) is in [`linking`](super::linking).

use std::collections::{BTreeMap, BTreeSet};

use super::code::Code;
use super::expression::Parser;
use super::findings::{At, Fault};
use super::line::{Line, Rest};
use super::options::{Options, Semicolon};
use super::program::{File, Label, SourceBlock, Unit, lines, place};
use crate::place::Spot;

/// A GOTO whose number is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goto {
    pub pc: u32,
    pub number: u64,
    pub at: At,
}

/// A DO whose END has not come.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenLoop {
    pub number: u8,
    pub id: u16,
    pub condition: u32,
    pub leave: Option<u32>,
    pub at: At,
}

/// A program whose end has not come.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenUnit {
    pub number: Option<u32>,
    pub entry: u32,
    pub at: At,
    /// Nothing but remarks so far.
    pub is_blank: bool,
}

/// Reads texts.
pub(super) struct Reader<'a> {
    pub options: &'a Options,
    pub files: Vec<File>,
    pub units: Vec<Unit>,
    /// By O number: where the program begins, and where that number stands.
    pub numbers: BTreeMap<u32, (u32, At)>,
    /// The programs that were asked for.
    pub asked: BTreeSet<u32>,
    pub code: Code,
    pub lines: Vec<SourceBlock>,
    pub remarks: Vec<(u32, u32)>,
    pub faults: Vec<Fault>,
    pub warnings: Vec<Fault>,
    pub targets: BTreeSet<u32>,
    /// Where the line that is read begins and ends.
    current: Spot,
    current_end: u32,
    pub unit: Option<OpenUnit>,
    /// The text had its closing `%`.
    is_closed: bool,
    /// Of the unit that is read.
    pub labels: Vec<Label>,
    pub gotos: Vec<Goto>,
    pub loops: Vec<OpenLoop>,
    /// The written numbers behind M99 P: any program may have them.
    pub returns: BTreeSet<u64>,
    /// Whether the unit has faults: what depends on its being whole is not looked at then.
    pub is_broken: bool,
}

/// The most that is told at once.
pub(super) const FAULTS_MAX: usize = 50;
/// The longest text: places are kept in 32 bits, and a macro program is small.
const TEXT_BYTES_MAX: usize = 256 << 20;

impl<'a> Reader<'a> {
    pub(super) fn new(options: &'a Options) -> Self {
        Self {
            options,
            files: Vec::new(),
            units: Vec::new(),
            numbers: BTreeMap::new(),
            asked: BTreeSet::new(),
            code: Code::default(),
            lines: Vec::new(),
            remarks: Vec::new(),
            faults: Vec::new(),
            warnings: Vec::new(),
            targets: BTreeSet::new(),
            current: Spot::default(),
            current_end: 0,
            unit: None,
            is_closed: false,
            labels: Vec::new(),
            gotos: Vec::new(),
            loops: Vec::new(),
            returns: BTreeSet::new(),
            is_broken: false,
        }
    }

    /// Reads a text.
    pub(super) fn file(&mut self, text: &[u8], number: Option<u32>) {
        let file = self.files.len() as u16;
        self.files.push(File { text: text.into(), number });
        let at = At { file, start: 0, end: 1 };
        if text.starts_with(&[0xFF, 0xFE]) || text.starts_with(&[0xFE, 0xFF]) {
            let message = "the text is UTF-16, two bytes a character";
            self.faults.push(Fault::syntax(at, message, "save it again as plain text (ASCII, UTF-8 or GBK)"));
            return;
        }
        if text.len() > TEXT_BYTES_MAX {
            let message = format!("the program is larger than {} MiB", TEXT_BYTES_MAX >> 20);
            self.faults.push(Fault::syntax(
                at,
                message,
                "a program without macros is fed as G-code, of any size",
            ));
            return;
        }
        let start = if text.starts_with(&[0xEF, 0xBB, 0xBF]) { 3 } else { 0 };
        let mut line = Line::default();
        (self.is_closed, self.unit) = (false, None);
        for (number, (start, to)) in (1..).zip(lines(text, start)) {
            self.current = Spot { byte: u64::from(start), line: number, column: 1 };
            self.current_end = to;
            let mut from = start;
            while let Some(semicolon) = self.block_text(&mut line, text, file, from, to) {
                from = semicolon + 1;
            }
            if self.faults.len() >= FAULTS_MAX {
                return;
            }
        }
        self.close(at);
        if self.units.last().is_none_or(|unit| unit.at.file != file) {
            self.unit = Some(OpenUnit { number, entry: self.code.next(), at, is_blank: true });
            self.close(at);
        }
        let Some(number) = number.filter(|number| !self.numbers.contains_key(number)) else { return };
        // A text that was asked for by number need not say it again, but it may not say another.
        let first = self.units.iter_mut().find(|unit| unit.at.file == file);
        match first {
            Some(unit) if unit.number.is_none() => {
                unit.number = Some(number);
                self.numbers.insert(number, (unit.entry, unit.at));
            }
            Some(Unit { number: Some(other), at, .. }) => {
                let message = format!("the text of O{number:04} holds O{other:04}");
                let fault =
                    Fault::new("no-program", *at, message, "give the file or the program the right number");
                self.faults.push(fault);
            }
            _ => {}
        }
    }

    /// Reads a line from a byte on; where the next block of the same line begins behind a semicolon, says so.
    fn block_text(&mut self, line: &mut Line, text: &[u8], file: u16, from: u32, to: u32) -> Option<u32> {
        let rest = match line.read(text, file, from, to, self.options.semicolon) {
            Ok(rest) => rest,
            Err(fault) => {
                self.fault(fault);
                return None;
            }
        };
        if let Err(fault) = self.line(line) {
            self.fault(fault);
            return None;
        }
        let Rest::Semicolon(at) = rest else { return None };
        if self.options.semicolon == Semicolon::EndOfBlock {
            return Some(at);
        }
        self.behind_semicolon(text, file, at, to);
        None
    }

    /// What stands behind a semicolon is a remark, or two readings.
    fn behind_semicolon(&mut self, text: &[u8], file: u16, at: u32, to: u32) {
        let mut line = Line::default();
        if line.read(text, file, at + 1, to, Semicolon::Remark).is_err() || line.bytes.is_empty() {
            return;
        }
        let (mut code, options) = (Code::default(), self.options.clone());
        let mut reader = Reader::new(&options);
        if reader.statements(&mut Parser::new(&line, &mut code, &options)).is_ok() {
            self.fault(Fault::new(
                "semicolon",
                At { file, start: at, end: to },
                "text behind `;` that reads as a block: a remark to some, the next block to others",
                "put a remark in brackets, a block on a line of its own, or say in the profile what `;` is",
            ));
        }
    }

    /// One line.
    fn line(&mut self, line: &Line) -> Result<(), Fault> {
        let at = line.at(0, line.bytes.len());
        let mut from = 0;
        match line.bytes.first() {
            Some(b'%') => {
                self.close(at);
                self.is_closed = self.units.last().is_some_and(|unit| unit.at.file == at.file);
                return Ok(());
            }
            Some(b'O' | b':') if line.bytes.get(1).is_some_and(u8::is_ascii_digit) => {
                from = 1 + line.bytes[1..].iter().take_while(|b| b.is_ascii_digit()).count();
                let digits = std::str::from_utf8(&line.bytes[1..from]).ok().and_then(|d| d.parse().ok());
                let Some(number) = digits else {
                    return Err(Fault::syntax(at, "an O number of more than nine digits", "write O1000"));
                };
                self.open(number, at);
            }
            Some(_) if self.unit.is_none() && self.is_closed => {
                return Err(Fault::syntax(at, "text behind the end of the tape", "take it out, or the `%`"));
            }
            Some(_) => {
                let entry = self.code.next();
                let unit = self.unit.get_or_insert(OpenUnit { number: None, entry, at, is_blank: false });
                unit.is_blank = false;
            }
            None if self.unit.is_none() && !line.remarks.is_empty() && !self.is_closed => {
                let entry = self.code.next();
                self.unit = Some(OpenUnit { number: None, entry, at, is_blank: true });
            }
            None => {}
        }
        let mut code = std::mem::take(&mut self.code);
        let mut parser = Parser::new(line, &mut code, self.options);
        parser.at = from;
        let kept = (self.labels.len(), self.gotos.len());
        let result = self.statements(&mut parser);
        self.code = code;
        if result.is_err() {
            self.labels.truncate(kept.0);
            self.gotos.truncate(kept.1);
        }
        result.map(|_| ())
    }

    fn open(&mut self, number: u32, at: At) {
        match &mut self.unit {
            // Remarks in front of its O number belong to a program.
            Some(unit) if unit.is_blank && unit.number.is_none() => {
                (unit.number, unit.at, unit.is_blank) = (Some(number), at, false);
            }
            _ => {
                self.close(at);
                let entry = self.code.next();
                self.unit = Some(OpenUnit { number: Some(number), entry, at, is_blank: false });
            }
        }
        if let Some((_, other)) = self.numbers.get(&number).copied() {
            let line = self.line_of(other);
            let message = format!("O{number:04} stands here and in line {line}");
            self.fault(Fault::new("duplicate-program", at, message, "give one of them another number"));
        }
        self.is_closed = false;
    }

    pub(super) fn fault(&mut self, fault: Fault) {
        self.is_broken = true;
        self.faults.push(fault);
    }

    /// Notes the line that a block comes from.
    pub(super) fn source_with(
        &mut self,
        line: &Line,
        remarks: impl Iterator<Item = (u32, u32)>,
        skip: u8,
        number: Option<u64>,
    ) -> u32 {
        let first_remark = self.remarks.len() as u32;
        self.remarks.extend(remarks);
        let at = line.at(0, 1);
        let column = u64::from(at.start).saturating_sub(self.current.byte) + 1;
        self.lines.push(SourceBlock {
            file: at.file,
            spot: Spot { byte: u64::from(at.start), column, ..self.current },
            end: self.current_end,
            number,
            skip,
            first_remark,
            remark_count: (self.remarks.len() as u32 - first_remark) as u16,
        });
        self.lines.len() as u32 - 1
    }

    pub(super) fn line_of(&self, at: At) -> u64 {
        self.files.get(usize::from(at.file)).map_or(0, |file| place(&file.text, at).line)
    }
}
