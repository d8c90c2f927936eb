//! The adapter in place of a tape reader.

use std::time::Duration;

use mock_controller::{Lines, Next, Protocol, Settings, TapePacing};

use crate::talk::{BLOCK, Talk};

#[test]
fn by_answer_each_character_is_asked_for_and_one_too_many_is_an_alarm() {
    let pacing = TapePacing::Answer { next: Next::Byte(0x11), per_second: None };
    let mut talk = Talk::in_protocol(Protocol::Tape(pacing));
    talk.hears([0x11]);
    for byte in format!("%\n{BLOCK}%\n").bytes() {
        talk.send([byte]);
        talk.hears([0x11]);
    }
    talk.is_done(1);
    talk.send(b"\0\0");
    talk.has_alarm("unasked");
}

#[test]
fn the_readers_pace_and_an_edge_of_cts() {
    let pacing = TapePacing::Answer { next: Next::Cts, per_second: Some(100) };
    let mut talk = Talk::in_protocol(Protocol::Tape(pacing));
    let off = Lines { cts: false, dsr: true };
    for byte in BLOCK.bytes() {
        assert_eq!(talk.control.lines(), Lines::ON);
        talk.send([byte]);
        assert_eq!(talk.control.lines(), off);
        talk.wait(9);
        assert_eq!(talk.control.lines(), off);
        talk.wait(1);
    }
    talk.hears([0_u8; 0]);
    assert_eq!(talk.report().blocks, 1);
}

#[test]
fn synchronous_characters_keep_the_pace() {
    let pacing = TapePacing::Synchronous { per_second: 100 };
    for (pause, alarm) in [(10, None), (15, None), (5, Some("reader-speed"))] {
        let mut talk = Talk::in_protocol(Protocol::Tape(pacing));
        assert_eq!(talk.control.lines(), Lines::ON);
        for byte in BLOCK.bytes() {
            talk.send([byte]);
            talk.wait(pause);
        }
        talk.hears([0_u8; 0]);
        assert_eq!(talk.report().alarm.as_deref(), alarm, "{pause}");
    }
}

#[test]
fn the_run_line_goes_off_while_the_control_is_full() {
    let pacing = TapePacing::Synchronous { per_second: 400 };
    let settings = Settings { protocol: Protocol::Tape(pacing), cutting_time: 8.0, ..Settings::default() };
    let mut talk = Talk::with(settings);
    let mut off = 0;
    for byte in format!("{}DD\n", BLOCK.repeat(60)).bytes() {
        while !talk.control.lines().cts {
            off += 1;
            talk.wait(5);
        }
        assert_eq!(talk.control.send(&[byte], talk.now), 1);
        talk.now += Duration::from_micros(2500);
        talk.control.advance(talk.now);
    }
    let report = talk.report();
    assert!(off > 10 && report.holds > 0, "{off} {report:?}");
    assert!(report.max_overrun_bytes <= 1, "{report:?}");
    talk.wait(60_000);
    assert_eq!((talk.report().blocks, talk.report().alarm), (60, None));
}
