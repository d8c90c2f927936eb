//! Blocks of motion: nodes rounded to the micron, arcs whose radii agree, the wire's upper end.

use super::{Writer, refused, spelling};
use crate::formats::WriteError;
use crate::formats::gcode::dialect::ArcCentre;
use crate::formats::gcode::modal::Mode;
use crate::geometry::{Element, Point, Sense};
use crate::motion::{Motion, Travel};
use crate::place::Spot;
use crate::units::{Micrometres, Position};

/// An element on whole microns.
#[derive(Clone, Copy, Debug)]
struct Rounded {
    mode: Mode,
    start: Position,
    end: Position,
    /// The centre of an arc.
    centre: Option<Position>,
}

impl Writer {
    pub(super) fn travel(
        &mut self,
        motion: &Motion,
        travel: Travel,
        element: &Element,
        upper: Option<&Element>,
        text: &mut Vec<u8>,
    ) -> Result<(), WriteError> {
        let spot = motion.spot;
        self.open(text);
        let start = node(element.start(), spot)?;
        if !self.line_is_path && self.line_block != motion.block {
            self.flush(text);
        }
        let at = match self.at {
            Some(at) => at,
            None => self.begin_at(start, motion.block, text),
        };
        if !near(at, start) {
            let message = format!(
                "the motion begins at {} {}, and the last one ended at {} {}",
                start.x.millimetres(),
                start.y.millimetres(),
                at.x.millimetres(),
                at.y.millimetres()
            );
            return Err(refused(spot, &message, "put a rapid motion between them"));
        }
        let tolerance =
            self.dialect.arc_tolerance(crate::formats::gcode::numbers::Unit::Millimetre) as f64 / 1e3;
        let lower = rounded(element, at, travel, tolerance, spot)?;
        let upper = upper
            .map(|element| {
                let start = at + self.lean;
                if !near(start, node(element.start(), spot)?) {
                    let message = "the upper end does not begin where it is";
                    return Err(refused(spot, message, "lead it there in the motion before"));
                }
                rounded(element, start, travel, tolerance, spot)
            })
            .transpose()?;
        let words = match upper {
            None if self.lean == Position::default() => self.element(&lower, false),
            _ if self.dialect.pairs => self.pair(&lower, upper.as_ref()),
            _ => self.leaning(&lower, upper.as_ref(), spot)?,
        };
        // An offset is switched on along a line.
        if lower.centre.is_some() && self.line_is_path {
            self.flush(text);
        }
        self.put(&words, motion.block, false);
        self.flush(text);
        self.at = Some(lower.end);
        self.lean = upper.map_or(Position::default(), |u| u.end - lower.end);
        Ok(())
    }

    /// Says where the wire is before the first motion.
    fn begin_at(&mut self, start: Position, block: u64, text: &mut Vec<u8>) -> Position {
        let mut words = b"G92".to_vec();
        self.axes(b"XY", start, &mut words);
        // What waits to share the block of the motion goes on waiting.
        let waiting = std::mem::take(&mut self.line);
        let (is_path, waiting_block) = (self.line_is_path, self.line_block);
        self.apart(text, |writer, text| {
            writer.put(&words, block, false);
            writer.flush(text);
        });
        (self.line, self.line_is_path, self.line_block) = (waiting, is_path, waiting_block);
        start
    }

    /// The words of a motion.
    fn element(&mut self, element: &Rounded, is_pair: bool) -> Vec<u8> {
        let mut words = Vec::new();
        let suppress = self.layout.suppress && !is_pair;
        if !suppress || self.mode != Some(element.mode) {
            words.extend_from_slice(match element.mode {
                Mode::Rapid => b"G00",
                Mode::Line => b"G01",
                Mode::Clockwise => b"G02",
                Mode::CounterClockwise => b"G03",
            });
        }
        self.mode = Some(element.mode);
        let way = element.end - element.start;
        let target = if self.dialect.written.incremental { way } else { element.end };
        let is_arc = element.centre.is_some();
        let moves = [way.x.0 != 0, way.y.0 != 0];
        // A line that moves neither axis says one all the same, else it would be no motion.
        let said = |axis: usize| !suppress || moves[axis] || (axis == 0 && !is_arc && !moves[1]);
        for (axis, letter, value) in [(0, b'X', target.x), (1, b'Y', target.y)] {
            if said(axis) {
                self.number(letter, value, &mut words);
            }
        }
        if let Some(centre) = element.centre {
            let seen = match self.dialect.arc_centre {
                ArcCentre::FromStart => centre - element.start,
                ArcCentre::Absolute => centre,
                ArcCentre::ToStart => element.start - centre,
            };
            self.axes(b"IJ", seen, &mut words);
        }
        words
    }

    /// A motion with the wire's lean in U and V.
    fn leaning(
        &mut self,
        lower: &Rounded,
        upper: Option<&Rounded>,
        spot: Spot,
    ) -> Result<Vec<u8>, WriteError> {
        let upright = Rounded { start: lower.start + self.lean, ..*lower };
        let upper = upper.unwrap_or(&upright);
        if !self.dialect.upper || self.dialect.written.incremental {
            let help = "choose a dialect with U and V in absolute coordinates";
            return Err(refused(spot, "the dialect has no word for a motion of the upper end", help));
        }
        let lean = upper.end - lower.end;
        let mut words = self.element(lower, false);
        let is_line = |mode| matches!(mode, Mode::Line | Mode::Rapid);
        let apart = match (lower.centre, upper.centre) {
            _ if is_line(lower.mode) && is_line(upper.mode) => None,
            (Some(lower), Some(upper)) => Some(upper - lower),
            _ => None,
        };
        if !(is_line(lower.mode) && is_line(upper.mode)) && (apart.is_none() || lower.mode != upper.mode) {
            let help = "choose a dialect with `:` between the two motions, or cut the arc into lines";
            return Err(refused(spot, "the two ends move in different ways", help));
        }
        self.axes(b"UV", lean, &mut words);
        if let Some(apart) = apart {
            if self.dialect.upper_centre {
                self.axes(b"KL", apart, &mut words);
            } else {
                // Without K and L the centres coincide, or are moved as the ends are.
                let is_moved = near(lean, self.lean) && near(apart, lean);
                if !near(apart, Position::default()) && !is_moved {
                    let help = "choose a dialect with K and L";
                    return Err(refused(spot, "the centre of the upper arc has no word", help));
                }
            }
        }
        Ok(words)
    }

    /// A motion of both ends with a colon between.
    fn pair(&mut self, lower: &Rounded, upper: Option<&Rounded>) -> Vec<u8> {
        let both = Rounded { mode: Mode::Line, start: lower.start + self.lean, end: lower.end, centre: None };
        let mut words = self.element(lower, true);
        let mode = self.mode;
        words.extend_from_slice(b" : ");
        words.append(&mut self.element(upper.unwrap_or(&both), true));
        self.mode = mode;
        words
    }

    fn axes(&self, letters: &[u8; 2], value: Position, words: &mut Vec<u8>) {
        self.number(letters[0], value.x, words);
        self.number(letters[1], value.y, words);
    }

    fn number(&self, letter: u8, value: Micrometres, words: &mut Vec<u8>) {
        if !words.is_empty() {
            self.gap(words);
        }
        words.push(letter);
        spelling::length(&self.dialect, value, words);
    }
}

/// An element from a node, on whole microns.
fn rounded(
    element: &Element,
    start: Position,
    travel: Travel,
    tolerance_um: f64,
    spot: Spot,
) -> Result<Rounded, WriteError> {
    let end = node(element.end(), spot)?;
    let line = |mode| Rounded { mode, start, end, centre: None };
    let (centre, sense) = match (travel, *element) {
        (Travel::Rapid, Element::Line { .. }) => return Ok(line(Mode::Rapid)),
        (Travel::Cut, Element::Line { .. }) => return Ok(line(Mode::Line)),
        (Travel::Cut, Element::Arc { centre, sense, .. }) => (centre, sense),
        (Travel::Rapid, Element::Arc { .. }) => {
            return Err(refused(spot, "a rapid motion along an arc", "rapid motions are straight"));
        }
    };
    node(centre, spot)?;
    // An arc that is shorter than a micron would become a full circle.
    let is_full = element.start() == element.end() || element.sweep() > std::f64::consts::PI;
    if start == end && !is_full {
        return Ok(line(Mode::Line));
    }
    let (centre, difference) = best_centre(start, end, centre);
    if centre == start || centre == end {
        return Ok(line(Mode::Line));
    }
    if difference > tolerance_um {
        let message = format!("the ends of the arc lie on circles whose radii differ by {difference:.1} um");
        return Err(refused(spot, &message, "correct the arc"));
    }
    let mode = match sense {
        Sense::Clockwise => Mode::Clockwise,
        Sense::CounterClockwise => Mode::CounterClockwise,
    };
    Ok(Rounded { mode, start, end, centre: Some(centre) })
}

/// The whole microns to be called the centre of an arc; and by how much the radii at its two ends differ then, um.
///
/// It is the nearest to the true centre, unless the radii would differ by more than a control is sure to pass over: then
/// it is moved by up to a micron, where that makes them agree by more than it shifts the arc. A centre is not moved for the
/// sake of agreement alone: the far side of an arc over three quadrants strays by more than twice of what it is moved.
fn best_centre(start: Position, end: Position, centre: Point) -> (Position, f64) {
    let nearest = Position::nearest(centre);
    let mut best = (nearest, f64::INFINITY, f64::INFINITY);
    for dx in -1..=1 {
        for dy in -1..=1 {
            let candidate = nearest + Position::new(dx, dy);
            let difference = (distance(candidate, start) - distance(candidate, end)).abs();
            let cost =
                DISAGREEMENT_COST * (difference - AGREEMENT_UM).max(0.0) + candidate.distance_um(centre);
            if cost < best.2 {
                best = (candidate, difference, cost);
            }
        }
    }
    (best.0, best.1)
}

/// Radii that differ by no more agree on any control: it is the least increment, and what a 3B arc's pulses may lie beside
/// its circle. LinuxCNC refuses small arcs from 1.27 um (`CENTER_ARC_RADIUS_TOLERANCE_MM`).
const AGREEMENT_UM: f64 = 1.0;

/// What a micron of disagreement beyond that is worth in microns of the centre: a refused block is worse than a wide arc.
const DISAGREEMENT_COST: f64 = 2.0;

fn distance(a: Position, b: Position) -> f64 {
    let (x, y) = ((a.x.0 - b.x.0) as f64, (a.y.0 - b.y.0) as f64);
    (x * x + y * y).sqrt()
}

/// The node nearest to a point.
fn node(point: Point, spot: Spot) -> Result<Position, WriteError> {
    // NaN is beyond every bound.
    if point.x.abs() <= 1e6 && point.y.abs() <= 1e6 {
        return Ok(Position::nearest(point));
    }
    Err(refused(spot, "a coordinate of more than a kilometre", "correct the number"))
}

/// Whether two positions are the same but for a rounding.
fn near(a: Position, b: Position) -> bool {
    (a.x.0 - b.x.0).abs() <= 1 && (a.y.0 - b.y.0).abs() <= 1
}
