//! Thins a trace of pulses to the few points that a drawing needs.
//!
//! A machine moves by steps of a micrometre, and a cut of a metre is a million of them; no picture wants those.
//! Points come one at a time and are forgotten again, so a whole day of cutting takes no more memory than its result.
//!
//! From the last point kept, every dropped point leaves a wedge of directions in which a line still passes within the
//! tolerance of it. The intersection of the wedges narrows; a point inside it, at least as far out as all before
//! it, can end the line, and the farthest such point does when the wedge closes. (Zhao and Saalfeld's sleeve
//! fitting, 1997, with the ends kept on points of the trace.)
//!
//! It does not find the fewest points, and does not turn lines into arcs.

use std::collections::VecDeque;

/// Thins one trace; micrometres in and out.
#[derive(Clone, Debug)]
pub struct Thinning {
    tolerance: f64,
    kept: Vec<(i64, i64)>,
    /// The end of the line from the last kept point, when there is one; all before it are within the tolerance.
    end: Option<(i64, i64)>,
    /// Points after `end`, which it does not answer for.
    pending: VecDeque<(i64, i64)>,
    sleeve: Sleeve,
}

impl Thinning {
    /// Begins a trace whose points may be off by the given tolerance.
    ///
    /// The steps of a line by single pulses stray from it by less than 1.5 µm, so with that tolerance a line becomes a
    /// line again; with 0.8 µm it takes a few points, and with nought only points on straight runs go.
    #[must_use]
    pub fn new(tolerance_um: f64) -> Self {
        assert!(tolerance_um >= 0.0, "a tolerance of {tolerance_um} µm is no distance");
        Self {
            // A hair less, so that rounding in the wedges cannot exceed what was promised.
            tolerance: tolerance_um * (1.0 - 1e-9),
            kept: Vec::new(),
            end: None,
            pending: VecDeque::new(),
            sleeve: Sleeve::open(),
        }
    }

    /// Takes the next point of the trace.
    pub fn push(&mut self, point: (i64, i64)) {
        match self.kept.last() {
            None => self.kept.push(point),
            Some(&anchor) if self.end.is_none() && anchor == point => {} // Standing still leaves no trace.
            Some(&anchor) => {
                self.consider(anchor, point);
                if self.sleeve.is_closed() || self.pending.len() > PENDING_MAX {
                    self.end_line();
                }
            }
        }
    }

    /// How many points have been kept so far; those not yet decided on come on top.
    #[must_use]
    pub fn kept_count(&self) -> usize {
        self.kept.len()
    }

    /// Ends the trace and returns the points kept, the first and the last of the trace among them.
    #[must_use]
    pub fn finish(mut self) -> Vec<(i64, i64)> {
        while !self.pending.is_empty() {
            self.end_line();
        }
        self.kept.extend(self.end);
        self.kept
    }

    fn consider(&mut self, anchor: (i64, i64), point: (i64, i64)) {
        let apart = |to, from| (i128::from(to) - i128::from(from)) as f64;
        let way = [apart(point.0, anchor.0), apart(point.1, anchor.1)];
        match self.sleeve.admits(way) {
            true => {
                self.end = Some(point);
                self.pending.clear();
            }
            false => self.pending.push_back(point),
        }
        self.sleeve.narrow(way, self.tolerance);
    }

    /// Keeps the end of the line and begins the next one there with the points that are left.
    fn end_line(&mut self) {
        self.kept.extend(self.end.take());
        self.sleeve = Sleeve::open();
        for point in std::mem::take(&mut self.pending) {
            self.push(point);
        }
    }
}

/// How many points a line looks ahead for a better end. More give fewer points and cost as much time each.
const PENDING_MAX: usize = 32;

/// The directions from one point in which a line passes within the tolerance of all points so far.
#[derive(Clone, Copy, Debug)]
struct Sleeve {
    wedge: Wedge,
    /// The square of the farthest distance so far.
    reach: f64,
}

#[derive(Clone, Copy, Debug)]
enum Wedge {
    Any,
    Between { right: [f64; 2], left: [f64; 2] },
    Closed,
}

impl Sleeve {
    fn open() -> Self {
        Self { wedge: Wedge::Any, reach: 0.0 }
    }

    fn is_closed(&self) -> bool {
        matches!(self.wedge, Wedge::Closed)
    }

    /// Says whether a line may end at `way`: in an admitted direction and no nearer than any point before it.
    ///
    /// The distance matters when the trace turns back: a line that ended short of its farthest point would not cover
    /// that one.
    fn admits(&self, way: [f64; 2]) -> bool {
        square(way) >= self.reach && self.wedge.holds(way)
    }

    fn narrow(&mut self, way: [f64; 2], tolerance: f64) {
        let far = square(way);
        self.reach = self.reach.max(far);
        // A point this near is within the tolerance of every line that begins here.
        if far > tolerance * tolerance {
            self.wedge = self.wedge.met(Wedge::around(way, tolerance));
        }
    }
}

impl Wedge {
    /// The directions of lines from the origin that pass within the tolerance of a point farther away than that.
    fn around(way: [f64; 2], tolerance: f64) -> Self {
        let sine = tolerance / square(way).sqrt();
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let [x, y] = way;
        Self::Between {
            right: [x * cosine + y * sine, y * cosine - x * sine],
            left: [x * cosine - y * sine, y * cosine + x * sine],
        }
    }

    fn holds(self, way: [f64; 2]) -> bool {
        match self {
            Self::Any => true,
            Self::Closed => false,
            // The wedge of no tolerance is a ray, whose other side the products alone would let in.
            Self::Between { right, left } => {
                cross(right, way) >= 0.0 && cross(way, left) >= 0.0 && dot(way, right) + dot(way, left) >= 0.0
            }
        }
    }

    fn met(self, other: Self) -> Self {
        match (self, other) {
            (Self::Any, wedge) | (wedge, Self::Any) => wedge,
            (Self::Closed, _) | (_, Self::Closed) => Self::Closed,
            (Self::Between { right: r1, left: l1 }, Self::Between { right: r2, left: l2 }) => {
                let right = match (self.holds(r2), other.holds(r1)) {
                    (true, _) => r2,
                    (false, true) => r1,
                    (false, false) => return Self::Closed,
                };
                Self::Between { right, left: if self.holds(l2) { l2 } else { l1 } }
            }
        }
    }
}

fn square(way: [f64; 2]) -> f64 {
    dot(way, way)
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_staircase_of_hundreds_of_pulses_becomes_a_line() {
        let stairs = staircase(&[(0, 0), (400, 400)]);
        assert_eq!(stairs.len(), 801);
        assert_eq!(thinned(&stairs, 0.8), [(0, 0), (400, 400)]);
    }

    #[test]
    fn stairs_of_any_slope_become_a_few_points() {
        for slope in [(700, 1), (700, 13), (700, 233), (700, 500), (-311, 700), (17, -700)] {
            let stairs = staircase(&[(0, 0), slope]);
            let kept = thinned(&stairs, 1.5);
            assert_eq!(kept, [(0, 0), slope]);
            let kept = thinned(&stairs, 0.8);
            assert!(kept.len() <= 12, "{slope:?}: {} points", kept.len());
            assert_answers_for_all(&stairs, &kept, 0.8);
        }
    }

    #[test]
    fn every_point_dropped_lies_within_the_tolerance_of_the_line_that_replaces_it() {
        for seed in 1..40 {
            for tolerance in [0.0, 0.8, 1.5, 4.0, 25.0] {
                let walk = random_walk(seed, 600);
                assert_answers_for_all(&walk, &thinned(&walk, tolerance), tolerance);
            }
        }
    }

    #[test]
    fn a_round_trip_keeps_its_far_end() {
        let there_and_back = staircase(&[(0, 0), (300, 0), (0, 0)]);
        assert_eq!(thinned(&there_and_back, 1.0), [(0, 0), (300, 0), (0, 0)]);
    }

    #[test]
    fn a_corner_is_kept_within_the_tolerance() {
        let bent = staircase(&[(0, 0), (500, 0), (500, 300), (200, 300)]);
        assert_eq!(thinned(&bent, 0.5), [(0, 0), (500, 0), (500, 300), (200, 300)]);
        assert_answers_for_all(&bent, &thinned(&bent, 10.0), 10.0);
    }

    #[test]
    fn without_tolerance_only_points_on_straight_runs_go() {
        assert_eq!(thinned(&[(0, 0), (1, 0), (2, 0), (2, 1), (3, 1)], 0.0), [(0, 0), (2, 0), (2, 1), (3, 1)]);
    }

    #[test]
    fn short_traces_keep_their_ends() {
        assert_eq!(thinned(&[], 1.0), []);
        assert_eq!(thinned(&[(3, 4)], 1.0), [(3, 4)]);
        assert_eq!(thinned(&[(3, 4), (3, 4), (3, 4)], 1.0), [(3, 4)]);
        assert_eq!(thinned(&[(3, 4), (3, 5)], 1.0), [(3, 4), (3, 5)]);
        assert_eq!(thinned(&[(3, 4), (3, 5), (3, 4)], 1.0).last(), Some(&(3, 4)));
    }

    #[test]
    fn what_waits_for_a_decision_is_bounded() {
        let mut thinning = Thinning::new(50.0);
        for point in random_walk(7, 5000) {
            thinning.push(point);
            assert!(thinning.pending.len() <= PENDING_MAX);
        }
        assert_eq!(thinning.finish().first(), Some(&(0, 0)));
    }

    fn thinned(trace: &[(i64, i64)], tolerance_um: f64) -> Vec<(i64, i64)> {
        let mut thinning = Thinning::new(tolerance_um);
        trace.iter().for_each(|&point| thinning.push(point));
        thinning.finish()
    }

    /// Finds, in order, the kept points in the trace, and measures every point between two of them.
    fn assert_answers_for_all(trace: &[(i64, i64)], kept: &[(i64, i64)], tolerance: f64) {
        assert_eq!((kept.first(), kept.last()), (trace.first(), trace.last()));
        // The trace may pass a kept point more than once: some choice of passes has to satisfy all lines.
        let mut reached = vec![0];
        for line in kept.windows(2) {
            let mut next = Vec::new();
            for &from in &reached {
                for (to, point) in trace.iter().enumerate().skip(from) {
                    if distance_to(*point, line) > tolerance + 1e-6 {
                        break;
                    }
                    if *point == line[1] {
                        next.push(to);
                    }
                }
            }
            next.sort_unstable();
            next.dedup();
            reached = next;
            assert!(!reached.is_empty(), "{line:?} leaves a point out by more than {tolerance} µm");
        }
        assert!(reached.contains(&(trace.len() - 1)));
    }

    fn distance_to(point: (i64, i64), line: &[(i64, i64)]) -> f64 {
        let vector = |to: (i64, i64), from: (i64, i64)| [(to.0 - from.0) as f64, (to.1 - from.1) as f64];
        let (way, arm) = (vector(line[1], line[0]), vector(point, line[0]));
        let part = if square(way) > 0.0 { (dot(way, arm) / square(way)).clamp(0.0, 1.0) } else { 0.0 };
        square([arm[0] - way[0] * part, arm[1] - way[1] * part]).sqrt()
    }

    /// Walks from corner to corner by single pulses of one axis, as a control compares deviations.
    fn staircase(corners: &[(i64, i64)]) -> Vec<(i64, i64)> {
        let mut trace = vec![corners[0]];
        for leg in corners.windows(2) {
            let (dx, dy) = (leg[1].0 - leg[0].0, leg[1].1 - leg[0].1);
            let (mut x, mut y) = (0, 0);
            while (x, y) != (dx, dy) {
                if dx == x || (dy != y && (x.abs() * dy.abs()) > (y.abs() * dx.abs())) {
                    y += dy.signum();
                } else {
                    x += dx.signum();
                }
                trace.push((leg[0].0 + x, leg[0].1 + y));
            }
        }
        trace
    }

    /// A wandering trace from a small generator, the same on every machine.
    fn random_walk(seed: u64, steps: usize) -> Vec<(i64, i64)> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut point = (0, 0);
        let mut habit = 0;
        (0..steps)
            .map(|_| {
                let here = point;
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let throw = state >> 33;
                if throw.is_multiple_of(11) {
                    habit = throw / 11 % 8;
                }
                let way = if throw.is_multiple_of(3) { habit } else { (habit + throw % 2) % 8 };
                let (dx, dy) =
                    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)][way as usize];
                point = (point.0 + dx, point.1 + dy);
                here
            })
            .collect()
    }
}
