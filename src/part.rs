//! A part: a shape with its wire, lead-in, repetition and rounding, from which blocks are pulled.
//!
//! This is what a part file or the options of `generate` say, once every value has been checked. It is all that is
//! needed to make the same program again, which is how a job is resumed.

pub mod file;

use std::sync::Arc;

use crate::formats::gcode::Dialect;
pub use crate::formats::three_b::StopWord;
use crate::formats::three_b::Style;
use crate::geometry::{Element, Point};
use crate::interpolator::Model;
use crate::motion::{Act, Motion, Stop, Travel};
use crate::place::Spot;
use crate::rounding::closed_loop::ClosedLoop;
use crate::rounding::per_block::PerBlock;
use crate::rounding::{Aim, Made, Role, Step};
use crate::shapes::cycloid_gear::{CycloidGear, Direction, Impossible, LeadIn, Outline, Trim};
use crate::units::Position;

/// How blocks are rounded.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Rounding {
    /// From where the control really stands.
    #[default]
    ClosedLoop,
    /// Every block by itself, as in the 1990 paper.
    PerBlock,
}

/// The format of a part's program.
#[derive(Clone, Debug, Default)]
pub enum Format {
    /// 3B, rounded as the part says.
    #[default]
    ThreeB,
    /// 4B: the outline, with flags for an offset that is keyed in.
    FourB,
    /// G-code of a dialect.
    Gcode(Arc<Dialect>),
}

impl PartialEq for Format {
    /// Dialects are the same by name.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::ThreeB, Self::ThreeB) | (Self::FourB, Self::FourB) => true,
            (Self::Gcode(a), Self::Gcode(b)) => a.name == b.name,
            _ => false,
        }
    }
}

/// A part with all its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The shape.
    pub gear: CycloidGear,
    /// The wire's offset, mm: + outside, − inside.
    pub offset: f64,
    /// The direction of cut.
    pub direction: Direction,
    /// What to do when the wire does not fit the tooth space.
    pub trim: Trim,
    /// The way in.
    pub lead_in: LeadIn,
    /// How many times the outline is cut.
    pub repeat: u64,
    /// What the program is written in.
    pub format: Format,
    /// How blocks are rounded.
    pub rounding: Rounding,
    /// Which controls closed-loop rounding serves.
    pub aim: Aim,
    /// What the program ends with.
    pub stop_word: StopWord,
    /// How blocks are written.
    pub style: Style,
    /// The machine named in the part file.
    pub machine: Option<String>,
}

impl Default for Part {
    /// The 1990 paper's printed run, rounded in closed loop for any control.
    fn default() -> Self {
        Self {
            gear: CycloidGear::default(),
            offset: 0.07,
            direction: Direction::Clockwise,
            trim: Trim::Refuse,
            lead_in: LeadIn::Centre,
            repeat: 1,
            format: Format::ThreeB,
            rounding: Rounding::ClosedLoop,
            aim: Aim::Any,
            stop_word: StopWord::DD,
            style: Style::default(),
            machine: None,
        }
    }
}

/// A part whose outline has been worked out: what blocks are pulled from.
#[derive(Clone, Debug)]
pub struct Prepared {
    part: Part,
    outline: Arc<Outline>,
    warnings: Vec<Warning>,
}

/// Something the operator should know before the first block.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// The lead-in cuts into the part that is kept.
    LeadInCrossesKeptPart,
    /// The tip rounding vanished: the wire leaves this corner radius, mm.
    SharpTip {
        /// The radius asked for, mm.
        asked: f64,
        /// The radius the wire leaves, mm.
        left: f64,
    },
    /// The root was trimmed: the wire does not reach its bottom.
    TrimmedRoot {
        /// The root radius asked for by the shape, mm.
        nominal: f64,
        /// The radius the wire leaves, mm.
        left: f64,
    },
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::LeadInCrossesKeptPart => {
                f.write_str("the lead-in crosses the part that is kept: the wire will slit it on the way in")
            }
            Self::SharpTip { asked, left } => write!(
                f,
                "the tip rounding of {asked} mm is sharper than the wire: its neighbours are trimmed to a corner, and the wire leaves a radius of {left} mm"
            ),
            Self::TrimmedRoot { nominal, left } => write!(
                f,
                "the wire does not reach the root ({nominal:.4} mm radius): the flanks are trimmed to a corner, and the wire leaves a radius of {left} mm"
            ),
        }
    }
}

impl Part {
    /// Works out the outline and what there is to warn of.
    ///
    /// # Errors
    ///
    /// When no such part exists or the wire does not fit it.
    pub fn prepare(self) -> Result<Prepared, Impossible> {
        let outline = self.gear.outline(self.offset, self.direction, self.trim)?;
        let mut warnings = Vec::new();
        if self.lead_in.crosses_kept_part(&self.gear, &outline, self.offset)? {
            warnings.push(Warning::LeadInCrossesKeptPart);
        }
        if outline.has_sharp_tip() && self.offset < 0.0 {
            warnings.push(Warning::SharpTip { asked: self.gear.tip_radius, left: -self.offset });
        }
        if outline.has_trimmed_root() {
            let nominal = self.gear.derived()?.rho_f;
            warnings.push(Warning::TrimmedRoot { nominal, left: self.offset });
        }
        Ok(Prepared { part: self, outline, warnings })
    }
}

impl Prepared {
    /// The part's values.
    #[must_use]
    pub fn part(&self) -> &Part {
        &self.part
    }

    /// The wire's path once round.
    #[must_use]
    pub fn outline(&self) -> &Arc<Outline> {
        &self.outline
    }

    /// What to tell the operator first.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The number of elements, lead-in included; closed-loop rounding may split some of them.
    #[must_use]
    pub fn element_count(&self) -> u64 {
        self.part
            .repeat
            .saturating_mul(self.outline.len())
            .saturating_add(u64::from(self.part.lead_in.point().is_some()))
    }

    /// Where the wire stands before the first block, in the part's frame.
    #[must_use]
    pub fn origin(&self) -> Position {
        Position::nearest(self.part.lead_in.point().unwrap_or_else(|| self.outline.start()))
    }

    /// The elements of the whole program, one at a time.
    pub fn steps(&self) -> impl Iterator<Item = Step> + Send + use<> {
        let outline = Arc::clone(&self.outline);
        let start = outline.start();
        let lead_in = self
            .part
            .lead_in
            .point()
            .map(|from| Step { element: Element::Line { start: from, end: start }, role: Role::LeadIn });
        let last = outline.len() - 1;
        let once = move |_| {
            (0..).zip(outline.elements()).map(move |(n, element)| Step {
                element,
                role: match n {
                    0 => Role::Opening,
                    n if n == last => Role::Closing,
                    _ => Role::Contour,
                },
            })
        };
        lead_in.into_iter().chain((0..self.part.repeat).flat_map(once))
    }

    /// What the program makes the machine do, in no format yet, its end included.
    pub fn motions(&self) -> impl Iterator<Item = Motion> + Send + use<> {
        let moves = self.steps().map(|step| Act::Move {
            travel: Travel::Cut,
            element: step.element,
            upper: None,
            flag: None,
        });
        let acts = moves.chain(std::iter::once(Act::Stop(Stop::End)));
        (1..).zip(acts).map(|(block, act)| Motion { act, block, spot: Spot::default() })
    }

    /// The blocks of the whole program, one at a time.
    #[must_use]
    pub fn blocks(&self) -> Box<dyn Iterator<Item = Made> + Send> {
        match self.part.rounding {
            Rounding::PerBlock => Box::new(PerBlock::new(self.steps())),
            Rounding::ClosedLoop => Box::new(ClosedLoop::new(self.steps(), self.origin(), self.part.aim)),
        }
    }
}

/// The name of an aim on the command line and in part files.
#[must_use]
pub fn aim_name(aim: Aim) -> &'static str {
    match aim {
        Aim::Any => "any",
        Aim::One(model) => model.name(),
    }
}

/// The aim of a name.
#[must_use]
pub fn aim_named(name: &str) -> Option<Aim> {
    if name == "any" {
        return Some(Aim::Any);
    }
    Model::ALL.into_iter().find(|model| model.name() == name).map(Aim::One)
}

/// A start hole from its coordinates, mm; none beyond 100 m, where a control counts no more.
#[must_use]
pub fn start_hole(x: f64, y: f64) -> Option<LeadIn> {
    (x.abs().max(y.abs()) <= 100_000.0).then(|| LeadIn::From(Point::new(x, y)))
}
