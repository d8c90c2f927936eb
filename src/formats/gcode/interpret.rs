//! A G-code program as motions, one at a time.

use std::collections::VecDeque;
use std::io::{Read, Seek};

use super::dialect::{Code, Dialect};
use super::machine::{Flow, Machine};
use super::subprograms::{Body, Library, opens};
use super::words::Kind;
use crate::formats::ReadError;
use crate::formats::lines::{Line, Lines};
use crate::motion::{Act, Motion, Stop};
use crate::place::Place;

/// Reads a program: an iterator of what it says. Ends after the first error.
#[derive(Debug)]
pub struct Motions<R> {
    lines: Lines<R>,
    machine: Machine,
    library: Library,
    calls: Vec<Call>,
    /// Subprograms that have been called.
    called: Vec<u32>,
    /// Blocks of the main program so far.
    block: u64,
    state: State,
    /// Where an error ended the reading.
    failed_in: Option<State>,
    ready: VecDeque<Motion>,
}

/// A subprogram in work.
#[derive(Debug)]
struct Call {
    label: u32,
    repeats_left: u32,
    /// Where in its text the next line begins.
    at: usize,
    line: u64,
    block: u64,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum State {
    Running,
    /// Behind the end: subprograms stand there, and `%`.
    Behind {
        in_body: bool,
    },
    Done,
}

/// How deep subprograms may call one another.
pub const CALLS_MAX: usize = 8;

impl<R: Read> Motions<R> {
    /// Reads a source once, from its start. A call of a subprogram is an error.
    pub fn new(source: R, dialect: Dialect) -> Self {
        Self::with_library(source, dialect, Library::default())
    }

    /// Reads a source once, with subprograms found before.
    pub fn with_library(source: R, dialect: Dialect, library: Library) -> Self {
        Self {
            lines: Lines::new(source),
            machine: Machine::new(dialect),
            library,
            calls: Vec::new(),
            called: Vec::new(),
            block: 0,
            state: State::Running,
            failed_in: None,
            ready: VecDeque::new(),
        }
    }
}

impl<R: Read + Seek> Motions<R> {
    /// Reads a source twice: first for its subprograms.
    ///
    /// # Errors
    ///
    /// As [`Library::index`].
    pub fn of_file(mut source: R, dialect: Dialect) -> Result<Self, ReadError> {
        let library = Library::index(&mut source, &dialect)?;
        Ok(Self::with_library(source, dialect, library))
    }
}

impl<R: Read> Iterator for Motions<R> {
    type Item = Result<Motion, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(motion) = self.ready.pop_front() {
                return Some(Ok(motion));
            }
            let more = match self.state {
                State::Done => return None,
                State::Running if self.calls.is_empty() => self.main_line(),
                State::Running => self.subprogram_line(),
                State::Behind { in_body } => self.line_behind(in_body),
            };
            match more {
                Ok(true) => {}
                Ok(false) => self.state = State::Done,
                Err(error) => {
                    // What the faulty block said before the fault is not executed.
                    self.ready.clear();
                    self.failed_in = matches!(error, ReadError::Program { .. }).then_some(self.state);
                    self.state = State::Done;
                    return Some(Err(error));
                }
            }
        }
    }
}

impl<R: Read> Motions<R> {
    /// The subprograms that have been called so far.
    #[must_use]
    pub fn called(&self) -> &[u32] {
        &self.called
    }

    /// Goes on behind an error, at the next line and as if the faulty block were not there; false where that cannot be.
    pub fn go_on(&mut self) -> bool {
        match self.failed_in.take() {
            Some(state) => {
                self.state = state;
                true
            }
            None => false,
        }
    }

    /// The next line as it stands, and whether it is a block: executed for what may be wrong with it alone, its motions
    /// thrown away and subprograms not gone into. None at the end of the source.
    ///
    /// # Errors
    ///
    /// As the iterator's.
    pub fn next_line(&mut self) -> Result<Option<(Line<'_>, bool)>, ReadError> {
        let before = self.block;
        let more = match self.state {
            State::Done => false,
            State::Running => self.main_line()?,
            State::Behind { in_body } => self.line_behind(in_body)?,
        };
        self.ready.clear();
        self.calls.clear();
        Ok(more.then(|| (self.lines.line(), self.block > before)))
    }

    /// Executes the next line of the main program; false at the end of the source.
    fn main_line(&mut self) -> Result<bool, ReadError> {
        let Some(line) = self.lines.next_line()? else { return Ok(false) };
        let (counted, flow) = self.machine.run(line, self.block, &mut self.ready)?;
        self.block += u64::from(counted);
        match flow {
            Flow::On => {}
            Flow::Call { label, repeats, place } => self.call(label, repeats, place)?,
            Flow::Return(place) if self.machine.dialect.return_ends => {
                self.ready.push_back(Motion {
                    act: Act::Stop(Stop::End),
                    block: self.block,
                    spot: place.spot(),
                });
                self.state = State::Behind { in_body: false };
            }
            Flow::Return(place) => {
                return Err(ReadError::Program {
                    message: "M99 outside of a subprogram".into(),
                    place,
                    help: "a program ends with M02 or M30".into(),
                });
            }
            Flow::End => self.state = State::Behind { in_body: false },
        }
        Ok(true)
    }

    fn call(&mut self, label: u32, repeats: u32, place: Place) -> Result<(), ReadError> {
        let refused = |message: String, help: &'static str| {
            Err(ReadError::Program { message, place: place.clone(), help: help.into() })
        };
        if self.calls.len() >= CALLS_MAX {
            return refused(
                format!("subprograms call one another more than {CALLS_MAX} deep"),
                "write the inner ones out",
            );
        }
        let Some(body) = self.library.body(label) else {
            return refused(
                format!("subprogram {label} is not in the program"),
                "it stands in the same file, behind the end of the main program; what is piped in cannot call one",
            );
        };
        self.calls.push(Call::start(label, repeats - 1, body));
        if let Err(at) = self.called.binary_search(&label) {
            self.called.insert(at, label);
        }
        Ok(())
    }

    /// Executes the next line of the subprogram in work.
    fn subprogram_line(&mut self) -> Result<bool, ReadError> {
        let Some(call) = self.calls.last_mut() else { return Ok(true) };
        let Some(body) = self.library.body(call.label) else { return Ok(false) };
        let Some(line) = call.next_line(body) else {
            // A body is held as far as its M99; past it nothing stands.
            self.calls.pop();
            return Ok(true);
        };
        let opens = line.byte == body.spot.byte;
        let (counted, flow) = self.machine.run(line, call.block, &mut self.ready)?;
        if opens && matches!(self.ready.front(), Some(Motion { act: Act::Header(_), .. })) {
            // The label was for the call; the blocks now stand in its place.
            self.ready.pop_front();
        }
        call.block += u64::from(counted);
        match flow {
            Flow::On => {}
            Flow::Call { label, repeats, place } => self.call(label, repeats, place)?,
            Flow::Return(_) if call.repeats_left > 0 => {
                *call = Call::start(call.label, call.repeats_left - 1, body)
            }
            Flow::Return(_) => {
                self.calls.pop();
            }
            Flow::End => {
                self.calls.clear();
                self.state = State::Behind { in_body: false };
            }
        }
        Ok(true)
    }

    /// Passes over a line behind the end of the main program.
    fn line_behind(&mut self, in_body: bool) -> Result<bool, ReadError> {
        let Some(line) = self.lines.next_line()? else { return Ok(false) };
        let (words, counted) = self.machine.cut(&line)?;
        let words = words.to_vec();
        self.block += u64::from(counted);
        let label = opens(&words, &self.machine.dialect, !in_body);
        if let Some(label) = label
            && self.called.binary_search(&label).is_err()
        {
            // Nothing calls it: it is told, not executed.
            let text = words.first().map_or(&b""[..], |w| w.text(line.bytes));
            self.ready.push_back(Motion {
                act: Act::Unknown(text.into()),
                block: self.block,
                spot: line.spot(0),
            });
        }
        let in_body = in_body || label.is_some();
        if !in_body {
            if counted {
                return Err(ReadError::Program {
                    message: "a block behind the end of the program".into(),
                    place: line.place(0, line.bytes.len()),
                    help: "take it out, or give it the label of a subprogram".into(),
                });
            }
            for word in &words {
                let text = word.text(line.bytes).into();
                let act = if word.kind == Kind::Comment { Act::Comment(text) } else { Act::Header(text) };
                self.ready.push_back(Motion { act, block: self.block, spot: line.spot(word.at as usize) });
            }
        }
        let dialect = &self.machine.dialect;
        let ends =
            words.iter().any(|w| w.letter == b'M' && matches!(dialect.m_code(w), Code::Return | Code::End));
        self.state = State::Behind { in_body: in_body && !ends };
        Ok(true)
    }
}

impl Call {
    fn start(label: u32, repeats_left: u32, body: &Body) -> Self {
        Self { label, repeats_left, at: 0, line: body.spot.line, block: body.blocks_before }
    }

    /// The next line of the body, cut as [`Lines`] cuts.
    fn next_line<'b>(&mut self, body: &'b Body) -> Option<Line<'b>> {
        let rest = body.text.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        let end = if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
        let number = self.line;
        let byte = body.spot.byte + self.at as u64;
        self.at += length + end;
        self.line += 1;
        Some(Line { bytes: &rest[..length], number, byte })
    }
}
