//! SOURCE: what a word on the command line stands for, checked before the first byte goes anywhere.
//!
//! A file is read twice: checked whole, then fed with its size, time and digest verified on the way. A part is checked
//! for syntax and parameters. A stream (`-`, a FIFO) can be read only once, so its faults come to light as it is fed, each
//! before its block is offered.

mod reading;

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::connection::{self, LineOptions};
use super::dialects;
use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::macros::{MacroOptions, MacroProgram, line_of};
use crate::formats::gcode::{Dialect, Library, Motions};
use crate::journal::history::History;
use crate::journal::resume;
use crate::motion::{Act, Motion};
use crate::part::file::PartFile;
use crate::part::{Format, Prepared};
use crate::profile::Profile;
use crate::program::verbatim::{FourB, Gcode};
use crate::program::{self, Counted, Line, Program, Segment, Segments};
use reading::{Hashing, Later, Shared, Stamp, Verified};

/// A checked source.
#[derive(Debug)]
pub(super) struct Source {
    /// As it was named, made absolute.
    pub(super) path: String,
    pub(super) kind: Kind,
    /// What G-code is read in.
    dialect: Option<Dialect>,
    /// Digest of the source's bytes; empty for a stream.
    pub(super) digest: String,
    /// Blocks and bytes of text, where a check has counted them.
    pub(super) size: Option<Size>,
    body: Body,
}

/// How a macro program is read, where the source is one.
pub(super) struct MacroSource<'a> {
    pub(super) options: &'a MacroOptions,
    /// Whose profile says how blocks are spelled.
    pub(super) machine: Option<&'a str>,
    pub(super) line: &'a LineOptions,
}

/// The length of a program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) blocks: u64,
    /// Blocks and stop words.
    pub(super) lines: u64,
    /// Text without ends of block.
    pub(super) bytes: u64,
}

#[derive(Debug)]
enum Body {
    Part(Box<Prepared>),
    Macro(MacroProgram),
    File(Stamp),
    Stream,
}

/// Reads a part file and says what it left to default; with the digest of its text.
pub(super) fn part_file(path: &str) -> Result<(PartFile, blake3::Hash), Failure> {
    let text = if path == "-" { io::read_to_string(io::stdin()) } else { std::fs::read_to_string(path) };
    let text = text.map_err(|error| unreadable(path, &error))?;
    let file = PartFile::parse(&text).map_err(|error| Failure::keys(Exit::Program, path, error))?;
    if !file.assumed.is_empty() {
        say!("{path}: not given, taken from the 1990 paper's run: {}", file.assumed.join(", "));
    }
    Ok((file, blake3::hash(text.as_bytes())))
}

pub(super) fn unreadable(path: &str, error: &io::Error) -> Failure {
    let help = match error.kind() {
        io::ErrorKind::NotFound => "check the name; a shape is generated with `dripfeed generate`",
        io::ErrorKind::InvalidData => "the file is not UTF-8 text",
        _ => "check the file and its permissions",
    };
    Failure::new(Exit::Program, format!("cannot read {path}: {error}")).help(help)
}

impl Source {
    /// Opens and checks what a word on the command line stands for.
    ///
    /// G-code is read in a dialect; the generic one where none is named.
    pub(super) fn open(
        word: &str,
        from: Option<Kind>,
        dialect: Option<&str>,
        macros: &MacroSource<'_>,
    ) -> Result<Self, Failure> {
        let kind = Kind::asked(word, from)?;
        if kind == Kind::Macro {
            return Self::of_macro(word, dialect, macros);
        }
        macros.options.check_unused(word, kind)?;
        let dialect = (kind == Kind::Gcode).then(|| dialects::load(dialect, "read")).transpose()?;
        if word == "-" {
            return if kind == Kind::Part {
                Self::part("-", Path::new("-"))
            } else {
                Self::stream(word, kind, dialect)
            };
        }
        let metadata = std::fs::metadata(word).map_err(|error| unreadable(word, &error))?;
        let path = std::path::absolute(word).map_err(|error| unreadable(word, &error))?;
        match kind {
            Kind::Part => Self::part(word, &path),
            kind if metadata.is_file() => Self::file(word, path, kind, dialect),
            kind => Self::stream(&path.display().to_string(), kind, dialect),
        }
    }

    /// A part that comes from no file.
    #[cfg(feature = "demo")]
    pub(super) fn of_part(name: &str, prepared: Prepared) -> Self {
        Self {
            path: name.to_owned(),
            kind: Kind::Part,
            dialect: None,
            digest: String::new(),
            size: None,
            body: Body::Part(Box::new(prepared)),
        }
    }

    /// A macro program, read whole.
    fn of_macro(word: &str, dialect: Option<&str>, macros: &MacroSource<'_>) -> Result<Self, Failure> {
        let profile = connection::of_macros(macros.machine, macros.line)?;
        let text = super::macros::text_of(word)?;
        let program = MacroProgram::parse(word, &text, macros.options, &profile, dialect, false)?;
        let path = match word {
            "-" => word.to_owned(),
            _ => std::path::absolute(word).map_err(|error| unreadable(word, &error))?.display().to_string(),
        };
        Ok(Self {
            path,
            kind: Kind::Macro,
            dialect: None,
            digest: blake3::hash(&text).to_hex().to_string(),
            size: None,
            body: Body::Macro(program),
        })
    }

    /// The macro program, if it is one.
    pub(super) fn macro_program(&self) -> Option<&MacroProgram> {
        match &self.body {
            Body::Macro(program) => Some(program),
            Body::Part(_) | Body::File(_) | Body::Stream => None,
        }
    }

    fn stream(path: &str, kind: Kind, dialect: Option<Dialect>) -> Result<Self, Failure> {
        // A drawing is refused before it is waited for.
        text_program(path, kind, io::empty(), dialect.as_ref(), None)?;
        let path = path.to_owned();
        Ok(Self { path, kind, dialect, digest: String::new(), size: None, body: Body::Stream })
    }

    fn part(word: &str, path: &Path) -> Result<Self, Failure> {
        let (file, digest) = part_file(word)?;
        let prepared = file.part.prepare().map_err(|error| Failure::gear(&error))?;
        Ok(Self {
            path: path.display().to_string(),
            kind: Kind::Part,
            dialect: None,
            digest: digest.to_hex().to_string(),
            size: None,
            body: Body::Part(Box::new(prepared)),
        })
    }

    /// Checks a program file whole.
    fn file(word: &str, path: PathBuf, kind: Kind, dialect: Option<Dialect>) -> Result<Self, Failure> {
        if let Some(dialect) = &dialect {
            check_gcode(word, &path, dialect)?;
        }
        let file = File::open(&path).map_err(|error| unreadable(word, &error))?;
        let metadata = file.metadata().map_err(|error| unreadable(word, &error))?;
        let hashing = Arc::new(Mutex::new(Hashing { file, hasher: blake3::Hasher::new(), bytes: 0 }));
        let shared = Shared(Arc::clone(&hashing));
        let mut reader = text_program(word, kind, shared, dialect.as_ref(), Some(&path))?;
        let (mut size, mut text) = (Size { blocks: 0, lines: 0, bytes: 0 }, Vec::new());
        loop {
            text.clear();
            match reader.pull(&mut text) {
                Ok(Some(line)) => {
                    size.blocks += u64::from(matches!(line, Line::Block(_)));
                    size.lines += 1;
                    size.bytes += text.len() as u64;
                }
                Ok(None) => break,
                Err(error) => return Err(Failure::program(word, error)),
            }
        }
        drop(reader);
        if size.blocks == 0 {
            return Err(Failure::new(Exit::Program, format!("{word} holds no block")));
        }
        let hashing = hashing.lock().unwrap_or_else(PoisonError::into_inner);
        let digest = hashing.hasher.finalize();
        let stamp =
            Stamp { path: path.clone(), bytes: hashing.bytes, modified: metadata.modified().ok(), digest };
        Ok(Self {
            path: path.display().to_string(),
            kind,
            dialect,
            digest: digest.to_hex().to_string(),
            size: Some(size),
            body: Body::File(stamp),
        })
    }

    /// The part, if it is one.
    pub(super) fn prepared(&self) -> Option<&Prepared> {
        match &self.body {
            Body::Part(prepared) => Some(prepared),
            Body::Macro(_) | Body::File(_) | Body::Stream => None,
        }
    }

    /// Runs the beginning of a macro program: tells what was noticed and whether the line will keep up, and finds its
    /// length where that is not far.
    pub(super) fn forecast(&mut self, profile: &Profile, unpaced: bool) -> Result<(), Failure> {
        let Some(program) = self.macro_program() else { return Ok(()) };
        let forecast = program.forecast(&self.path, line_of(profile))?;
        if let Some(failure) = forecast.idle {
            return Err(failure);
        }
        program.say_noticed(&self.path, &forecast.findings);
        if let Some(words) = forecast.starvation.filter(|_| !unpaced) {
            say!("warning: {words}");
        }
        self.size = forecast.size;
        Ok(())
    }

    /// Whether the program can be made only once.
    pub(super) fn is_stream(&self) -> bool {
        matches!(self.body, Body::Stream)
    }

    /// The program, from its first block, counted.
    pub(super) fn counted(&self) -> Result<Counted, Failure> {
        Ok(Counted::new(self.program()?))
    }

    /// The program, from its first block.
    pub(super) fn program(&self) -> Result<Box<dyn Program>, Failure> {
        Ok(match &self.body {
            Body::Part(prepared) => program::generated(prepared),
            Body::Macro(program) => program.lines().into_program(),
            Body::File(stamp) => {
                let verified =
                    Verified::open(stamp.clone()).map_err(|error| unreadable(&self.path, &error))?;
                self.text_program(verified, Some(&stamp.path))?
            }
            Body::Stream if self.path == "-" => self.text_program(io::stdin(), None)?,
            Body::Stream => self.text_program(Later { path: self.path.clone(), file: None }, None)?,
        })
    }

    fn text_program(
        &self,
        text: impl Read + Send + 'static,
        file: Option<&Path>,
    ) -> Result<Box<dyn Program>, Failure> {
        text_program(&self.path, self.kind, text, self.dialect.as_ref(), file)
    }

    /// Refuses to begin elsewhere than at the first block where the control would not know what is in force there.
    pub(super) fn check_from_block(&self, from_block: u64) -> Result<(), Failure> {
        let kind = match self.prepared().map(|prepared| &prepared.part().format) {
            Some(Format::FourB) => Kind::FourB,
            Some(Format::Gcode(_)) => Kind::Gcode,
            Some(Format::ThreeB) | None => self.kind,
        };
        let in_force = match kind {
            Kind::Gcode | Kind::Macro => "its modal state (units, distance mode, offset)",
            Kind::FourB => "the offset it adds to the outline",
            Kind::ThreeB | Kind::Part | Kind::Dxf => return Ok(()),
        };
        if from_block <= 1 {
            return Ok(());
        }
        let message = format!(
            "{} is begun at its first block: anywhere else the control would not have {in_force}",
            self.path
        );
        Err(Failure::new(Exit::Usage, message)
            .help("send it whole, or cut the rest into a program of its own that says what is in force"))
    }

    /// Makes the whole program once to compare it with a journal: its blocks, and the first segment that differs.
    pub(super) fn compare(&self, history: &History) -> Result<resume::Program, Failure> {
        let mut program = self.counted()?;
        let (mut segments, mut text) = (Segments::default(), Vec::new());
        let mut recorded = history.segments.iter().peekable();
        let mut differs_at = None;
        let mut compare = |found: Segment| {
            if let Some((block, value)) = recorded.next_if(|(block, _)| *block == found.block)
                && *value != found.value.to_hex().as_str()
            {
                differs_at = differs_at.or(Some(*block));
            }
        };
        loop {
            text.clear();
            match program.pull(&mut text) {
                Ok(Some(numbered)) => {
                    if let Some(segment) = segments.add(&text, numbered.line) {
                        compare(segment);
                    }
                }
                Ok(None) => break,
                Err(error) => return Err(Failure::program(&self.path, error)),
            }
        }
        // A recorded segment that was not met lies beyond the program's end.
        differs_at = differs_at.or_else(|| recorded.next().map(|(block, _)| *block));
        let whole = segments.finish();
        if let Some((blocks, value)) = &history.whole
            && (*blocks, value.as_str()) != (whole.block, whole.value.to_hex().as_str())
        {
            differs_at = differs_at.or(Some(*blocks));
        }
        let same_source = !self.digest.is_empty() && self.digest == history.job.source_digest;
        Ok(resume::Program { blocks: program.blocks(), differs_at, same_source })
    }
}

/// The program in a text of a kind; in a file it may call subprograms that stand behind its end.
fn text_program(
    word: &str,
    kind: Kind,
    text: impl Read + Send + 'static,
    dialect: Option<&Dialect>,
    file: Option<&Path>,
) -> Result<Box<dyn Program>, Failure> {
    match (kind, dialect) {
        (Kind::ThreeB, _) => Ok(Box::new(program::Read::new(BufReader::with_capacity(READ_BUFFER, text)))),
        (Kind::FourB, _) => Ok(Box::new(FourB::new(BufReader::with_capacity(READ_BUFFER, text)))),
        (Kind::Gcode, Some(dialect)) => {
            let library = match file.map(File::open).transpose().map_err(|e| unreadable(word, &e))? {
                Some(mut file) => {
                    Library::index(&mut file, dialect).map_err(|error| Failure::read(word, error))?
                }
                None => Library::default(),
            };
            Ok(Box::new(Gcode::new(text, dialect.clone(), library)))
        }
        (Kind::Gcode | Kind::Macro | Kind::Dxf | Kind::Part, _) => {
            let message = format!("{word} is a drawing: what is fed is a program made from it");
            Err(Failure::new(Exit::Usage, message)
                .help("make one with `dripfeed convert`, look at it, and send that"))
        }
    }
}

/// Executes a G-code program once, before anything is sent: what is wrong with it is found, and what a control that is
/// fed cannot do is told.
fn check_gcode(word: &str, path: &Path, dialect: &Dialect) -> Result<(), Failure> {
    let file = File::open(path).map_err(|error| unreadable(word, &error))?;
    let failed = |error| Failure::read(word, error);
    let mut motions =
        Motions::of_file(BufReader::with_capacity(READ_BUFFER, file), dialect.clone()).map_err(failed)?;
    let mut unknown: Option<(Motion, u64)> = None;
    for motion in &mut motions {
        let motion = motion.map_err(failed)?;
        if matches!(motion.act, Act::Unknown(_)) {
            unknown.get_or_insert((motion, 0)).1 += 1;
        }
    }
    if let Some((Motion { act: Act::Unknown(text), spot, .. }, count)) = unknown {
        let text = String::from_utf8_lossy(&text).into_owned();
        say!(
            "warning: words that the dialect {} does not know are sent as they stand: {count}, first `{text}` in line {}",
            dialect.name,
            spot.line
        );
    }
    if let [label, ..] = motions.called() {
        say!(
            "warning: the program calls subprogram {label}: a control that is fed block by block cannot go back to it; \
             `dripfeed convert {word} --to gcode` writes it out"
        );
    }
    Ok(())
}

const READ_BUFFER: usize = 1 << 17;
