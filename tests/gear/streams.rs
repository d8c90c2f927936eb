//! Blocks on demand: long programs begin at once, end quietly when nobody reads on, and take no more memory than
//! short ones.

use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, Stdio};

use mock_controller::{Kind, Model};

use crate::binary::{command, dripfeed};
use crate::execution::{MODELS, execute, promise_kept, read};
use crate::outlines::generate;
use crate::part::{PAPERS_PART, Part};
use crate::theory::{Gear, PAPER};

fn started(arguments: &[&str]) -> Child {
    command(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program under test can be started")
}

/// Five lines are read of a program that would take minutes to print; then the reader goes away.
fn first_five_lines(arguments: &[&str]) -> (Vec<String>, Option<i32>, String) {
    let mut child = started(arguments);
    let reader = BufReader::new(child.stdout.take().expect("a pipe"));
    let lines: Result<Vec<String>, _> = reader.lines().take(5).collect();
    let output = child.wait_with_output().expect("the program ends");
    let stderr = String::from_utf8(output.stderr).expect("standard error is text");
    (lines.expect("five lines"), output.status.code(), stderr)
}

#[test]
fn the_first_blocks_of_a_million_turns_come_at_once_and_a_closed_pipe_ends_it_quietly() {
    let (lines, code, stderr) =
        first_five_lines(&["generate", "gear", "--repeat", "1000000", "--lead-in", "none"]);
    let whole = dripfeed(&["generate", "gear", "--lead-in", "none"]).stdout;
    assert_eq!(lines, whole.lines().take(5).collect::<Vec<_>>());
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
}

#[test]
fn a_closed_pipe_says_nothing_beyond_the_warning_that_stands_already() {
    let (_, code, stderr) = first_five_lines(&["generate", "gear", "--repeat", "1000000"]);
    assert_eq!(code, Some(0));
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    assert!(stderr.starts_with("warning: the lead-in"), "{stderr}");
}

#[test]
fn the_same_gear_is_the_same_bytes_every_time() {
    for more in [&[][..], &["--interpolator", "exact"], &["--rounding", "per-block"], &["--repeat", "3"]] {
        let arguments = [&["generate", "gear", "--offset=-0.055", "--teeth=41"][..], more].concat();
        let (first, second) = (dripfeed(&arguments), dripfeed(&arguments));
        assert_eq!(first.code, Some(0), "{}", first.stderr);
        assert_eq!(first.stdout, second.stdout, "{more:?}");
        assert_eq!(first.stderr, second.stderr, "{more:?}");
    }
}

#[test]
fn a_second_turn_is_the_first_once_more() {
    let once = dripfeed(&["generate", "gear", "--end", "none"]).stdout;
    let thrice = dripfeed(&["generate", "gear", "--end", "none", "--repeat", "3"]).stdout;
    let lead_in = once.find('\n').expect("a line") + 1;
    assert_eq!(thrice, format!("{once}{0}{0}", &once[lead_in..]));
}

/// The lead-in is a metre long: one block counts at most 999 999 µm, so it takes two.
#[test]
fn a_gear_of_5000_teeth_is_right_to_the_last_node() {
    let part = Part { gear: Gear { teeth: 5000, ..PAPER }, ..PAPERS_PART };
    let (program, _) = generate(&part, &["--interpolator", "rotated"]);
    assert!(program.blocks.iter().all(|block| block.j <= 999_999));
    assert_eq!(program.blocks.iter().take_while(|block| block.kind == Kind::Line).count(), 2);
    let verdict = promise_kept(&program.blocks, &part.path(), "rotated");
    assert!(verdict.is_ok(), "{:?}", verdict.err());
}

#[test]
fn a_gear_of_5000_teeth_closes_under_every_model() {
    let part = Part { gear: Gear { teeth: 5000, ..PAPER }, ..PAPERS_PART };
    let (program, _) = generate(&part, &[]);
    let lead_in = program.blocks.iter().take_while(|block| block.kind == Kind::Line).count();
    for model in MODELS {
        let places = execute(model, &program.blocks, [0, 0]).expect("the program can be executed");
        assert_eq!(places[lead_in], places[program.blocks.len()], "{model:?}");
    }
    let path_um: u64 = program.blocks.iter().map(|block| u64::from(block.j)).sum();
    assert!(crate::execution::pulses(Model::Rotated, &program.blocks) > path_um);
}

/// The largest memory a running process has ever held, kB.
#[cfg(target_os = "linux")]
fn peak_kb(child: &Child) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).expect("a running process");
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).expect("a process with memory");
    line.split_whitespace().nth(1).and_then(|number| number.parse().ok()).expect("a number of kB")
}

/// 5 million blocks. The pipe holds far less than is still to come whenever the memory is looked at, so the process is
/// alive then.
#[cfg(target_os = "linux")]
#[test]
fn twenty_thousand_turns_take_no_more_memory_than_the_first_few() {
    let mut child = started(&["generate", "gear", "--repeat", "20000", "--lead-in", "none"]);
    let mut stdout = child.stdout.take().expect("a pipe");
    let mut buffer = vec![0; 1 << 20];
    let (mut bytes, mut early) = (0_usize, None);
    while bytes < 60_000_000 {
        let count = stdout.read(&mut buffer).expect("more blocks");
        assert!(count > 0, "the program ended after {bytes} bytes");
        bytes += count;
        if early.is_none() && bytes > 1_000_000 {
            early = Some(peak_kb(&child));
        }
    }
    let (early, late) = (early.expect("a first look"), peak_kb(&child));
    assert!(late < 16 * 1024, "{late} kB");
    assert!(late < early + 512, "{early} kB after a million bytes, {late} kB after sixty million");
    let mut rest = Vec::new();
    stdout.read_to_end(&mut rest).expect("the rest of the program");
    assert!(rest.ends_with(b"\nDD\n"), "the program ends with its stop word");
    assert_eq!(child.wait().expect("the program ends").code(), Some(0));
}

#[test]
fn a_long_program_reads_back_as_the_blocks_it_is_made_of() {
    let text = dripfeed(&["generate", "gear", "--repeat", "50"]).stdout;
    let once = dripfeed(&["generate", "gear"]).stdout;
    assert_eq!(read(&text).blocks.len(), 1 + 50 * (read(&once).blocks.len() - 1));
}
