//! `dripfeed generate gear`, judged from outside: the paper's table row by row, and gears of any kind executed by the
//! mock's interpolators and laid against formulas written out here.
//!
//! Nothing of the program is used but what it prints. The formulas are in `gear/theory.rs`; how blocks are matched to
//! elements is argued in `gear/execution.rs`.

#[path = "gear/any_gear.rs"]
mod any_gear;
#[path = "gear/binary.rs"]
mod binary;
#[path = "gear/execution.rs"]
mod execution;
#[path = "gear/outlines.rs"]
mod outlines;
#[path = "gear/paper.rs"]
mod paper;
#[path = "gear/part.rs"]
mod part;
#[path = "gear/refusals.rs"]
mod refusals;
#[path = "gear/sabotage.rs"]
mod sabotage;
#[path = "gear/streams.rs"]
mod streams;
#[path = "gear/syntax.rs"]
mod syntax;
#[path = "gear/theory.rs"]
mod theory;
