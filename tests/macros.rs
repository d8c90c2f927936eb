//! Custom macro B: constructs against the manuals, whole programs, arbitrary text.

#[path = "macros/conformance.rs"]
mod conformance;
#[path = "macros/spelling.rs"]
mod spelling;
