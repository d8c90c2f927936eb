//! Motions into 4B: the outline as drawn, R and a flag on its arcs, the offset left to the control.
//!
//! Blocks are chosen as in 3B, from where the control really stands with no offset keyed in. A contour is held whole,
//! because only an outline that has come back tells convex from concave. The flags of a 4B source are kept, if they are
//! one another's; other arcs get theirs from the outline they enclose something with, an open one from the side of the
//! offset in the program. An offset in the program (G41, G42) is not written but told: [`Writer::keyed`] is what the
//! operator has to key in.
//!
//! Only arcs take up an offset, so a corner is refused with its place, or gets an arc where [`Form::corners`] asks for
//! one. What a 3B program cannot say of stops, ways and remarks, 4B cannot either: see [`crate::formats::three_b::write`].

use super::corners::rounded;
use super::outline::{CORNER_HELP, Outlined, corner, first_corner, flag_of, side_of, told};
use super::{Block, Fourth, Order, Ratio};
use crate::formats::losses::Losses;
use crate::formats::three_b::write as three_b;
use crate::formats::three_b::write::refusal;
use crate::formats::{WriteError, three_b as blocks};
use crate::geometry::{Element, Point};
use crate::motion::runs::{ContourError, Gatherer, Run};
use crate::motion::{Act, Flag, Motion, Offset, Side, Taper, Travel};
use crate::place::Spot;
use crate::units::{Micrometres, Position};

/// How a program is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Form {
    /// What 3B and 4B have in common.
    pub plain: three_b::Form,
    /// Where the flag stands.
    pub order: Order,
    /// The radius of an arc to be put into each corner, mm; none refuses corners.
    pub corners: Option<f64>,
}

/// What the control has to add to the outline of a program that had an offset in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToKey {
    /// Whether the wire runs outside the outline: F is positive.
    pub outside: bool,
    /// How far, mm, where the program says it and not a register of a control.
    pub distance: Option<f64>,
}

/// Writes 4B.
#[derive(Debug)]
pub struct Writer {
    form: Form,
    plain: three_b::Writer,
    gatherer: Gatherer,
    /// The offset in force.
    offset: Offset,
    /// What the first outline needs keyed in, and every other one too.
    keyed: Option<Option<ToKey>>,
    /// A ratio of taper for the next block.
    ratio: Option<(Ratio, Spot)>,
}

impl Writer {
    /// A writer at the start of a program.
    #[must_use]
    pub fn new(form: Form) -> Self {
        Self {
            form,
            plain: three_b::Writer::new(form.plain),
            gatherer: Gatherer::default(),
            offset: Offset::Off,
            keyed: None,
            ratio: None,
        }
    }

    /// What has to be keyed into the control, where the program had an offset in it.
    #[must_use]
    pub fn keyed(&self) -> Option<ToKey> {
        self.keyed.flatten()
    }

    /// What the format had no room for.
    #[must_use]
    pub fn lost(&self) -> &Losses {
        self.plain.lost()
    }

    /// The start hole, mm from the program's zero, where the way to it was left out.
    #[must_use]
    pub fn start_hole(&self) -> Option<Point> {
        self.plain.start_hole()
    }

    /// Blocks written.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.plain.blocks()
    }

    /// Where a control without an offset stands, µm from the program's zero.
    #[must_use]
    pub fn stands(&self) -> Position {
        self.plain.stands()
    }

    fn run(&mut self, run: &Run, text: &mut Vec<u8>) -> Result<(), WriteError> {
        let parts = Outlined::of(run);
        if parts.is_way() {
            return run.motions.iter().try_for_each(|motion| self.say(motion, text));
        }
        let pieces = self.outline(run, &parts, text)?;
        let (begins, ends) =
            (pieces.first().map(|p| p.element.start()), pieces.last().map(|p| p.element.end()));
        let (first, behind) = (parts.outline.start, parts.outline.end);
        let mut pieces = pieces.into_iter().peekable();
        let mut cuts = parts.cuts.iter().enumerate().peekable();
        for (n, motion) in run.motions.iter().enumerate() {
            let Some((cut, &(_, element))) = cuts.next_if(|(_, cut)| cut.0 == n) else {
                // A move without length takes no block.
                if !matches!(motion.act, Act::Move { .. }) {
                    self.say(motion, text)?;
                }
                continue;
            };
            if parts.outline.contains(&cut) {
                while let Some(piece) = pieces.next_if(|piece| piece.cut == cut) {
                    self.block(motion, piece.element, piece.flag, text)?;
                }
                continue;
            }
            // A corner arc where the outline begins moves its beginning.
            let start = ends.filter(|_| cut == behind).unwrap_or(element.start());
            let end = begins.filter(|_| cut + 1 == first).unwrap_or(element.end());
            let element = match element {
                Element::Line { .. } => Element::Line { start, end },
                arc @ Element::Arc { .. } if (start, end) == (arc.start(), arc.end()) => arc,
                Element::Arc { .. } => {
                    return Err(refusal(
                        "the outline begins in a corner to which an arc leads",
                        motion.spot,
                        "begin the outline where it has no corner, or lead to it on a straight line",
                    ));
                }
            };
            self.block(motion, element, flag(motion), text)?;
        }
        Ok(())
    }

    /// The outline as it is written, with its flags.
    fn outline(&mut self, run: &Run, parts: &Outlined, text: &mut Vec<u8>) -> Result<Vec<Piece>, WriteError> {
        let cuts = &parts.cuts[parts.outline.clone()];
        let motion = |n: usize| &run.motions[cuts[n].0];
        let elements: Vec<Element> = parts.elements().collect();
        let whole = match self.form.corners {
            Some(radius) => {
                let begins_in_corner = parts.closed
                    && parts.outline.start == 0
                    && corner(&elements[elements.len() - 1], &elements[0]).is_some();
                if begins_in_corner {
                    return Err(refusal(
                        "the outline begins in a corner, and no straight line leads to it",
                        motion(0).spot,
                        "begin the outline where it has no corner, or lead in",
                    ));
                }
                rounded(&elements, parts.closed, radius).map_err(|no_room| {
                    refusal(
                        format!("the corner before this block has no room for an arc of {radius} mm"),
                        motion(no_room.behind).spot,
                        "ask for a smaller corner arc",
                    )
                })?
            }
            None => elements.iter().copied().enumerate().collect(),
        };
        let drawn: Vec<Element> = whole.iter().map(|piece| piece.1).collect();
        if let Some((n, turned)) = first_corner(&drawn, parts.closed) {
            return Err(refusal(told(turned), motion(whole[n].0).spot, CORNER_HELP));
        }
        let offset = offset_on(run, cuts[0].0, self.offset);
        let outside = outside(run, parts, offset);
        self.key(offset, outside, motion(0), text)?;
        let mut pieces = Vec::with_capacity(whole.len());
        let mut before = None;
        for (n, element) in whole {
            // Behind an element stands the arc that rounds its corner.
            let own = flag(motion(n)).filter(|_| before.replace(n) != Some(n));
            let flag = match (element, outside) {
                (Element::Arc { sense, .. }, Some(side)) => Some(flag_of(side, sense)),
                (Element::Arc { .. }, None) => {
                    return Err(refusal(
                        "an arc of a contour that does not come back: whether it is convex cannot be told",
                        motion(n).spot,
                        "close the contour, or flag its arcs, or say the side of the wire with an offset",
                    ));
                }
                (Element::Line { .. }, _) => own,
            };
            if own.is_some() && own != flag {
                return Err(refusal(
                    "the flag of this arc puts the wire on the other side than those before it",
                    motion(n).spot,
                    "convex arcs of the outline are D, concave ones DD",
                ));
            }
            pieces.push(Piece { cut: parts.outline.start + n, element, flag });
        }
        Ok(pieces)
    }

    /// Tells what the control has to be keyed in, which is one thing for the whole program.
    fn key(
        &mut self,
        offset: Offset,
        outside: Option<Side>,
        first: &Motion,
        text: &mut Vec<u8>,
    ) -> Result<(), WriteError> {
        let wanted = match (offset, outside) {
            (Offset::On { side, distance, .. }, Some(outside)) => {
                let turned = distance.is_some_and(|distance| distance < 0.0);
                Some(ToKey { outside: (side == outside) != turned, distance: distance.map(f64::abs) })
            }
            (Offset::On { .. }, None) | (Offset::Off, _) => None,
        };
        match self.keyed {
            Some(keyed) if keyed == wanted => return Ok(()),
            Some(_) => {
                return Err(refusal(
                    "this contour needs another offset than those before it, and a 4B control holds one",
                    first.spot,
                    "write a program for each offset",
                ));
            }
            None => self.keyed = Some(wanted),
        }
        let Some(ToKey { outside, distance }) = wanted else { return Ok(()) };
        let (kind, sign, where_to) = if outside {
            ("offset, to be keyed in as +F: the wire outside", '+', "outside")
        } else {
            ("offset, to be keyed in as -F: the wire inside", '-', "inside")
        };
        self.plain.lose(kind, first.spot);
        let value = distance.map_or_else(|| "the register".to_owned(), |mm| format!("{mm:.3} mm"));
        self.plain.remark(format!(" key in F = {sign}{value}: the wire {where_to} ").as_bytes(), text);
        Ok(())
    }

    /// Writes what is no part of an outline.
    fn say(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        use crate::formats::Writer as _;
        match &motion.act {
            &Act::Move { element, upper: None, travel: Travel::Cut, flag } => {
                self.block(motion, element, flag, text)
            }
            &Act::Offset(offset) => {
                self.offset = offset;
                Ok(())
            }
            Act::Taper(Taper::On { .. }) => Err(refusal(
                "a 4B control is told its taper on its panel, not in the program",
                motion.spot,
                "leave the taper out, flag the lead-in D (positive) or DD (inverse), and key it in",
            )),
            Act::Word(word) => match word.strip_prefix(b"L").and_then(Ratio::parse) {
                Some(ratio) => {
                    self.ratio = Some((ratio, motion.spot));
                    Ok(())
                }
                None => self.plain.write(motion, text),
            },
            _ => self.plain.write(motion, text),
        }
    }

    /// Writes the blocks of an element.
    fn block(
        &mut self,
        motion: &Motion,
        element: Element,
        flag: Option<Flag>,
        text: &mut Vec<u8>,
    ) -> Result<(), WriteError> {
        let Act::Move { travel, upper, .. } = &motion.act else { return Ok(()) };
        if upper.is_some() {
            return Err(refusal(
                "4B has no numbers for the wire's upper end, and this motion gives it some",
                motion.spot,
                "cut the taper with the control's own taper, or leave the upper end out",
            ));
        }
        let ratio = self.ratio.take();
        let radius = match (element.radius(), ratio) {
            (Some(_), Some((_, spot))) => {
                return Err(refusal(
                    "a ratio of taper on an arc, where R stands in its place",
                    spot,
                    "write it on the straight line that leads in",
                ));
            }
            (Some(radius), None) => flag.map(|_| Fourth::Radius(Micrometres::nearest(radius))),
            (None, _) => ratio.map(|(ratio, _)| Fourth::Ratio(ratio)),
        };
        let (style, order) = (self.form.plain.style, self.form.order);
        // The first of several blocks carries what belongs to a line; every piece of an arc carries its own.
        let begun = std::cell::Cell::new(false);
        self.plain.travel(*travel, element, motion.spot, text, |&block, text| {
            let is_arc = matches!(block.motion, blocks::Motion::Arc(..));
            let carries = is_arc == element.radius().is_some() && (is_arc || !begun.replace(true));
            let (fourth, flag) = if carries { (radius, flag) } else { (None, None) };
            Block { block, fourth, flag }.write(style, order, text);
        })
    }
}

/// An element of an outline as it is written.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// The place of the cut it comes from, or behind which it rounds the corner.
    cut: usize,
    element: Element,
    flag: Option<Flag>,
}

impl crate::formats::Writer for Writer {
    fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        let (run, behind) =
            self.gatherer.give(motion.clone()).map_err(|error| as_write_error(error, motion))?;
        if let Some(run) = run {
            self.run(&run, text)?;
        }
        behind.map_or(Ok(()), |motion| self.say(&motion, text))
    }

    fn finish(&mut self, text: &mut Vec<u8>) -> Result<(), WriteError> {
        if let Some(run) = self.gatherer.finish() {
            self.run(&run, text)?;
        }
        if let Some((_, spot)) = self.ratio.take() {
            self.plain.lose("ratio of taper that has no block", spot);
        }
        self.plain.finish(text)
    }
}

/// The offset in force on a motion of a run, by what was in force before it.
fn offset_on(run: &Run, motion: usize, before: Offset) -> Offset {
    let said = run.motions[..motion].iter().rev().find_map(|motion| match motion.act {
        Act::Offset(offset) => Some(offset),
        _ => None,
    });
    said.unwrap_or(before)
}

/// Where a positive offset is to put the wire: where the source's flags say, else outside, else where the source has it.
fn outside(run: &Run, parts: &Outlined, offset: Offset) -> Option<Side> {
    let mut cuts = parts.cuts[parts.outline.clone()].iter();
    let flagged = cuts.find_map(|&(n, element)| match element {
        Element::Arc { sense, .. } => flag(&run.motions[n]).map(|flag| side_of(flag, sense)),
        Element::Line { .. } => None,
    });
    let by_offset = match offset {
        Offset::On { side, .. } => Some(side),
        Offset::Off => None,
    };
    flagged.or(parts.outside()).or(by_offset)
}

fn flag(motion: &Motion) -> Option<Flag> {
    match motion.act {
        Act::Move { flag, .. } => flag,
        _ => None,
    }
}

fn as_write_error(error: ContourError, motion: &Motion) -> WriteError {
    match error {
        ContourError::Contour { message, spot, help, .. } => WriteError { message, spot, help },
        ContourError::Read(error) => refusal(error.to_string(), motion.spot, "read it first"),
    }
}
