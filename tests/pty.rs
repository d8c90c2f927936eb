//! End to end: the real `dripfeed` against the real `mock-controller`, and against a control of the tests' own, over
//! pseudo-terminals and TCP. A pseudo-terminal has no baud, parity or modem lines: what depends on those is shown by
//! `simulation` on the line model.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![expect(
    clippy::disallowed_methods,
    reason = "other processes are waited for, by the clock and not for ever"
)]

#[path = "pty/bench.rs"]
mod bench;
#[path = "pty/faults.rs"]
mod faults;
#[path = "pty/formats.rs"]
mod formats;
#[path = "pty/kills.rs"]
mod kills;
#[path = "pty/own_control.rs"]
mod own_control;
#[path = "pty/whole_jobs.rs"]
mod whole_jobs;
