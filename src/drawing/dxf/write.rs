//! Motions written as a drawing, one entity after another: ASCII DXF of release 12, which every program reads.
//!
//! Nothing is held: the head is written before the first motion, and extents, which only the end could tell, are left out.
//!
//! An arc of a DXF file runs counter-clockwise and carries no direction. What direction a program has is in the order:
//! every entity begins where the last one ended, the first at the origin, and the file says so in a remark. An arc is
//! written with the radius it has at its start, so the point where one entity ends is, to the last digit, where the next
//! begins, even where the two radii of an arc differ by a rounding. A circle would lose its start and sense: it begins
//! where the last entity ended, and a remark before it tells the sense when it is clockwise. A path that ends with an arc
//! tells its last point in a remark.
//!
//! Source: Autodesk, *DXF Reference*; the least a release 12 file needs is HEADER, TABLES with the layers, ENTITIES.

use std::fmt::Write as _;

use crate::formats::{WriteError, Writer};
use crate::geometry::{Element, Point, Sense, Vector};
use crate::motion::{Act, Motion, Offset, Side, Stop, Taper, Travel};

/// The layer of what is cut.
pub const CUT: &str = "CUT";
/// The layer of positioning.
pub const RAPID: &str = "RAPID";
/// The layer of the ways of the wire's upper end.
pub const UPPER: &str = "UPPER";

/// The remark that entities stand in cutting order.
pub(super) const IN_ORDER: &str =
    "entities in cutting order, each begun where the last one ended, the first at 0,0";
/// The remark before a circle that is run clockwise.
pub(super) const CLOCKWISE: &str = "clockwise";
/// What the remark with the last point of a program begins with.
pub(super) const ENDS_AT: &str = "ends at ";

/// Writes motions as a drawing.
#[derive(Clone, Debug, Default)]
pub struct DxfWriter {
    begun: bool,
    finished: bool,
    last: Option<Element>,
}

impl DxfWriter {
    /// A drawing with nothing in it yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn begin(&mut self, text: &mut Vec<u8>) {
        if self.begun {
            return;
        }
        self.begun = true;
        let mut head = String::new();
        let _ = write!(
            head,
            "999\n{IN_ORDER}\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n4\n9\n$MEASUREMENT\n70\n1\n\
             0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n70\n64\n3\nSolid\n72\n65\n\
             73\n0\n40\n0.0\n0\nENDTAB\n0\nTABLE\n2\nLAYER\n70\n4\n"
        );
        for (name, colour) in [("0", 7), (CUT, 1), (RAPID, 3), (UPPER, 5)] {
            let _ = write!(head, "0\nLAYER\n2\n{name}\n70\n64\n62\n{colour}\n6\nCONTINUOUS\n");
        }
        head.push_str("0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
        text.extend_from_slice(head.as_bytes());
    }

    fn element(&mut self, element: Element, layer: &str, text: &mut Vec<u8>) {
        let mut out = String::new();
        match element {
            Element::Line { start, end } => {
                let _ = write!(
                    out,
                    "0\nLINE\n8\n{layer}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n",
                    Mm(start.x),
                    Mm(start.y),
                    Mm(end.x),
                    Mm(end.y)
                );
            }
            Element::Arc { start, end, centre, sense } => {
                let radius = (start - centre).norm();
                if start == end {
                    if sense == Sense::Clockwise {
                        let _ = write!(out, "999\n{CLOCKWISE}\n");
                    }
                    let _ = write!(
                        out,
                        "0\nCIRCLE\n8\n{layer}\n10\n{}\n20\n{}\n40\n{}\n",
                        Mm(centre.x),
                        Mm(centre.y),
                        Mm(radius)
                    );
                } else {
                    let (from, to) = match sense {
                        Sense::CounterClockwise => (start, end),
                        Sense::Clockwise => (end, start),
                    };
                    let _ = write!(
                        out,
                        "0\nARC\n8\n{layer}\n10\n{}\n20\n{}\n40\n{}\n50\n{}\n51\n{}\n",
                        Mm(centre.x),
                        Mm(centre.y),
                        Mm(radius),
                        Mm(degrees(from - centre)),
                        Mm(degrees(to - centre))
                    );
                }
            }
        }
        text.extend_from_slice(out.as_bytes());
    }
}

impl Writer for DxfWriter {
    fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        self.begin(text);
        match &motion.act {
            Act::Move { travel, element, upper, .. } => {
                let layer = match travel {
                    Travel::Cut => CUT,
                    Travel::Rapid => RAPID,
                };
                if !is_finite(element) || upper.as_ref().is_some_and(|upper| !is_finite(upper)) {
                    return Err(WriteError {
                        message: "a coordinate is not finite".into(),
                        spot: motion.spot,
                        help: "a drawing holds finite numbers only".into(),
                    });
                }
                self.element(*element, layer, text);
                self.last = Some(*element);
                if let Some(upper) = upper {
                    self.element(*upper, UPPER, text);
                }
            }
            // A drawing has no room for what is no way: it stands in remarks.
            Act::Comment(words) | Act::Word(words) | Act::Unknown(words) | Act::Header(words) => {
                remark(words, text);
            }
            Act::Offset(Offset::Off) => remark(b"offset off", text),
            Act::Offset(Offset::On { side, distance, register }) => {
                let distance = distance.map_or(String::new(), |mm| format!(" {mm} mm"));
                let register = register.map_or(String::new(), |number| format!(" register {number}"));
                remark(format!("offset {}{distance}{register}", side_name(*side)).as_bytes(), text);
            }
            Act::Taper(Taper::Off) => remark(b"taper off", text),
            Act::Taper(Taper::On { side, angle }) => {
                remark(format!("taper {} {angle} degrees", side_name(*side)).as_bytes(), text);
            }
            Act::Stop(Stop::Pause) => remark(b"pause", text),
            Act::Stop(Stop::Optional) => remark(b"optional pause", text),
            Act::Stop(Stop::End) => remark(b"end", text),
            Act::Dwell(seconds) => remark(format!("dwell {seconds} s").as_bytes(), text),
        }
        Ok(())
    }

    fn finish(&mut self, text: &mut Vec<u8>) -> Result<(), WriteError> {
        if self.finished {
            return Ok(());
        }
        self.begin(text);
        self.finished = true;
        let mut end = String::new();
        if let Some(last @ Element::Arc { .. }) = self.last {
            let Point { coords, .. } = last.end();
            let _ = write!(end, "999\n{ENDS_AT}{} {}\n", Mm(coords.x), Mm(coords.y));
        }
        end.push_str("0\nENDSEC\n0\nEOF\n");
        text.extend_from_slice(end.as_bytes());
        Ok(())
    }
}

/// Appends a remark that does not pass for one of the file's own.
fn remark(words: &[u8], text: &mut Vec<u8>) {
    text.extend_from_slice(b"999\n; ");
    text.extend(words.iter().map(|&b| if b < b' ' { b' ' } else { b }));
    text.push(b'\n');
}

fn side_name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

fn is_finite(element: &Element) -> bool {
    let [low, high] = [element.start(), element.end()];
    let round = match element {
        Element::Line { .. } => true,
        Element::Arc { centre, .. } => centre.x.is_finite() && centre.y.is_finite(),
    };
    round && [low.x, low.y, high.x, high.y].iter().all(|v| v.is_finite())
}

/// The direction in degrees, counter-clockwise from +X, 0 to 360; exact on the axes.
fn degrees(v: Vector) -> f64 {
    match (v.x, v.y) {
        (x, 0.0) => {
            if x < 0.0 {
                180.0
            } else {
                0.0
            }
        }
        (0.0, y) => {
            if y < 0.0 {
                270.0
            } else {
                90.0
            }
        }
        (x, y) => {
            let angle = libm::atan2(y, x).to_degrees();
            if angle < 0.0 { angle + 360.0 } else { angle }
        }
    }
}

/// A number with all its digits and a point, so that it reads back as the same bits; never -0.
struct Mm(f64);

impl std::fmt::Display for Mm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let value = if self.0 == 0.0 { 0.0 } else { self.0 };
        if value.fract() == 0.0 { write!(f, "{value:.1}") } else { write!(f, "{value}") }
    }
}
