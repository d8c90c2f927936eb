//! `dripfeed plot IN -o OUT.svg|OUT.png`: a program as a picture.
//!
//! ```text
//! $ dripfeed plot gear.3b -o gear.svg
//! 265 blocks, 15.446 x 15.446 mm
//! 77 034 pulses of the rotated model; the largest deviation is 0.99 µm, in block 98
//! ```
//!
//! A picture tells at a glance whether it is the right part. The SVG is in model millimetres: a point of the program
//! stands at (x, -y); its classes are `nominal wire rapid cut lead-in start`. `docs/check.md` says what is drawn.

use std::cell::RefCell;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::drawing;
use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::motions::{Motions, OfPart, Reading};
use super::registers::{self, KeyedIn, Registers};
use super::{print, print_json};
use crate::check::wire::{self, Known, Seen};
use crate::drawing::Extent;
use crate::formats::four_b::offset::Keyed;
use crate::interpolator::Model;
use crate::plot::{Options as What, Plot, Plotted};

/// Draw a program as SVG or PNG: contour, wire, and the cut pulse by pulse
#[derive(Args, Debug)]
pub(super) struct Options {
    /// A program, a part file, or - for standard input
    #[arg(value_name = "IN")]
    input: String,
    /// Where the picture goes: .svg or .png; - for SVG on standard output
    #[arg(short, long, value_name = "OUT.svg|OUT.png")]
    output: PathBuf,
    #[command(flatten)]
    registers: Registers,
    #[command(flatten)]
    keyed: KeyedIn,
    /// The wire's diameter; 0 draws no wire [default: 0.18]
    #[arg(long, value_name = "MM", value_parser = diameter)]
    wire: Option<f64>,
    /// A number at every N-th block; 0 for none [default: about forty in all]
    #[arg(long, value_name = "N")]
    numbers: Option<u64>,
    /// The control's way of interpolating, whose pulses are drawn [default: rotated]
    #[arg(long, value_name = "MODEL", value_parser = Model::ALL.map(Model::name))]
    interpolator: Option<String>,
    /// Draw the program alone, without the simulated cut
    #[arg(long, conflicts_with = "interpolator")]
    no_simulation: bool,
    /// How wide a PNG is [default: 2400]
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(100..=20_000))]
    pixels: Option<u32>,
    /// Print what was drawn as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: Reading,
}

/// What pictures can be written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Picture {
    Svg,
    Png,
}

/// The wire that is drawn when none is named: molybdenum of 0.18 mm is what reciprocating machines commonly run.
const WIRE_MM: f64 = 0.18;

/// How wide a PNG is unless it is said.
pub(super) const PIXELS: u32 = 2400;

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    let picture = picture_of(&options.output)?;
    if options.json && is_standard_output(&options.output) {
        let message = "the picture and its figures cannot both go to standard output";
        return Err(Failure::new(Exit::Usage, message).help("name a file with -o, or leave out --json"));
    }
    let named = options.interpolator.as_deref();
    let model = Model::ALL.into_iter().find(|model| Some(model.name()) == named).unwrap_or(Model::Rotated);
    let simulated = (!options.no_simulation).then_some(model);
    let mut motions = Motions::open(&options.input, &options.reading, OfPart::Blocks, model)?;
    if let Err(fault) = drawing::tell(&motions.places.name, motions.drawn.as_ref()) {
        // A drawing that cannot be cut as it is can be looked at.
        say!("{}", fault.render().trim_end());
    }
    let keyed = options.keyed.of(&options.input, motions.kind)?;
    let wire = options.wire.or_else(|| kerf(&motions, keyed)).unwrap_or_else(|| {
        say!("the wire's diameter is not given: {WIRE_MM} mm is drawn (--wire MM)");
        WIRE_MM
    });
    let mut plot = Plot::new(What {
        title: Path::new(&motions.places.name)
            .file_name()
            .map_or_else(|| motions.places.name.clone(), |name| name.to_string_lossy().into_owned()),
        wire: (wire > 0.0).then_some(wire),
        numbers: options.numbers,
        simulated,
    });
    let known = registers::known(motions.kind, &options.registers, keyed);
    let blocks = draw(&mut motions, &mut plot, known.as_ref())?;
    let plotted = plot.finish();
    if plotted.extent.is_none() {
        return Err(moves_nothing(&motions.places.name));
    }
    let bytes = match picture {
        Picture::Svg => plotted.picture.to_svg().into_bytes(),
        Picture::Png => plotted
            .picture
            .to_png(options.pixels.unwrap_or(PIXELS))
            .map_err(|error| Failure::new(Exit::Usage, error.to_string()).help("ask for fewer --pixels"))?,
    };
    if is_standard_output(&options.output) {
        return print(&bytes);
    }
    write(&options.output, &bytes)?;
    if options.json {
        return print_json(&as_json(&plotted, blocks, bytes.len()));
    }
    print(account(&plotted, blocks, simulated).as_bytes())
}

pub(super) fn moves_nothing(name: &str) -> Failure {
    Failure::new(Exit::Program, format!("{name} moves nothing"))
        .help("check that this is the program that was meant")
}

/// Draws every motion; returns how many blocks there are.
fn draw(motions: &mut Motions, plot: &mut Plot, known: Option<&Known>) -> Result<u64, Failure> {
    let mut blocks = 0;
    let mut failed = None;
    let plot = RefCell::new(plot);
    let mut next = || {
        let motion = match motions.next()? {
            Ok(motion) => motion,
            Err(error) => {
                failed = Some(Failure::read(&motions.places.name, error));
                return None;
            }
        };
        blocks = motion.block;
        if let Err(fault) = plot.borrow_mut().see(&motion, motions.block().as_ref()) {
            let failure = Failure::new(Exit::Program, format!("block {blocks}: {fault}"));
            let help = "simulate another model with --interpolator, or none with --no-simulation";
            failed = Some(failure.help(help));
            return None;
        }
        Some(motion)
    };
    let mut doubt = None;
    let mut is_offset = false;
    match known {
        None => while next().is_some() {},
        Some(known) => wire::follow(next, known, |seen| match seen {
            Seen::Switched => is_offset = true,
            Seen::Motion(motion) => plot.borrow_mut().see_wire(motion),
            Seen::Passed(warning) => say!("warning: {warning}"),
            Seen::Failed(error) => doubt = Some(error.to_string()),
            Seen::Unknown(register) => {
                doubt =
                    Some(format!("what register {register} holds is not given (--register {register}=MM)"));
            }
        }),
    }
    if known.is_none() && motions.kind == Kind::FourB {
        doubt = Some("the offset that is keyed into the control is not given (--offset MM)".to_owned());
    }
    if let Some(failure) = failed {
        return Err(failure);
    }
    if let Some(doubt) = &doubt {
        say!("{doubt}: the wire is drawn on the programmed path");
    }
    if !is_offset || doubt.is_some() {
        plot.into_inner().forget_wire();
    }
    Ok(blocks)
}

fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-")
}

fn picture_of(path: &Path) -> Result<Picture, Failure> {
    if is_standard_output(path) {
        return Ok(Picture::Svg);
    }
    match path.extension().and_then(|suffix| suffix.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("svg") => Ok(Picture::Svg),
        Some("png") => Ok(Picture::Png),
        _ => Err(Failure::new(
            Exit::Usage,
            format!("what picture {} is to be cannot be told from its name", path.display()),
        )
        .help("name a file that ends in .svg or .png")),
    }
}

fn diameter(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=5.0).contains(&value) => Ok(value),
        _ => Err("a diameter is from 0 to 5 mm".to_owned()),
    }
}

/// What a part's own offset takes away, or one that is keyed in.
fn kerf(motions: &Motions, keyed: Option<Keyed>) -> Option<f64> {
    let offset = motions.part().map(|part| part.offset).or(keyed.map(|keyed| keyed.offset));
    offset.map(|offset| 2.0 * offset.abs())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |error| Failure::new(Exit::Ours, format!("cannot write {}: {error}", path.display()));
    let mut file = std::fs::File::create(path).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.flush()).map_err(failed)
}

fn as_json(plotted: &Plotted, blocks: u64, bytes: usize) -> serde_json::Value {
    let corners = |extent: Option<Extent>| extent.map(|extent| [extent.min, extent.max]);
    serde_json::json!({
        "blocks": blocks,
        "bytes": bytes,
        "part_mm": corners(plotted.part),
        "extent_mm": corners(plotted.extent),
        "pulses": plotted.pulses,
        "thinned_um": plotted.thinned_um,
        "deviation": plotted.deviation.map(|deviation| serde_json::json!({
            "um": deviation.um,
            "x_mm": deviation.at.x,
            "y_mm": deviation.at.y,
            "block": deviation.block,
        })),
    })
}

/// What was drawn, for a person.
fn account(plotted: &Plotted, blocks: u64, simulated: Option<Model>) -> String {
    let mut text = format!("{blocks} blocks");
    if let Some(extent) = plotted.part {
        text.push_str(&format!(", {:.3} x {:.3} mm", extent.width(), extent.height()));
    }
    text.push('\n');
    if let (Some(model), Some(deviation)) = (simulated, plotted.deviation) {
        text.push_str(&format!(
            "{} pulses of the {} model; the largest deviation is {:.2} µm, in block {}\n",
            plotted.pulses,
            model.name(),
            deviation.um,
            deviation.block
        ));
    }
    if plotted.thinned_um > 2.5 {
        text.push_str(&format!(
            "lines are drawn within {:.0} µm, to keep the picture small\n",
            plotted.thinned_um
        ));
    }
    if plotted.numbers_left_out > 0 {
        text.push_str(&format!("{} block numbers are left out for want of room\n", plotted.numbers_left_out));
    }
    text
}
