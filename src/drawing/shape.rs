//! The things that can be drawn, each of one [`Class`].
//!
//! Where a thing is and how large it is on the part is in model millimetres; how large a head, a marker or a letter
//! is stays with the page. A shape knows neither scale nor output.

use super::{Class, Extent, Outline};

/// One thing in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub(super) class: Class,
    pub(super) geometry: Geometry,
    pub(super) width: Option<f64>,
    pub(super) filled: bool,
    pub(super) nudge: [f64; 2],
}

/// Which end of a text stands at its point.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Align {
    /// The text begins at the point.
    Left,
    /// The text is centred on the point.
    Centre,
    /// The text ends at the point.
    Right,
}

impl Align {
    /// How much of the text lies left of its point, 0 to 1.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Left => 0.0,
            Self::Centre => 0.5,
            Self::Right => 1.0,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Geometry {
    Outline(Outline),
    Circle { centre: [f64; 2], radius: f64 },
    Arrow { from: [f64; 2], to: [f64; 2] },
    Dimension { from: [f64; 2], to: [f64; 2], text: String },
    Head { tip: [f64; 2], heading: [f64; 2] },
    Start { at: [f64; 2] },
    Text { at: [f64; 2], align: Align, text: String },
}

/// Shapes in the order they are painted, the first lowest. Positions are model millimetres, Y up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sketch {
    pub(super) shapes: Vec<Shape>,
}

impl Shape {
    /// Draws an outline.
    #[must_use]
    pub fn path(class: Class, outline: Outline) -> Self {
        Self::new(class, Geometry::Outline(outline))
    }

    /// Draws a straight line.
    #[must_use]
    pub fn line(class: Class, from: [f64; 2], to: [f64; 2]) -> Self {
        Self::path(class, Outline::from(from).line_to(to))
    }

    /// Draws a rectangle.
    #[must_use]
    pub fn rectangle(class: Class, extent: Extent) -> Self {
        let Extent { min, max } = extent;
        let corners = Outline::from(min).line_to([max[0], min[1]]).line_to(max).line_to([min[0], max[1]]);
        Self::path(class, corners.closed())
    }

    /// Draws a circle.
    #[must_use]
    pub fn circle(class: Class, centre: [f64; 2], radius: f64) -> Self {
        Self::new(class, Geometry::Circle { centre, radius })
    }

    /// Draws a line with a head at its end.
    #[must_use]
    pub fn arrow(class: Class, from: [f64; 2], to: [f64; 2]) -> Self {
        Self::new(class, Geometry::Arrow { from, to })
    }

    /// Draws a line with a head at either end and its measure in the middle.
    #[must_use]
    pub fn dimension(from: [f64; 2], to: [f64; 2], text: impl Into<String>) -> Self {
        Self::new(Class::Dimension, Geometry::Dimension { from, to, text: text.into() })
    }

    /// Draws a lone arrow head with its tip at a point; the heading may have any length but nought.
    #[must_use]
    pub fn head(class: Class, tip: [f64; 2], heading: [f64; 2]) -> Self {
        Self::new(class, Geometry::Head { tip, heading })
    }

    /// Marks the start point: a ring with a cross through it.
    #[must_use]
    pub fn start(at: [f64; 2]) -> Self {
        Self::new(Class::Start, Geometry::Start { at })
    }

    /// Writes one line of text, its foot line at the point. Inside a view it gets a white
    /// halo and is moved as far as it takes to stay whole; with its point out of sight, it is left out.
    #[must_use]
    pub fn text(class: Class, at: [f64; 2], align: Align, text: impl Into<String>) -> Self {
        Self::new(class, Geometry::Text { at, align, text: text.into() })
    }

    /// Draws with a pen of so many model millimetres, such as the wire at its true width.
    #[must_use]
    pub fn wide(self, millimetres: f64) -> Self {
        Self { width: Some(millimetres), ..self }
    }

    /// Paints the inside of an outline or a circle and leaves out its line.
    #[must_use]
    pub fn filled(self) -> Self {
        Self { filled: true, ..self }
    }

    /// Moves the shape by page millimetres, such as a label off the point that it names.
    #[must_use]
    pub fn nudged(self, page: [f64; 2]) -> Self {
        Self { nudge: page, ..self }
    }

    /// Returns the bounds in model millimetres. Letters, heads and pens have no size in the model and do not count.
    #[must_use]
    pub fn extent(&self) -> Extent {
        match &self.geometry {
            Geometry::Outline(outline) => outline.extent(),
            Geometry::Circle { centre, radius } => Extent::around(*centre, 2.0 * radius, 2.0 * radius),
            Geometry::Arrow { from, to } | Geometry::Dimension { from, to, .. } => {
                Extent::between(*from, *to)
            }
            Geometry::Head { tip: at, .. } | Geometry::Start { at } | Geometry::Text { at, .. } => {
                Extent { min: *at, max: *at }
            }
        }
    }

    fn new(class: Class, geometry: Geometry) -> Self {
        Self { class, geometry, width: None, filled: false, nudge: [0.0, 0.0] }
    }
}

impl Sketch {
    /// An empty sketch.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Paints a shape over those already there.
    pub fn draw(&mut self, shape: Shape) {
        self.shapes.push(shape);
    }

    /// Returns the bounds of all shapes in model millimetres; nothing for an empty sketch.
    #[must_use]
    pub fn extent(&self) -> Option<Extent> {
        self.shapes.iter().map(Shape::extent).reduce(Extent::united)
    }
}

impl Extend<Shape> for Sketch {
    fn extend<T: IntoIterator<Item = Shape>>(&mut self, shapes: T) {
        self.shapes.extend(shapes);
    }
}

impl FromIterator<Shape> for Sketch {
    fn from_iter<T: IntoIterator<Item = Shape>>(shapes: T) -> Self {
        Self { shapes: shapes.into_iter().collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extent_of_a_sketch_holds_all_its_shapes() {
        let mut sketch = Sketch::new();
        assert_eq!(sketch.extent(), None);
        sketch.draw(Shape::circle(Class::Cut, [0.0, 0.0], 2.0));
        sketch.draw(Shape::line(Class::LeadIn, [0.0, 0.0], [5.0, 1.0]));
        assert_eq!(sketch.extent(), Some(Extent::between([-2.0, -2.0], [5.0, 2.0])));
    }
}
