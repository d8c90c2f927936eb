//! From characters to blocks: what a control makes of what it reads.
//!
//! ```text
//!   LABEL ──end of block, or a whole block──▶ BETWEEN ◀──complete── BLOCK     Z digit completes a block
//!     ▲                                       │ B N ─────────────────▲
//!     │                                       │ ; ( * ─▶ COMMENT ─▶ BETWEEN
//!     │  link opens, program ends             │ %   ─▶ PERCENT ── end of block ─▶ BETWEEN (leader) or LABEL (end)
//!     │                                       │ D   ─▶ STOP: D again is the end, anything else was a pause
//!     └── TAIL ◀── end by E or DD ────────────┘ anything else ─▶ DEAD (malformed)
//! ```
//!
//! White space is free. `%` is the end if a block has come since the link opened and since the last end; otherwise it is
//! a leader. So a sender that goes on after a broken link may send its leader again.
//!
//! Listings of CAM systems (domain/2) have the end point behind `;`, rows of `*`, header rows such as `Start Point = …`
//! before the first block, and `N  12:` in front of blocks and stop words: all of it is passed.
//!
//! Choices where the manuals are silent: `( )` is a comment; any other word between blocks is malformed; block numbers
//! are not looked at. A header is looked for where a label may stand, and in a row that begins with `S` before the first
//! block; a row that begins as a block and does not go on as one is no header.
//!
//! It does not decide when the alarm for a malformed block is raised: that is when the cutter gets there.

mod label;

use super::settings::{LabelSkip, Torn};
use super::text::Text;
use crate::dialect::Assembly;
use crate::dialect::four_b::{FourBlock, Step};
use crate::dialect::gcode::Line;
use crate::observer::Observer;

pub(crate) struct Reader {
    label_skip: LabelSkip,
    state: State,
    assembly: Assembly,
    /// Text since the last piece was taken as program.
    pending: Vec<u8>,
    /// Characters since the last block, as the buffer counts them.
    characters: usize,
    /// The label's first letters that are no white space, in case it is a stop word.
    word: Vec<u8>,
    /// Rows of a label or header read and discarded before the first block.
    rows: u64,
    /// The row of the label began as a block, and has gone on as one.
    is_block: bool,
    blocks_in_program: u64,
    blocks_on_link: u64,
    place: Place,
    torn: u64,
    skipped: u64,
    after_end: bool,
    /// A stop word D has been read since this was last asked.
    paused: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Label,
    Between,
    Block { kept: bool },
    Comment { until: u8 },
    Percent { ends: bool },
    Stop,
    Tail,
    Dead,
}

/// Line and column since the beginning, from 1, of what the reader has seen.
#[derive(Clone, Copy, Debug)]
struct Place {
    line: u64,
    column: u64,
}

/// What one more character completed.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) enum Read {
    Nothing,
    Block(FourBlock),
    /// In a dialect of lines.
    Line(Line),
    /// The program's end.
    End,
    /// What was found, and where.
    Malformed(String),
}

impl Reader {
    pub(crate) fn new(assembly: Assembly, label_skip: LabelSkip) -> Self {
        Reader {
            label_skip,
            state: if label_skip == LabelSkip::Off { State::Between } else { State::Label },
            assembly,
            pending: Vec::new(),
            characters: 0,
            word: Vec::new(),
            rows: 0,
            is_block: true,
            blocks_in_program: 0,
            blocks_on_link: 0,
            place: Place { line: 1, column: 0 },
            torn: 0,
            skipped: 0,
            after_end: false,
            paused: false,
        }
    }

    /// Characters read that belong to no complete block yet.
    pub(crate) fn characters(&self) -> usize {
        self.characters
    }

    /// As [`Reader::characters`], which begin again at 0.
    pub(crate) fn take_characters(&mut self) -> usize {
        std::mem::take(&mut self.characters)
    }

    /// Unfinished blocks dropped because the link closed.
    pub(crate) fn torn(&self) -> u64 {
        self.torn
    }

    /// Characters label skip discarded.
    pub(crate) fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Whether the last thing read was a program's end, trailers aside.
    pub(crate) fn is_after_end(&self) -> bool {
        self.after_end
    }

    /// Whether a stop word D has been passed since this was last asked.
    pub(crate) fn take_pause(&mut self) -> bool {
        std::mem::take(&mut self.paused)
    }

    /// The link has closed: an unfinished block is dropped or kept.
    pub(crate) fn link_closed(&mut self, torn: Torn, text: &mut Text) {
        self.blocks_on_link = 0;
        if self.state == State::Dead {
            return;
        }
        if self.assembly.is_partial() {
            match torn {
                Torn::Drop => self.torn += 1,
                Torn::Keep => {
                    self.state = State::Block { kept: true };
                    return;
                }
            }
        }
        self.clear(text);
    }

    /// The control is reset: nothing is kept.
    pub(crate) fn reset(&mut self, text: &mut Text) {
        self.blocks_on_link = 0;
        self.clear(text);
    }

    fn clear(&mut self, text: &mut Text) {
        self.assembly.clear();
        self.pending.clear();
        self.characters = 0;
        self.begin_label(text);
    }

    fn begin_label(&mut self, text: &mut Text) {
        text.break_line();
        self.begin_row();
        self.rows = 0;
        self.state = if self.label_skip == LabelSkip::Off { State::Between } else { State::Label };
    }

    /// Takes one character; bit 8 is already clear, NUL already gone.
    pub(crate) fn push(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        if c == b'\r' {
            return self.carriage_return(text, observer);
        }
        if c == b'\n' {
            self.place = Place { line: self.place.line + 1, column: 0 };
        } else {
            self.place.column += 1;
        }
        self.characters += 1;
        self.take(c, text, observer)
    }

    /// CR is ignored; but where it stands alone as the end of block ("in use: LF, CR LF, CR, LF CR …", domain/4), it ends
    /// a label, a comment and a `%` line as LF would. The text takes several line ends in a row as one.
    fn carriage_return(&mut self, text: &mut Text, observer: &mut impl Observer) -> Read {
        let in_block = matches!(self.state, State::Block { .. } | State::Dead) || self.assembly.is_partial();
        if in_block { Read::Nothing } else { self.take(b'\n', text, observer) }
    }

    fn take(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        match self.state {
            State::Label => self.label(c, text, observer),
            State::Between => self.between(c, text, observer),
            State::Block { kept } => self.block(c, kept, text, observer),
            State::Comment { until } => {
                self.pending.push(c);
                // It is read past and takes no room.
                self.characters = self.characters.saturating_sub(1);
                let ends = c == until || c == b'\n';
                if ends || self.pending.len() >= PIECE {
                    self.accept(text, observer);
                }
                if ends {
                    self.state = self.after_comment();
                }
                Read::Nothing
            }
            State::Percent { ends } => {
                self.characters = 0;
                match (c, ends) {
                    (b'\n', true) => self.begin_label(text),
                    (b'\n', false) => self.state = State::Between,
                    // The line of a `%` is neither program nor of interest.
                    _ => {}
                }
                Read::Nothing
            }
            State::Stop => {
                if c.eq_ignore_ascii_case(&b'D') {
                    self.pending.push(c);
                    self.accept(text, observer);
                    self.state = State::Tail;
                    return self.end(text);
                }
                // A single D is a pause. It is passed, but told.
                self.paused = true;
                self.accept(text, observer);
                self.state = State::Between;
                self.between(c, text, observer)
            }
            State::Tail => self.tail(c, text, observer),
            State::Dead => Read::Nothing,
        }
    }

    fn between(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        match c.to_ascii_uppercase() {
            b'%' => {
                let ends = self.blocks_in_program > 0 && self.blocks_on_link > 0;
                self.pending.clear();
                let read = if ends { self.end(text) } else { Read::Nothing };
                self.characters = 0;
                self.state = State::Percent { ends };
                return read;
            }
            DC4 if self.blocks_in_program > 0 => return self.end(text),
            // "DC2, data, DC4" frames a transfer (domain/4, punch side); without a block in between it means nothing.
            DC2 | DC4 => {
                self.characters = self.characters.saturating_sub(1);
                return Read::Nothing;
            }
            _ => {}
        }
        self.pending.push(c);
        match c.to_ascii_uppercase() {
            b'\n' => {
                self.accept(text, observer);
                // Line ends in a row take the room of one.
                self.characters = 1;
            }
            space if space.is_ascii_whitespace() => {}
            b'D' => self.state = State::Stop,
            b'E' => {
                self.accept(text, observer);
                self.state = State::Tail;
                return self.end(text);
            }
            b';' => self.comment(b'\n'),
            b'*' => {
                self.rows += u64::from(self.takes_headers());
                self.comment(b'\n');
            }
            b'(' => self.comment(b')'),
            b'S' if self.takes_headers() => {
                self.begin_row();
                self.state = State::Label;
            }
            _ => {
                self.after_end = false;
                self.state = State::Block { kept: false };
                return self.assemble(c, text, observer);
            }
        }
        Read::Nothing
    }

    fn comment(&mut self, until: u8) {
        self.characters = self.characters.saturating_sub(1);
        self.state = State::Comment { until };
    }

    fn block(&mut self, c: u8, kept: bool, text: &mut Text, observer: &mut impl Observer) -> Read {
        if kept && c == b'%' {
            self.torn += 1;
            self.assembly.clear();
            self.pending.clear();
            self.characters = 0;
            self.state = State::Percent { ends: false };
            return Read::Nothing;
        }
        if self.assembly.is_number_alone() && matches!(c, b'D' | b'd' | b'E' | b'e') {
            // A stop word may be numbered as a block is: `N  16: DD`.
            self.assembly.clear();
            self.state = State::Between;
            return self.between(c, text, observer);
        }
        self.pending.push(c);
        self.assemble(c, text, observer)
    }

    fn assemble(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        match self.assembly.push(c) {
            Step::More => Read::Nothing,
            Step::Complete(block) => self.block_complete(block, text, observer),
            Step::Wrong { expected } => self.malformed(c, expected),
        }
    }

    fn malformed(&mut self, c: u8, expected: &'static str) -> Read {
        self.state = State::Dead;
        let Place { line, column } = self.place;
        let found = char::from(c);
        Read::Malformed(format!("line {line}, column {column}: expected {expected}, found {found:?}"))
    }

    fn block_complete(&mut self, block: FourBlock, text: &mut Text, observer: &mut impl Observer) -> Read {
        self.accept(text, observer);
        self.blocks_in_program += 1;
        self.blocks_on_link += 1;
        self.after_end = false;
        self.state = State::Between;
        Read::Block(block)
    }

    /// After a stop word: its line may still end.
    fn tail(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        if c == b'\n' {
            self.pending.push(c);
            self.accept(text, observer);
            self.characters = 0;
            self.begin_label(text);
            return Read::Nothing;
        }
        if c.is_ascii_whitespace() {
            return Read::Nothing;
        }
        self.begin_label(text);
        match self.state {
            State::Between => self.between(c, text, observer),
            State::Label
            | State::Block { .. }
            | State::Comment { .. }
            | State::Percent { .. }
            | State::Stop
            | State::Tail
            | State::Dead => self.label(c, text, observer),
        }
    }

    /// The program's end has been read.
    fn end(&mut self, text: &mut Text) -> Read {
        if self.state != State::Tail {
            self.begin_label(text);
        }
        self.blocks_in_program = 0;
        self.blocks_on_link = 0;
        self.rows = 0;
        self.after_end = true;
        Read::End
    }

    fn accept(&mut self, text: &mut Text, observer: &mut impl Observer) {
        text.put(&self.pending, observer);
        self.pending.clear();
    }
}

/// A comment is digested in pieces: it may be of any length.
const PIECE: usize = 4096;

const DC2: u8 = 0x12;
const DC4: u8 = 0x14;
