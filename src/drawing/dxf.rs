//! DXF: drawings read into contours, and motions written as drawings.
//!
//! A drawing is the one format that is held whole: its blocks stand before what inserts them, and its contours are
//! scattered over the file. Damage to the file is an error with its place. What a sound file holds and cannot be cut is
//! left out and told in the drawing's [`report`](Drawing::report), by kind and layer; nothing of it is lost in silence.
//!
//! ```text
//! bytes ─pairs─▶ group codes ─records─▶ entities (checked; made by the `dxf` crate) ─model─▶ pieces, mm
//!                                                      (inserts, layers, units)       │ contours
//!                                                                                     ▼
//!                                                               Drawing { contours, report } ─▶ motions
//! ```
//!
//! It does not read DWG or DXB, and draws no pictures.

mod entity;
mod model;
mod motions;
mod pairs;
mod placement;
mod records;
mod trace;
mod units;
mod write;

use std::io::Read;

use crate::formats::ReadError;
use crate::geometry::Point;
use crate::geometry::biarc::{Elements, Fit};
use crate::motion::Motion;
use crate::place::Place;

use super::contours::{Contour, Direction, Joining, Order, Start, contours};
use super::finding::{Finding, Severity};
use model::Model;
use records::Records;

pub use units::{Known, Units};
pub use write::{CUT, DxfWriter, RAPID, UPPER};

/// The largest file that is read, bytes: a guard of memory.
pub const FILE_BYTES_MAX: u64 = 1 << 30;

/// How a drawing is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The greatest distance of a curve from its lines and arcs, mm.
    pub tolerance: f64,
    /// What curves become.
    pub elements: Elements,
    /// The greatest radius of an arc made of a curve, mm.
    pub radius_max: f64,
    /// Ends closer than this meet, mm.
    pub join: f64,
    /// The layers that are cut, by name; all that are neither off nor frozen when none are given.
    pub layers: Option<Vec<String>>,
    /// The drawing's unit, mm, instead of what it says itself.
    pub unit: Option<f64>,
    /// The order of contours; when none is given, as the drawing says, else holes first.
    pub order: Option<Order>,
    /// Where closed contours begin.
    pub start: Start,
    /// In which sense closed contours are run.
    pub direction: Direction,
}

impl Default for Options {
    fn default() -> Self {
        let Joining { join, start, direction, .. } = Joining::default();
        Self {
            tolerance: 0.001,
            elements: Elements::Fewest,
            // Five digits before the point, which is what many controls take. A guess; a profile knows better.
            radius_max: 99_999.0,
            join,
            layers: None,
            unit: None,
            order: None,
            start,
            direction,
        }
    }
}

/// A drawing's contours, in cutting order, and what there is to say about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The contours.
    pub contours: Vec<Contour>,
    /// What was left out, assumed, mended, or stands in the way of cutting.
    pub report: Vec<Finding>,
    /// The drawing's unit.
    pub units: Units,
    /// The order the contours are in.
    pub order: Order,
}

impl Drawing {
    /// Whether nothing found stands in the way of cutting.
    #[must_use]
    pub fn is_fit_to_cut(&self) -> bool {
        self.report.iter().all(|finding| finding.severity < Severity::Fault)
    }

    /// The motions that cut the drawing: a remark with its layer before each contour, positioning to its start where the
    /// wire is not there yet, with a pause before and after it for the wire, the contour, and the end of the program.
    pub fn motions(&self) -> impl Iterator<Item = Motion> {
        motions::Motions::of(&self.contours)
    }
}

/// Reads a drawing.
///
/// # Errors
///
/// When the source fails, or the file is damaged or no DXF file.
pub fn read(source: impl Read, options: &Options) -> Result<Drawing, ReadError> {
    let mut bytes = Vec::new();
    source.take(FILE_BYTES_MAX + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > FILE_BYTES_MAX {
        return Err(ReadError::Program {
            message: format!("the drawing is larger than {FILE_BYTES_MAX} bytes"),
            place: Place::in_line(&[], 1, 0, 0, 1),
            help: "delete what is not to be cut".into(),
        });
    }
    let records = Records::of(&bytes)?;
    drop(bytes);
    Ok(drawn(&records, options))
}

fn drawn(records: &Records, options: &Options) -> Drawing {
    let mut report = Vec::new();
    let units = Units::of(options.unit, records.units, records.measurement);
    tell_units(units, records, &mut report);
    if let Some(spot) = records.behind_end {
        let message = "what stands behind `0 EOF` is not read".to_string();
        report.push(Finding::new(Severity::Warning, "behind-end", message).line(spot.line));
    }
    if let Some(&line) = records.leaving_plane.first() {
        let count = records.leaving_plane.len();
        let (many, leave) = if count == 1 { ("entity", "leaves") } else { ("entities", "leave") };
        let message =
            format!("{count} {many} {leave} the XY plane, and {leave} it out of account: Z is not cut");
        report.push(Finding::new(Severity::Warning, "leaves-plane", message).line(line));
    }
    let chosen = options.layers.as_ref().map(|names| chosen(names, records, &mut report));
    let fit =
        Fit { tolerance: options.tolerance, elements: options.elements, radius_max: options.radius_max };
    let model = Model::of(records, units.millimetres, fit, chosen);
    report.extend(model.report);
    let order = match options.order {
        Some(order) => order,
        None if records.in_order => {
            let message = "the drawing says that its entities stand in cutting order".to_string();
            report.push(Finding::new(Severity::Note, "in-order", message));
            Order::InSequence
        }
        None => Order::HolesFirst,
    };
    let ends_at = records.ends_at.map(|[x, y]| Point::new(x, y) * units.millimetres);
    let layers: Vec<String> = records.layers.iter().map(|layer| layer.name.clone()).collect();
    let joining =
        Joining { join: options.join, order, start: options.start.clone(), direction: options.direction };
    let contours = contours(model.pieces, &layers, &joining, ends_at, &mut report);
    if contours.is_empty() {
        let message = "the drawing has nothing to cut".to_string();
        report.push(Finding::new(Severity::Fault, "nothing-to-cut", message));
    }
    Drawing { contours, report, units, order }
}

fn tell_units(units: Units, records: &Records, report: &mut Vec<Finding>) {
    let name = if units.millimetres == 25.4 { "inches" } else { "mm" };
    let because = match (units.known, records.units) {
        (Known::Given | Known::Stated, _) => return,
        (Known::Likely, _) => "`$MEASUREMENT` makes it likely".to_string(),
        (Known::Assumed, Some(number)) if number != 0 => {
            format!("`$INSUNITS` {number} is none that is known")
        }
        (Known::Assumed, _) => "nothing in it tells".to_string(),
    };
    let message = format!("the drawing does not state its unit: {name} are assumed, since {because}");
    report.push(
        Finding::new(Severity::Warning, "unit-assumed", message).help("state the unit when reading it"),
    );
}

/// Which layers are chosen; a name that no layer has is a fault.
fn chosen(names: &[String], records: &Records, report: &mut Vec<Finding>) -> Vec<bool> {
    let mut chosen = vec![false; records.layers.len()];
    for name in names {
        let mut found = false;
        for (layer, chosen) in records.layers.iter().zip(&mut chosen) {
            if layer.name.to_uppercase() == name.to_uppercase() {
                (*chosen, found) = (true, true);
            }
        }
        if !found {
            let present: Vec<&str> = records.layers.iter().map(|layer| layer.name.as_str()).collect();
            let message = format!("the drawing has no layer {name}");
            report.push(
                Finding::new(Severity::Fault, "no-layer", message)
                    .help(format!("its layers are {}", present.join(", "))),
            );
        }
    }
    chosen
}

#[cfg(test)]
mod tests;
