//! Programs no one wrote, and where the mock's interpolators say they lead.

use dripfeed::formats::Writer as _;
use dripfeed::formats::three_b::motions::Motions;
use dripfeed::formats::three_b::write::{Form, Writer};
use dripfeed::interpolator::Model;
use dripfeed::motion::Motion;
use dripfeed::rounding::Aim;
use proptest::prelude::*;

pub(crate) const MODELS: [(Model, mock_controller::Model); 4] = [
    (Model::Rotated, mock_controller::Model::Rotated),
    (Model::Mirrored, mock_controller::Model::Mirrored),
    (Model::Strict, mock_controller::Model::Strict),
    (Model::Exact, mock_controller::Model::Exact),
];

/// A line to anywhere within 30 mm, short ones as likely as long ones; ties and axes among them.
pub(crate) fn line() -> impl Strategy<Value = String> {
    (0.0f64..4.5, 0.0f64..4.5, 1u8..=4, 0u8..6).prop_map(|(x, y, digit, kind)| {
        let size = |log: f64| libm::pow(10.0, log) as u32;
        let (x, y) = (size(x), size(y));
        match kind {
            // At 45° the tie rule chooses G; along an axis the other number is 0 or left out.
            0 => format!("B{x}B{x}B{x:06}G{}L{digit}", if digit % 2 == 1 { 'Y' } else { 'X' }),
            // A control of the mirrored form never steps Y in a block of zeros, so those count X.
            1 if digit % 2 == 1 => format!("BBB{x}GXL{digit}"),
            2 if digit % 2 == 1 => format!("B{x}B0B{x}XL{digit}"),
            1 | 2 => format!("B0B{y}B{y}YL{digit}"),
            _ if x > y => format!("B{x}B{y}B{x:06}GXL{digit}"),
            _ => format!("B{x}B{y}B{y:06}GYL{digit}"),
        }
    })
}

/// An arc of 3 µm to 3 mm radius that counts up to `turns` turns.
pub(crate) fn arc(turns: f64) -> impl Strategy<Value = String> {
    (0.5f64..3.5, 0.0f64..std::f64::consts::FRAC_PI_2, 0.0f64..turns, 1u8..=4, any::<bool>(), any::<bool>())
        .prop_map(|(log, angle, share, digit, clockwise, g)| {
            let radius = libm::pow(10.0, log);
            let (sin, cos) = libm::sincos(angle);
            let (x, y) = ((radius * cos).round(), (radius * sin).round());
            let j = ((4.0 * radius * share) as u32).max(1);
            let letters = if clockwise { "SR" } else { "NR" };
            format!("B{x}B{y}B{j}G{}{letters}{digit}", if g { 'X' } else { 'Y' })
        })
}

/// The full circle from a point on an axis.
pub(crate) fn circle() -> impl Strategy<Value = String> {
    (3u32..3000, 0usize..4, any::<bool>()).prop_map(|(r, axis, clockwise)| {
        // The axis the circle starts on is the one with the larger coordinate at its end, so G is the other.
        let (x, y, g) = if axis.is_multiple_of(2) { (r, 0, 'Y') } else { (0, r, 'X') };
        let digit = if clockwise { [4, 1, 2, 3][axis] } else { [1, 2, 3, 4][axis] };
        format!("B{x}B{y}B{}G{g}{}{digit}", 4 * r, if clockwise { "SR" } else { "NR" })
    })
}

/// The motions of a program.
pub(crate) fn motions(text: &str, model: Model) -> Vec<Motion> {
    Motions::of_three_b(text.as_bytes(), model).map(|motion| motion.expect("the program is 3B")).collect()
}

/// Motions written as 3B.
pub(crate) fn written(motions: &[Motion], aim: Aim) -> String {
    let mut writer = Writer::new(Form { aim, ..Form::default() });
    let mut text = Vec::new();
    motions.iter().for_each(|motion| writer.write(motion, &mut text).expect("3B has room for it"));
    writer.finish(&mut text).expect("a program can end");
    String::from_utf8(text).expect("3B is ASCII")
}

/// Where each block of a program ends under one of the mock's models, µm from where it began; stop words aside.
pub(crate) fn ends(text: &str, model: mock_controller::Model) -> Vec<(i64, i64)> {
    let (mut x, mut y) = (0, 0);
    let blocks = text.lines().filter(|line| line.contains('B'));
    blocks
        .map(|line| {
            let block = mock_controller::parse_block(line).unwrap_or_else(|wrong| panic!("{line}: {wrong}"));
            let travel = mock_controller::interpolator::run(model, &block, |_, _| {})
                .unwrap_or_else(|fault| panic!("{line}: {fault}"));
            x += travel.dx;
            y += travel.dy;
            (x, y)
        })
        .collect()
}
