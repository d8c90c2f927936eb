//! Printed blocks, carried out by the mock's interpolators and laid against the theoretical outline.
//!
//! **Which block ends an element?** A writer may cut an element in several blocks, and nothing in a 3B program says
//! where an element ends. So the elements' ends are laid on the blocks' ends in order, each on one block, the last on
//! the last, such that the sum of the squared distances is least. That needs no tolerance and no knowledge of how the
//! writer splits. It is never kinder than the best reading of the sequence: if the largest distance in the alignment
//! keeps the promise, then that alignment is a reading which keeps it, in order and to the end. And it cannot pass by
//! laying two ends on one block, or by passing over blocks at the end.

use mock_controller::interpolator::run;
use mock_controller::{Block, Model, parse_block};

use crate::theory::{Element, Point};

pub(crate) const MODELS: [Model; 4] = [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact];

/// A place of the wire, whole µm.
pub(crate) type Place = [i64; 2];

/// A printed program: its blocks, and what came after the last of them.
#[derive(Debug)]
pub(crate) struct Program {
    pub(crate) blocks: Vec<Block>,
    pub(crate) stop: Option<String>,
}

/// Reads a printed program; every line but the last must be a whole block.
pub(crate) fn read(text: &str) -> Program {
    let mut lines: Vec<&str> = text.lines().collect();
    let stop = lines.pop_if(|last| !last.contains('B')).map(str::to_owned);
    let read = |line: &&str| parse_block(line).unwrap_or_else(|wrong| panic!("{line:?}: {wrong}"));
    Program { blocks: lines.iter().map(read).collect(), stop }
}

/// Where the wire stands before the first block and after each.
pub(crate) fn execute(model: Model, blocks: &[Block], start: Place) -> Result<Vec<Place>, String> {
    let [mut x, mut y] = start;
    let mut places = vec![start];
    for (index, block) in blocks.iter().enumerate() {
        let travel = run(model, block, |_, _| {})
            .map_err(|fault| format!("block {} ({block}) under {model:?}: {fault}", index + 1))?;
        x += travel.dx;
        y += travel.dy;
        places.push([x, y]);
    }
    Ok(places)
}

/// Steps of one axis that a program takes.
pub(crate) fn pulses(model: Model, blocks: &[Block]) -> u64 {
    let steps = |block| run(model, block, |_, _| {}).expect("the block can be carried out").pulses;
    blocks.iter().map(steps).sum()
}

/// What a cut should have been.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    /// Where the wire stands at first, whole µm.
    pub(crate) start: Place,
    /// How many of the elements are the lead-in: 0 or 1.
    pub(crate) lead_in: usize,
    pub(crate) elements: Vec<Element>,
}

/// How far a cut lies from what it should have been, by model in the order of [`MODELS`].
#[derive(Debug)]
pub(crate) struct Measured {
    /// The largest distance of an element's end from its theoretical place, µm.
    pub(crate) node_error_um: [f64; 4],
    /// From where the outline began to where it ended, µm.
    pub(crate) closure_um: [f64; 4],
    /// The element each block belongs to.
    pub(crate) element_of_block: Vec<usize>,
}

/// Executes the blocks under all models and lays them against the path. The alignment looks at the `trusted` models
/// only.
pub(crate) fn measure(blocks: &[Block], path: &Path, trusted: &[Model]) -> Result<Measured, String> {
    let mut cuts = Vec::new();
    for model in MODELS {
        cuts.push(execute(model, blocks, path.start)?);
    }
    let trusted: Vec<&Vec<Place>> =
        MODELS.iter().zip(&cuts).filter(|(model, _)| trusted.contains(model)).map(|(_, cut)| cut).collect();
    let last_blocks = align(&path.elements, &trusted)?;

    let mut measured =
        Measured { node_error_um: [0.0; 4], closure_um: [0.0; 4], element_of_block: Vec::new() };
    for (model, cut) in cuts.iter().enumerate() {
        for (element, &block) in path.elements.iter().zip(&last_blocks) {
            let error = point(cut[block]).distance(element.end);
            measured.node_error_um[model] = measured.node_error_um[model].max(error);
        }
        let began = if path.lead_in == 0 { 0 } else { last_blocks[0] };
        measured.closure_um[model] = point(cut[began]).distance(point(cut[cut.len() - 1]));
    }
    for (element, &last) in last_blocks.iter().enumerate() {
        measured.element_of_block.resize(last, element);
    }
    Ok(measured)
}

/// For each element the number of blocks after which it is done.
fn align(elements: &[Element], cuts: &[&Vec<Place>]) -> Result<Vec<usize>, String> {
    let blocks = cuts[0].len() - 1;
    let Some(extra) = blocks.checked_sub(elements.len()) else {
        return Err(format!("{blocks} blocks cannot cut {} elements", elements.len()));
    };
    // cost[d]: the least sum so far if the element at hand is done after d blocks more than elements.
    let mut cost = vec![f64::INFINITY; extra + 1];
    cost[0] = 0.0;
    let mut came_from = Vec::with_capacity(elements.len());
    for (index, element) in elements.iter().enumerate() {
        let mut cheapest = 0;
        let mut next = Vec::with_capacity(extra + 1);
        let mut from = Vec::with_capacity(extra + 1);
        for d in 0..=extra {
            if cost[d] < cost[cheapest] {
                cheapest = d;
            }
            let error =
                cuts.iter().map(|cut| point(cut[index + 1 + d]).distance(element.end)).fold(0.0, f64::max);
            next.push(cost[cheapest] + error * error);
            from.push(cheapest);
        }
        // Before the first element no block is spent.
        cost = next;
        came_from.push(from);
    }
    let mut last_blocks = vec![0; elements.len()];
    let mut d = extra;
    for index in (0..elements.len()).rev() {
        last_blocks[index] = index + 1 + d;
        d = came_from[index][d];
    }
    Ok(last_blocks)
}

/// The largest distance of any pulse from the element it belongs to, µm.
pub(crate) fn largest_deviation_um(
    model: Model,
    blocks: &[Block],
    path: &Path,
    element_of_block: &[usize],
) -> f64 {
    let [mut x, mut y] = path.start;
    let mut largest = 0.0_f64;
    for (block, &element) in blocks.iter().zip(element_of_block) {
        let element = &path.elements[element];
        let travel = run(model, block, |dx, dy| {
            largest = largest.max(element.distance_um(point([x + dx, y + dy])));
        });
        let travel = travel.expect("the block has been carried out before");
        x += travel.dx;
        y += travel.dy;
    }
    largest
}

/// The models named by `--interpolator`.
pub(crate) fn trusted_by(interpolator: &str) -> Vec<Model> {
    match interpolator {
        "any" => MODELS.to_vec(),
        name => MODELS.into_iter().filter(|model| name_of(*model) == name).collect(),
    }
}

pub(crate) fn name_of(model: Model) -> &'static str {
    match model {
        Model::Rotated => "rotated",
        Model::Mirrored => "mirrored",
        Model::Strict => "strict",
        Model::Exact => "exact",
    }
}

/// Whether the cut is what the chosen `--interpolator` promises: under a named model every element's end within 1.05 µm
/// and the outline closed to 0; under `any` every end within 1.5 µm under every model.
pub(crate) fn promise_kept(blocks: &[Block], path: &Path, interpolator: &str) -> Result<Measured, String> {
    let trusted = trusted_by(interpolator);
    let measured = measure(blocks, path, &trusted)?;
    let largest_um = if interpolator == "any" { 1.5 } else { 1.05 };
    for (index, model) in MODELS.into_iter().enumerate() {
        if !trusted.contains(&model) {
            continue;
        }
        let (error, closure) = (measured.node_error_um[index], measured.closure_um[index]);
        if error > largest_um {
            return Err(format!("{interpolator}: under {model:?} a node is {error:.3} µm off"));
        }
        if interpolator != "any" && closure != 0.0 {
            return Err(format!("{interpolator}: under {model:?} the outline closes to {closure:.3} µm"));
        }
    }
    Ok(measured)
}

pub(crate) fn point(place: Place) -> Point {
    #[expect(clippy::cast_precision_loss, reason = "a table is far smaller than 2^52 µm")]
    let [x, y] = place.map(|coordinate| coordinate as f64);
    Point { x, y }
}
