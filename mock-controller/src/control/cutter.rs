//! The cutter: takes whole blocks out of the buffer, one after the other, and has them stepped.
//!
//! A block is stepped at the end of its cutting time; its pulses carry times spread evenly over that time. What stands
//! in the way of a block (an alarm, a reset) strikes when it is taken.

use std::time::Duration;

use super::Controller;
use super::plan::{Motion, Planned, Stroke};
use crate::dialect::four_b::FourBlock;
use crate::dialect::gcode::Line;
use crate::dialect::three_b::Block;
use crate::interpolator::length::length_um;
use crate::interpolator::{self, Cause, Fault, Model, Travel};
use crate::line::fault::FaultKind;
use crate::observer::{BlockEnd, Observer};

/// One thing in the buffer.
pub(super) struct Queued {
    pub(super) item: Item,
    /// Characters it takes up there.
    pub(super) characters: usize,
}

pub(super) enum Item {
    Block(FourBlock),
    Line(Line),
    /// A stop word D.
    Pause,
    End,
    /// What was read instead of a block, and where.
    Malformed(String),
}

/// A block being cut.
pub(super) struct Cut {
    /// One after the other; the first is the block, as it is told of.
    strokes: Vec<Stroke>,
    /// What the upper guide does meanwhile.
    upper: Option<Block>,
    began: Duration,
    pub(super) ends: Duration,
}

impl<O: Observer> Controller<O> {
    /// Takes what is next out of the plan, and out of the buffer into the plan, until a block is being cut or the buffer
    /// holds none.
    pub(super) fn take_up(&mut self) {
        while self.cut.is_none() && self.is_running() {
            match self.plan.next() {
                Some(Planned::Cut(motion)) => self.begin_cut(&motion),
                Some(Planned::End) => self.tally.programs += 1,
                Some(Planned::Alarm { name, found }) => {
                    let detail = format!("block {}, {found}", self.tally.blocks + 1);
                    self.raise(name, Some(detail));
                }
                None if self.read_on() => {}
                None => break,
            }
        }
        self.starved();
    }

    /// Hands one item of the buffer to the plan; false: there is none.
    fn read_on(&mut self) -> bool {
        let Some(Queued { item, characters }) = self.queue.pop_front() else {
            return false;
        };
        self.queued_characters -= characters;
        match item {
            Item::Block(block) => self.plan.block(block, characters),
            Item::Line(line) => self.plan.line(line, characters),
            Item::Pause => self.plan.pause(),
            Item::End => self.plan.end(),
            Item::Malformed(found) => {
                let detail = format!("block {}, {found}", self.tally.blocks + 1);
                self.raise("format", Some(detail));
            }
        }
        self.drained();
        true
    }

    fn begin_cut(&mut self, motion: &Motion) {
        let number = self.tally.blocks + 1;
        if self.settings.alarm_at_block == Some(number) || self.faults.strikes(FaultKind::Alarm) {
            return self.raise("nak", Some(format!("block {number}: told to")));
        }
        if self.faults.strikes(FaultKind::NakStorm) {
            return self.raise("nak-storm", Some(format!("block {number}: told to")));
        }
        let told = self.settings.reset_at_block == Some(number);
        if told || self.faults.strikes(FaultKind::Reset) {
            if told {
                self.settings.reset_at_block = None;
            }
            return self.reset();
        }
        let line_time = self.settings.pace.time_of(u64::try_from(motion.characters).unwrap_or(u64::MAX));
        let mut takes = line_time.mul_f64(self.settings.cutting_time);
        if self.faults.strikes(FaultKind::Slow) {
            takes *= 10;
        }
        if self.faults.strikes(FaultKind::Stall) {
            takes += self.faults.pick_milliseconds(FaultKind::Stall, 1000, 5000);
        }
        let model = self.settings.interpolator;
        let strokes = motion.strokes(model, self.position_um());
        let upper = motion.upper.map(|path| path.block(model, self.tally.upper_um));
        let (Some(strokes), None | Some(Some(_))) = (strokes, upper) else {
            return self.raise(Cause::ArcCentre.name(), Some(format!("block {number}")));
        };
        self.cut = Some(Cut { strokes, upper: upper.flatten(), began: self.now, ends: self.now + takes });
        if takes.is_zero() {
            self.step_cut();
        }
    }

    pub(super) fn finish_cut(&mut self) {
        self.step_cut();
        self.take_up();
    }

    /// Steps the block being cut.
    fn step_cut(&mut self) {
        let Some(Cut { strokes, upper, began, ends }) = self.cut.take() else {
            return;
        };
        let model = self.settings.interpolator;
        let number = self.tally.blocks + 1;
        let start_um = self.position_um();
        let above = upper.map(|upper| (upper, self.step_upper(&upper)));
        let done = if self.observer.wants_pulses() {
            let span = ends - began;
            // Steps can be spread only when their number is known, so the block is stepped twice.
            let total = if span.is_zero() && above.is_none() {
                1
            } else {
                run_all(model, &strokes, |_, _| {}).travel.pulses
            };
            let places = above.as_ref().map_or(&[][..], |(_, above)| &above.places);
            let observer = &mut self.observer;
            let (mut count, mut told) = (0, 0);
            let done = run_all(model, &strokes, |dx, dy| {
                count += 1;
                let at = began + share(span, count, total);
                let due = part(places.len(), count, total);
                for [u_um, v_um] in &places[told..due.max(told)] {
                    observer.upper_pulse(at, number, *u_um, *v_um);
                }
                told = due.max(told);
                observer.pulse(at, number, start_um[0] + dx, start_um[1] + dy);
            });
            for [u_um, v_um] in &places[told..] {
                observer.upper_pulse(ends, number, *u_um, *v_um);
            }
            done
        } else {
            run_all(model, &strokes, |_, _| {})
        };
        let Done { travel, length_um, fault } = done;
        self.tally.pulses += travel.pulses;
        self.tally.x_um += travel.dx;
        self.tally.y_um += travel.dy;
        if let Some((upper, Above { fault: Some(fault), .. })) = above {
            let detail = format!("block {number} ({upper} at the upper guide): {fault}");
            return self.raise(fault.cause.name(), Some(detail));
        }
        if let Some((block, fault)) = fault {
            return self.raise(fault.cause.name(), Some(format!("block {number} ({block}): {fault}")));
        }
        let Some(Stroke { block, .. }) = strokes.first().copied() else {
            return;
        };
        let end_um = self.position_um();
        let pulses = travel.pulses;
        let end = BlockEnd { number, block, start_um, end_um, pulses, began, ended: ends };
        self.executed(&end, length_um);
    }

    /// Steps the upper guide through its block; it keeps pace with the plane of the program.
    fn step_upper(&mut self, block: &Block) -> Above {
        let [u_um, v_um] = self.tally.upper_um;
        let wants_pulses = self.observer.wants_pulses();
        let mut places = Vec::new();
        let outcome = interpolator::run(self.settings.interpolator, block, |du, dv| {
            if wants_pulses {
                places.push([u_um + du, v_um + dv]);
            }
        });
        let (travel, fault) = match outcome {
            Ok(travel) => (travel, None),
            Err(fault) => (fault.travel, Some(fault)),
        };
        self.tally.upper_pulses += travel.pulses;
        self.tally.upper_um = [u_um + travel.dx, v_um + travel.dy];
        Above { places, fault }
    }
}

/// What the upper guide did in one block.
struct Above {
    /// Where each pulse brought it, if anyone wants to know.
    places: Vec<[i64; 2]>,
    fault: Option<Fault>,
}

/// What all strokes of a block did.
struct Done {
    travel: Travel,
    length_um: f64,
    fault: Option<(Block, Fault)>,
}

/// Steps one stroke after the other; `pulse` is told the place from where the first began.
fn run_all(model: Model, strokes: &[Stroke], mut pulse: impl FnMut(i64, i64)) -> Done {
    let mut done = Done { travel: Travel::default(), length_um: 0.0, fault: None };
    for stroke in strokes {
        let (dx, dy) = (done.travel.dx, done.travel.dy);
        let outcome = interpolator::run(model, &stroke.block, |x, y| pulse(dx + x, dy + y));
        let travel = match outcome {
            Ok(travel) => travel,
            Err(fault) => {
                done.fault = Some((stroke.block, fault));
                fault.travel
            }
        };
        done.length_um += stroke.length_um.unwrap_or_else(|| length_um(&stroke.block, &travel));
        done.travel =
            Travel { dx: dx + travel.dx, dy: dy + travel.dy, pulses: done.travel.pulses + travel.pulses };
        if done.fault.is_some() {
            break;
        }
    }
    done
}

/// How many of `whole` steps go with `count` of `total` others.
fn part(whole: usize, count: u64, total: u64) -> usize {
    let steps = whole as u128 * u128::from(count.min(total)) / u128::from(total.max(1));
    usize::try_from(steps).unwrap_or(whole).min(whole)
}

/// `count` of `total` equal parts of a time span.
fn share(span: Duration, count: u64, total: u64) -> Duration {
    if span.is_zero() {
        return span;
    }
    let nanoseconds = span.as_nanos() * u128::from(count) / u128::from(total.max(1));
    Duration::from_nanos(u64::try_from(nanoseconds).unwrap_or(u64::MAX))
}
