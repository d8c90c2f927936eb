//! What was commanded so far, as far as a program can ask for it: codes in force, last numbers, the end of the last block.
//!
//! Nothing is assumed: what the machine had in force before the program is known where the profile says so, and a
//! position is known from the first absolute end or G92 on. Groups are those of Fanuc's machining centres (B-63684EN,
//! 16.2); which groups a wire control counts is unverified.

use super::block::{Amount, Word};
use super::calls::valued;
use super::code::Template;
use super::findings::{At, Fault};
use super::making::is_axis;
use super::number::Number;
use super::options::{Options, decimals};
use super::variables::Variable;
use super::words::tenths;
use crate::formats::gcode::numbers::Unit;

/// The state of a control, as far as blocks tell it.
#[derive(Clone, Debug)]
pub(super) struct State<N> {
    pub unit: Unit,
    /// By group, tenths of the code in force.
    pub groups: [Option<u16>; GROUPS],
    /// By letter, the last number.
    letters: [Option<N>; 26],
    /// By letter, where the axis stands in the unit in force.
    ends: [Option<N>; 26],
}

const GROUPS: usize = 31;
/// Behind G66 and G67.
pub(super) const MODAL_CALLS: usize = 12;

/// Codes behind which the position is the machine's: references, its own coordinates, other origins.
const LOSES_POSITION: [u32; 10] = [160, 270, 280, 290, 300, 520, 530, 680, 921, 923];

/// What a block did beside its words.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Effect {
    None,
    /// M02 or M30 was computed.
    Ends,
}

impl<N: Number> State<N> {
    pub(super) fn new(options: &Options, program: Option<u32>) -> Self {
        let mut state =
            Self { unit: options.unit, groups: [None; GROUPS], letters: [None; 26], ends: [None; 26] };
        state.groups[6] = Some(match options.unit {
            Unit::Inch => 200,
            Unit::Millimetre => 210,
        });
        state.groups[MODAL_CALLS] = Some(670);
        for code in &options.in_force {
            state.set(u32::from(*code));
        }
        state.letters[usize::from(b'O' - b'A')] = program.map(|number| N::whole(i64::from(number)));
        state
    }

    /// Follows a block that was made.
    pub(super) fn follow(
        &mut self,
        options: &Options,
        template: &Template,
        skip: u8,
        number: Option<u64>,
        words: &[Word<N>],
    ) -> Result<Effect, String> {
        let mut effect = Effect::None;
        if let Some(number) = number.and_then(|n| i64::try_from(n).ok()) {
            self.letters[usize::from(b'N' - b'A')] = Some(N::whole(number));
        }
        let (mut presets, mut loses) = (false, false);
        for word in words {
            let code = match word.amount {
                Amount::Written { number, .. } => tenths(number),
                Amount::Computed(value) => {
                    let value = value.at_decimals(1).and_then(|v| u32::try_from(v).ok());
                    if let (b'G' | b'M', Some(value)) = (word.letter, value)
                        && let (b'G', 310 | 650 | 660 | 661 | 670) | (b'M', 970 | 980 | 990) =
                            (word.letter, value)
                    {
                        return Err(format!("{}{} is computed", word.letter as char, value / 10));
                    }
                    if word.letter == b'M' && matches!(value, Some(20 | 300)) {
                        effect = Effect::Ends;
                    }
                    value
                }
            };
            match word.letter {
                b'G' => {
                    let Some(code) = code else { continue };
                    presets |= code == 920;
                    loses |= LOSES_POSITION.contains(&code);
                    self.set(code);
                    if skip > 0
                        && let Some(group) = group(code)
                    {
                        // Whether the block ran is not known.
                        self.groups[group] = None;
                    }
                }
                letter => {
                    let value = match word.amount {
                        Amount::Written { number, .. } => Some(N::written(number.mantissa, number.decimals)),
                        Amount::Computed(value) => Some(value),
                    };
                    self.letters[usize::from(letter - b'A')] = if skip > 0 { None } else { value };
                }
            }
        }
        if (template.moves || presets) && !loses {
            for word in words.iter().filter(|word| is_axis(word.letter)) {
                self.go(options, skip, presets, word);
            }
        }
        Ok(effect)
    }

    /// An axis comes to its end.
    fn go(&mut self, options: &Options, skip: u8, presets: bool, word: &Word<N>) {
        let value = match word.amount {
            Amount::Computed(value) => Some(value),
            Amount::Written { number, .. } => {
                valued(number, decimals(word.letter, self.unit), options.pointless)
            }
        };
        let end = &mut self.ends[usize::from(word.letter - b'A')];
        // A cycle ends at a height of its own.
        let in_cycle = word.letter == b'Z' && self.groups[9].is_some_and(|code| code != 800);
        let lost = self.groups[17] == Some(160) || self.groups[16] == Some(680);
        *end = match (value, self.groups[3]) {
            _ if skip > 0 || in_cycle || lost => None,
            (Some(value), _) if presets => Some(value),
            (Some(value), Some(900)) => Some(value),
            (Some(value), Some(910)) => end.and_then(|end| end.plus(value).ok()),
            _ => None,
        };
    }

    /// A G code comes into force.
    fn set(&mut self, code: u32) {
        if LOSES_POSITION.contains(&code) || matches!(code, 540..=599) {
            self.ends = [None; 26];
        }
        let Some(group) = group(code) else { return };
        let unit = match code {
            200 => Unit::Inch,
            210 => Unit::Millimetre,
            _ => self.unit,
        };
        if unit != self.unit {
            let inch = N::written(254, 1);
            for (at, end) in self.ends.iter_mut().enumerate() {
                let letter = b'A' + at as u8;
                if matches!(letter, b'A'..=b'C') {
                    continue;
                }
                *end = end.and_then(|end| {
                    let other = if unit == Unit::Inch { end.over(inch) } else { end.times(inch) };
                    other.ok()
                });
            }
            self.unit = unit;
        }
        self.groups[group] = Some(code as u16);
    }

    /// The value of a system variable.
    pub(super) fn read(
        &self,
        options: &Options,
        number: i64,
        variable: Variable,
        at: At,
    ) -> Result<Option<N>, Fault> {
        let unknown = |what: String, help: String| Err(Fault::new("machine-variable", at, what, help));
        match variable {
            Variable::Group(group) => match self.groups[usize::from(group)] {
                Some(code) if code % 10 == 0 => Ok(Some(N::whole(i64::from(code / 10)))),
                Some(code) => Ok(Some(N::written(i64::from(code), 1))),
                None => unknown(
                    format!(
                        "#{number}: no G code of group {group} was commanded so far; what the machine had in force is not known"
                    ),
                    "command one in front, or say in the profile what is in force".to_owned(),
                ),
            },
            Variable::Letter(letter) => match self.letters[usize::from(letter - b'A')] {
                Some(value) => Ok(Some(value)),
                None => unknown(
                    format!(
                        "#{number}: no {} was commanded so far; what the machine had is not known",
                        letter as char
                    ),
                    format!("command {} in front", letter as char),
                ),
            },
            Variable::Position(axis) => {
                let Some(letter) = options.axes.get(usize::from(axis)).copied() else {
                    return unknown(
                        format!("#{number}: the profile names no axis {}", axis + 1),
                        "say in the profile which axes the machine has".to_owned(),
                    );
                };
                match letter.checked_sub(b'A').and_then(|at| self.ends.get(usize::from(at))) {
                    Some(Some(value)) => Ok(Some(*value)),
                    _ => unknown(
                        format!("#{number}: where {} stands is not known here", letter as char),
                        format!("G92, or G90 with {} in front, makes it known", letter as char),
                    ),
                }
            }
            Variable::Date | Variable::Time => match options.date_time {
                Some((date, time)) => {
                    let value = if variable == Variable::Date { date } else { time };
                    Ok(Some(N::whole(i64::from(value))))
                }
                None => unknown(
                    format!("#{number} is the date or the time: the program would be another one every day"),
                    "give a fixed one".to_owned(),
                ),
            },
            other => Err(super::references::not_readable(number, other, at)),
        }
    }
}

/// The group of a code in tenths.
fn group(code: u32) -> Option<usize> {
    Some(match code {
        0 | 10 | 20 | 30 | 330 => 1,
        170 | 180 | 190 => 2,
        900 | 910 => 3,
        220 | 230 => 4,
        930 | 940 | 950 => 5,
        200 | 210 => 6,
        400 | 410 | 420 => 7,
        430 | 440 | 490 => 8,
        730 | 740 | 760 => 9,
        800..=890 if code.is_multiple_of(10) => 9,
        980 | 990 => 10,
        500 | 510 => 11,
        960 | 970 => 13,
        540..=599 => 14,
        610 | 620 | 630 | 640 => 15,
        680 | 690 => 16,
        150 | 160 => 17,
        _ => return None,
    })
}
