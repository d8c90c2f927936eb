//! The demo's page: what the control's pulses cut, whole and one tooth, with the figures below.

use std::sync::Arc;

use super::{BAUD, Verdict, Watch};
use crate::drawing::{
    Align, Class, Extent, Outline, Picture, PngError, Shape, Sketch, Turn, View, figures, legend,
};
use crate::geometry::{Element, Point, Sense};
use crate::part::Prepared;
use crate::shapes::cycloid_gear::{Direction, Trim};

/// The page as SVG and PNG.
pub(super) fn draw(
    prepared: &Prepared,
    watch: &Watch,
    verdict: &Verdict,
) -> Result<(String, Vec<u8>), PngError> {
    let page = page(prepared, watch, verdict);
    Ok((page.to_svg(), page.to_png(2400)?))
}

fn page(prepared: &Prepared, watch: &Watch, verdict: &Verdict) -> Picture {
    let part = prepared.part();
    let nominal = part.gear.outline(0.0, Direction::Clockwise, Trim::Refuse).ok();
    let nominal = nominal.map(|outline| path(outline.elements()));
    let cut = Outline::through(Watch::points(watch.cut.as_ref()));
    let lead_in = Outline::through(Watch::points(watch.lead_in.as_ref()));
    let origin = [prepared.origin().x.millimetres(), prepared.origin().y.millimetres()];
    let width = 2.0 * part.offset.abs();

    let body = sketch(nominal.clone().map(|o| Shape::path(Class::Part, o).filled()));
    let kerf = sketch(cut.clone().map(|o| Shape::path(Class::Wire, o).wide(width)));
    let lines = sketch(
        [
            nominal.map(|o| Shape::path(Class::Nominal, o)),
            cut.clone().map(|o| Shape::path(Class::Cut, o)),
            lead_in.map(|o| Shape::path(Class::LeadIn, o)),
        ]
        .into_iter()
        .flatten(),
    );

    let tip = part.gear.module * part.gear.teeth as f64 / 2.0 * 1.1;
    let reach = reach(watch);
    let mark = Outline::from([0.0, -0.55 * tip]).arc_to([-0.55 * tip, 0.0], [0.0, 0.0], Turn::Clockwise);
    let mut marks = vec![
        Shape::start(origin),
        Shape::text(Class::Label, origin, Align::Left, "start").nudged([4.0, -1.2]),
        Shape::path(Class::Direction, mark.clone()),
        Shape::text(Class::Label, [-0.39 * tip, -0.39 * tip], Align::Left, "direction of cut")
            .nudged([2.5, 1.0]),
        Shape::dimension(
            [-reach, -1.22 * tip],
            [reach, -1.22 * tip],
            format!("Ø {:.3} over the path", 2.0 * reach),
        ),
    ];
    marks.extend(mark.along(1.0).map(|end| Shape::head(Class::Direction, end.at, end.heading)));
    let marks = sketch(marks);
    // Heads on the path of the tooth that is enlarged: the one a quarter turn from the start.
    let near = sketch([0.2505, 0.2585].into_iter().filter_map(|at| {
        cut.as_ref().and_then(|o| o.along(at)).map(|place| Shape::head(Class::Cut, place.at, place.heading))
    }));

    let mut page = Picture::page("Clock gear as cut", 297.0, 210.0);
    let title = format!("Clock gear, module {} mm, {} teeth", part.gear.module, part.gear.teeth);
    page.draw(Shape::text(Class::Title, [14.0, 192.0], Align::Left, &title));
    page.draw(Shape::text(Class::Label, [283.0, 192.0], Align::Right, "as cut, from the control's pulses"));
    page.draw(Shape::line(Class::Frame, [14.0, 187.0], [283.0, 187.0]));
    let window = Extent::around([0.0, -0.12 * tip], 2.6 * tip, 2.6 * tip);
    let whole = View::new(Extent::between([14.0, 52.0], [142.0, 182.0]), window);
    let whole = page.place(whole.titled("Whole part").showing(&body).showing(&lines).showing(&marks));
    let tooth = Extent::around(
        [part.gear.module * part.gear.teeth as f64 / 2.0, 0.0],
        4.2 * part.gear.module,
        4.2 * part.gear.module,
    );
    let tooth = View::new(Extent::between([155.0, 52.0], [283.0, 182.0]), tooth);
    page.place(
        tooth
            .titled("One tooth")
            .enlarging(whole)
            .showing(&body)
            .showing(&kerf)
            .showing(&lines)
            .showing(&near),
    );

    let report = &verdict.report;
    page.draw_all(figures(
        [14.0, 46.0],
        84.0,
        &[
            ("Blocks", &report.blocks.to_string()),
            ("Pulses", &report.pulses.to_string()),
            ("Length of path", &format!("{:.3} mm", report.path_length_mm)),
            ("Farthest node from theory", &format!("{:.2} µm", verdict.max_node_error_um)),
            ("Closure", &format!("{:.2} µm", verdict.closure_um)),
        ],
    ));
    let utilisation =
        report.line_utilisation.map_or_else(|| "not known".to_owned(), |u| format!("{:.1} %", 100.0 * u));
    page.draw_all(figures(
        [112.0, 46.0],
        84.0,
        &[
            ("Wire offset", &format!("{:+.3} mm", part.offset)),
            ("Line", &format!("{BAUD} baud 7E2, DC1/DC3")),
            ("Line busy while not held", &utilisation),
            ("Holds by the control", &report.holds.to_string()),
            ("Most characters after DC3", &report.max_overrun_bytes.to_string()),
        ],
    ));
    page.draw_all(legend(
        [212.0, 46.0],
        &[
            (Class::Nominal, "outline of the part"),
            (Class::Cut, "centre of the wire, as cut"),
            (Class::LeadIn, "lead-in"),
            (Class::Wire, "kerf, true width"),
            (Class::Start, "start"),
        ],
    ));
    page
}

/// The farthest the cut reaches from the centre, mm.
fn reach(watch: &Watch) -> f64 {
    let square = |p: &crate::units::Position| (p.x.0 * p.x.0 + p.y.0 * p.y.0) as f64;
    watch.ends.iter().map(square).fold(0.0, f64::max).sqrt() / 1000.0
}

fn sketch(shapes: impl IntoIterator<Item = Shape>) -> Arc<Sketch> {
    Arc::new(shapes.into_iter().collect())
}

/// A contour as an outline to draw.
fn path(elements: impl Iterator<Item = Element>) -> Outline {
    let mut outline: Option<Outline> = None;
    let plain = |p: Point| [p.x, p.y];
    for element in elements {
        let so_far = outline.take().unwrap_or_else(|| Outline::from(plain(element.start())));
        outline = Some(match element {
            Element::Line { end, .. } => so_far.line_to(plain(end)),
            Element::Arc { end, centre, sense, .. } => {
                let turn = match sense {
                    Sense::Clockwise => Turn::Clockwise,
                    Sense::CounterClockwise => Turn::CounterClockwise,
                };
                so_far.arc_to(plain(end), plain(centre), turn)
            }
        });
    }
    outline.unwrap_or_else(|| Outline::from([0.0, 0.0])).closed()
}
