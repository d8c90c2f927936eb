//! A spline: a NURBS curve of any degree up to [`DEGREE_MAX`], with its knots as they are.
//!
//! Knots need not be clamped nor evenly spaced, so closed and periodic splines are no case of their own: the curve is
//! what the formula gives between the knots `degree` and `count of control points`. Points are weighted in homogeneous
//! coordinates and found by de Boor's scheme. It does not interpolate: which curve runs through given points is a
//! choice of the program that drew it.

use thiserror::Error;

use super::curve::Curve;
use super::{Point, Vector};

/// The highest degree that is evaluated; drawings use 1 to 5.
pub const DEGREE_MAX: usize = 15;
/// Powers lose as many digits as the weights differ by; beyond this de Boor's scheme is measured by instead.
const POWERS_WEIGHTS: f64 = 100.0;

/// A NURBS curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    degree: usize,
    knots: Vec<f64>,
    /// Control points times their weight, and the weight.
    controls: Vec<[f64; 3]>,
    seams: Vec<f64>,
    /// One for each span with a length, of a curve that is measured by them; else none.
    spans: Vec<Span>,
}

/// A span of degree 3 or less as powers of u, which goes from 0 to 1 in it.
#[derive(Clone, Debug, PartialEq)]
struct Span {
    from: f64,
    width: f64,
    /// The first point, from which the others are seen: far from the origin no digit is lost.
    origin: Point,
    x: [f64; 4],
    y: [f64; 4],
    w: [f64; 4],
}

/// Why numbers are no spline.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SplineError {
    /// The degree is 0 or too high.
    #[error("a spline of degree {0} is not one of degree 1 to {DEGREE_MAX}")]
    Degree(usize),
    /// Too few control points.
    #[error("a spline of degree {degree} has {found} control points, and needs at least {}", degree + 1)]
    Controls {
        /// The degree.
        degree: usize,
        /// How many control points there are.
        found: usize,
    },
    /// The number of knots does not fit.
    #[error("a spline with {controls} control points of degree {degree} has {found} knots, not {}", controls + degree + 1)]
    Knots {
        /// The degree.
        degree: usize,
        /// How many control points there are.
        controls: usize,
        /// How many knots there are.
        found: usize,
    },
    /// The knots fall, or the curve has no length in them.
    #[error("the knots of the spline fall at knot {0}")]
    KnotsFall(usize),
    /// All knots of the range are one.
    #[error("the knots of the spline span nothing")]
    KnotsSpanNothing,
    /// The number of weights does not fit.
    #[error("a spline with {controls} control points has {found} weights")]
    Weights {
        /// How many control points there are.
        controls: usize,
        /// How many weights there are.
        found: usize,
    },
    /// A weight is not positive.
    #[error("weight {0} of the spline is not positive")]
    Weight(usize),
    /// A number is not finite.
    #[error("a number of the spline is not finite")]
    NotFinite,
}

impl Spline {
    /// A spline of its numbers; no weights at all mean that all are equal.
    ///
    /// # Errors
    ///
    /// When the numbers do not make a curve.
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        controls: &[Point],
        weights: &[f64],
    ) -> Result<Self, SplineError> {
        if !(1..=DEGREE_MAX).contains(&degree) {
            return Err(SplineError::Degree(degree));
        }
        if controls.len() <= degree {
            return Err(SplineError::Controls { degree, found: controls.len() });
        }
        if knots.len() != controls.len() + degree + 1 {
            return Err(SplineError::Knots { degree, controls: controls.len(), found: knots.len() });
        }
        if !weights.is_empty() && weights.len() != controls.len() {
            return Err(SplineError::Weights { controls: controls.len(), found: weights.len() });
        }
        let numbers = controls.iter().flat_map(|p| [p.x, p.y]);
        if !numbers.chain(knots.iter().copied()).chain(weights.iter().copied()).all(f64::is_finite) {
            return Err(SplineError::NotFinite);
        }
        if let Some(at) = weights.iter().position(|&w| w <= 0.0) {
            return Err(SplineError::Weight(at));
        }
        if let Some(at) = knots.windows(2).position(|pair| pair[1] < pair[0]) {
            return Err(SplineError::KnotsFall(at + 1));
        }
        let (from, to) = (knots[degree], knots[controls.len()]);
        if from >= to {
            return Err(SplineError::KnotsSpanNothing);
        }
        let mut seams: Vec<f64> = knots[degree..controls.len()].to_vec();
        seams.dedup();
        seams.retain(|&t| from < t && t < to);
        let weight = |n: usize| weights.get(n).copied().unwrap_or(1.0);
        let controls = controls.iter().enumerate().map(|(n, p)| {
            let w = weight(n);
            [p.x * w, p.y * w, w]
        });
        let mut spline = Self { degree, knots, controls: controls.collect(), seams, spans: Vec::new() };
        let [lightest, heaviest] =
            weights.iter().fold([1.0_f64, 1.0], |[low, high], &w| [low.min(w), high.max(w)]);
        if degree <= 3 && heaviest <= POWERS_WEIGHTS * lightest {
            spline.spans = (degree..spline.controls.len()).filter_map(|span| spline.powers(span)).collect();
        }
        Ok(spline)
    }

    /// A span as powers, from its ends and the slopes there; none for one without a length.
    fn powers(&self, span: usize) -> Option<Span> {
        let [from, to] = [self.knots[span], self.knots[span + 1]];
        let width = to - from;
        if width <= 0.0 {
            return None;
        }
        let [(start, leaves), (end, arrives)] = [from, to].map(|t| self.evaluate_in(span, t));
        let origin = Point::new(start[0] / start[2], start[1] / start[2]);
        let powers = |axis: usize, origin: f64| {
            let seen = |p: [f64; 3]| p[axis] - origin * p[2];
            let (a, b) = (seen(start), seen(end));
            let (c, d) = (seen(leaves) * width, seen(arrives) * width);
            [a, c, 3.0 * (b - a) - 2.0 * c - d, 2.0 * (a - b) + c + d]
        };
        Some(Span { from, width, origin, x: powers(0, origin.x), y: powers(1, origin.y), w: powers(2, 0.0) })
    }

    /// The homogeneous point and its derivative.
    fn evaluate(&self, t: f64) -> ([f64; 3], [f64; 3]) {
        let (first, last) = (self.degree, self.controls.len() - 1);
        let t = t.clamp(self.knots[first], self.knots[last + 1]);
        // The span that holds t; the last one with length also holds its end.
        let mut span = first + self.knots[first + 1..=last].partition_point(|&knot| knot <= t);
        while span > first && self.knots[span] >= self.knots[span + 1] {
            span -= 1;
        }
        self.evaluate_in(span, t)
    }

    /// The same by the formula of one span.
    fn evaluate_in(&self, span: usize, t: f64) -> ([f64; 3], [f64; 3]) {
        match self.degree {
            2 => self.blended::<3>(span, t, 2),
            3 => self.blended::<4>(span, t, 3),
            degree => self.blended::<{ DEGREE_MAX + 1 }>(span, t, degree),
        }
    }

    /// De Boor's algorithm in room for `N` points, one more than the degree `p` or more.
    #[inline]
    fn blended<const N: usize>(&self, span: usize, t: f64, p: usize) -> ([f64; 3], [f64; 3]) {
        let mut d = [[0.0; 3]; N];
        d[..=p].copy_from_slice(&self.controls[span - p..=span]);
        let mut slope = [0.0; 3];
        for level in 1..=p {
            if level == p {
                let width = self.knots[span + 1] - self.knots[span];
                slope = std::array::from_fn(|axis| p as f64 * (d[p][axis] - d[p - 1][axis]) / width);
            }
            for j in (level..=p).rev() {
                let low = self.knots[span - p + j];
                let high = self.knots[span + 1 + j - level];
                let share = if high > low { (t - low) / (high - low) } else { 0.0 };
                d[j] = std::array::from_fn(|axis| d[j - 1][axis] * (1.0 - share) + d[j][axis] * share);
            }
        }
        (d[p], slope)
    }
}

impl Curve for Spline {
    fn range(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.controls.len()]]
    }

    fn point(&self, t: f64) -> Point {
        let ([x, y, w], _) = self.evaluate(t);
        Point::new(x / w, y / w)
    }

    fn sample(&self, t: f64) -> Point {
        let after = self.spans.partition_point(|span| span.from <= t);
        let Some(span) = self.spans.get(after.max(1) - 1) else { return self.point(t) };
        let u = (t - span.from) / span.width;
        let sum = |c: &[f64; 4]| c[0] + u * (c[1] + u * (c[2] + u * c[3]));
        let over = 1.0 / sum(&span.w);
        Point::new(span.origin.x + sum(&span.x) * over, span.origin.y + sum(&span.y) * over)
    }

    fn tangent(&self, t: f64) -> Vector {
        let ([x, y, w], [dx, dy, dw]) = self.evaluate(t);
        Vector::new((dx - x / w * dw) / w, (dy - y / w * dw) / w)
    }

    fn seams(&self) -> &[f64] {
        &self.seams
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(of: &[(f64, f64)]) -> Vec<Point> {
        of.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn a_quarter_circle_of_degree_two_is_round() {
        let weights = [1.0, 0.5_f64.sqrt(), 1.0];
        let controls = points(&[(5.0, 0.0), (5.0, 5.0), (0.0, 5.0)]);
        let arc = Spline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &controls, &weights).unwrap();
        for n in 0..=100 {
            let t = f64::from(n) / 100.0;
            let p = arc.point(t);
            assert!((p.coords.norm() - 5.0).abs() < 1e-14);
            assert!(arc.tangent(t).dot(&p.coords).abs() < 1e-12);
        }
    }

    #[test]
    fn a_single_span_is_a_bezier_curve_and_its_tangent_the_slope_of_it() {
        let controls = points(&[(0.0, 0.0), (1.0, 3.0), (4.0, -2.0), (6.0, 1.0), (5.0, 5.0), (0.0, 7.0)]);
        let mut knots = vec![2.0; 6];
        knots.extend([4.0; 6]);
        let curve = Spline::new(5, knots, &controls, &[]).unwrap();
        let binomial = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        let bernstein = |u: f64| {
            let power = |x: f64, n: usize| (0..n).fold(1.0, |product, _| product * x);
            controls.iter().enumerate().fold(Vector::zeros(), |sum, (n, p)| {
                sum + p.coords * (binomial[n] * power(u, n) * power(1.0 - u, 5 - n))
            })
        };
        for n in 0..=50 {
            let u = f64::from(n) / 50.0;
            assert!((curve.point(2.0 + 2.0 * u).coords - bernstein(u)).norm() < 1e-13);
            let h = 1e-6;
            let slope = (bernstein(u + h) - bernstein(u - h)) / (4.0 * h);
            assert!((curve.tangent(2.0 + 2.0 * u) - slope).norm() < 1e-7);
        }
    }

    #[test]
    fn knots_that_are_not_clamped_give_the_uniform_curve() {
        // A uniform cubic at a knot is (a + 4 b + c) / 6, with the direction c - a.
        let controls = points(&[(0.0, 0.0), (2.0, 5.0), (7.0, 4.0), (9.0, -3.0), (12.0, 1.0)]);
        let knots: Vec<f64> = (0..9).map(f64::from).collect();
        let curve = Spline::new(3, knots, &controls, &[]).unwrap();
        assert_eq!(curve.range(), [3.0, 5.0]);
        for (n, t) in [(0, 3.0), (1, 4.0), (2, 5.0)] {
            let [a, b, c] = [controls[n], controls[n + 1], controls[n + 2]];
            let expected = (a.coords + b.coords * 4.0 + c.coords) / 6.0;
            assert!((curve.point(t).coords - expected).norm() < 1e-14, "{t}");
            assert!((curve.tangent(t) - (c - a) / 2.0).norm() < 1e-14, "{t}");
        }
    }

    #[test]
    fn a_point_to_measure_by_is_the_point() {
        let controls: Vec<Point> =
            (0..9).map(|n| Point::new(4e5 + f64::from(n * n), f64::from(n * 7 % 5))).collect();
        let weights: Vec<f64> = (0..9).map(|n| [1.0, 0.3, 7.0, 20.0][n % 4]).collect();
        for degree in 1..=5 {
            // A double knot, and ends that are not clamped.
            let mut knots: Vec<f64> = (0..9 + degree + 1).map(|n| 0.7 * n as f64).collect();
            knots[degree + 2] = knots[degree + 1];
            for weights in [&weights[..], &[], &[5.0; 9]] {
                let curve = Spline::new(degree, knots.clone(), &controls, weights).unwrap();
                let [from, to] = curve.range();
                for n in 0..=1000 {
                    let t = from + (to - from) * f64::from(n) / 1000.0;
                    let off = (curve.sample(t) - curve.point(t)).norm();
                    assert!(off < 1e-9, "{off} at {t}, degree {degree}");
                }
            }
        }
    }

    #[test]
    fn numbers_that_make_no_curve_are_refused_with_the_reason() {
        let controls = points(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]);
        let refused = |degree, knots: &[f64], weights: &[f64]| {
            Spline::new(degree, knots.to_vec(), &controls, weights).unwrap_err().to_string()
        };
        assert_eq!(refused(0, &[], &[]), "a spline of degree 0 is not one of degree 1 to 15");
        assert_eq!(refused(3, &[], &[]), "a spline of degree 3 has 3 control points, and needs at least 4");
        assert_eq!(
            refused(2, &[0.0; 5], &[]),
            "a spline with 3 control points of degree 2 has 5 knots, not 6"
        );
        assert_eq!(
            refused(2, &[0.0, 0.0, 0.0, 1.0, 0.5, 1.0], &[]),
            "the knots of the spline fall at knot 4"
        );
        assert_eq!(refused(2, &[0.0; 6], &[]), "the knots of the spline span nothing");
        let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert_eq!(refused(2, &knots, &[1.0]), "a spline with 3 control points has 1 weights");
        assert_eq!(refused(2, &knots, &[1.0, 0.0, 1.0]), "weight 1 of the spline is not positive");
        assert_eq!(refused(2, &knots, &[1.0, f64::NAN, 1.0]), "a number of the spline is not finite");
    }
}
