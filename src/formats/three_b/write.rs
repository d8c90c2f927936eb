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
use super::{Block, StopWord, Style};
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
    /// Whether `N 12:` stands before a block.
    pub numbers: Numbers,
}

impl Default for Form {
    /// Six digits of J, right for every model of control, `DD` at the end, no remarks, no numbers.
    fn default() -> Self {
        let (aim, end) = (Aim::Any, StopWord::DD);
        Self { style: Style::default(), aim, end, remarks: Remarks::LeftOut, numbers: Numbers::LeftOut }
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

/// Which blocks are numbered, as CAM listings have it: there are controls that take no numbers.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Numbers {
    /// None; those of the source are left out and counted.
    LeftOut,
    /// Those that were in the source, with the same numbers.
    AsRead,
    /// All, from 1; those of the source give way.
    All,
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
    /// The digits of the number the source gave the next line, and where they stand.
    number: Option<(Box<[u8]>, Spot)>,
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

    /// Goes along an element; `spell` writes a block without its number and line end.
    pub(in crate::formats) fn travel(
        &mut self,
        travel: Travel,
        element: Element,
        spot: Spot,
        text: &mut Vec<u8>,
        spell: impl Fn(&Block, &mut Vec<u8>),
    ) -> Result<(), WriteError> {
        if self.ended {
            return Err(refusal(
                "a motion after the end of the program",
                spot,
                "put one program in one file",
            ));
        }
        within_reach(&element, spot)?;
        let (numbers, blocks, number) = (self.form.numbers, &mut self.blocks, &mut self.number);
        let way = self.path.go(travel, element, spot, |line| {
            if let Line::Block(block) = line {
                *blocks += 1;
                match (numbers, number.take()) {
                    (Numbers::All, _) => push_number(blocks.to_string().as_bytes(), text),
                    (Numbers::AsRead, Some((digits, _))) => push_number(&digits, text),
                    (Numbers::AsRead, None) | (Numbers::LeftOut, _) => {}
                }
                spell(block, text);
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

    /// Keeps the number of the next block or stop word.
    fn numbered(&mut self, digits: &[u8], spot: Spot) {
        if self.form.numbers != Numbers::AsRead {
            self.losses.add("line number", spot);
        } else if let Some((_, unused)) = self.number.replace((digits.into(), spot)) {
            self.losses.add("line number of a line that has no block", unused);
        }
    }

    /// Counts what had no room.
    pub(in crate::formats) fn lose(&mut self, kind: &'static str, spot: Spot) {
        self.losses.add(kind, spot);
    }

    /// Writes a comment on a line of its own, if there is room for one.
    pub(in crate::formats) fn remark(&self, words: &[u8], text: &mut Vec<u8>) -> bool {
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
                if let Some((digits, _)) = self.number.take() {
                    push_number(&digits, text);
                }
                text.extend_from_slice(b"D\n");
            }
        }
    }

    fn end(&mut self, text: &mut Vec<u8>) {
        let number = self.number.take();
        if !std::mem::replace(&mut self.ended, true) && self.form.end != StopWord::None {
            if let Some((digits, _)) = number {
                push_number(&digits, text);
            }
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
            &Act::Move { travel, element, .. } => {
                let style = self.form.style;
                self.travel(travel, element, spot, text, |block, text| style.write(block, text))
            }
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
            Act::Word(_) => {
                self.losses.add("word", spot);
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
                if let Some(digits) = line_number(words) {
                    self.numbered(digits, spot);
                } else if !self.header(words, text) {
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

/// The digits of a line number, told as a header `N12`.
fn line_number(words: &[u8]) -> Option<&[u8]> {
    let (b'N' | b'n', digits) = words.split_first()? else { return None };
    (!digits.is_empty() && digits.iter().all(u8::is_ascii_digit)).then_some(digits)
}

/// Writes a line number as listings have it: `N  12: `.
fn push_number(digits: &[u8], text: &mut Vec<u8>) {
    text.push(b'N');
    text.extend(std::iter::repeat_n(b' ', NUMBER_WIDTH.saturating_sub(digits.len())));
    text.extend_from_slice(digits);
    text.extend_from_slice(b": ");
}

/// As wide as the numbers of the listings seen.
const NUMBER_WIDTH: usize = 4;

pub(in crate::formats) fn refusal(
    message: impl Into<String>,
    spot: Spot,
    help: impl Into<Cow<'static, str>>,
) -> WriteError {
    WriteError { message: message.into(), spot, help: help.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Writer as _;
    use crate::formats::three_b::motions::Motions;
    use crate::interpolator::Model;
    use crate::motion::{Flag, Side};

    fn motion(act: Act) -> Motion {
        Motion { act, block: 1, spot: Spot { byte: 7, line: 2, column: 3 } }
    }

    fn line(travel: Travel, from: (f64, f64), to: (f64, f64)) -> Motion {
        let element = Element::Line { start: Point::new(from.0, from.1), end: Point::new(to.0, to.1) };
        motion(Act::Move { travel, element, upper: None, flag: None })
    }

    fn write(form: Form, motions: &[Motion]) -> Result<(String, Writer), WriteError> {
        let (mut writer, mut text) = (Writer::new(form), Vec::new());
        for motion in motions {
            writer.write(motion, &mut text)?;
        }
        writer.finish(&mut text)?;
        Ok((String::from_utf8_lossy(&text).into_owned(), writer))
    }

    fn lost(writer: &Writer) -> Vec<(&'static str, u64)> {
        writer.lost().iter().map(|loss| (loss.kind, loss.count)).collect()
    }

    #[test]
    fn between_contours_the_control_stops_runs_and_stops() {
        use Travel::{Cut, Rapid};
        let motions = [
            line(Rapid, (0.0, 0.0), (2.0, 1.0)),
            line(Cut, (2.0, 1.0), (3.0, 1.0)),
            line(Cut, (3.0, 1.0), (2.0, 1.0)),
            line(Rapid, (2.0, 1.0), (2.0, 4.0)),
            line(Rapid, (2.0, 4.0), (0.0, 4.0)),
            line(Cut, (0.0, 4.0), (1.0, 4.0)),
            motion(Act::Stop(Stop::Pause)),
            line(Rapid, (1.0, 4.0), (0.0, 4.0)),
            motion(Act::Stop(Stop::End)),
        ];
        let form = Form { aim: Aim::One(Model::Rotated), ..Form::default() };
        let (text, writer) = write(form, &motions).unwrap();
        let expected = [
            "B1000B0B001000GXL1",
            "B1000B0B001000GXL3",
            "D",
            "B0B3000B003000GYL2",
            "B2000B0B002000GXL3",
            "D",
            "B1000B0B001000GXL1",
            "D",
            "B1000B0B001000GXL3",
            "DD",
        ];
        assert_eq!(text.lines().collect::<Vec<_>>(), expected);
        assert_eq!(writer.start_hole(), Some(Point::new(2.0, 1.0)));
        assert_eq!(lost(&writer), [("way from the program's zero to the start hole", 1)]);
        assert_eq!(writer.stands(), Position::new(0, 4000));
        // What is said between contours survives reading and writing.
        let again: Vec<Motion> =
            Motions::of_three_b(text.as_bytes(), Model::Rotated).map(|motion| motion.unwrap()).collect();
        assert_eq!(write(form, &again).unwrap().0, text);
        let commented = write(Form { remarks: Remarks::Brackets, ..form }, &motions[..2]).unwrap().0;
        assert_eq!(commented, "( start hole at X 2.000 Y 1.000 )\nB1000B0B001000GXL1\nDD\n");
    }

    #[test]
    fn a_contour_closes_on_the_micron_where_it_opened() {
        let third = 1.0 / 3.0;
        let nodes = [(0.0, 0.0), (third, third), (7.0 * third, 0.1), (2.0, 5.0 * third), (third, third)];
        let mut motions: Vec<Motion> =
            nodes.windows(2).map(|pair| line(Travel::Cut, pair[0], pair[1])).collect();
        for aim in [Aim::Any, Aim::One(Model::Rotated), Aim::One(Model::Mirrored)] {
            let form = Form { aim, ..Form::default() };
            let opened = write(form, &motions[..1]).unwrap().1.stands();
            assert_eq!(write(form, &motions).unwrap().1.stands(), opened, "{aim:?}");
        }
        motions.push(line(Travel::Cut, nodes[1], nodes[0]));
        assert_eq!(write(Form::default(), &motions).unwrap().1.stands(), Position::new(0, 0));
    }

    #[test]
    fn what_3b_has_no_word_for_is_refused_with_its_place() {
        let element = Element::Line { start: Point::origin(), end: Point::new(1.0, 0.0) };
        let moved = |upper, flag| Act::Move { travel: Travel::Cut, element, upper, flag };
        let offset = Offset::On { side: Side::Left, distance: Some(0.1), register: None };
        for (act, wanted) in [
            (Act::Offset(offset), "adds no offset"),
            (Act::Taper(Taper::On { side: Side::Right, angle: 1.0 }), "no word for a taper"),
            (moved(Some(element), None), "moves them apart"),
            (moved(None, Some(Flag::D)), "a flag asks"),
        ] {
            let refused = write(Form::default(), &[motion(act)]).unwrap_err();
            assert!(refused.message.contains(wanted), "{refused}");
            assert_eq!((refused.spot.line, refused.spot.column), (2, 3));
            assert!(!refused.help.is_empty());
        }
        let off = [Act::Offset(Offset::Off), Act::Taper(Taper::Off)].map(motion);
        assert_eq!(write(Form::default(), &off).unwrap().0, "DD\n");
        let after_end = [motion(Act::Stop(Stop::End)), line(Travel::Cut, (0.0, 0.0), (1.0, 0.0))];
        assert!(write(Form::default(), &after_end).unwrap_err().message.contains("after the end"));
        for (from, to) in
            [((0.0, 0.0), (1.1e6, 0.0)), ((f64::NAN, 0.0), (1.0, 0.0)), ((0.0, 0.0), (0.0, f64::INFINITY))]
        {
            assert!(write(Form::default(), &[line(Travel::Cut, from, to)]).is_err(), "{to:?}");
        }
        let gap = [line(Travel::Cut, (0.0, 0.0), (1.0, 0.0)), line(Travel::Cut, (1.5, 0.0), (2.0, 0.0))];
        assert!(write(Form::default(), &gap).unwrap_err().message.contains("ended at (1.000, 0.000)"));
    }

    #[test]
    fn what_is_left_out_is_counted_by_kind() {
        let words = |text: &[u8]| Box::<[u8]>::from(text);
        let acts = [
            Act::Comment(words(b"one")),
            Act::Comment(words(b"two")),
            Act::Header(words(b"%")),
            Act::Word(words(b"C001")),
            Act::Header(words(b"N12")),
            Act::Unknown(words(b"Q7")),
            Act::Dwell(0.5),
            Act::Stop(Stop::Optional),
        ];
        let motions = acts.map(motion);
        let (text, writer) = write(Form::default(), &motions).unwrap();
        assert_eq!(text, "D\nDD\n");
        let optional = "stop on request (M01), written as a stop in any case (D)";
        let kinds = ["comment", "header line", "word", "line number", "unknown word", "dwell", optional];
        let expected: Vec<_> =
            kinds.into_iter().map(|kind| (kind, if kind == "comment" { 2 } else { 1 })).collect();
        assert_eq!(lost(&writer), expected);
        assert_eq!(writer.lost().iter().next().unwrap().first.line, 2);
    }

    #[test]
    fn comments_headers_and_numbers_survive_where_there_is_room_for_them() {
        let listing = "%\n*****\nStart Point = 0.0, 0.0 ; X , Y\n(one (of two)\nN   1: B5000B0B005000GXL1\n; 5.000, 0.000\n\
                       N 40: B0B5000B005000GYL2\nB7000B0B7000GXL1\n(\u{96f6}\u{4ef6})\nN  41: DD\n%\n";
        let read = |text: &str| -> Vec<Motion> {
            let motions = Motions::of_three_b(text.as_bytes(), Model::Rotated);
            motions.map(|motion| Motion { spot: Spot::default(), ..motion.unwrap() }).collect()
        };
        for remarks in [Remarks::Brackets, Remarks::Semicolons] {
            let aim = Aim::One(Model::Rotated);
            let form = Form { remarks, numbers: Numbers::AsRead, aim, ..Form::default() };
            let (text, writer) = write(form, &read(listing)).unwrap();
            assert!(writer.lost().is_empty(), "{:?}", writer.lost());
            assert_eq!(read(&text), read(listing), "{text}");
            assert!(text.contains("N   1: B5000B0") && text.contains("N  40: B0B5000"), "{text}");
            assert!(text.contains("\nB7000B0B007000GXL1\n") && text.contains("N  41: DD"), "{text}");
        }
        let (text, writer) = write(
            Form { numbers: Numbers::All, aim: Aim::One(Model::Rotated), ..Form::default() },
            &read(listing),
        )
        .unwrap();
        assert!(text.contains("N   2: B0B5000B005000GYL2\nN   3: B7000B0"), "{text}");
        assert!(lost(&writer).contains(&("line number", 3)), "{:?}", writer.lost());
        // A header of another format would be no header here.
        let foreign = [motion(Act::Header(b"O1234".as_slice().into()))];
        let form = Form { remarks: Remarks::Brackets, ..Form::default() };
        assert_eq!(write(form, &foreign).unwrap().0, "(O1234)\nDD\n");
    }

    #[test]
    fn blocks_are_counted_and_nothing_is_said_behind_the_end() {
        let motions = [
            line(Travel::Cut, (0.0, 0.0), (1.0, 0.0)),
            line(Travel::Cut, (1.0, 0.0), (1.0, 1.0)),
            line(Travel::Cut, (1.0, 1.0), (0.0, 1.0)),
            motion(Act::Stop(Stop::End)),
            motion(Act::Stop(Stop::Pause)),
            motion(Act::Stop(Stop::End)),
        ];
        let (text, mut writer) = write(Form::default(), &motions).unwrap();
        assert_eq!((text.lines().count(), writer.blocks()), (4, 3), "{text}");
        assert!(text.ends_with("L3\nDD\n"), "{text}");
        writer.lose("ratio", Spot { byte: 9, line: 3, column: 1 });
        assert_eq!(lost(&writer), [("stop after the end", 2), ("ratio", 1)]);
    }

    #[test]
    fn a_header_is_written_as_it_stands_only_if_it_reads_back_whole() {
        let header = |words: &str| motion(Act::Header(words.as_bytes().into()));
        let form = Form { remarks: Remarks::Brackets, numbers: Numbers::AsRead, ..Form::default() };
        for (words, written) in [
            ("%", "%\n"),
            ("*** one ***", "*** one ***\n"),
            ("Start Point = 1", "Start Point = 1\n"),
            ("% of what", "(% of what)\n"),
            ("Start = 1 ; X", "Start = 1 ; X\n"),
            ("N", "(N)\n"),
            ("N7B", "(N7B)\n"),
            ("(one)", ";(one)\n"),
        ] {
            assert_eq!(write(form, &[header(words)]).unwrap().0, format!("{written}DD\n"), "{words}");
        }
        // A number waits for a line it can stand before.
        assert_eq!(write(form, &[header("N7")]).unwrap().0, "N   7: DD\n");
        assert_eq!(write(form, &[header("n12345")]).unwrap().0, "N12345: DD\n");
    }

    #[test]
    fn an_arc_flatter_than_any_block_can_say_is_cut_as_its_chords() {
        let radius = 2e6;
        let half = 50.0f64;
        let rise = radius - (radius * radius - half * half).sqrt();
        let arc = Element::Arc {
            start: Point::new(-half, 0.0),
            end: Point::new(half, 0.0),
            centre: Point::new(0.0, rise - radius),
            sense: crate::geometry::Sense::Clockwise,
        };
        let act = Act::Move { travel: Travel::Cut, element: arc, upper: None, flag: None };
        let (text, writer) = write(Form::default(), &[motion(act)]).unwrap();
        assert!(text.lines().count() > 1 && !text.contains('R'), "{text}");
        assert_eq!(writer.stands(), Position::new(50_000, 0));
    }
}
