//! The 4B block `B X B Y B J B R D|DD G Z`: 3B with a radius and a flag, for a control that adds the wire's offset.
//!
//! A 4B program is the outline as drawn. The control holds the signed offset F (+ the wire runs outside, a punch; − inside, a
//! die) and makes the radius of an arc flagged `D` R + F, of one flagged `DD` R − F; lines between shift. Only arcs carry a
//! flag, and the lead-in, where it declares the sense of taper; every other block is plain 3B. Source: Zhan, Han, Sha,
//! "Manual programming for wire EDM" (2015).
//!
//! *Unverified:* the field order with the flag behind G, the spelling of the taper ratio, a flag without a fourth B.

mod corners;
pub mod offset;
mod outline;
mod read;
pub mod write;

use crate::formats::three_b;
use crate::motion::Flag;
use crate::units::Micrometres;

pub use read::{Entry, Reader};

/// One block of a 4B program.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Block {
    /// What it says in 3B.
    pub block: three_b::Block,
    /// What stands behind the fourth B; none where there is no such B, or nothing behind it.
    pub fourth: Option<Fourth>,
    /// The compensation flag.
    pub flag: Option<Flag>,
}

impl Block {
    /// Appends the block's text, without an end of block.
    pub fn write(&self, style: three_b::Style, order: Order, text: &mut Vec<u8>) {
        style.write_numbers(&self.block, text);
        if self.fourth.is_some() || self.flag.is_some() {
            text.push(b'B');
            match self.fourth {
                Some(Fourth::Radius(radius)) => three_b::push_number(text, radius.0, 1),
                Some(Fourth::Ratio(ratio)) => {
                    text.push(b'L');
                    ratio.write(text);
                }
                None => {}
            }
            style.gap(text);
        }
        let flag = |text: &mut Vec<u8>| {
            if let Some(flag) = self.flag {
                text.extend_from_slice(if flag == Flag::D { b"D" } else { b"DD" });
                style.gap(text);
            }
        };
        if order == Order::FlagBeforeAxis {
            flag(text);
        }
        style.write_axis(self.block.g, text);
        style.gap(text);
        if order == Order::FlagBehindAxis {
            flag(text);
        }
        three_b::write_instruction(self.block.motion, text);
    }
}

/// Where in a block the flag stands: controls differ.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Order {
    /// `B X B Y B J B R D G Z`, as in the 2015 paper.
    #[default]
    FlagBeforeAxis,
    /// `B X B Y B J B R G D Z`. *Unverified.*
    FlagBehindAxis,
}

/// What stands behind the fourth B.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Fourth {
    /// R: the radius of the outline, unsigned.
    Radius(Micrometres),
    /// `L`: a ratio of taper, in place of R.
    Ratio(Ratio),
}

/// A ratio of taper, in millionths. What it is a ratio of, the paper does not say.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Ratio(u64);

impl Ratio {
    /// The longest ratio as text: eight digits, a point, six decimals.
    pub(super) const BYTES_MAX: usize = 15;

    /// A ratio written in decimal; none when it is longer than eight digits and six decimals.
    #[must_use]
    pub fn parse(text: &[u8]) -> Option<Self> {
        let point = text.iter().position(|&b| b == b'.').unwrap_or(text.len());
        let (whole, decimals) = (text.get(..point)?, text.get(point + 1..).unwrap_or_default());
        if whole.len() > 8 || decimals.len() > 6 || whole.len() + decimals.len() == 0 {
            return None;
        }
        let mut value = 0;
        for n in 0..whole.len() + 6 {
            let digit = match whole.get(n) {
                Some(&digit) => digit,
                None => decimals.get(n - whole.len()).copied().unwrap_or(b'0'),
            };
            value = value * 10 + u64::from(digit.is_ascii_digit().then(|| digit - b'0')?);
        }
        Some(Self(value))
    }

    /// Appends the ratio in decimal, as short as it can be.
    pub fn write(self, text: &mut Vec<u8>) {
        let (whole, rest) = (self.0 / 1_000_000, self.0 % 1_000_000);
        text.extend_from_slice(whole.to_string().as_bytes());
        if rest > 0 {
            text.extend_from_slice(format!(".{rest:06}").trim_end_matches('0').as_bytes());
        }
    }
}

/// The largest difference between R and the circle through X, Y that rounding explains, µm.
///
/// X and Y are whole microns, and a writer may have moved them by two more to end where it should. *Guess.*
pub(super) const RADIUS_TOLERANCE_UM: f64 = 5.0;
