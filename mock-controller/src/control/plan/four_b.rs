//! 4B: the outline is programmed, the control holds the offset F and cuts beside it.
//!
//! ```text
//!   OFF ──line──▶ LEADING ──line or arc──▶ CONTOUR ──line off the tangent──▶ LEAVING ──pause, end, lead-in──▶ OFF
//!    ▲              │ pause, end, flagged     │ at the contour's start: the lead-out                            │
//!    └──────────────┘ line: a plain move      └──▶ OFF                          anything else: alarm `tangency` ┘
//! ```
//!
//! The flag of an arc and its sense tell the side: with `D` the radius becomes R + F, with `DD` R − F, so on an arc to
//! the left (NR) `D` puts the wire to the right of the motion by F. Every arc of a contour must tell the same. Nodes
//! are shifted along the normal from the nominal outline, which is what the blocks would do as they stand; so a
//! program that closes at F = 0 closes at any F.
//!
//! Readings of this mock, unverified for any control:
//! - The lead-in is the line before the contour's first element. It goes from where the wire stands to the shifted
//!   start of that element, so nothing moves until the first arc has told the side (at most `LOOK_AHEAD_BLOCKS_MAX`).
//! - Of two lines before a contour the second is the lead-in if it is flagged, or if a pause comes between them.
//! - The lead-out is a line off the tangent, at the contour's start or just before a pause, the end, or a next flagged
//!   lead-in. It goes from the shifted end to its nominal end: back in the start hole the wire stands where F = 0 leaves it.
//! - A line that goes on along the tangent past the contour's start is an overlap, and shifted.
//! - With a taper A keyed in, the upper guide's wire is cut beside the same outline at F − A (`D` on the lead-in) or F + A
//!   (`DD`), under the same rules; over the start hole the wire is vertical. Nothing is cut up there: where A is more
//!   than an arc's radius the wires cross at the cone's apex, and the guide runs on the other side of the centre. (The
//!   paper's die has R 1 and A 6.99.)
//! - A contour of lines alone tells no side, and an arc without a flag no radius: alarms, not guesses.
//!
//! Source: domain/2, "The 4B block".

use std::collections::VecDeque;

use super::{Motion, Path, Planned};
use crate::control::settings::Settings;
use crate::dialect::four_b::{Flag, FourBlock, Fourth};
use crate::dialect::three_b::Kind;
use crate::interpolator::{Model, run};
use crate::outline::{Element, Point, Shape, are_tangent, shifted_node};

pub(in crate::control) struct FourBPlan {
    model: Model,
    /// F, µm, signed.
    offset_um: f64,
    /// A, µm, where a taper is keyed in.
    taper_um: Option<f64>,
    /// The offset at the upper guide, µm, once the lead-in has declared the sense of the taper.
    upper_um: f64,
    /// Where the blocks would have come as they stand.
    nominal: [i64; 2],
    phase: Phase,
    /// Elements of the contour that cannot be cut yet.
    held: VecDeque<Held>,
    /// 1: with F positive the wire is to the right of the motion; −1: to the left.
    side: Option<f64>,
    pub(super) ready: VecDeque<Planned>,
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    Off,
    Leading { line: Held },
    Contour { lead_in: Option<Held>, start: Point },
    Leaving { lead_in: Option<Held>, line: Held },
}

/// A block and the piece of outline it is.
#[derive(Clone, Copy, Debug)]
struct Held {
    block: FourBlock,
    element: Element,
    characters: usize,
}

impl FourBPlan {
    pub(super) fn new(settings: &Settings, stands: [i64; 2]) -> FourBPlan {
        FourBPlan {
            model: settings.interpolator,
            offset_um: settings.wire_offset_um,
            taper_um: settings.taper.map(|taper| taper.shift_um()),
            upper_um: 0.0,
            nominal: stands,
            phase: Phase::Off,
            held: VecDeque::new(),
            side: None,
            ready: VecDeque::new(),
        }
    }

    pub(super) fn block(&mut self, block: FourBlock, characters: usize) {
        let plain = block.block;
        let travel = match run(self.model, &plain, |_, _| {}) {
            Ok(travel) => travel,
            Err(fault) => return self.alarm(fault.cause.name(), format!("{block}: {fault}")),
        };
        let element = Element::of_block(&plain, self.nominal, &travel);
        self.nominal = [self.nominal[0] + travel.dx, self.nominal[1] + travel.dy];
        let held = Held { block, element, characters };
        if travel.pulses == 0 {
            // A block without motion is executed and is no part of the outline.
            return self.as_it_stands(&held);
        }
        match self.phase {
            Phase::Off => self.lead_in(held),
            Phase::Leading { line } if held.is_flagged_line() => {
                self.as_it_stands(&line);
                self.lead_in(held);
            }
            Phase::Leading { line } => {
                if let Err((name, found)) = self.declare_taper(&line) {
                    return self.alarm(name, found);
                }
                self.phase = Phase::Contour { lead_in: Some(line), start: line.element.to };
                self.append(held);
            }
            Phase::Contour { .. } => self.append(held),
            Phase::Leaving { line, .. } if held.is_flagged_line() => {
                self.leave(Some(line));
                self.lead_in(held);
            }
            Phase::Leaving { line, .. } => self.not_tangent(&line),
        }
    }

    /// A stop word D: it parts a move from a lead-in and a lead-out from what follows. Within a contour it only waits.
    pub(super) fn pause(&mut self) {
        match self.phase {
            Phase::Leading { line } if !line.is_flagged_line() => {
                self.as_it_stands(&line);
                self.phase = Phase::Off;
            }
            Phase::Leaving { line, .. } => self.leave(Some(line)),
            Phase::Off | Phase::Leading { .. } | Phase::Contour { .. } => {}
        }
    }

    pub(super) fn end(&mut self) {
        match self.phase {
            Phase::Off => {}
            Phase::Leading { line } => self.as_it_stands(&line),
            Phase::Contour { .. } => self.leave(None),
            Phase::Leaving { line, .. } => self.leave(Some(line)),
        }
        self.phase = Phase::Off;
        self.ready.push_back(Planned::End);
    }

    fn lead_in(&mut self, held: Held) {
        if held.block.block.kind == Kind::Line {
            self.phase = Phase::Leading { line: held };
        } else {
            self.alarm("lead-in", format!("{}: no line leads to this arc", held.block));
        }
    }

    /// The lead-in's flag: `D` a positive taper, the upper guide's offset is F − A; `DD` the inverse, F + A.
    fn declare_taper(&mut self, lead_in: &Held) -> Result<(), (&'static str, String)> {
        self.upper_um = match (self.taper_um, lead_in.block.marks.map(|marks| marks.flag)) {
            (None, _) => self.offset_um,
            (Some(shift), Some(Flag::D)) => self.offset_um - shift,
            (Some(shift), Some(Flag::DD)) => self.offset_um + shift,
            (Some(_), None) => {
                let found = format!("{}: a lead-in without D or DD, with a taper keyed in", lead_in.block);
                return Err(("taper", found));
            }
        };
        Ok(())
    }

    /// Takes the next element of the contour.
    fn append(&mut self, held: Held) {
        let Phase::Contour { lead_in, start } = self.phase else {
            return;
        };
        if let Some(last) = self.held.back()
            && !are_tangent(&last.element, &held.element)
        {
            if held.block.block.kind != Kind::Line {
                return self.not_tangent(&held);
            }
            if last.element.to.minus(start).length() <= CLOSED_UM {
                return self.leave(Some(held));
            }
            self.phase = Phase::Leaving { lead_in, line: held };
            return;
        }
        if held.block.block.kind != Kind::Line
            && let Err((name, found)) = self.told_by(&held)
        {
            return self.alarm(name, found);
        }
        self.held.push_back(held);
        if self.side.is_some() {
            self.release();
        } else if self.held.len() > LOOK_AHEAD_BLOCKS_MAX {
            self.alarm("side", format!("no arc within {LOOK_AHEAD_BLOCKS_MAX} blocks tells the side"));
        }
    }

    /// What an arc tells: the side, and whether its radius bears the offset.
    fn told_by(&mut self, held: &Held) -> Result<(), (&'static str, String)> {
        let block = held.block;
        let Some(marks) = block.marks else {
            return Err(("flag", format!("{block}: an arc without D or DD, with an offset held")));
        };
        let Fourth::Radius(radius) = marks.fourth else {
            return Err(("radius", format!("{block}: an arc without R")));
        };
        let radius = f64::from(radius);
        let drawn = held.element.size();
        if (radius - drawn).abs() > RADIUS_SLACK_UM {
            return Err(("radius", format!("{block}: R {radius} µm, but X and Y give {drawn:.1} µm")));
        }
        let grows = match marks.flag {
            Flag::D => 1.0,
            Flag::DD => -1.0,
        };
        let becomes = radius + grows * self.offset_um;
        if becomes <= 0.0 {
            return Err(("radius", format!("{block}: R {radius} µm becomes {becomes} µm")));
        }
        let Shape::Arc { turn, .. } = held.element.shape else {
            return Ok(());
        };
        // The centre of an arc to the left is on the left: what grows goes to the right.
        let side = grows * turn.sign();
        if *self.side.get_or_insert(side) == side {
            Ok(())
        } else {
            Err(("side", format!("{block}: its flag puts the wire on the other side")))
        }
    }

    /// Sets free what has a known end.
    fn release(&mut self) {
        while self.held.len() >= 2 {
            let next = self.held.get(1).copied();
            if let Some(held) = self.held.pop_front() {
                self.shifted(&held, next.as_ref());
            }
        }
    }

    /// One element of the contour, and before the first the lead-in.
    fn shifted(&mut self, held: &Held, next: Option<&Held>) {
        let side = self.side.unwrap_or_default();
        if let Phase::Contour { lead_in, .. } | Phase::Leaving { lead_in, .. } = &mut self.phase
            && let Some(lead_in) = lead_in.take()
        {
            let start = |offset| shifted_node(None, Some(&held.element), side * offset);
            self.cut(&lead_in, |offset| start(offset).map(|start| Path::To(start.rounded())));
        }
        let next = next.map(|next| &next.element);
        self.cut(held, |offset| {
            let to = shifted_node(Some(&held.element), next, side * offset)?;
            Some(match held.element.shape {
                Shape::Line => Path::To(to.rounded()),
                Shape::Arc { turn, .. }
                    if (held.element.size() + turn.sign() * side * offset).abs() < APEX_UM =>
                {
                    Path::To(to.rounded())
                }
                Shape::Arc { centre, turn, sweep } => {
                    Path::Round { centre: centre.rounded(), turn, sweep, to, ends: None }
                }
            })
        });
    }

    /// The contour is over: all of it is set free, and then the lead-out.
    fn leave(&mut self, lead_out: Option<Held>) {
        if self.side.is_none() {
            return self.alarm("side", "no arc of the contour tells the side".to_owned());
        }
        self.flush();
        if let Some(held) = lead_out {
            self.cut(&held, |_| Some(Path::To(held.element.to.rounded())));
        }
        self.side = None;
        self.phase = Phase::Off;
    }

    fn flush(&mut self) {
        self.release();
        if let Some(last) = self.held.pop_front() {
            self.shifted(&last, None);
        }
    }

    fn as_it_stands(&mut self, held: &Held) {
        self.cut(held, |_| Some(Path::Block(held.block.block)));
    }

    /// Has a block cut along the path that an offset gives it, below and, with a taper, above.
    fn cut(&mut self, held: &Held, path: impl Fn(f64) -> Option<Path>) {
        let as_it_stands = Path::Block(held.block.block);
        // Without an offset a block stays what it is.
        let along =
            |offset: f64| if offset == 0.0 { as_it_stands } else { path(offset).unwrap_or(as_it_stands) };
        let lower = along(self.offset_um);
        let upper = self.taper_um.map(|_| path(self.upper_um).unwrap_or(as_it_stands));
        self.ready.push_back(Planned::Cut(Motion { lower, then: None, upper, characters: held.characters }));
    }

    fn not_tangent(&mut self, held: &Held) {
        self.alarm("tangency", format!("{}: not tangent to the block before it", held.block));
    }

    fn alarm(&mut self, name: &'static str, found: String) {
        if self.side.is_some() {
            self.flush();
        }
        self.ready.push_back(Planned::Alarm { name, found });
    }
}

impl Held {
    fn is_flagged_line(&self) -> bool {
        self.block.marks.is_some() && self.block.block.kind == Kind::Line
    }
}

/// How far R may be from what X and Y give: half a micron each, and a writer's choice among neighbours (a guess).
const RADIUS_SLACK_UM: f64 = 5.0;

/// A radius so small that whole µm do not tell where on the circle a point stands: the guide stands at the apex.
const APEX_UM: f64 = 2.0;

/// How near its start a contour counts as closed: the drift of blocks rounded one by one (domain/1: 1 µm; domain/2: up
/// to 6.7 µm an arc).
const CLOSED_UM: f64 = 20.0;

/// Most blocks read before the first arc of a contour. A guess; it bounds the memory.
const LOOK_AHEAD_BLOCKS_MAX: usize = 1000;
