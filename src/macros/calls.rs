//! Calls and returns: G65, G66, M97, M98, M99.
//!
//! A macro call has locals of its own; a subprogram works with those of its caller (Haas 96-8000: "Calling a subroutine
//! via an M97 or M98 does not nest the local variables"). A modal macro is called behind every block that moves; a motion
//! within it calls the one set before it, and so on (Mitsubishi M700V, 13.5, note 2; NCT 99M, 20). Its locals are set where
//! G66 stands, not at each call, so what it leaves in them it finds again.

use super::code::{Kind, Value};
use super::findings::Fault;
use super::machine::Machine;
use super::modal::MODAL_CALLS;
use super::number::Number;
use super::options::{Pointless, decimals};
use super::program::Program;
use super::variables::{FRAME, LOCALS};
use crate::formats::gcode::numbers::Number as Written;

/// A call that has not returned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    kind: Kind,
    /// Where the program goes on behind it.
    back: u32,
    entry: u32,
    /// How often it runs again.
    left: u64,
    /// The operation that called.
    caller: u32,
    /// What was heard of modal calls before.
    heard: usize,
}

/// A macro that is called behind every motion.
#[derive(Clone, Debug)]
pub(super) struct Modal<N> {
    entry: u32,
    count: u64,
    locals: Vec<Option<N>>,
    caller: u32,
}

const FRAME_CELLS: usize = FRAME.end as usize;

impl<N: Number> Machine<N> {
    /// Calls, and says where the program goes on.
    pub(super) fn call(&mut self, program: &Program, pc: usize, call: u32) -> Result<u32, Box<Fault>> {
        let of = &program.code.calls[call as usize];
        let entry = self.entry(program, pc, call)?;
        let count = self.count(program, pc, of.count)?;
        if of.kind == Kind::Macro {
            let locals = self.arguments(program, call)?;
            self.enter(program, pc, Kind::Macro, entry, count, pc as u32 + 1)?;
            self.save();
            self.cells[..FRAME_CELLS].copy_from_slice(&locals);
        } else {
            self.enter(program, pc, of.kind, entry, count, pc as u32 + 1)?;
        }
        Ok(entry)
    }

    /// G66.
    pub(super) fn set_modal(&mut self, program: &Program, pc: usize, call: u32) -> Result<(), Box<Fault>> {
        self.outside_modal(program, pc, "G66")?;
        let of = &program.code.calls[call as usize];
        let entry = self.entry(program, pc, call)?;
        let count = self.count(program, pc, of.count)?;
        let locals = self.arguments(program, call)?;
        if self.modal.len() >= usize::from(program.options.macro_levels) {
            let message = format!("more than {} modal calls in force", program.options.macro_levels);
            return Err(fault(program, pc, "nesting", message, "cancel one with G67"));
        }
        self.modal.push(Modal { entry, count, locals, caller: pc as u32 });
        self.heard = self.modal.len();
        self.state.groups[MODAL_CALLS] = Some(660);
        Ok(())
    }

    /// G67: the last one; nothing where none is in force.
    pub(super) fn cancel_modal(&mut self, program: &Program, pc: usize) -> Result<(), Box<Fault>> {
        self.outside_modal(program, pc, "G67")?;
        self.modal.pop();
        self.heard = self.modal.len();
        self.state.groups[MODAL_CALLS] = Some(if self.modal.is_empty() { 670 } else { 660 });
        Ok(())
    }

    fn outside_modal(&self, program: &Program, pc: usize, word: &str) -> Result<(), Box<Fault>> {
        if self.heard == self.modal.len() {
            return Ok(());
        }
        let message = format!("{word} within a macro that was called by G66");
        Err(fault(program, pc, "modal-call", message, "set and cancel modal calls outside of them"))
    }

    /// The modal call behind a block that moved.
    pub(super) fn call_modal(&mut self, program: &Program) -> Result<(), Box<Fault>> {
        let Some(level) = self.heard.checked_sub(1) else { return Ok(()) };
        let (entry, count, caller) = {
            let modal = &self.modal[level];
            (modal.entry, modal.count, modal.caller)
        };
        let back = self.pc;
        self.enter(program, caller as usize, Kind::Modal, entry, count, back)?;
        self.save();
        self.cells[..FRAME_CELLS].copy_from_slice(&self.modal[level].locals);
        self.heard = level;
        self.pc = entry;
        Ok(())
    }

    fn enter(
        &mut self,
        program: &Program,
        pc: usize,
        kind: Kind,
        entry: u32,
        count: u64,
        back: u32,
    ) -> Result<(), Box<Fault>> {
        let options = &program.options;
        let is_macro = |kind: Kind| matches!(kind, Kind::Macro | Kind::Modal);
        let macros = self.frames.iter().filter(|frame| is_macro(frame.kind)).count();
        let (depth, most, what) = if is_macro(kind) && macros >= usize::from(options.macro_levels) {
            (macros, options.macro_levels, "macro calls")
        } else {
            (self.frames.len(), options.levels, "calls")
        };
        if depth >= usize::from(most) {
            let repeated = self.frames.iter().any(|frame| frame.entry == entry);
            let name = program.unit_of(entry).number.map_or("the program".to_owned(), |n| format!("O{n:04}"));
            let message = if repeated {
                format!("{name} calls itself: {what} are {most} deep already")
            } else {
                format!("{what} more than {most} deep")
            };
            let help = "controls hold no more (Fanuc: four levels of macros)";
            return Err(fault(program, pc, "nesting", message, help));
        }
        self.frames.push(Frame { kind, back, entry, left: count - 1, caller: pc as u32, heard: self.heard });
        Ok(())
    }

    /// Puts the locals aside.
    fn save(&mut self) {
        self.saved.extend_from_slice(&self.cells[..FRAME_CELLS]);
    }

    /// M99: once more, or back to the caller, there to an N number where one is given. None ends the program.
    pub(super) fn back(
        &mut self,
        program: &Program,
        pc: usize,
        target: Option<u16>,
    ) -> Result<Option<u32>, Box<Fault>> {
        let number = target.map(|cell| self.index(program, pc, cell)).transpose()?;
        let Some(frame) = self.frames.last_mut() else {
            return match number {
                Some(number) => self.label(program, pc, pc as u32, number).map(Some),
                None => self.again(program, pc),
            };
        };
        if frame.left > 0 && number.is_none() {
            frame.left -= 1;
            return Ok(Some(frame.entry));
        }
        let frame = *frame;
        self.frames.pop();
        if matches!(frame.kind, Kind::Macro | Kind::Modal) {
            let from = self.saved.len() - FRAME_CELLS;
            if frame.kind == Kind::Modal {
                let level = self.heard;
                self.modal[level].locals.copy_from_slice(&self.cells[..FRAME_CELLS]);
            }
            self.cells[..FRAME_CELLS].copy_from_slice(&self.saved[from..]);
            self.saved.truncate(from);
        }
        self.heard = frame.heard;
        match number {
            // Where a modal call came from is behind the block that moved.
            Some(number) => {
                let from = if frame.kind == Kind::Modal { frame.back } else { frame.caller };
                self.label(program, pc, from, number).map(Some)
            }
            None => Ok(Some(frame.back)),
        }
    }

    /// M99 of the main program.
    fn again(&mut self, program: &Program, pc: usize) -> Result<Option<u32>, Box<Fault>> {
        let Some(times) = program.options.repeat else {
            let message = "M99 in the main program: it would run for ever";
            return Err(fault(
                program,
                pc,
                "endless",
                message,
                "say how often with --repeat, or end it with M02",
            ));
        };
        self.runs += 1;
        if self.runs >= times {
            return Ok(None);
        }
        // Locals are undefined again behind M99 of the main program.
        self.cells[..FRAME_CELLS].fill(None);
        Ok(Some(program.units[0].entry))
    }

    /// Where `GOTO` with a computed number goes.
    pub(super) fn go_to(&self, program: &Program, pc: usize, cell: u16) -> Result<u32, Box<Fault>> {
        let number = self.index(program, pc, cell)?;
        let to = self.label(program, pc, pc as u32, number)?;
        let inside = |l: &&super::code::Loop, pc: u32| l.body <= pc && pc <= l.end;
        let entered = program.code.loops.iter().find(|l| inside(l, to) && !inside(l, pc as u32));
        match entered {
            None => Ok(to),
            Some(entered) => {
                let message = format!("GOTO {number} goes into a loop DO{} from outside", entered.number);
                Err(fault(program, pc, "goto-into-loop", message, "a loop is entered at its WHILE"))
            }
        }
    }

    /// An N number of the program that the operation `from` stands in.
    fn label(&self, program: &Program, pc: usize, from: u32, number: i64) -> Result<u32, Box<Fault>> {
        let unit = program.unit_of(from);
        let label = u64::try_from(number).ok().and_then(|number| unit.label(number, from));
        label.map(|label| label.pc).ok_or_else(|| {
            let name = unit.number.map_or("the program".to_owned(), |n| format!("O{n:04}"));
            let message = format!("there is no N{number} in {name}");
            fault(
                program,
                pc,
                "no-label",
                message,
                "N numbers are found in the program they are gone to from",
            )
        })
    }

    fn entry(&self, program: &Program, pc: usize, call: u32) -> Result<u32, Box<Fault>> {
        let of = &program.code.calls[call as usize];
        if let Some(entry) = of.entry {
            return Ok(entry);
        }
        let Value::Cell(cell) = of.program else {
            return Err(fault(program, pc, "no-program", "a program that is not there", "see to it"));
        };
        let number = self.index(program, pc, cell)?;
        if of.kind == Kind::Local {
            return self.label(program, pc, pc as u32, number);
        }
        let found = program.units.iter().find(|unit| unit.number.map(i64::from) == Some(number));
        found.map(|unit| unit.entry).ok_or_else(|| {
            let message = format!("there is no program O{number:04}");
            let help = "its number is computed; put it in the same text, or in the directory of the program";
            fault(program, pc, "no-program", message, help)
        })
    }

    fn count(&self, program: &Program, pc: usize, count: Value) -> Result<u64, Box<Fault>> {
        let number = match count {
            Value::Written(number, _) => number.mantissa,
            Value::Cell(cell) if self.cells[usize::from(cell)].is_none() => 1,
            Value::Cell(cell) => self.index(program, pc, cell)?,
        };
        match u64::try_from(number) {
            Ok(count) if count > 0 => Ok(count),
            _ => {
                let message = format!("L is {number}: called no times");
                Err(fault(program, pc, "count", message, "L counts from 1"))
            }
        }
    }

    /// The locals of a macro: undefined but for its arguments.
    fn arguments(&self, program: &Program, call: u32) -> Result<Vec<Option<N>>, Box<Fault>> {
        let of = &program.code.calls[call as usize];
        let mut locals = vec![None; FRAME_CELLS];
        for (variable, letter, value) in &of.arguments {
            debug_assert!(LOCALS.contains(variable));
            locals[usize::from(*variable)] = match value {
                Value::Cell(cell) => self.cells[usize::from(*cell)],
                Value::Written(number, _) => {
                    let decimals = decimals(*letter, self.state.unit);
                    match valued(*number, decimals, program.options.pointless) {
                        Some(value) => Some(value),
                        None => {
                            let message = format!(
                                "{}{}: an argument without a point is {} or {} of the least increment",
                                *letter as char, number.mantissa, number.mantissa, number.mantissa
                            );
                            let help = "write the point, or say in the profile what is meant without it";
                            return Err(Box::new(Fault::new("no-point", of.at, message, help)));
                        }
                    }
                }
            };
        }
        Ok(locals)
    }
}

/// What a written number comes to, whose least increment has so many decimals; none where that is not decided.
pub(super) fn valued<N: Number>(number: Written, decimals: u8, pointless: Pointless) -> Option<N> {
    let is_clear = number.point || decimals == 0 || number.mantissa == 0;
    match pointless {
        _ if is_clear => Some(N::written(number.mantissa, number.decimals)),
        Pointless::Whole => Some(N::written(number.mantissa, number.decimals)),
        Pointless::LeastIncrement => Some(N::written(number.mantissa, decimals)),
        Pointless::Refused => None,
    }
}

fn fault(
    program: &Program,
    pc: usize,
    code: &'static str,
    message: impl Into<String>,
    help: &'static str,
) -> Box<Fault> {
    Box::new(Fault::new(code, program.code.marks[pc], message, help))
}
