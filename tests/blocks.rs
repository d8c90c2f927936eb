//! 3B and 4B programs through motions and back, judged by the mock's interpolators: a second reading of the manuals.

#[path = "blocks/domain.rs"]
mod domain;
#[path = "blocks/four_b.rs"]
mod four_b;
#[path = "blocks/programs.rs"]
mod programs;
#[path = "blocks/round_trip.rs"]
mod round_trip;
