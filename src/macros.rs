//! Custom macro B, expanded lazily into plain blocks: the macro program is the source, what it makes is fed.
//!
//! ```text
//!  text ── words, statements ── Program ── Expansion ── Block ── Printer ── bytes
//!                                (parsed,    (runs with    (words with
//!                                 checked)    fuel)         values)
//!                                └───────────────── Expanded ─────────────────┘
//! ```
//!
//! A program is parsed whole (a macro is small, what it makes is not) and run a block at a time: memory does not grow
//! with what is made. It counts in decimals, as the programmer wrote them ([`decimal`]); a control that counts in binary
//! floating point is followed on request ([`binary`]). Nothing here reads a file or a clock, and nothing is emitted past
//! an error.

pub mod binary;
pub mod block;
pub mod decimal;
pub mod expanded;
pub mod findings;
pub mod form;
pub mod number;
pub mod options;
pub mod printer;
pub mod program;
pub mod run;
pub mod starvation;

mod arguments;
mod branches;
mod calls;
mod code;
mod diagnosis;
mod expression;
mod foresight;
mod functions;
mod line;
mod linking;
mod machine;
mod making;
mod modal;
mod reader;
mod references;
mod statement;
mod suppress;
mod survey;
mod variables;
mod words;
