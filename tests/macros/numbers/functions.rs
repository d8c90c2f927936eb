//! The functions against series in whole numbers, on some thousands of arguments each.
//!
//! What is promised: 15 significant digits and no more than 15 decimals, wrong by at most one unit of the last of them.
//! An angle that is found in its eighth of a turn has the digits of that eighth.

use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::{Function, Number as _, Undefined};
use num::{BigRational, One as _, Signed as _, Zero as _};

use super::exact::{Random, fraction, held, ten_to, value};
use super::series;

/// Arguments a function.
const ARGUMENTS: u32 = 4000;

#[test]
fn sines_cosines_and_tangents_are_right_to_a_unit() {
    let mut random = Random::new(7);
    for _ in 0..ARGUMENTS {
        let angle = angle(&mut random);
        let exact = value(angle);
        let (sine, cosine) = (series::sine(&exact), series::cosine(&exact));
        assert_near("SIN", angle, angle.function(Function::Sine), &sine.value());
        assert_near("COS", angle, angle.function(Function::Cosine), &cosine.value());
        match angle.function(Function::Tangent) {
            Err(Undefined::TangentOf(_)) => {
                assert!(
                    (exact / fraction(90, 0)).is_integer() && cosine.value().abs() < fraction(1, 30),
                    "TAN[{angle}]"
                );
            }
            tangent => assert_near("TAN", angle, tangent, &sine.over(&cosine).value()),
        }
    }
}

#[test]
fn angles_of_sines_cosines_and_tangents_are_right_to_a_unit() {
    let mut random = Random::new(8);
    for _ in 0..ARGUMENTS {
        let of = within_one(&mut random);
        let sine = series::arc_sine(&value(of)).value();
        assert_angle_near("ASIN", of, of.function(Function::ArcSine), &sine);
        assert_angle_near("ACOS", of, of.function(Function::ArcCosine), &(fraction(90, 0) - sine));
        let of = random.decimal();
        let tangent = series::arc_tangent(&series::Fixed::of(&value(of))).value();
        assert_angle_near("ATAN", of, of.function(Function::ArcTangent), &tangent);
    }
}

#[test]
fn directions_are_right_to_a_unit_and_go_once_round() {
    let mut random = Random::new(9);
    for _ in 0..ARGUMENTS {
        let (x, y) = (random.decimal(), random.decimal());
        if value(x).is_zero() && value(y).is_zero() {
            continue;
        }
        let angle = y.arc_tangent(x);
        let exact = series::direction(&value(x), &value(y)).value();
        let found = value(angle.clone().unwrap());
        assert!(!found.is_negative() && found < fraction(360, 0), "ATAN[{y}]/[{x}] = {found}");
        // The last hair of a turn is none.
        let exact =
            if found.is_zero() && exact > fraction(359, 0) { exact - fraction(360, 0) } else { exact };
        assert_angle_near(&format!("ATAN[{y}]/"), x, angle, &exact);
    }
}

#[test]
fn exponentials_and_logarithms_are_right_to_a_unit() {
    let mut random = Random::new(10);
    for _ in 0..ARGUMENTS {
        let decimals = random.below(19) as u8;
        let of = Decimal::written(random.digits(), decimals);
        if value(of).abs() < fraction(46, 0) {
            let exact = series::exponential(&series::Fixed::of(&value(of))).value();
            assert_near("EXP", of, of.function(Function::Exponential), &exact);
        }
        let of = random.decimal().absolute();
        if value(of).is_zero() {
            assert_eq!(of.function(Function::Logarithm), Err(Undefined::LogarithmOf("0".into())));
        } else {
            assert_near("LN", of, of.function(Function::Logarithm), &series::logarithm(&value(of)).value());
        }
        // Next to 1, where a double knows little.
        let of = Decimal::written(ten_18() + random.digits() / 1000, 18);
        assert_near("LN", of, of.function(Function::Logarithm), &series::logarithm(&value(of)).value());
    }
}

#[test]
fn whole_powers_are_exact_where_they_fit_and_right_to_a_unit_elsewhere() {
    let mut random = Random::new(11);
    let mut exact_count = 0;
    for _ in 0..ARGUMENTS {
        let base = random.decimal();
        let exponent = (random.below(64) >> random.below(6)) as i32;
        let exponent = if random.below(4) == 0 { -exponent } else { exponent };
        if value(base).is_zero() {
            continue;
        }
        let power = base.power(Decimal::whole(exponent.into()));
        let exact = value(base).pow(exponent);
        // A power that fits is exact, and what 1 is divided by for a negative exponent.
        if is_held(&value(base).pow(exponent.abs())) {
            assert_eq!(power.ok().map(value), held(&exact), "POW[{base},{exponent}]");
            exact_count += 1;
        } else {
            assert_near(&format!("POW {exponent}"), base, power, &exact);
        }
    }
    assert!(exact_count > 500, "{exact_count}");
}

#[test]
fn other_powers_are_right_to_a_unit() {
    let mut random = Random::new(12);
    for _ in 0..ARGUMENTS {
        let base = Decimal::written(random.below(10_000_000) as i64 + 1, random.below(7) as u8);
        let exponent = Decimal::written(random.below(20_000) as i64 - 10_000, 3);
        let growth = series::logarithm(&value(base)).times(&series::Fixed::of(&value(exponent)));
        if growth.value() > fraction(46, 0) {
            assert_eq!(base.power(exponent), Err(Undefined::TooLarge), "POW[{base},{exponent}]");
        } else if growth.value() > fraction(-46, 0)
            && !(exponent.as_whole().is_some() && growth.value().is_positive())
        {
            let exact = series::exponential(&growth).value();
            assert_near(&format!("POW[{base}]"), exponent, base.power(exponent), &exact);
        }
    }
}

/// Compares with 15 digits and 15 decimals; a number too large to be held is refused.
fn assert_near(function: &str, of: Decimal, found: Result<Decimal, Undefined>, exact: &BigRational) {
    let largest = fraction(i64::MAX, 0);
    match found {
        Ok(found) => {
            let unit = unit(exact);
            let found = value(found);
            assert!(
                (&found / &unit).is_integer() || unit > fraction(1, 0),
                "{function}[{of}] = {found}: too many digits"
            );
            assert!((&found - exact).abs() <= unit, "{function}[{of}] = {found}, not {:.20}", to_f64(exact));
        }
        Err(Undefined::TooLarge) => {
            assert!(exact.abs() + unit(exact) > largest, "{function}[{of}] is refused")
        }
        Err(other) => panic!("{function}[{of}]: {other}"),
    }
}

/// Compares an angle with the digits of its distance from the nearest axis.
fn assert_angle_near(function: &str, of: Decimal, found: Result<Decimal, Undefined>, exact: &BigRational) {
    let right = fraction(90, 0);
    let axis = (exact / &right).round() * &right;
    let unit = unit(&(exact - axis));
    let found = value(found.unwrap());
    assert!((&found - exact).abs() <= unit, "{function}[{of}] = {}, not {}", to_f64(&found), to_f64(exact));
}

/// The last of 15 digits, or of 15 decimals.
fn unit(exact: &BigRational) -> BigRational {
    let mut unit = fraction(1, 15);
    while exact.abs() >= &unit * ten_to(15) {
        unit *= ten_to(1);
    }
    unit
}

fn is_held(exact: &BigRational) -> bool {
    held(exact).as_ref() == Some(exact)
}

/// An angle as programs have it, or any.
fn angle(random: &mut Random) -> Decimal {
    match random.below(3) {
        0 => Decimal::written(random.below(72_000) as i64 - 36_000, 2),
        1 => Decimal::whole(15 * (random.below(96) as i64 - 48)),
        _ => random.decimal(),
    }
}

/// A number from -1 to 1, often near an end.
fn within_one(random: &mut Random) -> Decimal {
    let size = random.below(ten_18().unsigned_abs() + 1) as i64;
    let size = match random.below(3) {
        0 => size / 1_000_000_000_000_000 * 1_000_000_000_000_000,
        1 => size,
        _ => ten_18() - (size >> random.below(60)),
    };
    Decimal::written(if random.below(2) == 0 { size } else { -size }, 18)
}

fn ten_18() -> i64 {
    1_000_000_000_000_000_000
}

fn to_f64(value: &BigRational) -> f64 {
    use num::ToPrimitive as _;
    value.to_f64().unwrap_or(f64::NAN)
}

#[test]
fn a_unit_is_the_last_of_fifteen_digits() {
    assert_eq!(unit(&BigRational::one()), fraction(1, 14));
    assert_eq!(unit(&fraction(999, 3)), fraction(1, 15));
    assert_eq!(unit(&fraction(1, 12)), fraction(1, 15));
    assert_eq!(unit(&ten_to(16).into()), ten_to(2).into());
}
