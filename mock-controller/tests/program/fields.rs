//! The report's fields, each against what the test works out itself, for a program in each dialect.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use std::f64::consts::PI;
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use serde_json::{Value, json};

use crate::process::{Mock, json as read};

/// Feeds a program and reads what the control says until it has taken it; the report, and the status at the end.
fn fed(words: &[&str], program: &[u8]) -> (i32, Value, Value) {
    let all = [&["--tcp", "127.0.0.1:0", "--once", "--status", "DIR/status.json"], words].concat();
    let mut mock = Mock::start(&all);
    let mut stream = TcpStream::connect(&mock.ready).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let mut byte = [0];
    stream.read_exact(&mut byte).unwrap();
    assert_eq!(byte, [0x11]);
    stream.write_all(program).unwrap();
    while byte[0] & 0x7F != 0x13 {
        stream.read_exact(&mut byte).unwrap();
    }
    drop(stream);
    let (code, report) = mock.ended();
    (code, report, read(&mock.file("status.json")).expect("a status"))
}

fn sha256(text: &str) -> String {
    use sha2::Digest as _;
    sha2::Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The fields the command line's contract names.
const CONTRACT: [&str; 11] = [
    "blocks",
    "pulses",
    "end_um",
    "path_length_mm",
    "bytes",
    "max_overrun_bytes",
    "holds",
    "line_utilisation",
    "sha256",
    "alarm",
    "faults",
];

#[test]
fn every_field_holds_what_was_received_and_cut_in_every_dialect() {
    // A slant, a half circle of R 5, and a slant on; the same by three readings.
    let gcode = "O7 (CHECKED)\nN10 G17 G90 G21\nG01 X3. Y4.\nG03 X3. Y14. J5. ; half\nG00 X-1. Y2.\nM02\n";
    let three = "B3000B4000B4000GYL1\nB0B5000B10000GXNR4\nB4000B12000B012000GYL3\nDD\n";
    let four = "B3000B4000B4000B0DGYL1\nB0B5000B10000B5000DGXNR4\nB4000B12000B12000GYL3\nDD\n";
    let length = 5.0 + 5.0 * PI + 4.0_f64.hypot(12.0);
    for (dialect, text) in [("gcode", gcode), ("3b", three), ("4b", four)] {
        let program = format!("%\r\n{}%\r\n", text.replace('\n', "\r\n"));
        let (code, report, status) = fed(&["--dialect", dialect, "--baud", "38400"], program.as_bytes());
        for field in CONTRACT {
            assert!(report.get(field).is_some() && status.get(field).is_some(), "{dialect}: {field}");
        }
        assert_eq!(code, 0);
        assert_eq!(report["blocks"], 3, "{dialect}");
        assert_eq!(report["pulses"], 7000 + 20_000 + 16_000, "{dialect}");
        assert_eq!(report["end_um"], json!([-1000, 2000]), "{dialect}");
        let found = report["path_length_mm"].as_f64().unwrap();
        assert!((found - length).abs() < 1e-6, "{dialect}: {found} for {length}");
        // Bytes after the end are trailer, and read.
        assert_eq!(report["bytes"], program.len(), "{dialect}");
        assert_eq!((&report["max_overrun_bytes"], &report["holds"]), (&json!(0), &json!(0)), "{dialect}");
        let utilisation = report["line_utilisation"].as_f64().unwrap();
        assert!((0.9..=1.0).contains(&utilisation), "{dialect}: {utilisation}");
        assert_eq!(report["sha256"], sha256(text), "{dialect}");
        assert_eq!((&report["alarm"], &report["faults"]), (&Value::Null, &json!({})), "{dialect}");
        // The status is the same object.
        let names = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&report), names(&status), "{dialect}");
    }
}

#[test]
fn two_offsets_at_an_inside_and_an_outside_corner_by_the_options_alone() {
    // An L: the pulses tell its sides. Counter-clockwise, the wire on the right, corners gone round or cut off.
    let program =
        "%\nG01 X5. Y-3.\nG42 D1 X5. Y0.\nX20.\nY10.\nX10.\nY20.\nX0.\nY0.\nX5.\nG40 X5. Y-3.\nM02\n";
    for (words, offset) in [
        (["--wire-offset", "0.1"], 100),
        (["--wire-offset", "0.073"], 73),
        (["--offset-register", "D1=0.1"], 100),
        (["--offset-register", "d01=0.073"], 73),
    ] {
        let all = [&["--unpaced", "--dialect", "gcode", "--trace", "/dev/null"][..], &words].concat();
        let (code, report, _) = fed(&all, program.as_bytes());
        assert_eq!((code, &report["blocks"], &report["alarm"]), (0, &10.into(), &Value::Null), "{words:?}");
        assert_eq!(report["end_um"], json!([5000, -3000]));
        // Round a closed outline of right angles as many pulses as its box has sides, and in and out.
        let sides = 2 * (20_000 + 2 * offset) + 2 * (20_000 + 2 * offset);
        assert_eq!(report["pulses"], 8000 + 2 * (3000 - offset) + sides, "{words:?}");
    }
    let words = ["--unpaced", "--dialect", "gcode", "--offset-register", "D2=0.1"];
    let (code, report, _) = fed(&words, program.as_bytes());
    assert_eq!((code, &report["alarm"], &report["blocks"]), (6, &"offset".into(), &1.into()));
}
