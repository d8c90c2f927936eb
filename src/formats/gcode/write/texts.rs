//! What is written as it was read: remarks, headers, and words that are kept.
//!
//! A word is put into a block only where the dialect reads it as a word that is kept or not known. One that would move the wire,
//! set a register or tilt the wire there came from another dialect and stands in a remark, and is counted among the losses.

use super::{Writer, refused};
use crate::formats::WriteError;
use crate::formats::gcode::dialect::{Code, I, J, LongWord, Role};
use crate::formats::gcode::words::{self, Kind, Word};
use crate::motion::Motion;

/// What a text would be in a block of the dialect.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Read {
    /// What it was: text that is kept.
    Kept,
    /// The same, in a line of its own alone.
    Alone,
    /// Something else.
    Otherwise,
}

impl Writer {
    /// `%`, the word that names a program, a skip or a number of the next block; any other header becomes a remark.
    pub(super) fn header(&mut self, header: &[u8], motion: &Motion, text: &mut Vec<u8>) {
        // Listings of 3B write `N 12:`.
        let header = header.strip_suffix(b":").unwrap_or(header);
        let digits = header.get(1..).unwrap_or_default().trim_ascii();
        let is_number = (1..=18).contains(&digits.len()) && digits.iter().all(u8::is_ascii_digit);
        match header.first().copied() {
            Some(b'/') if header.len() <= 2 && !self.is_ended => {
                self.settle(text);
                self.skip = header.to_vec();
                self.waiting_for = (motion.block, motion.spot.line);
            }
            Some(b'N' | b'n') if is_number && !self.is_ended => {
                self.flush(text);
                if !self.number.is_empty() {
                    self.settle(text);
                }
                self.number = [b"N", digits].concat();
                self.waiting_for = (motion.block, motion.spot.line);
            }
            Some(b'%') => {
                self.settle(text);
                if self.is_opened && !self.is_ended {
                    self.end(text);
                }
                text.extend(header.iter().filter(|b| !matches!(b, b'\r' | b'\n')));
                self.end_line(text);
            }
            Some(letter)
                if is_number
                    && self.dialect.names_program(letter.to_ascii_uppercase())
                    && !self.is_opened =>
            {
                self.settle(text);
                text.extend_from_slice(header);
                self.end_line(text);
            }
            _ => {
                self.flush(text);
                self.losses.add("header line", motion.spot);
                self.remark(header, text);
            }
        }
    }

    pub(super) fn comment(
        &mut self,
        remark: &[u8],
        motion: &Motion,
        text: &mut Vec<u8>,
    ) -> Result<(), WriteError> {
        if !(self.dialect.brackets || self.dialect.semicolon) {
            let help = "a dialect file allows them with `brackets` or `semicolon`";
            return Err(refused(motion.spot, "the dialect has no remarks", help));
        }
        let bracketed =
            self.dialect.brackets && !remark.iter().any(|b| matches!(b, b'(' | b')' | b'\r' | b'\n'));
        let comes_from = (motion.block, motion.spot.line);
        let is_of_line = !self.line.is_empty() && (self.line_block, self.line_of) == comes_from;
        if bracketed && (is_of_line || !self.number.is_empty() && self.waiting_for == comes_from) {
            self.tail.extend_from_slice(b" (");
            self.tail.extend_from_slice(remark);
            self.tail.push(b')');
            return Ok(());
        }
        self.flush(text);
        if !self.dialect.semicolon && remark.contains(&b')') {
            let help = "take the bracket out of the remark";
            return Err(refused(
                motion.spot,
                "a remark with a bracket, and the dialect has only brackets",
                help,
            ));
        }
        self.remark(remark, text);
        Ok(())
    }

    /// A remark on lines of its own.
    pub(super) fn remark(&self, remark: &[u8], text: &mut Vec<u8>) {
        for line in remark.split(|b| matches!(b, b'\n' | b'\r')) {
            if self.dialect.brackets && !line.iter().any(|b| matches!(b, b'(' | b')')) {
                text.push(b'(');
                text.extend_from_slice(line);
                text.push(b')');
            } else {
                text.push(b';');
                text.extend_from_slice(line);
            }
            self.end_line(text);
        }
    }

    /// A word that is kept as it stands.
    pub(super) fn word(
        &mut self,
        word: &[u8],
        motion: &Motion,
        text: &mut Vec<u8>,
    ) -> Result<(), WriteError> {
        // A line end within would make two blocks of it.
        let word: Vec<u8> = word.iter().map(|b| if matches!(b, b'\n' | b'\r') { b' ' } else { *b }).collect();
        let read = if self.is_ended { Read::Otherwise } else { self.read_again(&word) };
        if read == Read::Otherwise {
            self.losses.add("foreign word", motion.spot);
            return self.comment(&word, motion, text);
        }
        self.open(text);
        // What begins with no letter could be taken for the number of the word before it.
        let clings = !word.first().is_some_and(u8::is_ascii_alphabetic);
        if motion.block != self.line_block || self.line_is_path || read == Read::Alone || clings {
            self.flush(text);
        }
        self.put(&word, motion.block, false);
        self.line_is_full = read == Read::Alone;
        Ok(())
    }

    /// What the dialect would read in a text.
    fn read_again(&self, text: &[u8]) -> Read {
        let mut words = Vec::new();
        if words::cut(text, &mut words).is_err() || words.is_empty() {
            return Read::Otherwise;
        }
        let mut read = Read::Kept;
        let mut owned = None;
        let is_heights = self.dialect.heights && self.code(&words[0]) == Some(Code::Position);
        for (n, word) in words.iter().enumerate() {
            if owned == Some(word.letter) {
                continue;
            }
            owned = self.dialect.argument(word).or(owned);
            match self.piece(word, text) {
                _ if is_heights && (n == 0 || self.is_height(word)) => read = Read::Alone,
                Read::Kept => {}
                Read::Alone if words.len() == 1 => read = Read::Alone,
                Read::Alone | Read::Otherwise => return Read::Otherwise,
            }
        }
        read
    }

    fn piece(&self, word: &Word, text: &[u8]) -> Read {
        let letter = word.text(text).first().map_or(0, u8::to_ascii_uppercase);
        match word.kind {
            Kind::Word => match (self.code(word), self.dialect.role(word.letter)) {
                (Some(Code::Kept | Code::Frame(_)), _) => Read::Kept,
                (Some(Code::Unknown), _) if word.letter == b'M' => Read::Kept,
                // Beside axes it would be refused.
                (Some(Code::Unknown), _) => Read::Alone,
                (Some(_), _) => Read::Otherwise,
                (None, Role::Kept | Role::Feed) => Read::Kept,
                (None, Role::Unknown) if !self.dialect.names_program(word.letter) => Read::Kept,
                (None, Role::Length(_)) if self.dialect.lone_j && word.letter == b'J' => Read::Alone,
                (None, _) => Read::Otherwise,
            },
            Kind::Unknown => match self.dialect.long_word(word.text(text)) {
                LongWord::Kept | LongWord::Unknown => Read::Kept,
                LongWord::Refused | LongWord::Command => Read::Otherwise,
            },
            Kind::Assignment if self.dialect.assignments && self.dialect.register == Some(letter) => {
                Read::Otherwise
            }
            Kind::Assignment => Read::Alone,
            Kind::Colon if !self.dialect.pairs => Read::Kept,
            Kind::Colon | Kind::Comment | Kind::Skip | Kind::Percent | Kind::Macro => Read::Otherwise,
        }
    }

    fn code(&self, word: &Word) -> Option<Code> {
        match word.letter {
            b'G' => Some(self.dialect.g_code(word)),
            b'M' => Some(self.dialect.m_code(word)),
            _ => None,
        }
    }

    fn is_height(&self, word: &Word) -> bool {
        let Role::Length(place) = self.dialect.role(word.letter) else { return false };
        [I, J].contains(&usize::from(place))
    }
}

#[cfg(test)]
mod tests {
    use crate::formats::Writer as _;
    use crate::formats::gcode::{Dialect, Layout, Writer};
    use crate::geometry::{Element, Point};
    use crate::motion::{Act, Motion, Offset, Side, Travel};
    use crate::place::Spot;

    fn text(s: &str) -> Box<[u8]> {
        s.as_bytes().into()
    }

    fn line(x: f64) -> Act {
        let (start, end) = (Point::new(x - 1.0, 0.0), Point::new(x, 0.0));
        Act::Move { travel: Travel::Cut, element: Element::Line { start, end }, upper: None, flag: None }
    }

    /// What a dialect writes of acts, each with its block, and the kinds of what became a remark.
    fn written(dialect: &str, layout: Layout, acts: Vec<(u64, Act)>) -> (String, Vec<&'static str>) {
        let mut writer = Writer::with_layout(Dialect::named(dialect).unwrap().unwrap(), layout);
        let mut out = Vec::new();
        for (block, act) in acts {
            let spot = Spot { line: block, ..Spot::default() };
            writer.write(&Motion { act, block, spot }, &mut out).unwrap();
        }
        writer.finish(&mut out).unwrap();
        (String::from_utf8(out).unwrap(), writer.lost().iter().map(|l| l.kind).collect())
    }

    #[test]
    fn a_word_that_means_something_else_there_becomes_a_remark() {
        let acts = || {
            ["T84", "S3", "L0.5", "G60", "#1", "%", "G92 I30. J0.", "H1=5", "@!"]
                .into_iter()
                .map(|word| (1, Act::Word(text(word))))
                .chain([(2, line(1.0))])
                .collect()
        };
        let (fanuc, lost) = written("fanuc", Layout::default(), acts());
        let expected = "(T84)\nG21 G90\nS3 (L0.5)\nG60\n(#1)\n(%)\n(G92 I30. J0.)\nH1=5\n@!\n\
                        G92 X0.000 Y0.000\nG01 X1.000 Y0.000\nM02\n";
        assert_eq!(fanuc, expected, "T is a taper, L a centre");
        assert_eq!(lost, ["foreign word"]);
        let (sodick, _) = written("sodick", Layout::default(), acts());
        assert!(sodick.contains("\nT84 S3") || sodick.contains("\nT84\n"), "{sodick}");
        assert!(sodick.contains("(H1=5)"), "it would set a register: {sodick}");
        let (charmilles, _) = written("charmilles", Layout::default(), acts());
        assert!(charmilles.contains("\nG92 I30. J0.\r\n"), "{charmilles}");
    }

    #[test]
    fn numbers_skips_and_remarks_stay_with_their_block() {
        let acts = vec![
            (1, Act::Header(text("N 10:"))),
            (1, Act::Comment(text("nothing but this"))),
            (2, line(1.0)),
            (3, Act::Header(text("/"))),
            (3, Act::Header(text("N30"))),
            (3, Act::Comment(text("behind"))),
            (3, line(2.0)),
            (4, Act::Comment(text("by itself"))),
            (5, Act::Header(text("Start Point = 0, 0"))),
        ];
        let (told, lost) = written("generic", Layout::default(), acts);
        let expected = "N10 G21 G90 (nothing but this)\nG92 X0.000 Y0.000\nG01 X1.000 Y0.000\n\
                        /N30 G01 X2.000 Y0.000 (behind)\n(by itself)\n(Start Point = 0, 0)\nM02\n";
        assert_eq!(told, expected);
        assert_eq!(lost, ["header line"]);
    }

    #[test]
    fn an_offset_that_is_a_number_is_keyed_into_a_named_register_or_refused() {
        let offset = Offset::On { side: Side::Left, distance: Some(0.11), register: None };
        let acts = || vec![(1, Act::Offset(offset)), (2, line(1.0))];
        let layout = Layout { register: Some(3), ..Layout::default() };
        let expected = "G21 G90\n(D3 = 0.110 MM)\nG92 X0.000 Y0.000\nG41 D3 G01 X1.000 Y0.000\nM02\n";
        assert_eq!(written("generic", layout, acts()).0, expected);
        let mut writer = Writer::new(Dialect::generic().unwrap());
        let motion = Motion { act: Act::Offset(offset), block: 1, spot: Spot::default() };
        let refused = writer.write(&motion, &mut Vec::new()).unwrap_err();
        assert_eq!(refused.message, "the dialect has no word for this offset");
        assert!(written("integer-um", Layout::default(), acts()).0.contains("G41 D110 G01"));
        assert!(written("mitsubishi", Layout::default(), acts()).0.contains("H1=0.110\n"));
    }
}
