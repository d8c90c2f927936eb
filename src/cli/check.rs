//! `dripfeed check IN`: everything that is wrong with a program, in one run; nothing is sent.
//!
//! ```text
//! $ dripfeed check ring.3b
//! warning[contour-gap]: the contour does not close: it ends 5.0 µm from where block 2 began
//!    ╭─[ring.3b:3:1]
//!  3 │ B9900B5B39600GYNR1
//!    · ────────┬─────────
//!    ╰────
//!   help: check the numbers of the blocks between; 3 µm is allowed
//! ```
//!
//! Findings go to standard error, the account to standard output; with `--json` both go to standard output as one object.
//! The exit code is 0 when nothing was found, 3 for errors, 8 for warnings alone. `docs/check.md` lists what is looked at.

use std::cell::RefCell;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::motions::{Motions, OfPart, Reading};
use super::registers::{self, KeyedIn, Registers};
use super::{machines, print, print_json};
use crate::check::{Check, Finding, Format, Kept, Looked, Report, Settings, Severity, wire};
use crate::drawing::finding as drawing;
use crate::interpolator::Model;
use crate::motion::Motion;
use crate::place::Spot;
use crate::profile::Profile;

/// Check a program: everything wrong with it in one run, nothing is sent
#[derive(Args, Debug)]
pub(super) struct Options {
    /// A program, a part file, or - for standard input
    #[arg(value_name = "IN")]
    input: String,
    #[command(flatten)]
    registers: Registers,
    #[command(flatten)]
    keyed: KeyedIn,
    /// The machine to check against: a built-in profile or a file [default: generic-iso]
    #[arg(long, value_name = "NAME|FILE")]
    machine: Option<String>,
    /// Which side of the contours is the part, for lead-ins through it, where the program does not say
    #[arg(long, value_name = "SIDE")]
    kept: Option<Side>,
    /// Look at nothing but whether the program can be read
    #[arg(long)]
    syntax_only: bool,
    /// List the blocks at which a job can be taken up safely
    #[arg(long)]
    restart_points: bool,
    /// Print the findings as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: Reading,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Side {
    /// Punches: what falls out is the part
    Inside,
    /// Dies: what falls out is waste
    Outside,
}

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    let profile = match &options.machine {
        Some(name) => machines::load(name)?.profile,
        None => Profile::generic_iso().map_err(|error| Failure::keys(Exit::Ours, "generic-iso", error))?,
    };
    // Wrong arcs are judged here, and so is what stands behind them.
    let reading = Reading {
        of_machine: profile.dialect.clone(),
        keeps_wrong_arcs: true,
        profile: Some(profile.clone()),
        ..options.reading.clone()
    };
    let mut motions = Motions::open(&options.input, &reading, OfPart::Blocks, Model::Rotated)?;
    let report = check(&mut motions, options, profile)?;
    if options.json {
        print_json(&as_json(&report, options))?;
    } else {
        for finding in &report.findings {
            say!("{}", rendered(finding, &mut motions));
        }
        for (code, count) in &report.more {
            say!("and {count} more of {code}");
        }
        print(account(&report, &motions.places.name, options).as_bytes())?;
    }
    match (report.errors, report.warnings) {
        (0, 0) => Ok(()),
        (0, _) => Err(Failure::told(Exit::Warnings)),
        _ => Err(Failure::told(Exit::Program)),
    }
}

fn check(motions: &mut Motions, options: &Options, profile: Profile) -> Result<Report, Failure> {
    let mut check = Check::new(Settings {
        format: match motions.kind {
            Kind::FourB => Format::FourB,
            Kind::Gcode | Kind::Macro => Format::GCode,
            Kind::ThreeB | Kind::Dxf | Kind::Part => Format::ThreeB,
        },
        travel: profile.travel,
        taper_max: profile.taper_max_degrees,
        kept: options.kept.map(|side| match side {
            Side::Inside => Kept::Inside,
            Side::Outside => Kept::Outside,
        }),
        tape: Some(profile.tape),
        restart_points: options.restart_points,
        syntax_only: options.syntax_only,
    });
    for found in motions.drawn.iter().flat_map(|drawing| &drawing.report) {
        let severity = match found.severity {
            drawing::Severity::Fault => Severity::Error,
            drawing::Severity::Warning => Severity::Warning,
            // What is as it should be is no finding.
            drawing::Severity::Note => continue,
        };
        let spot = Spot { line: found.line, column: u64::from(found.line > 0), byte: 0 };
        let (message, help) = (found.to_string(), found.help.clone());
        check.add(Finding { severity, code: found.code, spot, width: 0, block: 0, message, help });
    }
    let keyed = options.keyed.of(&options.input, motions.kind)?;
    match registers::known(motions.kind, &options.registers, keyed) {
        Some(known) => {
            let check = RefCell::new(&mut check);
            let next = || next_of(motions, &mut check.borrow_mut());
            wire::follow(next, &known, |seen| check.borrow_mut().see_wire(seen));
        }
        None => while next_of(motions, &mut check).is_some() {},
    }
    // G-code goes out line by line as it stands.
    motions.lines(|line, block| check.see_text(line.bytes, block, line.spot(0)))?;
    Ok(check.finish())
}

/// Checks the next motion that can be read.
fn next_of(motions: &mut Motions, check: &mut Check) -> Option<Motion> {
    loop {
        match motions.next()? {
            Ok(motion) => {
                check.see_text(motions.text(&motion), motion.block, motion.spot);
                check.see(&motion, motions.block().as_ref());
                return Some(motion);
            }
            Err(error) => {
                if !(check.see_error(&error) && motions.go_on_behind(&error)) {
                    return None;
                }
            }
        }
    }
}

fn rendered(finding: &Finding, motions: &mut Motions) -> String {
    let place = motions.places.place(finding.spot, finding.width);
    // Without a place in a text the block says where it is.
    let message = match (&place, finding.block) {
        (None, 1..) => format!("block {}: {}", finding.block, finding.message),
        _ => finding.message.clone(),
    };
    let exit = match finding.severity {
        Severity::Error => Exit::Program,
        Severity::Warning => Exit::Warnings,
    };
    let word = format!("{}[{}]:", finding.severity.name(), finding.code);
    let mut failure = Failure::new(exit, message).called(word);
    if let Some(place) = place {
        failure = failure.at(&motions.places.name, place);
    }
    if !finding.help.is_empty() {
        failure = failure.help(finding.help.clone());
    }
    failure.render().trim_end().to_owned()
}

fn as_json(report: &Report, options: &Options) -> serde_json::Value {
    let diagnostics: Vec<_> = report
        .findings
        .iter()
        .map(|finding| {
            json!({
                "severity": finding.severity.name(),
                "code": finding.code,
                "line": finding.spot.line,
                "column": finding.spot.column,
                "block": finding.block,
                "message": finding.message,
                "help": finding.help,
            })
        })
        .collect();
    let mut value = json!({
        "diagnostics": diagnostics,
        "more": report.more.iter().map(|(code, count)| json!({"code": code, "count": count})).collect::<Vec<_>>(),
        "errors": report.errors,
        "warnings": report.warnings,
        "blocks": report.blocks,
    });
    value["wire_path"] = match report.wire {
        Looked::NoOffset => json!("as programmed"),
        Looked::Whole => json!("checked"),
        Looked::Unknown(register) => json!({"unknown_register": register}),
        Looked::NotKeyed => json!("unknown_offset"),
    };
    if let Some(models) = report.models.filter(|_| !report.unreadable) {
        let models = models.map(|account| {
            json!({
                "model": account.model.name(),
                "node_um": account.node_um,
                "closure_um": account.closure_um,
                "end_um": [account.end.x.0, account.end.y.0],
            })
        });
        value["models"] = json!(models);
    }
    if options.restart_points {
        let points: Vec<_> = report
            .restart_points
            .iter()
            .map(|point| json!({"block": point.block, "x_mm": point.at.x, "y_mm": point.at.y, "why": point.why}))
            .collect();
        value["restart_points"] = json!(points);
        value["more_restart_points"] = json!(report.more_restart_points);
    }
    value
}

/// What was looked at, for a person.
fn account(report: &Report, name: &str, options: &Options) -> String {
    let count = |number: u64, what: &str| match number {
        1 => format!("1 {what}"),
        number => format!("{number} {what}s"),
    };
    let verdict = match (report.errors, report.warnings) {
        (0, 0) => "in order".to_owned(),
        (errors, 0) => count(errors, "error"),
        (0, warnings) => count(warnings, "warning"),
        (errors, warnings) => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    };
    let mut text = format!("{name}: {}, {verdict}\n", count(report.blocks, "block"));
    if report.unreadable && !options.syntax_only {
        text.push_str("behind what cannot be read only syntax was checked\n");
    }
    if let (Looked::Unknown(register), false) = (report.wire, report.unreadable) {
        text.push_str(&format!(
            "the wire's own path was not checked: what register {register} holds is not given (--register {register}=MM)\n"
        ));
    }
    if report.wire == Looked::NotKeyed && !report.unreadable {
        text.push_str(
            "the wire's own path was not checked: the offset that is keyed into the control is not given (--offset MM)\n",
        );
    }
    if let Some(models) = report.models.filter(|_| !report.unreadable) {
        for account in models {
            let closure =
                account.closure_um.map_or_else(|| "no contour".to_owned(), |um| format!("{um:.2} µm"));
            text.push_str(&format!(
                "under {:9} farthest node from exact {:6.2} µm, closure {closure}\n",
                account.model.name(),
                account.node_um
            ));
        }
    }
    for point in &report.restart_points {
        text.push_str(&format!(
            "restart at block {:>8}, {:.3}, {:.3} mm: {}\n",
            point.block, point.at.x, point.at.y, point.why
        ));
    }
    if report.more_restart_points > 0 {
        text.push_str(&format!("and {} more restart points\n", report.more_restart_points));
    }
    text
}
