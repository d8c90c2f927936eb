//! `dripfeed generate gear | FILE.toml | --explain KIND`: prints a part's program, block by block.
//!
//! ```text
//! $ dripfeed generate gear | head -3
//! B579B6617B006617GYL2
//! B19B222B000232GYNR4
//! B11B236B000236GYL2
//! ```
//!
//! Blocks go to standard output as they are made, in constant memory. Warnings and, at the end, the number of blocks and
//! the node error and closure under every model of the control go to standard error.

use std::io::Write;

use clap::Args;

use super::failure::{Exit, Failure};
use super::{print, source};
use crate::formats::gcode::dialect::BUILT_IN;
use crate::part::file::{AIMS, DIRECTIONS, FORMATS, GEAR_TEMPLATE, ROUNDINGS, STOP_WORDS, dialect_named};
use crate::part::{Format, Part, Prepared, Rounding, aim_named, start_hole};
use crate::program::{self, Counted};
use crate::rounding::audit::Audit;
use crate::shapes::cycloid_gear::{LeadIn, Trim};

/// Print a part's program: blocks made on demand from a few numbers
#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct Options {
    /// `gear`, or a part file (FILE.toml)
    #[arg(required_unless_present = "explain")]
    what: Option<String>,
    /// Print a commented part file of this kind, which builds unedited
    #[arg(long, value_name = "KIND", value_parser = ["gear"], conflicts_with = "what")]
    explain: Option<String>,
    #[command(flatten)]
    gear: Gear,
}

/// Options of the gear; without a part file only. Defaults are the printed run of the 1990 paper.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Gear (lengths in mm; defaults: the 1990 paper's printed run)")]
struct Gear {
    /// m: module [default: 0.4]
    #[arg(long, value_name = "MM")]
    module: Option<f64>,
    /// z: number of teeth [default: 36]
    #[arg(long, value_name = "Z")]
    teeth: Option<u64>,
    /// kp: tip flank radius / module [default: 2.0]
    #[arg(long)]
    kp: Option<f64>,
    /// kr: depth of the flanks' centre circle / module [default: 0.15]
    #[arg(long)]
    kr: Option<f64>,
    /// ks: tooth thickness on the pitch circle / module [default: 1.57]
    #[arg(long)]
    ks: Option<f64>,
    /// knf: dedendum / module [default: 1.57]
    #[arg(long)]
    knf: Option<f64>,
    /// R': tip rounding [default: 0.04]
    #[arg(long, value_name = "MM")]
    tip_radius: Option<f64>,
    /// Wire radius + spark gap: + outside (punch), - inside (die) [default: 0.07]
    #[arg(long, value_name = "MM")]
    offset: Option<f64>,
    /// Direction of cut [default: cw]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(DIRECTIONS.map(|(w, _)| w)))]
    direction: Option<String>,
    /// Start of the lead-in: centre, none, or X,Y from the gear's centre [default: centre]
    #[arg(long, value_name = "centre|none|X,Y", allow_hyphen_values = true)]
    lead_in: Option<String>,
    /// How many times the outline is cut [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    repeat: Option<u64>,
    /// Where the wire is too thick for the tooth space, cut what can be cut
    #[arg(long)]
    trim: bool,
    /// Block format [default: 3b]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(FORMATS.map(|(w, _)| w)))]
    format: Option<String>,
    /// The control G-code is for, a built-in dialect [default: generic]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(BUILT_IN.map(|(w, _)| w)))]
    dialect: Option<String>,
    /// closed-loop chooses each block from where the control stands; per-block rounds as the paper [default: closed-loop]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(ROUNDINGS.map(|(w, _)| w)))]
    rounding: Option<String>,
    /// The control's way of interpolating; any is right under all of them [default: any]
    #[arg(long, value_parser = AIMS)]
    interpolator: Option<String>,
    /// Stop word [default: DD]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(STOP_WORDS.map(|(w, _)| w)))]
    end: Option<String>,
}

pub(super) fn run(options: Options) -> Result<(), Failure> {
    if options.explain.is_some() {
        return print(GEAR_TEMPLATE.as_bytes());
    }
    let what = options.what.unwrap_or_default();
    let part = if what == "gear" {
        options.gear.part()?
    } else {
        if let Some(option) = options.gear.first_given() {
            let message = format!("--{option} goes with `generate gear`; a part file states its own values");
            return Err(
                Failure::new(Exit::Usage, message).help(format!("change {what}, or leave the option out"))
            );
        }
        if !what.contains(['.', '/', '\\']) && !std::path::Path::new(&what).exists() {
            let failure = Failure::new(Exit::Usage, format!("there is no shape `{what}`"));
            return Err(failure.help(crate::keys::nearest(&what, &["gear"]).unwrap_or_default()));
        }
        source::part_file(&what)?.0.part
    };
    let prepared = part.prepare().map_err(|error| Failure::gear(&error))?;
    for warning in prepared.warnings() {
        say!("warning: {warning}");
    }
    if prepared.part().format != Format::ThreeB {
        return write_text(&prepared, std::io::stdout().lock());
    }
    let audit = write(&prepared, std::io::stdout().lock())?;
    say!("{}", account(&audit, &prepared).trim_end());
    Ok(())
}

/// Writes the program in 4B or G-code: its elements as they are designed, with the offset in them.
fn write_text(prepared: &Prepared, mut out: impl Write) -> Result<(), Failure> {
    let mut program = Counted::new(program::generated(prepared));
    let mut text = Vec::with_capacity(CHUNK + 64);
    loop {
        let pulled = program.pull(&mut text).map_err(|error| Failure::program("the part", error))?;
        if pulled.is_some() {
            text.push(b'\n');
        }
        if text.len() >= CHUNK || pulled.is_none() || program.blocks() == FIRST_BLOCKS {
            out.write_all(&text).and_then(|()| out.flush()).map_err(Failure::output)?;
            text.clear();
        }
        if pulled.is_none() {
            break;
        }
    }
    say!("{} blocks for {} elements", program.blocks(), prepared.element_count());
    let part = prepared.part();
    if part.format == Format::FourB && part.offset != 0.0 {
        say!("the outline has the offset of {} mm in it: F = 0, or generate it with --offset 0", part.offset);
    }
    Ok(())
}

impl Gear {
    fn part(&self) -> Result<Part, Failure> {
        let mut part = Part::default();
        let gear = &mut part.gear;
        for (given, value) in [
            (self.module, &mut gear.module),
            (self.kp, &mut gear.kp),
            (self.kr, &mut gear.kr),
            (self.ks, &mut gear.ks),
            (self.knf, &mut gear.knf),
            (self.tip_radius, &mut gear.tip_radius),
            (self.offset, &mut part.offset),
        ] {
            *value = given.unwrap_or(*value);
        }
        gear.teeth = self.teeth.unwrap_or(gear.teeth);
        part.repeat = self.repeat.unwrap_or(1);
        if self.trim {
            part.trim = Trim::Allow;
        }
        // The words were checked against the same tables.
        let word = |given: &Option<String>, name: &str| given.as_deref() == Some(name);
        part.direction =
            DIRECTIONS.iter().find(|(w, _)| word(&self.direction, w)).map_or(part.direction, |d| d.1);
        part.rounding =
            ROUNDINGS.iter().find(|(w, _)| word(&self.rounding, w)).map_or(part.rounding, |r| r.1);
        part.stop_word = STOP_WORDS.iter().find(|(w, _)| word(&self.end, w)).map_or(part.stop_word, |s| s.1);
        part.aim = self.interpolator.as_deref().and_then(aim_named).unwrap_or(part.aim);
        part.format = self.format(&part)?;
        part.lead_in = match self.lead_in.as_deref() {
            None | Some("centre") => LeadIn::Centre,
            Some("none") => LeadIn::None,
            Some(text) => lead_in(text)?,
        };
        Ok(part)
    }

    fn format(&self, part: &Part) -> Result<Format, Failure> {
        let wrong = |message: &str, help: &str| Err(Failure::new(Exit::Usage, message).help(help));
        let format = match (self.format.as_deref(), self.dialect.as_deref()) {
            (Some("gcode"), dialect) => {
                if dialect.is_none() {
                    say!("G-code is written in the dialect generic, for want of another");
                }
                let dialect = dialect_named(dialect.unwrap_or("generic"));
                Format::Gcode(dialect.map_err(|error| Failure::keys(Exit::Ours, "dialect", error))?)
            }
            (_, Some(_)) => return wrong("--dialect goes with --format gcode", "leave it out"),
            (Some("4b"), None) => Format::FourB,
            (_, None) => Format::ThreeB,
        };
        if part.rounding == Rounding::PerBlock && format != Format::ThreeB {
            return wrong("--rounding per-block goes with 3B", "leave out --rounding or --format");
        }
        if part.repeat > 1 && format == Format::FourB {
            return wrong("4B takes an outline once: it is held whole for its flags", "leave out --repeat");
        }
        Ok(format)
    }

    /// The first option that was given, by its name.
    fn first_given(&self) -> Option<&'static str> {
        [
            ("module", self.module.is_some()),
            ("teeth", self.teeth.is_some()),
            ("kp", self.kp.is_some()),
            ("kr", self.kr.is_some()),
            ("ks", self.ks.is_some()),
            ("knf", self.knf.is_some()),
            ("tip-radius", self.tip_radius.is_some()),
            ("offset", self.offset.is_some()),
            ("direction", self.direction.is_some()),
            ("lead-in", self.lead_in.is_some()),
            ("repeat", self.repeat.is_some()),
            ("trim", self.trim),
            ("format", self.format.is_some()),
            ("dialect", self.dialect.is_some()),
            ("rounding", self.rounding.is_some()),
            ("interpolator", self.interpolator.is_some()),
            ("end", self.end.is_some()),
        ]
        .into_iter()
        .find_map(|(name, given)| given.then_some(name))
    }
}

fn lead_in(text: &str) -> Result<LeadIn, Failure> {
    let point = text.split_once(',').and_then(|(x, y)| {
        let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        start_hole(number(x)?, number(y)?)
    });
    match point {
        Some(lead_in) => Ok(lead_in),
        None => Err(Failure::new(
            Exit::Usage,
            format!("--lead-in {text} is not centre, none, or X,Y in mm within 100 m"),
        )
        .help("for example --lead-in 0,-12.5")),
    }
}

/// Writes the whole program and accounts for it.
fn write(prepared: &Prepared, mut out: impl Write) -> Result<Audit, Failure> {
    let part = prepared.part();
    let mut audit = Audit::new(prepared.origin());
    let mut text = Vec::with_capacity(CHUNK + 64);
    for made in prepared.blocks() {
        audit.add(&made).map_err(|fault| {
            Failure::new(Exit::Program, format!("block {}: {fault}", audit.blocks))
                .help("the part is too small for 3B's micron at this place")
        })?;
        part.style.write(&made.block, &mut text);
        text.push(b'\n');
        // The first blocks go out at once, for whoever only wants to see them.
        if text.len() >= CHUNK || audit.blocks == FIRST_BLOCKS {
            out.write_all(&text).and_then(|()| out.flush()).map_err(Failure::output)?;
            text.clear();
        }
    }
    if !part.stop_word.text().is_empty() {
        text.extend_from_slice(part.stop_word.text().as_bytes());
        text.push(b'\n');
    }
    out.write_all(&text).and_then(|()| out.flush()).map_err(Failure::output)?;
    Ok(audit)
}

/// The account of a program, for a person.
fn account(audit: &Audit, prepared: &Prepared) -> String {
    let mut text = format!("{} blocks for {} elements\n", audit.blocks, prepared.element_count());
    for (model, deviation) in audit.deviations() {
        text.push_str(&format!(
            "under {:9} largest node error {:6.2} µm, closure {:5.2} µm\n",
            model.name(),
            deviation.node_um,
            deviation.closure_um
        ));
    }
    text
}

const CHUNK: usize = 1 << 16;
const FIRST_BLOCKS: u64 = 16;
