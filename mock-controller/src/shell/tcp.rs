//! A listening socket as the link: one sender at a time, the next one waits in the backlog.

use std::io::{self, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::Duration;

use super::{Link, News, pause};

/// A socket a sender can connect to.
pub struct TcpLink {
    listener: TcpListener,
    stream: Option<TcpStream>,
    /// Writing failed: the sender is gone.
    lost: bool,
}

impl TcpLink {
    /// Takes a socket that is already bound.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn new(listener: TcpListener) -> io::Result<Self> {
        listener.set_nonblocking(true)?;
        Ok(TcpLink { listener, stream: None, lost: false })
    }

    /// Where it listens; the port the system chose if 0 was asked for.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    fn accept(&mut self, timeout: Duration) -> io::Result<News> {
        wait_readable(&self.listener, timeout)?;
        match self.listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(true)?;
                stream.set_nodelay(true)?; // DC3 must not wait for company.
                self.stream = Some(stream);
                self.lost = false;
                Ok(News::Opened)
            }
            Err(error) if is_passing(&error) || error.kind() == io::ErrorKind::ConnectionAborted => {
                Ok(News::Quiet)
            }
            Err(error) => Err(error),
        }
    }
}

impl Link for TcpLink {
    fn wait(&mut self, room: usize, timeout: Duration) -> io::Result<News> {
        let Some(stream) = &mut self.stream else {
            return self.accept(timeout);
        };
        if !self.lost {
            if room == 0 {
                pause(timeout);
                return Ok(News::Quiet);
            }
            wait_readable(stream, timeout)?;
            let mut bytes = vec![0; room];
            match stream.read(&mut bytes) {
                Ok(0) => {}
                Ok(count) => {
                    bytes.truncate(count);
                    return Ok(News::Bytes(bytes));
                }
                Err(error) if is_passing(&error) => return Ok(News::Quiet),
                Err(_) => {} // Reset by the sender: as closed.
            }
        }
        self.stream = None;
        Ok(News::Closed)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(stream) = &mut self.stream {
            match stream.write_all(bytes) {
                Ok(()) => {}
                Err(error) if is_passing(&error) => {} // The sender does not read: dropped.
                Err(_) => self.lost = true,
            }
        }
        Ok(())
    }

    fn pull(&mut self) -> io::Result<()> {
        self.stream = None;
        Ok(())
    }
}

fn is_passing(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted)
}

/// Waits with a fine timeout: a DC3 that leaves a millisecond late is a character of overrun.
#[cfg(unix)]
fn wait_readable(socket: &impl std::os::fd::AsFd, timeout: Duration) -> io::Result<()> {
    use rustix::event::PollFlags;
    super::pty::poll_one(socket, PollFlags::IN, timeout).map(|_| ())
}

/// Without poll: looks again every millisecond.
#[cfg(not(unix))]
fn wait_readable<S>(_socket: &S, timeout: Duration) -> io::Result<()> {
    pause(timeout.min(Duration::from_millis(1)));
    Ok(())
}
