//! The way of the wire through a program, as blocks and the stops between contours.

use super::refusal;
use crate::formats::WriteError;
use crate::formats::three_b::Block;
use crate::geometry::{Element, Point, Vector};
use crate::motion::Travel;
use crate::place::Spot;
use crate::rounding::Aim;
use crate::rounding::closed_loop::Chooser;
use crate::units::Position;

/// Follows the motions and chooses their blocks.
#[derive(Debug)]
pub(in crate::formats) struct Path {
    pub(in crate::formats) chooser: Chooser,
    aim: Aim,
    /// Where the last motion ended, mm; none before the first one.
    at: Option<Point>,
    pub(in crate::formats) start_hole: Option<Point>,
    /// Anything was written yet.
    begun: bool,
    /// On a way between contours.
    jumping: bool,
    /// The last line is a pause.
    paused: bool,
    contour: Contour,
}

/// A line of a program.
#[derive(Clone, Copy, Debug)]
pub(in crate::formats) enum Line<'a> {
    Block(&'a Block),
    Pause,
}

/// What became of a motion.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(in crate::formats) enum Way {
    Written,
    /// Left out: the operator stands the wire in the hole.
    ToStartHole,
}

impl Path {
    pub(in crate::formats) fn new(aim: Aim) -> Self {
        Self {
            chooser: chooser_at(Position::default(), aim),
            aim,
            at: None,
            start_hole: None,
            begun: false,
            jumping: false,
            paused: false,
            contour: Contour::default(),
        }
    }

    /// A pause was written.
    pub(in crate::formats) fn pause(&mut self) {
        self.paused = true;
        self.contour.pause(self.at);
    }

    /// Goes along an element.
    pub(in crate::formats) fn go(
        &mut self,
        travel: Travel,
        element: Element,
        spot: Spot,
        mut line: impl FnMut(Line<'_>),
    ) -> Result<Way, WriteError> {
        let (start, end) = (element.start(), element.end());
        match self.at {
            Some(at) if (start - at).norm() > GAP_MM => {
                return Err(refusal(
                    format!(
                        "the motion begins at ({:.3}, {:.3}), and the one before it ended at ({:.3}, {:.3})",
                        start.x, start.y, at.x, at.y
                    ),
                    spot,
                    "say the way between them",
                ));
            }
            Some(_) => {}
            None => self.chooser = chooser_at(Position::nearest(start), self.aim),
        }
        self.at = Some(end);
        if travel == Travel::Rapid {
            if !self.begun {
                self.chooser = chooser_at(Position::nearest(end), self.aim);
                self.start_hole = Some(end);
                return Ok(Way::ToStartHole);
            }
            self.contour = Contour::default();
        }
        let jumps = travel == Travel::Rapid;
        if jumps != self.jumping && !std::mem::take(&mut self.paused) {
            line(Line::Pause);
        }
        self.jumping = jumps;
        self.begun = true;
        self.cut(element, &mut line);
        Ok(Way::Written)
    }

    fn cut(&mut self, element: Element, line: &mut impl FnMut(Line<'_>)) {
        let home = self.contour.home(&element, self.chooser.stands());
        let mut blocks = |chooser: &mut Chooser| {
            while let Some(chosen) = chooser.next_block() {
                self.paused = false;
                line(Line::Block(&chosen.block));
            }
        };
        let chords = chords(&element);
        if chords == 0 {
            self.chooser.give(element, home);
            blocks(&mut self.chooser);
        }
        for n in 0..chords {
            let at = |n: u64| element.at(n as f64 / chords as f64);
            let last = n + 1 == chords;
            self.chooser.give(Element::Line { start: at(n), end: at(n + 1) }, home.filter(|_| last));
            blocks(&mut self.chooser);
        }
        self.contour.went(element.end(), self.chooser.stands());
    }
}

fn chooser_at(origin: Position, aim: Aim) -> Chooser {
    Chooser::new(origin, aim).with_exact_nodes()
}

/// The first nodes of the contour in work, and where the control stood there.
#[derive(Debug, Default)]
struct Contour {
    nodes: [(Point, Position); NODES],
    count: usize,
}

/// Lead-ins have one element, or a few.
const NODES: usize = 4;

impl Contour {
    /// Where an element has to end if it brings the contour back to a node.
    fn home(&mut self, element: &Element, stands: Position) -> Option<Position> {
        if self.count == 0 {
            self.nodes[0] = (element.start(), stands);
            self.count = 1;
        }
        if let Element::Arc { start, end, .. } = element
            && start == end
        {
            return Some(stands);
        }
        self.nodes[..self.count].iter().find(|node| node.0 == element.end()).map(|node| node.1)
    }

    /// Where the control stops on a node, another contour may begin; anywhere else it stops on the way round.
    fn pause(&mut self, at: Option<Point>) {
        if self.nodes[..self.count].last().is_some_and(|node| Some(node.0) == at) {
            self.count = 0;
        }
    }

    fn went(&mut self, end: Point, stands: Position) {
        if let Some(n) = self.nodes[..self.count].iter().position(|node| node.0 == end) {
            self.count = n + 1;
        } else if self.count < NODES {
            self.nodes[self.count] = (end, stands);
            self.count += 1;
        }
    }
}

/// In how many straight lines an arc is written whose circle is too large for the numbers of a block; 0 for a block of
/// its own.
fn chords(element: &Element) -> u64 {
    match element.radius() {
        Some(radius) if radius > RADIUS_MAX_MM => {
            (element.length() / (8.0 * radius * BULGE_MM).sqrt()).ceil().max(1.0) as u64
        }
        Some(_) | None => 0,
    }
}

/// Refuses what no machine can reach, before its numbers overflow.
pub(in crate::formats) fn within_reach(element: &Element, spot: Spot) -> Result<(), WriteError> {
    let reaches = |v: Vector| v.x.abs() <= REACH_MM && v.y.abs() <= REACH_MM;
    let ends = reaches(element.start().coords) && reaches(element.end().coords);
    let bow = match element.radius() {
        Some(radius) if radius > RADIUS_MAX_MM => {
            radius <= ARC_RADIUS_MAX_MM && element.extent().into_iter().all(|corner| reaches(corner.coords))
        }
        Some(radius) => radius.is_finite(),
        None => true,
    };
    if ends && bow {
        return Ok(());
    }
    Err(refusal(
        "the motion leads more than a kilometre from the program's zero, or round a circle of more than 1000 km",
        spot,
        "check the coordinates and their unit",
    ))
}

/// A gap that rounding explains, mm.
const GAP_MM: f64 = 0.003;
/// The farthest from zero, mm.
const REACH_MM: f64 = 1e6;
/// The largest radius whose X and Y are written: eight digits. *Guess:* no source limits them.
const RADIUS_MAX_MM: f64 = 99_999.0;
/// The largest radius whose chords can be worked out to a fraction of a micron, mm.
const ARC_RADIUS_MAX_MM: f64 = 1e9;
/// How far an arc may bow out from the chords that stand for it, mm.
const BULGE_MM: f64 = 0.000_25;

#[cfg(test)]
mod tests;
