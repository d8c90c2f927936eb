//! Faults: each is seen to strike, to be counted, and to have the effect its name says.

use std::collections::BTreeMap;
use std::time::Duration;

use mock_controller::{BlockEnd, Controller, FaultKind, Observer, Report, Settings};

use crate::sender::{HOUR, Sender, run, sha256, staircase};

fn with(kind: FaultKind, rate: f64) -> Settings {
    Settings { faults: BTreeMap::from([(kind, rate)]), seed: 3, ..Settings::default() }
}

fn struck(report: &Report, kind: FaultKind) -> u64 {
    report.faults.get(kind.name()).copied().unwrap_or(0)
}

#[test]
fn a_rate_of_zero_never_strikes() {
    let faults = FaultKind::ALL.into_iter().map(|kind| (kind, 0.0)).collect();
    let report = run(Settings { faults, ..Settings::default() }, &mut Sender::of(staircase(100)));
    assert_eq!((report.blocks, report.alarm, report.faults.len()), (100, None, 0));
}

#[test]
fn noise_changes_what_is_received_and_is_counted() {
    for kind in [FaultKind::Flip, FaultKind::Drop, FaultKind::Double, FaultKind::Insert] {
        let report = run(with(kind, 0.01), &mut Sender::of(staircase(100)));
        let count = struck(&report, kind);
        assert!(count > 0, "{kind}");
        assert_ne!(report.sha256, sha256(&staircase(100).replace("%\n", "")), "{kind}");
    }
    let doubled = run(with(FaultKind::Double, 1.0), &mut Sender::of("%\n\n\n"));
    assert_eq!((doubled.bytes, struck(&doubled, FaultKind::Double)), (8, 4));
    let dropped = run(with(FaultKind::Drop, 1.0), &mut Sender::of("%\n\n\n"));
    assert_eq!((dropped.bytes, struck(&dropped, FaultKind::Drop)), (0, 4));
    let foreign = run(with(FaultKind::Insert, 1.0), &mut Sender::of("%\n"));
    assert_eq!((foreign.bytes, struck(&foreign, FaultKind::Insert)), (4, 2));
}

#[test]
fn wrong_parity_is_an_alarm() {
    let report = run(with(FaultKind::Parity, 0.02), &mut Sender::of(staircase(100)));
    assert_eq!(report.alarm.as_deref(), Some("parity"));
    assert!(report.blocks < 100 && struck(&report, FaultKind::Parity) >= 1);
}

#[test]
fn an_echo_comes_back_as_it_was_sent() {
    let mut control = Controller::new(with(FaultKind::Echo, 1.0)).unwrap();
    control.link_opened(Duration::ZERO);
    assert_eq!(control.send(b"%\n", Duration::ZERO), 2);
    assert_eq!(control.receive(Duration::from_secs(1)), [0x11, b'%', b'\n']);
}

#[test]
fn a_lost_dc3_is_an_overrun() {
    let report = run(with(FaultKind::XoffLost, 1.0), &mut Sender::of(staircase(100)));
    assert_eq!((report.alarm.as_deref(), struck(&report, FaultKind::XoffLost)), (Some("overrun"), 1));
}

#[test]
fn a_lost_dc1_leaves_the_sender_held_for_ever() {
    let mut sender = Sender::of(staircase(100));
    let report = run(with(FaultKind::XonLost, 0.5), &mut sender);
    assert!(!sender.has_sent_all());
    assert!(report.alarm.is_none() && report.programs == 0 && struck(&report, FaultKind::XonLost) > 0);
}

#[test]
fn a_late_dc1_costs_time_and_a_doubled_one_nothing() {
    let mut sender = Sender::of(staircase(60));
    let report = run(with(FaultKind::XonLate, 1.0), &mut sender);
    assert_eq!((report.blocks, report.alarm.as_deref()), (60, None));
    assert!(sender.heard[0].0 >= Duration::from_millis(500), "{:?}", sender.heard[0]);
    assert!(struck(&report, FaultKind::XonLate) > 1);
    let mut sender = Sender::of(staircase(60));
    let report = run(with(FaultKind::XonDouble, 1.0), &mut sender);
    assert_eq!((report.blocks, report.alarm.as_deref()), (60, None));
    assert_eq!(sender.codes()[..2], [0x11, 0x11]);
}

#[test]
fn an_alarm_and_a_nak_storm_stop_the_control_for_good() {
    let mut sender = Sender::of(staircase(100));
    let report = run(with(FaultKind::Alarm, 0.05), &mut sender);
    assert_eq!((report.alarm.as_deref(), struck(&report, FaultKind::Alarm)), (Some("nak"), 1));
    assert_eq!(sender.codes()[sender.codes().len() - 2..], [0x13, 0x15]);
    let mut sender = Sender::of(staircase(100));
    let report = run(with(FaultKind::NakStorm, 0.05), &mut sender);
    assert_eq!(report.alarm.as_deref(), Some("nak-storm"));
    assert_eq!(sender.codes().iter().filter(|&&code| code == 0x15).count(), 20);
}

#[test]
fn an_alarm_at_a_block_comes_before_it_is_cut() {
    let mut sender = Sender::of(staircase(100));
    let report = run(Settings { alarm_at_block: Some(17), ..Settings::default() }, &mut sender);
    assert_eq!((report.blocks, report.end_um, report.alarm.as_deref()), (16, [160, 0], Some("nak")));
}

#[test]
fn a_reset_clears_the_buffer_is_deaf_until_the_link_opens_and_keeps_the_position() {
    let settings = Settings { reset_at_block: Some(17), ..Settings::default() };
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    let mut sender = Sender::of(staircase(100));
    let now = sender.feed(&mut control, Duration::ZERO, HOUR);
    assert_eq!(sender.codes()[sender.codes().len() - 2..], [0x13, 0x16]);
    assert_eq!((control.blocks(), control.buffered(), control.alarm()), (16, 0, None));
    assert_eq!(control.send(staircase(1).as_bytes(), now), staircase(1).len());
    control.advance(now + Duration::from_secs(1));
    assert_eq!(control.blocks(), 16);
    control.link_closed(now + Duration::from_secs(1));
    control.link_opened(now + Duration::from_secs(2));
    let mut sender = Sender::of(staircase(84));
    sender.feed(&mut control, now + Duration::from_secs(2), 2 * HOUR);
    let report = control.report();
    assert_eq!((report.blocks, report.end_um, report.resets, report.programs), (100, [1000, 0], 1, 1));
}

#[test]
fn a_stall_is_a_long_hold_and_nothing_is_lost() {
    let report = run(with(FaultKind::Stall, 0.05), &mut Sender::of(staircase(100)));
    assert_eq!((report.blocks, report.alarm.as_deref()), (100, None));
    assert!(report.held_seconds > 1.0 && struck(&report, FaultKind::Stall) > 0, "{}", report.held_seconds);
}

#[test]
fn a_stall_on_an_unpaced_line_holds_the_line_itself() {
    let settings = Settings { faults: BTreeMap::from([(FaultKind::Stall, 0.05)]), ..Settings::unpaced() };
    let report = run(settings, &mut Sender::of(staircase(100)).window(4096));
    assert_eq!((report.blocks, report.alarm.as_deref(), report.max_overrun_bytes), (100, None, 0));
    assert!(report.holds > 0);
}

#[test]
fn a_pulled_cable_loses_what_is_on_its_way_and_the_next_connection_goes_on() {
    let mut control = Controller::new(with(FaultKind::Disconnect, 0.002)).unwrap();
    let mut now = Duration::ZERO;
    let mut pulled = 0;
    for _ in 0..200 {
        control.link_opened(now);
        let left = 100 - control.blocks();
        // Whoever goes on knows where the control stands; here it is asked.
        let mut sender = Sender::of(staircase(left)).window(8);
        now = sender.feed(&mut control, now, now + HOUR);
        if !control.take_disconnected() {
            break;
        }
        pulled += 1;
        assert_eq!(control.queued(), 0);
        control.link_closed(now);
        control.advance(now + Duration::from_secs(60));
        now += Duration::from_secs(60);
    }
    let report = control.report();
    assert!(pulled > 0);
    assert_eq!((report.blocks, report.end_um, report.programs), (100, [1000, 0], 1));
    assert_eq!((struck(&report, FaultKind::Disconnect), report.connections), (pulled, pulled + 1));
}

/// Keeps everything it sees.
#[derive(Default)]
struct Witness {
    pulses: Vec<(Duration, u64, i64, i64)>,
    ends: Vec<BlockEnd>,
    text: Vec<u8>,
}

impl Observer for Witness {
    fn pulse(&mut self, at: Duration, block: u64, x_um: i64, y_um: i64) {
        self.pulses.push((at, block, x_um, y_um));
    }

    fn block_end(&mut self, end: &BlockEnd) {
        self.ends.push(*end);
    }

    fn text(&mut self, text: &[u8]) {
        self.text.extend_from_slice(text);
    }
}

#[test]
fn the_same_seed_gives_the_same_run_to_the_pulse_and_another_seed_another() {
    let witness = |seed| {
        let faults = FaultKind::ALL.into_iter().filter(|&kind| kind != FaultKind::Disconnect);
        let faults = faults.map(|kind| (kind, 0.0007)).collect();
        let mut control =
            Controller::observed(Settings { faults, seed, ..Settings::default() }, Witness::default())
                .unwrap();
        control.link_opened(Duration::ZERO);
        // An echo is no code, so the sender that checks every code will not do here.
        let program = staircase(300).into_bytes();
        let mut now = Duration::ZERO;
        let mut sent = 0;
        let mut may_send = false;
        while now < HOUR {
            for byte in control.receive(now) {
                may_send = if byte == 0x11 {
                    true
                } else if byte == 0x13 {
                    false
                } else {
                    may_send
                };
            }
            if may_send && control.queued() == 0 && sent < program.len() {
                sent += control.send(&program[sent..=sent], now);
            }
            match control.next_wakeup() {
                Some(next) => now = now.max(next),
                None => break,
            }
        }
        let report = control.report();
        (std::mem::take(&mut control.observer_mut().pulses), report)
    };
    assert_eq!(witness(1), witness(1));
    assert_ne!(witness(1).1, witness(2).1);
}

#[test]
fn pulses_are_spread_evenly_over_the_cutting_time_and_told_in_order() {
    let settings = Settings { cutting_time: 1.0, ..Settings::default() };
    let mut control = Controller::observed(settings, Witness::default()).unwrap();
    control.link_opened(Duration::ZERO);
    Sender::of("%\nB10BB10GXL1\nB3B4B4GYL2\n%\n").feed(&mut control, Duration::ZERO, HOUR);
    let seen = control.observer_mut();
    assert_eq!(seen.pulses.len(), 17);
    assert_eq!(seen.text, b"B10BB10GXL1\nB3B4B4GYL2\n");
    let [first, second] = seen.ends[..] else { panic!("two blocks") };
    assert_eq!((first.number, first.start_um, first.end_um, first.pulses), (1, [0, 0], [10, 0], 10));
    assert_eq!((second.number, second.start_um, second.end_um, second.pulses), (2, [10, 0], [7, 4], 7));
    assert_eq!(second.block.to_string(), "B3B4B4GYL2");
    let tenth = (first.ended - first.began) / 10;
    for (index, &(at, block, x, y)) in seen.pulses[..10].iter().enumerate() {
        let steps = u32::try_from(index).unwrap() + 1;
        assert_eq!((block, x, y), (1, i64::from(steps), 0));
        let wanted = first.began + tenth * steps;
        assert!(at.abs_diff(wanted) < Duration::from_nanos(20), "{at:?} {wanted:?}");
    }
    assert!(seen.pulses.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    assert_eq!(seen.pulses[16].0, second.ended);
}
