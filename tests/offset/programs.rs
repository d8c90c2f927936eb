//! G-code with G41 and G42 to the wire's own path and on to 3B: the sample programs of every dialect.
//!
//! The oracle walks the wire's path by samples: the contour as programmed must lie square beside every one of them, at
//! the offset and on the other side, and nowhere nearer.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::io::Cursor;

use dripfeed::compensation::Compensated;
use dripfeed::formats::gcode::{Dialect, Motions};
use dripfeed::formats::three_b::motions::Motions as ThreeB;
use dripfeed::formats::three_b::write::{Form, Writer};
use dripfeed::formats::{ReadError, Writer as _};
use dripfeed::geometry::offset::Corners;
use dripfeed::geometry::{Element, Point};
use dripfeed::interpolator::Model;
use dripfeed::motion::runs::ContourError;
use dripfeed::motion::{Act, Motion, Offset, Side, Travel};
use dripfeed::place::Spot;
use dripfeed::rounding::Aim;

use crate::measure::{distance_from, samples};

/// A micron.
const UM: f64 = 1e-3;

const SAMPLES: [(&str, &str); 8] = [
    ("generic", "generic"),
    ("fanuc", "fanuc"),
    ("charmilles", "charmilles"),
    ("sodick", "sodick"),
    ("mitsubishi", "mitsubishi"),
    ("agie", "agie"),
    ("integer-um", "integer-um"),
    ("integer-um-91", "integer-um"),
];

fn read(name: &str, dialect: &str) -> Vec<Motion> {
    let text = std::fs::read(format!("tests/data/dialects/{name}.nc")).unwrap();
    let dialect = Dialect::named(dialect).unwrap().unwrap();
    let read: Result<_, ReadError> = Motions::of_file(Cursor::new(text), dialect).unwrap().collect();
    read.unwrap()
}

fn wire(motions: &[Motion]) -> Result<Vec<Motion>, ContourError> {
    let registers = (0..1000).map(|n| (n, BY)).collect::<BTreeMap<_, _>>();
    Compensated::new(motions.iter().cloned().map(Ok::<_, ReadError>), registers, Corners::Round).collect()
}

/// A contour under an offset.
struct Contour {
    elements: Vec<Element>,
    spots: Vec<Spot>,
    /// How far to its left the wire has to be, mm.
    left: f64,
}

impl Contour {
    /// Whether the wire on its way has the contour square beside it, and no nearer than that.
    fn is_beside(&self, way: &Element) -> bool {
        samples(way, 16).iter().all(|(point, normal)| {
            let foot = point - normal.coords * self.left;
            let off = distance_from(&self.elements, *point) - self.left.abs();
            distance_from(&self.elements, foot) < UM && off.abs() < UM
        })
    }
}

/// What the registers are told to hold, mm.
const BY: f64 = 0.137;

/// What is cut under an offset, without the moves that lead in.
fn contours(motions: &[Motion]) -> Vec<Contour> {
    let mut found: Vec<Contour> = Vec::new();
    let (mut on, mut led_in) = (false, false);
    for motion in motions {
        match motion.act {
            Act::Offset(Offset::On { side, distance, .. }) => {
                if !on {
                    // One program gives its registers values of its own.
                    let by = distance.unwrap_or(BY);
                    let left = if side == Side::Left { by } else { -by };
                    found.push(Contour { elements: Vec::new(), spots: Vec::new(), left });
                    led_in = false;
                }
                on = true;
            }
            Act::Offset(Offset::Off) => on = false,
            Act::Move { element, .. } if on => {
                let contour = found.last_mut().unwrap();
                if led_in {
                    contour.elements.push(element);
                    contour.spots.push(motion.spot);
                }
                led_in = true;
            }
            _ => {}
        }
    }
    found
}

fn moves(motions: &[Motion]) -> impl Iterator<Item = (Spot, Element)> {
    motions.iter().filter_map(|motion| match motion.act {
        Act::Move { element, .. } => Some((motion.spot, element)),
        _ => None,
    })
}

#[test]
fn the_wire_of_every_dialects_sample_runs_beside_its_contours() {
    for (name, dialect) in SAMPLES {
        let said = read(name, dialect);
        let contours = contours(&said);
        assert!(!contours.is_empty(), "{name} has no offset");
        let made = wire(&said).unwrap();
        let mut judged = 0;
        for (spot, way) in moves(&made) {
            let own: Vec<_> = contours.iter().filter(|contour| contour.spots.contains(&spot)).collect();
            judged += usize::from(!own.is_empty());
            // A subprogram is called for several contours, or for one with several offsets.
            let fits = own.iter().any(|contour| contour.is_beside(&way));
            assert!(fits || own.is_empty(), "{name}: no contour is beside {way:?} of {spot:?}");
        }
        assert!(judged >= contours.len(), "{name}: {judged}");
        // The way has no gap, and ends where the program ends.
        for pair in moves(&made).collect::<Vec<_>>().windows(2) {
            assert!((pair[0].1.end() - pair[1].1.start()).norm() < 1e-9, "{name}: {pair:?}");
        }
        assert_eq!(moves(&made).last().unwrap().1.end(), moves(&said).last().unwrap().1.end(), "{name}");
    }
}

#[test]
fn nothing_else_a_sample_says_is_lost_or_moved() {
    let others = |motions: &[Motion]| -> Vec<Motion> {
        let is_other = |motion: &&Motion| !matches!(motion.act, Act::Move { .. } | Act::Offset(_));
        motions.iter().filter(is_other).cloned().collect()
    };
    for (name, dialect) in SAMPLES {
        let said = read(name, dialect);
        let made = wire(&said).unwrap();
        assert!(!made.iter().any(|motion| matches!(motion.act, Act::Offset(_))), "{name}");
        assert_eq!(others(&made), others(&said), "{name}");
        let (before, after) = (in_words(&said), in_words(&made));
        // Each is still said before the same block cuts.
        for (told, block) in &before {
            assert!(after.contains(&(told.clone(), *block)), "{name}: {told} was before {block:?}");
        }
    }
}

/// What is said, with the spot of the next move behind it.
fn in_words(motions: &[Motion]) -> Vec<(String, Option<Spot>)> {
    let mut next = None;
    let mut told = Vec::new();
    for motion in motions.iter().rev() {
        match &motion.act {
            Act::Move { .. } => next = Some(motion.spot),
            Act::Offset(_) => {}
            other => told.push((format!("{other:?}"), next)),
        }
    }
    told
}

#[test]
fn the_wire_of_every_upright_sample_is_cut_by_its_3b() {
    for (name, dialect) in SAMPLES {
        // 3B has no taper; upright, these programs are what they are but for it.
        let upright = |mut motion: Motion| {
            if let Act::Move { upper, .. } = &mut motion.act {
                *upper = None;
            }
            (!matches!(motion.act, Act::Taper(_))).then_some(motion)
        };
        let said: Vec<Motion> = read(name, dialect).into_iter().filter_map(upright).collect();
        let made = wire(&said).unwrap();
        let mut writer = Writer::new(Form { aim: Aim::One(Model::Strict), ..Form::default() });
        let mut text = Vec::new();
        for motion in &made {
            writer.write(motion, &mut text).unwrap();
        }
        writer.finish(&mut text).unwrap();
        // Where the program begins with a way to its hole, 3B begins in the hole.
        let first = moves(&made).next().unwrap().1;
        let hole = writer.start_hole().unwrap_or(first.start());
        let blocks: Result<Vec<Motion>, ReadError> =
            ThreeB::of_three_b(text.as_slice(), Model::Strict).collect();
        let cut: Vec<Element> =
            moves(&blocks.unwrap()).map(|(_, element)| element.placed(0.0, 1.0, hole.coords)).collect();
        let ways: Vec<Element> = made
            .iter()
            .filter_map(|motion| match motion.act {
                Act::Move { element, travel, .. } => Some((element, travel)),
                _ => None,
            })
            .skip_while(|(element, travel)| *travel == Travel::Rapid && element.end() != hole)
            .map(|(element, _)| element)
            .collect();
        for point in cut.iter().flat_map(|element| samples(element, 16)).map(|(point, _)| point) {
            let off = distance_from(&ways, point);
            assert!(off < 2.0 * UM, "{name}: 3B is off by {off} at {point}");
        }
        let from = usize::from(writer.start_hole().is_some());
        for point in ways[from..].iter().filter(|w| w.length() > UM).flat_map(|w| samples(w, 16)).map(|s| s.0)
        {
            let off = distance_from(&cut, point);
            assert!(off < 2.0 * UM, "{name}: 3B leaves out {point} by {off}");
        }
        let end: Point = cut.last().unwrap().end();
        assert!((end - ways.last().unwrap().end()).norm() < 2.0 * UM, "{name}: 3B ends at {end}");
    }
}
