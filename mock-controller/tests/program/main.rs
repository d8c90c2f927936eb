//! The program itself, over a pseudo-terminal, TCP and a device, fed with raw bytes.
//!
//! Time is real here; every wait is for something to happen, with a deadline.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod device;
mod faults;
mod fields;
mod process;
mod protocols;
mod pty;
mod tcp;
mod words;
