//! `dripfeed convert IN --to FORMAT`: a program or drawing in another format, or changed: with the wire's offset worked
//! out, or cut backwards.
//!
//! ```text
//! IN ─▶ motions ─▶ offset ─▶ backwards ─▶ OUT
//!       reader     the wire's  --reverse   writer
//!                  own path
//! ```
//!
//! Motions pass one at a time, contours one at a time where they must be seen whole. What the format of OUT has no room
//! for is counted and told; what it cannot say is refused, with its place in IN.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::motions::{Motions, OfPart, Places, Reading};
use super::output::Output;
use super::{dialects, plot};
use crate::compensation::put_on::PutOn;
use crate::compensation::{Compensated, Warning};
use crate::formats::gcode;
use crate::formats::losses::Losses;
use crate::formats::three_b::write as three_b;
use crate::formats::{WriteError, Writer};
use crate::geometry::offset::Corners;
use crate::geometry::{Point, Vector};
use crate::interpolator::Model;
use crate::motion::reverse::Reversed;
use crate::motion::runs::ContourError;
use crate::motion::{Act, Motion, Offset};
use crate::part::aim_named;
use crate::part::file::{AIMS, STOP_WORDS};
use crate::place::Spot;
use crate::plot::Plot;
use crate::rounding::Aim;

/// Convert a program or drawing to another format; work out the wire's offset, or cut it backwards
#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct Options {
    /// A program, a drawing, a part file, or - for standard input
    #[arg(value_name = "IN")]
    input: String,
    /// What to make [default: by the name after -o]
    #[arg(long, value_name = "FORMAT")]
    to: Option<To>,
    /// Where it goes [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Work out the wire's path so far from the contour, mm: half the wire and the gap. Without --side: what the program's own offsets measure
    #[arg(long, value_name = "MM", value_parser = distance)]
    offset: Option<f64>,
    /// The side the wire runs on, as seen in the direction of IN
    #[arg(long, value_name = "left|right", requires = "offset")]
    side: Option<Side>,
    /// What an offset register of the control holds, such as 1=0.125; may be given again
    #[arg(long, value_name = "N=MM", value_parser = register)]
    register: Vec<(u32, f64)>,
    /// How the wire goes round outside corners: on an arc, or straight on [default: round]
    #[arg(long, value_name = "CORNERS")]
    corners: Option<CornersWord>,
    /// Cut every contour backwards, from its own start hole
    #[arg(long)]
    reverse: bool,
    /// Where the wire stands before the first block: 3B and 4B do not say it [default: 0,0]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = point)]
    start: Option<Point>,
    #[command(flatten)]
    blocks: Blocks,
    #[command(flatten)]
    gcode: Gcode,
}

/// How 3B and 4B are written.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "3B and 4B")]
struct Blocks {
    /// The control's way of interpolating; any is right under all of them [default: any]
    #[arg(long, value_parser = AIMS)]
    interpolator: Option<String>,
    /// Stop word [default: DD]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(STOP_WORDS.map(|(w, _)| w)))]
    end: Option<String>,
    /// Keep comments and headers, between signs the control passes over [default: left out, and counted]
    #[arg(long, value_name = "HOW")]
    remarks: Option<Remarks>,
    /// Write `N 12:` before each block
    #[arg(long)]
    numbers: bool,
}

/// How G-code is written.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "G-code")]
struct Gcode {
    /// The control it is for: a built-in dialect or a dialect file [default: generic]
    #[arg(long, value_name = "NAME|FILE")]
    to_dialect: Option<String>,
    /// Number the blocks in steps, in place of the numbers they had
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u32).range(1..=1000))]
    number_step: Option<u32>,
    /// Leave out words that are in force already
    #[arg(long)]
    suppress: bool,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
enum To {
    /// Blocks of five words
    #[value(name = "3b")]
    ThreeB,
    /// G-code of a wire-cutting control
    Gcode,
    /// A picture of lines
    Svg,
    /// A picture of points
    Png,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Side {
    Left,
    Right,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CornersWord {
    /// On an arc about the corner
    Round,
    /// Along both sides to where they meet, up to a right angle
    Sharp,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Remarks {
    /// ( … ) on lines of their own
    Brackets,
    /// ; … on lines of their own
    Semicolons,
}

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    let to = options.to()?;
    options.check_words(to)?;
    let aim = options.blocks.interpolator.as_deref().and_then(aim_named).unwrap_or(Aim::Any);
    // A program that is right under any model ends its blocks where `rotated` does.
    let model = if let Aim::One(model) = aim { model } else { Model::Rotated };
    let mut writer = Made::of(to, options, aim)?;
    let motions = Motions::open(&options.input, &options.reading, OfPart::Elements, model)?;
    let mut places = motions.places()?;
    let mut output = Output::open(options.output.as_deref())?;
    if to == To::Png && output.is_terminal() {
        return Err(Failure::new(Exit::Usage, "a PNG is nothing for a terminal").help("name a file with -o"));
    }
    let mut text = Vec::with_capacity(2 * CHUNK);
    for motion in changed(motions, options, to)? {
        let motion = motion.map_err(|error| refused_contour(error, &mut places))?;
        writer.write(&motion, &mut text).map_err(|error| refused(error, &mut places))?;
        if text.len() >= CHUNK {
            output.write(&text)?;
            text.clear();
        }
    }
    let account = writer.finish(&options.input, &mut text).map_err(|error| match error {
        Unfinished::Write(error) => refused(error, &mut places),
        Unfinished::Failure(failure) => failure,
    })?;
    output.write(&text)?;
    output.finish()?;
    say!("{account}");
    Ok(())
}

impl Options {
    fn to(&self) -> Result<To, Failure> {
        let suffix = self.output.as_deref().and_then(Path::extension).and_then(|suffix| suffix.to_str());
        let by_name = match suffix.map(str::to_ascii_lowercase).as_deref() {
            Some("3b") => Some(To::ThreeB),
            Some("nc" | "iso" | "ngc" | "gcode") => Some(To::Gcode),
            Some("svg") => Some(To::Svg),
            Some("png") => Some(To::Png),
            _ => None,
        };
        self.to.or(by_name).ok_or_else(|| {
            Failure::new(Exit::Usage, "what to make is not said")
                .help("name a format with --to, such as --to 3b")
        })
    }

    /// Words that go with other formats only.
    fn check_words(&self, to: To) -> Result<(), Failure> {
        let (blocks, gcode) = (&self.blocks, &self.gcode);
        let is_blocks = to == To::ThreeB;
        for (given, belongs, word, goes) in [
            (blocks.end.is_some(), is_blocks, "--end", "3B"),
            (blocks.remarks.is_some(), is_blocks, "--remarks", "3B"),
            (blocks.numbers, is_blocks, "--numbers", "3B"),
            (gcode.to_dialect.is_some(), to == To::Gcode, "--to-dialect", "G-code"),
            (gcode.number_step.is_some(), to == To::Gcode, "--number-step", "G-code"),
            (gcode.suppress, to == To::Gcode, "--suppress", "G-code"),
        ] {
            if given && !belongs {
                return Err(Failure::new(Exit::Usage, format!("{word} goes with {goes} only"))
                    .help("leave it out, or name another format with --to"));
            }
        }
        Ok(())
    }

    fn corners(&self) -> Corners {
        match self.corners {
            None | Some(CornersWord::Round) => Corners::Round,
            Some(CornersWord::Sharp) => Corners::Sharp { limit: std::f64::consts::SQRT_2 + 1e-9 },
        }
    }
}

type Stream = Box<dyn Iterator<Item = Result<Motion, ContourError>>>;

/// What is to be written, motion by motion.
fn changed(motions: Motions, options: &Options, to: To) -> Result<Stream, Failure> {
    let kind = motions.kind;
    let mut stream: Stream = Box::new(motions.map(|motion| motion.map_err(ContourError::from)));
    if let Some(start) = options.start {
        if !matches!(kind, Kind::ThreeB | Kind::FourB | Kind::Part) {
            let message =
                format!("--start goes with 3B, 4B and parts; {} says where it begins", kind.title());
            return Err(Failure::new(Exit::Usage, message).help("leave it out"));
        }
        let by = start - Point::origin();
        stream = Box::new(stream.map(move |motion| motion.map(|motion| moved(motion, by))));
    }
    // 3B has no offset; a picture shows the wire's path. G-code keeps an offset for the control, unless one is put on.
    let is_wire = options.side.is_some() || matches!(to, To::ThreeB);
    if let (Some(side), Some(distance)) = (options.side, options.offset) {
        let side = match side {
            Side::Left => crate::motion::Side::Left,
            Side::Right => crate::motion::Side::Right,
        };
        stream = Box::new(PutOn::new(stream, side, distance));
    } else if let Some(distance) = options.offset {
        stream = Box::new(stream.map(move |motion| motion.map(|motion| measured(motion, distance))));
    }
    if is_wire || options.offset.is_some() {
        let registers: BTreeMap<u32, f64> = options.register.iter().copied().collect();
        let mut wire = Compensated::new(stream, registers, options.corners());
        stream = Box::new(std::iter::from_fn(move || {
            let motion = wire.next();
            for warning in wire.take_warnings() {
                tell(&warning);
            }
            Some(motion?.map_err(ContourError::from))
        }));
    }
    if options.reverse {
        stream = Box::new(Reversed::new(stream));
    }
    Ok(stream)
}

/// A motion in another place.
fn moved(mut motion: Motion, by: Vector) -> Motion {
    if let Act::Move { element, upper, .. } = &mut motion.act {
        *element = element.placed(0.0, 1.0, by);
        *upper = upper.map(|upper| upper.placed(0.0, 1.0, by));
    }
    motion
}

/// An offset of the program itself, of the distance that is given.
fn measured(mut motion: Motion, mm: f64) -> Motion {
    if let Act::Offset(Offset::On { distance, .. }) = &mut motion.act {
        *distance = Some(mm);
    }
    motion
}

fn tell(warning: &Warning) {
    let Warning { block, unreached, .. } = warning;
    say!(
        "warning: block {block}: the wire does not reach the contour at X{:.3} Y{:.3}; the largest offset that does is {:.3} mm",
        unreached.at.x,
        unreached.at.y,
        unreached.largest
    );
}

/// What is being made.
enum Made {
    ThreeB(Box<three_b::Writer>),
    Gcode { writer: Box<gcode::Writer>, motions: u64 },
    Picture { plot: Box<Plot>, to: To, moves: u64 },
}

/// Why something could not be ended.
enum Unfinished {
    Write(WriteError),
    Failure(Failure),
}

impl Made {
    fn of(to: To, options: &Options, aim: Aim) -> Result<Self, Failure> {
        Ok(match to {
            To::ThreeB => {
                let (blocks, standard) = (&options.blocks, three_b::Form::default());
                let end = blocks.end.as_deref();
                Self::ThreeB(Box::new(three_b::Writer::new(three_b::Form {
                    aim,
                    end: STOP_WORDS.iter().find(|(word, _)| end == Some(word)).map_or(standard.end, |s| s.1),
                    remarks: match blocks.remarks {
                        None => three_b::Remarks::LeftOut,
                        Some(Remarks::Brackets) => three_b::Remarks::Brackets,
                        Some(Remarks::Semicolons) => three_b::Remarks::Semicolons,
                    },
                    numbers: blocks.numbers,
                    ..standard
                })))
            }
            To::Gcode => {
                let Gcode { to_dialect, number_step, suppress } = &options.gcode;
                let dialect = dialects::load(to_dialect.as_deref(), "written")?;
                let layout = gcode::Layout {
                    number_step: *number_step,
                    suppress: *suppress,
                    ..gcode::Layout::default()
                };
                Self::Gcode { writer: Box::new(gcode::Writer::with_layout(dialect, layout)), motions: 0 }
            }
            To::Svg | To::Png => {
                let name = Path::new(&options.input).file_name();
                let plot = Plot::new(crate::plot::Options {
                    title: name.map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
                    wire: options.offset.map(|offset| 2.0 * offset.abs()).filter(|wire| *wire > 0.0),
                    numbers: None,
                    simulated: None,
                });
                Self::Picture { plot: Box::new(plot), to, moves: 0 }
            }
        })
    }

    fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        let is_move = u64::from(matches!(motion.act, Act::Move { .. }));
        match self {
            Self::ThreeB(writer) => writer.write(motion, text),
            Self::Gcode { writer, motions } => {
                *motions += is_move;
                writer.write(motion, text)
            }
            Self::Picture { plot, moves, .. } => {
                *moves += is_move;
                plot.see(motion, None).map_err(|fault| WriteError {
                    message: fault.to_string(),
                    spot: motion.spot,
                    help: "check the block".into(),
                })
            }
        }
    }

    /// Ends what is made; returns the account of it.
    fn finish(self, input: &str, text: &mut Vec<u8>) -> Result<String, Unfinished> {
        match self {
            Self::ThreeB(mut writer) => {
                writer.finish(text).map_err(Unfinished::Write)?;
                let mut account = counted(writer.blocks(), "block");
                if let Some(hole) = writer.start_hole() {
                    account.push_str(&format!(
                        "\nthe program begins with the wire in its start hole, X{:.3} Y{:.3}",
                        hole.x, hole.y
                    ));
                }
                account.push_str(&left_out(writer.lost(), "left out"));
                Ok(account)
            }
            Self::Gcode { mut writer, motions } => {
                writer.finish(text).map_err(Unfinished::Write)?;
                let mut account = counted(motions, "motion");
                account.push_str(&left_out(writer.lost(), "kept as a remark"));
                Ok(account)
            }
            Self::Picture { plot, to, moves } => {
                let plotted = plot.finish();
                if plotted.extent.is_none() {
                    return Err(Unfinished::Failure(plot::moves_nothing(input)));
                }
                match to {
                    To::Png => {
                        let png = plotted.picture.to_png(plot::PIXELS);
                        text.extend(png.map_err(|error| {
                            Unfinished::Failure(Failure::new(Exit::Ours, error.to_string()))
                        })?);
                    }
                    _ => text.extend_from_slice(plotted.picture.to_svg().as_bytes()),
                }
                Ok(counted(moves, "motion"))
            }
        }
    }
}

fn counted(count: u64, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// What found no room, a line a kind.
fn left_out(losses: &Losses, how: &str) -> String {
    let mut text = String::new();
    for loss in losses.iter() {
        text.push_str(&format!("\n{how}: {}", counted(loss.count, loss.kind)));
        if loss.first.line > 0 {
            text.push_str(&format!(", first in line {}", loss.first.line));
        }
    }
    text
}

fn refused(error: WriteError, places: &mut Places) -> Failure {
    at(error.message, error.spot, error.help.into_owned(), places)
}

fn refused_contour(error: ContourError, places: &mut Places) -> Failure {
    match error {
        ContourError::Read(error) => Failure::read(&places.name, error),
        ContourError::Contour { message, block, spot, help } => {
            at(format!("block {block}: {message}"), spot, help.into_owned(), places)
        }
    }
}

fn at(message: String, spot: Spot, help: String, places: &mut Places) -> Failure {
    let failure = Failure::new(Exit::Program, message).help(help);
    match places.place(spot, 0) {
        Some(place) => failure.at(&places.name, place),
        None => failure,
    }
}

fn distance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= 100.0 => Ok(value),
        _ => Err("an offset is a length in mm, up to 100".to_owned()),
    }
}

fn register(text: &str) -> Result<(u32, f64), String> {
    let split =
        text.split_once('=').and_then(|(n, mm)| Some((n.trim().parse().ok()?, distance(mm.trim()).ok()?)));
    split.ok_or_else(|| "a register is a number and what it holds in mm, such as 1=0.125".to_owned())
}

fn point(text: &str) -> Result<Point, String> {
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.abs() <= 100_000.0);
    let split = text.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    split.ok_or_else(|| "a point is X,Y in mm, within 100 m, such as 10,-2.5".to_owned())
}

const CHUNK: usize = 1 << 16;
