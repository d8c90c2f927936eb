//! Block formats: one grammar a file, read and written.
//!
//! Readers yield blocks with their place and never hold a program; writers append one block's text at a time.
//! 3B is here; 4B and G-code are not yet.

pub mod three_b;
