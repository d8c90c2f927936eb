//! A line as statements: assignments, branches, loops, and the words of one block.
//!
//! Statements run in the order they are written; the words of a line make one block, behind them all. What stands in no
//! rule is refused: a word that is passed over may be a motion.

use super::code::{Kind, Loop, Op};
use super::expression::{Parser, Target, not_readable};
use super::findings::{At, Fault};
use super::options::{Control, Skip};
use super::program::{Goto, Label, OpenLoop, Reader};
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
    /// The first operation of the line.
    pub first: u32,
    /// Jumps over the rest of the line.
    over: Vec<u32>,
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

    fn statement(&mut self, parser: &mut Parser<'_>, read: &mut Statements) -> Result<(), Fault> {
        let from = parser.at;
        match parser.peek() {
            Some(b'#') => {
                read.acts = true;
                self.assignment(parser)
            }
            // Haas: M99 with a condition in front (96-8000, conditional expressions).
            Some(b'[') => {
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
                    read.acts = true;
                    parser.at += word.len();
                    self.control(word, from, parser, read)
                }
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

    fn control(
        &mut self,
        word: &'static str,
        from: usize,
        parser: &mut Parser<'_>,
        read: &mut Statements,
    ) -> Result<(), Fault> {
        match word {
            "IF" => self.branch(parser, read),
            "GOTO" => self.goto(parser, from),
            "WHILE" => {
                let start = parser.code.next();
                let (at, last) = bracketed(parser, "behind WHILE")?;
                if !parser.takes_word("DO") {
                    let message = "WHILE without DO";
                    return Err(Fault::syntax(parser.here(), message, "write WHILE[…]DO1"));
                }
                self.open_loop(parser, from, start, Some((at, last)))
            }
            "DO" => {
                let start = parser.code.next();
                self.open_loop(parser, from, start, None)
            }
            "END" => {
                let number = loop_number(parser, from, "END")?;
                let at = parser.since(from);
                let Some(open) = self.loops.last().copied().filter(|open| open.number == number) else {
                    let (message, help) = match self.loops.iter().find(|open| open.number == number) {
                        Some(_) => {
                            let inner = self.loops.last().map_or(0, |open| open.number);
                            let message = format!("END{number} within DO{inner}: loops may not overlap");
                            (message, "end the inner loop first")
                        }
                        None => (format!("END{number} without DO{number}"), "write WHILE[…]DO1 in front"),
                    };
                    return Err(Fault::new("loop-nesting", at, message, help));
                };
                self.loops.pop();
                let end = parser.code.push(Op::Again { to: open.condition, id: open.id }, at);
                if let Some(leave) = open.leave {
                    parser.code.aim(leave, end + 1);
                }
                parser.code.loops[usize::from(open.id)].end = end;
                Ok(())
            }
            "THEN" => Err(Fault::syntax(parser.since(from), "THEN without IF", "write IF[…]THEN#1=…")),
            other => Err(Fault::syntax(
                parser.since(from),
                format!("{other} is not of the language that is expanded"),
                match other {
                    "ELSE" | "ENDIF" => "write IF[…]GOTO n around what is left out",
                    "SETVN" => "write #<name> instead",
                    _ => "output to other devices is for a control to do; take it out",
                },
            )),
        }
    }

    fn branch(&mut self, parser: &mut Parser<'_>, read: &mut Statements) -> Result<(), Fault> {
        let jump = condition(parser, "behind IF")?;
        let from = parser.at;
        if parser.takes_word("GOTO") {
            self.goto(parser, from)?;
            let next = parser.code.next();
            parser.code.aim(jump, next);
            return Ok(());
        }
        if !parser.takes_word("THEN") {
            let message = "IF[…] without GOTO or THEN";
            return Err(Fault::syntax(parser.here(), message, "write IF[…]GOTO 10 or IF[…]THEN#1=…"));
        }
        if parser.peek().is_none() {
            return Err(Fault::syntax(parser.here(), "THEN with nothing behind it", "write IF[…]THEN#1=…"));
        }
        let then = parser.at;
        let words = read.words.len();
        while parser.peek().is_some() {
            let rest = &parser.line.bytes[parser.at..];
            if let Some(word) = control_word(rest)
                && word != "GOTO"
            {
                let message = format!("{word} behind THEN");
                return Err(Fault::syntax(parser.here(), message, "write IF[…]GOTO around it"));
            }
            self.statement(parser, read)?;
        }
        if read.words.len() > words && self.options.control == Control::Fanuc {
            return Err(Fault::syntax(
                parser.line.at(then, then + 1),
                "words of a block behind THEN: one macro statement stands there",
                "write IF[…]GOTO around the block",
            ));
        }
        read.over.push(jump);
        Ok(())
    }

    fn goto(&mut self, parser: &mut Parser<'_>, from: usize) -> Result<(), Fault> {
        let number_at = parser.at;
        match parser.peek() {
            Some(b'0'..=b'9') => {
                let (digits, decimals) = parser.digits()?;
                let at = parser.since(from);
                if decimals > 0 {
                    return Err(Fault::syntax(
                        parser.since(number_at),
                        "an N number with a point",
                        "write GOTO 10",
                    ));
                }
                let pc = parser.code.push(Op::Jump { to: 0 }, at);
                self.gotos.push(Goto { pc, number: digits as u64, at });
                Ok(())
            }
            Some(b'#' | b'[') => {
                let cell = if parser.peek() == Some(b'#') {
                    parser.variable()?
                } else {
                    parser.bracket("behind GOTO")?.cell
                };
                parser.code.computed_jumps = true;
                let at = parser.since(from);
                parser.code.push(Op::Goto { cell }, at);
                Ok(())
            }
            _ => Err(Fault::syntax(parser.here(), "GOTO without a number", "write GOTO 10")),
        }
    }

    fn open_loop(
        &mut self,
        parser: &mut Parser<'_>,
        from: usize,
        start: u32,
        condition: Option<(At, u16)>,
    ) -> Result<(), Fault> {
        let number = loop_number(parser, from, "DO")?;
        let at = parser.since(from);
        if let Some(outer) = self.loops.iter().find(|open| open.number == number) {
            let line = self.line_of(outer.at);
            return Err(Fault::new(
                "loop-nesting",
                at,
                format!("DO{number} within the DO{number} of line {line}"),
                "loops in one another have the numbers 1, 2 and 3",
            ));
        }
        let Ok(id) = u16::try_from(parser.code.loops.len()) else {
            return Err(Fault::syntax(at, "the program has more than 65,535 loops", "split it"));
        };
        let leave = condition.map(|(at, cell)| {
            let code = &mut *parser.code;
            // A comparison alone is one step with the jump.
            match code.ops.last().copied().filter(|_| code.next() > start) {
                Some(Op::Compare { comparison, to, a, b }) if to == cell => {
                    code.ops.pop();
                    code.marks.pop();
                    code.push(Op::LeaveUnlessCompare { comparison, id, a, b, to: 0 }, at)
                }
                _ => code.push(Op::Leave { cell, id, to: 0 }, at),
            }
        });
        let body = parser.code.next();
        let condition_at = condition.map_or(at, |(at, _)| at);
        parser.code.loops.push(Loop { number, condition: start, body, end: 0, at: condition_at });
        self.loops.push(OpenLoop { number, id, condition: start, leave, at });
        Ok(())
    }
}

/// A condition in brackets, and the jump that is taken where it does not hold.
fn condition(parser: &mut Parser<'_>, where_: &str) -> Result<u32, Fault> {
    let start = parser.code.next();
    let (at, cell) = bracketed(parser, where_)?;
    let code = &mut *parser.code;
    Ok(match code.ops.last().copied().filter(|_| code.next() > start) {
        Some(Op::Compare { comparison, to, a, b }) if to == cell => {
            code.ops.pop();
            code.marks.pop();
            code.push(Op::JumpUnlessCompare { comparison, a, b, to: 0 }, at)
        }
        _ => code.push(Op::JumpUnless { cell, to: 0 }, at),
    })
}

/// `[condition]`: its place and its cell.
fn bracketed(parser: &mut Parser<'_>, where_: &str) -> Result<(At, u16), Fault> {
    let from = parser.at;
    parser.expects(b'[', where_)?;
    let term = parser.condition()?;
    parser.expects(b']', "to close the condition")?;
    let at = parser.since(from);
    if !term.is_condition && parser.options.control == Control::Fanuc {
        return Err(Fault::syntax(
            at,
            "a number where a condition is needed",
            "compare it: [#1 NE 0]; Haas controls, to which a number is a condition, are chosen in the profile",
        ));
    }
    Ok((at, term.cell))
}

fn loop_number(parser: &mut Parser<'_>, from: usize, word: &str) -> Result<u8, Fault> {
    let digits = match parser.peek() {
        Some(b'0'..=b'9') => parser.digits()?.0,
        _ => 0,
    };
    match digits {
        1..=3 => Ok(digits as u8),
        _ => Err(Fault::new(
            "loop-nesting",
            parser.since(from),
            format!("{word} with a number that is not 1, 2 or 3"),
            "loops have the numbers 1, 2 and 3; behind their END they may be used again",
        )),
    }
}

/// The word of the language a text begins with: two letters or more, so none of a block.
fn control_word(text: &[u8]) -> Option<&'static str> {
    CONTROL_WORDS.into_iter().find(|word| text.starts_with(word.as_bytes()))
}

const CONTROL_WORDS: [&str; 13] = [
    "IF", "THEN", "GOTO", "WHILE", "DO", "ENDIF", "END", "ELSE", "SETVN", "POPEN", "PCLOS", "BPRNT", "DPRNT",
];

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
