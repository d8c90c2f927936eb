//! Crossings and touches, and the grid against comparing all with all.

use super::*;
use crate::geometry::{Sense, turn};

fn held(element: Element) -> Held {
    let mut found = None;
    // The only maker of held cuts is a chain of cuts.
    let mut contours = crate::check::contours::Contours::default();
    let act = Act::Move { travel: Travel::Cut, element, upper: None, flag: None };
    let motion = Motion { act, block: 1, spot: Spot::default() };
    contours.see(&motion, Default::default(), Default::default(), &mut |run| {
        if let Run::Ring { ring, .. } = run {
            found = Some(ring[0]);
        }
    });
    contours.finish(&mut |run| {
        if let Run::Rest { held: [held, ..], .. } = run {
            found = Some(*held);
        }
    });
    found.unwrap()
}

fn line(from: (f64, f64), to: (f64, f64)) -> Element {
    Element::Line { start: Point::new(from.0, from.1), end: Point::new(to.0, to.1) }
}

fn arc(from: (f64, f64), to: (f64, f64), centre: (f64, f64), sense: Sense) -> Element {
    let p = |(x, y)| Point::new(x, y);
    Element::Arc { start: p(from), end: p(to), centre: p(centre), sense }
}

fn through(points: &[(f64, f64)]) -> Vec<Held> {
    points.windows(2).map(|pair| held(line(pair[0], pair[1]))).collect()
}

fn crosses(ring: &[Held], is_closed: bool) -> Vec<(usize, usize)> {
    match search(&Stretch { lead: &[], ring, is_closed }) {
        Found::All(crosses) => crosses.iter().map(|cross| (cross.earlier, cross.later)).collect(),
        Found::GivenUp => panic!("given up"),
    }
}

#[test]
fn lines_cross_and_neighbours_touch() {
    assert_eq!(crosses(&through(&[(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]), false), [(0, 2)]);
    // Out and straight back, and a needle-sharp corner.
    assert_eq!(crosses(&through(&[(0.0, 0.0), (10.0, 0.0), (0.0, 0.0)]), false), []);
    assert_eq!(crosses(&through(&[(0.0, 0.0), (10.0, 0.0), (0.0, 0.001)]), false), []);
}

#[test]
fn a_crossing_at_a_node_is_found_once_and_a_touch_there_is_none() {
    // The second stretch passes through the first at a node of its own.
    let through_node = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (5.0, 5.0), (5.0, 0.0), (4.0, -5.0)];
    assert_eq!(crosses(&through(&through_node), false).len(), 1);
    let touch = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (6.0, 5.0), (5.0, 0.0), (4.0, 5.0)];
    assert_eq!(crosses(&through(&touch), false), []);
    // It ends on the first: nothing passes through.
    let ends = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (5.0, 5.0), (5.0, 0.0)];
    assert_eq!(crosses(&through(&ends), false), []);
}

#[test]
fn arcs_cross_lines_and_arcs_and_tangents_do_not() {
    let cw = Sense::Clockwise;
    let round = held(arc((-5.0, 0.0), (5.0, 0.0), (0.0, 0.0), cw));
    let cut = |from, to| crosses(&[round, held(line((5.0, 0.0), (20.0, 0.0))), held(line(from, to))], false);
    assert_eq!(cut((20.0, 3.0), (-20.0, 3.0)), [(0, 2), (0, 2)]);
    assert_eq!(cut((20.0, 5.0), (-20.0, 5.0)), []);
    assert_eq!(cut((20.0, -3.0), (-20.0, -3.0)), [], "the other half of the circle is not cut");
    let other = held(arc((2.0, 6.0), (2.0, -6.0), (2.0, 0.0), Sense::CounterClockwise));
    let mut path = vec![round];
    path.extend(through(&[(5.0, 0.0), (20.0, 0.0), (20.0, 6.0), (2.0, 6.0)]));
    path.push(other);
    assert_eq!(crosses(&path, false), [(0, 4)]);
    // The same circle again, a micron off, is a second pass.
    let again = held(arc((-5.0, 0.001), (5.0, 0.001), (0.0, 0.001), cw));
    let way_back = held(arc((5.0, 0.0), (-5.0, 0.001), (0.0, 0.0), cw));
    assert_eq!(crosses(&[round, way_back, again], false), []);
}

#[test]
fn a_crossing_at_a_small_angle_is_told_by_how_far_it_goes() {
    let shallow = |depth: f64| {
        through(&[(0.0, 0.0), (100.0, 0.0), (100.0, 20.0), (-1.0, 20.0), (-1.0, depth), (99.0, -depth)])
    };
    assert_eq!(crosses(&shallow(0.05), false), [(0, 4)]);
    assert_eq!(crosses(&shallow(0.002), false), []);
}

#[test]
fn the_grid_finds_what_comparing_all_with_all_finds() {
    let mut state = 7u64;
    let mut dice = move |n: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % n
    };
    let mut in_all = 0;
    for _ in 0..200 {
        let mut here = (0.0, 0.0);
        let mut path = Vec::new();
        for _ in 0..60 {
            let size = [1.0, 3.0, 40.0][dice(3) as usize];
            let mut step = || (dice(2001) as f64 / 1000.0 - 1.0) * size;
            let to = (here.0 + step(), here.1 + step());
            let bulge = step();
            // Some of them arcs about a point on the chord's bisector.
            path.push(held(if dice(2) == 0 {
                line(here, to)
            } else {
                let (mx, my) = ((here.0 + to.0) / 2.0, (here.1 + to.1) / 2.0);
                let centre = (mx - (to.1 - here.1) * bulge, my + (to.0 - here.0) * bulge);
                arc(here, to, centre, if dice(2) == 0 { Sense::Clockwise } else { Sense::CounterClockwise })
            }));
            here = to;
        }
        let stretch = Stretch { lead: &[], ring: &path, is_closed: false };
        let mut all: Vec<Point> = Vec::new();
        for a in 0..path.len() {
            for b in a + 1..path.len() {
                for at in meet::meet(&path[a].element, &path[b].element).into_iter().flatten() {
                    if crosses_at(&stretch, a, b, at) {
                        all.push(at);
                    }
                }
            }
        }
        let Found::All(found) = search(&stretch) else { panic!("given up") };
        in_all += found.len();
        let near = |a: Point, b: Point| (a - b).norm() <= SAME_MM;
        assert!(found.iter().all(|cross| all.iter().any(|&at| near(at, cross.at))));
        assert!(all.iter().all(|&at| found.iter().any(|cross| near(at, cross.at))));
    }
    assert!(in_all > 1000, "only {in_all} crossings met");
}

#[test]
fn two_elements_meet_on_both_of_them() {
    // Dense sampling of one against the other's distance.
    let pairs = [
        (line((0.0, 0.0), (10.0, 3.0)), arc((9.0, 0.0), (1.0, 1.0), (5.0, 0.5), Sense::CounterClockwise)),
        (
            arc((0.0, 0.0), (6.0, 0.0), (3.0, -1.0), Sense::Clockwise),
            arc((3.0, 3.0), (3.0, -3.0), (0.0, 0.0), Sense::Clockwise),
        ),
    ];
    for (a, b) in pairs {
        let points: Vec<Point> = meet::meet(&a, &b).into_iter().flatten().collect();
        assert!(!points.is_empty());
        for at in &points {
            assert!(a.distance(*at) < 1e-9 && b.distance(*at) < 1e-9);
        }
        let sides = (0..=10_000).map(|n| {
            let on = a.at(f64::from(n) / 10_000.0);
            let near = b.nearest(on);
            let inside = match b {
                Element::Arc { centre, .. } => (on - centre).norm() < (near - centre).norm(),
                Element::Line { start, end } => turn(end - start, on - start) > 0.0,
            };
            (inside, b.distance(on) < 0.01)
        });
        let sides: Vec<_> = sides.collect();
        let changes = sides.windows(2).filter(|w| w[0].0 != w[1].0 && w[0].1 && w[1].1).count();
        assert_eq!(changes, points.len());
    }
}
