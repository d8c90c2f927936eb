//! Lead-ins through the part that is kept.
//!
//! The wire slits whatever it passes on its way to the contour. Which side of a contour is kept is known when the control
//! sets its wire off (the part lies on the other side), or when the operator says so. A 3B program has the offset in its
//! numbers and says nothing; about it no claim is made unless [`Kept`] is given.

use super::Finding;
use super::contours::{Held, Run};
use crate::geometry::{Path, Sense};
use crate::motion::Side;

/// Which side of its contours the part is on.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kept {
    /// A punch: what falls out is the part.
    Inside,
    /// A die: what falls out is waste.
    Outside,
}

/// Looks at the way to each ring.
#[derive(Debug)]
pub(super) struct LeadIn {
    given: Option<Kept>,
}

impl LeadIn {
    pub(super) fn new(given: Option<Kept>) -> Self {
        Self { given }
    }

    pub(super) fn see(&mut self, run: &Run<'_>, tell: &mut impl FnMut(Finding)) {
        let Run::Ring { lead, ring, .. } = *run else { return };
        let Some(last) = lead.last() else { return };
        // A ring that bounds nothing but the offset's own way in says nothing about sides.
        if self.given.is_none() && ring[0].side.is_none() {
            return;
        }
        let Some(path) = Path::new(ring.iter().map(|held| held.element).collect()) else { return };
        let Some(kept) = self.given.or_else(|| kept_by_offset(&path, ring)) else { return };
        // A lead-in that crosses the contour is told as such; one that does not is on one side throughout.
        let is_inside = path.contains(last.element.at(0.5));
        if is_inside == (kept == Kept::Inside) {
            let where_ = if is_inside { "inside" } else { "outside" };
            tell(
                Finding::warning(
                    "lead-in-through-part",
                    last.spot,
                    last.block,
                    format!("the lead-in slits the part that is kept, {where_} the contour"),
                )
                .help("put the start hole on the other side of the contour, in the waste"),
            );
        }
    }
}

/// The part lies on the side of the contour on which the wire does not run.
fn kept_by_offset(path: &Path, ring: &[Held]) -> Option<Kept> {
    let wire_is_inside = match (ring[0].side?, path.sense()) {
        (Side::Left, Sense::CounterClockwise) | (Side::Right, Sense::Clockwise) => true,
        (Side::Left, Sense::Clockwise) | (Side::Right, Sense::CounterClockwise) => false,
    };
    Some(if wire_is_inside { Kept::Outside } else { Kept::Inside })
}
