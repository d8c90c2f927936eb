//! The mock control as a program: reads its words, opens its link, serves, writes its report, says how it ended.
//!
//! All that the control does is in the library; all that touches the system is in the library's shell.

mod cli;
mod machine;

use std::ffi::OsString;
use std::io::{self, Write as _};
use std::net::TcpListener;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::{CommandFactory as _, Parser as _};
use mock_controller::shell::files::{Files, write_report};
use mock_controller::shell::serial::SerialLink;
use mock_controller::shell::tcp::TcpLink;
use mock_controller::shell::{Link, serve};
use mock_controller::{Code, CodeTable, Controller, Settings};

use cli::{At, CodeWord, Job, Words};

fn main() -> ExitCode {
    let words = match all_words() {
        Ok(words) => words,
        Err(error) => {
            eprintln!("mock-controller: error: {error}");
            return ExitCode::from(if error.kind() == io::ErrorKind::InvalidData { 2 } else { 1 });
        }
    };
    let job = match Words::parse_from(words).job() {
        Ok(job) => job,
        Err(error) => error.exit(),
    };
    match run(&job) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Alarm(name)) => {
            eprintln!("mock-controller: alarm: {name}");
            ExitCode::from(6)
        }
        Err(error) => {
            eprintln!("mock-controller: error: {error}");
            ExitCode::from(if error.kind() == io::ErrorKind::InvalidData { 2 } else { 1 })
        }
    }
}

/// The command line, with the options of the machine's file if it names one.
fn all_words() -> io::Result<Vec<OsString>> {
    let mut words: Vec<OsString> = std::env::args_os().collect();
    if let Some(file) = machine::named(&words) {
        let name = PathBuf::from(&file);
        let told = |kind, error: &dyn std::fmt::Display| {
            io::Error::new(kind, format!("{}: {error}", name.display()))
        };
        let text = std::fs::read_to_string(&file).map_err(|error| told(error.kind(), &error))?;
        let added = machine::words(&text, &words, &Words::command())
            .map_err(|error| told(io::ErrorKind::InvalidData, &error))?;
        words.extend(added);
    }
    Ok(words)
}

/// How a run that did not fail ended.
enum Outcome {
    Done,
    Alarm(String),
}

fn run(job: &Job) -> io::Result<Outcome> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    let files = Files::create(job.trace.as_deref(), job.save.as_deref(), job.picture.as_deref())?;
    let files = if job.settings.taper.is_some() { files.with_upper() } else { files };
    let settings = Settings { code: code(&job.code)?, ..job.settings.clone() };
    let mut control = Controller::observed(settings, files).map_err(io::Error::other)?;
    let (mut link, ready) = open(job)?;
    writeln!(io::stdout(), "ready {ready}")?;
    io::stdout().flush()?;
    let served = serve(link.as_mut(), &mut control, &stop, |control| {
        if let Some(path) = &job.status {
            write_report(path, &control.report())?;
        }
        control.observer_mut().flush()
    });
    // Whatever ended it, what was cut is told.
    let written = job.report.as_deref().map_or(Ok(()), |path| write_report(path, &control.report()));
    let finished = control.observer_mut().finish();
    served.and(written).and(finished)?;
    Ok(match control.report() {
        report if report.alarm.is_some() => {
            let detail = report.alarm_detail.map(|detail| format!(" ({detail})")).unwrap_or_default();
            Outcome::Alarm(report.alarm.unwrap_or_default() + &detail)
        }
        _ => Outcome::Done,
    })
}

/// The character code; a table is read from its file.
fn code(word: &CodeWord) -> io::Result<Code> {
    let file = match word {
        CodeWord::Known(code) => return Ok(code.clone()),
        CodeWord::File(file) => file,
    };
    let told =
        |kind, error: &dyn std::fmt::Display| io::Error::new(kind, format!("{}: {error}", file.display()));
    let text = std::fs::read_to_string(file).map_err(|error| told(error.kind(), &error))?;
    let table = CodeTable::parse(&text).map_err(|error| told(io::ErrorKind::InvalidData, &error))?;
    Ok(Code::Table(table))
}

fn open(job: &Job) -> io::Result<(Box<dyn Link>, String)> {
    let named = |name: &str, error: io::Error| io::Error::new(error.kind(), format!("{name}: {error}"));
    match &job.place {
        At::Tcp(address) => {
            let listener = TcpListener::bind(address).map_err(|error| named(address, error))?;
            let link = TcpLink::new(listener)?;
            let ready = link.address()?.to_string();
            Ok((Box::new(link), ready))
        }
        At::Serial(device) => {
            let link =
                SerialLink::new(device, job.baud, job.framing).map_err(|error| named(device, error))?;
            Ok((Box::new(link), device.clone()))
        }
        #[cfg(unix)]
        At::Pty(path) => {
            let name = path.display().to_string();
            let link =
                mock_controller::shell::pty::PtyLink::new(path).map_err(|error| named(&name, error))?;
            Ok((Box::new(link), name))
        }
        #[cfg(not(unix))]
        At::Pty(path) => Err(named(&path.display().to_string(), io::Error::from(io::ErrorKind::Unsupported))),
    }
}
