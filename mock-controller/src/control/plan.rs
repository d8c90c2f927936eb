//! The plan: what the control makes of the program's words before it cuts.
//!
//! ```text
//!   buffer ──block──▶ plan ──motions, in order──▶ cutter
//!                      │ 3B: as they stand
//!                      │ 4B: the outline shifted by the offset the control holds (four_b)
//!                      │ G-code: words carried out, the outline shifted where told (gcode)
//! ```
//!
//! A plan may hold blocks back until a later one tells where they end; a program's end sets them free. A motion says
//! where to go, not from where: that is known only when the wire stands there.

mod four_b;
pub(super) mod gcode;

use std::collections::{BTreeMap, VecDeque};

use super::settings::Settings;
use crate::dialect::Dialect;
use crate::dialect::four_b::FourBlock;
use crate::dialect::gcode::Line;
use crate::dialect::three_b::Block;
use crate::interpolator::{Model, run};
use crate::outline::{Point, Turn, aim, swept};
use four_b::FourBPlan;
use gcode::GcodePlan;

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
    /// And then, as part of the same block: the way round a corner.
    pub(super) then: Option<Path>,
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
    /// Round about a centre, to near a place; with `ends` the last micron is stepped straight.
    Round { centre: [i64; 2], turn: Turn, sweep: f64, to: Point, ends: Option<[i64; 2]> },
}

/// What the interpolator is given at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) block: Block,
    /// Its nominal length, µm, where it is not what the block says.
    pub(super) length_um: Option<f64>,
}

impl Motion {
    /// What does it from where the wire stands; `None`: it stands on a centre.
    pub(super) fn strokes(&self, model: Model, from: [i64; 2]) -> Option<Vec<Stroke>> {
        let mut strokes = Vec::with_capacity(1);
        let stands = self.lower.strokes(model, from, self.then.is_some(), &mut strokes)?;
        if let Some(then) = self.then {
            then.strokes(model, stands, false, &mut strokes)?;
        }
        Some(strokes)
    }
}

impl Path {
    /// The block that does it from where the wire stands; `None`: it stands on the centre.
    pub(super) fn block(self, model: Model, from: [i64; 2]) -> Option<Block> {
        match self {
            Path::Block(block) => Some(block),
            Path::To(to) => Some(aim::line(from, to)),
            Path::Round { centre, turn, sweep, to, .. } => aim::arc(model, from, centre, turn, sweep, to),
        }
    }

    /// As [`Path::block`], with the last micron. Where the wire then stands is worked out only if it matters.
    fn strokes(
        self,
        model: Model,
        from: [i64; 2],
        goes_on: bool,
        strokes: &mut Vec<Stroke>,
    ) -> Option<[i64; 2]> {
        let block = self.block(model, from)?;
        let (ends, length_um) = match self {
            Path::Round { centre, turn, sweep, to, ends: Some(ends) } => {
                let (centre, from) = (Point::whole(centre), Point::whole(from));
                let sweep = swept(centre, turn, from, to, sweep).max(0.0);
                (Some(ends), Some(from.minus(centre).length() * sweep))
            }
            Path::Round { ends: None, .. } | Path::Block(_) | Path::To(_) => (None, None),
        };
        strokes.push(Stroke { block, length_um });
        if !goes_on && ends.is_none() {
            return Some(from);
        }
        let travel = run(model, &block, |_, _| {}).unwrap_or_else(|fault| fault.travel);
        let stands = [from[0] + travel.dx, from[1] + travel.dy];
        let Some(ends) = ends else {
            return Some(stands);
        };
        if stands != ends {
            strokes.push(Stroke { block: aim::line(stands, ends), length_um: Some(0.0) });
        }
        Some(ends)
    }
}

/// A plan, by dialect.
pub(super) enum Plan {
    /// Every block as it stands.
    Plain {
        ready: VecDeque<Planned>,
    },
    FourB(Box<FourBPlan>),
    Gcode(Box<GcodePlan>),
}

impl Plan {
    /// The plan of a control that stands somewhere.
    pub(super) fn new(settings: &Settings, stands: [i64; 2]) -> Plan {
        match settings.dialect {
            Dialect::FourB if settings.wire_offset_um != 0.0 || settings.taper.is_some() => {
                Plan::FourB(Box::new(FourBPlan::new(settings, stands)))
            }
            Dialect::Gcode => Plan::Gcode(Box::new(GcodePlan::new(settings, stands))),
            Dialect::ThreeB | Dialect::FourB => Plan::Plain { ready: VecDeque::new() },
        }
    }

    /// What is to be done next; `None`: more of the program is needed.
    pub(super) fn next(&mut self) -> Option<Planned> {
        match self {
            Plan::Plain { ready } => ready.pop_front(),
            Plan::FourB(plan) => plan.ready.pop_front(),
            Plan::Gcode(plan) => plan.next(),
        }
    }

    /// Takes a block.
    pub(super) fn block(&mut self, block: FourBlock, characters: usize) {
        match self {
            Plan::Plain { ready } => {
                let lower = Path::Block(block.block);
                ready.push_back(Planned::Cut(Motion { lower, then: None, upper: None, characters }));
            }
            Plan::FourB(plan) => plan.block(block, characters),
            Plan::Gcode(_) => {} // Its reader gives no blocks.
        }
    }

    /// Takes a line.
    pub(super) fn line(&mut self, line: Line, characters: usize) {
        match self {
            Plan::Plain { .. } | Plan::FourB(_) => {} // Their reader gives no lines.
            Plan::Gcode(plan) => plan.line(line, characters),
        }
    }

    /// Words that were understood and not acted on, by word.
    pub(super) fn passed_over(&self) -> BTreeMap<String, u64> {
        match self {
            Plan::Plain { .. } | Plan::FourB(_) => BTreeMap::new(),
            Plan::Gcode(plan) => plan.passed_over(),
        }
    }

    /// Takes a stop word D.
    pub(super) fn pause(&mut self) {
        match self {
            Plan::Plain { .. } | Plan::Gcode(_) => {}
            Plan::FourB(plan) => plan.pause(),
        }
    }

    /// Takes the program's end.
    pub(super) fn end(&mut self) {
        match self {
            Plan::Plain { ready } => ready.push_back(Planned::End),
            Plan::FourB(plan) => plan.end(),
            Plan::Gcode(plan) => plan.end(),
        }
    }
}
