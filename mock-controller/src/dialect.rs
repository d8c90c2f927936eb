//! What a control understands as a block.
//!
//! One file a dialect; each gives a type for its block and an assembly that is fed one character at a time, as the
//! characters come off the line. Only 3B is here.

pub mod three_b;
