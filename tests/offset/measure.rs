//! Distances and samples, worked out without the program's own.

use dripfeed::geometry::{Element, Path, Point, Sense};

/// The distance of a point from a way, by the formula for a segment and for an arc.
pub(crate) fn distance(path: &Path, point: Point) -> f64 {
    distance_from(path.elements(), point)
}

/// The distance of a point from any of some elements.
pub(crate) fn distance_from(elements: &[Element], point: Point) -> f64 {
    elements.iter().map(|element| distance_from_element(element, point)).fold(f64::INFINITY, f64::min)
}

fn distance_from_element(element: &Element, point: Point) -> f64 {
    let ends = (point - element.start()).norm().min((point - element.end()).norm());
    match *element {
        Element::Line { start, end } => {
            let way = end - start;
            let t = (point - start).dot(&way) / way.dot(&way);
            if (0.0..=1.0).contains(&t) { (start + way * t - point).norm() } else { ends }
        }
        Element::Arc { start, end, centre, sense } => {
            // Counter-clockwise from one end to the other.
            let (from, to) = if sense == Sense::CounterClockwise { (start, end) } else { (end, start) };
            let angle = |p: Point| libm::atan2(p.y - centre.y, p.x - centre.x);
            let turn = |p: Point| (angle(p) - angle(from)).rem_euclid(std::f64::consts::TAU);
            let whole = if from == to { std::f64::consts::TAU } else { turn(to) };
            if turn(point) <= whole {
                ((point - centre).norm() - (start - centre).norm()).abs()
            } else {
                ends
            }
        }
    }
}

/// Points along an element and the unit vectors to its left there; `count` steps, ends left out.
pub(crate) fn samples(element: &Element, count: usize) -> Vec<(Point, Point)> {
    (0..count)
        .map(|n| {
            let t = (n as f64 + 0.5) / count as f64;
            match *element {
                Element::Line { start, end } => {
                    let way = (end - start) / (end - start).norm();
                    (start + (end - start) * t, Point::new(-way.y, way.x))
                }
                Element::Arc { start, end, centre, sense } => {
                    let angle = |p: Point| libm::atan2(p.y - centre.y, p.x - centre.x);
                    let tau = std::f64::consts::TAU;
                    let turn = (angle(end) - angle(start)).rem_euclid(tau);
                    let turn = match sense {
                        Sense::CounterClockwise if start == end => tau,
                        Sense::Clockwise if start == end => -tau,
                        Sense::CounterClockwise => turn,
                        Sense::Clockwise => turn - tau,
                    };
                    let here = angle(start) + turn * t;
                    let (sin, cos) = (libm::sin(here), libm::cos(here));
                    // Where nodes are rounded the two ends of an arc are not equally far from its centre.
                    let [from, to] = [start, end].map(|p| (p - centre).norm());
                    let radius = from + (to - from) * t;
                    let inwards = if sense == Sense::CounterClockwise { -1.0 } else { 1.0 };
                    (
                        Point::new(centre.x + radius * cos, centre.y + radius * sin),
                        Point::new(inwards * cos, inwards * sin),
                    )
                }
            }
        })
        .collect()
}

/// The inside of a closed contour, its arcs drawn as many short lines.
pub(crate) struct Inside(Vec<Point>);

impl Inside {
    pub(crate) fn of(path: &Path) -> Self {
        let mut nodes = Vec::new();
        for element in path.elements() {
            nodes.push(element.start());
            if matches!(element, Element::Arc { .. }) {
                nodes.extend(samples(element, 60).iter().map(|(p, _)| *p));
            }
        }
        Self(nodes)
    }

    /// A ray to the right meets the lines an odd number of times.
    pub(crate) fn has(&self, point: Point) -> bool {
        let mut inside = false;
        for n in 0..self.0.len() {
            let (a, b) = (self.0[n], self.0[(n + 1) % self.0.len()]);
            if (a.y > point.y) != (b.y > point.y)
                && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
            {
                inside = !inside;
            }
        }
        inside
    }
}
