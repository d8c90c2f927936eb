//! Macros judged from outside: their numbers by exact fractions and by series written out here.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "macros/numbers.rs"]
mod numbers;
