//! A macro program with the programs it calls, read whole and ready to run.
//!
//! A text holds one program or several, each behind its O number. What is called and stands in none of them is asked for
//! by number ([`Programs`]) before anything runs. All that can be found wrong with the texts is found here; what depends
//! on values is found by running.

use std::collections::BTreeSet;

use super::code::{Code, Kind, Op, Value};
use super::expression::Parser;
use super::findings::{At, Fault, Finding, MacroError};
use super::line::{Line, Rest};
use super::options::{Options, Semicolon};
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
    /// Where the GOTOs and returns with a written number go, for what is said of labels.
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
    /// Its N numbers in the order they stand.
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
    first_remark: u32,
    remark_count: u16,
}

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
struct OpenUnit {
    number: Option<u32>,
    entry: u32,
    at: At,
    /// Nothing but remarks so far.
    is_blank: bool,
}

/// Reads texts.
pub(super) struct Reader<'a> {
    pub options: &'a Options,
    files: Vec<File>,
    units: Vec<Unit>,
    code: Code,
    lines: Vec<SourceBlock>,
    remarks: Vec<(u32, u32)>,
    faults: Vec<Fault>,
    warnings: Vec<Fault>,
    targets: BTreeSet<u32>,
    /// Where the line that is read begins and ends.
    current: Spot,
    current_end: u32,
    unit: Option<OpenUnit>,
    /// The text had its closing `%`.
    is_closed: bool,
    /// Of the unit that is read.
    pub labels: Vec<Label>,
    pub gotos: Vec<Goto>,
    pub loops: Vec<OpenLoop>,
    /// M99 P with a written number: the operation, the number.
    pub returns: Vec<(u32, u64, At)>,
    /// Whether the unit has faults: what depends on its being whole is not looked at then.
    is_broken: bool,
}

/// The most that is told at once.
const FAULTS_MAX: usize = 50;
/// The longest text: places are kept in 32 bits, and a macro program is small.
const TEXT_BYTES_MAX: usize = 256 << 20;

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
        let behind = self.labels.iter().find(|label| label.number == number && label.pc > from);
        behind.or_else(|| self.labels.iter().find(|label| label.number == number))
    }
}

impl<'a> Reader<'a> {
    fn new(options: &'a Options) -> Self {
        Self {
            options,
            files: Vec::new(),
            units: Vec::new(),
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
            returns: Vec::new(),
            is_broken: false,
        }
    }

    /// Reads a text.
    fn file(&mut self, text: &[u8], number: Option<u32>) {
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
        if !self.units.last().is_some_and(|unit| unit.at.file == file) {
            self.unit = Some(OpenUnit { number, entry: self.code.next(), at, is_blank: true });
            self.close(at);
        } else if number.is_some() {
            // A text that was asked for by number need not say it again.
            let first = self.units.iter_mut().find(|unit| unit.at.file == file);
            if let Some(unit) = first.filter(|unit| unit.number.is_none()) {
                unit.number = number;
            }
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
        let kept = (self.labels.len(), self.gotos.len(), self.returns.len());
        let result = self.statements(&mut parser);
        self.code = code;
        if result.is_err() {
            self.labels.truncate(kept.0);
            self.gotos.truncate(kept.1);
            self.returns.truncate(kept.2);
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
        if let Some(other) = self.units.iter().find(|unit| unit.number == Some(number)) {
            let line = self.line_of(other.at);
            let message = format!("O{number:04} stands here and in line {line}");
            self.fault(Fault::new("duplicate-program", at, message, "give one of them another number"));
        }
        self.is_closed = false;
    }

    /// Ends a unit: its loops must be closed and its GOTOs found.
    fn close(&mut self, end: At) {
        let (labels, gotos) = (std::mem::take(&mut self.labels), std::mem::take(&mut self.gotos));
        let loops = std::mem::take(&mut self.loops);
        let Some(OpenUnit { number, entry, at, .. }) = self.unit.take() else { return };
        self.code.push(Op::Fall, end);
        let unit = Unit { number, entry, end: self.code.next(), labels, at };
        if !std::mem::take(&mut self.is_broken) {
            for open in loops {
                let message = format!("DO{0} without END{0}", open.number);
                self.faults.push(Fault::new("loop-nesting", open.at, message, "end the loop"));
            }
            for goto in gotos {
                self.goto_target(&unit, goto);
            }
        }
        self.units.push(unit);
    }

    fn goto_target(&mut self, unit: &Unit, goto: Goto) {
        let Some(label) = unit.label(goto.number, goto.pc).copied() else {
            let message = format!("there is no N{} in this program", goto.number);
            let help = "a GOTO finds N numbers of its own program only";
            self.faults.push(Fault::new("no-label", goto.at, message, help));
            return;
        };
        let inside = |l: &super::code::Loop, pc: u32| l.body <= pc && pc <= l.end;
        let entered = self.code.loops.iter().find(|l| inside(l, label.pc) && !inside(l, goto.pc));
        if let Some(entered) = entered {
            let message = format!(
                "GOTO{} goes into the loop DO{} of line {} from outside",
                goto.number,
                entered.number,
                self.line_of(entered.at)
            );
            let help = "a loop is entered at its WHILE; go there";
            self.faults.push(Fault::new("goto-into-loop", goto.at, message, help));
            return;
        }
        self.code.aim(goto.pc, label.pc);
        self.targets.insert(label.pc);
        self.say_twice(unit, goto.number, goto.at, Some(label));
    }

    /// An N number that is gone to and stands more than once.
    fn say_twice(&mut self, unit: &Unit, number: u64, at: At, taken: Option<Label>) {
        let mut places = unit.labels.iter().filter(|label| label.number == number);
        let (Some(first), Some(second)) = (places.next(), places.next()) else { return };
        let lines = (self.line_of(first.at), self.line_of(second.at));
        let goes = taken.map_or(String::new(), |l| format!("; this one goes to line {}", self.line_of(l.at)));
        self.warnings.push(Fault::new(
            "duplicate-label",
            at,
            format!("N{number} stands in lines {} and {}{goes}", lines.0, lines.1),
            "a GOTO searches forwards first, then from the start; give one of them another number",
        ));
    }

    /// Finds what calls go to, and loads it.
    fn calls(&mut self, programs: &mut dyn Programs) {
        let mut at = 0;
        let mut loaded_all = false;
        while at < self.code.calls.len() && self.faults.len() < FAULTS_MAX {
            let call = self.code.calls[at].clone();
            at += 1;
            match (call.kind, call.program) {
                (Kind::Local, Value::Written(number, _)) => {
                    self.local(at - 1, number.mantissa as u64, call.at)
                }
                (Kind::Local, Value::Cell(_)) => {}
                (_, Value::Written(number, _)) => {
                    self.load(number.mantissa, at - 1, call.at, programs);
                }
                (_, Value::Cell(_)) if !loaded_all => {
                    loaded_all = true;
                    match programs.numbers() {
                        Ok(numbers) => {
                            for number in numbers {
                                if self.entry(i64::from(number)).is_none() {
                                    self.load_text(number, call.at, programs);
                                }
                            }
                        }
                        Err(message) => {
                            let fault = Fault::new(
                                "no-program",
                                call.at,
                                message,
                                "see to the directory of programs",
                            );
                            self.faults.push(fault);
                        }
                    }
                }
                (_, Value::Cell(_)) => {}
            }
        }
    }

    /// M97: an N number of the program the call stands in.
    fn local(&mut self, call: usize, number: u64, at: At) {
        let pc =
            self.code.ops.iter().position(|op| *op == Op::Call { call: call as u32 }).unwrap_or(0) as u32;
        let unit = self.units.iter().find(|unit| pc < unit.end).cloned();
        let Some(unit) = unit else { return };
        match unit.label(number, pc).copied() {
            Some(label) => {
                self.code.calls[call].entry = Some(label.pc);
                self.targets.insert(label.pc);
                self.say_twice(&unit, number, at, Some(label));
            }
            None => {
                let message = format!("there is no N{number} in this program");
                self.faults.push(Fault::new(
                    "no-label",
                    at,
                    message,
                    "M97 calls an N number of its own program",
                ));
            }
        }
    }

    fn load(&mut self, number: i64, call: usize, at: At, programs: &mut dyn Programs) {
        let is_subprogram = self.code.calls[call].kind == Kind::Subprogram;
        if self.entry(number).is_none()
            && let Ok(number) = u32::try_from(number)
        {
            self.load_text(number, at, programs);
        }
        if let Some(entry) = self.entry(number) {
            self.code.calls[call].entry = Some(entry);
            return;
        }
        // Fanuc, M98: the last four digits are the program, those in front how often.
        let (count, short) = (number / 10_000, number % 10_000);
        if is_subprogram && count > 0 {
            if self.entry(short).is_none() {
                self.load_text(short as u32, at, programs);
            }
            if let Some(entry) = self.entry(short) {
                let repeats =
                    crate::formats::gcode::numbers::Number { mantissa: count, decimals: 0, point: false };
                self.code.calls[call].entry = Some(entry);
                self.code.calls[call].count = Value::Written(repeats, (0, 0));
                return;
            }
        }
        if self.faults.is_empty() {
            let message = format!("there is no program O{number:04}");
            let help = "put it in the same text, or in the directory of the program";
            self.faults.push(Fault::new("no-program", at, message, help));
        }
    }

    fn entry(&self, number: i64) -> Option<u32> {
        let number = u32::try_from(number).ok()?;
        self.units.iter().find(|unit| unit.number == Some(number)).map(|unit| unit.entry)
    }

    fn load_text(&mut self, number: u32, at: At, programs: &mut dyn Programs) {
        if self.files.len() >= usize::from(u16::MAX) {
            return;
        }
        match programs.load(number) {
            Ok(Some(text)) => self.file(&text, Some(number)),
            Ok(None) => {}
            Err(message) => {
                self.faults.push(Fault::new("no-program", at, message, "see to the file"));
            }
        }
    }

    fn fault(&mut self, fault: Fault) {
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

/// The lines of a text, without their ends.
fn lines(text: &[u8], start: usize) -> impl Iterator<Item = (u32, u32)> + '_ {
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

fn place(text: &[u8], at: At) -> Spot {
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
