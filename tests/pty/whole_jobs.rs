//! Whole jobs: the report of the control checked field by field against what was sent.

use mock_controller::{Model, interpolator, parse_block};
use sha2::{Digest, Sha256};

use super::bench::{Bench, said};

/// What a control must report for a program, worked out from its text.
struct Expected {
    blocks: u64,
    pulses: u64,
    end_um: [i64; 2],
    path_length_mm: f64,
    sha256: String,
}

fn expect(program: &str) -> Expected {
    let mut expected =
        Expected { blocks: 0, pulses: 0, end_um: [0, 0], path_length_mm: 0.0, sha256: String::new() };
    for line in program.lines().filter(|line| *line != "DD") {
        let block = parse_block(line).expect("a block");
        let travel = interpolator::run(Model::Rotated, &block, |_, _| {}).expect("a block that ends");
        expected.blocks += 1;
        expected.pulses += travel.pulses;
        expected.end_um[0] += travel.dx;
        expected.end_um[1] += travel.dy;
    }
    expected.sha256 = Sha256::digest(program.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    expected
}

fn check(report: &serde_json::Value, expected: &Expected) {
    assert_eq!(report["blocks"], expected.blocks, "{report}");
    assert_eq!(report["pulses"], expected.pulses, "{report}");
    assert_eq!(report["end_um"], serde_json::json!(expected.end_um), "{report}");
    assert_eq!(report["sha256"], expected.sha256.as_str(), "{report}");
    assert_eq!(report["alarm"], serde_json::Value::Null, "{report}");
    assert_eq!(report["faults"], serde_json::json!({}), "{report}");
    assert!(report["path_length_mm"].as_f64().unwrap() > expected.path_length_mm, "{report}");
}

#[test]
fn a_part_over_a_pseudo_terminal_at_wire_speed_is_cut_whole() {
    let bench = Bench::new();
    let part = bench.gear(12);
    let expected = expect(&bench.program(&part));
    let mock = bench.mock_on_pty(&["--once", "--baud", "9600"]);
    let own_report = bench.path("send.json").display().to_string();
    let port = mock.port.clone();
    let output = bench.run(&["send", &part, "--port", &port, "--baud", "9600", "--report", &own_report]);
    assert!(output.status.success(), "{}", said(&output));
    let (code, report) = mock.finished();
    assert_eq!(code, 0);
    check(&report, &expected);
    assert!(report["holds"].as_u64().unwrap() >= 1, "{report}");
    assert!(report["max_overrun_bytes"].is_u64(), "{report}");
    // Leader, program, trailer.
    let bytes = bench.program(&part).len() as u64 + 4;
    assert_eq!(report["bytes"], bytes, "{report}");

    let own: serde_json::Value = serde_json::from_slice(&std::fs::read(own_report).unwrap()).unwrap();
    assert_eq!(own["blocks"], expected.blocks);
    assert_eq!(own["bytes"], bytes);
    for name in ["seconds", "held_seconds", "max_overrun_bytes", "line_utilisation", "first_byte_ms"] {
        assert!(own[name].is_number(), "{name} in {own}");
    }
    let job = bench.newest_job();
    assert_eq!((&job["state"], &job["sent_to_block"]), (&"done".into(), &expected.blocks.into()));
}

#[test]
fn a_3b_file_over_tcp_is_cut_whole() {
    let bench = Bench::new();
    let program = bench.program(&bench.gear(8));
    let expected = expect(&program);
    let file = bench.file("gear.3b", &program);
    let mock = bench.mock_on_tcp(&["--once", "--baud", "19200"]);
    let port = mock.port.clone();
    let output = bench.run(&["send", &file, "--port", &port, "--baud", "19200"]);
    assert!(output.status.success(), "{}", said(&output));
    let (code, report) = mock.finished();
    assert_eq!(code, 0);
    check(&report, &expected);
}

#[test]
fn a_program_on_standard_input_is_cut_whole() {
    let bench = Bench::new();
    let program = bench.program(&bench.gear(8));
    let expected = expect(&program);
    let file = std::fs::File::open(bench.file("gear.3b", &program)).unwrap();
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    let mut command = bench.dripfeed(&["send", "-", "--from", "3b", "--port", &port, "--unpaced"]);
    let output = command.stdin(file).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    check(&mock.finished().1, &expected);
}

#[test]
fn a_trade_program_run_together_reaches_the_control_block_by_block() {
    let bench = Bench::new();
    let file = bench.file("circle.3b", "B9900B0B9900GXL1B9900B0B39600GYNR1B9900B0B9900GXL3\nDD\n");
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    let output = bench.run(&["send", &file, "--port", &port, "--unpaced"]);
    assert!(output.status.success(), "{}", said(&output));
    let (_, report) = mock.finished();
    check(&report, &expect("B9900B0B9900GXL1\nB9900B0B39600GYNR1\nB9900B0B9900GXL3\nDD\n"));
    assert_eq!(report["end_um"], serde_json::json!([0, 0]));
}

#[test]
fn the_same_job_with_one_block_missing_shows_in_the_pulses() {
    // The twin that shows the checks above can fail: a closed outline ends where it should all the same.
    let bench = Bench::new();
    let program = bench.program(&bench.gear(8));
    let expected = expect(&program);
    let mut lines: Vec<&str> = program.lines().collect();
    lines.remove(20);
    let file = bench.file("short.3b", &(lines.join("\n") + "\n"));
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    assert!(bench.run(&["send", &file, "--port", &port, "--unpaced"]).status.success());
    let (_, report) = mock.finished();
    assert_ne!(report["pulses"], expected.pulses);
    assert_ne!(report["sha256"], expected.sha256.as_str());
}
