//! Sender to control: the driver's FIFO and the shift register.
//!
//! A link that opens or closes is a mark among the characters, so that what was in the FIFO before still arrives
//! before. Within one busy run the n-th character completes at start + n character times exactly.

use std::collections::VecDeque;
use std::time::Duration;

use super::pace::Pace;

pub(crate) struct Forward {
    pace: Pace,
    capacity: usize,
    fifo: VecDeque<u8>,
    shifting: Option<u8>,
    run: Run,
    /// The driver may begin another character.
    open: bool,
    /// Characters put in since the beginning, and those that have left the shift register.
    put: u64,
    left: u64,
    marks: VecDeque<(u64, Mark)>,
}

/// Something that happens to the link between two characters.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Mark {
    Opened,
    Closed,
}

/// An unbroken run of characters on the line.
struct Run {
    start: Duration,
    completed: u64,
}

impl Forward {
    pub(crate) fn new(pace: Pace, capacity: usize) -> Self {
        Forward {
            pace,
            capacity,
            fifo: VecDeque::with_capacity(capacity),
            shifting: None,
            run: Run { start: Duration::ZERO, completed: 0 },
            open: true,
            put: 0,
            left: 0,
            marks: VecDeque::new(),
        }
    }

    pub(crate) fn room(&self) -> usize {
        self.capacity.saturating_sub(self.fifo.len())
    }

    /// Characters that have not yet reached the control, the one being shifted included.
    pub(crate) fn queued(&self) -> usize {
        self.fifo.len() + usize::from(self.shifting.is_some())
    }

    pub(crate) fn put(&mut self, bytes: &[u8], now: Duration) -> usize {
        let accepted = bytes.len().min(self.room());
        self.fifo.extend(&bytes[..accepted]);
        self.put += u64::try_from(accepted).unwrap_or(u64::MAX);
        self.begin(now);
        accepted
    }

    fn begin(&mut self, now: Duration) {
        if self.open && self.shifting.is_none() {
            self.run = Run { start: now, completed: 0 };
            self.shifting = self.fifo.pop_front();
        }
    }

    /// A line of the control stops the driver after the character on the line, or lets it go on.
    pub(crate) fn gate(&mut self, open: bool, now: Duration) {
        self.open = open;
        self.begin(now);
    }

    pub(crate) fn mark(&mut self, mark: Mark) {
        self.marks.push_back((self.put, mark));
    }

    /// Whether [`Forward::due_mark`] would give one.
    pub(crate) fn mark_is_due(&self) -> bool {
        self.marks.front().is_some_and(|&(position, _)| position <= self.left)
    }

    /// The next mark, once every character put in before it has left the line.
    pub(crate) fn due_mark(&mut self) -> Option<Mark> {
        if !self.mark_is_due() {
            return None;
        }
        self.marks.pop_front().map(|(_, mark)| mark)
    }

    /// When the character in the shift register is complete.
    pub(crate) fn completion(&self) -> Option<Duration> {
        self.shifting?;
        Some(self.run.start + self.pace.time_of(self.run.completed + 1))
    }

    /// Takes the complete character off the line and begins the next.
    pub(crate) fn complete(&mut self) -> Option<u8> {
        let byte = self.shifting.take()?;
        self.run.completed += 1;
        self.left += 1;
        self.shifting = if self.open { self.fifo.pop_front() } else { None };
        Some(byte)
    }

    /// The cable is out: everything on its way is lost, marks among it included.
    pub(crate) fn cut(&mut self) {
        self.fifo.clear();
        self.shifting = None;
        self.marks.clear();
        self.left = self.put;
    }
}
