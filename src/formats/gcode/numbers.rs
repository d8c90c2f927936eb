//! Numbers as they are written, and what they come to in whole nanometres.
//!
//! A length in G-code is a decimal with or without a point. Both become integers of 1 nm at once, so that positions add up
//! without a remainder and equal points have equal bits: a micron is 1000, an inch 25 400 000. What lies below a
//! nanometre (a seventh decimal of a millimetre) is rounded, halves away from zero.

/// A number of a word.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Number {
    /// Its digits as a whole number, with its sign.
    pub mantissa: i64,
    /// How many of them stand behind the point.
    pub decimals: u8,
    /// Whether it has a point.
    pub point: bool,
}

/// The unit of lengths.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Unit {
    /// G21, G71.
    #[default]
    Millimetre,
    /// G20, G70.
    Inch,
}

impl Unit {
    /// Its length in nanometres.
    #[must_use]
    pub fn nanometres(self) -> i64 {
        match self {
            Self::Millimetre => 1_000_000,
            Self::Inch => 25_400_000,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Inch => "inch",
        }
    }
}

/// Beyond this a coordinate is refused: 1 km, in nanometres. Sums and squares stay exact or nearly so.
pub const LENGTH_MAX: i64 = 1_000_000_000_000;

impl Number {
    /// The number in nanometres, when 1 is `per` nanometres; none beyond [`LENGTH_MAX`].
    #[must_use]
    pub fn nanometres(self, per: i64) -> Option<i64> {
        let divisor = *POWERS.get(usize::from(self.decimals))?;
        // Halves away from zero: half the divisor is added on the side of the sign.
        let value = match self.mantissa.checked_mul(per) {
            Some(product) if product.unsigned_abs() < u64::MAX / 4 && divisor < i64::MAX / 2 => {
                (product + if product < 0 { -divisor / 2 } else { divisor / 2 }) / divisor
            }
            _ => {
                let product = i128::from(self.mantissa) * i128::from(per);
                let divisor = i128::from(divisor);
                let half = if product < 0 { -divisor / 2 } else { divisor / 2 };
                i64::try_from((product + half) / divisor).ok()?
            }
        };
        (-LENGTH_MAX..=LENGTH_MAX).contains(&value).then_some(value)
    }

    /// The number as it is, for what is no length.
    #[must_use]
    pub fn decimal(self) -> f64 {
        let divisor = POWERS.get(usize::from(self.decimals)).copied().unwrap_or(i64::MAX);
        self.mantissa as f64 / divisor as f64
    }

    /// The number where only a whole one without a sign has a meaning: a code, a register, a label.
    #[must_use]
    pub fn whole(self) -> Option<u32> {
        if self.decimals == 0 { u32::try_from(self.mantissa).ok() } else { None }
    }
}

/// Millimetres of a length in nanometres: one division, correctly rounded, never `-0`.
#[must_use]
pub fn millimetres(nanometres: i64) -> f64 {
    nanometres as f64 / 1e6
}

/// Powers of ten as far as a mantissa has digits.
pub(crate) const POWERS: [i64; 19] = {
    let mut powers = [1i64; 19];
    let mut n = 1;
    while n < 19 {
        powers[n] = powers[n - 1] * 10;
        n += 1;
    }
    powers
};

#[cfg(test)]
mod tests {
    use super::*;

    fn number(mantissa: i64, decimals: u8) -> Number {
        Number { mantissa, decimals, point: true }
    }

    #[test]
    fn lengths_are_whole_nanometres_and_inches_exact() {
        assert_eq!(number(5, 0).nanometres(1_000_000), Some(5_000_000));
        assert_eq!(number(-8_701, 4).nanometres(25_400_000), Some(-22_100_540));
        assert_eq!(number(-15, 7).nanometres(1_000_000), Some(-2), "halves away from zero");
        assert_eq!(number(14, 7).nanometres(1_000_000), Some(1));
        assert_eq!(number(1_000_001, 0).nanometres(1_000_000), None, "more than a kilometre");
        assert_eq!(number(i64::MAX, 0).nanometres(25_400_000), None);
    }

    #[test]
    fn a_millimetre_is_the_number_a_person_would_type() {
        assert_eq!(millimetres(12_345_000), 12.345);
        assert_eq!(millimetres(-100), -0.0001);
        assert!(millimetres(0).is_sign_positive());
    }
}
