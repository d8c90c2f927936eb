//! A pseudo-terminal as the link: a symbolic link to its slave side, which senders open like a serial device.
//!
//! That a sender has opened the slave is seen by the master's hang-up going away, that it has closed it by the hang-up
//! coming back. Since a hang-up cannot be waited for to go away, a closed link is looked at every few milliseconds.
//! A slave that is closed and opened again between two looks counts as open throughout.
//!
//! A sender usually throws away stale input just after opening. So an opening is told only after `SETTLE`, or with the
//! first byte, lest the first DC1 be thrown away with it.
//!
//! Measured on Linux only. A pseudo-terminal ignores baud and parity; pacing is the control's own (domain/4).

use std::fs;
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::ffi::OsStrExt as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::pty::OpenptFlags;
use rustix::termios::{OptionalActions, QueueSelector};

use super::{Clock, Link, News, pause};

/// A pseudo-terminal with a symbolic link to it, which is removed at the end.
pub struct PtyLink {
    link: PathBuf,
    master: OwnedFd,
    slave: PathBuf,
    state: State,
    clock: Clock,
}

#[derive(Clone, Copy, Debug)]
enum State {
    Closed,
    Settling { until: Duration },
    Open,
}

impl PtyLink {
    /// Makes a pseudo-terminal and the link to it. An old symbolic link in the way is replaced, nothing else is.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn new(link: &Path) -> io::Result<Self> {
        let (master, slave) = open_pair()?;
        let pty =
            PtyLink { link: link.to_owned(), master, slave, state: State::Closed, clock: Clock::start() };
        pty.point()?;
        Ok(pty)
    }

    /// Points the link at the slave, in one step.
    fn point(&self) -> io::Result<()> {
        if let Ok(found) = fs::symlink_metadata(&self.link)
            && !found.file_type().is_symlink()
        {
            return Err(io::Error::new(
                io::ErrorKind::AlreadyExists,
                "there is a file that is no symbolic link",
            ));
        }
        let mut name = self.link.as_os_str().to_owned();
        name.push(format!(".{}", std::process::id()));
        let beside = PathBuf::from(name);
        std::os::unix::fs::symlink(&self.slave, &beside)?;
        fs::rename(&beside, &self.link).inspect_err(|_| {
            let _ = fs::remove_file(&beside);
        })
    }

    /// A fresh pair in place of the old: whoever has the old slave open finds it gone.
    fn renew(&mut self) -> io::Result<()> {
        (self.master, self.slave) = open_pair()?;
        self.state = State::Closed;
        self.point()
    }

    /// After a sender: what it did not read is thrown away, and its claim to be the only one (TIOCEXCL) ends with it.
    fn tidy(&mut self) -> io::Result<()> {
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        match rustix::fs::open(&self.slave, flags, Mode::empty()) {
            Ok(slave) => {
                let _ = rustix::termios::tcflush(&slave, QueueSelector::IFlush);
                let _ = rustix::termios::ioctl_tiocnxcl(&slave);
                Ok(())
            }
            Err(_) => self.renew(),
        }
    }

    fn read(&mut self, room: usize) -> io::Result<News> {
        let mut bytes = vec![0; room];
        match rustix::io::read(&self.master, &mut bytes) {
            Ok(0) | Err(rustix::io::Errno::IO) => self.closed(),
            Ok(count) => {
                bytes.truncate(count);
                Ok(News::Bytes(bytes))
            }
            Err(rustix::io::Errno::INTR | rustix::io::Errno::AGAIN) => Ok(News::Quiet),
            Err(error) => Err(error.into()),
        }
    }

    fn closed(&mut self) -> io::Result<News> {
        self.state = State::Closed;
        self.tidy()?;
        Ok(News::Closed)
    }
}

impl Link for PtyLink {
    fn wait(&mut self, room: usize, timeout: Duration) -> io::Result<News> {
        match self.state {
            State::Closed => {
                let seen = poll_one(&self.master, PollFlags::IN, Duration::ZERO)?;
                if seen.contains(PollFlags::IN) {
                    self.state = State::Open;
                    return Ok(News::Opened);
                }
                if !seen.contains(PollFlags::HUP) {
                    self.state = State::Settling { until: self.clock.now() + SETTLE };
                    return Ok(News::Quiet);
                }
                pause(timeout.min(LOOK));
                Ok(News::Quiet)
            }
            State::Settling { until } => {
                let seen = poll_one(&self.master, PollFlags::IN, timeout.min(LOOK))?;
                if seen.contains(PollFlags::IN) || (seen.is_empty() && self.clock.now() >= until) {
                    self.state = State::Open;
                    return Ok(News::Opened);
                }
                if seen.contains(PollFlags::HUP) {
                    self.state = State::Closed;
                    self.tidy()?;
                }
                Ok(News::Quiet)
            }
            State::Open => {
                let wanted = if room > 0 { PollFlags::IN } else { PollFlags::empty() };
                let seen = poll_one(&self.master, wanted, timeout)?;
                if seen.contains(PollFlags::IN) {
                    return self.read(room);
                }
                if !seen.contains(PollFlags::HUP) {
                    return Ok(News::Quiet);
                }
                if room > 0 {
                    return self.closed();
                }
                // Hung up, but bytes may be left that there is no room for.
                pause(timeout.min(LOOK));
                Ok(News::Quiet)
            }
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match rustix::io::write(&self.master, bytes) {
            Ok(_) => Ok(()),
            // Nobody reads, or nobody is there: dropped.
            Err(rustix::io::Errno::AGAIN | rustix::io::Errno::INTR | rustix::io::Errno::IO) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn pull(&mut self) -> io::Result<()> {
        self.renew()
    }
}

impl Drop for PtyLink {
    fn drop(&mut self) {
        if fs::read_link(&self.link).is_ok_and(|target| target == self.slave) {
            let _ = fs::remove_file(&self.link);
        }
    }
}

/// A raw pair without echo, its slave closed so that the master reports a hang-up.
fn open_pair() -> io::Result<(OwnedFd, PathBuf)> {
    let master = rustix::pty::openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
    rustix::pty::grantpt(&master)?;
    rustix::pty::unlockpt(&master)?;
    let name = rustix::pty::ptsname(&master, Vec::new())?;
    let slave = PathBuf::from(std::ffi::OsStr::from_bytes(name.as_bytes()));
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
    let opened = rustix::fs::open(&slave, flags, Mode::empty())?;
    let mut termios = rustix::termios::tcgetattr(&opened)?;
    termios.make_raw();
    rustix::termios::tcsetattr(&opened, OptionalActions::Now, &termios)?;
    rustix::io::ioctl_fionbio(&master, true)?;
    Ok((master, slave))
}

/// Waits for one descriptor, with a timeout finer than a millisecond.
pub(super) fn poll_one(fd: &impl AsFd, events: PollFlags, timeout: Duration) -> io::Result<PollFlags> {
    let timeout = Timespec::try_from(timeout).map_err(|_| io::Error::from(io::ErrorKind::InvalidInput))?;
    let mut fds = [PollFd::new(fd, events)];
    match poll(&mut fds, Some(&timeout)) {
        Ok(_) | Err(rustix::io::Errno::INTR) => Ok(fds[0].revents()),
        Err(error) => Err(error.into()),
    }
}

/// How long after an opening it is told, so that a sender has thrown away its stale input. A guess; senders do it within
/// a millisecond or two.
const SETTLE: Duration = Duration::from_millis(50);

/// Between two looks at a link nobody has open.
const LOOK: Duration = Duration::from_millis(3);
