//! The records of a file: header, layers, blocks and entities, each checked before anything is made of it.
//!
//! What is damaged is an error with its place; what is merely not for cutting is kept as such and counted later.

use std::collections::HashMap;
use std::ops::Range;

use crate::formats::ReadError;
use crate::place::Spot;

use super::entity::{self, Figure, Holds, Kind, Uncut};
use super::pairs::{Pair, Pairs};
use super::write;

/// All that is in a file.
#[derive(Debug, Default)]
pub(super) struct Records {
    /// `$INSUNITS`.
    pub(super) units: Option<i16>,
    /// `$MEASUREMENT`.
    pub(super) measurement: Option<i16>,
    /// Whether the file says that its entities stand in cutting order.
    pub(super) in_order: bool,
    /// Where such a file says that its last entity ends.
    pub(super) ends_at: Option<[f64; 2]>,
    pub(super) layers: Vec<Layer>,
    /// All blocks that are named, defined or not.
    pub(super) blocks: Vec<Block>,
    /// The names of kinds that are not cut.
    pub(super) kinds: Vec<String>,
    /// The entities of all blocks and of the model.
    pub(super) entities: Vec<Entity>,
    /// Which of them are the model.
    pub(super) model: Range<usize>,
    /// Where something stands behind the end of the file.
    pub(super) behind_end: Option<Spot>,
    /// The lines of entities that do not lie at one height.
    pub(super) leaving_plane: Vec<u64>,
    layer_numbers: HashMap<Vec<u8>, u32>,
    block_numbers: HashMap<Vec<u8>, u32>,
    kind_numbers: HashMap<Vec<u8>, u32>,
}

#[derive(Debug)]
pub(super) struct Layer {
    pub(super) name: String,
    pub(super) off: bool,
    pub(super) frozen: bool,
}

#[derive(Debug)]
pub(super) struct Block {
    pub(super) name: String,
    pub(super) defined: bool,
    pub(super) base: [f64; 2],
    pub(super) entities: Range<usize>,
}

#[derive(Debug)]
pub(super) struct Entity {
    pub(super) figure: Figure,
    pub(super) layer: u32,
    pub(super) line: u64,
    /// A remark before it says that it is run clockwise.
    pub(super) clockwise: bool,
}

/// The layer that stands for that of the insert.
pub(super) const LAYER_0: u32 = 0;

impl Records {
    /// Reads a file.
    pub(super) fn of(bytes: &[u8]) -> Result<Self, ReadError> {
        let mut records = Self::default();
        records.layer(b"0");
        let mut reading = Reading {
            pairs: Pairs::of(bytes)?,
            put_back: None,
            records,
            batch: Batch::default(),
            clockwise: false,
            heights: None,
        };
        reading.file()?;
        Ok(reading.records)
    }

    fn layer(&mut self, name: &[u8]) -> u32 {
        let layers = &mut self.layers;
        number_of(&mut self.layer_numbers, name, |name| {
            layers.push(Layer { name, off: false, frozen: false });
        })
    }

    fn block(&mut self, name: &[u8]) -> u32 {
        let blocks = &mut self.blocks;
        number_of(&mut self.block_numbers, name, |name| {
            blocks.push(Block { name, defined: false, base: [0.0; 2], entities: 0..0 });
        })
    }

    fn kind(&mut self, name: &[u8]) -> u32 {
        let kinds = &mut self.kinds;
        number_of(&mut self.kind_numbers, name, |name| kinds.push(name))
    }
}

/// The number of a name, given in order of appearance; names differ by more than capitals.
fn number_of(numbers: &mut HashMap<Vec<u8>, u32>, name: &[u8], add: impl FnOnce(String)) -> u32 {
    if let Some(&number) = numbers.get(name) {
        return number;
    }
    let key = name.to_ascii_uppercase();
    let next = numbers.len() as u32;
    if let Some(&number) = numbers.get(&key) {
        return number;
    }
    numbers.insert(key, next);
    add(shown(name));
    next
}

/// A name as text: UTF-8 as it is, `\U+XXXX` as its character, bytes of another code as `\xHH`.
fn shown(name: &[u8]) -> String {
    let Ok(text) = std::str::from_utf8(name) else {
        return name
            .iter()
            .map(|&b| if b.is_ascii() { (b as char).to_string() } else { format!("\\x{b:02X}") })
            .collect();
    };
    let mut shown = String::new();
    let mut parts = text.split("\\U+");
    shown.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let character =
            part.get(..4).and_then(|hex| u32::from_str_radix(hex, 16).ok()).and_then(char::from_u32);
        match character {
            Some(character) => {
                shown.push(character);
                shown.push_str(&part[4..]);
            }
            None => {
                shown.push_str("\\U+");
                shown.push_str(part);
            }
        }
    }
    shown
}

/// Entities on their way to the `dxf` crate and back.
#[derive(Debug, Default)]
struct Batch {
    text: Vec<u8>,
    /// For each: which of the entities it is, its kind, and the block it inserts.
    slots: Vec<(usize, Kind, u32)>,
}

struct Reading<'a> {
    pairs: Pairs<'a>,
    put_back: Option<Pair<'a>>,
    records: Records,
    batch: Batch,
    clockwise: bool,
    /// The lowest and highest Z of an entity.
    heights: Option<[f64; 2]>,
}

const DAMAGED: &str = "the drawing is damaged here: save it again from the program that drew it";

impl<'a> Reading<'a> {
    /// The next pair that is no remark.
    fn next(&mut self) -> Result<Pair<'a>, ReadError> {
        if let Some(pair) = self.put_back.take() {
            return Ok(pair);
        }
        loop {
            let Some(pair) = self.pairs.next_pair()? else { return Err(self.pairs.cut_off()) };
            if pair.code != 999 {
                return Ok(pair);
            }
            if pair.is(999, write::IN_ORDER) {
                self.records.in_order = true;
            } else if pair.is(999, write::CLOCKWISE) {
                self.clockwise = true;
            } else if let Some(point) = ends_at(&pair) {
                self.records.ends_at = Some(point);
            }
        }
    }

    fn file(&mut self) -> Result<(), ReadError> {
        loop {
            let pair = self.next()?;
            if pair.is(0, "EOF") {
                break;
            }
            if !pair.is(0, "SECTION") {
                let at = if pair.code == 0 { pair.spot } else { self.pairs.begun() };
                return Err(self.pairs.error(at, "`0 SECTION` or `0 EOF` is due here".into(), DAMAGED));
            }
            let name = self.next()?;
            match (name.code, &*name.text()) {
                (2, b"HEADER") => self.header()?,
                (2, b"TABLES") => self.tables()?,
                (2, b"BLOCKS") => self.blocks()?,
                (2, b"ENTITIES") => {
                    let from = self.records.entities.len();
                    let stop = self.entities(&[b"ENDSEC"])?;
                    debug_assert_eq!(stop, b"ENDSEC");
                    let to = self.records.entities.len();
                    if !self.records.model.is_empty() && from < to {
                        return Err(self.pairs.error(
                            name.spot,
                            "the drawing has two sections of ENTITIES".into(),
                            DAMAGED,
                        ));
                    }
                    if from < to {
                        self.records.model = from..to;
                    }
                }
                (2, _) => while !self.next()?.is(0, "ENDSEC") {},
                _ => {
                    return Err(self.pairs.error(
                        self.pairs.begun(),
                        "the name of the section is due here".into(),
                        DAMAGED,
                    ));
                }
            }
        }
        self.flush()?;
        let behind = self.pairs.spot();
        if !matches!(self.pairs.next_pair(), Ok(None)) {
            self.records.behind_end = Some(behind);
        }
        Ok(())
    }

    fn header(&mut self) -> Result<(), ReadError> {
        let mut variable = Vec::new();
        loop {
            let pair = self.next()?;
            match (pair.code, variable.as_slice()) {
                (0, _) if pair.is(0, "ENDSEC") => return Ok(()),
                (0, _) => return Err(self.pairs.error(pair.spot, "`0 ENDSEC` is due here".into(), DAMAGED)),
                (9, _) => variable = pair.text().into_owned(),
                (70, b"$INSUNITS") => self.records.units = Some(self.whole(&pair)?),
                (70, b"$MEASUREMENT") => self.records.measurement = Some(self.whole(&pair)?),
                _ => {}
            }
        }
    }

    fn tables(&mut self) -> Result<(), ReadError> {
        // Name, off, frozen.
        let mut layer: Option<(Vec<u8>, bool, bool)> = None;
        loop {
            let pair = self.next()?;
            if pair.code == 0 {
                if let Some((name, off, frozen)) = layer.take() {
                    let number = self.records.layer(&name);
                    let known = &mut self.records.layers[number as usize];
                    (known.off, known.frozen) = (off, frozen);
                }
                if pair.is(0, "ENDSEC") {
                    return Ok(());
                }
                if pair.is(0, "LAYER") {
                    layer = Some((b"0".to_vec(), false, false));
                }
                continue;
            }
            let Some((name, off, frozen)) = &mut layer else { continue };
            match pair.code {
                2 => *name = pair.text().into_owned(),
                62 => *off = pair.number().is_some_and(|colour| colour < 0.0),
                70 => {
                    let Some(flags) = pair.whole() else { return Err(self.no_whole(&pair)) };
                    *frozen = flags & 1 != 0;
                }
                _ => {}
            }
        }
    }

    fn blocks(&mut self) -> Result<(), ReadError> {
        loop {
            let pair = self.next()?;
            if pair.is(0, "ENDSEC") {
                return Ok(());
            }
            if pair.code != 0 {
                // What follows `0 ENDBLK`.
                continue;
            }
            if !pair.is(0, "BLOCK") {
                return Err(self.pairs.error(
                    pair.spot,
                    "`0 BLOCK` or `0 ENDSEC` is due here".into(),
                    DAMAGED,
                ));
            }
            let begun = pair.spot;
            let (mut name, mut base) = (None, [0.0; 2]);
            loop {
                let pair = self.next()?;
                match pair.code {
                    0 => {
                        self.put_back = Some(pair);
                        break;
                    }
                    2 => name = Some(self.records.block(&pair.text())),
                    10 => base[0] = self.number(&pair)?,
                    20 => base[1] = self.number(&pair)?,
                    _ => {}
                }
            }
            let Some(name) = name else {
                return Err(self.pairs.error(begun, "the block has no name".into(), DAMAGED));
            };
            let from = self.records.entities.len();
            let stop = self.entities(&[b"ENDBLK", b"ENDSEC"])?;
            if stop == b"ENDSEC" {
                return Err(self.pairs.error(begun, "the block has no `0 ENDBLK`".into(), DAMAGED));
            }
            let to = self.records.entities.len();
            let block = &mut self.records.blocks[name as usize];
            if block.defined {
                return Err(self.pairs.error(
                    begun,
                    format!("block {} is defined twice", block.name),
                    DAMAGED,
                ));
            }
            (block.defined, block.base, block.entities) = (true, base, from..to);
        }
    }

    /// Entities up to one of the records named, which is told.
    fn entities(&mut self, stops: &[&'static [u8]]) -> Result<&'static [u8], ReadError> {
        // A polyline goes on over its vertices.
        let mut polyline: Option<Spot> = None;
        // One that is not cut has vertices all the same.
        let mut uncut = false;
        loop {
            let pair = self.next()?;
            if pair.code != 0 {
                return Err(self.pairs.error(
                    self.pairs.begun(),
                    "`0` and an entity are due here".into(),
                    DAMAGED,
                ));
            }
            let name = pair.text();
            let kind = Kind::named(&name);
            match (kind, polyline) {
                (Some(Kind::Vertex), Some(_)) => {
                    self.entity(Kind::Vertex, pair.spot, uncut)?;
                    continue;
                }
                (Some(Kind::Vertex), None) => {
                    return Err(self.pairs.error(
                        pair.spot,
                        "a VERTEX stands outside of a POLYLINE".into(),
                        DAMAGED,
                    ));
                }
                (_, Some(begun)) if &*name != b"SEQEND" => {
                    return Err(self.pairs.error(begun, "the POLYLINE has no SEQEND".into(), DAMAGED));
                }
                _ => {}
            }
            if let Some(stop) = stops.iter().find(|&&stop| *stop == *name) {
                return Ok(stop);
            }
            if &*name == b"EOF" {
                return Err(self.pairs.error(pair.spot, "`0 EOF` stands inside a section".into(), DAMAGED));
            }
            if &*name == b"SEQEND" {
                // The end of a polyline's vertices or of an insert's attributes: no entity of its own.
                if polyline.take().is_some() && !uncut {
                    self.batch.text.extend_from_slice(b"0\nSEQEND\n");
                }
                self.skip()?;
                continue;
            }
            if self.batch.slots.len() >= BATCH {
                self.flush()?;
            }
            match kind {
                Some(kind) => {
                    let cut = self.entity(kind, pair.spot, false)?;
                    if kind == Kind::Polyline {
                        (polyline, uncut) = (Some(pair.spot), !cut);
                    }
                }
                None => {
                    let kind = self.records.kind(&name);
                    self.other(Uncut::Kind(kind), pair.spot)?;
                }
            }
        }
    }

    /// An entity of a kind that is cut; false when this one is not.
    fn entity(&mut self, kind: Kind, spot: Spot, uncut: bool) -> Result<bool, ReadError> {
        let begin = self.batch.text.len();
        let text = |batch: &mut Batch, code: i32, value: &[u8]| {
            let mut digits = [0u8; 4];
            batch.text.extend_from_slice(digits_of(code, &mut digits));
            batch.text.push(b'\n');
            batch.text.extend_from_slice(value);
            batch.text.push(b'\n');
        };
        text(&mut self.batch, 0, kind.name().as_bytes());
        let clockwise = std::mem::take(&mut self.clockwise);
        let mut seen = Seen::default();
        let (mut layer, mut block) = (LAYER_0, None);
        let (mut hidden, mut foreign) = (None, false);
        let mut counts = [0u32; 2];
        match kind {
            // A polyline's heights are those of its vertices.
            Kind::Vertex => {}
            Kind::Ellipse => self.heights = Some([0.0; 2]),
            _ => self.heights = None,
        }
        loop {
            let pair = self.next()?;
            match pair.code {
                0 => {
                    self.put_back = Some(pair);
                    break;
                }
                102 => foreign = matches!(&*pair.text(), [b'{', ..]),
                // An object inside the entity: what follows is its own.
                101 => foreign = true,
                _ if foreign || pair.code >= 1000 => {}
                8 => layer = self.records.layer(&pair.text()),
                2 if kind == Kind::Insert => block = Some(self.records.block(&pair.text())),
                60 if pair.number() == Some(1.0) => hidden = Some(Uncut::Invisible),
                67 if pair.number() == Some(1.0) => hidden = Some(Uncut::Paper),
                30 | 31 if kind.has_height(pair.code) => {
                    let z = self.number(&pair)?;
                    let [low, high] = self.heights.unwrap_or([z; 2]);
                    self.heights = Some([low.min(z), high.max(z)]);
                }
                code => match kind.holds(code) {
                    None => {}
                    Some(holds) => {
                        match holds {
                            Holds::Number => self.number(&pair).map(|_| ())?,
                            Holds::Whole => self.whole(&pair).map(|_| ())?,
                        }
                        if !seen.add(code) && !kind.repeats(code) {
                            let message = format!("code {code} is given twice in one {}", kind.name());
                            return Err(self.pairs.error(pair.spot, message, DAMAGED));
                        }
                        match (kind, code) {
                            (Kind::LwPolyline | Kind::Spline, 10) => counts[0] += 1,
                            (Kind::LwPolyline | Kind::Spline, 20) => counts[1] += 1,
                            (Kind::LwPolyline, 42) if counts[0] == 0 => {
                                let message = "a bulge stands before the first vertex".into();
                                return Err(self.pairs.error(pair.spot, message, DAMAGED));
                            }
                            _ => {}
                        }
                        if counts[1] > counts[0] || counts[0] > counts[1] + 1 {
                            let message = "X (10) and Y (20) do not alternate".into();
                            return Err(self.pairs.error(pair.spot, message, DAMAGED));
                        }
                        text(&mut self.batch, code, &pair.text());
                        // The crate drops points of a spline without Z.
                        match (kind, code) {
                            (Kind::Spline, 20) => text(&mut self.batch, 30, b"0"),
                            (Kind::Spline, 21) => text(&mut self.batch, 31, b"0"),
                            _ => {}
                        }
                    }
                },
            }
        }
        if counts[0] != counts[1] {
            return Err(self.pairs.error(
                spot,
                format!("the last point of the {} has no Y", kind.name()),
                DAMAGED,
            ));
        }
        if let Some(code) = kind.required().iter().find(|&&code| !seen.has(code)) {
            let message = format!("the {} has no code {code}", kind.name());
            return Err(self.pairs.error(spot, message, DAMAGED));
        }
        if kind == Kind::Insert && block.is_none() {
            return Err(self.pairs.error(spot, "the INSERT names no block".into(), DAMAGED));
        }
        if let Some([low, high]) = self.heights
            && high - low > 1e-6 * (1.0 + low.abs())
            && hidden.is_none()
            && !uncut
        {
            self.records.leaving_plane.push(spot.line);
            self.heights = None;
        }
        if kind == Kind::Vertex {
            if uncut {
                self.batch.text.truncate(begin);
            }
            return Ok(!uncut);
        }
        let figure = Figure::Uncut(hidden.unwrap_or(Uncut::Invisible));
        if hidden.is_some() {
            self.batch.text.truncate(begin);
        } else {
            self.batch.slots.push((self.records.entities.len(), kind, block.unwrap_or(0)));
        }
        self.records.entities.push(Entity { figure, layer, line: spot.line, clockwise });
        Ok(hidden.is_none())
    }

    /// An entity that is not cut.
    fn other(&mut self, why: Uncut, spot: Spot) -> Result<(), ReadError> {
        let (mut layer, mut foreign, mut why) = (LAYER_0, false, why);
        loop {
            let pair = self.next()?;
            match pair.code {
                0 => {
                    self.put_back = Some(pair);
                    break;
                }
                102 => foreign = matches!(&*pair.text(), [b'{', ..]),
                101 => foreign = true,
                8 if !foreign => layer = self.records.layer(&pair.text()),
                60 if !foreign && pair.number() == Some(1.0) => why = Uncut::Invisible,
                67 if !foreign && pair.number() == Some(1.0) => why = Uncut::Paper,
                _ => {}
            }
        }
        self.records.entities.push(Entity {
            figure: Figure::Uncut(why),
            layer,
            line: spot.line,
            clockwise: false,
        });
        Ok(())
    }

    /// Passes over the rest of a record.
    fn skip(&mut self) -> Result<(), ReadError> {
        loop {
            let pair = self.next()?;
            if pair.code == 0 {
                self.put_back = Some(pair);
                return Ok(());
            }
        }
    }

    /// Has the batch made into figures, each back in its place.
    fn flush(&mut self) -> Result<(), ReadError> {
        let Batch { text, slots } = std::mem::take(&mut self.batch);
        if slots.is_empty() {
            return Ok(());
        }
        let figures = entity::parse(&text).unwrap_or_default();
        let agree = figures.len() == slots.len()
            && figures.iter().zip(&slots).all(|((kind, _), (_, expected, _))| kind == expected);
        if !agree {
            let line = slots.first().map_or(0, |&(n, ..)| self.records.entities[n].line);
            return Err(self.pairs.error(
                self.pairs.spot(),
                format!("the entities from line {line} on could not be read"),
                DAMAGED,
            ));
        }
        for ((_, mut figure), (n, _, block)) in figures.into_iter().zip(slots) {
            if let Figure::Insert(insert) = &mut figure {
                insert.block = block;
            }
            self.records.entities[n].figure = figure;
        }
        Ok(())
    }

    fn number(&self, pair: &Pair<'_>) -> Result<f64, ReadError> {
        pair.number().ok_or_else(|| {
            let message = format!("code {} holds a number, and this is none", pair.code);
            self.pairs.error(pair.spot, message, DAMAGED)
        })
    }

    fn whole(&self, pair: &Pair<'_>) -> Result<i16, ReadError> {
        pair.whole().ok_or_else(|| self.no_whole(pair))
    }

    fn no_whole(&self, pair: &Pair<'_>) -> ReadError {
        let message = format!("code {} holds a whole number of 16 bits, and this is none", pair.code);
        self.pairs.error(pair.spot, message, DAMAGED)
    }
}

/// The point in a remark about the end of the last entity.
fn ends_at(remark: &Pair<'_>) -> Option<[f64; 2]> {
    let text = remark.text();
    let text = std::str::from_utf8(&text).ok()?.strip_prefix(write::ENDS_AT)?;
    let (x, y) = text.split_once(' ')?;
    let number = |text: &str| text.parse().ok().filter(|v: &f64| v.is_finite());
    Some([number(x)?, number(y)?])
}

/// Which codes have been there.
#[derive(Default)]
struct Seen([u64; 4]);

impl Seen {
    /// Whether the code is there for the first time.
    fn add(&mut self, code: i32) -> bool {
        let (word, bit) = ((code as usize >> 6) & 3, 1 << (code & 63));
        let first = self.0[word] & bit == 0;
        self.0[word] |= bit;
        first
    }

    fn has(&self, code: i32) -> bool {
        self.0[(code as usize >> 6) & 3] & (1 << (code & 63)) != 0
    }
}

fn digits_of(code: i32, buffer: &mut [u8; 4]) -> &[u8] {
    let mut rest = code.unsigned_abs();
    let mut at = buffer.len();
    while at > 0 {
        at -= 1;
        buffer[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    &buffer[at..]
}

/// Entities handed over at a time: enough that the crate's empty drawing costs nothing, and little memory.
const BATCH: usize = 4096;
