//! The centre of an arc, from I and J or from R, and the check that tells whether it is one.

use super::dialect::ArcCentre;
use super::numbers::millimetres;
use crate::geometry::{Element, Point, Sense};

/// A position or displacement, nanometres.
pub(super) type Nanometres = [i64; 2];

/// What a block says of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub start: Nanometres,
    pub end: Nanometres,
    pub sense: Sense,
    /// I and J, as written.
    pub offset: [Option<i64>; 2],
    /// R, as written.
    pub radius: Option<i64>,
    /// What absolute coordinates of the program are shifted by.
    pub shift: Nanometres,
    /// How far the radii may disagree.
    pub tolerance: i64,
    /// Whether an arc whose radii disagree more is kept as it is.
    pub is_kept: bool,
}

/// Why a block is no arc.
#[derive(Debug)]
pub(super) struct Wrong {
    pub message: String,
    pub help: String,
}

impl Arc {
    /// The arc.
    pub(super) fn element(&self, rule: ArcCentre) -> Result<Element, Wrong> {
        let centre = match (self.radius, self.offset) {
            (Some(_), [Some(_), _] | [_, Some(_)]) => {
                return Err(wrong("an arc with both R and I or J", "leave one of them out"));
            }
            (Some(radius), _) => self.centre_from_radius(radius)?,
            (None, [None, None]) => {
                return Err(wrong("an arc without a centre", "I and J, or R, belong in the block"));
            }
            (None, _) => self.centre_checked(rule)?,
        };
        Ok(Element::Arc { start: point(self.start), end: point(self.end), centre, sense: self.sense })
    }

    /// The centre I and J give under a rule.
    fn centre(&self, rule: ArcCentre) -> Option<Nanometres> {
        let [i, j] = self.offset;
        let (i0, j0) = (i.unwrap_or(0), j.unwrap_or(0));
        match rule {
            ArcCentre::FromStart => Some([self.start[0] + i0, self.start[1] + j0]),
            ArcCentre::ToStart => Some([self.start[0] - i0, self.start[1] - j0]),
            ArcCentre::Absolute => Some([i? + self.shift[0], j? + self.shift[1]]),
        }
    }

    /// The centre I and J give, when both radii agree.
    fn centre_checked(&self, rule: ArcCentre) -> Result<Point, Wrong> {
        let Some(centre) = self.centre(rule) else {
            return Err(wrong("an absolute centre needs both I and J", "write the one that is missing"));
        };
        let radii = self.radii(centre);
        if self.agree(radii) {
            return Ok(point(centre));
        }
        if radii[0] == 0.0 && radii[1] == 0.0 {
            return Err(wrong("an arc of radius 0", "I and J lead from the start to the centre"));
        }
        let fitting = [ArcCentre::FromStart, ArcCentre::Absolute, ArcCentre::ToStart]
            .into_iter()
            .find(|other| *other != rule && self.centre(*other).is_some_and(|c| self.agree(self.radii(c))));
        if fitting.is_none() && self.is_kept && radii[0] > 0.0 {
            return Ok(point(centre));
        }
        let help = match fitting {
            Some(other) => format!(
                "they agree with `arc_centre = \"{}\"`: choose it if the control reads so",
                other.name()
            ),
            None => "correct the end or the centre".to_owned(),
        };
        Err(Wrong {
            message: format!(
                "the radius of the arc is {:.4} mm at its start and {:.4} mm at its end",
                radii[0] / 1e6,
                radii[1] / 1e6
            ),
            help,
        })
    }

    /// The radii at start and end, nanometres.
    fn radii(&self, centre: Nanometres) -> [f64; 2] {
        [self.start, self.end].map(|p| length([p[0] - centre[0], p[1] - centre[1]]))
    }

    fn agree(&self, [start, end]: [f64; 2]) -> bool {
        start > 0.0 && end > 0.0 && (start - end).abs() <= self.tolerance as f64
    }

    /// The centre of the arc of a radius: of at most half a turn, of more when the radius is negative.
    fn centre_from_radius(&self, radius: i64) -> Result<Point, Wrong> {
        let way = [self.end[0] - self.start[0], self.end[1] - self.start[1]];
        let chord = length(way);
        if chord == 0.0 {
            return Err(wrong("an arc with R that ends where it begins", "write a full circle with I and J"));
        }
        let (half, size) = (chord / 2.0, (radius as f64).abs());
        if radius == 0 || half > size + self.tolerance as f64 / 2.0 {
            return Err(Wrong {
                message: format!(
                    "a radius of {:.4} mm does not reach over {:.4} mm",
                    size / 1e6,
                    chord / 1e6
                ),
                help: "the radius is at least half the way from start to end".to_owned(),
            });
        }
        let height = (size * size - half * half).max(0.0).sqrt();
        // The centre of a short counter-clockwise arc lies to the left of the chord.
        let left = (self.sense == Sense::CounterClockwise) == (radius > 0);
        let side = if left { height / chord } else { -height / chord };
        let from = point(self.start);
        Ok(Point::new(
            from.x + (way[0] as f64 / 2.0 - way[1] as f64 * side) / 1e6,
            from.y + (way[1] as f64 / 2.0 + way[0] as f64 * side) / 1e6,
        ))
    }
}

fn length(way: Nanometres) -> f64 {
    let (x, y) = (way[0] as f64, way[1] as f64);
    (x * x + y * y).sqrt()
}

fn wrong(message: &str, help: &str) -> Wrong {
    Wrong { message: message.to_owned(), help: help.to_owned() }
}

/// The point in millimetres.
pub(super) fn point(at: Nanometres) -> Point {
    Point::new(millimetres(at[0]), millimetres(at[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MM: i64 = 1_000_000;

    fn arc(end: Nanometres, offset: [Option<i64>; 2], radius: Option<i64>) -> Arc {
        let sense = Sense::CounterClockwise;
        Arc {
            start: [10 * MM, 0],
            end,
            sense,
            offset,
            radius,
            shift: [0, 0],
            tolerance: 3000,
            is_kept: false,
        }
    }

    fn centre(arc: Arc, rule: ArcCentre) -> Point {
        match arc.element(rule) {
            Ok(Element::Arc { centre, .. }) => centre,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_four_conventions_give_one_centre() {
        let end = [0, 10 * MM];
        for (rule, offset) in [
            (ArcCentre::FromStart, [Some(-10 * MM), Some(0)]),
            (ArcCentre::FromStart, [Some(-10 * MM), None]),
            (ArcCentre::ToStart, [Some(10 * MM), Some(0)]),
            (ArcCentre::Absolute, [Some(0), Some(0)]),
        ] {
            assert_eq!(centre(arc(end, offset, None), rule), Point::new(0.0, 0.0), "{rule:?}");
        }
        let short = centre(arc(end, [None, None], Some(10 * MM)), ArcCentre::FromStart);
        assert!((short - Point::new(0.0, 0.0)).norm() < 1e-12);
        let long = centre(arc(end, [None, None], Some(-10 * MM)), ArcCentre::FromStart);
        assert!((long - Point::new(10.0, 10.0)).norm() < 1e-12);
    }

    #[test]
    fn radii_that_disagree_are_told_with_the_rule_that_fits() {
        let told = |end, offset| arc(end, offset, None).element(ArcCentre::FromStart).unwrap_err();
        let error = told([0, 10 * MM], [Some(10 * MM), Some(0)]);
        assert_eq!(
            error.message,
            "the radius of the arc is 10.0000 mm at its start and 22.3607 mm at its end"
        );
        assert!(error.help.contains("to-start"), "{}", error.help);
        assert!(told([0, 10 * MM], [Some(0), Some(0)]).help.contains("absolute"));
        assert!(arc([0, 10 * MM + 2999], [Some(-10 * MM), None], None).element(ArcCentre::FromStart).is_ok());
        assert!(
            arc([0, 10 * MM + 3001], [Some(-10 * MM), None], None).element(ArcCentre::FromStart).is_err()
        );
    }

    #[test]
    fn what_is_no_arc_is_refused() {
        let refused = |a: Arc| a.element(ArcCentre::FromStart).unwrap_err().message;
        assert_eq!(
            refused(arc([10 * MM, 0], [None, None], Some(5 * MM))),
            "an arc with R that ends where it begins"
        );
        assert!(refused(arc([0, 0], [None, None], Some(4 * MM))).contains("does not reach"));
        assert!(refused(arc([0, 0], [None, None], None)).contains("without a centre"));
        assert!(refused(arc([0, 0], [Some(1), None], Some(1))).contains("both R and I"));
        assert!(refused(arc([10 * MM, 0], [Some(0), None], None)).contains("radius 0"));
        assert!(arc([0, 0], [Some(1), None], None).element(ArcCentre::Absolute).is_err());
    }

    #[test]
    fn a_wrong_arc_is_kept_on_request_unless_another_rule_for_centres_fits_it() {
        let kept = |offset| Arc { is_kept: true, ..arc([-10 * MM, 0], offset, None) };
        let wrong = kept([Some(-10 * MM + 5000), Some(0)]);
        assert!(wrong.element(ArcCentre::FromStart).is_ok());
        assert!(Arc { is_kept: false, ..wrong }.element(ArcCentre::FromStart).is_err());
        let absolute = kept([Some(0), Some(5000)]);
        assert!(absolute.element(ArcCentre::FromStart).is_err());
    }
}
