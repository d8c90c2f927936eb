//! Loops whose course is known before they run: those that never do, and those that never end.
//!
//! The text is walked once from top to bottom with the values that are certain wherever it is come to: what a line sets
//! from numbers stays known until something else may have set it (the body of a loop, a call, a place that is jumped to).
//! Nothing is guessed: where a value depends on the way the program came, the loop is left to the run, and to its
//! budget.

use std::collections::BTreeSet;

use super::code::{Comparison, Loop, Op, Sign};
use super::diagnosis::condition;
use super::findings::{Fault, NEVER_RUNS};
use super::number::{Bits, Number, Rounding};
use super::program::Program;
use super::reader::FAULTS_MAX;
use super::variables::{CONSTANTS, FRAME, RESULTS, is_variable, name_of};
use crate::check::Severity;

/// What is known of a cell: nothing, or its value, which may be undefined.
type Known<N> = Option<Option<N>>;

/// One walk over the operations of a program's text.
struct Walk<'p, N> {
    program: &'p Program,
    cells: Vec<Known<N>>,
    /// Whether the text is come to from above.
    is_reached: bool,
    /// Ends of conditional stretches: where, what was known in front, and where the stretch begins.
    joins: Vec<(u32, u32, Vec<Known<N>>, bool)>,
    found: Vec<(Severity, Fault)>,
    has_modal: bool,
    /// All N numbers, where jumps are computed.
    labels: BTreeSet<u32>,
}

/// The loops of a program that never run or never end.
pub(super) fn loops<N: Number>(program: &Program) -> Vec<(Severity, Fault)> {
    let code = &program.code;
    // Locals begin undefined; what a control still holds in its commons is not known.
    let mut cells: Vec<Known<N>> = vec![Some(None); usize::from(FRAME.end)];
    cells.resize(usize::from(CONSTANTS), None);
    cells.extend(code.constants.iter().map(|(digits, decimals)| Some(Some(N::written(*digits, *decimals)))));
    let mut walk = Walk {
        program,
        cells,
        is_reached: true,
        joins: Vec::new(),
        found: Vec::new(),
        labels: match code.computed_jumps {
            true => program.units.iter().flat_map(|unit| &unit.labels).map(|label| label.pc).collect(),
            false => BTreeSet::new(),
        },
        has_modal: code.ops.iter().any(|op| matches!(op, Op::SetModal { .. })),
    };
    for (n, unit) in program.units.iter().enumerate() {
        if n > 0 {
            walk.forget_all();
        }
        walk.is_reached = true;
        walk.joins.clear();
        for pc in unit.entry..unit.end {
            walk.step(pc);
        }
    }
    walk.found
}

impl<N: Number> Walk<'_, N> {
    fn step(&mut self, pc: u32) {
        let code = &self.program.code;
        while let Some((to, from, _, _)) = self.joins.last()
            && *to == pc
        {
            let from = *from;
            if let Some((_, _, cells, was_reached)) = self.joins.pop() {
                if self.is_reached {
                    self.forget_set(from, pc);
                } else {
                    self.cells[..cells.len()].copy_from_slice(&cells);
                    self.is_reached = was_reached;
                }
            }
        }
        if self.program.targets.contains(&pc) || self.labels.contains(&pc) {
            self.forget_all();
            self.is_reached = true;
        }
        let op = code.ops[pc as usize];
        match op {
            Op::Jump { .. } | Op::Goto { .. } | Op::Return | Op::ReturnTo { .. } | Op::Alarm { .. } => {
                self.is_reached = false;
            }
            Op::JumpUnless { to, .. } | Op::JumpUnlessCompare { to, .. } => {
                let cells = self.cells[..usize::from(CONSTANTS)].to_vec();
                self.joins.push((to, pc + 1, cells, self.is_reached));
            }
            Op::Leave { id, .. } | Op::LeaveUnlessCompare { id, .. } => {
                let around = code.loops[usize::from(id)];
                if self.is_reached {
                    self.judge(&around, op);
                }
                self.forget_set(around.body, around.end);
            }
            Op::Again { id, .. } => {
                let around = code.loops[usize::from(id)];
                let has_condition = around.condition < around.body;
                if self.is_reached && !has_condition && !self.has_exit(&around) {
                    let message = format!(
                        "the loop DO{} cannot end: it has no condition and nothing leads out",
                        around.number
                    );
                    self.say(
                        Severity::Error,
                        "loop-endless",
                        &around,
                        message,
                        "write WHILE[…]DO, or a GOTO out of it",
                    );
                }
                self.forget_set(around.body, around.end);
                self.is_reached &= has_condition;
            }
            Op::Call { .. } | Op::SetModal { .. } | Op::Store { .. } => self.forget_all(),
            Op::Block { template } => {
                let template = &code.templates[template as usize];
                if self.has_modal {
                    self.forget_all();
                }
                self.is_reached &= !template.ends;
            }
            Op::CancelModal | Op::Stop { .. } | Op::Fall => {}
            _ => {
                if let Some((to, value)) = self.value_of(op) {
                    self.cells[usize::from(to)] = value;
                }
            }
        }
    }

    fn forget_all(&mut self) {
        for cell in &mut self.cells[1..usize::from(CONSTANTS)] {
            *cell = None;
        }
    }

    /// Forgets what the operations `from..=to` may set.
    fn forget_set(&mut self, from: u32, to: u32) {
        let last = (to as usize).min(self.program.code.ops.len() - 1);
        for op in &self.program.code.ops[from as usize..=last] {
            match *op {
                Op::Call { .. } | Op::SetModal { .. } | Op::Store { .. } => return self.forget_all(),
                Op::Block { .. } if self.has_modal => return self.forget_all(),
                op => {
                    if let Some(to) = sets(op) {
                        self.cells[usize::from(to)] = None;
                    }
                }
            }
        }
    }

    /// Looks at a loop where it is come to.
    fn judge(&mut self, around: &Loop, op: Op) {
        let Op::LeaveUnlessCompare { comparison, a, b, .. } = op else { return };
        let at = around.at;
        let [left, right] = [self.cells[usize::from(a)], self.cells[usize::from(b)]];
        let holds = left.zip(right).map(|(left, right)| compared(comparison, left, right));
        if holds == Some(false) {
            let known: Vec<Option<N>> = self.cells.iter().map(|cell| cell.flatten()).collect();
            let message =
                format!("the loop never runs: {}", condition(self.program, at, comparison, [a, b], &known));
            // A bound that is written and a variable the loop itself counts: no setting of a job makes it run.
            let counts = |cell: u16| is_variable(cell) && self.sets_within(around, cell) > 0;
            let is_written = |cell: u16| cell >= CONSTANTS;
            let is_certain = counts(a) && is_written(b) || counts(b) && is_written(a);
            let severity = if is_certain { Severity::Error } else { Severity::Warning };
            self.say(severity, NEVER_RUNS, around, message, "look at the start value and the comparison");
            return;
        }
        if self.has_exit(around) {
            return;
        }
        let severity = if holds == Some(true) { Severity::Error } else { Severity::Warning };
        let (counted, bound, comparison_seen) = match (self.changes(around, a), self.changes(around, b)) {
            (false, false) => {
                if is_result(a) || is_result(b) {
                    return;
                }
                let known: Vec<Option<N>> = self.cells.iter().map(|cell| cell.flatten()).collect();
                let text = condition(self.program, at, comparison, [a, b], &known);
                let text =
                    if holds.is_some() { text } else { text.rsplit(", ").next().unwrap_or("").to_owned() };
                let message = format!("the loop cannot end: nothing in it changes its condition; {text}");
                self.say(
                    severity,
                    "loop-endless",
                    around,
                    message,
                    "count a variable of the condition in the loop",
                );
                return;
            }
            (true, false) if is_variable(a) && !is_result(b) => (a, b, comparison),
            (false, true) if is_variable(b) && !is_result(a) => (b, a, mirrored(comparison)),
            _ => return,
        };
        let Some(step) = self.step_of(around, counted) else { return };
        let direction = step.compare(N::ZERO);
        let start = self.cells[usize::from(counted)].flatten();
        let end = self.cells[usize::from(bound)].flatten();
        let is_wrong = match comparison_seen {
            Comparison::Greater | Comparison::GreaterOrEqual => direction.is_ge(),
            Comparison::Less | Comparison::LessOrEqual => direction.is_le(),
            Comparison::NotEqual => match start.zip(end) {
                Some((start, end)) => passes_by(start, end, step),
                None => false,
            },
            Comparison::Equal => false,
        };
        if !is_wrong {
            return;
        }
        let code = &self.program.code;
        let name = name_of(counted, &code.local_names, &code.names).unwrap_or_default();
        let value = start.map_or(String::new(), |start| format!("is {} and ", start.text()));
        let change = match direction {
            std::cmp::Ordering::Less => format!("falls by {}", step.absolute().text()),
            std::cmp::Ordering::Equal => "stays".to_owned(),
            std::cmp::Ordering::Greater => format!("grows by {}", step.text()),
        };
        let nothing: Vec<Option<N>> = Vec::new();
        let runs = condition(self.program, at, comparison, [CONSTANTS, CONSTANTS], &nothing);
        let message = format!("the loop cannot end: `{name}` {value}{change} each turn, {runs}");
        self.say(
            severity,
            "loop-endless",
            around,
            message,
            "look at the sign of the step and at the comparison",
        );
    }

    fn say(
        &mut self,
        severity: Severity,
        code: &'static str,
        around: &Loop,
        message: String,
        help: &'static str,
    ) {
        if self.found.len() < FAULTS_MAX {
            self.found.push((severity, Fault::new(code, around.at, message, help)));
        }
    }

    fn body(&self, around: &Loop) -> &[Op] {
        &self.program.code.ops[around.body as usize..around.end as usize]
    }

    /// How many operations of a loop set a cell.
    fn sets_within(&self, around: &Loop, cell: u16) -> usize {
        self.body(around).iter().filter(|op| sets(**op) == Some(cell)).count()
    }

    /// Whether a loop may change what stands in a cell.
    fn changes(&self, around: &Loop, cell: u16) -> bool {
        cell < CONSTANTS && (self.sets_within(around, cell) > 0 || is_result(cell))
    }

    /// Whether a loop may be left otherwise than by its condition, or does things that are not followed here.
    fn has_exit(&self, around: &Loop) -> bool {
        let inside = |to: u32| around.condition <= to && to <= around.end;
        self.body(around).iter().any(|op| match *op {
            Op::Jump { to } => !inside(to),
            Op::Goto { .. }
            | Op::Return
            | Op::ReturnTo { .. }
            | Op::Alarm { .. }
            | Op::Call { .. }
            | Op::SetModal { .. }
            | Op::Store { .. } => true,
            Op::Block { template } => {
                let template = &self.program.code.templates[template as usize];
                template.ends || template.computed_code || self.has_modal && template.moves
            }
            _ => false,
        })
    }

    /// By how much a loop counts a variable, where it does so in one place and by a known number.
    fn step_of(&self, around: &Loop, counted: u16) -> Option<N> {
        if self.sets_within(around, counted) != 1 {
            return None;
        }
        let op = self.body(around).iter().find(|op| sets(**op) == Some(counted))?;
        let Op::Arithmetic { sign, a, b, .. } = *op else { return None };
        let by = match (sign, a == counted, b == counted) {
            (Sign::Add | Sign::Subtract, true, false) => b,
            (Sign::Add, false, true) => a,
            _ => return None,
        };
        if self.changes(around, by) {
            return None;
        }
        let step = self.cells[usize::from(by)]?.unwrap_or(N::ZERO);
        Some(if sign == Sign::Subtract { step.negated() } else { step })
    }

    /// The cell an operation sets and what is known of its value.
    fn value_of(&self, op: Op) -> Option<(u16, Known<N>)> {
        let to = sets(op)?;
        let known = |cell: u16| self.cells[usize::from(cell)];
        let number = |cell: u16| known(cell).map(|value| value.unwrap_or(N::ZERO));
        let value = match op {
            Op::Copy { from, .. } => return Some((to, known(from))),
            Op::Negate { from, .. } => return Some((to, known(from).map(|value| value.map(N::negated)))),
            Op::Arithmetic { sign, a, b, .. } => number(a).zip(number(b)).and_then(|(a, b)| {
                let result = match sign {
                    Sign::Add => a.plus(b),
                    Sign::Subtract => a.minus(b),
                    Sign::Multiply => a.times(b),
                    Sign::Divide => a.over(b),
                    Sign::Modulo => a.modulo(b),
                };
                result.ok()
            }),
            Op::Bits { bits, a, b, .. } => number(a).zip(number(b)).and_then(|(a, b)| a.bits(bits, b).ok()),
            Op::Compare { comparison, a, b, .. } => {
                known(a).zip(known(b)).map(|(a, b)| truth(compared(comparison, a, b)))
            }
            Op::Logic { bits, a, b, .. } => number(a).zip(number(b)).map(|(a, b)| {
                let (a, b) = (a.compare(N::ZERO).is_ne(), b.compare(N::ZERO).is_ne());
                truth(match bits {
                    Bits::And => a && b,
                    Bits::Or => a || b,
                    Bits::Xor => a != b,
                })
            }),
            Op::Absolute { from, .. } => number(from).map(N::absolute),
            Op::Function { function, from, .. } => number(from).and_then(|n| n.function(function).ok()),
            // How finely a word is rounded depends on the unit in force.
            Op::Round { letter, rounding, from, .. } if letter == 0 || rounding != Rounding::Nearest => {
                number(from).and_then(|n| n.rounded(rounding, 0).ok())
            }
            Op::ArcTangent { a, b, .. } => number(a).zip(number(b)).and_then(|(a, b)| a.arc_tangent(b).ok()),
            Op::Power { a, b, .. } => number(a).zip(number(b)).and_then(|(a, b)| a.power(b).ok()),
            _ => None,
        };
        Some((to, value.map(Some)))
    }
}

/// The cell an operation sets.
pub(super) fn sets(op: Op) -> Option<u16> {
    let mut op = op;
    match op {
        Op::Copy { to, .. } => Some(to),
        _ => super::statement::result_of(&mut op).map(|to| *to),
    }
}

fn is_result(cell: u16) -> bool {
    RESULTS.contains(&cell)
}

fn truth<N: Number>(holds: bool) -> N {
    N::whole(i64::from(holds))
}

fn mirrored(comparison: Comparison) -> Comparison {
    match comparison {
        Comparison::Greater => Comparison::Less,
        Comparison::GreaterOrEqual => Comparison::LessOrEqual,
        Comparison::Less => Comparison::Greater,
        Comparison::LessOrEqual => Comparison::GreaterOrEqual,
        same => same,
    }
}

/// Whether counting from `start` by `step` never meets `end`.
fn passes_by<N: Number>(start: N, end: N, step: N) -> bool {
    let Ok(way) = end.minus(start) else { return false };
    if step.compare(N::ZERO).is_eq() {
        return way.compare(N::ZERO).is_ne();
    }
    let is_away = way.compare(N::ZERO) != step.compare(N::ZERO) && way.compare(N::ZERO).is_ne();
    is_away || way.modulo(step).is_ok_and(|rest| rest.compare(N::ZERO).is_ne())
}

/// A comparison of two values, either of which may be undefined. Undefined and 0 differ to EQ and NE alone (Mitsubishi
/// M700V, 13.5: "<Vacant> and 0 are not equivalent for EQ and NE only").
#[inline]
pub(super) fn compared<N: Number>(comparison: Comparison, a: Option<N>, b: Option<N>) -> bool {
    let order = match (a, b) {
        (Some(a), Some(b)) => a.compare(b),
        _ => match comparison {
            Comparison::Equal => return a.is_none() && b.is_none(),
            Comparison::NotEqual => return a.is_some() || b.is_some(),
            _ => a.unwrap_or(N::ZERO).compare(b.unwrap_or(N::ZERO)),
        },
    };
    match comparison {
        Comparison::Equal => order.is_eq(),
        Comparison::NotEqual => order.is_ne(),
        Comparison::Greater => order.is_gt(),
        Comparison::GreaterOrEqual => order.is_ge(),
        Comparison::Less => order.is_lt(),
        Comparison::LessOrEqual => order.is_le(),
    }
}
