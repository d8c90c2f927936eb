//! Where a program begins and ends, what is a block, and what is none.

use std::time::Duration;

use mock_controller::{Controller, LabelSkip, Report, Settings};

use crate::sender::{HOUR, Sender, run, run_unpaced, sha256, staircase};

const BLOCK: &str = "B10BB10GXL1";

fn run_with(label_skip: LabelSkip, program: &str) -> Report {
    run(Settings { label_skip, ..Settings::unpaced() }, &mut Sender::of(program).window(4096))
}

#[test]
fn a_program_ends_at_a_trailing_percent_at_dc4_and_at_a_stop_word() {
    for (end, ends) in
        [("%\n", 1), ("\u{14}", 1), ("DD\n", 1), ("dd\n", 1), ("E\n", 1), ("D\n", 0), ("", 0), ("D", 0)]
    {
        for leader in ["", "%\n", "\0\0%\r\n", "\n", "O0001\n"] {
            let report = run_unpaced(&format!("{leader}{BLOCK}\n{BLOCK}\n{end}"));
            let found = (report.blocks, report.programs, report.alarm.as_deref());
            assert_eq!(found, (2, ends, None), "{leader:?} {end:?}");
        }
    }
}

#[test]
fn a_stop_word_and_a_trailer_after_it_are_one_end() {
    for trailer in ["DD\n%\n", "E\r\n%\r\n", "DD%\n", "DD\n%\n%\n\0\0\0\u{14}", "%\n%\n", "%"] {
        let report = run_unpaced(&format!("%\n{BLOCK}\n{trailer}"));
        assert_eq!((report.blocks, report.programs, report.alarm), (1, 1, None), "{trailer:?}");
    }
}

#[test]
fn a_single_d_is_a_pause_and_is_passed() {
    let report = run_unpaced(&format!("%\n{BLOCK}\nD\n{BLOCK} D {BLOCK}D{BLOCK}\nDD\n"));
    assert_eq!((report.blocks, report.programs, report.alarm), (4, 1, None));
}

#[test]
fn blocks_may_run_on_and_stand_over_several_lines_in_any_case() {
    let report = run_unpaced("b5 4 0B54900B0GXL1".replace("5 4 0", "540").as_str());
    assert_eq!((report.blocks, report.alarm), (1, None));
    let report = run_unpaced("%\nB10 B B10 GX\n L1 b10bb10gxl1\tB 10\nB\nB10 X L\n1\n%\n");
    assert_eq!((report.blocks, report.end_um, report.programs, report.alarm), (3, [30, 0], 1, None));
}

#[test]
fn a_second_program_may_follow_on_the_same_connection() {
    let one = staircase(2);
    for two in [staircase(3), format!("{BLOCK}\n{BLOCK}\n{BLOCK}\nDD\n"), format!("O0002\n{}", staircase(3))]
    {
        let report = run_unpaced(&format!("{one}{two}"));
        assert_eq!((report.blocks, report.programs, report.alarm), (5, 2, None));
    }
}

#[test]
fn after_its_last_word_the_control_still_takes_a_next_program() {
    let mut control = Controller::new(Settings::default()).unwrap();
    control.link_opened(Duration::ZERO);
    let mut first = Sender::of(staircase(2));
    let now = first.feed(&mut control, Duration::ZERO, HOUR);
    assert!(control.is_finished());
    let again = staircase(2);
    assert_eq!(control.send(again.as_bytes(), now), again.len());
    assert!(!control.is_finished() || control.report().programs == 1);
    control.advance(2 * HOUR);
    assert_eq!(control.receive(2 * HOUR), [0x13]);
    assert_eq!((control.report().programs, control.blocks(), control.is_finished()), (2, 4, true));
}

#[test]
fn label_skip_auto_keeps_what_is_a_block_and_discards_what_is_not() {
    for (label, skipped) in
        [("O1234 (GEAR)\n", 11), ("39 B318 X SR3\n", 10), ("70GYSR1\n", 7), ("START POINT = 0\n", 12)]
    {
        let report = run_unpaced(&format!("{label}{BLOCK}\n%\n"));
        assert_eq!((report.blocks, report.alarm.as_deref()), (1, None), "{label:?}");
        assert_eq!(report.skipped, skipped, "{label:?}");
        assert_eq!(report.sha256, sha256(&format!("{BLOCK}\n")), "{label:?}");
    }
    let report = run_unpaced(&format!("garbage {BLOCK}{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.skipped), (2, 7));
    let report = run_unpaced(&format!("N 1: {BLOCK}\nN 2: {BLOCK}\nDD\n"));
    assert_eq!((report.blocks, report.skipped, report.alarm), (2, 0, None));
    assert_eq!(report.sha256, sha256(&format!("N 1: {BLOCK}\nN 2: {BLOCK}\nDD\n")));
}

#[test]
fn label_skip_on_discards_a_first_line_whatever_it_is_and_off_takes_all() {
    let report = run_with(LabelSkip::On, &format!("{BLOCK}\n{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.skipped, report.programs), (1, 11, 1));
    let report = run_with(LabelSkip::On, &format!("%\n{BLOCK}\n{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.skipped, report.programs), (2, 0, 1));
    let report = run_with(LabelSkip::Off, &format!("{BLOCK}\n{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.programs), (2, 1));
    let report = run_with(LabelSkip::Off, &format!("O1234\n{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.alarm.as_deref()), (0, Some("format")));
}

#[test]
fn every_end_of_block_in_use_gives_the_same_text() {
    let wanted = sha256(&format!("{BLOCK}\n{BLOCK}\n"));
    for end in ["\n", "\r\n", "\r", "\n\r", "\n\r\r", "\r\n\n"] {
        let report = run_unpaced(&format!("%{end}{BLOCK}{end}{BLOCK}{end}%{end}"));
        assert_eq!((report.blocks, report.programs, report.alarm), (2, 1, None), "{end:?}");
        assert_eq!(report.sha256, wanted, "{end:?}");
    }
}

#[test]
fn comments_are_passed_and_belong_to_the_text() {
    let program = format!("{BLOCK} ; 0.010, 0.000\n(second) {BLOCK}\nDD\n");
    let report = run_unpaced(&format!("%\n{program}%\n"));
    assert_eq!((report.blocks, report.programs, report.alarm), (2, 1, None));
    assert_eq!(report.sha256, sha256(&program));
}

#[test]
fn a_malformed_block_is_an_alarm_with_its_place_once_the_control_gets_there() {
    for (wrong, found) in [
        ("B869B39B31B7GYL1", "block 3, line 4, column 11"),
        ("B1B2B3GXL5", "block 3, line 4, column 10"),
        ("Q", "block 3, line 4, column 1"),
        ("B1.5B2B3GXL1", "block 3, line 4, column 3"),
        ("B1B2B1000000GXL1", "block 3, line 4, column 12"),
        ("B1B2%", "block 3, line 4, column 5"),
        ("B1B2\u{14}", "block 3, line 4, column 5"),
    ] {
        let mut sender = Sender::of(format!("%\n{BLOCK}\n{BLOCK}\n{wrong}\n{BLOCK}\n%\n"));
        let report = run(Settings::default(), &mut sender);
        assert_eq!((report.blocks, report.alarm.as_deref()), (2, Some("format")), "{wrong:?}");
        let detail = report.alarm_detail.unwrap();
        assert!(detail.starts_with(found), "{wrong:?}: {detail}");
        assert_eq!(sender.codes(), [0x11, 0x13, 0x15], "{wrong:?}");
    }
}

#[test]
fn what_no_table_can_do_is_an_alarm() {
    let report = run_unpaced(&format!("%\n{BLOCK}\nBBB9900GYL1\n{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.alarm.as_deref()), (1, Some("endless-block")));
    let report = run_unpaced(&format!("%\n{BLOCK}\nB1B0B2GXNR1\n{BLOCK}\n%\n"));
    assert_eq!((report.blocks, report.alarm.as_deref(), report.end_um), (1, Some("arc-centre"), [9, 0]));
}

#[test]
fn the_report_has_the_fields_of_the_contract() {
    let report = serde_json::to_value(run_unpaced(&staircase(2))).unwrap();
    for field in [
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
    ] {
        assert!(report.get(field).is_some(), "{field}");
    }
    assert_eq!(report["blocks"], 2);
    assert_eq!(report["pulses"], 20);
    assert_eq!(report["end_um"], serde_json::json!([20, 0]));
    assert_eq!(report["path_length_mm"], 0.02);
    assert_eq!(report["bytes"], staircase(2).len());
    assert_eq!(report["alarm"], serde_json::Value::Null);
    assert_eq!(report["faults"], serde_json::json!({}));
    assert_eq!(report["line_utilisation"], serde_json::Value::Null);
}

#[test]
fn a_listing_of_a_cam_system_is_cut_with_its_header_numbers_and_end_points() {
    let listing = "\
        *****************************************\n\
        CAMWEDM -Version 2.0 , Name : 1.3B\n\
        Conner R= 0.00000 , Offset F= 0.11000 ,Length= 81.7\n\
        ; made by hand: B1B1B1GXL1\n\
        *****************************************\n\
        Start Point = 0.00000 , 0.00000 ; X , Y\n\
        N   1: B 0 B 5000 B 5000 GY L2 ; 0.000 , 5.000\n\
        N   2: D\n\
        *****************************************\n\
        N   3: B 5000 B 0 B 5000 GX L1 ; 5.000 , 5.000\n\
        N   4: DD\n";
    for leader in ["", "%\n"] {
        for end in ["\n", "\r\n"] {
            let report = run_unpaced(&format!("{leader}{}", listing.replace('\n', end)));
            let found = (report.blocks, report.end_um, report.programs, report.alarm.as_deref());
            assert_eq!(found, (2, [5000, 5000], 1, None), "{leader:?} {:?}", report.alarm_detail);
        }
    }
    for (word, programs) in [("N16:DD", 1), ("n 16: e", 1), ("N 16: D", 0)] {
        let report = run_unpaced(&format!("%\n{BLOCK}\n{word}\n"));
        assert_eq!((report.blocks, report.programs, report.alarm), (1, programs, None), "{word}");
    }
}

#[test]
fn a_header_hides_no_broken_block() {
    for broken in ["B10B10GXL1", "N 1: B10B10GXL1", "B10BB10GXL5", "N 1: B1.0BB10GXL1"] {
        let report = run_unpaced(&format!("*****\nStart Point = 0 , 0\n{broken}\n{BLOCK}\nDD\n"));
        assert_eq!((report.blocks, report.alarm.as_deref()), (0, Some("format")), "{broken}");
    }
    let report = run_unpaced(&format!("%\n{BLOCK}\nStart Point = 0\n{BLOCK}\nDD\n"));
    assert_eq!((report.blocks, report.alarm.as_deref()), (1, Some("format")));
}

#[test]
fn the_die_of_the_examples_is_cut_to_its_end() {
    let die =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/examples/die.4b")).unwrap();
    let settings =
        Settings { dialect: mock_controller::Dialect::FourB, wire_offset_um: -59.0, ..Settings::unpaced() };
    let report = run(settings, &mut Sender::of(die).window(4096));
    assert_eq!((report.blocks, report.end_um, report.programs, report.alarm), (15, [0, 0], 1, None));
}
