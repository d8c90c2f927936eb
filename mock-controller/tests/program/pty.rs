//! Over a pseudo-terminal.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read as _, Write as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;

use crate::process::{Mock, json, wait_for};

const BLOCK: &str = "B10 B0 B000010 GX L1\n";

/// Opens a terminal as a sender does.
pub(crate) fn open(path: &Path) -> File {
    let flags = rustix::fs::OFlags::NOCTTY | rustix::fs::OFlags::NONBLOCK;
    let flags = i32::try_from(flags.bits()).unwrap();
    OpenOptions::new().read(true).write(true).custom_flags(flags).open(path).unwrap()
}

/// Waits until the other side has said `code` again.
pub(crate) fn hear(port: &mut File, code: u8) {
    wait_for("a code", || {
        let mut byte = [0];
        match port.read(&mut byte) {
            Ok(1) => byte[0] == code,
            Ok(_) => false,
            Err(error) => {
                assert_eq!(error.kind(), ErrorKind::WouldBlock, "{error}");
                false
            }
        }
    });
}

#[test]
fn a_program_over_a_pty_is_cut_and_reported() {
    let mut mock = Mock::start(&["--pty", "DIR/link", "--baud", "115200", "--once", "--save", "DIR/saved"]);
    assert_eq!(mock.ready, mock.file("link").to_str().unwrap());
    let mut port = open(&mock.file("link"));
    hear(&mut port, 0x11);
    port.write_all(format!("%\n{}%\n", BLOCK.repeat(5)).as_bytes()).unwrap();
    hear(&mut port, 0x13);
    drop(port);
    let (code, report) = mock.ended();
    assert_eq!(code, 0);
    assert_eq!((&report["blocks"], &report["end_um"]), (&5.into(), &serde_json::json!([50, 0])));
    assert_eq!(std::fs::read_to_string(mock.file("saved")).unwrap(), BLOCK.repeat(5));
    assert!(!mock.file("link").exists(), "the link is removed");
}

#[test]
fn the_slave_may_be_opened_and_closed_many_times() {
    let mock = Mock::start(&["--pty", "DIR/link", "--unpaced", "--status", "DIR/status.json"]);
    let status = || json(&mock.file("status.json")).unwrap_or_default();
    for round in 1..=20 {
        let mut port = open(&mock.file("link"));
        if round % 2 == 0 {
            hear(&mut port, 0x11);
        }
        // The last byte is half a block that must not join the next.
        port.write_all(format!("{BLOCK}B1").as_bytes()).unwrap();
        drop(port);
        wait_for("the block and the closing to be seen", || {
            status()["blocks"] == round && status()["torn"] == round && status()["connections"] == round
        });
    }
    assert_eq!(status()["end_um"], serde_json::json!([200, 0]));
}

#[test]
fn a_sender_that_writes_and_closes_at_once_loses_nothing() {
    let mut mock = Mock::start(&["--pty", "DIR/link", "--baud", "115200", "--cutting-time", "0", "--once"]);
    let mut port = open(&mock.file("link"));
    port.write_all(format!("{}DD\n", BLOCK.repeat(100)).as_bytes()).unwrap();
    drop(port);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"], &report["torn"]), (0, &100.into(), &0.into()));
}

#[test]
fn sigterm_writes_the_report_and_leaves() {
    let mut mock = Mock::start(&["--pty", "DIR/link", "--unpaced", "--status", "DIR/status.json"]);
    let mut port = open(&mock.file("link"));
    port.write_all(BLOCK.as_bytes()).unwrap();
    wait_for("the block", || json(&mock.file("status.json")).unwrap_or_default()["blocks"] == 1);
    mock.terminate();
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"], &report["programs"]), (0, &1.into(), &0.into()));
    assert_eq!(json(&mock.file("status.json")).unwrap(), report, "the status is the same object");
    assert!(!mock.file("link").exists());
}

#[test]
fn a_cable_that_is_pulled_is_gone_for_the_sender_and_can_be_opened_again() {
    let words = [
        "--pty",
        "DIR/link",
        "--baud",
        "115200",
        "--fault",
        "disconnect=0.01",
        "--status",
        "DIR/status.json",
    ];
    let mock = Mock::start(&words);
    let status = || json(&mock.file("status.json")).unwrap_or_default();
    for round in 1..=3 {
        let mut port = open(&mock.file("link"));
        hear(&mut port, 0x11);
        wait_for("the port to be gone", || match port.write(b" ") {
            Ok(_) => false,
            Err(error) => error.kind() != ErrorKind::WouldBlock,
        });
        wait_for("the fault to be counted", || status()["faults"]["disconnect"] == round);
    }
}

#[test]
fn a_file_in_the_way_of_the_link_is_not_removed() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("precious");
    std::fs::write(&path, "keep").unwrap();
    let output =
        std::process::Command::new(env!("CARGO_BIN_EXE_mock-controller")).arg("--pty").arg(&path).output();
    assert_eq!(output.unwrap().status.code(), Some(1));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "keep");
}
