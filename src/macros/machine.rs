//! The machine that runs operations: its cells, and what every operation does to them.
//!
//! It stops where a block is made, the program ends or its fuel is spent, and goes on from there. What calls and returns
//! do is in [`calls`](super::calls), how a block comes from its template in [`making`](super::making).

use super::block::{Block, Turn, Word};
use super::calls::{Frame, Modal};
use super::code::{Comparison, Op, Sign};
use super::findings::{Fault, Finding};
use super::foresight::compared;
use super::making::is_axis;
use super::modal::State;
use super::number::{Bits, Number, Rounding, Undefined};
use super::options::decimals;
use super::program::Program;
use super::variables::{self, CONSTANTS, Variable};

/// Everything that changes while a program runs.
#[derive(Debug)]
pub(super) struct Machine<N> {
    /// As many as an operation can name, so that no access has to be tested.
    pub cells: Box<[Option<N>; CELLS]>,
    pub pc: u32,
    pub frames: Vec<Frame>,
    /// The variables of the levels that wait.
    pub saved: Vec<Option<N>>,
    pub modal: Vec<Modal<N>>,
    /// How many of the modal calls are heard where the program stands.
    pub heard: usize,
    pub state: State<N>,
    /// Steps since the last block.
    pub idle: u64,
    /// How often the main program has run.
    pub runs: u64,
    pub is_over: bool,
    /// By loop: whether it ever went round.
    turned: Vec<bool>,
    pub findings: Vec<Finding>,
    /// By operation: whether something was said of it.
    noted: Vec<bool>,
    /// Whether what was commanded must be followed.
    pub follows: bool,
    /// The words of a block that is skipped.
    pub scratch: Vec<Word<N>>,
}

const CELLS: usize = 1 << 16;
/// The most that is noted while running.
const FINDINGS_MAX: usize = 50;

impl<N: Number> Machine<N> {
    /// A program at its start.
    pub(super) fn new(program: &Program) -> Self {
        let code = &program.code;
        let mut cells: Box<[Option<N>; CELLS]> =
            vec![None; CELLS].try_into().unwrap_or_else(|_| unreachable!());
        for (cell, (digits, decimals)) in cells[usize::from(CONSTANTS)..].iter_mut().zip(&code.constants) {
            *cell = Some(N::written(*digits, *decimals));
        }
        let has_modal = code.ops.iter().any(|op| matches!(op, Op::SetModal { .. }));
        // What a word is rounded to and an argument without a point depend on the unit.
        let asks_unit = code.ops.iter().any(|op| matches!(op, Op::Round { letter: 1.., .. }))
            || code.calls.iter().any(|call| !call.arguments.is_empty());
        let changes_unit = code.templates.iter().any(|template| template.computed_code)
            || code.words.iter().any(|word| word.is_unit());
        Self {
            cells,
            pc: program.units[0].entry,
            frames: Vec::new(),
            saved: Vec::new(),
            modal: Vec::new(),
            heard: 0,
            state: State::new(&program.options, program.number()),
            idle: 0,
            runs: 0,
            is_over: false,
            turned: vec![false; code.loops.len()],
            findings: Vec::new(),
            noted: vec![false; code.ops.len()],
            follows: code.reads_state || has_modal || asks_unit && changes_unit,
            scratch: Vec::new(),
        }
    }

    /// Runs operations until one makes a block.
    #[inline]
    pub(super) fn run(
        &mut self,
        program: &Program,
        fuel: &mut u32,
        mut out: Option<&mut Block<N>>,
    ) -> Result<Turn, Box<Fault>> {
        let code = &program.code;
        let ops = &code.ops[..];
        let mut pc = self.pc as usize;
        let mut left = *fuel;
        let turn = loop {
            if left == 0 {
                self.pc = pc as u32;
                break Turn::Working;
            }
            left -= 1;
            match ops[pc] {
                Op::Copy { to, from } => self.cells[usize::from(to)] = self.cells[usize::from(from)],
                Op::Arithmetic { sign, to, a, b } => {
                    let (a, b) = self.pair(program, pc, a, b);
                    let result = match sign {
                        Sign::Add => a.plus(b),
                        Sign::Subtract => a.minus(b),
                        Sign::Multiply => a.times(b),
                        Sign::Divide => a.over(b),
                        Sign::Modulo => a.modulo(b),
                    };
                    match result {
                        Ok(value) => self.cells[usize::from(to)] = Some(value),
                        Err(why) => return Err(undefined(program, pc, &why)),
                    }
                }
                Op::Function { function, to, from } => {
                    let value = self.one(program, pc, from).function(function);
                    self.set(program, pc, to, value)?;
                }
                Op::Bits { bits, to, a, b } => {
                    let (a, b) = self.pair(program, pc, a, b);
                    self.set(program, pc, to, a.bits(bits, b))?;
                }
                Op::Compare { comparison, to, a, b } => {
                    let holds = self.holds(comparison, a, b);
                    self.cells[usize::from(to)] = Some(N::whole(i64::from(holds)));
                }
                Op::Logic { bits, to, a, b } => {
                    let (a, b) = (self.is_true(a), self.is_true(b));
                    let holds = match bits {
                        Bits::And => a && b,
                        Bits::Or => a || b,
                        Bits::Xor => a != b,
                    };
                    self.cells[usize::from(to)] = Some(N::whole(i64::from(holds)));
                }
                Op::Negate { to, from } => {
                    self.cells[usize::from(to)] = self.cells[usize::from(from)].map(N::negated);
                }
                Op::Absolute { to, from } => {
                    let value = self.one(program, pc, from).absolute();
                    self.cells[usize::from(to)] = Some(value);
                }
                Op::Round { rounding, letter, to, from } => {
                    let value = self.one(program, pc, from);
                    let digits = match rounding {
                        Rounding::Nearest if letter != 0 => decimals(letter, self.state.unit),
                        _ => 0,
                    };
                    self.set(program, pc, to, value.rounded(rounding, digits))?;
                }
                Op::ArcTangent { to, a, b } => {
                    let (a, b) = self.pair(program, pc, a, b);
                    self.set(program, pc, to, a.arc_tangent(b))?;
                }
                Op::Power { to, a, b } => {
                    let (a, b) = self.pair(program, pc, a, b);
                    self.set(program, pc, to, a.power(b))?;
                }
                Op::Load { to, index } => {
                    let number = self.index(program, pc, index)?;
                    let value = match variables::variable(number) {
                        Variable::Null => None,
                        Variable::Kept(cell) => self.cells[usize::from(cell)],
                        other => self.system(program, pc, number, other)?,
                    };
                    self.cells[usize::from(to)] = value;
                }
                Op::Store { index, from } => {
                    let number = self.index(program, pc, index)?;
                    match variables::variable(number) {
                        Variable::Kept(cell) => {
                            self.cells[usize::from(cell)] = self.cells[usize::from(from)];
                        }
                        Variable::Null => {
                            let message = "#0 is always undefined and cannot be set";
                            return Err(Box::new(Fault::syntax(code.marks[pc], message, "use another")));
                        }
                        other => {
                            return Err(Box::new(super::statement::not_writable(
                                number,
                                other,
                                code.marks[pc],
                            )));
                        }
                    }
                }
                Op::System { to, number } => {
                    let number = i64::from(number);
                    let value = self.system(program, pc, number, variables::variable(number))?;
                    self.cells[usize::from(to)] = value;
                }
                Op::Jump { to } => {
                    pc = to as usize;
                    continue;
                }
                Op::Again { to, id } => {
                    self.turned[usize::from(id)] = true;
                    pc = to as usize;
                    continue;
                }
                Op::JumpUnless { cell, to } => {
                    if !self.is_true(cell) {
                        pc = to as usize;
                        continue;
                    }
                }
                Op::Leave { cell, to, .. } => {
                    if !self.is_true(cell) {
                        pc = to as usize;
                        continue;
                    }
                }
                Op::JumpUnlessCompare { comparison, a, b, to } => {
                    if !self.holds(comparison, a, b) {
                        pc = to as usize;
                        continue;
                    }
                }
                Op::LeaveUnlessCompare { comparison, id, a, b, to } => {
                    if !self.holds(comparison, a, b) {
                        if !self.turned[usize::from(id)] {
                            self.note_loop(program, pc);
                        }
                        pc = to as usize;
                        continue;
                    }
                }
                Op::Goto { cell } => {
                    pc = self.go_to(program, pc, cell)? as usize;
                    continue;
                }
                Op::Block { template } => {
                    let template = &code.templates[template as usize];
                    if self.make(program, pc, template, out.as_deref_mut())? {
                        pc += 1;
                        self.pc = pc as u32;
                        if template.ends {
                            self.is_over = true;
                        } else if template.moves && self.heard > 0 {
                            let words = out.as_deref().map_or(&self.scratch, |out| &out.words);
                            if words.iter().any(|word| is_axis(word.letter)) {
                                self.call_modal(program)?;
                            }
                        }
                        break Turn::Block;
                    }
                }
                Op::Stop { template } => {
                    let template = &code.templates[template as usize];
                    self.make(program, pc, template, out.as_deref_mut())?;
                    self.pc = pc as u32 + 1;
                    break Turn::Block;
                }
                Op::Call { call } => {
                    pc = self.call(program, pc, call)? as usize;
                    continue;
                }
                Op::SetModal { call } => self.set_modal(program, pc, call)?,
                Op::CancelModal => self.cancel_modal(program, pc)?,
                Op::Return => match self.back(program, pc, None)? {
                    Some(to) => {
                        pc = to as usize;
                        continue;
                    }
                    None => break Turn::End,
                },
                Op::ReturnTo { cell } => match self.back(program, pc, Some(cell))? {
                    Some(to) => {
                        pc = to as usize;
                        continue;
                    }
                    None => break Turn::End,
                },
                Op::Alarm { cell, text } => return Err(self.alarm(program, pc, cell, text)),
                Op::Fall => {
                    self.fall(program, pc)?;
                    break Turn::End;
                }
            }
            pc += 1;
        };
        *fuel = left;
        Ok(turn)
    }

    /// The value of a cell in a calculation: an undefined one counts as 0.
    #[inline]
    fn one(&mut self, program: &Program, pc: usize, cell: u16) -> N {
        match self.cells[usize::from(cell)] {
            Some(value) => value,
            None => {
                self.note_null(program, pc, cell);
                N::ZERO
            }
        }
    }

    #[inline]
    fn pair(&mut self, program: &Program, pc: usize, a: u16, b: u16) -> (N, N) {
        match (self.cells[usize::from(a)], self.cells[usize::from(b)]) {
            (Some(a), Some(b)) => (a, b),
            _ => (self.one(program, pc, a), self.one(program, pc, b)),
        }
    }

    #[inline]
    fn set(
        &mut self,
        program: &Program,
        pc: usize,
        to: u16,
        value: Result<N, Undefined>,
    ) -> Result<(), Box<Fault>> {
        match value {
            Ok(value) => {
                self.cells[usize::from(to)] = Some(value);
                Ok(())
            }
            Err(why) => Err(undefined(program, pc, &why)),
        }
    }

    #[inline]
    fn holds(&self, comparison: Comparison, a: u16, b: u16) -> bool {
        let (a, b) = (self.cells[usize::from(a)], self.cells[usize::from(b)]);
        compared(comparison, a, b)
    }

    #[inline]
    fn is_true(&self, cell: u16) -> bool {
        self.cells[usize::from(cell)].is_some_and(|value| value.compare(N::ZERO).is_ne())
    }

    /// The number of a variable, a program or an N number that is computed: to the nearest whole one.
    pub(super) fn index(&self, program: &Program, pc: usize, cell: u16) -> Result<i64, Box<Fault>> {
        let Some(value) = self.cells[usize::from(cell)] else {
            return Err(Box::new(Fault::new(
                "undefined",
                program.code.marks[pc],
                "a number that is undefined",
                "set the variable it is computed from",
            )));
        };
        value.at_decimals(0).ok_or_else(|| undefined(program, pc, &Undefined::TooLarge))
    }

    /// A variable that is not kept in a cell.
    fn system(
        &self,
        program: &Program,
        pc: usize,
        number: i64,
        variable: Variable,
    ) -> Result<Option<N>, Box<Fault>> {
        let at = program.code.marks[pc];
        self.state.read(&program.options, number, variable, at).map_err(Box::new)
    }

    pub(super) fn was_noted(&mut self, pc: usize) -> bool {
        self.findings.len() >= FINDINGS_MAX || std::mem::replace(&mut self.noted[pc], true)
    }

    /// The loops that never went round.
    pub(super) fn note_loops(&mut self, program: &Program) {
        let turned = &self.turned;
        self.findings.retain(|finding| {
            finding.error.code != super::findings::NEVER_RUNS
                || !program
                    .code
                    .loops
                    .iter()
                    .zip(turned)
                    .any(|(l, turned)| *turned && u64::from(l.at.start) == finding.error.place.byte)
        });
    }
}

#[cold]
pub(super) fn undefined(program: &Program, pc: usize, why: &Undefined) -> Box<Fault> {
    let help = match why {
        Undefined::DivisionByZero => "test the divisor with IF before dividing",
        Undefined::TooLarge => "18 digits are held",
        _ => "look at the values that lead here",
    };
    Box::new(Fault::new("arithmetic", program.code.marks[pc], why.to_string(), help))
}
