//! The 3B block `B X B Y B J G Z`, put together one character at a time.
//!
//! A block is recognised by its whole pattern and is complete at its Z digit; white space is free and no line end is
//! needed. A block number in front (`N 12:`) is taken as part of the block and not looked at.
//!
//! Not done here: `%`, comments, stop words (the control's reader), and what the block does (the interpolator).
//!
//! Sources: domain/2, "The 3B block" (a 1990 paper and public listings). That X and Y may be larger than J's six digits
//! is a guess: no source limits them.

use std::fmt;

/// An axis of the table.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Axis {
    /// The X axis, `GX`.
    X,
    /// The Y axis, `GY`.
    Y,
}

/// What the letters of Z say.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Kind {
    /// `L`: a straight line; X and Y are its end relative to its start.
    Line,
    /// `SR`: an arc, clockwise; X and Y are its start relative to its centre.
    Clockwise,
    /// `NR`: an arc, counter-clockwise; X and Y are its start relative to its centre.
    CounterClockwise,
}

/// The digit of Z; it carries the signs X and Y do not have.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Quadrant {
    /// `1`: x and y positive.
    First,
    /// `2`: x negative, y positive.
    Second,
    /// `3`: x and y negative.
    Third,
    /// `4`: x positive, y negative.
    Fourth,
}

impl Quadrant {
    /// The signs of x and y in this quadrant, each 1 or -1.
    #[must_use]
    pub fn signs(self) -> (i64, i64) {
        match self {
            Quadrant::First => (1, 1),
            Quadrant::Second => (-1, 1),
            Quadrant::Third => (-1, -1),
            Quadrant::Fourth => (1, -1),
        }
    }

    pub(super) fn from_digit(digit: u8) -> Option<Quadrant> {
        match digit {
            b'1' => Some(Quadrant::First),
            b'2' => Some(Quadrant::Second),
            b'3' => Some(Quadrant::Third),
            b'4' => Some(Quadrant::Fourth),
            _ => None,
        }
    }

    fn digit(self) -> char {
        match self {
            Quadrant::First => '1',
            Quadrant::Second => '2',
            Quadrant::Third => '3',
            Quadrant::Fourth => '4',
        }
    }
}

/// One 3B block. All numbers in µm; signs come from [`Quadrant`] alone.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub struct Block {
    /// |X|: of the end (line, from its start) or of the start (arc, from its centre), µm.
    pub x: u32,
    /// |Y|, as `x`, µm.
    pub y: u32,
    /// J: the total travel along the axis `g`, µm.
    pub j: u32,
    /// G: the axis on which J is counted.
    pub g: Axis,
    /// The letters of Z.
    pub kind: Kind,
    /// The digit of Z.
    pub quadrant: Quadrant,
}

impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let g = match self.g {
            Axis::X => "GX",
            Axis::Y => "GY",
        };
        let kind = match self.kind {
            Kind::Line => "L",
            Kind::Clockwise => "SR",
            Kind::CounterClockwise => "NR",
        };
        write!(f, "B{}B{}B{}{g}{kind}{}", self.x, self.y, self.j, self.quadrant.digit())
    }
}

/// Why a text is no 3B block.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Malformed {
    /// What the pattern calls for at this place.
    pub expected: &'static str,
    /// The character found there; `None`: the text ended.
    pub found: Option<char>,
}

impl fmt::Display for Malformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.found {
            Some(found) => write!(f, "expected {}, found {found:?}", self.expected),
            None => write!(f, "expected {}, but the text ended", self.expected),
        }
    }
}

impl std::error::Error for Malformed {}

/// Reads exactly one block from a text, white space around it allowed.
///
/// # Errors
///
/// [`Malformed`] when the text is not one whole block and nothing else.
pub fn parse_block(text: &str) -> Result<Block, Malformed> {
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
    numbers: [u32; 3],
    g: Option<Axis>,
}

/// What one more character made of it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Step {
    More,
    Complete(Block),
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
    /// After the `G` of G.
    AfterG,
    /// After the axis letter.
    BeforeKind,
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
            Place::Empty(2) | Place::Digits(2) | Place::Ended(2) => "the number J, then GX, GY, X or Y",
            Place::Empty(_) | Place::Digits(_) | Place::Ended(_) => "a number of µm, then B",
            Place::AfterG => "X or Y after G",
            Place::BeforeKind => "L, SR or NR",
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
            Place::Empty(index) | Place::Digits(index) => match c {
                b'0'..=b'9' => return self.digit(index, c - b'0'),
                _ => self.after_number(index, c),
            },
            Place::Ended(index) => self.after_number(index, c),
            Place::AfterG => self.axis(c),
            Place::BeforeKind => match c {
                b'L' => Some(Place::BeforeDigit(Kind::Line)),
                b'S' => Some(Place::Arc(Kind::Clockwise)),
                b'N' => Some(Place::Arc(Kind::CounterClockwise)),
                _ => None,
            },
            Place::Arc(kind) => (c == b'R').then_some(Place::BeforeDigit(kind)),
            Place::BeforeDigit(kind) => match (Quadrant::from_digit(c), self.g) {
                (Some(quadrant), Some(g)) => {
                    let [x, y, j] = self.numbers;
                    *self = Assembly::default();
                    return Step::Complete(Block { x, y, j, g, kind, quadrant });
                }
                (Some(_) | None, Some(_) | None) => None,
            },
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
        self.place = Place::Digits(index);
        Step::More
    }

    fn after_number(&mut self, index: usize, c: u8) -> Option<Place> {
        match (index, c) {
            (0 | 1, b'B') => Some(Place::Empty(index + 1)),
            (2, b'G') => Some(Place::AfterG),
            (2, _) => self.axis(c),
            _ => None,
        }
    }

    fn axis(&mut self, c: u8) -> Option<Place> {
        self.g = match c {
            b'X' => Some(Axis::X),
            b'Y' => Some(Axis::Y),
            _ => return None,
        };
        Some(Place::BeforeKind)
    }
}

/// Six digits of J: "a block counts at most 999 999 µm" (domain/2).
const J_MAX_UM: u32 = 999_999;

/// A guess: 100 m is beyond any machine, and keeps every product in the interpolator far from overflow.
const COORDINATE_MAX_UM: u32 = 99_999_999;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_block_is_read_with_blanks_padding_and_a_bare_axis() {
        let block = parse_block("B579 B6617 B006617 Y L2").unwrap();
        let wanted =
            Block { x: 579, y: 6617, j: 6617, g: Axis::Y, kind: Kind::Line, quadrant: Quadrant::Second };
        assert_eq!(block, wanted);
    }

    #[test]
    fn empty_numbers_are_zero_and_letters_may_be_small() {
        let block = parse_block(" bbb9900 g x l1\n").unwrap();
        assert_eq!(block.to_string(), "B0B0B9900GXL1");
    }

    #[test]
    fn a_block_number_in_front_is_passed_over() {
        assert_eq!(parse_block("N  12: B1B2B3GYNR4").unwrap().to_string(), "B1B2B3GYNR4");
    }

    #[test]
    fn what_is_not_the_whole_pattern_is_refused() {
        for wrong in [
            "",
            "B1B2GXL1",
            "B1B2B3B4GXL1",
            "B1 2B3B4GXL1",
            "B-1B2B3GXL1",
            "B1B2B3GZL1",
            "B1B2B3GXL5",
            "B1B2B3GXL0",
            "B1B2B3GXR1",
            "B1B2B3GX",
            "B1B2B3L1",
            "B1B2B3GXL1x",
            "B1.5B2B3GXL1",
            "B1B2B1000000GXL1",
            "B100000000B2B3GXL1",
        ] {
            assert!(parse_block(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_largest_numbers_are_read() {
        assert_eq!(parse_block("B99999999B0B999999GXL1").unwrap().j, 999_999);
    }
}
