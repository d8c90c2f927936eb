//! Ink as PNG, anti-aliased on white paper.
//!
//! The same marks as in the SVG, painted by `tiny-skia`. It makes no promise about the bytes: another version of the
//! painter may round the edge of a line differently.

use tiny_skia::{
    FillRule, LineCap, LineJoin, Mask, Paint as Ink, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};

use super::ink::{Group, Mark, Paint, Step};
use super::outline::Arc;
use super::{Class, Colour, Extent, Picture};

/// Why there is no PNG.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The image would have no pixels, or too many.
    #[error("an image of {wide} by {high} pixels cannot be drawn; the limit is {PIXELS_MAX} pixels in all")]
    Size {
        /// Pixels wide, as asked for.
        wide: u32,
        /// Pixels high, as follows from the paper.
        high: u64,
    },
    /// The image was drawn and could not be packed.
    #[error("the image cannot be packed as PNG: {reason}")]
    Packing {
        /// What the packer said.
        reason: String,
    },
}

/// The most pixels of an image: A3 at 600 dots per inch, some 280 megabytes while it is drawn.
pub(super) const PIXELS_MAX: u64 = 70_000_000;

/// Finer lines than this many pixels would fade away.
const PEN_LEAST: f32 = 0.7;

/// Paints the whole picture.
pub(super) fn write(picture: &Picture, groups: &[Group], pixels_wide: u32) -> Result<Vec<u8>, PngError> {
    let paper = picture.paper;
    let per_unit = f64::from(pixels_wide) / paper.width();
    let high = (paper.height() * per_unit).round().max(1.0) as u64;
    let refused = PngError::Size { wide: pixels_wide, high };
    if u64::from(pixels_wide).saturating_mul(high) > PIXELS_MAX {
        return Err(refused);
    }
    let image = u32::try_from(high).ok().and_then(|high| Pixmap::new(pixels_wide, high));
    let mut easel = match image {
        Some(image) => Easel { image, corner: [paper.min[0], paper.max[1]], per_unit, pen: picture.pen },
        None => return Err(refused),
    };
    easel.image.fill(colour(Class::Paper.style().colour));
    for group in groups {
        let mask = group.clip.and_then(|clip| easel.mask(&clip));
        for mark in &group.marks {
            easel.paint(mark, mask.as_ref());
        }
    }
    easel.image.encode_png().map_err(|error| PngError::Packing { reason: error.to_string() })
}

struct Easel {
    image: Pixmap,
    /// The paper's upper left corner.
    corner: [f64; 2],
    per_unit: f64,
    pen: f64,
}

impl Easel {
    fn paint(&mut self, mark: &Mark, mask: Option<&Mask>) {
        let style = mark.class.style();
        let mut ink = Ink { anti_alias: true, ..Ink::default() };
        ink.set_color(colour(style.colour));
        let Some(path) = self.path(&mark.steps) else {
            return; // Nothing but a move, such as a text of spaces.
        };
        let width = match mark.paint {
            Paint::Solid => {
                return self.image.fill_path(&path, &ink, FillRule::EvenOdd, Transform::identity(), mask);
            }
            Paint::Line => style.pen * self.pen,
            Paint::Wide(width) => width,
        };
        let dash = style.dash.and_then(|lengths| {
            StrokeDash::new(lengths.map(|length| self.pixels(length * self.pen)).to_vec(), 0.0)
        });
        let stroke = Stroke {
            width: self.pixels(width).max(PEN_LEAST),
            line_cap: if dash.is_some() { LineCap::Butt } else { LineCap::Round },
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        self.image.stroke_path(&path, &ink, &stroke, Transform::identity(), mask);
    }

    fn mask(&self, clip: &Extent) -> Option<Mask> {
        let mut mask = Mask::new(self.image.width(), self.image.height())?;
        let corners = [clip.min, [clip.max[0], clip.min[1]], clip.max, [clip.min[0], clip.max[1]]];
        let mut steps = vec![Step::Move(corners[0])];
        steps.extend(corners[1..].iter().map(|corner| Step::Line(*corner)));
        steps.push(Step::Close);
        mask.fill_path(&self.path(&steps)?, FillRule::Winding, true, Transform::identity());
        Some(mask)
    }

    fn path(&self, steps: &[Step]) -> Option<Path> {
        let mut path = PathBuilder::new();
        let mut here = [0.0, 0.0];
        for step in steps {
            match *step {
                Step::Move(to) => {
                    let [x, y] = self.point(to);
                    path.move_to(x, y);
                }
                Step::Line(to) => {
                    let [x, y] = self.point(to);
                    path.line_to(x, y);
                }
                Step::Curve { controls, to } => self.curve(&mut path, controls, to),
                Step::Arc { to, centre, turn } => {
                    for quarter in (Arc { from: here, to, centre, turn }).quarters() {
                        self.curve(&mut path, quarter.controls(), quarter.to);
                    }
                }
                Step::Close => path.close(),
            }
            here = step.end().unwrap_or(here);
        }
        path.finish()
    }

    fn curve(&self, path: &mut PathBuilder, controls: [[f64; 2]; 2], to: [f64; 2]) {
        let [[ax, ay], [bx, by], [x, y]] = [controls[0], controls[1], to].map(|point| self.point(point));
        path.cubic_to(ax, ay, bx, by, x, y);
    }

    fn point(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        [self.pixels(x - self.corner[0]), self.pixels(self.corner[1] - y)]
    }

    /// The painter counts in `f32`; a page's worth of pixels has thousandths of a pixel to spare.
    fn pixels(&self, length: f64) -> f32 {
        (length * self.per_unit) as f32
    }
}

fn colour(colour: Colour) -> tiny_skia::Color {
    let [_, red, green, blue] = colour.rgb.to_be_bytes();
    let opacity = u32::from(colour.opacity_percent.min(100)) * 255 / 100;
    tiny_skia::Color::from_rgba8(red, green, blue, u8::try_from(opacity).unwrap_or(u8::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Shape, Sketch, View};
    use std::sync::Arc as Shared;

    #[test]
    fn the_height_follows_from_the_paper() {
        let image = painted(&Picture::page("empty", 297.0, 210.0), 594);
        assert_eq!((image.width(), image.height()), (594, 420));
        assert!(image.pixels().iter().all(|pixel| (pixel.red(), pixel.alpha()) == (255, 255)));
    }

    #[test]
    fn an_image_without_pixels_or_with_too_many_is_refused() {
        let page = Picture::page("empty", 297.0, 210.0);
        assert!(matches!(page.to_png(0), Err(PngError::Size { wide: 0, .. })));
        let error = page.to_png(20_000).expect_err("too large");
        assert_eq!(
            error.to_string(),
            "an image of 20000 by 14141 pixels cannot be drawn; the limit is 70000000 pixels in all"
        );
    }

    #[test]
    fn up_in_the_model_is_up_in_the_image() {
        let mut page = Picture::page("dot", 10.0, 10.0);
        page.draw(Shape::circle(Class::Cut, [2.0, 9.0], 1.0).filled());
        let image = painted(&page, 100);
        assert!(is_dark(&image, 20, 10) && !is_dark(&image, 20, 90));
    }

    #[test]
    fn a_view_is_clipped_at_its_edge() {
        let thick =
            Shared::new(Sketch::from_iter([Shape::line(Class::Cut, [-9.0, 0.0], [9.0, 0.0]).wide(2.0)]));
        let mut page = Picture::page("clip", 10.0, 10.0);
        let view = View::new(Extent::around([5.0, 5.0], 4.0, 4.0), Extent::around([0.0, 0.0], 4.0, 4.0));
        page.place(view.unframed().without_scale_bar().showing(&thick));
        let image = painted(&page, 100);
        assert!(is_dark(&image, 31, 50) && is_dark(&image, 68, 50));
        assert!(!is_dark(&image, 28, 50) && !is_dark(&image, 71, 50));
    }

    fn painted(picture: &Picture, wide: u32) -> Pixmap {
        Pixmap::decode_png(&picture.to_png(wide).expect("a picture")).expect("a PNG")
    }

    fn is_dark(image: &Pixmap, x: u32, y: u32) -> bool {
        image.pixel(x, y).expect("inside the image").red() < 128
    }
}
