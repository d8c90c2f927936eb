//! Reading 3B: blocks with their place, one at a time, the program never held.
//!
//! A block is recognised by its whole pattern B-B-B-G-Z; white space is free within it, a number may be left out, letters
//! may be small, and blocks may run on without a line end. Around blocks stand stop words, `%`, line numbers (`N 12:`),
//! comments (`; …`, `( … )`, rows of `*`) and header lines (`Start Point = …`). What is none of these is an error with
//! its place: nothing a file says is skipped in silence.
//!
//! A block within one line is taken in one go (`quick`); one over several lines, and whatever is wrong, goes character by character (`careful`). 4B is read by [`crate::formats::four_b`] through the same
//! reader; here its blocks are recognised and refused.

mod around;
mod careful;
mod pieces;
mod quick;

use std::io;

use super::{Block, Motion};
use crate::formats::ReadError;
use crate::formats::four_b::{self, Fourth};
use crate::motion::Flag;
use crate::place::{Place, Spot};
use crate::units::Micrometres;

pub use pieces::LINE_BYTES_MAX;
use pieces::Pieces;

/// Something of a 3B program.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A block; its text is in [`Reader::text`].
    Block(Block),
    /// `DD`, `D` or `E`.
    StopWord(&'static str),
}

/// Anything a 3B source says: what goes to the control, and what stands around it.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// What goes to the control.
    Item(Item),
    /// A remark; [`Reader::text`] has it without its brackets or semicolon.
    Comment,
    /// A header line, a row of stars, or `%`; [`Reader::text`] has it as it stands.
    Header,
    /// A line number (`N 12:`); [`Reader::text`] has its digits.
    Number,
}

/// Reads a 3B program item by item.
#[derive(Debug)]
pub struct Reader<R> {
    pieces: Pieces<R>,
    grammar: Grammar,
    /// How much of the piece in work has been read.
    at: usize,
    text: Text,
    /// The block in work, its text without white space, in capitals.
    spelled: Vec<u8>,
    /// What the block just read says beyond 3B.
    beyond: Beyond,
    begun: Spot,
    ended_by: Option<&'static str>,
}

/// Which blocks are read.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Grammar {
    ThreeB,
    /// 3B and 4B mixed.
    FourB,
}

/// Where the text of the last entry is.
#[derive(Clone, Copy, Debug)]
enum Text {
    /// In the piece in work, as it stands.
    AsItStands { from: usize, to: usize },
    /// In [`Reader::spelled`].
    Spelled,
}

/// What a 4B block says beyond 3B.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(in crate::formats) struct Beyond {
    pub(in crate::formats) fourth: Option<Fourth>,
    pub(in crate::formats) flag: Option<Flag>,
}

/// Why a block's flag and radius do not go with the rest of it.
struct Misfit {
    message: &'static str,
    help: &'static str,
}

impl Beyond {
    /// Whether flag and radius go with the block.
    fn fits(self, block: &Block) -> Result<(), Misfit> {
        let arc = matches!(block.motion, Motion::Arc(..));
        match (self.fourth, self.flag) {
            (None, None) => Ok(()),
            (Some(Fourth::Radius(radius)), flag) if arc => {
                if flag.is_none() {
                    return Err(Misfit {
                        message: "an arc with a radius and no flag",
                        help: "write D for a convex arc, DD for a concave one",
                    });
                }
                let (x, y) = (block.x.0 as f64, block.y.0 as f64);
                if ((x * x + y * y).sqrt() - radius.0 as f64).abs() > four_b::RADIUS_TOLERANCE_UM {
                    return Err(Misfit {
                        message: "R is not the radius of the circle through X, Y",
                        help: "R² is X² + Y² on an arc, whose X, Y are its start seen from the centre",
                    });
                }
                Ok(())
            }
            (None | Some(Fourth::Ratio(_)), _) if arc => Err(Misfit {
                message: "an arc with a flag and no radius",
                help: "write the radius of the outline, whole micrometres, behind the fourth B",
            }),
            (Some(Fourth::Radius(Micrometres(0)) | Fourth::Ratio(_)) | None, _) => Ok(()),
            (Some(Fourth::Radius(_)), _) => Err(Misfit {
                message: "a straight line with a radius",
                help: "leave out the number behind the fourth B, or check the letter of Z",
            }),
        }
    }
}

impl<R: io::Read> Reader<R> {
    /// A reader at the start of a program.
    pub fn new(input: R) -> Self {
        Self::of(Grammar::ThreeB, input)
    }

    /// A reader of 3B and 4B mixed.
    pub(in crate::formats) fn of_four_b(input: R) -> Self {
        Self::of(Grammar::FourB, input)
    }

    fn of(grammar: Grammar, input: R) -> Self {
        Self {
            pieces: Pieces::new(input),
            grammar,
            at: 0,
            text: Text::Spelled,
            spelled: Vec::new(),
            beyond: Beyond::default(),
            begun: Spot::default(),
            ended_by: None,
        }
    }

    /// The text of what was just read: of a block as it stands in the source without white space, in capitals.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        match self.text {
            Text::AsItStands { from, to } => self.pieces.piece().get(from..to).unwrap_or_default(),
            Text::Spelled => &self.spelled,
        }
    }

    /// Where what was just read begins.
    #[must_use]
    pub fn spot(&self) -> Spot {
        self.begun
    }

    /// The byte of the source behind what was just read.
    #[must_use]
    pub fn end_byte(&self) -> u64 {
        self.pieces.byte() + self.at as u64
    }

    /// What the block just read says beyond 3B.
    pub(in crate::formats) fn beyond(&self) -> Beyond {
        self.beyond
    }

    /// The next block or stop word; none at the end of the source.
    ///
    /// # Errors
    ///
    /// With the place of the first thing that is not 3B, or of a block no control can run.
    pub fn next_item(&mut self) -> Result<Option<Item>, ReadError> {
        loop {
            match self.next_entry()? {
                Some(Entry::Item(item)) => return Ok(Some(item)),
                Some(Entry::Comment | Entry::Header | Entry::Number) => {}
                None => return Ok(None),
            }
        }
    }

    /// The next thing the source says, of whatever kind; none at its end.
    ///
    /// # Errors
    ///
    /// As [`Reader::next_item`].
    pub fn next_entry(&mut self) -> Result<Option<Entry>, ReadError> {
        loop {
            let Some(&byte) = self.pieces.piece().get(self.at) else {
                if self.next_piece()? {
                    continue;
                }
                return Ok(None);
            };
            if matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0 | 0x1A) {
                self.at += 1;
                continue;
            }
            if matches!(byte, b'B' | b'b')
                && let Some(block) = self.quick()
            {
                return Ok(Some(Entry::Item(Item::Block(block))));
            }
            self.begun = self.spot_at(self.at);
            return self.entry(byte).map(Some);
        }
    }

    /// A block written plainly; none when the careful way has to look at it.
    fn quick(&mut self) -> Option<Block> {
        if self.ended_by.is_some() {
            return None;
        }
        let read = match self.grammar {
            Grammar::ThreeB => quick::block::<false>,
            Grammar::FourB => quick::block::<true>,
        };
        let line = self.pieces.piece().get(self.at..)?;
        let (text, length, (block, beyond)) = match read(line) {
            Some((block, beyond, length)) => {
                (Text::AsItStands { from: self.at, to: self.at + length }, length, (block, beyond))
            }
            None => {
                quick::squeeze(line, &mut self.spelled);
                let (block, beyond, length) = read(&self.spelled)?;
                self.spelled.truncate(length);
                (Text::Spelled, quick::spread(line, length), (block, beyond))
            }
        };
        self.begun = self.spot_at(self.at);
        self.beyond = beyond;
        self.text = text;
        self.at += length;
        Some(block)
    }

    /// Goes on to the next piece; false at the end of the source.
    fn next_piece(&mut self) -> Result<bool, ReadError> {
        self.at = 0;
        let more = self.pieces.next_piece()?;
        // A UTF-8 byte order mark, as editors leave it.
        if more && self.pieces.byte() == 0 && self.pieces.piece().starts_with(b"\xEF\xBB\xBF") {
            self.at = 3;
        }
        Ok(more)
    }

    /// An error at what was just read.
    pub(in crate::formats) fn error_here(&self, message: String, help: &'static str) -> ReadError {
        let byte = self.pieces.byte();
        // What began in a line that is gone is shown by its last line.
        let from = self.begun.byte.checked_sub(byte).map_or(0, |at| at as usize).min(self.at);
        self.error(from, self.at - from, message, help)
    }

    fn error(&self, at: usize, width: usize, message: impl Into<String>, help: &'static str) -> ReadError {
        ReadError::Program { message: message.into(), place: self.place(at, width), help: help.into() }
    }

    fn place(&self, at: usize, width: usize) -> Place {
        self.pieces.place(at, width)
    }

    fn spot_at(&self, at: usize) -> Spot {
        self.pieces.spot(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::three_b::{Quadrant, Sense};
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

    fn refused_place(text: &str) -> Place {
        match read(text).unwrap_err() {
            ReadError::Program { place, .. } => place,
            ReadError::Io(error) => panic!("{error}"),
        }
    }

    #[test]
    fn remarks_in_parentheses_are_passed_over_and_end_with_their_line() {
        let program = "(first) B7B0B7GXL1 (B9 B9) B0B8B8GYL2 (open B9B0B9GXL1\nB9B0B9GXL1";
        assert_eq!(texts(program), ["B7B0B7GXL1", "B0B8B8GYL2", "B9B0B9GXL1"]);
    }

    #[test]
    fn a_byte_order_mark_is_passed_over_at_the_very_start_only() {
        assert_eq!(texts("\u{feff}B7B0B7GXL1"), ["B7B0B7GXL1"]);
        for (program, line, column) in [
            ("B7B0B7GXL1\n\u{feff}B7B0B7GXL1", 2, 1),
            ("B7B0B7GXL1\u{feff}B7B0B7GXL1", 1, 11),
            ("\u{ff22}\u{ff22}B7B0B7GXL1", 1, 1),
        ] {
            let place = refused_place(program);
            assert_eq!((place.line, place.column), (line, column), "{program}");
        }
    }

    #[test]
    fn a_line_number_is_digits_with_a_colon() {
        assert_eq!(texts("N 12:B7B0B7GXL1\nn13: B7B0B7GXL1"), ["B7B0B7GXL1", "B7B0B7GXL1"]);
        for program in ["N12XB7B0B7GXL1", "N 12 B7B0B7GXL1", "N : B7B0B7GXL1", "N:B7B0B7GXL1"] {
            assert_eq!(refusal(program), ("neither a 3B block nor a comment".to_owned(), 1, 1), "{program}");
        }
    }

    #[test]
    fn each_stop_word_is_known_by_its_own_name() {
        for (program, word) in
            [("D", "D"), ("d\n", "D"), ("D ", "D"), ("DD", "DD"), ("dd;", "DD"), ("E ", "E")]
        {
            let (item, _) = read(program).unwrap().remove(0);
            assert_eq!(item, Item::StopWord(word), "{program}");
        }
        for program in ["DDX", "DX", "EX", "DE"] {
            assert!(refusal(program).0.contains("neither"), "{program}");
        }
    }

    #[test]
    fn every_instruction_is_read_as_what_it_says() {
        for (text, sense, digit) in [
            ("B0B5B5GXSR1", Sense::Clockwise, Quadrant::First),
            ("B5B0B5GXSR2", Sense::Clockwise, Quadrant::Second),
            ("B5B0B5GXNR1", Sense::CounterClockwise, Quadrant::First),
            ("B5B0B5GXNR3", Sense::CounterClockwise, Quadrant::Third),
        ] {
            let Item::Block(block) = read(text).unwrap().remove(0).0 else { panic!("{text} is a block") };
            assert_eq!(block.motion, Motion::Arc(sense, digit));
        }
    }

    #[test]
    fn a_sign_or_a_point_is_named_wherever_a_number_begins_with_it() {
        for sign in ['-', '+', '.'] {
            let (message, _, column) = refusal(&format!("B{sign}1B2B3GXL1"));
            assert!(message.starts_with(&format!("X holds `{sign}`")), "{message}");
            assert_eq!(column, 2);
        }
    }

    #[test]
    fn the_largest_count_is_read_and_a_larger_number_is_underlined() {
        assert_eq!(texts("B999999B0B999999GXL1"), ["B999999B0B999999GXL1"]);
        let place = refused_place("B7B0B7GXL1\nB1000000B0B1000000GXL1");
        assert_eq!((place.line, place.column, place.byte, place.width), (2, 12, 22, 7));
        let zeros = format!("B{}B{}B1GXL1", "0".repeat(199), "0".repeat(500));
        assert!(refusal(&zeros).0.contains("too many zeros"));
    }

    #[test]
    fn a_block_that_never_ends_is_underlined_whole_on_the_line_it_ends_on() {
        let place = refused_place("B7B0B7GXL1\nB7B0B7GXL1 B0B0B500GYL1 B7B0B7GXL1\n");
        assert_eq!((place.line, place.column, place.byte, place.width), (2, 12, 22, 12));
        let place = refused_place("B7B0B7GXL1 B0B0\nB500GYL1 B7B0B7GXL1\n");
        assert_eq!((place.line, place.column, place.byte, place.width), (2, 1, 16, 8));
        let long =
            format!("{}B0B0B500GYL1{}", "B9900B0B9900GXL1".repeat(4095), "B9900B0B9900GXL1".repeat(4095));
        let place = refused_place(&long);
        assert_eq!((place.line, place.column, place.byte, place.width), (1, 65_521, 65_520, 12));
    }

    #[test]
    fn a_line_may_be_as_long_as_is_said_and_what_stands_behind_its_blocks_is_not_lost() {
        let remark = format!(";{}", "x".repeat(LINE_BYTES_MAX - 1));
        assert_eq!(texts(&remark), [""; 0]);
        assert!(refusal(&format!("{remark}x")).0.contains("longer"));
        let gap = " ".repeat(LINE_BYTES_MAX);
        assert!(refusal(&format!("B7B0B7GXL1{gap}B7B0B7GXL1")).0.contains("longer"));
        let blocks = "B9900B0B9900GXL1".repeat(4000);
        let blanks = " ".repeat(LINE_BYTES_MAX - 1 - blocks.len());
        let items = read(&format!("{blocks}{blanks}DD")).unwrap();
        assert_eq!((items.len(), &items[4000].0), (4001, &Item::StopWord("DD")));
    }
}
