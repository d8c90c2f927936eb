//! A generated part in 4B or G-code: its elements as they are designed, spelled by a writer, a line at a time.

use std::collections::VecDeque;

use super::{Line, Program, ProgramError};
use crate::formats::Writer;
use crate::motion::Motion;

/// Motions, written.
pub struct Written {
    motions: Box<dyn Iterator<Item = Motion> + Send>,
    writer: Box<dyn Writer + Send>,
    text: Vec<u8>,
    lines: VecDeque<Vec<u8>>,
    is_ended: bool,
}

impl Written {
    /// The program a writer makes of motions.
    #[must_use]
    pub fn new(
        motions: impl Iterator<Item = Motion> + Send + 'static,
        writer: impl Writer + Send + 'static,
    ) -> Self {
        Self {
            motions: Box::new(motions),
            writer: Box::new(writer),
            text: Vec::new(),
            lines: VecDeque::new(),
            is_ended: false,
        }
    }

    fn write_more(&mut self) -> Result<(), ProgramError> {
        match self.motions.next() {
            Some(motion) => self.writer.write(&motion, &mut self.text)?,
            None => {
                self.writer.finish(&mut self.text)?;
                self.is_ended = true;
            }
        }
        let lines = self.text.split(|b| matches!(b, b'\n' | b'\r')).filter(|line| !line.is_empty());
        self.lines.extend(lines.map(<[u8]>::to_vec));
        self.text.clear();
        Ok(())
    }
}

impl Program for Written {
    fn pull(&mut self, text: &mut Vec<u8>) -> Result<Option<Line>, ProgramError> {
        loop {
            if let Some(line) = self.lines.pop_front() {
                text.extend_from_slice(&line);
                return Ok(Some(match line.as_slice() {
                    b"D" => Line::Pause,
                    b"DD" | b"E" => Line::End,
                    _ => Line::Block(None),
                }));
            }
            if self.is_ended {
                return Ok(None);
            }
            self.write_more()?;
        }
    }
}
