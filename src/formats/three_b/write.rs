//! Motions into 3B, each block chosen from where the control really stands.
//!
//! 3B describes the wire's own path and nothing else: an offset, a taper, a wire's upper end of its own are refused, and
//! what a 3B control has no word for (dwells, conditions, words of G-code) is left out and counted in [`Writer::lost`].
//!
//! **Contours.** A contour closes where an element ends on the very point at which one of the first four of its elements
//! began; it is then brought back to the micron on which the control stood there, so a turn more or less leaves nothing
//! over.
//!
//! **Ways without cutting.** 3B has no rapid. Between contours the trade writes `D`, the straight line, `D` (跳步): the
//! control stops for the wire to be cut, runs the line, stops for it to be threaded. That custom is *unverified* for any one
//! control. The way from the program's zero to the first start hole is left out, because a 3B control has no zero: the
//! operator stands the wire in the hole, and the program begins there. [`Writer::start_hole`] says where that is.

pub(in crate::formats) mod path;

use std::borrow::Cow;

use super::read::{Entry, Reader};
use super::{StopWord, Style};
use crate::formats::WriteError;
use crate::formats::losses::Losses;
use crate::geometry::{Element, Point};
use crate::motion::{Act, Motion, Offset, Stop, Taper, Travel};
use crate::place::Spot;
use crate::rounding::Aim;
use crate::units::Position;

use path::{Line, Path, Way, within_reach};

/// How a program is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Form {
    /// How a block is spelled.
    pub style: Style,
    /// Which controls the blocks have to be right for.
    pub aim: Aim,
    /// What the program ends with.
    pub end: StopWord,
    /// What becomes of comments and headers.
    pub remarks: Remarks,
    /// Whether `N 12:` stands before each block.
    pub numbers: bool,
}

impl Default for Form {
    /// Six digits of J, right for every model of control, `DD` at the end, no remarks, no numbers.
    fn default() -> Self {
        let (aim, end) = (Aim::Any, StopWord::DD);
        Self { style: Style::default(), aim, end, remarks: Remarks::LeftOut, numbers: false }
    }
}

/// What becomes of comments and headers: there are controls that take none.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Remarks {
    /// They are left out and counted.
    LeftOut,
    /// Comments stand in brackets on lines of their own; headers as they are.
    Brackets,
    /// Comments stand behind semicolons on lines of their own; headers as they are.
    Semicolons,
}

/// Writes 3B.
#[derive(Debug)]
pub struct Writer {
    form: Form,
    path: Path,
    losses: Losses,
    ended: bool,
    /// Blocks written.
    blocks: u64,
    /// A line number the source gave the next block, out of order.
    number: Option<Box<[u8]>>,
}

impl Writer {
    /// A writer at the start of a program.
    #[must_use]
    pub fn new(form: Form) -> Self {
        let path = Path::new(form.aim);
        Self { form, path, losses: Losses::default(), ended: false, blocks: 0, number: None }
    }

    /// What the format had no room for.
    #[must_use]
    pub fn lost(&self) -> &Losses {
        &self.losses
    }

    /// The start hole, mm from the program's zero, where the way to it was left out.
    #[must_use]
    pub fn start_hole(&self) -> Option<Point> {
        self.path.start_hole
    }

    /// Blocks written.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.blocks
    }

    /// Where the control stands, µm from the program's zero.
    #[must_use]
    pub fn stands(&self) -> Position {
        self.path.chooser.stands()
    }

    fn travel(
        &mut self,
        travel: Travel,
        element: Element,
        spot: Spot,
        text: &mut Vec<u8>,
    ) -> Result<(), WriteError> {
        if self.ended {
            return Err(refusal("a motion after the end of the program", spot, "put one program in one file"));
        }
        within_reach(&element, spot)?;
        let (form, blocks, number) = (self.form, &mut self.blocks, &mut self.number);
        let way = self.path.go(travel, element, spot, |line| {
            if let Line::Block(block) = line {
                *blocks += 1;
                if form.numbers {
                    match number.take() {
                        Some(digits) => {
                            text.extend_from_slice(b"N ");
                            text.extend_from_slice(&digits);
                        }
                        None => text.extend_from_slice(format!("N{:4}", *blocks).as_bytes()),
                    }
                    text.extend_from_slice(b": ");
                }
                form.style.write(block, text);
            } else {
                text.push(b'D');
            }
            text.push(b'\n');
        })?;
        if way == Way::ToStartHole {
            self.losses.add("way from the program's zero to the start hole", spot);
            let hole = element.end();
            self.remark(format!(" start hole at X {:.3} Y {:.3} ", hole.x, hole.y).as_bytes(), text);
        }
        Ok(())
    }

    /// Writes a comment on a line of its own, if there is room for one.
    fn remark(&self, words: &[u8], text: &mut Vec<u8>) -> bool {
        let brackets = match self.form.remarks {
            Remarks::LeftOut => return false,
            Remarks::Brackets => !words.contains(&b')'),
            Remarks::Semicolons => false,
        };
        text.push(if brackets { b'(' } else { b';' });
        text.extend(words.iter().map(|&b| if matches!(b, b'\n' | b'\r') { b' ' } else { b }));
        text.extend_from_slice(if brackets { b")\n" } else { b"\n" });
        true
    }

    fn header(&self, words: &[u8], text: &mut Vec<u8>) -> bool {
        if self.form.remarks == Remarks::LeftOut {
            return false;
        }
        let mut reader = Reader::new(words);
        if matches!(reader.next_entry(), Ok(Some(Entry::Header))) && reader.text() == words {
            text.extend_from_slice(words);
            text.push(b'\n');
            return true;
        }
        // Words of another format would not read back as a header of this one.
        self.remark(words, text)
    }

    fn stop(&mut self, stop: Stop, spot: Spot, text: &mut Vec<u8>) {
        match stop {
            _ if self.ended => self.losses.add("stop after the end", spot),
            Stop::End => self.end(text),
            Stop::Pause | Stop::Optional => {
                if stop == Stop::Optional {
                    self.losses.add("stop on request (M01), written as a stop in any case (D)", spot);
                }
                self.path.pause();
                text.extend_from_slice(b"D\n");
            }
        }
    }

    fn end(&mut self, text: &mut Vec<u8>) {
        if !std::mem::replace(&mut self.ended, true) && self.form.end != StopWord::None {
            text.extend_from_slice(self.form.end.text().as_bytes());
            text.push(b'\n');
        }
    }
}

impl crate::formats::Writer for Writer {
    fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        let spot = motion.spot;
        match &motion.act {
            Act::Move { upper: Some(_), .. } => Err(refusal(
                "3B moves both ends of the wire alike, and this motion moves them apart",
                spot,
                "cut the taper with 4B on a control with a taper device, or leave the upper end out",
            )),
            Act::Move { flag: Some(_), .. } => Err(refusal(
                "3B describes the wire's own path; a flag asks the control to add an offset or a taper",
                spot,
                "put the offset into the path first, or write 4B",
            )),
            &Act::Move { travel, element, .. } => self.travel(travel, element, spot, text),
            Act::Offset(Offset::On { .. }) => Err(refusal(
                "3B describes the wire's own path; a 3B control adds no offset",
                spot,
                "put the offset into the path first, or write 4B",
            )),
            Act::Taper(Taper::On { .. }) => Err(refusal(
                "3B describes the wire's own path, upright; it has no word for a taper",
                spot,
                "write 4B, or cut it upright",
            )),
            Act::Offset(Offset::Off) | Act::Taper(Taper::Off) => Ok(()),
            &Act::Stop(stop) => {
                self.stop(stop, spot, text);
                Ok(())
            }
            Act::Dwell(_) => {
                self.losses.add("dwell", spot);
                Ok(())
            }
            Act::Word(word) => {
                match word.strip_prefix(b"N") {
                    Some(digits) if self.form.numbers && digits.iter().all(u8::is_ascii_digit) => {
                        self.number = Some(digits.into());
                    }
                    Some(_) => self.losses.add("line number", spot),
                    None => self.losses.add("word", spot),
                }
                Ok(())
            }
            Act::Unknown(_) => {
                self.losses.add("unknown word", spot);
                Ok(())
            }
            Act::Comment(words) => {
                if !self.remark(words, text) {
                    self.losses.add("comment", spot);
                }
                Ok(())
            }
            Act::Header(words) => {
                if !self.header(words, text) {
                    self.losses.add("header line", spot);
                }
                Ok(())
            }
        }
    }

    fn finish(&mut self, text: &mut Vec<u8>) -> Result<(), WriteError> {
        self.end(text);
        Ok(())
    }
}

pub(in crate::formats) fn refusal(
    message: impl Into<String>,
    spot: Spot,
    help: impl Into<Cow<'static, str>>,
) -> WriteError {
    WriteError { message: message.into(), spot, help: help.into() }
}
