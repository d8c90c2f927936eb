//! A macro program, fed: each line is made when the control has room for it.

use super::{Line, Program, ProgramError};
use crate::macros::expanded::{Expanded, Step};
use crate::macros::number::Number;

impl<N: Number> Program for Expanded<N> {
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError> {
        loop {
            // A long computation keeps nobody waiting but whoever asked for the block: the line has a thread of its own.
            match self.next_line(FUEL, text)? {
                Step::Block => return Ok(Some(Line::Block(None))),
                Step::Remark => return Ok(Some(Line::Remark)),
                Step::Working => {}
                Step::End => return Ok(None),
            }
        }
    }
}

const FUEL: u32 = 1 << 20;
