//! The wire's path beside a contour as a closed line along which one can measure.
//!
//! Places on the contour become places on the path: square beside them where the wire comes there, and else, in an inside
//! corner or a slot that is too narrow, the point of the path nearest to them that can be seen from there.

use super::clearance::nearest_within;
use crate::geometry::{Element, Path, Point, Sense, Vector, sweep};
use crate::motion::Side;

/// The path of one pass, begun beside the contour's beginning, with the places beside the contour's marks.
#[derive(Clone, Debug)]
pub(super) struct Track {
    elements: Vec<Element>,
    /// Where each element begins, mm along the track.
    begins: Vec<f64>,
    pub(super) length: f64,
    /// The places beside the marks, mm along the track; the last one is the track's length.
    marks: Vec<f64>,
    /// On which side of the contour it is.
    pub(super) side: Side,
    /// How far from it, mm.
    pub(super) by: f64,
}

/// A place beside a mark of the contour, or past it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Position {
    /// Which mark.
    pub(super) mark: usize,
    /// How many times round the contour it lies farther on.
    pub(super) laps: i32,
    /// How far past it, mm along the track, in the direction of the contour.
    pub(super) over: f64,
}

/// The wire does not come to a place of the contour, or not between it and the one before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lost {
    /// Which mark of the contour.
    pub(super) mark: usize,
    /// Where it is on the contour.
    pub(super) at: Point,
}

impl Track {
    /// The track along an outline beside a contour, with marks given in mm along the contour, the first of them 0 and the
    /// last its length.
    pub(super) fn new(
        contour: &Path,
        outline: &Path,
        (side, by): (Side, f64),
        marks: &[f64],
    ) -> Result<Self, Lost> {
        let beside = |elements| Self { side, by, ..Self::along(elements) };
        let mut track = beside(outline.elements().to_vec());
        let begin = track.beside(contour, 0.0).map_err(|at| Lost { mark: 0, at })?;
        track = beside(track.between(begin, begin + track.length));
        let inner = marks.get(1..marks.len().saturating_sub(1)).unwrap_or_default();
        let mut places = vec![0.0];
        for (n, mark) in inner.iter().enumerate() {
            let lost = |at| Lost { mark: n + 1, at };
            let place = track.beside(contour, *mark).map_err(lost)?;
            if place <= places[n] + SNAP {
                return Err(lost(point_at(contour, *mark).0));
            }
            places.push(place);
        }
        places.push(track.length);
        // The marks become nodes, so that what ends beside one and what begins there share a point, bit for bit.
        let mut elements = Vec::with_capacity(track.elements.len() + places.len());
        let mut firsts = vec![0];
        for pair in places.windows(2) {
            elements.extend(track.between(pair[0], pair[1]));
            firsts.push(elements.len());
        }
        close(&mut elements);
        track = beside(elements);
        track.marks =
            firsts.into_iter().map(|n| track.begins.get(n).copied().unwrap_or(track.length)).collect();
        Ok(track)
    }

    fn along(elements: Vec<Element>) -> Self {
        let mut length = 0.0;
        let mut begins = Vec::with_capacity(elements.len());
        for element in &elements {
            begins.push(length);
            length += element.length();
        }
        Self { elements, begins, length, marks: Vec::new(), side: Side::Left, by: 0.0 }
    }

    /// How far along the track a position is, mm; it may be less than 0 or more than the track's length.
    pub(super) fn place(&self, position: Position) -> f64 {
        self.marks[position.mark] + f64::from(position.laps) * self.length + position.over
    }

    /// The point at a place, and the direction of the track behind it.
    pub(super) fn leaving(&self, place: f64) -> (Point, Vector) {
        let (n, fraction) = self.find(place);
        let at = self.elements[n].at(fraction);
        (at, heading(&self.elements[n], at))
    }

    /// The point at a place, and the direction of the track before it.
    pub(super) fn arriving(&self, place: f64) -> (Point, Vector) {
        let (n, fraction) = self.find(place);
        let at = self.elements[n].at(fraction);
        let at_node = place.rem_euclid(self.length) - self.begins[n] < SLIVER || fraction <= 0.0;
        let before = if at_node { (n + self.elements.len() - 1) % self.elements.len() } else { n };
        (at, heading(&self.elements[before], at))
    }

    /// The elements of the track.
    pub(super) fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// The elements from one place to another, forwards where `to` is the greater one, else backwards.
    pub(super) fn between(&self, from: f64, to: f64) -> Vec<Element> {
        if to < from {
            let mut back = self.between(to, from);
            back.reverse();
            return back.into_iter().map(Element::reversed).collect();
        }
        let mut ways = Vec::new();
        let laps = (from / self.length).floor();
        let (from, to) = (from - laps * self.length, to - laps * self.length);
        let mut lap = 0.0;
        while lap < to {
            for (element, begin) in self.elements.iter().zip(&self.begins) {
                let (begin, length) = (lap + begin, element.length());
                let (low, high) = (from.max(begin), to.min(begin + length));
                if high - low > SLIVER {
                    ways.push(part(element, low - begin, high - begin, length));
                }
            }
            lap += self.length;
        }
        ways
    }

    /// The element at a place and how much of it lies before.
    fn find(&self, place: f64) -> (usize, f64) {
        let place = place.rem_euclid(self.length);
        let place = if place > self.length - SLIVER { 0.0 } else { place };
        let n = self.begins.partition_point(|begin| *begin <= place + SLIVER).saturating_sub(1);
        let length = self.elements[n].length();
        (n, if length > 0.0 { (place - self.begins[n]) / length } else { 0.0 })
    }

    /// The place beside a point of the contour given in mm along it; that point where the wire does not come to it.
    fn beside(&self, contour: &Path, along: f64) -> Result<f64, Point> {
        let (at, heading) = point_at(contour, along);
        let left = if self.side == Side::Left { self.by } else { -self.by };
        let wire = at + Vector::new(-heading.y, heading.x) * left;
        let distances = |to: Point| self.elements.iter().map(move |element| element.distance(to)).enumerate();
        let nearest = distances(wire).min_by(|a, b| a.1.total_cmp(&b.1));
        let (n, near) = match nearest {
            Some((n, distance)) if distance <= BESIDE => (n, wire),
            _ => {
                let mut others: Vec<(usize, f64)> = distances(at).collect();
                others.sort_by(|a, b| a.1.total_cmp(&b.1));
                let seen = |n: &usize| sees(contour, self.side, at, self.elements[*n].nearest(at));
                (others.into_iter().map(|(n, _)| n).find(seen).ok_or(at)?, at)
            }
        };
        let length = self.elements[n].length();
        let mut within = fraction(&self.elements[n], near) * length;
        // What all but falls on a node is the node.
        if within < SNAP {
            within = 0.0;
        } else if within > length - SNAP {
            within = length;
        }
        let place = self.begins[n] + within;
        Ok(if place > self.length - SNAP { 0.0 } else { place })
    }
}

/// Whether nothing of a contour stands between one of its points and a point of the path on a side of it.
fn sees(contour: &Path, side: Side, from: Point, to: Point) -> bool {
    let way = to - from;
    let length = way.norm();
    if length <= 2.0 * SIGHT {
        return true;
    }
    let line = Element::Line { start: from + way * (SIGHT / length), end: to };
    let waste_inside = (contour.area() > 0.0) == (side == Side::Left);
    contour.contains(line.at(0.5)) == waste_inside
        && nearest_within(&line, contour.elements(), CLEAR).is_none()
}

/// The point at a length along a closed contour and the direction of the contour behind it.
pub(super) fn point_at(contour: &Path, along: f64) -> (Point, Vector) {
    let whole = Track::along(contour.elements().to_vec());
    // A rounding short of a node is the node: the direction behind it counts.
    let next = whole.begins.iter().copied().find(|begin| (begin - along).abs() < SNAP);
    let along = if (along - whole.length).abs() < SNAP { 0.0 } else { next.unwrap_or(along) };
    whole.leaving(along)
}

/// A closed contour begun at the point of it that is nearest to another.
pub(super) fn begun_nearest(contour: &Path, to: Point) -> Path {
    let whole = Track::along(contour.elements().to_vec());
    let mut best = (0, f64::INFINITY);
    for (n, element) in contour.elements().iter().enumerate() {
        let distance = element.distance(to);
        if distance < best.1 {
            best = (n, distance);
        }
    }
    let element = &contour.elements()[best.0];
    let within = fraction(element, to) * element.length();
    if within < SNAP {
        return contour.clone().begun_at(best.0);
    }
    if within > element.length() - SNAP {
        return contour.clone().begun_at(best.0 + 1);
    }
    let from = whole.begins[best.0] + within;
    let mut elements = whole.between(from, from + whole.length);
    close(&mut elements);
    Path::new(elements).unwrap_or_else(|| contour.clone())
}

/// The direction in which an element runs at one of its points.
pub(super) fn heading(element: &Element, at: Point) -> Vector {
    match *element {
        Element::Line { .. } => element.heading_at_start(),
        Element::Arc { centre, sense, .. } => {
            Element::Arc { start: at, end: at, centre, sense }.heading_at_start()
        }
    }
}

/// Ends elements that come round on the very point at which they begin.
fn close(elements: &mut [Element]) {
    if let (Some(first), Some(last)) = (elements.first().map(Element::start), elements.last_mut()) {
        match last {
            Element::Line { end, .. } | Element::Arc { end, .. } => *end = first,
        }
    }
}

/// The part of an element between two places on it, mm from its start.
fn part(element: &Element, from: f64, to: f64, length: f64) -> Element {
    let start = if from <= SLIVER { element.start() } else { element.at(from / length) };
    let end = if to >= length - SLIVER { element.end() } else { element.at(to / length) };
    match *element {
        Element::Line { .. } => Element::Line { start, end },
        Element::Arc { centre, sense, .. } => Element::Arc { start, end, centre, sense },
    }
}

/// How much of an element lies before its point nearest to another.
fn fraction(element: &Element, to: Point) -> f64 {
    match *element {
        Element::Line { start, end } => {
            let way = end - start;
            let length2 = way.norm_squared();
            if length2 > 0.0 { ((to - start).dot(&way) / length2).clamp(0.0, 1.0) } else { 0.0 }
        }
        Element::Arc { start, end, centre, sense } => {
            let (turn, whole) = (turned(start - centre, to - centre, sense), element.sweep());
            if turn <= whole {
                turn / whole
            } else if (to - start).norm_squared() <= (to - end).norm_squared() {
                0.0
            } else {
                1.0
            }
        }
    }
}

/// The angle from one direction to another, radians in [0, 2π).
fn turned(from: Vector, to: Vector, sense: Sense) -> f64 {
    let turn = sweep(from, to, sense);
    if turn >= std::f64::consts::TAU - 1e-12 { 0.0 } else { turn }
}

/// Places nearer than this are one, mm: a tenth of a micron, which no node shows.
pub(super) const SNAP: f64 = 1e-4;
/// A line of sight begins so far from the point of the contour it is for, mm: at a tenth of a micron it would still touch the
/// wall it leaves where that is flat, ten millimetres long for a tenth of a millimetre across.
const SIGHT: f64 = 0.01;
/// A line of sight so near to the contour touches it, mm: a nanometre.
const CLEAR: f64 = 1e-6;
/// Shorter parts of an element are left out, mm: what reckoning along a track may be out by.
const SLIVER: f64 = 1e-7;
/// A point so near to the path is on it, mm: the offset's own nodes are good to a hundredth of a micron.
const BESIDE: f64 = 5e-4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::offset::{Corners, offset};

    fn square() -> Path {
        let p = Point::new;
        let nodes = [p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)];
        let line = |n: usize| Element::Line { start: nodes[n], end: nodes[(n + 1) % 4] };
        Path::new((0..4).map(line).collect()).unwrap()
    }

    fn beside(left: f64) -> (Side, f64) {
        (if left > 0.0 { Side::Left } else { Side::Right }, left.abs())
    }

    fn track(contour: &Path, left: f64, marks: &[f64]) -> Track {
        let found = offset(contour, left, Corners::Round).unwrap();
        Track::new(contour, &found.outlines[0].path, beside(left), marks).unwrap()
    }

    #[test]
    fn a_track_begins_in_the_inside_corner_or_square_beside_the_outside_one() {
        let inside = track(&square(), 1.0, &[0.0, 40.0]);
        assert!((inside.leaving(0.0).0 - Point::new(1.0, 1.0)).norm() < 1e-9);
        let outside = track(&square(), -1.0, &[0.0, 40.0]);
        assert!((outside.leaving(0.0).0 - Point::new(0.0, -1.0)).norm() < 1e-9);
    }

    #[test]
    fn marks_stand_square_beside_the_contour() {
        let inside = track(&square(), 1.0, &[0.0, 5.0, 12.0, 40.0]);
        let at = |mark| inside.leaving(inside.place(Position { mark, laps: 0, over: 0.0 })).0;
        assert!((at(1) - Point::new(5.0, 1.0)).norm() < 1e-9);
        assert!((at(2) - Point::new(9.0, 2.0)).norm() < 1e-9);
        assert!((at(3) - at(0)).norm() < 1e-9);
    }

    #[test]
    fn places_the_wire_cannot_tell_apart_are_refused() {
        let contour = square();
        let found = offset(&contour, 1.0, Corners::Round).unwrap();
        // Both lie within the corner that the wire does not enter.
        let error =
            Track::new(&contour, &found.outlines[0].path, beside(1.0), &[0.0, 9.5, 10.0, 40.0]).unwrap_err();
        assert_eq!((error.mark, error.at), (2, Point::new(10.0, 0.0)));
    }

    #[test]
    fn a_place_in_a_slot_is_not_taken_for_one_behind_its_wall() {
        // A slot 0.4 mm wide and 6 mm deep, and a wall of 0.2 mm between it and the outside.
        let p = Point::new;
        let nodes = [
            p(0.0, 0.0),
            p(10.0, 0.0),
            p(10.0, 8.0),
            p(9.8, 8.0),
            p(9.8, 2.0),
            p(9.4, 2.0),
            p(9.4, 8.0),
            p(0.0, 8.0),
        ];
        let line = |n: usize| Element::Line { start: nodes[n], end: nodes[(n + 1) % nodes.len()] };
        let contour = Path::new((0..nodes.len()).map(line).collect()).unwrap();
        let found = offset(&contour, -0.5, Corners::Round).unwrap();
        // 3 mm down the slot: the nearest path runs behind the wall, the one that is seen lies before the mouth.
        let mark = 10.0 + 8.0 + 0.2 + 3.0;
        let track =
            Track::new(&contour, &found.outlines[0].path, beside(-0.5), &[0.0, mark, contour.length()])
                .unwrap();
        let (at, _) = track.leaving(track.place(Position { mark: 1, laps: 0, over: 0.0 }));
        assert!(at.y > 8.0 && at.x < 9.8, "{at}");
    }

    #[test]
    fn far_down_a_passage_too_narrow_for_the_wire_all_places_are_its_mouth() {
        // A room, and from it a passage 0.2 mm wide and 12 mm long.
        let p = Point::new;
        let nodes = [
            p(0.0, 0.0),
            p(10.0, 0.0),
            p(10.0, 4.0),
            p(22.0, 4.0),
            p(22.0, 4.2),
            p(10.0, 4.2),
            p(10.0, 8.0),
            p(0.0, 8.0),
        ];
        let line = |n: usize| Element::Line { start: nodes[n], end: nodes[(n + 1) % nodes.len()] };
        let contour = Path::new((0..nodes.len()).map(line).collect()).unwrap();
        let found = offset(&contour, 0.2, Corners::Round).unwrap();
        // 3 and 10 mm down, on the same wall.
        let marks = [0.0, 17.0, 24.0, contour.length()];
        let error = Track::new(&contour, &found.outlines[0].path, beside(0.2), &marks).unwrap_err();
        assert_eq!((error.mark, error.at), (2, p(20.0, 4.0)));
    }

    #[test]
    fn a_stretch_over_the_closing_point_is_as_long_as_asked_and_runs_back_the_same_way() {
        let track = track(&square(), -0.5, &[0.0, 40.0]);
        let ways = track.between(3.0, track.length + 4.5);
        let length: f64 = ways.iter().map(Element::length).sum();
        assert!((length - track.length - 1.5).abs() < 1e-9);
        assert!(Path::new(ways.clone()).is_some());
        let back = track.between(track.length + 4.5, 3.0);
        assert_eq!(back.len(), ways.len());
        assert_eq!(back[0].start(), ways[ways.len() - 1].end());
    }

    #[test]
    fn a_contour_can_begin_anywhere() {
        let circle = Path::circle(Point::new(1.0, 2.0), 3.0, Sense::Clockwise);
        let begun = begun_nearest(&circle, Point::new(1.0, 9.0));
        assert!(begun.is_closed());
        assert!((begun.start() - Point::new(1.0, 5.0)).norm() < 1e-9);
        assert!((begun.area() - circle.area()).abs() < 1e-9);
        let corner = begun_nearest(&square(), Point::new(12.0, 12.0));
        assert_eq!((corner.start(), corner.elements().len()), (Point::new(10.0, 10.0), 4));
        let side = begun_nearest(&square(), Point::new(4.0, 12.0));
        assert_eq!((side.start(), side.elements().len()), (Point::new(4.0, 10.0), 5));
    }
}
