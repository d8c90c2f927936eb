//! How numbers are spelled.

use crate::formats::gcode::Dialect;
use crate::units::Micrometres;

/// A length: with a point and three decimals, or in whole micrometres.
pub(super) fn length(dialect: &Dialect, value: Micrometres, words: &mut Vec<u8>) {
    let size = value.0.unsigned_abs();
    let text = match dialect.written.padded {
        _ if !dialect.written.micrometres => {
            format!("{}{}.{:03}", sign(value, ""), size / 1000, size % 1000)
        }
        0 => format!("{}{size}", sign(value, "")),
        width => format!("{}{size:0width$}", sign(value, "+")),
    };
    words.extend_from_slice(text.as_bytes());
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
    let width = dialect.register_digits;
    words.extend_from_slice(format!("{register:0width$}").as_bytes());
}

fn sign(value: Micrometres, plus: &'static str) -> &'static str {
    if value.0 < 0 { "-" } else { plus }
}
