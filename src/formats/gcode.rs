//! G-code as wire cutters speak it, read and written.
//!
//! ```text
//!  Boundaries   where blocks begin, and their N numbers          as fast as lines are found
//!  Blocks       words, places, modal state                       no allocation a block
//!  Motions      what the machine does: crate::motion             an iterator, as of every format
//! ```
//!
//! What a word means is decided by the control: a [`Dialect`] is data, a file of its own. Macro programs are not read
//! here; they are expanded first.

mod arcs;
mod blocks;
mod boundaries;
pub mod dialect;
mod interpret;
mod machine;
pub mod modal;
pub mod numbers;
mod registers;
mod subprograms;
pub mod words;
mod write;

pub use blocks::{Block, Blocks};
pub use boundaries::{Boundaries, Boundary};
pub use dialect::Dialect;
pub use interpret::{CALLS_MAX, Motions};
pub use subprograms::{Library, SUBPROGRAM_BYTES_MAX};
pub use write::{Layout, Writer};
