//! A page, or a single plot, with views on it.
//!
//! A [`Picture`] is paper in millimetres. Each [`View`] is a rectangle on it that shows a window of model space at its
//! own scale, clipped, with a title above and a scale bar below; one view may enlarge a region of another. What
//! belongs to the page itself, such as a table of figures, is drawn straight onto it.
//!
//! It lays nothing out by itself: the caller says where each view and each line of text stands.

use std::sync::Arc;

use super::furniture::ScaleBar;
use super::ink::{Group, ink};
use super::png::{self, PngError};
use super::{Extent, Shape, Sketch, svg};

/// Paper with views on it.
#[derive(Clone, Debug)]
pub struct Picture {
    pub(super) title: String,
    pub(super) paper: Extent,
    /// Picture units per page millimetre: 1 on a page, the enlargement undone on a plot in model millimetres.
    pub(super) pen: f64,
    pub(super) views: Vec<View>,
    pub(super) sheet: Sketch,
}

/// A rectangle of the page that shows a window of model space.
#[derive(Clone, Debug)]
pub struct View {
    area: Extent,
    window: Extent,
    pub(super) title: Option<String>,
    pub(super) framed: bool,
    scaled: bool,
    pub(super) enlarges: Option<ViewNumber>,
    pub(super) sketches: Vec<Arc<Sketch>>,
}

/// A view of the picture that gave out the number.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct ViewNumber(pub(super) usize);

impl Picture {
    /// Begins a page of the given size; the origin is its lower left corner.
    #[must_use]
    pub fn page(title: impl Into<String>, width: f64, height: f64) -> Self {
        let paper = Extent::sized([0.0, 0.0], width, height);
        Self { title: title.into(), paper, pen: 1.0, views: Vec::new(), sheet: Sketch::new() }
    }

    /// Shows a window of model space and nothing else: one view with a scale bar, in model millimetres throughout.
    ///
    /// Letters, heads and hairlines are as large as on paper 200 mm across. In the SVG a point of the model stands at
    /// `(x, -y)`.
    #[must_use]
    pub fn plot(
        title: impl Into<String>,
        window: Extent,
        sketches: impl IntoIterator<Item = Arc<Sketch>>,
    ) -> Self {
        let window = with_a_size(window);
        let pen = window.width().max(window.height()) / PLOT_SPAN;
        let field = window.grown(PLOT_MARGIN * pen);
        let mut view = View::new(field, field).unframed();
        view.area.min[1] -= SCALE_STRIP * pen;
        view.sketches.extend(sketches);
        let paper = view.area.grown(PAPER_MARGIN * pen);
        Self { title: title.into(), paper, pen, views: vec![view], sheet: Sketch::new() }
    }

    /// Puts a view on the page, over those already there.
    pub fn place(&mut self, view: View) -> ViewNumber {
        let known = view.enlarges.is_none_or(|ViewNumber(overview)| overview < self.views.len());
        assert!(known, "a view enlarges one that is already on its page");
        self.views.push(view);
        ViewNumber(self.views.len() - 1)
    }

    /// Draws on the page itself, over all views, in page millimetres.
    pub fn draw(&mut self, shape: Shape) {
        self.sheet.draw(shape);
    }

    /// Draws all shapes of a sketch on the page itself.
    pub fn draw_all(&mut self, sketch: Sketch) {
        self.sheet.extend(sketch.shapes);
    }

    /// Returns the picture as SVG, one user unit a millimetre; equal pictures give equal text on every platform.
    #[must_use]
    pub fn to_svg(&self) -> String {
        svg::write(self, &self.groups())
    }

    /// Returns the picture as PNG of the given width; the height follows from the paper.
    ///
    /// # Errors
    ///
    /// Refuses a width that makes no image or one beyond the limit on size.
    pub fn to_png(&self, pixels_wide: u32) -> Result<Vec<u8>, PngError> {
        png::write(self, &self.groups(), pixels_wide)
    }

    pub(super) fn groups(&self) -> Vec<Group> {
        ink(self)
    }
}

impl View {
    /// Shows `window` of model space in `area` of the page, framed and with a scale bar.
    ///
    /// The window is fitted whole and centred; where the proportions differ, more than the window is seen.
    #[must_use]
    pub fn new(area: Extent, window: Extent) -> Self {
        Self {
            area,
            window: with_a_size(window),
            title: None,
            framed: true,
            scaled: true,
            enlarges: None,
            sketches: Vec::new(),
        }
    }

    /// Writes a heading above the view.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: Some(title.into()), ..self }
    }

    /// Leaves out the frame.
    #[must_use]
    pub fn unframed(self) -> Self {
        Self { framed: false, ..self }
    }

    /// Leaves out the scale bar.
    #[must_use]
    pub fn without_scale_bar(self) -> Self {
        Self { scaled: false, ..self }
    }

    /// Marks in another view the region that this one shows, and joins the two.
    #[must_use]
    pub fn enlarging(self, overview: ViewNumber) -> Self {
        Self { enlarges: Some(overview), ..self }
    }

    /// Shows a sketch, over those already shown. Views may share one.
    #[must_use]
    pub fn showing(mut self, sketch: &Arc<Sketch>) -> Self {
        self.sketches.push(Arc::clone(sketch));
        self
    }

    /// Page millimetres for one model millimetre, on a page.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale_at(1.0)
    }

    /// Where the view's field lies on the page: its area without the strips for title and scale bar.
    #[must_use]
    pub fn field(&self) -> Extent {
        self.field_at(1.0)
    }

    /// The region of model space that is seen.
    #[must_use]
    pub fn region(&self) -> Extent {
        self.region_at(1.0)
    }

    pub(super) fn region_at(&self, pen: f64) -> Extent {
        let (field, scale) = (self.field_at(pen), self.scale_at(pen));
        Extent::around(self.window.centre(), field.width() / scale, field.height() / scale)
    }

    pub(super) fn field_at(&self, pen: f64) -> Extent {
        let mut field = self.area;
        if self.title.is_some() {
            field.max[1] -= TITLE_STRIP * pen;
        }
        if self.scaled {
            field.min[1] += SCALE_STRIP * pen;
        }
        field
    }

    pub(super) fn scale_at(&self, pen: f64) -> f64 {
        let field = self.field_at(pen);
        (field.width() / self.window.width()).min(field.height() / self.window.height())
    }

    pub(super) fn window_centre(&self) -> [f64; 2] {
        self.window.centre()
    }

    pub(super) fn scale_bar(&self, pen: f64) -> Option<ScaleBar> {
        self.scaled
            .then(|| ScaleBar::within(self.field_at(pen).width() * SCALE_BAR_SHARE, self.scale_at(pen)))
    }
}

/// The page is taken to be this wide or high when a plot's letters and pens are sized, millimetres.
const PLOT_SPAN: f64 = 200.0;

/// Room around a plot's window for what has no size in the model, page millimetres.
const PLOT_MARGIN: f64 = 6.0;

/// White around a plot, page millimetres.
const PAPER_MARGIN: f64 = 4.0;

/// What a heading takes off the top of a view, page millimetres.
const TITLE_STRIP: f64 = 6.5;

/// What a scale bar takes off the bottom of a view, page millimetres.
const SCALE_STRIP: f64 = 6.0;

/// The most of the field's width that a scale bar takes.
const SCALE_BAR_SHARE: f64 = 0.3;

/// The least side of a window, millimetres: a micrometre, for nothing on these machines is smaller.
const WINDOW_LEAST: f64 = 0.001;

/// A straight cut has no height; it gets some, so that there is a scale to draw it at.
fn with_a_size(window: Extent) -> Extent {
    let least = (window.width().max(window.height()) / 20.0).max(WINDOW_LEAST);
    Extent::around(window.centre(), window.width().max(least), window.height().max(least))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Class, Outline};

    #[test]
    fn a_window_is_fitted_whole_and_the_spare_room_shows_more_of_the_model() {
        let area = Extent::sized([10.0, 10.0], 100.0, 50.0);
        let view = View::new(area, Extent::around([0.0, 0.0], 5.0, 5.0)).without_scale_bar();
        assert_eq!(view.scale(), 10.0);
        assert_eq!(view.region(), Extent::around([0.0, 0.0], 10.0, 5.0));
    }

    #[test]
    fn title_and_scale_bar_take_their_room_from_the_field() {
        let area = Extent::sized([0.0, 0.0], 100.0, 50.0);
        let view = View::new(area, area).titled("part");
        assert_eq!(view.field(), Extent::between([0.0, SCALE_STRIP], [100.0, 50.0 - TITLE_STRIP]));
    }

    #[test]
    fn a_plot_keeps_the_coordinates_of_the_model() {
        let cut = Shape::path(Class::Cut, Outline::from([-3.0, 1.25]).line_to([7.0, 4.5]));
        let sketch = Arc::new(Sketch::from_iter([cut]));
        let window = sketch.extent().expect("one shape");
        let plot = Picture::plot("plate", window, [sketch]);
        assert!(plot.to_svg().contains(r#"<path class="cut" d="M-3-1.25L7-4.5"/>"#), "{}", plot.to_svg());
    }

    #[test]
    fn a_straight_cut_and_a_lone_point_can_be_plotted() {
        for end in [[5.0, 0.0], [0.0, 0.0]] {
            let sketch = Arc::new(Sketch::from_iter([Shape::line(Class::Cut, [0.0, 0.0], end)]));
            let plot = Picture::plot("line", sketch.extent().expect("one shape"), [sketch]);
            assert!(plot.to_png(200).is_ok());
        }
    }
}
