//! Motions as a G-code program, a line at a time.
//!
//! A program begins with its unit, its distance mode and where the wire is (`G21 G90`, `G92 X… Y…`), has one motion a
//! line and ends with M02. Nodes are rounded to the micron as absolute positions, so that increments do not add up
//! remainders. Words that stood in one block stay in one; a comment that would end a line early stands before it. What the
//! dialect has no word for is an error, never left out.

mod moves;
mod spelling;
mod texts;

use super::dialect::Dialect;
use super::modal::Mode;
use crate::formats::losses::Losses;
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
    /// The block its words come from, and the line of the source.
    line_block: u64,
    line_of: u64,
    /// Whether it holds offset and taper words alone, which go into the block of the next line.
    line_is_path: bool,
    /// Whether nothing but remarks may follow in it.
    line_is_full: bool,
    /// `/`, with its level, that the next line takes.
    skip: Vec<u8>,
    /// The N word that the next line takes.
    number: Vec<u8>,
    /// The block both are of, and the line of the source.
    waiting_for: (u64, u64),
    /// Remarks for the end of the line in work, or of the one the number waits for.
    tail: Vec<u8>,
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
    losses: Losses,
}

/// Choices about how a program is written that do not depend on the control.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Layout {
    /// Numbers every block in such steps, in place of the numbers it had.
    pub number_step: Option<u32>,
    /// Leaves out what is in force already: the word of motion, an axis that does not move.
    pub suppress: bool,
    /// The register for an offset that is a number, in a dialect that only has registers; a remark says what is to be keyed
    /// into it. None: such an offset is refused.
    pub register: Option<u32>,
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
            line_of: 0,
            line_is_path: false,
            line_is_full: false,
            skip: Vec::new(),
            number: Vec::new(),
            waiting_for: (0, 0),
            tail: Vec::new(),
            last_number: 0,
            is_opened: false,
            is_ended: false,
            flags_told: false,
            at: None,
            lean: Position::default(),
            mode: None,
            register: None,
            losses: Losses::default(),
        }
    }

    /// What stands in the program as a remark, because the dialect has no word for it.
    #[must_use]
    pub fn lost(&self) -> &Losses {
        &self.losses
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
        // Where the line of the source is not known there is one for all.
        let comes_from = (motion.block, motion.spot.line);
        if comes_from != self.waiting_for {
            self.settle_what_waits(text);
        }
        if self.line_is_full && !matches!(motion.act, Act::Comment(_)) {
            self.flush(text);
        }
        if self.line.is_empty() {
            self.line_of = motion.spot.line;
        }
        match &motion.act {
            Act::Header(header) => self.header(header, motion, text),
            Act::Comment(remark) => return self.comment(remark, motion, text),
            Act::Word(word) | Act::Unknown(word) => return self.word(word, motion, text),
            Act::Move { travel, element, upper, flag } => {
                if flag.is_some() && !self.flags_told {
                    self.flags_told = true;
                    self.flush(text);
                    self.losses.add("4B flag", motion.spot);
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
                self.line_is_full = true;
            }
        }
        Ok(())
    }

    fn finish(&mut self, text: &mut Vec<u8>) -> Result<(), WriteError> {
        self.settle(text);
        if !self.is_ended {
            self.end(text);
        }
        Ok(())
    }
}

impl Writer {
    fn offset(&mut self, offset: &Offset, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        self.open(text);
        self.make_room(*b"G4", motion.block, text);
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
        let register = register.or(distance.and(self.layout.register));
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
                    self.apart(text, |writer, text| {
                        writer.put(&set, motion.block, false);
                        writer.flush(text);
                    });
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
        self.make_room(*b"G5", motion.block, text);
        let Taper::On { side, angle } = *taper else {
            self.put(b"G50", motion.block, true);
            return Ok(());
        };
        if !angle.is_finite() || angle.abs() >= 90.0 {
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
        if !self.is_opened {
            self.apart(text, Self::say_modes);
        }
    }

    fn say_modes(&mut self, text: &mut Vec<u8>) {
        self.is_opened = true;
        let mut words = Vec::new();
        if let Some(code) = self.dialect.written.unit_word {
            words.extend_from_slice(format!("G{code:02}").as_bytes());
            self.gap(&mut words);
        }
        words.extend_from_slice(if self.dialect.written.incremental { b"G91" } else { b"G90" });
        self.put(&words, self.waiting_for.0, false);
        self.flush(text);
    }

    /// Writes a line that takes neither the number nor the skip nor the remarks that wait for another.
    fn apart(&mut self, text: &mut Vec<u8>, write: impl FnOnce(&mut Self, &mut Vec<u8>)) {
        let skip = std::mem::take(&mut self.skip);
        let number = std::mem::take(&mut self.number);
        let tail = std::mem::take(&mut self.tail);
        write(self, text);
        (self.skip, self.number, self.tail) = (skip, number, tail);
    }

    /// Ends the line in work unless a word of this group, offset or taper, can go on in it.
    fn make_room(&mut self, group: [u8; 2], block: u64, text: &mut Vec<u8>) {
        let is_there = self.line.windows(2).any(|pair| pair == group);
        if is_there || self.line_block != block && !self.line_is_path {
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
                // What is no word would go on in the number.
                if self.dialect.written.blanks || !words.first().is_some_and(u8::is_ascii_alphabetic) {
                    start.push(b' ');
                }
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

    /// Ends the line in work, if there is one.
    fn flush(&mut self, text: &mut Vec<u8>) {
        if self.line.is_empty() {
            return;
        }
        text.append(&mut self.line);
        text.append(&mut self.tail);
        if self.dialect.written.semicolon {
            text.push(b';');
        }
        (self.line_is_path, self.line_is_full) = (false, false);
        self.end_line(text);
    }

    /// A number, skip or remark of another block that no line has taken stands in one of its own.
    fn settle_what_waits(&mut self, text: &mut Vec<u8>) {
        if !(self.skip.is_empty() && self.number.is_empty()) {
            self.settle(text);
        }
    }

    /// Ends the line in work; a number, skip or remark that no line of its block has taken stands in one of its own.
    fn settle(&mut self, text: &mut Vec<u8>) {
        self.flush(text);
        if self.skip.is_empty() && self.number.is_empty() {
            return;
        }
        if !self.is_opened && !self.number.is_empty() && self.skip.is_empty() {
            // That block is likely to have said the same.
            return self.say_modes(text);
        }
        self.open(text);
        if self.layout.number_step.is_some() {
            // The number alone says nothing, the skip of nothing neither.
            self.skip.clear();
            self.number.clear();
        }
        self.line.append(&mut self.skip);
        self.line.append(&mut self.number);
        if self.line.is_empty() {
            if !self.tail.is_empty() {
                text.extend_from_slice(self.tail.trim_ascii_start());
                self.tail.clear();
                self.end_line(text);
            }
            return;
        }
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
