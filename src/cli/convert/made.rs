//! OUT of `convert`: the writer of each format, and what is told once it is done.

use std::path::Path;

use super::super::failure::{Exit, Failure};
use super::super::{dialects, plot};
use super::words::{Gcode, Options, To};
use crate::drawing::dxf::DxfWriter;
use crate::formats::four_b::write::ToKey;
use crate::formats::losses::Losses;
use crate::formats::three_b::write as three_b;
use crate::formats::{WriteError, Writer, four_b, gcode};
use crate::geometry::Point;
use crate::motion::{Act, Motion};
use crate::plot::Plot;
use crate::rounding::Aim;

/// What is being made.
pub(super) enum Made {
    ThreeB(Box<three_b::Writer>),
    FourB(Box<four_b::write::Writer>),
    Gcode { writer: Box<gcode::Writer>, motions: u64 },
    Dxf { writer: DxfWriter, motions: u64 },
    Picture { plot: Box<Plot>, to: To, moves: u64 },
}

/// Why something could not be ended.
pub(super) enum Unfinished {
    Write(WriteError),
    Failure(Failure),
}

impl Made {
    pub(super) fn of(to: To, options: &Options, aim: Aim) -> Result<Self, Failure> {
        Ok(match to {
            To::ThreeB => Self::ThreeB(Box::new(three_b::Writer::new(options.blocks.form(aim)))),
            To::FourB => Self::FourB(Box::new(four_b::write::Writer::new(four_b::write::Form {
                plain: options.blocks.form(aim),
                order: four_b::Order::default(),
                corners: options.blocks.round_corners,
            }))),
            To::Gcode => {
                let Gcode { to_dialect, number_step, suppress } = &options.gcode;
                let dialect =
                    dialects::load(to_dialect.as_deref().or(options.reading.dialect.as_deref()), "written")?;
                let layout = gcode::Layout {
                    number_step: *number_step,
                    suppress: *suppress,
                    ..gcode::Layout::default()
                };
                Self::Gcode { writer: Box::new(gcode::Writer::with_layout(dialect, layout)), motions: 0 }
            }
            To::Dxf => Self::Dxf { writer: DxfWriter::new(), motions: 0 },
            To::Svg | To::Png => {
                let name = Path::new(&options.input).file_name();
                let plot = Plot::new(crate::plot::Options {
                    title: name.map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
                    wire: options.wire.offset.map(|offset| 2.0 * offset.abs()).filter(|wire| *wire > 0.0),
                    numbers: None,
                    simulated: None,
                });
                Self::Picture { plot: Box::new(plot), to, moves: 0 }
            }
        })
    }

    pub(super) fn write(&mut self, motion: &Motion, text: &mut Vec<u8>) -> Result<(), WriteError> {
        let is_move = u64::from(matches!(motion.act, Act::Move { .. }));
        match self {
            Self::ThreeB(writer) => writer.write(motion, text),
            Self::FourB(writer) => writer.write(motion, text),
            Self::Gcode { writer, motions } => {
                *motions += is_move;
                writer.write(motion, text)
            }
            Self::Dxf { writer, motions } => {
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
    pub(super) fn finish(self, input: &str, text: &mut Vec<u8>) -> Result<String, Unfinished> {
        match self {
            Self::ThreeB(mut writer) => {
                writer.finish(text).map_err(Unfinished::Write)?;
                Ok(account(writer.blocks(), writer.start_hole(), writer.lost()))
            }
            Self::FourB(mut writer) => {
                writer.finish(text).map_err(Unfinished::Write)?;
                let mut account = account(writer.blocks(), writer.start_hole(), writer.lost());
                if let Some(ToKey { outside, distance }) = writer.keyed() {
                    let sign = if outside { '+' } else { '-' };
                    let distance = distance.map_or_else(
                        || "as the register of the source says".to_owned(),
                        |mm| format!("{mm:.4} mm"),
                    );
                    account.push_str(&format!("\nkey into the control: F = {sign} {distance}"));
                }
                Ok(account)
            }
            Self::Gcode { mut writer, motions } => {
                writer.finish(text).map_err(Unfinished::Write)?;
                let mut account = counted(motions, "motion");
                account.push_str(&left_out(writer.lost(), "kept as a remark"));
                Ok(account)
            }
            Self::Dxf { mut writer, motions } => {
                writer.finish(text).map_err(Unfinished::Write)?;
                Ok(counted(motions, "motion"))
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

/// What was written, and what the operator has to know about it.
fn account(blocks: u64, hole: Option<Point>, lost: &Losses) -> String {
    let mut text = counted(blocks, "block");
    if let Some(hole) = hole {
        let (x, y) = (hole.x, hole.y);
        text.push_str(&format!("\nthe program begins with the wire in its start hole, X{x:.3} Y{y:.3}"));
    }
    text.push_str(&left_out(lost, "left out"));
    text
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
