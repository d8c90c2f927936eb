//! The pieces a drawing shows: inserts followed into their blocks, layers that are left out left out, and everything that
//! does not become a piece counted.

use std::collections::BTreeMap;

use crate::drawing::contours::Piece;
use crate::drawing::finding::{Finding, Severity};
use crate::geometry::biarc::Fit;
use crate::geometry::{Element, Path};
use crate::motion::Travel;

use super::entity::{Figure, Insert, Uncut};
use super::placement::Placement;
use super::records::{Entity, LAYER_0, Records};
use super::trace::{TraceError, trace};
use super::write::{RAPID, UPPER};

/// The deepest that blocks may be inserted in blocks.
const DEPTH_MAX: usize = 32;
/// The most entities that inserts may make of a drawing: a guard against arrays in arrays.
const SHOWN_MAX: usize = 4_000_000;

/// What is made of a drawing's records.
pub(super) struct Model<'a> {
    records: &'a Records,
    fit: Fit,
    chosen: Option<Vec<bool>>,
    shown: usize,
    full: bool,
    /// Shown, and not traced yet.
    jobs: Vec<Job<'a>>,
    pub(super) pieces: Vec<Piece>,
    pub(super) report: Vec<Finding>,
    left_out: BTreeMap<(LeftOut, u32), (u64, u64)>,
}

/// An entity to be made into elements.
struct Job<'a> {
    entity: &'a Entity,
    layer: u32,
    placement: Placement,
}

/// Entities traced at a time: a bound of memory.
const JOBS_MAX: usize = 1 << 17;
/// The most threads, and the fewest entities for one.
const THREADS_MAX: usize = 8;
const PART_MIN: usize = 256;

/// Why something was left out, for counting.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
enum LeftOut {
    Uncut(Uncut),
    LayerOff,
    LayerFrozen,
    LayerNotChosen,
    UpperEnd,
    NoLength,
}

impl<'a> Model<'a> {
    pub(super) fn of(records: &'a Records, scale: f64, fit: Fit, chosen: Option<Vec<bool>>) -> Self {
        let mut model = Self {
            records,
            fit,
            chosen,
            shown: 0,
            full: false,
            jobs: Vec::new(),
            pieces: Vec::new(),
            report: Vec::new(),
            left_out: BTreeMap::new(),
        };
        let all = &records.entities[records.model.clone()];
        model.entities(all, &Placement::scaled(scale), None, &mut Vec::new());
        model.trace();
        model.tell_left_out();
        model
    }

    fn entities(
        &mut self,
        entities: &'a [Entity],
        placement: &Placement,
        inherited: Option<u32>,
        inside: &mut Vec<u32>,
    ) {
        for entity in entities {
            self.shown += 1;
            if self.shown > SHOWN_MAX {
                if !self.full {
                    self.full = true;
                    let message = format!("the drawing's inserts show more than {SHOWN_MAX} entities");
                    self.fault(
                        "too-many",
                        message,
                        entity.line,
                        "explode what is to be cut, and delete the rest",
                    );
                }
                return;
            }
            let layer = match (entity.layer, inherited) {
                // Layer 0 in a block is that of the insert.
                (LAYER_0, Some(layer)) => layer,
                (layer, _) => layer,
            };
            if let Figure::Uncut(why) = entity.figure {
                self.count(LeftOut::Uncut(why), layer, entity.line);
                continue;
            }
            let known = &self.records.layers[layer as usize];
            if known.frozen {
                self.count(LeftOut::LayerFrozen, layer, entity.line);
                continue;
            }
            if let Figure::Insert(insert) = &entity.figure {
                self.insert(insert, entity.line, layer, placement, inside);
                continue;
            }
            if known.off {
                self.count(LeftOut::LayerOff, layer, entity.line);
                continue;
            }
            if self.chosen.as_ref().is_some_and(|chosen| !chosen[layer as usize]) {
                self.count(LeftOut::LayerNotChosen, layer, entity.line);
                continue;
            }
            if self.records.in_order && known.name == UPPER {
                self.count(LeftOut::UpperEnd, layer, entity.line);
                continue;
            }
            self.jobs.push(Job { entity, layer, placement: *placement });
            if self.jobs.len() >= JOBS_MAX {
                self.trace();
            }
        }
    }

    /// Makes pieces of what has been shown, in its order, on as many processors as there are.
    fn trace(&mut self) {
        let jobs = std::mem::take(&mut self.jobs);
        let fit = self.fit;
        let work = |part: &[Job<'_>]| -> Vec<Result<Vec<Element>, TraceError>> {
            part.iter().map(|job| trace(&job.entity.figure, &job.placement, &fit)).collect()
        };
        let processors = std::thread::available_parallelism().map_or(1, |count| count.get().min(THREADS_MAX));
        let (here, others) = jobs.split_at(jobs.len().div_ceil(processors).max(PART_MIN).min(jobs.len()));
        let parts = others.chunks(here.len().max(1));
        let traced = std::thread::scope(|scope| {
            let threads: Vec<_> = parts.map(|part| scope.spawn(|| work(part))).collect();
            let mut traced = vec![work(here)];
            traced.extend(threads.into_iter().map(|thread| match thread.join() {
                Ok(part) => part,
                Err(panic) => std::panic::resume_unwind(panic),
            }));
            traced
        });
        for (job, traced) in jobs.iter().zip(traced.into_iter().flatten()) {
            self.piece(job.entity, job.layer, traced);
        }
    }

    fn piece(&mut self, entity: &Entity, layer: u32, traced: Result<Vec<Element>, TraceError>) {
        let elements = match traced {
            Ok(elements) => elements,
            Err(error) => {
                let kind = name_of(&entity.figure);
                let name = &self.records.layers[layer as usize].name;
                let help = match error {
                    TraceError::FitPoints(_) => {
                        "which curve runs through them depends on the program that drew it: save the spline with its \
                         control points, or as polyline arcs"
                    }
                    TraceError::Tilted => "turn it into the XY plane",
                    _ => "repair it in the program that drew it, or delete it",
                };
                let message = format!("a {kind} on layer {name} cannot be cut: {error}");
                self.fault("unusable", message, entity.line, help);
                return;
            }
        };
        if elements.is_empty() {
            self.count(LeftOut::NoLength, layer, entity.line);
            return;
        }
        debug_assert!(Path::new(elements.clone()).is_some(), "{elements:?}");
        let travel = if self.records.in_order && self.records.layers[layer as usize].name == RAPID {
            Travel::Rapid
        } else {
            Travel::Cut
        };
        self.pieces.push(Piece { elements, layer, line: entity.line, travel, clockwise: entity.clockwise });
    }

    fn insert(
        &mut self,
        insert: &Insert,
        line: u64,
        layer: u32,
        placement: &Placement,
        inside: &mut Vec<u32>,
    ) {
        let records = self.records;
        let block = &records.blocks[insert.block as usize];
        if !block.defined {
            let message = format!("block {} is inserted, and the drawing has none of that name", block.name);
            self.fault("no-block", message, line, "bind external references into the drawing");
            return;
        }
        if inside.contains(&insert.block) {
            let message = format!("block {} is inserted in itself", block.name);
            self.fault("block-in-itself", message, line, "take the insert out of the block");
            return;
        }
        if inside.len() >= DEPTH_MAX {
            let message = format!("blocks are inserted in blocks more than {DEPTH_MAX} deep");
            self.fault("too-deep", message, line, "explode the inner ones");
            return;
        }
        if insert.scale.contains(&0.0) {
            let message = format!("block {} is inserted at a scale of 0", block.name);
            self.fault("unusable", message, line, "repair the insert");
            return;
        }
        if insert.columns < 0 || insert.rows < 0 {
            let (columns, rows) = (insert.columns, insert.rows);
            let message = format!("block {} is inserted in {columns} columns and {rows} rows", block.name);
            self.fault("unusable", message, line, "repair the insert");
            return;
        }
        let entities = &records.entities[block.entities.clone()];
        inside.push(insert.block);
        for row in 0..insert.rows.max(1) {
            for column in 0..insert.columns.max(1) {
                self.shown += 1;
                if self.full {
                    break;
                }
                match placement.inserted(insert, block.base, [column, row]) {
                    Some(inner) if inner.is_finite() => self.entities(entities, &inner, Some(layer), inside),
                    Some(_) => {
                        let message =
                            format!("block {} is inserted with numbers that are too large", block.name);
                        self.fault("unusable", message, line, "repair the insert");
                        inside.pop();
                        return;
                    }
                    None => {
                        let message = format!("block {} is inserted in a tilted plane", block.name);
                        self.fault("unusable", message, line, "turn it into the XY plane");
                        inside.pop();
                        return;
                    }
                }
                // An empty block makes no entity that would be counted.
                if self.shown > SHOWN_MAX && !self.full {
                    self.full = true;
                    let message = format!("the drawing's inserts show more than {SHOWN_MAX} entities");
                    self.fault("too-many", message, line, "explode what is to be cut, and delete the rest");
                }
            }
        }
        inside.pop();
    }

    fn fault(&mut self, code: &'static str, message: String, line: u64, help: &'static str) {
        self.report.push(Finding::new(Severity::Fault, code, message).help(help).line(line));
    }

    fn count(&mut self, why: LeftOut, layer: u32, line: u64) {
        let (count, first) = self.left_out.entry((why, layer)).or_insert((0, line));
        *count += 1;
        *first = (*first).min(line);
    }

    fn tell_left_out(&mut self) {
        for (&(why, layer), &(count, line)) in &self.left_out {
            let name = &self.records.layers[layer as usize].name;
            let (many, are) = if count == 1 { ("entity", "is") } else { ("entities", "are") };
            let (severity, code, message) = match why {
                LeftOut::Uncut(Uncut::Kind(kind)) => {
                    let kind = &self.records.kinds[kind as usize];
                    let severity = if is_lettering(kind) { Severity::Note } else { Severity::Warning };
                    (severity, "not-cut", format!("{count} {kind} on layer {name} {are} not cut"))
                }
                LeftOut::Uncut(Uncut::Mesh) => {
                    let meshes = if count == 1 { "mesh" } else { "meshes" };
                    let message = format!("{count} POLYLINE {meshes} on layer {name} {are} not cut");
                    (Severity::Warning, "not-cut", message)
                }
                LeftOut::Uncut(Uncut::Invisible) => {
                    let message = format!("{count} invisible {many} on layer {name} {are} left out");
                    (Severity::Note, "invisible", message)
                }
                LeftOut::Uncut(Uncut::Paper) => {
                    let message = format!("{count} {many} of a paper sheet on layer {name} {are} left out");
                    (Severity::Note, "paper", message)
                }
                LeftOut::LayerOff => {
                    let message = format!("layer {name} is off: {count} {many} {are} left out");
                    (Severity::Note, "layer-off", message)
                }
                LeftOut::LayerFrozen => {
                    let message = format!("layer {name} is frozen: {count} {many} {are} left out");
                    (Severity::Note, "layer-frozen", message)
                }
                LeftOut::LayerNotChosen => {
                    let message = format!("layer {name} is not chosen: {count} {many} {are} left out");
                    (Severity::Note, "layer-not-chosen", message)
                }
                LeftOut::UpperEnd => {
                    let message = format!(
                        "the ways of the wire's upper end, {count} {many} on layer {name}, {are} left out"
                    );
                    (Severity::Warning, "upper-end", message)
                }
                LeftOut::NoLength => {
                    let message = format!("{count} {many} without length on layer {name} {are} left out");
                    (Severity::Warning, "no-length", message)
                }
            };
            self.report.push(Finding::new(severity, code, message).line(line));
        }
    }
}

/// Kinds that are for the eye: what they say is not lost by not cutting them.
fn is_lettering(kind: &str) -> bool {
    matches!(
        kind,
        "TEXT"
            | "MTEXT"
            | "RTEXT"
            | "ARCALIGNEDTEXT"
            | "ATTDEF"
            | "ATTRIB"
            | "DIMENSION"
            | "ARC_DIMENSION"
            | "LARGE_RADIAL_DIMENSION"
            | "LEADER"
            | "MULTILEADER"
            | "MLEADER"
            | "TOLERANCE"
            | "HATCH"
            | "POINT"
            | "VIEWPORT"
            | "IMAGE"
            | "WIPEOUT"
            | "OLEFRAME"
            | "OLE2FRAME"
            | "ACAD_TABLE"
    )
}

fn name_of(figure: &Figure) -> &'static str {
    match figure {
        Figure::Line { .. } => "LINE",
        Figure::Arc { .. } => "ARC",
        Figure::Circle { .. } => "CIRCLE",
        Figure::Ellipse { .. } => "ELLIPSE",
        Figure::Polyline { .. } => "POLYLINE",
        Figure::Spline(_) => "SPLINE",
        Figure::Insert(_) => "INSERT",
        Figure::Uncut(_) => "entity",
    }
}
