//! Why contours cannot be cut as planned, where, and what to do about it.

use std::fmt;

use thiserror::Error;

use super::{Distance, Kept, Lead, Plan, Tabs};
use crate::geometry::Point;
use crate::geometry::offset::Impossible;
use crate::place::Spot;

/// Contours that cannot be cut as planned.
#[derive(Clone, Debug, Error, PartialEq)]
pub struct Refusal {
    /// Which contour, from 1; 0 where the plan itself is at fault.
    pub contour: usize,
    /// Where the contour stands in its source.
    pub spot: Spot,
    /// Where on the part, mm.
    pub at: Option<Point>,
    /// Why.
    #[source]
    pub fault: Fault,
}

/// The rule that a plan breaks.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A number of the plan is none to cut with.
    #[error("{what} is {value}, and must be {must}")]
    Number {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// The contour does not close.
    #[error("the contour is open")]
    Open,
    /// The contour has no inside.
    #[error("the contour encloses nothing")]
    EnclosesNothing,
    /// The contour has no offset.
    #[error("pass {pass} has no path: {reason}")]
    Impossible {
        /// Which pass, from 1.
        pass: usize,
        /// Why.
        reason: Impossible,
    },
    /// The wire finds no room at all.
    #[error("the wire finds no room for pass {pass}, {offset:.4} mm from the contour")]
    NoRoom {
        /// Which pass, from 1.
        pass: usize,
        /// Its offset, mm.
        offset: f64,
    },
    /// The wire's path comes apart where the contour is too narrow.
    #[error("the path of pass {pass} comes apart into {pieces} pieces, {offset:.4} mm from the contour")]
    ComesApart {
        /// Which pass, from 1.
        pass: usize,
        /// Into how many pieces.
        pieces: usize,
        /// The offset, mm.
        offset: f64,
        /// The largest offset that still passes, mm, where it is known.
        largest: Option<f64>,
    },
    /// There are too few or too many start holes.
    #[error("{given} start holes are given, and the contour is cut in {needed} stretches")]
    Holes {
        /// How many are given.
        given: usize,
        /// How many stretches there are.
        needed: usize,
    },
    /// A direct lead without a start hole.
    #[error("a direct lead goes to the start hole, and none is given")]
    NoHole,
    /// A start hole is in the part.
    #[error("the start hole is in the kept part, {kept} the contour")]
    HoleInPart {
        /// Which side is kept.
        kept: Kept,
    },
    /// A lead would cut the part.
    #[error("the {lane} comes within {distance:.4} mm of contour {other}, and the wire needs {least:.4} mm")]
    CutsPart {
        /// Which way.
        lane: Lane,
        /// Which contour it comes too near to, from 1.
        other: usize,
        /// How near it comes, mm.
        distance: f64,
        /// How near it may come, mm.
        least: f64,
    },
    /// A lead would cut through a tab.
    #[error("the {lane} cuts into tab {tab}, which is to hold the piece")]
    CutsTab {
        /// Which way.
        lane: Lane,
        /// Which tab, from 1.
        tab: usize,
    },
    /// The wire on its path would cut into another contour.
    #[error(
        "the wire in pass {pass} comes within {distance:.4} mm of contour {other}, and cuts {least:.4} mm wide to each side"
    )]
    CutsOther {
        /// Which pass, from 1.
        pass: usize,
        /// Which contour, from 1.
        other: usize,
        /// How near it comes, mm.
        distance: f64,
        /// Half the width of the kerf, mm.
        least: f64,
    },
    /// Tabs take up the whole contour.
    #[error("the tabs take up {taken:.3} mm of a contour of {length:.3} mm")]
    TabsTooLong {
        /// The length of all of them, mm.
        taken: f64,
        /// The length of the contour, mm.
        length: f64,
    },
    /// A tab begins before the one before it has ended, or lies beyond the contour.
    #[error(
        "tab {tab} from {from:.3} to {to:.3} mm touches another one or the end of a contour of {length:.3} mm"
    )]
    TabsOverlap {
        /// Which tab, from 1.
        tab: usize,
        /// Where it begins, mm along the contour.
        from: f64,
        /// Where it ends, mm along the contour.
        to: f64,
        /// The length of the contour, mm.
        length: f64,
    },
    /// The kerfs to both sides of a tab leave nothing of it.
    #[error(
        "tab {tab} is {length:.3} mm long on the wire's path, and the kerf on either side takes {kerf:.3} mm of it"
    )]
    TabTooShort {
        /// Which tab, from 1.
        tab: usize,
        /// How long it is on the path of the first pass, mm.
        length: f64,
        /// Half the width of the kerf, mm.
        kerf: f64,
    },
    /// The wire does not come to the entry.
    #[error("the wire of pass {pass} does not come to the entry")]
    EntryLost {
        /// Which pass, from 1.
        pass: usize,
    },
    /// The wire does not come to an end of a tab, or not between it and the one before.
    #[error(
        "the wire of pass {pass} does not come to this end of a tab, or not between it and the one before"
    )]
    TabLost {
        /// Which pass, from 1.
        pass: usize,
    },
    /// The overcut is longer than what is cut already behind it.
    #[error("the overcut of {overcut:.3} mm is longer than the stretch of {length:.3} mm that it runs into")]
    OvercutTooLong {
        /// The overcut, mm.
        overcut: f64,
        /// The length of the shortest stretch, mm.
        length: f64,
    },
}

/// A way through the waste.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Lane {
    /// From the start hole to where the lead-in begins.
    Approach,
    /// To the wire's path.
    LeadIn,
    /// Away from it.
    LeadOut,
    /// From one pass to the next.
    Change,
}

impl Refusal {
    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> String {
        match &self.fault {
            Fault::Number { .. } => "give a length in millimetres or an angle in degrees".to_owned(),
            Fault::Open => {
                "close the contour in the drawing, or join its ends with a wider tolerance".to_owned()
            }
            Fault::EnclosesNothing => "draw it once only: a way drawn to and fro has no inside".to_owned(),
            Fault::Impossible { reason: Impossible::MeetsItself(_), .. } => {
                "redraw the contour so that it does not cross itself".to_owned()
            }
            Fault::Impossible { .. } => "move the drawing nearer to its origin".to_owned(),
            Fault::NoRoom { .. } => "use a thinner wire, or keep the other side of the contour".to_owned(),
            Fault::ComesApart { largest: Some(largest), .. } => {
                format!(
                    "use an offset of {largest:.3} mm at most, or draw its parts as contours of their own"
                )
            }
            Fault::ComesApart { largest: None, .. } => {
                "use a thinner wire, or draw its parts as contours of their own".to_owned()
            }
            Fault::Holes { needed, .. } => {
                format!("give one hole, or {needed}: one for each stretch in order")
            }
            Fault::NoHole => "give the start hole, or a straight lead of a length".to_owned(),
            Fault::HoleInPart { kept: Kept::Inside } => {
                "put the hole outside the contour, or keep what is outside".to_owned()
            }
            Fault::HoleInPart { kept: Kept::Outside } => {
                "put the hole inside the contour, or keep what is inside".to_owned()
            }
            Fault::CutsPart { lane: Lane::Approach, .. } => {
                "put the start hole where it sees the entry, or the entry nearer to the hole".to_owned()
            }
            Fault::CutsPart { lane: Lane::Change, .. } => {
                "lead out to where the next pass is led in: with a direct or a straight lead".to_owned()
            }
            Fault::CutsPart { .. } => "make the lead shorter, or let the wire come in elsewhere".to_owned(),
            Fault::CutsTab { .. } => {
                "use a straight lead, a smaller radius or a longer tab, or give a hole for each stretch"
                    .to_owned()
            }
            Fault::CutsOther { .. } => "move the contours apart, or use a thinner wire".to_owned(),
            Fault::TabsTooLong { .. } => "use fewer or shorter tabs".to_owned(),
            Fault::TabsOverlap { .. } => {
                "give tabs in order along the contour, with something to cut between them".to_owned()
            }
            Fault::TabTooShort { kerf, .. } => {
                format!("make the tab longer than {:.3} mm by what is to hold the piece", 2.0 * kerf)
            }
            Fault::EntryLost { .. } => {
                "let the wire come in elsewhere, not in a slot that it does not enter".to_owned()
            }
            Fault::TabLost { .. } => {
                "move the tab away from the corner or slot that the wire does not enter".to_owned()
            }
            Fault::OvercutTooLong { .. } => "make the overcut shorter".to_owned(),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.contour > 0 {
            write!(f, "contour {}: ", self.contour)?;
        }
        self.fault.fmt(f)?;
        self.at.map_or(Ok(()), |at| write!(f, " (at X{:.4} Y{:.4})", at.x, at.y))
    }
}

impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inside => "inside",
            Self::Outside => "outside",
        })
    }
}

impl fmt::Display for Lane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Approach => "way from the start hole to the lead-in",
            Self::LeadIn => "lead-in",
            Self::LeadOut => "lead-out",
            Self::Change => "way from one pass to the next",
        })
    }
}

/// Refuses numbers that are none to cut with.
pub(super) fn check_numbers(plan: &Plan) -> Result<(), Refusal> {
    let refuse = |what, value, must| {
        let fault = Fault::Number { what, value, must };
        Err(Refusal { contour: 0, spot: Spot::default(), at: None, fault })
    };
    let within = |value: f64, least: f64| value.is_finite() && least <= value && value <= FARTHEST;
    for pass in plan.passes() {
        if let Distance::Wire { diameter, gap, stock } = pass.distance {
            for (what, value) in [("the wire's diameter", diameter), ("the gap", gap), ("the stock", stock)] {
                if !within(value, 0.0) {
                    return refuse(what, value, "0 to 100000 mm");
                }
            }
        }
        let offset = pass.distance.offset();
        if !(offset == 0.0 || within(offset, SMALLEST_OFFSET)) {
            return refuse("the offset", offset, "0, or 0.001 to 100000 mm");
        }
    }
    for lead in std::iter::once(plan.lead_in).chain(plan.lead_out) {
        let (what, value) = match lead {
            Lead::Direct => continue,
            Lead::Straight { length } => ("the length of a lead", length),
            Lead::Arc { radius, sweep } => {
                if !(sweep > 0.0 && sweep <= 180.0) {
                    return refuse("the sweep of a lead", sweep, "more than 0 and at most 180 degrees");
                }
                ("the radius of a lead", radius)
            }
        };
        if !within(value, SMALLEST_LEAD) {
            return refuse(what, value, "0.001 to 100000 mm");
        }
    }
    if !within(plan.overcut, 0.0) {
        return refuse("the overcut", plan.overcut, "0 to 100000 mm");
    }
    match &plan.tabs {
        Tabs::Even { count: 0, .. } => return refuse("the number of tabs", 0.0, "at least 1"),
        Tabs::Even { length, .. } if !within(*length, SMALLEST_LEAD) => {
            return refuse("the length of a tab", *length, "0.001 to 100000 mm");
        }
        Tabs::Even { .. } | Tabs::None => {}
        Tabs::At(tabs) => {
            for tab in tabs {
                if !within(tab.length, SMALLEST_LEAD) {
                    return refuse("the length of a tab", tab.length, "0.001 to 100000 mm");
                }
                if !within(tab.from, 0.0) {
                    return refuse("the beginning of a tab", tab.from, "0 to 100000 mm");
                }
            }
        }
    }
    check_point("the place where the machine stands", plan.from)
}

/// Refuses a point that is none, or farther than any machine.
pub(super) fn check_point(what: &'static str, point: Point) -> Result<(), Refusal> {
    let is_far = |value: &f64| value.is_nan() || value.abs() > FARTHEST;
    match [point.x, point.y].into_iter().find(is_far) {
        None => Ok(()),
        Some(value) => {
            let fault = Fault::Number { what, value, must: "within 100 m of the origin" };
            Err(Refusal { contour: 0, spot: Spot::default(), at: None, fault })
        }
    }
}

/// As far as the offset reckons, mm.
const FARTHEST: f64 = 1e5;
/// A smaller offset leaves no telling on which side of the contour the wire is, mm.
const SMALLEST_OFFSET: f64 = 1e-3;
/// A shorter lead or tab is none on whole microns, mm.
const SMALLEST_LEAD: f64 = 1e-3;
