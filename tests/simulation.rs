//! The sender's machine against the mock control on a virtual clock: overrun, utilisation, holds, and what was pulled.
//!
//! Nothing here sleeps or reads a clock. The line, its latency and the control are `mock-controller`'s, a second reading
//! of the manuals; the figures are therefore arithmetic, the same on every machine.

#[path = "simulation/harness.rs"]
mod harness;

use std::time::Duration;

use dripfeed::protocol::pacing::Pace;
use dripfeed::protocol::{Ending, Failure};
use harness::{Run, Setup, program_text, run};

const MS: Duration = Duration::from_millis(1);

fn at(baud: u32, latency: Duration) -> Setup {
    Setup { baud, latency, ..Setup::default() }
}

#[test]
fn free_running_keeps_the_ten_character_rule_and_the_line_busy() {
    let cases = [
        (4800, 16 * MS),
        (9600, 4 * MS),
        (4800, Duration::ZERO),
        (9600, Duration::ZERO),
        (19_200, Duration::ZERO),
        (19_200, MS),
        (38_400, Duration::ZERO),
        (57_600, Duration::ZERO),
        (115_200, Duration::ZERO),
    ];
    for (baud, latency) in cases {
        let Run { report, holds_seen, ending, .. } = run(&at(baud, latency));
        let utilisation = report.line_utilisation.expect("the line is paced");
        println!(
            "{baud} baud, {latency:?}: {} after DC3, {:.2} % busy",
            report.max_overrun_bytes,
            100.0 * utilisation
        );
        assert_eq!(ending, Ending::Done { trailer_unsent: 0 });
        assert!(holds_seen >= 5, "{baud} baud, {latency:?}: only {holds_seen} holds");
        assert!(report.max_overrun_bytes <= 10, "{baud} baud, {latency:?}: {}", report.max_overrun_bytes);
        assert!(utilisation >= 0.99, "{baud} baud, {latency:?}: {utilisation}");
        assert_eq!(report.alarm, None);
    }
}

#[test]
fn strict_pacing_keeps_the_rule_where_the_latency_alone_would_break_it() {
    // A control slow enough to hold even a sender that leaves gaps.
    let setup = Setup { cutting_time: 3.0, ..at(9600, 16 * MS) };
    let free = run(&setup);
    assert_eq!(free.report.alarm.as_deref(), Some("overrun"));
    assert_eq!(setup.pace().worst_overrun(), 16);

    let strict = run(&Setup { strict: true, ..setup });
    let utilisation = strict.report.line_utilisation.expect("the line is paced");
    println!(
        "9600 baud, 16 ms, strict: {} after DC3, {:.2} % busy",
        strict.report.max_overrun_bytes,
        100.0 * utilisation
    );
    assert_eq!(strict.report.alarm, None);
    assert!(strict.report.max_overrun_bytes <= 10);
    assert!(utilisation >= 0.55, "{utilisation}");
    assert!(strict.holds_seen >= 5);
}

#[test]
fn the_sender_counts_at_least_the_overrun_the_control_saw() {
    for (baud, latency) in [(4800, 16 * MS), (9600, 4 * MS), (19_200, MS)] {
        let Run { report, tally, .. } = run(&at(baud, latency));
        assert!(tally.max_overrun_bytes >= report.max_overrun_bytes, "{baud}: {tally:?} {report:?}");
        assert!(tally.max_overrun_bytes <= 11, "{baud}: {tally:?}");
    }
}

#[test]
fn a_window_of_64_bytes_overruns_and_the_control_alarms() {
    // The twin that shows the checks above can fail.
    let setup = Setup { window: Some(64), ..at(4800, 16 * MS) };
    let Run { report, ending, .. } = run(&setup);
    assert!(report.max_overrun_bytes > 10);
    assert_eq!(report.alarm.as_deref(), Some("overrun"));
    assert!(matches!(ending, Ending::Failed { failure: Failure::ControlAlarm, .. }), "{ending:?}");
}

#[test]
fn parity_in_bit_8_changes_nothing() {
    let plain = run(&at(4800, 16 * MS));
    let parity = run(&Setup { dc3_parity: true, ..at(4800, 16 * MS) });
    assert_eq!(parity.report, plain.report);
    assert!(parity.holds_seen >= 5);
}

#[test]
fn what_the_control_decoded_is_the_program_and_nothing_else() {
    let setup = at(9600, 4 * MS);
    let Run { received, report, blocks_made, .. } = run(&setup);
    assert_eq!(String::from_utf8(received).unwrap(), program_text(&setup));
    assert_eq!(report.blocks, blocks_made);
}

#[test]
fn one_skipped_block_shows_in_the_pulses() {
    let whole = run(&Setup::default());
    let skipped = run(&Setup { skip_block: Some(57), ..Setup::default() });
    assert_ne!(skipped.report.pulses, whole.report.pulses);
    assert_ne!(skipped.report.sha256, whole.report.sha256);
}

#[test]
fn no_more_is_made_than_the_window_and_one_block_ahead_of_what_was_read() {
    for (baud, latency) in [(4800, 16 * MS), (9600, Duration::ZERO), (115_200, Duration::ZERO)] {
        let setup = at(baud, latency);
        let Run { most_ahead_bytes, longest_block, .. } = run(&setup);
        let bound = setup.pace().window + longest_block;
        assert!(most_ahead_bytes <= bound, "{baud}: {most_ahead_bytes} bytes ahead, {bound} allowed");
        assert!(most_ahead_bytes > 0);
    }
}

#[test]
fn an_alarm_or_reset_of_the_control_is_final_and_named() {
    let alarmed = run(&Setup { alarm_at_block: Some(40), ..Setup::default() });
    assert!(
        matches!(alarmed.ending, Ending::Failed { failure: Failure::ControlAlarm, .. }),
        "{:?}",
        alarmed.ending
    );
    let reset = run(&Setup { reset_at_block: Some(40), ..Setup::default() });
    assert!(
        matches!(reset.ending, Ending::Failed { failure: Failure::ControlReset, .. }),
        "{:?}",
        reset.ending
    );
    assert!(reset.report.blocks < 45);
}

#[test]
fn a_control_that_starts_late_loses_nothing() {
    let late = run(&Setup { start_delay: Duration::from_secs(900), ..Setup::default() });
    let prompt = run(&Setup::default());
    assert_eq!(late.report.sha256, prompt.report.sha256);
    assert_eq!(late.ending, Ending::Done { trailer_unsent: 0 });
}

#[test]
fn the_same_run_twice_is_the_same_to_the_byte_and_the_nanosecond() {
    let (a, b) = (run(&at(9600, 4 * MS)), run(&at(9600, 4 * MS)));
    assert_eq!(a.report, b.report);
    assert_eq!(a.finished_at, b.finished_at);
}

#[test]
fn what_strict_pacing_promises_is_what_the_line_then_shows() {
    let setup = Setup { strict: true, ..at(9600, 16 * MS) };
    let promised = setup.pace().best_utilisation();
    let shown = run(&setup).report.line_utilisation.expect("the line is paced");
    assert!((promised - shown).abs() < 0.05, "promised {promised}, shown {shown}");
    assert!(Pace::unpaced().gaps.is_none());
}
