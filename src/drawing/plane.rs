//! From shapes in model space to marks on paper: scale, clip, heads, markers and letters.
//!
//! A plane knows where model points lie on paper and how large a pen is there. Pieces of a line that lie outside its
//! clip are left out here, so that a view of one tooth does not carry the whole gear; what still hangs over the
//! edge is for the writer to cut off.
//!
//! It knows neither pages nor views beyond the one it was made for.

use super::ink::{Mark, Paint, Step};
use super::lettering::{strokes, text_width};
use super::outline::{Leg, distance, moved};
use super::picture::View;
use super::shape::Geometry;
use super::{Align, Class, Extent, Outline, Shape, Turn};

/// From model to paper.
pub(super) struct Plane {
    scale: f64,
    shift: [f64; 2],
    pen: f64,
    pub(super) clip: Option<Extent>,
}

impl Plane {
    pub(super) fn paper(pen: f64) -> Self {
        Self { scale: 1.0, shift: [0.0, 0.0], pen, clip: None }
    }

    pub(super) fn of(view: &View, pen: f64) -> Self {
        let (field, scale) = (view.field_at(pen), view.scale_at(pen));
        let shift = moved(field.centre(), view.window_centre(), -scale);
        Self { scale, shift, pen, clip: Some(field) }
    }

    pub(super) fn place(&self, point: [f64; 2]) -> [f64; 2] {
        moved(self.shift, point, self.scale)
    }

    pub(super) fn ink(&self, shape: &Shape) -> Vec<Mark> {
        let shifted = Self { shift: moved(self.shift, shape.nudge, self.pen), ..*self };
        let mut marks = shifted.marks(shape);
        marks.retain(|mark| self.clip.is_none_or(|clip| mark.reaches(&clip, self.pen)));
        marks
    }

    fn marks(&self, shape: &Shape) -> Vec<Mark> {
        let class = shape.class;
        let paint = match (shape.filled, shape.width) {
            (true, _) => Paint::Solid,
            (false, Some(width)) => Paint::Wide(width * self.scale),
            (false, None) => Paint::Line,
        };
        match &shape.geometry {
            Geometry::Outline(outline) => vec![Mark::new(class, paint, self.outline(outline, paint, class))],
            Geometry::Circle { centre, radius } => {
                vec![Mark::new(class, paint, circle(self.place(*centre), radius * self.scale))]
            }
            Geometry::Arrow { from, to } => {
                let (from, to) = (self.place(*from), self.place(*to));
                self.arrow(class, from, to)
            }
            Geometry::Dimension { from, to, text } => {
                self.dimension(self.place(*from), self.place(*to), text)
            }
            Geometry::Head { tip, heading } => {
                self.head(class, self.place(*tip), *heading).into_iter().collect()
            }
            Geometry::Start { at } => self.start(class, self.place(*at)),
            Geometry::Text { at, align, text } => self.label(class, self.place(*at), *align, text),
        }
    }

    /// Draws an outline, without the pieces of a line that cannot be seen.
    fn outline(&self, outline: &Outline, paint: Paint, class: Class) -> Vec<Step> {
        let seen = match paint {
            Paint::Solid => None,
            Paint::Line => self.clip.map(|clip| clip.grown(class.style().pen * self.pen)),
            Paint::Wide(width) => self.clip.map(|clip| clip.grown(width)),
        };
        let mut steps = Vec::new();
        let mut gaps = 0;
        let mut here = None;
        for (from, leg) in outline.pieces() {
            let (from, leg) = (self.place(from), self.leg(leg));
            if seen.is_some_and(|seen| !leg.extent(from).touches(&seen)) {
                gaps += 1;
                continue;
            }
            if here != Some(from) {
                steps.push(Step::Move(from));
            }
            here = Some(leg.end());
            steps.push(match leg {
                Leg::Line { to } => Step::Line(to),
                Leg::Arc { to, centre, turn } => Step::Arc { to, centre, turn },
            });
        }
        if outline.closed && gaps == 0 {
            steps.pop();
            steps.push(Step::Close);
        }
        steps
    }

    fn leg(&self, leg: Leg) -> Leg {
        match leg {
            Leg::Line { to } => Leg::Line { to: self.place(to) },
            Leg::Arc { to, centre, turn } => {
                Leg::Arc { to: self.place(to), centre: self.place(centre), turn }
            }
        }
    }

    /// A line on paper with a head; the line stops inside the head, so that the tip stays sharp.
    fn arrow(&self, class: Class, from: [f64; 2], to: [f64; 2]) -> Vec<Mark> {
        let length = distance(from, to);
        let back = (HEAD_LENGTH / 2.0 * self.pen).min(length);
        let way = [to[0] - from[0], to[1] - from[1]];
        let stop = moved(to, way, if length > 0.0 { -back / length } else { 0.0 });
        let line = Mark::new(class, Paint::Line, vec![Step::Move(from), Step::Line(stop)]);
        std::iter::once(line).chain(self.head(class, to, way)).collect()
    }

    fn head(&self, class: Class, tip: [f64; 2], heading: [f64; 2]) -> Option<Mark> {
        let length = distance([0.0, 0.0], heading);
        if length <= 0.0 {
            return None;
        }
        let ahead = heading.map(|part| part / length * self.pen);
        let aside = [-ahead[1], ahead[0]];
        let foot = moved(tip, ahead, -HEAD_LENGTH);
        let corners = [moved(foot, aside, HEAD_WIDTH / 2.0), moved(foot, aside, -HEAD_WIDTH / 2.0)];
        let steps = vec![Step::Move(tip), Step::Line(corners[0]), Step::Line(corners[1]), Step::Close];
        Some(Mark::new(class, Paint::Solid, steps))
    }

    fn start(&self, class: Class, at: [f64; 2]) -> Vec<Mark> {
        let reach = START_REACH * self.pen;
        let mut steps = circle(at, START_RADIUS * self.pen);
        for way in [[reach, 0.0], [0.0, reach]] {
            steps.extend([Step::Move(moved(at, way, -1.0)), Step::Line(moved(at, way, 1.0))]);
        }
        let disc = Mark::new(Class::Paper, Paint::Solid, circle(at, START_RADIUS * self.pen));
        vec![disc, Mark::new(class, Paint::Line, steps)]
    }

    /// A line with two heads that leaves room for its measure, or has it beyond its end when it is too short.
    fn dimension(&self, from: [f64; 2], to: [f64; 2], text: &str) -> Vec<Mark> {
        let height = Class::Label.style().letters * self.pen;
        let foot = |middle: [f64; 2]| [middle[0], middle[1] - height / 2.0];
        let length = distance(from, to);
        if length <= 0.0 {
            return self.label(Class::Label, foot(to), Align::Centre, text);
        }
        let heading = [0, 1].map(|axis| (to[axis] - from[axis]) / length);
        let half = [text_width(text, height) / 2.0, height / 2.0].map(|side| side + MEASURE_GAP * self.pen);
        // From the middle of the text's box to its edge, along the line.
        let room = (half[0] / heading[0].abs()).min(half[1] / heading[1].abs());
        let middle = moved(from, heading, length / 2.0);
        if room + HEAD_LENGTH * self.pen > length / 2.0 {
            let mut marks = self.arrow(Class::Dimension, middle, from);
            marks.extend(self.arrow(Class::Dimension, middle, to));
            marks.extend(self.label(Class::Label, foot(moved(to, heading, room)), Align::Centre, text));
            return marks;
        }
        let mut marks = self.arrow(Class::Dimension, moved(middle, heading, -room), from);
        marks.extend(self.arrow(Class::Dimension, moved(middle, heading, room), to));
        marks.extend(self.label(Class::Label, foot(middle), Align::Centre, text));
        marks
    }

    /// A text; inside a view it has a halo and stays whole, or is left out when its point cannot be seen.
    fn label(&self, class: Class, at: [f64; 2], align: Align, text: &str) -> Vec<Mark> {
        let Some(field) = self.clip else {
            return vec![self.text(class, at, align, text)];
        };
        if !field.touches(&Extent { min: at, max: at }) {
            return Vec::new();
        }
        let height = class.style().letters * self.pen;
        let width = text_width(text, height);
        let left = at[0] - width * align.share();
        let inside = field.grown(-LABEL_MARGIN * self.pen);
        let left = left.min(inside.max[0] - width).max(inside.min[0]);
        let foot = at[1].min(inside.max[1] - height).max(inside.min[1]);
        let text = self.text(class, [left, foot], Align::Left, text);
        vec![Mark::new(Class::Paper, Paint::Line, text.steps.clone()), text]
    }

    fn text(&self, class: Class, at: [f64; 2], align: Align, text: &str) -> Mark {
        let height = class.style().letters * self.pen;
        let left = at[0] - text_width(text, height) * align.share();
        let steps = strokes(text, [left, at[1]], height);
        Mark { says: Some(text.to_owned()), ..Mark::new(class, Paint::Line, steps) }
    }
}

/// A circle as two half turns, which an SVG arc can say and a whole turn cannot.
fn circle(centre: [f64; 2], radius: f64) -> Vec<Step> {
    let right = [centre[0] + radius, centre[1]];
    let left = [centre[0] - radius, centre[1]];
    let half = |to| Step::Arc { to, centre, turn: Turn::CounterClockwise };
    vec![Step::Move(right), half(left), half(right), Step::Close]
}

/// Length of an arrow head, page millimetres.
const HEAD_LENGTH: f64 = 2.6;

/// Width of an arrow head: slender, as on a drawing.
const HEAD_WIDTH: f64 = 1.5;

/// Between a measure and its line, page millimetres.
const MEASURE_GAP: f64 = 1.2;

/// The nearest a text comes to the edge of its view, page millimetres.
const LABEL_MARGIN: f64 = 1.5;

/// Radius of the start's ring.
const START_RADIUS: f64 = 1.1;

/// How far the start's cross reaches out of its middle.
const START_REACH: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::ink::ink;
    use crate::drawing::{Picture, Sketch};
    use std::sync::Arc as Shared;

    #[test]
    fn pieces_of_a_line_outside_the_view_are_left_out() {
        let zigzag = Outline::through((0..1000).map(|i| [f64::from(i), f64::from(i % 2)])).expect("points");
        let marks = seen(Shape::path(Class::Cut, zigzag), Extent::between([500.0, 0.0], [510.0, 1.0]));
        assert_eq!(marks.len(), 1);
        assert!(marks[0].steps.len() <= 14, "{:?}", marks[0].steps);
    }

    #[test]
    fn a_line_that_leaves_the_view_and_comes_back_is_drawn_in_two_runs() {
        let loop_out =
            Outline::from([1.0, 1.0]).line_to([9.0, 1.0]).line_to([9.0, 9.0]).line_to([1.0, 9.0]).closed();
        let marks = seen(Shape::path(Class::Cut, loop_out.clone()), Extent::between([0.0, 0.0], [3.0, 10.0]));
        let moves =
            |marks: &[Mark]| marks[0].steps.iter().filter(|step| matches!(step, Step::Move(_))).count();
        assert_eq!(moves(&marks), 2);
        assert!(!marks[0].steps.contains(&Step::Close));
        let marks = seen(Shape::path(Class::Cut, loop_out), Extent::between([0.0, 0.0], [10.0, 10.0]));
        assert_eq!((moves(&marks), marks[0].steps.last()), (1, Some(&Step::Close)));
    }

    #[test]
    fn a_surface_is_kept_whole_or_left_out() {
        let square = || Shape::rectangle(Class::Part, Extent::between([0.0, 0.0], [9.0, 9.0])).filled();
        let marks = seen(square(), Extent::between([4.0, 4.0], [20.0, 20.0]));
        assert_eq!(marks[0].steps.len(), 5);
        assert_eq!(seen(square(), Extent::between([10.0, 10.0], [20.0, 20.0])), []);
    }

    #[test]
    fn heads_and_letters_keep_their_size_at_any_scale() {
        for size in [1.0, 100.0] {
            let window = Extent::around([0.0, 0.0], size, size);
            let head = &seen(Shape::head(Class::Cut, [0.0, 0.0], [1.0, 0.0]), window)[0];
            assert_eq!(head.steps[0], Step::Move([50.0, 50.0]));
            assert_eq!(head.steps[1], Step::Line([50.0 - HEAD_LENGTH, 50.0 + HEAD_WIDTH / 2.0]));
            let text = &seen(Shape::text(Class::Label, [0.0, 0.0], Align::Left, "I"), window)[1];
            assert_eq!(text.steps, [Step::Move([50.0, 50.0]), Step::Line([50.0, 52.2])]);
        }
    }

    #[test]
    fn a_label_stays_whole_at_the_edge_and_goes_with_its_point() {
        let window = Extent::between([0.0, 0.0], [100.0, 100.0]);
        let label = |x| Shape::text(Class::Label, [x, 50.0], Align::Left, "start");
        let inside =
            |x| seen(label(x), window)[1].steps.iter().all(|step| step.end().is_some_and(|to| to[0] < 98.51));
        assert!(inside(50.0) && inside(99.0));
        assert_eq!(seen(label(100.5), window), []);
    }

    #[test]
    fn a_dimension_of_nothing_is_only_its_measure() {
        let window = Extent::between([0.0, 0.0], [100.0, 100.0]);
        assert_eq!(seen(Shape::dimension([50.0, 50.0], [50.0, 50.0], "0"), window).len(), 2);
    }

    #[test]
    fn a_dimension_leaves_room_for_its_measure_or_has_it_beside() {
        let window = Extent::between([0.0, 0.0], [100.0, 100.0]);
        let half = text_width("12.345", Class::Label.style().letters) / 2.0;
        let long = seen(Shape::dimension([20.0, 50.0], [80.0, 50.0], "12.345"), window);
        assert_eq!(long[0].steps[0], Step::Move([50.0 - half - MEASURE_GAP, 50.0]));
        assert_eq!(long[2].steps[0], Step::Move([50.0 + half + MEASURE_GAP, 50.0]));
        let short = seen(Shape::dimension([20.0, 50.0], [26.0, 50.0], "12.345"), window);
        let measure = short.last().expect("a text");
        assert!(measure.steps.iter().all(|step| step.end().is_some_and(|to| to[0] > 26.0)));
    }

    /// Shows one shape in a bare field of 100 by 100 mm.
    fn seen(shape: Shape, window: Extent) -> Vec<Mark> {
        let mut page = Picture::page("one", 100.0, 100.0);
        let view = View::new(Extent::sized([0.0, 0.0], 100.0, 100.0), window);
        page.place(view.unframed().without_scale_bar().showing(&Shared::new(Sketch::from_iter([shape]))));
        ink(&page).into_iter().flat_map(|group| group.marks).collect()
    }
}
