//! `kill -9` at random moments, and on again from the block the control itself names.

use std::process::Stdio;
use std::time::Duration;

use super::bench::{Bench, pause, said};

/// Where a kill struck.
#[derive(Clone, Copy, Debug, Default)]
struct Struck {
    before_the_first_block: u32,
    in_the_middle: u32,
    after_the_last: u32,
}

/// A random number below `n` from a seed, so that a failing run can be told.
fn dice(seed: u64, n: u64) -> u64 {
    let mut x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03;
    x ^= x >> 29;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (x ^ (x >> 32)) % n
}

/// One job killed at a moment and resumed; compared with `whole`, the report of an uninterrupted one.
fn kill_and_resume(seed: u64, whole: &serde_json::Value, struck: &mut Struck) {
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_pty(&["--baud", "38400"]);
    let port = mock.port.clone();
    let line = ["--port", &port, "--baud", "38400"];
    let mut arguments = vec!["send", &part];
    arguments.extend(line);
    let mut child = bench.dripfeed(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    pause(Duration::from_millis(20 + dice(seed, 700)));
    child.kill().unwrap();
    child.wait().unwrap();

    let executed = mock.settled()["blocks"].as_u64().unwrap();
    let job = bench.newest_job();
    let claimed = job["sent_to_block"].as_u64().unwrap_or(0);
    assert!(
        claimed >= executed,
        "seed {seed}: the journal claims {claimed}, the control executed {executed}"
    );
    let total = whole["blocks"].as_u64().unwrap();
    match executed {
        0 => struck.before_the_first_block += 1,
        n if n == total => struck.after_the_last += 1,
        _ => struck.in_the_middle += 1,
    }
    if job.is_null() {
        // Killed before the job was written down: nothing was sent, it is simply begun again.
        assert_eq!(executed, 0);
        let output = bench.run(&arguments);
        assert!(output.status.success(), "seed {seed}: {}", said(&output));
    } else if job["state"] != "done" {
        let next = (executed + 1).to_string();
        let output = bench.run(&["resume", "--from-block", &next, "--yes"]);
        assert!(output.status.success(), "seed {seed}: {}", said(&output));
    }
    mock.settled();
    let report = mock.dismissed();
    for field in ["blocks", "pulses", "end_um"] {
        assert_eq!(report[field], whole[field], "seed {seed}: {field}, {report}");
    }
    assert_eq!(bench.newest_job()["state"], "done");
}

/// The report of the same job, not interrupted.
fn uninterrupted() -> serde_json::Value {
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    let output = bench.run(&["send", &part, "--port", &port, "--unpaced"]);
    assert!(output.status.success(), "{}", said(&output));
    mock.finished().1
}

fn campaign(seeds: std::ops::Range<u64>) {
    let whole = uninterrupted();
    let mut struck = Struck::default();
    let count = seeds.end - seeds.start;
    for seed in seeds {
        kill_and_resume(seed, &whole, &mut struck);
    }
    println!("{struck:?}");
    assert!(u64::from(struck.in_the_middle) * 2 >= count, "too few kills struck in the middle: {struck:?}");
}

#[test]
fn after_ten_random_kills_the_control_stands_where_an_uninterrupted_job_leaves_it() {
    campaign(0..10);
}

#[test]
fn after_ten_more_random_kills_too() {
    campaign(10..20);
}

#[test]
fn resuming_one_block_late_is_seen() {
    // The twin that shows the comparison can fail.
    let whole = uninterrupted();
    let bench = Bench::new();
    let part = bench.gear(12);
    let mock = bench.mock_on_pty(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    let output = bench.run(&["send", &part, "--port", &port, "--unpaced", "--from-block", "2", "--yes"]);
    assert!(output.status.success(), "{}", said(&output));
    let (_, report) = mock.finished();
    assert_ne!(report["pulses"], whole["pulses"]);
    assert_ne!(report["blocks"], whole["blocks"]);
}
