//! What macros count with, against exact fractions of any size.
//!
//! Nothing here knows how a decimal is held: one goes in as digits and decimals, and comes back as it is spelled.

#[path = "numbers/arithmetic.rs"]
mod arithmetic;
#[path = "numbers/exact.rs"]
mod exact;
#[path = "numbers/functions.rs"]
mod functions;
#[path = "numbers/loops.rs"]
mod loops;
#[path = "numbers/roots.rs"]
mod roots;
#[path = "numbers/series.rs"]
mod series;
