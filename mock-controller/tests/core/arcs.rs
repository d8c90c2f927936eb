//! Arcs: the published pulse sequences, one to four quadrants, full circles, a wrong G.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use std::f64::consts::TAU;

use mock_controller::interpolator::length::length_um;
use mock_controller::interpolator::{Cause, run};
use mock_controller::{Axis, Block, Kind, Model, Quadrant, Travel, parse_block};

use crate::sender::run_unpaced;

/// Every place of an arc, from its centre, the start first.
fn places(model: Model, text: &str) -> Vec<(i64, i64)> {
    let block = parse_block(text).unwrap();
    let (sign_x, sign_y) = block.quadrant.signs();
    let start = (sign_x * i64::from(block.x), sign_y * i64::from(block.y));
    let mut places = vec![start];
    run(model, &block, |x, y| places.push((start.0 + x, start.1 + y))).unwrap();
    for pair in places.windows(2) {
        assert_eq!((pair[1].0 - pair[0].0).abs() + (pair[1].1 - pair[0].1).abs(), 1, "{text}");
    }
    places
}

/// F at every place: F = x² + y² − R² holds on an arc.
fn f_values(places: &[(i64, i64)]) -> Vec<i64> {
    let f = |&(x, y): &(i64, i64)| x * x + y * y;
    places.iter().map(|place| f(place) - f(&places[0])).collect()
}

#[test]
fn the_counter_clockwise_vector_of_the_books() {
    let places = places(Model::Rotated, "B4B0B4GYNR1");
    // −x +y +y +y −x +y −x −x ends at (0, 4); counted along Y it ends with the fourth +y, at (2, 4).
    assert_eq!(places, [(4, 0), (3, 0), (3, 1), (3, 2), (3, 3), (2, 3), (2, 4)]);
    let whole = self::places(Model::Rotated, "B4B0B4GXNR1");
    assert_eq!(whole[6..], [(2, 4), (1, 4), (0, 4)]);
    assert_eq!(f_values(&whole), [0, -7, -6, -3, 2, -3, 4, 1, 0]);
}

#[test]
fn the_clockwise_vector_of_the_books() {
    let places = places(Model::Rotated, "B0B6B6GYSR1");
    assert_eq!(f_values(&places), [0, -11, -10, -7, -2, 5, -4, 5, -2, 9, 4, 1, 0]);
    assert_eq!(places.last(), Some(&(6, 0)));
}

#[test]
fn strict_steps_outward_first_where_the_others_step_inward() {
    assert_eq!(places(Model::Strict, "B4B0B4GXNR1")[1], (4, 1));
    assert_eq!(places(Model::Strict, "B0B6B6GYSR1")[1], (1, 6));
    assert_eq!(places(Model::Mirrored, "B4B0B4GXNR1")[1], (3, 0));
}

#[test]
fn a_full_circle_from_an_axis_point_closes_in_every_model_sense_and_quadrant() {
    for radius in [1_u32, 2, 3, 17, 400, 9900] {
        for (kind, quadrant, on_x) in [
            (Kind::CounterClockwise, Quadrant::First, true),
            (Kind::CounterClockwise, Quadrant::Second, false),
            (Kind::CounterClockwise, Quadrant::Third, true),
            (Kind::CounterClockwise, Quadrant::Fourth, false),
            (Kind::Clockwise, Quadrant::First, false),
            (Kind::Clockwise, Quadrant::Second, true),
            (Kind::Clockwise, Quadrant::Third, false),
            (Kind::Clockwise, Quadrant::Fourth, true),
        ] {
            let (x, y) = if on_x { (radius, 0) } else { (0, radius) };
            // The end lies on an axis: the other one has the smaller coordinate.
            let g = if on_x { Axis::Y } else { Axis::X };
            let block = Block { x, y, j: 4 * radius, g, kind, quadrant };
            for model in [Model::Rotated, Model::Strict, Model::Exact] {
                if radius == 1 && model == Model::Rotated {
                    continue; // Its first step is onto the centre.
                }
                let travel = run(model, &block, |_, _| {}).unwrap();
                let wanted = Travel { dx: 0, dy: 0, pulses: 8 * u64::from(radius) };
                assert_eq!(travel, wanted, "{model:?} {block}");
                let length = length_um(&block, &travel);
                assert!((length - TAU * f64::from(radius)).abs() < 1e-6, "{model:?} {block}: {length}");
            }
        }
    }
}

#[test]
fn a_full_circle_counted_along_the_wrong_axis_stops_140_um_short() {
    let travel = run(Model::Rotated, &parse_block("B9900B0B39600GXNR1").unwrap(), |_, _| {}).unwrap();
    let short = (travel.dx as f64).hypot(travel.dy as f64);
    assert!((139.0..142.0).contains(&short), "{short}");
}

#[test]
fn an_arc_on_its_centre_is_a_fault() {
    for text in ["B1B0B2GXNR1", "B1B0B1GYNR1", "BBB5GXNR1", "B0B1B2GXSR1"] {
        let fault = run(Model::Rotated, &parse_block(text).unwrap(), |_, _| {}).unwrap_err();
        assert_eq!(fault.cause, Cause::ArcCentre, "{text}");
    }
    let fault = run(Model::Exact, &parse_block("BBB5GXNR1").unwrap(), |_, _| {}).unwrap_err();
    assert_eq!(fault.cause, Cause::ArcCentre);
}

/// The true end of an arc, by walking the circle in very small angles until G has travelled J.
fn sampled_end(block: &Block) -> (f64, f64) {
    let (sign_x, sign_y) = block.quadrant.signs();
    let (x, y) = (f64::from(block.x) * sign_x as f64, f64::from(block.y) * sign_y as f64);
    let radius = x.hypot(y);
    let sense = if block.kind == Kind::Clockwise { -1.0 } else { 1.0 };
    let start = y.atan2(x);
    let step = 0.02 / radius;
    let mut travelled = 0.0;
    let mut before = (x, y);
    for count in 1_u64.. {
        let angle = start + sense * step * count as f64;
        let here = (radius * angle.cos(), radius * angle.sin());
        travelled += match block.g {
            Axis::X => (here.0 - before.0).abs(),
            Axis::Y => (here.1 - before.1).abs(),
        };
        before = here;
        if travelled >= f64::from(block.j) - 1e-9 {
            break;
        }
    }
    (before.0 - x, before.1 - y)
}

#[test]
fn arcs_over_one_to_four_quadrants_end_near_the_sampled_circle() {
    let mut dice = 12_345_u64;
    let mut roll = |bound: u64| {
        dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((dice >> 33) % bound).unwrap()
    };
    let quadrants = [Quadrant::First, Quadrant::Second, Quadrant::Third, Quadrant::Fourth];
    let mut turned = [0; 4];
    for _ in 0..200 {
        let mut block = Block {
            x: 5 + roll(300),
            y: 5 + roll(300),
            j: 0,
            g: if roll(2) == 0 { Axis::X } else { Axis::Y },
            kind: if roll(2) == 0 { Kind::Clockwise } else { Kind::CounterClockwise },
            quadrant: quadrants[roll(4) as usize],
        };
        let radius = f64::from(block.x).hypot(f64::from(block.y));
        block.j = 1 + roll(4 * radius as u64);
        turned[((f64::from(block.j) / radius) as usize).min(3)] += 1;
        let (true_x, true_y) = sampled_end(&block);
        let exact = run(Model::Exact, &block, |x, y| {
            let (sign_x, sign_y) = block.quadrant.signs();
            let from_centre =
                ((i64::from(block.x) * sign_x + x) as f64).hypot((i64::from(block.y) * sign_y + y) as f64);
            assert!((from_centre - radius).abs() <= 0.708, "{block}: {from_centre} of {radius}");
        })
        .unwrap();
        // The last sample overshoots by up to 0.02 µm of arc.
        assert!((exact.dx as f64 - true_x).abs() <= 0.521, "{block}: {} {true_x}", exact.dx);
        assert!((exact.dy as f64 - true_y).abs() <= 0.521, "{block}: {} {true_y}", exact.dy);
        for model in [Model::Rotated, Model::Strict] {
            let travel = run(model, &block, |x, y| {
                let (sign_x, sign_y) = block.quadrant.signs();
                let from_centre = ((i64::from(block.x) * sign_x + x) as f64)
                    .hypot((i64::from(block.y) * sign_y + y) as f64);
                assert!((from_centre - radius).abs() <= 1.5, "{block}: {from_centre} of {radius}");
            })
            .unwrap();
            // Where G is the end's larger coordinate, a step of G is a long way along the circle: no bound is given.
            let (sign_x, sign_y) = block.quadrant.signs();
            let end_x = (f64::from(block.x) * sign_x as f64 + true_x).abs();
            let end_y = (f64::from(block.y) * sign_y as f64 + true_y).abs();
            let right_g = if end_x < end_y { Axis::X } else { Axis::Y };
            let off = (travel.dx as f64 - true_x).hypot(travel.dy as f64 - true_y);
            assert!(block.g != right_g || off <= 8.0, "{model:?} {block}: {off}");
        }
    }
    assert!(turned.iter().all(|&count| count > 10), "every number of quadrants: {turned:?}");
}

#[test]
fn many_quadrant_arcs_with_j_from_geometry_are_a_few_um_off_as_simulated_in_the_sources() {
    // From +X counter-clockwise to 225°, 3 quadrants begun; the end by G = the smaller coordinate would tie, so both.
    let radius = 10_000_u32;
    let half = (f64::from(radius) / 2_f64.sqrt()).round();
    for g in [Axis::X, Axis::Y] {
        let j = match g {
            Axis::X => f64::from(radius) * 2.0 + (f64::from(radius) - half),
            Axis::Y => f64::from(radius) * 2.0 + half,
        };
        let block = Block {
            x: radius,
            y: 0,
            j: j as u32,
            g,
            kind: Kind::CounterClockwise,
            quadrant: Quadrant::First,
        };
        let travel = run(Model::Rotated, &block, |_, _| {}).unwrap();
        let off = (travel.dx as f64 + half + f64::from(radius)).hypot(travel.dy as f64 + half);
        assert!(off <= 7.0, "{g:?}: {off}");
    }
}

#[test]
fn an_exact_arc_that_has_turned_round_rounds_both_coordinates() {
    // R² = 8, R = 2.828: from (2, 2) counter-clockwise, G = Y: 0.828 up to the top, then down.
    let travel = run(Model::Exact, &parse_block("B2B2B3GYNR1").unwrap(), |_, _| {}).unwrap();
    // Down by 3 − 0.828 = 2.172 from 2.828 to y = 0.657, x = −2.751.
    assert_eq!((2 + travel.dx, 2 + travel.dy), (-3, 1));
}

#[test]
fn the_program_from_the_trade_closes() {
    let program = "B9900B0B9900GXL1B9900B0B39600GYNR1B9900B0B9900GXL3";
    let report = run_unpaced(program);
    assert_eq!((report.blocks, report.end_um, report.alarm), (3, [0, 0], None));
    assert_eq!(report.pulses, 9900 + 8 * 9900 + 9900);
    assert!((report.path_length_mm - (2.0 + TAU) * 9.9).abs() < 1e-9, "{}", report.path_length_mm);
}

#[test]
fn the_length_of_an_arc_follows_its_executed_end() {
    let block = parse_block("B1000B0B1000GXNR1").unwrap();
    let travel = run(Model::Rotated, &block, |_, _| {}).unwrap();
    assert_eq!((travel.dx, travel.dy), (-1000, 1000));
    assert!((length_um(&block, &travel) - TAU * 250.0).abs() < 1e-6);
    // 5 µm short of the quarter: the sweep is less by their angle. Beyond it: more.
    for (dx, short_um) in [(-995, 5.0), (-1005, -5.0)] {
        let length = length_um(&block, &Travel { dx, dy: 1000, pulses: 0 });
        assert!((length - (TAU * 250.0 - short_um)).abs() < 1e-3, "{length}");
    }
}
