//! Each protocol from the sender's side, in bytes written out here, on a virtual clock. Nothing here sleeps.

#![expect(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod answer;
mod codes;
mod fanuc_a;
mod faults;
mod frames;
mod grbl;
mod heidenhain;
mod holds;
mod lines;
mod marlin;
mod talk;
mod tape;
mod xmodem;
mod ymodem;
