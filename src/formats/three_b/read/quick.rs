//! A block written plainly, within one line: taken in one go, in capitals as it stands, else once blanks are squeezed out.
//!
//! Whatever is not such a block, or is one that might be wrong, is left to `careful`, which says what it is.

use super::Beyond;
use crate::formats::four_b::Fourth;
use crate::formats::three_b::{Axis, Block, Motion, Quadrant};
use crate::geometry::Sense;
use crate::interpolator::comes_to_an_end;
use crate::motion::Flag;
use crate::units::Micrometres;

/// The block at the start of `line`, what it says beyond 3B, and its length.
#[inline]
pub(super) fn block<const FOUR_B: bool>(line: &[u8]) -> Option<(Block, Beyond, usize)> {
    let mut at = 0;
    let x = number(line, &mut at, COORDINATE_DIGITS)?;
    let y = number(line, &mut at, COORDINATE_DIGITS)?;
    let j = number(line, &mut at, COUNT_DIGITS)?;
    let mut beyond = Beyond::default();
    if FOUR_B {
        if line.get(at) == Some(&b'B') {
            let from = at + 1;
            let radius = number(line, &mut at, COORDINATE_DIGITS)?;
            if at > from {
                beyond.fourth = Some(Fourth::Radius(radius));
            }
        }
        flag(line, &mut at, &mut beyond)?;
    }
    if line.get(at) == Some(&b'G') {
        at += 1;
    }
    let g = match line.get(at)? {
        b'X' => Axis::X,
        b'Y' => Axis::Y,
        _ => return None,
    };
    at += 1;
    if FOUR_B {
        flag(line, &mut at, &mut beyond)?;
    }
    let (sense, digit) = match *line.get(at..)? {
        [b'L', digit, ..] => (None, digit),
        [b'S', b'R', digit, ..] => (Some(Sense::Clockwise), digit),
        [b'N', b'R', digit, ..] => (Some(Sense::CounterClockwise), digit),
        _ => return None,
    };
    let quadrant = Quadrant::from_digit(digit)?;
    let (motion, length) = match sense {
        None => (Motion::Line(quadrant), at + 2),
        Some(sense) => (Motion::Arc(sense, quadrant), at + 3),
    };
    let block = Block { x, y, j, g, motion };
    let fits = !FOUR_B || beyond.fits(&block).is_ok();
    (comes_to_an_end(&block) && fits).then_some((block, beyond, length))
}

/// `B` and the number behind it; one left out is 0.
#[inline]
fn number(line: &[u8], at: &mut usize, digits_max: usize) -> Option<Micrometres> {
    let rest = line.get(*at..)?;
    let (&b'B', rest) = rest.split_first()? else { return None };
    let mut value = 0;
    for (count, byte) in rest.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            *at += 1 + count;
            return Some(Micrometres(value));
        }
        if count == digits_max {
            return None;
        }
        value = value * 10 + i64::from(digit);
    }
    None
}

/// The start of a line without blanks and in capitals, as much of it as a plain block may take.
pub(super) fn squeeze(line: &[u8], text: &mut Vec<u8>) {
    text.clear();
    let line = &line[..line.len().min(SQUEEZED_BYTES)];
    let words = line.iter().take_while(|b| !matches!(b, b'\n' | b';' | b'('));
    text.extend(words.filter(|b| !blank(**b)).map(u8::to_ascii_uppercase));
}

/// The length on the line of what was `length` bytes long without blanks.
pub(super) fn spread(line: &[u8], length: usize) -> usize {
    let mut words = line.iter().enumerate().filter(|(_, b)| !blank(**b));
    words.nth(length - 1).map_or(line.len(), |(at, _)| at + 1)
}

fn blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0)
}

#[inline]
fn flag(line: &[u8], at: &mut usize, beyond: &mut Beyond) -> Option<()> {
    let (flag, length) = match line.get(*at..)? {
        [b'D', b'D', ..] => (Flag::DD, 2),
        [b'D', ..] => (Flag::D, 1),
        _ => return Some(()),
    };
    *at += length;
    match beyond.flag.replace(flag) {
        None => Some(()),
        Some(_) => None,
    }
}

/// So many digits cannot say more than [`crate::interpolator::COORDINATE_MAX`].
const COORDINATE_DIGITS: usize = 9;
/// So many digits cannot say more than [`crate::formats::three_b::COUNT_MAX`].
const COUNT_DIGITS: usize = 6;
/// Enough for a block with every number and a blank or two between its words.
const SQUEEZED_BYTES: usize = 96;

#[cfg(test)]
mod tests;
