//! SOURCE: what a word on the command line stands for, checked before the first byte goes anywhere.
//!
//! A file is read twice: checked whole, then fed with its size, time and digest verified on the way. A part is checked
//! for syntax and parameters. A stream (`-`, a FIFO) can be read only once, so its faults come to light as it is fed, each
//! before its block is offered.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use clap::ValueEnum;

use super::failure::{Exit, Failure};
use crate::journal::history::History;
use crate::journal::resume;
use crate::part::Prepared;
use crate::part::file::PartFile;
use crate::program::{self, Counted, Generated, Line, Program, Segment, Segments};

/// What a source is.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(super) enum Kind {
    /// A 3B program
    #[value(name = "3b")]
    ThreeB,
    /// A part file, generated on demand
    Part,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::ThreeB => "3b",
            Self::Part => "part",
        }
    }

    pub(super) fn named(name: &str) -> Option<Self> {
        match name {
            "3b" => Some(Self::ThreeB),
            "part" => Some(Self::Part),
            _ => None,
        }
    }
}

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

pub(super) fn unreadable(path: &str, error: &io::Error) -> Failure {
    let help = match error.kind() {
        io::ErrorKind::NotFound => "check the name; a shape is generated with `dripfeed generate`",
        io::ErrorKind::InvalidData => "the file is not UTF-8 text",
        _ => "check the file and its permissions",
    };
    Failure::new(Exit::Program, format!("cannot read {path}: {error}")).help(help)
}

/// What a word on the command line stands for, by `--from`, its name, or its content.
pub(super) fn kind(word: &str, from: Option<Kind>) -> Result<Kind, Failure> {
    if word == "-" {
        return from.ok_or_else(|| {
            Failure::new(Exit::Usage, "what comes from standard input must be named with --from")
                .help("for example `--from 3b`")
        });
    }
    let metadata = std::fs::metadata(word).map_err(|error| unreadable(word, &error))?;
    if metadata.is_dir() {
        return Err(Failure::new(Exit::Program, format!("{word} is a directory, not a program")));
    }
    from.or_else(|| kind_of(word, metadata.is_file())).ok_or_else(|| {
        Failure::new(Exit::Usage, format!("what {word} is cannot be told from its name"))
            .help("name a .3b program or a .toml part file, or say --from 3b or --from part")
    })
}

impl Source {
    /// Opens and checks what a word on the command line stands for.
    pub(super) fn open(word: &str, from: Option<Kind>) -> Result<Self, Failure> {
        let kind = kind(word, from)?;
        if word == "-" {
            return match kind {
                Kind::ThreeB => Ok(Self::stream(word)),
                Kind::Part => Self::part("-", Path::new("-")),
            };
        }
        let metadata = std::fs::metadata(word).map_err(|error| unreadable(word, &error))?;
        let path = std::path::absolute(word).map_err(|error| unreadable(word, &error))?;
        match kind {
            Kind::Part => Self::part(word, &path),
            Kind::ThreeB if metadata.is_file() => Self::file(word, path),
            Kind::ThreeB => Ok(Self::stream(&path.display().to_string())),
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

    fn stream(path: &str) -> Self {
        let path = path.to_owned();
        Self { path, kind: Kind::ThreeB, digest: String::new(), size: None, body: Body::Stream }
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

    /// Checks a 3B file whole.
    fn file(word: &str, path: PathBuf) -> Result<Self, Failure> {
        let file = File::open(&path).map_err(|error| unreadable(word, &error))?;
        let metadata = file.metadata().map_err(|error| unreadable(word, &error))?;
        let mut hashing = Hashing { file, hasher: blake3::Hasher::new(), bytes: 0 };
        let mut reader = program::Read::new(BufReader::with_capacity(READ_BUFFER, &mut hashing));
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
        let digest = hashing.hasher.finalize();
        let stamp =
            Stamp { path: path.clone(), bytes: hashing.bytes, modified: metadata.modified().ok(), digest };
        Ok(Self {
            path: path.display().to_string(),
            kind: Kind::ThreeB,
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
                Box::new(program::Read::new(BufReader::with_capacity(READ_BUFFER, verified)))
            }
            Body::Stream if self.path == "-" => Box::new(program::Read::new(BufReader::new(io::stdin()))),
            Body::Stream => {
                Box::new(program::Read::new(BufReader::new(Later { path: self.path.clone(), file: None })))
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

/// What the name of a file says it is; failing that, its first bytes. What can be read only once is not looked into.
fn kind_of(word: &str, is_file: bool) -> Option<Kind> {
    let path = Path::new(word);
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("3b") => Some(Kind::ThreeB),
        Some("toml") => Some(Kind::Part),
        _ if !is_file => None,
        _ => {
            let mut head = [0; 4096];
            let count = File::open(path).and_then(|mut file| file.read(&mut head)).ok()?;
            let head = &head[..count];
            if head.split(|&b| b == b'\n').any(|line| line.trim_ascii() == b"[part]") {
                return Some(Kind::Part);
            }
            let mut reader = crate::formats::three_b::read::Reader::new(head);
            // A block within the first lines, with nothing unreadable before it.
            matches!(reader.next_item(), Ok(Some(_))).then_some(Kind::ThreeB)
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

impl Read for &mut Hashing {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.hasher.update(&buffer[..count]);
        self.bytes += count as u64;
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
