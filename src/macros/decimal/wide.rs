//! What does not fit into 64 bits on the way, and divisions by powers of ten without dividing.
//!
//! A result is rounded here and nowhere else: once, from the exact one, halves to even, to the most decimals that fit.

use super::{Decimal, POWERS, SCALE_MAX};
use crate::macros::number::Undefined;

/// The largest mantissa.
const MANTISSA_MAX: u64 = i64::MAX.unsigned_abs();

/// The number `value / 10^scale`, with `scale` at most twice [`SCALE_MAX`], rounded to what fits.
pub(super) fn fitted(value: i128, scale: u8) -> Result<Decimal, Undefined> {
    let size = value.unsigned_abs();
    let negative = value < 0;
    let mut drop = scale.saturating_sub(SCALE_MAX);
    if size > u128::from(MANTISSA_MAX) {
        // Between 2^(length - 1) and 2^length: at least so many digits are too many. 1233/4096 is a little less than lg 2.
        let length = 128 - size.leading_zeros();
        drop = drop.max((((length - 64) * 1233) >> 12) as u8);
        // Up to half a unit more is rounded down again.
        while size > u128::from(MANTISSA_MAX) * u128::from(power(drop)) + u128::from(power(drop) / 2) {
            drop += 1;
        }
    }
    loop {
        if drop > scale {
            return Err(Undefined::TooLarge);
        }
        let (quotient, rest) = if drop == 0 { (size as u64, 0) } else { tenth_wide(size, usize::from(drop)) };
        match rounded(quotient, rest, power(drop)) {
            Some(size) => return Ok(made(size, negative, scale - drop, rest == 0)),
            None => drop += 1, // Rounded up beyond the largest mantissa.
        }
    }
}

/// `one / other`, neither of which is nought, rounded to what fits.
pub(super) fn quotient(one: Decimal, other: Decimal) -> Result<Decimal, Undefined> {
    let negative = (one.mantissa < 0) != (other.mantissa < 0);
    let (dividend, divisor) = (one.mantissa.unsigned_abs(), other.mantissa.unsigned_abs());
    // The dividend takes as many noughts as the quotient has room for; never more than 18 decimals come of it.
    let noughts_max = u32::from(SCALE_MAX + other.scale - one.scale);
    let length = |size: u64| 64 - size.leading_zeros();
    // So many fit surely: dividend < 2^length, divisor >= 2^(length - 1), quotient < 2^63.
    let mut noughts = noughts_max.min(((62 + length(divisor) - length(dividend)) * 1233) >> 12);
    // Up to half a unit more is rounded down again.
    let room = u128::from(MANTISSA_MAX) * u128::from(divisor) + u128::from(divisor / 2);
    while noughts < noughts_max && raised(dividend, noughts + 1).is_some_and(|raised| raised <= room) {
        noughts += 1;
    }
    loop {
        let Some(scale) = (noughts + u32::from(one.scale)).checked_sub(u32::from(other.scale)) else {
            return Err(Undefined::TooLarge);
        };
        let raised = raised(dividend, noughts).ok_or(Undefined::TooLarge)?;
        // The quotient is at most half a unit above the largest mantissa.
        let quotient = (raised / u128::from(divisor)) as u64;
        let rest = (raised - u128::from(quotient) * u128::from(divisor)) as u64;
        match rounded(quotient, rest, divisor) {
            Some(size) => return Ok(made(size, negative, scale as u8, rest == 0)),
            None => noughts = noughts.checked_sub(1).ok_or(Undefined::TooLarge)?,
        }
    }
}

/// A quotient rounded to even by its rest; none beyond the largest mantissa.
fn rounded(quotient: u64, rest: u64, divisor: u64) -> Option<u64> {
    let up = match rest.cmp(&(divisor - rest)) {
        std::cmp::Ordering::Less => false,
        std::cmp::Ordering::Equal => quotient % 2 == 1,
        std::cmp::Ordering::Greater => true,
    };
    Some(quotient + u64::from(up)).filter(|size| *size <= MANTISSA_MAX)
}

/// An exact result is kept in its fewest digits, so that what is counted on with it fits and is quick.
fn made(size: u64, negative: bool, scale: u8, is_exact: bool) -> Decimal {
    let number = Decimal { mantissa: super::signed(size, negative), scale };
    if is_exact { number.stripped() } else { number }
}

/// `10^digits`, for 0 to 19.
const fn power(digits: u8) -> u64 {
    if digits < 19 { POWERS[digits as usize].unsigned_abs() } else { 10_000_000_000_000_000_000 }
}

/// `size × 10^digits`, where 128 bits hold it.
fn raised(size: u64, digits: u32) -> Option<u128> {
    10u128.checked_pow(digits)?.checked_mul(u128::from(size))
}

/// `size / 10^digits` towards zero, for a size below 2^63 and 1 to 18 digits.
#[inline]
pub(super) fn tenth(size: u64, digits: usize) -> u64 {
    let Reciprocal { factor, shift } = RECIPROCALS[digits];
    let high = (u128::from(size) * u128::from(factor)) >> 64;
    (high as u64) >> shift
}

/// `size / 10^digits` to the nearest, halves up, under the same terms.
#[inline]
pub(super) fn nearest_tenth(size: u64, digits: usize) -> u64 {
    let (down, power) = (tenth(size, digits), POWERS[digits].unsigned_abs());
    down + u64::from(size - down * power >= power / 2)
}

/// A factor that divides: `size × factor / 2^(64 + shift)` is `size / 10^n`, rounded towards zero, for sizes below 2^63.
///
/// With `l` the least for which 2^l ≥ 10^n, the factor is 2^(63 + l) / 10^n rounded up, too much by less than one in
/// 2^63: too little to reach the next whole number. (Granlund and Montgomery, 1994, theorem 4.2.)
#[derive(Clone, Copy)]
struct Reciprocal {
    factor: u64,
    shift: u32,
}

/// By the number of digits; that of no digits is not used.
const RECIPROCALS: [Reciprocal; 19] = {
    let mut reciprocals = [Reciprocal { factor: 0, shift: 0 }; 19];
    let mut n = 1;
    while n < reciprocals.len() {
        let power = POWERS[n].unsigned_abs() as u128;
        let length = 128 - (power - 1).leading_zeros();
        let factor = (1u128 << (63 + length)).div_ceil(power);
        assert!(factor >> 64 == 0);
        reciprocals[n] = Reciprocal { factor: factor as u64, shift: length - 1 };
        n += 1;
    }
    reciprocals
};

/// `size / 10^digits` towards zero, and what is left, for 1 to 19 digits; the quotient is below 2^64.
///
/// Two multiplications in place of a division by 128 bits (Möller and Granlund, "Improved division by invariant
/// integers", 2011, algorithm 4).
fn tenth_wide(size: u128, digits: usize) -> (u64, u64) {
    let Inverse { divisor, inverse, shift } = INVERSES[digits];
    let size = size << shift;
    let (high, low) = ((size >> 64) as u64, size as u64);
    let product = (u128::from(inverse) * u128::from(high)).wrapping_add(size);
    let mut quotient = ((product >> 64) as u64).wrapping_add(1);
    let mut rest = low.wrapping_sub(quotient.wrapping_mul(divisor));
    if rest > product as u64 {
        quotient = quotient.wrapping_sub(1);
        rest = rest.wrapping_add(divisor);
    }
    if rest >= divisor {
        quotient += 1;
        rest -= divisor;
    }
    (quotient, rest >> shift)
}

/// A power of ten shifted up to its highest bit, and ⌊(2^128 - 1) / it⌋ less 2^64.
#[derive(Clone, Copy)]
struct Inverse {
    divisor: u64,
    inverse: u64,
    shift: u32,
}

/// By the number of digits; that of no digits is not used.
const INVERSES: [Inverse; 20] = {
    let mut inverses = [Inverse { divisor: 0, inverse: 0, shift: 0 }; 20];
    let mut n = 1;
    while n < inverses.len() {
        let shift = power(n as u8).leading_zeros();
        let divisor = power(n as u8) << shift;
        let inverse = u128::MAX / divisor as u128 - (1 << 64);
        inverses[n] = Inverse { divisor, inverse: inverse as u64, shift };
        n += 1;
    }
    inverses
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dividing_by_a_reciprocal_is_dividing() {
        let mut size = 0x9E37_79B9_7F4A_7C15_u64;
        for (n, power) in POWERS.into_iter().enumerate().skip(1) {
            let power = power.unsigned_abs();
            let steps = (0..40).flat_map(|k| [power * (MANTISSA_MAX / power) - k, power + k, k]);
            let edges = [MANTISSA_MAX, MANTISSA_MAX - 1, power - 1, 0];
            for size in steps.chain(edges) {
                assert_eq!(tenth(size, n), size / power, "{size} / 10^{n}");
            }
            for _ in 0..2000 {
                size = size.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let size = size >> (1 + size % 60);
                assert_eq!(tenth(size, n), size / power, "{size} / 10^{n}");
                assert_eq!(nearest_tenth(size, n), (size + power / 2) / power, "{size} / 10^{n}");
            }
        }
    }

    #[test]
    fn dividing_by_an_inverse_is_dividing() {
        let mut state = 0x9E37_79B9_7F4A_7C15_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 1 >> (state % 62)
        };
        for n in 1..20 {
            let power = u128::from(power(n));
            let edges =
                [0, 1, power - 1, power, power + 1, power << 63, (power << 63) - 1, (power << 64) - 1];
            let sizes = (0..5000).flat_map(|_| {
                let quotient = u128::from(random()) * power;
                [quotient, quotient + power - 1, quotient + u128::from(random()) % power]
            });
            for size in sizes.chain(edges) {
                let expected = ((size / power) as u64, (size % power) as u64);
                assert_eq!(tenth_wide(size, usize::from(n)), expected, "{size} / 10^{n}");
            }
        }
    }
}
