//! In which order and direction the wire runs along the pieces of a contour.
//!
//! Nothing here knows a coordinate: positions are marks of the division, and how far past them.
//!
//! ```text
//!  no tabs          pass 1 all round, pass 2 all round, …
//!  tabs last        each stretch: pass 1, 2, …;  stop;  each tab: pass 1, 2, …
//!  before skims     each stretch: pass 1;  stop;  each tab: pass 1;  pass 2 all round, …
//! ```

use super::division::{Division, Piece};
use super::track::Position;
use super::{CutTabs, Plan, Stops, Tabs, Way};
use crate::motion::Stop;

/// A run of the wire along its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Job {
    /// Which pass, from 0.
    pub(super) pass: usize,
    pub(super) from: Position,
    pub(super) to: Position,
    pub(super) begin: Begin,
    /// What is cut.
    pub(super) piece: What,
    /// The stop before it.
    pub(super) stop: Option<Stop>,
}

/// What a job cuts.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum What {
    /// The contour all round.
    Whole,
    /// The piece behind this mark, a stretch.
    Stretch,
    /// The piece behind this mark, a tab.
    Tab(usize),
}

/// How the wire comes to where a job begins.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Begin {
    /// It is threaded in the hole of this stretch and led in.
    Thread {
        /// The number of the stretch, from 0.
        stretch: usize,
    },
    /// It leads out of the job before and in again.
    LeadAgain {
        /// The stretch whose hole a direct lead goes to.
        stretch: usize,
    },
    /// It steps from where the job before ended to the same place beside the contour.
    Step,
}

/// The jobs that cut a contour.
pub(super) fn jobs(division: &Division, plan: &Plan) -> Vec<Job> {
    let mut order = Order { division, plan, jobs: Vec::new(), stands: None };
    if plan.tabs == Tabs::None {
        order.all_round(0, Position { mark: 0, laps: 0, over: 0.0 }, true);
        order.skims_all_round();
        return order.jobs;
    }
    let last = plan.cut_tabs == CutTabs::Last;
    for (n, mark) in division.of_kind(Piece::Stretch).enumerate() {
        order.stretch(n, mark, last);
    }
    order.tabs(last);
    if !last {
        order.skims_all_round();
    }
    order.jobs
}

struct Order<'a> {
    division: &'a Division,
    plan: &'a Plan,
    jobs: Vec<Job>,
    /// Where the wire stands after the last job.
    stands: Option<Position>,
}

impl Order<'_> {
    fn push(&mut self, job: Job) {
        self.stands = Some(job.to);
        self.jobs.push(job);
    }

    /// A pass all round, begun at a position.
    fn all_round(&mut self, pass: usize, from: Position, forwards: bool) {
        let begin = match (self.stands, self.plan.lead_out) {
            (Some(at), Some(_)) if self.same_mark(at.mark, from.mark) => {
                Begin::LeadAgain { stretch: self.stretch_at(from.mark) }
            }
            (Some(at), None) if self.same_place(at, from) => Begin::Step,
            _ => Begin::Thread { stretch: self.stretch_at(from.mark) },
        };
        let (laps, over) = if forwards { (1, self.plan.overcut) } else { (-1, -self.plan.overcut) };
        let to = Position { laps: from.laps + laps, over: from.over + over, ..from };
        self.push(Job { pass, from, to, begin, piece: What::Whole, stop: None });
    }

    /// All passes but the first, all round.
    fn skims_all_round(&mut self) {
        let first = self.division.of_kind(Piece::Stretch).next().unwrap_or(0);
        let mut forwards = true;
        for (n, skim) in self.plan.skims.iter().enumerate() {
            forwards = skim.way == Way::Again || !forwards;
            let lead = Position { mark: first, laps: 0, over: 0.0 };
            let from = match (self.stands, self.plan.lead_out) {
                // The wire stays on its path: it goes on from where it stands.
                (Some(at), None) if self.same_mark(at.mark, first) => {
                    Position { mark: first, laps: 0, over: at.over }
                }
                _ => lead,
            };
            self.all_round(n + 1, from, forwards);
        }
    }

    /// A stretch: the first pass, or all of them.
    fn stretch(&mut self, stretch: usize, mark: usize, all: bool) {
        let end = mark + 1;
        // Past the closing point the contour is cut already, if it was begun there.
        let closes =
            end == self.division.pieces.len() && self.division.pieces[0] == Piece::Stretch && mark > 0;
        let over = if closes { self.plan.overcut } else { 0.0 };
        let start = Position { mark, laps: 0, over: 0.0 };
        let finish = Position { mark: end, laps: 0, over };
        let thread = Begin::Thread { stretch };
        let piece = What::Stretch;
        self.push(Job { pass: 0, from: start, to: finish, begin: thread, piece, stop: None });
        let mut forwards = true;
        for (n, skim) in self.plan.skims.iter().enumerate().filter(|_| all) {
            forwards = skim.way == Way::Again || !forwards;
            let (from, to) = if forwards { (start, finish) } else { (finish, start) };
            let begin = if self.stands == Some(from) { Begin::Step } else { thread };
            self.push(Job { pass: n + 1, from, to, begin, piece, stop: None });
        }
    }

    /// The tabs: first the one at which the wire stands.
    fn tabs(&mut self, all: bool) {
        let mut left: Vec<usize> = self.division.of_kind(Piece::Tab).collect();
        let (each, stop) = match self.plan.stops {
            Stops::BeforeEach(stop) => (true, stop),
            Stops::BeforeLast(stop) => (false, stop),
        };
        while !left.is_empty() {
            let begins = |tab: &usize| self.stands.is_some_and(|at| self.same_place(at, bare(*tab)));
            let ends = |tab: &usize| self.stands.is_some_and(|at| self.same_place(at, bare(tab + 1)));
            let (n, begin, mut forwards) = if let Some(n) = left.iter().position(begins) {
                (n, Begin::Step, true)
            } else if let Some(n) = left.iter().position(ends) {
                (n, Begin::Step, false)
            } else {
                // From the lead-in of the stretch behind it, backwards.
                (0, Begin::Thread { stretch: self.stretch_at(left[0] + 1) }, false)
            };
            let tab = left.remove(n);
            let (low, high) = (bare(tab), bare(tab + 1));
            let past = |position: Position, over: f64| Position { over, ..position };
            let overcut = self.plan.overcut;
            let (from, to) = if forwards { (low, past(high, overcut)) } else { (high, past(low, -overcut)) };
            let stop = (each || left.is_empty()).then_some(stop);
            let piece = What::Tab(tab);
            self.push(Job { pass: 0, from, to, begin, piece, stop });
            for n in 1..=self.plan.skims.len() {
                if !all {
                    break;
                }
                forwards = !forwards;
                let from = self.stands.unwrap_or(to);
                let to = if forwards { past(high, overcut) } else { past(low, -overcut) };
                self.push(Job { pass: n, from, to, begin: Begin::Step, piece, stop: None });
            }
        }
    }

    /// The stretch, from 0, that begins at a mark.
    fn stretch_at(&self, mark: usize) -> usize {
        self.division.of_kind(Piece::Stretch).position(|at| self.same_mark(at, mark)).unwrap_or(0)
    }

    fn same_mark(&self, one: usize, other: usize) -> bool {
        let count = self.division.pieces.len();
        one % count == other % count
    }

    fn same_place(&self, one: Position, other: Position) -> bool {
        self.same_mark(one.mark, other.mark) && one.over == other.over
    }
}

fn bare(mark: usize) -> Position {
    Position { mark, laps: 0, over: 0.0 }
}
