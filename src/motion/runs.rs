//! A stream of motions cut into runs of the wire: what lies between two ways without cutting.
//!
//! What has to be seen whole (a contour to be reversed, to be offset, to have its corners rounded) is held one run at a
//! time, and no longer than [`MOVES_MAX`]. A run ends at a rapid, at the end of the program, and at a stop where the
//! contour has come home; a stop on the way round, to hold the part, does not end it. In 3B, which has no rapid, the line
//! between two pauses is a run of its own.

use std::borrow::Cow;
use std::collections::VecDeque;

use thiserror::Error;

use super::{Act, Motion, Stop, Travel};
use crate::formats::ReadError;
use crate::geometry::{Element, Point};
use crate::place::Spot;

/// Why something cannot be done to a contour.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ContourError {
    /// The program could not be read so far.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The contour does not allow it.
    #[error("block {block}: {message}")]
    Contour {
        /// The rule broken.
        message: String,
        /// The block.
        block: u64,
        /// Where it stands.
        spot: Spot,
        /// What to do about it.
        help: Cow<'static, str>,
    },
}

impl ContourError {
    pub(crate) fn at(motion: &Motion, message: impl Into<String>, help: &'static str) -> Self {
        Self::Contour { message: message.into(), block: motion.block, spot: motion.spot, help: help.into() }
    }
}

/// A piece of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum Portion {
    /// The wire cuts.
    Run(Run),
    /// Something said, or a way without cutting.
    Between(Motion),
}

/// A run of the wire: it begins with a cut; things may be said in it and behind its last cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Everything, in order.
    pub motions: Vec<Motion>,
}

/// How a run is made up, in moves.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Layout {
    /// So many first moves lead to the outline.
    pub lead_in: usize,
    /// So many last moves lead away from it.
    pub lead_out: usize,
    /// Whether the outline between them comes back to where it began.
    pub closed: bool,
}

impl Layout {
    /// How moves are made up that go from each node to the next.
    ///
    /// An outline is what comes back to a node. Moves at both ends that lead there and back again are leads.
    #[must_use]
    pub fn of(nodes: &[Point]) -> Self {
        let Some(moves) = nodes.len().checked_sub(1).filter(|&moves| moves > 0) else {
            return Layout { lead_in: 0, lead_out: 0, closed: false };
        };
        let meet = |a: usize, b: usize| (nodes[a] - nodes[b]).norm() <= MEET_MM;
        if meet(0, moves) {
            let mut leads = 0;
            while moves - 2 * leads > 2 && meet(leads + 1, moves - leads - 1) {
                leads += 1;
            }
            return Layout { lead_in: leads, lead_out: leads, closed: true };
        }
        let most = LEAD_MOVES_MAX.min(moves - 1);
        for leads in 1..=2 * most {
            for lead_in in (0..=leads.min(most)).rev() {
                let lead_out = leads - lead_in;
                if lead_out <= most && lead_in + lead_out < moves && meet(lead_in, moves - lead_out) {
                    return Layout { lead_in, lead_out, closed: true };
                }
            }
        }
        Layout { lead_in: 0, lead_out: 0, closed: false }
    }
}

impl Run {
    /// The elements cut, in order, each with its motion's place in [`Run::motions`].
    pub fn cuts(&self) -> impl DoubleEndedIterator<Item = (usize, Element)> {
        self.motions.iter().enumerate().filter_map(|(n, motion)| match motion.act {
            Act::Move { element, .. } => Some((n, element)),
            _ => None,
        })
    }

    /// How the run is made up.
    #[must_use]
    pub fn layout(&self) -> Layout {
        let mut nodes: Vec<Point> = self.cuts().map(|(_, element)| element.start()).collect();
        nodes.extend(self.cuts().next_back().map(|(_, element)| element.end()));
        Layout::of(&nodes)
    }

    /// Whether the wire is back where the outline, or the way to it, began, or has only gone straight. With a flag a way
    /// that goes straight leads to an outline.
    fn has_come_home(&self) -> bool {
        if let [Motion { act: Act::Move { flag: Some(_), .. }, .. }, rest @ ..] = self.motions.as_slice()
            && !rest.iter().any(|motion| matches!(motion.act, Act::Move { .. }))
        {
            return false;
        }
        let Some((_, last)) = self.cuts().next_back() else { return true };
        let home = |(_, first): (usize, Element)| (first.start() - last.end()).norm() <= MEET_MM;
        self.cuts().nth(1).is_none() || self.cuts().take(1 + LEAD_MOVES_MAX).any(home)
    }
}

/// Gathers motions, given one at a time, into portions.
#[derive(Debug, Default)]
pub struct Gatherer {
    run: Run,
    moves: usize,
}

impl Gatherer {
    /// Takes a motion; gives the run it ends, if it ends one, and the motion itself, if it is in none.
    ///
    /// # Errors
    ///
    /// When the run is longer than [`MOVES_MAX`].
    pub fn give(&mut self, motion: Motion) -> Result<(Option<Run>, Option<Motion>), ContourError> {
        let ends = match motion.act {
            Act::Move { travel: Travel::Cut, .. } => {
                self.moves += 1;
                if self.moves > MOVES_MAX {
                    let message = format!("a contour of more than {MOVES_MAX} moves");
                    let help = "a contour is held whole for this; do it where the program is made";
                    return Err(ContourError::at(&motion, message, help));
                }
                self.run.motions.push(motion);
                return Ok((None, None));
            }
            Act::Move { travel: Travel::Rapid, .. } | Act::Stop(Stop::End) => true,
            Act::Stop(Stop::Pause | Stop::Optional) => self.run.has_come_home(),
            _ => false,
        };
        if self.run.motions.is_empty() {
            return Ok((None, Some(motion)));
        }
        if ends {
            return Ok((self.finish(), Some(motion)));
        }
        self.run.motions.push(motion);
        Ok((None, None))
    }

    /// The run in work, at the end of the program.
    pub fn finish(&mut self) -> Option<Run> {
        self.moves = 0;
        let run = std::mem::take(&mut self.run);
        (!run.motions.is_empty()).then_some(run)
    }
}

/// Cuts motions that are pulled into portions.
#[derive(Debug)]
pub struct Runs<I> {
    motions: I,
    gatherer: Gatherer,
    /// What ended the run, told behind it.
    behind: Option<Motion>,
}

impl<I, E> Runs<I>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    /// The portions of a program.
    pub fn new(motions: I) -> Self {
        Self { motions, gatherer: Gatherer::default(), behind: None }
    }
}

impl<I, E> Iterator for Runs<I>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    type Item = Result<Portion, ContourError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(behind) = self.behind.take() {
            return Some(Ok(Portion::Between(behind)));
        }
        loop {
            let given = match self.motions.next() {
                Some(Ok(motion)) => self.gatherer.give(motion),
                Some(Err(error)) => return Some(Err(error.into())),
                None => return self.gatherer.finish().map(|run| Ok(Portion::Run(run))),
            };
            match given {
                Ok((None, None)) => {}
                Ok((None, Some(motion))) => return Some(Ok(Portion::Between(motion))),
                Ok((Some(run), behind)) => {
                    self.behind = behind;
                    return Some(Ok(Portion::Run(run)));
                }
                Err(error) => return Some(Err(error)),
            }
        }
    }
}

/// Motions made into others, a portion of a program at a time: what [`Contourwise`] drives.
pub trait Rework {
    /// What becomes of a run.
    ///
    /// # Errors
    ///
    /// When its shape does not allow it.
    fn run(&mut self, run: Run) -> Result<Vec<Motion>, ContourError>;

    /// What becomes of something between runs: itself as a rule, with something before it, or nothing yet.
    ///
    /// # Errors
    ///
    /// When it does not allow it.
    fn between(&mut self, motion: Motion) -> Result<Between, ContourError>;
}

/// What becomes of something between runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Between {
    /// One motion.
    One(Motion),
    /// Any number of them.
    Several(Vec<Motion>),
}

/// A program reworked contour by contour.
#[derive(Debug)]
pub struct Contourwise<I, W> {
    runs: Runs<I>,
    rework: W,
    ready: VecDeque<Motion>,
}

impl<I, E, W> Contourwise<I, W>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
    W: Rework,
{
    /// The program reworked.
    pub fn new(motions: I, rework: W) -> Self {
        Self { runs: Runs::new(motions), rework, ready: VecDeque::new() }
    }
}

impl<I, E, W> Iterator for Contourwise<I, W>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
    W: Rework,
{
    type Item = Result<Motion, ContourError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(motion) = self.ready.pop_front() {
                return Some(Ok(motion));
            }
            match self.runs.next()? {
                Ok(Portion::Between(motion)) => match self.rework.between(motion) {
                    Ok(Between::One(motion)) => return Some(Ok(motion)),
                    Ok(Between::Several(motions)) => self.ready = motions.into(),
                    Err(error) => return Some(Err(error)),
                },
                Ok(Portion::Run(run)) => match self.rework.run(run) {
                    Ok(motions) => self.ready = motions.into(),
                    Err(error) => return Some(Err(error)),
                },
                Err(error) => return Some(Err(error)),
            }
        }
    }
}

/// The most moves held.
pub const MOVES_MAX: usize = 1_000_000;

/// Nodes so near are one, mm: a 3B program rounded block by block closes a few microns off.
pub(crate) const MEET_MM: f64 = 0.010;

/// The most moves of a lead that does not come back the way it went.
const LEAD_MOVES_MAX: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;

    fn path(nodes: &[(f64, f64)]) -> Run {
        let lines = nodes.windows(2).map(|pair| cut(pair[0], pair[1]));
        Run { motions: lines.collect() }
    }

    fn cut(from: (f64, f64), to: (f64, f64)) -> Motion {
        let element = Element::Line { start: Point::new(from.0, from.1), end: Point::new(to.0, to.1) };
        said(Act::Move { travel: Travel::Cut, element, upper: None, flag: None })
    }

    fn said(act: Act) -> Motion {
        Motion { act, block: 1, spot: Spot::default() }
    }

    const SQUARE: [(f64, f64); 5] = [(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 9.0), (1.0, 1.0)];

    #[test]
    fn leads_are_told_from_the_outline_they_lead_to() {
        let square = |before: &[(f64, f64)], after: &[(f64, f64)]| {
            let Layout { lead_in, lead_out, closed } = path(&[before, &SQUARE, after].concat()).layout();
            (lead_in, lead_out, closed)
        };
        let (hole, by) = ((0.0, 0.0), (0.5, 1.0));
        assert_eq!(square(&[], &[]), (0, 0, true));
        assert_eq!(square(&[hole], &[hole]), (1, 1, true));
        assert_eq!(square(&[hole, by], &[by, hole]), (2, 2, true));
        assert_eq!(square(&[hole], &[]), (1, 0, true));
        assert_eq!(square(&[hole, by], &[]), (2, 0, true));
        assert_eq!(square(&[], &[hole]), (0, 1, true));
        assert_eq!(square(&[hole], &[(0.0, 5.0)]), (1, 1, true));
        assert_eq!(path(&SQUARE[..4]).layout(), Layout { lead_in: 0, lead_out: 0, closed: false });
        assert_eq!(path(&SQUARE[..2]).layout(), Layout { lead_in: 0, lead_out: 0, closed: false });
    }

    #[test]
    fn a_stop_on_the_way_round_does_not_end_a_run_and_one_at_home_does() {
        let pause = || said(Act::Stop(Stop::Pause));
        let mut motions = path(&[(0.0, 0.0), (1.0, 1.0), (9.0, 1.0), (9.0, 9.0)]).motions;
        motions.push(pause());
        motions.extend(path(&[(9.0, 9.0), (1.0, 1.0), (0.0, 0.0)]).motions);
        motions.push(pause());
        motions.push(cut((0.0, 0.0), (20.0, 0.0)));
        motions.push(pause());
        motions.extend(path(&[(20.0, 0.0), (21.0, 0.0), (22.0, 1.0), (21.0, 0.0)]).motions);
        motions.push(said(Act::Stop(Stop::End)));
        let portions = Runs::new(motions.into_iter().map(Ok::<_, ContourError>));
        let told: Vec<String> = portions
            .map(|portion| match portion.unwrap() {
                Portion::Run(run) => format!("{} of {}", run.cuts().count(), run.motions.len()),
                Portion::Between(motion) => format!("{:?}", motion.act),
            })
            .collect();
        let expected = ["5 of 6", "Stop(Pause)", "1 of 1", "Stop(Pause)", "3 of 3", "Stop(End)"];
        assert_eq!(told, expected);
    }
}
