//! G-code and 4B over TCP: sent as they stand, and cut by a control that compensates by itself.

use super::bench::{Bench, said};

/// From (5, -3) round an L of 20 × 20 mm with a notch of 10 × 10, the wire on the right: outside.
const L: &str = "%\nO0007 (L)\nN10 G21 G90\nN20 G92 X5. Y-3.\nN30 G42 D1 G01 X5. Y0.\nN40 X20.\nN50 Y10.\nN60 X10.\nN70 Y20.\n\
                 N80 X0.\nN90 Y0.\nN100 X5.\nN110 G40 X6. Y-3.\nN120 M02\n%\n";

/// What the mock must have cut: the L beside its outline by `r` mm, with a quarter of a circle at each of five corners.
fn length_of_l(r: f64) -> f64 {
    let sides = 15.0 + 10.0 + (10.0 - r) + (10.0 - r) + 10.0 + 20.0 + 5.0;
    // The lead-out slants from (5, -r) to (6, -3).
    sides + 5.0 * std::f64::consts::FRAC_PI_2 * r + (3.0 - r) + ((3.0 - r) * (3.0 - r) + 1.0).sqrt()
}

#[test]
fn a_gcode_file_over_tcp_is_compensated_and_cut_whole() {
    for offset in ["0.1", "0.25"] {
        let bench = Bench::new();
        let file = bench.file("l.nc", L);
        let mock = bench.mock_on_tcp(&["--once", "--unpaced", "--dialect", "gcode", "--wire-offset", offset]);
        let port = mock.port.clone();
        let own_report = bench.path("send.json").display().to_string();
        let output = bench.run(&["send", &file, "--port", &port, "--unpaced", "--report", &own_report]);
        assert!(output.status.success(), "{}", said(&output));
        let (code, report) = mock.finished();
        assert_eq!((code, &report["alarm"]), (0, &serde_json::Value::Null), "{report}");
        assert_eq!(report["blocks"], 9, "{report}");
        assert_eq!(report["end_um"], serde_json::json!([1000, 0]), "{report}");
        let length = report["path_length_mm"].as_f64().unwrap();
        let wanted = length_of_l(offset.parse().unwrap());
        assert!((length - wanted).abs() < 0.005, "{length} for {wanted}");
        let own: serde_json::Value = serde_json::from_slice(&std::fs::read(own_report).unwrap()).unwrap();
        assert_eq!(own["bytes"], report["bytes"], "{own}");
        assert_eq!(bench.newest_job()["state"], "done");
    }
}

#[test]
fn a_4b_file_over_tcp_is_cut_beside_its_outline() {
    // The die of the examples, with F keyed in on either side.
    let die = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/examples/die.4b");
    for (offset, f) in [("--wire-offset=-0.059", -0.059), ("--wire-offset=0.1", 0.1)] {
        let bench = Bench::new();
        let mock = bench.mock_on_tcp(&["--once", "--unpaced", "--dialect", "4b", offset]);
        let port = mock.port.clone();
        let output = bench.run(&["send", die, "--port", &port, "--unpaced"]);
        assert!(output.status.success(), "{}", said(&output));
        let (code, report) = mock.finished();
        assert_eq!((code, &report["alarm"]), (0, &serde_json::Value::Null), "{report}");
        assert_eq!(report["blocks"], 15, "{report}");
        assert_eq!(report["end_um"], serde_json::json!([0, 0]), "{report}");
        // Lines keep their length, lead-in and lead-out gain F; of the arcs, four corners and the two turns of
        // atan(8/6) = 0.9273 at the bow grow with F, and the bow shrinks.
        let bow: f64 = 0.927_295_218_001_612;
        let lines = 2.0 * 19.0 + 2.0 * 28.0 + 2.0 * 10.2 + 2.0 * (15.0 + f);
        let arcs = (2.0 * std::f64::consts::PI + 2.0 * bow) * (1.0 + f) + 2.0 * bow * (10.0 - f);
        let length = report["path_length_mm"].as_f64().unwrap();
        assert!((length - lines - arcs).abs() < 0.02, "{length} for {}", lines + arcs);
        let job = bench.newest_job();
        assert_eq!((&job["state"], &job["sent_to_block"]), (&"done".into(), &15.into()));
    }
}

#[test]
fn what_convert_makes_of_gcode_is_cut_by_a_3b_control_as_the_gcode_by_its_own() {
    let bench = Bench::new();
    let file = bench.file("l.nc", L);
    let wire = bench.path("wire.3b").display().to_string();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_dripfeed"))
        .args(["convert", &file, "--register", "1=0.1", "-o", &wire])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let mock = bench.mock_on_tcp(&["--once", "--unpaced"]);
    let port = mock.port.clone();
    let output = bench.run(&["send", &wire, "--port", &port, "--unpaced"]);
    assert!(output.status.success(), "{}", said(&output));
    let (_, report) = mock.finished();
    assert_eq!(report["end_um"], serde_json::json!([1000, 0]), "{report}");
    let length = report["path_length_mm"].as_f64().unwrap();
    assert!((length - length_of_l(0.1)).abs() < 0.02, "{length}");
}
