//! What is wrong with a macro program, or worth a look, with its place.

use std::borrow::Cow;
use std::fmt;

use crate::check::Severity;
use crate::formats::ReadError;
use crate::place::Place;

/// Why a program cannot be expanded, or not further.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct MacroError {
    /// A word for scripts; it keeps its meaning.
    pub code: &'static str,
    /// The rule broken, in words.
    pub message: String,
    /// Where.
    pub place: Place,
    /// What to do about it.
    pub help: Cow<'static, str>,
    /// The program it stands in, where that was loaded from beside the main one.
    pub program: Option<u32>,
}

impl fmt::Display for MacroError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(number) = self.program {
            write!(f, "in O{number:04}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for MacroError {}

impl From<MacroError> for ReadError {
    fn from(error: MacroError) -> Self {
        Self::Program { message: error.to_string(), place: error.place, help: error.help }
    }
}

/// Something found without or besides an end of the run.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Finding {
    /// Whether the program must not be expanded, or someone should look.
    pub severity: Severity,
    /// What and where.
    pub error: MacroError,
}

/// The code of a loop that does not run.
pub const NEVER_RUNS: &str = "loop-never-runs";

/// A stretch of one of a program's texts, in numbers alone.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(super) struct At {
    /// Which text.
    pub file: u16,
    /// Its first byte.
    pub start: u32,
    /// The byte behind it.
    pub end: u32,
}

/// A rule broken, before its place is shown.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub code: &'static str,
    pub message: String,
    pub at: At,
    pub help: Cow<'static, str>,
}

impl Fault {
    pub(super) fn new(
        code: &'static str,
        at: At,
        message: impl Into<String>,
        help: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self { code, message: message.into(), at, help: help.into() }
    }

    /// Text that belongs to nothing of the language.
    pub(super) fn syntax(at: At, message: impl Into<String>, help: impl Into<Cow<'static, str>>) -> Self {
        Self::new("macro-syntax", at, message, help)
    }
}
