//! Fractions of whole numbers of any size, the rule of rounding written out on them, and random decimals.

use std::cmp::Ordering;

use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::Number as _;
use num::{BigInt, BigRational, Integer as _, Signed as _};

/// `10^n`.
pub(crate) fn ten_to(n: u32) -> BigInt {
    BigInt::from(10).pow(n)
}

/// `digits / 10^decimals`.
pub(crate) fn fraction(digits: impl Into<BigInt>, decimals: u32) -> BigRational {
    BigRational::new(digits.into(), ten_to(decimals))
}

/// A number as it is spelled.
pub(crate) fn read(text: &str) -> BigRational {
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let digits: BigInt = text.replace('.', "").parse().unwrap_or_else(|_| panic!("{text:?} is no number"));
    fraction(digits, decimals as u32)
}

/// What a decimal is, by its spelling.
pub(crate) fn value(decimal: Decimal) -> BigRational {
    read(&decimal.text())
}

/// The nearest whole number, ties as told: given the whole number towards zero, the one farther away.
pub(crate) fn nearest(value: &BigRational, tie: impl Fn(&BigInt) -> bool) -> BigInt {
    let down = value.trunc().to_integer();
    let away = &down + value.numer().signum();
    match (value - value.trunc()).abs().cmp(&BigRational::new(1.into(), 2.into())) {
        Ordering::Less => down,
        Ordering::Greater => away,
        Ordering::Equal if tie(&down) => away,
        Ordering::Equal => down,
    }
}

/// The number a decimal holds for an exact result: halves to even, with the most decimals, up to 18, at which the digits
/// fit into 63 bits. None where not even a whole number fits.
pub(crate) fn held(exact: &BigRational) -> Option<BigRational> {
    (0..=18).rev().find_map(|decimals| {
        let digits = nearest(&(exact * ten_to(decimals)), BigInt::is_odd);
        (digits.abs() <= BigInt::from(i64::MAX)).then(|| fraction(digits, decimals))
    })
}

/// Random numbers, the same in every run.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 up to a bound.
    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        // Splitmix64 (Vigna).
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % bound
    }

    /// Any digits, small ones as often as large ones, sometimes at an edge.
    pub(crate) fn digits(&mut self) -> i64 {
        let size = match self.below(16) {
            0 => 10i64.pow(self.below(19) as u32) - self.below(2) as i64,
            1 => i64::MAX - self.below(20) as i64,
            2 => 5 * 10i64.pow(self.below(18) as u32),
            3 => self.below(12) as i64,
            _ => (self.below(1 << 63) >> self.below(63)) as i64,
        };
        if self.below(2) == 0 { size } else { -size }
    }

    /// Any decimal: half of them as programs have them, half with any digits.
    pub(crate) fn decimal(&mut self) -> Decimal {
        if self.below(2) == 0 {
            let size = self.below(1_000_000) as i64;
            return Decimal::written(if self.below(2) == 0 { size } else { -size }, self.below(5) as u8);
        }
        Decimal::written(self.digits(), self.below(19) as u8)
    }
}

#[test]
fn the_rule_of_rounding_is_as_it_is_stated() {
    let rule = |numer: i64, denom: i64| held(&BigRational::new(numer.into(), denom.into())).unwrap();
    assert_eq!(rule(1, 3), read("0.333333333333333333"));
    assert_eq!(rule(100, 3), read("33.33333333333333333"));
    assert_eq!(held(&(read("4000000000000000001") + read("0.5"))), Some(read("4000000000000000002")));
    assert_eq!(held(&(read("4000000000000000000") + read("0.5"))), Some(read("4000000000000000000")));
    assert_eq!(held(&read("9223372036854775807.4")), Some(read("9223372036854775807")));
    assert_eq!(held(&read("9223372036854775807.5")), None);
}
