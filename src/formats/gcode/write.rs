//! Motions as a G-code program, a line at a time.
//!
//! A program begins with its unit, its distance mode and where the wire is (`G21 G90`, `G92 X… Y…`), has one motion a
//! line and ends with M02. Nodes are rounded to the micron as absolute positions, so that increments do not add up
//! remainders. Words that stood in one block stay in one; a comment that would end a line early stands before it. What the
//! dialect has no word for is an error, never left out.

mod moves;
mod spelling;

use super::dialect::Dialect;
use super::modal::Mode;
use crate::formats::{WriteError, Writer as WriterOfAnyFormat};
use crate::motion::{Act, Motion, Offset, Side, Stop, Taper};
use crate::place::Spot;
use crate::units::{Micrometres, Position};

/// Writes one dialect.
#[derive(Debug)]
pub struct Writer {
    dialect: Dialect,
    layout: Layout,
    /// The line in work: words that may share it with the next motion.
    line: Vec<u8>,
    /// The block its words come from.
    line_block: u64,
    /// Whether it holds offset and taper words alone, which go into the block of the next line.
    line_is_path: bool,
    /// `/`, with its level, for the next block.
    skip: Vec<u8>,
    /// The N word for the next block.
    number: Vec<u8>,
    last_number: u64,
    is_opened: bool,
    is_ended: bool,
    flags_told: bool,
    /// Where the wire is.
    at: Option<Position>,
    /// Where its upper end is, seen from there.
    lean: Position,
    mode: Option<Mode>,
    /// What registers were set to here, by number.
    register: Option<(u32, Micrometres)>,
}

/// Choices about how a program is written that do not depend on the control.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Layout {
    /// Numbers every block in such steps, in place of the numbers it had.
    pub number_step: Option<u32>,
    /// Leaves out what is in force already: the word of motion, an axis that does not move.
    pub suppress: bool,
}

impl Writer {
    /// A writer at the start of a program.
    #[must_use]
    pub fn new(dialect: Dialect) -> Self {
        Self::with_layout(dialect, Layout::default())
    }

    /// A writer at the start of a program, with choices made.
    #[must_use]
    pub fn with_layout(dialect: Dialect, layout: Layout) -> Self {
        Self {
            dialect,
            layout,
            line: Vec::new(),
            line_block: 0,
            line_is_path: false,
            skip: Vec::new(),
            number: Vec::new(),
            last_number: 0,
            is_opened: false,
            is_ended: false,
            flags_told: false,
            at: None,
            lean: Position::default(),
            mode: None,
            register: None,
        }
    }
}

impl WriterOfAnyFormat for Writer {
    fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        if self.is_ended && !matches!(motion.act, Act::Comment(_) | Act::Header(_) | Act::Unknown(_)) {
            return Err(refused(
                motion.spot,
                "the program goes on behind its end",
                "take the end out, or what follows",
            ));
        }
        match &motion.act {
            Act::Header(header) => self.header(header, text),
            Act::Comment(remark) => return self.comment(remark, motion, text),
            Act::Word(word) => self.word(word, motion, text),
            // What is not known is not put among words that are.
            Act::Unknown(word) if self.is_ended => return self.comment(word, motion, text),
            Act::Unknown(word) => self.word(word, motion, text),
            Act::Move { travel, element, upper, flag } => {
                if flag.is_some() && !self.flags_told {
                    self.flags_told = true;
                    self.flush(text);
                    self.remark(
                        b"4B marks convex and concave arcs; here the control sees it by itself",
                        text,
                    );
                }
                return self.travel(motion, *travel, element, upper.as_ref(), text);
            }
            Act::Offset(offset) => return self.offset(offset, motion, text),
            Act::Taper(taper) => return self.taper(taper, motion, text),
            Act::Stop(stop) => self.stop(*stop, motion, text),
            Act::Dwell(seconds) => {
                if !(0.0..1e6).contains(seconds) {
                    return Err(refused(
                        motion.spot,
                        "a dwell that is no time",
                        "a dwell lasts at least 0 s",
                    ));
                }
                self.open(text);
                self.flush(text);
                let mut words = b"G04".to_vec();
                self.gap(&mut words);
                words.push(b'X');
                spelling::decimal(*seconds, &mut words);
                self.put(&words, motion.block, false);
                self.flush(text);
            }
        }
        Ok(())
    }

    fn finish(&mut self, text: &mut Vec<u8>) -> Result<(), WriteError> {
        self.flush_all(text);
        if !self.is_ended {
            self.end(text);
        }
        Ok(())
    }
}

impl Writer {
    /// `%`, the word that names a program, a skip or a number of the next block; any other header becomes a remark.
    fn header(&mut self, header: &[u8], text: &mut Vec<u8>) {
        let digits = header.get(1..).unwrap_or_default();
        let is_number = !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
        match header.first().copied() {
            Some(b'/') if header.len() <= 2 => {
                self.flush_all(text);
                self.skip = header.to_vec();
            }
            Some(b'N' | b'n') if is_number => {
                self.flush(text);
                if !self.number.is_empty() {
                    // A block that said nothing which is written elsewhere keeps its line.
                    self.open(text);
                    self.flush_all(text);
                }
                self.number = header.to_vec();
            }
            Some(b'%') => {
                self.flush_all(text);
                if self.is_opened && !self.is_ended {
                    self.end(text);
                }
                text.extend(header.iter().filter(|b| !matches!(b, b'\r' | b'\n')));
                self.end_line(text);
            }
            Some(letter)
                if is_number
                    && self.dialect.names_program(letter.to_ascii_uppercase())
                    && !self.is_opened =>
            {
                self.flush_all(text);
                text.extend_from_slice(header);
                self.end_line(text);
            }
            _ => {
                self.flush(text);
                self.remark(header, text);
            }
        }
    }

    fn comment(&mut self, remark: &[u8], motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        if !(self.dialect.brackets || self.dialect.semicolon) {
            let help = "a dialect file allows them with `brackets` or `semicolon`";
            return Err(refused(motion.spot, "the dialect has no remarks", help));
        }
        let bracketed =
            self.dialect.brackets && !remark.iter().any(|b| matches!(b, b'(' | b')' | b'\r' | b'\n'));
        if bracketed && !self.line.is_empty() && self.line_block == motion.block {
            self.line.extend_from_slice(b" (");
            self.line.extend_from_slice(remark);
            self.line.push(b')');
            return Ok(());
        }
        self.flush(text);
        if !self.dialect.semicolon && remark.contains(&b')') {
            let help = "take the bracket out of the remark";
            return Err(refused(
                motion.spot,
                "a remark with a bracket, and the dialect has only brackets",
                help,
            ));
        }
        self.remark(remark, text);
        Ok(())
    }

    /// A remark on lines of its own.
    fn remark(&self, remark: &[u8], text: &mut Vec<u8>) {
        for line in remark.split(|b| matches!(b, b'\n' | b'\r')) {
            if self.dialect.brackets && !line.iter().any(|b| matches!(b, b'(' | b')')) {
                text.push(b'(');
                text.extend_from_slice(line);
                text.push(b')');
            } else {
                text.push(b';');
                text.extend_from_slice(line);
            }
            self.end_line(text);
        }
    }

    /// A word that is kept as it stands.
    fn word(&mut self, word: &[u8], motion: &Motion, text: &mut Vec<u8>) {
        self.open(text);
        if motion.block != self.line_block || self.line_is_path {
            self.flush(text);
        }
        // A line end within would make two blocks of it.
        let word: Vec<u8> = word.iter().map(|b| if matches!(b, b'\n' | b'\r') { b' ' } else { *b }).collect();
        self.put(&word, motion.block, false);
        let assigns = word.contains(&b'=');
        if assigns {
            self.flush(text);
        }
    }

    fn offset(&mut self, offset: &Offset, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        self.open(text);
        self.make_room(motion.block, text);
        let Offset::On { side, distance, register } = *offset else {
            self.put(b"G40", motion.block, true);
            return Ok(());
        };
        let help = "give the offset a register, or choose a dialect that can say its value";
        let distance = match distance {
            Some(mm) if mm.abs() < 1e6 => Some(Micrometres::nearest(mm)),
            Some(_) => return Err(refused(motion.spot, "an offset that is no length", help)),
            None => None,
        };
        let mut words = match side {
            Side::Left => b"G41".to_vec(),
            Side::Right => b"G42".to_vec(),
        };
        match (register, distance, self.dialect.register, self.dialect.offset_value) {
            (None, Some(distance), _, Some(letter)) => {
                self.gap(&mut words);
                words.push(letter);
                spelling::length(&self.dialect, distance, &mut words);
            }
            (register, Some(distance), Some(letter), _) if self.dialect.assignments => {
                let register = register.unwrap_or(1);
                if self.register != Some((register, distance)) {
                    self.register = Some((register, distance));
                    self.flush(text);
                    let mut set = vec![letter];
                    spelling::register(&self.dialect, register, &mut set);
                    set.push(b'=');
                    spelling::length(&self.dialect, distance, &mut set);
                    self.put(&set, motion.block, false);
                    self.flush(text);
                }
                self.gap(&mut words);
                words.push(letter);
                spelling::register(&self.dialect, register, &mut words);
            }
            (Some(register), distance, Some(letter), _) => {
                if let Some(distance) = distance {
                    let mut remark = vec![letter];
                    spelling::register(&self.dialect, register, &mut remark);
                    remark.extend_from_slice(format!(" = {:.3} MM", distance.millimetres()).as_bytes());
                    self.flush(text);
                    self.remark(&remark, text);
                }
                self.gap(&mut words);
                words.push(letter);
                spelling::register(&self.dialect, register, &mut words);
            }
            (None, None, _, _) => {}
            _ => return Err(refused(motion.spot, "the dialect has no word for this offset", help)),
        }
        self.put(&words, motion.block, true);
        Ok(())
    }

    fn taper(&mut self, taper: &Taper, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        let (true, Some(letter)) = (self.dialect.has_taper(), self.dialect.taper_angle) else {
            let help = "tilt the wire with U and V, or choose a dialect with G51 and G52";
            return Err(refused(motion.spot, "the dialect has no word for a taper", help));
        };
        self.open(text);
        self.make_room(motion.block, text);
        let Taper::On { side, angle } = *taper else {
            self.put(b"G50", motion.block, true);
            return Ok(());
        };
        // NaN is none either.
        if !(angle.abs() < 90.0) {
            return Err(refused(
                motion.spot,
                "the wire cannot lean so far",
                "an angle lies below 90 degrees",
            ));
        }
        let mut words = match side {
            Side::Left => b"G51".to_vec(),
            Side::Right => b"G52".to_vec(),
        };
        self.gap(&mut words);
        words.push(letter);
        spelling::decimal(angle, &mut words);
        self.put(&words, motion.block, true);
        Ok(())
    }

    fn stop(&mut self, stop: Stop, motion: &Motion, text: &mut Vec<u8>) {
        self.open(text);
        self.flush(text);
        let word: &[u8] = match stop {
            Stop::Pause => b"M00",
            Stop::Optional => b"M01",
            Stop::End => b"M02",
        };
        self.is_ended = stop == Stop::End;
        self.put(word, motion.block, false);
        self.flush(text);
    }

    fn end(&mut self, text: &mut Vec<u8>) {
        self.open(text);
        self.put(b"M02", 0, false);
        self.flush(text);
        self.is_ended = true;
    }

    /// The first block: unit and distance mode.
    fn open(&mut self, text: &mut Vec<u8>) {
        if self.is_opened {
            return;
        }
        self.is_opened = true;
        let mut words = Vec::new();
        if let Some(code) = self.dialect.written.unit_word {
            words.extend_from_slice(format!("G{code:02}").as_bytes());
            self.gap(&mut words);
        }
        words.extend_from_slice(if self.dialect.written.incremental { b"G91" } else { b"G90" });
        let skip = std::mem::take(&mut self.skip);
        // The number of the block that said all this before is its own only if nothing else is waiting for it.
        self.put_unnumbered(&words);
        self.flush(text);
        self.skip = skip;
    }

    /// Ends the line in work unless offset and taper of this block can go on in it.
    fn make_room(&mut self, block: u64, text: &mut Vec<u8>) {
        if self.line_block != block && !self.line_is_path {
            self.flush(text);
        }
    }

    /// Adds words to the line in work.
    fn put(&mut self, words: &[u8], block: u64, is_path: bool) {
        if self.line.is_empty() {
            self.line_is_path = is_path;
            let mut start = std::mem::take(&mut self.skip);
            let mut number = std::mem::take(&mut self.number);
            if let Some(step) = self.layout.number_step {
                self.last_number += u64::from(step);
                number = format!("N{}", self.last_number).into_bytes();
            }
            if !number.is_empty() {
                start.append(&mut number);
                self.gap(&mut start);
            }
            self.line = start;
        } else {
            // A word that is not known may run into its neighbour.
            let plain = words.first().is_some_and(u8::is_ascii_uppercase);
            if self.dialect.written.blanks || !plain || !self.line.last().is_some_and(u8::is_ascii_digit) {
                self.line.push(b' ');
            }
            self.line_is_path &= is_path;
        }
        self.line.extend_from_slice(words);
        self.line_block = block;
    }

    /// Adds words to a line that takes no number from the source.
    fn put_unnumbered(&mut self, words: &[u8]) {
        let number = std::mem::take(&mut self.number);
        self.put(words, 0, false);
        self.number = number;
    }

    /// Ends the line in work, if there is one.
    fn flush(&mut self, text: &mut Vec<u8>) {
        if self.line.is_empty() {
            return;
        }
        text.append(&mut self.line);
        if self.dialect.written.semicolon {
            text.push(b';');
        }
        self.line_is_path = false;
        self.end_line(text);
    }

    /// Ends the line in work; a skip or number that no block has taken stands alone.
    fn flush_all(&mut self, text: &mut Vec<u8>) {
        self.flush(text);
        if self.skip.is_empty() && (self.number.is_empty() || self.layout.number_step.is_some()) {
            self.number.clear();
            return;
        }
        self.line.append(&mut self.skip);
        self.line.append(&mut self.number);
        self.flush(text);
    }

    fn end_line(&self, text: &mut Vec<u8>) {
        if self.dialect.written.carriage_return {
            text.push(b'\r');
        }
        text.push(b'\n');
    }

    fn gap(&self, words: &mut Vec<u8>) {
        if self.dialect.written.blanks {
            words.push(b' ');
        }
    }
}

fn refused(spot: Spot, message: &str, help: &'static str) -> WriteError {
    WriteError { message: message.to_owned(), spot, help: help.into() }
}
