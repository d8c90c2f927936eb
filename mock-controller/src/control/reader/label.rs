//! What stands before the first block: a label that is skipped, and the header rows of a listing.
//!
//! A row is looked at for a whole block, since a program may begin without a label. What is neither label, header, stop
//! word nor block is malformed, but for the first row, which a control skips whatever it is ("label skip", domain/4).

use super::{DC4, Read, Reader, State};
use crate::control::settings::LabelSkip;
use crate::control::text::Text;
use crate::dialect::four_b::Step;
use crate::observer::Observer;

impl Reader {
    /// Whether header rows may still come.
    pub(super) fn takes_headers(&self) -> bool {
        self.label_skip == LabelSkip::Auto && self.blocks_in_program == 0
    }

    /// Where a comment leads back to.
    pub(super) fn after_comment(&mut self) -> State {
        if self.rows > 0 && self.takes_headers() {
            self.begin_row();
            return State::Label;
        }
        State::Between
    }

    pub(super) fn begin_row(&mut self) {
        self.word.clear();
        self.is_block = true;
    }

    /// Before the first block.
    pub(super) fn label(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        match c {
            b'\n' => return self.label_ends(text, observer),
            DC4 if self.blocks_in_program > 0 => return self.end(text),
            DC4 => {
                self.characters = 0;
                return Read::Nothing;
            }
            b'%' if !self.assembly.is_partial() => {
                self.skip_pending();
                self.state = State::Percent { ends: false };
                return Read::Nothing;
            }
            b';' | b'*' | b'(' if self.rows > 0 && self.word.is_empty() => {
                return self.between(c, text, observer);
            }
            _ => {}
        }
        if self.assembly.is_number_alone() && matches!(c, b'D' | b'd' | b'E' | b'e') {
            self.assembly.clear();
            self.word.clear();
        }
        if !c.is_ascii_whitespace() && self.word.len() < 3 {
            self.word.push(c.to_ascii_uppercase());
        }
        self.pending.push(c);
        if self.label_skip == LabelSkip::On {
            return Read::Nothing;
        }
        // One letter alone is no block begun: `Begin`, `Name` are words.
        let was_begun = self.is_block && self.assembly.is_begun() && self.word.len() > 2;
        match self.assembly.push(c) {
            Step::More => {
                if !self.assembly.is_partial() {
                    self.skip_pending_but(0);
                }
                Read::Nothing
            }
            Step::Complete(block) => self.block_complete(block, text, observer),
            Step::Wrong { expected } if was_begun && self.rows > 0 => self.malformed(c, expected),
            Step::Wrong { .. } => {
                self.is_block = false;
                // This character may itself begin a block.
                let begins = self.assembly.push(c) == Step::More && self.assembly.is_partial();
                self.skip_pending_but(usize::from(begins));
                Read::Nothing
            }
        }
    }

    fn label_ends(&mut self, text: &mut Text, observer: &mut impl Observer) -> Read {
        let is_word =
            self.label_skip == LabelSkip::Auto && matches!(self.word.as_slice(), b"D" | b"DD" | b"E");
        if is_word {
            let pauses = self.word == b"D";
            self.paused |= pauses;
            self.skipped = self.skipped.saturating_sub(self.word.len() as u64);
            self.pending.clone_from(&self.word);
            self.pending.push(b'\n');
            self.accept(text, observer);
            self.state = State::Between;
            return if pauses { Read::Nothing } else { self.end(text) };
        }
        if self.assembly.is_begun() && (self.is_block || self.rows == 0) {
            // A block may run over a line end: white space is free.
            self.pending.push(b'\n');
            self.state = State::Block { kept: false };
            return Read::Nothing;
        }
        self.assembly.clear();
        self.skip_pending();
        self.rows += 1;
        self.begin_row();
        self.state = if self.takes_headers() { State::Label } else { State::Between };
        Read::Nothing
    }

    pub(super) fn skip_pending(&mut self) {
        self.skip_pending_but(0);
        self.characters = 0;
    }

    /// Discards the label's text but for its last `keep` characters.
    pub(super) fn skip_pending_but(&mut self, keep: usize) {
        let discarded = self.pending.len().saturating_sub(keep);
        self.skipped +=
            self.pending[..discarded].iter().filter(|byte| !byte.is_ascii_whitespace()).count() as u64;
        self.pending.drain(..discarded);
        self.characters = keep;
    }
}
