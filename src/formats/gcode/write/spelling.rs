//! How numbers are spelled.

use crate::formats::gcode::Dialect;
use crate::units::Micrometres;

/// A length: with a point and three decimals, or in whole micrometres.
pub(super) fn length(dialect: &Dialect, value: Micrometres, words: &mut Vec<u8>) {
    let written = dialect.written;
    let size = value.0.unsigned_abs();
    if value.0 < 0 {
        words.push(b'-');
    } else if written.micrometres && written.padded > 0 {
        words.push(b'+');
    }
    if written.micrometres {
        digits(size, written.padded, words);
    } else {
        digits(size / 1000, 1, words);
        words.push(b'.');
        digits(size % 1000, 3, words);
    }
}

/// A whole number of at least so many digits.
pub(super) fn digits(mut number: u64, width: usize, words: &mut Vec<u8>) {
    let mut buffer = [b'0'; 20];
    let mut at = buffer.len();
    while number > 0 || at + width.max(1) > buffer.len() {
        at -= 1;
        buffer[at] = b'0' + (number % 10) as u8;
        number /= 10;
    }
    words.extend_from_slice(&buffer[at..]);
}

/// A number that is no length, with a point: up to six decimals, as many as it needs.
pub(super) fn decimal(value: f64, words: &mut Vec<u8>) {
    let text = format!("{:.6}", value + 0.0);
    let text = text.trim_end_matches('0');
    words.extend_from_slice(
        text.strip_suffix('.').map_or(text.to_owned(), |whole| format!("{whole}.0")).as_bytes(),
    );
}

/// The number of an offset register.
pub(super) fn register(dialect: &Dialect, register: u32, words: &mut Vec<u8>) {
    digits(u64::from(register), dialect.register_digits, words);
}
