//! The 3B block `B X B Y B J G Z`: what it says and how it is written.
//!
//! X, Y and J are unsigned micrometres; direction comes only from the digit of Z. For a line X, Y is the end seen
//! from the start; for an arc X, Y is the *start* seen from the centre. J is the travel along the counting axis G,
//! and the block ends when it is used up. Source: Zhan, Han, Sha, "Manual programming for wire EDM" (2015), table 1;
//! Li, "IBM-PC … NC WEDM" (1990), printed table.
//!
//! What a control *does* with a block is `interpolator`; choosing the numbers is `rounding`; reading is [`read`].

pub mod motions;
pub mod read;
pub mod write;

use crate::geometry::Sense;
use crate::units::{Micrometres, Position};

/// The largest count a block can hold: six decimal digits on the older controls.
pub const COUNT_MAX: Micrometres = Micrometres(999_999);

/// The counting axis, G.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Axis {
    /// GX.
    X,
    /// GY.
    Y,
}

/// The digit of Z: a quadrant of the block's own frame.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Quadrant {
    /// +x, +y.
    First,
    /// −x, +y.
    Second,
    /// −x, −y.
    Third,
    /// +x, −y.
    Fourth,
}

impl Quadrant {
    /// The signs (x, y) of the quadrant.
    #[must_use]
    pub fn signs(self) -> (i64, i64) {
        match self {
            Self::First => (1, 1),
            Self::Second => (-1, 1),
            Self::Third => (-1, -1),
            Self::Fourth => (1, -1),
        }
    }

    /// The quadrant for a digit 1-4.
    #[must_use]
    pub fn from_digit(digit: u8) -> Option<Self> {
        match digit {
            b'1' => Some(Self::First),
            b'2' => Some(Self::Second),
            b'3' => Some(Self::Third),
            b'4' => Some(Self::Fourth),
            _ => None,
        }
    }

    /// The digit 1-4 as text.
    #[must_use]
    pub fn digit(self) -> u8 {
        match self {
            Self::First => b'1',
            Self::Second => b'2',
            Self::Third => b'3',
            Self::Fourth => b'4',
        }
    }
}

/// The instruction, Z.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Motion {
    /// L1-L4: a straight line into the quadrant.
    Line(Quadrant),
    /// SR1-SR4 and NR1-NR4: an arc that starts in, or enters, the quadrant.
    Arc(Sense, Quadrant),
}

/// One 3B block.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Block {
    /// X, unsigned.
    pub x: Micrometres,
    /// Y, unsigned.
    pub y: Micrometres,
    /// J: travel along G, unsigned.
    pub j: Micrometres,
    /// G: the counting axis.
    pub g: Axis,
    /// Z: the instruction.
    pub motion: Motion,
}

impl Block {
    /// The line to `end`, seen from its start: digit by half-open quadrants, G the longer axis, at 45° GY in
    /// quadrants 1 and 3 and GX in 2 and 4 (the tie rule of the 2015 paper).
    #[must_use]
    pub fn line(end: Position) -> Self {
        let quadrant = line_quadrant(end);
        let (x, y) = (end.x.abs(), end.y.abs());
        let g = if x > y {
            Axis::X
        } else if y > x {
            Axis::Y
        } else {
            match quadrant {
                Quadrant::First | Quadrant::Third => Axis::Y,
                Quadrant::Second | Quadrant::Fourth => Axis::X,
            }
        };
        let j = match g {
            Axis::X => x,
            Axis::Y => y,
        };
        Self { x, y, j, g, motion: Motion::Line(quadrant) }
    }

    /// The arc that starts at `start` (seen from the centre) and counts `j` along `g`.
    #[must_use]
    pub fn arc(start: Position, sense: Sense, g: Axis, j: Micrometres) -> Self {
        Self {
            x: start.x.abs(),
            y: start.y.abs(),
            j,
            g,
            motion: Motion::Arc(sense, arc_quadrant(start, sense)),
        }
    }

    /// X and Y with the signs of the digit: the end of a line, the start of an arc.
    #[must_use]
    pub fn signed(&self) -> Position {
        let (sx, sy) = match self.motion {
            Motion::Line(quadrant) | Motion::Arc(_, quadrant) => quadrant.signs(),
        };
        Position::new(sx * self.x.0, sy * self.y.0)
    }

    /// X or Y, whichever lies along the counting axis.
    #[must_use]
    #[inline]
    pub fn counted(&self) -> Micrometres {
        match self.g {
            Axis::X => self.x,
            Axis::Y => self.y,
        }
    }
}

/// The digit of a line: 0° ≤ θ < 90° is 1, and so on round.
fn line_quadrant(end: Position) -> Quadrant {
    match (end.x.0, end.y.0) {
        (x, y) if x > 0 && y >= 0 => Quadrant::First,
        (x, y) if x <= 0 && y > 0 => Quadrant::Second,
        (x, y) if x < 0 && y <= 0 => Quadrant::Third,
        _ => Quadrant::Fourth,
    }
}

/// The digit of an arc: the quadrant the motion enters from `start`.
fn arc_quadrant(start: Position, sense: Sense) -> Quadrant {
    match sense {
        Sense::CounterClockwise => line_quadrant(start),
        Sense::Clockwise => match (start.x.0, start.y.0) {
            (x, y) if x >= 0 && y > 0 => Quadrant::First,
            (x, y) if x < 0 && y >= 0 => Quadrant::Second,
            (x, y) if x <= 0 && y < 0 => Quadrant::Third,
            _ => Quadrant::Fourth,
        },
    }
}

/// The word a program ends with.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum StopWord {
    /// `DD`: end of program.
    #[default]
    DD,
    /// `D`: pause.
    D,
    /// `E`: end.
    E,
    /// No stop word.
    None,
}

impl StopWord {
    /// The word as it is written.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::DD => "DD",
            Self::D => "D",
            Self::E => "E",
            Self::None => "",
        }
    }
}

/// How a control likes its blocks written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Style {
    /// Digits of J, padded with zeros; 1 pads nothing. Six on older controls (`B006617`).
    pub j_digits: usize,
    /// Whether G is written `GX` or, as in the 1990 paper, bare `X`.
    pub g_letter: bool,
    /// A blank between words, as in the 1990 paper.
    pub blanks: bool,
}

impl Default for Style {
    /// `B579B6617B006617GYL2`.
    fn default() -> Self {
        Self { j_digits: 6, g_letter: true, blanks: false }
    }
}

impl Style {
    /// Appends the block's text, without an end of block.
    pub fn write(self, block: &Block, text: &mut Vec<u8>) {
        self.write_numbers(block, text);
        self.write_axis(block.g, text);
        self.gap(text);
        write_instruction(block.motion, text);
    }

    /// Appends X, Y and J.
    pub(in crate::formats) fn write_numbers(self, block: &Block, text: &mut Vec<u8>) {
        for (number, digits) in [(block.x, 1), (block.y, 1), (block.j, self.j_digits)] {
            text.push(b'B');
            push_number(text, number.0, digits);
            self.gap(text);
        }
    }

    /// Appends G.
    pub(in crate::formats) fn write_axis(self, axis: Axis, text: &mut Vec<u8>) {
        if self.g_letter {
            text.push(b'G');
        }
        text.push(match axis {
            Axis::X => b'X',
            Axis::Y => b'Y',
        });
    }

    pub(in crate::formats) fn gap(self, text: &mut Vec<u8>) {
        if self.blanks {
            text.push(b' ');
        }
    }
}

/// Appends Z.
pub(in crate::formats) fn write_instruction(motion: Motion, text: &mut Vec<u8>) {
    let (letters, quadrant): (&[u8], _) = match motion {
        Motion::Line(quadrant) => (b"L", quadrant),
        Motion::Arc(Sense::Clockwise, quadrant) => (b"SR", quadrant),
        Motion::Arc(Sense::CounterClockwise, quadrant) => (b"NR", quadrant),
    };
    text.extend_from_slice(letters);
    text.push(quadrant.digit());
}

/// Appends a non-negative number in decimal, at least `digits` long.
pub(in crate::formats) fn push_number(text: &mut Vec<u8>, number: i64, digits: usize) {
    let mut buffer = [b'0'; 20];
    let mut rest = number.unsigned_abs();
    let mut at = buffer.len();
    while rest > 0 {
        at -= 1;
        buffer[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
    }
    let start = at.min(buffer.len() - digits.clamp(1, buffer.len()));
    text.extend_from_slice(&buffer[start..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(style: Style, block: &Block) -> String {
        let mut bytes = Vec::new();
        style.write(block, &mut bytes);
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn a_block_is_written_as_its_control_likes_it() {
        let block = Block::line(Position::new(-579, 6617));
        assert_eq!(text(Style::default(), &block), "B579B6617B006617GYL2");
        let paper = Style { j_digits: 6, g_letter: false, blanks: true };
        assert_eq!(text(paper, &block), "B579 B6617 B006617 Y L2");
        let bare = Style { j_digits: 1, g_letter: true, blanks: false };
        assert_eq!(text(bare, &Block::line(Position::new(9900, 0))), "B9900B0B9900GXL1");
    }

    #[test]
    fn the_axes_belong_to_the_digit_they_open() {
        for (x, y, digit) in [(1, 0, '1'), (0, 1, '2'), (-1, 0, '3'), (0, -1, '4')] {
            let line = Block::line(Position::new(x, y));
            assert!(text(Style::default(), &line).ends_with(&format!("L{digit}")));
            let nr = Block::arc(Position::new(x, y), Sense::CounterClockwise, Axis::X, Micrometres(1));
            assert!(text(Style::default(), &nr).ends_with(&format!("NR{digit}")));
        }
        for (x, y, digit) in [(0, 1, '1'), (-1, 0, '2'), (0, -1, '3'), (1, 0, '4')] {
            let sr = Block::arc(Position::new(x, y), Sense::Clockwise, Axis::X, Micrometres(1));
            assert!(text(Style::default(), &sr).ends_with(&format!("SR{digit}")));
        }
    }

    #[test]
    fn a_tie_counts_y_in_quadrants_one_and_three() {
        for (x, y, g) in [(5, 5, Axis::Y), (-5, 5, Axis::X), (-5, -5, Axis::Y), (5, -5, Axis::X)] {
            assert_eq!(Block::line(Position::new(x, y)).g, g);
        }
    }

    #[test]
    fn the_digits_go_round_the_quadrants_with_their_signs() {
        for (digit, signs) in [(b'1', (1, 1)), (b'2', (-1, 1)), (b'3', (-1, -1)), (b'4', (1, -1))] {
            let quadrant = Quadrant::from_digit(digit).unwrap();
            assert_eq!((quadrant.signs(), quadrant.digit()), (signs, digit));
        }
        assert_eq!((Quadrant::from_digit(b'0'), Quadrant::from_digit(b'5')), (None, None));
    }

    #[test]
    fn the_number_along_the_counting_axis_is_the_one_g_names() {
        for (x, y, g, counted) in [(-579, 6617, Axis::Y, 6617), (9900, -1, Axis::X, 9900), (4, 4, Axis::Y, 4)]
        {
            let line = Block::line(Position::new(x, y));
            assert_eq!((line.g, line.counted(), line.j), (g, Micrometres(counted), Micrometres(counted)));
        }
        let arc = Block::arc(Position::new(3, 4), Sense::Clockwise, Axis::X, Micrometres(90));
        assert_eq!(arc.counted(), Micrometres(3));
    }

    #[test]
    fn inside_a_quadrant_the_digit_gives_back_the_signs_of_the_point() {
        for (x, y, digit) in [(3, 4, '1'), (-3, 4, '2'), (-3, -4, '3'), (3, -4, '4')] {
            let point = Position::new(x, y);
            for (block, letters) in [
                (Block::line(point), "L"),
                (Block::arc(point, Sense::Clockwise, Axis::Y, Micrometres(2)), "SR"),
                (Block::arc(point, Sense::CounterClockwise, Axis::Y, Micrometres(2)), "NR"),
            ] {
                assert!(text(Style::default(), &block).ends_with(&format!("GY{letters}{digit}")));
                assert_eq!(block.signed(), point);
            }
        }
    }
}
