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

mod made;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::motions::{Motions, OfPart, Places, Reading};
use super::output::Output;
use super::registers::Registers;
use super::{drawing, plan};
use crate::compensation::Compensated;
use crate::compensation::put_on::PutOn;
use crate::cutting::Refusal;
use crate::formats::four_b::offset::Keyed;
use crate::formats::three_b::write as three_b;
use crate::formats::{WriteError, four_b};
use crate::geometry::offset::Corners;
use crate::geometry::{Point, Vector};
use crate::interpolator::Model;
use crate::motion::lead;
use crate::motion::reverse::reversed;
use crate::motion::runs::ContourError;
use crate::motion::thinning::{self, Thinning};
use crate::motion::{Act, Motion, Offset};
use crate::part::aim_named;
use crate::part::file::{AIMS, STOP_WORDS};
use crate::place::Spot;
use crate::rounding::Aim;
use made::{Made, Unfinished};

/// Write a program or drawing in another format, with an offset or backwards
#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct Options {
    /// A program, a drawing, a part file, or - for standard input
    #[arg(value_name = "IN")]
    input: String,
    /// What to make [default: by the name after -o, else what IN is]
    #[arg(long, value_name = "FORMAT")]
    to: Option<To>,
    /// Where it goes [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    wire: Wire,
    #[command(flatten)]
    plan: plan::CuttingPlan,
    #[command(flatten)]
    blocks: Blocks,
    #[command(flatten)]
    gcode: Gcode,
}

/// Where the wire goes.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Wire")]
struct Wire {
    /// Work out the wire's path so far from the contour, mm: half the wire and the gap. Without --side it is what the program's own offsets measure, and F of a 4B program
    #[arg(long, value_name = "MM", value_parser = distance)]
    offset: Option<f64>,
    /// The side the wire runs on, as seen in the direction of IN
    #[arg(long, value_name = "left|right", requires = "offset")]
    side: Option<Side>,
    #[command(flatten)]
    registers: Registers,
    /// How the wire goes round outside corners: on an arc, or straight on [default: round]
    #[arg(long, value_name = "CORNERS")]
    corners: Option<CornersWord>,
    /// Merge chains of short lines into fewer lines and arcs, no farther than this from them, mm [default: each line stays]
    #[arg(long, value_name = "MM", value_parser = distance)]
    thin: Option<f64>,
    /// What --thin merges into [default: arcs, and lines where they reach farther]
    #[arg(long, value_name = "WHAT", requires = "thin")]
    thin_into: Option<ThinInto>,
    /// Cut every contour backwards, from its own start hole
    #[arg(long)]
    reverse: bool,
    /// Where the wire stands before the first block, as 3B and 4B do not say; for a drawing a start hole, and again for more [default: 0,0; a drawing without one is begun on its contour]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = point)]
    start: Vec<Point>,
    /// A of a 4B program, how far its taper sets the wire's upper end off, mm
    #[arg(long, value_name = "MM", value_parser = distance)]
    taper: Option<f64>,
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
    /// Put an arc of this radius into each corner of a 4B outline, mm [default: a corner is refused]
    #[arg(long, value_name = "MM", value_parser = distance)]
    round_corners: Option<f64>,
}

/// How G-code is written.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "G-code")]
struct Gcode {
    /// The control OUT is for: a built-in dialect or a dialect file [default: that of IN, else generic]
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
enum ThinInto {
    /// Lines alone
    Lines,
    /// Lines and arcs
    Arcs,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
enum To {
    /// Blocks of five words
    #[value(name = "3b")]
    ThreeB,
    /// The outline, its offset left to the control
    #[value(name = "4b")]
    FourB,
    /// A drawing, an entity a motion
    Dxf,
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
    let reading =
        Reading { starts: options.wire.start.clone(), as_they_come: true, ..options.reading.clone() };
    let motions = Motions::open(&options.input, &reading, OfPart::Elements, model)?;
    drawing::tell(&motions.places.name, motions.drawn.as_ref())?;
    let mut places = motions.places()?;
    let mut output = Output::open(options.output.as_deref())?;
    if to == To::Png && output.is_terminal() {
        return Err(Failure::new(Exit::Usage, "a PNG is nothing for a terminal").help("name a file with -o"));
    }
    let mut text = Vec::with_capacity(2 * CHUNK);
    for motion in changed(motions, options, to, &mut places)? {
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
            Some("4b") => Some(To::FourB),
            Some("nc" | "iso" | "ngc" | "gcode") => Some(To::Gcode),
            Some("dxf") => Some(To::Dxf),
            Some("svg") => Some(To::Svg),
            Some("png") => Some(To::Png),
            _ => None,
        };
        let by_input = || match Kind::asked(&self.input, self.reading.from) {
            Ok(Kind::ThreeB) => Some(To::ThreeB),
            Ok(Kind::Gcode | Kind::Macro) => Some(To::Gcode),
            Ok(Kind::Dxf) => Some(To::Dxf),
            Ok(Kind::FourB) => Some(To::FourB),
            Ok(Kind::Part) | Err(_) => None,
        };
        self.to.or(by_name).or_else(by_input).ok_or_else(|| {
            Failure::new(Exit::Usage, "what to make is not said")
                .help("name a format with --to, such as --to 3b")
        })
    }

    /// Words that go with other formats only.
    fn check_words(&self, to: To) -> Result<(), Failure> {
        let (blocks, gcode) = (&self.blocks, &self.gcode);
        let is_blocks = matches!(to, To::ThreeB | To::FourB);
        for (given, belongs, word, goes) in [
            (blocks.end.is_some(), is_blocks, "--end", "3B and 4B"),
            (blocks.remarks.is_some(), is_blocks, "--remarks", "3B and 4B"),
            (blocks.numbers, is_blocks, "--numbers", "3B and 4B"),
            (blocks.round_corners.is_some(), to == To::FourB, "--round-corners", "4B"),
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
}

impl Options {
    /// Whether the contours of a drawing are cut by a plan: where anything of it is said, or an offset.
    fn has_plan(&self, to: To) -> bool {
        self.plan.first_given().is_some() || (self.wire.offset.is_some() && to != To::FourB)
    }
}

impl Wire {
    fn corners(&self) -> Corners {
        match self.corners {
            None | Some(CornersWord::Round) => Corners::Round,
            Some(CornersWord::Sharp) => Corners::Sharp { limit: std::f64::consts::SQRT_2 + 1e-9 },
        }
    }
}

impl Blocks {
    fn form(&self, aim: Aim) -> three_b::Form {
        let (standard, end) = (three_b::Form::default(), self.end.as_deref());
        three_b::Form {
            aim,
            end: STOP_WORDS.iter().find(|(word, _)| end == Some(word)).map_or(standard.end, |s| s.1),
            remarks: match self.remarks {
                None => three_b::Remarks::LeftOut,
                Some(Remarks::Brackets) => three_b::Remarks::Brackets,
                Some(Remarks::Semicolons) => three_b::Remarks::Semicolons,
            },
            numbers: if self.numbers { three_b::Numbers::All } else { three_b::Numbers::LeftOut },
            ..standard
        }
    }
}

/// The largest arc that thinning makes, mm: what six digits of micrometres hold in 3B.
const ARC_RADIUS_MAX: f64 = 999.999;

type Stream = Box<dyn Iterator<Item = Result<Motion, ContourError>>>;

/// What is to be written, motion by motion.
fn changed(motions: Motions, options: &Options, to: To, places: &mut Places) -> Result<Stream, Failure> {
    let (kind, wire) = (motions.kind, &options.wire);
    let side = wire.side.map(|side| match side {
        Side::Left => crate::motion::Side::Left,
        Side::Right => crate::motion::Side::Right,
    });
    let mut stream = match &motions.drawn {
        Some(drawing) if options.has_plan(to) && wire.thin.is_none() => {
            let needs = plan::Wire {
                offset: wire.offset,
                side,
                corners: wire.corners(),
                starts: &wire.start,
                stops: to == To::Gcode,
            };
            let cutting = options.plan.cut(drawing, &needs, places)?;
            Box::new(cutting.map(|motion| motion.map_err(cannot_be_cut))) as Stream
        }
        Some(_) if wire.thin.is_some() => {
            return Err(Failure::new(Exit::Usage, "--thin goes with programs")
                .help("the curves of a drawing become as few lines and arcs as --tolerance allows"));
        }
        Some(_) => {
            let drawn = motions.map(|motion| motion.map_err(ContourError::from));
            let hole = wire.start.first().copied();
            let stream: Stream = match hole {
                Some(hole) => Box::new(lead::from_hole(drawn, hole)),
                None => Box::new(drawn),
            };
            beside(stream, options, side, to)
        }
        None => {
            if let Some(word) = options.plan.first_given() {
                let message =
                    format!("{word} goes with a drawing, and {} is {}", options.input, kind.title());
                return Err(Failure::new(Exit::Usage, message).help(
                    "a program is led in as it is; make a drawing of its outline, or put an offset on it with --offset and --side",
                ));
            }
            let mut stream: Stream = Box::new(motions.map(|motion| motion.map_err(ContourError::from)));
            if let Some(tolerance) = wire.thin.filter(|tolerance| *tolerance > 0.0) {
                let into = match wire.thin_into {
                    Some(ThinInto::Lines) => thinning::Into::Lines,
                    Some(ThinInto::Arcs) | None => thinning::Into::LinesAndArcs,
                };
                let thinning = Thinning { tolerance, into, radius_max: ARC_RADIUS_MAX };
                stream = Box::new(thinning::thinned(stream, thinning));
            }
            if let Some(start) = wire.start.first() {
                if kind == Kind::Gcode {
                    let message = "--start goes with 3B, 4B, parts and drawings; G-code says where it begins";
                    return Err(Failure::new(Exit::Usage, message).help("leave it out"));
                }
                let by = start - Point::origin();
                stream = Box::new(stream.map(move |motion| motion.map(|motion| moved(motion, by))));
            }
            if kind == Kind::FourB {
                keyed_in(stream, options, to)?
            } else {
                beside(stream, options, side, to)
            }
        }
    };
    if options.wire.reverse {
        stream = Box::new(reversed(stream));
    }
    Ok(stream)
}

/// The wire's path of a 4B program, once an offset is keyed in.
fn keyed_in(stream: Stream, options: &Options, to: To) -> Result<Stream, Failure> {
    let wire = &options.wire;
    if wire.side.is_some() {
        return Err(Failure::new(Exit::Usage, "a 4B program says itself on which side the wire runs")
            .help("leave --side out; --offset is F, positive outside the outline"));
    }
    if wire.offset.is_none() && wire.taper.is_none() {
        return Ok(stream);
    }
    if to == To::FourB {
        return Err(Failure::new(Exit::Usage, "4B leaves the offset to the control")
            .help("leave --offset and --taper out, or name another format with --to"));
    }
    let keyed = Keyed { offset: wire.offset.unwrap_or(0.0), taper: wire.taper };
    Ok(Box::new(four_b::offset::beside(stream, keyed)))
}

/// The wire's path of any other program: beside its contours, or as its own offsets say.
fn beside(mut stream: Stream, options: &Options, side: Option<crate::motion::Side>, to: To) -> Stream {
    let wire = &options.wire;
    if let (Some(side), Some(distance)) = (side, wire.offset) {
        stream = Box::new(PutOn::new(stream, side, distance));
    } else if let Some(distance) = wire.offset {
        stream = Box::new(stream.map(move |motion| motion.map(|motion| measured(motion, distance))));
    }
    // 3B has no offset; 4B leaves it to the control, and so does G-code unless it is said here.
    if to == To::FourB || (to != To::ThreeB && wire.offset.is_none()) {
        return stream;
    }
    let mut wire = Compensated::new(stream, wire.registers.held(), wire.corners());
    Box::new(std::iter::from_fn(move || {
        let motion = wire.next();
        for warning in wire.take_warnings() {
            say!("warning: {warning}");
        }
        Some(motion?.map_err(ContourError::from))
    }))
}

/// A plan was tried out before its first motion; what is refused all the same is told like anything else.
fn cannot_be_cut(refusal: Refusal) -> ContourError {
    ContourError::Contour {
        message: refusal.fault.to_string(),
        block: 0,
        spot: refusal.spot,
        help: refusal.help().into(),
    }
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

fn point(text: &str) -> Result<Point, String> {
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.abs() <= 100_000.0);
    let split = text.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    split.ok_or_else(|| "a point is X,Y in mm, within 100 m, such as 10,-2.5".to_owned())
}

const CHUNK: usize = 1 << 16;
