//! Numbers larger than a format has digits for.
//!
//! 3B and 4B: J has six digits on the older controls, which is a rule of the format and refused when it is read; that a
//! control takes more than six digits in X and Y is unverified, so more is told. G-code: eight digits of 1 µm, ±99 999.999
//! mm, which is what wire controls take at their least increment of 1 µm (unverified for any one of them).

use super::Finding;
use crate::formats::three_b::{Block, COUNT_MAX};
use crate::geometry::{Element, Point};
use crate::motion::{Act, Motion};

/// The format a program is written in.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Format {
    /// 3B.
    #[default]
    ThreeB,
    /// 4B.
    FourB,
    /// G-code.
    GCode,
}

/// Compares each block with the digits of its format.
#[derive(Debug)]
pub(super) struct Limits {
    format: Format,
}

/// Eight digits of a micron, mm.
const GCODE_MM: f64 = 99_999.999;

impl Limits {
    pub(super) fn new(format: Format) -> Self {
        Self { format }
    }

    pub(super) fn see(&self, motion: &Motion, block: Option<&Block>, tell: &mut impl FnMut(Finding)) {
        let Act::Move { element, .. } = &motion.act else { return };
        match self.format {
            Format::ThreeB | Format::FourB => {
                let largest = block.map_or_else(
                    || 1000.0 * blockwise(element).iter().copied().fold(0.0, f64::max),
                    |block| block.x.max(block.y).0 as f64,
                );
                if largest > COUNT_MAX.0 as f64 {
                    tell(
                        Finding::warning(
                            "number-digits",
                            motion.spot,
                            motion.block,
                            format!("X or Y is {largest:.0} µm: seven digits or more, and J has six"),
                        )
                        .help("that a control takes them is unverified; split the block, or try it dry"),
                    );
                }
            }
            Format::GCode => {
                let end: Point = element.end();
                let largest = end.x.abs().max(end.y.abs());
                if largest > GCODE_MM {
                    tell(
                        Finding::error(
                            "number-limit",
                            motion.spot,
                            motion.block,
                            format!("a coordinate of {largest:.3} mm has more than eight digits of a micron"),
                        )
                        .help("the largest coordinate is 99999.999 mm; check the unit and the point"),
                    );
                }
            }
        }
    }
}

/// X and Y as 3B writes them, mm: the way of a line, the start of an arc from its centre.
fn blockwise(element: &Element) -> [f64; 2] {
    let way = match *element {
        Element::Line { start, end } => end - start,
        Element::Arc { start, centre, .. } => start - centre,
    };
    [way.x.abs(), way.y.abs()]
}
