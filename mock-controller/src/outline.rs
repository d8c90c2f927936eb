//! The programmed outline as lines and arcs in real numbers, µm, and what an offset makes of it.
//!
//! Only for the dialects in which the control holds the offset. The side is told by a sign: an offset is positive to
//! the *right* of the motion. Nothing here rounds; [`aim`] alone goes back to whole µm and to blocks.

pub(crate) mod aim;
pub(crate) mod corner;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::dialect::three_b::{Axis, Block, Kind};
use crate::interpolator::Travel;

/// A point or a vector, µm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

impl Point {
    #[expect(clippy::cast_precision_loss, reason = "a coordinate is far below 2^53 µm")]
    pub(crate) fn whole([x, y]: [i64; 2]) -> Point {
        Point { x: x as f64, y: y as f64 }
    }

    /// To the nearest µm, halves away from zero.
    #[expect(clippy::cast_possible_truncation, reason = "a coordinate is far below 2^53 µm")]
    pub(crate) fn rounded(self) -> [i64; 2] {
        [self.x.round() as i64, self.y.round() as i64]
    }

    pub(crate) fn plus(self, other: Point) -> Point {
        Point { x: self.x + other.x, y: self.y + other.y }
    }

    pub(crate) fn minus(self, other: Point) -> Point {
        Point { x: self.x - other.x, y: self.y - other.y }
    }

    pub(crate) fn times(self, factor: f64) -> Point {
        Point { x: self.x * factor, y: self.y * factor }
    }

    pub(crate) fn length(self) -> f64 {
        libm::hypot(self.x, self.y)
    }

    pub(crate) fn dot(self, other: Point) -> f64 {
        self.x * other.x + self.y * other.y
    }

    pub(crate) fn cross(self, other: Point) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// A quarter turn clockwise: the right-hand normal of a direction.
    pub(crate) fn right(self) -> Point {
        Point { x: self.y, y: -self.x }
    }

    pub(crate) fn unit(self) -> Point {
        let length = self.length();
        if length > 0.0 { self.times(1.0 / length) } else { self }
    }

    /// Radians, counter-clockwise from +X.
    pub(crate) fn angle(self) -> f64 {
        libm::atan2(self.y, self.x)
    }
}

/// Which way an arc turns.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Turn {
    Clockwise,
    CounterClockwise,
}

impl Turn {
    /// 1 counter-clockwise, −1 clockwise.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Turn::Clockwise => -1.0,
            Turn::CounterClockwise => 1.0,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Line,
    /// `sweep` in radians, positive whichever way it turns.
    Arc {
        centre: Point,
        turn: Turn,
        sweep: f64,
    },
}

/// One line or arc of the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Element {
    pub(crate) from: Point,
    pub(crate) to: Point,
    pub(crate) shape: Shape,
}

impl Element {
    /// What a block does when it is carried out as it stands, from `start` by `travel`.
    pub(crate) fn of_block(block: &Block, start: [i64; 2], travel: &Travel) -> Element {
        let end = [start[0] + travel.dx, start[1] + travel.dy];
        let (from, to) = (Point::whole(start), Point::whole(end));
        let turn = match block.kind {
            Kind::Line => return Element { from, to, shape: Shape::Line },
            Kind::Clockwise => Turn::Clockwise,
            Kind::CounterClockwise => Turn::CounterClockwise,
        };
        let (sign_x, sign_y) = block.quadrant.signs();
        let offset = [sign_x * i64::from(block.x), sign_y * i64::from(block.y)];
        let centre = from.minus(Point::whole(offset));
        let sweep = sweep_of(from.minus(centre), to.minus(centre), turn, travel.pulses);
        Element { from, to, shape: Shape::Arc { centre, turn, sweep } }
    }

    /// The direction of motion at the start, a unit vector.
    pub(crate) fn starts_towards(&self) -> Point {
        self.direction(self.from)
    }

    /// The direction of motion at the end, a unit vector.
    pub(crate) fn ends_towards(&self) -> Point {
        self.direction(self.to)
    }

    fn direction(&self, at: Point) -> Point {
        match self.shape {
            Shape::Line => self.to.minus(self.from).unit(),
            Shape::Arc { centre, turn, .. } => at.minus(centre).right().times(-turn.sign()).unit(),
        }
    }

    /// A line's length or an arc's radius: the longer, the better its directions are known.
    pub(crate) fn size(&self) -> f64 {
        match self.shape {
            Shape::Line => self.to.minus(self.from).length(),
            Shape::Arc { centre, .. } => self.from.minus(centre).length(),
        }
    }
}

/// The shifted node between two elements that are tangent there, or at the free end of one. The longer of the two has
/// the more to say about the direction.
pub(crate) fn shifted_node(before: Option<&Element>, after: Option<&Element>, right: f64) -> Option<Point> {
    let node = after.map(|element| element.from).or(before.map(|element| element.to))?;
    let ending = before.map(|element| element.ends_towards().times(element.size()));
    let starting = after.map(|element| element.starts_towards().times(element.size()));
    let direction = ending.unwrap_or_default().plus(starting.unwrap_or_default()).unit();
    Some(node.plus(direction.right().times(right)))
}

/// Whether the one goes on in the direction in which the other ends, as far as whole µm can tell.
pub(crate) fn are_tangent(before: &Element, after: &Element) -> bool {
    let (ends, starts) = (before.ends_towards(), after.starts_towards());
    let angle = libm::atan2(ends.cross(starts).abs(), ends.dot(starts));
    angle <= TANGENT_RAD + NODE_SLACK_UM / before.size() + NODE_SLACK_UM / after.size()
}

/// A guess: about 1°. At an offset of 0.1 mm it leaves a step of 2 µm.
const TANGENT_RAD: f64 = 0.02;

/// What the rounding of a node and a centre may turn a direction by, times the element's size: half a micron each way
/// for both, and one for the interpolator.
const NODE_SLACK_UM: f64 = 3.0;

/// The angle swept about a centre from one point to another, the one of all that differ by whole turns that is nearest
/// to `about`.
pub(crate) fn swept(centre: Point, turn: Turn, from: Point, to: Point, about: f64) -> f64 {
    let angle = turn.sign() * (to.minus(centre).angle() - from.minus(centre).angle()) - about;
    let turned = angle.rem_euclid(TAU);
    about + if turned > PI { turned - TAU } else { turned }
}

/// The angle swept from one vector to another by a walk of so many steps: whole turns are told by the steps.
#[expect(clippy::cast_precision_loss, reason = "the pulses of one block are far below 2^53")]
fn sweep_of(from: Point, to: Point, turn: Turn, pulses: u64) -> f64 {
    let radius = from.length();
    let start = from.angle();
    let turned = (turn.sign() * (to.angle() - start)).rem_euclid(TAU);
    let steps = |sweep: f64| {
        let end = start + turn.sign() * sweep;
        radius * (travel(Axis::X, start, end) + travel(Axis::Y, start, end))
    };
    let mut best = (f64::INFINITY, 0.0);
    for turns in -1..=8 {
        let sweep = turned + TAU * f64::from(turns);
        let off = (steps(sweep) * if sweep < 0.0 { -1.0 } else { 1.0 } - pulses as f64).abs();
        if off < best.0 {
            best = (off, sweep);
        }
    }
    best.1
}

/// How far an axis moves, to and fro, while a point goes round the unit circle from one angle to another.
pub(crate) fn travel(axis: Axis, from: f64, to: f64) -> f64 {
    // Of the cosine, from 0: two each half turn. The sine is the cosine a quarter turn later.
    let run = |angle: f64| {
        let halves = libm::floor(angle / PI);
        2.0 * halves + 1.0 - libm::cos(angle - PI * halves)
    };
    match axis {
        Axis::X => (run(to) - run(from)).abs(),
        Axis::Y => (run(to - FRAC_PI_2) - run(from - FRAC_PI_2)).abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dialect::three_b::parse_block;
    use crate::interpolator::{Model, run};

    #[test]
    fn an_axis_travels_twice_the_diameter_in_a_full_turn_from_anywhere() {
        for start in [0.0, 1.0, -2.5, 3.0] {
            for axis in [Axis::X, Axis::Y] {
                assert!((travel(axis, start, start + TAU) - 4.0).abs() < 1e-12);
                assert!((travel(axis, start, start - TAU) - 4.0).abs() < 1e-12);
            }
        }
        assert!((travel(Axis::X, 0.0, FRAC_PI_2) - 1.0).abs() < 1e-12);
        assert!((travel(Axis::Y, -0.5, 0.5) - 2.0 * libm::sin(0.5)).abs() < 1e-12);
    }

    #[test]
    fn the_sweep_of_an_executed_arc_tells_a_full_circle_from_none() {
        for (text, sweep) in [
            ("B9900B0B39600GYNR1", TAU),
            ("B9900B0B9900GXNR1", FRAC_PI_2),
            ("B0B9900B19800GXSR1", 1.0),
            ("B9900B0B0GXNR1", 0.0),
        ] {
            let block = parse_block(text).unwrap();
            let travel = run(Model::Rotated, &block, |_, _| {}).unwrap();
            let Shape::Arc { centre, sweep: found, .. } = Element::of_block(&block, [5, 7], &travel).shape
            else {
                panic!("{text}");
            };
            let sweep = if text.contains("SR1") { PI * 1.0 } else { sweep };
            assert!((found - sweep).abs() < 2e-3, "{text}: {found} {centre:?}");
        }
    }

    #[test]
    fn right_of_a_motion_along_x_is_minus_y() {
        let line = Element { from: Point::default(), to: Point { x: 10.0, y: 0.0 }, shape: Shape::Line };
        let node = shifted_node(Some(&line), None, 3.0).unwrap();
        assert_eq!(node, Point { x: 10.0, y: -3.0 });
    }
}
