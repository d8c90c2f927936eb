//! What a 3B or 4B program makes the machine do.
//!
//! A block begins where the last one really ended, so positions add up in whole microns from where the first block
//! begins, each end taken from the model of the control that is stated. An arc's centre follows from its block; its end
//! lies on its circle as nearly as pulses can. An arc that goes round more than once becomes several motions of one block.
//!
//! 3B has no rapid: the way between two contours is a line between two stop words `D`, and stays what it is.

use std::io;

use super::read::{Entry, Item, Reader};
use super::{Block, Motion as Instruction};
use crate::formats::ReadError;
use crate::formats::four_b::Fourth;
use crate::geometry::{Element, Point, Sense};
use crate::interpolator::{Branch, COORDINATE_MAX, Model};
use crate::motion::{Act, Flag, Motion, Stop, Text, Travel};
use crate::units::{Micrometres, Position};

/// The motions of a program, one at a time.
#[derive(Debug)]
pub struct Motions<R> {
    reader: Reader<R>,
    model: Model,
    at: Position,
    /// Blocks read.
    block: u64,
    /// What a block says besides its move, told first.
    waiting: Option<Move>,
    round: Option<Round>,
    over: bool,
    is_four_b: bool,
    last: Option<Block>,
}

/// A block read and not yet told.
#[derive(Clone, Copy, Debug)]
struct Move {
    block: Block,
    flag: Option<Flag>,
}

/// An arc that is told in pieces.
#[derive(Clone, Copy, Debug)]
struct Round {
    block: Block,
    flag: Option<Flag>,
    sense: Sense,
    start: Position,
    pieces: i64,
    told: i64,
}

impl<R: io::Read> Motions<R> {
    /// The motions of a 3B program, on a control of a model.
    pub fn of_three_b(source: R, model: Model) -> Self {
        Self::of(Reader::new(source), model, false)
    }

    /// The motions of a program in which 3B and 4B are mixed.
    pub fn of_four_b(source: R, model: Model) -> Self {
        Self::of(Reader::of_four_b(source), model, true)
    }

    fn of(reader: Reader<R>, model: Model, is_four_b: bool) -> Self {
        Self {
            reader,
            model,
            at: Position::default(),
            block: 0,
            waiting: None,
            round: None,
            over: false,
            is_four_b,
            last: None,
        }
    }

    /// Goes on behind an error, at another place of the same program, from where the control stands.
    pub fn go_on_from(&mut self, source: R) {
        self.reader = if self.is_four_b { Reader::of_four_b(source) } else { Reader::new(source) };
        (self.waiting, self.round, self.over) = (None, None, false);
    }

    /// The block the last motion came from; none where it came from none, or is a further piece of an arc.
    #[must_use]
    pub fn last_block(&self) -> Option<Block> {
        self.last
    }

    /// The text of the last block or stop word as it goes to the control.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        self.reader.text()
    }

    /// Where the control stands.
    #[must_use]
    pub fn stands(&self) -> Position {
        self.at
    }

    fn next_motion(&mut self) -> Result<Option<Motion>, ReadError> {
        self.last = None;
        if let Some(round) = self.round.take() {
            return Ok(Some(self.piece(round)));
        }
        if let Some(waiting) = self.waiting.take() {
            return self.travel(waiting).map(Some);
        }
        let Some(entry) = self.reader.next_entry()? else { return Ok(None) };
        let act = match entry {
            Entry::Item(Item::Block(block)) => {
                self.block += 1;
                let beyond = self.reader.beyond();
                let this = Move { block, flag: beyond.flag };
                let Some(Fourth::Ratio(ratio)) = beyond.fourth else {
                    return self.travel(this).map(Some);
                };
                self.waiting = Some(this);
                let mut text = b"L".to_vec();
                ratio.write(&mut text);
                Act::Word(text.into())
            }
            Entry::Item(Item::StopWord("D")) => Act::Stop(Stop::Pause),
            Entry::Item(Item::StopWord(_)) => Act::Stop(Stop::End),
            Entry::Comment => Act::Comment(self.reader.text().into()),
            Entry::Header => Act::Header(self.reader.text().into()),
            Entry::Number => Act::Header(numbered(self.reader.text())),
        };
        Ok(Some(self.told(act)))
    }

    fn told(&self, act: Act) -> Motion {
        Motion { act, block: self.block, spot: self.reader.spot() }
    }

    fn moves(&self, element: Element, flag: Option<Flag>) -> Motion {
        self.told(Act::Move { travel: Travel::Cut, element, upper: None, flag })
    }

    /// Runs a block.
    fn travel(&mut self, Move { block, flag }: Move) -> Result<Motion, ReadError> {
        self.last = Some(block);
        let start = self.at;
        let end = self.end_of(&block, start)?;
        let line = Element::Line { start: millimetres(start), end: millimetres(end) };
        let Instruction::Arc(sense, _) = block.motion else {
            self.at = end;
            return Ok(self.moves(line, flag));
        };
        let told = match Branch::at(block.signed(), sense) {
            Ok(branch) if block.j.0 > 0 => {
                let turns = block.j.0 as f64 / branch.turn(self.model.bend());
                told_as(turns, block.signed(), end - start, sense)
            }
            // Nothing is counted, so nothing moves: not the full circle that an arc with equal ends would be.
            Ok(_) | Err(_) => Told::Line,
        };
        let Told::Arcs(pieces) = told else {
            self.at = end;
            return Ok(self.moves(line, flag));
        };
        Ok(self.piece(Round { block, flag, sense, start, pieces, told: 0 }))
    }

    /// The next piece of an arc.
    fn piece(&mut self, mut round: Round) -> Motion {
        round.told += 1;
        let j = Micrometres(round.block.j.0 * round.told / round.pieces);
        let piece_end = self.model.displacement(&Block { j, ..round.block });
        let start = self.at;
        // A shorter count of a block that comes to its end comes to its end too.
        self.at = round.start + piece_end.unwrap_or_default();
        let centre = millimetres(round.start - round.block.signed());
        let (from, to) = (millimetres(start), millimetres(self.at));
        let motion =
            self.moves(Element::Arc { start: from, end: to, centre, sense: round.sense }, round.flag);
        self.round = (round.told < round.pieces).then_some(round);
        motion
    }

    /// Where a block ends.
    fn end_of(&self, block: &Block, start: Position) -> Result<Position, ReadError> {
        let moved = self.model.displacement(block).map_err(|fault| {
            let message = format!("{fault}, on a control of the model `{}`", self.model.name());
            self.reader.error_here(message, "check G and the digit of Z, or state the control's model")
        })?;
        let end = start + moved;
        if end.x.abs().0.max(end.y.abs().0) > COORDINATE_MAX {
            let message = "the wire is led more than a kilometre from its start".to_owned();
            return Err(self.reader.error_here(message, "no machine is that large: check X, Y and J"));
        }
        Ok(end)
    }
}

impl<R: io::Read> Iterator for Motions<R> {
    type Item = Result<Motion, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let motion = self.next_motion().transpose();
        self.over = !matches!(motion, Some(Ok(_)));
        motion
    }
}

/// How an arc is told.
#[derive(Clone, Copy, Debug)]
enum Told {
    Line,
    /// As so many arcs, one behind the other.
    Arcs(i64),
}

/// How an arc is told that goes round so many `turns`, begins at `from` as seen from the centre, and ends so far away as
/// it has `moved`.
///
/// The ends of an arc say how far it goes, if it is less than a whole turn and more than a pulse or two: one that has not
/// come ahead of its start would be taken for a whole turn, and is a line. Near a whole turn the ends say it where the arc
/// ends short of its start, or on it. Beyond, half turns are told: they are far from what could be mistaken.
fn told_as(turns: f64, from: Position, moved: Position, sense: Sense) -> Told {
    let cross = from.x.0 * moved.y.0 - from.y.0 * moved.x.0;
    let ahead = match sense {
        Sense::CounterClockwise => cross > 0,
        Sense::Clockwise => cross < 0,
    };
    if turns < 0.25 && !ahead {
        Told::Line
    } else if turns <= 0.75 || !turns.is_finite() || (turns < 1.25 && !ahead) {
        Told::Arcs(1)
    } else if turns < 1.25 {
        Told::Arcs(2)
    } else {
        Told::Arcs((2.0 * turns).ceil() as i64)
    }
}

fn millimetres(at: Position) -> Point {
    Point::new(at.x.millimetres(), at.y.millimetres())
}

/// A line number as a header, as G-code's are.
fn numbered(digits: &[u8]) -> Text {
    [b"N", digits].concat().into()
}

#[cfg(test)]
mod tests;
