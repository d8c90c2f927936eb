//! Macros judged from outside: their numbers by exact fractions and by series written out here.

#[path = "macros/numbers.rs"]
mod numbers;
