//! The 4B block `B X B Y B J B R D|DD G Z`, put together one character at a time, and the 3B blocks among them.
//!
//! The flag may also stand behind G (`… B R G D|DD Z`); both orders are read, mixed if need be. R may be empty, and a
//! taper ratio word `L…` may stand in its place, behind the fourth `B` or without it. The flag DD and the stop word DD
//! are told apart by position alone: inside a block it is the flag. White space is free, letters may be small.
//!
//! Not done here: what flag and radius mean (the control's plan), stop words (its reader).
//!
//! Sources: domain/2, "The 4B block"; the seed paper writes `BXBYBJBR或L_D_或DD_G_Z_`. Which digits an `L` takes is not
//! known: digits and one point are read (a guess).

use std::fmt;

use super::three_b::{Axis, Block, Kind, Malformed, Quadrant};

/// One block of a 4B program.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub struct FourBlock {
    /// Its 3B part.
    pub block: Block,
    /// What makes it 4B; `None`: it is a plain 3B block.
    pub marks: Option<Marks>,
}

/// What a 4B block says beyond a 3B block.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub struct Marks {
    /// What stands in the fourth field.
    pub fourth: Fourth,
    /// D or DD.
    pub flag: Flag,
}

/// The fourth field.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Fourth {
    /// Nothing.
    Empty,
    /// R, the arc's radius, µm.
    Radius(u32),
    /// `L`, a taper ratio; its value is not looked at.
    TaperRatio,
}

/// The flag. On an arc: how the offset changes its radius. On a lead-in line: the sense of the taper.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Flag {
    /// `D`: R + F; positive taper.
    D,
    /// `DD`: R − F; inverse taper.
    DD,
}

impl From<Block> for FourBlock {
    fn from(block: Block) -> FourBlock {
        FourBlock { block, marks: None }
    }
}

impl fmt::Display for FourBlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(Marks { fourth, flag }) = self.marks else {
            return self.block.fmt(f);
        };
        let plain = self.block.to_string();
        let (numbers, words) = plain.split_at(plain.find('G').unwrap_or(plain.len()));
        match fourth {
            Fourth::Empty => write!(f, "{numbers}B{flag:?}{words}"),
            Fourth::Radius(radius) => write!(f, "{numbers}B{radius}{flag:?}{words}"),
            Fourth::TaperRatio => write!(f, "{numbers}L…{flag:?}{words}"),
        }
    }
}

/// Reads exactly one block, 4B or 3B, from a text, white space around it allowed.
///
/// # Errors
///
/// [`Malformed`] when the text is not one whole block and nothing else.
pub fn parse_four_block(text: &str) -> Result<FourBlock, Malformed> {
    let mut assembly = Assembly::default();
    let mut block = None;
    for found in text.chars() {
        let byte = u8::try_from(found).unwrap_or(b'?');
        if block.is_some() {
            if byte.is_ascii_whitespace() {
                continue;
            }
            return Err(Malformed { expected: "the end of the text", found: Some(found) });
        }
        match assembly.push(byte) {
            Step::More => {}
            Step::Complete(complete) => block = Some(complete),
            Step::Wrong { expected } => return Err(Malformed { expected, found: Some(found) }),
        }
    }
    block.ok_or(Malformed { expected: assembly.place.expected(), found: None })
}

/// A block being put together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Assembly {
    place: Place,
    numbers: [u32; 4],
    /// The digits of the fourth number have begun.
    has_radius: bool,
    has_ratio: bool,
    has_fourth: bool,
    flag: Option<Flag>,
    g: Option<Axis>,
}

/// What one more character made of it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Step {
    More,
    Complete(FourBlock),
    Wrong { expected: &'static str },
}

#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum Place {
    /// Nothing of a block yet.
    #[default]
    Start,
    /// Inside the block number in front.
    Numbered,
    /// After a `B`, no digit of its number yet.
    Empty(usize),
    /// Inside a number.
    Digits(usize),
    /// White space after a number's digits.
    Ended(usize),
    /// Inside the value of a taper ratio word.
    Ratio,
    /// After one D, which may be the first of two.
    AfterD,
    /// After the `G` of G.
    AfterG,
    /// Between the fourth field and Z: flag, G, or Z, whatever has not been.
    Words,
    /// After the `S` or `N` of Z.
    Arc(Kind),
    /// Before the digit of Z.
    BeforeDigit(Kind),
}

impl Place {
    fn expected(self) -> &'static str {
        match self {
            Place::Start => "B",
            Place::Numbered => "a block number and B",
            Place::Empty(2) | Place::Digits(2) | Place::Ended(2) => "the number J, then B, GX, GY, X or Y",
            Place::Empty(3) | Place::Digits(3) | Place::Ended(3) => "the radius R or L, then D, DD or G",
            Place::Empty(_) | Place::Digits(_) | Place::Ended(_) => "a number of µm, then B",
            Place::Ratio => "a taper ratio, then D, DD or G",
            Place::AfterG => "X or Y after G",
            Place::AfterD | Place::Words => "D or DD, GX, GY, X or Y, then L, SR or NR",
            Place::Arc(_) => "R",
            Place::BeforeDigit(_) => "a quadrant, 1 to 4",
        }
    }
}

impl Assembly {
    /// Whether some of a block is there, but not all of it.
    pub(crate) fn is_partial(&self) -> bool {
        self.place != Place::Start
    }

    /// As [`Assembly::is_partial`], a block number in front alone not counted.
    pub(crate) fn is_begun(&self) -> bool {
        self.is_partial() && self.place != Place::Numbered
    }

    /// Takes one character, bit 8 already cleared. After `Complete` or `Wrong` it stands at the start again.
    pub(crate) fn push(&mut self, byte: u8) -> Step {
        let c = byte.to_ascii_uppercase();
        if c.is_ascii_whitespace() {
            if let Place::Digits(index) = self.place {
                self.place = Place::Ended(index);
            }
            return Step::More;
        }
        let next = match self.place {
            Place::Start => match c {
                b'B' => Some(Place::Empty(0)),
                b'N' => Some(Place::Numbered),
                _ => None,
            },
            Place::Numbered => match c {
                b'0'..=b'9' | b':' => Some(Place::Numbered),
                b'B' => Some(Place::Empty(0)),
                _ => None,
            },
            Place::Empty(3) if c == b'L' => self.ratio(),
            Place::Empty(index) | Place::Digits(index) if c.is_ascii_digit() => {
                return self.digit(index, c - b'0');
            }
            Place::Empty(index) | Place::Digits(index) | Place::Ended(index) => match (index, c) {
                (0..=2, b'B') => {
                    self.has_fourth = index == 2;
                    Some(Place::Empty(index + 1))
                }
                (2, b'L') => self.ratio(),
                (2 | 3, _) => self.word(c),
                _ => None,
            },
            Place::Ratio => match c {
                b'0'..=b'9' | b'.' => Some(Place::Ratio),
                _ => self.word(c),
            },
            Place::AfterD if c == b'D' => {
                self.flag = Some(Flag::DD);
                Some(Place::Words)
            }
            Place::AfterD | Place::Words => self.word(c),
            Place::AfterG => self.axis(c),
            Place::Arc(kind) => (c == b'R').then_some(Place::BeforeDigit(kind)),
            Place::BeforeDigit(kind) => return self.complete(kind, c),
        };
        match next {
            Some(place) => {
                self.place = place;
                Step::More
            }
            None => self.wrong(self.place.expected()),
        }
    }

    fn wrong(&mut self, expected: &'static str) -> Step {
        *self = Assembly::default();
        Step::Wrong { expected }
    }

    fn digit(&mut self, index: usize, digit: u8) -> Step {
        let largest = if index == 2 { J_MAX_UM } else { COORDINATE_MAX_UM };
        let number = self.numbers[index].saturating_mul(10).saturating_add(u32::from(digit));
        if number > largest {
            return self.wrong(if index == 2 {
                "a J of at most 999 999 µm"
            } else {
                "at most 99 999 999 µm"
            });
        }
        self.numbers[index] = number;
        self.has_radius = index == 3;
        self.place = Place::Digits(index);
        Step::More
    }

    fn ratio(&mut self) -> Option<Place> {
        self.has_fourth = true;
        self.has_ratio = true;
        Some(Place::Ratio)
    }

    /// A letter behind the numbers: the flag, G, or Z once both have been.
    fn word(&mut self, c: u8) -> Option<Place> {
        match c {
            b'D' if self.has_fourth && self.flag.is_none() => {
                self.flag = Some(Flag::D);
                Some(Place::AfterD)
            }
            b'G' if self.g.is_none() => Some(Place::AfterG),
            b'X' | b'Y' if self.g.is_none() => self.axis(c),
            b'L' | b'S' | b'N' if self.g.is_some() && self.flag.is_some() == self.has_fourth => match c {
                b'L' => Some(Place::BeforeDigit(Kind::Line)),
                b'S' => Some(Place::Arc(Kind::Clockwise)),
                _ => Some(Place::Arc(Kind::CounterClockwise)),
            },
            _ => None,
        }
    }

    fn axis(&mut self, c: u8) -> Option<Place> {
        self.g = match c {
            b'X' => Some(Axis::X),
            b'Y' => Some(Axis::Y),
            _ => return None,
        };
        Some(Place::Words)
    }

    fn complete(&mut self, kind: Kind, digit: u8) -> Step {
        let (Some(quadrant), Some(g)) = (Quadrant::from_digit(digit), self.g) else {
            return self.wrong(self.place.expected());
        };
        let [x, y, j, radius] = self.numbers;
        let fourth = match (self.has_radius, self.has_ratio) {
            (true, _) => Fourth::Radius(radius),
            (false, true) => Fourth::TaperRatio,
            (false, false) => Fourth::Empty,
        };
        let marks = self.flag.map(|flag| Marks { fourth, flag });
        *self = Assembly::default();
        Step::Complete(FourBlock { block: Block { x, y, j, g, kind, quadrant }, marks })
    }
}

/// Six digits of J: "a block counts at most 999 999 µm" (domain/2).
const J_MAX_UM: u32 = 999_999;

/// A guess, as for 3B: 100 m is beyond any machine.
const COORDINATE_MAX_UM: u32 = 99_999_999;

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> String {
        parse_four_block(text).map_or_else(|error| error.to_string(), |block| block.to_string())
    }

    #[test]
    fn the_flag_may_stand_before_or_behind_g() {
        for text in [
            "B5000B0B5000B5000DDGYNR1",
            "B5000B0B5000B5000GYDDNR1",
            "b5000 b b5000 b5000 d d y nr1",
            "B5000BB005000B5000 Y DD NR 1",
        ] {
            assert_eq!(read(text), "B5000B0B5000B5000DDGYNR1", "{text}");
        }
        assert_eq!(read("B5000B0B5000B5000GYDNR1"), "B5000B0B5000B5000DGYNR1");
    }

    #[test]
    fn a_3b_block_among_them_stays_3b() {
        let block = parse_four_block("N 3: B579 B6617 B006617 Y L2").unwrap();
        assert_eq!((block.marks, block.to_string()), (None, "B579B6617B6617GYL2".to_owned()));
    }

    #[test]
    fn a_lead_in_may_have_its_fourth_field_empty_or_zero_or_a_taper_ratio() {
        let fourth = |text| parse_four_block(text).unwrap().marks.unwrap().fourth;
        assert_eq!(fourth("B0B5000B5000BDGYL2"), Fourth::Empty);
        assert_eq!(fourth("B0B5000B5000B0DGYL2"), Fourth::Radius(0));
        assert_eq!(fourth("BBB5000B0DDGYL2"), Fourth::Radius(0));
        for text in ["BBB5000BL12DGYL2", "BBB5000L1.5DGYL2", "BBB5000 L12 GY D L2"] {
            assert_eq!(fourth(text), Fourth::TaperRatio, "{text}");
        }
    }

    #[test]
    fn what_is_not_the_whole_pattern_is_refused() {
        for wrong in [
            "B1B2B3B4GXL1",    // no flag
            "B1B2B3DGXL1",     // a flag and no fourth field
            "B1B2B3B4DDDGXL1", // a third D
            "B1B2B3B4DGXDL1",  // a second flag
            "B1B2B3B4DGXGYL1", // a second G
            "B1B2B3B4DL1",     // no G
            "B1B2B3B4B5DGXL1", // a fifth number
            "B1B2B3B4 5DGXL1", // a number in two pieces
            "B1B2B3B4L5DGXL1", // a radius and a ratio
            "B1B2B1000000B1DGXL1",
            "B1B2B3B4DGXL5",
            "B1B2B3B4D",
        ] {
            assert!(parse_four_block(wrong).is_err(), "{wrong}");
        }
    }
}
