//! Protocols through the program: its words, a real clock, and links without modem lines.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use crate::process::{Mock, wait_for};
use crate::pty::{hear, open};

const BLOCK: &str = "B10BB10GXL1\n";

fn connect(mock: &Mock) -> TcpStream {
    let stream = TcpStream::connect(&mock.ready).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    stream
}

#[track_caller]
fn hears(stream: &mut TcpStream, wanted: &[u8]) {
    let mut heard = vec![0; wanted.len()];
    stream.read_exact(&mut heard).unwrap();
    assert_eq!(heard, wanted, "heard {}", String::from_utf8_lossy(&heard));
}

#[test]
fn over_links_without_lines_the_link_holds_the_characters_back() {
    for protocol in ["rts-cts", "dtr-dsr"] {
        let words = ["--pty", "DIR/link", "--baud", "38400", "--protocol", protocol, "--once"];
        let mut mock = Mock::start(&words);
        let mut port = open(&mock.file("link"));
        let program = format!("%\n{}%\n", BLOCK.repeat(100));
        let mut rest = program.as_bytes();
        wait_for("all to be taken", || {
            rest = &rest[port.write(rest).unwrap_or(0)..];
            rest.is_empty()
        });
        drop(port);
        let (code, report) = mock.ended();
        assert_eq!((code, &report["blocks"], &report["programs"]), (0, &100.into(), &1.into()), "{protocol}");
        assert!(report["holds"].as_u64().unwrap() > 0, "{protocol}: {report}");
        assert!(report["max_overrun_bytes"].as_u64().unwrap() <= 1, "{protocol}: {report}");
    }
}

#[test]
fn a_block_at_a_time_with_characters_of_ones_own() {
    let words = ["--tcp", "127.0.0.1:0", "--unpaced", "--once", "--protocol", "answer", "--ack", "0x2B"];
    let mut mock = Mock::start(&[&words[..], &["--request", "0x3F", "--nak", "0x2D"]].concat());
    let mut stream = connect(&mock);
    hears(&mut stream, b"?");
    for line in [BLOCK, BLOCK, "DD\n"] {
        stream.write_all(line.as_bytes()).unwrap();
        hears(&mut stream, b"?");
    }
    drop(stream);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"]), (0, &2.into()));
}

#[test]
fn an_eia_image_with_parity_on_the_way_back() {
    let words = ["--pty", "DIR/link", "--unpaced", "--once", "--code", "eia", "--dc3-parity", "--tv-check"];
    let mut mock = Mock::start(&words);
    let mut port = open(&mock.file("link"));
    hear(&mut port, 0x11);
    // %, B3BB3GXL1 and a blank before the end of block for an even number, DD likewise.
    let image = [
        0x00, 0x00, 0x0B, 0x80, 0x62, 0x13, 0x62, 0x62, 0x13, 0x67, 0x37, 0x43, 0x01, 0x80, 0x64, 0x64, 0x10,
        0x80,
    ];
    port.write_all(&image).unwrap();
    hear(&mut port, 0x93);
    drop(port);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["end_um"]), (0, &serde_json::json!([3, 0])), "{report}");
}

#[test]
fn a_table_of_codes_from_a_file_and_one_that_is_none() {
    let directory = tempfile::tempdir().unwrap();
    let table = directory.path().join("codes");
    std::fs::write(&table, "EOB 80\nB 62\n3 13\nGX 67\nL1 43\nDD 64\n").unwrap();
    let words = ["--tcp", "127.0.0.1:0", "--unpaced", "--once", "--protocol", "rts-cts", "--code"];
    let mut mock = Mock::start(&[&words[..], &[table.to_str().unwrap()]].concat());
    let mut stream = connect(&mock);
    stream.write_all(&[0x62, 0x13, 0x62, 0x62, 0x13, 0x67, 0x43, 0x80, 0x64, 0x80]).unwrap();
    wait_for("the end", || stream.read(&mut [0]).unwrap() == 0);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["end_um"]), (0, &serde_json::json!([3, 0])), "{report}");

    std::fs::write(&table, "EOB\n").unwrap();
    for (file, code) in [(table.to_str().unwrap(), 2), ("/nowhere/codes", 1)] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_mock-controller"))
            .args(["--tcp", "127.0.0.1:0", "--code", file])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code));
        assert!(String::from_utf8(output.stderr).unwrap().contains(file));
    }
}

#[test]
fn dsr_that_drops_ends_with_6_and_every_protocol_is_ready() {
    let words = ["--tcp", "127.0.0.1:0", "--unpaced", "--fault", "dsr-drop=1"];
    let mut mock = Mock::start(&words);
    let mut stream = connect(&mock);
    hears(&mut stream, &[0x11]);
    stream.write_all(b"B").unwrap();
    hears(&mut stream, &[0x13, 0x15]);
    drop(stream);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["alarm"], &report["faults"]["dsr-drop"]), (6, &"dsr".into(), &1.into()));
    for (protocol, greeting) in [
        ("frames", &[0x7E, 0x52][..]),
        ("xmodem", &[0x15]),
        ("xmodem-crc", b"C"),
        ("xmodem-1k", b"C"),
        ("ymodem", b"C"),
        ("fanuc-a", b"07SYN\r"),
        ("grbl", b"\r\nGrbl"),
        ("marlin", b"start\n"),
        ("tape", &[0x11]),
    ] {
        let mock = Mock::start(&["--tcp", "127.0.0.1:0", "--unpaced", "--protocol", protocol]);
        hears(&mut connect(&mock), greeting);
    }
}
