//! What each segment of a found outline runs beside: a piece of the contour, or one of its corners.
//!
//! Outlines follow the contour in its order, so the search goes on from where the last segment was found and is short.

use cavalier_contours::polyline::{PlineSource, PlineVertex, Polyline, seg_arc_radius_and_center};

use super::source::{Source, cross};
use super::{Origin, Outline};
use crate::geometry::{Element, Path, Point, Sense};

/// The outline of a polyline, begun with its part nearest to the contour's beginning, every segment attributed.
pub(super) fn outline(source: &Source, found: &Polyline) -> Option<Outline> {
    let mut segments: Vec<Segment> =
        found.iter_segments().map(|(from, to)| Segment::between(from, to)).collect();
    let mut key = 0;
    for segment in &mut segments {
        key = source.key_of(segment, key);
        segment.key = key;
    }
    if found.is_closed() {
        let count = segments.len();
        let first = (0..count).min_by_key(|&n| {
            let before = segments[(n + count - 1) % count].key;
            (segments[n].key, before == segments[n].key)
        })?;
        segments.rotate_left(first);
    }
    let mut elements: Vec<Element> = Vec::with_capacity(segments.len());
    let mut origins: Vec<Origin> = Vec::with_capacity(segments.len());
    for segment in &segments {
        let origin = source.origin(segment.key);
        let element = source.element(segment);
        match (elements.last_mut(), origins.last()) {
            (Some(last), Some(before)) if *before == origin && goes_on(last, &element) => {
                *last = joined(last, &element);
            }
            _ => {
                elements.push(element);
                origins.push(origin);
            }
        }
    }
    Path::new(elements).map(|path| Outline { path, origins })
}

/// A segment as the library found it.
struct Segment {
    from: Point,
    to: Point,
    /// A point half-way.
    middle: Point,
    bulge: f64,
    /// Twice the index of the piece it runs beside; one more for the corner at that piece's end.
    key: usize,
}

impl Segment {
    fn between(from: PlineVertex<f64>, to: PlineVertex<f64>) -> Self {
        let (bulge, from, to) = (from.bulge, Point::new(from.x, from.y), Point::new(to.x, to.y));
        let way = to - from;
        // Half-way an arc stands off its chord by half the chord times the bulge, to the right when counter-clockwise.
        let middle = Point::new(0.5 * (from.x + to.x + bulge * way.y), 0.5 * (from.y + to.y - bulge * way.x));
        Self { from, to, middle, bulge, key: 0 }
    }

    fn sense(&self) -> Option<Sense> {
        match self.bulge {
            bulge if bulge > 0.0 => Some(Sense::CounterClockwise),
            bulge if bulge < 0.0 => Some(Sense::Clockwise),
            _ => None,
        }
    }
}

impl Source {
    /// The key of what a segment runs beside, looked for from a key on.
    fn key_of(&self, segment: &Segment, from: usize) -> usize {
        let count = 2 * self.pieces.len();
        let exact = (from..from + count).map(|key| if key < count { key } else { key - count });
        // What matches nothing is given to the piece nearest to it.
        let nearest = || {
            let distance = |n: usize| (self.piece(n).distance(segment.middle) - self.left.abs()).abs();
            2 * (0..self.pieces.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
        };
        exact.into_iter().find(|&key| self.is_beside(segment, key)).unwrap_or_else(nearest)
    }

    fn is_beside(&self, segment: &Segment, key: usize) -> bool {
        let piece = &self.pieces[key / 2];
        if key % 2 == 1 {
            let round = if self.left > 0.0 { Sense::Clockwise } else { Sense::CounterClockwise };
            return segment.sense() == Some(round)
                && [segment.from, segment.middle, segment.to]
                    .iter()
                    .all(|p| is_near((p - piece.end).norm(), self.left.abs()));
        }
        match piece.bend {
            None => {
                let way = piece.end - piece.start;
                let length = way.norm();
                segment.bulge == 0.0
                    && (segment.to - segment.from).dot(&way) > 0.0
                    && [segment.from, segment.to].iter().all(|p| {
                        let seen = p - piece.start;
                        let foot = seen.dot(&way) / length;
                        is_near(cross(way, seen) / length, self.left) && -NEAR < foot && foot < length + NEAR
                    })
            }
            Some(bend) => {
                let radius = bend.radius_beside(self.left);
                let seen = segment.middle - bend.centre;
                let side = if bend.sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
                let slack = -NEAR * bend.radius;
                segment.sense() == Some(bend.sense)
                    && [segment.from, segment.middle, segment.to]
                        .iter()
                        .all(|p| is_near((p - bend.centre).norm(), radius))
                    && side * cross(piece.start - bend.centre, seen) >= slack
                    && side * cross(seen, piece.end - bend.centre) >= slack
            }
        }
    }

    fn origin(&self, key: usize) -> Origin {
        let element = self.pieces[key / 2].element;
        if key % 2 == 1 { Origin::Corner(element) } else { Origin::Element(element) }
    }

    /// The element a segment is, with the centre the contour knows.
    fn element(&self, segment: &Segment) -> Element {
        let (start, end) = (segment.from, segment.to);
        let Some(sense) = segment.sense() else { return Element::Line { start, end } };
        let piece = &self.pieces[segment.key / 2];
        let centre = match piece.bend {
            _ if !self.is_beside(segment, segment.key) => {
                let vertex = |p: Point, bulge| PlineVertex::new(p.x, p.y, bulge);
                let (_, centre) = seg_arc_radius_and_center(vertex(start, segment.bulge), vertex(end, 0.0));
                Point::new(centre.x, centre.y)
            }
            Some(bend) if segment.key % 2 == 0 => bend.centre,
            _ => piece.end,
        };
        Element::Arc { start, end, centre, sense }
    }

    /// A piece as an element of its own.
    pub(super) fn piece(&self, n: usize) -> Element {
        let piece = &self.pieces[n];
        let (start, end) = (piece.start, piece.end);
        match piece.bend {
            None => Element::Line { start, end },
            Some(bend) => Element::Arc { start, end, centre: bend.centre, sense: bend.sense },
        }
    }
}

/// Whether two elements beside the same element are one way: halves of an arc, or a line cut in two.
fn goes_on(before: &Element, after: &Element) -> bool {
    match (before, after) {
        (Element::Line { .. }, Element::Line { .. }) => true,
        (Element::Arc { centre: a, sense: s, .. }, Element::Arc { centre: b, sense: t, .. }) => {
            a == b && s == t
        }
        _ => false,
    }
}

fn joined(before: &Element, after: &Element) -> Element {
    match *before {
        Element::Line { start, .. } => Element::Line { start, end: after.end() },
        Element::Arc { start, centre, sense, .. } => Element::Arc { start, end: after.end(), centre, sense },
    }
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() < NEAR
}

/// How far a found node may be off, mm: a few times what the library takes for one point.
const NEAR: f64 = 5e-5;
