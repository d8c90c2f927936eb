//! Arbitrary bytes into every reader: refused or read, but never a panic, and nothing lost in silence.
//!
//! `cargo test --test fuzz` tries each for a moment; `cargo bolero test three_b::…` goes on for as long as one likes.

#[path = "fuzz/dxf.rs"]
mod dxf;
#[path = "fuzz/four_b.rs"]
mod four_b;
#[path = "fuzz/gcode.rs"]
mod gcode;
#[path = "fuzz/three_b.rs"]
mod three_b;
