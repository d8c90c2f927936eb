//! The block for an arc: the circle through the control's position and the target, and the integers around it.

use super::{Choice, Goal, NoneFits, Stand};
use crate::formats::three_b::{Axis, Block, COUNT_MAX};
use crate::geometry::{Element, Point, Sense, Vector, sweep};
use crate::interpolator::{Bend, Branch, Model};
use crate::rounding::{Aim, pieces};
use crate::units::{Micrometres, Position};

/// What of an arc matters to its block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    start_um: Point,
    centre_um: Point,
    /// As at the start.
    radius_um: f64,
    sense: Sense,
    /// The sweep in quarter turns, to the middle of its quarter: 0.5, 1.5, 2.5, 3.5, or 4 for the full circle.
    quarters: f64,
}

impl Shape {
    pub(super) fn new(start: Point, end: Point, centre: Point, sense: Sense) -> Self {
        let quarters = quarter_turns(start - centre, end - centre, sense);
        let radius_um = (start - centre).norm() * 1000.0;
        Self { start_um: start * 1000.0, centre_um: centre * 1000.0, radius_um, sense, quarters }
    }

    /// How far a circle strays from this one at most, anywhere round it, when it is begun at a point of the lattice seen
    /// from its centre, µm.
    fn stray(&self, stand: Stand, first: Position) -> f64 {
        let vector = |p: Position| Vector::new(p.x.0 as f64, p.y.0 as f64);
        let (first, from_centre) = (vector(first), vector(stand.at) - self.centre_um.coords);
        (first.norm() - self.radius_um).abs() + (first - from_centre).norm()
    }
}

/// The best block for an arc; `Ok(None)` when it is shorter than the lattice can show.
pub(super) fn choose(stand: Stand, goal: Goal, shape: Shape) -> Result<Option<Choice>, NoneFits> {
    if goal.at == stand.at && shape.quarters < 2.0 {
        return Ok(None);
    }
    let ideal = ideal_start(stand, goal, shape);
    let middle = Position::new(ideal.x.round() as i64, ideal.y.round() as i64);
    let toward = |v: f64| if v < v.round() { -1 } else { 1 };
    let (sx, sy) = (toward(ideal.x), toward(ideal.y));

    let mut best: Option<Choice> = None;
    if goal.theory_first {
        let first: Vector = shape.start_um - shape.centre_um;
        let first = Position::new(first.x.round() as i64, first.y.round() as i64);
        for g in [None, Some(Axis::X), Some(Axis::Y)] {
            consider(stand, goal, shape, first, g, &mut best);
            if best.is_some_and(|b| b.end == goal.at) {
                return Ok(best);
            }
        }
    }
    for ring in [&NEAR[..], &FAR[..]] {
        for &(dx, dy) in ring {
            let first = middle + Position::new(sx * dx, sy * dy);
            consider(stand, goal, shape, first, None, &mut best);
            if best.is_some_and(|b| goal.admits(b.end, AT_ONCE_UM)) {
                return Ok(best);
            }
        }
        if best.is_some_and(|b| goal.admits(b.end, GOOD_UM)) {
            return Ok(best);
        }
    }
    if best.is_some_and(|b| goal.admits(b.end, stand.limit_um())) { Ok(best) } else { Err(NoneFits) }
}

/// Tries the block that starts at `first`, seen from its centre, and counts along `g`, or along the axis that is right for
/// where it ends.
#[inline]
fn consider(
    stand: Stand,
    goal: Goal,
    shape: Shape,
    first: Position,
    g: Option<Axis>,
    best: &mut Option<Choice>,
) {
    let last = goal.at - stand.at + first;
    let Ok(branch) = Branch::at(first, shape.sense) else { return };
    let Some((quarter, u, v)) = Branch::frame(last, shape.sense) else { return };
    let Some(crossed) = crossings(branch.quarter(), quarter, shape.quarters) else { return };
    // G is the axis with the smaller coordinate at the end: the one that moves faster there.
    let falling = branch.falling_axis(quarter);
    let g = g.unwrap_or(if u < v { falling } else { other(falling) });
    let bend = match stand.aim {
        Aim::One(model) => model.bend(),
        Aim::Any => Bend::Inward,
    };
    let count = branch.count_to(bend, g, crossed, (u, v));
    if !(1..=COUNT_MAX.0).contains(&count) {
        return;
    }
    let Ok(moved) = branch.travel(bend, g, count) else { return };
    let end = stand.at + moved;
    let error = goal.error(end);
    if best.is_some_and(|b| b.error <= error) {
        return;
    }
    // Up to half a turn the ends hold the rest of the way; beyond, they can be right and the far side is not.
    if shape.quarters > 2.0 && shape.stray(stand, first) > STRAY_UM {
        return;
    }
    let agree = |bend| branch.travel(bend, g, count) == Ok(moved);
    if stand.aim == Aim::Any && !(agree(Bend::True) && agree(Bend::Outward)) {
        return;
    }
    *best = Some(Choice { block: Block::arc(first, shape.sense, g, Micrometres(count)), end, error });
}

/// Where the arc should start, seen from its centre, µm: on the circle through the control's position and the aim,
/// with its centre as near as can be to the theoretical one.
fn ideal_start(stand: Stand, goal: Goal, shape: Shape) -> Vector {
    let at = |p: Position| Point::new(p.x.0 as f64, p.y.0 as f64);
    let (from, to) = (at(stand.at), at(goal.at));
    let from_centre: Vector = from - shape.centre_um;
    let chord = to + bias(stand.aim, to - shape.centre_um, shape.sense) - from;
    let length2 = chord.norm_squared();
    if length2 == 0.0 || (shape.quarters > 3.0 && length2 < 0.04 * from_centre.norm_squared()) {
        // Nearly a full circle: the chord says nothing about the centre.
        return from_centre;
    }
    let middle = from + chord * 0.5;
    from_centre - chord * ((middle - shape.centre_um).dot(&chord) / length2)
}

/// How far beyond the goal the true circle should pass for the pulses to end on it, µm.
///
/// The stepping models leave a row or column only once the circle has been crossed, so their path lies about half a
/// micron to one side; the middle of what makes them, or all models at once, end on the goal is aimed at.
fn bias(aim: Aim, end: Vector, sense: Sense) -> Vector {
    // In the frame of the branch u falls and v grows; only magnitudes matter here.
    let (ccw_x, ccw_y) = match sense {
        Sense::CounterClockwise => (end.x, end.y),
        Sense::Clockwise => (end.y, end.x),
    };
    let quarter = match (ccw_x > 0.0, ccw_y > 0.0) {
        (true, true) => 0,
        (false, true) => 1,
        (false, false) => 2,
        (true, false) => 3,
    };
    let (u, v) = if quarter % 2 == 0 { (ccw_x.abs(), ccw_y.abs()) } else { (ccw_y.abs(), ccw_x.abs()) };
    let (du, dv) = match aim {
        Aim::One(Model::Exact) => (0.0, 0.0),
        Aim::One(Model::Rotated | Model::Mirrored | Model::Strict) if u < v => (1.0, -0.5),
        Aim::One(Model::Rotated | Model::Mirrored | Model::Strict) => (0.5, -1.0),
        Aim::Any if u < v => (0.0, (u / v - 0.5) / 2.0),
        Aim::Any => (if u > 0.0 { (0.5 - v / u) / 2.0 } else { 0.0 }, 0.0),
    };
    let (x, y) = match quarter {
        0 => (du, dv),
        1 => (-dv, du),
        2 => (-du, -dv),
        _ => (dv, -du),
    };
    match sense {
        Sense::CounterClockwise => Vector::new(x, y),
        Sense::Clockwise => Vector::new(y, x),
    }
}

/// See [`Shape::quarters`].
fn quarter_turns(from: Vector, to: Vector, sense: Sense) -> f64 {
    let cross = match sense {
        Sense::CounterClockwise => from.x * to.y - from.y * to.x,
        Sense::Clockwise => from.y * to.x - from.x * to.y,
    };
    let ahead = from.dot(&to) >= 0.0;
    if cross > 0.0 {
        if ahead { 0.5 } else { 1.5 }
    } else if cross < 0.0 {
        if ahead { 3.5 } else { 2.5 }
    } else if ahead {
        4.0
    } else {
        2.0
    }
}

/// How many axes the block crosses on its way from quarter to quarter; none when rounding put the end behind the start.
fn crossings(from: u8, to: u8, quarters: f64) -> Option<u8> {
    let least = (to + 4 - from) % 4;
    let expected = [i32::from(least) - 4, i32::from(least), i32::from(least) + 4]
        .into_iter()
        .min_by(|a, b| (f64::from(*a) - quarters).abs().total_cmp(&(f64::from(*b) - quarters).abs()))?;
    u8::try_from(expected).ok()
}

/// An arc in two: at the first axis of its centre that it crosses well inside, else in the middle; none when its
/// bulge is below half a micron.
pub(super) fn split(arc: &Element) -> Option<(Element, Element)> {
    let Element::Arc { start, end, centre, sense } = *arc else { return None };
    let whole = sweep(start - centre, end - centre, sense);
    let radius = (start - centre).norm();
    let bulge_um = 1000.0 * radius * (1.0 - libm::cos((whole / 2.0).min(std::f64::consts::PI)));
    if bulge_um <= BULGE_UM {
        return None;
    }
    let axes = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0), Vector::new(-1.0, 0.0), Vector::new(0.0, -1.0)];
    let margin = 0.02 * whole;
    let crossing = axes
        .into_iter()
        .map(|axis| (axis, sweep(start - centre, axis, sense)))
        .filter(|&(_, turn)| turn > margin && turn < whole - margin)
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let at = match crossing {
        Some((axis, _)) => centre + axis * radius,
        None => pieces::at_fraction(arc, 0.5),
    };
    Some((pieces::between(arc, start, at), pieces::between(arc, at, end)))
}

fn other(axis: Axis) -> Axis {
    match axis {
        Axis::X => Axis::Y,
        Axis::Y => Axis::X,
    }
}

/// So near that no other choice can be better by much: the lattice's own share is up to 0.71 µm.
const AT_ONCE_UM: f64 = 0.75;

/// Near enough not to look further out, µm.
const GOOD_UM: f64 = 0.95;

/// How far the circle of an arc of more than half a turn may stray, µm; one that cannot be cut so is split. The pulses lie
/// up to a micron beside their circle, so the wire keeps within 2.5 µm.
const STRAY_UM: f64 = 1.5;

/// A bulge the lattice cannot show, µm.
const BULGE_UM: f64 = 0.5;

/// The lattice points round the ideal start, towards its fraction first.
const NEAR: [(i64, i64); 9] = [(0, 0), (1, 0), (0, 1), (1, 1), (-1, 0), (0, -1), (1, -1), (-1, 1), (-1, -1)];

/// The next ring.
const FAR: [(i64, i64); 16] = [
    (2, 0),
    (0, 2),
    (2, 1),
    (1, 2),
    (2, 2),
    (-2, 0),
    (0, -2),
    (2, -1),
    (-1, 2),
    (-2, 1),
    (1, -2),
    (2, -2),
    (-2, 2),
    (-2, -1),
    (-1, -2),
    (-2, -2),
];
