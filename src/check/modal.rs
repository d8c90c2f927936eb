//! What is on and off, and whether the program makes sense of it from start to end.
//!
//! Offset and taper hold until they are switched off; a stop word ends a program and nothing cuts behind it. A program
//! that leaves a mode on hands it to the next one. Words the reader does not know are told here too.

use super::Finding;
use crate::geometry::Element;
use crate::motion::{Act, Motion, Offset, Side, Stop, Taper, Travel};
use crate::place::Spot;

/// What is on.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct State {
    /// The side on which the control sets its wire off.
    pub side: Option<Side>,
    /// Whether the wire is tilted.
    pub is_tapered: bool,
}

/// Follows the modes.
#[derive(Debug, Default)]
pub(super) struct Modal {
    state: State,
    /// Where offset and taper were switched on.
    offset_at: (u64, Spot),
    taper_at: (u64, Spot),
    /// An offset has been switched and no move has come since.
    is_switching: bool,
    cuts: u64,
    has_ended: bool,
    is_after_end_told: bool,
    last: (u64, Spot),
}

impl Modal {
    /// What is on for the next move.
    pub(super) fn state(&self) -> State {
        self.state
    }

    pub(super) fn see(&mut self, motion: &Motion, tell: &mut impl FnMut(Finding)) {
        let here = (motion.block, motion.spot);
        match &motion.act {
            Act::Move { travel, element, .. } => {
                self.cuts += u64::from(*travel == Travel::Cut);
                self.move_(*travel, element, motion, tell);
                self.last = here;
            }
            Act::Offset(offset) => {
                self.is_switching = true;
                self.offset_at = here;
                self.state.side = match offset {
                    Offset::Off => None,
                    Offset::On { side, .. } => Some(*side),
                };
            }
            Act::Taper(taper) => {
                self.taper_at = here;
                self.state.is_tapered = match taper {
                    Taper::Off => false,
                    Taper::On { angle, .. } => *angle != 0.0,
                };
            }
            Act::Stop(Stop::End) => {
                self.has_ended = true;
            }
            Act::Unknown(text) => tell(
                Finding::warning(
                    "unknown-word",
                    motion.spot,
                    motion.block,
                    format!("`{}` is a word this format does not know", text.escape_ascii()),
                )
                .help("it is handed on as it stands; see that the control knows it"),
            ),
            Act::Stop(Stop::Pause | Stop::Optional)
            | Act::Dwell(_)
            | Act::Word(_)
            | Act::Comment(_)
            | Act::Header(_) => {}
        }
    }

    fn move_(&mut self, travel: Travel, element: &Element, motion: &Motion, tell: &mut impl FnMut(Finding)) {
        if self.has_ended && !std::mem::replace(&mut self.is_after_end_told, true) {
            tell(
                Finding::error(
                    "after-end",
                    motion.spot,
                    motion.block,
                    "the machine is to move after the program has ended",
                )
                .help("the control stops at the end word; put one program in one file"),
            );
        }
        if std::mem::take(&mut self.is_switching)
            && travel == Travel::Cut
            && matches!(element, Element::Arc { .. })
        {
            tell(
                Finding::warning(
                    "offset-on-arc",
                    motion.spot,
                    motion.block,
                    "the offset is switched on or off on an arc",
                )
                .help("switch it on the straight line of the lead-in or lead-out; controls alarm on an arc"),
            );
        }
        if travel == Travel::Rapid && self.state.side.is_some() {
            tell(
                Finding::warning(
                    "rapid-with-offset",
                    motion.spot,
                    motion.block,
                    "a rapid move while the offset is on",
                )
                .help("switch the offset off (G40) on the way out of the contour"),
            );
        }
    }

    pub(super) fn finish(&mut self, tell: &mut impl FnMut(Finding)) {
        if self.cuts == 0 {
            tell(
                Finding::error("no-cut", Spot::default(), 0, "the program cuts nothing")
                    .help("check that this is the program that was meant"),
            );
            return;
        }
        if !self.has_ended {
            let (block, spot) = self.last;
            tell(
                Finding::warning("no-end", spot, block, "no word ends the program")
                    .help("end it with DD (3B, 4B) or M02; without one a control may wait for more"),
            );
        }
        if self.state.side.is_some() {
            let (block, spot) = self.offset_at;
            tell(
                Finding::warning("offset-left-on", spot, block, "the offset is still on at the end")
                    .help("switch it off (G40) on the lead-out; the next program would begin with it"),
            );
        }
        if self.state.is_tapered {
            let (block, spot) = self.taper_at;
            tell(
                Finding::warning("taper-left-on", spot, block, "the taper is still on at the end")
                    .help("switch it off (G50) on the lead-out; the next program would begin tilted"),
            );
        }
    }
}
