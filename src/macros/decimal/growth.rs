//! EXP, LN and POW, and how what `libm` finds becomes a decimal.

use super::powers::Power;
use super::{Decimal, FUNCTION_DECIMALS, POWERS, SCALE_MAX, SIGNIFICANT};
use crate::macros::number::{Number as _, Undefined};

/// The nearest number with at most [`SIGNIFICANT`] digits and [`FUNCTION_DECIMALS`] decimals.
pub(super) fn nearest(value: f64) -> Result<Decimal, Undefined> {
    let size = value.abs();
    if size.partial_cmp(&TOO_LARGE) != Some(std::cmp::Ordering::Less) {
        return Err(Undefined::TooLarge); // An infinity too.
    }
    let limit = POWERS[usize::from(SIGNIFICANT)] as f64;
    let mut decimals = usize::from(FUNCTION_DECIMALS);
    while decimals > 0 && size * POWERS[decimals] as f64 >= limit {
        decimals -= 1;
    }
    let mut noughts = 0;
    while decimals == 0 && size / POWERS[noughts] as f64 >= limit {
        noughts += 1;
    }
    // At most 10^15, where halves are still told apart.
    let digits = size * POWERS[decimals] as f64 / POWERS[noughts] as f64 + 0.5;
    let size = (digits as i64).unsigned_abs() * POWERS[noughts].unsigned_abs();
    if size > i64::MAX.unsigned_abs() {
        return Err(Undefined::TooLarge);
    }
    Ok(Decimal { mantissa: super::signed(size, value < 0.0), scale: decimals as u8 }.stripped())
}

/// 2^63: no mantissa is as large.
const TOO_LARGE: f64 = 9_223_372_036_854_775_808.0;
/// EXP of more than this is beyond every mantissa, and of less than its negative, rounded, is nought.
const GROWTH_MAX: f64 = 45.0;

/// LN
pub(super) fn logarithm(of: Decimal) -> Result<Decimal, Undefined> {
    if of.mantissa <= 0 {
        return Err(Undefined::LogarithmOf(of.text()));
    }
    nearest(natural(of))
}

/// The logarithm of a number above nought. Near 1 it is told from the difference to 1, which is exact.
fn natural(of: Decimal) -> f64 {
    match of.minus(Decimal::whole(1)).map(Decimal::approximate) {
        Ok(difference) if difference.abs() < 0.25 => libm::log1p(difference),
        _ => libm::log(of.approximate()),
    }
}

/// EXP
pub(super) fn exponential(of: Decimal) -> Result<Decimal, Undefined> {
    let exponent = of.approximate();
    if exponent.abs() > GROWTH_MAX {
        return if exponent > 0.0 { Err(Undefined::TooLarge) } else { Ok(Decimal::ZERO) };
    }
    // The whole part is exact in binary; so the error of the rest is that of a number below 1.
    let (whole, rest) = apart(of)?;
    nearest(libm::exp(whole as f64) * libm::exp(rest.approximate()))
}

/// POW: exact for whole exponents while the digits hold, otherwise rounded as functions are.
pub(super) fn power(base: Decimal, exponent: Decimal) -> Result<Decimal, Undefined> {
    let undefined = || Err(Undefined::PowerOf(base.text(), exponent.text()));
    let whole = exponent.as_whole();
    match base.mantissa {
        _ if exponent.mantissa == 0 => return Ok(Decimal::whole(1)),
        0 if exponent.mantissa < 0 => return undefined(),
        0 => return Ok(Decimal::ZERO),
        mantissa if mantissa < 0 && whole.is_none() => return undefined(),
        _ => {}
    }
    if let Some(whole) = whole
        && let Some(power) = exact(base, whole.unsigned_abs())
    {
        return if whole > 0 { Ok(power) } else { Decimal::whole(1).over(power) };
    }
    let size = base.absolute();
    let growth = natural(size) * exponent.approximate();
    if growth.abs() > GROWTH_MAX {
        return if growth > 0.0 { Err(Undefined::TooLarge) } else { Ok(Decimal::ZERO) };
    }
    let (whole, rest) = apart(exponent)?;
    let value = Power::of(size.mantissa.unsigned_abs(), POWERS[usize::from(size.scale)].unsigned_abs())
        .raised(whole.unsigned_abs())
        .approximate();
    let value = if whole < 0 { 1.0 / value } else { value };
    let value = value * libm::pow(size.approximate(), rest.approximate());
    nearest(if base.mantissa < 0 && whole % 2 != 0 { -value } else { value })
}

/// A power that fits without rounding. In its fewest digits a mantissa with decimals is no multiple of ten, so no power of
/// it is one: all its decimals are needed.
fn exact(base: Decimal, exponent: u64) -> Option<Decimal> {
    let base = base.stripped();
    let exponent = u32::try_from(exponent).ok()?;
    let scale = u32::from(base.scale).checked_mul(exponent).filter(|scale| *scale <= u32::from(SCALE_MAX))?;
    let mantissa = base.mantissa.checked_pow(exponent).filter(|mantissa| *mantissa != i64::MIN)?;
    Some(Decimal { mantissa, scale: scale as u8 })
}

/// The nearest whole number and what is left, exactly.
fn apart(number: Decimal) -> Result<(i64, Decimal), Undefined> {
    let whole = number.at_decimals(0).ok_or(Undefined::TooLarge)?;
    Ok((whole, number.minus(Decimal::whole(whole))?))
}
