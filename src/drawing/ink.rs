//! A picture brought down to strokes and surfaces in paper millimetres, Y up, ready for either writer.
//!
//! ```text
//!  views ──▶ model to paper, clipped ──▶ frame, heading, scale bar ──▶ callouts ──▶ the sheet
//! ```
//!
//! It spells no output format; and it makes no choice of colour or pen beyond the class.

use super::outline::Leg;
use super::picture::{Picture, View};
use super::plane::Plane;
use super::{Align, Class, Extent, Shape, Turn};

/// Marks that belong together and share a clip.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) clip: Option<Extent>,
    pub(super) marks: Vec<Mark>,
}

/// One stroke or surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    pub(super) class: Class,
    pub(super) paint: Paint,
    pub(super) steps: Vec<Step>,
    /// What it says, when it is a text.
    pub(super) says: Option<String>,
}

/// How a mark is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// A line by the class's own pen.
    Line,
    /// A line of this width on paper.
    Wide(f64),
    /// The inside.
    Solid,
}

/// One step of the pen on paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Move([f64; 2]),
    Line([f64; 2]),
    Arc { to: [f64; 2], centre: [f64; 2], turn: Turn },
    Curve { controls: [[f64; 2]; 2], to: [f64; 2] },
    Close,
}

impl Step {
    /// Where the pen stands afterwards; nothing after closing, which goes back to where the outline began.
    pub(super) fn end(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Move(to) | Self::Line(to) | Self::Arc { to, .. } | Self::Curve { to, .. } => Some(to),
            Self::Close => None,
        }
    }
}

/// Brings a picture down to ink, in painting order.
pub(super) fn ink(picture: &Picture) -> Vec<Group> {
    let pen = picture.pen;
    let mut groups = Vec::new();
    for view in &picture.views {
        let plane = Plane::of(view, pen);
        let marks = view.sketches.iter().flat_map(|sketch| &sketch.shapes).flat_map(|shape| plane.ink(shape));
        groups.push(Group { clip: plane.clip, marks: marks.collect() });
        groups.push(Group { clip: None, marks: surroundings(view, pen) });
    }
    let paper = Plane::paper(pen);
    let callouts = picture.views.iter().flat_map(|detail| match detail.enlarges {
        Some(overview) => callout(&picture.views[overview.0], detail, pen),
        None => Vec::new(),
    });
    groups.push(Group { clip: None, marks: callouts.flat_map(|shape| paper.ink(&shape)).collect() });
    let sheet = picture.sheet.shapes.iter().flat_map(|shape| paper.ink(shape));
    groups.push(Group { clip: None, marks: sheet.collect() });
    groups.retain(|group| !group.marks.is_empty());
    groups
}

/// Frame, heading and scale bar of a view.
fn surroundings(view: &View, pen: f64) -> Vec<Mark> {
    let field = view.field_at(pen);
    let mut shapes = Vec::new();
    if view.framed {
        shapes.push(Shape::rectangle(Class::Frame, field));
    }
    if let Some(title) = &view.title {
        let foot = [field.min[0], field.max[1] + HEADING_LIFT * pen];
        shapes.push(Shape::text(Class::Heading, foot, Align::Left, title.as_str()));
    }
    if let Some(bar) = view.scale_bar(pen) {
        let foot = field.min[1] - BAR_DROP * pen;
        let label = bar.label();
        let [left, right] = [field.min[0], field.min[0] + bar.length];
        for end in [left, right] {
            let tick = [foot - TICK * pen, foot + TICK * pen].map(|height| [end, height]);
            shapes.push(Shape::line(Class::ScaleBar, tick[0], tick[1]));
        }
        shapes.push(Shape::line(Class::ScaleBar, [left, foot], [right, foot]));
        let beside = [right + BAR_GAP * pen, foot - Class::Label.style().letters / 2.0 * pen];
        shapes.push(Shape::text(Class::Label, beside, Align::Left, label));
    }
    let paper = Plane::paper(pen);
    shapes.iter().flat_map(|shape| paper.ink(shape)).collect()
}

/// A box around the enlarged region, joined to the near edge of the view that enlarges it.
fn callout(overview: &View, detail: &View, pen: f64) -> Vec<Shape> {
    let plane = Plane::of(overview, pen);
    let region = detail.region_at(pen);
    let region = Extent::between(plane.place(region.min), plane.place(region.max));
    let field = detail.field_at(pen);
    let way = [0, 1].map(|axis| field.centre()[axis] - region.centre()[axis]);
    let corner = |extent: &Extent, right: bool, upper: bool| {
        [if right { extent.max[0] } else { extent.min[0] }, if upper { extent.max[1] } else { extent.min[1] }]
    };
    let join = |end: bool| {
        if way[0].abs() >= way[1].abs() {
            (corner(&region, way[0] > 0.0, end), corner(&field, way[0] < 0.0, end))
        } else {
            (corner(&region, end, way[1] > 0.0), corner(&field, end, way[1] < 0.0))
        }
    };
    let joints = [false, true].map(join).map(|(from, to)| Shape::line(Class::Callout, from, to));
    std::iter::once(Shape::rectangle(Class::Callout, region)).chain(joints).collect()
}

impl Mark {
    pub(super) fn new(class: Class, paint: Paint, steps: Vec<Step>) -> Self {
        Self { class, paint, steps, says: None }
    }

    /// Says whether anything of the mark can be seen inside a clip.
    pub(super) fn reaches(&self, clip: &Extent, pen: f64) -> bool {
        let mut here = [0.0, 0.0];
        let mut all: Option<Extent> = None;
        for step in &self.steps {
            let extent = match *step {
                Step::Move(to) => Extent { min: to, max: to },
                Step::Line(to) => Extent::between(here, to),
                Step::Arc { to, centre, turn } => Leg::Arc { to, centre, turn }.extent(here),
                Step::Curve { controls: [a, b], to } => {
                    Extent::between(a, b).united(Extent::between(here, to))
                }
                Step::Close => continue,
            };
            here = step.end().unwrap_or(here);
            all = Some(all.map_or(extent, |all| all.united(extent)));
        }
        let margin = match self.paint {
            Paint::Line => self.class.style().pen * pen,
            Paint::Wide(width) => width,
            Paint::Solid => 0.0,
        };
        all.is_some_and(|all| all.grown(margin).touches(clip))
    }
}

/// A heading's foot line above its field, page millimetres.
const HEADING_LIFT: f64 = 2.4;

/// A scale bar below its field, page millimetres.
const BAR_DROP: f64 = 4.0;

/// From a scale bar to its length in words, page millimetres.
const BAR_GAP: f64 = 2.0;

/// Half the height of the ticks at the ends of a scale bar, page millimetres.
const TICK: f64 = 0.9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_enlarged_region_is_boxed_where_it_lies() {
        let window = |side| Extent::around([0.0, 0.0], side, side);
        let mut page = Picture::page("two", 200.0, 100.0);
        let area = Extent::sized([0.0, 0.0], 100.0, 100.0);
        let whole = page.place(View::new(area, window(10.0)).unframed().without_scale_bar());
        let area = Extent::sized([120.0, 10.0], 80.0, 80.0);
        page.place(View::new(area, window(1.0)).unframed().without_scale_bar().enlarging(whole));
        let groups = ink(&page);
        let marks: Vec<_> = groups.iter().flat_map(|group| &group.marks).collect();
        assert_eq!(marks[0].steps[0], Step::Move([45.0, 45.0]));
        assert_eq!(marks[1].steps, [Step::Move([55.0, 45.0]), Step::Line([120.0, 10.0])]);
        assert_eq!(marks[2].steps, [Step::Move([55.0, 55.0]), Step::Line([120.0, 90.0])]);
    }
}
