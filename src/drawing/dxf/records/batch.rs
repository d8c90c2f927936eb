//! Entities handed over to the `dxf` crate, many at a time, and what comes back held against what was handed over.

use crate::formats::ReadError;

use super::sections::{DAMAGED, Reading};
use crate::drawing::dxf::entity::{self, Figure, Kind};

/// Entities on their way to the `dxf` crate and back.
#[derive(Debug, Default)]
pub(super) struct Batch {
    pub(super) text: Vec<u8>,
    /// For each: which of the entities it is, its kind, and the block it inserts.
    pub(super) slots: Vec<(usize, Kind, u32)>,
}

impl Reading<'_> {
    /// Has the batch made into figures, each back in its place.
    pub(super) fn flush(&mut self) -> Result<(), ReadError> {
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
}

/// Entities handed over at a time: enough that the crate's empty drawing costs nothing, and little memory.
pub(super) const BATCH: usize = 4096;
