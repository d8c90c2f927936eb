//! SIN, COS, TAN and their inverses, in degrees.
//!
//! An angle is brought into an eighth of a turn in decimals, without a remainder, and only what is left becomes radians: so
//! SIN[180] is 0, COS[90] is 0, SIN[x] and COS[90-x] are the same, and TAN[90] has no value. An inverse is found in an eighth
//! of a turn likewise, and what is added to it is exact.

use super::growth::nearest;
use super::{Decimal, POWERS, SCALE_MAX};
use crate::macros::number::{Number as _, Undefined};

/// An angle without its sign, as quarters of a turn and what is left of it.
struct Reduced {
    /// From 0 to 3.
    quarter: u64,
    /// Whether the rest is measured back from the end of the quarter.
    is_back: bool,
    /// From 0 to 45 degrees.
    rest: Decimal,
}

impl Reduced {
    fn of(angle: Decimal) -> Self {
        let size = angle.mantissa.unsigned_abs();
        // A number with 18 decimals is less than 10.
        let right = if angle.scale == SCALE_MAX {
            u64::MAX
        } else {
            90 * POWERS[usize::from(angle.scale)].unsigned_abs()
        };
        let (quarters, rest) = if size < right { (0, size) } else { (size / right, size % right) };
        // The quarters of a number of 18 digits are whole to the last, so the remainder by 4 is too.
        let back = right - rest;
        let is_back = back < rest;
        let rest = if is_back { back } else { rest };
        Self {
            quarter: quarters % 4,
            is_back,
            rest: Decimal { mantissa: super::signed(rest, false), scale: angle.scale },
        }
    }

    fn is(&self, degrees: i64) -> bool {
        self.rest.compare(Decimal::whole(degrees)).is_eq()
    }

    fn radians(&self) -> f64 {
        self.rest.approximate() * (std::f64::consts::PI / 180.0)
    }

    /// The sine of the rest, or its cosine.
    fn of_rest(&self, cosine: bool) -> Decimal {
        match cosine {
            false if self.is(30) => Decimal { mantissa: 5, scale: 1 },
            false => nearest_within(libm::sin(self.radians())),
            true => nearest_within(libm::cos(self.radians())),
        }
    }
}

/// SIN
pub(super) fn sine(angle: Decimal) -> Decimal {
    let reduced = Reduced::of(angle);
    let is_odd = reduced.quarter % 2 == 1;
    let value = reduced.of_rest(is_odd != reduced.is_back);
    if (reduced.quarter >= 2) != (angle.mantissa < 0) { value.negated() } else { value }
}

/// COS
pub(super) fn cosine(angle: Decimal) -> Decimal {
    let reduced = Reduced::of(angle);
    let is_odd = reduced.quarter % 2 == 1;
    let value = reduced.of_rest(is_odd == reduced.is_back);
    if matches!(reduced.quarter, 1 | 2) { value.negated() } else { value }
}

/// TAN
pub(super) fn tangent(angle: Decimal) -> Result<Decimal, Undefined> {
    let reduced = Reduced::of(angle);
    let is_odd = reduced.quarter % 2 == 1;
    let is_inverse = is_odd != reduced.is_back;
    let value = match is_inverse {
        _ if reduced.is(45) => Decimal::whole(1),
        true if reduced.is(0) => return Err(Undefined::TangentOf(angle.text())),
        true => nearest(1.0 / libm::tan(reduced.radians()))?,
        false => nearest_within(libm::tan(reduced.radians())),
    };
    Ok(if is_odd != (angle.mantissa < 0) { value.negated() } else { value })
}

/// ASIN, from -90 to 90.
pub(super) fn arc_sine(of: Decimal) -> Result<Decimal, Undefined> {
    let size = of.absolute();
    let angle = match arcs(size) {
        None => return Err(Undefined::ArcOf("ASIN", of.text())),
        Some(Arc::Sine(angle)) => angle,
        Some(Arc::Cosine(angle)) => less(90, angle),
    };
    Ok(if of.mantissa < 0 { angle.negated() } else { angle })
}

/// ACOS, from 0 to 180.
pub(super) fn arc_cosine(of: Decimal) -> Result<Decimal, Undefined> {
    let size = of.absolute();
    let angle = match arcs(size) {
        None => return Err(Undefined::ArcOf("ACOS", of.text())),
        Some(Arc::Sine(angle)) => less(90, angle),
        Some(Arc::Cosine(angle)) => angle,
    };
    Ok(if of.mantissa < 0 { less(180, angle) } else { angle })
}

/// ATAN of one argument, from -90 to 90.
pub(super) fn arc_tangent(of: Decimal) -> Decimal {
    let angle = first_quarter(Decimal::whole(1), of.absolute());
    if of.mantissa < 0 { angle.negated() } else { angle }
}

/// The angle of a direction, from 0 up to 360.
pub(super) fn direction(x: Decimal, y: Decimal) -> Result<Decimal, Undefined> {
    if x.mantissa == 0 && y.mantissa == 0 {
        return Err(Undefined::DivisionByZero);
    }
    let angle = first_quarter(x.absolute(), y.absolute());
    Ok(match (x.mantissa < 0, y.mantissa < 0) {
        (false, false) => angle,
        (true, false) => less(180, angle),
        (true, true) => less(180, angle.negated()),
        // Nearer to a whole turn than the digits go is a whole turn, which is none.
        (false, true) if angle.mantissa == 0 => Decimal::ZERO,
        (false, true) => less(360, angle),
    })
}

/// The angle of a direction in the first quarter.
fn first_quarter(x: Decimal, y: Decimal) -> Decimal {
    let steep = y > x;
    let (long, short) = if steep { (y, x) } else { (x, y) };
    let angle = in_degrees(libm::atan(short.approximate() / long.approximate()));
    if steep { less(90, angle) } else { angle }
}

/// An angle of at most 60 degrees that has a size for its sine or for its cosine.
enum Arc {
    Sine(Decimal),
    Cosine(Decimal),
}

/// Of a size, none beyond 1. Near 1 the sine says little, and what is missing to 1 says all: it is exact.
fn arcs(size: Decimal) -> Option<Arc> {
    let one = Decimal::whole(1);
    if size > one {
        return None;
    }
    if size <= (Decimal { mantissa: 5, scale: 1 }) {
        return Some(Arc::Sine(in_degrees(libm::asin(size.approximate()))));
    }
    let missing = one.minus(size).unwrap_or(Decimal::ZERO).approximate();
    Some(Arc::Cosine(in_degrees(2.0 * libm::asin((missing / 2.0).sqrt()))))
}

/// What an angle is short of a whole number of degrees; it has at most 15 decimals, so it fits.
fn less(degrees: i64, angle: Decimal) -> Decimal {
    Decimal::whole(degrees).minus(angle).unwrap_or(Decimal::ZERO)
}

fn in_degrees(radians: f64) -> Decimal {
    nearest_within(radians * (180.0 / std::f64::consts::PI))
}

/// A value no larger than a few turns, so that it surely fits.
fn nearest_within(value: f64) -> Decimal {
    nearest(value).unwrap_or(Decimal::ZERO)
}
