//! What one block makes the machine do: the words of a line, in the state the lines before it left.
//!
//! A block gives its acts in one order: its number and remarks and the words that are kept, as they stand; then the
//! offset, the taper, the motion and the stop. The state is in whole nanometres from where the program began.

mod acts;
mod path;

use std::collections::VecDeque;

use super::arcs::Nanometres;
use super::boundaries::{counts, unclosed};
use super::dialect::{Code, Dialect, I, J, LENGTHS, Role};
use super::modal::{Modal, Mode};
use super::numbers::Number;
use super::registers::Registers;
use super::subprograms::called;
use super::words::{self, Kind, Word};
use crate::formats::ReadError;
use crate::formats::lines::Line;
use crate::motion::{Act, Motion, Offset, Stop, Taper};
use crate::place::Place;

/// The state of a control as far as the path depends on it.
#[derive(Debug)]
pub(super) struct Machine {
    pub dialect: Dialect,
    words: Vec<Word>,
    modal: Modal,
    /// Where the wire is, from where the program began.
    at: Nanometres,
    /// Where its upper end is, from there.
    lean: Nanometres,
    /// What the program's coordinates are shifted by: later G92.
    shift: Nanometres,
    /// Whether the start is settled: by a G92 or by a motion.
    is_placed: bool,
    upper_mode: Option<Mode>,
    register: Option<u32>,
    /// The offset itself, where a word gives it.
    offset_value: Option<i64>,
    registers: Registers,
    angle: Option<f64>,
    /// What was last told.
    offset: Offset,
    taper: Taper,
}

/// Where a program goes on.
#[derive(Debug)]
pub(super) enum Flow {
    /// With the next line.
    On,
    /// With a subprogram.
    Call { label: u32, repeats: u32, place: Place },
    /// Behind the call.
    Return(Place),
    /// Nowhere.
    End,
}

/// A block in work.
pub(super) struct Now<'a> {
    pub line: Line<'a>,
    pub block: u64,
    pub ready: &'a mut VecDeque<Motion>,
}

/// A length of a block and the word it stands in.
#[derive(Clone, Copy, Debug)]
struct Length {
    value: i64,
    word: Word,
}

/// What the G and M words of a block make of its other words.
#[derive(Clone, Copy, Debug, Default)]
struct Sense {
    dwell: Option<Word>,
    position: Option<Word>,
    call: Option<Word>,
    back: Option<Word>,
    /// A word that says how the wire moves.
    travel: Option<Word>,
    /// A G word that is not known.
    unknown: Option<Word>,
    /// A word with an argument, and the argument's letter.
    owner: Option<u8>,
    ends: bool,
}

impl Machine {
    pub(super) fn new(dialect: Dialect) -> Self {
        Self {
            modal: Modal::at_start(&dialect),
            dialect,
            words: Vec::new(),
            at: [0, 0],
            lean: [0, 0],
            shift: [0, 0],
            is_placed: false,
            upper_mode: None,
            register: None,
            offset_value: None,
            registers: Registers::default(),
            angle: None,
            offset: Offset::Off,
            taper: Taper::Off,
        }
    }

    /// Cuts a line, for what is passed over; whether it counts as a block.
    pub(super) fn cut(&mut self, line: &Line<'_>) -> Result<(&[Word], bool), ReadError> {
        words::cut(line.bytes, &mut self.words).map_err(|e| unclosed(line, e))?;
        let counted = counts(&self.words, &self.dialect);
        Ok((&self.words, counted))
    }

    /// Executes a line; `blocks_before` counts those before it. Whether the line is a block, and where to go on.
    pub(super) fn run(
        &mut self,
        line: Line<'_>,
        blocks_before: u64,
        ready: &mut VecDeque<Motion>,
    ) -> Result<(bool, Flow), ReadError> {
        let (_, counted) = self.cut(&line)?;
        let words = std::mem::take(&mut self.words);
        let mut now = Now { line, block: blocks_before + u64::from(counted), ready };
        let flow = self.block(&words, &mut now);
        self.words = words;
        Ok((counted, flow?))
    }

    fn block(&mut self, words: &[Word], now: &mut Now<'_>) -> Result<Flow, ReadError> {
        let (lower, upper) = match words.iter().position(|w| w.kind == Kind::Colon) {
            Some(at) if self.dialect.pairs => (&words[..at], Some(&words[at + 1..])),
            _ => (words, None),
        };
        let sense = self.sense(lower, now)?;
        self.modal.take_in(lower, &self.dialect);
        let mut lengths = [None; LENGTHS];
        for (n, word) in lower.iter().enumerate() {
            match word.kind {
                Kind::Word => self.word(word, lower.get(n + 1), lower, &sense, &mut lengths, now)?,
                _ => self.piece(word, now)?,
            }
        }
        if self.modal.taper.is_none() {
            self.angle = None;
        }
        self.tell_offset(now);
        self.tell_taper(now)?;
        if let Some(word) = sense.position {
            if upper.is_some() {
                return Err(now.error(&word, "a G92 block has no second half", "leave the `:` out"));
            }
            self.position(&word, &lengths, now)?;
        } else {
            self.travel(&lengths, upper, &sense, now)?;
        }
        self.stops(lower, now);
        if let Some(word) = sense.call {
            return match called(lower, &self.dialect) {
                Some((label, Some(repeats))) if repeats > 0 => {
                    Ok(Flow::Call { label, repeats, place: now.place(&word) })
                }
                _ => Err(now.error(
                    &word,
                    "a call that does not say what or how often",
                    "M98 P and L with whole numbers",
                )),
            };
        }
        Ok(match sense.back {
            _ if sense.ends => Flow::End,
            Some(word) => Flow::Return(now.place(&word)),
            None => Flow::On,
        })
    }

    /// Looks through the G and M words; two that contradict each other are an error.
    fn sense(&self, words: &[Word], now: &Now<'_>) -> Result<Sense, ReadError> {
        let mut sense = Sense::default();
        let mut seen: [Option<Code>; 6] = [None; 6];
        for word in words {
            let code = match word.letter {
                b'G' => self.dialect.g_code(word),
                b'M' => self.dialect.m_code(word),
                _ => continue,
            };
            let group = match code {
                Code::Travel(_) => {
                    sense.travel = Some(*word);
                    0
                }
                Code::Incremental(_) => 1,
                Code::Unit(_) => 2,
                Code::Offset(_) => 3,
                Code::Taper(_) => 4,
                Code::Frame(_) => 5,
                Code::Dwell => {
                    sense.dwell = Some(*word);
                    continue;
                }
                Code::Position => {
                    sense.position = Some(*word);
                    continue;
                }
                Code::Call => {
                    sense.call = Some(*word);
                    continue;
                }
                Code::Return => {
                    sense.back = Some(*word);
                    continue;
                }
                Code::End => {
                    sense.ends = true;
                    continue;
                }
                Code::Unknown if word.letter == b'G' => {
                    sense.unknown = Some(*word);
                    continue;
                }
                Code::Kept => {
                    sense.owner = self.dialect.argument(word).or(sense.owner);
                    continue;
                }
                Code::Plane
                | Code::Pause
                | Code::OptionalStop
                | Code::Refused
                | Code::Macro
                | Code::Unknown => continue,
            };
            if seen[group].is_some_and(|other| other != code) {
                return Err(now.error(
                    word,
                    "the block has another word of this kind",
                    "leave one of them out",
                ));
            }
            seen[group] = Some(code);
        }
        Ok(sense)
    }

    /// Takes in one word.
    fn word(
        &mut self,
        word: &Word,
        next: Option<&Word>,
        words: &[Word],
        sense: &Sense,
        lengths: &mut [Option<Length>; LENGTHS],
        now: &mut Now<'_>,
    ) -> Result<(), ReadError> {
        match word.letter {
            b'G' => return self.code(word, self.dialect.g_code(word), words, now),
            b'M' => return self.code(word, self.dialect.m_code(word), words, now),
            b'X' | b'P' if sense.dwell.is_some() => return Ok(()),
            b'P' | b'L' if sense.call.is_some() => return now.only_one(word, words),
            letter if sense.owner == Some(letter) => return Ok(()),
            b'J' if self.dialect.lone_j && is_alone(word, words) => {
                now.tell(Act::Word(word.text(now.line.bytes).into()), word);
                return Ok(());
            }
            _ => {}
        }
        let role = self.dialect.role(word.letter);
        if matches!(role, Role::Register | Role::OffsetValue | Role::Angle) {
            now.only_one(word, words)?;
        }
        match role {
            Role::Length(place) => {
                let place = usize::from(place);
                if sense.position.is_some() && (place == I || place == J) && self.dialect.heights {
                    return Ok(());
                }
                if next.is_some_and(|e| e.letter == b'E' && e.at == word.end) {
                    return Err(now.error(
                        word,
                        "a number with an exponent",
                        "G-code has none; put a blank before the word E",
                    ));
                }
                let value = self.length(word, now)?;
                if lengths[place].is_some() {
                    return Err(now.twice(word));
                }
                lengths[place] = Some(Length { value, word: *word });
            }
            Role::Number => {
                if word.number().is_none() {
                    return Err(now.error(word, "an N without a number", "number the block or leave it out"));
                }
                now.tell(Act::Header(word.text(now.line.bytes).into()), word);
            }
            Role::Kept => now.tell(Act::Word(word.text(now.line.bytes).into()), word),
            Role::Feed => {
                let text = self.feed(word, now)?;
                now.tell(Act::Word(text), word);
            }
            Role::Register => match word.whole() {
                Some(register) => (self.register, self.offset_value) = (Some(register), None),
                None => {
                    return Err(now.error(
                        word,
                        "not the number of a register",
                        "registers have whole numbers",
                    ));
                }
            },
            Role::OffsetValue => self.offset_value = Some(self.length(word, now)?),
            Role::Angle => self.angle = Some(self.angle(word, now)?),
            Role::Refused => return Err(now.refused(word)),
            Role::Unknown if self.dialect.names_program(word.letter) && is_first(word, words) => {
                now.tell(Act::Header(word.text(now.line.bytes).into()), word);
            }
            Role::Unknown => now.tell(Act::Unknown(word.text(now.line.bytes).into()), word),
        }
        Ok(())
    }

    /// Takes in a G or M word.
    fn code(&mut self, word: &Word, code: Code, words: &[Word], now: &mut Now<'_>) -> Result<(), ReadError> {
        let text = word.text(now.line.bytes);
        match code {
            Code::Dwell => {
                let seconds = self.dwell(word, words, now)?;
                now.tell(Act::Dwell(seconds), word);
            }
            Code::Frame(_) => now.tell(Act::Word(text.into()), word),
            Code::Kept => {
                let argument = self.dialect.argument(word);
                let argument = argument.and_then(|letter| words.iter().find(|w| w.letter == letter));
                let mut text = text.to_vec();
                if let Some(argument) = argument {
                    text.push(b' ');
                    text.extend_from_slice(argument.text(now.line.bytes));
                }
                now.tell(Act::Word(text.into()), word);
            }
            Code::Refused => return Err(now.refused(word)),
            Code::Macro => return Err(now.macro_program(word)),
            Code::Unknown => now.tell(Act::Unknown(text.into()), word),
            // These are in the state or told when the block is done.
            Code::Travel(_)
            | Code::Incremental(_)
            | Code::Unit(_)
            | Code::Offset(_)
            | Code::Taper(_)
            | Code::Plane
            | Code::Position
            | Code::Pause
            | Code::OptionalStop
            | Code::End
            | Code::Call
            | Code::Return => {}
        }
        Ok(())
    }

    /// The number of a word as a length.
    fn length(&self, word: &Word, now: &Now<'_>) -> Result<i64, ReadError> {
        let number = now.number(word)?;
        self.nanometres(number).map_err(|message| {
            now.error(word, message, "write the point, or choose a dialect that has a rule")
        })
    }

    fn nanometres(&self, number: Number) -> Result<i64, String> {
        let unit = self.modal.unit;
        let per = if number.point || number.mantissa == 0 {
            unit.nanometres()
        } else {
            self.dialect.without_point[unit as usize].ok_or_else(|| {
                format!(
                    "a length without a point: the dialect {} has no rule for it in {}",
                    self.dialect.name,
                    unit.name()
                )
            })?
        };
        number.nanometres(per).ok_or_else(|| "a length of more than a kilometre".to_owned())
    }

    fn stops(&self, words: &[Word], now: &mut Now<'_>) {
        for word in words.iter().filter(|w| w.letter == b'M') {
            let stop = match self.dialect.m_code(word) {
                Code::Pause => Stop::Pause,
                Code::OptionalStop => Stop::Optional,
                Code::End => Stop::End,
                _ => continue,
            };
            now.tell(Act::Stop(stop), word);
        }
    }
}

/// Whether a word is the first of its block.
fn is_first(word: &Word, words: &[Word]) -> bool {
    words.iter().find(|w| w.kind == Kind::Word).is_some_and(|first| first.at == word.at)
}

/// Whether a word stands alone in its block, but for a number and remarks.
fn is_alone(word: &Word, words: &[Word]) -> bool {
    words.iter().all(|w| w.at == word.at || w.letter == b'N' || matches!(w.kind, Kind::Comment | Kind::Skip))
}
