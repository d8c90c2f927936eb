//! The form a program is run in: operations over cells, one behind the other.
//!
//! An operation names the cells it reads and the one it writes, so an assignment of a sum is one step; where it goes to
//! is an index. A block is a template, a range of words whose numbers are written or stand in cells. Nothing is looked up
//! by name and nothing is allocated while it runs.

use super::findings::{At, Fault};
use super::number::{Bits, Function, Rounding};
use super::variables::{CONSTANTS, FRAME, LOCALS, NAMES};
use crate::formats::gcode::numbers::Number as Written;

/// One step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    /// `to = from`, null kept.
    Copy {
        to: u16,
        from: u16,
    },
    Arithmetic {
        sign: Sign,
        to: u16,
        a: u16,
        b: u16,
    },
    Bits {
        bits: Bits,
        to: u16,
        a: u16,
        b: u16,
    },
    /// 1 where it holds, else 0.
    Compare {
        comparison: Comparison,
        to: u16,
        a: u16,
        b: u16,
    },
    /// Of two conditions.
    Logic {
        bits: Bits,
        to: u16,
        a: u16,
        b: u16,
    },
    /// `to = -from`, null kept.
    Negate {
        to: u16,
        from: u16,
    },
    Absolute {
        to: u16,
        from: u16,
    },
    Function {
        function: Function,
        to: u16,
        from: u16,
    },
    /// To whole numbers, or as finely as the letter's word is written where there is one.
    Round {
        rounding: Rounding,
        letter: u8,
        to: u16,
        from: u16,
    },
    ArcTangent {
        to: u16,
        a: u16,
        b: u16,
    },
    Power {
        to: u16,
        a: u16,
        b: u16,
    },
    /// `to = #[index]`.
    Load {
        to: u16,
        index: u16,
    },
    /// `#[index] = from`.
    Store {
        index: u16,
        from: u16,
    },
    /// `to =` a variable that is not kept in a cell.
    System {
        to: u16,
        number: u16,
    },
    Jump {
        to: u32,
    },
    /// Goes on at `to` where the cell is 0 or null.
    JumpUnless {
        cell: u16,
        to: u32,
    },
    /// The same with the comparison in it.
    JumpUnlessCompare {
        comparison: Comparison,
        a: u16,
        b: u16,
        to: u32,
    },
    /// END: back to the condition.
    Again {
        to: u32,
        id: u16,
    },
    /// The condition of a loop: leaves it for `to`.
    Leave {
        cell: u16,
        id: u16,
        to: u32,
    },
    LeaveUnlessCompare {
        comparison: Comparison,
        id: u16,
        a: u16,
        b: u16,
        to: u32,
    },
    /// `GOTO` to a number that is computed.
    Goto {
        cell: u16,
    },
    /// A block is made.
    Block {
        template: u32,
    },
    Call {
        call: u32,
    },
    /// G66.
    SetModal {
        call: u32,
    },
    /// G67.
    CancelModal,
    /// M99.
    Return,
    /// M99 P.
    ReturnTo {
        cell: u16,
    },
    /// `#3000=n(text)`.
    Alarm {
        cell: u16,
        text: u32,
    },
    /// `#3006=n(text)`: M00 with the text.
    Stop {
        template: u32,
    },
    /// The text of a program ends.
    Fall,
}

const _: () = assert!(size_of::<Op>() <= 16);

/// `+ - * / MOD`.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Sign {
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
}

/// `EQ NE GT GE LT LE`.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Comparison {
    Equal,
    NotEqual,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
}

impl Comparison {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Equal => "EQ",
            Self::NotEqual => "NE",
            Self::Greater => "GT",
            Self::GreaterOrEqual => "GE",
            Self::Less => "LT",
            Self::LessOrEqual => "LE",
        }
    }
}

/// A block before its numbers are known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Template {
    /// The line it stands in.
    pub source: u32,
    /// Its words.
    pub first: u32,
    pub count: u16,
    /// At least one of them is written, so the block is never empty.
    pub sure: bool,
    /// Words with an axis letter move.
    pub moves: bool,
    /// M02 or M30 stands in it.
    pub ends: bool,
    /// A G or M word is computed.
    pub computed_code: bool,
    /// Remarks, and no words.
    pub is_remark: bool,
}

/// A word of a template.
#[derive(Clone, Copy, Debug)]
pub(super) struct TemplateWord {
    pub letter: u8,
    pub value: Value,
}

impl TemplateWord {
    /// Whether it is G20 or G21.
    pub(super) fn is_unit(self) -> bool {
        let Value::Written(number, _) = self.value else { return false };
        self.letter == b'G' && matches!(super::words::tenths(number), Some(200 | 210))
    }
}

/// The number of a word.
#[derive(Clone, Copy, Debug)]
pub(super) enum Value {
    /// As it is written, and where its digits with their sign stand.
    Written(Written, (u32, u32)),
    Cell(u16),
}

/// How a program calls another.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    /// G65: with variables of its own.
    Macro,
    /// G66, after every motion.
    Modal,
    /// M98.
    Subprogram,
    /// M97: an N number of the same program.
    Local,
}

/// A call.
#[derive(Clone, Debug)]
pub(super) struct Call {
    pub kind: Kind,
    pub program: Value,
    /// Where `program` is, when it is written and was found.
    pub entry: Option<u32>,
    pub count: Value,
    /// Whether the count is written behind L.
    pub has_count: bool,
    /// Its operation.
    pub pc: u32,
    /// Variables and what they are set to, with the letter.
    pub arguments: Vec<(u16, u8, Value)>,
    pub at: At,
}

/// A DO with its END.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loop {
    pub number: u8,
    /// First operation of the condition.
    pub condition: u32,
    /// First operation of what is repeated.
    pub body: u32,
    /// The operation of END.
    pub end: u32,
    /// The condition in the text; that of DO where there is none.
    pub at: At,
}

/// All operations of a program with those it calls.
#[derive(Clone, Debug, Default)]
pub(super) struct Code {
    pub ops: Vec<Op>,
    /// Where each operation comes from.
    pub marks: Vec<At>,
    pub constants: Vec<(i64, u8)>,
    pub templates: Vec<Template>,
    pub words: Vec<TemplateWord>,
    pub calls: Vec<Call>,
    pub loops: Vec<Loop>,
    pub texts: Vec<At>,
    pub local_names: Vec<String>,
    pub names: Vec<String>,
    /// Some variable is read whose value follows from what was commanded.
    pub reads_state: bool,
    /// Some GOTO, M99 P or M97 P is computed: every N number may be meant.
    pub computed_jumps: bool,
}

impl Code {
    pub(super) fn next(&self) -> u32 {
        self.ops.len() as u32
    }

    pub(super) fn push(&mut self, op: Op, at: At) -> u32 {
        self.ops.push(op);
        self.marks.push(at);
        self.next() - 1
    }

    /// Sets where a jump goes.
    pub(super) fn aim(&mut self, jump: u32, target: u32) {
        match &mut self.ops[jump as usize] {
            Op::Jump { to }
            | Op::JumpUnless { to, .. }
            | Op::JumpUnlessCompare { to, .. }
            | Op::Leave { to, .. }
            | Op::LeaveUnlessCompare { to, .. } => *to = target,
            other => unreachable!("{other:?} goes nowhere"),
        }
    }

    /// The cell of a number of the text.
    pub(super) fn constant(&mut self, digits: i64, decimals: u8, at: At) -> Result<u16, Fault> {
        // A program that computes much has few numbers; the last ones are the likeliest.
        let known = self.constants.iter().rev().take(64).position(|c| *c == (digits, decimals));
        let index = match known {
            Some(back) => self.constants.len() - 1 - back,
            None => {
                self.constants.push((digits, decimals));
                self.constants.len() - 1
            }
        };
        u16::try_from(usize::from(CONSTANTS) + index).map_err(|_| {
            Fault::syntax(
                at,
                "the program has more than 60,000 numbers in its expressions",
                "split it into programs",
            )
        })
    }

    /// The cell of a variable with a name.
    pub(super) fn named(&mut self, name: &str, at: At) -> Result<u16, Fault> {
        let (list, range) = if name.starts_with('_') {
            (&mut self.names, NAMES)
        } else {
            (&mut self.local_names, LOCALS.end..FRAME.end)
        };
        let index = match list.iter().position(|n| n == name) {
            Some(index) => index,
            None => {
                list.push(name.to_owned());
                list.len() - 1
            }
        };
        let cell = usize::from(range.start) + index;
        if cell >= usize::from(range.end) {
            let message = format!("the program has more than {} such names", range.len());
            return Err(Fault::syntax(at, message, "use numbered variables"));
        }
        Ok(cell as u16)
    }
}
