//! The subprograms a program calls: found in a first pass, and only those that are called are held.
//!
//! With O labels a subprogram begins at its O line; with N labels it begins at an N word in the first block behind the
//! end of a program or of another subprogram, for any other N is just a number. It ends with M99. A source that cannot
//! be read twice has no library, and a call in it is an error.

use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom};

use super::boundaries::{counts, label_of, unclosed};
use super::dialect::{Code, Dialect, Label};
use super::words::{self, Kind, Word};
use crate::formats::ReadError;
use crate::formats::lines::Lines;
use crate::place::{Place, Spot};

/// Subprograms of a program, ready to be executed.
#[derive(Clone, Debug, Default)]
pub struct Library {
    bodies: BTreeMap<u32, Body>,
}

/// The text of a subprogram and where it comes from.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub text: Box<[u8]>,
    /// Where it begins.
    pub spot: Spot,
    /// How many blocks stand before it in the source.
    pub blocks_before: u64,
}

/// The most text of subprograms that is held.
pub const SUBPROGRAM_BYTES_MAX: u64 = 4 << 20;
/// The most labels and calls that are remembered.
const LABELS_MAX: usize = 10_000;

/// Where a subprogram stands.
#[derive(Clone, Copy, Debug)]
struct Found {
    spot: Spot,
    /// Its first byte behind; none when it has no end.
    end: Option<u64>,
    blocks_before: u64,
    /// Where the same label stands again.
    again: Option<Spot>,
}

impl Library {
    /// Reads a source through, remembers where subprograms are and holds those that are called. The source is left at its
    /// start.
    ///
    /// # Errors
    ///
    /// When the source fails or cannot be read as blocks, a subprogram that is called stands twice or has no M99, or there
    /// are too many of them.
    pub fn index(source: &mut (impl Read + Seek), dialect: &Dialect) -> Result<Self, ReadError> {
        source.seek(SeekFrom::Start(0))?;
        let mut pass =
            Pass { dialect, found: BTreeMap::new(), calls: BTreeMap::new(), open: None, behind_end: false };
        let mut lines = Lines::new(&mut *source);
        let (mut words, mut block) = (Vec::new(), 0);
        while let Some(line) = lines.next_line()? {
            // What follows is searched word by word only where it could be of a subprogram.
            words::cut(line.bytes, &mut words).map_err(|e| unclosed(&line, e))?;
            let counted = counts(&words, dialect);
            let end = line.byte + line.bytes.len() as u64;
            pass.line(&words, line.spot(0), end, block, counted).map_err(|message| ReadError::Program {
                message,
                place: line.place(0, 1),
                help: "write the calls out".into(),
            })?;
            block += u64::from(counted);
        }
        let library = pass.held(source)?;
        source.seek(SeekFrom::Start(0))?;
        Ok(library)
    }

    pub(super) fn body(&self, label: u32) -> Option<&Body> {
        self.bodies.get(&label)
    }
}

struct Pass<'d> {
    dialect: &'d Dialect,
    found: BTreeMap<u32, Found>,
    calls: BTreeMap<u32, Spot>,
    open: Option<u32>,
    behind_end: bool,
}

impl Pass<'_> {
    fn line(
        &mut self,
        words: &[Word],
        spot: Spot,
        end: u64,
        block: u64,
        counted: bool,
    ) -> Result<(), String> {
        if let Some(label) = opens(words, self.dialect, self.behind_end) {
            if let Some(found) = self.found.get_mut(&label) {
                found.again = Some(spot);
            } else {
                if self.found.len() >= LABELS_MAX {
                    return Err(format!("more than {LABELS_MAX} subprograms"));
                }
                let found = Found { spot, end: None, blocks_before: block, again: None };
                self.found.insert(label, found);
                self.open = Some(label);
            }
        }
        if counted {
            self.behind_end = false;
        }
        for word in words.iter().filter(|w| w.letter == b'M') {
            match self.dialect.m_code(word) {
                Code::End | Code::Return => {
                    self.behind_end = true;
                    if let Some(found) = self.open.take().and_then(|label| self.found.get_mut(&label)) {
                        found.end = Some(end);
                    }
                }
                Code::Call => {
                    if let Some((label, _)) = called(words, self.dialect) {
                        if self.calls.len() >= LABELS_MAX {
                            return Err(format!("calls of more than {LABELS_MAX} subprograms"));
                        }
                        self.calls.entry(label).or_insert(spot);
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The texts of what is called.
    fn held(self, source: &mut (impl Read + Seek)) -> Result<Library, ReadError> {
        let mut bodies = BTreeMap::new();
        let mut held = 0;
        for label in self.calls.keys() {
            // A call of what is not there is told where it is executed.
            let Some(found) = self.found.get(label) else { continue };
            let mut refuse = |spot: Spot, message: String| -> Result<Library, ReadError> {
                let place = Place::read_again(source, spot, 1)?;
                Err(ReadError::Program { message, place, help: "correct the program".into() })
            };
            if let Some(again) = found.again {
                return refuse(again, format!("subprogram {label} stands here for the second time"));
            }
            let Some(end) = found.end else {
                return refuse(found.spot, format!("subprogram {label} has no M99"));
            };
            let length = end - found.spot.byte;
            held += length;
            if held > SUBPROGRAM_BYTES_MAX {
                let message = format!("the subprograms called are longer than {SUBPROGRAM_BYTES_MAX} bytes");
                return refuse(found.spot, message);
            }
            source.seek(SeekFrom::Start(found.spot.byte))?;
            let mut text = Vec::new();
            source.by_ref().take(length).read_to_end(&mut text)?;
            let body = Body { text: text.into(), spot: found.spot, blocks_before: found.blocks_before };
            bodies.insert(*label, body);
        }
        Ok(Library { bodies })
    }
}

/// The label of the subprogram a line opens.
pub(super) fn opens(words: &[Word], dialect: &Dialect, behind_end: bool) -> Option<u32> {
    match dialect.subprograms {
        Label::O => {
            let first = words.iter().find(|w| w.kind != Kind::Comment)?;
            if dialect.names_program(first.letter) { first.whole() } else { None }
        }
        Label::N => label_of(words).filter(|_| behind_end),
    }
}

/// The subprogram a block calls and how often.
pub(super) fn called(words: &[Word], dialect: &Dialect) -> Option<(u32, Option<u32>)> {
    let number = |letter| words.iter().find(|w| w.letter == letter);
    let label = number(b'P')?.whole()?;
    let repeats = match number(b'L') {
        None => Some(1),
        Some(word) => word.whole(),
    };
    if dialect.packed_repeats && label > 9999 {
        return Some((label % 10_000, Some(label / 10_000)));
    }
    Some((label, repeats))
}
