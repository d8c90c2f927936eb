//! One compensated run: the lead-in, the moves of a contour, and what the program says between them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use super::{Fate, Warning, local};
use crate::geometry::offset::{Corners, Impossible, Origin, Unreached, offset};
use crate::geometry::{Element, Path, Point};
use crate::motion::runs::ContourError;
use crate::motion::{Act, Motion};
use crate::place::Spot;

/// What is collected while an offset is on.
#[derive(Debug)]
pub(super) struct Run {
    lead_in: Motion,
    /// The moves of the contour, none of length zero.
    moves: Vec<Motion>,
    elements: Vec<Element>,
    /// What else is said, and before which move.
    between: Vec<(usize, Motion)>,
}

/// The wire's path beside a run.
pub(super) struct Done {
    pub(super) motions: Vec<Motion>,
    pub(super) warnings: Vec<Warning>,
    /// Where the wire stands after it.
    pub(super) end: Point,
}

/// The wire's way beside a contour, and what each part of it runs beside.
struct Beside {
    ways: Vec<(Element, Origin)>,
    warnings: Vec<Warning>,
}

impl Run {
    pub(super) fn new(lead_in: Motion) -> Self {
        Self { lead_in, moves: Vec::new(), elements: Vec::new(), between: Vec::new() }
    }

    pub(super) fn len(&self) -> usize {
        self.moves.len() + self.between.len()
    }

    pub(super) fn push(&mut self, motion: Motion) {
        match motion.act {
            Act::Move { element, .. } if !is_nothing(&element) => {
                self.elements.push(element);
                self.moves.push(motion);
            }
            _ => self.between.push((self.moves.len(), motion)),
        }
    }

    /// The wire's path to the left of the contour by a distance, mm; the offset was switched on at a block and spot.
    pub(super) fn beside(
        &self,
        left: f64,
        corners: Corners,
        block: u64,
        spot: Spot,
    ) -> Result<Done, ContourError> {
        let at_switch = |message: &str, help: &'static str| ContourError::Contour {
            message: message.to_owned(),
            block,
            spot,
            help: Cow::Borrowed(help),
        };
        if self.elements.is_empty() {
            return Err(at_switch(
                "the offset is switched on for no contour",
                "leave out the offset, or cut something",
            ));
        }
        let Some(path) = Path::new(self.elements.clone()) else {
            return Err(at_switch("the contour has a gap", "a move must begin where the last one ended"));
        };
        let Beside { ways, warnings } = match self.as_a_whole(&path, left, corners)? {
            Some(whole) => whole,
            None => {
                let ways = self.corner_by_corner(left, corners)?;
                Beside { ways, warnings: self.cut_into(&path, left)? }
            }
        };
        let (Some(first), Some(last)) = (ways.first(), ways.last()) else {
            return Err(at_switch("nothing is left of the contour", "take a thinner wire"));
        };
        let end = last.0.end();
        let mut motions = Vec::with_capacity(ways.len() + self.between.len() + 1);
        motions.push(self.leading_to(first.0.start()));
        let mut at = first.0.start();
        let mut between = self.between.iter().peekable();
        for (element, origin) in ways {
            while let Some((_, said)) = between.next_if(|(before, _)| *before <= origin.element()) {
                motions.push(standing(said, at));
            }
            at = element.end();
            let from = &self.moves[origin.element()];
            let mut made = from.clone();
            if let Act::Move { element: of, .. } = &mut made.act {
                *of = element;
            }
            motions.push(made);
        }
        for (_, said) in between {
            motions.push(standing(said, at));
        }
        Ok(Done { motions, warnings, end })
    }

    fn leading_to(&self, point: Point) -> Motion {
        let mut lead_in = self.lead_in.clone();
        if let Act::Move { element, .. } = &mut lead_in.act {
            *element = Element::Line { start: element.start(), end: point };
        }
        lead_in
    }

    /// A closed contour, offset as one; none where it is open or meets itself.
    fn as_a_whole(&self, path: &Path, left: f64, corners: Corners) -> Result<Option<Beside>, ContourError> {
        if !path.is_closed() {
            return Ok(None);
        }
        let mut found = match offset(path, left, corners) {
            Ok(found) => found,
            Err(Impossible::MeetsItself(_)) => return Ok(None),
            Err(error) => return Err(self.fault(0, error.to_string(), "look at the numbers of the contour")),
        };
        let (Some(outline), 0) = (found.outlines.pop(), found.outlines.len()) else {
            let Some(missed) = found.unreached.first() else {
                return Err(self.fault(0, "nothing is left of the contour".to_owned(), THINNER));
            };
            let message = format!(
                "the wire cannot get through: the contour comes apart here, and an offset of {:.4} mm would pass",
                missed.largest
            );
            return Err(self.fault(missed.first, message, THINNER));
        };
        let mut ways: Vec<_> =
            outline.path.elements().iter().copied().zip(outline.origins.iter().copied()).collect();
        // The wire leaves square beside the contour's end; the corner it would turn there is the one it came from.
        while ways.last().is_some_and(|way| way.1 == Origin::Corner(self.elements.len() - 1)) {
            ways.pop();
        }
        let warnings = found.unreached.into_iter().map(|unreached| self.warning(unreached, Fate::PassedBy));
        Ok(Some(Beside { ways, warnings: warnings.collect() }))
    }

    /// What a wire led corner by corner cuts into, because it lies farther along than the next corner.
    ///
    /// In an outline that the run goes round once that is certain, and refused. In a run that never comes back to where
    /// it was, it may be a lead in the waste, and is told.
    fn cut_into(&self, path: &Path, left: f64) -> Result<Vec<Warning>, ContourError> {
        let Some(outline) = self.outline() else {
            // What crosses itself is not judged here.
            let Ok(found) = offset(path, left, Corners::Round) else { return Ok(Vec::new()) };
            let missed = found.unreached.into_iter();
            return Ok(missed.map(|unreached| self.warning(unreached, Fate::CutInto)).collect());
        };
        let found = Path::new(self.elements[outline.clone()].to_vec())
            .and_then(|path| offset(&path, left, Corners::Round).ok());
        let Some(missed) = found.and_then(|found| found.unreached.into_iter().next()) else {
            return Ok(Vec::new());
        };
        let message = format!(
            "the wire cannot enter the contour here; an offset of at most {:.4} mm would",
            missed.largest
        );
        Err(self.fault(outline.start + missed.first, message, STRAIGHT))
    }

    /// The most elements, but not all, that come back to where they began.
    fn outline(&self) -> Option<Range<usize>> {
        // Adding zero makes one of its two signs.
        let key = |at: Point| ((at.x + 0.0).to_bits(), (at.y + 0.0).to_bits());
        let all = self.elements.len();
        let mut seen = BTreeMap::from([(key(self.elements.first()?.start()), 0)]);
        let mut longest: Option<Range<usize>> = None;
        for (n, element) in self.elements.iter().enumerate() {
            let first = *seen.entry(key(element.end())).or_insert(n + 1);
            let found = first..n + 1;
            if found.len() < all && found.len() > longest.as_ref().map_or(0, ExactSizeIterator::len) {
                longest = Some(found);
            }
        }
        longest
    }

    fn warning(&self, unreached: Unreached, fate: Fate) -> Warning {
        let motion = &self.moves[unreached.first];
        Warning { block: motion.block, spot: motion.spot, unreached, fate }
    }

    fn corner_by_corner(&self, left: f64, corners: Corners) -> Result<Vec<(Element, Origin)>, ContourError> {
        local::beside(&self.elements, left, corners).map_err(|vanishes| {
            let message = format!("an offset of {:.4} mm leaves nothing of this element", left.abs());
            self.fault(vanishes.0, message, THINNER)
        })
    }

    fn fault(&self, element: usize, message: String, help: &'static str) -> ContourError {
        let motion = &self.moves[element];
        ContourError::Contour { message, block: motion.block, spot: motion.spot, help: Cow::Borrowed(help) }
    }
}

/// What is said between moves; a move of length zero is one where the wire stands.
fn standing(said: &Motion, at: Point) -> Motion {
    let mut said = said.clone();
    if let Act::Move { element, .. } = &mut said.act {
        *element = Element::Line { start: at, end: at };
    }
    said
}

fn is_nothing(element: &Element) -> bool {
    matches!(element, Element::Line { start, end } if start == end)
}

const THINNER: &str = "take a thinner wire or enlarge the corner";
const STRAIGHT: &str =
    "take a thinner wire, or lead in and out with one straight move each: then the place is passed by";
