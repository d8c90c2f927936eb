//! RTS/CTS and DTR/DSR: what the lines say, who stops, and how many characters come after all.

use std::collections::BTreeMap;
use std::time::Duration;

use mock_controller::{Controller, FaultKind, Handshake, Lines, Protocol, Report, Settings};

use crate::talk::BLOCK;

const OFF: Lines = Lines { cts: false, dsr: false };

fn program(blocks: usize) -> Vec<u8> {
    format!("%\n{}%\n", BLOCK.repeat(blocks)).into_bytes()
}

/// Feeds a program while `may_send` allows, at most `window` characters in the driver; what was said, and the report.
fn feed(settings: Settings, window: usize, mut may_send: impl FnMut(Lines) -> bool) -> (Vec<u8>, Report) {
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    let (program, mut sent, mut now, mut said) = (program(200), 0, Duration::ZERO, Vec::new());
    for _ in 0..1_000_000 {
        said.extend(control.receive(now));
        while may_send(control.lines()) && sent < program.len() && control.queued() < window {
            sent += control.send(&program[sent..=sent], now);
        }
        match control.next_wakeup() {
            Some(next) => now = now.max(next),
            None => return (said, control.report()),
        }
    }
    panic!("no end");
}

#[test]
fn cts_is_off_until_the_control_is_started_and_the_driver_waits() {
    let start = mock_controller::Start::After(Duration::from_secs(3));
    let settings = Settings { protocol: Protocol::RtsCts, start, ..Settings::default() };
    let mut control = Controller::new(settings).unwrap();
    assert_eq!(control.lines(), Lines { cts: false, dsr: true });
    control.link_opened(Duration::ZERO);
    assert_eq!(control.send(BLOCK.as_bytes(), Duration::ZERO), BLOCK.len());
    control.advance(Duration::from_millis(2999));
    assert_eq!((control.characters_read(), control.queued()), (0, BLOCK.len()));
    control.advance(Duration::from_secs(4));
    assert_eq!((control.lines(), control.blocks()), (Lines::ON, 1));
    assert_eq!(control.receive(Duration::from_secs(60)), [0_u8; 0], "nothing is said");
}

#[test]
fn a_driver_that_obeys_cts_sends_at_most_the_character_it_has_begun() {
    let settings = Settings { protocol: Protocol::RtsCts, ..Settings::default() };
    let (said, report) = feed(settings, 4096, |_| true);
    assert_eq!((report.blocks, report.programs, report.alarm), (200, 1, None));
    assert!(report.holds >= 3 && report.held_seconds > 0.1, "{}", report.holds);
    assert_eq!((said.len(), report.max_overrun_bytes), (0, 1));
}

#[test]
fn a_driver_that_ignores_cts_overruns() {
    let handshake = Handshake::Ignored;
    let settings = Settings { protocol: Protocol::RtsCts, handshake, ..Settings::default() };
    let (said, report) = feed(settings, 4096, |_| true);
    assert_eq!((report.alarm.as_deref(), said.len()), (Some("overrun"), 0));
}

#[test]
fn dsr_stops_no_driver_but_a_program_that_looks_keeps_the_rule() {
    let settings = Settings { protocol: Protocol::DtrDsr, ..Settings::default() };
    for window in [1, 4, 11] {
        let (said, report) = feed(settings.clone(), window, |lines| lines.dsr);
        assert_eq!((report.blocks, report.programs, report.alarm), (200, 1, None), "{window}");
        assert_eq!((said.len(), report.max_overrun_bytes), (0, window as u64 - 1), "what was in the driver");
        assert!(report.holds >= 3, "{}", report.holds);
    }
    let (_, report) = feed(settings.clone(), 12, |lines| lines.dsr);
    assert_eq!(report.alarm.as_deref(), Some("overrun"));
    let (_, report) = feed(settings, 1, |_| true);
    assert_eq!(report.alarm.as_deref(), Some("overrun"));
}

#[test]
fn a_link_without_lines_holds_the_characters_back_itself() {
    let handshake = Handshake::Both;
    let settings = Settings { protocol: Protocol::DtrDsr, handshake, ..Settings::default() };
    let (_, report) = feed(settings, 4096, |_| true);
    assert_eq!((report.blocks, report.alarm, report.max_overrun_bytes), (200, None, 1));
}

#[test]
fn a_broken_ready_line_is_the_alarm_dsr_in_every_protocol() {
    for protocol in [Protocol::DcCodes, Protocol::RtsCts, Protocol::DtrDsr, Protocol::Xmodem] {
        let faults = BTreeMap::from([(FaultKind::DsrDrop, 1.0)]);
        let settings = Settings { protocol: protocol.clone(), faults, ..Settings::default() };
        let mut control = Controller::new(settings).unwrap();
        control.link_opened(Duration::ZERO);
        control.advance(Duration::from_secs(1));
        assert_eq!(control.lines(), Lines::ON, "{protocol:?}");
        assert_eq!(control.send(b"B", Duration::from_secs(1)), 1);
        control.advance(Duration::from_secs(2));
        let report = control.report();
        assert_eq!((control.lines(), report.alarm.as_deref()), (OFF, Some("dsr")), "{protocol:?}");
        assert_eq!(report.faults, BTreeMap::from([("dsr-drop".to_owned(), 1)]));
    }
}

#[test]
fn a_sender_that_drops_its_dtr_in_mid_program_raises_the_alarm_and_one_that_is_done_does_not() {
    for (text, alarm) in [(BLOCK.to_owned(), Some("dsr")), (format!("{BLOCK}DD\n"), None)] {
        let mut control = Controller::new(Settings::default()).unwrap();
        control.link_opened(Duration::ZERO);
        control.sender_ready(true, Duration::from_secs(1));
        assert_eq!(control.send(text.as_bytes(), Duration::from_secs(1)), text.len());
        control.sender_ready(false, Duration::from_secs(2));
        assert_eq!(control.alarm(), alarm, "{text:?}");
    }
}

#[test]
fn a_line_that_is_lost_leaves_the_hold_or_the_overrun_behind() {
    let with = |kind| {
        let faults = BTreeMap::from([(kind, 1.0)]);
        feed(Settings { protocol: Protocol::RtsCts, faults, ..Settings::default() }, 4096, |_| true).1
    };
    let report = with(FaultKind::XoffLost);
    assert_eq!((report.alarm.as_deref(), report.faults["xoff-lost"]), (Some("overrun"), 1));
    let report = with(FaultKind::XonLost);
    assert_eq!((report.alarm, report.programs, report.holds), (None, 0, 1), "held for good");
    let report = with(FaultKind::XonLate);
    assert_eq!((report.alarm, report.programs), (None, 1));
    assert!(report.faults["xon-late"] >= 1 && report.held_seconds > 0.5, "{}", report.held_seconds);
}
