//! The records of a file: header, layers, blocks and entities, each checked before anything is made of it.
//!
//! What is damaged is an error with its place; what is merely not for cutting is kept as such and counted later. What is
//! drawn, and where, is not worked out here: that is `model`.

mod batch;
mod entities;
mod names;
mod sections;

use std::collections::HashMap;
use std::ops::Range;

use crate::formats::ReadError;
use crate::place::Spot;

use super::entity::Figure;
use names::number_of;
use sections::Reading;

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
        let mut reading = Reading::of(bytes, records)?;
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
