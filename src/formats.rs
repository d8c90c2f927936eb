//! Block formats: one grammar a file, read and written.
//!
//! Readers yield blocks with their place and never hold a program; writers append one block's text at a time. What they
//! have in common is [`crate::motion`].

pub mod four_b;
pub mod gcode;
pub mod lines;
pub mod losses;
pub mod three_b;

use std::borrow::Cow;
use std::io;

use thiserror::Error;

use crate::motion::Motion;
use crate::place::{Place, Spot};

/// What is wrong with a program.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The source failed.
    #[error("the program could not be read")]
    Io(#[from] io::Error),
    /// Something in it breaks a rule of its format.
    #[error("{message}")]
    Program {
        /// The rule broken.
        message: String,
        /// Where.
        place: Place,
        /// What to do about it.
        help: Cow<'static, str>,
    },
}

/// Spells motions in one format. Holds no more of a program than the format needs to look back at.
pub trait Writer {
    /// Appends the lines a motion takes, each with its end; none where the format has no room for it.
    ///
    /// # Errors
    ///
    /// When the format cannot say it.
    fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError>;

    /// Appends what the program ends with.
    ///
    /// # Errors
    ///
    /// When what was written cannot be ended there.
    fn finish(&mut self, text: &mut Vec<u8>) -> Result<(), WriteError>;
}

/// What a format cannot say.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub struct WriteError {
    /// The rule of the format.
    pub message: String,
    /// Where in the source it was said.
    pub spot: Spot,
    /// What to do about it.
    pub help: Cow<'static, str>,
}
