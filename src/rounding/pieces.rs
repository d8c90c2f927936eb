//! Elements cut into pieces that a block can count: at most 999 999 µm along its axis.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::formats::three_b::COUNT_MAX;
use crate::geometry::{Element, Point, Sense, Vector};

/// The pieces of an element, in order; nearly always the element itself.
pub(super) fn countable(element: Element) -> impl Iterator<Item = Element> {
    // A margin of one part in a thousand leaves room for rounding; the travel along an axis is at most the length.
    let longest = COUNT_MAX.millimetres() * 0.999;
    let pieces = match element {
        Element::Line { start, end } => {
            let d: Vector = end - start;
            (d.x.abs().max(d.y.abs()) / longest).ceil()
        }
        Element::Arc { start, centre, .. } => {
            let radius = (start - centre).norm();
            // A full turn is tried first, so that the sweep is worked out for long arcs only.
            if TAU * radius <= longest || travel(&element) <= COUNT_MAX.millimetres() {
                1.0
            } else {
                (radius * element.sweep() / longest).ceil()
            }
        }
    };
    let count = pieces.max(1.0) as u64;
    let mut from = element.start();
    (1..=count).map(move |k| {
        let to = if k == count { element.end() } else { at_fraction(&element, k as f64 / count as f64) };
        let start = std::mem::replace(&mut from, to);
        between(&element, start, to)
    })
}

/// The travel of an arc along X or Y, whichever is longer, mm.
fn travel(element: &Element) -> f64 {
    let Element::Arc { start, centre, sense, .. } = *element else { return 0.0 };
    let (r, swept) = (start - centre, element.sweep());
    let from = match sense {
        Sense::CounterClockwise => libm::atan2(r.y, r.x),
        Sense::Clockwise => -libm::atan2(r.y, r.x),
    } + TAU;
    // The integral of |sin| from 0: 2 for each half turn, and of the last one what is begun.
    let along = |angle: f64| 2.0 * (angle / PI).floor() + 1.0 - libm::cos(angle - PI * (angle / PI).floor());
    let between = |from: f64| along(from + swept) - along(from);
    r.norm() * between(from).max(between(from + FRAC_PI_2))
}

/// The point at a fraction of the element's length.
pub(super) fn at_fraction(element: &Element, fraction: f64) -> Point {
    match *element {
        Element::Line { start, end } => start + (end - start) * fraction,
        Element::Arc { start, centre, sense, .. } => {
            let turn = element.sweep() * fraction;
            let (sin, cos) = libm::sincos(match sense {
                Sense::CounterClockwise => turn,
                Sense::Clockwise => -turn,
            });
            let r: Vector = start - centre;
            centre + Vector::new(r.x * cos - r.y * sin, r.x * sin + r.y * cos)
        }
    }
}

/// The part of an element between two of its points.
pub(super) fn between(element: &Element, start: Point, end: Point) -> Element {
    match *element {
        Element::Line { .. } => Element::Line { start, end },
        Element::Arc { centre, sense, .. } => Element::Arc { start, end, centre, sense },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_two_and_a_half_metres_takes_three_blocks() {
        let element = Element::Line { start: Point::new(0.0, 0.0), end: Point::new(2500.0, 10.0) };
        let pieces: Vec<_> = countable(element).collect();
        assert_eq!(pieces.len(), 3);
        assert_eq!(pieces[2].end(), element.end());
        assert_eq!(pieces[0].end(), pieces[1].start());
    }

    #[test]
    fn a_large_full_circle_is_split_and_a_small_one_is_not() {
        let circle = |r: f64| Element::Arc {
            start: Point::new(r, 0.0),
            end: Point::new(r, 0.0),
            centre: Point::origin(),
            sense: Sense::CounterClockwise,
        };
        assert_eq!(countable(circle(100.0)).count(), 1);
        // Six digits count four radii.
        assert_eq!(countable(circle(249.999)).count(), 1);
        assert_eq!(countable(circle(250.0)).count(), 2);
        let pieces: Vec<_> = countable(circle(400.0)).collect();
        assert_eq!(pieces.len(), 3);
        for piece in &pieces {
            assert!(((piece.end() - Point::origin()).norm() - 400.0).abs() < 1e-9);
        }
    }
}
