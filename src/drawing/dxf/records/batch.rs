//! Entities handed over to the `dxf` crate, many at a time, and what comes back held against what was handed over.
//!
//! While the crate works on one batch the file is read on. What it makes of a batch goes back into the places kept for
//! it, so in the records nothing tells which thread was done first.

use std::collections::VecDeque;
use std::thread::JoinHandle;

use crate::drawing::dxf::entity::{self, Figure, Kind};
use crate::formats::ReadError;
use crate::place::Spot;

use super::sections::{DAMAGED, Reading};

/// Entities on their way to the `dxf` crate.
#[derive(Debug, Default)]
pub(super) struct Batch {
    pub(super) text: Vec<u8>,
    pub(super) slots: Vec<Slot>,
}

/// The place kept for an entity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    /// Which of the entities it is.
    pub(super) entity: usize,
    pub(super) kind: Kind,
    /// The block it inserts.
    pub(super) block: u32,
}

impl Batch {
    /// Whether it is to be handed over before the next entity.
    pub(super) fn is_full(&self) -> bool {
        self.slots.len() >= ENTITIES || self.text.len() >= BYTES
    }
}

/// Batches that the crate works on, in the order of the file.
#[derive(Debug, Default)]
pub(super) struct AtWork(VecDeque<Working>);

#[derive(Debug)]
struct Working {
    thread: JoinHandle<Figures>,
    slots: Vec<Slot>,
    /// Where reading stood.
    spot: Spot,
}

/// What the crate makes of a batch; none when it cannot read it.
type Figures = Option<Vec<(Kind, Figure)>>;

impl Reading<'_> {
    /// Hands the batch over.
    pub(super) fn hand_over(&mut self) -> Result<(), ReadError> {
        if self.at_work.0.len() >= BATCHES {
            self.take_back()?;
        }
        let Batch { text, slots } = std::mem::take(&mut self.batch);
        // It owns its text: where reading ends in an error, it comes to an end by itself.
        let thread = std::thread::spawn(move || entity::parse(&text));
        self.at_work.0.push_back(Working { thread, slots, spot: self.pairs.spot() });
        Ok(())
    }

    /// Has the last batch made into figures, and waits for all others.
    pub(super) fn flush(&mut self) -> Result<(), ReadError> {
        let Batch { text, slots } = std::mem::take(&mut self.batch);
        let last = if slots.is_empty() { Some(Vec::new()) } else { entity::parse(&text) };
        while !self.at_work.0.is_empty() {
            self.take_back()?;
        }
        self.put_in_place(last, slots, self.pairs.spot())
    }

    /// Waits for the first batch that was handed over.
    fn take_back(&mut self) -> Result<(), ReadError> {
        let Some(Working { thread, slots, spot }) = self.at_work.0.pop_front() else { return Ok(()) };
        match thread.join() {
            Ok(figures) => self.put_in_place(figures, slots, spot),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }

    fn put_in_place(&mut self, figures: Figures, slots: Vec<Slot>, spot: Spot) -> Result<(), ReadError> {
        let figures = figures.unwrap_or_default();
        let agree = figures.len() == slots.len()
            && figures.iter().zip(&slots).all(|((kind, _), slot)| *kind == slot.kind);
        if !agree {
            let line = slots.first().map_or(0, |slot| self.records.entities[slot.entity].line);
            let message = format!("the entities from line {line} on could not be read");
            return Err(self.pairs.error(spot, message, DAMAGED));
        }
        for ((_, mut figure), slot) in figures.into_iter().zip(slots) {
            if let Figure::Insert(insert) = &mut figure {
                insert.block = slot.block;
            }
            self.records.entities[slot.entity].figure = figure;
        }
        Ok(())
    }
}

/// Entities handed over at a time, and bytes of their text: enough that the crate's empty drawing costs nothing, and
/// little memory.
const ENTITIES: usize = 4096;
const BYTES: usize = 1 << 20;
/// Batches at work at a time: reading takes less time than making, so one more than the one next to be done.
const BATCHES: usize = 2;
