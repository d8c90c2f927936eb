//! Everything that can go wrong with a job, each with its own visible outcome.

use std::io::Write;
use std::process::{Child, Stdio};
use std::time::Duration;

use rustix::process::Signal;

use super::bench::{Bench, Mock, assert_golden, finish, pause, said, signal, verdict, wait_until};

/// Waits until the mock has cut at least so many blocks.
fn wait_for_blocks(mock: &Mock, blocks: u64) {
    wait_until("blocks are cut", || mock.status()["blocks"].as_u64().unwrap_or(0) >= blocks);
}

/// A sender on its way, paced at 9600 baud.
fn send_at_9600(bench: &Bench, part: &str, port: &str) -> Child {
    let mut command = bench.dripfeed(&["send", part, "--port", port, "--baud", "9600"]);
    command.stderr(Stdio::piped()).spawn().unwrap()
}

/// The resume line a failure printed, as words.
fn resume_line(stderr: &str) -> Vec<String> {
    let line =
        stderr.lines().find_map(|line| line.strip_prefix("to go on: dripfeed ")).expect("a resume line");
    line.split(' ').map(str::to_owned).collect()
}

#[test]
fn a_pulled_cable_ends_with_5_and_the_printed_line_goes_on() {
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_tcp(&["--baud", "9600"]);
    let port = mock.port.clone();
    let child = send_at_9600(&bench, &part, &port);
    wait_for_blocks(&mock, 3);
    mock.killed();
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 5, "{stderr}");
    assert!(stderr.contains("the link was lost"), "{stderr}");
    assert_golden(&bench, "cable-pulled", &stderr);

    // What reached the control is not known, so no block is named; the line works as it is once the operator names one.
    let mut arguments = resume_line(&stderr);
    assert!(!arguments.contains(&"--from-block".to_owned()), "{stderr}");
    arguments.extend(["--from-block", "3", "--dry-run"].map(str::to_owned));
    let output =
        std::process::Command::new(env!("CARGO_BIN_EXE_dripfeed")).args(&arguments).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let program = bench.program(&part);
    let tail: String = program.lines().skip(2).map(|line| format!("{line}\n")).collect();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), tail);
    assert_eq!(bench.newest_job()["state"], "failed");
}

#[test]
fn a_control_that_never_starts_is_waited_for_and_shown_until_the_operator_stops() {
    let bench = Bench::new();
    let part = bench.gear(8);
    let mock = bench.mock_on_pty(&["--start-delay", "never", "--unpaced"]);
    let port = mock.port.clone();
    let send = ["send", &part, "--port", &port, "--unpaced"];
    let child = bench.dripfeed(&send).stderr(Stdio::piped()).spawn().unwrap();
    pause(Duration::from_millis(400));
    signal(&child, Signal::INT);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 7, "{stderr}");
    assert!(stderr.contains("waiting for the control to ask (DC1)"), "{stderr}");

    let mut limited = send.to_vec();
    limited.extend(["--set", "start_timeout_s=1"]);
    let (code, stderr) = verdict(&bench.run(&limited));
    assert_eq!(code, 5, "{stderr}");
    assert!(stderr.contains("did not ask for the program within 1 s"), "{stderr}");
    assert_golden(&bench, "control-never-starts", &stderr);
    assert_eq!(mock.dismissed()["bytes"], 0);
}

#[test]
fn an_alarm_and_a_reset_of_the_control_end_with_6_and_say_which() {
    for (fault, words) in [("--alarm-at-block", "raised an alarm"), ("--reset-at-block", "was reset")] {
        let bench = Bench::new();
        let part = bench.gear(12);
        let mock = bench.mock_on_pty(&["--baud", "19200", fault, "10"]);
        let port = mock.port.clone();
        let (code, stderr) = verdict(&bench.run(&["send", &part, "--port", &port, "--baud", "19200"]));
        assert_eq!(code, 6, "{stderr}");
        assert!(stderr.contains(words), "{stderr}");
        assert_golden(&bench, &format!("control{fault}"), &stderr);
        resume_line(&stderr);
    }
}

/// A macro that computes for longer than anyone would wait keeps neither the line nor the operator waiting.
#[test]
fn ctrl_c_is_heard_while_a_macro_computes() {
    let bench = Bench::new();
    let text = "G21 G90\nG92 X0. Y0.\nG01 X1. Y1. F100\n#1=0\nWHILE[#1LT9000000000]DO1\n#1=#1+1\nEND1\nG01 X2. Y2.\nM02\n";
    let program = bench.file("long.nc", text);
    let mock = bench.mock_on_tcp(&["--unpaced", "--dialect", "gcode"]);
    let port = mock.port.clone();
    let send = ["send", &program, "--port", &port, "--budget", "100000000000"];
    let child = bench.dripfeed(&send).stderr(Stdio::piped()).spawn().unwrap();
    wait_until("the blocks before it are cut", || mock.status()["end_um"] == serde_json::json!([1000, 1000]));
    signal(&child, Signal::INT);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 7, "{stderr}");
    assert!(stderr.contains("block 3 was the last one sent whole"), "{stderr}");
    assert!(!stderr.contains("to go on:"), "a macro program is begun at its first block: {stderr}");
}

#[test]
fn ctrl_c_stops_at_the_end_of_a_block_and_the_job_goes_on_from_there() {
    for kind in [Signal::INT, Signal::TERM, Signal::HUP] {
        let bench = Bench::new();
        let part = bench.gear(12);
        let mock = bench.mock_on_pty(&["--baud", "9600"]);
        let port = mock.port.clone();
        let child = send_at_9600(&bench, &part, &port);
        wait_for_blocks(&mock, 3);
        signal(&child, kind);
        let (code, stderr) = verdict(&finish(child));
        assert_eq!(code, 7, "{stderr}");
        let job = bench.newest_job();
        let status = mock.settled();
        // At a boundary nothing is torn, and what was sent whole is what the control cuts.
        assert_eq!(status["torn"], 0, "{status}");
        assert_eq!(status["blocks"], job["sent_to_block"], "{stderr}");

        let words = resume_line(&stderr);
        let next = words.last().unwrap();
        let output = bench.run(&["resume", "--from-block", next, "--yes"]);
        assert!(output.status.success(), "{}", said(&output));
        let blocks = bench.program(&part).lines().count() as u64 - 1;
        assert_eq!(mock.settled()["blocks"], blocks);
    }
}

#[test]
fn a_second_sender_on_one_port_is_refused() {
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_pty(&["--start-delay", "never", "--unpaced"]);
    let port = mock.port.clone();
    let send = ["send", &part, "--port", &port, "--unpaced"];
    let mut first = bench.dripfeed(&send).stderr(Stdio::piped()).spawn().unwrap();
    wait_until("the job begins", || !bench.newest_job().is_null());
    let (code, stderr) = verdict(&bench.run(&send));
    assert_eq!(code, 5, "{stderr}");
    assert!(stderr.contains("is in use"), "{stderr}");
    assert_golden(&bench, "port-busy", &stderr);
    first.kill().unwrap();
    first.wait().unwrap();
}

#[test]
fn a_full_disk_in_mid_job_is_said_and_the_job_goes_on() {
    let bench = Bench::new();
    let part = bench.gear(36);
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    // No file may grow beyond a kilobyte, and the signal that would say so is ignored.
    let script = format!(
        "trap '' XFSZ; ulimit -f 1; exec {} send {part} --port {} --baud 115200 --journal {}",
        env!("CARGO_BIN_EXE_dripfeed"),
        mock.port,
        bench.path("journals").display()
    );
    let output =
        std::process::Command::new("bash").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    let (code, stderr) = verdict(&output);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("RESUME NOT GUARANTEED"), "{stderr}");
    assert!(stderr.contains("resume is not guaranteed"), "{stderr}");
    assert_eq!(mock.finished().0, 0);
}

#[test]
fn a_disk_that_is_full_before_the_job_sends_nothing() {
    let bench = Bench::new();
    let part = bench.gear(8);
    let mock = bench.mock_on_pty(&["--unpaced"]);
    let script = format!(
        "trap '' XFSZ; ulimit -f 0; exec {} send {part} --port {} --unpaced --journal {}",
        env!("CARGO_BIN_EXE_dripfeed"),
        mock.port,
        bench.path("journals").display()
    );
    let output =
        std::process::Command::new("bash").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    let (code, stderr) = verdict(&output);
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("the journal") && stderr.contains("nothing was sent"), "{stderr}");
    assert_golden(&bench, "disk-full-before", &stderr);
    assert_eq!(mock.dismissed()["bytes"], 0);
}

#[test]
fn a_stream_with_a_bad_block_stops_before_it() {
    let bench = Bench::new();
    let mock = bench.mock_on_pty(&["--unpaced"]);
    let port = mock.port.clone();
    let mut child = bench
        .dripfeed(&["send", "-", "--from", "3b", "--port", &port, "--unpaced"])
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"B100B0B100GXL1\nB0B50B50GYL2\nB100B0Q100GXL1\nB1B0B1GXL1\nDD\n").unwrap();
    drop(input);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 3, "{stderr}");
    assert!(stderr.contains("block 3 cannot be made and was not sent"), "{stderr}");
    assert_golden(&bench, "stream-bad-block", &stderr);
    assert!(stderr.contains(":3:7]") && stderr.contains("expected B, found `Q`"), "{stderr}");
    let status = mock.settled();
    assert_eq!((&status["blocks"], &status["torn"]), (&2.into(), &0.into()), "{status}");
    assert_eq!(status["end_um"], serde_json::json!([100, 50]));
}

#[test]
fn a_file_that_changes_under_the_job_stops_it() {
    let bench = Bench::new();
    // Longer than what is read ahead, so that the change is met on the way.
    let line = "B100B0B000100GXL1\nB100B0B000100GXL3\n";
    let text = line.repeat(20_000);
    let file = bench.file("long.3b", &text);
    let mock = bench.mock_on_pty(&["--start-delay", "never", "--unpaced"]);
    let port = mock.port.clone();
    let child = bench
        .dripfeed(&["send", &file, "--port", &port, "--unpaced"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until("the job begins", || !bench.newest_job().is_null());
    std::fs::OpenOptions::new().append(true).open(&file).unwrap().write_all(b"B1B0B000001GXL1\n").unwrap();
    mock.dismissed();
    finish(child);

    // Now against a control that reads: the file is checked, changed while the control waits, and fed.
    let file = bench.file("long.3b", &text);
    let mock = bench.mock_on_tcp(&["--start-delay", "1", "--unpaced"]);
    let port = mock.port.clone();
    let child = bench.dripfeed(&["send", &file, "--port", &port]).stderr(Stdio::piped()).spawn().unwrap();
    wait_until("the job runs", || bench.newest_job()["state"] == "running");
    std::fs::OpenOptions::new().append(true).open(&file).unwrap().write_all(b"B1B0B000001GXL1\n").unwrap();
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 3, "{stderr}");
    assert!(stderr.contains("has changed since it was checked"), "{stderr}");
    assert!(mock.dismissed()["blocks"].as_u64().unwrap() < 40_000);
}

#[test]
fn a_fifo_is_read_from_its_first_byte_and_ctrl_c_stops_a_wait_for_its_writer() {
    let bench = Bench::new();
    let fifo = bench.path("fifo").display().to_string();
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let mock = bench.mock_on_pty(&["--unpaced"]);
    let port = mock.port.clone();
    // What can be read only once is not looked into to tell what it is.
    let (code, stderr) = verdict(&bench.run(&["send", &fifo, "--port", &port, "--unpaced"]));
    assert_eq!(code, 2, "{stderr}");
    assert!(stderr.contains("--from"), "{stderr}");

    let send = ["send", &fifo, "--from", "3b", "--port", &port, "--unpaced"];
    let child = bench.dripfeed(&send).stderr(Stdio::piped()).spawn().unwrap();
    wait_until("the job begins", || !bench.newest_job().is_null());
    signal(&child, Signal::INT);
    assert_eq!(verdict(&finish(child)).0, 7);

    let child = bench.dripfeed(&send).stderr(Stdio::piped()).spawn().unwrap();
    let mut writer = std::fs::OpenOptions::new().write(true).open(&fifo).unwrap();
    for block in ["B100B0B100GXL1\n", "B0B50B50GYL2\n"] {
        writer.write_all(block.as_bytes()).unwrap();
        pause(Duration::from_millis(100));
    }
    // A block that is there goes out, though the writer has not closed.
    wait_for_blocks(&mock, 2);
    writer.write_all(b"DD\n").unwrap();
    drop(writer);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(mock.settled()["end_um"], serde_json::json!([100, 50]));
}

#[test]
fn an_alarm_in_answer_to_the_last_block_is_not_called_done() {
    let bench = Bench::new();
    let part = bench.gear(8);
    let last = (bench.program(&part).lines().count() - 1).to_string();
    let mock = bench.mock_on_pty(&["--unpaced", "--alarm-at-block", &last]);
    let port = mock.port.clone();
    let (code, stderr) = verdict(&bench.run(&["send", &part, "--port", &port, "--unpaced"]));
    assert_eq!(code, 6, "{stderr}");
}

#[test]
fn a_closed_screen_does_not_stop_a_job() {
    let bench = Bench::new();
    let part = bench.gear(8);
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status =
        bench.dripfeed(&["send", &part, "--port", &port, "--unpaced"]).stderr(full).status().unwrap();
    assert!(status.success(), "{status}");
    assert_eq!(mock.finished().1["blocks"], 60);
}

#[test]
fn a_part_changed_since_is_refused_at_resume() {
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_pty(&["--baud", "9600"]);
    let port = mock.port.clone();
    let child = send_at_9600(&bench, &part, &port);
    wait_for_blocks(&mock, 20);
    signal(&child, Signal::INT);
    finish(child);
    let text = std::fs::read_to_string(&part).unwrap().replace("kp = 1.6", "kp = 1.61");
    std::fs::write(&part, text).unwrap();
    let (code, stderr) = verdict(&bench.run(&["resume", "--from-block", "21", "--yes"]));
    assert_eq!(code, 3, "{stderr}");
    assert!(stderr.contains("differs within blocks 1 to 16"), "{stderr}");
    assert_golden(&bench, "resume-changed-part", &stderr);
}

#[test]
fn resume_asks_for_what_only_the_operator_knows() {
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_pty(&["--baud", "9600"]);
    let port = mock.port.clone();
    let child = send_at_9600(&bench, &part, &port);
    wait_for_blocks(&mock, 5);
    signal(&child, Signal::INT);
    finish(child);
    for (arguments, words) in [
        (&["resume"][..], "--from-block"),
        (&["resume", "--from-block", "5"], "--yes"),
        (&["resume", "--yes"], "--from-block"),
        (&["resume", "--from-block", "80", "--yes"], "would be skipped"),
        (&["resume", "--from-block", "0", "--yes"], "does not exist"),
        (&["resume", "no-such-job"], "no job"),
    ] {
        let (code, stderr) = verdict(&bench.run(arguments));
        assert_eq!(code, 2, "{arguments:?}: {stderr}");
        assert!(stderr.contains(words), "{arguments:?}: {stderr}");
    }
}
