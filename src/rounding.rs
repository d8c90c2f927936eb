//! From elements in millimetres to 3B blocks in whole microns.
//!
//! A 3B control counts pulses and has no absolute position: each block starts where the last one really ended. The
//! 1990 paper rounds every block on its own ([`per_block`]), and the remainders drift; the [`closed_loop`] chooses each
//! block from where the control really stands. Both pull one element at a time and hold one element's blocks at most.

pub mod audit;
pub mod closed_loop;
pub mod per_block;
mod pieces;

use crate::formats::three_b::Block;
use crate::geometry::{Element, Point};

/// One element of a part on its way to blocks.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The directed element.
    pub element: Element,
    /// What it is in the part.
    pub role: Role,
}

/// What an element is in its part.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Role {
    /// The way from the start hole to the contour.
    LeadIn,
    /// The first element of a closed contour.
    Opening,
    /// Any other element of a contour.
    Contour,
    /// The element that brings a contour back to where it opened.
    Closing,
}

/// A block and the point of the theoretical path it is meant to end at.
#[derive(Clone, Copy, Debug)]
pub struct Made {
    /// The block.
    pub block: Block,
    /// Where the path is when the block ends, mm.
    pub target: Point,
    /// Whether the target is a node: the end of an element, not a place where one was split.
    pub at_node: bool,
    /// What the element is in its part.
    pub role: Role,
}

/// Which controls the blocks must be right for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Aim {
    /// One named model of the interpolator.
    One(crate::interpolator::Model),
    /// Every model at once.
    Any,
}
