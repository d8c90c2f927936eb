//! A block character by character, over blanks and line ends, with an error for whatever is not one.

use std::io;

use super::{Beyond, Grammar, Reader, Text};
use crate::formats::ReadError;
use crate::formats::four_b::{Fourth, Ratio};
use crate::formats::three_b::{Axis, Block, COUNT_MAX, Motion, Quadrant};
use crate::geometry::Sense;
use crate::interpolator::{COORDINATE_MAX, Model};
use crate::motion::Flag;
use crate::units::Micrometres;

/// The longest that a block's numbers may be with their B, white space aside.
const BLOCK_BYTES_MAX: usize = 200;

impl<R: io::Read> Reader<R> {
    /// The block that begins here.
    pub(super) fn block(&mut self) -> Result<Block, ReadError> {
        self.spelled.clear();
        self.text = Text::Spelled;
        self.beyond = Beyond::default();
        let (first_line, at) = (self.pieces.line(), self.at);
        if let Some(word) = self.ended_by {
            return Err(self.error(
                self.at,
                1,
                format!("a block after the stop word {word}"),
                "the control stops at the stop word; put one program in one file",
            ));
        }
        let pattern = self.pattern();
        let mut numbers = [0; 3];
        for (n, name, largest) in [(0, "X", COORDINATE_MAX), (1, "Y", COORDINATE_MAX), (2, "J", COUNT_MAX.0)]
        {
            self.expect("B", |b| b == b'B', pattern)?;
            numbers[n] = self.number(name, largest)?;
        }
        match self.peek()? {
            Some(b'B') => self.fourth()?,
            // Whether a ratio stands behind a fourth B or in its place, the paper leaves open.
            Some(b'L') if self.grammar == Grammar::FourB => self.taper_ratio()?,
            Some(_) | None => {}
        }
        self.flag()?;
        let g_letter = self.peek()? == Some(b'G');
        if g_letter {
            self.take(b'G');
        }
        let g = self.expect("the counting axis GX or GY", |b| b == b'X' || b == b'Y', pattern)?;
        let g = if g == b'X' { Axis::X } else { Axis::Y };
        self.flag()?;
        let z = "L1-L4, SR1-SR4 or NR1-NR4";
        let letter = self.expect(z, |b| matches!(b, b'L' | b'S' | b'N'), pattern)?;
        if letter != b'L' {
            self.expect("R", |b| b == b'R', pattern)?;
        }
        let digit = self.expect("the digit 1, 2, 3 or 4", |b| (b'1'..=b'4').contains(&b), pattern)?;
        let Some(quadrant) = Quadrant::from_digit(digit) else { unreachable!("the digit was accepted") };
        let motion = match letter {
            b'L' => Motion::Line(quadrant),
            b'S' => Motion::Arc(Sense::Clockwise, quadrant),
            _ => Motion::Arc(Sense::CounterClockwise, quadrant),
        };
        let [x, y, j] = numbers.map(Micrometres);
        let block = Block { x, y, j, g, motion };
        // A block over several lines is shown by its last one.
        let (from, width) = if first_line == self.pieces.line() { (at, self.at - at) } else { (0, self.at) };
        Model::Rotated.displacement(&block).map_err(|fault| {
            let help = "no control can run this block to its end; check G and the digit of Z";
            self.error(from, width, fault.to_string(), help)
        })?;
        if let Err(wrong) = self.beyond.fits(&block) {
            return Err(self.error(from, width, wrong.message, wrong.help));
        }
        Ok(block)
    }

    fn pattern(&self) -> &'static str {
        match self.grammar {
            Grammar::ThreeB => "a 3B block is `B X B Y B J G Z`, such as B579B6617B006617GYL2",
            Grammar::FourB => "a 4B block is `B X B Y B J B R D|DD G Z`, such as B0B5000B010000B5000DGXNR2",
        }
    }

    /// The fourth B and its radius or ratio.
    fn fourth(&mut self) -> Result<(), ReadError> {
        if self.grammar == Grammar::ThreeB {
            return Err(self.error(
                self.at,
                1,
                "a fourth B: this is a 4B block, and only 3B is read here",
                "convert the program to 3B with the wire's offset in its numbers",
            ));
        }
        self.take(b'B');
        if self.peek()? == Some(b'L') {
            return self.taper_ratio();
        }
        let from = self.spelled.len();
        let radius = self.number("R", COORDINATE_MAX)?;
        if self.spelled.len() > from {
            self.beyond.fourth = Some(Fourth::Radius(Micrometres(radius)));
        }
        Ok(())
    }

    /// `L` and a ratio of taper: decimal digits, with or without a point.
    fn taper_ratio(&mut self) -> Result<(), ReadError> {
        self.take(b'L');
        let from = self.spelled.len();
        while let Some(byte) = self.peek()? {
            let taken = self.spelled.get(from..).unwrap_or_default();
            let point = byte == b'.' && !taken.contains(&b'.');
            if !(point || byte.is_ascii_digit()) || taken.len() > Ratio::BYTES_MAX {
                break;
            }
            self.take(byte);
        }
        let taken = self.spelled.get(from..).unwrap_or_default();
        let Some(ratio) = Ratio::parse(taken) else {
            let help = "the ratio is written like L0.5: up to eight digits and six decimals";
            return Err(self.error(self.at, 1, "L without a ratio of taper", help));
        };
        self.beyond.fourth = Some(Fourth::Ratio(ratio));
        Ok(())
    }

    /// The flag, if one stands here.
    fn flag(&mut self) -> Result<(), ReadError> {
        if self.grammar == Grammar::ThreeB || self.peek()? != Some(b'D') {
            return Ok(());
        }
        if self.beyond.flag.is_some() {
            return Err(self.error(
                self.at,
                1,
                "a second flag in one block",
                "the flag stands once, before or behind G",
            ));
        }
        self.take(b'D');
        self.beyond.flag = Some(Flag::D);
        if self.peek()? == Some(b'D') {
            self.take(b'D');
            self.beyond.flag = Some(Flag::DD);
        }
        Ok(())
    }

    /// The next character of a block that is not white space, over line ends.
    fn peek(&mut self) -> Result<Option<u8>, ReadError> {
        loop {
            match self.pieces.piece().get(self.at) {
                Some(b' ' | b'\t' | b'\r' | 0) => self.at += 1,
                Some(b'\n') | None => {
                    // The end of the line is looked past only if there is a next one, so that an error has a place.
                    if !self.pieces.has_more()? {
                        return Ok(None);
                    }
                    self.next_piece()?;
                }
                Some(&byte) => return Ok(Some(byte.to_ascii_uppercase())),
            }
        }
    }

    /// Takes a character of the block into its text.
    fn take(&mut self, byte: u8) {
        self.spelled.push(byte);
        self.at += 1;
    }

    fn number(&mut self, name: &str, largest: i64) -> Result<i64, ReadError> {
        let mut value = 0i64;
        let mut start = None;
        while let Some(byte) = self.peek()? {
            if !byte.is_ascii_digit() {
                if matches!(byte, b'-' | b'+' | b'.' | b',') {
                    return Err(self.error(
                        self.at,
                        1,
                        format!(
                            "{name} holds `{}`: 3B numbers are whole micrometres without sign",
                            byte as char
                        ),
                        "write 6.617 mm as 6617; the direction is in the digit of Z",
                    ));
                }
                break;
            }
            start = start.or(Some(self.at));
            value = value * 10 + i64::from(byte - b'0');
            if value > largest || self.spelled.len() >= BLOCK_BYTES_MAX {
                let from = start.unwrap_or(self.at).min(self.at);
                return Err(self.error(
                    from,
                    self.at + 1 - from,
                    format!("{name} is larger than {largest} µm, or written with too many zeros"),
                    "split the move into shorter blocks",
                ));
            }
            self.take(byte);
        }
        Ok(value)
    }

    fn expect(
        &mut self,
        wanted: &str,
        accept: impl Fn(u8) -> bool,
        help: &'static str,
    ) -> Result<u8, ReadError> {
        match self.peek()? {
            Some(byte) if accept(byte) => {
                self.take(byte);
                Ok(byte)
            }
            Some(byte) => {
                let found = if byte.is_ascii_graphic() {
                    format!("`{}`", byte as char)
                } else {
                    format!("byte {byte:02X}h")
                };
                Err(self.error(self.at, 1, format!("expected {wanted}, found {found}"), help))
            }
            None => {
                Err(self.error(self.at, 0, format!("expected {wanted}, found the end of the program"), help))
            }
        }
    }
}

#[cfg(test)]
mod tests;
