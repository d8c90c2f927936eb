//! A raw TCP device server: `tcp://host:port`.
//!
//! The server owns the serial port behind it: baud, framing and, if the rule of ten characters is to hold, XON/XOFF are
//! set there. What is in the network's buffers cannot be recalled.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream, ToSocketAddrs};
use std::time::Duration;

use super::{Link, LinkError};

/// A connection to a device server.
#[derive(Debug)]
pub struct TcpLink {
    stream: TcpStream,
}

impl TcpLink {
    /// Connects, waiting at most five seconds.
    ///
    /// # Errors
    ///
    /// When nothing answers there.
    pub fn open(address: &str) -> Result<Self, LinkError> {
        let refused = |error| LinkError::Refused { port: format!("tcp://{address}"), error };
        let mut last = io::Error::new(io::ErrorKind::NotFound, "the name has no address");
        for target in address.to_socket_addrs().map_err(refused)? {
            match TcpStream::connect_timeout(&target, CONNECT_TIMEOUT) {
                Ok(stream) => {
                    stream.set_nodelay(true).and_then(|()| stream.set_nonblocking(true)).map_err(refused)?;
                    return Ok(Self { stream });
                }
                Err(error) => last = error,
            }
        }
        Err(refused(last))
    }

    #[cfg(unix)]
    fn wait(&self, wait: Duration) -> io::Result<()> {
        use rustix::event::{PollFd, PollFlags, Timespec, poll};
        let mut descriptors = [PollFd::new(&self.stream, PollFlags::IN)];
        let timeout = Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: wait.subsec_nanos().into() };
        match poll(&mut descriptors, Some(&timeout)) {
            Ok(_) | Err(rustix::io::Errno::INTR) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    #[cfg(not(unix))]
    fn wait(&self, wait: Duration) -> io::Result<()> {
        // A socket time-out is as fine as these platforms get without another crate.
        self.stream.set_nonblocking(false)?;
        self.stream.set_read_timeout(Some(wait.max(Duration::from_millis(1))))?;
        let _ = self.stream.peek(&mut [0]);
        self.stream.set_nonblocking(true)
    }
}

const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);

/// The other side has closed. Whether that shows as an end, a reset or a broken pipe depends on what was still under way.
fn closed() -> LinkError {
    LinkError::Lost(io::Error::new(io::ErrorKind::UnexpectedEof, "the device server closed it"))
}

impl Link for TcpLink {
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> Result<usize, LinkError> {
        if !wait.is_zero() {
            self.wait(wait).map_err(LinkError::Lost)?;
        }
        match self.stream.read(buffer) {
            Ok(0) => Err(closed()),
            Ok(count) => Ok(count),
            Err(error) => match error.kind() {
                io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted => Ok(0),
                io::ErrorKind::ConnectionReset => Err(closed()),
                _ => Err(LinkError::Lost(error)),
            },
        }
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, LinkError> {
        match self.stream.write(bytes) {
            Ok(count) => Ok(count),
            Err(error) => match error.kind() {
                io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted => Ok(0),
                io::ErrorKind::ConnectionReset | io::ErrorKind::BrokenPipe => Err(closed()),
                _ => Err(LinkError::Lost(error)),
            },
        }
    }

    fn close(&mut self) {
        // Closing with unread bytes would reset the connection and destroy what is still under way.
        let _ = self.stream.shutdown(Shutdown::Write);
        let mut scrap = [0; 256];
        for _ in 0..CLOSE_WAITS {
            if self.receive(&mut scrap, Duration::from_millis(10)).is_err() {
                break;
            }
        }
    }
}

/// Ten milliseconds each: a second for the other side to take what is under way and close.
const CLOSE_WAITS: u32 = 100;
