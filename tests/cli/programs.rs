//! 3B programs given to `send`: what is taken, what is refused before a byte leaves, what a dry run prints.

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::Stdio;

use crate::scratch::{Ear, PROGRAM, Scratch};

#[test]
fn a_dry_run_prints_exactly_the_program_and_calls_nobody() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    let ear = Ear::new();
    for arguments in [
        &["send", "good.3b", "--dry-run"][..],
        &["send", "good.3b", "--dry-run", "--port", &ear.port()],
        &["send", "good.3b", "--dry-run", "--port", "/dev/no-such-port"],
        &["send", "good.3b", "--dry-run", "--yes", "--machine", "generic-iso"],
    ] {
        let run = scratch.run(arguments);
        assert_eq!((run.code, run.stdout.as_str()), (Some(0), PROGRAM), "{arguments:?}\n{}", run.stderr);
    }
    assert!(!ear.has_been_called());
    assert!(!scratch.has_journals(), "a dry run leaves no journal");
}

#[test]
fn a_dry_run_from_a_block_is_the_tail_of_the_program() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for from_block in 1..=3 {
        let run = scratch.run(&["send", "good.3b", "--dry-run", "--from-block", &from_block.to_string()]);
        let tail: String = PROGRAM.split_inclusive('\n').skip(from_block - 1).collect();
        assert_eq!((run.code, run.stdout), (Some(0), tail), "from block {from_block}\n{}", run.stderr);
    }
}

#[test]
fn a_block_beyond_the_last_is_refused_with_the_number_there_are() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for from_block in ["4", "5", "18446744073709551615"] {
        let run = scratch.run(&["send", "good.3b", "--dry-run", "--from-block", from_block]);
        assert!(matches!(run.code, Some(2 | 3)), "{from_block}: {:?} {}", run.code, run.stderr);
        assert_eq!(run.stdout, "");
        assert!(run.stderr.contains(from_block) && run.stderr.contains("3 blocks"), "{}", run.stderr);
    }
}

#[test]
fn what_is_generated_may_be_piped_into_send() {
    let scratch = Scratch::new();
    let generated = scratch.run(&["generate", "gear", "--repeat", "2"]).stdout;
    let sent = scratch.run_with(&generated, &["send", "-", "--from", "3b", "--dry-run"]);
    assert_eq!((sent.code, sent.stdout), (Some(0), generated));
}

#[test]
fn standard_input_must_be_named() {
    let run = Scratch::new().run_with(PROGRAM, &["send", "-", "--dry-run"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{}", run.stderr);
    assert!(run.stderr.contains("--from"), "{}", run.stderr);
}

/// A listing of the trade: numbers in front, ends behind, rows of stars, small letters, bare axes, blocks run together.
/// A dry run is compared block by block, white space aside.
#[test]
fn whatever_the_trade_writes_around_blocks_is_not_a_block() {
    let listing = "%\n* * * * *\nStart Point = 0.000, 6.642\n(Blocks By Bench)\nN   1: B579B6617B006617 Y L2 ; -0.579, 6.617\n\
                   b19b222b232gynr4 BBB9900GXL1\n  B 1 B 2\n B 2 GY L 3\nN 5: DD\n%\n";
    let scratch = Scratch::with(&[("listing.3b", listing)]);
    let run = scratch.run(&["send", "listing.3b", "--dry-run"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let blocks = run.stdout.lines().filter(|line| line.to_uppercase().contains('B'));
    let read: Vec<String> = blocks
        .map(|line| {
            mock_controller::parse_block(line).unwrap_or_else(|wrong| panic!("{line:?}: {wrong}")).to_string()
        })
        .collect();
    assert_eq!(read, ["B579B6617B6617GYL2", "B19B222B232GYNR4", "B0B0B9900GXL1", "B1B2B2GYL3"]);
    let from_third = scratch.run(&["send", "listing.3b", "--dry-run", "--from-block", "4"]).stdout;
    assert_eq!(from_third.lines().filter(|line| line.contains('B')).count(), 1, "{from_third}");
}

/// White space is free: a program may be one line, however long.
#[test]
fn a_program_run_together_is_read_whatever_the_length_of_its_line() {
    for turns in [1, 100, 20_000] {
        let text = "B9900B0B9900GXL1B9900B0B39600GYNR1B9900B0B9900GXL3".repeat(turns);
        let scratch = Scratch::with(&[("together.3b", &text)]);
        let run = scratch.run(&["send", "together.3b", "--dry-run"]);
        assert_eq!(run.code, Some(0), "{turns} turns: {}", run.stderr);
        assert_eq!(run.stdout.lines().count(), 3 * turns, "{turns} turns");
    }
}

/// J has six digits: a block counts at most 999 999 µm.
#[test]
fn a_block_that_counts_more_than_999_999_um_is_refused() {
    let scratch = Scratch::with(&[
        ("most.3b", "B999999B2B999999GXL1\nDD\n"),
        ("more.3b", "B1000000B2B1000000GXL1\nDD\n"),
    ]);
    assert_eq!(scratch.run(&["send", "most.3b", "--dry-run"]).code, Some(0));
    let run = scratch.run(&["send", "more.3b", "--dry-run"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{}", run.stderr);
}

#[test]
fn an_arc_that_no_control_can_carry_out_is_refused() {
    // Neither has a region to step in: a fault in every model of the control.
    let scratch = Scratch::with(&[("arc.3b", "B0B0B5GXNR1\nDD\n")]);
    let run = scratch.run(&["send", "arc.3b", "--dry-run"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{}", run.stderr);
}

/// Three thousand good blocks before the bad one.
#[test]
fn of_a_file_with_one_bad_block_nothing_is_sent() {
    let mut text = String::new();
    for _ in 0..3000 {
        text.push_str("B10B0B000010GXL1\n");
    }
    text.push_str("B10B0B000010GXL7\nDD\n");
    let scratch = Scratch::with(&[("bad.3b", &text)]);
    let ear = Ear::new();
    for arguments in [
        &["send", "bad.3b", "--port", &ear.port()][..],
        &["send", "bad.3b", "--port", &ear.port(), "--from-block", "3001", "--yes"],
        &["send", "bad.3b", "--dry-run"],
    ] {
        let run = scratch.run(arguments);
        assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{arguments:?}\n{}", run.stderr);
        assert!(run.stderr.contains("bad.3b:3001"), "{}", run.stderr);
    }
    assert!(!ear.has_been_called() && !scratch.has_journals());
}

#[test]
fn a_stream_stops_before_its_bad_block() {
    let stream = "B1B0B1GXL1\nB2B0B2GXL1\nB3B0B3GXL7\nB4B0B4GXL1\nDD\n";
    let run = Scratch::new().run_with(stream, &["send", "-", "--from", "3b", "--dry-run"]);
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert_eq!(run.stdout, "B1B0B1GXL1\nB2B0B2GXL1\n");
}

/// Blocks are printed as they come, not when the stream ends.
#[test]
fn the_first_block_of_a_stream_does_not_wait_for_the_second() {
    let mut child = Scratch::new()
        .command(&["send", "-", "--from", "3b", "--dry-run"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program under test can be started");
    let mut stdin = child.stdin.take().expect("a pipe");
    let mut lines = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    // More than any buffer on the way keeps to itself, and no end.
    let mut text = String::new();
    for number in 0..20_000 {
        writeln!(text, "B{number}B0B{number:06}GXL1").expect("a text grows");
    }
    let writer = std::thread::spawn(move || {
        stdin.write_all(text.as_bytes()).expect("the program reads on");
        stdin
    });
    assert_eq!(lines.next().expect("a line").expect("text"), "B0B0B000000GXL1");
    assert_eq!(lines.next().expect("a line").expect("text"), "B1B0B000001GXL1");
    let reader = std::thread::spawn(move || lines.count());
    drop(writer.join().expect("everything is written"));
    assert_eq!(reader.join().expect("everything is read"), 19_998);
    assert_eq!(child.wait().expect("the program ends").code(), Some(0));
}

#[test]
fn a_program_without_a_block_is_at_fault_whether_file_or_stream() {
    let scratch = Scratch::with(&[("empty.3b", ""), ("stop.3b", "DD\n"), ("percent.3b", "%\n%\n")]);
    for name in ["empty.3b", "stop.3b", "percent.3b"] {
        let run = scratch.run(&["send", name, "--dry-run"]);
        assert_eq!(run.code, Some(3), "{name}: {}", run.stderr);
        assert!(run.stderr.contains("no block"), "{}", run.stderr);
    }
    let run = scratch.run_with("", &["send", "-", "--from", "3b", "--dry-run"]);
    assert_eq!(run.code, Some(3), "an empty stream: {}", run.stderr);
}

#[test]
fn what_is_no_program_at_all_is_at_fault() {
    let scratch = Scratch::with(&[("letter.3b", "Dear Bob,\n"), ("binary.3b", "\u{0}\u{1}\u{2}\n")]);
    for name in ["letter.3b", "binary.3b"] {
        let run = scratch.run(&["send", name, "--dry-run"]);
        assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{name}: {}", run.stderr);
    }
}

#[test]
fn a_needed_answer_without_a_terminal_is_wrong_usage_and_names_yes() {
    let gear = "[part]\nkind = \"gear\"\n";
    let scratch = Scratch::with(&[("good.3b", PROGRAM), ("gear.toml", gear)]);
    let ear = Ear::new();
    for arguments in [
        &["send", "good.3b", "--port", &ear.port(), "--from-block", "2"][..],
        // The lead-in crosses the part that is kept.
        &["send", "gear.toml", "--port", &ear.port()],
    ] {
        // An answer on standard input is no answer.
        let run = scratch.run_with("y\nyes\n", arguments);
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{arguments:?}\n{}", run.stderr);
        assert!(run.stderr.contains("--yes"), "{arguments:?}\n{}", run.stderr);
    }
    assert!(!ear.has_been_called() && !scratch.has_journals());
}

#[test]
fn what_needs_no_answer_is_not_asked() {
    let gear = "[part]\nkind = \"gear\"\nlead_in = \"none\"\n";
    let scratch = Scratch::with(&[("good.3b", PROGRAM), ("gear.toml", gear)]);
    for source in ["good.3b", "gear.toml"] {
        let run = scratch.run(&["send", source, "--port", "/dev/no-such-port"]);
        assert_eq!(run.code, Some(5), "{source}: {}", run.stderr);
    }
}

#[test]
fn a_missing_port_is_exit_5_naming_it() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    for port in ["/dev/no-such-port", "/dev/ttyUSB_none", "no-such-port", "tcp://127.0.0.1:1"] {
        let run = scratch.run(&["send", "good.3b", "--port", port]);
        assert_eq!((run.code, run.stdout.as_str()), (Some(5), ""), "{port}: {}", run.stderr);
        let error = run.stderr.lines().find(|line| line.starts_with("error: ")).expect("an error");
        assert!(error.contains(port), "{error}");
    }
}

#[test]
fn a_port_must_be_named_unless_nothing_is_opened() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    let run = scratch.run(&["send", "good.3b"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""));
    assert!(run.stderr.contains("--port"), "{}", run.stderr);
}

#[test]
fn a_missing_file_and_a_directory_are_named() {
    let scratch = Scratch::new();
    std::fs::create_dir(scratch.path().join("plates.3b")).expect("a directory");
    for (arguments, named) in [
        (&["send", "nothing.3b", "--dry-run"][..], "nothing.3b"),
        (&["send", "nothing.3b", "--port", "/dev/no-such-port"], "nothing.3b"),
        (&["send", "plates.3b", "--dry-run"], "plates.3b"),
        (&["generate", "nothing.toml"], "nothing.toml"),
        (&["generate", "plates.3b"], "plates.3b"),
    ] {
        let run = scratch.run(arguments);
        assert!(matches!(run.code, Some(1..=3)), "{arguments:?}: {:?}", run.code);
        assert_eq!(run.stdout, "");
        assert!(run.stderr.contains(named), "{arguments:?}\n{}", run.stderr);
    }
    let directory = scratch.run(&["send", "plates.3b", "--dry-run"]).stderr;
    assert!(directory.contains("directory"), "{directory}");
}
