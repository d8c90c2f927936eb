//! A program as a picture: what it says, what the wire takes away, and what a control would really cut.
//!
//! A [`Plot`] sees every motion once, as a check does, and keeps what a page can show: the contours, the ways in and out,
//! rapid moves, start holes, the sense of the cut, some block numbers, and the largest deviation of the simulated cut. The
//! picture is in model millimetres throughout: in the SVG a point of the program stands at (x, −y), each thing in the class of
//! its kind (`nominal wire rapid cut lead-in start`).
//!
//! However long the program is, memory and picture stay bounded; what is thinned says by how much. It reads no file.

mod layer;
mod marks;
mod simulated;

use std::collections::HashSet;
use std::sync::Arc;

use crate::check::contours::{Contours, Held, Run};
use crate::drawing::{Align, Class, Extent, Outline, Picture, Shape, Sketch};
use crate::formats::three_b::Block;
use crate::geometry::{Element, Point, Vector};
use crate::interpolator::{Fault, Model};
use crate::motion::{Act, Motion, Stop, Travel};
use crate::units::Micrometres;

use layer::Layer;
use marks::{Mark, Marks};
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

/// The cuts as they are sorted out.
#[derive(Debug)]
struct Cuts {
    nominal: Layer,
    lead_in: Layer,
    numbers: Marks,
    heads: Marks,
    /// The bounds of the contours.
    part: Option<Extent>,
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
            cuts: Cuts {
                nominal: Layer::new(),
                lead_in: Layer::new(),
                numbers: options.numbers.map_or_else(|| Marks::up_to(NUMBERS_MAX), Marks::every),
                heads: Marks::between(HEADS_MAX),
                part: None,
            },
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
        page.starts(&self.starts);
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

impl Cuts {
    /// Draws what a chain of cuts has come to.
    fn draw(&mut self, run: &Run<'_>) {
        match *run {
            Run::Ring { ring, .. } => {
                let origin = -ring[0].element.start().coords;
                let doubled: f64 =
                    ring.iter().map(|held| held.element.placed(0.0, 1.0, origin).doubled_area()).sum();
                // Numbers stand outside: to the right of a contour that is run counter-clockwise.
                let outside = if doubled > 0.0 { -1.0 } else { 1.0 };
                for held in ring {
                    self.contour(&held.element, held.block, left(&held.element) * outside);
                }
                self.nominal.end_run();
            }
            // Without a ring in its chain a cut is what is to be cut.
            Run::Rest { held, rings: 0, .. } | Run::TooLong(held) => {
                for held in held {
                    self.contour(&held.element, held.block, left(&held.element));
                }
            }
            Run::Retrace(held) | Run::Rest { held, .. } => {
                for held in held {
                    self.lead_in.add(&held.element);
                    self.numbers.offer(mark(&held.element, held.block, left(&held.element)));
                }
            }
        }
    }

    fn contour(&mut self, element: &Element, block: u64, aside: Vector) {
        self.part = Some(grown(self.part, element));
        self.nominal.add(element);
        let mark = mark(element, block, aside);
        self.numbers.offer(mark);
        self.heads.offer(mark);
    }
}

/// Bounds that hold an element too.
fn grown(extent: Option<Extent>, element: &Element) -> Extent {
    let [min, max] = element.extent();
    let own = Extent::between([min.x, min.y], [max.x, max.y]);
    extent.map_or(own, |all| all.united(own))
}

/// The middle of an element, and its direction there.
fn mark(element: &Element, block: u64, aside: Vector) -> Mark {
    Mark { block, at: element.at(0.5), heading: middle_heading(element), aside }
}

fn middle_heading(element: &Element) -> Vector {
    match *element {
        Element::Line { .. } => element.heading_at_start(),
        Element::Arc { end, centre, sense, .. } => {
            Element::Arc { start: element.at(0.5), end, centre, sense }.heading_at_start()
        }
    }
}

fn left(element: &Element) -> Vector {
    let ahead = middle_heading(element);
    Vector::new(-ahead.y, ahead.x)
}

/// The sketch, in model millimetres, with sizes in page millimetres where things have no size of their own.
struct Page {
    pen: f64,
    /// What the program reaches.
    seen: Extent,
    /// What its contours reach.
    part: Extent,
    sketch: Sketch,
}

impl Page {
    /// Draws lines by the class's own pen, or one of so many page millimetres.
    fn lines(&mut self, class: Class, runs: Vec<Outline>, pen: Option<f64>) {
        let width = pen.map(|pen| pen * self.pen);
        self.sketch.extend(runs.into_iter().map(|run| {
            let shape = Shape::path(class, run);
            match width {
                Some(width) => shape.wide(width),
                None => shape,
            }
        }));
    }

    fn wide(&mut self, runs: &[Outline], width: f64) {
        self.sketch.extend(runs.iter().map(|run| Shape::path(Class::Wire, run.clone()).wide(width)));
    }

    fn heads(&mut self, heads: &Marks) {
        for mark in heads.clear_of_each_other(4.0 * HEAD_HALF * self.pen) {
            // The head lies over the middle of its block.
            let tip = mark.at + mark.heading * (HEAD_HALF * self.pen);
            self.sketch.draw(Shape::head(Class::Direction, [tip.x, tip.y], [mark.heading.x, mark.heading.y]));
        }
    }

    fn numbers(&mut self, numbers: &Marks) {
        let height = Class::Label.style().letters;
        for (mark, text, away) in numbers.apart(height, self.pen) {
            let nudge = [mark.aside.x * away, mark.aside.y * away - height / 2.0];
            self.sketch
                .draw(Shape::text(Class::Label, [mark.at.x, mark.at.y], Align::Centre, text).nudged(nudge));
        }
    }

    fn starts(&mut self, starts: &Starts) {
        for at in &starts.marked {
            self.sketch.draw(Shape::start([at.x, at.y]));
        }
        if let [only] = starts.marked[..] {
            let text = Shape::text(Class::Label, [only.x, only.y], Align::Centre, "start");
            self.sketch.draw(text.nudged([0.0, -5.0]));
        }
    }

    /// Width below and height to the left, with the lines they are taken from.
    fn dimensions(&mut self) {
        let Extent { min, max } = self.part;
        let (foot, side) = [1, 0].map(|axis| self.seen.min[axis] - DIMENSION_AWAY * self.pen).into();
        for x in [min[0], max[0]] {
            self.sketch.draw(Shape::line(Class::Dimension, [x, min[1]], [x, foot - self.pen]));
        }
        for y in [min[1], max[1]] {
            self.sketch.draw(Shape::line(Class::Dimension, [min[0], y], [side - self.pen, y]));
        }
        let [width, height] = [self.part.width(), self.part.height()].map(|side| format!("{side:.3}"));
        self.sketch.draw(Shape::dimension([min[0], foot], [max[0], foot], width));
        self.sketch.draw(Shape::dimension([side, min[1]], [side, max[1]], height));
    }

    fn caption(&mut self, wire: Option<f64>, model: Option<Model>) {
        let mut words = vec!["blue: as programmed".to_owned(), "orange: ways in and out".to_owned()];
        if let Some(model) = model {
            words.push(format!("black: pulses of the {} model", model.name()));
        }
        if let Some(width) = wire {
            words.push(format!("wire {width} mm"));
        }
        let at = [self.seen.min[0], self.seen.min[1] - CAPTION_DOWN * self.pen];
        self.sketch.draw(Shape::text(Class::Label, at, Align::Left, words.join(" · ")));
    }

    fn deviation(&mut self, deviation: &Deviation) {
        let pen = self.pen;
        let at = [deviation.at.x, deviation.at.y];
        // In words above or below the part, whichever is nearer.
        let is_above = at[1] >= self.seen.centre()[1];
        let (foot, end, way) = if is_above {
            let foot = self.seen.max[1] + DEVIATION_AWAY * pen;
            (foot, foot - 1.2 * pen, 1.0)
        } else {
            let foot = self.seen.min[1] - DEVIATION_AWAY * pen - Class::Caption.style().letters * pen;
            (foot, foot + (Class::Caption.style().letters + 1.2) * pen, -1.0)
        };
        self.sketch.draw(Shape::circle(Class::Callout, at, RING * pen));
        let line = Shape::line(Class::Callout, [at[0], at[1] + way * RING * pen], [at[0], end]);
        self.sketch.draw(line);
        let text = format!("largest deviation {:.2} µm, block {}", deviation.um, deviation.block);
        self.sketch.draw(Shape::text(Class::Caption, [at[0], foot], Align::Centre, text));
    }

    /// What the picture must show: the part, and what stands around it.
    fn room(&self) -> Extent {
        let Extent { min, max } = self.seen;
        let pen = self.pen;
        Extent {
            min: [min[0] - (DIMENSION_AWAY + 8.0) * pen, min[1] - (CAPTION_DOWN + 1.0) * pen],
            max: [max[0] + 6.0 * pen, max[1] + (DEVIATION_AWAY + 4.0) * pen],
        }
    }
}

/// The pen for what is programmed: broad enough to be seen on both sides of the cut on top.
const NOMINAL_PEN: f64 = 0.5;

/// The same with no cut on top.
const ALONE_PEN: f64 = 0.25;

/// The pen for the simulated cut.
const CUT_PEN: f64 = 0.14;

/// The larger side of the part on paper, millimetres.
const PART_SPAN: f64 = 165.0;

/// From the part to its dimension lines, page millimetres.
const DIMENSION_AWAY: f64 = 13.0;

/// From the part down to the caption's foot line, page millimetres.
const CAPTION_DOWN: f64 = 20.0;

/// From the part to the largest deviation in words, page millimetres.
const DEVIATION_AWAY: f64 = 5.0;

/// The radius of the ring round the largest deviation, page millimetres.
const RING: f64 = 2.2;

/// Half an arrow head, page millimetres.
const HEAD_HALF: f64 = 1.3;

/// Cuts that are held to tell a contour from the ways to it; some 30 MB.
const HELD_MAX: usize = 200_000;

/// The most block numbers when the page decides.
const NUMBERS_MAX: usize = 40;

/// The most arrow heads.
const HEADS_MAX: usize = 16;

/// The most start holes that are marked.
const STARTS_MAX: usize = 2000;

#[cfg(test)]
mod tests;
