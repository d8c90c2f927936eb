//! A line as statements: assignments, branches, loops, and the words of one block.
//!
//! Statements run in the order they are written; the words of a line make one block, behind them all. What stands in no
//! rule is refused: a word that is passed over may be a motion.

use super::branches::{condition, control_word};
use super::code::{Kind, Op};
use super::expression::Parser;
use super::findings::{At, Fault};
use super::options::Skip;
use super::program::Label;
use super::reader::Reader;
use super::references::{Target, not_readable};
use super::variables::{self, Variable};
use super::words::Word;

/// What is known of a line while it is read.
#[derive(Debug, Default)]
pub(super) struct Statements {
    pub words: Vec<Word>,
    pub number: Option<u64>,
    pub skip: u8,
    /// Operations other than those that compute words: what a `/` in front cannot leave to the control.
    pub acts: bool,
    /// A branch or a loop stands in the line.
    pub branches: bool,
    /// The first operation of the line.
    pub first: u32,
    /// Jumps over the rest of the line.
    pub over: Vec<u32>,
}

impl Reader<'_> {
    /// Reads the statements of the line that was cut last.
    pub(super) fn statements(&mut self, parser: &mut Parser<'_>) -> Result<Statements, Fault> {
        let mut read = Statements { first: parser.code.next(), ..Statements::default() };
        self.front(parser, &mut read)?;
        // A block keeps its `/` in the output unless the switches are known.
        let is_left_out = match self.options.skip {
            Skip::Kept => false,
            Skip::Switches(on) => read.skip > 0 && on & (1 << read.skip) != 0,
        };
        if is_left_out {
            read.over.push(parser.code.push(Op::Jump { to: 0 }, parser.line.at(0, 1)));
        }
        while parser.peek().is_some() {
            self.statement(parser, &mut read)?;
        }
        self.block(parser, &mut read)?;
        let next = parser.code.next();
        for jump in read.over.drain(..) {
            parser.code.aim(jump, next);
        }
        if read.skip > 0 && read.acts && self.options.skip == Skip::Kept {
            return Err(Fault::new(
                "block-skip",
                parser.line.at(0, 1),
                "`/` in front of macro statements: whether they run is decided by a switch of the control",
                "say in the profile which switches are on",
            ));
        }
        Ok(read)
    }

    /// `/` and N, in either order.
    fn front(&mut self, parser: &mut Parser<'_>, read: &mut Statements) -> Result<(), Fault> {
        loop {
            let from = parser.at;
            if read.skip == 0 && parser.takes(b'/') {
                read.skip = match parser.peek() {
                    Some(digit @ b'1'..=b'9') => {
                        parser.at += 1;
                        digit - b'0'
                    }
                    _ => 1,
                };
                if parser.peek() == Some(b'/') {
                    return Err(Fault::syntax(
                        parser.here(),
                        "a second `/`",
                        "one level of block skip is read",
                    ));
                }
            } else if read.number.is_none() && parser.takes(b'N') {
                if !matches!(parser.peek(), Some(b'0'..=b'9')) {
                    let message = "an N number that is not written out";
                    return Err(Fault::syntax(parser.since(from), message, "write N10"));
                }
                let (digits, decimals) = parser.digits()?;
                if decimals > 0 || parser.line.bytes[parser.at - 1] == b'.' {
                    return Err(Fault::syntax(parser.since(from), "an N number with a point", "write N10"));
                }
                read.number = Some(digits as u64);
                let pc = parser.code.next();
                self.labels.push(Label { number: digits as u64, pc, at: parser.since(from) });
            } else {
                return Ok(());
            }
        }
    }

    pub(super) fn statement(&mut self, parser: &mut Parser<'_>, read: &mut Statements) -> Result<(), Fault> {
        let from = parser.at;
        match parser.peek() {
            Some(b'#') => {
                self.in_front(parser, read, "an assignment")?;
                read.acts = true;
                self.assignment(parser)
            }
            // Haas: M99 with a condition in front (96-8000, conditional expressions).
            Some(b'[') => {
                self.in_front(parser, read, "a condition")?;
                read.acts = true;
                let jump = condition(parser, "of M99")?;
                if !(parser.line.bytes[parser.at..].starts_with(b"M99")) {
                    let message = "a condition in front of something that is not M99";
                    return Err(Fault::syntax(parser.since(from), message, "write IF[…]GOTO or IF[…]THEN"));
                }
                read.over.push(jump);
                self.word(parser, read)
            }
            Some(b'A'..=b'Z') => match control_word(&parser.line.bytes[parser.at..]) {
                Some(word) => {
                    self.in_front(parser, read, word)?;
                    read.acts = true;
                    parser.at += word.len();
                    self.control(word, from, parser, read)
                }
                None if read.branches => Err(Fault::syntax(
                    parser.here(),
                    "words of a block behind a branch or a loop",
                    "put them on a line of their own",
                )),
                None => self.word(parser, read),
            },
            Some(b',') => Err(Fault::syntax(
                parser.here(),
                "`,`: words of corners (,R ,C) are not expanded",
                "write the arc or the chamfer as a block",
            )),
            Some(b'/') => Err(Fault::syntax(
                parser.here(),
                "`/` within a block",
                "it stands in front of a block; a quotient stands in brackets",
            )),
            _ => Err(Fault::syntax(
                parser.here(),
                format!("`{}` begins no statement", parser.next_text()),
                "an assignment, a control word or a word of a block may stand here; calculations stand in brackets",
            )),
        }
    }

    /// Macro statements stand in front of the words of their line: which of both runs first is not certain otherwise.
    fn in_front(&self, parser: &Parser<'_>, read: &Statements, what: &str) -> Result<(), Fault> {
        if read.words.is_empty() {
            return Ok(());
        }
        let message = format!("{what} behind the words of a block");
        Err(Fault::syntax(parser.here(), message, "put it on a line of its own"))
    }

    fn assignment(&mut self, parser: &mut Parser<'_>) -> Result<(), Fault> {
        let from = parser.at;
        let target = parser.place_of_variable()?;
        if !parser.takes(b'=') {
            let message = format!("`{}` alone does nothing", parser.text(from));
            return Err(Fault::syntax(parser.since(from), message, "write #1=… to set it, X#1 to use it"));
        }
        let first = parser.code.next();
        let value_at = parser.at;
        let term = parser.condition()?;
        parser.number(term, parser.since(value_at))?;
        let at = parser.since(from);
        match target {
            Target::Cell(0) => {
                Err(Fault::syntax(at, "#0 is always undefined and cannot be set", "use another"))
            }
            Target::Cell(cell) => {
                // The last operation of a calculation writes where it belongs to at once.
                let computes = parser.code.next() > first;
                let last = parser.code.ops.last_mut().filter(|_| computes);
                match last.and_then(result_of) {
                    Some(result) if *result == term.cell => *result = cell,
                    _ => {
                        parser.code.push(Op::Copy { to: cell, from: term.cell }, at);
                    }
                }
                Ok(())
            }
            Target::Indirect(index) => {
                parser.code.push(Op::Store { index, from: term.cell }, at);
                Ok(())
            }
            Target::Number(number) => self.system(number, term.cell, at, parser),
        }
    }

    /// A variable that is not kept: an alarm, a stop, or refused.
    fn system(&mut self, number: i64, cell: u16, at: At, parser: &mut Parser<'_>) -> Result<(), Fault> {
        let variable = variables::variable(number);
        if !matches!(variable, Variable::Alarm | Variable::Message) {
            return Err(not_writable(number, variable, at));
        }
        let text = parser.line.remark_behind(parser.at);
        let code = &mut *parser.code;
        if variable == Variable::Alarm {
            code.texts.push(text.unwrap_or(At { end: at.end, start: at.end, ..at }));
            let text = code.texts.len() as u32 - 1;
            code.push(Op::Alarm { cell, text }, at);
        } else {
            let template = self.stop(parser, text);
            parser.code.push(Op::Stop { template }, at);
        }
        Ok(())
    }
}

/// Where an operation of a calculation writes to.
pub(super) fn result_of(op: &mut Op) -> Option<&mut u16> {
    match op {
        Op::Arithmetic { to, .. }
        | Op::Bits { to, .. }
        | Op::Compare { to, .. }
        | Op::Logic { to, .. }
        | Op::Negate { to, .. }
        | Op::Absolute { to, .. }
        | Op::Function { to, .. }
        | Op::Round { to, .. }
        | Op::ArcTangent { to, .. }
        | Op::Power { to, .. }
        | Op::Load { to, .. }
        | Op::System { to, .. } => Some(to),
        _ => None,
    }
}

pub(super) fn not_writable(number: i64, variable: Variable, at: At) -> Fault {
    match variable {
        Variable::None => not_readable(number, variable, at),
        Variable::Machine(what) => Fault::new(
            "machine-variable",
            at,
            format!("#{number} is {what}: a program without macros cannot set it"),
            "set it at the machine and take this statement out",
        ),
        Variable::Alarm | Variable::Message => Fault::syntax(
            at,
            format!("#{number} is written by its number only"),
            format!("write #{number}=1(TEXT)"),
        ),
        _ => Fault::new(
            "read-only",
            at,
            format!("#{number} is read only"),
            "it follows from what was commanded",
        ),
    }
}

/// How a call is spelled, for messages.
pub(super) fn name_of_call(kind: Kind) -> &'static str {
    match kind {
        Kind::Macro => "G65",
        Kind::Modal => "G66",
        Kind::Subprogram => "M98",
        Kind::Local => "M97",
    }
}
