//! The largest wire that touches a contour at a point: the largest circle on the wire's side that touches there and
//! holds nothing of the contour.
//!
//! A circle within a larger one that touches at the same point is empty when the larger one is. So an element is
//! touched by every wire up to the largest one that touches it anywhere.

use cavalier_contours::static_aabb2d_index::Control;

use super::source::{Piece, Source, cross};
use crate::geometry::{Element, Point, Sense, Vector};

impl Source {
    /// The largest radius that touches the element somewhere, mm; no more than the offset.
    pub(super) fn reach_of(&self, element: usize, way: &Element) -> f64 {
        let at = |fraction: f64| self.reach_at(way, fraction, &|other| other == element);
        let fractions = (0..SAMPLES).map(|n| (n as f64 + 0.5) / SAMPLES as f64);
        let best = fractions.max_by(|&a, &b| at(a).total_cmp(&at(b))).unwrap_or(0.5);
        at(highest(&at, best - 1.0 / SAMPLES as f64, best + 1.0 / SAMPLES as f64)).max(at(best))
    }

    /// The smallest of the radii that touch the element between two fractions of it, mm, `passed` elements left out.
    pub(super) fn throat(&self, way: &Element, [from, to]: [f64; 2], passed: &dyn Fn(usize) -> bool) -> f64 {
        let at = |fraction: f64| -self.reach_at(way, fraction, passed);
        let step = (to - from) / SAMPLES as f64;
        let fractions = (0..=SAMPLES).map(|n| from + n as f64 * step);
        let best = fractions.max_by(|&a, &b| at(a).total_cmp(&at(b))).unwrap_or(from);
        -at(highest(&at, (best - step).max(from), (best + step).min(to))).max(at(best))
    }

    /// The largest radius that touches a way at a fraction of it, mm, where `passed` elements do not count.
    fn reach_at(&self, way: &Element, fraction: f64, passed: &dyn Fn(usize) -> bool) -> f64 {
        let most = self.left.abs();
        let point = way.at(fraction);
        let towards = self.left.signum();
        let (normal, own) = match *way {
            Element::Line { .. } => (left_of(way.heading_at_start()) * towards, most),
            Element::Arc { centre, sense, .. } => {
                let out = point - centre;
                let radius = out.norm();
                let inwards = (sense == Sense::CounterClockwise) == (towards > 0.0);
                if radius == 0.0 {
                    return 0.0;
                }
                if inwards { (-out / radius, radius.min(most)) } else { (out / radius, most) }
            }
        };
        let mut reach = own;
        let middle = point + normal * most;
        let mut visit = |n: usize| {
            if !passed(self.pieces[n].element) {
                reach = reach.min(limit(point, normal, &self.pieces[n]));
            }
            Control::<()>::Continue
        };
        self.index.visit_query(
            middle.x - most,
            middle.y - most,
            middle.x + most,
            middle.y + most,
            &mut visit,
        );
        reach
    }
}

/// The radius with which a circle that touches at a point, on the side of the normal, touches a piece too; infinite
/// where it never does.
fn limit(point: Point, normal: Vector, piece: &Piece) -> f64 {
    let ends = at_point(point, normal, piece.start).min(at_point(point, normal, piece.end));
    let Some(bend) = piece.bend else { return ends.min(at_line(point, normal, piece)) };
    let seen = point - bend.centre;
    let (radius, height) = (bend.radius, normal.dot(&seen));
    let beyond = seen.norm_squared() - radius * radius;
    let runs_through = |foot: Vector| {
        let side = if bend.sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
        side * cross(piece.start - bend.centre, foot) >= 0.0
            && side * cross(foot, piece.end - bend.centre) >= 0.0
    };
    // Touching the arc's circle from outside, then from inside.
    let outside = ratio(beyond, 2.0 * (radius - height));
    let inside = ratio(-beyond, 2.0 * (radius + height));
    let touched = |candidate: f64| {
        let foot = seen + normal * candidate;
        if candidate < ends && runs_through(foot) { candidate } else { f64::INFINITY }
    };
    ends.min(touched(outside)).min(touched(inside))
}

fn at_point(point: Point, normal: Vector, other: Point) -> f64 {
    let way = other - point;
    ratio(way.norm_squared(), 2.0 * normal.dot(&way))
}

fn at_line(point: Point, normal: Vector, piece: &Piece) -> f64 {
    let way = piece.end - piece.start;
    let length = way.norm();
    let seen = point - piece.start;
    let across = left_of(way / length);
    let height = across.dot(&seen);
    let (across, height) = if height < 0.0 { (-across, -height) } else { (across, height) };
    let radius = ratio(height, 1.0 - across.dot(&normal));
    let foot = (seen + normal * radius).dot(&way) / length;
    if 0.0 <= foot && foot <= length { radius } else { f64::INFINITY }
}

/// A positive quotient; infinite where it is not one.
fn ratio(over: f64, under: f64) -> f64 {
    let quotient = over / under;
    if under > NOTHING && quotient > 0.0 { quotient } else { f64::INFINITY }
}

fn left_of(heading: Vector) -> Vector {
    Vector::new(-heading.y, heading.x)
}

/// Where a function of one hump between two numbers is highest, by golden sections.
fn highest(height: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_a, mut at_b) = (height(a), height(b));
    for _ in 0..SECTIONS {
        if at_a < at_b {
            (low, a, at_a) = (a, b, at_b);
            b = low + golden * (high - low);
            at_b = height(b);
        } else {
            (high, b, at_b) = (b, a, at_a);
            a = high - golden * (high - low);
            at_a = height(a);
        }
    }
    0.5 * (low + high)
}

/// Places tried on an element before the best is closed in on.
const SAMPLES: usize = 32;
/// Golden sections, each 0.62 of the last: 30 leave less than a millionth of the first.
const SECTIONS: usize = 30;
/// What a difference of cosines or lengths must exceed to be told from a rounding.
const NOTHING: f64 = 1e-12;

#[cfg(test)]
mod tests;
