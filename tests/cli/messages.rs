//! What is said to bad input, word for word.
//!
//! The complete standard error of each case is compared with `tests/golden/messages/NAME.txt`. The test's own directory
//! is written `DIR` there.

use crate::golden;
use crate::scratch::{PROGRAM, Scratch};

/// One bad input: the golden file's name, the exit code, the words, and a file `in.3b` or `in.toml` if it has one.
struct Case(&'static str, i32, &'static str, &'static str);

/// Everything a profile can say, so that nothing is taken from elsewhere and the latency is not looked up.
const BENCH: &str = include_str!("../data/bench.toml");

/// Runs each case and compares; all that differ are reported together.
fn compare(input: &str, cases: &[Case]) {
    let mut different = Vec::new();
    for Case(name, code, words, text) in cases {
        let scratch = Scratch::with(&[("good.3b", PROGRAM), ("bench.toml", BENCH)]);
        if !input.is_empty() {
            scratch.write(input, text);
        }
        let run = scratch.run(&words.split_whitespace().collect::<Vec<_>>());
        let directory = scratch.path().to_string_lossy().into_owned();
        let said = run.stderr.replace(&directory, "DIR");
        if let Some(difference) = golden::difference(&format!("messages/{name}.txt"), &said) {
            different.push(format!("{name}: dripfeed {words}\n{difference}"));
        }
        if run.code != Some(*code) {
            different.push(format!("{name}: exit {:?} instead of {code}", run.code));
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n"));
}

const WORDS: &[Case] = &[
    Case("words-none", 2, "", ""),
    Case("words-unknown-command", 2, "sned good.3b", ""),
    Case("words-unknown-option", 2, "generate gear --teeths 12", ""),
    Case("words-nothing-to-generate", 2, "generate", ""),
    Case("words-nothing-to-send", 2, "send", ""),
    Case("words-unknown-kind", 2, "generate --explain gaer", ""),
    Case("words-lead-in", 2, "generate gear --lead-in left", ""),
    Case("words-teeth-fractional", 2, "generate gear --teeth=12.5", ""),
    Case("words-teeth-negative", 2, "generate gear --teeth=-5", ""),
    Case("words-repeat-zero", 2, "generate gear --repeat=0", ""),
    Case("words-no-such-job", 2, "jobs show nothing", ""),
    Case("words-nothing-to-resume", 2, "resume", ""),
    Case("words-offset-keyed-into-3b", 2, "check good.3b --offset 0.1", ""),
];

const GEARS: &[Case] = &[
    Case("gear-teeth-zero", 3, "generate gear --teeth=0", ""),
    Case("gear-teeth-two", 3, "generate gear --teeth=2", ""),
    Case("gear-module-zero", 3, "generate gear --module=0", ""),
    Case("gear-module-negative", 3, "generate gear --module=-0.4", ""),
    Case("gear-module-nan", 3, "generate gear --module=nan", ""),
    Case("gear-module-infinite", 3, "generate gear --module=inf", ""),
    Case("gear-offset-nan", 3, "generate gear --offset=nan", ""),
    Case("gear-tip-radius-negative", 3, "generate gear --tip-radius=-0.01", ""),
    Case("gear-no-tooth-space", 3, "generate gear --ks=3.2 --offset=0", ""),
    Case(
        "gear-tooth-too-thick",
        3,
        "generate gear --ks=1.7 --kp=0.8 --knf=1.9 --tip-radius=0.002 --offset=0",
        "",
    ),
    Case("gear-tip-radius-above-flank-radius", 3, "generate gear --tip-radius=0.8", ""),
    Case("gear-tip-radius-between-flanks", 3, "generate gear --tip-radius=0.4", ""),
    Case("gear-flank-radius-above-centre-circle", 3, "generate gear --kp=18", ""),
    Case("gear-flank-vanishes", 3, "generate gear --knf=0.5", ""),
    Case("gear-flank-misses-pitch-circle", 3, "generate gear --kp=0.1 --tip-radius=0.01", ""),
    Case("gear-root-inside-centre", 3, "generate gear --knf=20", ""),
    Case("gear-wire-too-thick", 3, "generate gear --offset=0.5", ""),
    Case("gear-wire-too-thick-trimmed", 3, "generate gear --offset=0.5 --trim", ""),
    Case("gear-die-tip-flank-vanishes", 3, "generate gear --offset=-0.4", ""),
    Case("gear-sharp-tip", 0, "generate gear --offset=-0.07", ""),
    Case("gear-lead-in-crosses", 0, "generate gear", ""),
];

const PARTS: &[Case] = &[
    Case("part-unknown-key", 3, "generate in.toml", "[part]\nkind = \"gear\"\nteeht = 36\n"),
    Case(
        "part-unknown-section",
        3,
        "generate in.toml",
        "[part]\nkind = \"gear\"\n\n[wires]\noffset = 0.07\n",
    ),
    Case("part-unknown-kind", 3, "generate in.toml", "[part]\nkind = \"gaer\"\n"),
    Case("part-kind-missing", 3, "generate in.toml", "[part]\nteeth = 36\n"),
    Case("part-section-missing", 3, "generate in.toml", "[wire]\noffset = 0.07\n"),
    Case("part-empty", 3, "generate in.toml", ""),
    Case("part-word-for-number", 3, "generate in.toml", "[part]\nkind = \"gear\"\nmodule = \"0.4\"\n"),
    Case("part-teeth-fractional", 3, "generate in.toml", "[part]\nkind = \"gear\"\nteeth = 36.5\n"),
    Case("part-nan", 3, "generate in.toml", "[part]\nkind = \"gear\"\nmodule = nan\n"),
    Case("part-truth-for-number", 3, "generate in.toml", "[part]\nkind = \"gear\"\ntip_radius = true\n"),
    Case("part-lead-in", 3, "generate in.toml", "[part]\nkind = \"gear\"\nlead_in = [1]\n"),
    Case(
        "part-wire-twice",
        3,
        "generate in.toml",
        "[part]\nkind = \"gear\"\n[wire]\noffset = 0.07\ndiameter = 0.12\n",
    ),
    Case("part-wire-half", 3, "generate in.toml", "[part]\nkind = \"gear\"\n[wire]\ndiameter = 0.12\n"),
    Case(
        "part-unknown-word",
        3,
        "generate in.toml",
        "[part]\nkind = \"gear\"\n[output]\nrounding = \"per-blok\"\n",
    ),
    Case("part-key-twice", 3, "generate in.toml", "[part]\nkind = \"gear\"\nteeth = 36\nteeth = 37\n"),
    Case("part-no-toml", 3, "generate in.toml", "[part\nkind = \"gear\"\n"),
    Case("part-impossible-tooth", 3, "generate in.toml", "[part]\nkind = \"gear\"\nknf = 0.5\n"),
    Case("part-option-beside", 2, "generate in.toml --teeth 40", "[part]\nkind = \"gear\"\n"),
    Case("part-missing", 3, "generate nothing.toml", ""),
];

const PROGRAMS: &[Case] = &[
    Case("3b-digit", 3, "send in.3b --dry-run", "B1B0B1GXL1\nB1B2B3GXL5\n"),
    Case("3b-number-missing", 3, "send in.3b --dry-run", "B1B2GXL1\n"),
    Case("3b-fourth-number", 3, "send in.3b --dry-run", "B1B2B3B4GXL1\n"),
    Case("3b-sign", 3, "send in.3b --dry-run", "B-1B2B3GXL1\n"),
    Case("3b-point", 3, "send in.3b --dry-run", "B1.5B2B3GXL1\n"),
    Case("3b-axis", 3, "send in.3b --dry-run", "B1B2B3GZL1\n"),
    Case("3b-kind", 3, "send in.3b --dry-run", "B1B2B3GXR1\n"),
    Case("3b-too-large", 3, "send in.3b --dry-run", "B99999999999B2B3GXL1\n"),
    Case("3b-after-stop", 3, "send in.3b --dry-run", "B1B2B3GXL1\nDD\nB1B2B3GXL1\n"),
    Case("3b-arc-on-its-centre", 3, "send in.3b --dry-run", "B1B0B1GXL1\nB0B0B5GXNR1\n"),
    Case("3b-no-program", 3, "send in.3b --dry-run", "Dear Bob,\n"),
    Case("3b-empty", 3, "send in.3b --dry-run", ""),
];

const SENDING: &[Case] = &[
    Case("send-no-file", 3, "send nothing.3b --dry-run", ""),
    Case("send-directory", 3, "send . --dry-run", ""),
    Case("send-standard-input-unnamed", 2, "send - --dry-run", ""),
    Case("send-no-port", 2, "send good.3b", ""),
    Case("send-unknown-kind-of-port", 2, "send good.3b --port usb://1", ""),
    Case("send-port-missing", 5, "send good.3b --port /dev/no-such-port --machine bench.toml", ""),
    Case("send-port-refused", 5, "send good.3b --port tcp://127.0.0.1:1 --machine bench.toml", ""),
    Case("send-block-beyond", 2, "send good.3b --dry-run --from-block 4", ""),
    Case(
        "send-needs-answer",
        2,
        "send good.3b --port /dev/no-such-port --machine bench.toml --from-block 2",
        "",
    ),
    Case("send-baud", 2, "send good.3b --port /dev/no-such-port --machine bench.toml --baud 0", ""),
    Case("send-framing", 2, "send good.3b --port /dev/no-such-port --machine bench.toml --framing 7X2", ""),
    Case(
        "send-set-no-value",
        2,
        "send good.3b --port /dev/no-such-port --machine bench.toml --set pacing",
        "",
    ),
    Case(
        "send-set-unknown",
        2,
        "send good.3b --port /dev/no-such-port --machine bench.toml --set paceing=free",
        "",
    ),
];

const LEAD_IN: &[Case] = &[Case(
    "send-needs-answer-lead-in",
    2,
    "send in.toml --port /dev/no-such-port --machine bench.toml",
    "[part]\nkind = \"gear\"\n",
)];

const MACHINES: &[Case] = &[
    Case("machine-unknown", 4, "machines show nothing", ""),
    Case(
        "machine-unknown-key",
        4,
        "machines check in.toml",
        "[machine]\nname = \"m\"\n[link]\nbuad = 9600\n",
    ),
    Case(
        "machine-word-for-number",
        4,
        "machines check in.toml",
        "[machine]\nname = \"m\"\n[link]\nbaud = \"fast\"\n",
    ),
    Case(
        "machine-framing",
        4,
        "machines check in.toml",
        "[machine]\nname = \"m\"\n[link]\nframing = \"9X3\"\n",
    ),
    Case(
        "machine-protocol",
        4,
        "machines check in.toml",
        "[machine]\nname = \"m\"\n[protocol]\nname = \"dc-cods\"\n",
    ),
    Case("machine-no-toml", 4, "machines check in.toml", "[machine]\nname = \n"),
];

#[test]
fn wrong_words_are_answered_word_for_word() {
    compare("", WORDS);
}

#[test]
fn impossible_gears_are_answered_word_for_word() {
    compare("", GEARS);
}

#[test]
fn wrong_part_files_are_answered_word_for_word() {
    compare("in.toml", PARTS);
}

#[test]
fn malformed_programs_are_answered_word_for_word() {
    compare("in.3b", PROGRAMS);
}

#[test]
fn what_cannot_be_sent_is_answered_word_for_word() {
    compare("", SENDING);
    compare("in.toml", LEAD_IN);
}

#[test]
fn wrong_machine_profiles_are_answered_word_for_word() {
    compare("in.toml", MACHINES);
}

#[test]
fn no_golden_message_is_left_over() {
    let known: Vec<String> = [WORDS, GEARS, PARTS, PROGRAMS, SENDING, LEAD_IN, MACHINES]
        .into_iter()
        .flatten()
        .map(|Case(name, ..)| format!("{name}.txt"))
        .collect();
    let present = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/messages"))
        .expect("the golden files");
    for file in present {
        let name = file.expect("a golden file").file_name().to_string_lossy().into_owned();
        assert!(known.contains(&name), "{name} belongs to no case");
    }
}
