//! The shell: the only place with a clock, a pseudo-terminal, a socket, a serial device and files.
//!
//! One loop, [`serve`], drives a [`Controller`] from any [`Link`]. It never waits longer than the control's next event
//! or `GLANCE`, and never spins: a link that has hung up is looked at every few milliseconds.

pub mod files;
#[cfg(unix)]
pub mod pty;
pub mod serial;
pub mod tcp;

use std::io;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::control::settings::{Settings, Until};
use crate::control::{Controller, Lines};
use crate::observer::Observer;
use crate::report::Report;

/// Something a sender can open, write to and close.
pub trait Link {
    /// Waits for news, at most about `timeout`. Reads at most `room` bytes.
    ///
    /// # Errors
    ///
    /// What the system says when the link itself, not the sender, is gone.
    fn wait(&mut self, room: usize, timeout: Duration) -> io::Result<News>;

    /// Sends to the sender's program. Bytes nobody takes are dropped.
    ///
    /// # Errors
    ///
    /// As [`Link::wait`].
    fn write(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Sets the control's lines, where there are any, and tells whether the sender's DTR is on, where that can be seen.
    ///
    /// # Errors
    ///
    /// As [`Link::wait`].
    fn lines(&mut self, _lines: Lines) -> io::Result<Option<bool>> {
        Ok(None)
    }

    /// Pulls the cable: the sender sees its port gone. The link can be opened again afterwards.
    ///
    /// # Errors
    ///
    /// As [`Link::wait`].
    fn pull(&mut self) -> io::Result<()>;
}

/// What a link has to tell.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum News {
    /// Nothing so far.
    Quiet,
    /// A sender has opened it.
    Opened,
    /// The sender wrote this.
    Bytes(Vec<u8>),
    /// The sender has closed it, and everything it wrote has been told.
    Closed,
}

/// Drives the control until it is told to stop, an alarm is raised, or ([`Until::ProgramEnd`]) a program has ended.
///
/// After an alarm or a program's end it lingers until the sender closes, at most [`LINGER`], so that the control's last
/// word is heard. `tick` is called at the start, every [`TICK`], and at the end.
///
/// # Errors
///
/// What the link or `tick` fails with.
pub fn serve<O: Observer>(
    link: &mut dyn Link,
    control: &mut Controller<O>,
    stop: &AtomicBool,
    mut tick: impl FnMut(&mut Controller<O>) -> io::Result<()>,
) -> io::Result<()> {
    let clock = Clock::start();
    let mut next_tick = Duration::ZERO;
    let mut is_open = false;
    let mut finished_at = None;
    loop {
        let now = clock.now();
        let spoken = control.receive(now);
        if !spoken.is_empty() {
            link.write(&spoken)?;
        }
        if control.take_disconnected() {
            is_open = false;
            link.pull()?;
        }
        if let Some(ready) = link.lines(control.lines())? {
            control.sender_ready(ready, now);
        }
        if now >= next_tick {
            next_tick = now + TICK;
            tick(control)?;
        }
        if control.is_finished()
            && (control.alarm().is_some() || control.settings().until == Until::ProgramEnd)
        {
            let since = *finished_at.get_or_insert(now);
            if !is_open || now >= since + LINGER {
                break;
            }
        }
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let next = control.next_wakeup().map_or(next_tick, |at| at.min(next_tick));
        let timeout = next.saturating_sub(clock.now()).min(GLANCE);
        match link.wait(control.room().min(READ_BYTES_MAX), timeout)? {
            News::Quiet => {}
            News::Opened => {
                is_open = true;
                control.link_opened(clock.now());
            }
            News::Bytes(bytes) => {
                let accepted = control.send(&bytes, clock.now());
                debug_assert!(
                    accepted == bytes.len() || !is_open,
                    "a link reads no more than there is room for"
                );
            }
            News::Closed => {
                is_open = false;
                control.link_closed(clock.now());
            }
        }
    }
    tick(control)
}

/// Plays a control behind a listening socket, one sender at a time; returns when `stop` is set, on an alarm, or, with
/// [`Until::ProgramEnd`] in the settings, after a program's end.
///
/// For a demo that embeds the control in a thread of its own. Watch it through `observer`, which may be a `&mut`.
///
/// # Errors
///
/// Settings that contradict each other ([`io::ErrorKind::InvalidInput`]), or what the socket fails with.
pub fn serve_tcp<O: Observer>(
    listener: TcpListener,
    settings: Settings,
    observer: O,
    stop: Arc<AtomicBool>,
) -> io::Result<Report> {
    let mut control = Controller::observed(settings, observer)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let mut link = tcp::TcpLink::new(listener)?;
    serve(&mut link, &mut control, &stop, |_| Ok(()))?;
    Ok(control.report())
}

/// Time since the shell began.
struct Clock {
    start: Instant,
}

impl Clock {
    #[expect(clippy::disallowed_methods, reason = "the shell is where the clock is")]
    fn start() -> Self {
        Clock { start: Instant::now() }
    }

    fn now(&self) -> Duration {
        self.start.elapsed()
    }
}

/// Waits without listening to anything.
#[expect(clippy::disallowed_methods, reason = "the shell is where the clock is")]
fn pause(duration: Duration) {
    std::thread::sleep(duration);
}

/// Between two writings of the status file.
pub const TICK: Duration = Duration::from_millis(200);

/// Longest the sender is given to close after the control's last word.
pub const LINGER: Duration = Duration::from_secs(1);

/// Longest wait before the stop flag is looked at again.
const GLANCE: Duration = Duration::from_millis(50);

/// Most bytes read at once: on an unpaced line, what is cut before the status is written again.
const READ_BYTES_MAX: usize = 1024;
