//! The screen of a running feed: one live line on a terminal, plain lines elsewhere.

use std::io::{IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::link::feed::Snapshot;
use crate::protocol::Phase;

/// The length of the program, once it is known.
#[derive(Clone, Debug, Default)]
pub(super) struct Total {
    /// Blocks, 0 while unknown.
    pub(super) blocks: Arc<AtomicU64>,
    /// Bytes on the line, 0 while unknown.
    pub(super) bytes: Arc<AtomicU64>,
}

/// Shows a feed.
pub(super) struct Screen {
    bar: Option<ProgressBar>,
    total: Total,
    /// Time a byte takes, where the line is paced.
    character: Option<Duration>,
    last_words: String,
    last_line_at: Duration,
}

impl Screen {
    pub(super) fn new(total: Total, character: Option<Duration>) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
            if let Ok(style) = ProgressStyle::with_template("{wide_msg}") {
                bar.set_style(style);
            }
            bar
        });
        Self { bar, total, character, last_words: String::new(), last_line_at: Duration::ZERO }
    }

    /// Refreshes: the live line always, a plain line when something changed or ten seconds went by.
    pub(super) fn show(&mut self, snapshot: &Snapshot) {
        let line = self.line(snapshot);
        match &self.bar {
            Some(bar) => bar.set_message(line),
            None => {
                let words = state_words(snapshot, false);
                let due = snapshot.now >= self.last_line_at + PLAIN_EVERY;
                if words != self.last_words || due {
                    self.last_words = words;
                    self.last_line_at = snapshot.now;
                    // A screen nobody reads is no reason to stop cutting.
                    let _ = writeln!(std::io::stderr(), "{line}");
                }
            }
        }
    }

    /// Leaves the last line standing.
    pub(super) fn finish(self, snapshot: &Snapshot) {
        let line = self.line(snapshot);
        match self.bar {
            Some(bar) => bar.finish_with_message(line),
            None => {
                let _ = writeln!(std::io::stderr(), "{line}");
            }
        }
    }

    fn line(&self, snapshot: &Snapshot) -> String {
        let blocks = self.total.blocks.load(Ordering::Relaxed);
        let bytes = self.total.bytes.load(Ordering::Relaxed);
        let sent = snapshot.tally.bytes;
        // What matters most stands first: a terminal of 80 columns cuts the end off.
        let stopping = snapshot.stopping && snapshot.phase != Phase::Ended;
        let mut line =
            String::from(if stopping { "stopping after this block, Ctrl-C again: at once; " } else { "" });
        line.push_str(&format!("block {}", snapshot.block));
        if blocks > 0 {
            line.push_str(&format!("/{blocks}"));
        }
        line.push_str(&format!(", {}", size(sent)));
        if bytes > 0 {
            line.push_str(&format!(", {:.0} %", 100.0 * sent.min(bytes) as f64 / bytes as f64));
        }
        line.push_str(&format!(", {}", state_words(snapshot, true)));
        if let (Some(character), true) = (self.character, bytes > sent && snapshot.phase == Phase::Feeding) {
            let seconds = character.as_secs_f64() * (bytes - sent) as f64;
            line.push_str(&format!(", {} to go", clock(Duration::from_secs_f64(seconds))));
        }
        if snapshot.tally.holds > 0 {
            line.push_str(&format!(" (held {} before)", clock(snapshot.tally.held)));
        }
        if !snapshot.journal_ok {
            line.push_str(", RESUME NOT GUARANTEED: the journal cannot be written");
        }
        line
    }
}

/// The state of the line in words.
fn state_words(snapshot: &Snapshot, with_time: bool) -> String {
    let since = |from: Duration| {
        if with_time { format!(" for {}", clock(snapshot.now.saturating_sub(from))) } else { String::new() }
    };
    match snapshot.phase {
        Phase::AwaitingStart { since: from } => {
            format!("waiting for the control to ask (DC1){}", since(from))
        }
        Phase::Feeding => "feeding".to_owned(),
        Phase::Held { since: from } => format!("held by the control{}", since(from)),
        Phase::Draining => "the last bytes are on the line".to_owned(),
        Phase::Lingering { .. } => "all blocks sent; the control may still ask for the trailer".to_owned(),
        Phase::Ended => "ended".to_owned(),
    }
}

/// Hours, minutes, seconds.
pub(super) fn clock(time: Duration) -> String {
    let s = time.as_secs();
    format!("{:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
}

/// Bytes for a person.
fn size(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{bytes} B"),
        10_000..10_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// How often a plain line is printed when nothing changes.
const PLAIN_EVERY: Duration = Duration::from_secs(10);
