//! What is said while a program runs: with the values that are there.

use super::code::{Comparison, Loop, Op};
use super::findings::{At, Fault, Finding, NEVER_RUNS};
use super::machine::Machine;
use super::number::Number;
use super::program::Program;
use super::variables::{self, CONSTANTS, RESULTS};
use crate::check::Severity;

impl<N: Number> Machine<N> {
    /// An undefined variable in a calculation: it counts as 0 (Fanuc B-63684EN, 16.1; Mitsubishi M700V, 13.5), and is
    /// hardly what was meant.
    #[cold]
    pub(super) fn note_null(&mut self, program: &Program, pc: usize, cell: u16) {
        if cell == 0 || self.was_noted(pc) {
            return;
        }
        let code = &program.code;
        let at = code.marks[pc];
        let name = variables::name_of(cell, &code.local_names, &code.names);
        let name = name.unwrap_or_else(|| program.text_at(at));
        let message = format!("`{name}` is undefined and counts as 0 in this calculation");
        let error = program.shown(Fault::new(
            "undefined",
            at,
            message,
            "set it before, or #0 where 0 is meant: write 0",
        ));
        self.findings.push(Finding { severity: Severity::Warning, error });
    }

    /// A loop whose condition does not hold where it is come to.
    #[cold]
    pub(super) fn note_loop(&mut self, program: &Program, pc: usize) {
        let Op::LeaveUnlessCompare { comparison, a, b, .. } = program.code.ops[pc] else { return };
        if self.was_noted(pc) {
            return;
        }
        let at = program.code.marks[pc];
        let message =
            format!("the loop does not run: {}", condition(program, at, comparison, [a, b], &self.cells[..]));
        let help = "look at the start value and the comparison";
        let error = program.shown(Fault::new(NEVER_RUNS, at, message, help));
        self.findings.push(Finding { severity: Severity::Warning, error });
    }

    /// The budget is spent.
    #[cold]
    pub(super) fn spent(&self, program: &Program) -> Fault {
        let code = &program.code;
        let budget = program.options.budget;
        let steps = format!("{budget} steps without a block");
        let help = "look at how the loop comes to its end; --budget gives it more steps";
        let around: Option<&Loop> = code
            .loops
            .iter()
            .filter(|l| l.condition <= self.pc && self.pc <= l.end)
            .max_by_key(|l| l.condition);
        let Some(around) = around else {
            let at = code.marks[self.pc as usize];
            return Fault::new(
                "loop-endless",
                at,
                format!("{steps}: the program goes round and does not end"),
                help,
            );
        };
        let leave = around.body.checked_sub(1).map(|pc| code.ops[pc as usize]);
        let message = match leave {
            Some(Op::LeaveUnlessCompare { comparison, a, b, .. }) => {
                let condition = condition(program, around.at, comparison, [a, b], &self.cells[..]);
                format!("{steps}: the loop DO{} does not end; {condition}", around.number)
            }
            _ => format!("{steps}: the loop DO{} does not end", around.number),
        };
        Fault::new("loop-endless", around.at, message, help)
    }

    /// `#3000`.
    #[cold]
    pub(super) fn alarm(&self, program: &Program, pc: usize, cell: u16, text: u32) -> Box<Fault> {
        let text = program.text_at(program.code.texts[text as usize]);
        let number = self.cells[usize::from(cell)].map_or("without a number".to_owned(), N::text);
        let message = if text.is_empty() {
            format!("the program raises alarm {number}")
        } else {
            format!("the program raises alarm {number}: {text}")
        };
        let help = "the program found its own values wrong; look at what it tests";
        Box::new(Fault::new("program-alarm", program.code.marks[pc], message, help))
    }

    /// The text of a program ends: right for the main one only.
    pub(super) fn fall(&self, program: &Program, pc: usize) -> Result<(), Box<Fault>> {
        if self.frames.is_empty() {
            return Ok(());
        }
        let unit = program.unit_of(pc as u32);
        let name = unit.number.map_or("the program".to_owned(), |number| format!("O{number:04}"));
        let message = format!("{name} was called and ends without M99");
        Err(Box::new(Fault::new("no-return", unit.at, message, "end it with M99")))
    }
}

/// "`#101` is 25, the loop runs while `#101` GT 25".
pub(super) fn condition<N: Number>(
    program: &Program,
    at: At,
    comparison: Comparison,
    operands: [u16; 2],
    cells: &[Option<N>],
) -> String {
    let text = program.text_at(at).to_ascii_uppercase();
    let inner = text.strip_prefix('[').and_then(|t| t.strip_suffix(']')).unwrap_or(&text);
    let sides = inner.split_once(comparison.name()).unwrap_or((inner, ""));
    let sides = [sides.0.trim(), sides.1.trim()];
    let mut message = String::new();
    for (side, cell) in sides.iter().zip(operands) {
        // A number that is written says its value itself.
        if cell >= CONSTANTS || side.is_empty() {
            continue;
        }
        let value = cells[usize::from(cell)].map_or("undefined".to_owned(), N::text);
        if RESULTS.contains(&cell) || variables::is_variable(cell) {
            message += &format!("`{side}` is {value}, ");
        }
    }
    let name = comparison.name();
    message + &format!("the loop runs while `{}` {name} {}", sides[0], sides[1])
}
