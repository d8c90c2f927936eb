//! The control and its line on a virtual clock, fed by a sender of the tests' own. Nothing here sleeps.

#![expect(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod arbitrary;
mod arcs;
mod beside;
mod ends;
mod faults;
mod flow;
mod four_b;
mod gcode;
mod lines;
mod mixed;
mod quiet;
mod registers;
mod sender;
mod taper;
mod torn;
mod watch;
mod writer;
