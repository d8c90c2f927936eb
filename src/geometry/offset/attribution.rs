//! What each segment of a found outline runs beside: a piece of the contour, or one of its corners.
//!
//! Outlines follow the contour in its order, so the search goes on from where the last segment was found and is short.

use cavalier_contours::polyline::{PlineSource, PlineVertex, Polyline, seg_arc_radius_and_center};

use super::source::{Source, cross};
use super::{Origin, Outline};
use crate::geometry::{Element, Path, Point, Sense};

/// The outline of a polyline, begun with its part nearest to the contour's beginning, every segment attributed.
pub(super) fn outline(source: &Source, found: &Polyline) -> Option<Outline> {
    let count = found.segment_count();
    let mut elements: Vec<Element> = Vec::with_capacity(count);
    let mut origins: Vec<Origin> = Vec::with_capacity(count);
    let mut key = None;
    // The least key, and where it is met first.
    let (mut least, mut first) = (usize::MAX, 0);
    for (from, to) in found.iter_segments() {
        let segment = Segment::between(from, to);
        let next = source.key_of(&segment, key);
        if next.number < least {
            (least, first) = (next.number, elements.len());
        }
        elements.push(source.element(&segment, next));
        origins.push(source.origin(next.number));
        key = Some(next.number);
    }
    if found.is_closed() && !elements.is_empty() {
        // The ring may have been opened within what comes first.
        if first == 0 && key == Some(least) {
            let within = origins.iter().rev().take_while(|&&origin| origin == origins[0]).count();
            first = (elements.len() - within) % elements.len();
        }
        elements.rotate_left(first);
        origins.rotate_left(first);
    }
    merge(&mut elements, &mut origins);
    Path::new(elements).map(|path| Outline { path, origins })
}

/// Makes one of neighbours that are one way beside the same element: halves of an arc, a line cut in two.
fn merge(elements: &mut Vec<Element>, origins: &mut Vec<Origin>) {
    let is_one = |n: usize| origins[n] == origins[n + 1] && goes_on(&elements[n], &elements[n + 1]);
    if !(0..elements.len().saturating_sub(1)).any(is_one) {
        return;
    }
    let parts: Vec<_> = elements.drain(..).zip(origins.drain(..)).collect();
    for (element, origin) in parts {
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
}

/// What a segment runs beside.
#[derive(Clone, Copy)]
struct Key {
    /// Twice the index of the piece; one more for the corner at that piece's end.
    number: usize,
    /// Whether it lies where it should.
    is_exact: bool,
}

/// A segment as the library found it.
struct Segment {
    from: Point,
    to: Point,
    /// A point half-way.
    middle: Point,
    bulge: f64,
}

impl Segment {
    fn between(from: PlineVertex<f64>, to: PlineVertex<f64>) -> Self {
        let (bulge, from, to) = (from.bulge, Point::new(from.x, from.y), Point::new(to.x, to.y));
        let way = to - from;
        // Half-way an arc stands off its chord by half the chord times the bulge, to the right when counter-clockwise.
        let middle = Point::new(0.5 * (from.x + to.x + bulge * way.y), 0.5 * (from.y + to.y - bulge * way.x));
        Self { from, to, middle, bulge }
    }

    fn sense(&self) -> Option<Sense> {
        match self.bulge {
            bulge if bulge > 0.0 => Some(Sense::CounterClockwise),
            bulge if bulge < 0.0 => Some(Sense::Clockwise),
            _ => None,
        }
    }

    /// Whether it runs on a circle, as far as three of its points can tell.
    fn is_on(&self, centre: Point, radius: f64) -> bool {
        // The squares differ by the sum of the radii times their difference.
        let most = NEAR * (2.0 * radius + NEAR);
        let is_near = |p: Point| ((p - centre).norm_squared() - radius * radius).abs() < most;
        is_near(self.from) && is_near(self.middle) && is_near(self.to)
    }
}

impl Source {
    /// The key of what a segment runs beside, looked for from the last key on.
    fn key_of(&self, segment: &Segment, last: Option<usize>) -> Key {
        let count = 2 * self.pieces.len();
        let is_beside = |number: &usize| self.is_beside(segment, *number);
        // Nearly always the next piece, or the corner between.
        let likely = last.map(|last| {
            let next = last - last % 2 + 2;
            [if next < count { next } else { 0 }, last | 1]
        });
        let around = (0..count).map(|n| (last.unwrap_or(0) + n) % count);
        let exact =
            likely.into_iter().flatten().find(is_beside).or_else(|| around.into_iter().find(is_beside));
        // What matches nothing is given to the piece nearest to it.
        let nearest = || {
            let off = |n: usize| (self.piece(n).distance(segment.middle) - self.left.abs()).abs();
            2 * (0..self.pieces.len()).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0)
        };
        Key { number: exact.unwrap_or_else(nearest), is_exact: exact.is_some() }
    }

    fn is_beside(&self, segment: &Segment, key: usize) -> bool {
        let piece = &self.pieces[key / 2];
        if key % 2 == 1 {
            let round = if self.left > 0.0 { Sense::Clockwise } else { Sense::CounterClockwise };
            return segment.sense() == Some(round) && segment.is_on(piece.end, self.left.abs());
        }
        let Some(bend) = piece.bend else {
            let way = piece.end - piece.start;
            let (near, most) = (NEAR * piece.length, piece.length * (piece.length + NEAR));
            let is_near = |p: Point| {
                let seen = p - piece.start;
                let foot = seen.dot(&way);
                (cross(way, seen) - self.left * piece.length).abs() < near && -near < foot && foot < most
            };
            return segment.bulge == 0.0
                && is_near(segment.from)
                && is_near(segment.to)
                && (segment.to - segment.from).dot(&way) > 0.0;
        };
        let seen = segment.middle - bend.centre;
        let side = if bend.sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
        let slack = -NEAR * bend.radius;
        segment.sense() == Some(bend.sense)
            && segment.is_on(bend.centre, bend.radius_beside(self.left))
            && side * cross(piece.start - bend.centre, seen) >= slack
            && side * cross(seen, piece.end - bend.centre) >= slack
    }

    fn origin(&self, key: usize) -> Origin {
        let element = self.pieces[key / 2].element;
        if key % 2 == 1 { Origin::Corner(element) } else { Origin::Element(element) }
    }

    /// The element a segment is, with the centre the contour knows.
    fn element(&self, segment: &Segment, key: Key) -> Element {
        let (start, end) = (segment.from, segment.to);
        let Some(sense) = segment.sense() else { return Element::Line { start, end } };
        let piece = &self.pieces[key.number / 2];
        let centre = match piece.bend {
            Some(bend) if key.is_exact && key.number.is_multiple_of(2) => bend.centre,
            _ if key.is_exact => piece.end,
            _ => {
                let vertex = |p: Point, bulge| PlineVertex::new(p.x, p.y, bulge);
                let (_, centre) = seg_arc_radius_and_center(vertex(start, segment.bulge), vertex(end, 0.0));
                Point::new(centre.x, centre.y)
            }
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

/// Whether two elements run on the same line or circle, given that they run beside the same element.
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

/// How far a found node may be off, mm: a few times what the library takes for one point.
const NEAR: f64 = 5e-5;

#[cfg(test)]
mod tests;
