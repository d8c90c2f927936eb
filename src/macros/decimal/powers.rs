//! Whole powers in 128 bits of binary floating point.
//!
//! The error of a base is multiplied by the exponent: 1.000001 in an `f64` is off by 1e-16, and its millionth power by 1e-10.
//! With 128 bits, exponents up to 2^63 leave 60 bits right.

/// `mantissa × 2^exponent`, the mantissa's highest bit set.
#[derive(Clone, Copy)]
pub(super) struct Power {
    mantissa: u128,
    exponent: i64,
}

impl Power {
    /// `size / divisor`, neither of which is nought, with a divisor below 2^60.
    pub(super) fn of(size: u64, divisor: u64) -> Self {
        let (up, divisor) = (64 + size.leading_zeros(), u128::from(divisor));
        let size = u128::from(size) << up;
        let (quotient, rest) = (size / divisor, size % divisor);
        // The quotient has 68 bits at least; the rest of them come of a second division.
        let more = quotient.leading_zeros();
        let mantissa = (quotient << more) | ((rest << more) / divisor);
        Self { mantissa, exponent: -i64::from(up + more) }
    }

    /// To a power that is a number an `f64` can hold.
    pub(super) fn raised(self, mut exponent: u64) -> Self {
        let mut power = Self { mantissa: 1 << 127, exponent: -127 };
        let mut square = self;
        while exponent > 0 {
            if exponent % 2 == 1 {
                power = power.times(square);
            }
            exponent /= 2;
            if exponent > 0 {
                square = square.times(square);
            }
        }
        power
    }

    fn times(self, other: Self) -> Self {
        let high = upper_half(self.mantissa, other.mantissa);
        let more = high.leading_zeros(); // 0 or 1
        Self { mantissa: high << more, exponent: self.exponent + other.exponent + 128 - i64::from(more) }
    }

    pub(super) fn approximate(self) -> f64 {
        let exponent = self.exponent.clamp(-4096, 4096) as i32;
        libm::ldexp(self.mantissa as f64, exponent)
    }
}

/// The upper 128 bits of a product of 256.
fn upper_half(one: u128, other: u128) -> u128 {
    let halves = |whole: u128| (whole >> 64, whole & u128::from(u64::MAX));
    let ((a, b), (c, d)) = (halves(one), halves(other));
    let ((ad_high, ad_low), (bc_high, bc_low)) = (halves(a * d), halves(b * c));
    let carry = (ad_low + bc_low + ((b * d) >> 64)) >> 64;
    a * c + ad_high + bc_high + carry
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_half_of_a_product_is_what_long_multiplication_gives() {
        assert_eq!(upper_half(u128::MAX, u128::MAX), u128::MAX - 1);
        assert_eq!(upper_half(1 << 127, 3), 1);
        assert_eq!(upper_half(u128::MAX, 1 << 64), u128::from(u64::MAX));
        assert_eq!(upper_half(u128::from(u64::MAX), u128::from(u64::MAX)), 0);
    }

    #[test]
    fn a_millionth_power_is_right_to_the_last_bit() {
        // (1 + 1/n)^n for n = 10^6, from 60 digits of decimal arithmetic.
        let value = Power::of(1_000_001, 1_000_000).raised(1_000_000).approximate();
        assert!((value - 2.718_280_469_319_376_9).abs() < 5e-16, "{value:?}");
        assert_eq!(Power::of(3, 1).raised(5).approximate(), 243.0);
        assert_eq!(Power::of(5, 10).raised(70).approximate(), libm::ldexp(1.0, -70));
        assert_eq!(Power::of(7, 10).raised(0).approximate(), 1.0);
    }
}
