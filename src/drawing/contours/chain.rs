//! Ends that meet, joined: first those that agree to a nanometre, then those within the joining distance.
//!
//! In this order a chain of pieces shorter than the joining distance stays a chain. Each end looks only into the cells
//! round it, so the work grows with the number of pieces and no faster.

use crate::drawing::finding::{Finding, Severity, named};
use crate::geometry::{Element, Point, Sense, Vector};

use super::grid::Grid;
use super::{Chain, GAP_TOLD, Piece};

/// Ends this close are the same point written twice, mm.
const SAME_POINT: f64 = 1e-6;
/// An open end this many joining distances from another is told together with it.
const NEARLY: f64 = 100.0;

/// What an end is joined to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Link {
    Open,
    To(u32),
    /// More than two ends meet here.
    Branch,
}

/// The chains of pieces, by their first piece; what stops a chain from being closed is reported.
pub(super) fn chain(
    pieces: Vec<Piece>,
    layers: &[String],
    join: f64,
    report: &mut Vec<Finding>,
) -> Vec<Chain> {
    let mut ends = Ends::of(&pieces);
    ends.link(&pieces, SAME_POINT.min(join), report);
    ends.link(&pieces, join, report);
    ends.tell_open(&pieces, layers, join, report);
    let mut pieces: Vec<Option<Piece>> = pieces.into_iter().map(Some).collect();
    let mut chains = Vec::new();
    for n in 0..pieces.len() {
        if pieces[n].is_some() {
            let (first, loops) = ends.first_of(n as u32);
            chains.push(ends.collect(first, loops, &mut pieces));
        }
    }
    chains
}

/// Both ends of every piece: 2n its start, 2n + 1 its end.
struct Ends {
    points: Vec<Point>,
    layers: Vec<u32>,
    links: Vec<Link>,
}

impl Ends {
    fn of(pieces: &[Piece]) -> Self {
        let points: Vec<Point> = pieces.iter().flat_map(|p| [p.start(), p.end()]).collect();
        let layers = pieces.iter().flat_map(|p| [p.layer; 2]).collect();
        // A piece that is closed is joined to itself.
        let links = (0..points.len() as u32).map(|end| {
            let other = end ^ 1;
            if points[end as usize] == points[other as usize] { Link::To(other) } else { Link::Open }
        });
        Self { links: links.collect(), points, layers }
    }

    /// Links ends that meet within a distance and are open yet.
    fn link(&mut self, pieces: &[Piece], within: f64, report: &mut Vec<Finding>) {
        let count = self.points.len();
        let mut groups: Vec<u32> = (0..count as u32).collect();
        let mut grid = Grid::new(within, count);
        for end in 0..count {
            if self.links[end] != Link::Open {
                continue;
            }
            for other in grid.near(self.points[end]) {
                // A piece no longer than the distance does not close on itself.
                let speck = other == end as u32 ^ 1 && is_speck(&pieces[end / 2], within);
                if self.layers[other as usize] == self.layers[end] && !speck {
                    unite(&mut groups, other, end as u32);
                }
            }
            grid.insert(self.points[end], end as u32);
        }
        let mut sizes = vec![0u32; count];
        let mut partner = vec![u32::MAX; count];
        let mut made = Vec::new();
        for end in 0..count as u32 {
            if self.links[end as usize] != Link::Open {
                continue;
            }
            let root = root_of(&mut groups, end) as usize;
            sizes[root] += 1;
            if sizes[root] == 2 {
                let first = partner[root];
                self.links[first as usize] = Link::To(end);
                self.links[end as usize] = Link::To(first);
                made.push((first, end));
            }
            partner[root] = partner[root].min(end);
        }
        self.branches(pieces, &mut groups, &sizes, report);
        for (first, end) in made {
            let (a, b) = (self.points[first as usize], self.points[end as usize]);
            let gap = (a - b).norm();
            if gap > GAP_TOLD && self.links[end as usize] == Link::To(first) {
                let message = format!("a gap of {gap:.4} mm is closed between {} and {}", named(a), named(b));
                report.push(
                    Finding::new(Severity::Warning, "gap-closed", message)
                        .help("draw the ends on one point, or set `join` smaller to leave the gap open")
                        .at(a)
                        .line(pieces[end as usize / 2].line),
                );
            }
        }
    }

    /// Takes groups of more than two ends apart again, and tells where they are.
    fn branches(&mut self, pieces: &[Piece], groups: &mut [u32], sizes: &[u32], report: &mut Vec<Finding>) {
        if sizes.iter().all(|&size| size <= 2) {
            return;
        }
        let mut told = std::collections::BTreeMap::<u32, Vec<u64>>::new();
        for end in 0..self.points.len() as u32 {
            let root = root_of(groups, end);
            if sizes[root as usize] > 2 {
                self.links[end as usize] = Link::Branch;
                told.entry(root).or_default().push(pieces[end as usize / 2].line);
            }
        }
        for (root, lines) in told {
            let at = self.points[root as usize];
            let shown: Vec<String> = lines.iter().take(4).map(u64::to_string).collect();
            let more = if lines.len() > 4 { ", …" } else { "" };
            let message = format!("{} ends meet at {}", lines.len(), named(at));
            report.push(
                Finding::new(Severity::Fault, "branch", message)
                    .help(format!(
                        "which way to cut is not clear: keep two of the entities on lines {}{more}, or draw the others \
                         on a layer of their own",
                        shown.join(", ")
                    ))
                    .at(at)
                    .line(lines[0]),
            );
        }
    }

    /// Tells of ends that are left open.
    fn tell_open(&self, pieces: &[Piece], layers: &[String], join: f64, report: &mut Vec<Finding>) {
        let open: Vec<u32> =
            (0..self.links.len() as u32).filter(|&end| self.links[end as usize] == Link::Open).collect();
        let mut grid = Grid::new(join * NEARLY, open.len());
        for &end in &open {
            grid.insert(self.points[end as usize], end);
        }
        for &end in &open {
            let at = self.points[end as usize];
            let distance = |other: u32| (self.points[other as usize] - at).norm();
            let beside = grid
                .near(at)
                .filter(|&other| {
                    other != end && !(other == end ^ 1 && is_speck(&pieces[end as usize / 2], join))
                })
                .min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            let line = pieces[end as usize / 2].line;
            let (message, help) = match beside {
                Some(other) => {
                    let there = self.points[other as usize];
                    let gap = distance(other);
                    let message = format!(
                        "an open end at {} is {gap:.4} mm from another at {}",
                        named(at),
                        named(there)
                    );
                    let layer = self.layers[other as usize];
                    let help = if layer == self.layers[end as usize] {
                        "draw the ends on one point, or set `join` larger".to_string()
                    } else {
                        let name = layers.get(layer as usize).map_or("", String::as_str);
                        format!("the other is on layer {name}: contours are joined within a layer only")
                    };
                    (message, help)
                }
                None => {
                    (format!("an open end at {}", named(at)), "the contour is cut as an open path".into())
                }
            };
            report.push(Finding::new(Severity::Warning, "open-end", message).help(help).at(at).line(line));
        }
    }

    /// The end to begin the chain of a piece with, and whether the chain is closed.
    fn first_of(&self, piece: u32) -> (u32, bool) {
        // Both ways along the chain; the one that meets the earlier piece next is the way it is drawn.
        let next = |end: u32| match self.links[end as usize] {
            Link::To(other) => Some(other),
            Link::Open | Link::Branch => None,
        };
        let start = 2 * piece;
        let neighbours = (next(start).map(|e| e / 2), next(start + 1).map(|e| e / 2));
        let mut entry = start;
        while let Some(other) = next(entry) {
            entry = other ^ 1;
            if entry == start {
                let backwards = matches!(neighbours, (Some(before), Some(after)) if before < after);
                return (if backwards { start + 1 } else { start }, true);
            }
        }
        let mut exit = start + 1;
        while let Some(other) = next(exit) {
            exit = other ^ 1;
        }
        let (from, to) = (entry / 2, exit / 2);
        // An open chain begins at the end whose piece is drawn first.
        (if to < from { exit } else { entry }, false)
    }

    /// Takes a chain's pieces and joins them.
    fn collect(&self, first: u32, loops: bool, pieces: &mut [Option<Piece>]) -> Chain {
        let mut chain: Option<Chain> = None;
        let mut enter = first;
        while let Some(piece) = pieces[enter as usize / 2].take() {
            let Piece { elements, layer, line, travel, .. } = piece;
            let forward = enter.is_multiple_of(2);
            let oriented: Box<dyn Iterator<Item = Element>> = if forward {
                Box::new(elements.into_iter())
            } else {
                Box::new(elements.into_iter().rev().map(Element::reversed))
            };
            match &mut chain {
                None => chain = Some(Chain { elements: oriented.collect(), layer, line, travel }),
                Some(chain) => {
                    let at = chain.elements.len();
                    chain.elements.extend(oriented);
                    chain.line = chain.line.min(line);
                    meet(&mut chain.elements, at - 1, at);
                }
            }
            match self.links[(enter ^ 1) as usize] {
                Link::To(next) => enter = next,
                Link::Open | Link::Branch => break,
            }
        }
        let mut chain = chain.unwrap_or(Chain {
            elements: Vec::new(),
            layer: 0,
            line: 0,
            travel: crate::motion::Travel::Cut,
        });
        match chain.elements.as_mut_slice() {
            // An arc whose ends meet is a circle.
            [only] if loops => *only = moved_end(*only, only.start()),
            [_, .., _] if loops => {
                let last = chain.elements.len() - 1;
                meet(&mut chain.elements, last, 0);
            }
            _ => {}
        }
        chain.elements.retain(|e| matches!(e, Element::Arc { .. }) || e.start() != e.end());
        chain
    }
}

/// Brings the end of one element and the start of another onto one point.
///
/// Ends that differ by more than a rounding meet half way.
fn meet(elements: &mut [Element], before: usize, after: usize) {
    let (p, q) = (elements[before].end(), elements[after].start());
    if p == q {
        return;
    }
    let joint = if (p - q).norm() <= SAME_POINT { p } else { p + (q - p) * 0.5 };
    elements[before] = moved_end(elements[before], joint);
    elements[after] = moved_end(elements[after].reversed(), joint).reversed();
}

/// An element with its end moved a little.
///
/// An arc keeps its shape: it is turned and stretched about its start, so no point of it moves farther than twice its end
/// does. One of more than half a circle keeps its centre instead, its end a little off the circle.
pub(super) fn moved_end(element: Element, to: Point) -> Element {
    match element {
        Element::Line { start, .. } => Element::Line { start, end: to },
        Element::Arc { start, end, centre, sense } => {
            let (chord, wanted) = (end - start, to - start);
            let way = end - to;
            let left = chord.x * (centre.y - start.y) - chord.y * (centre.x - start.x) >= 0.0;
            let minor = left == (sense == Sense::CounterClockwise);
            let centre = if minor && way.norm() > SAME_POINT && chord.norm_squared() > 0.0 {
                // The quotient of the chords, as complex numbers, turns and stretches.
                let by = Vector::new(
                    wanted.x * chord.x + wanted.y * chord.y,
                    wanted.y * chord.x - wanted.x * chord.y,
                ) / chord.norm_squared();
                let seen = centre - start;
                start + Vector::new(seen.x * by.x - seen.y * by.y, seen.x * by.y + seen.y * by.x)
            } else {
                centre
            };
            Element::Arc { start, end: to, centre, sense }
        }
    }
}

fn is_speck(piece: &Piece, within: f64) -> bool {
    let mut length = 0.0;
    piece.elements.iter().all(|e| {
        length += e.length();
        length <= 2.0 * within
    })
}

fn root_of(groups: &mut [u32], mut n: u32) -> u32 {
    while groups[n as usize] != n {
        groups[n as usize] = groups[groups[n as usize] as usize];
        n = groups[n as usize];
    }
    n
}

fn unite(groups: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root_of(groups, a), root_of(groups, b));
    groups[a.max(b) as usize] = a.min(b);
}
