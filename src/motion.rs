//! What a program makes the machine do, one thing at a time, whatever format it is written in.
//!
//! Readers of 3B, 4B, G-code and drawings are iterators of `Result<Motion, ReadError>`; writers, checks and pictures
//! take them. So every format
//! meets every other one here, and nowhere else. Positions are absolute millimetres from where the program began, as
//! programmed: an offset the control adds is an [`Act::Offset`], not yet in the numbers. What has no meaning for the
//! path is carried along as text, so that nothing a program says is lost.
//!
//! How blocks are spelled is `formats`; where a control really stands after them is `interpolator`.

pub mod lead;
pub mod reverse;
pub mod runs;
pub mod thinning;

use crate::geometry::Element;
use crate::place::Spot;

/// One thing a program says.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// What.
    pub act: Act,
    /// The number of its block, from 1; what stands before the first block has 0.
    pub block: u64,
    /// Where in the source it stands.
    pub spot: Spot,
}

/// What a program says.
#[derive(Clone, Debug, PartialEq)]
pub enum Act {
    /// The wire moves along an element.
    Move {
        /// Whether it cuts on the way.
        travel: Travel,
        /// The way in the plane of the program, mm.
        element: Element,
        /// The way of the wire's upper end, mm, where the program gives it one of its own (U, V, `:`-pairs).
        upper: Option<Element>,
        /// 4B's flag on the block.
        flag: Option<Flag>,
    },
    /// The control sets its wire off the programmed path from the next move on.
    Offset(Offset),
    /// The control tilts the wire from the next move on.
    Taper(Taper),
    /// The control stops.
    Stop(Stop),
    /// The control waits, s.
    Dwell(f64),
    /// A word the machine needs and the path does not: cutting condition, wire, flushing, feed.
    Word(Text),
    /// A word the reader does not know: kept, and reported.
    Unknown(Text),
    /// A remark, without its brackets or semicolon.
    Comment(Text),
    /// What stands around a program: `%`, an O-word, a header line of a listing.
    Header(Text),
}

/// Words as they stand in the source; not always of any known character code.
pub type Text = Box<[u8]>;

/// Whether the wire cuts as it moves.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Travel {
    /// The wire cuts.
    Cut,
    /// The machine positions itself, with the wire cut or free.
    Rapid,
}

/// 4B's compensation flag.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Flag {
    /// `D`: a convex arc, the radius grows by a positive offset; on a lead-in, positive taper.
    D,
    /// `DD`: a concave arc, the radius shrinks by a positive offset; on a lead-in, inverse taper.
    DD,
}

/// The offset a control adds to the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// None: the numbers are the wire's.
    Off,
    /// The wire runs beside the path.
    On {
        /// On which side, seen in the direction of motion.
        side: Side,
        /// How far, mm, where it is known.
        distance: Option<f64>,
        /// The register of the control that holds the distance.
        register: Option<u32>,
    },
}

/// A side, seen in the direction of motion.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Side {
    /// To the left: G41, G51.
    Left,
    /// To the right: G42, G52.
    Right,
}

impl Side {
    /// The side of the same place seen the other way.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// The tilt a control gives the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Taper {
    /// The wire stands upright.
    Off,
    /// The wire's upper end leans to a side.
    On {
        /// To which side, seen in the direction of motion.
        side: Side,
        /// How far from upright, degrees.
        angle: f64,
    },
}

/// A stop.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Stop {
    /// `D`, M00: until the operator goes on.
    Pause,
    /// M01: the same, where the operator has asked for it.
    Optional,
    /// `DD`, `E`, M02, M30: the program is over.
    End,
}
