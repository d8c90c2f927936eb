//! Spells made blocks: a line of plain G-code for each.
//!
//! Words come in source order. A computed length is rounded once, here, to the decimals printed, halves away from zero;
//! a word that was written goes out as it is written, but for what the form says of its point. Nothing is guessed: a
//! whole-number word that came out with a fraction is an error.

use super::block::{Amount, Block, Word};
use super::form::{AmountOf, Form, Numbering, Point};
use super::number::Number;
use super::suppress::InForce;
use crate::formats::gcode::numbers::POWERS;
use crate::place::Spot;

#[cfg(test)]
mod tests;

/// What was printed of a block.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Printed {
    /// A block.
    Block,
    /// A remark or a program's name: sent, but not counted.
    Remark,
    /// Nothing: all its words were null, or its remarks are left out.
    Nothing,
}

/// Why a block cannot be spelled.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Unspellable {
    /// The rule broken.
    pub message: String,
    /// Where the source block stands.
    pub spot: Spot,
    /// What to do about it.
    pub help: String,
}

/// Spells blocks one after another.
#[derive(Clone, Debug)]
pub struct Printer {
    form: Form,
    /// 0: millimetres, 1: inches.
    unit: usize,
    /// What is in force, where words that say it again are left out.
    in_force: Option<InForce>,
    number: u32,
}

impl Printer {
    /// A printer of a form; with `suppress` words that say again what is in force are left out.
    #[must_use]
    pub fn new(form: Form, suppress: bool) -> Self {
        Self { form, unit: 0, in_force: suppress.then(InForce::default), number: 0 }
    }

    /// How it spells.
    #[must_use]
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// Whether a block's spelling depends on the blocks before it.
    #[must_use]
    pub fn looks_back(&self) -> bool {
        self.in_force.is_some() || matches!(self.form.numbers, Numbering::Count { .. })
    }

    /// Appends a block's text, without an end of line. `source` is the text of the program.
    ///
    /// # Errors
    ///
    /// When a word or the line does not fit the form; then nothing of it is appended.
    pub fn print<N: Number>(
        &mut self,
        block: &Block<N>,
        source: &[u8],
        text: &mut Vec<u8>,
    ) -> Result<Printed, Unspellable> {
        let start = text.len();
        let printed = self.spell(block, source, text).and_then(|printed| {
            let length = text.len() - start;
            match self.form.line_max {
                Some(most) if length > most => Err(Unspellable {
                    message: format!(
                        "the block takes {length} characters, and the control's lines hold {most}"
                    ),
                    spot: block.spot,
                    help: "leave remarks and blanks out (`comments`, `blanks`), or make two blocks of it"
                        .to_owned(),
                }),
                _ => Ok(printed),
            }
        });
        if printed.is_err() {
            text.truncate(start);
        }
        printed
    }

    fn spell<N: Number>(
        &mut self,
        block: &Block<N>,
        source: &[u8],
        text: &mut Vec<u8>,
    ) -> Result<Printed, Unspellable> {
        let start = text.len();
        let is_block = block.words.iter().any(|word| word.letter != b'O');
        if is_block {
            self.mark(block, text);
            let dropped = match &mut self.in_force {
                Some(in_force) => in_force.dropped(&self.form, self.unit, &block.words),
                None => 0,
            };
            for (n, word) in block.words.iter().enumerate() {
                if n >= 64 || dropped & (1 << n) == 0 {
                    self.word(word, block.spot, source, start, text)?;
                }
            }
        } else {
            for word in &block.words {
                self.word(word, block.spot, source, start, text)?;
            }
        }
        if self.form.remarks {
            for &(from, to) in &block.remarks {
                if text.len() > start && self.form.blanks {
                    text.push(b' ');
                }
                text.push(b'(');
                text.extend_from_slice(source.get(from as usize..to as usize).unwrap_or_default());
                text.push(b')');
            }
        }
        Ok(match (is_block, text.len() > start) {
            (true, _) => Printed::Block,
            (false, true) => Printed::Remark,
            (false, false) => Printed::Nothing,
        })
    }

    /// `/` and the N number.
    fn mark<N>(&mut self, block: &Block<N>, text: &mut Vec<u8>) {
        match block.skip {
            0 => {}
            1 => text.push(b'/'),
            level => text.extend_from_slice(&[b'/', b'0' + level.min(9)]),
        }
        let number = match self.form.numbers {
            Numbering::Keep => block.number,
            Numbering::Strip => None,
            Numbering::Count { step, last } => {
                self.number = match self.number.checked_add(step) {
                    Some(next) if next <= last => next,
                    _ => step,
                };
                Some(u64::from(self.number))
            }
        };
        if let Some(number) = number {
            text.push(b'N');
            digits(number, text);
            if self.form.blanks {
                text.push(b' ');
            }
        }
    }

    #[inline]
    fn word<N: Number>(
        &mut self,
        word: &Word<N>,
        spot: Spot,
        source: &[u8],
        start: usize,
        text: &mut Vec<u8>,
    ) -> Result<(), Unspellable> {
        if self.form.blanks && text.len() > start && !matches!(text.last(), Some(b' ' | b'/')) {
            text.extend_from_slice(&[b' ', word.letter]);
        } else {
            text.push(word.letter);
        }
        let kind = self.form.amount(word.letter);
        match word.amount {
            Amount::Written { number, digits: (from, to) } => {
                if word.letter == b'G' && number.decimals == 0 {
                    self.unit_word(number.mantissa);
                }
                let value = (kind == AmountOf::Length).then(|| self.form.value(self.unit, number)).flatten();
                match value {
                    Some(value) => self.length(value, text),
                    // Nobody wrote it.
                    None if from == to => signed(number.mantissa, text),
                    None => {
                        text.extend_from_slice(source.get(from as usize..to as usize).unwrap_or_default())
                    }
                }
                Ok(())
            }
            Amount::Computed(value) => {
                let fails =
                    |message: String, help: &str| Err(Unspellable { message, spot, help: help.to_owned() });
                match kind {
                    AmountOf::Length => match value.at_decimals(self.form.decimals[self.unit]) {
                        Some(value) if value.unsigned_abs() < LENGTH_MAX => {
                            self.length(value, text);
                            Ok(())
                        }
                        _ => fails(
                            format!(
                                "{}{} has more digits than a block holds",
                                char::from(word.letter),
                                value.text()
                            ),
                            "look at what computes it",
                        ),
                    },
                    AmountOf::Feed | AmountOf::Code => match (value.as_whole(), value.at_decimals(3)) {
                        (Some(whole), _) => {
                            if kind == AmountOf::Code {
                                self.unit_word(whole);
                            }
                            signed(whole, text);
                            Ok(())
                        }
                        (None, Some(thousandths)) if kind == AmountOf::Feed || thousandths % 100 == 0 => {
                            decimal(thousandths, 3, false, true, text);
                            Ok(())
                        }
                        _ => fails(
                            format!("{} is no code: {}", char::from(word.letter), value.text()),
                            "a G code is whole or has one decimal",
                        ),
                    },
                    AmountOf::Whole => match value.as_whole() {
                        Some(whole) => {
                            signed(whole, text);
                            Ok(())
                        }
                        None => fails(
                            format!(
                                "{} takes a whole number, and it comes to {}",
                                char::from(word.letter),
                                value.text()
                            ),
                            "write ROUND[…], FIX[…] or FUP[…] round what computes it",
                        ),
                    },
                }
            }
        }
    }

    /// Lengths behind it are in its unit.
    fn unit_word(&mut self, code: i64) {
        match code {
            20 | 70 => self.unit = 1,
            21 | 71 => self.unit = 0,
            _ => {}
        }
    }

    #[inline]
    fn length(&self, value: i64, text: &mut Vec<u8>) {
        match self.form.point {
            Point::Never => signed(value, text),
            Point::Always => decimal(
                value,
                self.form.decimals[self.unit],
                self.form.trailing_zeros,
                self.form.leading_zero,
                text,
            ),
        }
    }
}

impl Form {
    /// A written length in units of the last decimal printed; none where it goes out as it is written: it has no point,
    /// and what that means is not known, or more digits than can be rounded.
    pub(super) fn value(&self, unit: usize, number: crate::formats::gcode::numbers::Number) -> Option<i64> {
        let decimals = self.decimals[unit];
        let per_unit = [1_000_000, 25_400_000][unit];
        let count = if number.point { per_unit } else { self.without_point[unit]? };
        // count / per_unit is what 1 counts in the unit: exact as a fraction.
        let (mut top, mut bottom) = (i128::from(number.mantissa) * i128::from(count), i128::from(per_unit));
        let shift = i32::from(decimals) - i32::from(number.decimals);
        let power = 10i128.checked_pow(shift.unsigned_abs())?;
        if shift >= 0 {
            top = top.checked_mul(power)?;
        } else {
            bottom = bottom.checked_mul(power)?;
        }
        let half = if top < 0 { -bottom / 2 } else { bottom / 2 };
        i64::try_from((top + half) / bottom).ok()
    }
}

/// Beyond this a length is refused: 10¹⁵ of the last decimal printed.
const LENGTH_MAX: u64 = 1_000_000_000_000_000;

fn signed(value: i64, text: &mut Vec<u8>) {
    if value < 0 {
        text.push(b'-');
    }
    digits(value.unsigned_abs(), text);
}

/// `value / 10^decimals` with a point; never `-0`.
#[inline]
fn decimal(value: i64, decimals: u8, trailing_zeros: bool, leading_zero: bool, text: &mut Vec<u8>) {
    // Sign, twenty digits, the point; from behind.
    let mut buffer = [b'0'; 32];
    let (mut end, places) = (buffer.len(), usize::from(decimals.min(18)));
    let point = end - places - 1;
    let power = POWERS[places].unsigned_abs();
    let (mut whole, mut rest) = (value.unsigned_abs() / power, value.unsigned_abs() % power);
    let mut at = end;
    while at > point + 2 {
        at -= 2;
        buffer[at..at + 2].copy_from_slice(pair(rest % 100));
        rest /= 100;
    }
    if at > point + 1 {
        buffer[at - 1] = b'0' + rest as u8;
    }
    buffer[point] = b'.';
    at = point;
    // A zero is written all the same where no digit would be left.
    if whole > 0 || leading_zero || places == 0 || (!trailing_zeros && value == 0) {
        while whole >= 10 {
            at -= 2;
            buffer[at..at + 2].copy_from_slice(pair(whole % 100));
            whole /= 100;
        }
        if whole > 0 || at == point {
            at -= 1;
            buffer[at] = b'0' + whole as u8;
        }
    }
    if !trailing_zeros {
        while buffer[end - 1] == b'0' {
            end -= 1;
        }
    }
    if value < 0 {
        at -= 1;
        buffer[at] = b'-';
    }
    text.extend_from_slice(&buffer[at..end]);
}

/// A whole number.
fn digits(value: u64, text: &mut Vec<u8>) {
    let mut buffer = [b'0'; 20];
    let (mut at, mut value) = (buffer.len(), value);
    while value >= 10 {
        at -= 2;
        buffer[at..at + 2].copy_from_slice(pair(value % 100));
        value /= 100;
    }
    if value > 0 || at == buffer.len() {
        at -= 1;
        buffer[at] = b'0' + value as u8;
    }
    text.extend_from_slice(&buffer[at..]);
}

/// Two digits.
#[inline]
fn pair(value: u64) -> &'static [u8] {
    let at = value as usize * 2;
    &PAIRS[at..at + 2]
}

/// `00` to `99`.
const PAIRS: [u8; 200] = {
    let mut pairs = [0; 200];
    let mut n = 0;
    while n < 100 {
        pairs[2 * n] = b'0' + (n / 10) as u8;
        pairs[2 * n + 1] = b'0' + (n % 10) as u8;
        n += 1;
    }
    pairs
};
