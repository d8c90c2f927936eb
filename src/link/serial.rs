//! Serial devices and pseudo-terminals.
//!
//! Settings, reading and modem lines go through the crate `serialport`. Its `write` waits in the driver whatever its
//! time-out says, so on Unix bytes are handed over through a second, non-blocking descriptor of the same device. DTR and
//! RTS are set on, because platforms differ on open. The port is never flushed: the protocol closes it only once the
//! wire-time model says the line is empty.

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use serialport::{ClearBuffer, DataBits, FlowControl, SerialPort, StopBits};

use super::lock::PortLock;
use super::{Link, LinkError};
use crate::profile::{Framing, Parity};

/// An open serial port.
pub struct SerialLink {
    port: Box<dyn SerialPort>,
    #[cfg(unix)]
    writer: std::fs::File,
    pseudo_terminal: bool,
    _lock: PortLock,
}

/// What is known of a port's receive latency.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Latency {
    /// There is none to speak of: a pseudo-terminal.
    Nothing,
    /// The adapter says so (its latency timer).
    Adapter(Duration),
    /// Nothing says; this is taken.
    Assumed(Duration),
}

impl Latency {
    /// The latency of a serial device, from what the system tells of its adapter (Linux).
    #[must_use]
    pub fn of(device: &str) -> Self {
        let Ok(device) = std::fs::canonicalize(device) else { return Self::Assumed(ASSUMED_LATENCY) };
        if is_pseudo_terminal(&device) {
            return Self::Nothing;
        }
        let timer = device
            .file_name()
            .map(|name| PathBuf::from("/sys/class/tty").join(name).join("device/latency_timer"))
            .and_then(|path| std::fs::read_to_string(path).ok())
            .and_then(|text| text.trim().parse::<u64>().ok());
        // The driver's own share comes on top of the timer.
        timer.map_or(Self::Assumed(ASSUMED_LATENCY), |ms| Self::Adapter(Duration::from_millis(ms + 1)))
    }
}

/// Taken for an adapter that does not say: the default timer of the commonest USB chip (FTDI, 16 ms), the worst usual case.
const ASSUMED_LATENCY: Duration = Duration::from_millis(16);

fn is_pseudo_terminal(device: &Path) -> bool {
    device.starts_with("/dev/pts")
}

impl SerialLink {
    /// Opens a device and purges what it received before.
    ///
    /// # Errors
    ///
    /// With a message of its own for each way this fails.
    pub fn open(name: &str, baud: u32, framing: Framing) -> Result<Self, LinkError> {
        let device = if cfg!(unix) {
            std::fs::canonicalize(name).map_err(|error| LinkError::from_open(name, error))?
        } else {
            PathBuf::from(name)
        };
        let lock = PortLock::take(&device, name)?;
        #[cfg(unix)]
        let writer = open_writer(&device).map_err(|error| LinkError::from_open(name, error))?;

        let pseudo_terminal = is_pseudo_terminal(&device);
        // A pseudo-terminal has no framing and some kernels refuse to pretend.
        let framing = if pseudo_terminal {
            Framing { data_bits: 8, parity: Parity::None, stop_bits: 1 }
        } else {
            framing
        };
        let builder = serialport::new(device.display().to_string(), baud)
            .data_bits(match framing.data_bits {
                5 => DataBits::Five,
                6 => DataBits::Six,
                7 => DataBits::Seven,
                _ => DataBits::Eight,
            })
            .parity(match framing.parity {
                Parity::None => serialport::Parity::None,
                Parity::Even => serialport::Parity::Even,
                Parity::Odd => serialport::Parity::Odd,
            })
            .stop_bits(if framing.stop_bits == 1 { StopBits::One } else { StopBits::Two })
            .flow_control(FlowControl::None)
            .timeout(Duration::ZERO);
        let mut port = builder.open().map_err(|error| match error.kind() {
            serialport::ErrorKind::NoDevice => LinkError::from_open(name, io::Error::from(error)),
            serialport::ErrorKind::Io(kind) => {
                LinkError::from_open(name, io::Error::new(kind, error.to_string()))
            }
            serialport::ErrorKind::InvalidInput | serialport::ErrorKind::Unknown
                if error.description.contains("typewriter") || error.description.contains("ioctl") =>
            {
                LinkError::NotSerial { port: name.to_owned() }
            }
            serialport::ErrorKind::InvalidInput | serialport::ErrorKind::Unknown => {
                LinkError::Settings { port: name.to_owned(), reason: error.to_string() }
            }
        })?;
        if !pseudo_terminal {
            let lines = port.write_data_terminal_ready(true).and_then(|()| port.write_request_to_send(true));
            lines.map_err(|error| LinkError::Settings {
                port: name.to_owned(),
                reason: format!("DTR and RTS cannot be set on: {error}"),
            })?;
            // On a pseudo-terminal what came before may be the control's request, for there is no earlier session.
            port.clear(ClearBuffer::Input).map_err(|error| LinkError::Lost(io::Error::from(error)))?;
        }
        Ok(Self {
            port,
            #[cfg(unix)]
            writer,
            pseudo_terminal,
            _lock: lock,
        })
    }

    /// Whether the port is a pseudo-terminal, which has neither baud nor parity nor lines.
    #[must_use]
    pub fn is_pseudo_terminal(&self) -> bool {
        self.pseudo_terminal
    }
}

#[cfg(unix)]
fn open_writer(device: &Path) -> io::Result<std::fs::File> {
    use std::os::unix::fs::OpenOptionsExt;
    let flags = rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY;
    std::fs::OpenOptions::new().write(true).custom_flags(flags.bits() as i32).open(device)
}

impl Link for SerialLink {
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<usize, LinkError> {
        self.port.set_timeout(wait).map_err(|error| LinkError::Lost(io::Error::from(error)))?;
        match self.port.read(buffer) {
            Ok(0) => Err(LinkError::Lost(io::Error::new(io::ErrorKind::UnexpectedEof, "the device is gone"))),
            Ok(count) => Ok(count),
            Err(error) => match error.kind() {
                io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted => Ok(0),
                _ => Err(LinkError::Lost(error)),
            },
        }
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, LinkError> {
        #[cfg(unix)]
        let written = self.writer.write(bytes);
        #[cfg(not(unix))]
        let written = self.port.write(bytes);
        match written {
            Ok(count) => Ok(count),
            Err(error) => match error.kind() {
                io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted => Ok(0),
                _ => Err(LinkError::Lost(error)),
            },
        }
    }

    fn close(&mut self) {
        // Nothing to do: the line is empty by the model, and flushing would lose the tail.
    }
}
