//! Gears of the paper and of nobody's paper, executed and laid against the formulas.

use mock_controller::Model;

use crate::binary::{Run, dripfeed};
use crate::execution::{
    MODELS, Measured, Program, largest_deviation_um, measure, name_of, promise_kept, read,
};
use crate::part::{LeadIn, PAPERS_PART, Part};
use crate::theory::{Direction, Gear, PAPER, Root};

/// Parts to be right: the paper's and its relatives, and gears nobody printed: tips on the axes (z a multiple of 4),
/// roots on an axis (z even but not a multiple of 4), corners on the axes.
pub(crate) fn parts() -> Vec<(&'static str, Part)> {
    let paper = |change: &dyn Fn(&mut Part)| {
        let mut part = PAPERS_PART;
        change(&mut part);
        part
    };
    let other = |gear: Gear| Part { gear, ..PAPERS_PART };
    vec![
        ("the paper's", PAPERS_PART),
        ("the paper's as a die, its tip too sharp for the wire", paper(&|part| part.gear.offset = -0.07)),
        ("the paper's as a die with a thin wire", paper(&|part| part.gear.offset = -0.025)),
        ("the paper's without an offset", paper(&|part| part.gear.offset = 0.0)),
        ("the paper's counter-clockwise", paper(&|part| part.gear.direction = Direction::CounterClockwise)),
        ("the paper's without a lead-in", paper(&|part| part.lead_in = LeadIn::None)),
        ("the paper's from a hole outside", paper(&|part| part.lead_in = LeadIn::From([-1043, 11_987]))),
        ("the paper's twice", paper(&|part| part.repeat = 2)),
        (
            "the paper's, its root trimmed",
            paper(&|part| {
                part.gear.offset = 0.297;
                part.gear.root = Root::Trimmed;
            }),
        ),
        ("8 teeth of module 1", other(Gear { module: 1.0, teeth: 8, offset: 0.1, tip_radius: 0.1, ..PAPER })),
        (
            "8 teeth as a die, the sharp tips on the axes",
            other(Gear { module: 1.0, teeth: 8, offset: -0.11, tip_radius: 0.1, ..PAPER }),
        ),
        (
            "10 teeth, two roots on an axis",
            other(Gear { module: 0.7, teeth: 10, kp: 1.9, offset: 0.08, tip_radius: 0.07, ..PAPER }),
        ),
        (
            "12 teeth, blunt",
            other(Gear {
                module: 0.5,
                teeth: 12,
                kp: 1.8,
                kr: 0.1,
                ks: 1.5,
                knf: 1.65,
                tip_radius: 0.05,
                offset: 0.055,
                ..PAPER
            }),
        ),
        (
            "120 teeth, counter-clockwise, three times, without a lead-in",
            Part {
                gear: Gear {
                    module: 0.3,
                    teeth: 120,
                    kp: 2.3,
                    kr: 0.2,
                    ks: 1.45,
                    knf: 1.7,
                    tip_radius: 0.03,
                    offset: 0.085,
                    direction: Direction::CounterClockwise,
                    root: Root::Whole,
                },
                lead_in: LeadIn::None,
                repeat: 3,
            },
        ),
        (
            "7 teeth, a die, from a hole below",
            Part {
                gear: Gear { module: 0.8, teeth: 7, offset: -0.06, tip_radius: 0.09, ..PAPER },
                lead_in: LeadIn::From([137, -250]),
                repeat: 1,
            },
        ),
        (
            "200 teeth of module 3",
            other(Gear { module: 3.0, teeth: 200, kp: 2.2, tip_radius: 0.3, offset: 0.13, ..PAPER }),
        ),
        (
            "45 very small teeth",
            other(Gear { module: 0.1, teeth: 45, tip_radius: 0.012, offset: 0.02, ..PAPER }),
        ),
    ]
}

/// Generates a part and reads what was printed.
pub(crate) fn generate(part: &Part, more: &[&str]) -> (Program, Run) {
    let mut arguments = part.arguments();
    arguments.extend(more.iter().map(|&word| word.to_owned()));
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let run = dripfeed(&arguments);
    assert_eq!(run.code, Some(0), "{part:?} {more:?}\n{}", run.stderr);
    (read(&run.stdout), run)
}

fn each_part_keeps_the_promise_of(interpolator: &str) {
    let mut broken = Vec::new();
    for (name, part) in parts() {
        let (program, _) = generate(&part, &["--interpolator", interpolator]);
        if let Err(why) = promise_kept(&program.blocks, &part.path(), interpolator) {
            broken.push(format!("{name}: {why}"));
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn under_rotated_every_element_ends_within_1_05_um_and_the_outline_closes() {
    each_part_keeps_the_promise_of("rotated");
}

#[test]
fn under_mirrored_every_element_ends_within_1_05_um_and_the_outline_closes() {
    each_part_keeps_the_promise_of("mirrored");
}

#[test]
fn under_strict_every_element_ends_within_1_05_um_and_the_outline_closes() {
    each_part_keeps_the_promise_of("strict");
}

#[test]
fn under_exact_every_element_ends_within_1_05_um_and_the_outline_closes() {
    each_part_keeps_the_promise_of("exact");
}

#[test]
fn without_a_named_interpolator_every_element_ends_within_1_5_um_under_every_model() {
    each_part_keeps_the_promise_of("any");
}

#[test]
fn any_is_what_is_done_when_nothing_is_said() {
    let (silent, _) = generate(&PAPERS_PART, &[]);
    let (said, _) = generate(&PAPERS_PART, &["--interpolator", "any", "--rounding", "closed-loop"]);
    assert_eq!(silent.blocks, said.blocks);
}

/// Only arcs on which the models part are split: the paper's gear needs far fewer than the 400 blocks of splitting
/// every arc that crosses an axis of its centre.
#[test]
fn a_gear_for_any_control_is_split_no_more_than_at_the_axes() {
    let (program, _) = generate(&PAPERS_PART, &[]);
    assert!((253..=400).contains(&program.blocks.len()), "{}", program.blocks.len());
}

#[test]
fn a_gear_for_one_control_has_one_block_for_each_element() {
    for interpolator in ["rotated", "mirrored", "strict", "exact"] {
        let (program, _) = generate(&PAPERS_PART, &["--interpolator", interpolator]);
        assert_eq!(program.blocks.len(), 253, "{interpolator}");
    }
}

/// A block begins and ends up to 1.5 µm off and steps within 1 µm of its own curve; the rounding of its centre bends
/// that curve by up to another half µm.
#[test]
fn the_wire_stays_on_the_theoretical_outline_between_the_nodes() {
    for (name, part) in parts() {
        if part.gear.module > 1.0 {
            continue; // Ten million pulses would say no more.
        }
        let (program, _) = generate(&part, &[]);
        let path = part.path();
        let measured = promise_kept(&program.blocks, &path, "any").expect("the nodes are right");
        for model in MODELS {
            let largest = largest_deviation_um(model, &program.blocks, &path, &measured.element_of_block);
            assert!(largest <= 3.0, "{name} under {model:?}: {largest:.3} µm off the outline");
        }
    }
}

#[test]
fn the_numbers_on_standard_error_are_those_of_the_execution() {
    for (name, part) in parts() {
        for more in [
            &["--interpolator", "any"][..],
            &["--interpolator", "rotated"],
            &["--interpolator", "mirrored"],
            &["--interpolator", "strict"],
            &["--interpolator", "exact"],
            &["--rounding", "per-block"],
        ] {
            if part.repeat > 1 && more[0] == "--rounding" {
                continue; // A drift that grows from turn to turn: the next test's.
            }
            let (program, run) = generate(&part, more);
            let path = part.path();
            let trusted = crate::execution::trusted_by(if more[0] == "--rounding" { "any" } else { more[1] });
            let measured = measure(&program.blocks, &path, &trusted).expect("the program can be executed");
            let counts = format!("{} blocks for {} elements", program.blocks.len(), path.elements.len());
            assert!(run.stderr.contains(&counts), "{name} {more:?}: no {counts:?} in\n{}", run.stderr);
            agree(&run.stderr, &measured, &format!("{name} {more:?}"));
        }
    }
}

/// The paper's rounding is 1 µm off after a turn, and so 2 µm after two: where the wire stands then is what counts.
#[test]
fn the_closure_of_several_turns_is_the_distance_from_where_the_first_began() {
    let mut part = PAPERS_PART;
    part.repeat = 2;
    let (program, run) = generate(&part, &["--rounding", "per-block"]);
    let measured = measure(&program.blocks, &part.path(), &MODELS).expect("the program can be executed");
    agree(&run.stderr, &measured, "the paper's twice, per block");
}

/// A line straight up or down under `mirrored` always steps 1 µm aside first; one block alone can end 1.09 µm off.
#[test]
fn a_vertical_line_under_mirrored_ends_within_1_05_um_too() {
    let gear = Gear {
        module: 0.1558,
        teeth: 156,
        kp: 1.7775,
        kr: 0.3718,
        ks: 1.6548,
        knf: 1.2148,
        tip_radius: 0.0611,
        offset: 0.0582,
        ..PAPER
    };
    let part = Part { gear, ..PAPERS_PART };
    let (program, _) = generate(&part, &["--interpolator", "mirrored"]);
    let verdict = promise_kept(&program.blocks, &part.path(), "mirrored");
    assert!(verdict.is_ok(), "{verdict:?}");
}

/// Each model's line on standard error against the numbers measured here.
fn agree(stderr: &str, measured: &Measured, what: &str) {
    for (index, model) in MODELS.into_iter().enumerate() {
        let (error, closure) = reported(stderr, model);
        for (reported, own) in [(error, measured.node_error_um[index]), (closure, measured.closure_um[index])]
        {
            assert!(
                (reported - own).abs() <= 0.01,
                "{what} under {model:?}: {reported} reported, {own} measured"
            );
        }
    }
}

/// The largest node error and the closure that standard error gives for a model, µm.
pub(crate) fn reported(stderr: &str, model: Model) -> (f64, f64) {
    let wanted = format!("under {} ", name_of(model));
    let line = stderr.lines().find(|line| line.starts_with(&wanted));
    let line = line.unwrap_or_else(|| panic!("no line for {model:?} in\n{stderr}"));
    let number_after = |word: &str| {
        let rest = line.split(word).nth(1).and_then(|rest| rest.split_whitespace().next());
        rest.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no {word} in {line:?}"))
    };
    (number_after("error"), number_after("closure"))
}
