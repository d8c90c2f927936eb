//! Where it goes: a file that is whole or not there, a pipe that may close, and what is not a program.

use std::io::{BufRead as _, BufReader};

use crate::control::{assert_same_cut, cut_3b};
use crate::shop::Shop;

const SQUARE: &str = "B5000B0B5000GXL1\nB0B5000B5000GYL2\nB5000B0B5000GXL3\nB0B5000B5000GYL4\nDD\n";

/// A program of many blocks that fails at its end.
fn broken() -> String {
    SQUARE.replace("DD\n", "").repeat(20_000) + "B5000B0GXL1\nDD\n"
}

#[test]
fn a_file_appears_whole() {
    let shop = Shop::with("in.3b", SQUARE);
    for (out, begins) in
        [("out.nc", "G21 G90\n"), ("out.dxf", "999\n"), ("out.svg", "<svg"), ("out.3b", "B"), ("out.png", "")]
    {
        let run = shop.run(&format!("convert in.3b -o {out}"));
        assert_eq!((run.code, run.stdout.as_str()), (Some(0), ""), "{}", run.stderr);
        if begins.is_empty() {
            assert!(std::fs::read(shop.path(out)).unwrap().starts_with(b"\x89PNG"));
        } else {
            let text = shop.read(out);
            assert!(text.contains(begins) && text.ends_with('\n'), "{out}: {text}");
        }
    }
    assert_eq!(shop.files(), ["in.3b", "out.3b", "out.dxf", "out.nc", "out.png", "out.svg"]);
    assert_eq!(shop.read("out.nc"), shop.convert("in.3b --to gcode"), "as on standard output");
}

#[test]
fn a_failure_leaves_no_file_and_an_old_one_as_it_was() {
    let shop = Shop::with("in.3b", broken());
    for out in ["out.nc", "out.3b", "out.dxf", "out.svg", "out.png"] {
        let run = shop.run(&format!("convert in.3b -o {out}"));
        assert_eq!(run.code, Some(3), "{out}: {}", run.stderr);
        assert!(run.stderr.contains("in.3b:80001:"), "{}", run.stderr);
        assert_eq!(shop.files(), ["in.3b"], "{out}");
        shop.write(out, "old");
        assert_eq!(shop.run(&format!("convert in.3b -o {out}")).code, Some(3));
        assert_eq!(shop.read(out), "old");
        assert_eq!(shop.files(), ["in.3b", out], "nothing lies about");
        std::fs::remove_file(shop.path(out)).unwrap();
    }
    // What was read up to the fault has been printed, and nothing behind it.
    let run = shop.run("convert in.3b --to gcode");
    assert_eq!(run.code, Some(3));
    assert!(!run.stdout.contains("M02"), "a failed program has an end");
}

#[test]
fn the_file_that_is_read_may_be_the_one_that_is_written() {
    let shop = Shop::with("in.3b", SQUARE);
    let run = shop.run("convert in.3b --reverse -o in.3b");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(cut_3b(&shop.read("in.3b")).area() < -24.9);
    assert_eq!(shop.files(), ["in.3b"]);
}

#[test]
fn a_closed_pipe_ends_it_quietly() {
    let shop = Shop::with("in.3b", SQUARE.replace("DD\n", "").repeat(40_000) + "DD\n");
    for to in ["gcode", "3b", "dxf"] {
        let mut child = shop.command(&["convert", "in.3b", "--to", to]).spawn().unwrap();
        let mut line = String::new();
        let mut stdout = BufReader::new(child.stdout.take().unwrap());
        stdout.read_line(&mut line).unwrap();
        assert!(!line.is_empty());
        drop(stdout);
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{to}: {stderr}");
        assert!(!stderr.contains("error") && !stderr.contains("panic"), "{to}: {stderr}");
    }
}

#[test]
fn standard_input_is_read_as_it_is_named() {
    let shop = Shop::new();
    let run = shop.run_with(SQUARE, "convert - --from 3b --to gcode");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let back = shop.run_with(&run.stdout, "convert - --from gcode --to 3b");
    assert_eq!(back.code, Some(0), "{}", back.stderr);
    assert_same_cut(&cut_3b(&back.stdout), &cut_3b(SQUARE), 1, "through pipes");
    let named = shop.run_with(SQUARE, "convert - --from 3b -o out.nc");
    assert_eq!((named.code, named.stdout.as_str()), (Some(0), ""));
    assert_eq!(shop.read("out.nc"), run.stdout);
    // A place is told in what came from standard input, too.
    let faulty = shop.run_with("B1B2B3GXL1\nB1B2GXL1\nDD\n", "convert - --from 3b --to gcode");
    assert_eq!(faulty.code, Some(3));
    assert!(faulty.stderr.contains("standard input:2:"), "{}", faulty.stderr);
    assert!(faulty.stderr.contains("B1B2GXL1"), "{}", faulty.stderr);
}
