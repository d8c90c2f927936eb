//! SQRT, rounded correctly to 15 decimals, or to 17 digits where there are fewer.
//!
//! The root of a whole number of up to 34 digits is found: binary floating point guesses it to about 28 units, one step of
//! Newton's method mends the guess, and whole numbers decide the last unit. The root of a number with at most 18 decimals
//! has at most 10 digits if it has an end, so every root that has one is exact.

use super::{Decimal, FUNCTION_DECIMALS, POWERS, SCALE_MAX};
use crate::macros::number::{Number as _, Undefined};

/// The square root.
///
/// # Errors
///
/// Of -0.000000001 and less. What is nearer to nought comes of rounding: squares of lengths up to 3 m differ by as much
/// in a control's 53 bits. Its root would be less than 0.032 µm, under half of the finest least increment, 0.1 µm.
#[inline]
pub(super) fn root(of: Decimal) -> Result<Decimal, Undefined> {
    if of.mantissa > 0 {
        return Ok(positive(of.mantissa.unsigned_abs(), of.scale));
    }
    if of > NOUGHT_ABOVE { Ok(Decimal::ZERO) } else { Err(Undefined::RootOfNegative(of.text())) }
}

/// What a negative number has to exceed to count as nought.
const NOUGHT_ABOVE: Decimal = Decimal { mantissa: -1, scale: 9 };

fn positive(size: u64, scale: u8) -> Decimal {
    // 15 decimals, fewer by one for every two digits above 10 000: the root stays below 10^17.
    let mut decimals = FUNCTION_DECIMALS;
    let mut limit = scale + 4;
    while limit <= SCALE_MAX && size >= POWERS[usize::from(limit)].unsigned_abs() {
        limit += 2;
        decimals -= 1;
    }
    let raise = usize::from(2 * decimals - scale);
    let square = u128::from(size) * RAISES[raise];
    // 28 units of 10^17 at most: half a unit of the 53rd bit for each of mantissa, power, product and root.
    let guess = (size as f64 * RAISES_APPROXIMATE[raise]).sqrt() as i64;
    // 2 · 28 · 10^17 at most, so that its 64 low bits are all of it.
    let rest = square.wrapping_sub(u128::from(guess.unsigned_abs()).pow(2)) as i64;
    let step = (rest as f64 / (2.0 * guess as f64)).round_ties_even() as i64;
    let (mut root, rest) = (guess + step, rest - step * (2 * guess + step));
    // A root r is the nearest where r² - r < square <= r² + r.
    if rest > root {
        root += 1;
    } else if rest <= -root {
        root -= 1;
    }
    let number = Decimal { mantissa: root, scale: decimals };
    if rest == 0 { number.stripped() } else { number }
}

/// Powers of ten as far as a mantissa is raised.
const RAISES: [u128; 31] = {
    let mut powers = [1u128; 31];
    let mut n = 1;
    while n < powers.len() {
        powers[n] = powers[n - 1] * 10;
        n += 1;
    }
    powers
};

/// The same, rounded.
const RAISES_APPROXIMATE: [f64; 31] = {
    let mut powers = [0.0; 31];
    let mut n = 0;
    while n < powers.len() {
        powers[n] = RAISES[n] as f64;
        n += 1;
    }
    powers
};
