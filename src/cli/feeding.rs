//! What `send` and `resume` share: the options of the line, and one feed from open port to last word.

use std::io::{BufRead, BufReader, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::json;

use super::failure::{Exit, Failure};
use super::machines;
use super::screen::{Screen, Total};
use super::source::Source;
use crate::journal::writer::Journal;
use crate::journal::{Ended, How, Record};
use crate::link::feed::{self, Outcome, Shared, Snapshot, SourceFault};
use crate::link::serial::{Latency, SerialLink};
use crate::link::tcp::TcpLink;
use crate::link::{Link, Port};
use crate::profile::{Framing, Profile};
use crate::program::{Line, ProgramError};
use crate::protocol::dc_codes::{DcCodes, Settings};
use crate::protocol::pacing::Pace;
use crate::protocol::{self, Ending, Protocol, Tally, Torn};

/// Options of the line; what they change of the machine's profile.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Line")]
pub(super) struct LineOptions {
    /// Protocol, instead of the profile's
    #[arg(long, value_parser = ["dc-codes"])]
    pub(super) protocol: Option<String>,
    /// Speed of the line, instead of the profile's; over TCP it turns pacing on
    #[arg(long, value_name = "N", conflicts_with = "unpaced")]
    pub(super) baud: Option<u32>,
    /// Do not pace a pseudo-terminal: hand over what it takes
    #[arg(long)]
    pub(super) unpaced: bool,
    /// Data bits, parity, stop bits, such as 7E2, instead of the profile's
    #[arg(long, value_name = "7E2")]
    pub(super) framing: Option<String>,
    /// Any other value of the profile
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
}

impl LineOptions {
    /// As words, to be written down and read back.
    pub(super) fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        words.extend(self.protocol.iter().map(|v| format!("protocol={v}")));
        words.extend(self.baud.iter().map(|v| format!("baud={v}")));
        words.extend(self.unpaced.then(|| "unpaced".to_owned()));
        words.extend(self.framing.iter().map(|v| format!("framing={v}")));
        words.extend(self.set.iter().map(|v| format!("set {v}")));
        words
    }

    /// From words written down, what is given here winning over them.
    pub(super) fn or(mut self, words: &[String]) -> Self {
        let mut set = Vec::new();
        for word in words {
            match word.split_once('=') {
                Some(("protocol", value)) => self.protocol = self.protocol.or_else(|| Some(value.to_owned())),
                Some(("baud", value)) if !self.unpaced => {
                    self.baud = self.baud.or_else(|| value.parse().ok())
                }
                Some(("framing", value)) => self.framing = self.framing.or_else(|| Some(value.to_owned())),
                _ if word == "unpaced" => self.unpaced |= self.baud.is_none(),
                _ => set.extend(word.strip_prefix("set ").map(str::to_owned)),
            }
        }
        set.append(&mut self.set);
        Self { set, ..self }
    }
}

/// A machine's profile with everything the command line changes, and whether anything was named at all.
pub(super) fn profile(machine: Option<&str>, line: &LineOptions) -> Result<Profile, Failure> {
    let name = machine.unwrap_or("generic-iso");
    let file = machines::load(name)?;
    if machine.is_none() {
        eprintln!("no --machine is named; feeding as generic-iso:\n");
        eprintln!("{}", crate::profile::GENERIC_ISO);
    } else if !file.assumed.is_empty() {
        eprintln!("{name}: not given, taken from generic-iso: {}", file.assumed.join(", "));
    }
    let mut profile = file.profile;
    if let Some(baud) = line.baud {
        set(&mut profile, "baud", &baud.to_string(), "--baud")?;
    }
    if let Some(framing) = &line.framing {
        if Framing::parse(framing).is_none() {
            return Err(Failure::new(
                Exit::Usage,
                format!("--framing {framing} is not data bits 5-8, parity N, E or O, and stop bits 1 or 2"),
            )
            .help("typical is --framing 7E2"));
        }
        set(&mut profile, "framing", framing, "--framing")?;
    }
    for pair in &line.set {
        let Some((key, value)) = pair.split_once('=') else {
            return Err(Failure::new(Exit::Usage, format!("--set {pair} is not KEY=VALUE")).help(
                "for example --set pacing=strict; `dripfeed machines show generic-iso` lists the keys",
            ));
        };
        set(&mut profile, key.trim(), value.trim(), "--set")?;
    }
    Ok(profile)
}

fn set(profile: &mut Profile, key: &str, value: &str, option: &str) -> Result<(), Failure> {
    profile.set(key, value).map_err(|error| {
        let failure = Failure::new(Exit::Usage, format!("{option}: {error}"));
        match error.help {
            Some(help) => failure.help(help),
            None => failure,
        }
    })
}

/// Where a job goes and how the line is paced.
#[derive(Debug)]
pub(super) struct Connection {
    pub(super) port: Port,
    pub(super) profile: Profile,
    pub(super) pace: Pace,
}

impl Connection {
    /// Works out the pacing and says what it means, before the port is opened.
    pub(super) fn plan(port: Port, profile: Profile, options: &LineOptions) -> Self {
        // Where no adapter delays what the control says, this process itself may still be late to hear it.
        let own = OWN_DELAY.min(2 * profile.framing.character(profile.baud));
        let (paced, latency, source) = match (&port, profile.receive_latency) {
            (Port::Tcp(_), given) => {
                let source = if given.is_some() {
                    "from the profile"
                } else {
                    "for this system's own delays; the network's is not known"
                };
                (options.baud.is_some() && !options.unpaced, given.unwrap_or(own), source)
            }
            (Port::Serial(_), Some(latency)) => (!options.unpaced, latency, "from the profile"),
            (Port::Serial(device), None) => match Latency::of(device) {
                Latency::Nothing => (!options.unpaced, own, "for this system's own delays"),
                Latency::Adapter(latency) => {
                    (!options.unpaced, latency, "the adapter's latency timer and 1 ms")
                }
                Latency::Assumed(latency) => {
                    (!options.unpaced, latency, "ASSUMED: the adapter does not say; set receive_latency_ms")
                }
            },
        };
        let pace = if paced { profile.pace(latency) } else { Pace::unpaced() };
        let line = Self { port, profile, pace };
        line.say(source);
        line
    }

    fn say(&self, latency_source: &str) {
        let Profile { baud, framing, overrun_limit, .. } = self.profile;
        let Some(_) = self.pace.character else {
            eprintln!(
                "{}: not paced; bytes under way when the control says stop cannot be recalled",
                self.port
            );
            return;
        };
        let worst = self.pace.worst_overrun();
        eprintln!(
            "{}: {baud} baud {framing}, window {} bytes, receive latency {:.1} ms ({latency_source})",
            self.port,
            self.pace.window,
            self.pace.latency.as_secs_f64() * 1e3
        );
        if self.pace.gaps.is_some() {
            eprintln!(
                "strict pacing: at most {worst} characters after DC3, by listening gaps; at most {:.0} % of the line's time is used",
                100.0 * self.pace.best_utilisation()
            );
        } else if worst > overrun_limit {
            eprintln!(
                "warning: up to {worst} characters may follow the control's DC3, and it allows {overrun_limit}; lower the adapter's latency timer, the baud, or keep the rule with --set pacing=strict"
            );
        }
    }

    /// Opens the port.
    pub(super) fn open(&self) -> Result<Box<dyn Link>, Failure> {
        Ok(match &self.port {
            Port::Serial(device) => Box::new(
                SerialLink::open(device, self.profile.baud, self.profile.framing)
                    .map_err(|error| Failure::link(&error))?,
            ),
            Port::Tcp(address) => Box::new(TcpLink::open(address).map_err(|error| Failure::link(&error))?),
        })
    }
}

/// The profile's values in one digest, so that a changed profile is noticed.
pub(super) fn profile_digest(profile: &Profile) -> String {
    blake3::hash(format!("{profile:?}").as_bytes()).to_hex().to_string()
}

/// The time of day, RFC 3339.
pub(super) fn time_of_day() -> String {
    let now = jiff::Timestamp::now();
    format!("{now:.0}")
}

/// Asks a question on the terminal. Without one, or without a yes, the command ends.
pub(super) fn ask(question: &str, yes: bool) -> Result<(), Failure> {
    if yes {
        return Ok(());
    }
    match answer(&format!("{question} [y/N] "))?.trim() {
        "y" | "Y" | "yes" => Ok(()),
        _ => Err(Failure::new(Exit::Stopped, "not confirmed; nothing was sent")),
    }
}

/// A line from the terminal, never from standard input.
pub(super) fn answer(question: &str) -> Result<String, Failure> {
    let terminal = if std::io::stderr().is_terminal() { std::fs::File::open(TERMINAL).ok() } else { None };
    let Some(terminal) = terminal else {
        let question = question.trim_end_matches("[y/N] ").trim();
        return Err(Failure::new(Exit::Usage, format!("there is no terminal to ask on: {question}"))
            .help("answer on the command line with --yes; `resume` wants --from-block N with it"));
    };
    eprint!("{question}");
    let _ = std::io::stderr().flush();
    let mut line = String::new();
    BufReader::new(terminal)
        .read_line(&mut line)
        .map_err(|error| Failure::new(Exit::Ours, format!("cannot read from the terminal: {error}")))?;
    Ok(line)
}

#[cfg(unix)]
const TERMINAL: &str = "/dev/tty";
#[cfg(not(unix))]
const TERMINAL: &str = "CONIN$";

/// Prints the program text from a block on, as it would be sent.
pub(super) fn dry_run(source: &Source, from_block: u64) -> Result<(), Failure> {
    let mut program = source.program()?;
    let (mut out, mut text, mut block) = (std::io::stdout().lock(), Vec::new(), 0);
    loop {
        let start = text.len();
        match program.pull(&mut text) {
            Ok(Some(line)) => {
                block += u64::from(matches!(line, Line::Block(_)));
                let next = if line == Line::StopWord { block + 1 } else { block };
                if next < from_block {
                    text.truncate(start);
                } else {
                    text.push(b'\n');
                }
            }
            Ok(None) => break,
            Err(ProgramError::Read(error)) => {
                let _ = out.write_all(&text[..start]);
                return Err(Failure::read(&source.path, error));
            }
        }
        if text.len() >= 1 << 16 {
            out.write_all(&text).map_err(Failure::output)?;
            text.clear();
        }
    }
    out.write_all(&text).and_then(|()| out.flush()).map_err(Failure::output)
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
    /// A `dripfeed resume …` line up to the block number.
    pub(super) resume: String,
}

impl Feeding<'_> {
    /// Feeds to the end, whatever that is, and says how it went.
    pub(super) fn run(self) -> Result<(), Failure> {
        let (job, resume, source) = (self.job.clone(), self.resume.clone(), self.source.path.clone());
        let outcome = self.feed()?;
        conclude(outcome, &job, &resume, &source)
    }

    /// Feeds to the end, whatever that is.
    #[expect(clippy::disallowed_methods, reason = "the job begins here, by the clock")]
    pub(super) fn feed(mut self) -> Result<Outcome, Failure> {
        let flags = signals()?;
        let program = self.source.program()?;
        let tape = self.line.profile.tape.clone();
        let encode = |line: Result<Vec<u8>, _>| {
            line.map_err(|error: crate::tape::Unencodable| Failure::new(Exit::Profile, error.to_string()))
        };
        let settings = Settings {
            pace: self.line.pace,
            wait_for_start: self.line.profile.wait_for_start,
            start_timeout: self.line.profile.start_timeout,
            leader: encode(tape.leader())?,
            trailer: encode(tape.trailer())?,
            ends_with_stop_word: self.source.ends_with_stop_word,
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
            paced: self.line.pace.character.is_some(),
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
                for flag in &flags {
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

        journal.note(Record::Ended(ended(&outcome)));
        let journal_error = journal.close();
        if let Some(path) = &self.report {
            let report = report(&outcome, self.from_block, self.line.pace.character);
            std::fs::write(path, format!("{report}\n")).map_err(|error| {
                Failure::new(Exit::Ours, format!("cannot write {}: {error}", path.display()))
            })?;
        }
        if let Some(error) = journal_error {
            eprintln!("warning: resume is not guaranteed: the journal could not be written ({error})");
        }
        Ok(outcome)
    }

    /// The length of the program; that of a part is counted beside the feed, if it is not too long.
    fn total(&self, around: u64, end_of_block: u64) -> Total {
        let total = Total::default();
        if let Some(size) = self.source.size.filter(|_| self.from_block == 1) {
            let lines = size.blocks + u64::from(self.source.ends_with_stop_word);
            total.blocks.store(size.blocks, Ordering::Relaxed);
            total.bytes.store(size.bytes + lines * (end_of_block - 1) + around, Ordering::Relaxed);
        } else if self.from_block == 1
            && self.source.prepared().is_some_and(|p| p.element_count() <= COUNT_ELEMENTS_MAX)
            && let Ok(mut program) = self.source.program()
        {
            let counted = total.clone();
            let _ = std::thread::Builder::new().name("count".to_owned()).spawn(move || {
                let (mut text, mut blocks, mut bytes) = (Vec::new(), 0, around);
                while let Ok(Some(line)) = program.pull(&mut text) {
                    blocks += u64::from(matches!(line, Line::Block(_)));
                    bytes += text.len() as u64 + end_of_block;
                    text.clear();
                }
                counted.blocks.store(blocks, Ordering::Relaxed);
                counted.bytes.store(bytes, Ordering::Relaxed);
            });
        }
        total
    }
}

/// A flag for each signal that asks for a stop.
fn signals() -> Result<Vec<Arc<AtomicBool>>, Failure> {
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
    Ok(flags)
}

fn ended(outcome: &Outcome) -> Ended {
    let (how, reason, torn) = match &outcome.ending {
        _ if outcome.source_error.is_some() => (How::Failed, "the program is at fault".to_owned(), None),
        Ending::Done { .. } => (How::Done, "all sent".to_owned(), None),
        Ending::Stopped { torn } => (How::Stopped, "stopped by the operator".to_owned(), *torn),
        Ending::Failed { failure, torn } => (How::Failed, failure.to_string(), *torn),
    };
    let torn_bytes = torn.map_or(0, |Torn { bytes, .. }| bytes as u64);
    Ended { how, reason, block: outcome.last.block, torn_bytes, at: time_of_day() }
}

/// The figures of a feed, with the names of the contract.
fn report(outcome: &Outcome, from_block: u64, character: Option<Duration>) -> serde_json::Value {
    let Snapshot { now, block, tally, first_byte, .. } = outcome.last;
    let sending = now.saturating_sub(first_byte.unwrap_or(now)).saturating_sub(tally.held);
    let utilisation = character.map(|character| {
        (character.as_secs_f64() * tally.bytes as f64 / sending.as_secs_f64().max(1e-9)).min(1.0)
    });
    json!({
        "blocks": block + 1 - from_block.min(block + 1),
        "bytes": tally.bytes,
        "seconds": now.as_secs_f64(),
        "held_seconds": tally.held.as_secs_f64(),
        "holds": tally.holds,
        // Without a wire-time model nothing is known of it.
        "max_overrun_bytes": character.map(|_| tally.max_overrun_bytes),
        "line_utilisation": utilisation,
        "first_byte_ms": first_byte.map(|at| at.as_secs_f64() * 1e3),
    })
}

/// The last word on a feed.
pub(super) fn conclude(outcome: Outcome, job: &str, resume: &str, source: &str) -> Result<(), Failure> {
    let block = outcome.last.block;
    let next = format!("{resume} --from-block {}", block + 1);
    let after = format!("block {block} was the last one sent whole");
    let torn_words = |torn: Option<Torn>| match torn {
        Some(Torn { block, bytes }) => format!("; block {block} is torn, {bytes} bytes of it were sent"),
        None => String::new(),
    };
    if let Some(error) = outcome.source_error {
        let place = format!("block {} cannot be made and was not sent", error.block);
        let failure = match error.fault {
            SourceFault::Program(ProgramError::Read(read)) => {
                let mut failure = Failure::read(source, read);
                failure.prefix(&place);
                failure
            }
            SourceFault::Tape(error) => Failure::new(Exit::Program, format!("{place}: {error}")),
            SourceFault::ProducerDied => {
                Failure::new(Exit::Ours, format!("{place}: its maker stopped without a word"))
            }
        };
        return Err(failure.resume_with(next));
    }
    match outcome.ending {
        Ending::Done { trailer_unsent } => {
            if trailer_unsent > 0 {
                eprintln!(
                    "the control stopped reading at the stop word; {trailer_unsent} bytes of trailer were not wanted"
                );
            }
            eprintln!("done: job {job}, {block} blocks");
            Ok(())
        }
        Ending::Stopped { torn } => {
            Err(Failure::new(Exit::Stopped, format!("stopped by the operator: {after}{}", torn_words(torn)))
                .help("the control's own screen says which block it executed last; name the one after it")
                .resume_with(next))
        }
        Ending::Failed { failure, torn } => {
            let what = match (failure, &outcome.link_error) {
                (protocol::Failure::LinkLost, Some(error)) => error.to_string(),
                (failure, _) => failure.to_string(),
            };
            let exit = match failure {
                protocol::Failure::ControlReset | protocol::Failure::ControlAlarm => Exit::Control,
                protocol::Failure::LinkLost | protocol::Failure::NeverStarted(_) => Exit::Link,
            };
            let help = match failure {
                protocol::Failure::NeverStarted(_) => {
                    "start reading at the control; if it asked before this job was armed, use --set start=at-once"
                }
                protocol::Failure::ControlReset | protocol::Failure::ControlAlarm => {
                    "clear the alarm at the control, and read there which block it executed last"
                }
                protocol::Failure::LinkLost => {
                    "mend the link; the control's own screen says which block it executed last: name the one after it"
                }
            };
            Err(Failure::new(exit, format!("{what}: {after}{}", torn_words(torn)))
                .help(help)
                .resume_with(next))
        }
    }
}

/// How late this process may be to hear the control, where the link itself adds nothing. A guess.
const OWN_DELAY: Duration = Duration::from_millis(3);
/// How often the screen is refreshed and a stop noticed.
const REFRESH: Duration = Duration::from_millis(50);
/// A part with more elements is not counted beforehand; its progress has no percentage.
const COUNT_ELEMENTS_MAX: u64 = 2_000_000;
