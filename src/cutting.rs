//! How a contour is cut: start hole, lead-in, passes, overcut, tabs, lead-out.
//!
//! Contours as drawn go in, motions of the wire's centre come out: each contour is offset for every pass by the wire's
//! radius, the gap and the stock left ([`crate::geometry::offset`]), and the wire is led from a start hole to its path and
//! away from it through waste alone. Nothing is assumed: every value stands in the [`Plan`], and what was chosen by a
//! rule stands in the [`Summary`].
//!
//! ```text
//!  hole ──lead-in──▶ o═══ stretch ═══▶ ┄ tab ┄ ═══ stretch ═══▶ ┄ tab ┄ ▶o─overcut─▶ ──lead-out──▶
//! ```
//!
//! Without tabs each pass goes all round. With tabs the stretches between them are cut first, each from a start hole of
//! its own or from a common one; then the control stops, and the tabs are cut. The caller gives the order of contours.
//!
//! A plan that would cut the kept part is refused before its first motion. Nodes are whole microns, each rounded once by
//! [`Micrometres::nearest`](crate::units::Micrometres::nearest). One contour's motions are held at a time.
//!
//! It does not know how long a cut takes, does not tilt the wire, and does not see clamps or the edge of the plate.

mod clearance;
mod division;
mod jobs;
mod lead;
mod refusal;
mod route;
mod summary;
#[cfg(test)]
mod tests;
mod track;
mod words;

use std::collections::VecDeque;

pub use refusal::{Fault, Lane, Refusal};
pub use summary::{ContourSummary, PassSummary, Summary, TabSummary};
pub use words::{Misspelt, passes};

use crate::geometry::offset::Corners;
use crate::geometry::{Path, Point, Sense};
use crate::motion::{Act, Motion, Side, Stop, Text};
use crate::place::Spot;
use route::Route;

/// A closed contour to be cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Its outline as drawn, run in the direction of the first pass.
    pub path: Path,
    /// Which side of it is the part.
    pub kept: Kept,
    /// Where the wire comes to it.
    pub entry: Entry,
    /// Where the wire is threaded.
    pub holes: Holes,
    /// Where it stands in its source; all its motions say so.
    pub spot: Spot,
}

/// Which side of a contour is the part.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kept {
    /// A punch: what is inside is kept, and the wire runs outside.
    Inside,
    /// A die: what is outside is kept, and the wire runs inside.
    Outside,
}

/// Where the wire comes to a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// Where the contour begins as drawn.
    Beginning,
    /// At the point of the contour nearest to this one, mm: a start hole, or a place where a mark does no harm.
    Nearest(Point),
}

/// Where the wire is threaded.
#[derive(Clone, Debug, PartialEq)]
pub enum Holes {
    /// Through drilled holes, mm: one for the whole contour, or one for each stretch between tabs in their order.
    Given(Vec<Point>),
    /// Where the lead-in begins, a hole for each stretch: they are to be drilled there.
    AtLeadIn,
}

/// How contours are cut. There is no default: every value is somebody's decision.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The first pass.
    pub rough: Pass,
    /// The passes after it, in order.
    pub skims: Vec<Skim>,
    /// How the wire goes round outside corners.
    pub corners: Corners,
    /// How the wire comes to its path.
    pub lead_in: Lead,
    /// How it leaves its path; none where it stays on it.
    pub lead_out: Option<Lead>,
    /// How far the wire goes on past the closing point, and past the end of each tab, mm.
    pub overcut: f64,
    /// What is left uncut at first.
    pub tabs: Tabs,
    /// When the tabs are cut.
    pub cut_tabs: CutTabs,
    /// Before which tabs the control stops.
    pub stops: Stops,
    /// What the control is told between start holes.
    pub rethread: Rethread,
    /// Where the machine stands when the program begins, mm.
    pub from: Point,
}

/// One pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// How far from the contour the wire runs.
    pub distance: Distance,
    /// Condition words for the control, each said before the pass.
    pub words: Vec<Text>,
}

/// A pass after the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Skim {
    /// Its offset and words.
    pub pass: Pass,
    /// In which direction.
    pub way: Way,
}

/// The direction of a pass.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Way {
    /// In the direction of the first pass. Between tabs the wire is cut and threaded again for it.
    Again,
    /// Against the direction of the pass before it, from where that one ended.
    Back,
}

/// How far from the contour the wire's centre runs, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distance {
    /// So far.
    Offset(f64),
    /// As far as half the wire, the gap and the stock together.
    Wire {
        /// The wire's diameter, mm.
        diameter: f64,
        /// The spark gap between the wire and the work, mm.
        gap: f64,
        /// What is left for the passes to come, mm.
        stock: f64,
    },
}

/// How the wire comes to its path, or leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lead {
    /// Straight between the start hole and the path.
    Direct,
    /// Straight, square to the contour.
    Straight {
        /// How long, mm.
        length: f64,
    },
    /// On an arc tangent to the path.
    Arc {
        /// Its radius, mm.
        radius: f64,
        /// The angle it sweeps, degrees, at most 180.
        sweep: f64,
    },
}

/// What is left uncut at first, so that the piece does not fall.
#[derive(Clone, Debug, PartialEq)]
pub enum Tabs {
    /// Nothing.
    None,
    /// So many, at equal distances; the last one ends at the closing point.
    Even {
        /// How many.
        count: u32,
        /// The length of each along the contour, mm.
        length: f64,
    },
    /// These, in their order along the contour.
    At(Vec<Tab>),
}

/// A tab, along the contour as drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tab {
    /// How far from the entry it begins, mm.
    pub from: f64,
    /// How long it is, mm.
    pub length: f64,
}

/// When tabs are cut.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum CutTabs {
    /// Last of all: every pass over the stretches between them, then every pass over the tabs, to and fro. For a punch,
    /// which is held until it is finished.
    Last,
    /// After the first pass; the others then go all round. For a die, whose waste is taken out.
    BeforeSkims,
}

/// Before which tabs the control stops.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Stops {
    /// Before the last one: when it is cut, the piece falls.
    BeforeLast(Stop),
    /// Before each.
    BeforeEach(Stop),
}

/// What the control is told between start holes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rethread {
    /// To cut the wire, before it is positioned: a word or a stop; nothing where the format says it itself, as 3B does.
    pub cut: Vec<Act>,
    /// To thread it, after it is positioned. The first hole is threaded before the program is started.
    pub thread: Vec<Act>,
}

/// The motions that cut contours, one contour worked out at a time.
#[derive(Debug)]
pub struct Cutting {
    contours: Vec<Contour>,
    plan: Plan,
    summary: Summary,
    next: usize,
    at: Point,
    ready: VecDeque<Motion>,
    block: u64,
    is_over: bool,
}

impl Cutting {
    /// The motions that cut contours in this order, and what was chosen for it.
    ///
    /// # Errors
    ///
    /// When one of them cannot be cut so, or the kept part would be cut.
    pub fn new(contours: Vec<Contour>, plan: Plan) -> Result<Self, Refusal> {
        refusal::check_numbers(&plan)?;
        let mut summary = Summary::default();
        let mut at = lead::on_grid(plan.from);
        for number in 0..contours.len() {
            let route = Route::of(&contours, number, &plan, at)?;
            at = route.at;
            summary.contours.push(route.summary);
        }
        let at = lead::on_grid(plan.from);
        let (ready, next, block) = (VecDeque::new(), 0, 0);
        Ok(Self { contours, plan, summary, next, at, ready, block, is_over: false })
    }

    /// What was chosen, contour by contour.
    #[must_use]
    pub fn summary(&self) -> &Summary {
        &self.summary
    }

    fn say(&mut self, act: Act, spot: Spot) {
        if matches!(act, Act::Move { .. } | Act::Stop(Stop::End)) {
            self.block += 1;
        }
        self.ready.push_back(Motion { act, block: self.block, spot });
    }
}

impl Iterator for Cutting {
    type Item = Result<Motion, Refusal>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(motion) = self.ready.pop_front() {
                return Some(Ok(motion));
            }
            if self.is_over {
                return None;
            }
            let Some(contour) = self.contours.get(self.next) else {
                self.is_over = true;
                self.say(Act::Stop(Stop::End), Spot::default());
                continue;
            };
            let spot = contour.spot;
            match Route::of(&self.contours, self.next, &self.plan, self.at) {
                Ok(route) => {
                    self.at = route.at;
                    self.next += 1;
                    for act in route.acts {
                        self.say(act, spot);
                    }
                }
                Err(refusal) => {
                    self.is_over = true;
                    return Some(Err(refusal));
                }
            }
        }
    }
}

impl Kept {
    /// Which side is kept when the wire runs on a side of a closed path, seen in its direction.
    #[must_use]
    pub fn beside(path: &Path, wire: Side) -> Self {
        match (path.sense(), wire) {
            (Sense::CounterClockwise, Side::Left) | (Sense::Clockwise, Side::Right) => Self::Outside,
            (Sense::CounterClockwise, Side::Right) | (Sense::Clockwise, Side::Left) => Self::Inside,
        }
    }

    /// The side of a closed path on which the wire runs, seen in its direction.
    #[must_use]
    pub fn wire_side(self, path: &Path) -> Side {
        match (path.sense(), self) {
            (Sense::CounterClockwise, Self::Outside) | (Sense::Clockwise, Self::Inside) => Side::Left,
            (Sense::CounterClockwise, Self::Inside) | (Sense::Clockwise, Self::Outside) => Side::Right,
        }
    }
}

impl Distance {
    /// How far the wire's centre is from the contour, mm.
    #[must_use]
    pub fn offset(self) -> f64 {
        match self {
            Self::Offset(offset) => offset,
            Self::Wire { diameter, gap, stock } => diameter / 2.0 + gap + stock,
        }
    }

    /// Half the width of the kerf, mm; the whole offset where the wire is not told.
    #[must_use]
    pub fn kerf_radius(self) -> f64 {
        match self {
            Self::Offset(offset) => offset,
            Self::Wire { diameter, gap, .. } => diameter / 2.0 + gap,
        }
    }
}

impl Plan {
    /// All passes, in order.
    pub fn passes(&self) -> impl Iterator<Item = &Pass> {
        std::iter::once(&self.rough).chain(self.skims.iter().map(|skim| &skim.pass))
    }
}
