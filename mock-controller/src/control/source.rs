//! The reader of the dialect in use.

use super::lines::LineReader;
use super::reader::{Read, Reader};
use super::settings::{LabelSkip, Torn};
use super::text::Text;
use crate::dialect::{Assembly, Dialect};
use crate::observer::Observer;

pub(super) enum Source {
    Blocks(Reader),
    Lines(LineReader),
}

/// The same call to whichever it is.
macro_rules! either {
    ($source:expr, $reader:ident => $call:expr) => {
        match $source {
            Source::Blocks($reader) => $call,
            Source::Lines($reader) => $call,
        }
    };
}

impl Source {
    pub(super) fn new(dialect: Dialect, label_skip: LabelSkip) -> Source {
        match Assembly::new(dialect) {
            Some(assembly) => Source::Blocks(Reader::new(assembly, label_skip)),
            None => Source::Lines(LineReader::new(label_skip)),
        }
    }

    pub(super) fn push(&mut self, c: u8, text: &mut Text, observer: &mut impl Observer) -> Read {
        either!(self, reader => reader.push(c, text, observer))
    }

    pub(super) fn characters(&self) -> usize {
        either!(self, reader => reader.characters())
    }

    pub(super) fn take_characters(&mut self) -> usize {
        either!(self, reader => reader.take_characters())
    }

    pub(super) fn torn(&self) -> u64 {
        either!(self, reader => reader.torn())
    }

    pub(super) fn skipped(&self) -> u64 {
        either!(self, reader => reader.skipped())
    }

    pub(super) fn is_after_end(&self) -> bool {
        either!(self, reader => reader.is_after_end())
    }

    pub(super) fn link_closed(&mut self, torn: Torn, text: &mut Text) {
        either!(self, reader => reader.link_closed(torn, text));
    }

    pub(super) fn reset(&mut self, text: &mut Text) {
        either!(self, reader => reader.reset(text));
    }

    /// Whether a stop word D has been passed since this was last asked.
    pub(super) fn take_pause(&mut self) -> bool {
        match self {
            Source::Blocks(reader) => reader.take_pause(),
            Source::Lines(_) => false,
        }
    }

    /// Whether the program ended with the line last told.
    pub(super) fn take_end(&mut self) -> bool {
        match self {
            Source::Blocks(_) => false,
            Source::Lines(reader) => reader.take_end(),
        }
    }
}
