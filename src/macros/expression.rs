//! Expressions: what is computed, as operations over cells.
//!
//! ```text
//! condition := sum [ (EQ|NE|GT|GE|LT|LE) sum ]
//! sum       := product { (+|-|OR|XOR) product }
//! product   := factor { (*|/|MOD|AND) factor }
//! factor    := [+|-] ( number | #variable | [condition] | FUNCTION[…] )
//! ```
//!
//! The order of operations is Fanuc's: functions, then multiplication with AND, then addition with OR and XOR
//! (B-63684EN, 16.3). AND, OR and XOR of two conditions join them, of two numbers they work bit by bit.

use super::code::{Code, Comparison, Op, Sign};
use super::findings::{At, Fault};
use super::line::Line;
use super::number::Bits;
use super::options::{Control, Options};
use super::variables::RESULTS;

/// Reads one line, writes operations.
pub(super) struct Parser<'a> {
    pub line: &'a Line,
    pub at: usize,
    pub code: &'a mut Code,
    pub options: &'a Options,
    /// How many cells for results are taken in this line.
    pub results: u16,
    /// The letter whose number is read; 0 outside of words.
    pub letter: u8,
    depth: u8,
}

/// Something computed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Term {
    pub cell: u16,
    pub is_condition: bool,
}

/// How deep brackets may be. Fanuc holds five levels (alarm 118); nothing here depends on so few.
const DEPTH_MAX: u8 = 64;

impl<'a> Parser<'a> {
    pub(super) fn new(line: &'a Line, code: &'a mut Code, options: &'a Options) -> Self {
        Self { line, at: 0, code, options, results: 0, letter: 0, depth: 0 }
    }

    pub(super) fn peek(&self) -> Option<u8> {
        self.line.bytes.get(self.at).copied()
    }

    pub(super) fn takes(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    /// Passes over a word of the language, if it is there.
    pub(super) fn takes_word(&mut self, word: &str) -> bool {
        let found = self.line.bytes[self.at..].starts_with(word.as_bytes());
        self.at += if found { word.len() } else { 0 };
        found
    }

    /// The place from a byte of the line up to where it is read.
    pub(super) fn since(&self, from: usize) -> At {
        self.line.at(from, self.at)
    }

    pub(super) fn here(&self) -> At {
        self.line.at(self.at, self.at + 1)
    }

    /// The text from a byte of the line up to where it is read.
    pub(super) fn text(&self, from: usize) -> String {
        let end = self.at.min(self.line.bytes.len());
        String::from_utf8_lossy(&self.line.bytes[from.min(end)..end]).into_owned()
    }

    /// How the text from here on begins, for messages.
    pub(super) fn next_text(&self) -> String {
        let rest = &self.line.bytes[self.at.min(self.line.bytes.len())..];
        let same = |b: &&u8| b.is_ascii_alphabetic() == rest[0].is_ascii_alphabetic();
        let length = rest.iter().take_while(same).count().min(12);
        String::from_utf8_lossy(&rest[..length]).into_owned()
    }

    pub(super) fn expects(&mut self, byte: u8, where_: &str) -> Result<(), Fault> {
        if self.takes(byte) {
            return Ok(());
        }
        let wanted = byte as char;
        let message = if self.peek().is_none() {
            format!("the line ends where `{wanted}` is needed {where_}")
        } else {
            format!("`{}` where `{wanted}` is needed {where_}", self.next_text())
        };
        Err(Fault::syntax(self.here(), message, "put the expression in square brackets"))
    }

    /// A cell for a result.
    pub(super) fn result(&mut self, at: At) -> Result<u16, Fault> {
        let cell = RESULTS.start + self.results;
        if cell >= RESULTS.end {
            return Err(Fault::syntax(
                at,
                "the line computes too much at once",
                "split it into several lines",
            ));
        }
        self.results += 1;
        Ok(cell)
    }

    /// `[…]` that is a number.
    pub(super) fn bracket(&mut self, where_: &str) -> Result<Term, Fault> {
        let from = self.at;
        self.expects(b'[', where_)?;
        let term = self.condition()?;
        self.expects(b']', "to close the bracket")?;
        self.number(term, self.since(from))?;
        Ok(term)
    }

    /// A condition or a number.
    pub(super) fn condition(&mut self) -> Result<Term, Fault> {
        let from = self.at;
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            let message = format!("brackets are nested more than {DEPTH_MAX} deep");
            return Err(Fault::syntax(self.here(), message, "use a variable for a part of it"));
        }
        let left = self.sum()?;
        let term = match self.comparison() {
            None => left,
            Some(comparison) => {
                self.number(left, self.since(from))?;
                let right_from = self.at;
                let right = self.sum()?;
                self.number(right, self.since(right_from))?;
                let at = self.since(from);
                let to = self.result(at)?;
                self.code.push(Op::Compare { comparison, to, a: left.cell, b: right.cell }, at);
                let again = self.at;
                if self.comparison().is_some() {
                    return Err(Fault::syntax(
                        self.since(again),
                        "a second comparison without brackets",
                        "put each condition in brackets: [[#1 GT 0] AND [#2 GT 0]]",
                    ));
                }
                Term { cell: to, is_condition: true }
            }
        };
        self.depth -= 1;
        Ok(term)
    }

    fn comparison(&mut self) -> Option<Comparison> {
        use Comparison::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
        [Equal, NotEqual, Greater, GreaterOrEqual, Less, LessOrEqual]
            .into_iter()
            .find(|comparison| self.takes_word(comparison.name()))
    }

    fn sum(&mut self) -> Result<Term, Fault> {
        let from = self.at;
        let mut left = self.product()?;
        loop {
            if self.takes(b'+') {
                left = self.arithmetic(Sign::Add, left, from, Self::product)?;
            } else if self.takes(b'-') {
                left = self.arithmetic(Sign::Subtract, left, from, Self::product)?;
            } else if self.takes_word("OR") {
                left = self.bits(Bits::Or, left, from, Self::product)?;
            } else if self.takes_word("XOR") {
                left = self.bits(Bits::Xor, left, from, Self::product)?;
            } else {
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<Term, Fault> {
        let from = self.at;
        let mut left = self.factor()?;
        loop {
            if self.takes(b'*') {
                left = self.arithmetic(Sign::Multiply, left, from, Self::factor)?;
            } else if self.takes(b'/') {
                left = self.arithmetic(Sign::Divide, left, from, Self::factor)?;
            } else if self.takes_word("MOD") {
                left = self.arithmetic(Sign::Modulo, left, from, Self::factor)?;
            } else if self.takes_word("AND") {
                left = self.bits(Bits::And, left, from, Self::factor)?;
            } else {
                return Ok(left);
            }
        }
    }

    fn arithmetic(
        &mut self,
        sign: Sign,
        left: Term,
        from: usize,
        operand: fn(&mut Self) -> Result<Term, Fault>,
    ) -> Result<Term, Fault> {
        self.number(left, self.since(from))?;
        let right_from = self.at;
        let right = operand(self)?;
        self.number(right, self.since(right_from))?;
        self.push(from, |to| Op::Arithmetic { sign, to, a: left.cell, b: right.cell })
    }

    fn bits(
        &mut self,
        bits: Bits,
        left: Term,
        from: usize,
        operand: fn(&mut Self) -> Result<Term, Fault>,
    ) -> Result<Term, Fault> {
        let right = operand(self)?;
        if left.is_condition != right.is_condition {
            return Err(Fault::syntax(
                self.since(from),
                "a condition and a number cannot be joined",
                "put each condition in brackets: [[#1 GT 0] AND [#2 GT 0]]",
            ));
        }
        if left.is_condition {
            let term = self.push(from, |to| Op::Logic { bits, to, a: left.cell, b: right.cell })?;
            return Ok(Term { is_condition: true, ..term });
        }
        self.push(from, |to| Op::Bits { bits, to, a: left.cell, b: right.cell })
    }

    /// An operation with a result.
    pub(super) fn push(&mut self, from: usize, op: impl FnOnce(u16) -> Op) -> Result<Term, Fault> {
        let at = self.since(from);
        let to = self.result(at)?;
        self.code.push(op(to), at);
        Ok(Term { cell: to, is_condition: false })
    }

    /// Refuses a condition where a number is needed, but for controls to which it is one.
    pub(super) fn number(&self, term: Term, at: At) -> Result<(), Fault> {
        if !term.is_condition || self.options.control == Control::Haas {
            return Ok(());
        }
        Err(Fault::syntax(
            at,
            "a condition is no number here",
            "IF[…]THEN sets a variable by a condition; Haas controls, to which it is 1 or 0, are chosen in the profile",
        ))
    }

    fn factor(&mut self) -> Result<Term, Fault> {
        let from = self.at;
        if self.takes(b'-') {
            if self.peek().is_some_and(is_of_number) {
                let (digits, decimals) = self.digits()?;
                let cell = self.code.constant(-digits, decimals, self.since(from))?;
                return Ok(Term { cell, is_condition: false });
            }
            let term = self.sign()?;
            self.number(term, self.since(from))?;
            return self.push(from, |to| Op::Negate { to, from: term.cell });
        }
        if self.takes(b'+') {
            return self.sign();
        }
        match self.peek() {
            Some(byte) if is_of_number(byte) => {
                let (digits, decimals) = self.digits()?;
                let cell = self.code.constant(digits, decimals, self.since(from))?;
                Ok(Term { cell, is_condition: false })
            }
            Some(b'#') => Ok(Term { cell: self.variable()?, is_condition: false }),
            Some(b'[') => {
                self.at += 1;
                let term = self.condition()?;
                self.expects(b']', "to close the bracket")?;
                Ok(term)
            }
            Some(b'A'..=b'Z') => self.function(),
            Some(_) => Err(self.no_number(&format!("`{}` where a number is needed", self.next_text()))),
            None => Err(self.no_number("the line ends where a number is needed")),
        }
    }

    /// What stands behind a sign: not another one.
    fn sign(&mut self) -> Result<Term, Fault> {
        match self.peek() {
            Some(b'+' | b'-') => Err(self.no_number("two signs behind one another")),
            _ => self.factor(),
        }
    }

    fn no_number(&self, message: &str) -> Fault {
        Fault::syntax(
            self.here(),
            message,
            "a number, a variable (#1, #[#1+1], #<name>), brackets or a function may stand here",
        )
    }

    /// A number as it is written, without sign: digits, and how many stand behind the point.
    pub(super) fn digits(&mut self) -> Result<(i64, u8), Fault> {
        let from = self.at;
        let (mut digits, mut decimals, mut point, mut any) = (0i64, 0u8, false, false);
        let mut too_long = false;
        while let Some(byte) = self.peek() {
            match byte {
                b'0'..=b'9' => {
                    any = true;
                    match digits.checked_mul(10).and_then(|d| d.checked_add(i64::from(byte - b'0'))) {
                        Some(more) if more < 1_000_000_000_000_000_000 => digits = more,
                        _ => too_long = true,
                    }
                    decimals = decimals.saturating_add(u8::from(point));
                }
                b'.' if !point => point = true,
                b'.' => {
                    let message = format!("`{}.`: a number with two points", self.text(from));
                    return Err(Fault::syntax(self.since(from), message, "leave one out"));
                }
                _ => break,
            }
            self.at += 1;
        }
        if let Some(gap) = self.line.gap(from, self.at) {
            return Err(Fault::syntax(
                self.line.at(gap, gap + 1),
                "a blank within a number: controls pass over it and read one number",
                "write the number without the blank",
            ));
        }
        if !any {
            let message = format!("`{}`: a number without a digit", self.text(from));
            return Err(Fault::syntax(self.since(from), message, "write the digits"));
        }
        if too_long || decimals > 18 {
            return Err(Fault::syntax(
                self.since(from),
                "a number of more than 18 digits",
                "leave out those that mean nothing",
            ));
        }
        Ok((digits, decimals))
    }
}

fn is_of_number(byte: u8) -> bool {
    matches!(byte, b'0'..=b'9' | b'.')
}
