//! Arbitrary bytes into every reader: no panic, no unbounded memory, no silent loss.
//!
//! Bounded here; `cargo bolero test -T 10m NAME` runs one of them for long.

#[path = "fuzz/gcode.rs"]
mod gcode;
