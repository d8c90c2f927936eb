//! The entities of a section or a block, pair by pair: what every one of them must have, and what none may have twice.
//!
//! An entity that is cut goes on as text to `batch`; of any other its kind and layer are kept.

use crate::drawing::dxf::entity::{Figure, Holds, Kind, Uncut};
use crate::formats::ReadError;
use crate::place::Spot;

use super::batch::{Batch, Slot};
use super::sections::{DAMAGED, Reading};
use super::{Entity, LAYER_0};

impl Reading<'_> {
    /// Entities up to one of the records named, which is told.
    pub(super) fn entities(&mut self, stops: &[&'static [u8]]) -> Result<&'static [u8], ReadError> {
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
            if self.batch.is_full() {
                self.hand_over()?;
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
            self.batch.slots.push(Slot {
                entity: self.records.entities.len(),
                kind,
                block: block.unwrap_or(0),
            });
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
