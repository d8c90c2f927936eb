//! A program as a picture: what it says, what the wire takes away, and what a control would really cut.
//!
//! A [`Plot`] sees every motion once, as a check does, and keeps what a page can show: the contours, the ways in and out,
//! rapid moves, start holes, the sense of the cut, some block numbers, and the largest deviation of the simulated cut. The
//! picture is in model millimetres throughout: in the SVG a point of the program stands at (x, −y), each thing in the class of
//! its kind (`nominal wire rapid cut lead-in start`).
//!
//! However long the program is, memory and picture stay bounded; what is thinned says by how much. It reads no file.

mod cuts;
mod layer;
mod marks;
mod page;
mod simulated;

use std::collections::HashSet;
use std::sync::Arc;

use crate::check::contours::{Contours, Held, Run};
use crate::drawing::{Class, Extent, Picture, Sketch};
use crate::formats::three_b::Block;
use crate::geometry::{Element, Point};
use crate::interpolator::{Fault, Model};
use crate::motion::{Act, Motion, Stop, Travel};
use crate::units::Micrometres;

use cuts::{Cuts, grown, left};
use layer::Layer;
use page::{ALONE_PEN, CUT_PEN, NOMINAL_PEN, PART_SPAN, Page};
pub use simulated::Deviation;
use simulated::Simulation;

/// What to draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The picture's title.
    pub title: String,
    /// The diameter of the wire, mm; none draws no wire.
    pub wire: Option<f64>,
    /// A number at every so many blocks; none lets the page decide, 0 writes none.
    pub numbers: Option<u64>,
    /// The model whose pulses are drawn; none simulates nothing.
    pub simulated: Option<Model>,
}

/// A plot in progress.
#[derive(Debug)]
pub struct Plot {
    options: Options,
    contours: Contours,
    cuts: Cuts,
    rapid: Layer,
    /// The wire's own path, where it is not the programmed one.
    wire: Option<Layer>,
    starts: Starts,
    /// The next cut begins a chain.
    is_fresh: bool,
    /// The chain was begun behind a pause of a 3B program.
    is_behind_pause: bool,
    extent: Option<Extent>,
    simulation: Option<Simulation>,
    /// The program is 3B or 4B.
    has_blocks: bool,
}

/// Where the wire is threaded, each place once.
#[derive(Debug, Default)]
struct Starts {
    marked: Vec<Point>,
    seen: HashSet<(i64, i64)>,
    /// The last one is new.
    is_new: bool,
}

impl Starts {
    fn add(&mut self, at: Point) {
        let cell = [at.x, at.y].map(|v| Micrometres::nearest(v).0).into();
        self.is_new = self.marked.len() < STARTS_MAX && self.seen.insert(cell);
        if self.is_new {
            self.marked.push(at);
        }
    }

    /// Takes back the last one, which turned out to be none.
    fn take_back(&mut self, at: Point) {
        if self.is_new && self.marked.last() == Some(&at) {
            self.marked.pop();
            self.seen.remove(&[at.x, at.y].map(|v| Micrometres::nearest(v).0).into());
            self.is_new = false;
        }
    }
}

/// A plot that is done.
#[derive(Clone, Debug)]
#[must_use]
pub struct Plotted {
    /// The picture.
    pub picture: Picture,
    /// The bounds of the contours, mm; none for a program that cuts nothing.
    pub part: Option<Extent>,
    /// The bounds of all moves, mm; none for a program that moves nothing.
    pub extent: Option<Extent>,
    /// Where the simulated cut strays farthest.
    pub deviation: Option<Deviation>,
    /// Pulses simulated.
    pub pulses: u64,
    /// How far what is drawn may be from what was to be drawn, µm; 0 when all of it is drawn as it is.
    pub thinned_um: f64,
    /// Block numbers asked for that found no room.
    pub numbers_left_out: u64,
}

impl Plot {
    /// A plot of nothing yet.
    #[must_use]
    pub fn new(options: Options) -> Self {
        Self {
            contours: Contours::holding(HELD_MAX),
            cuts: Cuts::numbered(options.numbers),
            rapid: Layer::new(),
            wire: None,
            starts: Starts::default(),
            is_fresh: true,
            is_behind_pause: false,
            extent: None,
            simulation: options.simulated.map(Simulation::new),
            has_blocks: false,
            options,
        }
    }

    /// Takes the next motion; with the 3B block it was read from, if it was.
    ///
    /// # Errors
    ///
    /// When the simulated model cannot run the block.
    pub fn see(&mut self, motion: &Motion, block: Option<&Block>) -> Result<(), Fault> {
        match &motion.act {
            Act::Move { travel, element, .. } => {
                self.reach(element);
                if self.is_fresh && *travel == Travel::Cut {
                    self.starts.add(element.start());
                }
                self.is_fresh = *travel == Travel::Rapid;
                if *travel == Travel::Rapid {
                    self.is_behind_pause = false;
                    self.rapid.add(element);
                }
            }
            Act::Offset(_)
            | Act::Taper(_)
            | Act::Stop(_)
            | Act::Dwell(_)
            | Act::Word(_)
            | Act::Unknown(_)
            | Act::Comment(_)
            | Act::Header(_) => {}
        }
        if let (Act::Move { travel: Travel::Cut, element, .. }, Some(simulation), Some(block)) =
            (&motion.act, &mut self.simulation, block)
        {
            simulation.see(block, element, motion.block)?;
        }
        self.sort_out(motion);
        if let Act::Move { travel: Travel::Cut, element, .. } = &motion.act {
            // The cut with which a chain is given up is not among those handed over.
            if self.contours.is_given_up() {
                self.cuts.contour(element, motion.block, left(element));
            }
        }
        // G-code says with a rapid move where the wire is threaded again; 3B has only the pause.
        self.has_blocks |= block.is_some();
        if matches!(motion.act, Act::Stop(Stop::Pause | Stop::End)) && self.has_blocks {
            (self.is_fresh, self.is_behind_pause) = (true, motion.act == Act::Stop(Stop::Pause));
        }
        Ok(())
    }

    /// Draws what has become clear of the chains with a motion.
    fn sort_out(&mut self, motion: &Motion) {
        let is_jump = self.is_behind_pause && motion.act == Act::Stop(Stop::Pause);
        let Self { contours, cuts, simulation, rapid, starts, .. } = self;
        contours.see(motion, Default::default(), Default::default(), &mut |run| {
            match run {
                // One straight way between two pauses: 3B's way to say what G00 says.
                Run::Rest { held: [Held { element: line @ Element::Line { .. }, .. }], rings: 0, .. }
                    if is_jump =>
                {
                    rapid.add(line);
                    starts.take_back(line.start());
                    if let Some(simulation) = simulation {
                        simulation.forget_run();
                    }
                }
                run => cuts.draw(&run),
            }
            if let Some(simulation) = simulation {
                simulation.end_run();
            }
        });
    }

    /// Takes a motion of the wire's own path, where the control sets it off the programmed one.
    pub fn see_wire(&mut self, motion: &Motion) {
        if let Act::Move { travel: Travel::Cut, element, .. } = &motion.act {
            self.wire.get_or_insert_with(Layer::new).add(element);
        }
    }

    /// Takes back what [`Self::see_wire`] was given: the programmed path is the wire's after all, or the best that is known.
    pub fn forget_wire(&mut self) {
        self.wire = None;
    }

    fn reach(&mut self, element: &Element) {
        self.extent = Some(grown(self.extent, element));
    }

    /// Takes the end of the program, and draws.
    pub fn finish(mut self) -> Plotted {
        let Self { contours, cuts, .. } = &mut self;
        contours.finish(&mut |run| cuts.draw(&run));
        let part = self.cuts.part;
        let extent = match (self.extent, self.wire.as_ref().and_then(Layer::extent)) {
            (Some(programmed), Some(wire)) => Some(programmed.united(wire)),
            (programmed, wire) => programmed.or(wire),
        };
        let nothing = Extent { min: [0.0; 2], max: [0.0; 2] };
        let seen = extent.unwrap_or(nothing);
        let pen = seen.width().max(seen.height()).max(0.001) / PART_SPAN;
        let part_or_all = part.unwrap_or(seen);
        // What is written round the part stands clear of the wire.
        let seen = seen.grown(self.options.wire.unwrap_or(0.0) / 2.0);
        let mut page = Page { pen, seen, part: part_or_all, sketch: Sketch::new() };

        let mut thinned_um = 0.0f64;
        let mut runs = |layer: Layer| {
            let (runs, off) = layer.finish();
            thinned_um = thinned_um.max(off);
            runs
        };
        let (nominal, lead_in) = (runs(self.cuts.nominal), runs(self.cuts.lead_in));
        let rapid = runs(self.rapid);
        let wire = self.wire.map(&mut runs);
        if let Some(width) = self.options.wire {
            match &wire {
                Some(path) => page.wide(path, width),
                None => {
                    page.wide(&nominal, width);
                    page.wide(&lead_in, width);
                }
            }
        }
        page.lines(Class::Rapid, rapid, None);
        let pen = self.simulation.as_ref().filter(|s| s.pulses() > 0).map_or(ALONE_PEN, |_| NOMINAL_PEN);
        page.lines(Class::Nominal, nominal, Some(pen));
        page.lines(Class::LeadIn, lead_in, Some(pen));
        let simulated = self.simulation.as_ref().filter(|simulation| simulation.pulses() > 0);
        let model = simulated.map(Simulation::model);
        let deviation = self.simulation.as_ref().and_then(Simulation::largest);
        let pulses = self.simulation.as_ref().map_or(0, Simulation::pulses);
        if let Some(simulation) = self.simulation {
            let (runs, off) = simulation.finish();
            thinned_um = thinned_um.max(off);
            page.lines(Class::Cut, runs, Some(CUT_PEN));
        }
        page.heads(&self.cuts.heads);
        page.numbers(&self.cuts.numbers);
        page.starts(&self.starts.marked);
        if extent.is_some() {
            page.dimensions();
        }
        page.caption(self.options.wire, model);
        if let Some(deviation) = &deviation {
            page.deviation(deviation);
        }
        let room = page.room();
        Plotted {
            picture: Picture::plot(self.options.title, room, [Arc::new(page.sketch)]),
            part,
            extent,
            deviation,
            pulses,
            thinned_um,
            numbers_left_out: self.cuts.numbers.left_out,
        }
    }
}

/// Cuts that are held to tell a contour from the ways to it; some 30 MB.
const HELD_MAX: usize = 200_000;

/// The most start holes that are marked.
const STARTS_MAX: usize = 2000;

#[cfg(test)]
mod tests;
