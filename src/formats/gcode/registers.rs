//! Offset registers a program sets itself: `H1 = .0085 + H175`, `H001=110  H002=85`.

use std::collections::BTreeMap;

use super::numbers::{LENGTH_MAX, Number, POWERS};

/// What a program has put into registers, nanometres.
///
/// A register that depends on one the program has not set is unknown: its master stands in the control.
#[derive(Clone, Debug, Default)]
pub(super) struct Registers(BTreeMap<u32, Option<i64>>);

/// What is wrong with an assignment.
#[derive(Debug)]
pub(super) struct Wrong {
    /// Where in the text.
    pub at: usize,
    /// What.
    pub message: String,
}

/// More registers than any control has.
const REGISTERS_MAX: usize = 10_000;

impl Registers {
    /// What a register holds, where the program has set it.
    pub(super) fn value(&self, register: u32) -> Option<i64> {
        self.0.get(&register).copied().flatten()
    }

    /// Takes in the assignments of a text; `length` turns a number into nanometres.
    pub(super) fn assign(
        &mut self,
        text: &[u8],
        letter: u8,
        length: impl Fn(Number) -> Result<i64, String>,
    ) -> Result<(), Wrong> {
        let mut cursor = Cursor { text, at: 0 };
        while cursor.peek().is_some() {
            let register = cursor.register(letter)?;
            cursor.expect(b'=')?;
            let mut sum = Some(0i64);
            let mut sign = cursor.sign().unwrap_or(1);
            loop {
                let at = cursor.at;
                let term = if cursor.peek() == Some(letter) {
                    self.value(cursor.register(letter)?)
                } else {
                    let number = cursor.number()?;
                    Some(length(number).map_err(|message| Wrong { at, message })?)
                };
                sum = sum.zip(term).map(|(sum, term)| sum + sign * term);
                if sum.is_some_and(|sum| sum.abs() > LENGTH_MAX) {
                    return Err(Wrong { at, message: "the offset is beyond any machine".into() });
                }
                match cursor.sign() {
                    Some(next) => sign = next,
                    None => break,
                }
            }
            if self.0.len() >= REGISTERS_MAX && !self.0.contains_key(&register) {
                return Err(Wrong { at: 0, message: format!("more than {REGISTERS_MAX} registers are set") });
            }
            self.0.insert(register, sum);
        }
        Ok(())
    }
}

struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    /// The next character that is not a blank, as a capital.
    fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at).is_some_and(|b| matches!(b, b' ' | b'\t' | 0)) {
            self.at += 1;
        }
        self.text.get(self.at).map(u8::to_ascii_uppercase)
    }

    fn expect(&mut self, byte: u8) -> Result<(), Wrong> {
        if self.peek() == Some(byte) {
            self.at += 1;
            return Ok(());
        }
        Err(Wrong { at: self.at, message: format!("`{}` is missing here", byte as char) })
    }

    fn sign(&mut self) -> Option<i64> {
        let sign = match self.peek()? {
            b'+' => 1,
            b'-' => -1,
            _ => return None,
        };
        self.at += 1;
        Some(sign)
    }

    fn register(&mut self, letter: u8) -> Result<u32, Wrong> {
        self.expect(letter)?;
        let at = self.at;
        let number = self.number()?;
        number.whole().filter(|_| !number.point).ok_or(Wrong { at, message: "not a register".into() })
    }

    fn number(&mut self) -> Result<Number, Wrong> {
        self.peek();
        let from = self.at;
        let mut number = Number::default();
        let mut digits = 0;
        while let Some(&byte) = self.text.get(self.at) {
            match byte {
                b'0'..=b'9' => {
                    digits += 1;
                    let next =
                        number.mantissa.checked_mul(10).and_then(|m| m.checked_add(i64::from(byte - b'0')));
                    number.mantissa =
                        next.ok_or_else(|| Wrong { at: from, message: "the number is too long".into() })?;
                    number.decimals += u8::from(number.point);
                }
                b'.' if !number.point => number.point = true,
                _ => break,
            }
            if usize::from(number.decimals) >= POWERS.len() {
                return Err(Wrong { at: from, message: "the number is too long".into() });
            }
            self.at += 1;
        }
        if digits == 0 {
            return Err(Wrong { at: from, message: "a number or a register belongs here".into() });
        }
        Ok(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assign(registers: &mut Registers, text: &str) -> Result<(), Wrong> {
        registers.assign(text.as_bytes(), b'H', |n| {
            n.nanometres(if n.point { 25_400_000 } else { 1000 }).ok_or_else(|| "long".to_owned())
        })
    }

    #[test]
    fn sums_and_several_on_a_line_are_taken_in() {
        let mut registers = Registers::default();
        assign(&mut registers, "H175 = 0.0002").unwrap();
        assign(&mut registers, "H1 =.0085 + H175").unwrap();
        assign(&mut registers, "h001= +000110  H002=-85").unwrap();
        assert_eq!(registers.value(1), Some(110_000));
        assert_eq!(registers.value(2), Some(-85_000));
        assign(&mut registers, "H3=.0085+H175-H2").unwrap();
        assert_eq!(registers.value(3), Some(220_980 + 85_000));
        assign(&mut registers, "H3 = H9 + 1").unwrap();
        assert_eq!(registers.value(3), None, "H9 stands in the control");
    }

    #[test]
    fn what_is_no_sum_is_refused() {
        for text in
            ["H1=", "H1", "=5", "H1=5*2", "H1.5=2", "H=2", "H1=5 6", "H1=99999999999999999999", "H1=."]
        {
            assert!(assign(&mut Registers::default(), text).is_err(), "{text}");
        }
    }
}
