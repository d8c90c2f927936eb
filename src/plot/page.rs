//! The page a plot is drawn on: what stands where round the part, and with what pen.
//!
//! It is in model millimetres, with sizes in page millimetres where things have no size of their own. What is drawn is
//! decided in the plot.

use super::marks::Marks;
use super::simulated::Deviation;
use crate::drawing::{Align, Class, Extent, Outline, Shape, Sketch};
use crate::geometry::Point;
use crate::interpolator::Model;

/// The sketch, in model millimetres, with sizes in page millimetres where things have no size of their own.
pub(super) struct Page {
    pub(super) pen: f64,
    /// What the program reaches.
    pub(super) seen: Extent,
    /// What its contours reach.
    pub(super) part: Extent,
    pub(super) sketch: Sketch,
}

impl Page {
    /// Draws lines by the class's own pen, or one of so many page millimetres.
    pub(super) fn lines(&mut self, class: Class, runs: Vec<Outline>, pen: Option<f64>) {
        let width = pen.map(|pen| pen * self.pen);
        self.sketch.extend(runs.into_iter().map(|run| {
            let shape = Shape::path(class, run);
            match width {
                Some(width) => shape.wide(width),
                None => shape,
            }
        }));
    }

    pub(super) fn wide(&mut self, runs: &[Outline], width: f64) {
        self.sketch.extend(runs.iter().map(|run| Shape::path(Class::Wire, run.clone()).wide(width)));
    }

    pub(super) fn heads(&mut self, heads: &Marks) {
        for mark in heads.clear_of_each_other(4.0 * HEAD_HALF * self.pen) {
            // The head lies over the middle of its block.
            let tip = mark.at + mark.heading * (HEAD_HALF * self.pen);
            self.sketch.draw(Shape::head(Class::Direction, [tip.x, tip.y], [mark.heading.x, mark.heading.y]));
        }
    }

    pub(super) fn numbers(&mut self, numbers: &Marks) {
        let height = Class::Label.style().letters;
        for (mark, text, away) in numbers.apart(height, self.pen) {
            let nudge = [mark.aside.x * away, mark.aside.y * away - height / 2.0];
            self.sketch
                .draw(Shape::text(Class::Label, [mark.at.x, mark.at.y], Align::Centre, text).nudged(nudge));
        }
    }

    pub(super) fn starts(&mut self, starts: &[Point]) {
        for at in starts {
            self.sketch.draw(Shape::start([at.x, at.y]));
        }
        if let [only] = starts {
            let text = Shape::text(Class::Label, [only.x, only.y], Align::Centre, "start");
            self.sketch.draw(text.nudged([0.0, -5.0]));
        }
    }

    /// Width below and height to the left, with the lines they are taken from.
    pub(super) fn dimensions(&mut self) {
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

    pub(super) fn caption(&mut self, wire: Option<f64>, model: Option<Model>) {
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

    pub(super) fn deviation(&mut self, deviation: &Deviation) {
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
    pub(super) fn room(&self) -> Extent {
        let Extent { min, max } = self.seen;
        let pen = self.pen;
        Extent {
            min: [min[0] - (DIMENSION_AWAY + 8.0) * pen, min[1] - (CAPTION_DOWN + 1.0) * pen],
            max: [max[0] + 6.0 * pen, max[1] + (DEVIATION_AWAY + 4.0) * pen],
        }
    }
}

/// The pen for what is programmed: broad enough to be seen on both sides of the cut on top.
pub(super) const NOMINAL_PEN: f64 = 0.5;

/// The same with no cut on top.
pub(super) const ALONE_PEN: f64 = 0.25;

/// The pen for the simulated cut.
pub(super) const CUT_PEN: f64 = 0.14;

/// The larger side of the part on paper, millimetres.
pub(super) const PART_SPAN: f64 = 165.0;

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
