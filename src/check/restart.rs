//! Blocks at which a job can be taken up safely.
//!
//! Offset and taper must be off, since a control that was switched off has forgotten them, and the wire must be threaded
//! where it can stand free: where the program begins, after a stop or a rapid move, and where a contour begins, which the
//! wire can reach again through its own lead-in.

use super::contours::Run;
use super::modal::State;
use crate::geometry::Point;
use crate::motion::{Act, Motion, Travel};

/// A block to begin with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestartPoint {
    /// The block.
    pub block: u64,
    /// Where the wire must stand, mm from where the program began.
    pub at: Point,
    /// Why it is safe there.
    pub why: &'static str,
}

/// Collects restart points.
#[derive(Debug, Default)]
pub(super) struct Restart {
    points: Vec<RestartPoint>,
    more: u64,
    began: bool,
    after_rapid: bool,
}

/// The most points that are listed.
const POINTS_MAX: usize = 100_000;

impl Restart {
    pub(super) fn see(&mut self, motion: &Motion, state: State) {
        let Act::Move { travel, element, .. } = &motion.act else { return };
        let why = match (self.began, travel) {
            (false, _) => Some("where the program begins"),
            (true, Travel::Cut) if self.after_rapid => Some("first cut after a rapid move"),
            (true, _) => None,
        };
        self.began = true;
        self.after_rapid = *travel == Travel::Rapid;
        if let Some(why) = why
            && state == State::default()
        {
            self.add(motion.block, element.start(), why);
        }
    }

    pub(super) fn see_run(&mut self, run: &Run<'_>) {
        let first = match *run {
            Run::Ring { ring, .. } => ring.first().map(|first| (first, "a contour begins")),
            Run::Rest { held, .. } => held.first().map(|first| (first, "first cut after a stop")),
            Run::Retrace(_) | Run::TooLong(_) => None,
        };
        if let Some((first, why)) = first
            && first.side.is_none()
            && !first.is_tapered
        {
            self.add(first.block, first.element.start(), why);
        }
    }

    fn add(&mut self, block: u64, at: Point, why: &'static str) {
        if self.points.len() == POINTS_MAX {
            self.more += 1;
        } else {
            self.points.push(RestartPoint { block, at, why });
        }
    }

    /// The points in the order of their blocks, each once, and how many more there are.
    pub(super) fn finish(mut self) -> (Vec<RestartPoint>, u64) {
        // What was told first of a block is the stronger reason.
        self.points.sort_by_key(|point| point.block);
        self.points.dedup_by_key(|point| point.block);
        (self.points, self.more)
    }
}
