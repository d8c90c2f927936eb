//! Binary floating point: what a macro counts with on a control that counts so (`numbers = "f64"`).
//!
//! Here 25 less 250 times 0.02 is 20.0000000000001, a loop down to 20 takes a turn more, `COS[90]` is 6e-17, and all that is
//! meant: a program mended for such a control makes what it makes there. Fanuc's Series 15i counts in doubles (B-63324EN/03,
//! 17 "Custom macro", "Data type"); what other controls clamp or round on the way is unverified and left out.
//!
//! Functions are `libm`'s, the same on every platform. There is no infinity and nothing that is not a number: either is
//! [`Undefined`].

use std::cmp::Ordering;

use super::number::codes;
use super::number::{Bits, Function, Number, Rounding, Undefined};

/// A double.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Binary(f64);

/// Above this a negative number under a root counts as nought, as for decimals.
const NOUGHT_ABOVE: f64 = -1e-9;
/// 2^63: from here on no i64 holds it.
const TOO_LARGE: f64 = 9_223_372_036_854_775_808.0;
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

impl Binary {
    /// A value where it is a number; never -0, which no one would understand in print.
    fn held(value: f64) -> Result<Self, Undefined> {
        if value.is_finite() { Ok(Self(value + 0.0)) } else { Err(Undefined::TooLarge) }
    }

    fn fits(value: f64) -> Option<i64> {
        (value.abs() < TOO_LARGE).then_some(value as i64)
    }

    fn radians(self) -> f64 {
        self.0 * (std::f64::consts::PI / 180.0)
    }
}

impl Number for Binary {
    const NAME: &'static str = "f64";
    const ZERO: Self = Self(0.0);

    #[inline]
    fn whole(value: i64) -> Self {
        Self(value as f64)
    }

    #[inline]
    fn written(digits: i64, decimals: u8) -> Self {
        assert!(decimals <= 18, "a number is written with at most 18 decimals, not {decimals}");
        Self(digits as f64 / ten_to(decimals))
    }

    #[inline]
    fn as_whole(self) -> Option<i64> {
        if self.0.trunc() == self.0 { Self::fits(self.0) } else { None }
    }

    #[inline]
    fn at_decimals(self, decimals: u8) -> Option<i64> {
        Self::fits((self.0 * ten_to(decimals)).round())
    }

    fn text(self) -> String {
        format!("{}", self.0)
    }

    #[inline]
    fn approximate(self) -> f64 {
        self.0
    }

    #[inline]
    fn compare(self, other: Self) -> Ordering {
        // Neither is ever what cannot be compared.
        self.0.partial_cmp(&other.0).unwrap_or(Ordering::Equal)
    }

    #[inline]
    fn negated(self) -> Self {
        Self(0.0 - self.0)
    }

    #[inline]
    fn absolute(self) -> Self {
        Self(self.0.abs())
    }

    #[inline]
    fn plus(self, other: Self) -> Result<Self, Undefined> {
        Self::held(self.0 + other.0)
    }

    #[inline]
    fn minus(self, other: Self) -> Result<Self, Undefined> {
        Self::held(self.0 - other.0)
    }

    #[inline]
    fn times(self, other: Self) -> Result<Self, Undefined> {
        Self::held(self.0 * other.0)
    }

    #[inline]
    fn over(self, other: Self) -> Result<Self, Undefined> {
        if other.0 == 0.0 { Err(Undefined::DivisionByZero) } else { Self::held(self.0 / other.0) }
    }

    fn modulo(self, other: Self) -> Result<Self, Undefined> {
        // The remainder of the two doubles, without rounding.
        if other.0 == 0.0 { Err(Undefined::DivisionByZero) } else { Self::held(self.0 % other.0) }
    }

    fn bits(self, operation: Bits, other: Self) -> Result<Self, Undefined> {
        let whole = |number: Self| match number.as_whole() {
            Some(value) if value >= 0 => Ok(value),
            _ => Err(Undefined::NotBits(operation.name(), number.text())),
        };
        Ok(Self::whole(codes::bits(operation, whole(self)?, whole(other)?)))
    }

    fn rounded(self, rounding: Rounding, decimals: u8) -> Result<Self, Undefined> {
        let scaled = self.0 * ten_to(decimals);
        let whole = match rounding {
            Rounding::Nearest => scaled.round(),
            Rounding::Down => scaled.trunc(),
            Rounding::Up if scaled < 0.0 => scaled.floor(),
            Rounding::Up => scaled.ceil(),
        };
        // So large a number has no decimals to round.
        if scaled.abs() < TOO_LARGE { Self::held(whole / ten_to(decimals)) } else { Ok(self) }
    }

    fn function(self, function: Function) -> Result<Self, Undefined> {
        let value = self.0;
        let arc = |name, arc: fn(f64) -> f64| match value.abs() <= 1.0 {
            true => Ok(arc(value) * DEGREES),
            false => Err(Undefined::ArcOf(name, self.text())),
        };
        Self::held(match function {
            Function::Sine => libm::sin(self.radians()),
            Function::Cosine => libm::cos(self.radians()),
            Function::Tangent if (value % 180.0).abs() == 90.0 => {
                return Err(Undefined::TangentOf(self.text()));
            }
            Function::Tangent => libm::tan(self.radians()),
            Function::ArcSine => arc("ASIN", libm::asin)?,
            Function::ArcCosine => arc("ACOS", libm::acos)?,
            Function::ArcTangent => libm::atan(value) * DEGREES,
            Function::Root if value >= 0.0 => value.sqrt(),
            Function::Root if value > NOUGHT_ABOVE => 0.0,
            Function::Root => return Err(Undefined::RootOfNegative(self.text())),
            Function::Logarithm if value > 0.0 => libm::log(value),
            Function::Logarithm => return Err(Undefined::LogarithmOf(self.text())),
            Function::Exponential => libm::exp(value),
            Function::FromBcd | Function::ToBcd => {
                return codes::code(function, self.as_whole(), || self.text()).map(Self::whole);
            }
        })
    }

    fn arc_tangent(self, other: Self) -> Result<Self, Undefined> {
        if self.0 == 0.0 && other.0 == 0.0 {
            return Err(Undefined::DivisionByZero);
        }
        let angle = libm::atan2(self.0, other.0) * DEGREES;
        let angle = if angle < 0.0 { angle + 360.0 } else { angle };
        // A hair less than a whole turn is rounded to one, which is none.
        Self::held(if angle < 360.0 { angle } else { 0.0 })
    }

    fn power(self, exponent: Self) -> Result<Self, Undefined> {
        let has_value = match self.0 {
            0.0 => exponent.0 >= 0.0,
            base => base > 0.0 || exponent.0.trunc() == exponent.0,
        };
        if has_value {
            Self::held(libm::pow(self.0, exponent.0))
        } else {
            Err(Undefined::PowerOf(self.text(), exponent.text()))
        }
    }
}

/// A power of ten; exact up to 10^22, and beyond 10^308 none.
fn ten_to(decimals: u8) -> f64 {
    let mut power = 1.0;
    for _ in 0..decimals {
        power *= 10.0;
    }
    power
}

#[cfg(test)]
mod tests;
