//! `dripfeed expand`, and the other commands given a macro program: the real program, judged by what it prints.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples").join(name)
}

fn dripfeed(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dripfeed"));
    command.args(arguments).stdin(Stdio::null());
    command
}

/// Runs it on a program in a file of its own.
fn on(text: &str, arguments: &[&str]) -> Output {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("program.nc");
    std::fs::write(&file, text).unwrap();
    let arguments: Vec<&str> =
        arguments.iter().map(|a| if *a == "FILE" { file.to_str().unwrap() } else { a }).collect();
    dripfeed(&arguments).output().unwrap()
}

fn lines(output: &Output) -> Vec<String> {
    String::from_utf8(output.stdout.clone()).unwrap().lines().map(str::to_owned).collect()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// X, Y, Z of a block, in micrometres.
fn point(block: &str) -> [i64; 3] {
    let mut point = [0; 3];
    for word in block.split(' ') {
        if let Some(axis) = "XYZ".find(&word[..1]) {
            let (whole, decimals) = word[1..].split_once('.').unwrap();
            assert_eq!(decimals.len(), 3, "{block}");
            point[axis] = format!("{whole}{decimals}").parse().unwrap();
        }
    }
    point
}

/// Every node of every corner, by the formulas of the paper worked out here: 350 of them on the centre path, 250 on the
/// programmed corner, and the last is the corner's end exactly.
#[test]
fn the_papers_corners_are_cut_to_their_ends() {
    for (name, (sx, sy), radius, nodes) in [
        ("corner-1.nc", (1, 1), 7.0f64, 350),
        ("corner-2.nc", (-1, 1), 7.0, 350),
        ("corner-3.nc", (-1, -1), 7.0, 350),
        ("corner-4.nc", (1, -1), 7.0, 350),
        ("corner-1-compensated.nc", (1, 1), 5.0, 250),
    ] {
        let output = dripfeed(&["expand", example(name).to_str().unwrap()]).output().unwrap();
        assert!(output.status.success(), "{name}: {}", said(&output));
        let cut: Vec<[i64; 3]> =
            lines(&output).iter().filter(|line| line.starts_with("G01")).map(|block| point(block)).collect();
        assert_eq!(cut.len(), nodes, "{name}");
        for (n, [x, y, z]) in cut.iter().enumerate() {
            let along = radius - 0.02 * (n + 1) as f64;
            let exact_x = 20.0 + along;
            let exact_y = 20.0 + (radius * radius - along * along).max(0.0).sqrt();
            let exact_z = (40_000.0 - exact_x * exact_x).sqrt();
            let exact = [sx as f64 * exact_x, sy as f64 * exact_y, exact_z];
            for (made, exact) in [x, y, z].into_iter().zip(exact) {
                assert!(
                    (*made as f64 - 1000.0 * exact).abs() <= 0.5 + 1e-6,
                    "{name}, node {n}: {made} {exact}"
                );
            }
        }
        let end = [20_000 * sx, (20_000.0 + 1000.0 * radius) as i64 * sy, 198_997];
        assert_eq!(cut.last(), Some(&end), "{name}");
    }
}

#[test]
fn the_paper_as_printed_is_refused_with_the_loop_that_never_runs() {
    for command in [&["expand"][..], &["send", "--port", "tcp://127.0.0.1:9", "--yes"]] {
        let mut arguments = command.to_vec();
        let file = example("corner-1-as-printed.nc");
        arguments.push(file.to_str().unwrap());
        let output = dripfeed(&arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(3), "{}", said(&output));
        let said = said(&output);
        assert!(
            said.contains("the loop never runs: `#101` is 25, the loop runs while `#101` GT 25"),
            "{said}"
        );
        assert!(said.contains("corner-1-as-printed.nc:6"), "{said}");
        assert_eq!(output.stdout, b"");
    }
}

/// Loops, a subprogram, nulls, remarks, `/`, N numbers, inches: what a skip must not lose count of.
const BUSY: &str = "%
O1 (BUSY)
N1 G21 G90 (STARTS)
#1=0
WHILE[#1LT3]DO1
#1=#1+1
(A REMARK ALONE)
N10 G01 X#1 Y[#1*#1] F[100*#1]
IF[#1EQ2]GOTO20
G00 Z#30
N20 M98 P2 L2
END1
G65 P3 A1.5 B#1
/G20
/G01 X[#1/3]
M30
O2
X[#1+.5]
#2=0
WHILE[#2LT2]DO2
#2=#2+1
Y-#2
END2
M99
O3
G01 X#1 Y#2 Z#3
M99
%
";

#[test]
fn from_a_block_on_is_the_tail_of_the_whole() {
    for extra in [&[][..], &["--suppress"], &["--set", "n_numbers=count"], &["--set", "macros.numbers=f64"]] {
        let mut arguments = vec!["expand", "FILE"];
        arguments.extend(extra);
        let whole = on(BUSY, &arguments);
        assert!(whole.status.success(), "{}", said(&whole));
        let whole = lines(&whole);
        let is_block = |line: &&String| !line.starts_with(['(', 'O']);
        let blocks: Vec<usize> =
            whole.iter().enumerate().filter(|(_, line)| is_block(line)).map(|(at, _)| at).collect();
        assert!(blocks.len() > 20, "{whole:#?}");
        for (n, at) in blocks.iter().enumerate() {
            let number = (n + 1).to_string();
            let mut arguments = arguments.clone();
            arguments.extend(["--from-block", &number]);
            let tail = on(BUSY, &arguments);
            // Remarks in front of the block belong to it.
            let made: Vec<String> = lines(&tail).into_iter().filter(|line| is_block(&line)).collect();
            let expected: Vec<&String> = whole[*at..].iter().filter(is_block).collect();
            assert_eq!(made.iter().collect::<Vec<_>>(), expected, "from block {number} {extra:?}");
        }
        let past = (blocks.len() + 1).to_string();
        arguments.extend(["--from-block", &past]);
        let output = on(BUSY, &arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            said(&output).contains(&format!("the program has {} blocks", blocks.len())),
            "{}",
            said(&output)
        );
    }
}

#[test]
fn what_is_sent_is_what_is_expanded() {
    let expanded = lines(&on(BUSY, &["expand", "FILE"]));
    let sent = on(BUSY, &["send", "--dry-run", "FILE"]);
    assert!(sent.status.success(), "{}", said(&sent));
    assert_eq!(lines(&sent), expanded);
}

#[test]
fn a_loop_that_steps_the_wrong_way_is_refused_before_its_first_block() {
    let output = on("#1=25.\nWHILE[#1GT20]DO1\n#1=#1+0.02\nG01 X#1\nEND1\nM30\n", &["expand", "FILE"]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(3), 0), "{}", said(&output));
    assert!(said(&output).contains("program.nc:2"), "{}", said(&output));
    // A count of nothing is a setting, and told.
    let output = on("#5=0\n#1=0\nWHILE[#1LT#5]DO1\n#1=#1+1\nG01 X#1\nEND1\nG01 X9.\n", &["expand", "FILE"]);
    assert_eq!(lines(&output), ["G01 X9.000"], "{}", said(&output));
    assert_eq!(said(&output).matches("loop-never-runs").count(), 1, "{}", said(&output));
}

#[test]
fn blocks_before_an_error_are_printed_and_none_behind_it() {
    let output = on("G21 G90\n#1=2\nWHILE[#1GE0]DO1\n#1=#1-1\nG01 X[1/#1]\nEND1\nM30\n", &["expand", "FILE"]);
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(lines(&output), ["G21 G90", "G01 X1.000"]);
    let said = said(&output);
    assert!(said.contains("division by zero") && said.contains("program.nc:5"), "{said}");
    assert!(said.contains("G01 X[1/#1]"), "the line is shown: {said}");
}

#[test]
fn a_loop_of_any_length_is_made_lazily_and_a_closed_pipe_ends_it_quietly() {
    let text =
        "#1=0\n#2=0\nWHILE[#2LT900000000000]DO1\n#2=#2+1\n#1=#1+0.001\nIF[#1GT9]THEN #1=0\nG01 X#1\nEND1\n";
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("endless.nc");
    std::fs::write(&file, text).unwrap();
    let mut child = dripfeed(&["expand", file.to_str().unwrap()])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut head = BufReader::new(child.stdout.take().unwrap()).lines();
    for n in 1..=100_000u64 {
        let (mm, um) = (n % 9001 / 1000, n % 9001 % 1000);
        assert_eq!(head.next().unwrap().unwrap(), format!("G01 X{mm}.{um:03}"));
    }
    drop(head);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.code().is_some(), "ended by itself");
    assert!(!said(&output).contains("error"), "{}", said(&output));
}

#[test]
fn a_computation_without_a_block_runs_into_its_budget() {
    let text = "G01 X1.\n#1=0\nWHILE[#1LT100000]DO1\n#1=#1+1\nEND1\nG01 X2.\n";
    assert_eq!(lines(&on(text, &["expand", "FILE"])), ["G01 X1.000", "G01 X2.000"]);
    let output = on(text, &["expand", "FILE", "--budget", "10000"]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert_eq!(lines(&output), ["G01 X1.000"]);
    assert!(said(&output).contains("program.nc:"), "{}", said(&output));
}

#[test]
fn programs_are_found_in_a_directory_and_only_where_it_is_named() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("O0200.nc"), "O0200\nG01 X#1 Y2.\nM99\n").unwrap();
    let text = "G65 P200 A1.5\nM30\n";
    let output = on(text, &["expand", "FILE", "--programs", directory.path().to_str().unwrap()]);
    assert_eq!(lines(&output), ["G01 X1.500 Y2.000", "M30"], "{}", said(&output));
    let output = on(text, &["expand", "FILE"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(said(&output).contains("O0200"), "{}", said(&output));
    std::fs::write(directory.path().join("200.txt"), "O0200\nM99\n").unwrap();
    let output = on(text, &["expand", "FILE", "--programs", directory.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(3), "two files of one number");
}

#[test]
fn a_repeat_is_asked_for_and_a_stream_must_be_named() {
    let text = "G01 X1.\nM99\n";
    assert_eq!(on(text, &["expand", "FILE"]).status.code(), Some(3));
    let output = on(text, &["expand", "FILE", "--repeat", "3"]);
    assert_eq!(lines(&output), ["G01 X1.000"; 3], "{}", said(&output));

    let mut child = dripfeed(&["expand", "-"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(b"#1=3\nG01 X#1\n").unwrap();
    assert_eq!(lines(&child.wait_with_output().unwrap()), ["G01 X3.000"]);
}

#[test]
fn each_line_can_be_shown_beside_what_made_it() {
    let output = on("#1=3\nG01 X#1 (CUT)\n", &["expand", "FILE", "--annotate"]);
    assert_eq!(lines(&output), ["G01 X3.000 (CUT)                            ; 2: G01 X#1 (CUT)"]);
}

/// The arc of the paper's gear's tip, as lines: read by the other commands as the blocks it makes.
#[test]
fn check_convert_and_plot_read_what_a_macro_program_makes() {
    let text = "G21 G90\nG92 X10. Y0.\n#1=0\nWHILE[#1LT360]DO1\n#1=#1+1\nG01 X[10*COS[#1]] Y[10*SIN[#1]]\nEND1\nM02\n";
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("ring.nc");
    std::fs::write(&file, text).unwrap();
    let (file, out) = (file.to_str().unwrap(), directory.path().join("ring.3b"));
    let output = dripfeed(&["convert", file, "--to", "3b", "-o", out.to_str().unwrap()]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let blocks = std::fs::read_to_string(&out).unwrap();
    assert_eq!(blocks.lines().filter(|line| line.starts_with('B')).count(), 360);
    let output = dripfeed(&["check", file]).output().unwrap();
    let account = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(account.contains("ring.nc, expanded: ") && output.status.success(), "{account}{}", said(&output));
    let svg = directory.path().join("ring.svg");
    let output = dripfeed(&["plot", file, "-o", svg.to_str().unwrap()]).output().unwrap();
    assert!(output.status.success() && svg.exists(), "{}", said(&output));
}

#[test]
fn options_of_macro_programs_are_refused_elsewhere() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("plain.3b");
    std::fs::write(&file, "B1B0B1GXL1\nDD\n").unwrap();
    let output = dripfeed(&["check", file.to_str().unwrap(), "--repeat", "2"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("--repeat goes with a macro program"), "{}", said(&output));
}
