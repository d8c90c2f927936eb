//! How the control and its sender talk, where it is not by DC codes: one machine a file, each the control's side.
//!
//! ```text
//!   line ──byte──▶ take ──▶ pull ──program text──▶ code ──▶ reader ──▶ buffer
//!                   │         ▲ as long as the buffer has room
//!                   └──▶ answers ──▶ line back      lines: CTS, DSR
//! ```
//!
//! A machine is told what happens and when, and says what it wants in an [`Out`]; it reads no clock. What does not fit
//! the buffer stays in the machine, which then owes its answer: so a hold of a protocol with answers is an answer that
//! is not given. Machines that stream give every character at once and stop the sender by a line.
//!
//! Source: domain/4, "Protocols, in the order of what they are worth"; what is read elsewhere is said in each file.

mod answer;
mod crc16;
mod dtr_dsr;
mod fanuc_a;
mod frames;
mod grbl;
mod heidenhain;
mod marlin;
mod packet;
mod rts_cts;
mod tape;
mod xmodem;
mod ymodem;

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use super::settings::Settings;
pub use answer::AnswerBytes;
pub use fanuc_a::EndCode;
pub use tape::{Next, TapePacing};

/// How the control and its sender talk.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Protocol {
    /// DC1 to start and go on, DC3 to hold, NAK and SYN to stop.
    #[default]
    DcCodes,
    /// CTS on to start and go on, off to hold; the sender's driver obeys by itself.
    RtsCts,
    /// DSR on to start and go on, off to hold; the sender's program has to look.
    DtrDsr,
    /// An adapter in place of a tape reader.
    Tape(TapePacing),
    /// Each block is answered.
    Answer(AnswerBytes),
    /// Frames with a CRC (`docs/protocols.md`, "Frames: wire format"), and the most that may be outstanding.
    Frames {
        /// 1 is stop-and-wait; at most 64.
        window: u8,
    },
    /// XMODEM with a sum.
    Xmodem,
    /// XMODEM with a CRC, 128 bytes a packet.
    XmodemCrc,
    /// XMODEM with a CRC, 1024 or 128 bytes a packet.
    Xmodem1k,
    /// YMODEM: a name, a length, and packets as XMODEM-1K has them.
    Ymodem,
    /// Heidenhain's blockwise transfer with a block check character.
    HeidenhainBcc,
    /// Fanuc's remote buffer, protocol A.
    FanucA(EndCode),
    /// grbl's lines, each answered, and its buffer of 128 characters.
    Grbl,
    /// Marlin's numbered and checked lines.
    Marlin,
}

impl Protocol {
    /// The names on the command line, in the order of the protocols.
    pub const NAMES: [&str; 14] = [
        "dc-codes",
        "rts-cts",
        "dtr-dsr",
        "tape",
        "answer",
        "frames",
        "xmodem",
        "xmodem-crc",
        "xmodem-1k",
        "ymodem",
        "heidenhain-bcc",
        "fanuc-a",
        "grbl",
        "marlin",
    ];

    /// Whether its bytes have no room for a parity bit.
    #[must_use]
    pub fn is_eight_bit(&self) -> bool {
        matches!(
            self,
            Protocol::Frames { .. }
                | Protocol::Xmodem
                | Protocol::XmodemCrc
                | Protocol::Xmodem1k
                | Protocol::Ymodem
        )
    }

    /// Its machine; `None`: DC codes, which the control speaks by itself.
    pub(super) fn machine(settings: &Settings) -> Option<Box<dyn Machine>> {
        let end_of_block = settings.code.end_of_block();
        Some(match &settings.protocol {
            Protocol::DcCodes => return None,
            Protocol::RtsCts => Box::new(rts_cts::RtsCts::default()),
            Protocol::DtrDsr => Box::new(dtr_dsr::DtrDsr::default()),
            Protocol::Tape(pacing) => Box::new(tape::Tape::new(*pacing)),
            Protocol::Answer(bytes) => Box::new(answer::Answer::new(*bytes, end_of_block)),
            Protocol::Frames { window } => Box::new(frames::Frames::new(*window)),
            Protocol::Xmodem => Box::new(xmodem::Xmodem::new(packet::Check::Sum, false)),
            Protocol::XmodemCrc => Box::new(xmodem::Xmodem::new(packet::Check::Crc, false)),
            Protocol::Xmodem1k => Box::new(xmodem::Xmodem::new(packet::Check::Crc, true)),
            Protocol::Ymodem => Box::new(ymodem::Ymodem::default()),
            Protocol::HeidenhainBcc => Box::new(heidenhain::Heidenhain::default()),
            Protocol::FanucA(end) => Box::new(fanuc_a::FanucA::new(*end)),
            Protocol::Grbl => Box::new(grbl::Grbl::default()),
            Protocol::Marlin => Box::new(marlin::Marlin::default()),
        })
    }
}

impl FromStr for Protocol {
    type Err = UnknownProtocol;

    /// The protocol by its name, with its values' defaults.
    fn from_str(name: &str) -> Result<Protocol, UnknownProtocol> {
        Ok(match name {
            "dc-codes" => Protocol::DcCodes,
            "rts-cts" => Protocol::RtsCts,
            "dtr-dsr" => Protocol::DtrDsr,
            "tape" => Protocol::Tape(TapePacing::default()),
            "answer" => Protocol::Answer(AnswerBytes::default()),
            "frames" => Protocol::Frames { window: 1 },
            "xmodem" => Protocol::Xmodem,
            "xmodem-crc" => Protocol::XmodemCrc,
            "xmodem-1k" => Protocol::Xmodem1k,
            "ymodem" => Protocol::Ymodem,
            "heidenhain-bcc" => Protocol::HeidenhainBcc,
            "fanuc-a" => Protocol::FanucA(EndCode::default()),
            "grbl" => Protocol::Grbl,
            "marlin" => Protocol::Marlin,
            _ => return Err(UnknownProtocol),
        })
    }
}

/// The word names no protocol.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct UnknownProtocol;

impl fmt::Display for UnknownProtocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown protocol; known are {}", Protocol::NAMES.join(" "))
    }
}

impl std::error::Error for UnknownProtocol {}

/// The control's outputs, as its sender sees them: its RTS and DTR through a crossed cable.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Lines {
    /// Clear to send.
    pub cts: bool,
    /// Data set ready.
    pub dsr: bool,
}

impl Lines {
    /// Both on, as most controls hold them.
    pub const ON: Lines = Lines { cts: true, dsr: true };
}

/// The control's side of a protocol.
pub(super) trait Machine: Send {
    /// The control is started, after the link has opened.
    fn start(&mut self, now: Duration, out: &mut Out);

    /// A character has arrived. One with a parity error arrives as NUL (domain/4, "Parity errors arrive as NUL").
    fn take(&mut self, byte: u8, now: Duration, out: &mut Out);

    /// The buffer has room: gives more of the program, a character or a few. False: there is none.
    fn pull(&mut self, _now: Duration, _out: &mut Out) -> bool {
        false
    }

    /// The buffer has filled, or has room again.
    fn hold(&mut self, _held: bool, _now: Duration, _out: &mut Out) {}

    /// When it wants to be called though nothing has happened.
    fn due(&self) -> Option<Duration> {
        None
    }

    /// That time has come.
    fn time(&mut self, _now: Duration, _out: &mut Out) {}

    /// The link has closed: what is unfinished is forgotten.
    fn close(&mut self);

    /// The control stops, for good or until the link opens anew.
    fn stop(&mut self, stop: Stop, out: &mut Out);

    /// Its lines.
    fn lines(&self) -> Lines {
        Lines::ON
    }

    /// Whether characters go to the buffer whether it has room or not.
    fn streams(&self) -> bool {
        false
    }

    /// Whether more belongs to the transfer than the program's own end.
    fn in_transfer(&self) -> bool {
        false
    }
}

/// Why a control stops.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Stop {
    /// By its name.
    Alarm(&'static str),
    Reset,
}

/// What a machine wants done, in this order.
#[derive(Debug, Default)]
pub(super) struct Out {
    /// Program text, as it was coded on the line.
    pub(super) text: Vec<u8>,
    /// What is said, and what it means to the sender.
    pub(super) say: Vec<(Vec<u8>, Means)>,
    /// The program is complete, whatever its last word was.
    pub(super) ends: bool,
    /// The sender has broken the transfer off.
    pub(super) breaks: bool,
    /// Characters that were lost because nobody listened.
    pub(super) unread: u64,
    pub(super) alarm: Option<(&'static str, String)>,
}

/// What an answer means; faults strike by it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Means {
    /// The sender may go on.
    Go,
    /// The sender shall wait, or send again.
    Stop,
    Other,
}

impl Out {
    pub(super) fn go(&mut self, bytes: impl Into<Vec<u8>>) {
        self.say.push((bytes.into(), Means::Go));
    }

    pub(super) fn halt(&mut self, bytes: impl Into<Vec<u8>>) {
        self.say.push((bytes.into(), Means::Stop));
    }

    pub(super) fn tell(&mut self, bytes: impl Into<Vec<u8>>) {
        self.say.push((bytes.into(), Means::Other));
    }
}

const SOH: u8 = 0x01;
const STX: u8 = 0x02;
const ETX: u8 = 0x03;
const EOT: u8 = 0x04;
const ACK: u8 = 0x06;
const DC1: u8 = 0x11;
const NAK: u8 = 0x15;
const ETB: u8 = 0x17;
const CAN: u8 = 0x18;
/// The end of a file where packets are filled up.
const SUB: u8 = 0x1A;

/// Consecutive errors until a transfer is given up ("10 retries", domain/4).
const RETRIES: u32 = 10;
