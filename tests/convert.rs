//! `dripfeed convert`, judged from outside: what it writes is cut by the mock control, a second and independent reading
//! of the manuals, and laid against what the mock cuts of the original, or against formulas.
//!
//! Nothing of the program is used but what it prints. How two cuts are compared is told in `convert/control.rs`.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "convert/arcs.rs"]
mod arcs;
#[path = "convert/backwards.rs"]
mod backwards;
#[path = "convert/control.rs"]
mod control;
#[path = "convert/dialects.rs"]
mod dialects;
#[path = "convert/drawings.rs"]
mod drawings;
#[path = "convert/four_b.rs"]
mod four_b;
#[path = "cli/golden.rs"]
mod golden;
#[path = "convert/out.rs"]
mod out;
#[path = "convert/refusals.rs"]
mod refusals;
#[path = "convert/remarks.rs"]
mod remarks;
#[path = "convert/shop.rs"]
mod shop;
#[path = "convert/streams.rs"]
mod streams;
#[path = "convert/three_b.rs"]
mod three_b;
#[path = "../mock-controller/tests/core/writer.rs"]
mod writer;
