//! Over TCP, by the program and by the library's own call.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use mock_controller::shell::serve_tcp;
use mock_controller::{BlockEnd, Observer, Settings, Until};

use crate::process::{Mock, json, wait_for};

const BLOCK: &str = "B10 B0 B000010 GX L1\n";

fn connect(address: &str) -> TcpStream {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    stream
}

fn hear(stream: &mut TcpStream) -> u8 {
    let mut byte = [0];
    stream.read_exact(&mut byte).unwrap();
    byte[0]
}

#[test]
fn port_0_picks_one_and_a_program_is_cut_with_trace_and_picture() {
    let words = [
        "--tcp",
        "127.0.0.1:0",
        "--once",
        "--baud",
        "38400",
        "--trace",
        "DIR/trace.csv",
        "--picture",
        "DIR/p.svg",
    ];
    let mut mock = Mock::start(&words);
    assert!(mock.ready.starts_with("127.0.0.1:") && !mock.ready.ends_with(":0"), "{}", mock.ready);
    let mut stream = connect(&mock.ready);
    assert_eq!(hear(&mut stream), 0x11);
    stream.write_all(format!("%\n{}B0B4B4GXSR1\nDD\n%\n", BLOCK.repeat(2)).as_bytes()).unwrap();
    assert_eq!(hear(&mut stream), 0x13);
    drop(stream);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["blocks"], &report["programs"]), (0, &3.into(), &1.into()));
    let trace = std::fs::read_to_string(mock.file("trace.csv")).unwrap();
    let rows: Vec<Vec<&str>> = trace.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0], ["t_s", "block", "x_um", "y_um"]);
    assert_eq!(Some(rows.len() as u64 - 1), report["pulses"].as_u64());
    assert_eq!(rows[1][1..], ["1", "1", "0"]);
    assert_eq!(rows[20][1..], ["2", "20", "0"]);
    let times: Vec<f64> = rows[1..].iter().map(|row| row[0].parse().unwrap()).collect();
    assert!(times.windows(2).all(|pair| pair[0] <= pair[1]) && times[0] > 0.0);
    let last = &rows[rows.len() - 1];
    assert_eq!(
        serde_json::json!([last[2].parse::<i64>().unwrap(), last[3].parse::<i64>().unwrap()]),
        report["end_um"]
    );
    let picture = std::fs::read_to_string(mock.file("p.svg")).unwrap();
    assert!(picture.starts_with("<svg ") && picture.contains("0.020,0.000") && picture.ends_with("</svg>\n"));
}

#[test]
fn one_connection_after_the_other_and_a_status_in_between() {
    let mock = Mock::start(&["--tcp", "127.0.0.1:0", "--unpaced", "--status", "DIR/status.json"]);
    let status = || json(&mock.file("status.json")).unwrap_or_default();
    wait_for("the first status", || status()["blocks"] == 0);
    for round in 1..=3 {
        let mut stream = connect(&mock.ready);
        assert_eq!(hear(&mut stream), 0x11);
        stream.write_all(format!("%\n{BLOCK}B1B").as_bytes()).unwrap();
        drop(stream);
        wait_for("the block and the closing", || status()["blocks"] == round && status()["torn"] == round);
    }
    assert_eq!(status()["programs"], 0);
}

#[test]
fn a_sender_that_ignores_dc3_makes_the_program_leave_with_6() {
    let mut mock = Mock::start(&["--tcp", "127.0.0.1:0", "--baud", "19200"]);
    let mut stream = connect(&mock.ready);
    stream.write_all(format!("%\n{}%\n", BLOCK.repeat(300)).as_bytes()).unwrap();
    let mut codes = Vec::new();
    while codes.last() != Some(&0x15) {
        codes.push(hear(&mut stream));
    }
    assert_eq!(codes, [0x11, 0x13, 0x13, 0x15]);
    drop(stream);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["alarm"]), (6, &"overrun".into()));
    assert!(report["max_overrun_bytes"].as_u64() > Some(10));
}

/// Counts what it sees.
#[derive(Default)]
struct Count {
    pulses: u64,
    blocks: u64,
}

impl Observer for Count {
    fn pulse(&mut self, _at: Duration, _block: u64, _x_um: i64, _y_um: i64) {
        self.pulses += 1;
    }

    fn block_end(&mut self, _end: &BlockEnd) {
        self.blocks += 1;
    }
}

#[test]
fn the_library_serves_a_socket_from_a_thread() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let settings = Settings { until: Until::ProgramEnd, ..Settings::unpaced() };
    let server = std::thread::spawn(move || {
        let mut count = Count::default();
        let report = serve_tcp(listener, settings, &mut count, Arc::new(AtomicBool::new(false))).unwrap();
        (report, count)
    });
    let mut stream = connect(&address);
    assert_eq!(hear(&mut stream), 0x11);
    stream.write_all(format!("%\n{}%\n", BLOCK.repeat(1000)).as_bytes()).unwrap();
    assert_eq!(hear(&mut stream), 0x13);
    drop(stream);
    let (report, count) = server.join().unwrap();
    assert_eq!((report.blocks, report.pulses, report.alarm), (1000, 10_000, None));
    assert_eq!((count.blocks, count.pulses), (1000, 10_000));
}

#[test]
fn the_library_stops_when_told_and_refuses_settings_that_contradict_each_other() {
    let stop = Arc::new(AtomicBool::new(false));
    let told = Arc::clone(&stop);
    let listener = || TcpListener::bind("127.0.0.1:0").unwrap();
    let server = {
        let listener = listener();
        std::thread::spawn(move || {
            serve_tcp(listener, Settings::default(), mock_controller::Unobserved, told)
        })
    };
    stop.store(true, Ordering::Relaxed);
    assert_eq!(server.join().unwrap().unwrap().blocks, 0);
    let wrong = Settings { xon_at: 300, ..Settings::default() };
    let error = serve_tcp(listener(), wrong, mock_controller::Unobserved, stop).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput);
}

#[test]
fn a_4b_program_is_cut_beside_its_outline_by_the_offset_on_the_command_line() {
    for (offset, pulses) in [("0.1", 51_000), ("-0.07", 49_300)] {
        let words =
            ["--tcp", "127.0.0.1:0", "--once", "--unpaced", "--dialect", "4b", "--wire-offset", offset];
        let mut mock = Mock::start(&words);
        let mut stream = connect(&mock.ready);
        assert_eq!(hear(&mut stream), 0x11);
        let program = "%\nB5000BB5000B0DGXL1\nB5000B0B20000B5000DGYNR1\nB5000BB5000GXL3\nDD\n%\n";
        stream.write_all(program.as_bytes()).unwrap();
        assert_eq!(hear(&mut stream), 0x13);
        drop(stream);
        let (code, report) = mock.ended();
        assert_eq!((code, &report["pulses"], &report["blocks"]), (0, &pulses.into(), &3.into()), "{report}");
    }
}

#[test]
fn a_machines_file_stands_for_the_options_it_holds() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), "# a die\ndialect = \"4b\"\nwire-offset = -0.2\nbaud = 4800\nonce = true\n")
        .unwrap();
    let words = ["--tcp", "127.0.0.1:0", "--machine", file.path().to_str().unwrap(), "--unpaced"];
    let mut mock = Mock::start(&words);
    let mut stream = connect(&mock.ready);
    assert_eq!(hear(&mut stream), 0x11);
    stream.write_all(b"%\nB5000BB5000B0DGXL1\nB5000B0B20000B5000DGYNR1\nDD\n").unwrap();
    assert_eq!(hear(&mut stream), 0x13);
    drop(stream);
    let (code, report) = mock.ended();
    assert_eq!((code, &report["pulses"]), (0, &(9 * 4800).into()), "{report}");
}

#[test]
fn with_a_taper_the_report_and_the_trace_tell_of_the_upper_guide() {
    let mut words =
        vec!["--tcp", "127.0.0.1:0", "--once", "--unpaced", "--dialect", "4b", "--trace", "DIR/t.csv"];
    words.extend(["--wire-offset", "-0.1", "--taper", "1", "--taper-height", "10"]);
    let mut mock = Mock::start(&words);
    let mut stream = connect(&mock.ready);
    assert_eq!(hear(&mut stream), 0x11);
    stream.write_all(b"%\nB5000BB5000B0DGXL1\nB5000B0B20000B5000DGYNR1\nDD\n%\n").unwrap();
    assert_eq!(hear(&mut stream), 0x13);
    drop(stream);
    let (code, report) = mock.ended();
    // A = 10 mm times the tangent of 1 degree, 0.1746 mm.
    assert_eq!((code, &report["end_um"]), (0, &serde_json::json!([4900, 0])));
    assert_eq!(report["upper_end_um"], serde_json::json!([4725, 0]));
    assert_eq!(report["upper_pulses"], 9 * 4725);
    let trace = std::fs::read_to_string(mock.file("t.csv")).unwrap();
    let rows: Vec<Vec<&str>> = trace.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0], ["t_s", "block", "x_um", "y_um", "u_um", "v_um"]);
    assert_eq!(rows.len(), 1 + 9 * 4900);
    assert_eq!(rows[rows.len() - 1][1..], ["2", "4900", "0", "4725", "0"]);
    assert_eq!(rows[2450][1..], ["1", "2450", "0", "2362", "0"]);
}

#[test]
fn a_g_code_program_is_read_as_the_command_line_says() {
    let mut words =
        vec!["--tcp", "127.0.0.1:0", "--once", "--unpaced", "--dialect", "gcode", "--wire-offset", "0.1"];
    words.extend([
        "--arc-centre",
        "absolute",
        "--unit-without-point",
        "um",
        "--block-skip",
        "--ignore-words",
        "G54",
    ]);
    let mut mock = Mock::start(&words);
    let mut stream = connect(&mock.ready);
    assert_eq!(hear(&mut stream), 0x11);
    let program = b"%\nG54 G01 X1000\n/X9000\nG41 X5.\nG02 X5. Y0 I10000 J0\nG40 G01 X1.\nM02\n%\n";
    stream.write_all(program).unwrap();
    assert_eq!(hear(&mut stream), 0x13);
    drop(stream);
    let (code, report) = mock.ended();
    // The circle of R 5 about (10, 0), clockwise with the wire on its left: R 5.1, from (4.9, 0).
    assert_eq!(
        (code, &report["blocks"], &report["end_um"]),
        (0, &4.into(), &serde_json::json!([1000, 0])),
        "{report}"
    );
    assert_eq!(report["pulses"], 1000 + 3900 + 8 * 5100 + 3900);
    assert_eq!(report["words_passed_over"], serde_json::json!({"G54": 1}));
}
