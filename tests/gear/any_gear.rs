//! Random gears: those that exist keep the promise, those that do not are refused.

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::Config;

use crate::binary::dripfeed;
use crate::execution::{promise_kept, read};
use crate::part::{LeadIn, Part};
use crate::theory::{Direction, Gear, Root};

/// Clear of the bound on both sides: an element shorter than this may be left out by rounding.
const CLEAR_UM: f64 = 5.0;

proptest! {
    #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

    #[test]
    fn any_gear_that_exists_keeps_the_promise_and_any_other_is_refused(
        part in part(),
        interpolator in prop::sample::select(vec!["any", "any", "rotated", "mirrored", "strict", "exact"]),
    ) {
        let margin = part.gear.derived().margin_um(Root::Whole);
        let mut arguments = part.arguments();
        arguments.push(format!("--interpolator={interpolator}"));
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let run = dripfeed(&arguments);
        if margin > CLEAR_UM {
            prop_assert_eq!(run.code, Some(0), "margin {} µm\n{}", margin, run.stderr);
            let verdict = promise_kept(&read(&run.stdout).blocks, &part.path(), interpolator);
            prop_assert!(verdict.is_ok(), "{}: {}", arguments.join(" "), verdict.unwrap_err());
        } else if margin <= 0.0 || margin.is_nan() {
            let words = arguments.join(" ");
            prop_assert!(matches!(run.code, Some(2 | 3)), "margin {margin} µm, exit {:?}: {words}", run.code);
            prop_assert_eq!(run.stdout, "");
        }
    }
}

/// The same gears must reach both sides of the test above, or it would say little.
#[test]
fn about_half_of_the_random_gears_exist() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let exist = (0..1000)
        .filter(|_| {
            let tree = part().new_tree(&mut runner).expect("a part can be drawn");
            tree.current().gear.derived().margin_um(Root::Whole) > CLEAR_UM
        })
        .count();
    assert!((400..900).contains(&exist), "{exist} of 1000");
}

fn part() -> impl Strategy<Value = Part> {
    let lead_in = prop_oneof![
        Just(LeadIn::Centre),
        Just(LeadIn::None),
        (-300_000_i64..300_000, -300_000_i64..300_000).prop_map(|(x, y)| LeadIn::From([x, y])),
    ];
    (gear(), lead_in, 1..=2_u32).prop_map(|(gear, lead_in, repeat)| Part { gear, lead_in, repeat })
}

/// Module log-uniform; the tip rounding and the offset as shares of what may fit.
#[expect(clippy::disallowed_methods, reason = "the last bit of a random module does not matter")]
fn gear() -> impl Strategy<Value = Gear> {
    let numbers = (
        (0.05_f64.ln()..3.0_f64.ln()),
        6..=200_u32,
        1.2..3.0_f64,
        0.0..0.5_f64,
        1.2..1.9_f64,
        1.2..2.2_f64,
        0.01..0.5_f64,
        -2.5..1.3_f64,
        any::<bool>(),
    );
    numbers.prop_map(|(log_module, teeth, kp, kr, ks, knf, tip_share, offset_share, clockwise)| {
        let module = to_4_places(log_module.exp());
        let gear = Gear {
            module,
            teeth,
            kp: to_4_places(kp),
            kr: to_4_places(kr),
            ks: to_4_places(ks),
            knf: to_4_places(knf),
            tip_radius: to_4_places(tip_share * module),
            offset: 0.0,
            direction: if clockwise { Direction::Clockwise } else { Direction::CounterClockwise },
            root: Root::Whole,
        };
        let root_arc_mm = gear.derived().root_arc_radius / 1000.0;
        let unit = if root_arc_mm.is_finite() && root_arc_mm > 0.0 { root_arc_mm } else { module };
        Gear { offset: to_4_places(offset_share * unit), ..gear }
    })
}

fn to_4_places(number: f64) -> f64 {
    (number * 1e4).round() / 1e4
}
