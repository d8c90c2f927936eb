//! What can be said of a program without running it, beside its spelling.
//!
//! Loops are in [`foresight`](super::foresight); here are calls that come back to themselves, variables that nothing
//! sets, and a main program that would begin again for ever.

use std::collections::{BTreeMap, BTreeSet};

use super::code::{Kind, Op, Value};
use super::findings::{Fault, Finding};
use super::foresight::{self, sets};
use super::number::Number;
use super::program::Program;
use super::reader::FAULTS_MAX;
use super::variables::{FRAME, is_variable, name_of};
use crate::check::Severity;

impl Program {
    /// Everything that is found without running the program, errors first.
    #[must_use]
    pub fn check<N: Number>(&self) -> Vec<Finding> {
        let mut found = foresight::loops::<N>(self);
        self.endless_main(&mut found);
        self.recursion(&mut found);
        self.never_set(&mut found);
        let mut findings: Vec<Finding> = found
            .into_iter()
            .map(|(severity, fault)| Finding { severity, error: self.shown(fault) })
            .chain(self.findings().iter().cloned())
            .collect();
        findings.sort_by_key(|finding| finding.severity);
        findings
    }

    /// M99 in the main program, not behind an N number that M97 calls.
    fn endless_main(&self, found: &mut Vec<(Severity, Fault)>) {
        let main = &self.units[0];
        let has_local_calls = self.code.calls.iter().any(|call| call.kind == Kind::Local);
        let calls_itself = self.code.calls.iter().any(|call| call.entry == Some(main.entry));
        if self.options.repeat.is_some() || has_local_calls || calls_itself {
            return;
        }
        let range = main.entry as usize..main.end as usize;
        if let Some(at) = self.code.ops[range.clone()].iter().position(|op| *op == Op::Return) {
            found.push((
                Severity::Error,
                Fault::new(
                    "endless",
                    self.code.marks[range.start + at],
                    "M99 in the main program: it would run for ever",
                    "say how often with --repeat, or end it with M02",
                ),
            ));
        }
    }

    /// Programs that call one another in a circle.
    fn recursion(&self, found: &mut Vec<(Severity, Fault)>) {
        let mut calls: BTreeMap<u32, Vec<(u32, usize)>> = BTreeMap::new();
        for (pc, op) in self.code.ops.iter().enumerate() {
            let (Op::Call { call } | Op::SetModal { call }) = *op else { continue };
            let call = &self.code.calls[call as usize];
            let Some(entry) = call.entry.filter(|_| call.kind != Kind::Local) else { continue };
            let from = self.unit_of(pc as u32).entry;
            calls.entry(from).or_default().push((self.unit_of(entry).entry, pc));
        }
        // Depth first; a call of a program that has not returned closes a circle.
        let name = |entry: u32| match self.unit_of(entry).number {
            Some(number) => format!("O{number:04}"),
            None => "the main program".to_owned(),
        };
        let (mut seen, mut waiting) = (BTreeSet::new(), BTreeSet::new());
        for start in calls.keys().copied() {
            let mut way = vec![(start, 0)];
            while let Some((unit, next)) = way.last_mut() {
                if *next == 0 && !seen.insert(*unit) {
                    way.pop();
                    continue;
                }
                waiting.insert(*unit);
                let Some((to, pc)) = calls.get(unit).and_then(|calls| calls.get(*next)).copied() else {
                    waiting.remove(unit);
                    way.pop();
                    continue;
                };
                *next += 1;
                if !waiting.contains(&to) {
                    way.push((to, 0));
                } else if found.len() < FAULTS_MAX {
                    let through =
                        if to == *unit { String::new() } else { format!(" through {}", name(*unit)) };
                    let message = format!("{} calls itself{through}", name(to));
                    let help = "macro calls are four levels deep at most; a loop repeats without calls";
                    found.push((
                        Severity::Warning,
                        Fault::new("recursion", self.code.marks[pc], message, help),
                    ));
                }
            }
        }
    }

    /// Commons and names that are read, and that nothing sets.
    fn never_set(&self, found: &mut Vec<(Severity, Fault)>) {
        let code = &self.code;
        if code.ops.iter().any(|op| matches!(op, Op::Store { .. })) {
            return;
        }
        let set: BTreeSet<u16> = code.ops.iter().filter_map(|op| sets(*op)).collect();
        let mut said = BTreeSet::new();
        let mut read = |cell: u16, pc: usize| {
            let is_kept = is_variable(cell) && (cell >= FRAME.end || cell >= super::variables::LOCALS.end);
            if !is_kept || set.contains(&cell) || !said.insert(cell) {
                return;
            }
            let name = name_of(cell, &code.local_names, &code.names).unwrap_or_default();
            let message = format!(
                "`{name}` is read and never set: here it is undefined, a control may still hold a value"
            );
            let fault = Fault::new("undefined", code.marks[pc], message, "set it in the program");
            found.push((Severity::Warning, fault));
        };
        for (pc, op) in code.ops.iter().enumerate() {
            for cell in reads(*op).into_iter().flatten() {
                read(cell, pc);
            }
            let values: Vec<Value> = match *op {
                Op::Block { template } => {
                    let template = &code.templates[template as usize];
                    let words = &code.words[template.first as usize..][..usize::from(template.count)];
                    words.iter().map(|word| word.value).collect()
                }
                Op::Call { call } | Op::SetModal { call } => {
                    let call = &code.calls[call as usize];
                    call.arguments
                        .iter()
                        .map(|argument| argument.2)
                        .chain([call.program, call.count])
                        .collect()
                }
                _ => continue,
            };
            for value in values {
                if let Value::Cell(cell) = value {
                    read(cell, pc);
                }
            }
        }
    }
}

/// The cells an operation reads.
fn reads(op: Op) -> [Option<u16>; 2] {
    match op {
        Op::Copy { from, .. }
        | Op::Negate { from, .. }
        | Op::Absolute { from, .. }
        | Op::Function { from, .. }
        | Op::Round { from, .. }
        | Op::Store { from, .. } => [Some(from), None],
        Op::Arithmetic { a, b, .. }
        | Op::Bits { a, b, .. }
        | Op::Compare { a, b, .. }
        | Op::Logic { a, b, .. }
        | Op::ArcTangent { a, b, .. }
        | Op::Power { a, b, .. }
        | Op::JumpUnlessCompare { a, b, .. }
        | Op::LeaveUnlessCompare { a, b, .. } => [Some(a), Some(b)],
        Op::JumpUnless { cell, .. }
        | Op::Leave { cell, .. }
        | Op::Goto { cell }
        | Op::ReturnTo { cell }
        | Op::Alarm { cell, .. } => [Some(cell), None],
        Op::Load { index, .. } => [Some(index), None],
        Op::System { .. }
        | Op::Jump { .. }
        | Op::Again { .. }
        | Op::Block { .. }
        | Op::Call { .. }
        | Op::SetModal { .. }
        | Op::CancelModal
        | Op::Return
        | Op::Stop { .. }
        | Op::Fall => [None, None],
    }
}
