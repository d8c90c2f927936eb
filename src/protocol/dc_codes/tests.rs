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

/// A line of a character a millisecond, three bytes ahead, heard four milliseconds late.
fn paced() -> DcCodes {
    let pace = Pace { character: Some(MS), window: 3, gaps: None, latency: 4 * MS };
    DcCodes::new(settings(pace), Duration::ZERO)
}

#[test]
fn reset_and_alarm_are_heard_from_the_start_to_the_end_and_not_before() {
    for (byte, failure) in [(0x16, Failure::ControlReset), (0x15, Failure::ControlAlarm)] {
        let mut m = machine();
        m.offer_block(1, b"DD\n");
        m.handle_received(&[byte], MS);
        assert_eq!(m.phase(), Phase::AwaitingStart { since: Duration::ZERO });

        let feeding = |m: &mut DcCodes| {
            m.handle_transmitted(5, MS);
            assert_eq!(m.phase(), Phase::Feeding);
        };
        let held = |m: &mut DcCodes| {
            m.handle_transmitted(5, MS);
            m.handle_received(&[0x13], MS);
            assert_eq!(m.phase(), Phase::Held { since: MS });
        };
        let draining = |m: &mut DcCodes| {
            m.finish(ProgramEnd::StopWord);
            m.handle_transmitted(7, MS);
            assert_eq!(m.phase(), Phase::Draining);
        };
        let lingering = |m: &mut DcCodes| {
            m.finish(ProgramEnd::StopWord);
            m.handle_transmitted(5, MS);
            m.handle_received(&[0x13], MS);
            assert_eq!(m.phase(), Phase::Lingering { until: MS + LINGER });
        };
        for bring_to in [&feeding as &dyn Fn(&mut DcCodes), &held, &draining, &lingering] {
            let mut m = machine();
            m.handle_received(&[0x11], MS);
            m.offer_block(1, b"DD\n");
            bring_to(&mut m);
            m.handle_received(&[byte], 2 * MS);
            assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Failed { failure, torn: None })));
        }
    }
}

#[test]
fn the_tally_counts_bytes_holds_and_the_time_held() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    assert_eq!(take(&mut m, 2 * MS).len(), 5);
    m.handle_received(&[0x13], 4 * MS);
    m.handle_received(&[0x11], 7 * MS);
    m.handle_received(&[0x13], 8 * MS);
    m.handle_received(&[0x11], 10 * MS);
    m.offer_block(2, b"B2\n");
    assert_eq!(take(&mut m, 11 * MS).len(), 3);
    let last_byte = Some((11 * MS, 5 * MS));
    // Of an unpaced line nothing is known but that all five may have come after DC3; none went out between the holds.
    let tally = Tally { bytes: 8, last_byte, held: 5 * MS, holds: 2, max_overrun_bytes: 5 };
    assert_eq!(m.tally(), tally);
}

#[test]
fn the_overrun_is_what_the_wire_completes_after_dc3_has_left_the_control() {
    let mut m = paced();
    m.handle_received(&[0x11], Duration::ZERO);
    m.offer_block(1, b"B1B1B1\n");
    assert_eq!(take(&mut m, Duration::ZERO).len(), 3);
    assert_eq!(take(&mut m, 2 * MS).len(), 2);
    // Five characters, completed at 1 to 5 ms; heard at 5 ms, DC3 left at 1 ms.
    m.handle_received(&[0x13], 5 * MS);
    assert_eq!(m.tally().max_overrun_bytes, 4);
}

#[test]
fn a_hold_with_blocks_to_go_is_a_hold_though_the_source_is_at_its_end() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    m.offer_block(1, b"DD\n");
    m.finish(ProgramEnd::StopWord);
    m.handle_transmitted(5, MS);
    m.handle_received(&[0x13], MS);
    assert_eq!(m.phase(), Phase::Held { since: MS });

    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.handle_transmitted(2, MS);
    m.handle_received(&[0x13], MS);
    m.finish(ProgramEnd::StopWord);
    assert_eq!(m.phase(), Phase::Held { since: MS });
}

#[test]
fn a_hold_before_the_source_says_it_ends_with_a_block_stays_one() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    m.handle_transmitted(5, MS);
    m.handle_received(&[0x13], MS);
    m.finish(ProgramEnd::Block);
    assert_eq!(m.phase(), Phase::Held { since: MS });
}

#[test]
fn dc3_is_the_end_where_there_is_no_trailer_to_ask_for() {
    let mut m = DcCodes::new(Settings { trailer: Vec::new(), ..settings(Pace::unpaced()) }, Duration::ZERO);
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    take(&mut m, MS);
    m.finish(ProgramEnd::StopWord);
    m.handle_received(&[0x13], 2 * MS);
    assert_eq!((m.phase(), m.poll_timeout(2 * MS)), (Phase::Draining, Some(2 * MS + LISTEN)));
}

#[test]
fn the_control_is_listened_to_until_well_after_the_line_is_empty() {
    let mut m = paced();
    m.handle_received(&[0x11], Duration::ZERO);
    m.offer_block(1, b"D");
    assert_eq!(take(&mut m, Duration::ZERO), b"%\nD");
    m.finish(ProgramEnd::StopWord);
    assert_eq!(take(&mut m, 3 * MS), b"%\n");
    let over = 5 * MS + 4 * MS + LISTEN;
    assert_eq!(m.poll_timeout(3 * MS), Some(over));
    m.handle_timeout(over - Duration::from_nanos(1));
    assert_eq!(m.phase(), Phase::Draining);
    m.handle_timeout(over);
    assert_eq!(m.phase(), Phase::Ended);
}

#[test]
fn a_link_that_goes_while_the_last_bytes_are_on_the_wire_is_lost() {
    let mut m = paced();
    m.handle_received(&[0x11], Duration::ZERO);
    m.offer_block(1, b"D");
    m.finish(ProgramEnd::StopWord);
    take(&mut m, Duration::ZERO);
    take(&mut m, 3 * MS);
    assert_eq!(m.phase(), Phase::Draining);
    m.handle_link_lost(5 * MS - Duration::from_nanos(1));
    let failure = Failure::LinkLost;
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Failed { failure, torn: None })));
}

#[test]
fn a_stop_that_comes_when_all_is_handed_over_takes_nothing_back() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"DD\n");
    m.finish(ProgramEnd::StopWord);
    take(&mut m, MS);
    m.handle_command(Command::StopAtBlock, 2 * MS);
    m.handle_timeout(MS + LISTEN);
    assert_eq!(events(&mut m).last(), Some(&Event::Ended(Ending::Done { trailer_unsent: 0 })));
}

#[test]
fn what_the_link_did_not_take_goes_out_before_what_is_offered_after_it() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    m.offer_block(1, b"B1\n");
    m.handle_transmitted(3, MS);
    m.offer_block(2, b"B2\n");
    assert_eq!(take(&mut m, MS), b"1\nB2\n");
}

#[test]
fn what_was_handed_over_is_not_kept_for_good_though_something_always_waits() {
    let mut m = machine();
    m.handle_received(&[0x11], MS);
    for n in 1..=50 {
        m.offer_block(n, &[b'B'; COMPACT_AT]);
        m.handle_transmitted(m.left() - 1, MS);
        assert!(m.text.len() <= 2 * COMPACT_AT + 2);
    }
}

#[test]
fn one_block_is_asked_for_before_the_start_and_none_of_an_empty_program() {
    let mut m = machine();
    assert!(m.wants_block(MS));
    m.offer_block(1, b"B1\n");
    assert!(!m.wants_block(MS));
    let mut m = machine();
    m.finish(ProgramEnd::Block);
    assert!(!m.wants_block(MS));
}

#[test]
fn what_waits_here_and_what_is_on_the_wire_share_the_window() {
    let mut m = paced();
    m.handle_received(&[0x11], Duration::ZERO);
    assert_eq!(take(&mut m, Duration::ZERO), b"%\n");
    assert!(m.wants_block(Duration::ZERO));
    m.offer_block(1, b"B");
    assert!(!m.wants_block(Duration::ZERO));
    assert!(m.wants_block(MS));
    m.offer_block(2, b"B");
    assert!(!m.wants_block(MS));
}

#[test]
fn a_machine_with_nothing_to_send_waits_for_the_source_and_one_with_something_for_the_wire() {
    let mut m = paced();
    m.handle_received(&[0x11], Duration::ZERO);
    take(&mut m, Duration::ZERO);
    assert_eq!(m.poll_timeout(Duration::ZERO), None);
    // Two of three places are taken: when the first character has left the wire there is room for two.
    m.offer_block(1, b"B1\n");
    take(&mut m, Duration::ZERO);
    assert_eq!(m.poll_timeout(Duration::ZERO), Some(MS));
    m.handle_timeout(3 * MS);
    assert_eq!(take(&mut m, 3 * MS), b"1\n");
    m.offer_block(2, b"B");
    assert_eq!(m.poll_timeout(4 * MS), Some(4 * MS));
}
