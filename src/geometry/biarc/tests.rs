//! Curves with a formula, and their elements measured by dense sampling of both.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::*;
use crate::geometry::ellipse::Ellipse;
use crate::geometry::spline::Spline;
use crate::geometry::{Sense, Vector, turn};

/// A curve by two closures.
struct Formula<P, T> {
    range: [f64; 2],
    point: P,
    tangent: T,
    seams: Vec<f64>,
}

impl<P: Fn(f64) -> Point, T: Fn(f64) -> Vector> Curve for Formula<P, T> {
    fn range(&self) -> [f64; 2] {
        self.range
    }
    fn point(&self, t: f64) -> Point {
        (self.point)(t)
    }
    fn tangent(&self, t: f64) -> Vector {
        (self.tangent)(t)
    }
    fn seams(&self) -> &[f64] {
        &self.seams
    }
}

/// What dense sampling says of elements against their curve.
struct Measured {
    /// The farthest point of the curve from the elements, mm.
    curve_off: f64,
    /// The farthest point of the elements from the curve, mm.
    elements_off: f64,
    /// The largest turn at a joint, radians, beyond the rounding of coordinates.
    kink: f64,
}

fn measured(curve: &impl Curve, elements: &[Element]) -> Measured {
    let [from, to] = curve.range();
    let count = (elements.len() * 60).clamp(2000, 40_000);
    let samples: Vec<Point> =
        (0..=count).map(|n| curve.point(from + (to - from) * n as f64 / count as f64)).collect();
    let near = |p: Point| elements.iter().map(|e| e.distance(p)).fold(f64::INFINITY, f64::min);
    let curve_off = samples.iter().step_by(3).map(|&p| near(p)).fold(0.0, f64::max);
    let mut elements_off = 0.0_f64;
    for element in elements {
        for n in 0..=8 {
            let p = element.at(f64::from(n) / 8.0);
            let chords = samples.windows(2).map(|w| Element::Line { start: w[0], end: w[1] }.distance(p));
            elements_off = elements_off.max(chords.fold(f64::INFINITY, f64::min));
        }
    }
    // A direction is known no better than a coordinate's last digit over the length of the element that has it.
    let kink = elements
        .windows(2)
        .map(|w| {
            let blur = 1e-14 * w[0].end().coords.norm() / w[0].length().min(w[1].length());
            turn(w[0].heading_at_end(), w[1].heading_at_start()).abs() - blur
        })
        .fold(0.0, f64::max);
    Measured { curve_off, elements_off, kink }
}

fn joined(elements: &[Element]) -> bool {
    elements.windows(2).all(|w| w[0].end() == w[1].start())
}

/// The curve is kept to within the tolerance, and to 1e-9 rad where it is smooth.
fn kept(curve: &impl Curve, tolerance: f64) -> usize {
    let with = Fit { elements: Elements::Biarcs, ..Fit::within(tolerance) };
    let elements = fit(curve, &with).unwrap();
    assert!(joined(&elements));
    let [from, to] = curve.range();
    assert!((elements[0].start() - curve.point(from)).norm() < 1e-12);
    assert!((elements[elements.len() - 1].end() - curve.point(to)).norm() <= 1e-9);
    let found = measured(curve, &elements);
    let count = elements.len();
    assert!(found.curve_off <= tolerance * 1.0001, "{} mm in {count} elements", found.curve_off);
    assert!(found.elements_off <= tolerance * 1.5, "{} mm back in {count} elements", found.elements_off);
    assert!(found.kink < 1e-9, "{} rad in {count} elements", found.kink);
    count
}

fn sine(waves: f64) -> impl Curve {
    Formula {
        range: [0.0, waves * TAU],
        point: |t: f64| Point::new(t, libm::sin(t)),
        tangent: |t: f64| Vector::new(1.0, libm::cos(t)),
        seams: vec![],
    }
}

#[test]
fn a_spline_that_is_a_circle_becomes_one_arc() {
    let h = 0.5_f64.sqrt();
    let square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let controls: Vec<Point> =
        square.iter().map(|&(x, y)| Point::new(3.0 + 7.0 * f64::from(x), 7.0 * f64::from(y))).collect();
    let weights = [1.0, h, 1.0, h, 1.0, h, 1.0, h, 1.0];
    let knots = vec![0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0];
    let circle = Spline::new(2, knots, &controls, &weights).unwrap();
    let elements = fit(&circle, &Fit::within(0.001)).unwrap();
    assert_eq!(elements.len(), 1, "{elements:?}");
    let Element::Arc { start, end, centre, sense } = elements[0] else { panic!("{elements:?}") };
    assert!(start == end && sense == Sense::CounterClockwise);
    assert!((centre - Point::new(3.0, 0.0)).norm() < 1e-9);
}

#[test]
fn a_straight_curve_is_one_line_whatever_its_speed() {
    let controls: Vec<Point> = [0.0, 0.1, 0.2, 9.0].iter().map(|&s| Point::new(s, 2.0 * s)).collect();
    let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let straight = Spline::new(3, knots, &controls, &[]).unwrap();
    let elements = fit(&straight, &Fit::within(0.001)).unwrap();
    assert_eq!(elements, [Element::Line { start: Point::new(0.0, 0.0), end: Point::new(9.0, 18.0) }]);
}

#[test]
fn a_polyline_drawn_as_a_spline_keeps_its_corners() {
    let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)];
    let controls: Vec<Point> = corners.iter().map(|&(x, y)| Point::new(x, y)).collect();
    let knots = vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0];
    let spline = Spline::new(1, knots, &controls, &[]).unwrap();
    for elements in [Elements::Lines, Elements::Biarcs, Elements::Fewest] {
        let made = fit(&spline, &Fit { elements, ..Fit::within(0.001) }).unwrap();
        let ends: Vec<Point> = made.iter().map(Element::end).collect();
        assert_eq!(ends, controls[1..], "{elements:?}");
    }
}

#[test]
fn a_cusp_ends_one_arc_and_begins_another() {
    // A cycloid of two arches: a cusp at every multiple of a turn, two of them at the ends.
    let cycloid = Formula {
        range: [0.0, 2.0 * TAU],
        point: |t: f64| Point::new(t - libm::sin(t), 1.0 - libm::cos(t)),
        tangent: |t: f64| Vector::new(1.0 - libm::cos(t), libm::sin(t)),
        seams: vec![],
    };
    let elements = fit(&cycloid, &Fit::within(0.001)).unwrap();
    let found = measured(&cycloid, &elements);
    assert!(found.curve_off <= 0.001 && found.elements_off <= 0.0015 && joined(&elements));
    assert!((found.kink - PI).abs() < 0.02, "the cusp is kept: {}", found.kink);
    assert!(elements.len() < 80, "{}", elements.len());
    // The length of an arch is 8.
    let length: f64 = elements.iter().map(Element::length).sum();
    assert!((length - 16.0).abs() < 0.001, "{length}");
}

#[test]
fn a_corner_no_one_announced_is_found() {
    let cam = Formula {
        range: [-1.0, 2.0],
        point: |t: f64| Point::new(t, (t - 0.3).abs()),
        tangent: |t: f64| Vector::new(1.0, if t < 0.3 { -1.0 } else { 1.0 }),
        seams: vec![],
    };
    let elements = fit(&cam, &Fit::within(0.001)).unwrap();
    assert_eq!(elements.len(), 2, "{elements:?}");
    assert!((elements[0].end() - Point::new(0.3, 0.0)).norm() < 1e-9);
}

#[test]
fn fewest_is_never_more_than_either() {
    for (waves, tolerance) in [(0.4, 0.1), (0.4, 0.0001), (3.0, 0.3), (3.0, 0.001)] {
        let curve = sine(waves);
        let count = |elements| fit(&curve, &Fit { elements, ..Fit::within(tolerance) }).unwrap().len();
        let (lines, biarcs) = (count(Elements::Lines), count(Elements::Biarcs));
        assert_eq!(count(Elements::Fewest), lines.min(biarcs), "{lines} lines, {biarcs} biarcs");
    }
}

#[test]
fn biarcs_need_the_third_root_of_the_tolerance_and_lines_the_second() {
    let curve = sine(1.0);
    let count =
        |elements, tolerance| fit(&curve, &Fit { elements, ..Fit::within(tolerance) }).unwrap().len() as f64;
    let lines = count(Elements::Lines, 1e-6) / count(Elements::Lines, 1e-3);
    let biarcs = count(Elements::Biarcs, 1e-6) / count(Elements::Biarcs, 1e-3);
    assert!((28.0..36.0).contains(&lines), "{lines}");
    assert!((8.0..12.0).contains(&biarcs), "{biarcs}");
    // Close to the best there is: chords of equal error take the integral of the square root of the curvature.
    let best: f64 = (0..100_000)
        .map(|n| {
            let t = TAU * (f64::from(n) + 0.5) / 100_000.0;
            let speed2 = 1.0 + libm::cos(t) * libm::cos(t);
            (libm::sin(t).abs() / (speed2 * speed2.sqrt())).sqrt() * speed2.sqrt()
        })
        .sum::<f64>()
        * TAU
        / 100_000.0
        / 8e-3_f64.sqrt();
    let taken = count(Elements::Lines, 1e-3);
    assert!(taken < 1.1 * best + 2.0, "{taken} lines where {best} might do");
}

#[test]
fn a_radius_beyond_the_limit_is_a_line() {
    let curve = sine(2.0);
    let limited = Fit { elements: Elements::Biarcs, radius_max: 50.0, tolerance: 0.0001 };
    let elements = fit(&curve, &limited).unwrap();
    assert!(elements.iter().filter_map(Element::radius).all(|r| r <= 50.0));
    assert!(measured(&curve, &elements).curve_off <= 0.0001);
    let free = fit(&curve, &Fit { radius_max: f64::INFINITY, ..limited }).unwrap();
    assert!(free.iter().filter_map(Element::radius).any(|r| r > 50.0), "the limit has something to do");
}

#[test]
fn what_is_no_curve_is_refused() {
    let broken = |range, at: f64| Formula {
        range,
        point: move |t: f64| Point::new(t, if t > at { f64::NAN } else { 0.0 }),
        tangent: |_| Vector::new(1.0, 0.0),
        seams: vec![],
    };
    assert_eq!(fit(&broken([1.0, 1.0], 9.0), &Fit::within(0.1)), Err(FitError::Range(1.0, 1.0)));
    assert!(matches!(fit(&broken([0.0, 1.0], 0.5), &Fit::within(0.1)), Err(FitError::NotFinite(_))));
    assert_eq!(fit(&sine(1.0), &Fit::within(0.0)), Err(FitError::Tolerance(0.0)));
    assert_eq!(fit(&sine(30_000.0), &Fit::within(1e-10)), Err(FitError::TooMany));
}

#[test]
fn a_curve_of_any_size_is_followed_or_refused_in_little_time() {
    let sizes =
        [5e-324, 1e-200, 1e-155, 1e-40, 1e-13, 1e-10, 1e-7, 1e-3, 1.0, 1e4, 1e9, 1e16, 1e40, 1e155, 1e300];
    for a in sizes {
        for b in sizes {
            for centre in [0.0, 1e8, 1e150] {
                let curve = Ellipse::whole(Point::new(centre, 0.0), Vector::new(a, 0.0), Vector::new(0.0, b));
                for elements in [Elements::Lines, Elements::Biarcs] {
                    let fit = Fit { tolerance: 0.1, elements, radius_max: 99_999.0 };
                    match super::fit(&curve, &fit) {
                        Ok(made) => assert!(made.len() < 100_000, "{a} {b} {centre} {}", made.len()),
                        Err(
                            FitError::Far(_) | FitError::Lost(_) | FitError::TooMany | FitError::NotFinite(_),
                        ) => {}
                        Err(other) => panic!("{other}"),
                    }
                }
            }
        }
    }
}

#[test]
fn a_closed_curve_is_closed_to_the_bit() {
    let ellipse = Ellipse::whole(Point::new(0.1, 0.7), Vector::new(3.0, 1.0), Vector::new(-0.5, 1.5));
    let elements = fit(&ellipse, &Fit::within(0.001)).unwrap();
    assert_eq!(elements[0].start(), elements[elements.len() - 1].end());
    assert!(turn(elements[elements.len() - 1].heading_at_end(), elements[0].heading_at_start()).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn an_ellipse_of_any_ratio_is_kept(
        log_ratio in -4.0..0.0_f64, major in 0.5..60.0_f64, angle in 0.0..TAU,
        from in 0.0..TAU, sweep in 0.05..TAU, log_tolerance in -4.0..-1.5_f64,
    ) {
        let a = Vector::new(libm::cos(angle), libm::sin(angle)) * major;
        let b = Vector::new(-a.y, a.x) * libm::exp10(log_ratio);
        kept(&Ellipse::new(Point::new(12.0, -3.0), a, b, from, from + sweep), libm::exp10(log_tolerance));
    }

    #[test]
    fn a_spline_of_any_degree_and_weights_is_kept(
        degree in 2usize..=5,
        legs in prop::collection::vec((0.4..3.0_f64, -1.4..1.4_f64, 0.2..5.0_f64, 0.3..1.0_f64), 7..20),
        log_tolerance in -4.0..-2.0_f64,
    ) {
        // A way that never turns back on itself: control points with a cusp between them have their own test.
        let (mut at, mut heading, mut knot) = (Point::new(0.0, 0.0), 0.0, 0.0);
        let (mut controls, mut weights, mut knots) = (vec![at], vec![1.0], vec![]);
        for &(length, bend, weight, gap) in &legs {
            heading += bend;
            at += Vector::new(libm::cos(heading), libm::sin(heading)) * length;
            controls.push(at);
            weights.push(weight);
            knots.push(knot);
            knot += gap;
        }
        for _ in 0..=degree + 1 {
            knots.push(knot);
            knot += 0.7;
        }
        let spline = Spline::new(degree, knots[..controls.len() + degree + 1].to_vec(), &controls, &weights);
        kept(&spline.unwrap(), libm::exp10(log_tolerance));
    }

    #[test]
    fn sines_and_spirals_are_kept(waves in 0.1..6.0_f64, turns in 0.2..5.0_f64, log_tolerance in -5.0..-1.5_f64) {
        let tolerance = libm::exp10(log_tolerance);
        kept(&sine(waves), tolerance);
        let spiral = Formula {
            range: [0.5, 0.5 + turns * TAU],
            point: |t: f64| Point::new(t * libm::cos(t), t * libm::sin(t)),
            tangent: |t: f64| Vector::new(libm::cos(t) - t * libm::sin(t), libm::sin(t) + t * libm::cos(t)),
            seams: vec![],
        };
        kept(&spiral, tolerance);
        // An involute: it begins in a cusp on its base circle.
        let involute = Formula {
            range: [0.0, turns],
            point: |t: f64| Point::new(libm::cos(t) + t * libm::sin(t), libm::sin(t) - t * libm::cos(t)) * 8.0,
            tangent: |t: f64| Vector::new(t * libm::cos(t), t * libm::sin(t)),
            seams: vec![],
        };
        kept(&involute, tolerance);
    }

    #[test]
    fn any_bezier_curve_is_within_tolerance_cusps_and_all(
        controls in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 4..=6),
    ) {
        let controls: Vec<Point> = controls.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let mut knots = vec![0.0; controls.len()];
        knots.resize(2 * controls.len(), 1.0);
        let curve = Spline::new(controls.len() - 1, knots, &controls, &[]).unwrap();
        for elements in [Elements::Lines, Elements::Fewest] {
            let made = fit(&curve, &Fit { elements, ..Fit::within(0.001) }).unwrap();
            let found = measured(&curve, &made);
            prop_assert!(joined(&made) && found.curve_off <= 0.001 * 1.0001, "{}", found.curve_off);
            prop_assert!(found.elements_off <= 0.0015, "{} back", found.elements_off);
        }
    }
}
