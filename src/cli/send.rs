//! `dripfeed send SOURCE --port PORT`: feeds a program to a control, block by block, as the control asks for it.
//!
//! ```text
//! $ dripfeed send gear.toml --port /dev/ttyUSB0 --machine mill.toml
//! /dev/ttyUSB0: 4800 baud 7E2, window 1 bytes
//! receive latency 17.0 ms, the adapter's latency timer and 1 ms
//! block 120/265, 3085 B, 45 %, feeding, 00:00:08 to go
//! ```
//!
//! The source is checked first; then the port is opened, the job written down, and the control's request awaited. Ctrl-C
//! stops at the end of the block, a second one at once. What was sent is in the journal; `dripfeed resume` goes on.

use std::path::PathBuf;

use clap::Args;

use super::connection::{self, Connection, LineOptions};
use super::failure::{Exit, Failure};
use super::feeding::{self, Feeding, StopFlags};
use super::jobs;
use super::kind::Kind;
use super::machines;
use super::macros::MacroOptions;
use super::question;
use super::source::{MacroSource, Source};
use super::spot;
use crate::journal::Job;
use crate::journal::writer::{self, Writer};
use crate::link::Port;
use crate::part::Warning;

/// Feed a program to a control, block by block, as it asks
#[derive(Args, Debug)]
pub(super) struct Options {
    /// A 3B, 4B, G-code or macro program, a part file (.toml), or - for standard input
    source: String,
    /// A serial device, or tcp://host:port
    #[arg(long, value_name = "PORT", required_unless_present = "dry_run", value_parser = Port::parse)]
    port: Option<Port>,
    /// The machine's profile: a name or a file [default: generic-iso, printed in full]
    #[arg(long, value_name = "NAME|FILE")]
    machine: Option<String>,
    /// What the source is, instead of what its name says
    #[arg(long, value_enum)]
    from: Option<Kind>,
    /// The control a G-code program is for: a built-in dialect or a dialect file [default: the machine's, else generic]
    #[arg(long, value_name = "NAME|FILE")]
    dialect: Option<String>,
    /// Send this block first; the wire must stand where it begins
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    from_block: Option<u64>,
    /// Print the program text that would be sent, and open no port
    #[arg(long)]
    dry_run: bool,
    /// Answer every question with yes
    #[arg(long)]
    yes: bool,
    /// Where journals are kept [default: $XDG_STATE_HOME/dripfeed]
    #[arg(long, value_name = "DIR")]
    journal: Option<PathBuf>,
    /// Write the figures of the feed here, as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    #[command(flatten)]
    macros: MacroOptions,
    #[command(flatten)]
    line: LineOptions,
}

pub(super) fn run(options: Options) -> Result<(), Failure> {
    let of_machine = || -> Result<Option<String>, Failure> {
        Ok(options.machine.as_deref().map(machines::load).transpose()?.and_then(|m| m.profile.dialect))
    };
    let dialect = options.dialect.clone().map_or_else(of_machine, |named| Ok(Some(named)))?;
    let as_macro =
        MacroSource { options: &options.macros, machine: options.machine.as_deref(), line: &options.line };
    let mut source = Source::open(&options.source, options.from, dialect.as_deref(), &as_macro)?;
    let warnings = source.prepared().map_or_else(Vec::new, |prepared| prepared.warnings().to_vec());
    for warning in &warnings {
        say!("warning: {warning}");
    }
    let from_block = options.from_block.unwrap_or(1);
    source.check_from_block(from_block)?;
    if from_block > 1 && !source.is_stream() {
        check_block(&source, from_block)?;
    }
    if options.dry_run {
        return feeding::dry_run(&source, from_block);
    }
    let machine = options.machine.or_else(|| source.prepared().and_then(|p| p.part().machine.clone()));
    let profile = connection::profile(machine.as_deref(), &options.line)?;
    source.forecast(&profile, options.line.unpaced)?;
    let Some(port) = options.port else {
        return Err(Failure::new(Exit::Usage, "where to send is not said; name it with --port"));
    };
    if warnings.contains(&Warning::LeadInCrossesKeptPart) {
        question::ask("The lead-in will slit the part that is kept. Send it all the same?", options.yes)?;
    }
    if from_block > 1 {
        if !source.is_stream() {
            say!("{}", spot::around(&source, from_block)?.trim_end());
        }
        let question = format!(
            "Block {from_block} goes first, those before it are not sent, and the wire must stand where it begins. Go on?"
        );
        question::ask(&question, options.yes)?;
    }

    let directory = jobs::directory(options.journal.as_deref())?;
    let connection = Connection::plan(port, profile, &options.line);
    let stops = StopFlags::watch()?;
    let link = connection.open()?;
    let started = feeding::time_of_day();
    let machine = machine.unwrap_or_else(|| "generic-iso".to_owned());
    let mut job = Job {
        job: String::new(),
        started: started.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        source: source.path.clone(),
        kind: source.kind.name().to_owned(),
        source_digest: source.digest.clone(),
        machine: absolute_if_file(&machine),
        machine_digest: connection::profile_digest(&connection.profile),
        port: connection.port.to_string(),
        settings: options.line.words(),
        from_block,
    };
    let file = create(&directory, &mut job, &source)?;
    let writer = Writer::start().map_err(|error| Failure::new(Exit::Ours, error.to_string()))?;
    let mut resume = format!("dripfeed resume {}", job.job);
    if options.journal.is_some() {
        resume.push_str(&format!(" --journal {}", quoted(&directory.display().to_string())));
    }
    if source.path == "-" {
        // What came from standard input cannot be made again; the operator names where it is kept.
        resume.push_str(" --source FILE");
    }
    say!("job {}", job.job);
    // What cannot be taken up is not offered to be.
    let goes_on = source.check_from_block(u64::MAX).is_ok();
    let journal = writer.attach(Box::new(file), from_block - 1);
    Feeding {
        source: &source,
        line: connection,
        link,
        journal,
        job: job.job,
        from_block,
        report: options.report,
        stops,
        is_resumed: false,
        resume: goes_on.then_some(resume),
    }
    .run()
    .map_err(|failure| {
        if goes_on {
            failure
        } else {
            failure.help(
                "clear the control and send it again: a program of this kind is begun at its first block",
            )
        }
    })
}

/// Checks that the program has the block that is to go first.
fn check_block(source: &Source, from_block: u64) -> Result<(), Failure> {
    let (mut program, mut text) = (source.counted()?, Vec::new());
    while program.blocks() < from_block {
        text.clear();
        match program.pull(&mut text) {
            Ok(Some(_)) => {}
            Ok(None) => return Err(feeding::no_such_block(from_block, program.blocks())),
            Err(error) => return Err(Failure::program(&source.path, error)),
        }
    }
    Ok(())
}

/// Creates the journal under the first free name: source, time, and a number if need be.
fn create(directory: &std::path::Path, job: &mut Job, source: &Source) -> Result<std::fs::File, Failure> {
    let stem: String = std::path::Path::new(&source.path)
        .file_stem()
        .map_or_else(|| "stdin".into(), |stem| stem.to_string_lossy())
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' })
        .take(24)
        .collect();
    let stem = stem.trim_matches('-');
    let stem = if stem.is_empty() { "stdin" } else { stem };
    let time: String = job.started.chars().filter(char::is_ascii_digit).collect();
    for n in 1..1000 {
        job.job = if n == 1 { format!("{stem}-{time}") } else { format!("{stem}-{time}-{n}") };
        if !writer::path_of(directory, &job.job).exists() {
            break;
        }
    }
    writer::create(directory, job).map_err(|error| Failure::journal(&error))
}

/// A profile file is found again from anywhere by its absolute path; a built-in one by its name.
fn absolute_if_file(machine: &str) -> String {
    let path = std::path::Path::new(machine);
    if path.is_file() {
        std::path::absolute(path).map_or_else(|_| machine.to_owned(), |path| path.display().to_string())
    } else {
        machine.to_owned()
    }
}

/// A word for a shell.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+:@%,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
