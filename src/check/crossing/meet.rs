//! Where two elements meet: lines and true arcs, without chords.
//!
//! The points lie on both elements; stretches that run along each other have no single point and give none.

use crate::geometry::{Element, Point, Vector, sweep};

/// The points that two elements have in common, at most two.
#[must_use]
pub fn meet(a: &Element, b: &Element) -> [Option<Point>; 2] {
    match (*a, *b) {
        (Element::Line { start: p, end: q }, Element::Line { start: r, end: s }) => {
            [line_and_line(p, q, r, s), None]
        }
        (Element::Line { start, end }, Element::Arc { centre, .. }) => {
            line_and_circle(start, end, centre, radius(b)).map(|point| point.filter(|&p| is_on_arc(b, p)))
        }
        (Element::Arc { .. }, Element::Line { .. }) => meet(b, a),
        (Element::Arc { centre: c, .. }, Element::Arc { centre: d, .. }) => {
            circles(c, radius(a), d, radius(b))
                .map(|point| point.filter(|&p| is_on_arc(a, p) && is_on_arc(b, p)))
        }
    }
}

/// A point may lie this far beyond an end and still be at it, mm: half a micron.
const END_MM: f64 = 0.0005;

fn line_and_line(p: Point, q: Point, r: Point, s: Point) -> Option<Point> {
    let (u, v, w) = (q - p, s - r, r - p);
    let cross = |a: Vector, b: Vector| a.x * b.y - a.y * b.x;
    let area = cross(u, v);
    let (length, other) = (u.norm(), v.norm());
    if area.abs() <= 1e-12 * length * other {
        return None;
    }
    let (t, k) = (cross(w, v) / area, cross(w, u) / area);
    let within = |t: f64, length: f64| -END_MM <= t * length && (t - 1.0) * length <= END_MM;
    (within(t, length) && within(k, other)).then(|| p + u * t.clamp(0.0, 1.0))
}

fn line_and_circle(start: Point, end: Point, centre: Point, radius: f64) -> [Option<Point>; 2] {
    let way = end - start;
    let length = way.norm();
    if length == 0.0 {
        return [None, None];
    }
    let ahead = way / length;
    let along = (centre - start).dot(&ahead);
    let foot = start + ahead * along;
    let square = radius * radius - (foot - centre).norm_squared();
    if square <= 0.0 {
        return [None, None];
    }
    let half = square.sqrt();
    [along - half, along + half]
        .map(|at| (-END_MM <= at && at <= length + END_MM).then(|| start + ahead * at.clamp(0.0, length)))
}

fn circles(c: Point, r: f64, d: Point, s: f64) -> [Option<Point>; 2] {
    let way = d - c;
    let distance = way.norm();
    // About one centre, or nearly: two circles of one contour, or the same one again.
    if distance <= 1e-9 * (r + s) {
        return [None, None];
    }
    let along = (distance * distance + r * r - s * s) / (2.0 * distance);
    let square = r * r - along * along;
    if square <= 0.0 {
        return [None, None];
    }
    let (ahead, half) = (way / distance, square.sqrt());
    let foot = c + ahead * along;
    let aside = Vector::new(-ahead.y, ahead.x) * half;
    [Some(foot + aside), Some(foot - aside)]
}

/// The radius between those of the ends.
fn radius(arc: &Element) -> f64 {
    match *arc {
        Element::Line { .. } => 0.0,
        Element::Arc { start, end, centre, .. } => 0.5 * ((start - centre).norm() + (end - centre).norm()),
    }
}

/// Whether a point of an arc's circle lies on the arc.
fn is_on_arc(arc: &Element, point: Point) -> bool {
    let Element::Arc { start, end, centre, sense } = *arc else { return false };
    start == end
        || (point - start).norm() <= END_MM
        || (point - end).norm() <= END_MM
        || sweep(start - centre, point - centre, sense) <= arc.sweep()
}
