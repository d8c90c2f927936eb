//! A wire-EDM control to feed: it receives a program over a paced line, cuts it pulse by pulse, and says what it cut.
//!
//! It exists so that a sender can be tried without a machine, by a second and independent reading of the manuals.
//! It knows nothing of any sender: only bytes and times go in, only bytes and a [`Report`] come out.
//!
//! ```text
//!  sender's program
//!    │ send()                                          ▲ receive()
//!    ▼                                                 │ latency
//!  line     driver FIFO ─▶ shift register, faults      │ one character at a time
//!    ▼                                                 │
//!  control  reader ─▶ bounded buffer ─▶ plan ─▶ cutter ──── DC1 DC3 NAK SYN
//!                      whole blocks      offset  │
//!                                               ▼
//!  interpolator                        pulses, 1 µm each ─▶ Observer, Report
//! ```
//!
//! Everything above is sans-IO: time is a [`std::time::Duration`] since an origin of the caller's choice and only moves by
//! [`Controller::advance`]. [`shell`] alone has a clock, a pseudo-terminal, a socket or a serial device.
//!
//! What it deliberately does not do: other dialects than 3B, 4B and plain G-code (no macros). Of a taper in G-code (G50 G51 G52) only the plane of the program is cut, and the words are counted.
#![warn(missing_docs)]

pub mod control;
pub mod dialect;
pub mod interpolator;
pub mod line;
pub mod observer;
mod outline;
pub mod picture;
pub mod report;
pub mod shell;

pub use control::Controller;
pub use control::settings::{Handshake, LabelSkip, Settings, SettingsError, Start, Taper, Torn, Until};
pub use control::{
    AnswerBytes, Code, CodeTable, EndCode, Lines, Next, NotACode, Protocol, TapePacing, UnknownProtocol,
};
pub use control::{
    ArcCentre, GcodeSettings, IgnoredWords, NotARegister, NotAWord, Register, UnitWithoutPoint,
};
pub use dialect::Dialect;
pub use dialect::four_b::{Flag, FourBlock, Fourth, Marks, parse_four_block};
pub use dialect::three_b::{Axis, Block, Kind, Quadrant, parse_block};
pub use interpolator::{Model, Travel};
pub use line::fault::FaultKind;
pub use line::pace::{Framing, Pace};
pub use observer::{BlockEnd, Observer, Unobserved};
pub use report::Report;
