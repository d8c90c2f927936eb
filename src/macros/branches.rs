//! Branches and loops: IF, GOTO, WHILE, DO, END.
//!
//! A comparison that is all of a condition is one step with the jump it decides. A loop is left at its condition and
//! turned at its END, so a GOTO may leave it anywhere and nothing has to be put back.

use super::code::{Loop, Op};
use super::expression::Parser;
use super::findings::{At, Fault};
use super::options::Control;
use super::reader::{Goto, OpenLoop, Reader};
use super::statement::Statements;

impl Reader<'_> {
    pub(super) fn control(
        &mut self,
        word: &'static str,
        from: usize,
        parser: &mut Parser<'_>,
        read: &mut Statements,
    ) -> Result<(), Fault> {
        read.branches = word != "IF";
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
            read.branches = true;
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
            if parser.peek().is_some() && read.words.len() == words {
                return Err(Fault::syntax(
                    parser.here(),
                    "a second statement behind THEN: whether it depends on the condition is not certain",
                    "put it on a line of its own",
                ));
            }
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
pub(super) fn condition(parser: &mut Parser<'_>, where_: &str) -> Result<u32, Fault> {
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
pub(super) fn control_word(text: &[u8]) -> Option<&'static str> {
    CONTROL_WORDS.into_iter().find(|word| text.starts_with(word.as_bytes()))
}

const CONTROL_WORDS: [&str; 13] = [
    "IF", "THEN", "GOTO", "WHILE", "DO", "ENDIF", "END", "ELSE", "SETVN", "POPEN", "PCLOS", "BPRNT", "DPRNT",
];
