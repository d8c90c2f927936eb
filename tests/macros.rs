//! Custom macro B: constructs against the manuals, whole programs, arbitrary text.

#[path = "macros/conformance.rs"]
mod conformance;
#[path = "macros/diagnostics.rs"]
mod diagnostics;
#[path = "macros/fuzz.rs"]
mod fuzz;
#[path = "macros/running.rs"]
mod running;
#[path = "macros/spelling.rs"]
mod spelling;
