//! One feed from open port to last word: what `send`, `resume` and `demo` share.

use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::connection::Connection;
use super::failure::{Exit, Failure};
use super::screen::{Screen, Total};
use super::source::Source;
use super::verdict;
use crate::journal::Record;
use crate::journal::writer::Journal;
use crate::link::Link;
use crate::link::feed::{self, Outcome, Shared, Snapshot};
use crate::protocol::dc_codes::{DcCodes, Settings};
use crate::protocol::{Protocol, Tally};

/// The time of day, RFC 3339.
pub(super) fn time_of_day() -> String {
    let now = jiff::Timestamp::now();
    format!("{now:.0}")
}

/// Prints the program text from a block on, as it would be sent.
pub(super) fn dry_run(source: &Source, from_block: u64) -> Result<(), Failure> {
    let mut program = source.counted()?;
    let (mut out, mut text) = (std::io::stdout().lock(), Vec::new());
    loop {
        let start = text.len();
        match program.pull(&mut text) {
            Ok(Some(numbered)) if numbered.goes_out_from(from_block) => text.push(b'\n'),
            Ok(Some(_)) => text.truncate(start),
            Ok(None) => break,
            Err(error) => {
                let _ = out.write_all(&text[..start]);
                return Err(Failure::program(&source.path, error));
            }
        }
        if text.len() >= 1 << 16 {
            out.write_all(&text).map_err(Failure::output)?;
            text.clear();
        }
    }
    out.write_all(&text).and_then(|()| out.flush()).map_err(Failure::output)?;
    if program.blocks() == 0 {
        return Err(Failure::new(Exit::Program, format!("{} holds no block", source.path)));
    }
    if program.blocks() + 1 < from_block {
        return Err(no_such_block(from_block, program.blocks()));
    }
    Ok(())
}

/// A block was named that the program does not have.
pub(super) fn no_such_block(block: u64, blocks: u64) -> Failure {
    Failure::new(Exit::Usage, format!("block {block} does not exist: the program has {blocks} blocks"))
        .help("blocks count from 1 as sent; the lead-in is block 1")
}

/// A job ready to be fed.
pub(super) struct Feeding<'a> {
    pub(super) source: &'a Source,
    pub(super) line: Connection,
    pub(super) link: Box<dyn Link>,
    pub(super) journal: Journal,
    pub(super) job: String,
    pub(super) from_block: u64,
    pub(super) report: Option<PathBuf>,
    pub(super) stops: StopFlags,
    /// Whether the job was begun before: a torn line may stand in the control.
    pub(super) is_resumed: bool,
    /// A `dripfeed resume …` line up to the block number; none when there is nothing to go on with.
    pub(super) resume: Option<String>,
}

impl Feeding<'_> {
    /// Feeds to the end, whatever that is, and says how it went.
    pub(super) fn run(self) -> Result<(), Failure> {
        let (job, resume, source) = (self.job.clone(), self.resume.clone(), self.source.path.clone());
        let outcome = self.feed()?;
        verdict::conclude(outcome, &job, resume.as_deref(), &source)
    }

    /// Feeds to the end, whatever that is.
    #[expect(clippy::disallowed_methods, reason = "the job begins here, by the clock")]
    pub(super) fn feed(mut self) -> Result<Outcome, Failure> {
        let program = self.source.program()?;
        let tape = self.line.profile.tape.clone();
        let encode = |line: Result<Vec<u8>, _>| {
            line.map_err(|error: crate::tape::Unencodable| Failure::new(Exit::Profile, error.to_string()))
        };
        let leader = encode(if self.is_resumed { tape.resumed_leader() } else { tape.leader() })?;
        let settings = Settings {
            pace: self.line.pace,
            wait_for_start: self.line.profile.wait_for_start,
            start_timeout: self.line.profile.start_timeout,
            leader,
            trailer: encode(tape.trailer())?,
        };
        let around = settings.leader.len() + settings.trailer.len();
        let total = self.total(around as u64, tape.end_of_block.len() as u64);
        let began = Instant::now();
        let mut protocol = DcCodes::new(settings, Duration::ZERO);
        let empty = Snapshot {
            phase: protocol.phase(),
            now: Duration::ZERO,
            block: self.from_block - 1,
            tally: Tally::default(),
            first_byte: None,
            journal_ok: true,
            stopping: false,
        };
        let shared = Shared { stops: Arc::new(AtomicU32::new(0)), snapshot: Arc::new(Mutex::new(empty)) };
        let job = feed::Job {
            program,
            tape,
            from_block: self.from_block,
            journal: self.journal,
            one_by_one: self.line.pace.character.is_some()
                || self.source.is_stream()
                || self.source.macro_program().is_some(),
        };
        let mut screen = Screen::new(total, self.line.pace.character);
        let link = &mut self.link;
        let (outcome, journal) = std::thread::scope(|scope| {
            let (done, finished) = channel();
            let in_thread = &shared;
            std::thread::Builder::new().name("feed".to_owned()).spawn_scoped(scope, move || {
                let result = feed::run(link.as_mut(), &mut protocol, job, in_thread, began);
                link.close();
                let _ = done.send(result);
            })?;
            loop {
                match finished.recv_timeout(REFRESH) {
                    Ok(result) => return result,
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(std::io::Error::other("the feeding thread ended without a word"));
                    }
                }
                for flag in &self.stops.0 {
                    if flag.swap(false, Ordering::Relaxed) {
                        shared.stops.fetch_add(1, Ordering::Relaxed);
                    }
                }
                if let Ok(snapshot) = shared.snapshot.lock().map(|s| *s) {
                    screen.show(&snapshot);
                }
            }
        })
        .map_err(|error: std::io::Error| Failure::new(Exit::Ours, error.to_string()))?;
        screen.finish(&outcome.last);

        journal.note(Record::Ended(verdict::ended(&outcome)));
        let journal_error = journal.close();
        if let Some(path) = &self.report {
            let report = verdict::report(&outcome, self.from_block, self.line.pace.character);
            if let Err(error) = std::fs::write(
                path,
                format!(
                    "{report}
"
                ),
            ) {
                say!("warning: the report {} cannot be written: {error}", path.display());
            }
        }
        if let Some(error) = journal_error {
            say!("warning: resume is not guaranteed: the journal could not be written ({error})");
        }
        Ok(outcome)
    }

    /// The length of the program; that of a part is counted beside the feed, if it is not too long.
    fn total(&self, around: u64, end_of_block: u64) -> Total {
        let total = Total::default();
        if let Some(size) = self.source.size.filter(|_| self.from_block == 1) {
            total.blocks.store(size.blocks, Ordering::Relaxed);
            total.bytes.store(size.bytes + size.lines * end_of_block + around, Ordering::Relaxed);
        } else if self.from_block == 1
            && self.source.prepared().is_some_and(|p| p.element_count() <= COUNT_ELEMENTS_MAX)
            && let Ok(mut program) = self.source.counted()
        {
            let counted = total.clone();
            let _ = std::thread::Builder::new().name("count".to_owned()).spawn(move || {
                let (mut text, mut bytes) = (Vec::new(), around);
                while let Ok(Some(_)) = program.pull(&mut text) {
                    bytes += text.len() as u64 + end_of_block;
                    text.clear();
                }
                counted.blocks.store(program.blocks(), Ordering::Relaxed);
                counted.bytes.store(bytes, Ordering::Relaxed);
            });
        }
        total
    }
}

/// Flags raised by the signals that ask for a stop.
#[derive(Debug)]
pub(super) struct StopFlags(Vec<Arc<AtomicBool>>);

impl StopFlags {
    /// From here on Ctrl-C, SIGTERM and SIGHUP raise a flag instead of ending the process. Called once all questions are
    /// answered and before anything is written down.
    pub(super) fn watch() -> Result<Self, Failure> {
        use signal_hook::consts::{SIGINT, SIGTERM};
        #[cfg(unix)]
        let wanted = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
        #[cfg(not(unix))]
        let wanted = [SIGINT, SIGTERM];
        let mut flags = Vec::new();
        for signal in wanted {
            let flag = Arc::new(AtomicBool::new(false));
            signal_hook::flag::register(signal, Arc::clone(&flag))
                .map_err(|error| Failure::new(Exit::Ours, format!("cannot watch for Ctrl-C: {error}")))?;
            flags.push(flag);
        }
        Ok(Self(flags))
    }
}

/// How often the screen is refreshed and a stop noticed.
const REFRESH: Duration = Duration::from_millis(50);
/// A part with more elements is not counted beforehand; its progress has no percentage.
const COUNT_ELEMENTS_MAX: u64 = 2_000_000;
