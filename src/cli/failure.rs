//! What a person reads when a command fails, and the exit code that says whose turn it is.

use std::fmt::{self, Display};
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents,
    SourceCode, SourceSpan, SpanContents,
};

use crate::formats::ReadError;
use crate::journal::writer::JournalError;
use crate::keys::KeyError;
use crate::link::LinkError;
use crate::place::Place;
use crate::program::ProgramError;
use crate::shapes::cycloid_gear::Impossible;

/// The exit codes of the command line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[repr(u8)]
pub(super) enum Exit {
    /// A failure of ours or the system's.
    Ours = 1,
    /// Wrong usage.
    Usage = 2,
    /// The program, drawing or part is at fault.
    Program = 3,
    /// The machine profile is.
    Profile = 4,
    /// The link failed or is busy.
    Link = 5,
    /// The control refused or alarmed.
    Control = 6,
    /// Stopped by the operator, resumable.
    Stopped = 7,
    /// A check found warnings only.
    Warnings = 8,
}

/// A command that did not do what it was asked.
#[derive(Debug)]
pub(super) struct Failure {
    exit: Option<Exit>,
    /// What stands before the message, `error:` if nothing else is said.
    word: Option<String>,
    message: String,
    place: Option<(String, Place)>,
    help: Option<String>,
    /// A command line that goes on from here.
    resume: Option<String>,
}

impl Failure {
    pub(super) fn new(exit: Exit, message: impl Into<String>) -> Self {
        Self { exit: Some(exit), word: None, message: message.into(), place: None, help: None, resume: None }
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub(super) fn at(mut self, file: &str, place: Place) -> Self {
        self.place = Some((file.to_owned(), place));
        self
    }

    /// An exit code whose reasons have been told already.
    pub(super) fn told(exit: Exit) -> Self {
        Self::silent(Some(exit))
    }

    fn silent(exit: Option<Exit>) -> Self {
        Self { exit, word: None, message: String::new(), place: None, help: None, resume: None }
    }

    /// Says what it is instead of `error:`, such as `warning[no-end]:`.
    pub(super) fn called(mut self, word: String) -> Self {
        self.word = Some(word);
        self
    }

    /// Puts words before the message.
    pub(super) fn prefix(&mut self, words: &str) {
        self.message = format!("{words}: {}", self.message);
    }

    pub(super) fn resume_with(mut self, command: Option<String>) -> Self {
        self.resume = command;
        self
    }

    /// From a failed write to standard output: a closed pipe is no failure.
    pub(super) fn output(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Self::silent(None);
        }
        Self::new(Exit::Ours, format!("cannot write to standard output: {error}"))
    }

    pub(super) fn keys(exit: Exit, file: &str, error: KeyError) -> Self {
        let failure = Self::new(exit, error.message).at(file, error.place);
        match error.help {
            Some(help) => failure.help(help),
            None => failure,
        }
    }

    pub(super) fn read(file: &str, error: ReadError) -> Self {
        match error {
            ReadError::Io(error) => Self::new(Exit::Program, format!("{file}: {error}")),
            ReadError::Program { message, place, help } => {
                Self::new(Exit::Program, message).at(file, place).help(help)
            }
        }
    }

    pub(super) fn program(file: &str, error: ProgramError) -> Self {
        match error {
            ProgramError::Read(error) => Self::read(file, error),
            ProgramError::Write(error) => Self::new(Exit::Program, error.message).help(error.help),
        }
    }

    pub(super) fn gear(error: &Impossible) -> Self {
        Self::new(Exit::Program, error.to_string()).help(error.help())
    }

    pub(super) fn link(error: &LinkError) -> Self {
        Self::new(Exit::Link, error.to_string()).help(error.help())
    }

    pub(super) fn journal(error: &JournalError) -> Self {
        let help = match error {
            JournalError::Io { .. } => {
                "nothing was sent; make room or name another directory with --journal DIR"
            }
            JournalError::InUse { .. } => {
                "wait for the other dripfeed to end, or look at it with `dripfeed jobs`"
            }
            JournalError::Unreadable { .. } => {
                "start the job again with `dripfeed send`; the journal is left as it is"
            }
        };
        Self::new(Exit::Ours, error.to_string()).help(help)
    }

    /// Prints the failure and returns its exit code.
    pub(super) fn report(&self) -> ExitCode {
        let Some(exit) = self.exit else { return ExitCode::SUCCESS };
        if self.message.is_empty() {
            return ExitCode::from(exit as u8);
        }
        let mut error = io::stderr().lock();
        // Nobody is left to tell when standard error is closed too.
        let _ = error.write_all(self.render().as_bytes());
        ExitCode::from(exit as u8)
    }

    /// The failure as a person reads it.
    pub(super) fn render(&self) -> String {
        let mut theme = if io::stderr().is_terminal() {
            GraphicalTheme::unicode()
        } else {
            GraphicalTheme::unicode_nocolor()
        };
        theme.characters.error = self.word.clone().unwrap_or_else(|| "error:".to_owned());
        let handler = GraphicalReportHandler::new_themed(theme).with_wrap_lines(false).with_context_lines(0);
        let mut text = String::new();
        // Writing into a string cannot fail.
        let _ = handler.render_report(&mut text, self);
        let mut text = text.trim_start().to_owned();
        if let Some(resume) = &self.resume {
            text.push_str(&format!("to go on: {resume}\n"));
        }
        text
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

impl Diagnostic for Failure {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place.as_ref().map(|_| self as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let (_, place) = self.place.as_ref()?;
        let span = LabeledSpan::underline((place.caret, place.width));
        Some(Box::new(std::iter::once(span)))
    }
}

/// The excerpt of the place, numbered as in the file it comes from.
impl SourceCode for Failure {
    fn read_span<'a>(
        &'a self,
        _span: &SourceSpan,
        _before: usize,
        _after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let Some((file, place)) = &self.place else { return Err(MietteError::OutOfBounds) };
        Ok(Box::new(MietteSpanContents::new_named(
            file.clone(),
            place.excerpt.as_bytes(),
            SourceSpan::from((0, place.excerpt.len())),
            place.line as usize - 1,
            place.column as usize - 1,
            1,
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_without_permission_is_answered_word_for_word() {
        let error = io::Error::from(io::ErrorKind::PermissionDenied);
        let failure = Failure::link(&LinkError::from_open("/dev/ttyUSB0", error));
        assert_eq!(failure.exit, Some(Exit::Link));
        assert_eq!(failure.render(), include_str!("../../tests/golden/faults/port-denied.txt"));
    }
}
