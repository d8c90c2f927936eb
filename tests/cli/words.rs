//! Words on the command line: known and unknown ones, help that fits the screen, streams that go nowhere.

use std::collections::VecDeque;
use std::process::Stdio;

use crate::binary::dripfeed;
use crate::scratch::{PROGRAM, Scratch};

#[test]
fn no_arguments_is_wrong_usage_and_shows_the_commands_on_standard_error() {
    let run = Scratch::new().run(&[]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""));
    for command in ["Usage:", "demo", "generate", "send", "resume", "jobs", "machines"] {
        assert!(run.stderr.contains(command), "no {command} in\n{}", run.stderr);
    }
}

#[test]
fn an_unknown_word_is_wrong_usage_and_is_repeated() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for arguments in [
        &["frobnicate"][..],
        &["--frobnicate"],
        &["generate", "--frobnicate"],
        &["generate", "gear", "frobnicate"],
        &["generate", "--explain", "frobnicate"],
        &["generate", "gear", "--format", "frobnicate"],
        &["generate", "gear", "--rounding", "frobnicate"],
        &["generate", "gear", "--interpolator", "frobnicate"],
        &["generate", "gear", "--direction", "frobnicate"],
        &["generate", "gear", "--lead-in", "frobnicate"],
        &["generate", "gear", "--end", "frobnicate"],
        &["generate", "gear", "--repeat", "frobnicate"],
        &["send", "good.3b", "frobnicate"],
        &["send", "good.3b", "--dry-run", "--from", "frobnicate"],
        &["send", "good.3b", "--dry-run", "--from-block", "frobnicate"],
        &["send", "good.3b", "--port", "frobnicate://x"],
        &["send", "good.3b", "--port", "/dev/nope", "--baud", "frobnicate"],
        &["send", "good.3b", "--port", "/dev/nope", "--framing", "frobnicate"],
        &["send", "good.3b", "--port", "/dev/nope", "--protocol", "frobnicate"],
        &["send", "good.3b", "--port", "/dev/nope", "--set", "frobnicate"],
        &["send", "good.3b", "--port", "/dev/nope", "--set", "frobnicate=1"],
        &["jobs", "frobnicate"],
        &["jobs", "show", "frobnicate"],
        &["machines", "frobnicate"],
        &["resume", "frobnicate"],
    ] {
        let run = scratch.run(arguments);
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{arguments:?}\n{}", run.stderr);
        assert!(run.stderr.contains("frobnicate"), "{arguments:?}\n{}", run.stderr);
        assert!(run.stderr.starts_with("error: ") || run.stderr.contains("\nerror: "), "{}", run.stderr);
    }
}

#[test]
fn a_misspelt_command_or_option_is_answered_with_the_right_one() {
    let scratch = Scratch::new();
    for (arguments, meant) in [
        (&["sned"][..], "'send'"),
        (&["genrate"], "'generate'"),
        (&["machine"], "'machines'"),
        (&["generate", "gear", "--teeths", "5"], "'--teeth'"),
        (&["generate", "gear", "--ofset", "0.1"], "'--offset'"),
        (&["send", "x.3b", "--dryrun"], "'--dry-run'"),
    ] {
        let run = scratch.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}");
        assert!(
            run.stderr.contains("similar") && run.stderr.contains(meant),
            "{arguments:?}\n{}",
            run.stderr
        );
    }
}

#[test]
fn zero_is_no_count() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for arguments in [
        &["generate", "gear", "--repeat", "0"][..],
        &["send", "good.3b", "--dry-run", "--from-block", "0"],
        &["send", "good.3b", "--dry-run", "--from-block=-1"],
    ] {
        let run = scratch.run(arguments);
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{arguments:?}\n{}", run.stderr);
    }
}

#[cfg(unix)]
#[test]
fn a_word_that_is_no_text_is_wrong_usage() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;

    let scratch = Scratch::new();
    let no_text = OsStr::from_bytes(b"\xFF\xFE");
    let output = scratch.command(&[]).arg(no_text).output().expect("the program can be started");
    assert_eq!(output.status.code(), Some(2));
    let output = scratch.command(&["generate", "gear", "--end"]).arg(no_text).output();
    assert_eq!(output.expect("the program can be started").status.code(), Some(2));
}

/// The lines under "Commands:", their first words; `help` itself left out.
fn commands_in(help: &str) -> Vec<String> {
    help.lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|word| *word != "help")
        .map(str::to_owned)
        .collect()
}

/// Every command and command of a command, found by reading the help.
fn every_command() -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut open = VecDeque::from([Vec::new()]);
    while let Some(words) = open.pop_front() {
        let help = help(&words, "--help");
        for command in commands_in(&help) {
            open.push_back([words.clone(), vec![command]].concat());
        }
        found.push(words);
    }
    found
}

fn help(words: &[String], flag: &str) -> String {
    let mut arguments: Vec<&str> = words.iter().map(String::as_str).collect();
    arguments.push(flag);
    let run = dripfeed(&arguments);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{arguments:?}");
    run.stdout
}

#[test]
fn the_help_names_every_command_it_is_to_name() {
    let found: Vec<String> = every_command().iter().map(|words| words.join(" ")).collect();
    for wanted in [
        "",
        "demo",
        "generate",
        "send",
        "resume",
        "jobs",
        "jobs show",
        "machines",
        "machines show",
        "machines check",
    ] {
        assert!(found.iter().any(|words| words == wanted), "no {wanted:?} in {found:?}");
    }
}

#[test]
fn the_help_of_every_command_fits_100_columns() {
    let mut too_long = Vec::new();
    for words in every_command() {
        for flag in ["--help", "-h"] {
            for line in help(&words, flag).lines() {
                if line.chars().count() > 100 {
                    too_long.push(format!(
                        "{} {flag}: {} columns: {line}",
                        words.join(" "),
                        line.chars().count()
                    ));
                }
            }
        }
    }
    assert!(too_long.is_empty(), "{too_long:#?}");
}

#[test]
fn the_version_is_that_of_the_package() {
    let run = dripfeed(&["--version"]);
    assert_eq!(run.stdout, format!("dripfeed {}\n", env!("CARGO_PKG_VERSION")));
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
}

/// What prints something, and ends with 0 when somebody reads it.
const TALKATIVE: [&[&str]; 10] = [
    &["--help"],
    &["--version"],
    &["generate", "--help"],
    &["generate", "gear", "--lead-in", "none"],
    &["generate", "--explain", "gear"],
    &["send", "good.3b", "--dry-run"],
    &["jobs"],
    &["jobs", "--json"],
    &["machines", "--json"],
    &["machines", "show", "generic-iso"],
];

#[test]
fn a_closed_output_pipe_ends_every_command_quietly() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for arguments in TALKATIVE {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let output = scratch.command(arguments).stdout(writer).stderr(Stdio::piped()).output();
        let output = output.expect("the program can be started");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), stderr.as_ref()), (Some(0), ""), "{arguments:?}");
    }
}

/// Unlike a reader who goes away, a full disk loses what was asked for.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_standard_output_is_a_failure_of_the_systems() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for arguments in [
        &["generate", "gear"][..],
        &["generate", "--explain", "gear"],
        &["send", "good.3b", "--dry-run"],
        &["machines", "--json"],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
        let output = scratch.command(arguments).stdout(full).stderr(Stdio::piped()).output();
        let output = output.expect("the program can be started");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}\n{stderr}");
        assert!(stderr.contains("error: "), "{arguments:?}\n{stderr}");
    }
}
