//! Runs a program: block after block, when asked.
//!
//! Between two blocks the machine computes as long as its fuel lasts and can be asked again; what it holds is its
//! variables and its calls, however many blocks it makes. An error ends it: nothing is made behind one.

use std::sync::Arc;

use super::block::{Block, Turn};
use super::findings::{Finding, MacroError};
use super::machine::Machine;
use super::number::Number;
use super::program::Program;

/// A program on its way.
#[derive(Debug)]
pub struct Expansion<N> {
    program: Arc<Program>,
    machine: Machine<N>,
}

impl<N: Number> Expansion<N> {
    /// A program at its start.
    #[must_use]
    pub fn new(program: Arc<Program>) -> Self {
        let machine = Machine::new(&program);
        Self { program, machine }
    }

    /// The program that is run.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Runs on until a block is made, at most `fuel` steps.
    ///
    /// # Errors
    ///
    /// When the program breaks a rule. There is nothing behind an error: asked again it says the end.
    pub fn turn(&mut self, fuel: u32, out: &mut Block<N>) -> Result<Turn, MacroError> {
        let mut fuel = fuel;
        self.machine.guarded(&self.program, &mut fuel, Some(out))
    }

    /// Runs over `blocks` blocks without making their words, at most `fuel` steps, and counts them down. Lines of remarks
    /// are not counted. Says [`Turn::Block`] when none are left.
    ///
    /// # Errors
    ///
    /// As [`Self::turn`].
    pub fn skip(&mut self, blocks: &mut u64, fuel: u32) -> Result<Turn, MacroError> {
        let mut fuel = fuel;
        while *blocks > 0 {
            match self.machine.guarded(&self.program, &mut fuel, None)? {
                Turn::Block => *blocks -= 1,
                other => return Ok(other),
            }
        }
        Ok(Turn::Block)
    }

    /// What was noticed so far that is no error.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.machine.findings
    }
}

impl<N: Number> Machine<N> {
    /// As far as the fuel and the budget go.
    fn guarded(
        &mut self,
        program: &Program,
        fuel: &mut u32,
        out: Option<&mut Block<N>>,
    ) -> Result<Turn, MacroError> {
        if self.is_over {
            return Ok(Turn::End);
        }
        let left = program.options.budget.saturating_sub(self.idle);
        let given = u64::from(*fuel).min(left) as u32;
        let mut rest = given;
        let (turn, made) = match out {
            Some(out) => {
                let turn = self.run(program, &mut rest, Some(&mut *out));
                (turn, !out.words.is_empty())
            }
            None => (self.run(program, &mut rest, None), true),
        };
        *fuel -= given - rest;
        match turn {
            Ok(Turn::Block) if made => self.idle = 0,
            // A remark moves nothing.
            Ok(Turn::Block) => self.idle += u64::from(given - rest),
            Ok(Turn::Working) => {
                self.idle += u64::from(given);
                if self.idle >= program.options.budget {
                    self.is_over = true;
                    return Err(program.shown(self.spent(program)));
                }
            }
            Ok(Turn::End) => self.is_over = true,
            Err(fault) => {
                self.is_over = true;
                return Err(program.shown(*fault));
            }
        }
        if self.is_over {
            self.note_loops(program);
        }
        Ok(turn.unwrap_or(Turn::End))
    }
}
