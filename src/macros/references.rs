//! How a variable is named: `#1`, `#[#1+1]`, `#<name>`.

use super::code::Op;
use super::expression::Parser;
use super::findings::{At, Fault};
use super::variables::{self, Variable};

impl Parser<'_> {
    /// A variable that is read: its cell.
    pub(super) fn variable(&mut self) -> Result<u16, Fault> {
        let from = self.at;
        match self.place_of_variable()? {
            Target::Cell(cell) => Ok(cell),
            Target::Indirect(index) => {
                self.code.reads_state = true;
                Ok(self.push(from, |to| Op::Load { to, index })?.cell)
            }
            Target::Number(number) => match variables::variable(number) {
                Variable::Group(_)
                | Variable::Letter(_)
                | Variable::Position(_)
                | Variable::Date
                | Variable::Time => {
                    self.code.reads_state = true;
                    Ok(self.push(from, |to| Op::System { to, number: number as u16 })?.cell)
                }
                other => Err(not_readable(number, other, self.since(from))),
            },
        }
    }

    /// `#1`, `#[…]` or `#<name>`, read or written.
    pub(super) fn place_of_variable(&mut self) -> Result<Target, Fault> {
        let from = self.at;
        self.at += 1;
        match self.peek() {
            Some(b'[') => {
                let letter = std::mem::replace(&mut self.letter, 0);
                let index = self.bracket("behind #")?.cell;
                self.letter = letter;
                Ok(Target::Indirect(index))
            }
            Some(b'<') => {
                self.at += 1;
                let length = self.line.bytes[self.at..].iter().take_while(|b| is_of_name(**b)).count();
                let name = self.text_of(length);
                self.at += length;
                if length == 0 || !self.takes(b'>') {
                    return Err(Fault::syntax(
                        self.since(from),
                        "a name is letters, digits and underscores between < and >",
                        "write #<depth>",
                    ));
                }
                Ok(Target::Cell(self.code.named(&name, self.since(from))?))
            }
            Some(b'0'..=b'9') => {
                let (digits, decimals) = self.digits()?;
                if decimals > 0 || self.line.bytes[self.at - 1] == b'.' {
                    return Err(Fault::syntax(
                        self.since(from),
                        "the number of a variable has no point",
                        "leave the point out",
                    ));
                }
                Ok(match variables::variable(digits) {
                    Variable::Null => Target::Cell(0),
                    Variable::Kept(cell) => Target::Cell(cell),
                    _ => Target::Number(digits),
                })
            }
            Some(b'#') => Err(Fault::syntax(
                self.since(from),
                "`##`: the number of a variable that stands in a variable needs brackets",
                "write #[#1]",
            )),
            _ => Err(Fault::syntax(
                self.since(from),
                "`#` without the number of a variable",
                "write #1, #[#1+1] or #<name>",
            )),
        }
    }

    fn text_of(&self, length: usize) -> String {
        String::from_utf8_lossy(&self.line.bytes[self.at..self.at + length]).into_owned()
    }
}

/// A variable as an assignment or an expression names it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Target {
    Cell(u16),
    /// Its number stands in a cell.
    Indirect(u16),
    /// One that is not kept in a cell.
    Number(i64),
}

/// Why a variable cannot be read.
pub(super) fn not_readable(number: i64, variable: Variable, at: At) -> Fault {
    match variable {
        Variable::Machine(what) => Fault::new(
            "machine-variable",
            at,
            format!("#{number} is {what}: only the machine knows it"),
            "set a variable to its value by hand, or run this program in the control",
        ),
        Variable::Alarm | Variable::Message => {
            Fault::syntax(at, format!("#{number} is written, not read"), "write #3000=1(TEXT)")
        }
        _ => Fault::new(
            "no-variable",
            at,
            format!("there is no variable #{number}"),
            "there are #0 to #33, #100 to #199, #500 to #999, and system variables from #1000",
        ),
    }
}

fn is_of_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}
