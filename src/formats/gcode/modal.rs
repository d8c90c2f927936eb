//! What stays in force from one block to the next: the modal groups of G words.

use super::dialect::{Code, Dialect};
use super::numbers::Unit;
use super::words::{Kind, Word};
use crate::motion::Side;

/// What is in force after a block.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Modal {
    /// How the wire moves; none before the first word that says so.
    pub travel: Option<Mode>,
    /// Whether X and Y are increments (G91).
    pub incremental: bool,
    /// The unit of lengths.
    pub unit: Unit,
    /// G41 left, G42 right, none after G40.
    pub offset: Option<Side>,
    /// G51 left, G52 right, none after G50.
    pub taper: Option<Side>,
    /// 54 to 59, where the program chose one.
    pub frame: Option<u8>,
}

/// How the wire moves.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Mode {
    /// G00.
    Rapid,
    /// G01.
    Line,
    /// G02.
    Clockwise,
    /// G03.
    CounterClockwise,
}

impl Modal {
    /// What is in force before the first block.
    #[must_use]
    pub fn at_start(dialect: &Dialect) -> Self {
        Self {
            travel: None,
            incremental: dialect.incremental_at_start,
            unit: dialect.unit_at_start,
            offset: None,
            taper: None,
            frame: None,
        }
    }

    /// Takes in the words of a block; where a `:` parts the motions of the two ends, as far as that.
    #[inline]
    pub fn take_in(&mut self, words: &[Word], dialect: &Dialect) {
        for word in words {
            if word.letter != b'G' {
                if word.kind == Kind::Colon && dialect.pairs {
                    break;
                }
                continue;
            }
            match dialect.g_code(word) {
                Code::Travel(mode) => self.travel = Some(mode),
                Code::Incremental(incremental) => self.incremental = incremental,
                Code::Unit(unit) => self.unit = unit,
                Code::Offset(side) => self.offset = side,
                Code::Taper(side) => self.taper = side,
                Code::Frame(frame) => self.frame = Some(frame),
                Code::Plane
                | Code::Dwell
                | Code::Position
                | Code::Pause
                | Code::OptionalStop
                | Code::End
                | Code::Call
                | Code::Return
                | Code::Kept
                | Code::Refused
                | Code::Macro
                | Code::Unknown => {}
            }
        }
    }
}
