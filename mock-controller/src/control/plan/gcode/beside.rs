//! G40, G41, G42: the wire beside the path, on the left or on the right.
//!
//! ```text
//!   ON ──G41, G42──▶ STARTING ──line──▶ LEADING ──line, arc──▶ ALONG ──G40──▶ LEAVING ──line──▶ ON
//! ```
//!
//! The line with or after G41 or G42 is the lead-in: it ends beside the start of the next element, square to it. The
//! line with or after G40 is the lead-out: it begins beside the end of the last and ends on the path. In between an
//! element is cut when the next has told where it ends: the control reads one motion ahead.
//!
//! Readings of this mock, unverified for any control: lead-in and lead-out must be lines; outside corners are gone round
//! on an arc, which belongs to the block before it; the side is not changed without G40.

use super::Fault;
use crate::control::plan::{Motion, Path};
use crate::outline::corner::{Corner, corner, shifted};
use crate::outline::{Element, Point, Shape, swept};

/// A motion of the program, or a piece of it as it is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) element: Element,
    pub(super) characters: usize,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Beside {
    /// The wire is on the path.
    #[default]
    On,
    /// Told which side, but not moved since.
    Starting { right: f64 },
    /// The lead-in waits for the next element.
    Leading { right: f64, line: Piece },
    /// An element waits for the next; `from` is where the wire begins it.
    Along { right: f64, held: Piece, from: Point },
    /// Told to return, but not moved since.
    Leaving,
}

impl Beside {
    pub(super) fn is_on(&self) -> bool {
        matches!(self, Beside::On)
    }

    /// G41, G42 after G40, with an offset: positive to the right.
    pub(super) fn start(&mut self, right: f64) {
        *self = Beside::Starting { right };
    }

    /// G40: what waits is cut to its own end.
    pub(super) fn finish(&mut self, out: &mut Vec<Motion>) -> Result<(), Fault> {
        match *self {
            Beside::On | Beside::Leaving => {}
            Beside::Starting { .. } => *self = Beside::On,
            Beside::Leading { line, .. } => {
                out.push(cut(&line, line.element.from, line.element.to));
                *self = Beside::On;
            }
            Beside::Along { right, held, from } => {
                out.push(cut(&held, from, beside(&held.element, right)?.to));
                *self = Beside::Leaving;
            }
        }
        Ok(())
    }

    /// Takes the next motion of the program; what can be cut goes to `out`.
    pub(super) fn take(&mut self, piece: Piece, out: &mut Vec<Motion>) -> Result<(), Fault> {
        let element = &piece.element;
        match *self {
            Beside::On => out.push(cut(&piece, element.from, element.to)),
            Beside::Leaving => {
                line_only(element, "the lead-out, after G40, is no line")?;
                out.push(cut(&piece, element.from, element.to));
                *self = Beside::On;
            }
            Beside::Starting { right } => {
                line_only(element, "the lead-in, after G41 or G42, is no line")?;
                *self = Beside::Leading { right, line: piece };
            }
            Beside::Leading { right, line } => {
                let from = beside(element, right)?.from;
                out.push(cut(&line, line.element.from, from));
                *self = Beside::Along { right, held: piece, from };
            }
            Beside::Along { right, held, from } => {
                let (ending, starting) = (beside(&held.element, right)?, beside(element, right)?);
                let next = match corner(&held.element, element, right, from) {
                    Corner::At(at) => {
                        out.push(cut(&held, from, at));
                        at
                    }
                    Corner::Around { to, turn, .. } => {
                        let centre = element.from;
                        let sweep = swept(centre, turn, ending.to, to, std::f64::consts::PI);
                        let round = Shape::Arc { centre, turn, sweep };
                        let then = Some(path(&round, ending.to, to));
                        out.push(Motion { then, ..cut(&held, from, ending.to) });
                        starting.from
                    }
                    Corner::Blocked => {
                        let found = "the offset neighbours of a corner do not meet: the wire is too thick";
                        return Err(Fault::new("interference", found));
                    }
                };
                *self = Beside::Along { right, held: piece, from: next };
            }
        }
        Ok(())
    }
}

fn beside(element: &Element, right: f64) -> Result<Element, Fault> {
    shifted(element, right).ok_or_else(|| {
        let radius = element.size();
        Fault::new(
            "radius",
            &format!("an arc of R {radius:.1} µm vanishes at an offset of {} µm", right.abs()),
        )
    })
}

fn line_only(element: &Element, found: &str) -> Result<(), Fault> {
    match element.shape {
        Shape::Line => Ok(()),
        Shape::Arc { .. } => Err(Fault::new("compensation", found)),
    }
}

/// A piece of the program between these two ends.
fn cut(piece: &Piece, from: Point, to: Point) -> Motion {
    let lower = path(&piece.element.shape, from, to);
    Motion { lower, then: None, upper: None, characters: piece.characters }
}

fn path(shape: &Shape, from: Point, to: Point) -> Path {
    match *shape {
        Shape::Line => Path::To(to.rounded()),
        Shape::Arc { centre, turn, sweep } => {
            let sweep = swept(centre, turn, from, to, sweep);
            Path::Round { centre: centre.rounded(), turn, sweep, to, ends: Some(to.rounded()) }
        }
    }
}
