//! Sums to remainders, comparisons, rounding and printing: each equal to the exact result, rounded once where it must be.

use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::{Number as _, Rounding, Undefined};
use num::{BigInt, BigRational, Signed as _, ToPrimitive as _, Zero as _};

use super::exact::{Random, fraction, held, nearest, ten_to, value};

/// Pairs of numbers; each goes through ten operations.
const PAIRS: u64 = 20_000;

#[test]
fn two_hundred_thousand_operations_give_the_exact_result_rounded_once() {
    let mut random = Random::new(1);
    let (mut exact_count, mut rounded_count, mut refused_count) = (0, 0, 0);
    for _ in 0..PAIRS {
        let (one, two) = (random.decimal(), random.decimal());
        let (a, b) = (value(one), value(two));
        let mut check = |operation: &str, result: Result<Decimal, Undefined>, exact: Option<BigRational>| {
            let held = exact.as_ref().and_then(held);
            match (&result, &held) {
                _ if held == exact => exact_count += 1,
                (Err(_), _) => refused_count += 1,
                _ => rounded_count += 1,
            }
            assert_eq!(result.ok().map(value), held, "{one} {operation} {two}");
        };
        let divided = (!b.is_zero()).then(|| &a / &b);
        check("+", one.plus(two), Some(&a + &b));
        check("-", one.minus(two), Some(&a - &b));
        check("*", one.times(two), Some(&a * &b));
        check("/", one.over(two), divided.clone());
        check("MOD", one.modulo(two), divided.map(|quotient| &a - quotient.trunc() * &b));
        let places = random.below(6) as u32;
        for (rounding, name) in [(Rounding::Nearest, "ROUND"), (Rounding::Down, "FIX"), (Rounding::Up, "FUP")]
        {
            let exact = fraction(whole(&(&a * ten_to(places)), rounding), places);
            check(name, one.rounded(rounding, places as u8), Some(exact));
        }
        assert_eq!(one.compare(two), a.cmp(&b), "{one} and {two}");
        assert_eq!(one == two, a == b, "{one} and {two}");
        let printed = nearest(&(&a * ten_to(places)), |_| true);
        assert_eq!(
            one.at_decimals(places as u8),
            printed.to_i64().filter(|n| *n > i64::MIN),
            "{one} at {places}"
        );
        assert_eq!(one.as_whole(), a.is_integer().then(|| a.to_i64().unwrap()), "{one}");
        assert_eq!((value(one.negated()), value(one.absolute())), (-&a, a.abs()));
    }
    // Each way of ending is met often.
    assert!(
        exact_count > 80_000 && rounded_count > 10_000 && refused_count > 500,
        "{exact_count} {rounded_count} {refused_count}"
    );
}

/// Sums that fall a hair short of a half, on it, or beyond it, at the last place that is held.
#[test]
fn halves_at_the_last_place_are_even_and_their_neighbours_are_not() {
    let mut random = Random::new(2);
    for _ in 0..20_000 {
        let decimals = 1 + random.below(18) as u8;
        // 19 digits, of which the one behind the point does not fit when it is added.
        let large = 1_000_000_000_000_000_000 + random.below(8_000_000_000_000_000_000) as i64;
        let large = Decimal::written(large, decimals - 1);
        let small = Decimal::written(4 + random.below(3) as i64, decimals);
        for (sum, exact) in [
            (large.plus(small), value(large) + value(small)),
            (large.negated().minus(small), -value(large) - value(small)),
        ] {
            assert_eq!(sum.ok().map(value), held(&exact), "{large} and {small}");
        }
    }
}

#[test]
fn a_product_by_a_quotient_comes_back_where_the_quotient_has_an_end() {
    let mut random = Random::new(3);
    for _ in 0..20_000 {
        let size = Decimal::written(random.below(1_000_000) as i64 + 1, random.below(4) as u8);
        let divisor =
            Decimal::whole([1, 2, 4, 5, 8, 10, 16, 20, 25, 50, 100, 125, 625][random.below(13) as usize]);
        let quotient = size.over(divisor).unwrap();
        assert_eq!(quotient.times(divisor), Ok(size), "{size} / {divisor}");
    }
}

fn whole(value: &BigRational, rounding: Rounding) -> BigInt {
    match rounding {
        Rounding::Nearest => nearest(value, |_| true),
        Rounding::Down => value.trunc().to_integer(),
        Rounding::Up if value.is_negative() => value.floor().to_integer(),
        Rounding::Up => value.ceil().to_integer(),
    }
}
