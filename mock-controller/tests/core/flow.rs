//! DC1, DC3 and the time they take: start, holds, overrun, latency, utilisation.

use std::time::Duration;

use mock_controller::{Controller, Framing, Pace, Settings, SettingsError, Start};

use crate::sender::{HOUR, Sender, run, sha256, staircase};

const DC1: u8 = 0x11;
const DC3: u8 = 0x13;

fn at(baud: u32) -> Settings {
    Settings { pace: Pace::Paced { baud, framing: Framing::SEVEN_EVEN_TWO }, ..Settings::default() }
}

#[test]
fn dc1_goes_out_when_the_link_opens_and_every_5_s_until_the_first_byte() {
    let mut control = Controller::new(Settings::default()).unwrap();
    control.link_opened(Duration::from_secs(1));
    let character = Pace::Paced { baud: 9600, framing: Framing::SEVEN_EVEN_TWO }.character();
    for seconds in [1, 6, 11] {
        let leaves = Duration::from_secs(seconds) + character;
        assert_eq!(control.receive(leaves - Duration::from_nanos(1)), [0_u8; 0]);
        assert_eq!(control.receive(leaves), [DC1]);
    }
    assert_eq!(control.send(b"\0", Duration::from_secs(12)), 1);
    assert_eq!(control.receive(HOUR), [0_u8; 0]);
    assert_eq!(control.report().bytes, 1);
}

#[test]
fn a_control_that_starts_late_reads_nothing_before_its_dc1() {
    let settings = Settings { start: Start::After(Duration::from_secs(30)), ..Settings::default() };
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    assert_eq!(control.send(b"B1B1B1GYL1\n", Duration::ZERO), 11);
    assert_eq!(control.receive(Duration::from_secs(29)), [0_u8; 0]);
    assert_eq!((control.report().unread, control.blocks()), (11, 0));
    let mut sender = Sender::of(staircase(1));
    sender.feed(&mut control, Duration::from_secs(29), HOUR);
    assert_eq!((sender.codes()[0], control.blocks()), (DC1, 1));
}

#[test]
fn a_control_that_never_starts_says_nothing() {
    let mut sender = Sender::of(staircase(1));
    let report = run(Settings { start: Start::Never, ..Settings::default() }, &mut sender);
    assert_eq!((sender.codes().len(), report.bytes), (0, 0));
}

#[test]
fn a_control_a_little_slower_than_the_line_really_holds_and_loses_nothing() {
    let mut sender = Sender::of(staircase(200));
    let report = run(Settings::default(), &mut sender);
    assert_eq!((report.blocks, report.end_um, report.alarm), (200, [2000, 0], None));
    assert!(report.holds >= 3, "{}", report.holds);
    // The one character of the window completes with DC3's own stop bit.
    assert_eq!(report.max_overrun_bytes, 0);
    // DC1 to start, DC3 and DC1 for each hold, DC3 at the end.
    let codes = sender.codes();
    let (go, hold) =
        (codes.iter().filter(|&&c| c == DC1).count(), codes.iter().filter(|&&c| c == DC3).count());
    assert_eq!((go as u64, hold as u64), (report.holds + 1, report.holds + 1));
    assert_eq!(report.sha256, sha256(&staircase(200).replace("%\n", "")));
    assert!(report.held_seconds > 0.1, "{}", report.held_seconds);
    let utilisation = report.line_utilisation.unwrap();
    assert!((0.999..=1.0).contains(&utilisation), "{utilisation}");
}

#[test]
fn a_control_as_fast_as_the_line_never_holds() {
    let report = run(Settings { cutting_time: 0.9, ..Settings::default() }, &mut Sender::of(staircase(200)));
    assert_eq!((report.blocks, report.holds, report.max_overrun_bytes), (200, 0, 0));
}

#[test]
fn a_sender_that_ignores_dc3_is_stopped_at_the_eleventh_character() {
    let mut sender = Sender::of(staircase(200)).heedless();
    let report = run(Settings::default(), &mut sender);
    assert_eq!(report.alarm.as_deref(), Some("overrun"));
    assert!(report.blocks < 200, "{}", report.blocks);
    assert_eq!(sender.codes()[..], [DC1, DC3, DC3, 0x15]);
    assert!(report.max_overrun_bytes > 10, "{}", report.max_overrun_bytes);
}

#[test]
fn a_window_of_11_keeps_the_rule_and_one_of_12_does_not() {
    for (window, alarm) in [(1, None), (5, None), (11, None), (12, Some("overrun")), (64, Some("overrun"))] {
        // The first character of the window completes with DC3's own stop bit, the others after it.
        let report = run(at(4800), &mut Sender::of(staircase(100)).window(window));
        assert_eq!(report.alarm.as_deref(), alarm, "window {window}: {}", report.max_overrun_bytes);
        if alarm.is_none() {
            assert_eq!(report.max_overrun_bytes, window as u64 - 1, "window {window}");
        }
    }
}

#[test]
fn sixteen_milliseconds_of_latency_are_7_characters_at_4800_and_14_at_9600() {
    for (baud, overrun, alarm) in [(4800, 7, None), (9600, 14, Some("overrun"))] {
        let latency = Duration::from_millis(16);
        let mut sender = Sender::of(staircase(200));
        let roomy = Settings { latency, overrun_limit: 50, buffer_bytes: 300, ..at(baud) };
        let report = run(roomy, &mut sender);
        assert_eq!((report.max_overrun_bytes, report.blocks, report.alarm), (overrun, 200, None), "{baud}");
        let report = run(Settings { latency, ..at(baud) }, &mut Sender::of(staircase(200)));
        assert_eq!(report.alarm.as_deref(), alarm, "{baud}");
    }
}

#[test]
fn with_latency_the_line_lies_idle_only_where_the_sender_lets_it() {
    let settings = Settings { latency: Duration::from_millis(8), ..at(4800) };
    let utilisation = run(settings, &mut Sender::of(staircase(200))).line_utilisation.unwrap();
    assert!((0.999..=1.0).contains(&utilisation), "{utilisation}");
}

#[test]
fn a_sender_that_pauses_is_seen_in_the_utilisation() {
    let mut control = Controller::new(Settings { cutting_time: 0.0, ..Settings::default() }).unwrap();
    control.link_opened(Duration::ZERO);
    let character = control.settings().pace.character();
    // Ten characters, each followed by a gap as long as itself.
    for index in 0..10_u32 {
        assert_eq!(control.send(b" ", character * 2 * (index + 1)), 1);
    }
    control.advance(HOUR);
    let utilisation = control.report().line_utilisation.unwrap();
    assert!((utilisation - 10.0 / 19.0).abs() < 1e-6, "{utilisation}");
}

#[test]
fn with_parity_dc3_nak_and_syn_come_with_bit_8_and_dc1_does_not() {
    let mut sender = Sender::of(staircase(40));
    run(Settings { dc3_parity: true, alarm_at_block: Some(30), ..Settings::default() }, &mut sender);
    let codes = sender.codes();
    assert_eq!((codes[0], codes[1], codes[codes.len() - 2], codes[codes.len() - 1]), (DC1, 0x93, 0x93, 0x95));
    let mut sender = Sender::of(staircase(5));
    run(Settings { dc3_parity: true, reset_at_block: Some(2), ..Settings::default() }, &mut sender);
    assert_eq!(sender.codes(), [DC1, 0x93, 0x96]);
}

#[test]
fn the_parity_of_what_is_sent_is_masked_and_nul_is_ignored() {
    let program: Vec<u8> = staircase(3)
        .bytes()
        .flat_map(|byte| [if byte.count_ones() % 2 == 1 { byte | 0x80 } else { byte }, 0x00])
        .collect();
    let report = run(Settings::default(), &mut Sender::of(program));
    assert_eq!((report.blocks, report.alarm), (3, None));
    assert_eq!(report.sha256, sha256(&staircase(3).replace("%\n", "")));
}

#[test]
fn after_a_program_dc3_says_that_it_has_been_heard_and_begins_no_hold() {
    let mut sender = Sender::of(format!("{}{}", staircase(2), "\0".repeat(50)));
    let report = run(Settings { cutting_time: 0.0, ..Settings::default() }, &mut sender);
    assert_eq!(sender.codes(), [DC1, DC3]);
    assert_eq!((report.holds, report.max_overrun_bytes, report.programs), (0, 0, 1));
}

#[test]
fn the_driver_takes_what_it_has_room_for() {
    let mut control = Controller::new(Settings { fifo_bytes: 8, ..Settings::default() }).unwrap();
    assert_eq!(control.send(b"a", Duration::ZERO), 0, "the link is closed");
    control.link_opened(Duration::ZERO);
    // One goes straight into the shift register.
    assert_eq!(control.send(b"            ", Duration::ZERO), 8);
    assert_eq!((control.room(), control.queued()), (1, 8));
    assert_eq!(control.send(b"  ", Duration::ZERO), 1);
    assert_eq!(control.room(), 0);
    control.advance(control.settings().pace.time_of(3));
    assert_eq!((control.room(), control.queued(), control.characters_read()), (3, 6, 3));
}

#[test]
fn blocks_take_their_cutting_time_one_after_the_other() {
    let settings = Settings { cutting_time: 2.0, ..Settings::default() };
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    let character = control.settings().pace;
    assert_eq!(control.send(b"B1BB1GXL1B2BB2GXL1", Duration::ZERO), 18);
    // Nine characters each: complete at 9 and 18, cut from 9 to 27 and from 27 to 45.
    for (characters, blocks) in [(26, 0), (27, 1), (44, 1), (45, 2)] {
        control.advance(character.time_of(characters) + Duration::from_nanos(2));
        assert_eq!(control.blocks(), blocks, "after {characters} characters");
    }
    assert_eq!(control.position_um(), [3, 0]);
}

#[test]
fn the_hold_begins_at_xoff_and_ends_at_xon_to_the_character() {
    for (xon_at, blocks) in [(10, 2), (11, 1), (12, 1)] {
        let settings = Settings { cutting_time: 1000.0, xoff_at: 20, xon_at, ..Settings::default() };
        let mut control = Controller::new(settings).unwrap();
        control.link_opened(Duration::ZERO);
        let mut now = Duration::ZERO;
        // Blocks of nine characters; the first is taken up at once, so 20 are reached at the second of the fourth.
        for (index, byte) in "B1BB1GXL1".repeat(4).bytes().take(29).enumerate() {
            assert!(!control.is_holding(), "after {index} characters");
            assert_eq!(control.send(&[byte], now), 1);
            now += control.settings().pace.time_of(2);
            control.advance(now);
        }
        assert!(control.is_holding() && control.buffered() == 20);
        // Taking up the second block leaves 11, the third 2.
        while control.is_holding() {
            let _ = control.receive(control.next_wakeup().unwrap());
        }
        assert_eq!(control.blocks(), blocks, "xon-at {xon_at}");
    }
}

#[test]
fn a_block_that_an_alarm_breaks_off_is_not_counted() {
    let settings = Settings { cutting_time: 1000.0, ..Settings::default() };
    let report = run(settings, &mut Sender::of(staircase(200)).heedless());
    assert_eq!((report.alarm.as_deref(), report.blocks, report.pulses), (Some("overrun"), 0, 0));
}

#[test]
fn settings_that_contradict_each_other_are_refused() {
    let refused = |settings: Settings| Controller::new(settings).err();
    let base = Settings::default;
    assert!(refused(base()).is_none());
    assert!(refused(Settings::unpaced()).is_none());
    let wrong = Settings { xon_at: 192, ..base() };
    assert_eq!(refused(wrong), Some(SettingsError::XonNotBelowXoff { xon_at: 192, xoff_at: 192 }));
    let tight = Settings { buffer_bytes: 203, ..base() };
    assert!(refused(tight).is_none());
    let wrong = Settings { buffer_bytes: 202, ..base() };
    assert_eq!(refused(wrong), Some(SettingsError::BufferTooSmall { buffer_bytes: 202, needed: 203 }));
    assert_eq!(refused(at(0)), Some(SettingsError::ZeroBaud));
    let wrong = Settings { cutting_time: 1.0, ..Settings::unpaced() };
    assert_eq!(refused(wrong), Some(SettingsError::CuttingTimeUnpaced));
    assert!(refused(Settings { cutting_time: -1.0, ..base() }).is_some());
    assert!(refused(Settings { fifo_bytes: 0, ..base() }).is_some());
}

#[test]
fn a_buffer_smaller_than_a_block_still_ends_one_way_or_the_other() {
    let tiny = Settings { buffer_bytes: 13, xoff_at: 2, xon_at: 1, ..Settings::default() };
    let report = run(tiny, &mut Sender::of(staircase(3)));
    assert_eq!(report.alarm.as_deref(), Some("buffer-overflow"));
}
