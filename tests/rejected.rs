//! Programs with one thing wrong each, and what `dripfeed check` says about them.
//!
//! The first lines of a file in `tests/rejected` are, as remarks behind `;`, exactly what is found in it, in order:
//! `severity[code] line:column message`. A line `with …` holds options. Of a program in which remarks would themselves be
//! looked at they stand in a file beside it, `NAME.expected`. The file of the same name in `tests/accepted` is its twin
//! with the fault mended: nothing is found in it. What a person reads lies whole in `tests/golden/check`; it is rewritten
//! only when `DRIPFEED_BLESS=1` is set.

#[path = "gear/binary.rs"]
#[expect(dead_code, reason = "the program is run in the directory of its input")]
mod binary;

use std::path::{Path, PathBuf};

use binary::Run;

fn directory(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

fn programs(name: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(directory(name))
        .expect("the programs are there")
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|suffix| suffix != "toml" && suffix != "expected"))
        .collect();
    files.sort();
    assert!(files.len() > 10, "only {} programs in tests/{name}", files.len());
    files
}

/// What is expected of a program: its first remarks, or the file beside it.
fn expectations(file: &Path) -> Vec<String> {
    let beside = PathBuf::from(format!("{}.expected", file.display()));
    if let Ok(text) = std::fs::read_to_string(beside) {
        return text.lines().map(str::to_owned).collect();
    }
    let text = std::fs::read_to_string(file).expect("a program");
    text.lines().map_while(|line| line.strip_prefix("; ")).map(str::to_owned).collect()
}

fn check(file: &Path, more: &[&str]) -> Run {
    let name = file.file_name().expect("a name").to_string_lossy().into_owned();
    let mut command = binary::command(&["check", &name]);
    command.current_dir(file.parent().expect("a directory"));
    for words in expectations(file).iter().filter_map(|line| line.strip_prefix("with ")) {
        command.args(words.split_whitespace());
    }
    let output = command.args(more).output().expect("the program under test runs");
    Run {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).expect("text"),
        stderr: String::from_utf8(output.stderr).expect("text"),
    }
}

/// The findings as the heads of the files spell them.
fn findings(run: &Run) -> Vec<String> {
    let report: serde_json::Value = serde_json::from_str(&run.stdout).expect("one JSON object");
    let text = |value: &serde_json::Value| value.as_str().expect("a text").to_owned();
    let all = report["diagnostics"].as_array().expect("an array").iter();
    all.map(|d| {
        assert!(!text(&d["help"]).is_empty(), "{d} has no help");
        format!(
            "{}[{}] {}:{} {}",
            text(&d["severity"]),
            text(&d["code"]),
            d["line"],
            d["column"],
            text(&d["message"])
        )
    })
    .collect()
}

#[test]
fn each_rejected_program_is_told_what_its_first_lines_say() {
    let mut different = Vec::new();
    for file in programs("rejected") {
        let mut expected = expectations(&file);
        expected.retain(|line| line.starts_with("error[") || line.starts_with("warning["));
        assert!(!expected.is_empty(), "{} expects nothing", file.display());
        let run = check(&file, &["--json"]);
        let found = findings(&run);
        let exit = if expected.iter().any(|finding| finding.starts_with("error")) { 3 } else { 8 };
        if found != expected || run.code != Some(exit) {
            different.push(format!("{}: exit {:?}\n  {}", file.display(), run.code, found.join("\n  ")));
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn each_is_told_word_for_word_with_caret_and_help() {
    let blessed = std::env::var("DRIPFEED_BLESS").is_ok_and(|value| value == "1");
    let mut different = Vec::new();
    for file in programs("rejected") {
        let name = file.file_name().expect("a name").to_string_lossy().into_owned();
        let golden = directory("golden").join("check").join(format!("{name}.txt"));
        let run = check(&file, &[]);
        let said = format!("{}--- standard output\n{}", run.stderr, run.stdout);
        if blessed {
            std::fs::write(&golden, &said).expect("a golden file can be written");
        }
        if std::fs::read_to_string(&golden).unwrap_or_default() != said {
            different.push(format!("{name}:\n{said}"));
        }
        // A terminal breaks long sentences by itself; an excerpt must not lose its caret.
        for line in said.lines().filter(|line| line.contains(['│', '·'])) {
            assert!(line.chars().count() <= 80, "{name}: {line}");
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn each_has_a_twin_in_which_nothing_is_found() {
    let accepted = programs("accepted");
    for file in programs("rejected") {
        let twin = directory("accepted").join(file.file_name().expect("a name"));
        assert!(accepted.contains(&twin), "{} has no twin", file.display());
    }
    for file in accepted {
        let run = check(&file, &["--json"]);
        assert_eq!((findings(&run), run.code), (Vec::new(), Some(0)), "{}", file.display());
    }
}

#[test]
fn findings_are_shown_with_caret_and_help_and_nothing_of_them_on_standard_output() {
    let file = directory("rejected").join("syntax.3b");
    let run = check(&file, &[]);
    for (message, line) in expectations(&file).iter().zip(5..) {
        let (word, message) = message.split_once(' ').expect("two words");
        let message = message.split_once(' ').expect("a place and a message").1;
        assert!(run.stderr.contains(&format!("{word}: {message}")), "{}", run.stderr);
        assert!(run.stderr.contains(&format!("syntax.3b:{line}:")), "{}", run.stderr);
    }
    assert_eq!(run.stderr.matches("help:").count(), 3);
    assert!(run.stdout.contains("3 errors") && !run.stdout.contains("expected"));
}

#[test]
fn generated_gears_are_in_order() {
    for words in [
        vec!["generate", "gear"],
        vec!["generate", "gear", "--repeat", "3"],
        vec!["generate", "gear", "--direction", "ccw", "--lead-in", "-0.6,12.5"],
        vec!["generate", "gear", "--lead-in", "none", "--teeth", "61", "--module", "0.6"],
        vec!["generate", "gear", "--offset", "-0.05", "--tip-radius", "0.2"],
    ] {
        let program = binary::command(&words).output().expect("a gear");
        assert!(program.status.success(), "{words:?}");
        let file = tempfile::Builder::new().suffix(".3b").tempfile().expect("a file");
        std::fs::write(file.path(), &program.stdout).expect("a program");
        let run = check(file.path(), &["--json"]);
        assert_eq!((findings(&run), run.code), (Vec::new(), Some(0)), "{words:?}");
    }
}

#[test]
fn standard_input_is_checked_as_a_file_is() {
    use std::io::Write as _;
    use std::process::Stdio;
    let mut child = binary::command(&["check", "-", "--from", "3b"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program under test runs");
    child
        .stdin
        .take()
        .expect("a pipe")
        .write_all(b"B9900B0B9900GXL1\nB9900B0B39600GYNR1\n")
        .expect("written");
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(8));
    assert!(said.contains("warning[no-end]: no word ends the program"), "{said}");
    assert!(said.contains("B9900B0B39600GYNR1"), "the line is shown: {said}");
}
