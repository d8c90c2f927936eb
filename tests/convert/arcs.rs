//! Long arcs of no one's drawing: the whole way round, not only where it ends, stays near the circle.

use mock_controller::Model;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use crate::control::{cut, three_b};
use crate::shop::convert;

/// An arc of more than half a turn, nm and turns.
#[derive(Clone, Copy, Debug)]
struct Arc {
    centre: [i64; 2],
    radius: f64,
    from: f64,
    turns: f64,
    is_clockwise: bool,
}

impl Arc {
    fn at(&self, turn: f64) -> [i64; 2] {
        let (sin, cos) = libm::sincos(turn * std::f64::consts::TAU);
        let [x, y] = self.centre;
        [x + (self.radius * cos).round() as i64, y + (self.radius * sin).round() as i64]
    }

    /// How far the wire of a control comes off the circle at most, µm.
    fn stray(&self, aim: &str, model: Model) -> f64 {
        let Self { centre, radius, from, turns, is_clockwise } = *self;
        let (start, end) = (self.at(from), self.at(from + if is_clockwise { -turns } else { turns }));
        let [x, y, to_x, to_y] = [start[0], start[1], end[0], end[1]].map(|nm| nm as f64 / 1e6);
        let [i, j] = [0, 1].map(|axis| (centre[axis] - start[axis]) as f64 / 1e6);
        let word = if is_clockwise { "G02" } else { "G03" };
        let text =
            format!("G21 G90\nG92 X{x:.6} Y{y:.6}\n{word} X{to_x:.6} Y{to_y:.6} I{i:.6} J{j:.6}\nM02\n");
        let program = convert("in.nc", &text, &format!("--to 3b --interpolator {aim}"));
        let zero = start.map(|nm| (nm as f64 / 1e3).round());
        let off = |place: &[i64; 2]| {
            let [x, y] = [0, 1].map(|axis| zero[axis] + place[axis] as f64 - centre[axis] as f64 / 1e3);
            ((x * x + y * y).sqrt() - radius / 1e3).abs()
        };
        cut(three_b(model), &program).pulses.iter().map(off).fold(0.0, f64::max)
    }
}

fn any_arc() -> impl Strategy<Value = Arc> {
    let at = -9_000_000..9_000_000_i64;
    ([at.clone(), at], 3.5..6.5f64, 0.0..1.0f64, 0.5..0.995f64, any::<bool>()).prop_map(
        |(centre, size, from, turns, is_clockwise)| Arc {
            centre,
            radius: libm::pow(10.0, size),
            from,
            turns,
            is_clockwise,
        },
    )
}

#[test]
fn the_far_side_of_a_long_arc_is_where_it_should_be() {
    let config = Config { cases: 60, failure_persistence: None, max_shrink_iters: 30, ..Config::default() };
    for (aim, model) in [("rotated", Model::Rotated), ("any", Model::Mirrored), ("exact", Model::Exact)] {
        let outcome = TestRunner::new(config.clone()).run(&any_arc(), |arc| {
            let off = arc.stray(aim, model);
            prop_assert!(off <= 2.5, "{aim}: {off} µm");
            Ok(())
        });
        outcome.unwrap();
    }
}
