//! BIN, BCD and the operations bit by bit: the same for every kind of number, as they are of whole numbers.
//!
//! A whole number in binary coded decimal has a decimal digit in every four bits: 39 is 0x39, which is 57.

use super::{Bits, Function, Undefined};

/// BIN and BCD of a whole number; `text` spells what was asked for where it has no code.
pub(in crate::macros) fn code(
    function: Function,
    value: Option<i64>,
    text: impl FnOnce() -> String,
) -> Result<i64, Undefined> {
    let name = if function == Function::FromBcd { "BIN" } else { "BCD" };
    let refused = |why| Err(Undefined::CodeOf(name, text(), why));
    let value = match value.map(u64::try_from) {
        None => return refused("only a whole number has a code"),
        Some(Err(_)) => return refused("a negative number has no code"),
        Some(Ok(value)) => value,
    };
    match function {
        Function::FromBcd => match from_bcd(value) {
            Some(value) => Ok(value),
            None => refused("four of its bits are more than 9"),
        },
        _ => match to_bcd(value) {
            Some(code) => Ok(code),
            None => refused("its code has more than 15 digits"),
        },
    }
}

/// AND, OR and XOR; the result is from 0 up too.
pub(in crate::macros) fn bits(operation: Bits, one: i64, other: i64) -> i64 {
    match operation {
        Bits::And => one & other,
        Bits::Or => one | other,
        Bits::Xor => one ^ other,
    }
}

impl Bits {
    /// As it is written.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::And => "AND",
            Self::Or => "OR",
            Self::Xor => "XOR",
        }
    }
}

fn from_bcd(code: u64) -> Option<i64> {
    let mut value = 0;
    for nibble in (0..16).rev() {
        let digit = (code >> (4 * nibble)) & 0xF;
        if digit > 9 {
            return None;
        }
        value = 10 * value + digit;
    }
    i64::try_from(value).ok()
}

fn to_bcd(value: u64) -> Option<i64> {
    let (mut code, mut rest) = (0, value);
    for nibble in 0..15 {
        code |= (rest % 10) << (4 * nibble);
        rest /= 10;
    }
    if rest == 0 { i64::try_from(code).ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decimal_digit_stands_in_every_four_bits() {
        assert_eq!(code(Function::ToBcd, Some(39), String::new), Ok(0x39));
        assert_eq!(code(Function::FromBcd, Some(0x39), String::new), Ok(39));
        assert_eq!(code(Function::ToBcd, Some(0), String::new), Ok(0));
        assert_eq!(code(Function::ToBcd, Some(999_999_999_999_999), String::new), Ok(0x0999_9999_9999_9999));
        assert_eq!(
            code(Function::FromBcd, Some(0x0999_9999_9999_9999), String::new),
            Ok(999_999_999_999_999)
        );
    }

    #[test]
    fn what_has_no_code_is_refused_with_the_reason() {
        let why = |function, value| match code(function, value, || "it".into()) {
            Err(Undefined::CodeOf(name, of, why)) => format!("{name} of {of}: {why}"),
            other => format!("{other:?}"),
        };
        assert_eq!(why(Function::FromBcd, Some(0x3A)), "BIN of it: four of its bits are more than 9");
        assert_eq!(why(Function::FromBcd, Some(-1)), "BIN of it: a negative number has no code");
        assert_eq!(why(Function::ToBcd, None), "BCD of it: only a whole number has a code");
        assert_eq!(
            why(Function::ToBcd, Some(1_000_000_000_000_000)),
            "BCD of it: its code has more than 15 digits"
        );
    }
}
