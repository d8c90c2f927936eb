//! Reading 3B: blocks with their place, one at a time, the program never held.
//!
//! A block is recognised by its whole pattern B-B-B-G-Z; white space is free within it, a number may be left out, letters
//! may be small, and blocks may run on without a line end. Around blocks stand stop words, `%`, line numbers (`N 12:`),
//! comments (`; …`, `( … )`, rows of `*`) and header lines (`Start Point = …`). What is none of these is an error with
//! its place: nothing a file says is skipped in silence. 4B blocks are recognised and refused; reading them is not here.

use std::io::{self, BufRead};

use super::{Axis, Block, COUNT_MAX, Motion, Quadrant};
use crate::formats::ReadError;
use crate::geometry::Sense;
use crate::interpolator::{COORDINATE_MAX, Model};
use crate::place::{Place, Spot};
use crate::units::Micrometres;

/// The longest line that is held; a longer one is an error, not a buffer, unless it is of blocks that run together.
pub const LINE_BYTES_MAX: usize = 65_536;

/// The longest a block's own text may be, white space aside.
const BLOCK_BYTES_MAX: usize = 200;

/// Something of a 3B program.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A block; its text is in [`Reader::text`].
    Block(Block),
    /// `DD`, `D` or `E`.
    StopWord(&'static str),
}

/// Reads a 3B program item by item.
#[derive(Debug)]
pub struct Reader<R> {
    input: R,
    /// The line in work, or a piece of a long one.
    line: Vec<u8>,
    /// What was read of a long line beyond the piece in work.
    rest: Vec<u8>,
    line_number: u64,
    /// Columns of the line before the piece in work.
    line_column: u64,
    line_byte: u64,
    at: usize,
    text: Vec<u8>,
    begun: Spot,
    ended_by: Option<&'static str>,
}

impl<R: BufRead> Reader<R> {
    /// A reader at the start of a program.
    pub fn new(input: R) -> Self {
        Self {
            input,
            line: Vec::new(),
            rest: Vec::new(),
            line_number: 0,
            line_column: 0,
            line_byte: 0,
            at: 0,
            text: Vec::new(),
            begun: Spot::default(),
            ended_by: None,
        }
    }

    /// The text of the block just read, as it stands in the source without white space, in capitals.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// Where what was just read begins.
    #[must_use]
    pub fn spot(&self) -> Spot {
        self.begun
    }

    /// The next block or stop word; none at the end of the source.
    ///
    /// # Errors
    ///
    /// With the place of the first thing that is not 3B, or of a block no control can run.
    pub fn next_item(&mut self) -> Result<Option<Item>, ReadError> {
        loop {
            let Some(&byte) = self.line.get(self.at) else {
                if self.next_line()? {
                    continue;
                }
                return Ok(None);
            };
            self.begun = Spot {
                byte: self.line_byte + self.at as u64,
                line: self.line_number,
                column: self.line_column + self.at as u64 + 1,
            };
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' | 0 | 0x1A => self.at += 1,
                // A UTF-8 byte order mark, as editors leave it.
                0xEF if self.line_number == 1 && self.at == 0 && self.line.starts_with(b"\xEF\xBB\xBF") => {
                    self.at = 3
                }
                b'%' => self.at += 1,
                b';' => self.at = self.line.len(),
                b'*' => self.row_of_stars()?,
                b'(' => {
                    self.at = self.line[self.at..]
                        .iter()
                        .position(|&b| b == b')')
                        .map_or(self.line.len(), |n| self.at + n + 1);
                }
                b'N' | b'n' if self.skip_line_number() => {}
                b'B' | b'b' if self.block_follows() => return self.block().map(Some),
                b'D' | b'd' | b'E' | b'e' => match self.stop_word() {
                    Some(word) => {
                        if word != "D" {
                            self.ended_by = Some(word);
                        }
                        return Ok(Some(Item::StopWord(word)));
                    }
                    None => self.header()?,
                },
                _ => self.header()?,
            }
        }
    }

    /// Reads the next line into `line`, or of a longer one the next blocks that run together; false at the end.
    fn next_line(&mut self) -> Result<bool, ReadError> {
        self.line_byte += self.line.len() as u64;
        let continues = !self.line.is_empty() && !self.line.ends_with(b"\n");
        if continues {
            self.line_column += self.line.len() as u64;
        } else {
            self.line_number += 1;
            self.line_column = 0;
        }
        self.line.clear();
        self.line.append(&mut self.rest);
        self.at = 0;
        let room = (LINE_BYTES_MAX + 1 - self.line.len()) as u64;
        let read = io::Read::take(&mut self.input, room).read_until(b'\n', &mut self.line)?;
        if self.line.len() > LINE_BYTES_MAX {
            let Some(cut) = end_of_last_block(&self.line) else {
                return Err(self.error(
                    LINE_BYTES_MAX,
                    1,
                    format!("the line is longer than {LINE_BYTES_MAX} bytes and not of blocks alone"),
                    "break it; only blocks may run together at any length",
                ));
            };
            self.rest = self.line.split_off(cut);
        }
        Ok(read > 0 || !self.line.is_empty())
    }

    fn error(&self, at: usize, width: usize, message: impl Into<String>, help: &'static str) -> ReadError {
        ReadError::Program { message: message.into(), place: self.place(at, width), help: help.into() }
    }

    fn place(&self, at: usize, width: usize) -> Place {
        let line = self.line.strip_suffix(b"\n").unwrap_or(&self.line);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        let mut place = Place::in_line(line, self.line_number, self.line_byte, at.min(line.len()), width);
        place.column += self.line_column;
        place
    }

    /// Skips `N 12:` of a listing.
    fn skip_line_number(&mut self) -> bool {
        let rest = &self.line[self.at + 1..];
        let digits = rest.iter().take_while(|b| b.is_ascii_digit() || **b == b' ').count();
        if rest[..digits].iter().any(u8::is_ascii_digit) && rest.get(digits) == Some(&b':') {
            self.at += digits + 2;
            return true;
        }
        false
    }

    /// Whether the B here opens a block: a number or another B comes after it.
    fn block_follows(&self) -> bool {
        let next = self.line[self.at + 1..].iter().find(|b| !b.is_ascii_whitespace());
        next.is_none_or(|&b| {
            b.is_ascii_digit() || b == b'B' || b == b'b' || b == b'-' || b == b'+' || b == b'.'
        })
    }

    fn stop_word(&mut self) -> Option<&'static str> {
        let rest = &self.line[self.at..];
        let word = ["DD", "D", "E"].into_iter().find(|word| {
            let Some((start, after)) = rest.split_at_checked(word.len()) else { return false };
            let ends = matches!(
                after.first(),
                None | Some(b' ' | b'\t' | b'\r' | b'\n' | b';' | b'(' | b'%' | b'B' | b'b' | 0 | 0x1A)
            );
            start.eq_ignore_ascii_case(word.as_bytes()) && ends
        })?;
        self.at += word.len();
        Some(word)
    }

    /// A row of stars, with or without words between them; a block among them is not decoration.
    fn row_of_stars(&mut self) -> Result<(), ReadError> {
        let rest = self.line[self.at..].trim_ascii_end();
        if holds_block_pattern(rest) {
            return Err(self.error(
                self.at,
                rest.len(),
                "a block behind a `*`",
                "put remarks in ( ) or after ;",
            ));
        }
        self.at = self.line.len();
        Ok(())
    }

    /// A line of words: kept out of the program if it is a header, else an error.
    fn header(&mut self) -> Result<(), ReadError> {
        let rest = self.line[self.at..].trim_ascii_end();
        let words = rest.split(|&b| b == b';' || b == b'(').next().unwrap_or_default();
        if !words.contains(&b'=') || holds_block_pattern(words) {
            return Err(self.error(
                self.at,
                rest.len(),
                "neither a 3B block nor a comment",
                "a block is `B X B Y B J G Z`, such as B579B6617B006617GYL2; put remarks in ( ) or after ;",
            ));
        }
        self.at = self.line.len();
        Ok(())
    }

    /// The next character of a block that is not white space, over line ends.
    fn peek(&mut self) -> Result<Option<u8>, ReadError> {
        loop {
            match self.line.get(self.at) {
                Some(b' ' | b'\t' | b'\r' | 0) => self.at += 1,
                Some(b'\n') | None => {
                    // The end of the line is looked past only if there is a next one, so that an error has a place.
                    if self.rest.is_empty() && self.input.fill_buf()?.is_empty() {
                        return Ok(None);
                    }
                    self.next_line()?;
                }
                Some(&byte) => return Ok(Some(byte.to_ascii_uppercase())),
            }
        }
    }

    /// Takes a character of the block into its text.
    fn take(&mut self, byte: u8) {
        self.text.push(byte);
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
            if value > largest || self.text.len() > BLOCK_BYTES_MAX {
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

    fn block(&mut self) -> Result<Item, ReadError> {
        self.text.clear();
        let (first_line, at) = (self.line_number, self.at);
        if let Some(word) = self.ended_by {
            return Err(self.error(
                self.at,
                1,
                format!("a block after the stop word {word}"),
                "the control stops at the stop word; put one program in one file",
            ));
        }
        let pattern = "a 3B block is `B X B Y B J G Z`, such as B579B6617B006617GYL2";
        let mut numbers = [0; 3];
        for (n, name, largest) in [(0, "X", COORDINATE_MAX), (1, "Y", COORDINATE_MAX), (2, "J", COUNT_MAX.0)]
        {
            self.expect("B", |b| b == b'B', pattern)?;
            numbers[n] = self.number(name, largest)?;
        }
        if self.peek()? == Some(b'B') {
            return Err(self.error(
                self.at,
                1,
                "a fourth B: this is a 4B block, and only 3B is read here",
                "convert the program to 3B with the wire's offset in its numbers",
            ));
        }
        if self.peek()? == Some(b'G') {
            self.take(b'G');
        }
        let g = self.expect("the counting axis GX or GY", |b| b == b'X' || b == b'Y', pattern)?;
        let g = if g == b'X' { Axis::X } else { Axis::Y };
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
        Model::Rotated.displacement(&block).map_err(|fault| {
            // A block over several lines is shown by its last one.
            let (from, width) =
                if first_line == self.line_number { (at, self.at - at) } else { (0, self.at) };
            ReadError::Program {
                message: fault.to_string(),
                place: self.place(from, width),
                help: "no control can run this block to its end; check G and the digit of Z".into(),
            }
        })?;
        Ok(Item::Block(block))
    }
}

/// Where the last whole block of a piece of line ends, if the piece is of blocks alone.
fn end_of_last_block(piece: &[u8]) -> Option<usize> {
    if piece.iter().any(|byte| matches!(byte, b';' | b'(' | b'*' | b'=' | b'%')) {
        return None;
    }
    let ends = |pair: &[u8]| matches!(pair, [b'L' | b'l' | b'R' | b'r', b'1'..=b'4']);
    piece.windows(2).rposition(ends).map(|at| at + 2)
}

/// Whether words hold three B with nothing but digits and blanks between them: a block, whatever stands around it.
fn holds_block_pattern(words: &[u8]) -> bool {
    let mut found = 0;
    for byte in words {
        match byte {
            b'B' | b'b' => found += 1,
            b'0'..=b'9' | b' ' | b'\t' => {}
            _ => found = 0,
        }
        if found == 3 {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Position;

    fn read(text: &str) -> Result<Vec<(Item, String)>, ReadError> {
        let mut reader = Reader::new(text.as_bytes());
        let mut items = Vec::new();
        while let Some(item) = reader.next_item()? {
            items.push((item, String::from_utf8(reader.text().to_vec()).unwrap()));
        }
        Ok(items)
    }

    fn texts(text: &str) -> Vec<String> {
        let blocks = read(text).unwrap().into_iter();
        blocks.filter(|(item, _)| matches!(item, Item::Block(_))).map(|(_, text)| text).collect()
    }

    fn refusal(text: &str) -> (String, u64, u64) {
        match read(text).unwrap_err() {
            ReadError::Program { message, place, .. } => (message, place.line, place.column),
            ReadError::Io(error) => panic!("{error}"),
        }
    }

    #[test]
    fn a_program_run_together_is_read_block_by_block() {
        let trade = "B9900B0B9900GXL1B9900B0B39600GYNR1B9900B0B9900GXL3";
        assert_eq!(texts(trade), ["B9900B0B9900GXL1", "B9900B0B39600GYNR1", "B9900B0B9900GXL3"]);
    }

    #[test]
    fn numbers_may_be_left_out_letters_small_and_white_space_free() {
        assert_eq!(texts("bbb9900gxl1"), ["BBB9900GXL1"]);
        assert_eq!(texts("B579 B6617\n  B006617 Y\tL2\r\n"), ["B579B6617B006617YL2"]);
        let (item, _) = read("B B B500 G Y L2").unwrap().remove(0);
        assert_eq!(
            item,
            Item::Block(Block { x: Micrometres(0), y: Micrometres(0), ..Block::line(Position::new(0, 500)) })
        );
    }

    #[test]
    fn a_cam_listing_is_read_past_its_numbers_columns_and_headers() {
        let listing = "***********\nStart Point = 0.00000, 0.00000 ; X , Y\nBlock B12 = none\n\
            N   1: B 5000 B 0 B 5000 GX L1 ; 5.000, 0.000\nN   2: B 0 B 5000 B 5000 GY L2 ; 5.000, 5.000\nN   3: DD\n%\n";
        assert_eq!(texts(listing), ["B5000B0B5000GXL1", "B0B5000B5000GYL2"]);
        let items = read(listing).unwrap();
        assert_eq!(items.last().unwrap().0, Item::StopWord("DD"));
    }

    #[test]
    fn every_fault_has_its_place_and_says_what_was_expected() {
        let (message, line, column) = refusal("B1B2B000003GXL1\nB100B20B000100GZL1\n");
        assert_eq!(
            (message.as_str(), line, column),
            ("expected the counting axis GX or GY, found `Z`", 2, 16)
        );
        assert_eq!(refusal("B1B2B3GXL5").0, "expected the digit 1, 2, 3 or 4, found `5`");
        assert_eq!(refusal("B1B2B3GXL").0, "expected the digit 1, 2, 3 or 4, found the end of the program");
        assert_eq!(refusal("B1B-2B3GXL1").2, 4);
        assert!(refusal("B1B2B3B4DGXL1").0.contains("4B"));
        assert!(refusal("hello world").0.contains("neither"));
        assert!(refusal("B0B0B500GYL1").0.contains("never"));
        assert!(refusal("B1B0B1GXL1 DD B1B0B1GXL1").0.contains("after the stop word"));
        assert!(refusal("B99999999999B0B1GXL1").0.contains("larger"));
        assert!(refusal("B1000000B0B1000000GXL1").0.contains("J is larger than 999999"));
        assert!(refusal(&format!("B{}B0B1GXL1", "0".repeat(500))).0.contains("too many zeros"));
        assert!(refusal(&"B".repeat(70_000)).0.contains("longer"));
        let long = "B9900B0B9900GXL1B9900B0B39600GYNR1".repeat(5000) + "B1B2Q";
        assert_eq!(texts(&long[..long.len() - 5]).len(), 10_000);
        let (_, line, column) = refusal(&long);
        assert_eq!((line, column), (1, 34 * 5000 + 5));
    }

    #[test]
    fn a_block_behind_a_percent_sign_or_a_wrong_letter_is_not_skipped() {
        assert_eq!(texts("%B7B0B7GXL1\n%\n"), ["B7B0B7GXL1"]);
        assert!(refusal("C5000B0B5000GXL1 ; X = 5\n").0.contains("neither"));
        assert!(refusal("X = B1B2B3GXL1\n").0.contains("neither"));
        assert!(refusal("% O1234\n").0.contains("neither"));
        assert!(refusal("** B9900B0B39600GYNR1 **\n").0.contains("behind a `*`"));
        assert_eq!(texts("\u{feff}B7B0B7GXL1DB1B0B1GXL1\nDD\n\x1a"), ["B7B0B7GXL1", "B1B0B1GXL1"]);
    }

    #[test]
    fn random_bytes_are_refused_or_read_but_never_panic() {
        let mut state = 0x9E37_79B9_7F4A_7C15u64;
        let alphabet = b"BBBB0123456789GXYLSRND E;%(=*\n\r\t\0-.\xff\x80";
        for _ in 0..20_000 {
            let mut bytes = Vec::new();
            for _ in 0..40 {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                bytes.push(alphabet[(state >> 33) as usize % alphabet.len()]);
            }
            let mut reader = Reader::new(&bytes[..]);
            while let Ok(Some(_)) = reader.next_item() {}
        }
    }
}
