//! The line between the sender's program and the control: a driver's FIFO, a shift register, and noise.
//!
//! Characters handed to the driver cannot be recalled. They travel one at a time, each taking the time its bits take.
//! Nothing here knows what the characters mean.
//!
//! Source: domain/4, rule 1 (4096 bytes of kernel FIFO; overshoot counted in completed characters).

pub(crate) mod back;
pub mod fault;
pub(crate) mod forward;
pub mod pace;
pub(crate) mod utilisation;
