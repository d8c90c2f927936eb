//! Offsets, compensation and cutting plans judged by dense sampling and by formulas, from outside.
//!
//! The distances here are worked out again in `offset/measure.rs`; the contours are random ones no one drew by hand,
//! non-convex, with arcs, with slots too narrow for the wire and necks at which they come apart.

#[path = "offset/compensation.rs"]
mod compensation;
#[path = "offset/contours.rs"]
mod contours;
#[path = "offset/cutting.rs"]
mod cutting;
#[path = "offset/formulas.rs"]
mod formulas;
#[path = "offset/leads.rs"]
mod leads;
#[path = "offset/measure.rs"]
mod measure;
#[path = "offset/programs.rs"]
mod programs;
#[path = "offset/reach.rs"]
mod reach;
#[path = "offset/sampling.rs"]
mod sampling;
