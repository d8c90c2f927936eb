//! What is drawn in one class: true elements while there are few, thinned lines when there are many.
//!
//! A picture of a million blocks shows no more than one of fifty thousand points does. When a layer has more, the
//! tolerance is doubled and what has been kept is thinned again, so memory and the size of the picture are bounded however
//! long the program is. Tolerances add up to less than twice the last one.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hasher as _};

use crate::drawing::{Extent, Outline, Thinning, Turn};
use crate::geometry::{Element, Point, Sense};
use crate::units::Micrometres;

/// Elements or points of one class.
#[derive(Debug)]
pub(super) struct Layer {
    exact: Vec<Element>,
    /// Where among them the run in work begins.
    run_from: usize,
    seen: Seen,
    /// Once there are too many elements.
    thinned: Option<Thinned>,
    /// The outermost points: lowest and highest X, lowest and highest Y.
    outermost: Option<[Point; 4]>,
}

/// The most elements that are drawn as they are.
const EXACT_MAX: usize = 20_000;

impl Layer {
    pub(super) fn new() -> Self {
        Self { exact: Vec::new(), run_from: 0, seen: Seen::default(), thinned: None, outermost: None }
    }

    /// Draws an element; it goes on from the last one if it begins there.
    pub(super) fn add(&mut self, element: &Element) {
        self.reach(element);
        if let Some(thinned) = &mut self.thinned {
            thinned.add(element);
        } else if self.exact.len() < EXACT_MAX {
            self.exact.push(*element);
        } else {
            let thinned = self.thinned.insert(Thinned::new());
            for element in self.exact.drain(..) {
                thinned.add(&element);
            }
            thinned.add(element);
        }
    }

    /// Ends a run: the same run again is not drawn.
    pub(super) fn end_run(&mut self) {
        if let Some(thinned) = &mut self.thinned {
            thinned.end_run();
        } else if !self.seen.is_new(self.exact[self.run_from..].iter().flat_map(bits)) {
            self.exact.truncate(self.run_from);
        }
        self.run_from = self.exact.len();
    }

    /// The bounds of what has been drawn, mm.
    pub(super) fn extent(&self) -> Option<Extent> {
        Extent::of(self.outermost?.map(|point| [point.x, point.y]))
    }

    fn reach(&mut self, element: &Element) {
        let [min, max] = element.extent();
        let (start, end) = (element.start(), element.end());
        let mut outermost = self.outermost.unwrap_or([start; 4]);
        let centre = match *element {
            Element::Line { .. } => start,
            Element::Arc { centre, .. } => centre,
        };
        // Where an arc reaches farther than its ends, it is abreast of its centre.
        let with_x = |x: f64| [start, end].into_iter().find(|p| p.x == x).unwrap_or(Point::new(x, centre.y));
        let with_y = |y: f64| [start, end].into_iter().find(|p| p.y == y).unwrap_or(Point::new(centre.x, y));
        if min.x < outermost[0].x {
            outermost[0] = with_x(min.x);
        }
        if max.x > outermost[1].x {
            outermost[1] = with_x(max.x);
        }
        if min.y < outermost[2].y {
            outermost[2] = with_y(min.y);
        }
        if max.y > outermost[3].y {
            outermost[3] = with_y(max.y);
        }
        self.outermost = Some(outermost);
    }

    /// The runs, and how far they may be from what was added, µm.
    pub(super) fn finish(self) -> (Vec<Outline>, f64) {
        match self.thinned {
            Some(thinned) => {
                let (mut runs, off) = thinned.finish();
                // Sizes taken off the picture are those of the part, however coarse the line between.
                let dots = self.outermost.into_iter().flatten();
                runs.extend(dots.map(|p| Outline::from([p.x, p.y]).line_to([p.x, p.y])));
                (runs, off)
            }
            None => (outlines(&self.exact), 0.0),
        }
    }
}

/// An element's numbers.
fn bits(element: &Element) -> [u64; 7] {
    let pair = |p: Point| [p.x.to_bits(), p.y.to_bits()];
    let ([a, b], [c, d]) = (pair(element.start()), pair(element.end()));
    match *element {
        Element::Line { .. } => [a, b, c, d, 0, 0, 0],
        Element::Arc { centre, sense, .. } => {
            let [e, f] = pair(centre);
            [a, b, c, d, e, f, if sense == Sense::Clockwise { 1 } else { 2 }]
        }
    }
}

/// Runs that have been drawn, by a digest of their numbers.
#[derive(Debug, Default)]
struct Seen(HashSet<u64>);

/// So many runs are remembered; a program of more different ones draws a later one twice at worst.
const SEEN_MAX: usize = 100_000;

impl Seen {
    fn is_new(&mut self, numbers: impl Iterator<Item = u64>) -> bool {
        let mut hasher = DefaultHasher::new();
        numbers.for_each(|number| hasher.write_u64(number));
        let digest = hasher.finish();
        if self.0.len() < SEEN_MAX { self.0.insert(digest) } else { !self.0.contains(&digest) }
    }
}

/// Runs of elements that follow one another.
fn outlines(elements: &[Element]) -> Vec<Outline> {
    let plain = |p: Point| [p.x, p.y];
    let runs = elements.chunk_by(|a, b| a.end() == b.start());
    runs.map(|run| {
        let mut outline = Outline::from(plain(run[0].start()));
        for element in run {
            outline = match *element {
                Element::Line { end, .. } => outline.line_to(plain(end)),
                Element::Arc { end, centre, sense, .. } => {
                    let turn = match sense {
                        Sense::Clockwise => Turn::Clockwise,
                        Sense::CounterClockwise => Turn::CounterClockwise,
                    };
                    outline.arc_to(plain(end), plain(centre), turn)
                }
            };
        }
        outline
    })
    .collect()
}

/// Runs of points with a bounded number of points in all.
#[derive(Debug)]
pub(super) struct Thinned {
    tolerance_um: f64,
    runs: Vec<Vec<(i64, i64)>>,
    seen: Seen,
    kept: usize,
    current: Option<Thinning>,
    last: Option<(i64, i64)>,
}

/// The most points of a layer: some 0.6 MB in an SVG.
const POINTS_MAX: usize = 30_000;

/// Where thinning begins, µm: below what a picture shows.
pub(super) const FINEST_UM: f64 = 0.8;

impl Thinned {
    pub(super) fn new() -> Self {
        Self {
            tolerance_um: FINEST_UM,
            runs: Vec::new(),
            seen: Seen::default(),
            kept: 0,
            current: None,
            last: None,
        }
    }

    /// How far what is kept may be from what was added, µm.
    pub(super) fn tolerance_um(&self) -> f64 {
        self.tolerance_um
    }

    /// Begins a run at a point, unless the last one stands there.
    pub(super) fn go_to(&mut self, point: (i64, i64)) {
        if self.last != Some(point) {
            self.end_run();
            self.push(point);
        }
    }

    /// Goes on to a point.
    pub(super) fn push(&mut self, point: (i64, i64)) {
        let current = self.current.get_or_insert_with(|| Thinning::new(self.tolerance_um));
        current.push(point);
        self.last = Some(point);
        if self.kept + current.kept_count() > POINTS_MAX {
            self.end_run();
            while self.kept > POINTS_MAX / 2 {
                self.coarsen();
            }
            // The run goes on where it was cut.
            self.push(point);
        }
    }

    fn add(&mut self, element: &Element) {
        let lattice = |p: Point| (Micrometres::nearest(p.x).0, Micrometres::nearest(p.y).0);
        self.go_to(lattice(element.start()));
        let pieces = pieces(element, self.tolerance_um / 2.0);
        for piece in 1..pieces {
            self.push(lattice(element.at(f64::from(piece) / f64::from(pieces))));
        }
        self.push(lattice(element.end()));
    }

    /// Ends a run: the same run again is not drawn.
    pub(super) fn end_run(&mut self) {
        if let Some(run) = self.current.take() {
            let run = run.finish();
            if self.seen.is_new(run.iter().flat_map(|&(x, y)| [x as u64, y as u64])) {
                self.kept += run.len();
                self.runs.push(run);
            }
        }
        self.last = None;
    }

    /// Lets go the run in work.
    pub(super) fn forget_run(&mut self) {
        (self.current, self.last) = (None, None);
    }

    fn coarsen(&mut self) {
        self.tolerance_um *= 2.0;
        self.kept = 0;
        let tolerance = self.tolerance_um;
        self.runs.retain_mut(|run| {
            let mut thinning = Thinning::new(tolerance);
            run.iter().for_each(|&point| thinning.push(point));
            *run = thinning.finish();
            // A dot below the tolerance shows nothing.
            let is_dot = match run[..] {
                [a, b] => ((a.0 - b.0).abs() as f64).max((a.1 - b.1).abs() as f64) < tolerance,
                _ => run.len() < 2,
            };
            self.kept += if is_dot { 0 } else { run.len() };
            !is_dot
        });
    }

    pub(super) fn finish(mut self) -> (Vec<Outline>, f64) {
        self.end_run();
        let plain = |&(x, y): &(i64, i64)| [Micrometres(x).millimetres(), Micrometres(y).millimetres()];
        let outlines = self.runs.iter().filter_map(|run| Outline::through(run.iter().map(plain)));
        (outlines.collect(), 2.0 * self.tolerance_um)
    }
}

/// Into how many chords an element is cut so that none is farther from it than a tolerance, µm.
fn pieces(element: &Element, tolerance_um: f64) -> u32 {
    let Some(radius) = element.radius() else { return 1 };
    let sagitta = tolerance_um / 1000.0;
    // A chord over the angle a is off the circle by r (1 - cos(a / 2)), about r a² / 8.
    let angle = (8.0 * sagitta / radius.max(sagitta)).sqrt();
    (element.sweep() / angle).ceil().clamp(1.0, 10_000.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spiral(count: u32) -> impl Iterator<Item = Element> {
        let at = |n: u32| {
            let angle = f64::from(n) * 0.01;
            let (sin, cos) = libm::sincos(angle);
            Point::new(cos, sin) * (5.0 + angle / 10.0)
        };
        (0..count).map(move |n| Element::Line { start: at(n), end: at(n + 1) })
    }

    #[test]
    fn few_elements_stay_what_they_are() {
        let mut layer = Layer::new();
        let arc = Element::Arc {
            start: Point::new(1.0, 0.0),
            end: Point::new(0.0, 1.0),
            centre: Point::origin(),
            sense: Sense::CounterClockwise,
        };
        layer.add(&arc);
        layer.add(&Element::Line { start: Point::new(0.0, 1.0), end: Point::new(-3.0, 1.0) });
        layer.add(&Element::Line { start: Point::new(9.0, 9.0), end: Point::new(9.0, 8.0) });
        let (runs, off) = layer.finish();
        assert_eq!((runs.len(), off), (2, 0.0));
        let first = Outline::from([1.0, 0.0]).arc_to([0.0, 1.0], [0.0, 0.0], Turn::CounterClockwise);
        assert_eq!(runs[0], first.line_to([-3.0, 1.0]));
    }

    #[test]
    fn many_elements_become_bounded_runs_near_them() {
        let mut layer = Layer::new();
        let mut count = 0;
        for element in spiral(400_000) {
            layer.add(&element);
            count += 1;
        }
        assert_eq!(count, 400_000);
        let thinned = layer.thinned.as_ref().unwrap();
        let points: usize = thinned.runs.iter().map(Vec::len).sum();
        assert!(points <= POINTS_MAX, "{points}");
        let (runs, _) = layer.finish();
        let whole: f64 = spiral(400_000).map(|e| e.length()).sum();
        let drawn: f64 = runs.iter().map(Outline::length).sum();
        assert!((drawn / whole - 1.0).abs() < 0.01, "{drawn} of {whole} mm");
        let extent = runs.iter().map(Outline::extent).reduce(crate::drawing::Extent::united).unwrap();
        let own = spiral(400_000).flat_map(|e| e.extent()).map(|p| [p.x, p.y]);
        let own = crate::drawing::Extent::of(own).unwrap();
        for (drawn, own) in [(extent.min, own.min), (extent.max, own.max)] {
            assert!(
                (drawn[0] - own[0]).abs() < 0.001 && (drawn[1] - own[1]).abs() < 0.001,
                "{drawn:?} {own:?}"
            );
        }
    }

    #[test]
    fn a_part_repeated_is_drawn_once_and_as_finely() {
        // Few cuts, and more than are drawn as they are.
        for turns in [3, 20_000] {
            let mut layer = Layer::new();
            for _ in 0..turns {
                let round: Vec<_> = spiral(10).collect();
                round.iter().for_each(|element| layer.add(element));
                round.iter().rev().for_each(|element| layer.add(&element.reversed()));
                layer.end_run();
            }
            let (runs, off) = layer.finish();
            assert!(runs.len() == 1 && off == 0.0, "{turns}: {} runs, {off} µm", runs.len());
        }
    }

    #[test]
    fn arcs_are_cut_finely_enough() {
        for radius in [0.01, 1.0, 300.0] {
            let p = |x, y| Point::new(x, y);
            let arc = Element::Arc {
                start: p(radius, 0.0),
                end: p(0.0, -radius),
                centre: Point::origin(),
                sense: Sense::CounterClockwise,
            };
            let pieces = pieces(&arc, 0.4);
            for piece in 0..pieces {
                let [a, b] = [piece, piece + 1].map(|n| arc.at(f64::from(n) / f64::from(pieces)));
                let middle = a + (b - a) * 0.5;
                assert!(arc.distance(middle) < 0.000_41, "{radius}: {}", arc.distance(middle));
            }
        }
    }

    #[test]
    fn a_heap_of_dots_does_not_grow_for_ever() {
        let mut layer = Layer::new();
        for n in 0..200_000 {
            let at = Point::new(f64::from(n % 500), f64::from(n / 500));
            layer.add(&Element::Line { start: at, end: at + crate::geometry::Vector::new(0.01, 0.0) });
        }
        let points: usize = layer.thinned.as_ref().unwrap().runs.iter().map(Vec::len).sum();
        assert!(points <= POINTS_MAX + 2, "{points}");
    }
}
