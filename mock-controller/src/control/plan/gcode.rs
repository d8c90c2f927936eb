//! G-code: words carried out one line at a time, as this mock reads them.
//!
//! - Motion G00 to G03 is modal, G90 and G91, G20 and G21 too; a program begins with G90 G21 and no motion. I and J are
//!   counted from the arc's start, R is the minor arc if positive, the major if negative, and no full circle.
//! - Targets are kept exactly and rounded to the nearest µm, halves away from zero; every motion ends there. A motion
//!   without length is none and not counted.
//! - G92 says where the wire stands. G04 waits for nothing, M00 and M01 stop nothing.
//! - G40 G41 G42 put the wire beside the path (`beside`), by the offset that D or H tells (`offsets`).
//! - M02 and M30 end the program. Subprograms stand behind it, O to M99, and are called by M98 P L: from the first call
//!   on, nothing is cut until the program's end has been read.
//! - G50 G51 G52, T and A with them or under G51 and G52, and the words of the list, are passed over and counted. G17, N and O say nothing here.
//!   Every other word is the alarm `word`: nothing is ignored in silence.
//!
//! Not done: a taper (U, V, T), other planes and axes, work offsets, macros, G28 to G30, scaling, rotation.
//!
//! All of it is a reading of this mock, unverified for any control; sources: domain/4 and domain/5, and common usage.

mod arc;
mod beside;
mod call;
mod offsets;
mod reading;

use std::collections::{BTreeMap, VecDeque};

use super::{Motion, Planned};
use crate::control::settings::Settings;
use crate::dialect::gcode::{Line, Word};
use crate::outline::{Element, Point, Shape, Turn};
use beside::{Beside, Piece};
use offsets::Offsets;
pub use offsets::{NotARegister, Register};
pub use reading::{ArcCentre, GcodeSettings, IgnoredWords, NotAWord, UnitWithoutPoint};

pub(in crate::control) struct GcodePlan {
    reading: GcodeSettings,
    offsets: Offsets,
    modal: Modal,
    /// Where the program has brought it, from where the wire stood before the first block.
    at: Exact,
    /// Where the program's zero is.
    zero: Exact,
    beside: Beside,
    /// A program that calls subprograms, until its end has been read.
    collected: Option<Vec<Read>>,
    /// M02 or an alarm: the rest of the program is not carried out.
    over: bool,
    passed_over: BTreeMap<String, u64>,
    ready: VecDeque<Planned>,
}

/// A line, and the characters it had.
#[derive(Clone, Debug)]
struct Read {
    line: Line,
    characters: usize,
}

/// What stays in force from line to line.
#[derive(Clone, Copy, Debug, Default)]
struct Modal {
    inch: bool,
    incremental: bool,
    motion: Option<Course>,
    /// D or H: which offset.
    offset: Option<Word>,
    /// Under G41 and G42: how far the wire is to be to the right of the path, µm.
    right: Option<f64>,
    /// Under G51 and G52: the wire would be inclined.
    tapers: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Course {
    Straight,
    Round(Turn),
}

/// x and y in millionths of a µm: an inch to six decimals is a whole number of them.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
struct Exact {
    x: i64,
    y: i64,
}

/// Why a line cannot be carried out: the alarm's name, and what was found.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    name: &'static str,
    found: String,
}

/// What one line says.
#[derive(Clone, Debug, Default)]
struct Said {
    inch: Option<bool>,
    incremental: Option<bool>,
    motion: Option<Course>,
    beside: Option<Side>,
    sets_zero: bool,
    ends: bool,
    /// D or H, if it is an offset's number.
    offset: Option<Word>,
    /// X Y I J R.
    lengths: BTreeMap<char, Word>,
}

#[derive(Clone, Copy, Debug)]
enum Side {
    None,
    Left,
    Right,
}

impl GcodePlan {
    pub(super) fn new(settings: &Settings, [x, y]: [i64; 2]) -> GcodePlan {
        GcodePlan {
            reading: settings.gcode.clone(),
            offsets: Offsets::new(settings),
            modal: Modal::default(),
            at: Exact { x: x * MILLIONTHS, y: y * MILLIONTHS },
            zero: Exact::default(),
            beside: Beside::On,
            collected: None,
            over: false,
            passed_over: BTreeMap::new(),
            ready: VecDeque::new(),
        }
    }

    pub(super) fn next(&mut self) -> Option<Planned> {
        self.ready.pop_front()
    }

    pub(super) fn passed_over(&self) -> BTreeMap<String, u64> {
        self.passed_over.clone()
    }

    pub(super) fn line(&mut self, line: Line, characters: usize) {
        if self.over {
            return;
        }
        let place = line.place;
        let calls = call::says(&line, 'M', 98) && !self.is_skipped(&line);
        let outcome = match &mut self.collected {
            Some(lines) if lines.len() < call::LINES_MAX => {
                lines.push(Read { line, characters });
                Ok(())
            }
            Some(_) => Err(Fault::new("call", "too long a program to call subprograms")),
            None if calls => {
                self.collected = Some(vec![Read { line, characters }]);
                Ok(())
            }
            None => self.carry_out(&line, characters),
        };
        if let Err(fault) = outcome {
            self.alarm(fault, place);
        }
    }

    pub(super) fn end(&mut self) {
        if let Some(lines) = self.collected.take()
            && !self.over
            && let Err((fault, place)) = self.run_collected(&lines)
        {
            self.alarm(fault, place);
        }
        let mut out = Vec::new();
        let outcome = self.beside.finish(&mut out);
        self.release(out);
        if let Err(fault) = outcome {
            self.alarm(fault, 0);
        }
        self.beside = Beside::On;
        self.modal = Modal::default();
        self.over = false;
        self.ready.push_back(Planned::End);
    }

    fn alarm(&mut self, Fault { name, found }: Fault, place: u64) {
        let mut out = Vec::new();
        // What could be cut before the fault is; a second fault tells nothing more.
        let _ = self.beside.finish(&mut out);
        self.release(out);
        self.over = true;
        self.ready.push_back(Planned::Alarm { name, found: format!("line {place}: {found}") });
    }

    fn release(&mut self, out: Vec<Motion>) {
        self.ready.extend(out.into_iter().map(Planned::Cut));
    }

    fn is_skipped(&self, line: &Line) -> bool {
        line.may_be_skipped && self.reading.block_skip
    }

    /// Carries out one line that calls nothing.
    fn carry_out(&mut self, line: &Line, characters: usize) -> Result<(), Fault> {
        if self.is_skipped(line) {
            return Ok(());
        }
        let said = self.hear(line)?;
        self.modal.inch = said.inch.unwrap_or(self.modal.inch);
        self.modal.incremental = said.incremental.unwrap_or(self.modal.incremental);
        self.modal.motion = said.motion.or(self.modal.motion);
        let mut out = Vec::new();
        let outcome = self.change_side(&said, &mut out).and_then(|()| match said.lengths.is_empty() {
            true => Ok(()),
            false if said.sets_zero => self.set_zero(&said),
            false => self.motion(&said, characters, &mut out),
        });
        self.release(out);
        self.over |= said.ends;
        outcome
    }

    fn hear(&mut self, line: &Line) -> Result<Said, Fault> {
        let mut said = Said::default();
        let waits = call::says(line, 'G', 4);
        let compensates = call::says(line, 'G', 41) || call::says(line, 'G', 42);
        let inclines = call::says(line, 'G', 51) || call::says(line, 'G', 52);
        let upright = call::says(line, 'G', 50);
        let tapers = inclines || upright || self.modal.tapers;
        self.modal.tapers = inclines || (self.modal.tapers && !upright);
        for word in &line.words {
            match word.letter {
                'N' | 'O' => {}
                'X' | 'P' | 'U' if waits => {} // How long it would wait.
                'A' | 'T' if tapers => self.count(word),
                'X' | 'Y' | 'I' | 'J' | 'R' => {
                    if said.lengths.insert(word.letter, *word).is_some() {
                        return Err(Fault::new("word", &format!("{word}: {} twice", word.letter)));
                    }
                }
                'D' | 'H' if self.offsets.are_told_by(word, compensates) => {
                    if said.offset.replace(*word).is_some() {
                        return Err(Fault::new("word", &format!("{word}: a second offset number")));
                    }
                }
                'G' => self.hear_g(word, &mut said)?,
                'M' => match word.number.whole() {
                    Some(0 | 1) => {}
                    Some(2 | 30) => said.ends = true,
                    Some(99) => return Err(call::no_caller()),
                    _ => self.pass_over(word)?,
                },
                _ => self.pass_over(word)?,
            }
        }
        Ok(said)
    }

    fn hear_g(&mut self, word: &Word, said: &mut Said) -> Result<(), Fault> {
        let course = match word.number.whole() {
            Some(0 | 1) => Course::Straight,
            Some(2) => Course::Round(Turn::Clockwise),
            Some(3) => Course::Round(Turn::CounterClockwise),
            other => {
                match other {
                    Some(4 | 17) => {}
                    Some(20) => said.inch = Some(true),
                    Some(21) => said.inch = Some(false),
                    Some(40) => said.beside = Some(Side::None),
                    Some(41) => said.beside = Some(Side::Left),
                    Some(42) => said.beside = Some(Side::Right),
                    Some(50..=52) => self.count(word),
                    Some(90) => said.incremental = Some(false),
                    Some(91) => said.incremental = Some(true),
                    Some(92) => said.sets_zero = true,
                    _ => self.pass_over(word)?,
                }
                return Ok(());
            }
        };
        match said.motion.replace(course) {
            None => Ok(()),
            Some(_) => Err(Fault::new("word", &format!("{word}: a second motion in one line"))),
        }
    }

    fn pass_over(&mut self, word: &Word) -> Result<(), Fault> {
        if !self.reading.ignored_words.holds(word) {
            return Err(Fault::new("word", &word.to_string()));
        }
        self.count(word);
        Ok(())
    }

    /// Counts a word that is not acted on: codes by their number, others by their letter.
    fn count(&mut self, word: &Word) {
        let name = match word.letter {
            'G' | 'M' => word.to_string(),
            letter => letter.to_string(),
        };
        *self.passed_over.entry(name).or_default() += 1;
    }

    fn set_zero(&mut self, said: &Said) -> Result<(), Fault> {
        if !self.beside.is_on() {
            return Err(Fault::new("compensation", "G92 with the wire beside the path"));
        }
        for (letter, word) in &said.lengths {
            let value = self.length(word)?;
            match letter {
                'X' => self.zero.x = self.at.x - value,
                'Y' => self.zero.y = self.at.y - value,
                _ => return Err(Fault::new("word", &format!("{word}: with G92"))),
            }
        }
        Ok(())
    }

    fn motion(&mut self, said: &Said, characters: usize, out: &mut Vec<Motion>) -> Result<(), Fault> {
        let target = Exact {
            x: self.coordinate(said.lengths.get(&'X'), self.at.x, self.zero.x)?,
            y: self.coordinate(said.lengths.get(&'Y'), self.at.y, self.zero.y)?,
        };
        if target.x.abs().max(target.y.abs()) > LENGTH_MAX {
            return Err(Fault::new("number", "the wire would stand beyond 100 m"));
        }
        let shape = match self.modal.motion {
            None => {
                return Err(Fault::new("word", "a motion without G00, G01, G02 or G03"));
            }
            Some(Course::Straight) => {
                match said.lengths.values().find(|word| !matches!(word.letter, 'X' | 'Y')) {
                    Some(word) => return Err(Fault::new("word", &format!("{word}: without an arc"))),
                    None => Shape::Line,
                }
            }
            Some(Course::Round(turn)) => self.arc(turn, target, said)?,
        };
        let (from, to) = (Point::whole(self.at.rounded()), Point::whole(target.rounded()));
        self.at = target;
        if shape == Shape::Line && from == to {
            return Ok(());
        }
        let element = Element { from, to, shape };
        self.beside.take(Piece { element, characters }, out)
    }

    /// Where an axis goes: where it is without a word.
    fn coordinate(&self, word: Option<&Word>, at: i64, zero: i64) -> Result<i64, Fault> {
        match word {
            None => Ok(at),
            Some(word) if self.modal.incremental => Ok(at + self.length(word)?),
            Some(word) => Ok(zero + self.length(word)?),
        }
    }

    /// A length, in millionths of a µm.
    fn length(&self, word: &Word) -> Result<i64, Fault> {
        let number = word.number;
        let least_um = match (number.has_point, self.reading.unit_without_point) {
            (false, UnitWithoutPoint::Error) => {
                return Err(Fault::new("number", &format!("{word}: a length without a point")));
            }
            (false, UnitWithoutPoint::Least) => true,
            (false, UnitWithoutPoint::Whole) | (true, _) => false,
        };
        // 0.001 mm and 0.0001 inch; else a millionth of a mm or of an inch.
        let unit = match (least_um, self.modal.inch) {
            (true, false) => 1_000_000,
            (true, true) => 2_540_000,
            (false, false) => 1000 * 10_i128.pow(6 - number.decimals),
            (false, true) => 25_400 * 10_i128.pow(6 - number.decimals),
        };
        i64::try_from(i128::from(number.digits) * unit)
            .ok()
            .filter(|length| length.abs() <= LENGTH_MAX)
            .ok_or_else(|| Fault::new("number", &format!("{word}: beyond 100 m")))
    }
}

impl Exact {
    /// To the nearest µm, halves away from zero.
    fn rounded(self) -> [i64; 2] {
        let round = |v: i64| (v.abs() + MILLIONTHS / 2) / MILLIONTHS * v.signum();
        [round(self.x), round(self.y)]
    }

    /// In µm.
    #[expect(clippy::cast_precision_loss, reason = "below 2^53 up to 9 m, and then only the last digit")]
    fn point(self) -> Point {
        Point { x: self.x as f64, y: self.y as f64 }.times(1.0 / MILLIONTHS as f64)
    }
}

impl Fault {
    pub(super) fn new(name: &'static str, found: &str) -> Fault {
        Fault { name, found: found.to_owned() }
    }
}

const MILLIONTHS: i64 = 1_000_000;

/// A guess, as for 3B: 100 m is beyond any machine.
const LENGTH_MAX: i64 = 100_000_000 * MILLIONTHS;
