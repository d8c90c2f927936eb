//! The command line: what parses, what does not, and with which exit code.

use std::process::{Command, Output};

fn run(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mock-controller")).args(words).output().unwrap()
}

#[test]
fn words_it_does_not_know_are_wrong_usage() {
    for words in [
        &[][..],
        &["--pty", "a", "--tcp", "localhost:0"],
        &["--tcp", "localhost:0", "--baud", "9600", "--unpaced"],
        &["--tcp", "localhost:0", "--baud", "0"],
        &["--tcp", "localhost:0", "--protocol", "kermit"],
        &["--tcp", "localhost:0", "--ack", "0x06"],
        &["--tcp", "localhost:0", "--protocol", "answer", "--ack", "6"],
        &["--tcp", "localhost:0", "--protocol", "tape", "--tape-pacing", "synchronous"],
        &["--tcp", "localhost:0", "--protocol", "xmodem", "--dc3-parity"],
        &["--tcp", "localhost:0", "--protocol", "frames", "--frame-window", "65"],
        &["--tcp", "localhost:0", "--dialect", "5b"],
        &["--tcp", "localhost:0", "--wire-offset", "0.1"],
        &["--tcp", "localhost:0", "--dialect", "4b", "--wire-offset", "11"],
        &["--tcp", "localhost:0", "--dialect", "4b", "--wire-offset", "wide"],
        &["--tcp", "localhost:0", "--taper", "1"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--taper", "1"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--wire-offset", "-0.1"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--ignore-words", "C,5"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--unit-without-point", "inch"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--offset-register", "D1"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--offset-register", "E1=0.1"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--offset-register", "D1=-0.1"],
        &["--tcp", "localhost:0", "--dialect", "gcode", "--offset-register=D1=1", "--offset-register=D01=1"],
        &["--tcp", "localhost:0", "--dialect", "4b", "--offset-register", "D1=0.1"],
        &["--tcp", "localhost:0", "--dialect", "4b", "--taper", "46"],
        &["--tcp", "localhost:0", "--dialect", "4b", "--taper-height", "80"],
        &["--tcp", "localhost:0", "--interpolator", "any"],
        &["--tcp", "localhost:0", "--framing", "7X2"],
        &["--tcp", "localhost:0", "--fault", "dsr=0.1"],
        &["--tcp", "localhost:0", "--fault", "flip"],
        &["--tcp", "localhost:0", "--fault", "flip=2"],
        &["--tcp", "localhost:0", "--fault", "flip=0.1", "--fault", "flip=0.2"],
        &["--port", "/dev/null", "--fault", "disconnect=0.1"],
        &["--tcp", "localhost:0", "--xon-at", "300"],
        &["--tcp", "localhost:0", "--buffer", "195"],
        &["--tcp", "localhost:0", "--unpaced", "--cutting-time", "1"],
        &["--tcp", "localhost:0", "--cutting-time", "-1"],
        &["--tcp", "localhost:0", "--start-delay", "soon"],
        &["--tcp", "localhost:0", "--latency", "-1"],
        &["--tcp", "localhost:0", "--torn", "mend"],
    ] {
        let output = run(words);
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{words:?}");
    }
}

#[test]
fn what_cannot_be_opened_is_a_failure_that_names_it() {
    for (words, name) in [
        (&["--tcp", "256.0.0.1:0"][..], "256.0.0.1:0"),
        (&["--port", "/nowhere/tty"], "/nowhere/tty"),
        (&["--tcp", "127.0.0.1:0", "--machine", "/nowhere/machine"], "/nowhere/machine"),
        (&["--pty", "/nowhere/link"], "/nowhere/link"),
        (&["--tcp", "127.0.0.1:0", "--trace", "/nowhere/trace"], "/nowhere/trace"),
        (&["--tcp", "127.0.0.1:0", "--status", "/nowhere/status"], "/nowhere/status"),
    ] {
        let output = run(words);
        assert_eq!(output.status.code(), Some(1), "{words:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(name), "{words:?}: {message}");
    }
}

#[test]
fn the_help_names_every_option() {
    let output = run(&["--help"]);
    assert_eq!(output.status.code(), Some(0));
    let help = String::from_utf8(output.stdout).unwrap();
    for option in [
        "--pty",
        "--tcp",
        "--port",
        "--machine",
        "--protocol",
        "--tape-pacing",
        "--next",
        "--reader-speed",
        "--ack",
        "--nak",
        "--request",
        "--frame-window",
        "--end-code",
        "--code",
        "--tv-check",
        "--ignore-lines",
        "--baud",
        "--unpaced",
        "--framing",
        "--dialect",
        "--wire-offset",
        "--offset-register",
        "--taper",
        "--taper-height",
        "--arc-centre",
        "--unit-without-point",
        "--block-skip",
        "--ignore-words",
        "--interpolator",
        "--buffer",
        "--xoff-at",
        "--xon-at",
        "--overrun-limit",
        "--dc3-parity",
        "--latency",
        "--cutting-time",
        "--start-delay",
        "--torn",
        "--label-skip",
        "--alarm-at-block",
        "--reset-at-block",
        "--fault",
        "--seed",
        "--once",
        "--report",
        "--status",
        "--trace",
        "--picture",
        "--save",
    ] {
        assert!(help.contains(option), "{option}");
    }
}

#[test]
fn a_machines_file_holds_options_and_a_wrong_line_is_wrong_usage() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("machine");
    let path = file.to_str().unwrap();
    for (text, found) in [
        ("baud = 4800\nspeed = 3\n", "machine: line 2: unknown key"),
        ("dialect = \"5b\"\n", "5b"),
        ("wire-offset = 0.1\n", "3B programs hold the wire offset in their numbers"),
        ("dialect = \"4b\"\nwire-offset = -0.1\nxon-at = 300\n", "xon-at 300 is not below"),
    ] {
        std::fs::write(&file, text).unwrap();
        let output = run(&["--tcp", "localhost:0", "--machine", path]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{text}: {message}");
        assert!(message.contains(found), "{text}: {message}");
    }
}
