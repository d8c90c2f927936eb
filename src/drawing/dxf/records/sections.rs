//! The sections of a file: the header's variables, the table of layers, blocks, entities. All others are passed over.

use crate::drawing::dxf::pairs::{Pair, Pairs};
use crate::drawing::dxf::write;
use crate::formats::ReadError;

use super::Records;
use super::batch::{AtWork, Batch};

/// A file as it is read.
pub(super) struct Reading<'a> {
    pub(super) pairs: Pairs<'a>,
    pub(super) put_back: Option<Pair<'a>>,
    pub(super) records: Records,
    pub(super) batch: Batch,
    pub(super) at_work: AtWork,
    pub(super) clockwise: bool,
    /// The lowest and highest Z of an entity.
    pub(super) heights: Option<[f64; 2]>,
}

pub(super) const DAMAGED: &str = "the drawing is damaged here: save it again from the program that drew it";

impl<'a> Reading<'a> {
    pub(super) fn of(bytes: &'a [u8], records: Records) -> Result<Self, ReadError> {
        let pairs = Pairs::of(bytes)?;
        Ok(Self {
            pairs,
            put_back: None,
            records,
            batch: Batch::default(),
            at_work: AtWork::default(),
            clockwise: false,
            heights: None,
        })
    }

    /// The next pair that is no remark.
    pub(super) fn next(&mut self) -> Result<Pair<'a>, ReadError> {
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

    pub(super) fn file(&mut self) -> Result<(), ReadError> {
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

    pub(super) fn number(&self, pair: &Pair<'_>) -> Result<f64, ReadError> {
        pair.number().ok_or_else(|| {
            let message = format!("code {} holds a number, and this is none", pair.code);
            self.pairs.error(pair.spot, message, DAMAGED)
        })
    }

    pub(super) fn whole(&self, pair: &Pair<'_>) -> Result<i16, ReadError> {
        pair.whole().ok_or_else(|| self.no_whole(pair))
    }

    pub(super) fn no_whole(&self, pair: &Pair<'_>) -> ReadError {
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
