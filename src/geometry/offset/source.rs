//! A contour as the library takes it: vertices with bulges, no two in one place, no arc beyond half a circle.
//!
//! Each segment of the polyline is a piece of an element; the pieces remember which, and keep the circle the element
//! was given with, because a bulge alone gives its centre back only to a rounding.

use cavalier_contours::polyline::{
    PlineCreation, PlineSource, PlineSourceMut, PlineVertex, Polyline, seg_arc_radius_and_center,
};
use cavalier_contours::static_aabb2d_index::StaticAABB2DIndex;

use super::ONE_POINT;
use crate::geometry::{Element, Path, Point, Sense, Vector};

/// A contour ready to be offset.
pub(super) struct Source {
    /// What the library works on.
    pub(super) polyline: Polyline,
    /// Where each of its segments lies.
    pub(super) index: StaticAABB2DIndex<f64>,
    /// One for each segment.
    pub(super) pieces: Vec<Piece>,
    /// How far to the left, mm.
    pub(super) left: f64,
    /// How many elements the contour has.
    pub(super) elements: usize,
}

/// A piece of an element: the element, or half of a long arc.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) element: usize,
    pub(super) start: Point,
    pub(super) end: Point,
    /// From end to end, straight, mm.
    pub(super) length: f64,
    pub(super) bend: Option<Bend>,
}

/// The circle a piece runs on.
#[derive(Clone, Copy)]
pub(super) struct Bend {
    pub(super) centre: Point,
    pub(super) radius: f64,
    pub(super) sense: Sense,
}

impl Bend {
    /// The radius of the wire's way beside it; none is left where it is not positive.
    pub(super) fn radius_beside(&self, left: f64) -> f64 {
        match self.sense {
            Sense::CounterClockwise => self.radius - left,
            Sense::Clockwise => self.radius + left,
        }
    }
}

impl Source {
    pub(super) fn new(path: &Path, left: f64) -> Self {
        let elements = path.elements();
        let mut polyline = Polyline::with_capacity(elements.len() + 2, path.is_closed());
        let mut pieces = Vec::with_capacity(elements.len() + 2);
        for (n, element) in elements.iter().enumerate() {
            push(&mut polyline, &mut pieces, n, element);
        }
        close(&mut polyline, &mut pieces, path);
        let index = polyline.create_approx_aabb_index();
        Self { polyline, index, pieces, left, elements: elements.len() }
    }
}

/// Adds the pieces of an element; one shorter than what the library tells apart is left out.
fn push(polyline: &mut Polyline, pieces: &mut Vec<Piece>, number: usize, element: &Element) {
    // Where something was left out in front, the piece begins at the last end that is known.
    let start = pieces.last().map_or(element.start(), |last| last.end);
    let end = element.end();
    let length = (end - start).norm();
    let mut add = |start: Point, end, length, bulge, bend| {
        if length > ONE_POINT {
            polyline.add(start.x, start.y, bulge);
            pieces.push(Piece { element: number, start, end, length, bend });
        }
    };
    let Element::Arc { centre, sense, .. } = *element else { return add(start, end, length, 0.0, None) };
    let (from, to) = (start - centre, end - centre);
    let (radius, other_radius) = (from.norm(), to.norm());
    let bend = Bend { centre, radius, sense };
    // Half a circle may come out a rounding beyond it.
    let half = radius * other_radius;
    let sine = along(cross(from, to), sense);
    let is_beyond_half = sine < 0.0 && !(from.dot(&to) < 0.0 && sine > -1e-9 * half);
    if (is_beyond_half || element.start() == end) && radius > ONE_POINT {
        let middle = element.at(0.5);
        for (start, end) in [(start, middle), (middle, end)] {
            let length = (end - start).norm();
            let bulge = bulge(start - centre, end - centre, length, 2.0 * radius, sense);
            add(start, end, length, bulge, Some(through(bend, start, end, bulge)));
        }
    } else {
        let bulge = bulge(from, to, length, radius + other_radius, sense);
        let is_true = (radius - other_radius).abs() <= 1e-9;
        add(start, end, length, bulge, Some(if is_true { bend } else { through(bend, start, end, bulge) }));
    }
}

/// The tangent of a quarter of the angle swept, positive counter-clockwise, for arcs up to half a circle: the chord is
/// 2 r sin of half the angle, the sum of both radii 2 r cos of it.
fn bulge(from: Vector, to: Vector, chord: f64, both_radii: f64, sense: Sense) -> f64 {
    along(chord / (both_radii + (from + to).norm()), sense)
}

/// Brings the last piece to the contour's end.
fn close(polyline: &mut Polyline, pieces: &mut [Piece], path: &Path) {
    let Some(first) = pieces.first().map(|piece| piece.start) else { return };
    let Some(last) = pieces.last_mut() else { return };
    if path.is_closed() {
        last.end = first;
    } else {
        polyline.add(last.end.x, last.end.y, 0.0);
    }
}

/// The circle as it was given, or through both ends where the given one misses them by a rounding of its own.
fn through(bend: Bend, start: Point, end: Point, bulge: f64) -> Bend {
    if (bend.radius - (end - bend.centre).norm()).abs() <= 1e-9 || bulge.abs() < 1e-12 {
        return bend;
    }
    let vertex = |p: Point, bulge| PlineVertex::new(p.x, p.y, bulge);
    let (radius, centre) = seg_arc_radius_and_center(vertex(start, bulge), vertex(end, 0.0));
    Bend { centre: Point::new(centre.x, centre.y), radius, sense: bend.sense }
}

/// A number that is positive in the sense of an arc, counted counter-clockwise.
fn along(value: f64, sense: Sense) -> f64 {
    match sense {
        Sense::CounterClockwise => value,
        Sense::Clockwise => -value,
    }
}

pub(super) fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

#[cfg(test)]
mod tests;
