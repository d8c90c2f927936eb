//! 3B to 3B, to G-code and back, to DXF and back: the mock's wire goes the same way and ends on the same micron.

use mock_controller::interpolator::run;
use mock_controller::{Block, Kind, Model, parse_block};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use crate::control::{MODELS, Place, assert_same_cut, cut, cut_3b, gcode, three_b};
use crate::shop::{Shop, convert};

/// The gears that are generated: `generate gear` with these words.
const GEARS: [&str; 6] = [
    "",
    "--teeth 12 --module 0.8 --offset 0.05 --tip-radius 0.05",
    "--teeth 60 --module 0.25 --offset 0.03 --tip-radius 0.02 --direction ccw",
    "--teeth 23 --module 0.5 --offset -0.03",
    "--teeth 17 --module 0.7 --lead-in none",
    "--teeth 31 --offset 0 --interpolator rotated --rounding per-block",
];

fn gear(words: &str) -> String {
    let run = Shop::new().run(&format!("generate gear {words}"));
    assert_eq!(run.code, Some(0), "{words}: {}", run.stderr);
    run.stdout
}

/// Where the text goes and comes back: words of `convert` from 3B, the file between, words back.
const WAYS: [(&str, &str, &str); 3] = [
    ("in.3b --to gcode", "between.nc", "between.nc --to 3b"),
    ("in.3b --to dxf", "between.dxf", "between.dxf --to 3b"),
    ("in.3b --to 3b --end none", "between.3b", "between.3b --to 3b"),
];

fn there_and_back(text: &str, (there, between, back): (&str, &str, &str)) -> String {
    let shop = Shop::with("in.3b", text);
    shop.write(between, shop.convert(there));
    shop.convert(back)
}

#[test]
fn gears_written_again_end_on_the_same_micron_with_the_same_extents() {
    for words in GEARS {
        let program = gear(words);
        let again = convert("in.3b", &program, "--to 3b");
        // Only the gear that was rounded for one model ends elsewhere under the others.
        let models = if words.contains("per-block") { &MODELS[..1] } else { &MODELS[..] };
        let first = cut_3b(&program);
        for &model in models {
            let (told, own) = (cut(three_b(model), &again), cut(three_b(model), &program));
            let what = format!("{words}, {model:?}");
            assert_eq!(told.end(), own.end(), "{what}");
            assert_eq!(told.end(), first.end(), "{what}");
            assert_same_cut(&told, &own, 2, &what);
        }
    }
}

#[test]
fn gears_come_back_from_gcode_and_from_a_drawing() {
    for words in GEARS {
        let program = gear(words);
        let first = cut_3b(&program);
        for way in WAYS {
            let what = format!("{words}, {}", way.1);
            let told = cut_3b(&there_and_back(&program, way));
            assert_eq!(told.end(), first.end(), "{what}");
            assert_same_cut(&told, &first, 2, &what);
        }
    }
}

/// Its arc goes round by more than three quarters and ends 0.9 µm beside its circle.
const LONG_ARC: &str = "B2102B1211B008883GXNR2\nB1B1B000001GYL1\nB822B0B000822GXL3\nB0B850B000850GYL4\nDD\n";

#[test]
fn an_arc_over_three_quarters_comes_back_from_gcode_to_the_letter() {
    assert_eq!(
        there_and_back(LONG_ARC, (WAYS[0].0, WAYS[0].1, "between.nc --to 3b --interpolator rotated")),
        LONG_ARC
    );
    for model in ["any", "mirrored", "strict", "exact"] {
        for way in WAYS {
            let back = format!("{} --interpolator {model}", way.2);
            let told = cut_3b(&there_and_back(LONG_ARC, (way.0, way.1, &back)));
            assert_same_cut(&told, &cut_3b(LONG_ARC), 2, &format!("{model}, {}", way.1));
        }
    }
}

#[test]
fn gcode_made_of_a_gear_is_cut_as_the_gear() {
    for words in GEARS {
        let program = gear(words);
        let text = convert("in.3b", &program, "--to gcode");
        let (told, first) = (cut(gcode(0.0), &text), cut_3b(&program));
        assert_eq!(told.end(), first.end(), "{words}");
        assert_same_cut(&told, &first, 2, words);
        assert_eq!(told.ends, first.ends, "{words}: node by node");
    }
}

/// A closed 3B program of lines and arcs, and what becomes of it if a control of each model cuts it.
fn closed(turns: f64) -> impl Strategy<Value = String> {
    let line = (1u32..3000, 1u32..3000, 1u32..=4, any::<bool>()).prop_map(|(x, y, quadrant, is_steep)| {
        let (x, y) = if is_steep { (x.min(y), x.max(y)) } else { (x.max(y), x.min(y)) };
        let g = if x > y || (x == y && quadrant % 2 == 0) { 'X' } else { 'Y' };
        format!("B{x}B{y}B{}G{g}L{quadrant}", x.max(y))
    });
    let arc = (20.0f64..3000.0, 0.0f64..1.0, 0.02f64..turns, 1u32..=4, any::<[bool; 2]>()).prop_map(
        |(radius, share, part, quadrant, [is_clockwise, is_x])| {
            let x = (radius * share).round();
            let y = (radius * radius - x * x).max(0.0).sqrt().round();
            let j = (4.0 * radius * part).round().max(1.0);
            let way = if is_clockwise { "SR" } else { "NR" };
            format!("B{x}B{y}B{j}G{}{way}{quadrant}", if is_x { 'X' } else { 'Y' })
        },
    );
    let circle = (10u32..3000, 0u32..4, any::<bool>()).prop_map(|(r, axis, is_clockwise)| {
        let (x, y, g) = if axis % 2 == 0 { (r, 0, 'Y') } else { (0, r, 'X') };
        let (way, quadrant) =
            if is_clockwise { ("SR", [4, 1, 2, 3][axis as usize]) } else { ("NR", axis + 1) };
        format!("B{x}B{y}B{}G{g}{way}{quadrant}", 4 * r)
    });
    proptest::collection::vec(prop_oneof![3 => line, 4 => arc, 1 => circle], 2..20)
        .prop_map(|blocks| closed_by_a_line(&blocks))
        .prop_filter("a program that cuts", |text| text.lines().count() > 3)
}

/// The blocks on which all models agree, and a line back to where they began.
fn closed_by_a_line(blocks: &[String]) -> String {
    let (mut text, [mut x, mut y]) = (String::new(), [0, 0]);
    let parsed = blocks.iter().filter_map(|block| Some((block, agreed(&parse_block(block).ok()?)?)));
    for (block, [dx, dy]) in parsed {
        (x, y) = (x + dx, y + dy);
        text.push_str(block);
        text.push('\n');
    }
    if x != 0 {
        text.push_str(&format!("B{0}B0B{0}GXL{1}\n", x.abs(), if x > 0 { 3 } else { 1 }));
    }
    if y != 0 {
        // No control of any model steps Y in a block that counts Y from a slope of zero: one step of X and one back.
        text.push_str(&format!("B0B{0}B{0}GYL{1}\n", y.abs(), if y > 0 { 4 } else { 2 }));
    }
    text + "DD\n"
}

/// Where a block leads, if it leads there under every model.
fn agreed(block: &Block) -> Option<Place> {
    let ends: Vec<Place> = MODELS
        .iter()
        .filter_map(|model| run(*model, block, |_, _| {}).ok())
        .map(|travel| [travel.dx, travel.dy])
        .collect();
    let is_agreed = ends.len() == MODELS.len() && ends.iter().all(|end| *end == ends[0]);
    (is_agreed && (block.kind != Kind::Line || ends[0] != [0, 0])).then(|| ends[0])
}

/// Fifty programs, others on every run.
fn fifty(turns: f64, judge: impl Fn(&str)) {
    let config = Config { cases: 50, failure_persistence: None, max_shrink_iters: 60, ..Config::default() };
    let mut runner = TestRunner::new(config);
    runner
        .run(&closed(turns), |text| {
            let judged = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| judge(&text)));
            judged.map_err(|panic| {
                let why = panic.downcast_ref::<String>().cloned().unwrap_or_default();
                TestCaseError::fail(format!("{why}\n{text}"))
            })
        })
        .unwrap();
}

#[test]
fn fifty_programs_no_one_wrote_end_on_the_same_micron_and_go_the_same_way() {
    fifty(0.95, |text| {
        let again = convert("in.3b", text, "--to 3b");
        let first = cut_3b(text);
        assert_eq!(first.end(), [0, 0]);
        for model in [Model::Rotated, Model::Strict, Model::Exact] {
            let told = cut(three_b(model), &again);
            assert_eq!(told.end(), [0, 0], "{model:?}\n{again}");
            assert_same_cut(&told, &first, 2, &format!("{model:?}\n{again}"));
        }
    });
}

#[test]
fn fifty_programs_no_one_wrote_come_back_from_gcode_and_from_a_drawing() {
    fifty(0.95, |text| {
        let first = cut_3b(text);
        for (there, between, back) in &WAYS[..2] {
            for model in ["rotated", "any"] {
                let back = format!("{back} --interpolator {model}");
                let again = there_and_back(text, (there, between, &back));
                let told = cut_3b(&again);
                assert_eq!(told.end(), [0, 0], "{between} {model}\n{again}");
                assert_same_cut(&told, &first, 2, &format!("{between} {model}\n{again}"));
            }
        }
        let text = convert("in.3b", text, "--to gcode");
        assert_same_cut(&cut(gcode(0.0), &text), &first, 2, &text);
    });
}
