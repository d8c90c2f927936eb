//! The ways in and out between a start hole and the wire's path.

use super::Lead;
use crate::geometry::{Element, Point, Sense, Vector};
use crate::units::Micrometres;

/// How the wire stands at a point of its path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    /// Where, mm.
    pub(super) at: Point,
    /// In which direction it runs there, of length 1.
    pub(super) heading: Vector,
    /// The direction straight away from the contour, of length 1.
    pub(super) away: Vector,
    /// Whether the waste is to the left of the heading.
    pub(super) waste_left: bool,
}

/// A way between a place in the waste and the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    /// Its end in the waste, mm.
    pub(super) outer: Point,
    /// Where it goes; none when it has no length.
    pub(super) element: Option<Element>,
}

/// The way in to where the wire stands; none for a direct one without a hole.
pub(super) fn inwards(lead: Lead, stand: &Stand, hole: Option<Point>) -> Option<Way> {
    let mirrored = Stand { heading: -stand.heading, waste_left: !stand.waste_left, ..*stand };
    let way = outwards(lead, &mirrored, hole)?;
    Some(Way { element: way.element.map(Element::reversed), ..way })
}

/// The way out from where the wire stands; none for a direct one without a hole.
pub(super) fn outwards(lead: Lead, stand: &Stand, hole: Option<Point>) -> Option<Way> {
    let straight = |outer: Point| {
        let element = (outer != stand.at).then_some(Element::Line { start: stand.at, end: outer });
        Way { outer, element }
    };
    match lead {
        Lead::Direct => hole.map(straight),
        Lead::Straight { length } => Some(straight(stand.at + stand.away * length)),
        Lead::Arc { radius, sweep } => {
            let left = Vector::new(-stand.heading.y, stand.heading.x);
            let (towards, sense) =
                if stand.waste_left { (left, Sense::CounterClockwise) } else { (-left, Sense::Clockwise) };
            let centre = stand.at + towards * radius;
            let (sin, cos) = libm::sincos(sweep.to_radians());
            // Seen from the centre, the arc turns away from −towards along the heading.
            let outer = centre - towards * (radius * cos) + stand.heading * (radius * sin);
            Some(Way { outer, element: Some(Element::Arc { start: stand.at, end: outer, centre, sense }) })
        }
    }
}

/// The nearest point on whole microns.
pub(super) fn on_grid(point: Point) -> Point {
    Point::new(Micrometres::nearest(point.x).millimetres(), Micrometres::nearest(point.y).millimetres())
}

/// An element with its ends on whole microns, begun where the last one ended; none where nothing is left of it.
pub(super) fn rounded(element: &Element, start: Point) -> Option<Element> {
    let end = on_grid(element.end());
    match *element {
        Element::Line { .. } => (start != end).then_some(Element::Line { start, end }),
        Element::Arc { centre, sense, .. } => {
            let (sweep, arc) = (element.sweep(), Element::Arc { start, end, centre, sense });
            // An arc shrunk to nothing must not become a full circle, nor a full circle nothing.
            if start == end && sweep < std::f64::consts::PI {
                None
            } else if (arc.sweep() - sweep).abs() > std::f64::consts::PI {
                Some(Element::Line { start, end })
            } else {
                Some(arc)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stand(waste_left: bool) -> Stand {
        let away = if waste_left { Vector::new(0.0, 1.0) } else { Vector::new(0.0, -1.0) };
        Stand { at: Point::new(5.0, 1.0), heading: Vector::new(1.0, 0.0), away, waste_left }
    }

    #[test]
    fn a_quarter_arc_comes_from_behind_and_goes_ahead_on_the_side_of_the_waste() {
        let lead = Lead::Arc { radius: 2.0, sweep: 90.0 };
        for (left, y) in [(true, 3.0), (false, -1.0)] {
            let way = inwards(lead, &stand(left), None).unwrap();
            let element = way.element.unwrap();
            assert!((way.outer - Point::new(3.0, y)).norm() < 1e-12, "{way:?}");
            assert!((element.heading_at_end() - Vector::new(1.0, 0.0)).norm() < 1e-12);
            assert!((element.length() - std::f64::consts::PI).abs() < 1e-12);
            let way = outwards(lead, &stand(left), None).unwrap();
            assert!((way.outer - Point::new(7.0, y)).norm() < 1e-12, "{way:?}");
            assert!((way.element.unwrap().heading_at_start() - Vector::new(1.0, 0.0)).norm() < 1e-12);
        }
    }

    #[test]
    fn a_direct_way_needs_a_hole() {
        assert!(inwards(Lead::Direct, &stand(true), None).is_none());
        let hole = Point::new(5.0, 9.0);
        let way = inwards(Lead::Direct, &stand(true), Some(hole)).unwrap();
        assert_eq!(way.element, Some(Element::Line { start: hole, end: Point::new(5.0, 1.0) }));
    }

    #[test]
    fn an_arc_of_less_than_a_micron_does_not_become_a_circle() {
        let p = Point::new;
        let arc = |start, end| Element::Arc { start, end, centre: p(0.0, 0.0), sense: Sense::Clockwise };
        assert_eq!(rounded(&arc(p(0.0, 1.0), p(0.0002, 1.0)), p(0.0, 1.0)), None);
        let circle = arc(p(0.0, 1.0), p(0.0, 1.0));
        assert_eq!(rounded(&circle, p(0.0, 1.0)), Some(circle));
    }
}
