//! What stands around the drawing: scale bars, tables of figures and legends.
//!
//! A reader takes sizes off a picture by its scale bar, so the bar has a round length. Tables and legends come as
//! sketches in page millimetres, to be drawn on the page. None of it measures the part.

use super::{Align, Class, Shape, Sketch};

/// A bar of round length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScaleBar {
    pub(super) micrometres: u64,
    /// Its length on the paper.
    pub(super) length: f64,
}

impl ScaleBar {
    /// Chooses the longest of 1, 2, 5, 10, 20, 50 … µm that fits `room` on paper, at `scale` paper per model.
    ///
    /// When not even a micrometre fits, it is a micrometre all the same.
    pub(super) fn within(room: f64, scale: f64) -> Self {
        let on_paper = |micrometres: u64| micrometres as f64 / 1000.0 * scale;
        let micrometres = (0..DECADES)
            .flat_map(|decade| [1, 2, 5].map(|first| first * 10_u64.pow(decade)))
            .take_while(|&micrometres| on_paper(micrometres) <= room)
            .last()
            .unwrap_or(1);
        Self { micrometres, length: on_paper(micrometres) }
    }

    /// The length in words, in millimetres from one millimetre on.
    pub(super) fn label(&self) -> String {
        match self.micrometres {
            short @ ..1000 => format!("{short} µm"),
            long => format!("{} mm", long / 1000),
        }
    }
}

/// Powers of ten from a micrometre up that a scale bar may have; the longest bar is 5 km.
const DECADES: u32 = 10;

/// Writes a table of names and figures from its upper left corner, each row over a thin rule.
#[must_use]
pub fn figures<N: AsRef<str>, F: AsRef<str>>(corner: [f64; 2], width: f64, rows: &[(N, F)]) -> Sketch {
    let mut sketch = Sketch::new();
    let [left, mut foot] = corner;
    for (name, figure) in rows {
        foot -= ROW;
        sketch.draw(Shape::text(Class::Label, [left, foot + LIFT], Align::Left, name.as_ref()));
        sketch.draw(Shape::text(Class::Caption, [left + width, foot + LIFT], Align::Right, figure.as_ref()));
        sketch.draw(Shape::line(Class::Frame, [left, foot], [left + width, foot]));
    }
    sketch
}

/// Writes a legend from its upper left corner: a sample of each class and what it stands for.
#[must_use]
pub fn legend<N: AsRef<str>>(corner: [f64; 2], entries: &[(Class, N)]) -> Sketch {
    let mut sketch = Sketch::new();
    let [left, mut foot] = corner;
    for (class, name) in entries {
        foot -= ROW;
        let middle = foot + LIFT + class.style().letters / 2.0;
        let centre = [left + SAMPLE / 2.0, middle];
        let cap = class.style().pen / 2.0;
        let line = Shape::line(*class, [left + cap, middle], [left + SAMPLE - cap, middle]);
        match class {
            Class::Start => sketch.draw(Shape::start(centre)),
            Class::Direction => sketch.draw(Shape::head(*class, [centre[0] + 1.3, middle], [1.0, 0.0])),
            Class::Part => sketch.draw(line.wide(SWATCH)),
            Class::Paper
            | Class::Wire
            | Class::Nominal
            | Class::Rapid
            | Class::Cut
            | Class::LeadIn
            | Class::Dimension
            | Class::Callout
            | Class::Frame
            | Class::ScaleBar
            | Class::Title
            | Class::Heading
            | Class::Caption
            | Class::Label => sketch.draw(line),
        }
        let at = [left + SAMPLE + SAMPLE_GAP, foot + LIFT];
        sketch.draw(Shape::text(Class::Label, at, Align::Left, name.as_ref()));
    }
    sketch
}

/// Height of a row of a table or legend, page millimetres.
const ROW: f64 = 5.6;

/// The letters' foot line above the row's rule.
const LIFT: f64 = 1.6;

/// Length of a legend's sample.
const SAMPLE: f64 = 10.0;

/// From the sample to its name.
const SAMPLE_GAP: f64 = 3.5;

/// How wide a sample of a surface is.
const SWATCH: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_bar_is_the_longest_round_length_that_fits() {
        for (room, scale, expected) in [
            (30.0, 10.0, "2 mm"),
            (49.9, 10.0, "2 mm"),
            (50.0, 10.0, "5 mm"),
            (30.0, 100.0, "200 µm"),
            (30.0, 1.0, "20 mm"),
            (30.0, 0.03, "1000 mm"),
            (30.0, 1e6, "1 µm"),
        ] {
            assert_eq!(ScaleBar::within(room, scale).label(), expected, "{room} at {scale}");
        }
    }

    #[test]
    fn a_scale_bar_is_drawn_as_long_as_it_says() {
        let bar = ScaleBar::within(30.0, 8.0);
        assert_eq!((bar.micrometres, bar.length), (2000, 16.0));
    }

    #[test]
    fn a_table_stays_between_its_edges() {
        let table = figures([10.0, 50.0], 60.0, &[("blocks", "1 234"), ("cut", "56.7 mm")]);
        let extent = table.extent().expect("rows");
        assert_eq!((extent.min[0], extent.max[0]), (10.0, 70.0));
        assert_eq!(extent.min[1], 50.0 - 2.0 * ROW);
    }
}
