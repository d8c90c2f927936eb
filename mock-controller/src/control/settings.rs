//! How the control and its line behave: every value, its default, and which values go together.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use super::code::Code;
use super::plan::gcode::{GcodeSettings, Register};
use super::protocol::Protocol;
use crate::dialect::Dialect;
use crate::interpolator::Model;
use crate::line::fault::FaultKind;
use crate::line::pace::{Framing, Pace};

/// Everything about a control and its line that can be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How long a character takes, in both directions. Default: 9600 baud, 7E2.
    pub pace: Pace,
    /// How the control and its sender talk. Default: DC codes.
    pub protocol: Protocol,
    /// The character code of the program. Default: ASCII, bit 8 not looked at.
    pub code: Code,
    /// An odd number of characters in a block is the alarm `tv`. Default off.
    pub tv_check: bool,
    /// Which of the control's lines stop the sender's driver by themselves. Default: CTS.
    pub handshake: Handshake,
    /// What the programs are written in. Default: 3B.
    pub dialect: Dialect,
    /// The wire offset the control holds, µm. 4B: F, + wire outside (punch), − inside (die). G-code: the offset of G41
    /// and G42 without a number, not negative; the side is theirs. Default 0; with 3B it must be 0, the offset is in
    /// the numbers.
    pub wire_offset_um: f64,
    /// The taper keyed in, 4B only. Default: none, the wire is vertical.
    pub taper: Option<Taper>,
    /// How G-code is read.
    pub gcode: GcodeSettings,
    /// The interpolator's model. Default: `Rotated`; unverified for any control.
    pub interpolator: Model,
    /// The input buffer, characters. Default 256 (a guess; no maker's number is public).
    pub buffer_bytes: usize,
    /// The fill at which the control asks for silence. Default 192.
    pub xoff_at: usize,
    /// The fill at which it asks to go on. Default 64.
    pub xon_at: usize,
    /// Characters allowed between DC3 and DC1; one more is the alarm `overrun`. Default 10 (Fanuc alarm 087, domain/4).
    pub overrun_limit: u64,
    /// Send DC3, NAK and SYN with even parity in bit 8: 0x93, 0x95, 0x96. Default off.
    pub dc3_parity: bool,
    /// How long after its stop bit a character of the control reaches the sender's program. Default 0.
    pub latency: Duration,
    /// What becomes of an unfinished block when the link closes. Default: dropped.
    pub torn: Torn,
    /// What is done with the text before the first end of block. Default: `Auto`.
    pub label_skip: LabelSkip,
    /// When the first DC1 goes out. Default: at once.
    pub start: Start,
    /// How long a block takes to cut, as a multiple of the time its characters take on the line. Default 1.25: the
    /// control is a little slower than the line, so its buffer fills and it holds. Nothing on an unpaced line.
    pub cutting_time: f64,
    /// Raise the alarm `nak` when this block is about to be cut.
    pub alarm_at_block: Option<u64>,
    /// Reset, once, when this block is about to be cut.
    pub reset_at_block: Option<u64>,
    /// The sender's driver FIFO, characters. Default 4096 (a kernel's, domain/4).
    pub fifo_bytes: usize,
    /// The probability of each kind of fault, 0 to 1. Default: none.
    pub faults: BTreeMap<FaultKind, f64>,
    /// The seed of the faults' dice. Default 0.
    pub seed: u64,
    /// When the shell leaves; the control itself does not look at it. Default: when told to stop.
    pub until: Until,
}

/// A taper as it is keyed in. The lead-in's flag declares its sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// α, degrees, from the vertical.
    pub degrees: f64,
    /// H2, from the plane of the program to the upper guide, µm. The paper's is 100 mm.
    pub height_um: f64,
}

impl Taper {
    /// A = H2 · tan α, µm (domain/2, "The 4B block").
    #[must_use]
    pub fn shift_um(&self) -> f64 {
        self.height_um * libm::tan(self.degrees.to_radians())
    }
}

/// What becomes of an unfinished block when the link closes.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Torn {
    /// It is dropped, and counted.
    #[default]
    Drop,
    /// It stays in the control, and what comes over the next connection joins it, as on a control without a line end
    /// that discards a partial block. Only `%` discards it.
    Keep,
}

/// What is done with the text between the opening of the link, or the end of a program, and the first end of block.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum LabelSkip {
    /// It is discarded, unless it holds a whole block or a stop word, which is then executed.
    #[default]
    Auto,
    /// It is discarded whatever it is: the manuals' label skip, taken literally. A program without a leader loses its
    /// first line.
    On,
    /// Nothing is discarded; what is not program is a malformed block.
    Off,
}

/// Which of the control's lines stop the sender's driver by themselves, after the character on the line.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Handshake {
    /// None: a driver that is not set up for it.
    Ignored,
    /// CTS, as drivers and chips do it.
    #[default]
    Cts,
    /// CTS and DSR. No driver does that; it stands for the lines where there are none, over a pseudo-terminal or TCP.
    Both,
}

/// When the first DC1 goes out after the link has opened.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Start {
    /// After this long. What arrives earlier is not read.
    After(Duration),
    /// Never: a control nobody starts.
    Never,
}

/// When a shell leaves.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Until {
    /// When it is told to stop, or on an alarm.
    #[default]
    Stopped,
    /// After a program's end, or on an alarm.
    ProgramEnd,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            pace: Pace::Paced { baud: 9600, framing: Framing::SEVEN_EVEN_TWO },
            protocol: Protocol::DcCodes,
            code: Code::Ascii,
            tv_check: false,
            handshake: Handshake::Cts,
            dialect: Dialect::ThreeB,
            wire_offset_um: 0.0,
            taper: None,
            gcode: GcodeSettings::default(),
            interpolator: Model::Rotated,
            buffer_bytes: 256,
            xoff_at: 192,
            xon_at: 64,
            overrun_limit: 10,
            dc3_parity: false,
            latency: Duration::ZERO,
            torn: Torn::Drop,
            label_skip: LabelSkip::Auto,
            start: Start::After(Duration::ZERO),
            cutting_time: 1.25,
            alarm_at_block: None,
            reset_at_block: None,
            fifo_bytes: 4096,
            faults: BTreeMap::new(),
            seed: 0,
            until: Until::Stopped,
        }
    }
}

impl Settings {
    /// The defaults on a line where characters take no time.
    #[must_use]
    pub fn unpaced() -> Settings {
        Settings { pace: Pace::Unpaced, cutting_time: 0.0, ..Settings::default() }
    }

    /// Whether the values go together.
    ///
    /// # Errors
    ///
    /// The first [`SettingsError`] found.
    pub fn validate(&self) -> Result<(), SettingsError> {
        if let Pace::Paced { baud: 0, .. } = self.pace {
            return Err(SettingsError::ZeroBaud);
        }
        if self.xon_at >= self.xoff_at {
            return Err(SettingsError::XonNotBelowXoff { xon_at: self.xon_at, xoff_at: self.xoff_at });
        }
        // One more character completes while DC3 itself is on the line.
        let limit = usize::try_from(self.overrun_limit).unwrap_or(usize::MAX);
        let needed = self.xoff_at.saturating_add(limit).saturating_add(1);
        if self.buffer_bytes < needed && self.pace != Pace::Unpaced {
            return Err(SettingsError::BufferTooSmall { buffer_bytes: self.buffer_bytes, needed });
        }
        if self.buffer_bytes < self.xoff_at {
            return Err(SettingsError::BufferTooSmall {
                buffer_bytes: self.buffer_bytes,
                needed: self.xoff_at,
            });
        }
        if !(0.0..=1e6).contains(&self.cutting_time) {
            return Err(SettingsError::CuttingTime(self.cutting_time));
        }
        if self.pace == Pace::Unpaced && self.cutting_time != 0.0 {
            return Err(SettingsError::CuttingTimeUnpaced);
        }
        if !(-OFFSET_MAX_UM..=OFFSET_MAX_UM).contains(&self.wire_offset_um) {
            return Err(SettingsError::WireOffset(self.wire_offset_um));
        }
        if self.dialect == Dialect::ThreeB && self.wire_offset_um != 0.0 {
            return Err(SettingsError::WireOffsetInNumbers);
        }
        if self.dialect == Dialect::Gcode && self.wire_offset_um < 0.0 {
            return Err(SettingsError::NegativeOffset(self.wire_offset_um));
        }
        if let Some(&register) = self.gcode.offset_registers.keys().next()
            && self.dialect != Dialect::Gcode
        {
            return Err(SettingsError::RegisterDialect(register));
        }
        if let Some((&register, &offset_um)) =
            self.gcode.offset_registers.iter().find(|&(_, offset)| !(0.0..=OFFSET_MAX_UM).contains(offset))
        {
            return Err(SettingsError::Register { register, offset_um });
        }
        if let Some(taper) = self.taper {
            if self.dialect != Dialect::FourB {
                return Err(SettingsError::TaperDialect);
            }
            let is_right = (0.0..=TAPER_MAX_DEGREES).contains(&taper.degrees)
                && (0.0..=HEIGHT_MAX_UM).contains(&taper.height_um);
            if !is_right {
                return Err(SettingsError::Taper(taper));
            }
        }
        if self.dc3_parity && self.protocol.is_eight_bit() {
            return Err(SettingsError::ParityInEightBits);
        }
        if let Protocol::Frames { window } = self.protocol
            && !(1..=64).contains(&window)
        {
            return Err(SettingsError::Window(window));
        }
        if self.fifo_bytes == 0 {
            return Err(SettingsError::NoFifo);
        }
        if let Some((&kind, &rate)) = self.faults.iter().find(|&(_, rate)| !(0.0..=1.0).contains(rate)) {
            return Err(SettingsError::Rate { kind, rate });
        }
        Ok(())
    }
}

/// Settings that contradict each other or themselves.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SettingsError {
    /// A line of 0 baud carries nothing.
    ZeroBaud,
    /// The hold would end where it begins.
    XonNotBelowXoff {
        /// The fill at which it would go on.
        xon_at: usize,
        /// The fill at which it would hold.
        xoff_at: usize,
    },
    /// A sender that keeps the overrun rule could still overflow the buffer.
    BufferTooSmall {
        /// The buffer asked for.
        buffer_bytes: usize,
        /// The least that fits: xoff-at, the overrun limit, and one.
        needed: usize,
    },
    /// Not a multiple between 0 and a million.
    CuttingTime(f64),
    /// A multiple of no time at all.
    CuttingTimeUnpaced,
    /// Not an offset between −10 and 10 mm.
    WireOffset(f64),
    /// 3B describes the path of the wire's centre; the control holds no offset.
    WireOffsetInNumbers,
    /// In G-code the side is told by G41 and G42, not by a sign.
    NegativeOffset(f64),
    /// Only G-code names offsets by number.
    RegisterDialect(Register),
    /// Not an offset between 0 and 10 mm.
    Register {
        /// Where it is kept.
        register: Register,
        /// What was keyed in.
        offset_um: f64,
    },
    /// An angle not between 0 and 45°, or a height not between 0 and 1000 mm.
    Taper(Taper),
    /// Only 4B knows a taper that is keyed in.
    TaperDialect,
    /// A protocol whose bytes have no parity bit.
    ParityInEightBits,
    /// Not between 1 and 64 frames.
    Window(u8),
    /// No room for a single character.
    NoFifo,
    /// Not a probability.
    Rate {
        /// Of which fault.
        kind: FaultKind,
        /// What was asked for.
        rate: f64,
    },
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SettingsError::ZeroBaud => write!(f, "a line of 0 baud carries nothing"),
            SettingsError::XonNotBelowXoff { xon_at, xoff_at } => {
                write!(f, "xon-at {xon_at} is not below xoff-at {xoff_at}")
            }
            SettingsError::BufferTooSmall { buffer_bytes, needed } => write!(
                f,
                "a buffer of {buffer_bytes} is smaller than the {needed} that xoff-at, the overrun limit and one \
                 character need"
            ),
            SettingsError::CuttingTime(ratio) => {
                write!(f, "cutting time {ratio} is not between 0 and 1000000")
            }
            SettingsError::CuttingTimeUnpaced => {
                write!(
                    f,
                    "an unpaced line has no character time of which the cutting time could be a multiple"
                )
            }
            SettingsError::WireOffset(offset_um) => {
                write!(f, "a wire offset of {} mm is not between -10 and 10 mm", offset_um / 1000.0)
            }
            SettingsError::WireOffsetInNumbers => {
                write!(f, "3B programs hold the wire offset in their numbers: the control has none")
            }
            SettingsError::NegativeOffset(offset_um) => write!(
                f,
                "a wire offset of {} mm is negative: in G-code G41 and G42 tell the side",
                offset_um / 1000.0
            ),
            SettingsError::RegisterDialect(register) => {
                write!(f, "offset register {register}: only G-code programs name offsets by number")
            }
            SettingsError::Register { register, offset_um } => write!(
                f,
                "offset register {register}: {} mm is not between 0 and 10 mm; G41 and G42 tell the side",
                offset_um / 1000.0
            ),
            SettingsError::Taper(Taper { degrees, height_um }) => write!(
                f,
                "a taper of {degrees}° over {} mm is not between 0 and 45°, 0 and 1000 mm",
                height_um / 1000.0
            ),
            SettingsError::TaperDialect => write!(f, "a taper is keyed in for 4B programs only"),
            SettingsError::ParityInEightBits => {
                write!(f, "parity in bit 8 of what is said: the bytes of this protocol have all eight")
            }
            SettingsError::Window(window) => write!(f, "a window of {window} frames is not between 1 and 64"),
            SettingsError::NoFifo => write!(f, "a driver FIFO of 0 takes nothing"),
            SettingsError::Rate { kind, rate } => {
                write!(f, "fault {kind}: rate {rate} is not between 0 and 1")
            }
        }
    }
}

impl std::error::Error for SettingsError {}

/// Guesses, beyond any machine.
const TAPER_MAX_DEGREES: f64 = 45.0;
const HEIGHT_MAX_UM: f64 = 1e6;

/// A guess: no wire is thicker.
const OFFSET_MAX_UM: f64 = 10_000.0;
