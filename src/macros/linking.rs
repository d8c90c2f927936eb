//! Where jumps and calls go: N numbers of a program, programs of the text, and programs from beside it.

use super::code::{Kind, Loop, Op, Value};
use super::findings::{At, Fault};
use super::program::{Label, Programs, Unit};
use super::reader::{FAULTS_MAX, Goto, OpenUnit, Reader};
use crate::formats::gcode::numbers::Number as Written;

impl Reader<'_> {
    /// Ends a unit: its loops must be closed and its GOTOs found.
    pub(super) fn close(&mut self, end: At) {
        let (mut labels, gotos) = (std::mem::take(&mut self.labels), std::mem::take(&mut self.gotos));
        labels.sort_by_key(|label| (label.number, label.pc));
        let loops = std::mem::take(&mut self.loops);
        let Some(OpenUnit { number, entry, at, .. }) = self.unit.take() else { return };
        self.code.push(Op::Fall, end);
        let unit = Unit { number, entry, end: self.code.next(), labels, at };
        if !std::mem::take(&mut self.is_broken) {
            for open in loops {
                let message = format!("DO{0} without END{0}", open.number);
                self.faults.push(Fault::new("loop-nesting", open.at, message, "end the loop"));
            }
            for goto in gotos {
                self.goto_target(&unit, goto);
            }
        }
        if let Some(number) = number {
            self.numbers.entry(number).or_insert((entry, at));
        }
        self.units.push(unit);
    }

    fn goto_target(&mut self, unit: &Unit, goto: Goto) {
        if self.faults.len() >= FAULTS_MAX {
            return;
        }
        let Some(label) = unit.label(goto.number, goto.pc).copied() else {
            let message = format!("there is no N{} in this program", goto.number);
            let help = "a GOTO finds N numbers of its own program only";
            self.faults.push(Fault::new("no-label", goto.at, message, help));
            return;
        };
        let inside = |l: &Loop, pc: u32| l.body <= pc && pc <= l.end;
        let entered = self.code.loops.iter().find(|l| inside(l, label.pc) && !inside(l, goto.pc));
        if let Some(entered) = entered {
            let message = format!(
                "GOTO{} goes into the loop DO{} of line {} from outside",
                goto.number,
                entered.number,
                self.line_of(entered.at)
            );
            let help = "a loop is entered at its WHILE; go there";
            self.faults.push(Fault::new("goto-into-loop", goto.at, message, help));
            return;
        }
        self.code.aim(goto.pc, label.pc);
        self.targets.insert(label.pc);
        self.say_twice(unit, goto.number, goto.at, Some(label));
    }

    /// An N number that is gone to and stands more than once.
    fn say_twice(&mut self, unit: &Unit, number: u64, at: At, taken: Option<Label>) {
        let [first, second, ..] = unit.labels_of(number) else { return };
        if self.warnings.len() >= FAULTS_MAX {
            return;
        }
        let lines = (self.line_of(first.at), self.line_of(second.at));
        let goes = taken.map_or(String::new(), |l| format!("; this one goes to line {}", self.line_of(l.at)));
        self.warnings.push(Fault::new(
            "duplicate-label",
            at,
            format!("N{number} stands in lines {} and {}{goes}", lines.0, lines.1),
            "a GOTO searches forwards first, then from the start; give one of them another number",
        ));
    }

    /// Finds what calls go to, and loads it.
    pub(super) fn calls(&mut self, programs: &mut dyn Programs) {
        let mut at = 0;
        let mut loaded_all = false;
        while at < self.code.calls.len() && self.faults.len() < FAULTS_MAX {
            let call = self.code.calls[at].clone();
            at += 1;
            match (call.kind, call.program) {
                (Kind::Local, Value::Written(number, _)) => {
                    self.local(at - 1, number.mantissa as u64, call.at)
                }
                (Kind::Local, Value::Cell(_)) => {}
                (_, Value::Written(number, _)) => {
                    self.load(number.mantissa, at - 1, call.at, programs);
                }
                (_, Value::Cell(_)) if !loaded_all => {
                    loaded_all = true;
                    match programs.numbers() {
                        Ok(numbers) => {
                            for number in numbers {
                                if self.entry(i64::from(number)).is_none() {
                                    self.load_text(number, call.at, programs);
                                }
                            }
                        }
                        Err(message) => {
                            let fault = Fault::new(
                                "no-program",
                                call.at,
                                message,
                                "see to the directory of programs",
                            );
                            self.faults.push(fault);
                        }
                    }
                }
                (_, Value::Cell(_)) => {}
            }
        }
        for unit in &self.units {
            for number in &self.returns {
                self.targets.extend(unit.labels_of(*number).iter().map(|label| label.pc));
            }
        }
    }

    /// M97: an N number of the program the call stands in.
    fn local(&mut self, call: usize, number: u64, at: At) {
        let pc = self.code.calls[call].pc;
        let index = self.units.partition_point(|unit| unit.end <= pc);
        let Some(unit) = self.units.get(index) else { return };
        match unit.label(number, pc).copied() {
            Some(label) => {
                self.code.calls[call].entry = Some(label.pc);
                self.targets.insert(label.pc);
                let unit = unit.clone();
                self.say_twice(&unit, number, at, Some(label));
            }
            None => {
                let message = format!("there is no N{number} in this program");
                self.faults.push(Fault::new(
                    "no-label",
                    at,
                    message,
                    "M97 calls an N number of its own program",
                ));
            }
        }
    }

    fn load(&mut self, number: i64, call: usize, at: At, programs: &mut dyn Programs) {
        let is_subprogram = self.code.calls[call].kind == Kind::Subprogram;
        if self.entry(number).is_none()
            && let Ok(number) = u32::try_from(number)
        {
            self.load_text(number, at, programs);
        }
        if let Some(entry) = self.entry(number) {
            self.code.calls[call].entry = Some(entry);
            return;
        }
        // Fanuc, M98: the last four digits are the program, those in front how often.
        let (count, short) = (number / 10_000, number % 10_000);
        let has_count = self.code.calls[call].has_count;
        if is_subprogram && count > 0 && !has_count {
            if self.entry(short).is_none() {
                self.load_text(short as u32, at, programs);
            }
            if let Some(entry) = self.entry(short) {
                let repeats = Written { mantissa: count, decimals: 0, point: false };
                self.code.calls[call].entry = Some(entry);
                self.code.calls[call].count = Value::Written(repeats, (0, 0));
                return;
            }
        }
        if self.faults.is_empty() {
            let message = format!("there is no program O{number:04}");
            let help = "put it in the same text, or in the directory of the program";
            self.faults.push(Fault::new("no-program", at, message, help));
        }
    }

    fn entry(&self, number: i64) -> Option<u32> {
        let number = u32::try_from(number).ok()?;
        self.numbers.get(&number).map(|(entry, _)| *entry)
    }

    fn load_text(&mut self, number: u32, at: At, programs: &mut dyn Programs) {
        if self.files.len() >= usize::from(u16::MAX) || !self.asked.insert(number) {
            return;
        }
        match programs.load(number) {
            Ok(Some(text)) => self.file(&text, Some(number)),
            Ok(None) => {}
            Err(message) => {
                self.faults.push(Fault::new("no-program", at, message, "see to the file"));
            }
        }
    }
}
