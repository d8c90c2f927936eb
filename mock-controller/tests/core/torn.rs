//! A link that closes in mid-program, and the next connection.

use std::time::Duration;

use mock_controller::{Controller, Settings, Torn};

use crate::sender::{HOUR, Sender, sha256};

const HALF: &str = "B10BB10GXL1\nB10BB1";
const FIRST: &str = "B10BB10GXL1\n";

fn second(seconds: u64) -> Duration {
    Duration::from_secs(seconds)
}

/// One connection: opens, sends all at once, closes at once.
fn connect(control: &mut Controller, now: Duration, text: &str) {
    control.link_opened(now);
    assert_eq!(control.send(text.as_bytes(), now), text.len());
    control.link_closed(now);
}

#[test]
fn what_is_in_the_driver_still_travels_after_the_link_has_closed() {
    let mut control = Controller::new(Settings::default()).unwrap();
    connect(&mut control, Duration::ZERO, &FIRST.repeat(5));
    assert_eq!((control.blocks(), control.queued()), (0, 60));
    control.advance(HOUR);
    assert_eq!((control.blocks(), control.queued(), control.report().torn), (5, 0, 0));
}

#[test]
fn an_unfinished_block_is_dropped_and_does_not_join_the_next_bytes() {
    let mut control = Controller::new(Settings::default()).unwrap();
    connect(&mut control, Duration::ZERO, HALF);
    control.advance(second(9));
    assert_eq!((control.blocks(), control.report().torn), (1, 1));
    // What would have completed the block is a label that no block begins with.
    connect(&mut control, second(10), &format!("0GXL1\n{FIRST}%\n"));
    control.advance(HOUR);
    let report = control.report();
    assert_eq!((report.blocks, report.end_um, report.alarm, report.programs), (2, [20, 0], None, 1));
    assert_eq!((report.skipped, report.connections), (5, 2));
    assert_eq!(report.sha256, sha256(&FIRST.repeat(2)));
}

#[test]
fn a_program_broken_off_and_gone_on_with_gives_the_digest_of_the_whole() {
    for leader in ["", "%\n", "\n", "\0\0\0%\n\n"] {
        let mut control = Controller::new(Settings::default()).unwrap();
        connect(&mut control, Duration::ZERO, &format!("{leader}{HALF}"));
        connect(&mut control, second(10), &format!("{leader}B10BB10GXL1\n{FIRST}%\n"));
        control.advance(HOUR);
        let report = control.report();
        let found = (report.blocks, report.programs, report.alarm.as_deref());
        assert_eq!(found, (3, 1, None), "{leader:?}");
        assert_eq!(report.sha256, sha256(&FIRST.repeat(3)), "{leader:?}");
    }
}

#[test]
fn a_block_complete_at_its_z_digit_is_cut_though_its_line_never_ended() {
    let mut control = Controller::new(Settings::default()).unwrap();
    connect(&mut control, Duration::ZERO, "B10BB10GXL1");
    connect(&mut control, second(10), &format!("{FIRST}%\n"));
    control.advance(HOUR);
    assert_eq!((control.blocks(), control.report().torn), (2, 0));
    assert_eq!(control.report().sha256, sha256(&FIRST.repeat(2)));
}

#[test]
fn kept_the_unfinished_block_joins_the_next_bytes_into_a_wild_move() {
    let keep = || Controller::new(Settings { torn: Torn::Keep, ..Settings::default() }).unwrap();
    let mut control = keep();
    connect(&mut control, Duration::ZERO, HALF);
    connect(&mut control, second(10), "0GXL1\n%\n");
    control.advance(HOUR);
    assert_eq!((control.blocks(), control.position_um(), control.report().torn), (2, [20, 0], 0));
    // A digit more is ten times the move; a line end alone is no help where white space is free.
    let mut control = keep();
    connect(&mut control, Duration::ZERO, "B10BB10GXL1\nB10BB10");
    connect(&mut control, second(10), "00GXL1\n%\n");
    control.advance(HOUR);
    assert_eq!((control.blocks(), control.position_um()), (2, [1010, 0]));
    let mut control = keep();
    connect(&mut control, Duration::ZERO, HALF);
    connect(&mut control, second(10), &format!("\n{FIRST}%\n"));
    control.advance(HOUR);
    assert_eq!(control.alarm(), Some("format"));
    // A leader with % clears it.
    let mut control = keep();
    connect(&mut control, Duration::ZERO, HALF);
    connect(&mut control, second(10), &format!("%\n{FIRST}%\n"));
    control.advance(HOUR);
    let report = control.report();
    assert_eq!((report.blocks, report.alarm, report.torn, report.programs), (2, None, 1, 1));
}

#[test]
fn a_percent_first_on_a_fresh_connection_is_a_leader_and_not_the_end() {
    let mut control = Controller::new(Settings::default()).unwrap();
    connect(&mut control, Duration::ZERO, &format!("%\n{FIRST}"));
    connect(&mut control, second(10), "%\n");
    control.advance(second(60));
    assert_eq!(control.report().programs, 0);
    connect(&mut control, second(60), &format!("%\n%\n{FIRST}%\n"));
    control.advance(HOUR);
    assert_eq!((control.report().programs, control.blocks(), control.report().connections), (1, 2, 3));
}

#[test]
fn a_stop_word_alone_on_a_fresh_connection_is_the_end() {
    for (word, programs) in [("DD\n", 1), ("E\n", 1), ("D\n", 0), ("%\nDD\n%\n", 1)] {
        let mut control = Controller::new(Settings::default()).unwrap();
        connect(&mut control, Duration::ZERO, FIRST);
        connect(&mut control, second(10), word);
        control.advance(HOUR);
        let report = control.report();
        assert_eq!((report.programs, report.blocks, report.alarm), (programs, 1, None), "{word:?}");
        assert_eq!(report.sha256, sha256(&format!("{FIRST}{}", word.replace("%\n", ""))), "{word:?}");
    }
}

#[test]
fn the_next_connection_is_greeted_with_dc1_and_nothing_old_is_heard() {
    let mut control = Controller::new(Settings { latency: second(1), ..Settings::default() }).unwrap();
    control.link_opened(Duration::ZERO);
    control.advance(Duration::from_millis(500));
    control.link_closed(Duration::from_millis(500));
    control.link_opened(Duration::from_millis(600));
    assert_eq!(
        control.receive(Duration::from_millis(1600)),
        [0_u8; 0],
        "the DC1 of the first opening is lost"
    );
    assert_eq!(control.receive(Duration::from_millis(1602)), [0x11]);
}

#[test]
fn a_control_still_full_greets_only_when_it_has_drained() {
    let settings = Settings { cutting_time: 100.0, ..Settings::default() };
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    let mut sender = Sender::of(FIRST.repeat(40));
    sender.feed(&mut control, Duration::ZERO, second(1));
    assert!(control.is_holding());
    control.link_closed(second(1));
    control.link_opened(second(2));
    assert_eq!(control.receive(second(3)), [0_u8; 0]);
    assert!(control.is_holding());
    while control.is_holding() {
        control.advance(control.next_wakeup().unwrap());
    }
    let drained = control.next_wakeup().unwrap();
    assert!(drained > second(3));
    // Then it asks as any waiting control does: again after 5 s.
    assert_eq!(control.receive(drained + second(4)), [0x11]);
    assert_eq!(control.receive(drained + second(6)), [0x11]);
}
