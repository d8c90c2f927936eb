//! Pictures out: what is to be cut and what was cut, as SVG and as PNG.
//!
//! A drawing beside a program is the quickest proof that the right part is on the machine. One picture
//! model in millimetres, Y up, serves both outputs, so the file that is printed and the one that is looked at cannot
//! differ: the model is brought down to strokes once, and the two writers only spell those strokes.
//!
//! ```text
//!  Shape ─▶ Sketch ─▶ View ─▶ Picture ──plane──▶ ink (strokes in page millimetres) ─▶ svg
//!  (model mm, Y up)   (window, scale)                                              └▶ png
//! ```
//!
//! Positions and radii are model millimetres; letters, arrow heads, markers and hairlines are page millimetres and
//! keep their size whatever the scale. [`Class`] alone decides how a thing looks.
//!
//! It does not read drawings, measure anything or know where its points come from. Letters are single strokes, as an
//! engraver cuts them, so no font is needed on the machine that draws or on the one that looks.

pub mod contours;
pub mod dxf;
pub mod finding;

mod extent;
mod outline;
mod shape;
mod style;

mod furniture;
mod glyphs;
mod lettering;
mod picture;

mod ink;
mod plane;
mod png;
mod svg;

mod thinning;

pub use extent::Extent;
pub use furniture::{figures, legend};
pub use lettering::text_width;
pub use outline::{Outline, Place, Turn};
pub use picture::{Picture, View, ViewNumber};
pub use png::PngError;
pub use shape::{Align, Shape, Sketch};
pub use style::{Class, Colour, Style};
pub use thinning::Thinning;
