//! The wire's own path, where the control sets it off the programmed one: by G41 and G42, or as keyed in for 4B.
//!
//! What the control would do is worked out by [`crate::compensation`] and [`crate::formats::four_b::offset`]; here it is
//! judged: an offset that cannot be done, a part of the contour that the wire cannot enter, a path of the wire that crosses
//! itself though the contour does not, or that needs more travel than the program.
//! How large an offset is often stands in the control alone, in a register or keyed in. Where it is not given nothing is
//! claimed, and that is said.

use std::collections::BTreeMap;

use super::Finding;
use super::contours::{Contours, Run};
use super::crossing::{Found, Stretch, search};
use super::travel::{Reach, Travel};
use crate::compensation::{Compensated, Warning};
use crate::formats::ReadError;
use crate::formats::four_b::offset::{Keyed, beside};
use crate::geometry::offset::Corners;
use crate::motion::runs::ContourError;
use crate::motion::{Act, Motion, Offset};
use crate::place::Spot;

/// What a control knows of its wire besides the program.
#[derive(Clone, Debug, PartialEq)]
pub enum Known {
    /// What its offset registers hold, mm.
    Registers(BTreeMap<u32, f64>),
    /// What is keyed into it for 4B.
    Keyed(Keyed),
}

/// What comes of following the wire.
#[derive(Debug)]
pub enum Seen<'a> {
    /// The program switches an offset on.
    Switched,
    /// The wire moves so.
    Motion(&'a Motion),
    /// The wire cannot enter a part of the contour.
    Passed(&'a Warning),
    /// The offset cannot be done.
    Failed(&'a ContourError),
    /// A register holds the distance, and what it holds is not known; the wire is followed no further.
    Unknown(u32),
}

/// How far the wire's own path was looked at.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Looked {
    /// The programmed path is the wire's.
    #[default]
    NoOffset,
    /// It was.
    Whole,
    /// It was not, for want of what this register of the control holds.
    Unknown(u32),
    /// It was not, for want of the offset that is keyed in.
    NotKeyed,
}

/// Follows motions and beside them the wire, with what the control knows.
///
/// `next` gives the program's motions, to its end; `show` is told what comes of each.
pub fn follow(mut next: impl FnMut() -> Option<Motion>, known: &Known, mut show: impl FnMut(&Seen<'_>)) {
    match known {
        Known::Registers(registers) => follow_registers(next, registers, show),
        Known::Keyed(keyed) => {
            show(&Seen::Switched);
            let source = std::iter::from_fn(|| next().map(Ok::<_, ReadError>));
            for motion in beside(source, *keyed) {
                match &motion {
                    Ok(motion) => show(&Seen::Motion(motion)),
                    Err(error) => show(&Seen::Failed(error)),
                }
            }
            while next().is_some() {}
        }
    }
}

fn follow_registers(
    next: impl FnMut() -> Option<Motion>,
    registers: &BTreeMap<u32, f64>,
    mut show: impl FnMut(&Seen<'_>),
) {
    let next = std::cell::RefCell::new(next);
    let pull = || (next.borrow_mut())();
    let (switched, unknown) = (std::cell::Cell::new(false), std::cell::Cell::new(None));
    let source = std::iter::from_fn(|| -> Option<Result<Motion, ReadError>> {
        let motion = pull()?;
        if let Act::Offset(Offset::On { distance: None, register, .. }) = motion.act
            && register.is_none_or(|register| !registers.contains_key(&register))
        {
            unknown.set(unknown.get().or(register));
        }
        switched.set(switched.get() || matches!(motion.act, Act::Offset(Offset::On { .. })));
        Some(Ok(motion))
    });
    let mut wire = Compensated::new(source, registers.clone(), Corners::Round);
    let mut is_told = false;
    while let Some(motion) = wire.next() {
        if switched.get() && !std::mem::replace(&mut is_told, true) {
            show(&Seen::Switched);
        }
        match (&motion, unknown.get()) {
            (Err(_), Some(register)) => show(&Seen::Unknown(register)),
            (Err(error), None) => show(&Seen::Failed(error)),
            (Ok(motion), _) => show(&Seen::Motion(motion)),
        }
        wire.take_warnings().iter().for_each(|warning| show(&Seen::Passed(warning)));
    }
    drop(wire);
    // Behind an offset that cannot be done the program itself goes on.
    while pull().is_some() {}
}

/// Judges the wire's path.
#[derive(Debug)]
pub(super) struct Wire {
    looked: Looked,
    contours: Contours,
    reach: Reach,
    /// Blocks at which the programmed path crosses itself, or has a corner that 4B cannot have.
    told: Vec<u64>,
}

impl Wire {
    pub(super) fn new(travel: Travel) -> Self {
        let reach = Reach::of_wire(travel);
        Self { looked: Looked::default(), contours: Contours::default(), reach, told: Vec::new() }
    }

    pub(super) fn looked(&self) -> Looked {
        self.looked
    }

    /// Takes a motion of the program itself: one with 4B's flag is for an offset that is keyed in.
    pub(super) fn see_programmed(&mut self, motion: &Motion) {
        if self.looked == Looked::NoOffset && matches!(motion.act, Act::Move { flag: Some(_), .. }) {
            self.looked = Looked::NotKeyed;
        }
    }

    /// Remembers what was found in the programmed path, which the wire's path repeats.
    pub(super) fn note(&mut self, finding: &Finding) {
        if matches!(finding.code, "crossing" | "not-tangent") && self.told.len() < TOLD_MAX {
            self.told.push(finding.block);
        }
    }

    /// `beyond` says in which axes the program itself needs more travel than there is.
    pub(super) fn see(&mut self, seen: &Seen<'_>, beyond: [bool; 2], tell: &mut impl FnMut(Finding)) {
        match *seen {
            Seen::Switched => self.looked = Looked::Whole,
            Seen::Unknown(register) => self.looked = Looked::Unknown(register),
            Seen::Motion(motion) => {
                let Self { contours, told, reach, .. } = self;
                reach.see_beyond(motion, beyond, tell);
                contours.see(motion, Default::default(), Default::default(), &mut |run| {
                    crossings(&run, told, tell);
                });
            }
            Seen::Passed(warning) => {
                let Warning { block, spot, .. } = *warning;
                tell(Finding::error("offset-too-large", spot, block, warning.message()).help(warning.help()));
            }
            // A corner that 4B cannot have is told by whoever looks for corners.
            Seen::Failed(ContourError::Contour { block, .. }) if self.told.contains(block) => {}
            Seen::Failed(ContourError::Contour { message, block, spot, help }) => {
                tell(Finding::error("offset-fails", *spot, *block, message.clone()).help(help.clone()));
            }
            // What cannot be read is told by whoever reads.
            Seen::Failed(ContourError::Read(_)) => {}
        }
    }

    pub(super) fn finish(&mut self, tell: &mut impl FnMut(Finding)) {
        let Self { contours, told, looked, .. } = self;
        if *looked != Looked::NoOffset {
            contours.finish(&mut |run| crossings(&run, told, tell));
        }
    }
}

/// Blocks that are remembered.
const TOLD_MAX: usize = 1000;

fn crossings(run: &Run<'_>, told: &[u64], tell: &mut impl FnMut(Finding)) {
    let stretch = match *run {
        Run::Ring { lead, ring, .. } => Stretch { lead, ring, is_closed: true },
        Run::Rest { held, fresh, .. } => {
            Stretch { lead: &[], ring: &held[held.len() - fresh..], is_closed: false }
        }
        Run::Retrace(_) | Run::TooLong(_) => return,
    };
    let Found::All(crosses) = search(&stretch) else { return };
    for cross in crosses {
        let (block, spot): (u64, Spot) = stretch.place(cross.later);
        let earlier = stretch.place(cross.earlier).0;
        if !told.contains(&block) {
            let message = format!(
                "the wire crosses its own path of block {earlier} at {:.3}, {:.3} mm, and the contour does not",
                cross.at.x, cross.at.y
            );
            tell(
                Finding::error("wire-crossing", spot, block, message)
                    .help("the offset is too large for the contour, or leads in from the wrong side"),
            );
        }
    }
}
