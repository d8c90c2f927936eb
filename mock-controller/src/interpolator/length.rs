//! How long a block's path is: nominal curves between executed ends.
//!
//! A line counts as straight from where it began to where it ended. An arc counts as part of the circle through its
//! start: the sweep that J means on the true circle, corrected by the angle between the true and the executed end.
//! Only for the report; nothing is decided by it.

use std::f64::consts::{PI, TAU};

use super::{Travel, exact::Walk};
use crate::dialect::three_b::{Block, Kind};

/// The length of an executed block, µm.
#[must_use]
pub fn length_um(block: &Block, travel: &Travel) -> f64 {
    match block.kind {
        Kind::Line => libm::hypot(real(travel.dx), real(travel.dy)),
        Kind::Clockwise => arc_length_um(block, travel, -1.0),
        Kind::CounterClockwise => arc_length_um(block, travel, 1.0),
    }
}

fn arc_length_um(block: &Block, travel: &Travel, sense: f64) -> f64 {
    let Some(walk) = Walk::new(block) else {
        return 0.0;
    };
    let (sign_x, sign_y) = block.quadrant.signs();
    let (start_x, start_y) = (real(sign_x * i64::from(block.x)), real(sign_y * i64::from(block.y)));
    let mut sweep = 0.0;
    let mut true_end = (start_x, start_y);
    for piece in walk {
        sweep += between(piece.from, piece.to).abs();
        true_end = piece.to;
    }
    let executed = (start_x + real(travel.dx), start_y + real(travel.dy));
    (sweep + sense * between(true_end, executed)).max(0.0) * libm::hypot(start_x, start_y)
}

/// The angle from one direction to another, radians, counter-clockwise positive, in (−π, π].
fn between(from: (f64, f64), to: (f64, f64)) -> f64 {
    let angle = libm::atan2(to.1, to.0) - libm::atan2(from.1, from.0);
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}

#[expect(clippy::cast_precision_loss, reason = "a coordinate is far below 2^53 µm")]
fn real(coordinate_um: i64) -> f64 {
    coordinate_um as f64
}
