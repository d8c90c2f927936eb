//! The machine by itself: every arrow of its picture, and the promises an operator relies on.

use super::*;

const MS: Duration = Duration::from_millis(1);

fn settings(pace: Pace) -> Settings {
    Settings {
        pace,
        wait_for_start: true,
        start_timeout: None,
        leader: b"%\n".to_vec(),
        trailer: b"%\n".to_vec(),
    }
}

fn machine() -> DcCodes {
    DcCodes::new(settings(Pace::unpaced()), Duration::ZERO)
}

/// Hands everything over that may be, and returns it.
fn take(machine: &mut DcCodes, now: Duration) -> Vec<u8> {
    let bytes = machine.poll_transmit(now).to_vec();
    if !bytes.is_empty() {
        machine.handle_transmitted(bytes.len(), now);
    }
    bytes
}

fn events(machine: &mut DcCodes) -> Vec<Event> {
    std::iter::from_fn(|| machine.poll_event()).collect()
}

#[test]
fn nothing_goes_out_before_the_control_asks_and_a_second_request_is_not_a_second_start() {
    let mut m = machine();
    m.offer_block(1, b"B1\n");
    assert_eq!(take(&mut m, MS), b"");
    m.handle_received(&[0x11], 2 * MS);
    assert_eq!(take(&mut m, 2 * MS), b"%\nB1\n");
    m.handle_received(&[0x11, 0x11], 3 * MS);
    m.offer_block(2, b"B2\n");
    assert_eq!(take(&mut m, 3 * MS), b"B2\n");
    let started = events(&mut m).into_iter().filter(|e| *e == Event::Started).count();
    assert_eq!(started, 1);
}

#[test]
fn a_profile_may_start_at_once() {
    let mut m = DcCodes::new(Settings { wait_for_start: false, ..settings(Pace::unpaced()) }, Duration::ZERO);
    assert_eq!(take(&mut m, MS), b"%\n");
}

#[test]
fn dc3_holds_with_and_without_parity_in_bit_8() {
    for dc3 in [0x13, 0x93] {
        let mut m = machine();
        m.handle_received(&[0x11], MS);
        m.offer_block(1, b"B1\n");
        m.handle_received(&[dc3], 2 * MS);
        assert_eq!(m.phase(), Phase::Held { since: 2 * MS });
        assert_eq!(take(&mut m, 3 * MS), b"");
        m.handle_received(&[0x11], 5 * MS);
        assert_eq!(take(&mut m, 5 * MS), b"%\nB1\n");
        assert!(events(&mut m).contains(&Event::Released { held: 3 * MS }));
    }
}

#[test]
fn a_hold_of_ten_hours_is_shown_and_not_timed_out() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    m.handle_received(&[0x13], 2 * MS);
    let hours = Duration::from_secs(36_000);
    assert_eq!(m.poll_timeout(hours), None);
    m.handle_timeout(hours);
    assert_eq!(m.phase(), Phase::Held { since: 2 * MS });
    m.handle_received(&[0x13], hours);
    assert_eq!(m.phase(), Phase::Held { since: 2 * MS });
}

#[test]
fn reset_and_alarm_are_final_in_either_parity() {
    let cases = [
        (0x16, Failure::ControlReset),
        (0x96, Failure::ControlReset),
        (0x15, Failure::ControlAlarm),
        (0x95, Failure::ControlAlarm),
    ];
    for (byte, failure) in cases {
        let mut m = machine();
        m.offer_block(1, b"B1B2\n");
        m.handle_received(&[0x11], MS);
        m.handle_transmitted(4, MS);
        m.handle_received(&[0x13, byte, 0x11], 2 * MS);
        assert_eq!(m.phase(), Phase::Ended);
        let torn = Some(Torn { line: TornLine::Block(1), bytes: 2 });
        assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Failed { failure, torn })));
        assert_eq!(take(&mut m, 3 * MS), b"");
    }
}

#[test]
fn dc3_after_the_last_byte_is_the_end_and_not_a_hold() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.finish(ProgramEnd::StopWord);
    assert_eq!(take(&mut m, MS), b"%\nDD\n%\n");
    m.handle_received(&[0x13], MS);
    m.handle_timeout(MS + LISTEN);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Done { trailer_unsent: 0 })));
    assert_eq!(m.tally().holds, 0);
}

#[test]
fn an_alarm_just_after_the_last_byte_is_heard() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.finish(ProgramEnd::StopWord);
    take(&mut m, MS);
    m.handle_received(&[0x13, 0x15], 20 * MS);
    let failure = Failure::ControlAlarm;
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Failed { failure, torn: None })));
}

#[test]
fn a_hold_after_the_last_byte_is_known_for_the_end_once_the_source_is_at_its_end() {
    let mut m = DcCodes::new(Settings { trailer: Vec::new(), ..settings(Pace::unpaced()) }, Duration::ZERO);
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    take(&mut m, MS);
    m.handle_received(&[0x13], MS);
    assert_eq!(m.phase(), Phase::Held { since: MS });
    m.finish(ProgramEnd::StopWord);
    m.handle_timeout(MS + LISTEN);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Done { trailer_unsent: 0 })));
}

#[test]
fn a_torn_stop_word_is_not_called_a_block() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    m.offer_block(1, b"DD\n");
    m.handle_transmitted(6, MS);
    m.handle_command(Command::StopAtBlock, MS);
    m.handle_command(Command::StopNow, MS);
    let torn = Some(Torn { line: TornLine::StopWordAfter(1), bytes: 1 });
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Stopped { torn })));
}

#[test]
fn a_link_that_goes_once_all_is_on_the_wire_takes_nothing_with_it() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.finish(ProgramEnd::StopWord);
    take(&mut m, MS);
    m.handle_link_lost(2 * MS);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Done { trailer_unsent: 0 })));
}

#[test]
fn a_control_that_stops_at_the_stop_word_need_not_take_the_trailer() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.finish(ProgramEnd::StopWord);
    m.handle_transmitted(5, MS);
    m.handle_received(&[0x13], MS);
    assert_eq!(m.poll_timeout(MS), Some(MS + LINGER));
    m.handle_timeout(MS + LINGER);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Done { trailer_unsent: 2 })));
}

#[test]
fn a_hold_at_the_stop_word_is_known_for_the_end_once_the_source_is_at_its_end() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.handle_transmitted(5, MS);
    m.handle_received(&[0x13], MS);
    assert_eq!(m.phase(), Phase::Held { since: MS });
    m.finish(ProgramEnd::StopWord);
    assert_eq!(m.poll_timeout(MS), Some(MS + LINGER));
    m.handle_received(&[0x11], 2 * MS);
    assert_eq!(take(&mut m, 2 * MS), b"%\n");
}

#[test]
fn a_hold_before_the_trailer_without_a_stop_word_is_a_hold() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    m.finish(ProgramEnd::Block);
    m.handle_transmitted(5, MS);
    m.handle_received(&[0x13], MS);
    assert_eq!(m.phase(), Phase::Held { since: MS });
    m.handle_received(&[0x11], 2 * MS);
    assert_eq!(take(&mut m, 2 * MS), b"%\n");
}

#[test]
fn a_stop_waits_for_the_end_of_the_block_and_a_second_one_does_not() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1B1\n");
    m.offer_block(2, b"B2B2\n");
    m.handle_transmitted(4, MS);
    m.handle_command(Command::StopAtBlock, MS);
    assert!(!m.wants_block(MS));
    assert_eq!(take(&mut m, MS), b"B1\n");
    m.handle_timeout(2 * MS);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Stopped { torn: None })));

    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1B1\n");
    m.handle_transmitted(4, MS);
    m.handle_received(&[0x13], MS);
    m.handle_command(Command::StopAtBlock, MS);
    assert_eq!(m.phase(), Phase::Held { since: MS });
    m.handle_command(Command::StopNow, MS);
    let torn = Some(Torn { line: TornLine::Block(1), bytes: 2 });
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Stopped { torn })));
}

#[test]
fn a_control_that_never_starts_is_waited_for_unless_the_profile_says_how_long() {
    assert_eq!(machine().poll_timeout(MS), None);
    let limit = Duration::from_secs(3);
    let mut m =
        DcCodes::new(Settings { start_timeout: Some(limit), ..settings(Pace::unpaced()) }, Duration::ZERO);
    assert_eq!(m.poll_timeout(MS), Some(limit));
    m.handle_timeout(limit);
    let failure = Failure::NeverStarted(limit);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Failed { failure, torn: None })));
}

#[test]
fn no_more_than_the_window_is_handed_over_ahead_of_the_wire() {
    let character = Duration::from_micros(1146);
    let mut m = DcCodes::new(settings(Pace::free(character, 4 * MS, 10, None)), Duration::ZERO);
    m.handle_received(&[0x11], Duration::ZERO);
    m.offer_block(1, &[b'B'; 100]);
    assert_eq!(take(&mut m, Duration::ZERO).len(), 3);
    assert_eq!(take(&mut m, Duration::ZERO).len(), 0);
    assert_eq!(take(&mut m, character).len(), 1);
    let wake = m.poll_timeout(character).unwrap();
    assert!(character < wake && wake <= 4 * character);
}

#[test]
fn blocks_are_asked_for_only_when_the_window_has_room() {
    let character = Duration::from_micros(1146);
    let mut m = DcCodes::new(settings(Pace::free(character, 4 * MS, 10, None)), Duration::ZERO);
    m.handle_received(&[0x11], Duration::ZERO);
    assert!(m.wants_block(MS));
    m.offer_block(1, &[b'B'; 20]);
    assert!(!m.wants_block(MS));
}
