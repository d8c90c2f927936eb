//! `dripfeed resume [JOB] --from-block N`: goes on with a job that broke off.
//!
//! ```text
//! $ dripfeed resume gear-20260101120000 --from-block 118
//! job gear-20260101120000 of /home/me/gear.toml: broken-off
//! handed over whole: up to block 120; may have been sent: up to block 134; accepted: not known
//! block 118 begins 3.213 mm, -5.871 mm from where the program began
//! ```
//!
//! What the control executed is read off the control; the block after it is N. The program is made again from the same
//! source, compared with the journal's digests, and sent from block N. Nothing is sent that was not shown, and nothing
//! starts without a yes.

use std::path::{Path, PathBuf};

use clap::Args;

use super::connection::{self, Connection, LineOptions};
use super::failure::{Exit, Failure};
use super::feeding::{self, Feeding, StopFlags};
use super::jobs;
use super::kind::Kind;
use super::macros::MacroOptions;
use super::question;
use super::send::quoted;
use super::source::{MacroSource, Source};
use super::spot;
use crate::journal::Record;
use crate::journal::history::History;
use crate::journal::resume::{Answer, Plan, Refusal, decide};
use crate::journal::writer::{self, Writer};
use crate::link::Port;

/// Go on with a job that broke off, from a block the operator names
#[derive(Args, Debug)]
pub(super) struct Options {
    /// The job [default: the newest that is not done]
    job: Option<String>,
    /// The block to send first: the one after the last that the control executed
    #[arg(long, value_name = "N")]
    from_block: Option<u64>,
    /// The source, if it is not where it was
    #[arg(long)]
    source: Option<String>,
    /// The port, if it is not the same
    #[arg(long, value_name = "PORT", value_parser = Port::parse)]
    port: Option<Port>,
    /// The control was reset or cleared: no partial block stands in it
    #[arg(long)]
    control_cleared: bool,
    /// Print the program text that would be sent, and open no port
    #[arg(long)]
    dry_run: bool,
    /// Answer every question with yes; needs --from-block
    #[arg(long, requires = "from_block")]
    yes: bool,
    /// Where journals are kept [default: $XDG_STATE_HOME/dripfeed]
    #[arg(long, value_name = "DIR")]
    journal: Option<PathBuf>,
    /// Write the figures of the feed here, as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    #[command(flatten)]
    line: LineOptions,
}

pub(super) fn run(options: Options) -> Result<(), Failure> {
    let directory = jobs::directory(options.journal.as_deref())?;
    let history = jobs::find(&directory, options.job.as_deref())?;
    let job = history.job.clone();
    let word = options.source.as_deref().unwrap_or(&job.source);
    if word == "-" {
        return Err(Failure::new(
            Exit::Usage,
            "the job came from standard input, which cannot be read again",
        )
        .help("name the program with --source FILE"));
    }
    let as_macro = MacroSource {
        options: &MacroOptions::default(),
        machine: Some(&job.machine),
        line: &LineOptions::default().or(&job.settings),
    };
    let source = Source::open(word, Kind::named(&job.kind), None, &as_macro)?;
    // What a broken off job of these kinds would be taken up with is never the first block.
    source.check_from_block(u64::MAX)?;
    if source.is_stream() {
        return Err(Failure::new(
            Exit::Usage,
            format!("{word} can be read only once; name a file with --source"),
        ));
    }
    // The profile must be what it was; only what is changed on this command line is meant to change.
    let recorded = LineOptions::default().or(&job.settings);
    let (then, _) = connection::resolve(&job.machine, &recorded)?;
    if connection::profile_digest(&then) != job.machine_digest {
        return Err(Failure::new(
            Exit::Profile,
            format!("the machine profile {} has changed since the job was sent", job.machine),
        )
        .help("put the old profile back, or start anew with `dripfeed send`"));
    }
    let line = options.line.clone().or(&job.settings);
    let (profile, _) = connection::resolve(&job.machine, &line)?;

    // The journal is held from here on, so that what is decided on stays true.
    let (file, history) = if options.dry_run {
        (None, history)
    } else {
        let (file, history) =
            writer::reopen(&directory, &job.job).map_err(|error| Failure::journal(&error))?;
        (Some(file), history)
    };
    let program = source.compare(&history)?;
    say!("{}", account(&history).trim_end());
    say!(
        "the profile takes the control's buffer to hold up to {} bytes not yet executed",
        profile.buffer_bytes
    );
    let discards_partial = !profile.tape.end_of_block.is_empty();
    let mut answer = Answer { from_block: options.from_block, control_cleared: options.control_cleared };
    let mut decision = decide(&history, &program, answer, discards_partial);
    if let Err(Refusal::AskBlock { .. }) = decision {
        let text = question::answer("The block after the last one that the control executed: ")?;
        let block = text
            .trim()
            .parse()
            .map_err(|_| Failure::new(Exit::Usage, format!("`{}` is not a block number", text.trim())))?;
        answer.from_block = Some(block);
        decision = decide(&history, &program, answer, discards_partial);
    }
    let Plan { from_block, repeated } = decision.map_err(|refusal| refused(&refusal))?;
    let Some(file) = file else { return feeding::dry_run(&source, from_block) };
    say!("{}", spot::around(&source, from_block)?.trim_end());
    if repeated > 0 {
        say!("{repeated} blocks that may have been sent before go out again");
    }

    let port = match &options.port {
        Some(port) => port.clone(),
        None => Port::parse(&job.port).map_err(|error| Failure::new(Exit::Usage, error))?,
    };
    question::ask(&format!("Does the wire stand where block {from_block} begins? Go on?"), options.yes)?;
    let resume = options.command(&job.job, &directory);
    let connection = Connection::plan(port, profile, &line);
    let stops = StopFlags::watch()?;
    let link = connection.open()?;
    let writer = Writer::start().map_err(|error| Failure::new(Exit::Ours, error.to_string()))?;
    let journal = writer.attach(Box::new(file), from_block - 1);
    let (at, port) = (feeding::time_of_day(), connection.port.to_string());
    journal.note(Record::Resumed { block: from_block, at, port });
    Feeding {
        source: &source,
        line: connection,
        link,
        journal,
        job: job.job,
        from_block,
        report: options.report,
        stops,
        is_resumed: true,
        resume: Some(resume),
    }
    .run()
}

impl Options {
    /// The command that goes on from here, up to the block number.
    fn command(&self, job: &str, directory: &Path) -> String {
        let mut command = format!("dripfeed resume {job}");
        let mut option = |name: &str, value: &str| command.push_str(&format!(" {name} {}", quoted(value)));
        if self.journal.is_some() {
            option("--journal", &directory.display().to_string());
        }
        if let Some(source) = &self.source {
            option("--source", source);
        }
        if let Some(port) = &self.port {
            option("--port", &port.to_string());
        }
        for (name, value) in self.line.options() {
            option(name, &value);
        }
        command.trim_end().to_owned()
    }
}

fn refused(refusal: &Refusal) -> Failure {
    let (exit, help) = match refusal {
        Refusal::Changed { .. } => (
            Exit::Program,
            "put the old source back, name it with --source, or start anew with `dripfeed send`",
        ),
        Refusal::Unvouched { .. } => {
            (Exit::Program, "put the old source back, or start anew with `dripfeed send`")
        }
        Refusal::NoSuchBlock { .. } => (Exit::Usage, "blocks count from 1 as sent, the lead-in is block 1"),
        Refusal::WouldSkip { .. } => {
            (Exit::Usage, "name the block after the last one that the control executed")
        }
        Refusal::Done { .. } => {
            (Exit::Usage, "send it again with `dripfeed send`, or part of it with --from-block N")
        }
        Refusal::AskBlock { .. } => (Exit::Usage, "name it with --from-block N"),
        Refusal::MayBeTorn => (Exit::Usage, "reset or clear the control, then say so with --control-cleared"),
    };
    Failure::new(exit, refusal.to_string()).help(help)
}

/// What is known of the job.
fn account(history: &History) -> String {
    let mut text = format!(
        "job {} of {}: {}\nhanded over whole: up to block {}; may have been sent: up to block {}; accepted: not known over DC codes\n",
        history.job.job,
        history.job.source,
        history.state(),
        history.sent,
        history.horizon
    );
    match &history.ended {
        Some(ended) if ended.torn_bytes > 0 => text.push_str(&format!(
            "block {} is torn: {} bytes of it were sent; the end of block that goes first makes the control drop them\n",
            ended.block + 1,
            ended.torn_bytes
        )),
        None => text.push_str(
            "the job broke off: a part of a block may stand in the control; the end of block that goes first makes it drop that\n",
        ),
        Some(_) => {}
    }
    text
}
