//! Moves the machine has no room for, and programs of an unlikely size.
//!
//! Where on its table a program begins is the operator's to choose, so what is judged is the span: a program wider than
//! the machine travels fits nowhere. The profile's `[travel]` says how far that is; without it the span is not judged.
//! A program smaller than 0.1 mm or larger than 2 m is most likely in another unit.

use super::Finding;
use crate::motion::{Act, Motion};
use crate::place::Spot;

/// How far the machine travels, mm, where it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// Along X.
    pub x: Option<f64>,
    /// Along Y.
    pub y: Option<f64>,
}

/// How far a program reaches.
#[derive(Debug)]
pub(super) struct Reach {
    axes: [Axis; 2],
    first: Option<(u64, Spot)>,
    /// What reaches so far.
    what: &'static str,
}

#[derive(Debug)]
struct Axis {
    name: char,
    travel: Option<f64>,
    low: f64,
    high: f64,
    is_told: bool,
}

impl Reach {
    pub(super) fn new(travel: Travel) -> Self {
        // Every program begins at the origin.
        let axis = |name, travel| Axis { name, travel, low: 0.0, high: 0.0, is_told: false };
        Self { axes: [axis('X', travel.x), axis('Y', travel.y)], first: None, what: "the program" }
    }

    /// How far the wire's own path reaches.
    pub(super) fn of_wire(travel: Travel) -> Self {
        Self { what: "the wire's path beside the program", ..Self::new(travel) }
    }

    /// In which axes more travel is needed than there is.
    pub(super) fn beyond(&self) -> [bool; 2] {
        [self.axes[0].is_told, self.axes[1].is_told]
    }

    /// Takes the next motion; in axes that are told already nothing more is told.
    pub(super) fn see_beyond(&mut self, motion: &Motion, told: [bool; 2], tell: &mut impl FnMut(Finding)) {
        for (axis, told) in self.axes.iter_mut().zip(told) {
            axis.is_told |= told;
        }
        self.see(motion, tell);
    }

    pub(super) fn see(&mut self, motion: &Motion, tell: &mut impl FnMut(Finding)) {
        let Act::Move { element, .. } = &motion.act else { return };
        self.first.get_or_insert((motion.block, motion.spot));
        let [min, max] = element.extent();
        for (axis, (low, high)) in self.axes.iter_mut().zip([(min.x, max.x), (min.y, max.y)]) {
            axis.low = axis.low.min(low);
            axis.high = axis.high.max(high);
            let span = axis.high - axis.low;
            if let Some(travel) = axis.travel
                && span > travel
                && !axis.is_told
            {
                axis.is_told = true;
                tell(
                    Finding::error(
                        "travel",
                        motion.spot,
                        motion.block,
                        format!(
                            "with this block {} spans {span:.3} mm in {}, and the machine travels {travel} mm",
                            self.what, axis.name
                        ),
                    )
                    .help("turn the part, split it, or correct [travel] in the machine's profile"),
                );
            }
        }
    }

    pub(super) fn finish(&self, tell: &mut impl FnMut(Finding)) {
        let Some((block, spot)) = self.first else { return };
        let span = self.axes.iter().map(|axis| axis.high - axis.low).fold(0.0, f64::max);
        let unlikely = if span < LEAST_MM {
            "very small: are its numbers in mm where µm are meant?"
        } else if span > MOST_MM {
            "very large: are its numbers in µm, or in tenths of them, where mm are meant?"
        } else {
            return;
        };
        let message = format!("the whole program spans {span:.3} mm, {unlikely}");
        tell(
            Finding::warning("unit", spot, block, message).help("check the unit the program was written in"),
        );
    }
}

/// Nothing smaller than the wire itself is cut on these machines.
const LEAST_MM: f64 = 0.1;
/// No table is larger than this.
const MOST_MM: f64 = 2000.0;
