//! `check` and `plot` in the hands of scripts and pipes: what cannot be read, what cannot be written, no terminal.

use std::io::Read as _;
use std::process::Stdio;

use crate::scratch::{PROGRAM, Scratch};

/// A closed ring with its way in, in order.
const RING: &str = "B5000B0B005000GXL1\nB9900B0B039600GYNR3\nDD\n";

#[test]
fn what_is_not_there_and_what_is_no_file_are_told_with_the_name_and_the_exit_code_of_the_program() {
    let scratch = Scratch::new();
    std::fs::create_dir(scratch.path().join("dir.3b")).expect("a directory");
    scratch.write("empty.3b", "");
    for words in [
        &["check", "none.3b"][..],
        &["plot", "none.3b", "-o", "out.svg"],
        &["check", "dir.3b"],
        &["plot", "dir.3b", "-o", "out.svg"],
        &["plot", "empty.3b", "-o", "out.svg"],
    ] {
        let run = scratch.run(words);
        assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{words:?}: {}", run.stderr);
        assert!(run.stderr.contains(words[1]) && run.stderr.contains("help:"), "{words:?}: {}", run.stderr);
        assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
    }
    assert!(!scratch.path().join("out.svg").exists(), "no picture of nothing");
    let run = scratch.run(&["check", "empty.3b"]);
    assert_eq!(run.code, Some(3));
    assert!(run.stderr.contains("error[no-cut]"), "{}", run.stderr);
}

#[test]
fn a_picture_that_cannot_be_written_is_a_failure_of_the_system_and_a_name_that_says_nothing_is_wrong_usage() {
    let scratch = Scratch::with(&[("ring.3b", RING)]);
    std::fs::create_dir(scratch.path().join("dir.svg")).expect("a directory");
    for (out, code) in [("none/out.svg", 1), ("dir.svg", 1), ("out.gif", 2), ("out", 2)] {
        let run = scratch.run(&["plot", "ring.3b", "-o", out]);
        assert_eq!((run.code, run.stdout.as_str()), (Some(code), ""), "{out}: {}", run.stderr);
        assert!(run.stderr.contains(out), "{out}: {}", run.stderr);
    }
    let run = scratch.run(&["plot", "ring.3b", "-o", "-", "--json"]);
    assert_eq!(run.code, Some(2), "one standard output cannot take two things");
}

#[test]
fn a_closed_pipe_ends_both_quietly() {
    let scratch = Scratch::new();
    // Enough to say for any pipe to fill.
    scratch.write("bad.3b", &format!("{}DD\n", "B100B20B000100GZL1\n".repeat(900)));
    let wave: String = (0..20_000).map(|n| format!("B100B{0}B{0:06}GYL1\n", 300 + n % 97)).collect();
    scratch.write("wave.3b", &wave);
    for words in [
        &["check", "bad.3b", "--json"][..],
        &["check", "ring.3b", "--restart-points"],
        &["plot", "wave.3b", "-o", "-"],
    ] {
        scratch.write("ring.3b", &RING.replace("DD\n", "D\n").repeat(20_000));
        let mut child = scratch
            .command(words)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        let mut pipe = child.stdout.take().expect("a pipe");
        let mut few = [0; 16];
        pipe.read_exact(&mut few).expect("it begins");
        drop(pipe);
        let output = child.wait_with_output().expect("it ends");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            !said.contains("panicked") && !said.to_lowercase().contains("broken pipe"),
            "{words:?}: {said}"
        );
        assert!(output.status.code().is_some_and(|code| [0, 3, 8].contains(&code)), "{words:?}: {output:?}");
    }
}

#[test]
fn without_a_terminal_nothing_is_coloured_and_an_excerpt_with_its_caret_fits_80_columns() {
    let long = format!("{}B5B6B7GZL1{}\n", "B100B20B000100GXL1".repeat(40), "B1B1B1GYL1".repeat(40));
    let scratch = Scratch::with(&[
        ("long.3b", &long),
        ("bad.3b", "B100B20B000100GZL1\nB1B2B3GXL9\n"),
        ("open.3b", PROGRAM),
    ]);
    for words in [
        &["check", "bad.3b"][..],
        &["check", "open.3b"],
        &["check", "long.3b"],
        &["check", "bad.3b", "--json"],
        &["plot", "open.3b", "-o", "out.svg"],
        &["plot", "bad.3b", "-o", "out.svg"],
    ] {
        let run = scratch.run(words);
        for text in [&run.stdout, &run.stderr] {
            assert!(!text.contains('\u{1b}'), "{words:?}: {text:?}");
        }
        for line in run.stderr.lines().filter(|line| line.contains(['│', '·'])) {
            assert!(line.chars().count() <= 80, "{words:?}: {line}");
        }
    }
}

#[test]
fn standard_input_must_be_named_and_is_then_read_as_a_file_is() {
    let scratch = Scratch::new();
    for words in [&["check", "-"][..], &["plot", "-", "-o", "out.svg"]] {
        let run = scratch.run_with(RING, words);
        assert_eq!(run.code, Some(2), "{words:?}");
        assert!(run.stderr.contains("--from"), "{words:?}: {}", run.stderr);
    }
    assert_eq!(scratch.run_with(RING, &["check", "-", "--from", "3b"]).code, Some(0));
    let piped = scratch.run_with(RING, &["plot", "-", "--from", "3b", "-o", "-"]);
    assert_eq!(piped.code, Some(0), "{}", piped.stderr);
    scratch.write("ring.3b", RING);
    let named = scratch.run(&["plot", "ring.3b", "-o", "-"]);
    let without_title = |text: &str| text.lines().filter(|line| !line.starts_with("<title>")).count();
    assert_eq!(without_title(&piped.stdout), without_title(&named.stdout));
    assert!(piped.stdout.trim_end().ends_with("</svg>"));
}

#[test]
fn the_exit_code_says_whether_nothing_warnings_or_errors_were_found() {
    let scratch = Scratch::with(&[
        ("good.3b", RING),
        ("warned.3b", RING.trim_end_matches("DD\n")),
        ("wrong.3b", "B5000B0B005000GXL1\nB9900B0B039600GXNR3\nDD\n"),
        ("small.toml", "[machine]\nname = \"x\"\n[travel]\nx_mm = -1\n"),
    ]);
    for (words, code) in [
        (&["check", "good.3b"][..], 0),
        (&["check", "warned.3b"], 8),
        (&["check", "wrong.3b"], 3),
        (&["check", "good.3b", "--machine", "small.toml"], 4),
        (&["check", "good.3b", "--machine", "nobody"], 4),
        (&["check", "good.3b", "--register", "one"], 2),
        (&["check", "good.3b", "--dialect", "fanuc"], 2),
        (&["plot", "good.3b", "-o", "out.svg", "--wire", "x"], 2),
    ] {
        let run = scratch.run(words);
        assert_eq!(run.code, Some(code), "{words:?}: {}", run.stderr);
        let json = scratch.run(&[words, &["--json"]].concat());
        assert_eq!(json.code, Some(code), "{words:?} --json");
    }
}

#[test]
fn json_has_the_fields_of_the_contract_and_syntax_only_looks_at_nothing_else() {
    let scratch = Scratch::with(&[("open.3b", PROGRAM), ("bad.3b", "B100B20B000100GZL1\n")]);
    let json = |words: &[&str]| -> serde_json::Value {
        serde_json::from_str(&scratch.run(words).stdout).expect("one JSON object")
    };
    let report = json(&["check", "open.3b", "--json"]);
    let found = report["diagnostics"].as_array().expect("an array");
    assert!(!found.is_empty());
    for diagnostic in found {
        for key in ["severity", "code", "message", "help"] {
            assert!(diagnostic[key].as_str().is_some_and(|text| !text.is_empty()), "{diagnostic}");
        }
        for key in ["line", "column", "block"] {
            assert!(diagnostic[key].is_u64(), "{diagnostic}");
        }
    }
    assert_eq!(json(&["check", "open.3b", "--json", "--syntax-only"])["diagnostics"], serde_json::json!([]));
    assert_eq!(json(&["check", "bad.3b", "--json", "--syntax-only"])["diagnostics"][0]["code"], "syntax");
    let points = json(&["check", "open.3b", "--json", "--restart-points"]);
    assert_eq!(points["restart_points"][0]["block"], 1, "{points}");
}
