//! A corner of the outline with the wire beside it: the neighbours shifted, and what joins or cuts them.
//!
//! On the outside of a corner the wire goes round it on an arc of the offset's radius; on the inside the shifted
//! neighbours are cut off where they cross. That controls join by an arc and not by lengthened lines is a reading of
//! this mock, unverified.

use std::f64::consts::TAU;

use super::{Element, Point, Shape, Turn, are_tangent, shifted_node, swept};

/// What stands between two shifted neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Corner {
    /// One point: they are tangent there, or cross there.
    At(Point),
    /// An arc about the corner, from the end of the one to the start of the other.
    Around { from: Point, to: Point, turn: Turn },
    /// They do not meet: the wire is too thick for the place.
    Blocked,
}

/// The element as the wire beside it runs, `right` of it by so much; `None`: an arc's radius vanishes.
pub(crate) fn shifted(element: &Element, right: f64) -> Option<Element> {
    if let Shape::Arc { turn, .. } = element.shape
        && element.size() + turn.sign() * right <= 0.0
    {
        return None;
    }
    let from = element.from.plus(element.starts_towards().right().times(right));
    let to = element.to.plus(element.ends_towards().right().times(right));
    Some(Element { from, to, shape: element.shape })
}

/// The corner between two elements of the outline. `starts` is where the wire begins the first of them.
pub(crate) fn corner(before: &Element, after: &Element, right: f64, starts: Point) -> Corner {
    if are_tangent(before, after) {
        return shifted_node(Some(before), Some(after), right).map_or(Corner::Blocked, Corner::At);
    }
    let (Some(ending), Some(starting)) = (shifted(before, right), shifted(after, right)) else {
        return Corner::Blocked;
    };
    let (ends, begins) = (before.ends_towards(), after.starts_towards());
    // Left positive. Straight back, the curves tell which way it is; two lines tell nothing, and the wire goes round.
    let straight_back = ends.cross(begins).abs() < STRAIGHT_BACK && ends.dot(begins) < 0.0;
    let turned = match straight_back {
        true => -(curvature(before) + curvature(after)),
        false => ends.cross(begins),
    };
    if turned * right > 0.0 || turned == 0.0 {
        let turn = if right > 0.0 { Turn::CounterClockwise } else { Turn::Clockwise };
        return Corner::Around { from: ending.to, to: starting.from, turn };
    }
    let ending = Element { from: starts, ..ending };
    crossings(&ending, &starting)
        .into_iter()
        .flatten()
        .filter(|&point| is_on(&ending, point) && is_on(&starting, point))
        .min_by(|a, b| a.minus(before.to).length().total_cmp(&b.minus(before.to).length()))
        .map_or(Corner::Blocked, Corner::At)
}

/// Where two elements, taken as whole lines and circles, cross.
fn crossings(a: &Element, b: &Element) -> [Option<Point>; 2] {
    match (a.shape, b.shape) {
        (Shape::Line, Shape::Line) => {
            let (along, other) = (a.starts_towards(), b.starts_towards());
            let across = along.cross(other);
            let distance = b.from.minus(a.from).cross(other) / across;
            [distance.is_finite().then(|| a.from.plus(along.times(distance))), None]
        }
        (Shape::Line, Shape::Arc { centre, .. }) => line_and_circle(a, centre, radius(b, centre)),
        (Shape::Arc { centre, .. }, Shape::Line) => line_and_circle(b, centre, radius(a, centre)),
        (Shape::Arc { centre, .. }, Shape::Arc { centre: other, .. }) => {
            let between = other.minus(centre);
            let distance = between.length();
            let (r, s) = (radius(a, centre), radius(b, other));
            // From the first centre towards the other to the common chord.
            let along = (distance * distance + r * r - s * s) / (2.0 * distance);
            let half = (r * r - along * along).sqrt();
            let foot = centre.plus(between.unit().times(along));
            pair(foot, between.unit().right(), half)
        }
    }
}

fn line_and_circle(line: &Element, centre: Point, radius: f64) -> [Option<Point>; 2] {
    let along = line.starts_towards();
    let foot = line.from.plus(along.times(centre.minus(line.from).dot(along)));
    let away = foot.minus(centre).length();
    pair(foot, along, (radius * radius - away * away).sqrt())
}

/// The two points at `half` on either side of a foot; none where it is no number.
fn pair(foot: Point, along: Point, half: f64) -> [Option<Point>; 2] {
    let point = |half: f64| half.is_finite().then(|| foot.plus(along.times(half)));
    [point(half), point(-half)]
}

/// The radius of a shifted arc: its ends have been shifted, its centre not.
fn radius(arc: &Element, centre: Point) -> f64 {
    arc.to.minus(centre).length()
}

/// To the left positive, 1/µm.
fn curvature(element: &Element) -> f64 {
    match element.shape {
        Shape::Line => 0.0,
        Shape::Arc { turn, .. } => turn.sign() / element.size(),
    }
}

/// Whether a point of the whole line or circle lies between the element's ends.
fn is_on(element: &Element, point: Point) -> bool {
    match element.shape {
        Shape::Line => {
            let (along, length) = (element.starts_towards(), element.size());
            let reached = point.minus(element.from).dot(along);
            (-SLACK_UM..=length + SLACK_UM).contains(&reached)
        }
        Shape::Arc { centre, turn, sweep } => {
            let slack = SLACK_UM / radius(element, centre);
            let all = swept(centre, turn, element.from, element.to, sweep);
            let reached = swept(centre, turn, element.from, point, 0.0).rem_euclid(TAU);
            reached <= all + slack || reached >= TAU - slack
        }
    }
}

/// The rounding of the ends.
const SLACK_UM: f64 = 1.0;

/// The sine below which two directions are opposite.
const STRAIGHT_BACK: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    fn line(from: (f64, f64), to: (f64, f64)) -> Element {
        Element { from: point(from.0, from.1), to: point(to.0, to.1), shape: Shape::Line }
    }

    #[test]
    fn a_right_angle_is_gone_round_outside_and_cut_off_inside() {
        let (along, up) = (line((0.0, 0.0), (5000.0, 0.0)), line((5000.0, 0.0), (5000.0, 4000.0)));
        let outside = corner(&along, &up, 100.0, point(0.0, -100.0));
        let around = Corner::Around {
            from: point(5000.0, -100.0),
            to: point(5100.0, 0.0),
            turn: Turn::CounterClockwise,
        };
        assert_eq!(outside, around);
        assert_eq!(corner(&along, &up, -100.0, point(0.0, 100.0)), Corner::At(point(4900.0, 100.0)));
        // A line shorter than the offset leaves no room.
        assert_eq!(corner(&along, &up, -6000.0, point(0.0, 6000.0)), Corner::Blocked);
    }

    #[test]
    fn a_line_and_an_arc_and_two_arcs_are_cut_off_where_they_cross() {
        let circle = |from: (f64, f64), to: (f64, f64), centre: (f64, f64), turn, sweep| Element {
            from: point(from.0, from.1),
            to: point(to.0, to.1),
            shape: Shape::Arc { centre: point(centre.0, centre.1), turn, sweep },
        };
        // Level into the left end of a half circle that bulges downwards, and from that into the next.
        let level = line((0.0, 0.0), (1000.0, 0.0));
        let bulge =
            circle((1000.0, 0.0), (3000.0, 0.0), (2000.0, 0.0), Turn::CounterClockwise, std::f64::consts::PI);
        let Corner::At(cross) = corner(&level, &bulge, 100.0, point(0.0, -100.0)) else {
            panic!("a right turn with the wire on the right is an inside corner");
        };
        assert!((cross.y + 100.0).abs() < 1e-9);
        assert!((cross.minus(point(2000.0, 0.0)).length() - 1100.0).abs() < 1e-9 && cross.x < 1000.0);
        let next =
            circle((3000.0, 0.0), (5000.0, 0.0), (4000.0, 0.0), Turn::CounterClockwise, std::f64::consts::PI);
        let Corner::At(cross) = corner(&bulge, &next, 100.0, point(900.0, 0.0)) else {
            panic!("between two bulges the wire cuts the cusp");
        };
        assert!((cross.x - 3000.0).abs() < 1e-9);
        assert!((cross.minus(point(2000.0, 0.0)).length() - 1100.0).abs() < 1e-9 && cross.y < 0.0);
    }

    #[test]
    fn an_arc_that_vanishes_is_none() {
        let arc = Element {
            from: point(100.0, 0.0),
            to: point(0.0, 100.0),
            shape: Shape::Arc { centre: point(0.0, 0.0), turn: Turn::CounterClockwise, sweep: TAU / 4.0 },
        };
        assert!(shifted(&arc, -100.0).is_none());
        assert_eq!(shifted(&arc, -99.0).map(|arc| arc.from), Some(point(1.0, 0.0)));
    }
}
