//! `dripfeed jobs [show JOB] [--json]`: what was sent, how far it got, what can be resumed.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use serde_json::json;

use super::failure::{Exit, Failure};
use super::{print, print_json};
use crate::journal::history::History;
use crate::journal::writer::{self, JournalError};

/// What was sent, how far it got, what can be resumed
#[derive(Args, Debug)]
pub(super) struct Options {
    #[command(subcommand)]
    action: Option<Action>,
    /// Print as JSON
    #[arg(long, global = true)]
    json: bool,
    /// Where the journals are [default: $XDG_STATE_HOME/dripfeed]
    #[arg(long, value_name = "DIR", global = true)]
    journal: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// One job in full
    Show {
        /// The job's name
        job: String,
    },
}

/// The directory of journals: as given, else `$XDG_STATE_HOME/dripfeed`, else `~/.local/state/dripfeed`.
pub(super) fn directory(given: Option<&Path>) -> Result<PathBuf, Failure> {
    let state = || {
        std::env::var_os("XDG_STATE_HOME")
            .map(PathBuf::from)
            .filter(|path| path.is_absolute())
            .or_else(|| std::env::home_dir().map(|home| home.join(".local/state")))
            .map(|state| state.join("dripfeed"))
    };
    given.map(Path::to_owned).or_else(state).ok_or_else(|| {
        Failure::new(Exit::Usage, "there is no home directory to keep journals in")
            .help("name one with --journal DIR")
    })
}

/// Every journal of a directory, newest first, and what is wrong with those that cannot be read.
fn readable(directory: &Path) -> Result<(Vec<History>, Vec<JournalError>), Failure> {
    let entries = match std::fs::read_dir(directory) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok((Vec::new(), Vec::new())),
        Err(error) => {
            return Err(Failure::new(Exit::Ours, format!("cannot read {}: {error}", directory.display())));
        }
    };
    let (mut histories, mut damaged) = (Vec::new(), Vec::new());
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.extension().is_none_or(|e| e != "journal") {
            continue;
        }
        match writer::read(&path) {
            Ok(history) => histories.push(history),
            Err(error) => damaged.push(error),
        }
    }
    histories.sort_by(|a, b| (&b.job.started, &b.job.job).cmp(&(&a.job.started, &a.job.job)));
    Ok((histories, damaged))
}

/// The state of a job in a word, `running` while a process holds its journal.
fn state(directory: &Path, history: &History) -> &'static str {
    if writer::is_in_use(&writer::path_of(directory, &history.job.job)) { "running" } else { history.state() }
}

fn summary(directory: &Path, history: &History) -> serde_json::Value {
    json!({
        "job": history.job.job,
        "source": history.job.source,
        "state": state(directory, history),
        "sent_to_block": history.horizon,
        // Over DC codes a control acknowledges nothing.
        "accepted_block": null,
        "digest": history.segments.last().map(|(_, value)| value),
        "started": history.job.started,
        "port": history.job.port,
        "handed_over_to_block": history.sent,
    })
}

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    let directory = directory(options.journal.as_deref())?;
    let Some(Action::Show { job }) = &options.action else {
        let (histories, damaged) = readable(&directory)?;
        for error in &damaged {
            say!("warning: {error}");
        }
        if options.json {
            return print_json(&histories.iter().map(|h| summary(&directory, h)).collect());
        }
        if histories.is_empty() {
            return print(format!("no jobs in {}\n", directory.display()).as_bytes());
        }
        let mut text = String::new();
        for history in &histories {
            let state = state(&directory, history);
            text.push_str(&format!(
                "{:32} {state:10} block {:>8}  {}\n",
                history.job.job, history.sent, history.job.source
            ));
        }
        return print(text.as_bytes());
    };
    let history = find(&directory, Some(job))?;
    if options.json {
        return print_json(&summary(&directory, &history));
    }
    print(describe(&directory, &history).as_bytes())
}

/// A job by name, or the newest that is not done.
pub(super) fn find(directory: &Path, job: Option<&str>) -> Result<History, Failure> {
    if let Some(job) = job {
        let path = writer::path_of(directory, job);
        if !path.exists() {
            return Err(Failure::new(
                Exit::Usage,
                format!("there is no job {job} in {}", directory.display()),
            )
            .help("`dripfeed jobs` lists them"));
        }
        return writer::read(&path).map_err(|error| Failure::journal(&error));
    }
    let (histories, damaged) = readable(directory)?;
    if let Some(error) = damaged.first() {
        // It may be the newest one; which job is meant is not for us to guess.
        return Err(Failure::journal(error));
    }
    histories.into_iter().find(|history| history.state() != "done").ok_or_else(|| {
        Failure::new(Exit::Usage, format!("there is no job to resume in {}", directory.display()))
            .help("`dripfeed jobs` lists all of them")
    })
}

fn describe(directory: &Path, history: &History) -> String {
    let job = &history.job;
    let mut text = format!(
        "job         {}\nstarted     {}\nsource      {} ({})\nmachine     {}\nport        {}\nstate       {}\n",
        job.job,
        job.started,
        job.source,
        job.kind,
        job.machine,
        job.port,
        state(directory, history)
    );
    if let Some(ended) = &history.ended {
        text.push_str(&format!("ended       {}: {}\n", ended.at, ended.reason));
        if ended.torn_bytes > 0 {
            text.push_str(&format!(
                "torn        block {}, {} bytes of it sent\n",
                ended.block + 1,
                ended.torn_bytes
            ));
        }
    }
    text.push_str(&format!(
        "handed over blocks up to {}\nmay be sent blocks up to {}\naccepted    not known: the control acknowledges nothing over DC codes\nresumed     {} times\n",
        history.sent, history.horizon, history.resumptions
    ));
    text
}
