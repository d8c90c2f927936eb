//! What can go wrong, how often, and dice that fall the same way for the same seed.
//!
//! Each kind rolls dice of its own, so that switching one kind on does not move the others.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;
use std::time::Duration;

/// A kind of fault. The rate of each is a probability from 0 to 1, per character, per DC1, per DC3 or per block.
///
/// In a protocol with answers a DC1 is every answer that lets the sender go on (ACK, `ok`, C), a DC3 every one that makes it wait
/// or send again (NAK, `Resend`); where a line holds the sender they are its going on and off.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum FaultKind {
    /// Per character: one of its seven data bits is turned over, unnoticed by parity.
    Flip,
    /// Per character: it vanishes.
    Drop,
    /// Per character: it arrives twice.
    Double,
    /// Per character: a foreign one arrives before it.
    Insert,
    /// Per character: it arrives with wrong parity; the control raises the alarm `parity`.
    Parity,
    /// Per character: the control's adapter sends it back.
    Echo,
    /// Per character: the cable is pulled; everything on its way in either direction is lost.
    Disconnect,
    /// Per character: the line that says "ready" breaks: DSR and CTS go off for good, and the control, which sees its own go
    /// off, raises the alarm `dsr` (Fanuc's 086).
    DsrDrop,
    /// Per DC1: it is lost on the line. The first one comes again after 5 s, one that ends a hold does not.
    XonLost,
    /// Per DC1: the control sends it 0.5 s to 5 s late.
    XonLate,
    /// Per DC1: the control sends it twice.
    XonDouble,
    /// Per DC3 that begins a hold: it is lost on the line.
    XoffLost,
    /// Per block: the control stands still for 1 s to 5 s before it cuts it.
    Stall,
    /// Per block: it takes ten times as long.
    Slow,
    /// Per block: the control is reset before it: its buffer is cleared, DC3 and SYN are sent, and it is deaf until the
    /// link opens anew.
    Reset,
    /// Per block: the alarm `nak` before it: DC3, then NAK.
    Alarm,
    /// Per block: the alarm `nak-storm` before it: DC3, then twenty NAKs.
    NakStorm,
}

impl FaultKind {
    /// Every kind, in the order of their names' use.
    pub const ALL: [FaultKind; 17] = [
        FaultKind::Flip,
        FaultKind::Drop,
        FaultKind::Double,
        FaultKind::Insert,
        FaultKind::Parity,
        FaultKind::Echo,
        FaultKind::Disconnect,
        FaultKind::DsrDrop,
        FaultKind::XonLost,
        FaultKind::XonLate,
        FaultKind::XonDouble,
        FaultKind::XoffLost,
        FaultKind::Stall,
        FaultKind::Slow,
        FaultKind::Reset,
        FaultKind::Alarm,
        FaultKind::NakStorm,
    ];

    /// The kind's name on the command line and in the report.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            FaultKind::Flip => "flip",
            FaultKind::Drop => "drop",
            FaultKind::Double => "double",
            FaultKind::Insert => "insert",
            FaultKind::Parity => "parity",
            FaultKind::Echo => "echo",
            FaultKind::Disconnect => "disconnect",
            FaultKind::DsrDrop => "dsr-drop",
            FaultKind::XonLost => "xon-lost",
            FaultKind::XonLate => "xon-late",
            FaultKind::XonDouble => "xon-double",
            FaultKind::XoffLost => "xoff-lost",
            FaultKind::Stall => "stall",
            FaultKind::Slow => "slow",
            FaultKind::Reset => "reset",
            FaultKind::Alarm => "alarm",
            FaultKind::NakStorm => "nak-storm",
        }
    }

    fn is_per_character(self) -> bool {
        matches!(
            self,
            FaultKind::Flip
                | FaultKind::Drop
                | FaultKind::Double
                | FaultKind::Insert
                | FaultKind::Parity
                | FaultKind::Echo
                | FaultKind::Disconnect
                | FaultKind::DsrDrop
        )
    }
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The word names no kind of fault.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct UnknownFault;

impl fmt::Display for UnknownFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unknown kind of fault; known are")?;
        for kind in FaultKind::ALL {
            write!(f, " {kind}")?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownFault {}

impl FromStr for FaultKind {
    type Err = UnknownFault;

    fn from_str(word: &str) -> Result<Self, UnknownFault> {
        FaultKind::ALL.into_iter().find(|kind| kind.name() == word).ok_or(UnknownFault)
    }
}

/// The faults asked for, their dice, and what really struck.
pub(crate) struct Faults {
    dice: BTreeMap<FaultKind, (f64, Dice)>,
    struck: BTreeMap<FaultKind, u64>,
    on_characters: bool,
}

impl Faults {
    pub(crate) fn new(rates: &BTreeMap<FaultKind, f64>, seed: u64) -> Self {
        let rates = || rates.iter().filter(|&(_, &rate)| rate > 0.0);
        let dice = rates().map(|(&kind, &rate)| (kind, (rate, Dice::new(seed, kind.name())))).collect();
        let on_characters = rates().any(|(kind, _)| kind.is_per_character());
        Faults { dice, struck: BTreeMap::new(), on_characters }
    }

    /// Whether any character needs a look at all.
    pub(crate) fn on_characters(&self) -> bool {
        self.on_characters
    }

    /// Rolls for one kind; a hit is counted as having struck.
    pub(crate) fn strikes(&mut self, kind: FaultKind) -> bool {
        let hit = match self.dice.get_mut(&kind) {
            Some((rate, dice)) => dice.unit() < *rate,
            None => false,
        };
        if hit {
            *self.struck.entry(kind).or_default() += 1;
        }
        hit
    }

    /// A number below `bound`, from the same dice.
    pub(crate) fn pick(&mut self, kind: FaultKind, bound: u64) -> u64 {
        match self.dice.get_mut(&kind) {
            Some((_, dice)) => dice.next() % bound.max(1),
            None => 0,
        }
    }

    /// A duration between two, in whole milliseconds.
    pub(crate) fn pick_milliseconds(&mut self, kind: FaultKind, from: u64, to: u64) -> Duration {
        Duration::from_millis(from + self.pick(kind, to - from + 1))
    }

    pub(crate) fn struck(&self) -> BTreeMap<String, u64> {
        self.struck.iter().map(|(kind, &count)| (kind.name().to_owned(), count)).collect()
    }
}

/// SplitMix64 (Steele, Lea, Flood 2014): small, and good enough to roll faults.
struct Dice {
    state: u64,
}

impl Dice {
    fn new(seed: u64, name: &str) -> Self {
        let mut state = seed;
        for byte in name.bytes() {
            state = (state ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        }
        Dice { state }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit an f64 exactly")]
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_found_by_its_name_and_no_other_word_is() {
        for kind in FaultKind::ALL {
            assert_eq!(kind.name().parse::<FaultKind>(), Ok(kind));
        }
        assert_eq!("dsr".parse::<FaultKind>(), Err(UnknownFault));
    }

    #[test]
    fn one_kind_does_not_move_the_dice_of_another() {
        let roll = |kinds: &[FaultKind]| {
            let mut faults = Faults::new(&kinds.iter().map(|&kind| (kind, 0.5)).collect(), 7);
            (0..64)
                .map(|_| {
                    faults.strikes(FaultKind::Flip);
                    faults.strikes(FaultKind::Drop)
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(roll(&[FaultKind::Drop]), roll(&[FaultKind::Drop, FaultKind::Flip]));
    }

    #[test]
    fn a_rate_is_kept_roughly_and_zero_and_one_exactly() {
        let count = |rate| {
            let mut faults = Faults::new(&BTreeMap::from([(FaultKind::Flip, rate)]), 1);
            (0..10_000).filter(|_| faults.strikes(FaultKind::Flip)).count()
        };
        assert_eq!(count(0.0), 0);
        assert_eq!(count(1.0), 10_000);
        let tenth = count(0.1);
        assert!((900..1100).contains(&tenth), "{tenth}");
    }
}
