//! What a writer had to leave out, counted by kind, so that nothing a program says is lost in silence.

use crate::place::Spot;

/// Counts of what was left out.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Losses {
    losses: Vec<Loss>,
}

/// What was left out of one kind.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Loss {
    /// What, in the singular: "comment", "dwell".
    pub kind: &'static str,
    /// How often.
    pub count: u64,
    /// Where the first of them stands in the source.
    pub first: Spot,
}

impl Losses {
    /// Counts one more.
    pub fn add(&mut self, kind: &'static str, spot: Spot) {
        match self.losses.iter_mut().find(|loss| loss.kind == kind) {
            Some(loss) => loss.count += 1,
            None => self.losses.push(Loss { kind, count: 1, first: spot }),
        }
    }

    /// The losses, in the order in which their kinds were first met.
    pub fn iter(&self) -> impl Iterator<Item = &Loss> {
        self.losses.iter()
    }

    /// Whether nothing was left out.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.losses.is_empty()
    }
}
