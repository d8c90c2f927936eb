//! The words of `convert`: what is asked for, and what does not go together.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::super::failure::{Exit, Failure};
use super::super::kind::Kind;
use super::super::motions::Reading;
use super::super::plan;
use super::super::registers::{Registers, distance};
use crate::formats::three_b::write as three_b;
use crate::geometry::Point;
use crate::geometry::offset::Corners;
use crate::part::file::{AIMS, STOP_WORDS};
use crate::rounding::Aim;

/// Write a program or drawing in another format, with an offset or backwards
#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub(in crate::cli) struct Options {
    /// A program, a drawing, a part file, or - for standard input
    #[arg(value_name = "IN")]
    pub(super) input: String,
    /// What to make [default: by the name after -o, else what IN is]
    #[arg(long, value_name = "FORMAT")]
    pub(super) to: Option<To>,
    /// Where it goes [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) wire: Wire,
    #[command(flatten)]
    pub(super) plan: plan::CuttingPlan,
    #[command(flatten)]
    pub(super) blocks: Blocks,
    #[command(flatten)]
    pub(super) gcode: Gcode,
}

/// Where the wire goes.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Wire")]
pub(super) struct Wire {
    /// Work out the wire's path so far from the contour, mm: half the wire and the gap. Without --side it is what the program's own offsets measure, and F of a 4B program
    #[arg(long, value_name = "MM", value_parser = distance)]
    pub(super) offset: Option<f64>,
    /// The side the wire runs on, as seen in the direction of IN
    #[arg(long, value_name = "left|right", requires = "offset")]
    pub(super) side: Option<Side>,
    #[command(flatten)]
    pub(super) registers: Registers,
    /// How the wire goes round outside corners: on an arc, or straight on [default: round]
    #[arg(long, value_name = "CORNERS")]
    pub(super) corners: Option<CornersWord>,
    /// Merge chains of short lines into fewer lines and arcs, no farther than this from them, mm [default: each line stays]
    #[arg(long, value_name = "MM", value_parser = distance)]
    pub(super) thin: Option<f64>,
    /// What --thin merges into [default: arcs, and lines where they reach farther]
    #[arg(long, value_name = "WHAT", requires = "thin")]
    pub(super) thin_into: Option<ThinInto>,
    /// Cut every contour backwards, from its own start hole
    #[arg(long)]
    pub(super) reverse: bool,
    /// Where the wire stands before the first block, as 3B and 4B do not say; for a drawing a start hole, and again for more [default: 0,0; a drawing without one is begun on its contour]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = point)]
    pub(super) start: Vec<Point>,
    /// A of a 4B program, how far its taper sets the wire's upper end off, mm
    #[arg(long, value_name = "MM", value_parser = distance)]
    pub(super) taper: Option<f64>,
}

/// How 3B and 4B are written.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "3B and 4B")]
pub(super) struct Blocks {
    /// The control's way of interpolating; any is right under all of them [default: any]
    #[arg(long, value_parser = AIMS)]
    pub(super) interpolator: Option<String>,
    /// Stop word [default: DD]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(STOP_WORDS.map(|(w, _)| w)))]
    pub(super) end: Option<String>,
    /// Keep comments and headers, between signs the control passes over [default: left out, and counted]
    #[arg(long, value_name = "HOW")]
    pub(super) remarks: Option<Remarks>,
    /// Write `N 12:` before blocks: all from 1, or those that have one in IN, as it is there [default: none; alone: all]
    #[arg(long, value_name = "WHICH", num_args = 0..=1, require_equals = true, default_missing_value = "all")]
    pub(super) numbers: Option<Numbers>,
    /// Put an arc of this radius into each corner of a 4B outline, mm [default: a corner is refused]
    #[arg(long, value_name = "MM", value_parser = distance)]
    pub(super) round_corners: Option<f64>,
}

/// How G-code is written.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "G-code")]
pub(super) struct Gcode {
    /// The control OUT is for: a built-in dialect or a dialect file [default: that of IN, else generic]
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) to_dialect: Option<String>,
    /// Number the blocks in steps, in place of the numbers they had
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) number_step: Option<u32>,
    /// Leave out words that are in force already
    #[arg(long)]
    pub(super) suppress: bool,
}

/// See `--thin-into`.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(super) enum ThinInto {
    /// Lines alone
    Lines,
    /// Lines and arcs
    Arcs,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(super) enum To {
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
pub(super) enum Side {
    Left,
    Right,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum CornersWord {
    /// On an arc about the corner
    Round,
    /// Along both sides to where they meet, up to a right angle
    Sharp,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Remarks {
    /// ( … ) on lines of their own
    Brackets,
    /// ; … on lines of their own
    Semicolons,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Numbers {
    /// All, from 1
    All,
    /// Those that are in IN
    AsRead,
}

impl Options {
    pub(super) fn to(&self) -> Result<To, Failure> {
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
    pub(super) fn check_words(&self, to: To) -> Result<(), Failure> {
        let (blocks, gcode) = (&self.blocks, &self.gcode);
        let is_blocks = matches!(to, To::ThreeB | To::FourB);
        for (given, belongs, word, goes) in [
            (blocks.end.is_some(), is_blocks, "--end", "3B and 4B"),
            (blocks.remarks.is_some(), is_blocks, "--remarks", "3B and 4B"),
            (blocks.numbers.is_some(), is_blocks, "--numbers", "3B and 4B"),
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
    pub(super) fn has_plan(&self, to: To) -> bool {
        self.plan.first_given().is_some() || (self.wire.offset.is_some() && to != To::FourB)
    }
}

impl Wire {
    pub(super) fn corners(&self) -> Corners {
        match self.corners {
            None | Some(CornersWord::Round) => Corners::Round,
            Some(CornersWord::Sharp) => Corners::Sharp { limit: std::f64::consts::SQRT_2 + 1e-9 },
        }
    }
}

impl Blocks {
    pub(super) fn form(&self, aim: Aim) -> three_b::Form {
        let (standard, end) = (three_b::Form::default(), self.end.as_deref());
        three_b::Form {
            aim,
            end: STOP_WORDS.iter().find(|(word, _)| end == Some(word)).map_or(standard.end, |s| s.1),
            remarks: match self.remarks {
                None => three_b::Remarks::LeftOut,
                Some(Remarks::Brackets) => three_b::Remarks::Brackets,
                Some(Remarks::Semicolons) => three_b::Remarks::Semicolons,
            },
            numbers: match self.numbers {
                None => three_b::Numbers::LeftOut,
                Some(Numbers::All) => three_b::Numbers::All,
                Some(Numbers::AsRead) => three_b::Numbers::AsRead,
            },
            ..standard
        }
    }
}

fn point(text: &str) -> Result<Point, String> {
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.abs() <= 100_000.0);
    let split = text.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    split.ok_or_else(|| "a point is X,Y in mm, within 100 m, such as 10,-2.5".to_owned())
}
