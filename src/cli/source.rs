//! SOURCE: what a word on the command line stands for, checked before the first byte goes anywhere.
//!
//! A file is read twice: checked whole, then fed with its size, time and digest verified on the way. A part is checked
//! for syntax and parameters. A stream (`-`, a FIFO) can be read only once, so its faults come to light as it is fed, each
//! before its block is offered.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use super::failure::{Exit, Failure};
use super::kind::Kind;
use crate::journal::history::History;
use crate::journal::resume;
use crate::part::Prepared;
use crate::part::file::PartFile;
use crate::program::{self, Counted, Generated, Line, Program, Segment, Segments};

/// A checked source.
#[derive(Debug)]
pub(super) struct Source {
    /// As it was named, made absolute.
    pub(super) path: String,
    pub(super) kind: Kind,
    /// Digest of the source's bytes; empty for a stream.
    pub(super) digest: String,
    /// Blocks and bytes of text, where a check has counted them.
    pub(super) size: Option<Size>,
    body: Body,
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
    File(Stamp),
    Stream,
}

/// What a file was when it was checked.
#[derive(Clone, Debug)]
struct Stamp {
    path: PathBuf,
    bytes: u64,
    modified: Option<SystemTime>,
    digest: blake3::Hash,
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

fn unreadable(path: &str, error: &io::Error) -> Failure {
    let help = match error.kind() {
        io::ErrorKind::NotFound => "check the name; a shape is generated with `dripfeed generate`",
        io::ErrorKind::InvalidData => "the file is not UTF-8 text",
        _ => "check the file and its permissions",
    };
    Failure::new(Exit::Program, format!("cannot read {path}: {error}")).help(help)
}

impl Source {
    /// Opens and checks what a word on the command line stands for.
    pub(super) fn open(word: &str, from: Option<Kind>) -> Result<Self, Failure> {
        if word == "-" {
            return match from {
                Some(Kind::Part) => Self::part("-", Path::new("-")),
                Some(kind) => Self::stream(word, kind),
                None => {
                    Err(Failure::new(Exit::Usage, "what comes from standard input must be named with --from")
                        .help("for example `--from 3b`"))
                }
            };
        }
        let metadata = std::fs::metadata(word).map_err(|error| unreadable(word, &error))?;
        if metadata.is_dir() {
            return Err(Failure::new(Exit::Program, format!("{word} is a directory, not a program")));
        }
        let kind = match from.or_else(|| Kind::of(word, metadata.is_file())) {
            Some(kind) => kind,
            None => {
                return Err(Failure::new(
                    Exit::Usage,
                    format!("what {word} is cannot be told from its name"),
                )
                .help("name a .3b, .4b or .nc program or a .toml part file, or say what it is with --from"));
            }
        };
        let path = std::path::absolute(word).map_err(|error| unreadable(word, &error))?;
        match kind {
            Kind::Part => Self::part(word, &path),
            kind if metadata.is_file() => Self::file(word, path, kind),
            kind => Self::stream(&path.display().to_string(), kind),
        }
    }

    /// A part that comes from no file.
    #[cfg(feature = "demo")]
    pub(super) fn of_part(name: &str, prepared: Prepared) -> Self {
        Self {
            path: name.to_owned(),
            kind: Kind::Part,
            digest: String::new(),
            size: None,
            body: Body::Part(Box::new(prepared)),
        }
    }

    fn stream(path: &str, kind: Kind) -> Result<Self, Failure> {
        // A drawing is refused before it is waited for.
        text_program(path, kind, io::empty())?;
        let path = path.to_owned();
        Ok(Self { path, kind, digest: String::new(), size: None, body: Body::Stream })
    }

    fn part(word: &str, path: &Path) -> Result<Self, Failure> {
        let (file, digest) = part_file(word)?;
        let prepared = file.part.prepare().map_err(|error| Failure::gear(&error))?;
        Ok(Self {
            path: path.display().to_string(),
            kind: Kind::Part,
            digest: digest.to_hex().to_string(),
            size: None,
            body: Body::Part(Box::new(prepared)),
        })
    }

    /// Checks a program file whole.
    fn file(word: &str, path: PathBuf, kind: Kind) -> Result<Self, Failure> {
        let file = File::open(&path).map_err(|error| unreadable(word, &error))?;
        let metadata = file.metadata().map_err(|error| unreadable(word, &error))?;
        let hashing = Arc::new(Mutex::new(Hashing { file, hasher: blake3::Hasher::new(), bytes: 0 }));
        let mut reader = text_program(word, kind, Shared(Arc::clone(&hashing)))?;
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
                Err(program::ProgramError::Read(error)) => return Err(Failure::read(word, error)),
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
            digest: digest.to_hex().to_string(),
            size: Some(size),
            body: Body::File(stamp),
        })
    }

    /// The part, if it is one.
    pub(super) fn prepared(&self) -> Option<&Prepared> {
        match &self.body {
            Body::Part(prepared) => Some(prepared),
            Body::File(_) | Body::Stream => None,
        }
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
            Body::Part(prepared) => Box::new(Generated::new(prepared)),
            Body::File(stamp) => {
                let verified =
                    Verified::open(stamp.clone()).map_err(|error| unreadable(&self.path, &error))?;
                text_program(&self.path, self.kind, verified)?
            }
            Body::Stream if self.path == "-" => text_program(&self.path, self.kind, io::stdin())?,
            Body::Stream => {
                text_program(&self.path, self.kind, Later { path: self.path.clone(), file: None })?
            }
        })
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
                Err(program::ProgramError::Read(error)) => return Err(Failure::read(&self.path, error)),
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

/// The program in a text of a kind.
fn text_program(
    word: &str,
    kind: Kind,
    text: impl Read + Send + 'static,
) -> Result<Box<dyn Program>, Failure> {
    match kind {
        Kind::ThreeB => Ok(Box::new(program::Read::new(BufReader::with_capacity(READ_BUFFER, text)))),
        Kind::FourB | Kind::Gcode => Err(Failure::new(Exit::Usage, "not yet")),
        Kind::Dxf | Kind::Part => {
            let message = format!("{word} is a drawing: what is fed is a program made from it");
            Err(Failure::new(Exit::Usage, message)
                .help("make one with `dripfeed convert`, look at it, and send that"))
        }
    }
}

/// A FIFO, opened when it is first read: opening it waits for whoever writes, and that wait must not be the main thread's.
struct Later {
    path: String,
    file: Option<File>,
}

impl Read for Later {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let file = match self.file.take() {
            Some(file) => file,
            None => File::open(&self.path)?,
        };
        self.file.insert(file).read(buffer)
    }
}

struct Hashing {
    file: File,
    hasher: blake3::Hasher,
    bytes: u64,
}

/// The file as its reader has it, while the digest stays in reach.
struct Shared(Arc<Mutex<Hashing>>);

impl Read for Shared {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut hashing = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let count = hashing.file.read(buffer)?;
        hashing.hasher.update(&buffer[..count]);
        hashing.bytes += count as u64;
        Ok(count)
    }
}

/// A file read for the second time: size and time are compared at every read, the digest at the end.
struct Verified {
    file: File,
    stamp: Stamp,
    hasher: blake3::Hasher,
    bytes: u64,
}

impl Verified {
    fn open(stamp: Stamp) -> io::Result<Self> {
        Ok(Self { file: File::open(&stamp.path)?, stamp, hasher: blake3::Hasher::new(), bytes: 0 })
    }
}

impl Read for Verified {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let changed = || io::Error::other("the file has changed since it was checked");
        let metadata = self.file.metadata()?;
        if metadata.len() != self.stamp.bytes || metadata.modified().ok() != self.stamp.modified {
            return Err(changed());
        }
        let count = self.file.read(buffer)?;
        self.hasher.update(&buffer[..count]);
        self.bytes += count as u64;
        if count == 0 && (self.bytes != self.stamp.bytes || self.hasher.finalize() != self.stamp.digest) {
            return Err(changed());
        }
        Ok(count)
    }
}

const READ_BUFFER: usize = 1 << 17;
