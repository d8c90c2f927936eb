//! IN of `check` and `plot`: a program as motions, with what was read for each of them.
//!
//! Motions come one at a time. A file can be read on behind something that cannot be read: at the next line, or behind
//! the next block where blocks run together. What comes from standard input or a FIFO is put aside first, since places
//! are shown by reading again.

use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek as _, SeekFrom};
use std::path::Path;

use super::failure::Failure;
use super::source::{self, Kind};
use crate::formats::ReadError;
use crate::formats::three_b::read::{Item, Reader};
use crate::formats::three_b::{Block, Motion as Instruction};
use crate::geometry::{Element, Point};
use crate::interpolator::Model;
use crate::motion::{Act, Motion, Stop, Travel};
use crate::part::{Part, Prepared, StopWord};
use crate::place::{Place, Spot};
use crate::rounding::Made;
use crate::units::Position;

/// A program as motions.
pub(super) struct Motions {
    /// As it was named.
    pub(super) name: String,
    source: Source,
    stands: Position,
    blocks: u64,
    block: Option<Block>,
    text: Vec<u8>,
}

enum Source {
    File { file: File, reader: Box<Reader<BufReader<File>>>, base: Spot },
    Part { prepared: Box<Prepared>, made: Box<dyn Iterator<Item = Made> + Send>, end: StopWord },
}

impl Motions {
    /// Opens what a word on the command line stands for.
    pub(super) fn open(word: &str, from: Option<Kind>) -> Result<Self, Failure> {
        let kind = source::kind(word, from)?;
        let source = match kind {
            Kind::Part => {
                let prepared = source::part_file(word)?.0.part.prepare();
                let prepared = Box::new(prepared.map_err(|error| Failure::gear(&error))?);
                let made = prepared.blocks();
                let end = prepared.part().stop_word;
                Source::Part { prepared, made, end }
            }
            Kind::ThreeB => {
                let failed = |error: io::Error| source::unreadable(word, &error);
                let is_file = word != "-" && Path::new(word).is_file();
                let file = if is_file { File::open(word) } else { put_aside(word) }.map_err(failed)?;
                let again = file.try_clone().map_err(failed)?;
                let reader = Box::new(Reader::new(BufReader::with_capacity(BUFFER, again)));
                Source::File { file, reader, base: Spot::default() }
            }
        };
        let name = if word == "-" { "standard input".to_owned() } else { word.to_owned() };
        Ok(Self {
            name,
            source,
            stands: Position::default(),
            blocks: 0,
            block: None,
            text: Vec::new(),
        })
    }

    /// The 3B block the last motion came from.
    pub(super) fn block(&self) -> Option<&Block> {
        self.block.as_ref()
    }

    /// The text of the last motion as it goes to the control.
    pub(super) fn text(&self) -> &[u8] {
        &self.text
    }

    /// The part the motions are made from.
    pub(super) fn part(&self) -> Option<&Part> {
        match &self.source {
            Source::Part { prepared, .. } => Some(prepared.part()),
            Source::File { .. } => None,
        }
    }

    /// A spot with the text that stands there; none where there is no text. A width of 0 means the whole block.
    pub(super) fn place(&mut self, spot: Spot, width: usize) -> Option<Place> {
        let Source::File { file, .. } = &mut self.source else { return None };
        if spot.line == 0 {
            return None;
        }
        // Reader and file share a position; the places are asked for when all has been read.
        let mut place = Place::read_again(file, spot, width.max(1)).ok()?;
        if width == 0 {
            place.width = block_width(place.excerpt.as_bytes().get(place.caret..)?);
        }
        Some(place)
    }

    /// Reads on behind an error; false where that cannot be.
    pub(super) fn go_on_behind(&mut self, error: &ReadError) -> bool {
        let (ReadError::Program { place, .. }, Source::File { file, reader, base }) =
            (error, &mut self.source)
        else {
            return false;
        };
        self.block = None;
        let Ok(next) = next_start(file, place.spot()) else { return false };
        let Ok(again) = file.try_clone() else { return false };
        *base = next;
        **reader = Reader::new(BufReader::with_capacity(BUFFER, again));
        true
    }

    fn next_from_file(&mut self) -> Option<Result<Motion, ReadError>> {
        let Source::File { reader, base, .. } = &mut self.source else { return None };
        self.text.clear();
        let item = match reader.next_item() {
            Ok(item) => item?,
            Err(ReadError::Program { message, place, help }) => {
                let spot = behind(*base, place.spot());
                let place = Place { line: spot.line, column: spot.column, byte: spot.byte, ..place };
                return Some(Err(ReadError::Program { message, place, help }));
            }
            Err(error) => return Some(Err(error)),
        };
        let spot = behind(*base, reader.spot());
        match item {
            Item::Block(block) => {
                self.text.extend_from_slice(reader.text());
                Some(Ok(self.motion(block, spot)))
            }
            Item::StopWord(word) => {
                self.text.extend_from_slice(word.as_bytes());
                Some(Ok(self.stop(word, spot)))
            }
        }
    }

    fn next_from_part(&mut self) -> Option<Result<Motion, ReadError>> {
        let Source::Part { prepared, made, end } = &mut self.source else { return None };
        self.text.clear();
        if let Some(made) = made.next() {
            prepared.part().style.write(&made.block, &mut self.text);
            return Some(Ok(self.motion(made.block, Spot::default())));
        }
        let word = std::mem::replace(end, StopWord::None).text();
        if word.is_empty() {
            return None;
        }
        self.text.extend_from_slice(word.as_bytes());
        Some(Ok(self.stop(word, Spot::default())))
    }

    fn stop(&mut self, word: &str, spot: Spot) -> Motion {
        self.block = None;
        let stop = if word == "D" { Stop::Pause } else { Stop::End };
        Motion { act: Act::Stop(stop), block: self.blocks, spot }
    }

    fn motion(&mut self, block: Block, spot: Spot) -> Motion {
        self.blocks += 1;
        self.block = Some(block);
        let start = self.stands;
        // The reader has seen that the block ends.
        let way = Model::Rotated.displacement(&block).unwrap_or_default();
        self.stands += way;
        let point = |p: Position| Point::new(p.x.millimetres(), p.y.millimetres());
        let element = match block.motion {
            Instruction::Line(_) => Element::Line { start: point(start), end: point(self.stands) },
            Instruction::Arc(..) if block.j.0 == 0 => {
                Element::Line { start: point(start), end: point(start) }
            }
            Instruction::Arc(sense, _) => {
                // A full circle may end a few microns behind or before its start; it is a full circle all the same.
                let radius = Position::default().distance_um(point(block.signed()));
                let is_whole = block.j.0 as f64 > 3.0 * radius
                    && start.distance_um(point(self.stands)) <= WHOLE_UM.min(0.1 * radius);
                if is_whole {
                    self.stands = start;
                }
                let centre = point(start - block.signed());
                Element::Arc { start: point(start), end: point(self.stands), centre, sense }
            }
        };
        let act = Act::Move { travel: Travel::Cut, element, upper: None, flag: None };
        Motion { act, block: self.blocks, spot }
    }
}

impl Iterator for Motions {
    type Item = Result<Motion, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.source {
            Source::File { .. } => self.next_from_file(),
            Source::Part { .. } => self.next_from_part(),
        }
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

/// Copies what can be read only once into a file without a name.
fn put_aside(word: &str) -> io::Result<File> {
    let path = std::env::temp_dir().join(format!("dripfeed-{}.in", std::process::id()));
    let mut file = File::options().read(true).write(true).create_new(true).open(&path)?;
    // An open file stays readable without its name; where a system thinks otherwise it is left behind.
    let _ = std::fs::remove_file(&path);
    if word == "-" {
        io::copy(&mut io::stdin().lock(), &mut file)?;
    } else {
        io::copy(&mut File::open(word)?, &mut file)?;
    }
    file.rewind()?;
    Ok(file)
}

/// A full circle from any point, its J from geometry, ends so near its start, µm, whatever the model.
const WHOLE_UM: f64 = 10.0;

const BUFFER: usize = 1 << 17;
