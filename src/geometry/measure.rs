//! What can be measured of an element: length, direction, extent, distance, area.

use std::f64::consts::{PI, TAU};

use super::{Element, Point, Sense, Vector};

impl Element {
    /// The length of the way, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        match *self {
            Self::Line { start, end } => (end - start).norm(),
            Self::Arc { start, end, centre, .. } => {
                0.5 * ((start - centre).norm() + (end - centre).norm()) * self.sweep()
            }
        }
    }

    /// The point at a fraction of the way, 0 to 1. The ends are exact.
    ///
    /// Where the radii at both ends differ by a rounding, the radius goes evenly from one to the other.
    #[must_use]
    pub fn at(&self, fraction: f64) -> Point {
        if fraction <= 0.0 {
            return self.start();
        }
        if fraction >= 1.0 {
            return self.end();
        }
        match *self {
            Self::Line { start, end } => start + (end - start) * fraction,
            Self::Arc { start, end, centre, sense } => {
                let (from, to) = ((start - centre).norm(), (end - centre).norm());
                let (sin, cos) = libm::sincos(signed(self.sweep() * fraction, sense));
                let r: Vector = start - centre;
                let scale = if from > 0.0 { 1.0 + (to / from - 1.0) * fraction } else { 1.0 };
                centre + Vector::new(r.x * cos - r.y * sin, r.x * sin + r.y * cos) * scale
            }
        }
    }

    /// The point half way, by roots alone: [`Self::at`] a half to 1e-12 of the radius, and far sooner.
    #[must_use]
    pub fn middle(&self) -> Point {
        match *self {
            Self::Line { start, end } => start + (end - start) * 0.5,
            Self::Arc { start, end, centre, sense } => {
                let (first, last) = (start - centre, end - centre);
                let (a, b) = (unit(first), unit(last));
                let side = if sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
                // Between two near directions, or opposite to it; between far ones, square to the way between them.
                let way = match a.dot(&b) > 0.0 {
                    true if start != end && cross(a, b) * side > 0.0 => a + b,
                    true => -(a + b),
                    false => Vector::new(b.y - a.y, a.x - b.x) * side,
                };
                centre + unit(way) * (0.5 * (first.norm() + last.norm()))
            }
        }
    }

    /// The direction of motion at the start, of length 1; zero for an element without length.
    #[must_use]
    pub fn heading_at_start(&self) -> Vector {
        match *self {
            Self::Line { start, end } => unit(end - start),
            Self::Arc { start, centre, sense, .. } => tangent(start - centre, sense),
        }
    }

    /// The direction of motion at the end, of length 1; zero for an element without length.
    #[must_use]
    pub fn heading_at_end(&self) -> Vector {
        match *self {
            Self::Line { start, end } => unit(end - start),
            Self::Arc { end, centre, sense, .. } => tangent(end - centre, sense),
        }
    }

    /// The radius at the start of an arc, mm; none for a line.
    #[must_use]
    pub fn radius(&self) -> Option<f64> {
        match *self {
            Self::Line { .. } => None,
            Self::Arc { start, centre, .. } => Some((start - centre).norm()),
        }
    }

    /// The smallest upright rectangle that holds the way: its lower left and upper right corner.
    #[must_use]
    pub fn extent(&self) -> [Point; 2] {
        let (start, end) = (self.start(), self.end());
        let mut min = Point::new(start.x.min(end.x), start.y.min(end.y));
        let mut max = Point::new(start.x.max(end.x), start.y.max(end.y));
        if let Self::Arc { centre, sense, .. } = *self {
            let (first, last) = (start - centre, end - centre);
            let radius = first.norm();
            for axis in AXES {
                if start == end || passes(first, last, axis, sense) {
                    let p = centre + axis * radius;
                    min = Point::new(min.x.min(p.x), min.y.min(p.y));
                    max = Point::new(max.x.max(p.x), max.y.max(p.y));
                }
            }
        }
        [min, max]
    }

    /// The distance of a point from the way, mm.
    #[must_use]
    pub fn distance(&self, point: Point) -> f64 {
        (point - self.nearest(point)).norm()
    }

    /// The point of the way nearest to a point.
    #[must_use]
    pub fn nearest(&self, point: Point) -> Point {
        match *self {
            Self::Line { start, end } => {
                let way = end - start;
                let length2 = way.norm_squared();
                if length2 == 0.0 {
                    return start;
                }
                start + way * ((point - start).dot(&way) / length2).clamp(0.0, 1.0)
            }
            Self::Arc { start, end, centre, sense } => {
                let seen = point - centre;
                let distance = seen.norm();
                let turn = super::sweep(start - centre, seen, sense);
                let whole = self.sweep();
                // A point straight behind the start has turned a whole circle.
                let behind = turn >= TAU - 1e-12;
                if distance > 0.0 && (turn <= whole || behind) {
                    let fraction = if behind { 0.0 } else { turn / whole };
                    let (from, to) = ((start - centre).norm(), (end - centre).norm());
                    return centre + seen * ((from + (to - from) * fraction) / distance);
                }
                if (point - start).norm_squared() <= (point - end).norm_squared() { start } else { end }
            }
        }
    }

    /// Twice the area swept by the ray from the origin, counter-clockwise positive: its sum round a closed contour is
    /// twice the area inside, mm².
    #[must_use]
    pub fn doubled_area(&self) -> f64 {
        let (start, end) = (self.start(), self.end());
        let chord = start.x * end.y - end.x * start.y;
        match *self {
            Self::Line { .. } => chord,
            Self::Arc { centre, sense, .. } => {
                let radius = 0.5 * ((start - centre).norm() + (end - centre).norm());
                let turn = self.sweep();
                chord + signed(radius * radius * (turn - libm::sin(turn)), sense)
            }
        }
    }

    /// The same element moved.
    #[must_use]
    pub fn moved(self, by: Vector) -> Self {
        match self {
            Self::Line { start, end } => Self::Line { start: start + by, end: end + by },
            Self::Arc { start, end, centre, sense } => {
                Self::Arc { start: start + by, end: end + by, centre: centre + by, sense }
            }
        }
    }

    /// The same element turned counter-clockwise by an angle in radians, made larger by `scale`, then moved.
    #[must_use]
    pub fn placed(self, turn: f64, scale: f64, by: Vector) -> Self {
        let (sin, cos) = libm::sincos(turn);
        let place = |p: Point| Point::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos) * scale + by;
        match self {
            Self::Line { start, end } => Self::Line { start: place(start), end: place(end) },
            Self::Arc { start, end, centre, sense } => {
                Self::Arc { start: place(start), end: place(end), centre: place(centre), sense }
            }
        }
    }
}

/// The turn from one heading to another, radians in (−π, π], counter-clockwise positive.
#[must_use]
pub fn turn(from: Vector, to: Vector) -> f64 {
    let angle = libm::atan2(from.x * to.y - from.y * to.x, from.dot(&to));
    if angle <= -PI { PI } else { angle }
}

/// Whether an arc that is no whole circle passes through a direction between those of its ends.
fn passes(first: Vector, last: Vector, through: Vector, sense: Sense) -> bool {
    let (first, last) = match sense {
        Sense::CounterClockwise => (first, last),
        Sense::Clockwise => (last, first),
    };
    let is_between = |a: Vector, b: Vector| cross(a, through) > 0.0 && cross(through, b) > 0.0;
    let is_along = |a: Vector| cross(a, through) == 0.0 && a.dot(&through) > 0.0;
    let turned = cross(first, last);
    if turned > 0.0 {
        is_between(first, last)
    } else if turned == 0.0 && first.dot(&last) < 0.0 {
        cross(first, through) > 0.0
    } else {
        // What is left of the circle turns by less than a half.
        !(is_between(last, first) || is_along(first) || is_along(last))
    }
}

fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

fn signed(turn: f64, sense: Sense) -> f64 {
    match sense {
        Sense::CounterClockwise => turn,
        Sense::Clockwise => -turn,
    }
}

fn tangent(from_centre: Vector, sense: Sense) -> Vector {
    let left = unit(Vector::new(-from_centre.y, from_centre.x));
    match sense {
        Sense::CounterClockwise => left,
        Sense::Clockwise => -left,
    }
}

fn unit(way: Vector) -> Vector {
    let length = way.norm();
    if length > 0.0 { way / length } else { Vector::zeros() }
}

const AXES: [Vector; 4] =
    [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0), Vector::new(-1.0, 0.0), Vector::new(0.0, -1.0)];

#[cfg(test)]
mod tests {
    use super::*;

    fn three_quarters() -> Element {
        Element::Arc {
            start: Point::new(7.0, 1.0),
            end: Point::new(2.0, -4.0),
            centre: Point::new(2.0, 1.0),
            sense: Sense::CounterClockwise,
        }
    }

    #[test]
    fn an_arc_is_measured_along_its_own_way() {
        let arc = three_quarters();
        assert!((arc.length() - 7.5 * PI).abs() < 1e-12);
        assert!((arc.at(1.0 / 3.0) - Point::new(2.0, 6.0)).norm() < 1e-12);
        assert!((arc.heading_at_start() - Vector::new(0.0, 1.0)).norm() < 1e-15);
        assert!((arc.heading_at_end() - Vector::new(1.0, 0.0)).norm() < 1e-15);
        assert_eq!(arc.extent(), [Point::new(-3.0, -4.0), Point::new(7.0, 6.0)]);
        let back = arc.reversed();
        assert!((back.heading_at_start() + arc.heading_at_end()).norm() < 1e-15);
        assert!((back.length() - arc.length()).abs() < 1e-12);
    }

    #[test]
    fn the_nearest_point_of_an_arc_may_be_an_end() {
        let arc = three_quarters();
        assert!((arc.distance(Point::new(2.0, 9.0)) - 3.0).abs() < 1e-12);
        assert!((arc.distance(Point::new(9.0, 1.0)) - 2.0).abs() < 1e-12);
        // Below right of the centre, where the arc does not go.
        assert!((arc.distance(Point::new(6.5, -4.0)) - 4.5).abs() < 1e-12);
    }

    #[test]
    fn a_circle_of_four_arcs_has_the_area_of_a_circle() {
        let p = Point::new;
        let quarter = |a, b| Element::Arc { start: a, end: b, centre: p(3.0, 4.0), sense: Sense::Clockwise };
        let nodes = [p(3.0, 6.0), p(5.0, 4.0), p(3.0, 2.0), p(1.0, 4.0)];
        let area: f64 = (0..4).map(|n| quarter(nodes[n], nodes[(n + 1) % 4]).doubled_area()).sum();
        assert!((area / 2.0 + 4.0 * PI).abs() < 1e-12);
    }

    /// Arcs of every sweep, either way, from every direction.
    fn arcs() -> impl Iterator<Item = Element> {
        let centre = Point::new(2.0, -1.0);
        let at = move |degrees: i32| {
            let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
            centre + Vector::new(cos, sin) * 3.0
        };
        (0..360).step_by(7).flat_map(move |from| {
            (1..=360).flat_map(move |sweep| {
                let end = if sweep == 360 { at(from) } else { at(from + sweep) };
                [Sense::CounterClockwise, Sense::Clockwise].map(|sense| Element::Arc {
                    start: at(from),
                    end,
                    centre,
                    sense,
                })
            })
        })
    }

    #[test]
    fn the_middle_is_the_point_at_a_half() {
        for arc in arcs() {
            assert!((arc.middle() - arc.at(0.5)).norm() < 1e-12, "{arc:?}");
        }
        let line = Element::Line { start: Point::new(1.0, 2.0), end: Point::new(4.0, -2.0) };
        assert_eq!(line.middle(), line.at(0.5));
    }

    #[test]
    fn an_arc_of_any_sweep_has_the_extent_of_its_points() {
        for arc in arcs() {
            let [mut min, mut max] = [arc.start(), arc.start()];
            for n in 0..=720 {
                let p = arc.at(f64::from(n) / 720.0);
                min = Point::new(min.x.min(p.x), min.y.min(p.y));
                max = Point::new(max.x.max(p.x), max.y.max(p.y));
            }
            let [low, high] = arc.extent();
            // Points half a degree apart miss the outermost by less than this.
            assert!((low - min).norm() < 5e-5 && (high - max).norm() < 5e-5, "{arc:?}");
        }
    }

    #[test]
    fn a_turn_right_back_is_half_a_circle() {
        let e = Vector::new(1.0, 0.0);
        assert!((turn(e, -e) - PI).abs() < 1e-15);
        assert!((turn(e, Vector::new(0.0, -1.0)) + PI / 2.0).abs() < 1e-15);
    }
}
