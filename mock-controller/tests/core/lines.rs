//! Lines: the right digit and G end exactly, ties, the forms that part.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use mock_controller::interpolator::{Cause, run};
use mock_controller::{Axis, Block, Kind, Model, Quadrant, parse_block};

/// Where a block ends; every pulse is checked to be one step.
fn end_of(model: Model, text: &str) -> (i64, i64) {
    let block = parse_block(text).unwrap();
    let mut at = (0_i64, 0_i64);
    let mut pulses = 0;
    let travel = run(model, &block, |x, y| {
        assert_eq!((x - at.0).abs() + (y - at.1).abs(), 1, "{text}");
        at = (x, y);
        pulses += 1;
    })
    .unwrap();
    assert_eq!(((travel.dx, travel.dy), travel.pulses), (at, pulses), "{text}");
    at
}

/// The digit for an end point by angle, half-open: 0° ≤ θ < 90° is 1.
fn digit(x: i64, y: i64) -> Quadrant {
    if x > 0 && y >= 0 {
        Quadrant::First
    } else if x <= 0 && y > 0 {
        Quadrant::Second
    } else if x < 0 && y <= 0 {
        Quadrant::Third
    } else {
        Quadrant::Fourth
    }
}

fn line(x: i64, y: i64, g: Axis) -> Block {
    let size = |v: i64| u32::try_from(v.abs()).unwrap();
    let j = match g {
        Axis::X => size(x),
        Axis::Y => size(y),
    };
    Block { x: size(x), y: size(y), j, g, kind: Kind::Line, quadrant: digit(x, y) }
}

#[test]
fn a_line_with_the_right_g_and_digit_ends_at_its_end_in_all_models_but_mirrored() {
    for x in -23..=23_i64 {
        for y in -23..=23_i64 {
            if (x, y) == (0, 0) || x.abs() == y.abs() {
                continue;
            }
            let block = line(x, y, if x.abs() > y.abs() { Axis::X } else { Axis::Y });
            for model in [Model::Rotated, Model::Strict, Model::Exact] {
                let travel = run(model, &block, |_, _| {}).unwrap();
                assert_eq!((travel.dx, travel.dy), (x, y), "{model:?} {block}");
            }
        }
    }
}

#[test]
fn at_45_degrees_the_tie_rule_is_exact_and_the_other_choice_1_um_off() {
    for size in [1, 2, 7, 500, 20_000] {
        for (x, y) in [(size, size), (-size, size), (-size, -size), (size, -size)] {
            let (rule, other) = match digit(x, y) {
                Quadrant::First | Quadrant::Third => (Axis::Y, Axis::X),
                Quadrant::Second | Quadrant::Fourth => (Axis::X, Axis::Y),
            };
            let right = run(Model::Rotated, &line(x, y, rule), |_, _| {}).unwrap();
            assert_eq!((right.dx, right.dy), (x, y));
            let wrong = run(Model::Rotated, &line(x, y, other), |_, _| {}).unwrap();
            assert_eq!((wrong.dx - x).abs() + (wrong.dy - y).abs(), 1, "({x}, {y})");
        }
    }
}

#[test]
fn the_rotated_form_alternates_as_the_method_says() {
    let mut steps = Vec::new();
    let block = parse_block("B3B2B3GXL1").unwrap();
    run(Model::Rotated, &block, |x, y| steps.push((x, y))).unwrap();
    // F: 0 → x, −2 → y, 1 → x, −1 → y, 2 → x and J is used up.
    assert_eq!(steps, [(1, 0), (1, 1), (2, 1), (2, 2), (3, 2)]);
}

#[test]
fn the_mirrored_form_leaves_a_line_along_y_1_um_off() {
    assert_eq!(end_of(Model::Rotated, "B0B500B500GYL2"), (0, 500));
    assert_eq!(end_of(Model::Mirrored, "B0B500B500GYL2"), (-1, 500));
    assert_eq!(end_of(Model::Mirrored, "B300B200B300GXL2"), (-300, 200));
}

#[test]
fn a_line_of_empty_numbers_runs_along_its_digits_axis() {
    for model in [Model::Rotated, Model::Strict, Model::Exact] {
        assert_eq!(end_of(model, "BBB9900GXL1"), (9900, 0));
        assert_eq!(end_of(model, "BBB9900GYL2"), (0, 9900));
        assert_eq!(end_of(model, "BBB9900GXL3"), (-9900, 0));
        assert_eq!(end_of(model, "BBB9900GYL4"), (0, -9900));
    }
}

#[test]
fn a_line_that_can_never_step_its_g_is_stopped() {
    for model in [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact] {
        let fault = run(model, &parse_block("BBB9900GYL1").unwrap(), |_, _| {}).unwrap_err();
        assert_eq!(fault.cause, Cause::EndlessBlock, "{model:?}");
    }
}

#[test]
fn a_j_of_zero_is_no_motion() {
    for model in [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact] {
        for text in ["B5B7B0GXL1", "B5B7B0GYNR2", "BBBGXL1", "BBBGXSR1"] {
            assert_eq!(end_of(model, text), (0, 0), "{model:?} {text}");
        }
    }
}

#[test]
fn the_exact_line_ends_where_g_has_travelled_j_and_rounds_halves_away_from_zero() {
    assert_eq!(end_of(Model::Exact, "B10B5B3GXL1"), (3, 2)); // 1.5
    assert_eq!(end_of(Model::Exact, "B10B5B3GXL3"), (-3, -2)); // −1.5
    assert_eq!(end_of(Model::Exact, "B10B4B3GXL2"), (-3, 1)); // 1.2
    assert_eq!(end_of(Model::Exact, "B1000B300B300GYL1"), (1000, 300));
}

#[test]
fn the_exact_lines_pulses_keep_within_a_half_square_of_the_line() {
    for text in ["B100B37B100GXL1", "B37B100B100GYL2", "B100B99B100GXL3", "B7B100B100GYL4", "B64B64B64GYL1"] {
        let block = parse_block(text).unwrap();
        let (sign_x, sign_y) = block.quadrant.signs();
        let (end_x, end_y) = (f64::from(block.x) * sign_x as f64, f64::from(block.y) * sign_y as f64);
        run(Model::Exact, &block, |x, y| {
            let off = (end_x * y as f64 - end_y * x as f64).abs() / end_x.hypot(end_y);
            assert!(off <= 0.708, "{text}: {off}");
        })
        .unwrap();
    }
}
