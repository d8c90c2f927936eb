//! `dripfeed demo`: the paper's gear, made on demand, fed to an embedded control at wire speed, and what it cut.
//!
//! No hardware and no options: a mock control listens on a loopback socket, the ordinary sender feeds it over a line
//! paced at 4800 baud, and the control's own pulses are compared with the theoretical nodes. This file alone knows the
//! mock.

mod picture;

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use mock_controller::{BlockEnd, Framing, Observer, Pace, Report, Settings, Until};
use serde_json::json;

use super::connection::{self, Connection, LineOptions};
use super::failure::{Exit, Failure};
use super::feeding::{self, Feeding, StopFlags};
use super::source::Source;
use super::{print, print_json, verdict};
use crate::drawing::Thinning;
use crate::geometry::Point;
use crate::journal::Job;
use crate::journal::writer::{self, Writer};
use crate::link::Port;
use crate::part::{Part, Prepared};
use crate::profile::Profile;
use crate::protocol::Ending;
use crate::rounding::Role;
use crate::units::Position;

/// Feed the paper's gear to an embedded control, and see what it cut
#[derive(Args, Debug)]
pub(super) struct Options {
    /// Where to leave the pictures [default: dripfeed-demo in the system's directory for temporary files]
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// What the control cut, against theory.
#[derive(Debug)]
pub(super) struct Verdict {
    report: Report,
    max_node_error_um: f64,
    closure_um: f64,
    seconds: f64,
}

/// The speed of the demo's line: the gear takes about a quarter of a minute.
const BAUD: u32 = 4800;

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    let directory = options.keep.clone().unwrap_or_else(|| std::env::temp_dir().join("dripfeed-demo"));
    let unusable =
        |error| Failure::new(Exit::Ours, format!("cannot write to {}: {error}", directory.display()));
    std::fs::create_dir_all(&directory).map_err(unusable)?;

    let prepared = Part::default().prepare().map_err(|error| Failure::gear(&error))?;
    say!("the clock gear of the 1990 paper: module 0.4 mm, 36 teeth, wire offset +0.07 mm");
    for warning in prepared.warnings() {
        say!("warning: {warning}");
    }
    say!("(the paper's own lead-in, from the gear's centre; a real punch wants a start hole outside)");

    let (report, watch, seconds) = feed(&prepared, &directory)?;
    let mut verdict = compare(&prepared, &watch, report);
    verdict.seconds = seconds;
    let (svg, png) = picture::draw(&prepared, &watch, &verdict)
        .map_err(|error| Failure::new(Exit::Ours, format!("the picture cannot be drawn: {error}")))?;
    let files = [(directory.join("gear.svg"), svg.into_bytes()), (directory.join("gear.png"), png)];
    for (path, bytes) in &files {
        std::fs::write(path, bytes).map_err(unusable)?;
    }

    if options.json {
        print_json(&json!({
            "blocks": verdict.report.blocks,
            "closure_um": verdict.closure_um,
            "max_node_error_um": verdict.max_node_error_um,
            "max_overrun_bytes": verdict.report.max_overrun_bytes,
            "line_utilisation": verdict.report.line_utilisation,
            "baud": BAUD,
            "seconds": verdict.seconds,
        }))?;
    } else {
        print(words(&verdict).as_bytes())?;
    }
    say!("pictures of what was cut: {} and {}", files[0].0.display(), files[1].0.display());
    judge(&verdict)
}

/// Runs the control and the sender; returns the control's report, what was watched, and the time taken.
fn feed(prepared: &Prepared, directory: &Path) -> Result<(Report, Watch, f64), Failure> {
    let ours = |error: std::io::Error| Failure::new(Exit::Ours, error.to_string());
    let listener = TcpListener::bind("127.0.0.1:0").map_err(ours)?;
    let address = listener.local_addr().map_err(ours)?;
    let settings = Settings {
        pace: Pace::Paced { baud: BAUD, framing: Framing::SEVEN_EVEN_TWO },
        until: Until::ProgramEnd,
        ..Settings::default()
    };
    let stop = Arc::new(AtomicBool::new(false));
    let mut watch = Watch::new(prepared.origin());
    let (report, outcome) = std::thread::scope(|scope| {
        let (control_stop, watch) = (Arc::clone(&stop), &mut watch);
        let control = std::thread::Builder::new()
            .name("control".to_owned())
            .spawn_scoped(scope, move || {
                mock_controller::shell::serve_tcp(listener, settings, watch, control_stop)
            })
            .map_err(ours)?;
        let outcome = send(prepared, &address.to_string(), directory);
        // A control whose program broke off would wait for the rest for ever.
        if !matches!(outcome, Ok(ref outcome) if matches!(outcome.ending, Ending::Done { .. })) {
            stop.store(true, Ordering::Relaxed);
        }
        let report =
            control.join().map_err(|_| Failure::new(Exit::Ours, "the control's thread broke off"))?;
        Ok((report.map_err(ours)?, outcome?))
    })?;
    let seconds = outcome.last.now.as_secs_f64();
    match outcome.ending {
        Ending::Done { .. } => Ok((report, watch, seconds)),
        Ending::Stopped { .. } | Ending::Failed { .. } => {
            // The demo's job is not kept, so there is nothing to go on with.
            verdict::conclude(outcome, "demo", None, "demo").map(|()| (report, watch, seconds))
        }
    }
}

fn send(prepared: &Prepared, address: &str, directory: &Path) -> Result<crate::link::feed::Outcome, Failure> {
    let source = Source::of_part("gear", prepared.clone());
    let mut profile =
        Profile::generic_iso().map_err(|error| Failure::keys(Exit::Ours, "generic-iso", error))?;
    profile.baud = BAUD;
    let line = LineOptions { baud: Some(BAUD), ..LineOptions::default() };
    let connection = Connection::plan(Port::Tcp(address.to_owned()), profile, &line);
    let stops = StopFlags::watch()?;
    let link = connection.open()?;
    let job = Job {
        job: format!("demo-{}", std::process::id()),
        started: feeding::time_of_day(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        source: "demo".to_owned(),
        kind: "part".to_owned(),
        source_digest: String::new(),
        machine: "generic-iso".to_owned(),
        machine_digest: connection::profile_digest(&connection.profile),
        port: connection.port.to_string(),
        settings: line.words(),
        from_block: 1,
    };
    let path = writer::path_of(directory, &job.job);
    let file = writer::create(directory, &job).map_err(|error| Failure::journal(&error))?;
    let thread = Writer::start().map_err(|error| Failure::new(Exit::Ours, error.to_string()))?;
    let journal = thread.attach(Box::new(file), 0);
    let feeding = Feeding {
        source: &source,
        line: connection,
        link,
        journal,
        job: job.job,
        from_block: 1,
        report: None,
        stops,
        is_resumed: false,
        resume: None,
    };
    let outcome = feeding.feed();
    let _ = std::fs::remove_file(path);
    outcome
}

/// What was seen of the control: where each block ended, and the path of its pulses.
#[derive(Debug)]
pub(super) struct Watch {
    origin: Position,
    ends: Vec<Position>,
    lead_in: Option<Thinning>,
    cut: Option<Thinning>,
    last: (i64, i64),
}

/// How far the drawn line may be from a pulse, µm: below what a picture shows.
const DRAWN_UM: f64 = 0.8;

impl Watch {
    fn new(origin: Position) -> Self {
        Self { origin, ends: Vec::new(), lead_in: None, cut: None, last: (origin.x.0, origin.y.0) }
    }

    fn points(thinned: Option<&Thinning>) -> Vec<[f64; 2]> {
        let points = thinned.map(|t| t.clone().finish()).unwrap_or_default();
        points.iter().map(|&(x, y)| [x as f64 / 1000.0, y as f64 / 1000.0]).collect()
    }
}

impl Observer for &mut Watch {
    fn wants_pulses(&self) -> bool {
        true
    }

    fn pulse(&mut self, _at: std::time::Duration, block: u64, x_um: i64, y_um: i64) {
        let here = (x_um + self.origin.x.0, y_um + self.origin.y.0);
        // The first block is the lead-in.
        let path = if block == 1 { &mut self.lead_in } else { &mut self.cut };
        let last = self.last;
        path.get_or_insert_with(|| {
            let mut path = Thinning::new(DRAWN_UM);
            path.push(last);
            path
        })
        .push(here);
        self.last = here;
    }

    fn block_end(&mut self, end: &BlockEnd) {
        self.ends.push(Position::new(end.end_um[0], end.end_um[1]) + self.origin);
    }
}

/// Compares where the control's blocks ended with the theoretical nodes.
fn compare(prepared: &Prepared, watch: &Watch, report: Report) -> Verdict {
    let (mut max_node_error_um, mut closure_um, mut opened) = (0.0f64, f64::INFINITY, None);
    let mut before = watch.origin;
    for (made, &end) in prepared.blocks().zip(&watch.ends) {
        if made.role == Role::Opening {
            opened = opened.or(Some(before));
        }
        if made.at_node {
            max_node_error_um = max_node_error_um.max(end.distance_um(made.target));
            if let (Role::Closing, Some(opened)) = (made.role, opened) {
                let opened: Position = opened;
                closure_um = end.distance_um(Point::new(opened.x.millimetres(), opened.y.millimetres()));
            }
        }
        before = end;
    }
    Verdict { report, max_node_error_um, closure_um, seconds: 0.0 }
}

fn words(verdict: &Verdict) -> String {
    let Verdict { report, max_node_error_um, closure_um, seconds } = verdict;
    let utilisation =
        report.line_utilisation.map_or_else(|| "not known".to_owned(), |u| format!("{:.1} %", 100.0 * u));
    format!(
        "The control cut {} blocks, {:.3} mm of path, in {seconds:.0} s at {BAUD} baud.\n\
         The farthest a node lies from theory is {max_node_error_um:.2} µm; the outline closes to {closure_um:.2} µm.\n\
         At most {} characters came after it said stop ({} holds); it allows 10.\n\
         While it was not held, the line was busy {utilisation} of the time.\n",
        report.blocks, report.path_length_mm, report.max_overrun_bytes, report.holds
    )
}

/// The demo is a check: a bad cut fails it.
fn judge(verdict: &Verdict) -> Result<(), Failure> {
    if let Some(alarm) = &verdict.report.alarm {
        return Err(Failure::new(Exit::Control, format!("the control raised the alarm {alarm}")));
    }
    if verdict.max_node_error_um > 1.5 || verdict.closure_um > 1.5 {
        return Err(Failure::new(
            Exit::Ours,
            "the cut is not what it should be: a node or the closure is more than 1.5 µm off",
        ));
    }
    Ok(())
}
