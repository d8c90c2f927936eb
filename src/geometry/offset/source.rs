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
        let mut made = Self {
            polyline: Polyline::with_capacity(elements.len() + 2, path.is_closed()),
            index: Polyline::<f64>::new().create_approx_aabb_index(),
            pieces: Vec::with_capacity(elements.len() + 2),
            left,
            elements: elements.len(),
        };
        for (n, element) in elements.iter().enumerate() {
            match *element {
                Element::Line { start, end } => made.push(n, start, end, None),
                Element::Arc { start, end, centre, sense } => {
                    if is_beyond_half(start, end, centre, sense) {
                        let middle = element.at(0.5);
                        made.push(n, start, middle, Some((centre, sense)));
                        made.push(n, middle, end, Some((centre, sense)));
                    } else {
                        made.push(n, start, end, Some((centre, sense)));
                    }
                }
            }
        }
        made.close(path);
        made.index = made.polyline.create_approx_aabb_index();
        made
    }

    /// Adds a piece; one shorter than what the library tells apart is left out.
    fn push(&mut self, element: usize, start: Point, end: Point, bend: Option<(Point, Sense)>) {
        // Where something was left out in front, the piece begins at the last end that is known.
        let start = self.pieces.last().map_or(start, |last| last.end);
        if (end - start).norm() <= ONE_POINT {
            return;
        }
        let bulge = bend.map_or(0.0, |(centre, sense)| bulge(start, end, centre, sense));
        let bend = bend.map(|(centre, sense)| bend_through(start, end, bulge, centre, sense));
        self.polyline.add(start.x, start.y, bulge);
        self.pieces.push(Piece { element, start, end, bend });
    }

    /// Brings the last piece to the contour's end.
    fn close(&mut self, path: &Path) {
        let Some(first) = self.pieces.first().map(|piece| piece.start) else { return };
        let Some(last) = self.pieces.last_mut() else { return };
        if path.is_closed() {
            last.end = first;
        } else {
            self.polyline.add(last.end.x, last.end.y, 0.0);
        }
    }
}

/// Whether an arc is more than half a circle, by more than a rounding.
fn is_beyond_half(start: Point, end: Point, centre: Point, sense: Sense) -> bool {
    let (from, to) = (start - centre, end - centre);
    let sine = along(cross(from, to), sense);
    let rounding = 1e-9 * from.norm() * to.norm();
    start == end || (sine < 0.0 && !(from.dot(&to) < 0.0 && sine > -rounding))
}

/// The tangent of a quarter of the angle swept, positive counter-clockwise; for arcs up to half a circle.
fn bulge(start: Point, end: Point, centre: Point, sense: Sense) -> f64 {
    let (from, to) = (start - centre, end - centre);
    let size = from.norm() * to.norm();
    if size == 0.0 {
        return 0.0;
    }
    let cosine = (from.dot(&to) / size).clamp(-1.0, 1.0);
    let sine = (along(cross(from, to), sense) / size).clamp(0.0, 1.0);
    // Two forms of one tangent, each where it loses no digits.
    let quarter = if cosine >= 0.0 {
        sine / (1.0 + cosine + (2.0 * (1.0 + cosine)).sqrt())
    } else {
        (1.0 - cosine) / (sine + (2.0 * (1.0 - cosine)).sqrt())
    };
    along(quarter, sense)
}

/// The circle as it was given, or through both ends where the given one misses them by a rounding of its own.
fn bend_through(start: Point, end: Point, bulge: f64, centre: Point, sense: Sense) -> Bend {
    let radius = (start - centre).norm();
    if (radius - (end - centre).norm()).abs() <= 1e-9 || bulge == 0.0 {
        return Bend { centre, radius, sense };
    }
    let vertex = |p: Point, bulge| PlineVertex::new(p.x, p.y, bulge);
    let (radius, centre) = seg_arc_radius_and_center(vertex(start, bulge), vertex(end, 0.0));
    Bend { centre: Point::new(centre.x, centre.y), radius, sense }
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
