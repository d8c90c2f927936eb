//! IN of `check`, `plot` and `convert`: a program, a part or a drawing as motions, with what was read for each of them.
//!
//! Motions come one at a time; only a drawing is held. A program can be read on behind something that cannot be read: at
//! the next line, or behind the next block where blocks run together. What comes from standard input or a FIFO is put
//! aside, since places are shown by reading again: first, where a program is read on behind an error, and G-code, which may
//! call what stands behind its end; else block by block as it comes.

mod aside;

use std::fs::File;
use std::io::{self, BufReader, Read, Seek as _, SeekFrom};
use std::path::Path;

use clap::Args;

use super::dialects;
use super::drawing;
use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::macros::MacroOptions;
use super::source;
use crate::drawing::dxf::Drawing;
use crate::formats::ReadError;
use crate::formats::gcode::{self, Dialect};
use crate::formats::lines::Line;
use crate::formats::three_b::{self, Block};
use crate::geometry::Point;
use crate::interpolator::Model;
use crate::motion::{Act, Motion};
use crate::part::{Part, Prepared};
use crate::place::{Place, Spot};
use crate::profile::Profile;
use crate::program::{Generated, Program};
use aside::{Copied, expanded, put_aside};

/// How IN is to be read.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct Reading {
    /// What IN is [default: by its name, then by its content; needed for -]
    #[arg(long, value_name = "KIND")]
    pub(super) from: Option<Kind>,
    /// The control a G-code program is for: a built-in dialect or a dialect file [default: the machine's, else generic]
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) dialect: Option<String>,
    /// The dialect of the machine, where it is known and no other is named.
    #[arg(skip)]
    pub(super) of_machine: Option<String>,
    /// Whether arcs whose radii disagree are read as they are.
    #[arg(skip)]
    pub(super) keeps_wrong_arcs: bool,
    #[command(flatten)]
    pub(super) macros: MacroOptions,
    /// How a macro program is run and what it makes is spelled, where a machine is known.
    #[arg(skip)]
    pub(super) profile: Option<Profile>,
    #[command(flatten)]
    pub(super) drawing: drawing::OfDrawing,
    /// Where the wire enters a drawing.
    #[arg(skip)]
    pub(super) starts: Vec<Point>,
    /// Whether blocks are read as they come, and not on behind what cannot be read.
    #[arg(skip)]
    pub(super) as_they_come: bool,
}

impl Reading {
    fn dialect(&self) -> Option<&str> {
        self.dialect.as_deref().or(self.of_machine.as_deref())
    }
}

/// What of a part is wanted.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum OfPart {
    /// The 3B blocks made of it.
    Blocks,
    /// Its elements as they are designed.
    Elements,
}

/// A program as motions.
pub(super) struct Motions {
    /// What it is.
    pub(super) kind: Kind,
    pub(super) places: Places,
    source: Source,
    part: Option<Part>,
    /// The drawing the motions are of.
    pub(super) drawn: Option<Drawing>,
}

/// Where to look up what stands at a spot.
pub(super) struct Places {
    /// The program, as it was named.
    pub(super) name: String,
    kind: Kind,
    /// Its text, where it has one.
    file: Option<File>,
}

impl Places {
    /// A spot with the text that stands there; none where there is no text. A width of 0 means the whole block.
    ///
    /// To be asked when all has been read: the file and its reader share a position.
    pub(super) fn place(&mut self, spot: Spot, width: usize) -> Option<Place> {
        let file = self.file.as_mut().filter(|_| spot.line > 0)?;
        let mut place = Place::read_again(file, spot, width.max(1)).ok()?;
        if width == 0 {
            let text = place.excerpt.as_bytes().get(place.caret..)?;
            place.width =
                if self.kind == Kind::Gcode { text.trim_ascii_end().len().max(1) } else { block_width(text) };
        }
        Some(place)
    }
}

enum Source {
    /// 3B or 4B, read or generated.
    Blocks {
        motions: Box<three_b::motions::Motions<Box<dyn Read>>>,
        /// Where the reader began, when it has gone on behind an error.
        base: Spot,
    },
    Gcode {
        motions: Box<gcode::Motions<BufReader<File>>>,
        dialect: Box<Dialect>,
        /// The byte of the last error that was gone on behind.
        failed_at: Option<u64>,
    },
    Made(Box<dyn Iterator<Item = Motion>>),
}

impl Motions {
    /// Opens what a word on the command line stands for; blocks run as on a control of the model.
    pub(super) fn open(
        word: &str,
        reading: &Reading,
        of_part: OfPart,
        model: Model,
    ) -> Result<Self, Failure> {
        let asked = Kind::asked(word, reading.from)?;
        // What a macro program makes is read as what it is.
        let kind = if asked == Kind::Macro { Kind::Gcode } else { asked };
        if asked != Kind::Macro {
            reading.macros.check_unused(word, asked)?;
        }
        if reading.dialect.is_some() && kind != Kind::Gcode {
            let message = format!("--dialect goes with G-code, and {word} is {}", kind.title());
            return Err(Failure::new(Exit::Usage, message).help("leave it out, or say --from gcode"));
        }
        if reading.drawing.is_given() && kind != Kind::Dxf {
            let message = format!("{word} is {}, and not a drawing", kind.title());
            return Err(Failure::new(Exit::Usage, message)
                .help("leave out what goes with drawings only, or say --from dxf"));
        }
        let (mut part, mut file, mut drawn) = (None, None, None);
        let blocks = |motions| Source::Blocks { motions: Box::new(motions), base: Spot::default() };
        let source = match kind {
            Kind::Part => {
                let prepared = source::part_file(word)?.0.part.prepare();
                let prepared = prepared.map_err(|error| Failure::gear(&error))?;
                part = Some(prepared.part().clone());
                match of_part {
                    OfPart::Blocks => {
                        let text: Box<dyn Read> = Box::new(Text::of(&prepared));
                        blocks(three_b::motions::Motions::of_three_b(text, model))
                    }
                    OfPart::Elements => Source::Made(Box::new(prepared.motions())),
                }
            }
            Kind::Dxf => {
                let drawing = reading.drawing.read(word, &reading.starts)?;
                let motions: Vec<Motion> = drawing.motions().collect();
                drawn = Some(drawing);
                Source::Made(Box::new(motions.into_iter()))
            }
            Kind::ThreeB | Kind::FourB | Kind::Gcode | Kind::Macro => {
                let failed = |error: io::Error| source::unreadable(word, &error);
                let is_file = word != "-" && Path::new(word).is_file();
                if !is_file && reading.as_they_come && kind != Kind::Gcode {
                    let (copy, text) = Copied::open(word).map_err(failed)?;
                    file = Some(copy);
                    let text = Box::new(BufReader::with_capacity(BUFFER, text));
                    let source = blocks(match kind {
                        Kind::FourB => three_b::motions::Motions::of_four_b(text, model),
                        _ => three_b::motions::Motions::of_three_b(text, model),
                    });
                    return Ok(Self {
                        kind,
                        places: Places { name: name_of(word), kind, file },
                        source,
                        part,
                        drawn,
                    });
                }
                let opened = match (asked, is_file) {
                    (Kind::Macro, _) => expanded(word, reading)?,
                    (_, true) => File::open(word).map_err(failed)?,
                    (_, false) => put_aside(word).map_err(failed)?,
                };
                let text = opened.try_clone().map_err(failed)?;
                file = Some(opened);
                let text = BufReader::with_capacity(BUFFER, text);
                match kind {
                    Kind::FourB => blocks(three_b::motions::Motions::of_four_b(Box::new(text), model)),
                    Kind::Gcode => {
                        let mut dialect = dialects::load(reading.dialect(), "read")?;
                        dialect.keeps_wrong_arcs = reading.keeps_wrong_arcs;
                        let motions = gcode::Motions::of_file(text, dialect.clone())
                            .map_err(|error| Failure::read(word, error))?;
                        Source::Gcode {
                            motions: Box::new(motions),
                            dialect: Box::new(dialect),
                            failed_at: None,
                        }
                    }
                    _ => blocks(three_b::motions::Motions::of_three_b(Box::new(text), model)),
                }
            }
        };
        let name = match asked {
            Kind::Macro => format!("{}, expanded", name_of(word)),
            _ => name_of(word),
        };
        Ok(Self { kind, places: Places { name, kind, file }, source, part, drawn })
    }

    /// The 3B block the last motion came from.
    pub(super) fn block(&self) -> Option<Block> {
        match &self.source {
            Source::Blocks { motions, .. } => motions.last_block(),
            Source::Gcode { .. } | Source::Made(_) => None,
        }
    }

    /// The text of a motion just read as it goes to the control; G-code goes line by line, see [`Motions::lines`].
    pub(super) fn text(&self, motion: &Motion) -> &[u8] {
        match (&self.source, &motion.act) {
            (Source::Blocks { motions, .. }, Act::Move { .. } | Act::Stop(_)) => motions.text(),
            _ => &[],
        }
    }

    /// The part the motions are made from.
    pub(super) fn part(&self) -> Option<&Part> {
        self.part.as_ref()
    }

    /// Shows every line of a G-code program that can be read, with the number of its block.
    pub(super) fn lines(&mut self, mut show: impl FnMut(Line<'_>, u64)) -> Result<(), Failure> {
        let (Source::Gcode { dialect, .. }, Some(file)) = (&self.source, &mut self.places.file) else {
            return Ok(());
        };
        let failed = |error: io::Error| source::unreadable(&self.places.name, &error);
        file.rewind().map_err(failed)?;
        let text = BufReader::with_capacity(BUFFER, file.try_clone().map_err(failed)?);
        let mut blocks = gcode::Blocks::new(text, dialect);
        // What cannot be read has been found by whoever read the motions.
        while let Ok(Some(block)) = blocks.next_block() {
            show(block.line, block.number);
        }
        Ok(())
    }

    /// Where to look up what stands at a spot, for when the motions are gone.
    pub(super) fn places(&self) -> Result<Places, Failure> {
        let Places { name, kind, file } = &self.places;
        let file = file.as_ref().map(File::try_clone).transpose();
        let file = file.map_err(|error| source::unreadable(name, &error))?;
        Ok(Places { name: name.clone(), kind: *kind, file })
    }

    /// Reads on behind an error; false where that cannot be.
    pub(super) fn go_on_behind(&mut self, error: &ReadError) -> bool {
        let ReadError::Program { place, .. } = error else { return false };
        match (&mut self.source, &mut self.places.file) {
            (Source::Blocks { motions, base }, Some(file)) => {
                let Ok(next) = next_start(file, place.spot()) else { return false };
                let Ok(again) = file.try_clone() else { return false };
                *base = next;
                motions.go_on_from(Box::new(BufReader::with_capacity(BUFFER, again)));
                true
            }
            // A line that is read wrong again where it was before is the end.
            (Source::Gcode { motions, failed_at, .. }, _) => {
                failed_at.replace(place.byte) != Some(place.byte) && motions.go_on()
            }
            _ => false,
        }
    }
}

impl Iterator for Motions {
    type Item = Result<Motion, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        match &mut self.source {
            Source::Blocks { motions, base } => Some(match motions.next()? {
                // What is generated has no text to look places up in.
                Ok(motion) if self.part.is_some() => Ok(Motion { spot: Spot::default(), ..motion }),
                Ok(motion) => Ok(Motion { spot: behind(*base, motion.spot), ..motion }),
                Err(ReadError::Program { message, place, help }) => {
                    let spot = behind(*base, place.spot());
                    let place = Place { line: spot.line, column: spot.column, byte: spot.byte, ..place };
                    Err(ReadError::Program { message, place, help })
                }
                Err(error) => Err(error),
            }),
            Source::Gcode { motions, .. } => motions.next(),
            Source::Made(motions) => motions.next().map(Ok),
        }
    }
}

/// A generated program as text, made as it is read.
struct Text {
    program: Generated,
    line: Vec<u8>,
    at: usize,
}

impl Text {
    fn of(prepared: &Prepared) -> Self {
        Self { program: Generated::new(prepared), line: Vec::new(), at: 0 }
    }
}

impl Read for Text {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.at == self.line.len() {
            self.line.clear();
            self.at = 0;
            while self.line.len() < buffer.len().min(BUFFER) {
                match self.program.pull(&mut self.line).map_err(io::Error::other)? {
                    Some(_) => self.line.push(b'\n'),
                    None => break,
                }
            }
        }
        let count = buffer.len().min(self.line.len() - self.at);
        buffer[..count].copy_from_slice(&self.line[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}

/// A spot of a text that itself begins at a spot of another.
fn behind(base: Spot, spot: Spot) -> Spot {
    if base.line == 0 {
        return spot;
    }
    let column = if spot.line == 1 { base.column + spot.column - 1 } else { spot.column };
    Spot { byte: base.byte + spot.byte, line: base.line + spot.line - 1, column }
}

/// Where reading goes on behind a spot, with the file set there: the next line, or behind the next block of this one.
fn next_start(file: &mut File, mut spot: Spot) -> io::Result<Spot> {
    file.seek(SeekFrom::Start(spot.byte))?;
    let mut before = 0u8;
    let mut reader = BufReader::new(&mut *file);
    let mut byte = [0u8];
    while reader.read(&mut byte)? > 0 {
        let [byte] = byte;
        spot.byte += 1;
        spot.column += 1;
        if byte == b'\n' {
            spot = Spot { byte: spot.byte, line: spot.line + 1, column: 1 };
            break;
        }
        if matches!((before.to_ascii_uppercase(), byte), (b'L' | b'R', b'0'..=b'9')) {
            break;
        }
        before = byte;
    }
    drop(reader);
    file.seek(SeekFrom::Start(spot.byte))?;
    Ok(spot)
}

/// How many bytes a block takes: up to its digit of Z, or up to a remark or the line's end.
fn block_width(text: &[u8]) -> usize {
    let is_end = |pair: &[u8]| matches!(pair, [b'L' | b'l' | b'R' | b'r', b'1'..=b'4']);
    let remark = text.iter().position(|b| matches!(b, b';' | b'(')).unwrap_or(text.len());
    let block = &text[..remark];
    block.windows(2).position(is_end).map_or_else(|| block.trim_ascii_end().len().max(1), |at| at + 2)
}

/// What a source is called in messages.
fn name_of(word: &str) -> String {
    if word == "-" { "standard input".to_owned() } else { word.to_owned() }
}

const BUFFER: usize = 1 << 17;
