//! Decimal numbers: what a macro counts with, so that 25 less 250 times 0.02 is 20.
//!
//! A number is a whole mantissa and how many of its digits stand behind the point, as the programmer wrote it. Sums,
//! differences and products are exact for as long as they fit; what does not is rounded once, from the exact result, halves
//! to even, to the most decimals that do fit. So 18 digits always hold and 19 hold often; a whole part beyond ±(2^63 - 1)
//! is refused. Equal values compare equal however many noughts they carry.
//!
//! Functions go through `libm`, the same on every platform, and are rounded to [`SIGNIFICANT`] digits and no more than
//! [`FUNCTION_DECIMALS`] decimals: an error of a few units in the sixteenth digit disappears, and `COS[60]` is 0.5. SQRT is
//! rounded correctly (`root.rs`).
//!
//! There is no infinity, no negative nought, and null is not a number: it is the language's.

mod angles;
mod growth;
mod powers;
mod root;
mod wide;

use std::cmp::Ordering;
use std::fmt;

use super::number::codes;
use super::number::{Bits, Function, Number, Rounding, Undefined};
use crate::formats::gcode::numbers::POWERS;

/// A decimal number: `mantissa / 10^scale`.
///
/// Not always in its fewest digits, as that takes time: 2.50 is 250 with two decimals until it is printed or asked for.
#[derive(Clone, Copy, Debug)]
pub struct Decimal {
    /// Never `i64::MIN`, so that every number has its negative.
    mantissa: i64,
    /// At most [`SCALE_MAX`].
    scale: u8,
}

/// The most digits behind the point.
pub const SCALE_MAX: u8 = 18;
/// The digits that a function's result is rounded to: those which `libm`'s 53 bits hold.
pub const SIGNIFICANT: u8 = 15;
/// The most decimals of a function's result; SQRT's too.
pub const FUNCTION_DECIMALS: u8 = 15;

impl Decimal {
    /// A number of a mantissa that is at most the largest; `i64::MIN` differs from it in the nineteenth digit only.
    const fn of(mantissa: i64, scale: u8) -> Self {
        let mantissa = if mantissa == i64::MIN { -i64::MAX } else { mantissa };
        Self { mantissa, scale }
    }

    /// The same number in its fewest digits.
    fn stripped(self) -> Self {
        let (mut size, mut scale) = (self.mantissa.unsigned_abs(), usize::from(self.scale));
        if size == 0 {
            return Self::ZERO;
        }
        if size % 2 == 1 {
            return self; // No multiple of ten.
        }
        for step in [16, 8, 4, 2, 1] {
            if scale >= step {
                let quotient = wide::tenth(size, step);
                if quotient * POWERS[step].unsigned_abs() == size {
                    (size, scale) = (quotient, scale - step);
                }
            }
        }
        Self { mantissa: signed(size, self.mantissa < 0), scale: scale as u8 }
    }

    /// The mantissas of both at the larger of their scales, where they fit.
    #[inline]
    fn aligned(self, other: Self) -> Option<(i64, i64, u8)> {
        if self.scale <= other.scale {
            let up = POWERS[usize::from(other.scale - self.scale)];
            Some((self.mantissa.checked_mul(up)?, other.mantissa, other.scale))
        } else {
            let up = POWERS[usize::from(self.scale - other.scale)];
            Some((self.mantissa, other.mantissa.checked_mul(up)?, self.scale))
        }
    }

    /// The same in 128 bits, which hold any.
    fn aligned_wide(self, other: Self) -> (i128, i128, u8) {
        let scale = self.scale.max(other.scale);
        let at = |number: Self| {
            i128::from(number.mantissa) * i128::from(POWERS[usize::from(scale - number.scale)])
        };
        (at(self), at(other), scale)
    }

    #[inline(never)]
    fn plus_wide(self, other: Self) -> Result<Self, Undefined> {
        let (one, other, scale) = self.aligned_wide(other);
        wide::fitted(one + other, scale)
    }

    #[inline(never)]
    fn times_wide(self, other: Self) -> Result<Self, Undefined> {
        wide::fitted(i128::from(self.mantissa) * i128::from(other.mantissa), self.scale + other.scale)
    }

    #[inline(never)]
    fn compare_apart(self, other: Self) -> Ordering {
        match self.aligned(other) {
            Some((one, other, _)) => one.cmp(&other),
            // The one of fewer decimals is too large to be written with more, so it is larger in size than the other.
            None if self.scale < other.scale => self.mantissa.cmp(&0),
            None => 0.cmp(&other.mantissa),
        }
    }
}

impl Number for Decimal {
    const NAME: &'static str = "decimal";
    const ZERO: Self = Self { mantissa: 0, scale: 0 };

    #[inline]
    fn whole(value: i64) -> Self {
        Self::of(value, 0)
    }

    #[inline]
    fn written(digits: i64, decimals: u8) -> Self {
        assert!(
            decimals <= SCALE_MAX,
            "a number is written with at most {SCALE_MAX} decimals, not {decimals}"
        );
        Self::of(digits, decimals)
    }

    #[inline]
    fn as_whole(self) -> Option<i64> {
        let scale = usize::from(self.scale);
        if scale == 0 {
            return Some(self.mantissa);
        }
        let size = self.mantissa.unsigned_abs();
        let whole = wide::tenth(size, scale);
        (whole * POWERS[scale].unsigned_abs() == size).then(|| signed(whole, self.mantissa < 0))
    }

    #[inline]
    fn at_decimals(self, decimals: u8) -> Option<i64> {
        if self.scale <= decimals {
            return match POWERS.get(usize::from(decimals - self.scale)) {
                Some(up) => self.mantissa.checked_mul(*up),
                None => (self.mantissa == 0).then_some(0),
            };
        }
        let size = wide::nearest_tenth(self.mantissa.unsigned_abs(), usize::from(self.scale - decimals));
        Some(signed(size, self.mantissa < 0))
    }

    fn text(self) -> String {
        self.to_string()
    }

    fn approximate(self) -> f64 {
        // Beyond 2^53 the mantissa would be rounded, and a number written with a nought more rounded differently.
        let number = if self.mantissa.unsigned_abs() >> 53 == 0 { self } else { self.stripped() };
        number.mantissa as f64 / POWERS[usize::from(number.scale)] as f64
    }

    #[inline]
    fn compare(self, other: Self) -> Ordering {
        if self.scale == other.scale { self.mantissa.cmp(&other.mantissa) } else { self.compare_apart(other) }
    }

    #[inline]
    fn negated(self) -> Self {
        Self { mantissa: -self.mantissa, scale: self.scale }
    }

    #[inline]
    fn absolute(self) -> Self {
        Self { mantissa: self.mantissa.abs(), scale: self.scale }
    }

    #[inline]
    fn plus(self, other: Self) -> Result<Self, Undefined> {
        if let Some((one, two, scale)) = self.aligned(other)
            && let Some(mantissa) = one.checked_add(two)
            && mantissa != i64::MIN
        {
            return Ok(Self { mantissa, scale });
        }
        self.plus_wide(other)
    }

    #[inline]
    fn minus(self, other: Self) -> Result<Self, Undefined> {
        self.plus(other.negated())
    }

    #[inline]
    fn times(self, other: Self) -> Result<Self, Undefined> {
        let scale = self.scale + other.scale;
        if scale <= SCALE_MAX
            && let Some(mantissa) = self.mantissa.checked_mul(other.mantissa)
            && mantissa != i64::MIN
        {
            return Ok(Self { mantissa, scale });
        }
        self.times_wide(other)
    }

    fn over(self, other: Self) -> Result<Self, Undefined> {
        if other.mantissa == 0 {
            return Err(Undefined::DivisionByZero);
        }
        // A nought has no leading digit to begin a long division with.
        if self.mantissa == 0 || (self.scale >= other.scale && self.mantissa % other.mantissa == 0) {
            let scale = self.scale.saturating_sub(other.scale);
            return Ok(Self { mantissa: self.mantissa / other.mantissa, scale });
        }
        wide::quotient(self, other)
    }

    fn modulo(self, other: Self) -> Result<Self, Undefined> {
        if other.mantissa == 0 {
            return Err(Undefined::DivisionByZero);
        }
        if let Some((one, two, scale)) = self.aligned(other) {
            return Ok(Self { mantissa: one % two, scale });
        }
        let (one, two, scale) = self.aligned_wide(other);
        wide::fitted(one % two, scale)
    }

    fn bits(self, operation: Bits, other: Self) -> Result<Self, Undefined> {
        let whole = |number: Self| match number.as_whole() {
            Some(value) if value >= 0 => Ok(value),
            _ => Err(Undefined::NotBits(operation.name(), number.text())),
        };
        Ok(Self::whole(codes::bits(operation, whole(self)?, whole(other)?)))
    }

    fn rounded(self, rounding: Rounding, decimals: u8) -> Result<Self, Undefined> {
        if self.scale <= decimals {
            return Ok(self);
        }
        let (size, drop) = (self.mantissa.unsigned_abs(), usize::from(self.scale - decimals));
        let size = match rounding {
            Rounding::Nearest => wide::nearest_tenth(size, drop),
            Rounding::Down => wide::tenth(size, drop),
            Rounding::Up => {
                let down = wide::tenth(size, drop);
                down + u64::from(down * POWERS[drop].unsigned_abs() != size)
            }
        };
        Ok(Self { mantissa: signed(size, self.mantissa < 0), scale: decimals })
    }

    #[inline]
    fn function(self, function: Function) -> Result<Self, Undefined> {
        match function {
            Function::Root => root::root(self),
            Function::Sine => Ok(angles::sine(self)),
            Function::Cosine => Ok(angles::cosine(self)),
            Function::Tangent => angles::tangent(self),
            Function::ArcSine => angles::arc_sine(self),
            Function::ArcCosine => angles::arc_cosine(self),
            Function::ArcTangent => Ok(angles::arc_tangent(self)),
            Function::Logarithm => growth::logarithm(self),
            Function::Exponential => growth::exponential(self),
            Function::FromBcd | Function::ToBcd => {
                codes::code(function, self.as_whole(), || self.text()).map(Self::whole)
            }
        }
    }

    fn arc_tangent(self, other: Self) -> Result<Self, Undefined> {
        angles::direction(other, self)
    }

    fn power(self, exponent: Self) -> Result<Self, Undefined> {
        growth::power(self, exponent)
    }
}

impl Ord for Decimal {
    fn cmp(&self, other: &Self) -> Ordering {
        self.compare(*other)
    }
}

impl PartialOrd for Decimal {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Decimal {}

impl PartialEq for Decimal {
    fn eq(&self, other: &Self) -> bool {
        self.compare(*other).is_eq()
    }
}

/// In its fewest digits: `0.02`, `-3`.
impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.stripped();
        let (size, scale) = (number.mantissa.unsigned_abs(), usize::from(number.scale));
        let digits = match scale {
            0 => size.to_string(),
            _ => {
                let whole = wide::tenth(size, scale);
                format!("{whole}.{:0scale$}", size - whole * POWERS[scale].unsigned_abs())
            }
        };
        f.pad_integral(number.mantissa >= 0, "", &digits)
    }
}

/// A size with its sign; a size is at most that of the largest mantissa.
#[inline]
fn signed(size: u64, negative: bool) -> i64 {
    let size = size as i64;
    if negative { -size } else { size }
}

#[cfg(test)]
mod tests;
