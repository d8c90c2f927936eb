//! What a macro counts with: the operations of the language, by one kind of number.
//!
//! The language runs over this trait, so that a program can be run in decimals or, for a control that really counts so,
//! in binary floating point. Null (an undefined variable) is not a number: it is the language's.

pub(super) mod codes;

use std::cmp::Ordering;
use std::fmt::Debug;

use thiserror::Error;

/// Why an operation has no result. Its place is known to whoever asked.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
#[non_exhaustive]
pub enum Undefined {
    /// Larger than the numbers held.
    #[error("the result has more digits than a macro variable holds")]
    TooLarge,
    /// Division, MOD or TAN's.
    #[error("division by zero")]
    DivisionByZero,
    /// SQRT of less than nothing, beyond what rounding explains.
    #[error("SQRT of {0}, a negative number")]
    RootOfNegative(String),
    /// LN of zero or less.
    #[error("LN of {0}: it is defined above 0 only")]
    LogarithmOf(String),
    /// ASIN or ACOS beyond ±1.
    #[error("{0} of {1}: it is defined from -1 to 1")]
    ArcOf(&'static str, String),
    /// TAN of 90°.
    #[error("TAN of {0} degrees has no value")]
    TangentOf(String),
    /// A power of a negative number with a fraction for exponent, or 0 to a negative one.
    #[error("POW[{0},{1}] has no value")]
    PowerOf(String, String),
    /// BIN or BCD of what is no such code.
    #[error("{0} of {1}: {2}")]
    CodeOf(&'static str, String, &'static str),
    /// AND, OR, XOR of what is not whole or is negative.
    #[error("{0} takes whole numbers from 0 up, not {1}")]
    NotBits(&'static str, String),
}

/// A number of a macro program.
pub trait Number: Copy + Debug + Send + Sync + 'static {
    /// Its name in profiles: `decimal`, `f64`.
    const NAME: &'static str;
    /// Nothing.
    const ZERO: Self;

    /// A whole number.
    fn whole(value: i64) -> Self;
    /// A number as it is written: its digits and how many stand behind the point (at most 18).
    fn written(digits: i64, decimals: u8) -> Self;
    /// The number where it is exactly a whole one.
    fn as_whole(self) -> Option<i64>;
    /// `self × 10^decimals`, rounded to a whole number with halves away from zero: what is printed. None beyond an i64.
    fn at_decimals(self, decimals: u8) -> Option<i64>;
    /// Its shortest exact spelling, for messages: `0.02`, `-3`.
    fn text(self) -> String;
    /// As binary floating point, for what is drawn or estimated.
    fn approximate(self) -> f64;

    /// Which is larger; without epsilon.
    fn compare(self, other: Self) -> Ordering;
    /// `-self`.
    fn negated(self) -> Self;
    /// ABS.
    fn absolute(self) -> Self;
    /// `+`
    ///
    /// # Errors
    ///
    /// Beyond the numbers held.
    fn plus(self, other: Self) -> Result<Self, Undefined>;
    /// `-`
    ///
    /// # Errors
    ///
    /// Beyond the numbers held.
    fn minus(self, other: Self) -> Result<Self, Undefined>;
    /// `*`
    ///
    /// # Errors
    ///
    /// Beyond the numbers held.
    fn times(self, other: Self) -> Result<Self, Undefined>;
    /// `/`
    ///
    /// # Errors
    ///
    /// By zero, and beyond the numbers held.
    fn over(self, other: Self) -> Result<Self, Undefined>;
    /// MOD: the remainder, with the sign of `self`.
    ///
    /// # Errors
    ///
    /// By zero.
    fn modulo(self, other: Self) -> Result<Self, Undefined>;
    /// AND, OR, XOR of whole numbers.
    ///
    /// # Errors
    ///
    /// Of what is not whole or is negative.
    fn bits(self, operation: Bits, other: Self) -> Result<Self, Undefined>;
    /// ROUND to `decimals` places, halves away from zero; FIX and FUP towards and away from zero.
    ///
    /// # Errors
    ///
    /// Beyond the numbers held.
    fn rounded(self, rounding: Rounding, decimals: u8) -> Result<Self, Undefined>;
    /// A function of one argument; angles in degrees.
    ///
    /// # Errors
    ///
    /// Where it has no value.
    fn function(self, function: Function) -> Result<Self, Undefined>;
    /// `ATAN[self]/[other]`: the angle of (x = other, y = self), from 0 to 360 degrees.
    ///
    /// # Errors
    ///
    /// Of (0, 0).
    fn arc_tangent(self, other: Self) -> Result<Self, Undefined>;
    /// POW[self, exponent].
    ///
    /// # Errors
    ///
    /// Where it has no value.
    fn power(self, exponent: Self) -> Result<Self, Undefined>;
}

/// An operation bit by bit.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Bits {
    /// Both.
    And,
    /// Either.
    Or,
    /// One of them.
    Xor,
}

/// How a number is made whole.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Rounding {
    /// ROUND: to the nearest, halves away from zero.
    Nearest,
    /// FIX: towards zero.
    Down,
    /// FUP: away from zero.
    Up,
}

/// A function of one argument.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Function {
    /// SIN
    Sine,
    /// COS
    Cosine,
    /// TAN
    Tangent,
    /// ASIN
    ArcSine,
    /// ACOS
    ArcCosine,
    /// ATAN of one argument, from -90 to 90 degrees
    ArcTangent,
    /// SQRT
    Root,
    /// LN
    Logarithm,
    /// EXP
    Exponential,
    /// BIN: from binary coded decimal
    FromBcd,
    /// BCD: to binary coded decimal
    ToBcd,
}
