//! The cuts of a program sorted out: what is contour, what leads to it and away, where numbers and arrow heads belong.

use super::layer::Layer;
use super::marks::{Mark, Marks};
use crate::check::contours::Run;
use crate::drawing::Extent;
use crate::geometry::{Element, Vector};

/// The cuts as they are sorted out.
#[derive(Debug)]
pub(super) struct Cuts {
    pub(super) nominal: Layer,
    pub(super) lead_in: Layer,
    pub(super) numbers: Marks,
    pub(super) heads: Marks,
    /// The bounds of the contours.
    pub(super) part: Option<Extent>,
}

impl Cuts {
    /// Nothing yet, with a number at every so many blocks; none lets the page decide.
    pub(super) fn numbered(every: Option<u64>) -> Self {
        Self {
            nominal: Layer::new(),
            lead_in: Layer::new(),
            numbers: every.map_or_else(|| Marks::up_to(NUMBERS_MAX), Marks::every),
            heads: Marks::between(HEADS_MAX),
            part: None,
        }
    }

    /// Draws what a chain of cuts has come to.
    pub(super) fn draw(&mut self, run: &Run<'_>) {
        match *run {
            Run::Ring { ring, .. } => {
                let origin = -ring[0].element.start().coords;
                let doubled: f64 =
                    ring.iter().map(|held| held.element.placed(0.0, 1.0, origin).doubled_area()).sum();
                // Numbers stand outside: to the right of a contour that is run counter-clockwise.
                let outside = if doubled > 0.0 { -1.0 } else { 1.0 };
                for held in ring {
                    self.contour(&held.element, held.block, left(&held.element) * outside);
                }
                self.nominal.end_run();
            }
            // Without a ring in its chain a cut is what is to be cut.
            Run::Rest { held, rings: 0, .. } | Run::TooLong(held) => {
                for held in held {
                    self.contour(&held.element, held.block, left(&held.element));
                }
            }
            Run::Retrace(held) | Run::Rest { held, .. } => {
                for held in held {
                    self.lead_in.add(&held.element);
                    self.numbers.offer(mark(&held.element, held.block, left(&held.element)));
                }
            }
        }
    }

    pub(super) fn contour(&mut self, element: &Element, block: u64, aside: Vector) {
        self.part = Some(grown(self.part, element));
        self.nominal.add(element);
        let mark = mark(element, block, aside);
        self.numbers.offer(mark);
        self.heads.offer(mark);
    }
}

/// Bounds that hold an element too.
pub(super) fn grown(extent: Option<Extent>, element: &Element) -> Extent {
    let [min, max] = element.extent();
    let own = Extent::between([min.x, min.y], [max.x, max.y]);
    extent.map_or(own, |all| all.united(own))
}

/// The middle of an element, and its direction there.
fn mark(element: &Element, block: u64, aside: Vector) -> Mark {
    Mark { block, at: element.at(0.5), heading: middle_heading(element), aside }
}

fn middle_heading(element: &Element) -> Vector {
    match *element {
        Element::Line { .. } => element.heading_at_start(),
        Element::Arc { end, centre, sense, .. } => {
            Element::Arc { start: element.at(0.5), end, centre, sense }.heading_at_start()
        }
    }
}

pub(super) fn left(element: &Element) -> Vector {
    let ahead = middle_heading(element);
    Vector::new(-ahead.y, ahead.x)
}

/// The most block numbers when the page decides.
const NUMBERS_MAX: usize = 40;

/// The most arrow heads.
const HEADS_MAX: usize = 16;
