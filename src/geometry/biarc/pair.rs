//! One biarc, or one chord, between two nodes of a curve, and how far the curve is from it.
//!
//! With P, S the ends, T, U their directions and d, e the lengths of the tangents, the arcs meet on the line from P + d·T
//! to S − e·U, which is d + e long. All the places where they may meet lie on one circle through P and S; the one taken
//! lies where the curve crosses that circle, so that the deviation is shared out evenly.

use std::f64::consts::TAU;

use crate::geometry::curve::Curve;
use crate::geometry::{Element, Point, Sense, Vector, turn};

use super::walk::{Node, Stretch};

/// One or two elements between two nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pieces {
    first: Element,
    second: Option<Element>,
}

impl Pieces {
    /// The straight line.
    pub(super) fn chord(start: Point, end: Point) -> Self {
        Self { first: Element::Line { start, end }, second: None }
    }

    /// A biarc in the directions of the nodes, or a single arc or line where that has them; none where no biarc has.
    pub(super) fn biarc(
        curve: &impl Curve,
        stretch: &Stretch,
        [from, to]: [f64; 2],
        [start, end]: [Node; 2],
        radius_max: f64,
    ) -> Option<Self> {
        let way = end.point - start.point;
        if way.norm_squared() == 0.0 {
            return None;
        }
        let single = arc(start.point, start.heading, end.point, radius_max);
        if turn(single.heading_at_end(), end.heading).abs() <= SMOOTH
            && turn(single.heading_at_start(), start.heading).abs() <= SMOOTH
        {
            return Some(Self { first: single, second: None });
        }
        let joint = meeting(curve, stretch, [from, to], [start, end])?;
        let first = arc(start.point, start.heading, joint, radius_max);
        let second = arc(end.point, -end.heading, joint, radius_max).reversed();
        (joint != start.point && joint != end.point).then_some(Self { first, second: Some(second) })
    }

    pub(super) fn elements(self) -> impl Iterator<Item = Element> {
        std::iter::once(self.first).chain(self.second)
    }

    pub(super) fn end(&self) -> Point {
        self.second.as_ref().unwrap_or(&self.first).end()
    }

    /// About the greatest distance of the curve from the elements, mm, from a few places.
    pub(super) fn glance(&self, curve: &impl Curve, stretch: &Stretch, [from, to]: [f64; 2]) -> f64 {
        let probes = self.probes();
        let measure = |eighths: f64| {
            probes.distance(curve.sample(stretch.parameter(from + (to - from) * eighths / 8.0)))
        };
        // The tops of an arc's and of a biarc's deviation lie a twentieth above these places.
        1.06 * [1.0, 3.0, 5.0, 7.0].map(measure).into_iter().fold(0.0, f64::max)
    }

    fn probes(&self) -> Probes {
        Probes { first: Probe::of(&self.first), second: self.second.as_ref().map(Probe::of) }
    }

    /// The greatest distance found of the curve's points from the elements, mm; when it is beyond the tolerance, one
    /// that is beyond it.
    pub(super) fn deviation(
        &self,
        curve: &impl Curve,
        stretch: &Stretch,
        [from, to]: [f64; 2],
        tolerance: f64,
    ) -> f64 {
        let probes = self.probes();
        let measure =
            |share: f64| probes.distance(curve.sample(stretch.parameter(from + (to - from) * share)));
        let mut most = 0.0_f64;
        let count = PLACES.max((3.0 * (to - from)) as usize);
        let mut last = [0.0, 0.0];
        for n in 1..=count {
            let share = |n: f64| n / count as f64;
            let next = if n < count { measure(share(n as f64)) } else { 0.0 };
            let is_top = last[1] > last[0] && last[1] >= next;
            if is_top && peak(last, next) > 0.7 * tolerance {
                // A top that matters is measured again, closer by.
                let mut near = [last[0], measure(share(n as f64 - 1.75))];
                for (part, value) in
                    [(1.5, None), (1.25, None), (1.0, Some(last[1])), (0.75, None), (0.5, None)]
                {
                    let value = value.unwrap_or_else(|| measure(share(n as f64 - part)));
                    most = most.max(value).max(peak(near, value));
                    near = [near[1], value];
                }
            }
            most = most.max(next);
            if most > tolerance {
                break;
            }
            last = [last[1], next];
        }
        most
    }
}

/// The top of the parabola through three values evenly apart, where the middle one is the highest.
fn peak([before, middle]: [f64; 2], after: f64) -> f64 {
    if middle <= before || middle < after {
        return middle;
    }
    let slope = 0.5 * (after - before);
    middle + 0.5 * slope * slope / (2.0 * middle - before - after)
}

/// Where the two arcs meet.
fn meeting(
    curve: &impl Curve,
    stretch: &Stretch,
    [from, to]: [f64; 2],
    [start, end]: [Node; 2],
) -> Option<Point> {
    let (p, t, s, u) = (start.point, start.heading, end.point, end.heading);
    let way = s - p;
    let apart = (t - u).norm_squared();
    // Both tangents of one length.
    let along = way.dot(&(t + u));
    let equal = way.norm_squared() / (along + (along * along + apart * way.norm_squared()).sqrt());
    let joint_of = |d: f64| {
        let e = (way.norm_squared() - 2.0 * d * way.dot(&t)) / (2.0 * way.dot(&u) + d * apart);
        let good = d > 0.0 && e > 0.0 && d.is_finite() && e.is_finite();
        good.then(|| {
            let (a, b) = (p + t * d, s - u * e);
            a + (b - a) * (d / (d + e))
        })
    };
    let even = joint_of(equal)?;
    // On the circle of all meeting places, the direction to and from the place differ by one angle: zero where `side` is.
    let (cross_even, dot_even) = (cross(even - p, s - even), (even - p).dot(&(s - even)));
    let side = |a: Vector, b: Vector| {
        let (c, d) = (cross(a, b), a.dot(&b));
        (c * dot_even - d * cross_even)
            / ((c * c + d * d) * (cross_even * cross_even + dot_even * dot_even)).sqrt()
    };
    let (mut low, mut high) = ((from, side(t, way)), (to, side(way, u)));
    if !(low.1 * high.1 < 0.0 && low.1.abs().max(high.1.abs()) > 1e-9) {
        return Some(even);
    }
    let mut crossing = None;
    for _ in 0..CROSSING_TRIES {
        let share = (low.1 / (low.1 - high.1)).clamp(0.1, 0.9);
        let at = low.0 + (high.0 - low.0) * share;
        let q = curve.sample(stretch.parameter(at));
        let value = side(q - p, s - q);
        crossing = Some(q);
        if value.abs() < 0.02 * (low.1.abs() + high.1.abs()) {
            break;
        }
        if value * low.1 > 0.0 { low = (at, value) } else { high = (at, value) }
    }
    let seen = crossing? - p;
    let d = seen.norm_squared() / (2.0 * t.dot(&seen));
    joint_of(d).or(Some(even))
}

/// The arc from a point in a direction to another point; the line where it does not turn, or hardly.
fn arc(start: Point, heading: Vector, end: Point, radius_max: f64) -> Element {
    let way = end - start;
    let off = cross(heading, way);
    let length2 = way.norm_squared();
    let radius = length2 / (2.0 * off);
    let straight = 2.0 * off.abs() <= SMOOTH * length2.sqrt() && heading.dot(&way) > 0.0;
    if straight || !radius.is_finite() || radius.abs() > radius_max {
        return Element::Line { start, end };
    }
    let left = Vector::new(-heading.y, heading.x);
    let sense = if radius > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
    Element::Arc { start, end, centre: start + left * radius, sense }
}

/// One element for two that follow each other on one circle or one line.
pub(super) fn merged(first: &Element, second: &Element) -> Option<Element> {
    match (*first, *second) {
        (Element::Line { start, .. }, Element::Line { end, .. }) => {
            let straight = turn(first.heading_at_end(), second.heading_at_start()).abs() <= SMOOTH;
            (straight && start != end).then_some(Element::Line { start, end })
        }
        (
            Element::Arc { start, centre, sense, .. },
            Element::Arc { end, centre: other, sense: other_sense, .. },
        ) => {
            let radius = (start - centre).norm();
            let near = SAME_CIRCLE + 1e-12 * radius;
            let same = sense == other_sense
                && (centre - other).norm() <= near
                && ((end - centre).norm() - radius).abs() <= near;
            let swept = first.sweep() + second.sweep();
            let fits = if start == end { swept > 6.0 } else { swept < TAU - 1e-9 };
            (same && fits).then_some(Element::Arc { start, end, centre, sense })
        }
        _ => None,
    }
}

/// An element prepared for many distances; its arcs are less than half a circle.
struct Probe {
    start: Point,
    end: Point,
    kind: Kind,
}

enum Kind {
    Line {
        /// Along it, of length 1.
        along: Vector,
        length: f64,
    },
    Arc {
        centre: Point,
        radius: f64,
        /// From the centre to both ends.
        arms: [Vector; 2],
        /// 1 counter-clockwise, −1 clockwise.
        sign: f64,
    },
}

impl Probe {
    fn of(element: &Element) -> Self {
        let (start, end) = (element.start(), element.end());
        let kind = match *element {
            Element::Line { .. } => {
                let way = end - start;
                let length = way.norm();
                // Without a length it has no side: nothing lies beside it.
                if length > 0.0 {
                    Kind::Line { along: way / length, length }
                } else {
                    Kind::Line { along: way, length: -1.0 }
                }
            }
            Element::Arc { centre, sense, .. } => {
                let sign = if sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
                let arms = [start - centre, end - centre];
                Kind::Arc { centre, radius: arms[0].norm(), arms, sign }
            }
        };
        Self { start, end, kind }
    }

    /// The distance of a point beside the element; none for one before its start or behind its end.
    #[inline]
    fn beside(&self, p: Point) -> Option<f64> {
        let off = p - self.start;
        match &self.kind {
            Kind::Line { along, length } => {
                let at = off.dot(along);
                (0.0 <= at && at <= *length).then(|| cross(*along, off).abs())
            }
            Kind::Arc { centre, radius, arms: [first, last], sign } => {
                let seen = p - centre;
                let is_beside = cross(*first, seen) * sign >= 0.0 && cross(seen, *last) * sign >= 0.0;
                // The difference of the squares, free of cancellation where the radius is large.
                is_beside.then(|| off.dot(&(seen + first)).abs() / (seen.norm() + radius))
            }
        }
    }

    fn to_nearest_end(&self, p: Point) -> f64 {
        (p - self.start).norm_squared().min((p - self.end).norm_squared()).sqrt()
    }
}

/// The probes of both elements.
struct Probes {
    first: Probe,
    second: Option<Probe>,
}

impl Probes {
    /// The distance of a point from the elements.
    ///
    /// A point beside the first is not measured against the second: an arc that turns less than half a circle never comes
    /// back over the line on which it was met, so of what is near the second only that about the meeting lies beside both.
    #[inline]
    fn distance(&self, p: Point) -> f64 {
        if let Some(distance) = self.first.beside(p) {
            return distance;
        }
        if let Some(distance) = self.second.as_ref().and_then(|second| second.beside(p)) {
            return distance;
        }
        let first = self.first.to_nearest_end(p);
        self.second.as_ref().map_or(first, |second| first.min(second.to_nearest_end(p)))
    }
}

fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Directions this close are one, radians.
const SMOOTH: f64 = 5e-10;
/// Centres and radii this close are one circle, mm.
const SAME_CIRCLE: f64 = 1e-8;
/// Places in which a piece is measured, at least.
const PLACES: usize = 36;
/// Tries for the crossing; it need not be met closely.
const CROSSING_TRIES: usize = 4;
