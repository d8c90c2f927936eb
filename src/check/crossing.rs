//! Where the wire's path crosses itself.
//!
//! A loop that a too large offset leaves in a corner, or a wrong number, makes the path cross itself, and what lies in the
//! loop is lost. Each ring is searched together with its way in, and each open cut: every element goes into the cells of a
//! grid it touches, and only elements that share a cell are intersected, lines and true arcs exactly ([`meet`]). A touch
//! is no crossing: neighbours meet at their node, a second pass lies on the first. Two stretches cross when each
//! leaves the other on the far side, at more than 1.1° or by more than 3 µm, which is what the lattice explains.
//!
//! Rings are not compared with each other: passes of one contour lie side by side. What the control adds by its
//! own offset is not in the path.

mod grid;
pub mod meet;

use super::Finding;
use super::contours::{CLOSED_MM, Held, Run};
use crate::geometry::{Element, Point, Vector};
use crate::motion::{Act, Motion, Travel};
use crate::place::Spot;

/// Two stretches of a path that cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cross {
    /// Where, mm.
    pub at: Point,
    /// The earlier element, by its index.
    pub earlier: usize,
    /// The later one.
    pub later: usize,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// All crossings, each once, at most [`FOUND_MAX`].
    All(Vec<Cross>),
    /// So much lies on one heap that the search was given up.
    GivenUp,
}

/// The most crossings of one contour that are collected.
pub const FOUND_MAX: usize = 1000;

/// A path's elements by index: the way in, then the ring.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<'a> {
    /// The way in; empty for none.
    pub lead: &'a [Held],
    /// The ring, or an open cut.
    pub ring: &'a [Held],
    /// Whether the ring's end is its start.
    pub is_closed: bool,
}

impl Stretch<'_> {
    fn count(&self) -> usize {
        self.lead.len() + self.ring.len()
    }

    fn held(&self, n: usize) -> &Held {
        if n < self.lead.len() { &self.lead[n] } else { &self.ring[n - self.lead.len()] }
    }

    /// The block of an element, and where it stands.
    pub(super) fn place(&self, n: usize) -> (u64, Spot) {
        let held = self.held(n);
        (held.block, held.spot)
    }

    fn element(&self, n: usize) -> &Element {
        &self.held(n).element
    }

    /// The element the path goes on with after one, or came from before it.
    fn after(&self, n: usize) -> Option<usize> {
        if n + 1 < self.count() { Some(n + 1) } else { self.is_closed.then_some(self.lead.len()) }
    }

    fn before(&self, n: usize) -> Option<usize> {
        if n == self.lead.len() && self.is_closed { Some(self.count() - 1) } else { n.checked_sub(1) }
    }
}

/// Searches a stretch for crossings.
#[must_use]
pub fn search(stretch: &Stretch<'_>) -> Found {
    let mut crosses: Vec<Cross> = Vec::new();
    let done = grid::pairs(stretch, |a, b| {
        if crosses.len() < FOUND_MAX {
            for at in meet::meet(stretch.element(a), stretch.element(b)).into_iter().flatten() {
                if crosses_at(stretch, a, b, at)
                    && !crosses.iter().any(|known| (known.at - at).norm() <= SAME_MM)
                {
                    crosses.push(Cross { at, earlier: a.min(b), later: a.max(b) });
                }
            }
        }
    });
    if !done {
        return Found::GivenUp;
    }
    crosses.sort_by_key(|cross| (cross.later, cross.earlier));
    Found::All(crosses)
}

/// Crossings nearer to each other than this, mm, are one, seen by two elements at their node.
const SAME_MM: f64 = 0.005;

/// A point nearer to an element's end than this, mm, is at the node.
const NODE_MM: f64 = 0.001;

/// The least angle of a crossing, as a sine: 1.1°.
const ANGLE_LEAST: f64 = 0.02;

/// How far stretches that cross at less than that must come apart on either side, mm.
const DEPTH_LEAST: f64 = 0.003;

/// Whether the path passes through itself where two of its elements meet.
fn crosses_at(stretch: &Stretch<'_>, a: usize, b: usize, at: Point) -> bool {
    let (first, second) = (stretch.element(a), stretch.element(b));
    let shared = [first.start(), first.end()].into_iter().any(|end| {
        let near = |other: Point| (other - end).norm() <= CLOSED_MM;
        (end - at).norm() <= SAME_MM && (near(second.start()) || near(second.end()))
    });
    if shared {
        // The common node of neighbours, or of the way in and the ring.
        return false;
    }
    let (Some(first_ways), Some(second_ways)) = (ways(stretch, a, at), ways(stretch, b, at)) else {
        return false;
    };
    interleave(first_ways, second_ways) || comes_apart(first, second)
}

/// The directions in which the path leaves a point: back where it came from, and on; none where it ends.
fn ways(stretch: &Stretch<'_>, n: usize, at: Point) -> Option<[Vector; 2]> {
    let element = stretch.element(n);
    if (element.end() - at).norm() <= NODE_MM {
        let next = stretch.element(stretch.after(n)?);
        return Some([-element.heading_at_end(), next.heading_at_start()]);
    }
    if (element.start() - at).norm() <= NODE_MM {
        let before = stretch.element(stretch.before(n)?);
        return Some([-before.heading_at_end(), element.heading_at_start()]);
    }
    let heading = match *element {
        Element::Line { .. } => element.heading_at_start(),
        Element::Arc { start, end, centre, sense } if at != centre => {
            Element::Arc { start: at, end: if end == at { start } else { end }, centre, sense }
                .heading_at_start()
        }
        Element::Arc { .. } => return None,
    };
    Some([-heading, heading])
}

/// Whether one path, seen as two ways out of a point, has the ways of another on its two sides.
fn interleave(path: [Vector; 2], other: [Vector; 2]) -> bool {
    let [Some(one), Some(two)] = other.map(|way| side(path, way)) else { return false };
    one != two
}

/// On which side of a path a way out of its point lies; none when it runs along it.
fn side([back, on]: [Vector; 2], way: Vector) -> Option<bool> {
    let along = |with: Vector| {
        let sine = with.x * way.y - with.y * way.x;
        sine.abs() < ANGLE_LEAST && with.dot(&way) > 0.0
    };
    if along(back) || along(on) {
        return None;
    }
    let left_of = |a: Vector, b: Vector| a.x * b.y - a.y * b.x > 0.0;
    // The left side of the path is what lies counter-clockwise from `on` before `back`.
    Some(if left_of(on, back) {
        left_of(on, way) && left_of(way, back)
    } else {
        left_of(on, way) || left_of(way, back)
    })
}

/// Whether two elements that cross at a small angle lie well apart on either side of the crossing.
fn comes_apart(first: &Element, second: &Element) -> bool {
    let apart = |end: Point| {
        let nearest = first.nearest(end);
        offset(first, nearest, end).or_else(|| {
            // The second reaches beyond the first: they are compared at the first one's end.
            let nearer = |p: Point| (p - end).norm();
            let (start, stop) = (first.start(), first.end());
            let last = if nearer(start) < nearer(stop) { start } else { stop };
            offset(first, last, second.nearest(last))
        })
    };
    match (apart(second.start()), apart(second.end())) {
        (Some(before), Some(after)) => before * after < 0.0 && before.abs().min(after.abs()) > DEPTH_LEAST,
        _ => false,
    }
}

/// How far a point lies to the left of an element, abreast of a point of it, mm; none when it is not abreast.
fn offset(element: &Element, on: Point, point: Point) -> Option<f64> {
    let heading = match *element {
        Element::Line { .. } => element.heading_at_start(),
        Element::Arc { end, centre, sense, .. } => {
            Element::Arc { start: on, end, centre, sense }.heading_at_start()
        }
    };
    let way = point - on;
    let left = heading.x * way.y - heading.y * way.x;
    (left.abs() >= 0.9 * way.norm()).then_some(left)
}

/// Searches runs, and watches the nodes where rings hang on.
#[derive(Debug, Default)]
pub(super) struct Crossing {
    /// The rings that hang on the chain, the last one perhaps not yet left.
    hung: Vec<Hung>,
    /// The ring before.
    last: Option<(Point, [Vector; 2])>,
}

/// The most hanging rings that are remembered.
const HUNG_MAX: usize = 64;

/// A ring that has closed on a path that came in, seen from their common node.
#[derive(Clone, Copy, Debug)]
struct Hung {
    at: Point,
    came: Vector,
    /// Back into the ring's last element, and on into its first.
    ring: [Vector; 2],
    /// How the path went on, with the block.
    went: Option<(Vector, u64, Spot)>,
}

impl Crossing {
    /// Looks at the first cut after a ring: it must leave the ring on the side it came from.
    pub(super) fn go_on(&mut self, motion: &Motion, tell: &mut impl FnMut(Finding)) {
        let Act::Move { travel, element, .. } = &motion.act else { return };
        let Some(hung) = self.hung.last_mut().filter(|hung| hung.went.is_none()) else { return };
        if *travel == Travel::Rapid || (element.start() - hung.at).norm() > CLOSED_MM {
            self.hung.pop();
            return;
        }
        let went = element.heading_at_start();
        hung.went = Some((went, motion.block, motion.spot));
        if interleave(hung.ring, [hung.came, went]) {
            tell(crossing(hung.at, motion.block, motion.spot, None));
            self.hung.pop();
        }
    }

    pub(super) fn see(&mut self, run: &Run<'_>, tell: &mut impl FnMut(Finding)) {
        let stretch = match *run {
            Run::Ring { lead, ring, .. } => Stretch { lead, ring, is_closed: true },
            Run::Rest { held, fresh, .. } => {
                self.last = None;
                self.hung.clear();
                Stretch { lead: &[], ring: &held[held.len() - fresh..], is_closed: false }
            }
            Run::Retrace(_) | Run::TooLong(_) => return,
        };
        let (Some(first), Some(last)) = (stretch.ring.first(), stretch.ring.last()) else { return };
        match search(&stretch) {
            Found::All(crosses) => {
                for cross in crosses {
                    let later = stretch.held(cross.later);
                    let earlier = stretch.held(cross.earlier).block;
                    tell(crossing(cross.at, later.block, later.spot, Some(earlier)));
                }
            }
            Found::GivenUp => tell(
                Finding::warning(
                    "not-checked",
                    first.spot,
                    first.block,
                    "the contour that begins here lies so thick that it was not searched for crossings",
                )
                .help("look at it with `dripfeed plot`"),
            ),
        }
        if stretch.is_closed {
            self.close(&stretch, first, last, tell);
        }
    }

    /// Looks at the nodes that a ring shares with the rings before it.
    fn close(&mut self, stretch: &Stretch<'_>, first: &Held, last: &Held, tell: &mut impl FnMut(Finding)) {
        let at = first.element.start();
        let ring = [-last.element.heading_at_end(), first.element.heading_at_start()];
        // A ring that hung on this one: its two passes through the node must not change sides.
        self.hung.retain(|hung| {
            let Some((went, block, spot)) = hung.went else { return true };
            let is_on_ring =
                stretch.ring[1..].iter().any(|held| (held.element.start() - hung.at).norm() <= CLOSED_MM);
            if is_on_ring && interleave([hung.came, hung.ring[1]], [hung.ring[0], went]) {
                tell(crossing(hung.at, block, spot, None));
            }
            !is_on_ring
        });
        // A ring right behind another, from the same node.
        if let Some((before, ways)) = self.last
            && stretch.lead.is_empty()
            && (before - at).norm() <= CLOSED_MM
            && interleave(ways, ring)
        {
            tell(crossing(at, first.block, first.spot, None));
        }
        self.last = Some((at, ring));
        if let Some(lead) = stretch.lead.last()
            && self.hung.len() < HUNG_MAX
        {
            self.hung.push(Hung { at, came: -lead.element.heading_at_end(), ring, went: None });
        }
    }
}

fn crossing(at: Point, block: u64, spot: Spot, earlier: Option<u64>) -> Finding {
    let whom = earlier.map_or_else(|| "itself".to_owned(), |earlier| format!("block {earlier}"));
    let message = format!("the path crosses {whom} at {:.3}, {:.3} mm", at.x, at.y);
    Finding::error("crossing", spot, block, message).help(
        "look at it with `dripfeed plot`; a loop in a corner means an offset larger than the corner allows",
    )
}

#[cfg(test)]
mod tests;
