//! What a control does with G41 and G42, done here: the wire's own path.
//!
//! An adapter between readers and writers: motions with offsets go in, motions of the wire come out, with the block
//! numbers and spots of the blocks they come from. The straight move after the offset is switched on leads in, from
//! where the wire stands to square beside the contour's start; the first move after it is switched off leads out. At
//! outside corners the wire goes round; at inside corners it turns where both its ways meet. One compensated run is
//! held at a time, and nothing else.
//!
//! A closed contour is offset as a whole ([`crate::geometry::offset`]), so that elements the wire cannot enter are
//! left out, and told as [`Warning`]s. Where it begins in an inside corner, the wire begins where its ways meet: a
//! control would cut into the corner there. An open run, as one with arcs for lead-in and lead-out or with an overcut,
//! is offset corner by corner ([`local`]) as a control does, and refused where an element of it vanishes or the outline
//! in it has a place that the wire cannot enter.
//!
//! Taper is passed on: it tilts the wire about the path and does not move it.
//!
//! ```
//! use dripfeed::compensation::Compensated;
//! use dripfeed::formats::gcode::{Dialect, Motions};
//! use dripfeed::geometry::offset::Corners;
//! use dripfeed::motion::{Act, Motion};
//!
//! let text = "G21 G90 G92 X0. Y0.\nG41 D1 G01 X5.\nG03 I-5. J0.\nG40 G01 X0.\nM02\n";
//! let dialect = Dialect::named("generic").expect("a built-in dialect")?;
//! let motions = Motions::new(text.as_bytes(), dialect);
//! let mut wire = Compensated::new(motions, [(1, 0.1)].into(), Corners::Round);
//! let made: Vec<Motion> = wire.by_ref().collect::<Result<_, _>>()?;
//! let ends = made.iter().filter_map(|motion| match motion.act {
//!     Act::Move { element, .. } => Some(element.end().x),
//!     _ => None,
//! });
//! assert_eq!(ends.collect::<Vec<_>>(), [4.9, 4.9, 0.0]);
//! assert!(wire.take_warnings().is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod local;
pub mod put_on;
mod run;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, VecDeque};
use std::fmt;

use crate::geometry::offset::{Corners, Unreached};
use crate::geometry::{Element, Point};
use crate::motion::runs::ContourError;
use crate::motion::{Act, Motion, Offset, Side, Stop};
use crate::place::Spot;
use run::Run;

/// Motions of the wire, made of motions with offsets.
#[derive(Debug)]
pub struct Compensated<I> {
    source: I,
    /// What the registers of the control hold, mm.
    registers: BTreeMap<u32, f64>,
    corners: Corners,
    state: State,
    /// Where the wire stands, when that is not where the program is.
    standing: Option<Point>,
    ready: VecDeque<Result<Motion, ContourError>>,
    warnings: Vec<Warning>,
    is_over: bool,
}

/// A part of a contour that the wire cannot enter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warning {
    /// The block of the first element that is not touched.
    pub block: u64,
    /// Where it stands in the source.
    pub spot: Spot,
    /// What is not touched; its indices count the elements from the contour's first.
    pub unreached: Unreached,
    /// What becomes of it.
    pub fate: Fate,
}

/// What becomes of a part that the wire cannot enter.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Fate {
    /// The wire passes it by: material stays there.
    PassedBy,
    /// The wire cuts into it, in an open run led corner by corner.
    CutInto,
}

impl Warning {
    /// What the wire does not do as it should, and where.
    #[must_use]
    pub fn message(&self) -> String {
        let at = self.unreached.at;
        let does = match self.fate {
            Fate::PassedBy => "does not reach",
            Fate::CutInto => "cuts into",
        };
        format!("the wire {does} the contour at X{:.3} Y{:.3}", at.x, at.y)
    }

    /// Up to where it would.
    #[must_use]
    pub fn help(&self) -> String {
        let does = match self.fate {
            Fate::PassedBy => "does",
            Fate::CutInto => "does not",
        };
        format!("the largest offset that {does} is {:.3} mm", self.unreached.largest)
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "block {}: {}; {}", self.block, self.message(), self.help())
    }
}

#[derive(Debug)]
enum State {
    /// The numbers are the wire's.
    Off,
    /// An offset is switched on; the move that leads in is awaited.
    Starting { on: On },
    /// A contour is collected.
    Running { on: On, run: Box<Run> },
}

/// An offset that is switched on.
#[derive(Clone, Copy, Debug)]
struct On {
    /// As the program says it.
    said: Offset,
    /// How far to the left of the contour, mm.
    left: f64,
    /// The block that switched it on.
    block: u64,
    spot: Spot,
}

impl<I, E> Compensated<I>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    /// The wire's path for motions, with what the registers of the control hold, mm; a distance in the motion itself
    /// comes first.
    pub fn new(source: I, registers: BTreeMap<u32, f64>, corners: Corners) -> Self {
        Self {
            source,
            registers,
            corners,
            state: State::Off,
            standing: None,
            ready: VecDeque::new(),
            warnings: Vec::new(),
            is_over: false,
        }
    }

    /// What has been passed by since this was last asked. To be asked after each motion, or at least at the end.
    #[must_use]
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        std::mem::take(&mut self.warnings)
    }

    fn take(&mut self, motion: Motion) -> Result<(), ContourError> {
        match std::mem::replace(&mut self.state, State::Off) {
            State::Off => match motion.act {
                Act::Offset(said) => self.switched(said, &motion)?,
                Act::Move { .. } => {
                    let moved = self.begun_where_it_stands(motion)?;
                    self.ready.push_back(Ok(moved));
                }
                _ => self.ready.push_back(Ok(motion)),
            },
            State::Starting { on } => match motion.act {
                Act::Offset(said) => self.switched(said, &motion)?,
                Act::Move { element: Element::Line { start, end }, .. } if start == end => {
                    self.state = State::Starting { on };
                    self.ready.push_back(Ok(motion));
                }
                Act::Move { element: Element::Line { .. }, upper: None, .. } => {
                    let lead_in = self.begun_where_it_stands(motion)?;
                    self.state = State::Running { on, run: Box::new(Run::new(lead_in)) };
                }
                Act::Move { .. } => {
                    return Err(ContourError::at(
                        &motion,
                        "the move after the offset is switched on is not straight",
                        LEAD,
                    ));
                }
                _ => {
                    self.state = State::Starting { on };
                    self.ready.push_back(Ok(motion));
                }
            },
            State::Running { on, mut run } => match motion.act {
                Act::Offset(Offset::Off) => self.finish(on, &run)?,
                Act::Offset(said) if said == on.said => self.state = State::Running { on, run },
                Act::Offset(_) => {
                    return Err(ContourError::at(&motion, "the offset changes within a contour", CHANGE));
                }
                Act::Stop(Stop::End) => {
                    self.finish(on, &run)?;
                    self.ready.push_back(Ok(motion));
                }
                Act::Move { upper: Some(_), .. } => {
                    return Err(ContourError::at(
                        &motion,
                        "the wire's upper end has a way of its own under an offset",
                        UPPER,
                    ));
                }
                _ => {
                    if run.len() == RUN_MOST {
                        return Err(ContourError::at(
                            &motion,
                            "the offset stays on for too many blocks",
                            CHANGE,
                        ));
                    }
                    run.push(motion);
                    self.state = State::Running { on, run };
                }
            },
        }
        Ok(())
    }

    fn switched(&mut self, said: Offset, motion: &Motion) -> Result<(), ContourError> {
        let Offset::On { side, distance, register } = said else { return Ok(()) };
        let held = register.and_then(|number| self.registers.get(&number).copied());
        let Some(distance) = distance.or(held) else {
            let message = match register {
                Some(number) => format!("register {number} holds no offset that is known here"),
                None => "the offset has no distance".to_owned(),
            };
            return Err(ContourError::at(motion, message, REGISTER));
        };
        if !distance.is_finite() {
            return Err(ContourError::at(motion, "the offset is not a number", REGISTER));
        }
        let left = if side == Side::Left { distance } else { -distance };
        self.state = State::Starting { on: On { said, left, block: motion.block, spot: motion.spot } };
        Ok(())
    }

    /// Gives out the wire's path beside a contour.
    fn finish(&mut self, on: On, run: &Run) -> Result<(), ContourError> {
        let done = run.beside(on.left, self.corners, on.block, on.spot)?;
        self.standing = Some(done.end);
        self.ready.extend(done.motions.into_iter().map(Ok));
        self.warnings.extend(done.warnings);
        Ok(())
    }

    /// A move begun where the wire stands: it leads out of an offset, or is any other.
    fn begun_where_it_stands(&mut self, mut motion: Motion) -> Result<Motion, ContourError> {
        let Act::Move { element, upper, .. } = &mut motion.act else { return Ok(motion) };
        let is_empty = matches!(element, Element::Line { start, end } if start == end);
        match (self.standing, *element) {
            (Some(at), element) if at != element.start() && !is_empty => {
                let Element::Line { end, .. } = element else {
                    return Err(ContourError::at(
                        &motion,
                        "the move after the offset is switched off is not straight",
                        LEAD,
                    ));
                };
                if upper.is_some() {
                    return Err(ContourError::at(
                        &motion,
                        "the wire's upper end has a way of its own under an offset",
                        UPPER,
                    ));
                }
                if let Act::Move { element, .. } = &mut motion.act {
                    *element = Element::Line { start: at, end };
                }
                self.standing = None;
            }
            (Some(_), _) if !is_empty => self.standing = None,
            // A move of length zero leaves the wire where it is.
            _ => {}
        }
        Ok(motion)
    }
}

impl<I, E> Iterator for Compensated<I>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    type Item = Result<Motion, ContourError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(ready) = self.ready.pop_front() {
                return Some(ready);
            }
            if self.is_over {
                return None;
            }
            let taken = match self.source.next() {
                Some(Ok(motion)) => self.take(motion),
                Some(Err(error)) => Err(error.into()),
                None => {
                    self.is_over = true;
                    match std::mem::replace(&mut self.state, State::Off) {
                        State::Running { on, run } => self.finish(on, &run),
                        State::Off | State::Starting { .. } => Ok(()),
                    }
                }
            };
            if let Err(error) = taken {
                self.is_over = true;
                self.ready.push_back(Err(error));
            }
        }
    }
}

/// Blocks of a run held at most: a guess, far beyond any contour, and about 200 MB.
const RUN_MOST: usize = 1_000_000;

const LEAD: &str =
    "a lead-in or lead-out must be a straight move in a block of its own beside G40, G41 or G42";
const CHANGE: &str = "switch the offset off with G40 and a straight move out, then on again";
const UPPER: &str = "offset both contours before they are joined, or cut with a taper angle";
const REGISTER: &str = "say what the register of the control holds, in mm: --register N=MM";
