//! From where the wire stands to where it should go, as one block of whole µm.
//!
//! A control that holds an offset makes blocks of its own. It makes each from the place its interpolator has really
//! reached, so no rounding is carried on, and it counts J so that its own interpolator ends as near as it can.
//!
//! Where the manuals are silent: that the control knows its own interpolator so well is a choice made here.

use super::{Point, Turn, swept, travel};
use crate::dialect::three_b::{Axis, Block, Kind, Quadrant};
use crate::interpolator::{Model, run};

/// The straight block from one place to another.
pub(crate) fn line(from: [i64; 2], to: [i64; 2]) -> Block {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    // Half-open quadrants: +X is 1, +Y 2, −X 3, −Y 4.
    let quadrant = match (dx, dy) {
        (1.., 0..) | (0, 0) => Quadrant::First,
        (..=0, 1..) => Quadrant::Second,
        (..=-1, ..=0) => Quadrant::Third,
        (0.., ..=-1) => Quadrant::Fourth,
    };
    let (x, y) = (size(dx), size(dy));
    // At 45° GY in quadrants 1 and 3, GX in 2 and 4.
    let rising = matches!(quadrant, Quadrant::First | Quadrant::Third);
    let g = if x > y || (x == y && !rising) { Axis::X } else { Axis::Y };
    Block { x, y, j: x.max(y), g, kind: Kind::Line, quadrant }
}

/// The round block about `centre` that ends nearest to `to`; `sweep` is about how far it turns, radians. `None`: the
/// wire stands on the centre.
pub(crate) fn arc(
    model: Model,
    from: [i64; 2],
    centre: [i64; 2],
    turn: Turn,
    sweep: f64,
    to: Point,
) -> Option<Block> {
    let start = [from[0] - centre[0], from[1] - centre[1]];
    let quadrant = entered(start, turn)?;
    let from_centre = Point::whole(start);
    let end = to.minus(Point::whole(centre));
    let (angle, radius) = (from_centre.angle(), from_centre.length());
    let sweep = swept(Point::default(), turn, from_centre, end, sweep);
    let g = if end.x.abs() < end.y.abs() { Axis::X } else { Axis::Y };
    let kind = match turn {
        Turn::Clockwise => Kind::Clockwise,
        Turn::CounterClockwise => Kind::CounterClockwise,
    };
    let geometric = radius * travel(g, angle, angle + turn.sign() * sweep.max(0.0));
    let whole = Block { x: size(start[0]), y: size(start[1]), j: counted(geometric), g, kind, quadrant };
    Some(nearest(model, whole, to.minus(Point::whole(from))))
}

/// The same block with the J, among those near, whose simulated end is nearest.
fn nearest(model: Model, block: Block, wanted: Point) -> Block {
    // On a small circle a few µm of J are a turn.
    let reach = (size_of_arc(&block) / 2).clamp(1, REACH_UM);
    let (least, most) = (block.j.saturating_sub(reach), block.j.saturating_add(reach));
    let mut best = (f64::INFINITY, block.j);
    let mut consider = |j: u32, x: i64, y: i64| {
        let off = Point::whole([x, y]).minus(wanted).length();
        // Of two equally near the one nearer to the geometry stays.
        if off < best.0 || (off == best.0 && j.abs_diff(block.j) < best.1.abs_diff(block.j)) {
            best = (off, j);
        }
    };
    if model == Model::Exact {
        // Where it ends is not on its way to where it would end with a longer J.
        for j in least..=most {
            if let Ok(travel) = run(model, &Block { j, ..block }, |_, _| {}) {
                consider(j, travel.dx, travel.dy);
            }
        }
        return Block { j: best.1, ..block };
    }
    if least == 0 {
        consider(0, 0, 0);
    }
    let (mut last, mut count) = ([0, 0], 0);
    let outcome = run(model, &Block { j: most, ..block }, |x, y| {
        let counts = if block.g == Axis::X { x != last[0] } else { y != last[1] };
        last = [x, y];
        count += u32::from(counts);
        if counts && least <= count {
            consider(count, x, y);
        }
    });
    // A walk that comes to no end is left to be found out when it is cut.
    if outcome.is_err() { block } else { Block { j: best.1, ..block } }
}

/// The quadrant an arc's motion enters; `None` on the centre.
fn entered(start: [i64; 2], turn: Turn) -> Option<Quadrant> {
    match (turn, start.into()) {
        (_, (0, 0)) => None,
        (Turn::CounterClockwise, (1.., 0..)) => Some(Quadrant::First),
        (Turn::CounterClockwise, (..=0, 1..)) => Some(Quadrant::Second),
        (Turn::CounterClockwise, (..=-1, ..=0)) => Some(Quadrant::Third),
        (Turn::CounterClockwise, (0.., ..=-1)) => Some(Quadrant::Fourth),
        (Turn::Clockwise, (0.., 1..)) => Some(Quadrant::First),
        (Turn::Clockwise, (1.., ..=0)) => Some(Quadrant::Fourth),
        (Turn::Clockwise, (..=0, ..=-1)) => Some(Quadrant::Third),
        (Turn::Clockwise, (..=-1, 0..)) => Some(Quadrant::Second),
    }
}

fn size(coordinate: i64) -> u32 {
    u32::try_from(coordinate.unsigned_abs()).unwrap_or(u32::MAX)
}

fn size_of_arc(block: &Block) -> u32 {
    counted(libm::hypot(f64::from(block.x), f64::from(block.y)))
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length, far below 2^32 µm")]
fn counted(length: f64) -> u32 {
    length.round() as u32
}

/// How far from the geometry a J is tried, µm: an arc over many quadrants ends up to 6.7 µm off (domain/2, [sim]).
const REACH_UM: u32 = 8;

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn a_line_ends_where_it_should_in_every_direction() {
        for x in -7..=7 {
            for y in -7..=7 {
                let block = line([3, -4], [3 + x, -4 + y]);
                let end = run(Model::Rotated, &block, |_, _| {}).unwrap();
                assert_eq!((end.dx, end.dy), (x, y), "{block}");
            }
        }
    }

    #[test]
    fn an_arc_ends_within_1_um_or_so_in_every_model_over_any_sweep() {
        for model in [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact] {
            for (start, sweep) in [
                ([3000, 0], 1.0),
                ([2100, 2200], 2.9),
                ([-500, 1234], 4.5),
                ([-7, -4000], 6.0),
                ([40, -9], 0.3),
            ] {
                for turn in [Turn::Clockwise, Turn::CounterClockwise] {
                    let from = Point::whole(start);
                    let angle = from.angle() + turn.sign() * sweep;
                    let end = Point { x: libm::cos(angle), y: libm::sin(angle) }.times(from.length());
                    let centre = [17, -23];
                    let (from, to) = ([start[0] + 17, start[1] - 23], end.plus(Point::whole(centre)));
                    let block = arc(model, from, centre, turn, sweep, to).unwrap();
                    let travel = run(model, &block, |_, _| {}).unwrap();
                    let stands = Point::whole([from[0] + travel.dx, from[1] + travel.dy]);
                    let off = stands.minus(to).length();
                    assert!(off <= 1.5, "{model:?} {turn:?} {block}: {off}");
                }
            }
        }
    }

    #[test]
    fn a_full_circle_is_told_from_none() {
        for radius in [2_u32, 3, 9, 17, 9900] {
            let to = Point { x: f64::from(radius), y: 0.0 };
            let from = [i64::from(radius), 0];
            let block = arc(Model::Exact, from, [0, 0], Turn::CounterClockwise, TAU, to).unwrap();
            assert_eq!(block.j, 4 * radius);
            let none = arc(Model::Exact, from, [0, 0], Turn::CounterClockwise, 0.0, to).unwrap();
            assert_eq!(none.j, 0);
        }
    }
}
