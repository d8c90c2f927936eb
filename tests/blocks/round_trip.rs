//! 3B to motions and back.

use dripfeed::geometry::{Element, Point, Sense};
use dripfeed::interpolator::Model;
use dripfeed::motion::{Act, Motion, Travel};
use dripfeed::place::Spot;
use dripfeed::rounding::Aim;
use proptest::prelude::*;

use crate::programs::{MODELS, arc, circle, ends, line, motions, written};

fn micrometres(motion: &Motion) -> Option<(i64, i64)> {
    let Act::Move { element, .. } = &motion.act else { return None };
    Some(((element.end().x * 1000.0).round() as i64, (element.end().y * 1000.0).round() as i64))
}

fn element_of(motion: &Motion) -> Option<&Element> {
    match &motion.act {
        Act::Move { element, .. } => Some(element),
        _ => None,
    }
}

fn program(arcs_turns: f64) -> impl Strategy<Value = String> {
    let block = prop_oneof![3 => line(), 5 => arc(arcs_turns), 1 => circle()];
    prop::collection::vec(block, 1..40).prop_map(|blocks| blocks.join("\n"))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The motions end where a control of that model ends, block by block.
    #[test]
    fn motions_end_where_the_mock_ends(text in program(3.0)) {
        for (model, mocks) in MODELS {
            let mut told = vec![None; text.lines().count()];
            for motion in motions(&text, model) {
                told[motion.block as usize - 1] = micrometres(&motion);
            }
            let expected: Vec<_> = ends(&text, mocks).into_iter().map(Some).collect();
            prop_assert_eq!(&told, &expected, "{:?}", model);
        }
    }

    /// Written again for the model it was read under, a program ends on the same micron, and each motion within one.
    #[test]
    fn a_program_written_again_ends_on_the_same_micron(text in program(1.0)) {
        for (model, mocks) in MODELS {
            let motions = motions(&text, model);
            let again = written(&motions, Aim::One(model));
            let (first, second) = (ends(&text, mocks), ends(&again, mocks));
            prop_assert_eq!(first.last(), second.last(), "{:?}\n{}\n\n{}", model, text, again);
        }
    }

    /// Blocks on which every model ends on the same micron, written for every model, end there under every model.
    #[test]
    fn what_all_models_agree_on_is_right_for_all_again(blocks in prop::collection::vec(program(1.0), 20)) {
        let text = agreed(blocks.iter().flat_map(|text| text.lines()));
        prop_assert!(text.lines().count() > 20, "{}", text);
        let again = written(&motions(&text, Model::Rotated), Aim::Any);
        let expected = ends(&text, MODELS[0].1).pop();
        for (model, mocks) in MODELS {
            prop_assert_eq!(ends(&again, mocks).pop(), expected, "{:?}\n{}\n\n{}", model, text, again);
        }
    }
}

/// The blocks on which the mock's models end on the same micron.
fn agreed<'a>(blocks: impl Iterator<Item = &'a str>) -> String {
    let agree = |block: &&str| {
        let end = ends(block, MODELS[0].1);
        MODELS.iter().all(|model| ends(block, model.1) == end)
    };
    blocks.filter(agree).fold(String::new(), |text, block| text + block + "\n")
}

fn single(text: &str, aim: Aim) -> String {
    written(&motions(text, Model::Rotated), aim)
}

#[test]
fn a_tie_keeps_its_digit_and_its_axis() {
    for block in ["B500B500B000500GYL1", "B500B500B000500GXL2", "B500B500B000500GYL3", "B500B500B000500GXL4"]
    {
        assert_eq!(single(block, Aim::One(Model::Rotated)), format!("{block}\nDD\n"));
    }
}

#[test]
fn a_full_circle_stays_one_block() {
    for block in ["B9900B0B039600GYNR1", "B0B9900B039600GXNR2", "B9900B0B039600GYSR4", "B0B3B000012GXSR1"] {
        for aim in [Aim::Any, Aim::One(Model::Strict)] {
            assert_eq!(single(block, aim), format!("{block}\nDD\n"));
        }
    }
}

/// R 249.999 mm is the largest circle that six digits count.
#[test]
fn a_circle_too_large_for_six_digits_is_split_and_closes() {
    let radius = 400.0;
    let at = |x, y| Point::new(x, y);
    let circle = Element::Arc {
        start: at(radius, 0.0),
        end: at(radius, 0.0),
        centre: at(0.0, 0.0),
        sense: Sense::CounterClockwise,
    };
    let motion = Motion {
        act: Act::Move { travel: Travel::Cut, element: circle, upper: None, flag: None },
        block: 1,
        spot: Spot::default(),
    };
    for (aim, trusted) in [(Aim::Any, &MODELS[..]), (Aim::One(Model::Exact), &MODELS[3..])] {
        let text = written(std::slice::from_ref(&motion), aim);
        assert!(text.lines().count() > 3, "{text}");
        for &(_, model) in trusted {
            let ends = ends(&text, model);
            assert_eq!(ends.last(), Some(&(0, 0)), "{text}");
            for (x, y) in ends {
                let (x, y) = (x as f64 + 400_000.0, y as f64);
                assert!(((x * x + y * y).sqrt() - 400_000.0).abs() < 1.5, "{x} {y}");
            }
        }
    }
}

/// A block of several turns is told in several motions; it is not one turn less.
#[test]
fn turns_are_counted() {
    let length = |text: &str| -> f64 {
        let moves = motions(text, Model::Rotated);
        moves.iter().filter_map(|motion| element_of(motion)).map(|element| element.length()).sum()
    };
    let one = length("B1000B0B004000GYNR1");
    for (turns, j) in [(2.0, 8000), (2.5, 10_000), (0.5, 2000), (7.0, 28_000)] {
        let many = length(&format!("B1000B0B{j}GYNR1"));
        assert!((many - turns * one).abs() < 0.01, "{turns}: {many} {one}");
    }
    assert_eq!(length("B1000B0B0GYNR1"), 0.0);
}
