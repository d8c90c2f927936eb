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
mod words;

use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::motions::{Motions, OfPart, Places, Reading};
use super::output::Output;
use super::{drawing, plan};
use crate::compensation::Compensated;
use crate::compensation::put_on::PutOn;
use crate::cutting::Refusal;
use crate::formats::four_b::offset::Keyed;
use crate::formats::{WriteError, four_b};
use crate::geometry::{Point, Vector};
use crate::interpolator::Model;
use crate::motion::lead;
use crate::motion::reverse::reversed;
use crate::motion::runs::ContourError;
use crate::motion::thinning::{self, Thinning};
use crate::motion::{Act, Motion, Offset};
use crate::part::aim_named;
use crate::place::Spot;
use crate::rounding::Aim;
use made::{Made, Unfinished};
pub(super) use words::Options;
use words::{Side, ThinInto, To};

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
                let made = match wire.thin_into {
                    Some(ThinInto::Lines) => thinning::Made::Lines,
                    Some(ThinInto::Arcs) | None => thinning::Made::LinesAndArcs,
                };
                let thinning = Thinning { tolerance, made, radius_max: ARC_RADIUS_MAX };
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
        motion
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

const CHUNK: usize = 1 << 16;
