//! A line of G-code: words of a letter and a number, comments apart.
//!
//! `( )` and `;` to the end of the line are comments, a `/` in front marks a line that may be skipped, `:` is read as
//! `O`. Letters may be small and white space is free. A number keeps its decimals and whether it had a point: what it
//! measures depends on words that may come later in the line.
//!
//! Not done here: what the words mean (the control's plan).
//!
//! The grammar is this crate's own reading, from domain/4 and the common usage of wire-EDM controls; six decimals and
//! twelve digits are a choice, more than any control takes.

use std::fmt;

/// One line of a program.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Line {
    /// Its number in the text, from 1.
    pub place: u64,
    /// It began with `/`.
    pub may_be_skipped: bool,
    /// Its words, in order; `N` is among them.
    pub words: Vec<Word>,
}

/// A letter and its number.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Word {
    /// The letter, a capital.
    pub letter: char,
    /// What follows it.
    pub number: Number,
}

/// A decimal number as it was written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Number {
    /// All digits as one whole number, with the sign.
    pub digits: i64,
    /// How many of them stand behind the point.
    pub decimals: u32,
    /// Whether a point was written.
    pub has_point: bool,
}

impl Number {
    /// The number where it is whole.
    #[must_use]
    pub fn whole(&self) -> Option<i64> {
        let unit = 10_i64.pow(self.decimals);
        (self.digits % unit == 0).then_some(self.digits / unit)
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Number { digits, decimals, has_point } = self.number;
        let sign = if digits < 0 { "-" } else { "" };
        let text = format!("{:0width$}", digits.unsigned_abs(), width = decimals as usize + 1);
        let (whole, behind) = text.split_at(text.len() - decimals as usize);
        // G and M codes have two digits on every panel.
        let padding = if matches!(self.letter, 'G' | 'M') && whole.len() < 2 { "0" } else { "" };
        let point = if has_point { "." } else { "" };
        write!(f, "{}{sign}{padding}{whole}{point}{behind}", self.letter)
    }
}

/// Why a text is no line of words.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct NotWords {
    /// Where, from 1.
    pub column: usize,
    /// What should be there.
    pub expected: &'static str,
    /// What is; `None`: the line ended.
    pub found: Option<char>,
}

impl fmt::Display for NotWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.found {
            Some(found) => {
                write!(f, "column {}: expected {}, found {found:?}", self.column, self.expected)
            }
            None => {
                write!(f, "column {}: expected {}, but the line ended", self.column, self.expected)
            }
        }
    }
}

impl std::error::Error for NotWords {}

/// Reads one line.
///
/// # Errors
///
/// [`NotWords`] when something in it is neither word nor comment.
pub fn parse_line(text: &str, place: u64) -> Result<Line, NotWords> {
    let mut line = Line { place, ..Line::default() };
    let mut rest = Rest { characters: text.chars().collect(), at: 0 };
    while let Some(c) = rest.next_word()? {
        match c.to_ascii_uppercase() {
            '/' if line.words.is_empty() && !line.may_be_skipped => line.may_be_skipped = true,
            ':' => line.words.push(Word { letter: 'O', number: rest.number()? }),
            letter @ 'A'..='Z' => line.words.push(Word { letter, number: rest.number()? }),
            _ => {
                rest.at -= 1;
                return Err(rest.not("a letter"));
            }
        }
    }
    Ok(line)
}

/// What has not been read of a line.
struct Rest {
    characters: Vec<char>,
    at: usize,
}

impl Rest {
    fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    fn take(&mut self, wanted: impl Fn(char) -> bool) -> Option<char> {
        let c = self.peek().filter(|&c| wanted(c))?;
        self.at += 1;
        Some(c)
    }

    fn not(&self, expected: &'static str) -> NotWords {
        NotWords { column: self.at + 1, expected, found: self.peek() }
    }

    fn skip_space(&mut self) {
        while self.take(|c| c.is_ascii_whitespace()).is_some() {}
    }

    /// The next character that is neither space nor comment.
    fn next_word(&mut self) -> Result<Option<char>, NotWords> {
        loop {
            self.skip_space();
            match self.take(|_| true) {
                Some(';') => self.at = self.characters.len(),
                Some('(') => {
                    while self.take(|c| c != ')').is_some() {}
                    self.take(|c| c == ')').ok_or_else(|| self.not("a closing )"))?;
                }
                other => return Ok(other),
            }
        }
    }

    fn number(&mut self) -> Result<Number, NotWords> {
        self.skip_space();
        let sign = self.take(|c| matches!(c, '+' | '-'));
        let mut number = Number { digits: 0, decimals: 0, has_point: false };
        let mut count = 0;
        loop {
            if !number.has_point && self.take(|c| c == '.').is_some() {
                number.has_point = true;
                continue;
            }
            let Some(digit) = self.peek().and_then(|c| c.to_digit(10)) else {
                break;
            };
            if count == DIGITS_MAX || number.decimals == DECIMALS_MAX {
                return Err(self.not("at most 12 digits, 6 of them decimals"));
            }
            self.at += 1;
            count += 1;
            number.decimals += u32::from(number.has_point);
            number.digits = number.digits * 10 + i64::from(digit);
        }
        if count == 0 {
            return Err(self.not("a number"));
        }
        if sign == Some('-') {
            number.digits = -number.digits;
        }
        Ok(number)
    }
}

const DIGITS_MAX: u32 = 12;
const DECIMALS_MAX: u32 = 6;

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> String {
        match parse_line(text, 1) {
            Ok(line) => line.words.iter().map(Word::to_string).collect::<Vec<_>>().join(" "),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn words_keep_their_decimals_and_comments_go() {
        assert_eq!(words("n10 g1x-1.50(a) Y .5 F 20 ; the rest"), "N10 G01 X-1.50 Y0.5 F20");
        assert_eq!(words("G01X10.Y-0.001"), "G01 X10. Y-0.001");
        assert_eq!(words(":0012"), "O12");
        assert_eq!(words(" (only a comment)"), "");
        assert!(parse_line("/G00 X1.", 1).unwrap().may_be_skipped);
    }

    #[test]
    fn what_is_neither_word_nor_comment_is_told_with_its_column() {
        assert_eq!(words("G01 X"), "column 6: expected a number, but the line ended");
        assert_eq!(words("G01 X1.2.3"), "column 9: expected a letter, found '.'");
        assert_eq!(words("G01 #1"), "column 5: expected a letter, found '#'");
        assert_eq!(words("X--1"), "column 3: expected a number, found '-'");
        assert_eq!(words("(open"), "column 6: expected a closing ), but the line ended");
        assert_eq!(
            words("X0.1234567"),
            "column 10: expected at most 12 digits, 6 of them decimals, found '7'"
        );
        assert_eq!(words("G1 /X1"), "column 4: expected a letter, found '/'");
    }
}
