//! IN where it is a drawing: how it is read, and what is told of it.

use std::fs::File;
use std::io::{self, Read};

use clap::{Args, ValueEnum};

use super::failure::{Exit, Failure};
use super::source;
use crate::drawing::contours::{Direction, Order, Start};
use crate::drawing::dxf::{self, Drawing};
use crate::drawing::finding::{Finding, Severity};
use crate::geometry::biarc::Elements;
use crate::geometry::{Point, Sense};

/// How a drawing is read.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Drawings")]
pub(super) struct OfDrawing {
    /// How far lines and arcs may lie from a curve, mm [default: 0.001]
    #[arg(long, value_name = "MM", value_parser = length)]
    tolerance: Option<f64>,
    /// What curves become [default: fewest]
    #[arg(long, value_name = "ELEMENTS")]
    elements: Option<ElementsWord>,
    /// Ends so near to each other meet, mm [default: 0.005]
    #[arg(long, value_name = "MM", value_parser = length)]
    join: Option<f64>,
    /// A layer that is cut; may be given again [default: all that are neither off nor frozen]
    #[arg(long, value_name = "NAME")]
    layer: Vec<String>,
    /// The drawing's unit [default: what it says itself]
    #[arg(long, value_name = "UNIT")]
    unit: Option<Unit>,
    /// The order of contours [default: holes-first, or the drawing's own where it says so]
    #[arg(long, value_name = "ORDER")]
    order: Option<OrderWord>,
    /// In which sense closed contours are cut [default: as drawn]
    #[arg(long, value_name = "cw|ccw")]
    direction: Option<Turn>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ElementsWord {
    /// Straight lines
    Lines,
    /// Tangent arcs, and lines where the curve is straight
    Biarcs,
    /// Whichever are fewer
    Fewest,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Unit {
    Mm,
    Inch,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum OrderWord {
    /// What lies in a contour before the contour, and otherwise whatever is nearest
    HolesFirst,
    /// By the first entity of each contour
    AsDrawn,
    /// Entity by entity, for drawings that are programs
    InSequence,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Turn {
    Cw,
    Ccw,
}

impl OfDrawing {
    /// Whether any of it is said.
    pub(super) fn is_given(&self) -> bool {
        self.tolerance.is_some()
            || self.elements.is_some()
            || self.join.is_some()
            || !self.layer.is_empty()
            || self.unit.is_some()
            || self.order.is_some()
            || self.direction.is_some()
    }

    fn options(&self, starts: &[Point]) -> dxf::Options {
        let standard = dxf::Options::default();
        let sense = self.direction.map(|direction| match direction {
            Turn::Cw => Sense::Clockwise,
            Turn::Ccw => Sense::CounterClockwise,
        });
        dxf::Options {
            tolerance: self.tolerance.unwrap_or(standard.tolerance),
            elements: match self.elements {
                Some(ElementsWord::Lines) => Elements::Lines,
                Some(ElementsWord::Biarcs) => Elements::Biarcs,
                Some(ElementsWord::Fewest) => Elements::Fewest,
                None => standard.elements,
            },
            join: self.join.unwrap_or(standard.join),
            layers: (!self.layer.is_empty()).then(|| self.layer.clone()),
            unit: self.unit.map(|unit| match unit {
                Unit::Mm => 1.0,
                Unit::Inch => 25.4,
            }),
            order: self.order.map(|order| match order {
                OrderWord::HolesFirst => Order::HolesFirst,
                OrderWord::AsDrawn => Order::AsDrawn,
                OrderWord::InSequence => Order::InSequence,
            }),
            start: if starts.is_empty() { standard.start } else { Start::At(starts.to_vec()) },
            direction: Direction { outlines: sense, holes: sense },
            ..standard
        }
    }

    /// Reads a drawing.
    pub(super) fn read(&self, word: &str, starts: &[Point]) -> Result<Drawing, Failure> {
        let text: Box<dyn Read> = if word == "-" {
            Box::new(io::stdin().lock())
        } else {
            Box::new(File::open(word).map_err(|error| source::unreadable(word, &error))?)
        };
        dxf::read(text, &self.options(starts)).map_err(|error| Failure::read(word, error))
    }
}

/// Tells what was found in a drawing, what stands in the way last; one that says no single thing to cut is refused.
pub(super) fn tell(word: &str, drawing: Option<&Drawing>) -> Result<(), Failure> {
    let report = drawing.map_or(&[][..], |drawing| &drawing.report);
    // Where the wire enters is meant as a start hole, which lies beside its contour.
    let is_told = |finding: &&Finding| finding.severity < Severity::Fault && finding.code != "start-beside";
    for finding in report.iter().filter(is_told) {
        let note = if finding.severity == Severity::Note { "" } else { "warning: " };
        say!("{note}{word}: {finding}{}", help(finding));
    }
    let mut faults = report.iter().filter(|finding| finding.severity == Severity::Fault);
    let Some(first) = faults.next() else { return Ok(()) };
    for fault in faults {
        say!("error: {word}: {fault}{}", help(fault));
    }
    Err(Failure::new(Exit::Program, format!("{word}: {first}")).help(first.help.clone()))
}

fn help(finding: &Finding) -> String {
    if finding.help.is_empty() { String::new() } else { format!("; {}", finding.help) }
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.000_001..=10.0).contains(&value) => Ok(value),
        _ => Err("a length in mm, from 0.000001 to 10".to_owned()),
    }
}
