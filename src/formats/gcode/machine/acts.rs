//! What a block says besides motion: pieces that are no words, offset, taper, dwell, feed; and its errors.

use super::{Machine, Now};
use crate::formats::ReadError;
use crate::formats::gcode::dialect::{LongWord, Role};
use crate::formats::gcode::numbers::{Number, Unit, millimetres};
use crate::formats::gcode::words::{Kind, Word};
use crate::motion::{Act, Motion, Offset, Taper};
use crate::place::Place;

impl Now<'_> {
    /// Adds an act of the block, at one of its words.
    pub(super) fn tell(&mut self, act: Act, word: &Word) {
        self.ready.push_back(Motion { act, block: self.block, spot: self.line.spot(word.at as usize) });
    }

    /// Adds an act of the whole block.
    pub(super) fn tell_of_block(&mut self, act: Act) {
        self.ready.push_back(Motion { act, block: self.block, spot: self.line.spot(0) });
    }

    pub(super) fn place(&self, word: &Word) -> Place {
        self.line.place(word.at as usize, word.width())
    }

    pub(super) fn error(&self, word: &Word, message: impl Into<String>, help: &'static str) -> ReadError {
        let text = String::from_utf8_lossy(word.text(self.line.bytes)).into_owned();
        let message: String = message.into();
        ReadError::Program {
            message: if text.is_empty() || text.len() > 60 {
                message
            } else {
                format!("`{text}`: {message}")
            },
            place: self.place(word),
            help: help.into(),
        }
    }

    pub(super) fn error_of_block(&self, message: impl Into<String>, help: impl Into<String>) -> ReadError {
        let start = self.line.bytes.iter().take_while(|b| b.is_ascii_whitespace()).count();
        ReadError::Program {
            message: message.into(),
            place: self.line.place(start, self.line.bytes.len().saturating_sub(start)),
            help: help.into().into(),
        }
    }

    pub(super) fn refused(&self, word: &Word) -> ReadError {
        self.error(
            word,
            "changes what is cut, and is not read",
            "write out the motion it makes; in the dialect file it stands under `refused`",
        )
    }

    /// Refuses the second word of a letter in a block.
    pub(super) fn only_one(&self, word: &Word, words: &[Word]) -> Result<(), ReadError> {
        let has_another = words.iter().any(|w| w.letter == word.letter && w.at < word.at);
        if has_another { Err(self.twice(word)) } else { Ok(()) }
    }

    pub(super) fn twice(&self, word: &Word) -> ReadError {
        self.error(word, "the block has this word already", "leave one of them out")
    }

    pub(super) fn macro_program(&self, word: &Word) -> ReadError {
        self.error(word, "macro program: expand first", "a program of plain blocks is needed here")
    }

    pub(super) fn number(&self, word: &Word) -> Result<Number, ReadError> {
        word.number().ok_or_else(|| {
            let message =
                if word.is_too_long() { "the number is too long" } else { "a letter without its number" };
            self.error(word, message, "a number has at most 18 digits, and at least one")
        })
    }
}

impl Machine {
    /// Takes in what is not a word.
    pub(super) fn piece(&mut self, piece: &Word, now: &mut Now<'_>) -> Result<(), ReadError> {
        let text = piece.text(now.line.bytes);
        match piece.kind {
            Kind::Comment => {
                let bracket = now.line.bytes.get((piece.at as usize).wrapping_sub(1)) == Some(&b'(');
                let known = if bracket { self.dialect.brackets } else { self.dialect.semicolon };
                if !known {
                    return Err(now.error(
                        piece,
                        "the dialect has no remarks of this kind",
                        "leave the remark out",
                    ));
                }
                now.tell(Act::Comment(text.into()), piece);
            }
            Kind::Skip | Kind::Percent => now.tell(Act::Header(text.into()), piece),
            Kind::Macro => return Err(now.macro_program(piece)),
            Kind::Assignment => return self.assignment(piece, now),
            Kind::Unknown => match self.dialect.long_word(text) {
                LongWord::Kept => now.tell(Act::Word(text.into()), piece),
                LongWord::Refused => return Err(now.refused(piece)),
                LongWord::Command => {
                    return Err(now.error(
                        piece,
                        "a word of a command file, not of a part program",
                        "give the part program it calls",
                    ));
                }
                LongWord::Unknown => now.tell(Act::Unknown(text.into()), piece),
            },
            Kind::Colon | Kind::Word => now.tell(Act::Unknown(text.into()), piece),
        }
        Ok(())
    }

    /// `H1 = …` sets registers; `E001 = …` defines a condition and is kept.
    fn assignment(&mut self, piece: &Word, now: &mut Now<'_>) -> Result<(), ReadError> {
        let text = piece.text(now.line.bytes);
        let letter = text.first().map_or(0, u8::to_ascii_uppercase);
        match self.dialect.register {
            Some(register) if register == letter && self.dialect.assignments => {
                let mut registers = std::mem::take(&mut self.registers);
                let set = registers.assign(text, letter, |number| self.nanometres(number));
                self.registers = registers;
                set.map_err(|wrong| ReadError::Program {
                    message: wrong.message,
                    place: now.line.place(piece.at as usize + wrong.at, 1),
                    help: "a register is set to a number, a register, or a sum of them".into(),
                })
            }
            _ => {
                let kept = letter.is_ascii_uppercase() && self.dialect.role(letter) == Role::Kept;
                now.tell(if kept { Act::Word(text.into()) } else { Act::Unknown(text.into()) }, piece);
                Ok(())
            }
        }
    }

    /// Tells the offset when it is another than before.
    pub(super) fn tell_offset(&mut self, now: &mut Now<'_>) {
        let offset = match self.modal.offset {
            None => Offset::Off,
            Some(side) => {
                let (register, distance) = match (self.offset_value, self.register) {
                    (Some(value), _) => (None, Some(value)),
                    (None, register) => (register, register.and_then(|r| self.registers.value(r))),
                };
                Offset::On { side, distance: distance.map(millimetres), register }
            }
        };
        if offset != self.offset {
            self.offset = offset;
            now.tell_of_block(Act::Offset(offset));
        }
    }

    /// Tells the taper when it is another than before.
    pub(super) fn tell_taper(&mut self, now: &mut Now<'_>) -> Result<(), ReadError> {
        let taper = match (self.modal.taper, self.angle) {
            (None, _) => Taper::Off,
            (Some(side), Some(angle)) => Taper::On { side, angle },
            (Some(_), None) => {
                return Err(now.error_of_block(
                    "a taper without an angle",
                    "say the angle in the block that switches it on",
                ));
            }
        };
        if taper != self.taper {
            self.taper = taper;
            now.tell_of_block(Act::Taper(taper));
        }
        Ok(())
    }

    /// The angle of a taper, degrees.
    pub(super) fn angle(&self, word: &Word, now: &Now<'_>) -> Result<f64, ReadError> {
        let number = now.number(word)?;
        let angle = if number.point || number.mantissa == 0 {
            number.decimal()
        } else {
            let thousandths = self.dialect.angle_without_point.ok_or_else(|| {
                now.error(
                    word,
                    "an angle without a point, for which the dialect has no rule",
                    "write the point",
                )
            })?;
            number.decimal() * f64::from(thousandths) / 1000.0
        };
        if angle.abs() >= 90.0 {
            return Err(now.error(word, "the wire cannot lean so far", "an angle lies below 90 degrees"));
        }
        // Never -0.
        Ok(angle + 0.0)
    }

    /// How long a G04 waits, seconds.
    pub(super) fn dwell(&self, word: &Word, words: &[Word], now: &Now<'_>) -> Result<f64, ReadError> {
        let mut times = words.iter().filter(|w| matches!(w.letter, b'X' | b'P'));
        let (Some(time), None) = (times.next(), times.next()) else {
            return Err(now.error(word, "a dwell needs one time", "X or P with the seconds"));
        };
        let number = now.number(time)?;
        let seconds = if number.point || number.mantissa == 0 {
            number.decimal()
        } else {
            let milliseconds = self.dialect.dwell_without_point.ok_or_else(|| {
                now.error(
                    time,
                    "a time without a point, for which the dialect has no rule",
                    "write the point",
                )
            })?;
            number.decimal() * f64::from(milliseconds) / 1000.0
        };
        if seconds < 0.0 {
            return Err(now.error(time, "a negative time", "write how long to wait"));
        }
        Ok(seconds + 0.0)
    }

    /// The text of a feed: as it stands in millimetres, translated from inches.
    pub(super) fn feed(&self, word: &Word, now: &Now<'_>) -> Result<Box<[u8]>, ReadError> {
        let number = now.number(word)?;
        if self.modal.unit == Unit::Millimetre || number.mantissa == 0 {
            return Ok(word.text(now.line.bytes).into());
        }
        let value = self.length(word, now)?;
        let digits = format!("{:06}", value.unsigned_abs() % 1_000_000);
        let sign = if value < 0 { "-" } else { "" };
        let text = format!("F{sign}{}.{}", value.unsigned_abs() / 1_000_000, digits.trim_end_matches('0'));
        Ok(text.into_bytes().into())
    }
}
