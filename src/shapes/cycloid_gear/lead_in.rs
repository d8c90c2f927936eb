//! The lead-in of a gear: where the wire is threaded, and whether its way to the outline cuts into the kept part.
//!
//! With a positive offset the wire runs outside the outline, and the paper's lead-in from the gear's centre slits the
//! punch; with a negative one the same lead-in lies in the slug of the cavity, where it belongs.

use std::sync::Arc;

use super::{CycloidGear, Direction, Impossible, Outline, Trim};
use crate::geometry::{Element, Point, Sense, Vector, sweep};

/// Where the wire starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LeadIn {
    /// From the gear's centre, as in the paper.
    #[default]
    Centre,
    /// No lead-in: the wire stands at the start of the outline.
    None,
    /// From a start hole, mm from the gear's centre.
    From(Point),
}

impl LeadIn {
    /// The starting point, if the lead-in is a move at all.
    #[must_use]
    pub fn point(self) -> Option<Point> {
        match self {
            Self::Centre => Some(Point::origin()),
            Self::None => None,
            Self::From(point) => Some(point),
        }
    }

    /// Whether the wire, on its straight way to the outline's start, cuts into the part that is kept: the inside of the
    /// nominal outline for a positive offset, the outside for a negative one. With no offset no side is kept, and
    /// nothing is said.
    ///
    /// The wire's centre must not cross the nominal outline, nor its own path before it joins it: there its kerf would
    /// bite into the part.
    ///
    /// # Errors
    ///
    /// When the gear itself is impossible.
    pub fn crosses_kept_part(
        self,
        gear: &CycloidGear,
        outline: &Arc<Outline>,
        offset: f64,
    ) -> Result<bool, Impossible> {
        let Some(from) = self.point() else { return Ok(false) };
        if offset == 0.0 {
            return Ok(false);
        }
        let nominal = gear.outline(0.0, Direction::Clockwise, Trim::Refuse)?;
        let to = outline.start();
        let elsewhere = |point: Point| (point - to).norm() > JOINS_MM;
        Ok(nominal.elements().any(|element| !meetings(from, to, &element).is_empty())
            || outline.elements().any(|element| meetings(from, to, &element).into_iter().any(elsewhere)))
    }
}

/// Where the straight line from `a` to `b` meets the element; at most two points.
fn meetings(a: Point, b: Point, element: &Element) -> Vec<Point> {
    let d = b - a;
    let within = -SAME_POINT..=1.0 + SAME_POINT;
    match *element {
        Element::Line { start, end } => {
            let e = end - start;
            let cross = |p: Vector, q: Vector| p.x * q.y - p.y * q.x;
            let across = cross(d, e);
            if across == 0.0 {
                return Vec::new();
            }
            let t = cross(start - a, e) / across;
            let s = cross(start - a, d) / across;
            if within.contains(&t) && within.contains(&s) { vec![a + d * t] } else { Vec::new() }
        }
        Element::Arc { start, end, centre, sense } => {
            let (m, radius) = (a - centre, start - centre);
            let (qa, qb, qc) = (d.dot(&d), d.dot(&m), m.dot(&m) - radius.dot(&radius));
            let root = qb * qb - qa * qc;
            if root < 0.0 || qa == 0.0 {
                return Vec::new();
            }
            [-root.sqrt(), root.sqrt()]
                .into_iter()
                .map(|r| (r - qb) / qa)
                .filter(|t| within.contains(t) && on_arc(m + d * *t, radius, end - centre, sense))
                .map(|t| a + d * t)
                .collect()
        }
    }
}

/// Whether a point of the circle, seen from its centre, lies on the arc.
fn on_arc(point: Vector, start: Vector, end: Vector, sense: Sense) -> bool {
    // A line through a node lies on both elements that meet there, not on neither.
    let turn = sweep(start, point, sense);
    turn <= sweep(start, end, sense) + SAME_POINT || turn >= 2.0 * std::f64::consts::PI - SAME_POINT
}

/// This near to the outline's start the way in has joined it, mm: a micron, what a control can tell.
const JOINS_MM: f64 = 0.001;

/// Angles and fractions of a length this near are the same point: far below the micron at any size of gear.
const SAME_POINT: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    fn crosses(offset: f64, lead_in: LeadIn) -> bool {
        let gear = CycloidGear::default();
        let outline = gear.outline(offset, Direction::Clockwise, Trim::Refuse).unwrap();
        lead_in.crosses_kept_part(&gear, &outline, offset).unwrap()
    }

    #[test]
    fn the_centre_slits_a_punch_but_not_a_cavity() {
        assert!(crosses(0.07, LeadIn::Centre));
        assert!(!crosses(-0.07, LeadIn::Centre));
    }

    #[test]
    fn a_punch_entered_from_its_centre_is_noticed_for_any_number_of_teeth() {
        for teeth in 6..400 {
            let gear = CycloidGear { teeth, ..CycloidGear::default() };
            let Ok(outline) = gear.outline(0.03, Direction::Clockwise, Trim::Refuse) else { continue };
            assert!(LeadIn::Centre.crosses_kept_part(&gear, &outline, 0.03).unwrap(), "{teeth} teeth");
        }
    }

    #[test]
    fn a_hole_outside_suits_a_punch_but_not_a_cavity() {
        let start = CycloidGear::default().outline(0.07, Direction::Clockwise, Trim::Refuse).unwrap().start();
        let outside = LeadIn::From(Point::from(start.coords * 1.5));
        assert!(!crosses(0.07, outside));
        assert!(crosses(-0.07, outside));
        assert!(crosses(0.07, LeadIn::From(Point::new(0.0, -20.0))));
        assert!(!crosses(0.07, LeadIn::None));
    }
}
