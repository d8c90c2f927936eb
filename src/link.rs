//! The only place with a clock and a port: opening links, and the loop that runs a protocol over one.
//!
//! A [`Link`] moves bytes and waits no longer than it is told; everything about *when* is the protocol's. Serial devices
//! and pseudo-terminals are [`serial`], device servers [`tcp`]; [`feed`] is the loop.

pub mod feed;
mod lock;
pub mod serial;
pub mod tcp;

use std::io;
use std::time::Duration;

use thiserror::Error;

/// A way to and from a control.
pub trait Link: Send {
    /// Waits at most `wait` for bytes from the control; 0 when none came.
    ///
    /// # Errors
    ///
    /// [`LinkError::Lost`] when the other end is gone.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<usize, LinkError>;

    /// Hands bytes over without waiting; returns how many were taken, perhaps 0.
    ///
    /// # Errors
    ///
    /// [`LinkError::Lost`] when the other end is gone.
    fn send(&mut self, bytes: &[u8]) -> Result<usize, LinkError>;

    /// Ends the link in order, without losing what was handed over. Waits a second at most.
    fn close(&mut self);
}

/// Where a link goes.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Port {
    /// A serial device or pseudo-terminal.
    Serial(String),
    /// `tcp://host:port`: a raw device server.
    Tcp(String),
}

impl Port {
    /// Reads a port as written on the command line.
    ///
    /// # Errors
    ///
    /// With what is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text.split_once("://") {
            Some(("tcp", address))
                if address
                    .rsplit_once(':')
                    .is_some_and(|(h, p)| !h.is_empty() && p.parse::<u16>().is_ok()) =>
            {
                Ok(Self::Tcp(address.to_owned()))
            }
            Some(("tcp", _)) => Err(format!("`{text}` is not tcp://host:port")),
            Some((scheme, _)) => Err(format!(
                "`{scheme}://` is not a kind of port; a port is a serial device or tcp://host:port"
            )),
            None if text.is_empty() => Err("a port is a serial device or tcp://host:port".to_owned()),
            None => Ok(Self::Serial(text.to_owned())),
        }
    }
}

impl std::fmt::Display for Port {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Serial(path) => f.write_str(path),
            Self::Tcp(address) => write!(f, "tcp://{address}"),
        }
    }
}

/// What is wrong with a link.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LinkError {
    /// There is no such port.
    #[error("port {port} does not exist")]
    Missing {
        /// The port.
        port: String,
    },
    /// The system does not allow it.
    #[error("no permission to open port {port}")]
    Denied {
        /// The port.
        port: String,
    },
    /// Someone else has it.
    #[error("port {port} is in use{}", .by.as_deref().map(|by| format!(" by {by}")).unwrap_or_default())]
    Busy {
        /// The port.
        port: String,
        /// Who, if known.
        by: Option<String>,
    },
    /// The device server did not take the connection.
    #[error("{port} did not answer: {error}")]
    Refused {
        /// The port.
        port: String,
        /// Why.
        error: io::Error,
    },
    /// The device does not take the settings.
    #[error("port {port} does not take the settings: {reason}")]
    Settings {
        /// The port.
        port: String,
        /// Why.
        reason: String,
    },
    /// It is something else.
    #[error("{port} is not a serial device")]
    NotSerial {
        /// What was named.
        port: String,
    },
    /// It was there and is gone.
    #[error("the link was lost: {0}")]
    Lost(io::Error),
}

impl LinkError {
    /// From the error of opening a port.
    #[must_use]
    pub fn from_open(port: &str, error: io::Error) -> Self {
        let port = port.to_owned();
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing { port },
            io::ErrorKind::PermissionDenied => Self::Denied { port },
            io::ErrorKind::ResourceBusy => Self::Busy { port, by: None },
            io::ErrorKind::IsADirectory => Self::NotSerial { port },
            _ => Self::Settings { port, reason: error.to_string() },
        }
    }

    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::Missing { .. } => {
                "check the cable and the adapter; on Linux `ls /dev/serial/by-id` shows what is plugged in"
            }
            Self::Denied { .. } => {
                "on Linux, add yourself to the group `dialout` (sudo usermod -aG dialout $USER) and log in again"
            }
            Self::Busy { .. } => "stop the other program first: two senders on one port cut scrap",
            Self::Refused { .. } => "check the address, and that the device server is on and free",
            Self::Settings { .. } => "check baud and framing against the adapter's data sheet",
            Self::NotSerial { .. } => "a port is a serial device such as /dev/ttyUSB0, or tcp://host:port",
            Self::Lost(_) => "check the cable and the adapter before going on",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_a_device_or_a_tcp_address() {
        assert_eq!(Port::parse("/dev/ttyUSB0"), Ok(Port::Serial("/dev/ttyUSB0".to_owned())));
        assert_eq!(Port::parse("tcp://127.0.0.1:4001"), Ok(Port::Tcp("127.0.0.1:4001".to_owned())));
        assert!(Port::parse("tcp://nowhere").is_err());
        assert!(Port::parse("udp://x:1").is_err());
    }

    #[test]
    fn each_way_a_port_fails_to_open_has_its_own_message_and_hint() {
        let open = |kind| LinkError::from_open("/dev/ttyUSB0", io::Error::from(kind));
        assert_eq!(open(io::ErrorKind::NotFound).to_string(), "port /dev/ttyUSB0 does not exist");
        let denied = open(io::ErrorKind::PermissionDenied);
        assert_eq!(denied.to_string(), "no permission to open port /dev/ttyUSB0");
        assert!(denied.help().contains("dialout"));
        assert_eq!(open(io::ErrorKind::ResourceBusy).to_string(), "port /dev/ttyUSB0 is in use");
    }
}
