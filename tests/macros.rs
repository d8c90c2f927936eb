//! Custom macro B: constructs against the manuals, whole programs, arbitrary text; its numbers by exact fractions and by
//! series written out here.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "macros/conformance.rs"]
mod conformance;
#[path = "macros/diagnostics.rs"]
mod diagnostics;
#[path = "macros/expand.rs"]
mod expand;
#[path = "macros/expressions.rs"]
mod expressions;
#[path = "macros/fuzz.rs"]
mod fuzz;
#[path = "macros/numbers.rs"]
mod numbers;
#[path = "macros/running.rs"]
mod running;
#[path = "macros/spelling.rs"]
mod spelling;
