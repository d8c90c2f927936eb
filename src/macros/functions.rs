//! Functions: SIN[…] to BCD[…], by their names or the first two letters of them.

use super::code::Op;
use super::expression::{Parser, Term};
use super::findings::Fault;
use super::number::{Function, Rounding};

impl Parser<'_> {
    pub(super) fn function(&mut self) -> Result<Term, Fault> {
        let from = self.at;
        let length = self.line.bytes[from..].iter().take_while(|b| b.is_ascii_alphabetic()).count();
        let name = String::from_utf8_lossy(&self.line.bytes[from..from + length]).into_owned();
        // Fanuc reads the first two letters alone as well (B-63684EN, 16.3).
        let known = FUNCTIONS.iter().find(|(n, _)| *n == name || name.len() == 2 && n.starts_with(&name));
        let Some((name, named)) = known else {
            return Err(Fault::syntax(
                self.line.at(from, from + length),
                format!("`{name}` is no function"),
                "SIN COS TAN ASIN ACOS ATAN SQRT ABS ROUND FIX FUP LN EXP POW BIN BCD are",
            ));
        };
        self.at += length;
        self.expects(b'[', &format!("behind {name}"))?;
        let first = self.argument()?;
        let mut second = None;
        if self.takes(b',') {
            if !matches!(named, Named::ArcTangent | Named::Power) {
                let at = self.line.at(self.at - 1, self.at);
                return Err(Fault::syntax(at, format!("{name} takes one number"), "leave the second out"));
            }
            second = Some(self.argument()?);
        }
        self.expects(b']', &format!("to close {name}"))?;
        let bytes = &self.line.bytes;
        if *named == Named::ArcTangent && second.is_none() && bytes[self.at..].starts_with(b"/[") {
            self.at += 2;
            second = Some(self.argument()?);
            self.expects(b']', "to close ATAN[…]/[…]")?;
        }
        if *named == Named::Power && second.is_none() {
            return Err(Fault::syntax(self.since(from), "POW takes two numbers", "write POW[base,exponent]"));
        }
        let letter = self.letter;
        let to_op = |to: u16| match (named, second) {
            (Named::Power, Some(second)) => Op::Power { to, a: first, b: second },
            (_, Some(second)) => Op::ArcTangent { to, a: first, b: second },
            (Named::Plain(function), None) => Op::Function { function: *function, to, from: first },
            (Named::Absolute, None) => Op::Absolute { to, from: first },
            (Named::Round(rounding), None) => {
                let letter = if *rounding == Rounding::Nearest { letter } else { 0 };
                Op::Round { rounding: *rounding, letter, to, from: first }
            }
            (Named::ArcTangent | Named::Power, None) => {
                Op::Function { function: Function::ArcTangent, to, from: first }
            }
        };
        self.push(from, to_op)
    }

    fn argument(&mut self) -> Result<u16, Fault> {
        let from = self.at;
        let term = self.condition()?;
        self.number(term, self.since(from))?;
        Ok(term.cell)
    }
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Named {
    Plain(Function),
    Absolute,
    Round(Rounding),
    ArcTangent,
    Power,
}

/// Longer names before those they begin with.
const FUNCTIONS: [(&str, Named); 16] = [
    ("SIN", Named::Plain(Function::Sine)),
    ("COS", Named::Plain(Function::Cosine)),
    ("TAN", Named::Plain(Function::Tangent)),
    ("ASIN", Named::Plain(Function::ArcSine)),
    ("ACOS", Named::Plain(Function::ArcCosine)),
    ("ATAN", Named::ArcTangent),
    ("SQRT", Named::Plain(Function::Root)),
    ("ABS", Named::Absolute),
    ("ROUND", Named::Round(Rounding::Nearest)),
    ("FIX", Named::Round(Rounding::Down)),
    ("FUP", Named::Round(Rounding::Up)),
    ("LN", Named::Plain(Function::Logarithm)),
    ("EXP", Named::Plain(Function::Exponential)),
    ("POW", Named::Power),
    ("BIN", Named::Plain(Function::FromBcd)),
    ("BCD", Named::Plain(Function::ToBcd)),
];
