//! A macro program as lines of plain G-code: expansion and spelling joined.
//!
//! The same for what prints, feeds and reads it. A line is made when it is asked for; nothing is kept of it.

use std::sync::Arc;

use super::block::{Block, Turn};
use super::findings::Finding;
use super::form::AmountOf;
use super::number::Number;
use super::printer::{Printed, Printer, Unspellable};
use super::program::Program;
use super::run::Expansion;
use super::starvation::{Account, Line, Starvation};
use crate::formats::ReadError;
use crate::place::Place;

/// Lines of a program that is expanded.
#[derive(Debug)]
pub struct Expanded<N> {
    expansion: Expansion<N>,
    printer: Printer,
    block: Block<N>,
    blocks: u64,
    /// Whether a block spelled held a length or an angle.
    moves: bool,
    starvation: Option<Starvation>,
    /// Whether blocks that are run over must be spelled, for those behind them to be spelled right.
    spells_all: bool,
}

/// What a turn came to.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Step {
    /// A block was appended.
    Block,
    /// A remark, or the program's name, was appended: it is not counted.
    Remark,
    /// The fuel ran out first; nothing was appended.
    Working,
    /// There is no more.
    End,
}

impl<N: Number> Expanded<N> {
    /// The lines of a program from its start.
    #[must_use]
    pub fn new(program: Arc<Program>, printer: Printer) -> Self {
        let spells_all = printer.looks_back() || program.texts().any(may_be_in_inches);
        let expansion = Expansion::new(program);
        Self {
            expansion,
            printer,
            block: Block::default(),
            blocks: 0,
            moves: false,
            starvation: None,
            spells_all,
        }
    }

    /// Works out whether a line keeps up, from here on.
    #[must_use]
    pub fn over(self, line: Line) -> Self {
        Self { starvation: Some(Starvation::new(line)), ..self }
    }

    /// Appends the next line, without its end, in at most `fuel` steps.
    ///
    /// # Errors
    ///
    /// When the program breaks a rule or a block cannot be spelled; nothing is made behind that.
    pub fn next_line(&mut self, fuel: u32, text: &mut Vec<u8>) -> Result<Step, ReadError> {
        loop {
            match self.expansion.turn(fuel, &mut self.block)? {
                Turn::Working => return Ok(Step::Working),
                Turn::End => return Ok(Step::End),
                Turn::Block => {}
            }
            let (start, program) = (text.len(), self.expansion.program());
            let source = program.source_text(self.block.source);
            let printed = self
                .printer
                .print(&self.block, source, text)
                .map_err(|error| unspellable(program, self.block.source, error))?;
            match printed {
                Printed::Nothing => {}
                Printed::Remark => return Ok(Step::Remark),
                Printed::Block => {
                    self.blocks += 1;
                    if !self.moves {
                        let form = self.printer.form();
                        self.moves =
                            self.block.words.iter().any(|w| form.amount(w.letter) == AmountOf::Length);
                    }
                    if let Some(starvation) = &mut self.starvation {
                        let characters = text.len() - start;
                        starvation.see(self.printer.form(), &self.block, self.blocks, characters);
                    }
                    return Ok(Step::Block);
                }
            }
        }
    }

    /// Runs over up to `blocks` blocks, counting them down, in at most `fuel` steps: [`Step::Block`] when none are left.
    ///
    /// # Errors
    ///
    /// As [`Self::next_line`].
    pub fn skip(&mut self, blocks: &mut u64, fuel: u32, scratch: &mut Vec<u8>) -> Result<Step, ReadError> {
        if self.spells_all || self.starvation.is_some() {
            // What was printed before matters: it is printed, and thrown away.
            while *blocks > 0 {
                scratch.clear();
                match self.next_line(fuel, scratch)? {
                    Step::Block => *blocks -= 1,
                    Step::Remark => {}
                    other => return Ok(other),
                }
            }
            return Ok(Step::Block);
        }
        let before = *blocks;
        let turn = self.expansion.skip(blocks, fuel)?;
        self.blocks += before - *blocks;
        Ok(match turn {
            Turn::Block => Step::Block,
            Turn::Working => Step::Working,
            Turn::End => Step::End,
        })
    }

    /// Blocks made or run over so far.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.blocks
    }

    /// Whether a block spelled so far holds a length or an angle, and so may move something.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// The line of the source that made the last one: its number, its text, and the program it stands in where that was
    /// loaded from beside the main one.
    #[must_use]
    pub fn made_from(&self) -> (u64, &[u8], Option<u32>) {
        let program = self.expansion.program();
        let source = self.block.source;
        (self.block.spot.line, program.line(source), program.file_of(source))
    }

    /// What was noticed so far that is no error.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        self.expansion.findings()
    }

    /// Whether the line keeps up, where that is worked out.
    #[must_use]
    pub fn account(&self) -> Option<Account> {
        self.starvation.as_ref().map(Starvation::account)
    }
}

/// Whether a text may switch to inches, which are spelled otherwise.
fn may_be_in_inches(text: &[u8]) -> bool {
    memchr::memchr2_iter(b'G', b'g', text).any(|at| {
        let behind = text[at + 1..].iter().filter(|b| !matches!(b, b' ' | b'\t')).take(12);
        let behind: Vec<u8> = behind.copied().skip_while(|b| *b == b'0').collect();
        match behind.as_slice() {
            [b'#' | b'[', ..] => true,
            [b'2' | b'7', b'0', rest @ ..] => !rest.first().is_some_and(u8::is_ascii_digit),
            _ => false,
        }
    })
}

fn unspellable(program: &Program, source: u32, error: Unspellable) -> ReadError {
    let Unspellable { message, spot, help } = error;
    let column = spot.column.max(1) - 1;
    let place =
        Place::in_line(program.line(source), spot.line, spot.byte - column, column as usize, usize::MAX);
    ReadError::Program { message, place, help: help.into() }
}
