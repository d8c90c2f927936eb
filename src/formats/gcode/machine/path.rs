//! The motion of a block: its element, and that of the wire's upper end.

use super::{Length, Machine, Now, Sense as Words};
use crate::formats::ReadError;
use crate::formats::gcode::arcs::{Arc, Nanometres, point};
use crate::formats::gcode::dialect::{ArcCentre, Code, I, J, K, L, LENGTHS, R, Role, U, V, X, Y};
use crate::formats::gcode::modal::Mode;
use crate::formats::gcode::numbers::LENGTH_MAX;
use crate::formats::gcode::words::{Kind, Word};
use crate::geometry::{Element, Sense};
use crate::motion::{Act, Travel};

type Lengths = [Option<Length>; LENGTHS];

impl Machine {
    /// G92: the program's coordinates of where the wire is.
    pub(super) fn position(
        &mut self,
        word: &Word,
        lengths: &Lengths,
        now: &mut Now<'_>,
    ) -> Result<(), ReadError> {
        if let Some(wrong) = [R, K, L, I, J].into_iter().find_map(|place| lengths[place]) {
            return Err(now.error(&wrong.word, "has no meaning in a G92 block", "leave it out"));
        }
        for (axis, place) in [X, Y].into_iter().enumerate() {
            let Some(given) = lengths[place] else { continue };
            if self.is_placed {
                self.shift[axis] = self.at[axis] - given.value;
            } else {
                self.at[axis] = given.value;
            }
        }
        // Heights alone place nothing.
        let is_placed = lengths[X].is_some() || lengths[Y].is_some();
        for (axis, place) in [U, V].into_iter().enumerate() {
            if let Some(given) = lengths[place] {
                self.lean[axis] = given.value;
            }
        }
        self.is_placed |= is_placed;
        if self.dialect.heights {
            let mut text = b"G92".to_vec();
            for letter in [b'I', b'J'] {
                if let Some(height) = self.height(letter, now) {
                    text.push(b' ');
                    text.extend_from_slice(height.text(now.line.bytes));
                }
            }
            if text.len() > 3 {
                now.tell(Act::Word(text.into()), word);
            }
        }
        Ok(())
    }

    /// A height of a plane in the line in work.
    fn height(&self, letter: u8, now: &Now<'_>) -> Option<Word> {
        let mut words = Vec::new();
        super::words::cut(now.line.bytes, &mut words).ok()?;
        words.into_iter().find(|w| w.letter == letter)
    }

    /// The motion of a block, if it has one.
    pub(super) fn travel(
        &mut self,
        lengths: &Lengths,
        upper: Option<&[Word]>,
        words: &Words,
        now: &mut Now<'_>,
    ) -> Result<(), ReadError> {
        let Some(first) = lengths.iter().flatten().next().copied() else {
            return match upper {
                None => Ok(()),
                Some(_) => {
                    Err(now.error_of_block("nothing to move before the `:`", "both halves are motions"))
                }
            };
        };
        if words.dwell.is_some() {
            return Err(now.error(
                &first.word,
                "has no meaning in a dwell",
                "a motion stands in a block of its own",
            ));
        }
        if let Some(unknown) = words.unknown {
            let help = "what the axes of the block mean depends on it; add it to the dialect or take it out";
            return Err(now.error(&unknown, "a G word the dialect does not know, with axes", help));
        }
        let mode = self.modal.travel.ok_or_else(|| {
            now.error(&first.word, "no word has said how to move", "begin with G00, G01, G02 or G03")
        })?;
        let target = self.target(lengths, self.at, now)?;
        let element = self.element(mode, self.at, target, lengths, now)?;
        let upper = match upper {
            Some(words) => Some(self.upper_half(words, mode, target, now)?),
            None => self.upper(mode, &element, target, lengths, now)?,
        };
        self.at = target;
        self.is_placed = true;
        let travel = if mode == Mode::Rapid { Travel::Rapid } else { Travel::Cut };
        now.tell(Act::Move { travel, element, upper, flag: None }, &first.word);
        Ok(())
    }

    /// Where X and Y lead.
    fn target(&self, lengths: &Lengths, from: Nanometres, now: &Now<'_>) -> Result<Nanometres, ReadError> {
        let mut target = from;
        for (axis, place) in [X, Y].into_iter().enumerate() {
            let Some(given) = lengths[place] else { continue };
            let base = if self.modal.incremental { from[axis] } else { self.shift[axis] };
            target[axis] = base + given.value;
            if target[axis].abs() > LENGTH_MAX {
                return Err(now.error(&given.word, "leads more than a kilometre away", "correct the number"));
            }
        }
        Ok(target)
    }

    /// The way to a target.
    fn element(
        &self,
        mode: Mode,
        start: Nanometres,
        end: Nanometres,
        lengths: &Lengths,
        now: &Now<'_>,
    ) -> Result<Element, ReadError> {
        let sense = match mode {
            Mode::Rapid | Mode::Line => {
                if let Some(wrong) = [I, J, R, K, L].into_iter().find_map(|place| lengths[place]) {
                    let message = "belongs to an arc, and the block is a line";
                    return Err(now.error(&wrong.word, message, "write G02 or G03, or leave it out"));
                }
                return Ok(Element::Line { start: point(start), end: point(end) });
            }
            Mode::Clockwise => Sense::Clockwise,
            Mode::CounterClockwise => Sense::CounterClockwise,
        };
        let arc = Arc {
            start,
            end,
            sense,
            offset: [I, J].map(|place| lengths[place].map(|l| l.value)),
            radius: lengths[R].map(|l| l.value),
            shift: self.shift,
            tolerance: self.dialect.arc_tolerance(self.modal.unit),
            is_kept: self.dialect.keeps_wrong_arcs,
        };
        arc.element(self.dialect.arc_centre).map_err(|wrong| now.error_of_block(wrong.message, wrong.help))
    }

    /// The way of the upper end as U and V, and in an arc K and L, give it; none where the wire stays upright.
    fn upper(
        &mut self,
        mode: Mode,
        lower: &Element,
        target: Nanometres,
        lengths: &Lengths,
        now: &Now<'_>,
    ) -> Result<Option<Element>, ReadError> {
        let before = self.lean;
        if self.dialect.pairs && before != [0, 0] && lengths[U].is_none() && lengths[V].is_none() {
            let help = "where the ends are apart each block says both motions";
            return Err(now.error_of_block("the upper end has no motion", help));
        }
        for (axis, place) in [U, V].into_iter().enumerate() {
            let Some(given) = lengths[place] else { continue };
            if self.modal.incremental {
                let help = "no manual at hand says whether U and V are increments then: write G90";
                return Err(now.error(&given.word, "U or V with G91", help));
            }
            self.lean[axis] = given.value;
        }
        if before == [0, 0] && self.lean == [0, 0] {
            return Ok(None);
        }
        let start = add(self.at, before);
        let end = add(target, self.lean);
        let Element::Arc { centre, sense, .. } = *lower else {
            return Ok(Some(Element::Line { start: point(start), end: point(end) }));
        };
        if mode == Mode::Rapid {
            return Ok(None);
        }
        // The centre is that of the lower arc, moved by K and L; without these, moved as the ends are, if that fits.
        let centre = [centre.x, centre.y].map(|mm| (mm * 1e6).round() as i64);
        let given = [K, L].map(|place| lengths[place].map(|l| l.value));
        let moves = match given {
            [None, None] => [[0, 0], before],
            [k, l] => [[k.unwrap_or(0), l.unwrap_or(0)]; 2],
        };
        let mut wrong = None;
        for by in moves {
            let middle = add(centre, by);
            let arc = Arc {
                start,
                end,
                sense,
                offset: [Some(middle[0] - start[0]), Some(middle[1] - start[1])],
                radius: None,
                shift: [0, 0],
                tolerance: self.dialect.arc_tolerance(self.modal.unit),
                is_kept: false,
            };
            match arc.element(ArcCentre::FromStart) {
                Ok(element) => return Ok(Some(element)),
                Err(error) => wrong = wrong.or(Some(error)),
            }
        }
        let message = wrong.map_or(String::new(), |w| w.message);
        Err(now.error_of_block(
            format!("upper end: {message}"),
            "U and V, and K and L where the dialect has them, must give an arc",
        ))
    }

    /// The motion behind a `:`.
    fn upper_half(
        &mut self,
        words: &[Word],
        lower_mode: Mode,
        target: Nanometres,
        now: &mut Now<'_>,
    ) -> Result<Element, ReadError> {
        let mut lengths = [None; LENGTHS];
        for word in words {
            let wrong = "has no meaning behind a `:`";
            match word.kind {
                Kind::Comment => {
                    self.piece(word, now)?;
                    continue;
                }
                Kind::Word => {}
                _ => return Err(now.error(word, wrong, "the motion of the upper end stands there")),
            }
            if word.letter == b'G' {
                match self.dialect.g_code(word) {
                    Code::Travel(mode) => self.upper_mode = Some(mode),
                    _ => return Err(now.error(word, wrong, "only G00 to G03 stand there")),
                }
                continue;
            }
            match self.dialect.role(word.letter) {
                Role::Length(place) if [X, Y, I, J, R].contains(&usize::from(place)) => {
                    let value = self.length(word, now)?;
                    if lengths[usize::from(place)].is_some() {
                        return Err(now.error(
                            word,
                            "the half has this word already",
                            "leave one of them out",
                        ));
                    }
                    lengths[usize::from(place)] = Some(Length { value, word: *word });
                }
                _ => return Err(now.error(word, wrong, "only axes and centres stand there")),
            }
        }
        let start = add(self.at, self.lean);
        let end = self.target(&lengths, start, now)?;
        let mode = self.upper_mode.unwrap_or(lower_mode);
        let element = self.element(mode, start, end, &lengths, now)?;
        self.lean = [end[0] - target[0], end[1] - target[1]];
        Ok(element)
    }
}

fn add(a: Nanometres, b: Nanometres) -> Nanometres {
    [a[0] + b[0], a[1] + b[1]]
}
