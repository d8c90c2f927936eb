//! Part files: every option of the command line as a key, strictly read.

use crate::scratch::{Ear, Scratch};

/// A part file that says everything, and the words that say the same.
const SAID_IN_FULL: &str = r#"
[part]
kind = "gear"
module = 0.5
teeth = 24
kp = 1.9
kr = 0.1
ks = 1.5
knf = 1.6
tip_radius = 0.05
direction = "ccw"
lead_in = [-1.25, 9.5]
repeat = 2

[wire]
offset = 0.06

[output]
format = "3b"
rounding = "closed-loop"
interpolator = "strict"
end = "E"
"#;

const THE_SAME_TYPED: &str = "generate gear --module 0.5 --teeth 24 --kp 1.9 --kr 0.1 --ks 1.5 --knf 1.6 --tip-radius 0.05 \
     --direction ccw --lead-in -1.25,9.5 --repeat 2 --offset 0.06 --format 3b --rounding closed-loop \
     --interpolator strict --end E";

#[test]
fn the_generators_options_are_keys_of_the_part_file() {
    let scratch = Scratch::with(&[("gear.toml", SAID_IN_FULL)]);
    let typed = scratch.run(&THE_SAME_TYPED.split_whitespace().collect::<Vec<_>>());
    let built = scratch.run(&["generate", "gear.toml"]);
    assert_eq!((typed.code, built.code), (Some(0), Some(0)), "{}\n{}", typed.stderr, built.stderr);
    assert_eq!(built.stdout, typed.stdout);
}

#[test]
fn a_wire_is_an_offset_or_a_diameter_a_gap_and_a_side() {
    for (side, offset) in [("outside", "0.07"), ("inside", "-0.07")] {
        let text =
            format!("[part]\nkind = \"gear\"\n[wire]\ndiameter = 0.12\ngap = 0.01\nside = \"{side}\"\n");
        let scratch = Scratch::with(&[("gear.toml", &text)]);
        let built = scratch.run(&["generate", "gear.toml"]);
        let typed = scratch.run(&["generate", "gear", &format!("--offset={offset}")]);
        assert_eq!(built.code, Some(0), "{}", built.stderr);
        assert_eq!(built.stdout, typed.stdout, "{side}");
    }
}

#[test]
fn what_a_part_file_leaves_out_is_told() {
    let scratch = Scratch::with(&[("gear.toml", "[part]\nkind = \"gear\"\nteeth = 20\n")]);
    let run = scratch.run(&["generate", "gear.toml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for left_out in ["module", "kp", "kr", "ks", "knf", "tip_radius", "offset"] {
        assert!(run.stderr.contains(left_out), "no {left_out} in\n{}", run.stderr);
    }
}

#[test]
fn a_part_file_is_sent_as_it_is_generated() {
    let scratch = Scratch::with(&[("gear.toml", SAID_IN_FULL)]);
    let generated = scratch.run(&["generate", "gear.toml"]).stdout;
    let sent = scratch.run(&["send", "gear.toml", "--dry-run"]);
    assert_eq!(sent.code, Some(0), "{}", sent.stderr);
    assert_eq!(sent.stdout, generated);
    for from_block in [2, 7, 100] {
        let rest = scratch.run(&["send", "gear.toml", "--dry-run", "--from-block", &from_block.to_string()]);
        let tail: String = generated.split_inclusive('\n').skip(from_block - 1).collect();
        assert_eq!((rest.code, rest.stdout), (Some(0), tail), "from block {from_block}\n{}", rest.stderr);
    }
}

/// `--from part` is among the words for `-`.
#[test]
fn a_part_file_is_read_from_standard_input_when_it_is_named_so() {
    let scratch = Scratch::with(&[("gear.toml", SAID_IN_FULL)]);
    let piped = scratch.run_with(SAID_IN_FULL, &["send", "-", "--from", "part", "--dry-run"]);
    assert_eq!(piped.code, Some(0), "{}", piped.stderr);
    assert_eq!(piped.stdout, scratch.run(&["generate", "gear.toml"]).stdout);
}

/// The kind is taken from the suffix, else from the content.
#[test]
fn a_part_file_without_a_suffix_is_known_by_its_content() {
    let scratch = Scratch::with(&[("gear", SAID_IN_FULL), ("gear.toml", SAID_IN_FULL)]);
    let run = scratch.run(&["send", "gear", "--dry-run"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert_eq!(run.stdout, scratch.run(&["send", "gear.toml", "--dry-run"]).stdout);
}

#[test]
fn of_a_wrong_part_file_nothing_is_printed_and_nobody_is_called() {
    for wrong in [
        "[part]\nkind = \"gear\"\nteeht = 36\n",
        "[part]\nkind = \"gear\"\nteeth = \"many\"\n",
        "[part]\nkind = \"gear\"\nknf = 0.5\n",
        "[part]\nkind = \"gear\"\n[wire]\noffset = 0.5\n",
        "[part]\nkind = \"cog\"\n",
        "[part]\nkind = \"gear\"\nteeth = = 3\n",
        "not toml at all",
        "",
    ] {
        let scratch = Scratch::with(&[("gear.toml", wrong)]);
        let ear = Ear::new();
        for arguments in [
            &["generate", "gear.toml"][..],
            &["send", "gear.toml", "--dry-run"],
            &["send", "gear.toml", "--port", &ear.port(), "--yes"],
        ] {
            let run = scratch.run(arguments);
            assert_eq!(
                (run.code, run.stdout.as_str()),
                (Some(3), ""),
                "{wrong:?} {arguments:?}\n{}",
                run.stderr
            );
        }
        assert!(!ear.has_been_called() && !scratch.has_journals(), "{wrong:?}");
    }
}

#[test]
fn an_option_beside_a_part_file_is_wrong_usage() {
    let scratch = Scratch::with(&[("gear.toml", SAID_IN_FULL)]);
    let run = scratch.run(&["generate", "gear.toml", "--teeth", "40"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{}", run.stderr);
    assert!(run.stderr.contains("--teeth"), "{}", run.stderr);
}
