//! The group codes and values a DXF file is made of, from its text or its binary form.
//!
//! A pair is a number that says what, and a value. Text files hold a line for each; binary ones a code of one byte (up to
//! release 12) or two, and a value whose form follows from the code. What the pairs mean is `records`.
//!
//! Source: Autodesk, *DXF Reference*, "Group Codes in Numerical Order" and "About Binary DXF Files".

use std::borrow::Cow;

use crate::formats::ReadError;
use crate::place::{Place, Spot};

/// A group code and its value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<'a> {
    pub(super) code: i32,
    pub(super) value: Value<'a>,
    /// Where its value stands.
    pub(super) spot: Spot,
}

/// A value as it stands in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'a> {
    Text(&'a [u8]),
    Real(f64),
    Whole(i64),
}

impl Pair<'_> {
    /// The value as a number that is finite.
    pub(super) fn number(&self) -> Option<f64> {
        let number = match self.value {
            Value::Text(text) => std::str::from_utf8(text).ok()?.parse().ok()?,
            Value::Real(number) => number,
            Value::Whole(number) => number as f64,
        };
        f64::is_finite(number).then_some(number)
    }

    /// The value as a whole number of 16 bits; some programs write those with a point.
    pub(super) fn whole(&self) -> Option<i16> {
        let number = self.number()?;
        let whole = number as i16;
        (f64::from(whole) == number).then_some(whole)
    }

    /// The value as text.
    pub(super) fn text(&self) -> Cow<'_, [u8]> {
        match self.value {
            Value::Text(text) => Cow::Borrowed(text),
            Value::Real(number) => Cow::Owned(number.to_string().into_bytes()),
            Value::Whole(number) => Cow::Owned(number.to_string().into_bytes()),
        }
    }

    pub(super) fn is(&self, code: i32, text: &str) -> bool {
        self.code == code && matches!(self.value, Value::Text(found) if found == text.as_bytes())
    }
}

/// The pairs of a file, one after another. Remarks (999) are among them.
#[derive(Debug)]
pub(super) struct Pairs<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    form: Form,
    /// Where the pair last given out begins.
    begun: Spot,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Form {
    Text,
    Binary { code_bytes: usize },
}

const SENTINEL: &[u8] = b"AutoCAD Binary DXF\r\n\x1A\0";

impl<'a> Pairs<'a> {
    /// The pairs of a file.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let mut pairs = Self { bytes, at: 0, line: 1, form: Form::Text, begun: Spot::default() };
        if let Some(rest) = bytes.strip_prefix(SENTINEL) {
            // The first pair is 0/SECTION: a second nought is the other half of a code of two bytes.
            let code_bytes = if rest.starts_with(&[0, 0]) { 2 } else { 1 };
            pairs.form = Form::Binary { code_bytes };
            pairs.at = SENTINEL.len();
        } else if bytes.starts_with(b"AutoCAD Binary DXF") {
            return Err(pairs.fault(
                0,
                18,
                "the head of the binary drawing is damaged".into(),
                "a transfer as text breaks binary files: copy it again, or save it as ASCII DXF",
            ));
        } else if bytes.starts_with(b"AC10") {
            return Err(pairs.fault(0, 6, "this is a DWG file".into(), "save it as DXF"));
        } else if bytes.starts_with(b"AutoCAD DXB") {
            return Err(pairs.fault(0, 11, "this is a DXB file".into(), "save it as DXF"));
        } else if matches!(bytes, [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..]) {
            return Err(pairs.fault(
                0,
                1,
                "the drawing is UTF-16, two bytes a character".into(),
                "save it as plain text",
            ));
        } else if bytes.starts_with(&[0xEF, 0xBB, 0xBF]) {
            pairs.at = 3;
        }
        Ok(pairs)
    }

    /// The next pair; none at the end of the file.
    pub(super) fn next_pair(&mut self) -> Result<Option<Pair<'a>>, ReadError> {
        match self.form {
            Form::Text => self.next_text(),
            Form::Binary { code_bytes } => self.next_binary(code_bytes),
        }
    }

    /// Where reading stands.
    pub(super) fn spot(&self) -> Spot {
        self.spot_at(self.at)
    }

    /// Where the code of the pair last given out stands.
    pub(super) fn begun(&self) -> Spot {
        self.begun
    }

    /// An error about what stands at a spot.
    pub(super) fn error(&self, spot: Spot, message: String, help: &'static str) -> ReadError {
        let at = (spot.byte as usize).min(self.bytes.len());
        let place = match self.form {
            Form::Text => {
                let end = at + line_length(&self.bytes[at..]);
                let start = at - (spot.column.max(1) as usize - 1).min(at);
                Place::in_line(&self.bytes[start..end], spot.line, start as u64, at - start, end - at)
            }
            Form::Binary { .. } => {
                let end = (at + 16).min(self.bytes.len());
                let mut place = Place::in_line(&self.bytes[at..end], 1, at as u64, 0, 1);
                place.column = at as u64 + 1;
                place
            }
        };
        ReadError::Program { message, place, help: help.into() }
    }

    fn fault(&self, at: usize, width: usize, message: String, help: &'static str) -> ReadError {
        let end = at + line_length(&self.bytes[at..]);
        let place = Place::in_line(&self.bytes[at..end.min(at + 80)], 1, at as u64, 0, width);
        ReadError::Program { message, place, help: help.into() }
    }

    fn spot_at(&self, at: usize) -> Spot {
        match self.form {
            Form::Text => Spot { byte: at as u64, line: self.line, column: 1 },
            Form::Binary { .. } => Spot { byte: at as u64, line: 1, column: at as u64 + 1 },
        }
    }

    /// The next line without blanks around it, and where it begins; none at the end of the file.
    fn next_line(&mut self) -> Option<(&'a [u8], Spot)> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return None;
        }
        let length = line_length(rest);
        let line = &rest[..length];
        let lead = line.len() - line.trim_ascii_start().len();
        let spot = Spot { byte: (self.at + lead) as u64, line: self.line, column: lead as u64 + 1 };
        self.at += match &rest[length..] {
            [b'\r', b'\n', ..] => length + 2,
            [] => length,
            _ => length + 1,
        };
        self.line += 1;
        Some((line.trim_ascii(), spot))
    }

    fn next_text(&mut self) -> Result<Option<Pair<'a>>, ReadError> {
        let (code, spot) = loop {
            match self.next_line() {
                None => return Ok(None),
                // Only what is left at the end of a file is empty.
                Some(([], spot)) => {
                    if !self.bytes[self.at..].trim_ascii().is_empty() {
                        return Err(self.error(
                            spot,
                            "an empty line stands where a group code is due".into(),
                            "the drawing is damaged here: save it again from the program that drew it",
                        ));
                    }
                }
                Some(found) => break found,
            }
        };
        self.begun = spot;
        let number = std::str::from_utf8(code).ok().and_then(|code| code.parse::<i32>().ok());
        let Some(code) = number.filter(|code| (-5..=1071).contains(code)) else {
            let help = if spot.line == 1 {
                "a DXF file begins with a line `0` and a line `SECTION`"
            } else {
                "the drawing is damaged here: save it again from the program that drew it"
            };
            return Err(self.error(spot, "a group code is due here, a whole number up to 1071".into(), help));
        };
        match self.next_line() {
            Some((value, spot)) => Ok(Some(Pair { code, value: Value::Text(value), spot })),
            None => Err(self.cut_off()),
        }
    }

    fn next_binary(&mut self, code_bytes: usize) -> Result<Option<Pair<'a>>, ReadError> {
        if self.at == self.bytes.len() {
            return Ok(None);
        }
        self.begun = self.spot();
        let code = match (code_bytes, self.bytes[self.at]) {
            (1, 0xFF) => {
                self.at += 1;
                i32::from(i16::from_le_bytes(self.take()?))
            }
            (1, code) => {
                self.at += 1;
                i32::from(code)
            }
            _ => i32::from(i16::from_le_bytes(self.take()?)),
        };
        let spot = self.spot();
        let value = match code {
            10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => {
                Value::Real(f64::from_le_bytes(self.take()?))
            }
            60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => {
                Value::Whole(i64::from(i16::from_le_bytes(self.take()?)))
            }
            90..=99 | 420..=429 | 440..=459 | 1071 => {
                Value::Whole(i64::from(i32::from_le_bytes(self.take()?)))
            }
            160..=169 => Value::Whole(i64::from_le_bytes(self.take()?)),
            290..=299 if code_bytes == 2 => Value::Whole(i64::from(u8::from_le_bytes(self.take()?))),
            290..=299 => Value::Whole(i64::from(i16::from_le_bytes(self.take()?))),
            310..=319 | 1004 => {
                let [length] = self.take()?;
                let from = self.at;
                let to = from + usize::from(length);
                let chunk = self.bytes.get(from..to).ok_or_else(|| self.cut_off())?;
                self.at = to;
                Value::Text(chunk)
            }
            0..=9
            | 100..=109
            | 300..=309
            | 320..=369
            | 390..=399
            | 410..=419
            | 430..=439
            | 470..=481
            | 999..=1009 => {
                let rest = &self.bytes[self.at..];
                let length = memchr::memchr(0, rest).ok_or_else(|| self.cut_off())?;
                self.at += length + 1;
                Value::Text(rest[..length].trim_ascii())
            }
            _ => {
                return Err(self.error(
                    self.begun,
                    format!("{code} is no group code"),
                    "the drawing is damaged here: save it again from the program that drew it",
                ));
            }
        };
        Ok(Some(Pair { code, value, spot }))
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let found = self.bytes[self.at..].first_chunk::<N>().copied().ok_or_else(|| self.cut_off())?;
        self.at += N;
        Ok(found)
    }

    /// The error for a file that ends where more is due.
    pub(super) fn cut_off(&self) -> ReadError {
        let spot = self.spot_at(self.bytes.len());
        self.error(
            spot,
            "the drawing is cut off: it ends before `0 EOF`".into(),
            "copy or save it again; what is missing would not be cut",
        )
    }
}

/// The length of a line without its end.
fn line_length(bytes: &[u8]) -> usize {
    memchr::memchr2(b'\n', b'\r', bytes).unwrap_or(bytes.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8]) -> Vec<(i32, String, u64)> {
        let mut pairs = Pairs::of(bytes).unwrap();
        let mut found = Vec::new();
        while let Some(pair) = pairs.next_pair().unwrap() {
            found.push((pair.code, String::from_utf8(pair.text().into_owned()).unwrap(), pair.spot.line));
        }
        found
    }

    #[test]
    fn text_is_read_whatever_its_line_ends_and_blanks() {
        let expected: Vec<(i32, String, u64)> =
            vec![(0, "SECTION".into(), 2), (8, "a b".into(), 4), (40, "".into(), 6), (0, "EOF".into(), 8)];
        for end in ["\n", "\r\n", "\r"] {
            let text = ["  0", "SECTION", "8", " a b ", " 40", "", "0", "EOF", "", ""].join(end);
            assert_eq!(all(text.as_bytes()), expected, "{end:?}");
        }
        assert_eq!(all(b"\xEF\xBB\xBF0\nEOF"), [(0, "EOF".into(), 2)]);
    }

    #[test]
    fn binary_values_have_the_form_of_their_code() {
        for wide in [true, false] {
            let mut bytes = SENTINEL.to_vec();
            let code = |bytes: &mut Vec<u8>, code: i16| match (wide, code) {
                (true, _) => bytes.extend(code.to_le_bytes()),
                (false, 0..=254) => bytes.push(code as u8),
                (false, _) => {
                    bytes.push(255);
                    bytes.extend(code.to_le_bytes());
                }
            };
            code(&mut bytes, 0);
            bytes.extend(b"SECTION\0");
            code(&mut bytes, 10);
            bytes.extend(1.25_f64.to_le_bytes());
            code(&mut bytes, 70);
            bytes.extend((-3_i16).to_le_bytes());
            code(&mut bytes, 90);
            bytes.extend(70_000_i32.to_le_bytes());
            code(&mut bytes, 310);
            bytes.extend([2, 65, 66]);
            code(&mut bytes, 1071);
            bytes.extend(7_i32.to_le_bytes());
            let found: Vec<(i32, String)> = all(&bytes).into_iter().map(|(c, v, _)| (c, v)).collect();
            let expected =
                [(0, "SECTION"), (10, "1.25"), (70, "-3"), (90, "70000"), (310, "AB"), (1071, "7")];
            assert_eq!(found, expected.map(|(c, v)| (c, v.to_string())));
        }
    }

    #[test]
    fn what_is_no_dxf_is_named() {
        let refused = |bytes: &[u8]| {
            let mut pairs = match Pairs::of(bytes) {
                Ok(pairs) => pairs,
                Err(error) => return error.to_string(),
            };
            loop {
                match pairs.next_pair() {
                    Ok(Some(_)) => {}
                    Ok(None) => return "accepted".into(),
                    Err(error) => return error.to_string(),
                }
            }
        };
        assert_eq!(refused(b"AC1032\0\0"), "this is a DWG file");
        assert_eq!(refused(b"G90 G54"), "a group code is due here, a whole number up to 1071");
        assert_eq!(refused(b"0\nSECTION\n\n2\n"), "an empty line stands where a group code is due");
        assert_eq!(refused(b"0\nSECTION\n2"), "the drawing is cut off: it ends before `0 EOF`");
        assert_eq!(refused(b"AutoCAD Binary DXF\n\x1A\0"), "the head of the binary drawing is damaged");
        let mut cut = SENTINEL.to_vec();
        cut.extend([0, 0, b'S']);
        assert_eq!(refused(&cut), "the drawing is cut off: it ends before `0 EOF`");
        cut.extend([0, 0xFE, 0x7F]);
        assert_eq!(refused(&cut), "32766 is no group code");
    }
}
