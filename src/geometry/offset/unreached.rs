//! Which parts of a contour no outline runs beside.
//!
//! Every element of an outline covers a stretch of the contour. Between two stretches that follow one another, either
//! nothing is missing; or a sharp inside corner, which every wire fills; or a part the wire cannot enter, with whole
//! elements in it or as a throat between two half-covered ones.

use super::source::Source;
use super::{NEGLIGIBLE, ONE_POINT, Origin, Outline, Unreached};
use crate::geometry::{Element, Path, Point, sweep};

/// The inside corners filled, when a single outline runs beside every element of the contour in turn: nearly always.
pub(super) fn corners_of_whole(path: &Path, source: &Source, outlines: &[Outline]) -> Option<usize> {
    let [outline] = outlines else { return None };
    Contour { path, source, outlines }.corners_along(outline)
}

/// The parts not reached, in the order of the contour, and the number of inside corners filled.
pub(super) fn find(path: &Path, source: &Source, outlines: &[Outline]) -> (Vec<Unreached>, usize) {
    let contour = Contour { path, source, outlines };
    let (mut unreached, mut corners) = (Vec::new(), 0);
    for gap in contour.gaps() {
        if gap.is_corner {
            corners += usize::from(contour.is_filled(gap.portions[0].element, gap.nodes[0]));
        } else if contour.leaves_material(&gap) {
            unreached.push(contour.told(&gap));
        }
    }
    (unreached, corners)
}

struct Contour<'a> {
    path: &'a Path,
    source: &'a Source,
    outlines: &'a [Outline],
}

/// A stretch of an element that an outline runs beside.
#[derive(Clone, Copy)]
struct Stretch {
    element: usize,
    /// From where to where on the element, as fractions of its way.
    from: f64,
    to: f64,
    /// Which outline, and which of its elements.
    outline: usize,
    place: usize,
}

/// What lies between two stretches.
struct Gap {
    portions: Vec<Portion>,
    /// Where the wire is when the gap begins and ends; one of them, or none, at the ends of an open contour.
    nodes: Vec<Point>,
    /// Whether the wire turns from the one element straight to the next.
    is_corner: bool,
}

/// An element in a gap, from one fraction of its way to another.
#[derive(Clone, Copy)]
struct Portion {
    element: usize,
    from: f64,
    to: f64,
    is_whole: bool,
}

impl Contour<'_> {
    /// The corners filled by an outline that runs beside every element in turn; none where it does not.
    fn corners_along(&self, outline: &Outline) -> Option<usize> {
        let (mut corners, mut expected) = (0, 0);
        let ways = outline.path.elements();
        for (place, origin) in outline.origins.iter().enumerate() {
            let Origin::Element(element) = *origin else { continue };
            if element != expected {
                return None;
            }
            expected += 1;
            let next = outline.origins.get(place + 1).or_else(|| outline.origins.first());
            if !matches!(next, Some(Origin::Corner(_))) {
                corners += usize::from(self.is_filled(element, ways[place].end()));
            }
        }
        (expected == self.source.elements && outline.path.is_closed() == self.path.is_closed())
            .then_some(corners)
    }

    /// Whether more than a trace of the corner at the end of an element stays when the wire turns at `node`.
    fn is_filled(&self, element: usize, node: Point) -> bool {
        let is_inner = element + 1 < self.source.elements || self.path.is_closed();
        let corner = self.path.elements()[element].end();
        let most = self.source.left.abs() + NEGLIGIBLE;
        is_inner && (corner - node).norm_squared() > most * most
    }

    /// What lies between the stretches, where it is long enough to be anything.
    fn gaps(&self) -> Vec<Gap> {
        let stretches = self.stretches();
        let whole = |range: std::ops::Range<usize>| {
            range.filter(|&n| self.is_known(n)).map(|element| Portion {
                element,
                from: 0.0,
                to: 1.0,
                is_whole: true,
            })
        };
        let part = |element, from, to| Portion { element, from, to, is_whole: false };
        let all = self.source.elements;
        let (Some(first), Some(last)) = (stretches.first(), stretches.last()) else {
            return vec![Gap { portions: whole(0..all).collect(), nodes: Vec::new(), is_corner: false }];
        };
        let mut gaps = Vec::new();
        if !self.path.is_closed() {
            let head = whole(0..first.element).chain([part(first.element, 0.0, first.from)]);
            gaps.push(Gap {
                portions: head.collect(),
                nodes: vec![self.way(first).start()],
                is_corner: false,
            });
        }
        for pair in stretches.windows(2) {
            let (before, after) = (&pair[0], &pair[1]);
            let portions: Vec<_> = if before.element == after.element {
                vec![part(before.element, before.to, after.from)]
            } else {
                let between = whole(before.element + 1..after.element);
                [part(before.element, before.to, 1.0)]
                    .into_iter()
                    .chain(between)
                    .chain([part(after.element, 0.0, after.from)])
                    .collect()
            };
            gaps.push(self.gap(before, after, portions));
        }
        let tail = [part(last.element, last.to, 1.0)].into_iter().chain(whole(last.element + 1..all));
        if self.path.is_closed() {
            let round = tail.chain(whole(0..first.element)).chain([part(first.element, 0.0, first.from)]);
            gaps.push(self.gap(last, first, round.collect()));
        } else {
            gaps.push(Gap { portions: tail.collect(), nodes: vec![self.way(last).end()], is_corner: false });
        }
        gaps.retain(|gap| {
            gap.portions.iter().map(|portion| self.length(portion)).sum::<f64>() > 10.0 * ONE_POINT
        });
        gaps
    }

    fn gap(&self, before: &Stretch, after: &Stretch, portions: Vec<Portion>) -> Gap {
        let count = self.outlines[before.outline].origins.len();
        let follows = before.outline == after.outline && (before.place + 1) % count == after.place;
        let is_corner = follows && portions.len() == 2 && portions.iter().all(|portion| !portion.is_whole);
        Gap { portions, nodes: vec![self.way(before).end(), self.way(after).start()], is_corner }
    }

    /// Whether more than a trace of material stays between the gap's contour and the wire where the gap begins or ends.
    fn leaves_material(&self, gap: &Gap) -> bool {
        gap.portions.iter().any(|portion| {
            (0..=4).any(|n| {
                let point = self.at(portion, n as f64 / 4.0);
                let wire = gap.nodes.iter().map(|node| (node - point).norm()).fold(f64::INFINITY, f64::min);
                wire - self.source.left.abs() > NEGLIGIBLE
            })
        })
    }

    fn told(&self, gap: &Gap) -> Unreached {
        let half = gap.portions.iter().map(|portion| self.length(portion)).sum::<f64>() / 2.0;
        let mut passed = 0.0;
        let mut at = self.at(&gap.portions[0], 0.0);
        for portion in &gap.portions {
            let length = self.length(portion);
            if passed <= half && length > 0.0 {
                at = self.at(portion, ((half - passed) / length).min(1.0));
            }
            passed += length;
        }
        let ways = self.path.elements();
        let reaches = |portion: &Portion| self.source.reach_of(portion.element, &ways[portion.element]);
        let whole: Vec<_> = gap.portions.iter().filter(|portion| portion.is_whole).collect();
        let told = if whole.is_empty() { gap.portions.iter().collect() } else { whole };
        let largest = |reach: &dyn Fn(&Portion) -> f64| {
            told.iter().map(|portion| reach(portion)).fold(self.source.left.abs(), f64::min)
        };
        let own = |element: usize| gap.portions.iter().any(|portion| portion.element == element);
        let throat =
            |portion: &Portion| self.source.throat(&ways[portion.element], [portion.from, portion.to], &own);
        Unreached {
            at,
            first: told[0].element,
            last: told[told.len() - 1].element,
            largest: if told[0].is_whole { largest(&reaches) } else { largest(&throat) },
        }
    }

    /// The stretches of the contour that outlines run beside, in its order.
    fn stretches(&self) -> Vec<Stretch> {
        let mut stretches = Vec::new();
        for (outline, found) in self.outlines.iter().enumerate() {
            for (place, (way, origin)) in found.path.elements().iter().zip(&found.origins).enumerate() {
                let Origin::Element(element) = *origin else { continue };
                let source = &self.path.elements()[element];
                let mut add = |from, to| stretches.push(Stretch { element, from, to, outline, place });
                let (from, to) = (fraction_beside(source, way.start()), fraction_beside(source, way.end()));
                if way.start() == way.end() {
                    add(0.0, 1.0);
                } else if to < from && source.start() == source.end() {
                    add(from, 1.0);
                    add(0.0, to);
                } else {
                    add(from, to);
                }
            }
        }
        stretches.sort_by(|a, b| a.element.cmp(&b.element).then(a.from.total_cmp(&b.from)));
        stretches
    }

    fn way(&self, stretch: &Stretch) -> &Element {
        &self.outlines[stretch.outline].path.elements()[stretch.place]
    }

    /// Whether an element is long enough for the library to know it.
    fn is_known(&self, element: usize) -> bool {
        self.source.pieces.binary_search_by_key(&element, |piece| piece.element).is_ok()
    }

    fn length(&self, portion: &Portion) -> f64 {
        (portion.to - portion.from).max(0.0) * self.path.elements()[portion.element].length()
    }

    fn at(&self, portion: &Portion, fraction: f64) -> Point {
        self.path.elements()[portion.element].at(portion.from + (portion.to - portion.from) * fraction)
    }
}

/// Where on an element's way a point beside it stands, as a fraction.
fn fraction_beside(element: &Element, point: Point) -> f64 {
    match *element {
        Element::Line { start, end } => {
            let way = end - start;
            ((point - start).dot(&way) / way.norm_squared()).clamp(0.0, 1.0)
        }
        Element::Arc { start, centre, sense, .. } => {
            let whole = element.sweep();
            let turned = sweep(start - centre, point - centre, sense);
            // A point just behind the start has turned a whole circle.
            let behind = std::f64::consts::TAU - turned;
            if turned <= whole && behind > 1e-9 {
                turned / whole
            } else if turned - whole < behind && behind > 1e-9 {
                1.0
            } else {
                0.0
            }
        }
    }
}

#[cfg(test)]
mod tests;
