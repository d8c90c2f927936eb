//! Alarms and resets through the program.

use std::io::Write as _;

use crate::process::{Mock, json, wait_for};
use crate::pty::{hear, open};

const BLOCK: &str = "B10 B0 B000010 GX L1\n";

#[test]
fn an_alarm_at_a_block_is_heard_with_parity_and_ends_with_6() {
    let words = ["--pty", "DIR/link", "--baud", "115200", "--alarm-at-block", "3", "--dc3-parity"];
    let mut mock = Mock::start(&words);
    let mut port = open(&mock.file("link"));
    hear(&mut port, 0x11);
    port.write_all(format!("%\n{}%\n", BLOCK.repeat(4)).as_bytes()).unwrap();
    hear(&mut port, 0x93);
    hear(&mut port, 0x95);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"], &report["alarm"]), (6, &2.into(), &"nak".into()));
}

#[test]
fn a_reset_is_heard_and_the_next_connection_goes_on() {
    let words = [
        "--pty",
        "DIR/link",
        "--baud",
        "115200",
        "--reset-at-block",
        "3",
        "--once",
        "--status",
        "DIR/status.json",
    ];
    let mut mock = Mock::start(&words);
    let status = || json(&mock.file("status.json")).unwrap_or_default();
    let mut port = open(&mock.file("link"));
    hear(&mut port, 0x11);
    port.write_all(format!("%\n{}%\n", BLOCK.repeat(4)).as_bytes()).unwrap();
    hear(&mut port, 0x13);
    hear(&mut port, 0x16);
    drop(port);
    wait_for("the reset", || status()["resets"] == 1);
    let mut port = open(&mock.file("link"));
    hear(&mut port, 0x11);
    port.write_all(format!("%\n{}%\n", BLOCK.repeat(2)).as_bytes()).unwrap();
    hear(&mut port, 0x13);
    drop(port);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"], &report["alarm"]), (0, &4.into(), &serde_json::Value::Null));
}

#[test]
fn a_late_start_is_late() {
    let mut mock = Mock::start(&["--pty", "DIR/link", "--unpaced", "--start-delay", "0.3", "--once"]);
    let mut port = open(&mock.file("link"));
    let opened = mock_time();
    hear(&mut port, 0x11);
    assert!(opened.elapsed().as_millis() >= 300);
    port.write_all(format!("{BLOCK}DD\n").as_bytes()).unwrap();
    hear(&mut port, 0x13);
    drop(port);
    assert_eq!(mock.ended().0, 0);
}

#[expect(clippy::disallowed_methods, reason = "the program under test lives in real time")]
fn mock_time() -> std::time::Instant {
    std::time::Instant::now()
}
