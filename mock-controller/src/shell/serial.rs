//! A real serial device as the link. It is open from the beginning to the end: whether a sender is at the other end of
//! the cable cannot be seen.
//!
//! The characters have already taken their time on the cable when they are read; the control's own line model adds one
//! character time to that.

use std::io::{self, Read as _, Write as _};
use std::time::Duration;

use serialport::{DataBits, FlowControl, SerialPort, StopBits};

use super::{Link, News, pause};
use crate::control::Lines;
use crate::line::pace::{Framing, Parity};

/// A serial device.
pub struct SerialLink {
    port: Box<dyn SerialPort>,
    told: bool,
    lines: Option<Lines>,
}

impl SerialLink {
    /// Opens a device, DTR and RTS on, no flow control by the driver.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn new(device: &str, baud: u32, framing: Framing) -> io::Result<Self> {
        let data = match framing.data {
            5 => DataBits::Five,
            6 => DataBits::Six,
            7 => DataBits::Seven,
            _ => DataBits::Eight,
        };
        let parity = match framing.parity {
            Parity::None => serialport::Parity::None,
            Parity::Even => serialport::Parity::Even,
            Parity::Odd => serialport::Parity::Odd,
        };
        let stop = if framing.stop == 1 { StopBits::One } else { StopBits::Two };
        let mut port = serialport::new(device, baud)
            .data_bits(data)
            .parity(parity)
            .stop_bits(stop)
            .flow_control(FlowControl::None)
            .timeout(Duration::from_millis(1))
            .open()?;
        // A pseudo-terminal has no modem lines.
        let _ = port.write_data_terminal_ready(true);
        let _ = port.write_request_to_send(true);
        Ok(SerialLink { port, told: false, lines: None })
    }
}

impl Link for SerialLink {
    fn wait(&mut self, room: usize, timeout: Duration) -> io::Result<News> {
        if !self.told {
            self.told = true;
            return Ok(News::Opened);
        }
        if room == 0 {
            pause(timeout);
            return Ok(News::Quiet);
        }
        self.port.set_timeout(timeout.max(Duration::from_millis(1)))?;
        let mut bytes = vec![0; room];
        match self.port.read(&mut bytes) {
            Ok(0) => Err(io::Error::new(io::ErrorKind::BrokenPipe, "the device is gone")),
            Ok(count) => {
                bytes.truncate(count);
                Ok(News::Bytes(bytes))
            }
            Err(error)
                if matches!(
                    error.kind(),
                    io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
                ) =>
            {
                Ok(News::Quiet)
            }
            Err(error) => Err(error),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.write_all(bytes)
    }

    /// The control's RTS is the sender's CTS, its DTR the sender's DSR; a device without lines is let be.
    fn lines(&mut self, lines: Lines) -> io::Result<Option<bool>> {
        if self.lines != Some(lines) {
            self.lines = Some(lines);
            let _ = self.port.write_request_to_send(lines.cts);
            let _ = self.port.write_data_terminal_ready(lines.dsr);
        }
        Ok(self.port.read_data_set_ready().ok())
    }

    fn pull(&mut self) -> io::Result<()> {
        Err(io::Error::new(io::ErrorKind::Unsupported, "a real cable cannot be pulled from here"))
    }
}
