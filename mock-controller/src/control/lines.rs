//! From characters to lines of G-code: what a control makes of what it reads.
//!
//! ```text
//!   LABEL ──end of block──▶ BODY ──% or DC4──▶ LABEL     a % before the first line is a leader
//!                            │ M02, M30 ─▶ LABEL         unless the program calls subprograms, which stand behind it
//!                            │ no words ─▶ DEAD (malformed)
//! ```
//!
//! As in the other dialects `%` is the end if a line has come since the link opened and since the last end.
//!
//! Choices where the manuals are silent: the first line is discarded by label skip `auto` only if it is no line of words;
//! CR ends a line as LF does, and empty lines are nothing. Comments take no room in the buffer.

use super::reader::Read;
use super::settings::{LabelSkip, Torn};
use super::text::Text;
use crate::dialect::gcode::{Line, parse_line};
use crate::observer::Observer;

pub(crate) struct LineReader {
    label_skip: LabelSkip,
    state: State,
    pending: Vec<u8>,
    characters: usize,
    lines_in_program: u64,
    lines_on_link: u64,
    /// The program calls subprograms: they follow its M02.
    calls: bool,
    /// What is pending was kept from a link that closed.
    kept: bool,
    /// Inside a comment, until this.
    comment: Option<u8>,
    place: u64,
    torn: u64,
    skipped: u64,
    after_end: bool,
    ended: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Label,
    Body,
    Percent { ends: bool },
    Dead,
}

impl LineReader {
    pub(crate) fn new(label_skip: LabelSkip) -> LineReader {
        LineReader {
            label_skip,
            state: first_state(label_skip),
            pending: Vec::new(),
            characters: 0,
            lines_in_program: 0,
            lines_on_link: 0,
            calls: false,
            kept: false,
            comment: None,
            place: 1,
            torn: 0,
            skipped: 0,
            after_end: false,
            ended: false,
        }
    }

    pub(crate) fn characters(&self) -> usize {
        self.characters
    }

    pub(crate) fn take_characters(&mut self) -> usize {
        std::mem::take(&mut self.characters)
    }

    pub(crate) fn torn(&self) -> u64 {
        self.torn
    }

    pub(crate) fn skipped(&self) -> u64 {
        self.skipped
    }

    pub(crate) fn is_after_end(&self) -> bool {
        self.after_end
    }

    /// Whether the last line told was the program's last, M02 or M30; asked once.
    pub(crate) fn take_end(&mut self) -> bool {
        std::mem::take(&mut self.ended)
    }

    pub(crate) fn link_closed(&mut self, torn: Torn, text: &mut Text) {
        self.lines_on_link = 0;
        if self.state == State::Dead {
            return;
        }
        if !is_blank(&self.pending) {
            match torn {
                Torn::Drop => self.torn += 1,
                Torn::Keep => {
                    self.kept = true;
                    return;
                }
            }
        }
        self.clear(text);
    }

    pub(crate) fn reset(&mut self, text: &mut Text) {
        self.lines_on_link = 0;
        self.clear(text);
    }

    fn clear(&mut self, text: &mut Text) {
        self.pending.clear();
        self.kept = false;
        self.comment = None;
        self.characters = 0;
        text.break_line();
        self.state = first_state(self.label_skip);
    }

    /// Takes one character; bit 8 is already clear, NUL already gone.
    pub(crate) fn push(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        let c = if c == b'\r' { b'\n' } else { c };
        self.characters += 1;
        match (self.state, c) {
            (State::Dead, _) => return Read::Nothing,
            (State::Percent { ends }, b'\n') => {
                self.characters = 0;
                self.place += 1;
                self.state = if ends { first_state(self.label_skip) } else { State::Body };
                return Read::Nothing;
            }
            (State::Percent { .. }, _) | (_, DC2) => {
                self.characters -= 1;
                return Read::Nothing;
            }
            (State::Label | State::Body, b'%') if is_blank(&self.pending) || self.kept => {
                self.torn += u64::from(self.kept);
                return self.percent(text);
            }
            (State::Label | State::Body, DC4) => {
                self.characters -= 1;
                if self.lines_in_program == 0 {
                    return Read::Nothing;
                }
                // An unfinished last line is a line.
                let read = if is_blank(&self.pending) { Read::Nothing } else { self.line(text, observer) };
                self.state = first_state(self.label_skip);
                return match read {
                    Read::Nothing => self.end(),
                    Read::Line(_) => {
                        self.ended = true;
                        self.end();
                        read
                    }
                    Read::Block(_) | Read::End | Read::Malformed(_) => read,
                };
            }
            (State::Label | State::Body, _) => {}
        }
        self.pending.push(c);
        if c == b'\n' {
            return self.line(text, observer);
        }
        if self.pending.len() > LINE_MAX {
            self.state = State::Dead;
            return Read::Malformed(format!("line {}: more than {LINE_MAX} characters", self.place));
        }
        self.pass_comment(c);
        Read::Nothing
    }

    /// A comment is read past and takes no room in the buffer.
    fn pass_comment(&mut self, c: u8) {
        let inside = self.comment;
        match (inside, c) {
            (None, b'(') => self.comment = Some(b')'),
            (None, b';') => self.comment = Some(b'\n'),
            (Some(until), _) if c == until => self.comment = None,
            _ => {}
        }
        if inside.is_some() || self.comment.is_some() {
            self.characters -= 1;
        }
    }

    fn percent(&mut self, text: &mut Text) -> Read {
        let ends = self.lines_in_program > 0 && self.lines_on_link > 0;
        self.pending.clear();
        self.kept = false;
        self.comment = None;
        self.characters = 0;
        self.state = State::Percent { ends };
        if !ends {
            return Read::Nothing;
        }
        text.break_line();
        self.end()
    }

    /// A line is complete.
    fn line(&mut self, text: &mut Text, observer: &mut impl Observer) -> Read {
        let is_label = self.state == State::Label;
        let written = String::from_utf8_lossy(&self.pending).into_owned();
        let parsed = parse_line(written.trim_end(), self.place);
        let ends_line = written.ends_with('\n');
        self.place += u64::from(ends_line);
        self.kept = false;
        self.comment = None;
        let skips = is_label
            && match self.label_skip {
                LabelSkip::Auto => parsed.is_err(),
                LabelSkip::On => true,
                LabelSkip::Off => false,
            };
        self.state = State::Body;
        if skips {
            let discarded = self.pending.iter().filter(|byte| !byte.is_ascii_whitespace()).count();
            self.skipped += discarded as u64;
            self.pending.clear();
            self.characters = 0;
            return Read::Nothing;
        }
        match parsed {
            Ok(line) => {
                text.put(&self.pending, observer);
                self.pending.clear();
                if line.words.is_empty() {
                    // A line without words is no program yet: what follows may still be the label. It takes no room.
                    self.characters = 0;
                    self.state = if is_label { State::Label } else { State::Body };
                    return Read::Nothing;
                }
                self.words(&line, text);
                Read::Line(line)
            }
            Err(error) => {
                self.state = State::Dead;
                Read::Malformed(format!("line {}, {error}", self.place - u64::from(ends_line)))
            }
        }
    }

    /// Sees where the program ends.
    fn words(&mut self, line: &Line, text: &mut Text) {
        self.lines_in_program += 1;
        self.lines_on_link += 1;
        self.after_end = false;
        let says =
            |code| line.words.iter().any(|word| word.letter == 'M' && word.number.whole() == Some(code));
        self.calls |= says(98);
        if !self.calls && (says(2) || says(30)) {
            self.ended = true;
            self.end();
            text.break_line();
            self.state = first_state(self.label_skip);
        }
    }

    fn end(&mut self) -> Read {
        self.lines_in_program = 0;
        self.lines_on_link = 0;
        self.calls = false;
        self.after_end = true;
        Read::End
    }
}

fn first_state(label_skip: LabelSkip) -> State {
    if label_skip == LabelSkip::Off { State::Body } else { State::Label }
}

fn is_blank(text: &[u8]) -> bool {
    text.iter().all(u8::is_ascii_whitespace)
}

/// A line of more characters, comments included, is no line. A guess; it bounds the memory.
const LINE_MAX: usize = 65_536;

const DC2: u8 = 0x12;
const DC4: u8 = 0x14;
