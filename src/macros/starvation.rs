//! Whether the line can keep up with the machine: what is made, executed on paper against the wire.
//!
//! Each block takes the control its length over the feed, and the line its characters; the control's buffer lies between
//! them, full at first. Where it runs empty the machine stands still between blocks, and on the part that shows. Straight
//! moves in X, Y, Z with a feed a minute (G94) are counted; an arc by its chord, so that it never seems slower than it is. A
//! block whose length or feed is not known (without a point under no rule, G93, G95, from nowhere) is passed over. Acceleration is not known, so a machine wants less than is said here, never more.

use super::block::{Amount, Block, Word};
use super::form::Form;
use super::number::Number;
use crate::formats::gcode::numbers::POWERS;

/// The line and the control's buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Characters a second.
    pub rate: f64,
    /// Characters the control holds.
    pub buffer: f64,
    /// Characters that end a block.
    pub end_of_block: usize,
}

/// A prediction, as far as blocks have been seen.
#[derive(Clone, Debug)]
pub struct Starvation {
    line: Line,
    unit: usize,
    incremental: bool,
    feed_a_minute: bool,
    motion: Option<i64>,
    feed: Option<f64>,
    at: [Option<f64>; 3],
    level: f64,
    account: Account,
}

/// What was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Blocks whose time is known.
    pub blocks: u64,
    /// How long the machine moves in them, seconds.
    pub moving: f64,
    /// How long the line takes for them, seconds.
    pub sending: f64,
    /// How long the machine stands still for want of blocks, seconds.
    pub waiting: f64,
    /// The first block before which it stands still; 0 for none.
    pub first: u64,
}

impl Starvation {
    /// A prediction for a line, before the first block.
    #[must_use]
    pub fn new(line: Line) -> Self {
        Self {
            line,
            unit: 0,
            incremental: false,
            feed_a_minute: true,
            motion: None,
            feed: None,
            at: [None; 3],
            level: line.buffer,
            account: Account::default(),
        }
    }

    /// What was found so far.
    #[must_use]
    pub fn account(&self) -> Account {
        self.account
    }

    /// Sees a block, with its number and how many characters were printed of it.
    pub fn see<N: Number>(&mut self, form: &Form, block: &Block<N>, number: u64, characters: usize) {
        let mut goes = self.at;
        let mut squares = Some(0.0);
        let mut moves = false;
        let mut elsewhere = false;
        for word in &block.words {
            match word.letter {
                b'G' => match word.whole() {
                    Some(motion @ 0..=3) => self.motion = Some(motion),
                    Some(20) => self.unit = 1,
                    Some(21) => self.unit = 0,
                    Some(90) => self.incremental = false,
                    Some(91) => self.incremental = true,
                    Some(94) => self.feed_a_minute = true,
                    Some(93 | 95) => self.feed_a_minute = false,
                    Some(4 | 10 | 17..=19 | 40..=59) => {}
                    _ => elsewhere = true,
                },
                b'F' => self.feed = value(form, self.unit, word).filter(|feed| *feed > 0.0),
                _ => {}
            }
        }
        for word in block.words.iter().filter(|word| matches!(word.letter, b'X'..=b'Z')) {
            let axis = &mut goes[usize::from(word.letter - b'X')];
            let value = value(form, self.unit, word);
            let by = if self.incremental { value } else { value.zip(*axis).map(|(to, from)| to - from) };
            squares = squares.zip(by).map(|(sum, by)| sum + by * by);
            *axis = if self.incremental { value.zip(*axis).map(|(by, from)| from + by) } else { value };
            moves = true;
        }
        self.at = if elsewhere { [None; 3] } else { goes };
        let characters = (characters + self.line.end_of_block) as f64;
        let length = squares.map(f64::sqrt).filter(|_| moves && !elsewhere);
        let feed = self.feed.filter(|_| self.feed_a_minute && matches!(self.motion, Some(1..=3)));
        let Some((length, feed)) = length.zip(feed) else {
            // The control takes it out of its buffer at once, or for as long as nobody knows: the line has the time.
            return;
        };
        let (moving, sending) = (60.0 * length / feed, characters / self.line.rate);
        self.account.blocks += 1;
        self.account.moving += moving;
        self.account.sending += sending;
        self.level += moving * self.line.rate - characters;
        // Half a character: less is rounding.
        if self.level < -0.5 {
            self.account.waiting += -self.level / self.line.rate;
            if self.account.first == 0 {
                self.account.first = number;
            }
            self.level = 0.0;
        }
        self.level = self.level.min(self.line.buffer);
    }
}

impl Account {
    /// In words; none where the line keeps up.
    #[must_use]
    pub fn text(&self) -> Option<String> {
        if self.first == 0 || self.moving <= 0.0 {
            return None;
        }
        let blocks = self.blocks as f64;
        Some(format!(
            "at the programmed feed the control wants {:.1} blocks a second, and the line carries {:.1}: from block {} on the machine \
             waits for blocks, {:.0} % of its time",
            blocks / self.moving,
            blocks / self.sending,
            self.first,
            100.0 * self.waiting / (self.moving + self.waiting),
        ))
    }
}

/// In the program's unit.
fn value<N: Number>(form: &Form, unit: usize, word: &Word<N>) -> Option<f64> {
    match word.amount {
        Amount::Written { number, .. } if word.letter == b'F' => Some(number.decimal()),
        Amount::Written { number, .. } => form
            .value(unit, number)
            .map(|value| value as f64 / POWERS[usize::from(form.decimals[unit])] as f64),
        Amount::Computed(value) => Some(value.approximate()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::macros::decimal::Decimal;

    fn step(x_micrometres: i64) -> Block<Decimal> {
        let whole = |n| Amount::Computed(Decimal::whole(n));
        let words = vec![
            Word { letter: b'G', amount: whole(1) },
            Word { letter: b'X', amount: Amount::Computed(Decimal::written(x_micrometres, 3)) },
            Word { letter: b'Y', amount: whole(0) },
            Word { letter: b'Z', amount: whole(0) },
            Word { letter: b'F', amount: whole(60) },
        ];
        Block { words, ..Block::default() }
    }

    /// 60 mm/min are 1 mm/s: a block of 0.1 mm takes the machine 0.1 s, and 20 characters take the line 0.2 s.
    #[test]
    fn a_line_of_half_the_speed_makes_the_machine_wait_half_the_time() {
        let line = Line { rate: 100.0, buffer: 1000.0, end_of_block: 1 };
        let mut starvation = Starvation::new(line);
        for n in 0..=1000 {
            starvation.see(&Form::default(), &step(100 * n), n as u64 + 1, 19);
        }
        let account = starvation.account();
        assert_eq!(account.blocks, 1000, "where the first begins is not known");
        assert!((account.moving - 100.0).abs() < 1e-9 && (account.sending - 200.0).abs() < 1e-9);
        // 1000 characters are there at first, the line is 10 short a block: for 100 blocks they last.
        assert_eq!(account.first, 102);
        assert!((account.waiting - 90.0).abs() < 1e-6, "{}", account.waiting);
        let text = account.text().unwrap();
        assert!(text.contains("10.0 blocks a second, and the line carries 5.0: from block 102"), "{text}");
        assert!(text.ends_with("47 % of its time"), "{text}");
    }

    #[test]
    fn a_line_that_keeps_up_is_not_spoken_of() {
        let line = Line { rate: 200.0, buffer: 20.0, end_of_block: 1 };
        let mut starvation = Starvation::new(line);
        for n in 0..=1000 {
            starvation.see(&Form::default(), &step(100 * n), n as u64 + 1, 19);
        }
        assert_eq!(starvation.account().text(), None);
    }
}
