//! How much of the time the line could have carried characters it did carry them.
//!
//! `line_utilisation` = character time / (elapsed − held), from the start bit of the first character to the stop bit of
//! the last. Held is, for each hold, the time from DC3's stop bit leaving the control (or from the last character that
//! still came in spite of it, if later) until the DC1 that ends it has reached the sender's program. So it is at most 1,
//! and a sender that never lets the line fall idle reaches 1.

use std::time::Duration;

#[derive(Clone, Debug, Default)]
pub(crate) struct Utilisation {
    first: Option<Duration>,
    last: Duration,
    characters: u64,
    held: Duration,
    hold: Option<Hold>,
}

#[derive(Clone, Copy, Debug)]
struct Hold {
    from: Duration,
    until: Option<Duration>,
}

impl Utilisation {
    /// DC3 has left the control.
    pub(crate) fn hold_begins(&mut self, at: Duration) {
        match &mut self.hold {
            None => self.hold = Some(Hold { from: at, until: None }),
            // The line has been silent since an earlier hold: it goes on.
            Some(hold) => hold.until = None,
        }
    }

    /// DC1 reaches the sender's program at this instant.
    pub(crate) fn hold_ends(&mut self, at: Duration) {
        if let Some(hold) = &mut self.hold {
            hold.until = Some(at);
        }
    }

    pub(crate) fn character(&mut self, completed: Duration, takes: Duration) {
        let start = completed.saturating_sub(takes);
        self.first.get_or_insert(start);
        self.last = completed;
        self.characters += 1;
        if let Some(hold) = &mut self.hold {
            let until = hold.until.unwrap_or(Duration::MAX);
            self.held += start.min(until).saturating_sub(hold.from);
            hold.from = completed;
            if until <= completed {
                self.hold = None;
            }
        }
    }

    /// The sum of all holds that lie between characters.
    pub(crate) fn held(&self) -> Duration {
        self.held
    }

    /// `None` while nothing has come, or no time has passed since.
    pub(crate) fn value(&self, takes: impl Fn(u64) -> Duration) -> Option<f64> {
        let elapsed = self.last.checked_sub(self.first?)?;
        let carrying = takes(self.characters);
        let usable = elapsed.saturating_sub(self.held);
        // Starts are known to the nanosecond only, so the quotient may pass 1 by a hair.
        (!usable.is_zero()).then(|| (carrying.as_secs_f64() / usable.as_secs_f64()).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn a_hold_is_not_idle_but_a_gap_is() {
        let mut line = Utilisation::default();
        // At 1 to 4 ms four characters, DC3 leaves at 3 ms, DC1 arrives at 10 ms, the sender goes on at 12 ms.
        for at in 1..=4 {
            if at == 4 {
                line.hold_begins(3 * MS);
            }
            line.character(at * MS, MS);
        }
        line.hold_ends(10 * MS);
        for at in 13..=16 {
            line.character(at * MS, MS);
        }
        assert_eq!(line.held(), 6 * MS);
        let value = line.value(|count| u32::try_from(count).unwrap_or(0) * MS).unwrap();
        assert!((value - 8.0 / 10.0).abs() < 1e-12, "{value}");
    }

    #[test]
    fn a_hold_after_the_last_character_does_not_count() {
        let mut line = Utilisation::default();
        line.character(MS, MS);
        line.hold_begins(2 * MS);
        line.hold_ends(90 * MS);
        assert_eq!(line.value(|_| MS), Some(1.0));
    }
}
