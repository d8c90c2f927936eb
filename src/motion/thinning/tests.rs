//! Thinned chains by dense sampling: how far either path strays from the other is measured again here, point by point.

use std::f64::consts::TAU;

use super::*;
use crate::motion::{Offset, Stop};
use crate::place::Spot;

#[test]
fn points_on_a_line_become_a_line() {
    let chain: Vec<Point> = (0..=500).map(|n| Point::new(f64::from(n) * 0.02, f64::from(n) * 0.01)).collect();
    let made = thin(&chain, 0.001, Made::LinesAndArcs);
    assert_eq!(made, [Element::Line { start: chain[0], end: chain[500] }]);
}

#[test]
fn a_corner_of_a_slot_becomes_a_few_arcs() {
    // Corner ① of the paper, by hundredths, in whole micrometres: a quarter of a circle of radius 7 about (20, 20).
    let chain: Vec<Point> = (0..=350)
        .map(|n| {
            let x = 27.0 - 0.02 * f64::from(n);
            micrometres(x, 20.0 + (49.0 - (x - 20.0) * (x - 20.0)).max(0.0).sqrt())
        })
        .collect();
    let arcs = thin(&chain, 0.002, Made::LinesAndArcs);
    // The first lines, where a hundredth along is half a millimetre up, are no arc within 2 µm.
    assert!(arcs.len() <= 8, "{} elements", arcs.len());
    let lines = thin(&chain, 0.002, Made::Lines);
    assert!(arcs.len() < lines.len() && lines.len() < 60, "{} lines", lines.len());
    assert_near(&chain, &arcs, 0.002);
    assert_near(&chain, &lines, 0.002);
    let radii = arcs.iter().filter_map(Element::radius);
    assert!(radii.clone().count() > 0);
    radii.for_each(|radius| assert!((radius - 7.0).abs() < 0.3, "{radius}"));
}

#[test]
fn every_path_is_within_the_tolerance_both_ways() {
    for seed in 1..=30 {
        for tolerance in [0.0005, 0.002, 0.01, 0.1] {
            let chain = curve(seed);
            for made in [Made::Lines, Made::LinesAndArcs] {
                let made = thin(&chain, tolerance, made);
                assert!(made.len() < chain.len(), "seed {seed}");
                assert_near(&chain, &made, tolerance);
            }
        }
    }
}

#[test]
fn random_walks_are_within_the_tolerance_too() {
    for seed in 1..=60 {
        let mut random = Random(seed);
        let mut at = Point::new(0.0, 0.0);
        let chain: Vec<Point> = std::iter::repeat_with(|| {
            at += crate::geometry::Vector::new(random.next() - 0.5, random.next() - 0.5) * 0.02;
            at
        })
        .take(300)
        .collect();
        for tolerance in [0.001, 0.01, 0.05] {
            assert_near(&chain, &thin(&chain, tolerance, Made::LinesAndArcs), tolerance);
        }
    }
}

#[test]
fn a_circle_is_cut_all_round_in_three_arcs() {
    let chain: Vec<Point> = (0..=720)
        .map(|n| {
            let (sine, cosine) = libm::sincos(TAU * f64::from(n % 720) / 720.0);
            micrometres(10.0 * cosine, 10.0 * sine)
        })
        .collect();
    let made = thin(&chain, 0.002, Made::LinesAndArcs);
    assert!(made.len() == 3, "{made:?}");
    assert!(made.iter().all(|element| element.sweep() < 0.5 * TAU));
    assert_eq!((made[0].start(), made.last().unwrap().end()), (chain[0], chain[0]));
    assert_near(&chain, &made, 0.002);
}

#[test]
fn a_way_back_is_not_swallowed() {
    let ways = [(0.0, 0.0), (10.0, 0.0), (5.0, 0.0), (12.0, 0.0), (0.0, 0.0)];
    let chain: Vec<Point> = ways.iter().map(|&(x, y)| Point::new(x, y)).collect();
    assert_eq!(thin(&chain, 0.01, Made::LinesAndArcs).len(), 4);
    let full_circle_back = [(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)].map(|(x, y)| Point::new(x, y));
    assert_eq!(thin(&full_circle_back, 0.01, Made::LinesAndArcs).len(), 2);
}

#[test]
fn corners_and_what_is_said_end_a_chain() {
    let stop = said(Act::Stop(Stop::Pause));
    let motions = vec![
        line((0.0, 0.0), (1.0, 0.0)),
        line((1.0, 0.0), (2.0, 0.0)),
        stop.clone(),
        line((2.0, 0.0), (3.0, 0.0)),
        line((3.0, 0.0), (4.0, 0.0)),
        line((4.0, 0.0), (4.0, 1.0)),
        line((4.0, 1.0), (4.0, 2.0)),
    ];
    let expected =
        [line((0.0, 0.0), (2.0, 0.0)), stop, line((2.0, 0.0), (4.0, 0.0)), line((4.0, 0.0), (4.0, 2.0))];
    assert_eq!(all(motions), expected);
}

#[test]
fn a_repeated_feed_says_nothing_and_another_one_does() {
    let feed = |text: &[u8]| said(Act::Word(text.into()));
    let motions = vec![
        feed(b"F200"),
        line((0.0, 0.0), (1.0, 0.0)),
        feed(b"F200"),
        line((1.0, 0.0), (2.0, 0.0)),
        feed(b"F100"),
        line((2.0, 0.0), (3.0, 0.0)),
        feed(b"C1"),
        feed(b"C1"),
    ];
    let expected = [
        feed(b"F200"),
        line((0.0, 0.0), (2.0, 0.0)),
        feed(b"F100"),
        line((2.0, 0.0), (3.0, 0.0)),
        feed(b"C1"),
        feed(b"C1"),
    ];
    assert_eq!(all(motions), expected);
}

#[test]
fn the_move_on_which_an_offset_comes_or_goes_stays_as_it_is() {
    let motions = vec![
        said(Act::Offset(Offset::On { side: crate::motion::Side::Left, distance: None, register: Some(1) })),
        line((0.0, 0.0), (1.0, 0.0)),
        line((1.0, 0.0), (2.0, 0.0)),
        line((2.0, 0.0), (3.0, 0.0)),
        said(Act::Offset(Offset::Off)),
        line((3.0, 0.0), (4.0, 0.0)),
        line((4.0, 0.0), (5.0, 0.0)),
    ];
    let mut expected = motions.clone();
    expected.splice(2..4, [line((1.0, 0.0), (3.0, 0.0))]);
    assert_eq!(all(motions), expected);
}

#[test]
fn rapids_arcs_and_tilted_lines_are_not_merged() {
    let (a, b, c) = (Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(2.0, 0.0));
    let element = |start, end| Element::Line { start, end };
    let upper = |start, end| {
        let (element, upper) = (element(start, end), Some(element(start, end)));
        said(Act::Move { travel: Travel::Cut, element, upper, flag: None })
    };
    let rapid = |start, end| {
        said(Act::Move { travel: Travel::Rapid, element: element(start, end), upper: None, flag: None })
    };
    for motions in [vec![upper(a, b), upper(b, c)], vec![rapid(a, b), rapid(b, c)]] {
        assert_eq!(all(motions.clone()), motions);
    }
}

#[test]
fn an_error_comes_behind_what_was_before_it() {
    let motions = [Ok(line((0.0, 0.0), (1.0, 0.0))), Ok(line((1.0, 0.0), (2.0, 0.0))), Err("broken")];
    let made: Vec<_> = thinned(motions.into_iter(), rule(0.01, Made::Lines)).collect();
    assert_eq!(made, [Ok(line((0.0, 0.0), (2.0, 0.0))), Err("broken")]);
}

#[test]
fn no_more_lines_are_held_than_stated() {
    let endless = (0..).map(|n: u32| {
        let x = |n: u32| f64::from(n) * 0.01;
        Ok::<_, ()>(line((x(n), libm::sin(x(n))), (x(n + 1), libm::sin(x(n + 1)))))
    });
    let mut thinned = thinned(endless, rule(1e-6, Made::LinesAndArcs));
    for _ in 0..20_000 {
        thinned.next().unwrap().unwrap();
        assert!(thinned.moves.len() < LINES_MAX && thinned.ready.len() < 2);
    }
}

fn rule(tolerance: f64, made: Made) -> Thinning {
    Thinning { tolerance, made, radius_max: 10_000.0 }
}

fn all(motions: Vec<Motion>) -> Vec<Motion> {
    let motions = motions.into_iter().map(Ok::<_, ()>);
    thinned(motions, rule(0.01, Made::LinesAndArcs)).map(Result::unwrap).collect()
}

/// The elements of a chain through points.
fn thin(chain: &[Point], tolerance: f64, made: Made) -> Vec<Element> {
    let motions =
        chain.windows(2).map(|pair| Ok::<_, ()>(line((pair[0].x, pair[0].y), (pair[1].x, pair[1].y))));
    thinned(motions, rule(tolerance, made))
        .map(|motion| match motion.unwrap().act {
            Act::Move { element, .. } => element,
            other => panic!("{other:?}"),
        })
        .collect()
}

fn line(from: (f64, f64), to: (f64, f64)) -> Motion {
    let element = Element::Line { start: Point::new(from.0, from.1), end: Point::new(to.0, to.1) };
    said(Act::Move { travel: Travel::Cut, element, upper: None, flag: None })
}

fn said(act: Act) -> Motion {
    Motion { act, block: 1, spot: Spot::default() }
}

/// A smooth curve of a few waves, its points in whole micrometres, its steps uneven, with a corner in it.
fn curve(seed: u64) -> Vec<Point> {
    let mut random = Random(seed);
    let waves: Vec<[f64; 3]> =
        (1..5).map(|n| [random.next() * 8.0 / f64::from(n), random.next() * TAU, f64::from(n)]).collect();
    let corner = random.next() * 5.0;
    let mut t = 0.0;
    let mut points = Vec::new();
    while t < 6.0 {
        let sum = |shift: f64| {
            waves.iter().map(|[size, phase, n]| size * libm::sin(n * t + phase + shift)).sum::<f64>()
        };
        let point = micrometres(sum(0.0), sum(1.3) + if t > corner { 3.0 * (t - corner) } else { 0.0 });
        if points.last() != Some(&point) {
            points.push(point);
        }
        t += 0.002 + 0.02 * random.next();
    }
    points
}

fn micrometres(x: f64, y: f64) -> Point {
    Point::new((x * 1000.0).round() / 1000.0, (y * 1000.0).round() / 1000.0)
}

/// Measures either path against the other, in order: each element is measured against the very lines it stands for, which end where it ends.
fn assert_near(chain: &[Point], made: &[Element], tolerance: f64) {
    let mut rest = chain;
    assert_eq!(made[0].start(), chain[0]);
    for element in made {
        // The chain may pass a point twice: the nearest count of lines that ends there and keeps to the tolerance is it.
        let stretches = (1..rest.len()).filter(|&n| rest[n] == element.end());
        let fitting =
            stretches.map(|n| (n, apart(&rest[..=n], element))).find(|(_, apart)| *apart <= tolerance + 1e-9);
        let Some((count, _)) = fitting else { panic!("{element:?} strays by more than {tolerance}") };
        rest = &rest[count..];
    }
    assert_eq!(rest.len(), 1, "the chain goes on");
}

/// The greatest distance of either from the other: eight places a line, and 400 an element.
fn apart(lines: &[Point], element: &Element) -> f64 {
    let mut most = 0.0_f64;
    for pair in lines.windows(2) {
        for n in 0..=8 {
            most = most.max(beside(pair[0] + (pair[1] - pair[0]) * (f64::from(n) / 8.0), element));
        }
    }
    for n in 0..=400 {
        most = most.max(distance(place(element, f64::from(n) / 400.0), lines));
    }
    most
}

/// A place of an element, by the share of it that has been run.
fn place(element: &Element, share: f64) -> Point {
    match *element {
        Element::Line { start, end } => start + (end - start) * share,
        Element::Arc { start, end, centre, sense } => {
            let sign = if sense == crate::geometry::Sense::Clockwise { -1.0 } else { 1.0 };
            let out = start - centre;
            let radius = out.norm();
            assert!(((end - centre).norm() - radius).abs() < 1e-9 * radius.max(1.0), "{element:?}");
            let (sine, cosine) = libm::sincos(sign * element.sweep() * share);
            centre
                + crate::geometry::Vector::new(out.x * cosine - out.y * sine, out.x * sine + out.y * cosine)
        }
    }
}

/// The distance of a point from an element. An arc of less than half a circle is what of its circle is beyond its chord.
fn beside(point: Point, element: &Element) -> f64 {
    let to_chord = distance(point, &[element.start(), element.end()]);
    let Element::Arc { start, end, centre, .. } = *element else { return to_chord };
    let on_circle = centre + (point - centre).normalize() * (start - centre).norm();
    let side = |p: Point| (end - start).perp(&(p - start));
    if side(on_circle) * side(centre) <= 0.0 {
        return (point - on_circle).norm();
    }
    (point - start).norm().min((point - end).norm())
}

fn distance(point: Point, lines: &[Point]) -> f64 {
    let to_line = |pair: &[Point]| {
        let way = pair[1] - pair[0];
        let share = ((point - pair[0]).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (point - (pair[0] + way * share)).norm_squared()
    };
    lines.windows(2).map(to_line).fold(f64::INFINITY, f64::min).sqrt()
}

/// Xorshift (Marsaglia).
struct Random(u64);

impl Random {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5851_F42D_4C95_7F2D;
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
