//! A path: elements that follow one another, each beginning on the very point where the last one ended.
//!
//! The one shape in which a contour is held whole: drawings give paths, offsets take and give them. What streams
//! through is elements one at a time.

use std::f64::consts::{PI, TAU};

use super::measure::turn;
use super::{Element, Point, Sense};

/// Elements that follow one another without a gap; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    elements: Vec<Element>,
}

impl Path {
    /// A path of elements; none when there is no element or one does not begin where the last one ended.
    #[must_use]
    pub fn new(elements: Vec<Element>) -> Option<Self> {
        let joined = elements.windows(2).all(|pair| pair[0].end() == pair[1].start());
        (joined && !elements.is_empty()).then_some(Self { elements })
    }

    /// A full circle from its rightmost point.
    #[must_use]
    pub fn circle(centre: Point, radius: f64, sense: Sense) -> Self {
        let start = Point::new(centre.x + radius, centre.y);
        Self { elements: vec![Element::Arc { start, end: start, centre, sense }] }
    }

    /// The elements, in order.
    #[must_use]
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Where it begins.
    #[must_use]
    pub fn start(&self) -> Point {
        self.elements[0].start()
    }

    /// Where it ends.
    #[must_use]
    pub fn end(&self) -> Point {
        self.elements[self.elements.len() - 1].end()
    }

    /// Whether it ends on the very point where it began.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.start() == self.end()
    }

    /// The length of the way, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.elements.iter().map(Element::length).sum()
    }

    /// The area inside a closed path, mm²; positive when it is run counter-clockwise.
    #[must_use]
    pub fn area(&self) -> f64 {
        // Seen from its own start, so that a part far from the origin loses no digits.
        let by = -self.start().coords;
        self.elements.iter().map(|e| e.moved(by).doubled_area()).sum::<f64>() / 2.0
    }

    /// The sense in which a closed path is run.
    #[must_use]
    pub fn sense(&self) -> Sense {
        if self.area() < 0.0 { Sense::Clockwise } else { Sense::CounterClockwise }
    }

    /// The smallest upright rectangle that holds the path: its lower left and upper right corner.
    #[must_use]
    pub fn extent(&self) -> [Point; 2] {
        let first = self.elements[0].extent();
        self.elements[1..].iter().map(Element::extent).fold(first, |[min, max], [low, high]| {
            [Point::new(min.x.min(low.x), min.y.min(low.y)), Point::new(max.x.max(high.x), max.y.max(high.y))]
        })
    }

    /// The same way run backwards.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { elements: self.elements.iter().rev().map(|e| e.reversed()).collect() }
    }

    /// A closed path begun with its `n`-th element; an open one stays as it is.
    #[must_use]
    pub fn begun_at(mut self, n: usize) -> Self {
        if self.is_closed() {
            let count = self.elements.len();
            self.elements.rotate_left(n % count);
        }
        self
    }

    /// The distance of a point from the way, mm.
    #[must_use]
    pub fn distance(&self, point: Point) -> f64 {
        self.elements.iter().map(|e| e.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// Whether a point lies inside a closed path: the path goes round it.
    #[must_use]
    pub fn contains(&self, point: Point) -> bool {
        self.elements.iter().map(|e| turn_seen_from(point, e)).sum::<f64>().abs() > PI
    }
}

/// The angle by which the direction from a point turns along an element, radians.
fn turn_seen_from(point: Point, element: &Element) -> f64 {
    let (start, end) = (element.start(), element.end());
    let chord = turn(start - point, end - point);
    let Element::Arc { centre, sense, .. } = *element else { return chord };
    // An arc and its chord enclose a segment of the circle, to the right of the chord when it is run counter-clockwise.
    // A point in it is gone round once more than the chord alone goes.
    let way = end - start;
    let left_of_chord = way.x * (point.y - start.y) - way.y * (point.x - start.x) > 0.0;
    let on_arcs_side = start == end || left_of_chord == (sense == Sense::Clockwise);
    let in_circle = (point - centre).norm_squared() < (start - centre).norm_squared();
    match sense {
        _ if !(on_arcs_side && in_circle) => chord,
        Sense::CounterClockwise => chord + TAU,
        Sense::Clockwise => chord - TAU,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with a round bay in its right side and a round nose on its left, counter-clockwise.
    fn key() -> Path {
        let p = Point::new;
        let line = |start, end| Element::Line { start, end };
        let arc = |start, end, centre, sense| Element::Arc { start, end, centre, sense };
        Path::new(vec![
            line(p(0.0, 0.0), p(10.0, 0.0)),
            line(p(10.0, 0.0), p(10.0, 3.0)),
            arc(p(10.0, 3.0), p(10.0, 7.0), p(10.0, 5.0), Sense::Clockwise),
            line(p(10.0, 7.0), p(10.0, 10.0)),
            line(p(10.0, 10.0), p(0.0, 10.0)),
            line(p(0.0, 10.0), p(0.0, 7.0)),
            arc(p(0.0, 7.0), p(0.0, 3.0), p(-1.5, 5.0), Sense::CounterClockwise),
            line(p(0.0, 3.0), p(0.0, 0.0)),
        ])
        .unwrap()
    }

    #[test]
    fn a_path_without_a_gap_is_one_and_any_other_is_not() {
        let p = Point::new;
        let gap = vec![
            Element::Line { start: p(0.0, 0.0), end: p(1.0, 0.0) },
            Element::Line { start: p(1.0, 1e-12), end: p(2.0, 0.0) },
        ];
        assert_eq!(Path::new(gap), None);
        assert_eq!(Path::new(Vec::new()), None);
        assert!(key().is_closed());
    }

    #[test]
    fn area_and_extent_follow_the_arcs() {
        // The nose has radius 2.5, reaches to x = -4 and leaves out the segment beyond x = 0.
        let nose = 2.5 * 2.5 * (PI - libm::atan2(2.0, 1.5)) + 1.5 * 2.0;
        let area = 100.0 - 2.0 * PI + nose;
        assert!((key().area() - area).abs() < 1e-9, "{} {area}", key().area());
        assert!((key().reversed().area() + area).abs() < 1e-9);
        assert!((key().extent()[0] - Point::new(-4.0, 0.0)).norm() < 1e-12);
        assert!((key().begun_at(3).area() - area).abs() < 1e-9);
    }

    #[test]
    fn a_point_is_inside_or_it_is_not() {
        let inside = [(5.0, 5.0), (7.9, 5.0), (-3.9, 5.0), (-1.0, 5.0), (9.9, 1.0), (-1.5, 7.3), (-0.1, 5.0)];
        let outside =
            [(8.1, 5.0), (10.5, 5.0), (-4.1, 5.0), (-0.5, 1.0), (-0.1, 7.3), (11.0, 11.0), (-3.5, 7.0)];
        for path in [key(), key().reversed(), key().begun_at(6)] {
            for (x, y) in inside {
                assert!(path.contains(Point::new(x, y)), "{x} {y}");
            }
            for (x, y) in outside {
                assert!(!path.contains(Point::new(x, y)), "{x} {y}");
            }
        }
        let circle = Path::circle(Point::new(1.0, 1.0), 2.0, Sense::Clockwise);
        assert!(circle.contains(Point::new(2.9, 1.0)) && !circle.contains(Point::new(3.1, 1.0)));
    }
}
