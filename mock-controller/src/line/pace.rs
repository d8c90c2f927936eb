//! How fast characters travel: baud and framing, or at once.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

/// The bits of one character, as `7E2`: data bits, parity, stop bits; the start bit comes on top.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Framing {
    /// Data bits, 5 to 8.
    pub data: u8,
    /// The parity bit.
    pub parity: Parity,
    /// Stop bits, 1 or 2.
    pub stop: u8,
}

/// The parity bit of a character.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Parity {
    /// `N`: no bit.
    None,
    /// `E`: an even number of ones.
    Even,
    /// `O`: an odd number of ones.
    Odd,
}

impl Framing {
    /// 7 data bits, even parity, 2 stop bits: typical of reader/puncher interfaces (domain/4, from a manual).
    pub const SEVEN_EVEN_TWO: Framing = Framing { data: 7, parity: Parity::Even, stop: 2 };

    /// Bits on the line for one character, start bit included.
    #[must_use]
    pub fn bits(self) -> u32 {
        let parity = match self.parity {
            Parity::None => 0,
            Parity::Even | Parity::Odd => 1,
        };
        1 + u32::from(self.data) + parity + u32::from(self.stop)
    }
}

impl fmt::Display for Framing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parity = match self.parity {
            Parity::None => 'N',
            Parity::Even => 'E',
            Parity::Odd => 'O',
        };
        write!(f, "{}{parity}{}", self.data, self.stop)
    }
}

/// The word is no framing.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct UnknownFraming;

impl fmt::Display for UnknownFraming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("expected data bits 5 to 8, N, E or O, stop bits 1 or 2, as in 7E2")
    }
}

impl std::error::Error for UnknownFraming {}

impl FromStr for Framing {
    type Err = UnknownFraming;

    fn from_str(word: &str) -> Result<Self, UnknownFraming> {
        let &[data @ b'5'..=b'8', parity, stop @ b'1'..=b'2'] = word.as_bytes() else {
            return Err(UnknownFraming);
        };
        let parity = match parity.to_ascii_uppercase() {
            b'N' => Parity::None,
            b'E' => Parity::Even,
            b'O' => Parity::Odd,
            _ => return Err(UnknownFraming),
        };
        Ok(Framing { data: data - b'0', parity, stop: stop - b'0' })
    }
}

/// How fast the line is, in both directions.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Pace {
    /// One character takes [`Framing::bits`] / `baud` seconds.
    Paced {
        /// Bits a second.
        baud: u32,
        /// The bits of a character.
        framing: Framing,
    },
    /// Characters take no time. During a hold nothing travels at all, as over TCP, where the transport holds what the
    /// control has no room for; so the overrun rule cannot be broken on such a line.
    Unpaced,
}

impl Pace {
    /// The time `count` characters take, rounded to the nanosecond only once.
    #[must_use]
    pub fn time_of(self, count: u64) -> Duration {
        match self {
            Pace::Unpaced => Duration::ZERO,
            Pace::Paced { baud, framing } => {
                let nanoseconds =
                    u128::from(count) * u128::from(framing.bits()) * 1_000_000_000 / u128::from(baud.max(1));
                Duration::from_nanos(u64::try_from(nanoseconds).unwrap_or(u64::MAX))
            }
        }
    }

    /// The time one character takes.
    #[must_use]
    pub fn character(self) -> Duration {
        self.time_of(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seven_e_two_is_eleven_bits() {
        let framing: Framing = "7E2".parse().unwrap();
        assert_eq!(framing, Framing::SEVEN_EVEN_TWO);
        assert_eq!(framing.bits(), 11);
        assert_eq!(framing.to_string(), "7E2");
        assert_eq!("8N1".parse::<Framing>().unwrap().bits(), 10);
    }

    #[test]
    fn other_words_are_no_framing() {
        for wrong in ["", "7E", "4E2", "9N1", "7E3", "7X2", "7E22", "E72"] {
            assert!(wrong.parse::<Framing>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn rounding_does_not_add_up_over_a_million_characters() {
        let pace = Pace::Paced { baud: 9600, framing: Framing::SEVEN_EVEN_TWO };
        assert_eq!(pace.time_of(9_600_000), Duration::from_secs(11_000));
    }
}
