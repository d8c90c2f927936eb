//! One line cut into words: a letter with its number, each with its place, and what stands between them.
//!
//! Blanks are free, also between a letter and its number; letters may be small; zeros in front mean nothing. Nothing is
//! skipped: what is no word is kept as a piece of unknown text, with its place. What words *mean* is not here.

use super::numbers::{Number, POWERS};

/// A piece of a line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Word {
    mantissa: i64,
    /// Where in the line it begins.
    pub at: u32,
    /// Where in the line it ends.
    pub end: u32,
    /// What it is.
    pub kind: Kind,
    /// Its capital letter; 0 for what is not a word.
    pub letter: u8,
    decimals: u8,
    form: u8,
}

/// What a piece of a line is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kind {
    /// A letter with its number.
    Word,
    /// A remark; the place is that of its text, without brackets or semicolon.
    Comment,
    /// `/`, with the digit of its level if there is one.
    Skip,
    /// A line that begins with `%`.
    Percent,
    /// `:` between the motions of the lower and the upper end.
    Colon,
    /// From the word before an `=` to the end of what is assigned.
    Assignment,
    /// `#`, a bracket or a word of macro programs.
    Macro,
    /// Anything else.
    Unknown,
}

/// What is wrong with a line as a line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Unclosed {
    /// Where in the line the bracket opens.
    pub at: usize,
}

const POINT: u8 = 1;
const DIGITS: u8 = 2;
const TOO_LONG: u8 = 4;

impl Word {
    fn piece(kind: Kind, at: usize, end: usize) -> Self {
        Self { mantissa: 0, at: at as u32, end: end as u32, kind, letter: 0, decimals: 0, form: 0 }
    }

    /// Its number; none where there is no digit, or more of them than a number holds.
    #[must_use]
    pub fn number(&self) -> Option<Number> {
        (self.form & (DIGITS | TOO_LONG) == DIGITS).then_some(Number {
            mantissa: self.mantissa,
            decimals: self.decimals,
            point: self.form & POINT != 0,
        })
    }

    /// Whether its number has more digits than can be held.
    #[must_use]
    pub fn is_too_long(&self) -> bool {
        self.form & TOO_LONG != 0
    }

    /// Its number where only a whole one without sign has a meaning.
    #[must_use]
    pub fn whole(&self) -> Option<u32> {
        self.number()?.whole()
    }

    /// Its number as an index into a table of codes; beyond any table where it is not a whole one.
    #[inline]
    pub(super) fn code(&self) -> usize {
        let is_whole = self.form & (DIGITS | TOO_LONG) == DIGITS && self.decimals == 0;
        if is_whole { usize::try_from(self.mantissa).unwrap_or(usize::MAX) } else { usize::MAX }
    }

    /// Its text.
    #[must_use]
    pub fn text<'a>(&self, line: &'a [u8]) -> &'a [u8] {
        line.get(self.at as usize..self.end as usize).unwrap_or_default()
    }

    /// How many bytes it takes.
    #[must_use]
    pub fn width(&self) -> usize {
        (self.end - self.at) as usize
    }
}

/// Cuts a line into its pieces, into a list that is used again for every line.
///
/// # Errors
///
/// When a remark is not closed: what it would swallow may be a motion.
pub fn cut(line: &[u8], words: &mut Vec<Word>) -> Result<(), Unclosed> {
    words.clear();
    let mut at = 0;
    while let Some(&byte) = line.get(at) {
        match CLASSES[usize::from(byte)] {
            Class::Blank => at += 1,
            Class::Letter => at = word(line, at, words),
            Class::Other => at = other(line, at, words)?,
        }
    }
    Ok(())
}

/// A letter and its number.
#[inline]
fn word(line: &[u8], at: usize, words: &mut Vec<Word>) -> usize {
    let letter = line[at] & 0xDF;
    let mut next = at + 1;
    while is_blank(line, next) {
        next += 1;
    }
    let mut negative = false;
    match line.get(next) {
        Some(b'-') => {
            negative = true;
            next += 1;
        }
        Some(b'+') => next += 1,
        Some(b'0'..=b'9' | b'.') => {}
        other => {
            return letters(line, at, other.copied(), next, words);
        }
    }
    let (mut mantissa, digits_at) = (0u64, next);
    while let Some(digit) = digit(line, next) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
        next += 1;
    }
    let mut digits = next - digits_at;
    let (mut form, mut decimals) = (0, 0);
    if line.get(next) == Some(&b'.') {
        form = POINT;
        next += 1;
        let decimals_at = next;
        while let Some(digit) = digit(line, next) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
            next += 1;
        }
        decimals = next - decimals_at;
        digits += decimals;
    }
    if digits > 0 {
        form |= DIGITS;
    }
    if digits > 18 && !fits(&line[digits_at..next]) || decimals >= POWERS.len() {
        form |= TOO_LONG;
        (mantissa, decimals) = (0, 0);
    }
    let magnitude = mantissa as i64;
    words.push(Word {
        mantissa: if negative { -magnitude } else { magnitude },
        at: at as u32,
        end: next as u32,
        kind: Kind::Word,
        letter,
        decimals: decimals as u8,
        form,
    });
    next
}

/// Whether digits, zeros in front aside, are few enough for 64 bits.
fn fits(digits: &[u8]) -> bool {
    digits.iter().filter(|b| b.is_ascii_digit()).skip_while(|b| **b == b'0').count() <= 18
}

/// A letter without a number of its own: alone, or the first of several.
#[cold]
fn letters(line: &[u8], at: usize, after: Option<u8>, next: usize, words: &mut Vec<Word>) -> usize {
    if matches!(after, Some(b'#' | b'[')) {
        words.push(Word::piece(Kind::Macro, at, next + 1));
        return next + 1;
    }
    let count = line[at..].iter().take_while(|b| b.is_ascii_alphabetic()).count();
    if count == 1 {
        words.push(Word { letter: line[at] & 0xDF, kind: Kind::Word, ..Word::piece(Kind::Word, at, at + 1) });
        return at + 1;
    }
    let end = at + count;
    let name = &line[at..end];
    let kind =
        if MACRO_WORDS.iter().any(|w| name.eq_ignore_ascii_case(w)) { Kind::Macro } else { Kind::Unknown };
    // The number behind belongs to it.
    let end = end + line[end..].iter().take_while(|b| matches!(b, b'0'..=b'9' | b'.' | b'-' | b'+')).count();
    words.push(Word::piece(kind, at, end));
    end
}

const MACRO_WORDS: [&[u8]; 6] = [b"IF", b"THEN", b"GOTO", b"WHILE", b"DO", b"END"];

/// What begins neither with a letter nor with a blank.
#[cold]
fn other(line: &[u8], at: usize, words: &mut Vec<Word>) -> Result<usize, Unclosed> {
    match line[at] {
        b'(' => {
            let length = memchr::memchr(b')', &line[at + 1..]).ok_or(Unclosed { at })?;
            words.push(Word::piece(Kind::Comment, at + 1, at + 1 + length));
            return Ok(at + length + 2);
        }
        b';' => {
            // A bare semicolon is the end of the block.
            if line[at + 1..].iter().any(|b| !b.is_ascii_whitespace()) {
                words.push(Word::piece(Kind::Comment, at + 1, line.len()));
            }
            return Ok(line.len());
        }
        b'%' if words.is_empty() => {
            words.push(Word::piece(Kind::Percent, at, at + line[at..].trim_ascii_end().len()));
            return Ok(line.len());
        }
        b'/' if words.is_empty() => {
            let level = line.get(at + 1).is_some_and(u8::is_ascii_digit);
            let end = at + 1 + usize::from(level);
            words.push(Word::piece(Kind::Skip, at, end));
            return Ok(end);
        }
        b':' => {
            words.push(Word::piece(Kind::Colon, at, at + 1));
            return Ok(at + 1);
        }
        b'=' => {
            let rest = memchr::memchr2(b'(', b';', &line[at..]).unwrap_or(line.len() - at);
            let end = at + line[at..at + rest].trim_ascii_end().len();
            let from = match words.pop() {
                Some(word) if word.kind == Kind::Word => word.at as usize,
                other => {
                    words.extend(other);
                    at
                }
            };
            words.push(Word::piece(Kind::Assignment, from, end));
            return Ok(end.max(at + 1));
        }
        b'#' | b'[' | b']' => {
            words.push(Word::piece(Kind::Macro, at, at + 1));
            return Ok(at + 1);
        }
        _ => {}
    }
    let length = 1 + line[at + 1..]
        .iter()
        .take_while(|b| {
            CLASSES[usize::from(**b)] == Class::Other
                && !matches!(b, b'(' | b';' | b':' | b'=' | b'#' | b'[' | b']')
        })
        .count();
    words.push(Word::piece(Kind::Unknown, at, at + length));
    Ok(at + length)
}

#[inline]
fn digit(line: &[u8], at: usize) -> Option<u64> {
    let digit = line.get(at)?.wrapping_sub(b'0');
    (digit < 10).then_some(u64::from(digit))
}

#[inline]
fn is_blank(line: &[u8], at: usize) -> bool {
    line.get(at).is_some_and(|b| CLASSES[usize::from(*b)] == Class::Blank)
}

#[derive(Clone, Copy, Eq, PartialEq)]
enum Class {
    Blank,
    Letter,
    Other,
}

/// NUL is the blank tape of a leader, 0x1A the end mark of old files.
const CLASSES: [Class; 256] = {
    let mut classes = [Class::Other; 256];
    let mut n = 0;
    while n < 256 {
        let byte = n as u8;
        if byte.is_ascii_alphabetic() {
            classes[n] = Class::Letter;
        } else if matches!(byte, b' ' | b'\t' | 0 | 0x1A | 0x0B | 0x0C) {
            classes[n] = Class::Blank;
        }
        n += 1;
    }
    classes
};

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(line: &str) -> Vec<(Kind, String)> {
        let mut words = Vec::new();
        cut(line.as_bytes(), &mut words).unwrap();
        words
            .iter()
            .map(|w| (w.kind, String::from_utf8_lossy(w.text(line.as_bytes())).into_owned()))
            .collect()
    }

    type Written = (char, Option<(i64, u8, bool)>);

    fn numbers(line: &str) -> Vec<Written> {
        let mut words = Vec::new();
        cut(line.as_bytes(), &mut words).unwrap();
        words
            .iter()
            .map(|w| (w.letter as char, w.number().map(|n| (n.mantissa, n.decimals, n.point))))
            .collect()
    }

    #[test]
    fn numbers_are_read_as_they_are_written() {
        let read = numbers("G01X0.Y-.5 i+1j 007");
        let expected = [
            ('G', Some((1, 0, false))),
            ('X', Some((0, 0, true))),
            ('Y', Some((-5, 1, true))),
            ('I', Some((1, 0, false))),
            ('J', Some((7, 0, false))),
        ];
        assert_eq!(read, expected);
        assert_eq!(numbers("X. Y- Z"), [('X', None), ('Y', None), ('Z', None)]);
        let long = numbers("X0000000000000000000000123.5 Y9999999999999999999 U0.00000000000000000001");
        assert_eq!(long, [('X', Some((1235, 1, true))), ('Y', None), ('U', None)]);
    }

    #[test]
    fn what_is_no_word_is_kept() {
        let read = pieces("/2N1 G1 RX1.5 @! (a;b) \u{e9} X1 ; rest");
        let expected = [
            (Kind::Skip, "/2"),
            (Kind::Word, "N1"),
            (Kind::Word, "G1"),
            (Kind::Unknown, "RX1.5"),
            (Kind::Unknown, "@!"),
            (Kind::Comment, "a;b"),
            (Kind::Unknown, "\u{e9}"),
            (Kind::Word, "X1"),
            (Kind::Comment, " rest"),
        ];
        assert_eq!(read, expected.map(|(kind, text)| (kind, text.to_owned())));
        assert_eq!(pieces(" % 12 "), [(Kind::Percent, "% 12".to_owned())]);
        assert_eq!(pieces("G1 :"), [(Kind::Word, "G1".to_owned()), (Kind::Colon, ":".to_owned())]);
        assert_eq!(pieces("G1X1;"), [(Kind::Word, "G1".to_owned()), (Kind::Word, "X1".to_owned())]);
    }

    #[test]
    fn an_assignment_reaches_to_the_remark() {
        let read = pieces("N5 H1 = .0085 + H175 (sum)");
        assert_eq!(read[1], (Kind::Assignment, "H1 = .0085 + H175".to_owned()));
        assert_eq!(read[2], (Kind::Comment, "sum".to_owned()));
        assert_eq!(pieces("="), [(Kind::Assignment, "=".to_owned())]);
    }

    #[test]
    fn macro_words_are_told_apart() {
        for line in ["#1=5", "X[#1]", "X#1", "WHILE[1]", "GOTO 10", "if"] {
            assert!(pieces(line).iter().any(|(kind, _)| *kind == Kind::Macro), "{line}");
        }
    }

    #[test]
    fn a_remark_that_is_not_closed_is_refused() {
        assert_eq!(cut(b"G1 (X5", &mut Vec::new()), Err(Unclosed { at: 3 }));
    }
}
