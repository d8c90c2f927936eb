//! SQRT, judged by squaring.

use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::{Function, Number as _};
use num::{BigRational, Signed as _, Zero as _};

use super::exact::{Random, fraction, value};

/// Fifteen decimals; a digit fewer for each two digits that the square has more than four.
fn decimals(square: &BigRational) -> u32 {
    let digits = square.trunc().to_integer().to_string().len() as u32;
    15 - digits.saturating_sub(4).div_ceil(2)
}

#[test]
fn a_root_is_the_nearest_number_of_its_decimals() {
    let mut random = Random::new(4);
    for _ in 0..100_000 {
        let of = random.decimal().absolute();
        let (square, root) = (value(of), value(of.function(Function::Root).unwrap()));
        let places = decimals(&square);
        let half = fraction(1, places) / fraction(2, 0);
        assert!(
            (&root * fraction(1, 0) / fraction(1, places)).is_integer(),
            "SQRT[{of}] = {root}: {places} decimals"
        );
        let above = &root + &half;
        assert!(&above * &above > square, "SQRT[{of}] = {root} is too little");
        let below = &root - &half;
        assert!(below.is_negative() || &below * &below < square, "SQRT[{of}] = {root} is too much");
    }
}

#[test]
fn a_root_with_an_end_is_exact() {
    let mut random = Random::new(5);
    for _ in 0..100_000 {
        let root = Decimal::written(
            (random.below(3_000_000_000) >> random.below(31)) as i64,
            random.below(10) as u8,
        );
        let square = root.times(root).unwrap();
        assert_eq!(square.function(Function::Root), Ok(root), "SQRT[{square}]");
        // Written with noughts behind, it is the same.
        if let Ok(again) = square.times(Decimal::written(100, 2)) {
            assert_eq!(again.function(Function::Root), Ok(root), "SQRT[{square}]");
        }
    }
}

#[test]
fn a_square_next_to_a_half_decides_the_last_digit_rightly() {
    // (n + 1/2)² = n² + n + 1/4 units: the whole numbers on either side of it, for roots of 9 digits and 15 decimals.
    let mut random = Random::new(6);
    for _ in 0..20_000 {
        let n = random.below(3_000_000_000) as i64;
        for square in [n * n + n, n * n + n + 1] {
            let of = Decimal::whole(square);
            let (root, exact) = (value(of.function(Function::Root).unwrap()), value(of));
            let half = fraction(1, decimals(&exact)) / fraction(2, 0);
            assert!((&root + &half).pow(2) > exact, "SQRT[{of}]");
            assert!(exact.is_zero() || (&root - &half).pow(2) < exact, "SQRT[{of}]");
        }
    }
}
