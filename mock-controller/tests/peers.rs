//! `sx` and `sb` of lrzsz send to the mock over a pseudo-terminal: what a sender nobody here wrote makes of it.
//!
//! Needs lrzsz (`apt-get install lrzsz`); a test without it fails. `cargo test -p mock-controller --features peers --test peers`.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

/// Blocks that are all different, and no length that fits a packet.
fn program() -> String {
    let blocks: String = (1..=300).map(|k| format!("B{k}BB{k}GXL1\n")).collect();
    format!("{blocks}DD\n")
}

/// Sends a file by a program of lrzsz; its exit code, and the mock's report.
fn sent(peer: &[&str], protocol: &str, more: &[&str]) -> (Option<i32>, i32, Value, String) {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (link, report, saved, source) = (file("link"), file("report.json"), file("saved"), file("gear.3b"));
    std::fs::write(&source, program()).unwrap();
    let mut mock = Command::new(env!("CARGO_BIN_EXE_mock-controller"))
        .args(["--pty", &link, "--baud", "115200", "--framing", "8N1", "--protocol", protocol, "--once"])
        .args(["--report", &report, "--save", &saved])
        .args(more)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut ready = String::new();
    BufReader::new(mock.stdout.take().unwrap()).read_line(&mut ready).unwrap();
    assert_eq!(ready.trim_end(), format!("ready {link}"));
    let port = || File::options().read(true).write(true).open(Path::new(&link)).unwrap();
    // One descriptor that stays open, so that the line is not seen closed between the peer's two.
    let _held = port();
    let status = Command::new(peer[0])
        .args(&peer[1..])
        .arg(&source)
        .stdin(port())
        .stdout(port())
        .stderr(Stdio::null())
        .status()
        .expect("lrzsz is needed: apt-get install lrzsz");
    drop(_held);
    let code = mock.wait().unwrap().code().unwrap();
    let report = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
    (status.code(), code, report, std::fs::read_to_string(&saved).unwrap())
}

#[test]
fn every_member_of_the_family_takes_what_lrzsz_sends() {
    for (peer, protocol) in [
        (&["sx"][..], "xmodem"),
        (&["sx"], "xmodem-crc"),
        (&["sx", "-k"], "xmodem-1k"),
        (&["sb"], "ymodem"),
        (&["sb", "-k"], "ymodem"),
    ] {
        let (peers, code, report, saved) = sent(peer, protocol, &[]);
        assert_eq!((peers, code), (Some(0), 0), "{peer:?} {protocol}: {report}");
        assert_eq!((&report["blocks"], &report["alarm"]), (&300.into(), &Value::Null), "{peer:?} {protocol}");
        assert_eq!(saved, program(), "{peer:?} {protocol}");
    }
}

#[test]
fn packets_broken_on_the_line_are_sent_again_by_lrzsz() {
    for (peer, protocol) in [("sx", "xmodem-crc"), ("sb", "ymodem")] {
        let words = ["--fault", "flip=0.001", "--seed", "3"];
        let (peers, code, report, saved) = sent(&[peer], protocol, &words);
        assert_eq!((peers, code), (Some(0), 0), "{peer}: {report}");
        assert!(report["faults"]["flip"].as_u64().unwrap() > 0, "{report}");
        assert_eq!(saved, program(), "{peer}");
    }
}

#[test]
fn an_alarm_makes_lrzsz_give_up() {
    let (peers, code, report, _) = sent(&["sx"], "xmodem", &["--alarm-at-block", "5"]);
    assert_eq!((code, &report["alarm"]), (6, &"nak".into()));
    assert_ne!(peers, Some(0));
}
