//! Makes a block from its template: the words whose numbers there are.

use super::block::{Amount, Block, Word};
use super::code::{Template, TemplateWord, Value};
use super::findings::Fault;
use super::machine::Machine;
use super::modal::Effect;
use super::number::Number;
use super::program::Program;

impl<N: Number> Machine<N> {
    /// A block from its template; false where all its words are dropped.
    #[inline]
    pub(super) fn make(
        &mut self,
        program: &Program,
        pc: usize,
        template: &Template,
        out: Option<&mut Block<N>>,
    ) -> Result<bool, Box<Fault>> {
        let words = &program.code.words[template.first as usize..][..usize::from(template.count)];
        match out {
            Some(out) => {
                self.fill(words, &mut out.words);
                if out.words.is_empty() && !template.is_remark {
                    return Ok(false);
                }
                let source = &program.lines[template.source as usize];
                (out.source, out.spot, out.skip, out.number) =
                    (template.source, source.spot, source.skip, source.number);
                out.remarks.clear();
                out.remarks.extend_from_slice(program.remarks_of(template.source));
                if self.follows || template.computed_code {
                    self.follow(program, pc, template, &out.words)?;
                }
            }
            None if template.is_remark => return Ok(false),
            None if self.follows || template.computed_code => {
                let mut scratch = std::mem::take(&mut self.scratch);
                self.fill(words, &mut scratch);
                let is_made = !scratch.is_empty();
                let followed = if is_made { self.follow(program, pc, template, &scratch) } else { Ok(()) };
                self.scratch = scratch;
                followed?;
                return Ok(is_made);
            }
            None => {
                return Ok(template.sure
                    || words.iter().any(|word| match word.value {
                        Value::Written(..) => true,
                        Value::Cell(cell) => self.cells[usize::from(cell)].is_some(),
                    }));
            }
        }
        Ok(true)
    }

    #[inline]
    fn fill(&self, words: &[TemplateWord], out: &mut Vec<Word<N>>) {
        out.clear();
        for word in words {
            let amount = match word.value {
                Value::Written(number, digits) => Amount::Written { number, digits },
                Value::Cell(cell) => match self.cells[usize::from(cell)] {
                    Some(value) => Amount::Computed(value),
                    None => continue,
                },
            };
            out.push(Word { letter: word.letter, amount });
        }
    }

    /// Follows what a block commands.
    fn follow(
        &mut self,
        program: &Program,
        pc: usize,
        template: &Template,
        words: &[Word<N>],
    ) -> Result<(), Box<Fault>> {
        let source = &program.lines[template.source as usize];
        match self.state.follow(&program.options, template, source.skip, source.number, words) {
            Ok(Effect::None) => Ok(()),
            Ok(Effect::Ends) => {
                self.is_over = true;
                Ok(())
            }
            Err(message) => {
                let help = "write codes that call, return or wait for a signal as numbers";
                Err(Box::new(Fault::syntax(program.code.marks[pc], message, help)))
            }
        }
    }
}

/// Whether a letter's word moves an axis.
pub(super) fn is_axis(letter: u8) -> bool {
    matches!(letter, b'A'..=b'C' | b'U'..=b'Z')
}
