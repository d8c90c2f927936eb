//! The words that say how the control and its sender talk, and in which code.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use mock_controller::{AnswerBytes, Code, EndCode, Handshake, Next, Protocol, TapePacing};

use super::At;

#[derive(Args, Debug)]
pub(crate) struct Talk {
    /// How the control and its sender talk: dc-codes rts-cts dtr-dsr tape answer frames xmodem xmodem-crc xmodem-1k ymodem
    /// heidenhain-bcc fanuc-a grbl marlin. A pseudo-terminal and TCP have no modem lines: there rts-cts and dtr-dsr hold
    /// the characters back in the link, as a driver that obeys them would.
    #[arg(long, value_name = "NAME", default_value = "dc-codes")]
    protocol: Protocol,

    /// tape: the adapter asks for each character, or takes them at the reader's pace [default: answer].
    #[arg(long, value_enum)]
    tape_pacing: Option<Pacing>,

    /// tape: what asks for a character, a byte or `cts` [default: 0x11].
    #[arg(long, value_name = "BYTE|cts", value_parser = next)]
    next: Option<Next>,

    /// tape: characters a second of the reader; needed for synchronous [default: as fast as they come].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    reader_speed: Option<u32>,

    /// answer: what is said after a good block [default: 0x06].
    #[arg(long, value_name = "BYTE", value_parser = byte)]
    ack: Option<u8>,

    /// answer: what is said after a broken block [default: 0x15].
    #[arg(long, value_name = "BYTE", value_parser = byte)]
    nak: Option<u8>,

    /// answer: what asks for each block, the first too, in place of ack [default: none].
    #[arg(long, value_name = "BYTE", value_parser = byte)]
    request: Option<u8>,

    /// frames: how many may be outstanding, 1 to 64 [default: 1].
    #[arg(long, value_name = "N")]
    frame_window: Option<u8>,

    /// fanuc-a: what ends a message [default: cr].
    #[arg(long, value_enum)]
    end_code: Option<End>,

    /// The character code: ascii, iso, eia, or a file with a token and its byte in hex a line [default: ascii].
    #[arg(long, value_name = "NAME|FILE")]
    code: Option<String>,

    /// An odd number of characters in a block, its end included, is the alarm `tv`.
    #[arg(long)]
    tv_check: bool,

    /// The sender's driver does not stop when CTS goes off.
    #[arg(long)]
    ignore_lines: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Pacing {
    Answer,
    Synchronous,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum End {
    Cr,
    Etx,
}

/// A character code, or where its table is.
#[derive(Clone, Debug)]
pub(crate) enum CodeWord {
    Known(Code),
    File(PathBuf),
}

impl Talk {
    /// The protocol with its values; an error: a word that belongs to another.
    pub(super) fn protocol(&self) -> Result<Protocol, String> {
        let is_tape = matches!(self.protocol, Protocol::Tape(_));
        let is_answer = matches!(self.protocol, Protocol::Answer(_));
        for (given, fits, word, with) in [
            (self.tape_pacing.is_some(), is_tape, "tape-pacing", "tape"),
            (self.next.is_some(), is_tape, "next", "tape"),
            (self.reader_speed.is_some(), is_tape, "reader-speed", "tape"),
            (self.ack.is_some(), is_answer, "ack", "answer"),
            (self.nak.is_some(), is_answer, "nak", "answer"),
            (self.request.is_some(), is_answer, "request", "answer"),
            (
                self.frame_window.is_some(),
                matches!(self.protocol, Protocol::Frames { .. }),
                "frame-window",
                "frames",
            ),
            (self.end_code.is_some(), matches!(self.protocol, Protocol::FanucA(_)), "end-code", "fanuc-a"),
        ] {
            if given && !fits {
                return Err(format!("--{word} goes with --protocol {with}"));
            }
        }
        Ok(match &self.protocol {
            Protocol::Tape(_) => Protocol::Tape(self.tape()?),
            Protocol::Answer(defaults) => Protocol::Answer(AnswerBytes {
                ack: self.ack.unwrap_or(defaults.ack),
                nak: self.nak.unwrap_or(defaults.nak),
                request: self.request,
            }),
            Protocol::Frames { window } => Protocol::Frames { window: self.frame_window.unwrap_or(*window) },
            Protocol::FanucA(default) => Protocol::FanucA(match self.end_code {
                None => *default,
                Some(End::Cr) => EndCode::Cr,
                Some(End::Etx) => EndCode::Etx,
            }),
            other => other.clone(),
        })
    }

    fn tape(&self) -> Result<TapePacing, String> {
        match (self.tape_pacing, self.next, self.reader_speed) {
            (None | Some(Pacing::Answer), next, per_second) => {
                Ok(TapePacing::Answer { next: next.unwrap_or(Next::Byte(0x11)), per_second })
            }
            (Some(Pacing::Synchronous), None, Some(per_second)) => Ok(TapePacing::Synchronous { per_second }),
            (Some(Pacing::Synchronous), Some(_), _) => {
                Err("--next goes with --tape-pacing answer".to_owned())
            }
            (Some(Pacing::Synchronous), None, None) => {
                Err("--tape-pacing synchronous needs --reader-speed".to_owned())
            }
        }
    }

    pub(super) fn code(&self) -> CodeWord {
        match self.code.as_deref() {
            None | Some("ascii") => CodeWord::Known(Code::Ascii),
            Some("iso") => CodeWord::Known(Code::Iso),
            Some("eia") => CodeWord::Known(Code::Eia),
            Some(file) => CodeWord::File(file.into()),
        }
    }

    pub(super) fn checks_tv(&self) -> bool {
        self.tv_check
    }

    /// What stops the sender's driver: on a link without lines the link stands in for them.
    pub(super) fn handshake(&self, place: &At) -> Handshake {
        match (self.ignore_lines, place) {
            (true, _) => Handshake::Ignored,
            (false, At::Pty(_) | At::Tcp(_)) => Handshake::Both,
            (false, At::Serial(_)) => Handshake::Cts,
        }
    }
}

fn next(word: &str) -> Result<Next, String> {
    if word == "cts" { Ok(Next::Cts) } else { byte(word).map(Next::Byte) }
}

fn byte(word: &str) -> Result<u8, String> {
    let hex = word.strip_prefix("0x").ok_or("expected a byte in hex, as 0x06")?;
    u8::from_str_radix(hex, 16).map_err(|_| "expected a byte in hex, as 0x06".to_owned())
}
