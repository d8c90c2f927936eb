//! What the cut of a 4B program consists of: the way in, the outline, the way out; and the side its flags tell.
//!
//! The side is where a positive offset puts the wire, seen in the direction of motion: `D` makes the radius of an arc
//! grow, so on one that turns left it is the right. Every arc of an outline tells the same. On an outline that encloses
//! something it is the outside.

use std::ops::Range;

use crate::geometry::{Element, Point, Sense, Vector, turn};
use crate::motion::runs::{Layout, MEET_MM, Run};
use crate::motion::{Flag, Side};

/// A run of the wire with its parts told apart.
#[derive(Debug)]
pub(super) struct Outlined {
    /// The elements that have a length, each with its motion's place in the run.
    pub(super) cuts: Vec<(usize, Element)>,
    /// Which of them are the outline; those before lead in, those behind lead out.
    pub(super) outline: Range<usize>,
    /// Whether the outline ends where it began.
    pub(super) closed: bool,
}

impl Outlined {
    /// The parts of a run.
    ///
    /// Where no outline comes back to where it began, the first move leads in if it is straight, and the last leads out
    /// if it is straight and leaves the outline at a corner.
    pub(super) fn of(run: &Run) -> Self {
        let cuts: Vec<(usize, Element)> = run.cuts().filter(|(_, element)| element.length() > 0.0).collect();
        let mut nodes: Vec<Point> = cuts.iter().map(|(_, element)| element.start()).collect();
        nodes.extend(cuts.last().map(|(_, element)| element.end()));
        let (count, layout) = (cuts.len(), Layout::of(&nodes));
        let is_line = |n: usize| matches!(cuts[n].1, Element::Line { .. });
        let (mut from, mut to) = (layout.lead_in, count - layout.lead_out);
        if !layout.closed && count > 1 {
            from = usize::from(is_line(0));
            if to - from > 1 && is_line(count - 1) && corner(&cuts[count - 2].1, &cuts[count - 1].1).is_some()
            {
                to -= 1;
            }
        }
        if layout.closed && (from, to) == (0, count) && count > 2 {
            // From the hole and back to it, and on round the outline a little farther than once.
            let on =
                |at: Point, cuts: &[(usize, Element)]| cuts.iter().any(|cut| cut.1.distance(at) <= MEET_MM);
            from = usize::from(is_line(0) && on(nodes[1], &cuts[2..]));
            to -= usize::from(is_line(count - 1) && on(nodes[count - 1], &cuts[..count - 2]));
        }
        // Arcs that lead in and out without a corner are set off like the outline.
        let is_arc = |n: usize| !is_line(n);
        while from > 0 && is_arc(from - 1) && corner(&cuts[from - 1].1, &cuts[from].1).is_none() {
            from -= 1;
        }
        while to < count && to > 0 && is_arc(to) && corner(&cuts[to - 1].1, &cuts[to].1).is_none() {
            to += 1;
        }
        let closed = from < to && (nodes[from] - nodes[to]).norm() <= MEET_MM;
        Self { cuts, outline: from..to, closed }
    }

    /// The elements of the outline.
    pub(super) fn elements(&self) -> impl Iterator<Item = Element> {
        self.cuts[self.outline.clone()].iter().map(|(_, element)| *element)
    }

    /// Whether nothing is cut but one straight line: a way, not an outline.
    pub(super) fn is_way(&self) -> bool {
        match self.cuts.as_slice() {
            [] => true,
            [(_, element)] => matches!(element, Element::Line { .. }),
            [_, _, ..] => false,
        }
    }

    /// The outside of a closed outline.
    pub(super) fn outside(&self) -> Option<Side> {
        let origin = self.elements().next().filter(|_| self.closed)?.start();
        let area: f64 = self.elements().map(|e| e.placed(0.0, 1.0, -origin.coords).doubled_area()).sum();
        Some(if area < 0.0 { Side::Left } else { Side::Right })
    }
}

/// Where a positive offset puts the wire, by an arc's flag.
pub(super) fn side_of(flag: Flag, sense: Sense) -> Side {
    match (flag, sense) {
        (Flag::D, Sense::CounterClockwise) | (Flag::DD, Sense::Clockwise) => Side::Right,
        (Flag::D, Sense::Clockwise) | (Flag::DD, Sense::CounterClockwise) => Side::Left,
    }
}

/// The flag that an arc has where a positive offset puts the wire on a side.
pub(super) fn flag_of(side: Side, sense: Sense) -> Flag {
    if side_of(Flag::D, sense) == side { Flag::D } else { Flag::DD }
}

/// The turn from one element to the next, radians, counter-clockwise positive; none where the way runs on without a
/// corner, to within what whole microns and a rounded drawing explain.
pub(super) fn corner(before: &Element, after: &Element) -> Option<f64> {
    let turned = turn(before.heading_at_end(), after.heading_at_start());
    (turned.abs() > allowed(before, after)).then_some(turned)
}

/// How far the headings of two neighbours may differ that run on, radians.
fn allowed(before: &Element, after: &Element) -> f64 {
    CORNER + LATTICE_MM * (1.0 / size(before) + 1.0 / size(after))
}

/// The first corner of an outline: the place of the element behind it, and the turn.
///
/// A piece of a few microns, as closing a contour to the micron takes, has no direction to speak of: what it turns as an
/// arc is reckoned, and the headings before and behind it are compared.
pub(super) fn first_corner(elements: &[Element], closed: bool) -> Option<(usize, f64)> {
    let (mut before, mut turned): (Option<&Element>, f64) = (None, 0.0);
    let again = if closed { elements.len() } else { 0 };
    for (n, element) in elements.iter().enumerate().chain(elements.iter().enumerate().take(again)) {
        if element.length() < SHORT_MM {
            turned += match element {
                Element::Arc { sense: Sense::Clockwise, .. } => -element.sweep(),
                Element::Line { .. } | Element::Arc { .. } => element.sweep(),
            };
            continue;
        }
        if let Some(before) = before {
            let (sin, cos) = libm::sincos(turned);
            let heading = before.heading_at_end();
            let heading = Vector::new(heading.x * cos - heading.y * sin, heading.x * sin + heading.y * cos);
            let turned = turn(heading, element.heading_at_start());
            if turned.abs() > allowed(before, element) {
                return Some((n, turned));
            }
        }
        (before, turned) = (Some(element), 0.0);
    }
    None
}

/// What is wrong with a corner, as it is told.
pub(super) fn told(corner: f64) -> String {
    format!(
        "a corner of {:.2}° before this block: only arcs take up an offset, and none is there",
        corner.abs().to_degrees()
    )
}

/// What to do about a corner.
pub(super) const CORNER_HELP: &str =
    "put an arc of at least the offset into the corner, tangent to both sides";

/// The length that fixes an element's direction, mm.
pub(super) fn size(element: &Element) -> f64 {
    let length = element.length();
    element.radius().map_or(length, |radius| radius.min(length)).max(f64::MIN_POSITIVE)
}

/// Headings that differ by less run on, radians: 0.1°. *Guess.*
const CORNER: f64 = 0.1 * std::f64::consts::PI / 180.0;
/// A shorter piece has no direction of its own, mm. *Guess.*
const SHORT_MM: f64 = 0.005;
/// How far whole microns move one end of an element against the other, mm.
const LATTICE_MM: f64 = 0.0015;
