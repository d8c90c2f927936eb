//! The plan: what the control makes of the program's words before it cuts.
//!
//! ```text
//!   buffer ──block──▶ plan ──motions, in order──▶ cutter
//!                      │ 3B: as they stand
//!                      │ 4B: the outline shifted by the offset the control holds (four_b)
//! ```
//!
//! A plan may hold blocks back until a later one tells where they end; a program's end sets them free. A motion says
//! where to go, not from where: that is known only when the wire stands there.

mod four_b;

use std::collections::VecDeque;

use super::settings::Settings;
use crate::dialect::Dialect;
use crate::dialect::four_b::FourBlock;
use crate::dialect::three_b::Block;
use crate::interpolator::Model;
use crate::outline::{Point, Turn, aim};
use four_b::FourBPlan;

/// What the cutter is to do next.
pub(super) enum Planned {
    Cut(Motion),
    /// The program has ended.
    End,
    Alarm {
        name: &'static str,
        found: String,
    },
}

/// One block of the program, ready to be cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// What the wire does in the plane of the program.
    pub(super) lower: Path,
    /// What it does at the upper guide, if a taper is keyed in.
    pub(super) upper: Option<Path>,
    /// Characters the block had on the line: its cutting time is a multiple of theirs.
    pub(super) characters: usize,
}

/// Where a motion goes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Path {
    /// By this block, as it stands.
    Block(Block),
    /// Straight to a place.
    To([i64; 2]),
    /// Round about a centre.
    Round { centre: [i64; 2], turn: Turn, sweep: f64, to: Point },
}

impl Path {
    /// The block that does it from where the wire stands; `None`: it stands on the centre.
    pub(super) fn block(self, model: Model, from: [i64; 2]) -> Option<Block> {
        match self {
            Path::Block(block) => Some(block),
            Path::To(to) => Some(aim::line(from, to)),
            Path::Round { centre, turn, sweep, to } => aim::arc(model, from, centre, turn, sweep, to),
        }
    }
}

/// A plan, by dialect.
pub(super) enum Plan {
    /// Every block as it stands.
    Plain {
        ready: VecDeque<Planned>,
    },
    FourB(Box<FourBPlan>),
}

impl Plan {
    /// The plan of a control that stands somewhere.
    pub(super) fn new(settings: &Settings, stands: [i64; 2]) -> Plan {
        match settings.dialect {
            Dialect::FourB if settings.wire_offset_um != 0.0 || settings.taper.is_some() => {
                Plan::FourB(Box::new(FourBPlan::new(settings, stands)))
            }
            Dialect::ThreeB | Dialect::FourB => Plan::Plain { ready: VecDeque::new() },
        }
    }

    /// What is to be done next; `None`: more of the program is needed.
    pub(super) fn next(&mut self) -> Option<Planned> {
        match self {
            Plan::Plain { ready } => ready.pop_front(),
            Plan::FourB(plan) => plan.ready.pop_front(),
        }
    }

    /// Takes a block.
    pub(super) fn block(&mut self, block: FourBlock, characters: usize) {
        match self {
            Plan::Plain { ready } => {
                let lower = Path::Block(block.block);
                ready.push_back(Planned::Cut(Motion { lower, upper: None, characters }));
            }
            Plan::FourB(plan) => plan.block(block, characters),
        }
    }

    /// Takes a stop word D.
    pub(super) fn pause(&mut self) {
        match self {
            Plan::Plain { .. } => {}
            Plan::FourB(plan) => plan.pause(),
        }
    }

    /// Takes the program's end.
    pub(super) fn end(&mut self) {
        match self {
            Plan::Plain { ready } => ready.push_back(Planned::End),
            Plan::FourB(plan) => plan.end(),
        }
    }
}
