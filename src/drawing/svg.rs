//! Ink as SVG: one path a mark, looks in a style element, true arcs.
//!
//! One user unit is a millimetre, and the paper's point (x, y) stands at (x, −y), since SVG has Y down. Numbers are
//! rounded to a tenth of a micrometre and written from integers, so equal pictures give equal bytes. Texts are
//! strokes; what they say is in `aria-label`, where a screen reader and a search find it.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::ink::{Group, Mark, Paint, Step};
use super::outline::Arc;
use super::{Class, Extent, Picture, Turn};

/// Writes the whole document.
pub(super) fn write(picture: &Picture, groups: &[Group]) -> String {
    let Extent { min, max } = picture.paper;
    let size = [picture.paper.width(), picture.paper.height()];
    let printed = size.map(|side| decimal(side / picture.pen));
    let mut svg = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    line(
        &mut svg,
        format_args!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{}mm" height="{}mm" viewBox="{} {} {} {}">"#,
            printed[0],
            printed[1],
            decimal(min[0]),
            decimal(-max[1]),
            decimal(size[0]),
            decimal(size[1]),
        ),
    );
    line(&mut svg, format_args!("<title>{}</title>", escaped(&picture.title)));
    line(&mut svg, format_args!("<style>\n{}</style>", stylesheet(groups, picture.pen)));
    line(&mut svg, format_args!(r#"<rect class="paper solid" {}/>"#, rectangle(&picture.paper)));
    for (number, group) in groups.iter().enumerate() {
        match &group.clip {
            Some(clip) => {
                let rectangle = rectangle(clip);
                line(
                    &mut svg,
                    format_args!(r#"<clipPath id="clip-{number}"><rect {rectangle}/></clipPath>"#),
                );
                line(&mut svg, format_args!(r#"<g clip-path="url(#clip-{number})">"#));
            }
            None => line(&mut svg, format_args!("<g>")),
        }
        for mark in &group.marks {
            line(&mut svg, format_args!("{}", element(mark)));
        }
        line(&mut svg, format_args!("</g>"));
    }
    line(&mut svg, format_args!("</svg>"));
    svg
}

fn line(svg: &mut String, text: std::fmt::Arguments<'_>) {
    // A String takes whatever is written to it.
    let _ = writeln!(svg, "{text}");
}

/// The looks of the classes that occur.
fn stylesheet(groups: &[Group], pen: f64) -> String {
    let used = groups.iter().flat_map(|group| &group.marks).map(|mark| mark.class);
    let mut sheet = String::from("path{fill:none;stroke-linecap:round;stroke-linejoin:round}\n");
    for class in used.chain([Class::Paper]).collect::<BTreeSet<_>>() {
        let style = class.style();
        let colour = format!("#{:06x}", style.colour.rgb);
        let opacity = match style.colour.opacity_percent {
            100.. => [String::new(), String::new()],
            percent => ["stroke", "fill"].map(|what| format!(";{what}-opacity:0.{percent:02}")),
        };
        let dash = style.dash.map_or_else(String::new, |[dash, gap]| {
            let [dash, gap] = [dash, gap].map(|length| decimal(length * pen));
            format!(";stroke-dasharray:{dash} {gap};stroke-linecap:butt")
        });
        let width = decimal(style.pen * pen);
        line(
            &mut sheet,
            format_args!(".{}{{stroke:{colour};stroke-width:{width}{}{dash}}}", style.name, opacity[0]),
        );
        line(&mut sheet, format_args!(".{}.solid{{fill:{colour};stroke:none{}}}", style.name, opacity[1]));
    }
    sheet
}

fn element(mark: &Mark) -> String {
    let name = mark.class.style().name;
    let path = path(&mark.steps);
    let says =
        mark.says.as_ref().map_or_else(String::new, |text| format!(r#" aria-label="{}""#, escaped(text)));
    match mark.paint {
        Paint::Line => format!(r#"<path class="{name}"{says} d="{path}"/>"#),
        Paint::Wide(width) => {
            format!(r#"<path class="{name}" style="stroke-width:{}"{says} d="{path}"/>"#, decimal(width))
        }
        Paint::Solid => format!(r#"<path class="{name} solid"{says} d="{path}"/>"#),
    }
}

fn rectangle(extent: &Extent) -> String {
    format!(
        r#"x="{}" y="{}" width="{}" height="{}""#,
        decimal(extent.min[0]),
        decimal(-extent.max[1]),
        decimal(extent.width()),
        decimal(extent.height())
    )
}

fn path(steps: &[Step]) -> String {
    let mut data = String::new();
    let mut here = [0.0, 0.0];
    for step in steps {
        match *step {
            Step::Move(to) => command(&mut data, 'M', &[to[0], -to[1]]),
            Step::Line(to) => command(&mut data, 'L', &[to[0], -to[1]]),
            Step::Curve { controls: [[ax, ay], [bx, by]], to: [x, y] } => {
                command(&mut data, 'C', &[ax, -ay, bx, -by, x, -y]);
            }
            Step::Arc { to, centre, turn } => arc(&mut data, &Arc { from: here, to, centre, turn }),
            Step::Close => data.push('Z'),
        }
        here = step.end().unwrap_or(here);
    }
    data
}

/// Writes an arc; a whole turn, which SVG cannot say, as its quarters.
fn arc(data: &mut String, arc: &Arc) {
    if arc.from == arc.to {
        return arc.quarters().iter().for_each(|quarter| self::arc(data, quarter));
    }
    let radius = arc.radius();
    let large = if arc.is_large() { 1.0 } else { 0.0 };
    let sweep = match arc.turn {
        Turn::CounterClockwise => 0.0, // SVG counts the sweep with Y down.
        Turn::Clockwise => 1.0,
    };
    command(data, 'A', &[radius, radius, 0.0, large, sweep, arc.to[0], -arc.to[1]]);
}

fn command(data: &mut String, letter: char, numbers: &[f64]) {
    data.push(letter);
    for (index, number) in numbers.iter().enumerate() {
        let number = decimal(*number);
        if index > 0 && !number.starts_with('-') {
            data.push(' ');
        }
        data.push_str(&number);
    }
}

/// Writes a number with at most four decimals, without trailing noughts and never as minus nought.
fn decimal(number: f64) -> String {
    assert!(number.is_finite(), "a picture's numbers are finite");
    let least = (number * 10_000.0).round() as i64;
    let sign = if least < 0 { "-" } else { "" };
    let (whole, part) = (least.unsigned_abs() / 10_000, least.unsigned_abs() % 10_000);
    match part {
        0 => format!("{sign}{whole}"),
        _ => format!("{sign}{whole}.{part:04}").trim_end_matches('0').to_owned(),
    }
}

/// Makes a text safe between tags and in attributes; characters that XML has no place for become U+FFFD.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\t' | '\n' | '\r' => safe.push(' '),
            '\0'..' ' | '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            plain => safe.push(plain),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Align, Outline, Shape, Sketch, View};
    use std::sync::Arc as Shared;

    #[test]
    fn numbers_have_four_decimals_at_most_and_no_minus_nought() {
        for (number, written) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.000_04, "0"),
            (0.000_05, "0.0001"),
            (-1.5, "-1.5"),
            (12.345_678, "12.3457"),
            (100.0, "100"),
            (-0.25, "-0.25"),
        ] {
            assert_eq!(decimal(number), written);
        }
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b & \"c\">\u{1}µ\n"), "a&lt;b &amp; &quot;c&quot;&gt;\u{fffd}µ ");
    }

    #[test]
    fn a_page_is_well_formed_with_a_viewbox_in_millimetres() {
        let svg = page().to_svg();
        assert_well_formed(&svg);
        assert!(svg.contains(r#"width="297mm" height="210mm" viewBox="0 -210 297 210""#), "{svg}");
        assert!(svg.contains("<title>a &lt;gear&gt; &amp; more</title>"));
        assert!(!svg.contains("NaN") && !svg.contains("-0 "));
    }

    #[test]
    fn shapes_carry_the_class_they_were_given() {
        let svg = page().to_svg();
        for class in ["nominal", "wire", "rapid", "cut", "lead-in", "start"] {
            assert!(svg.contains(&format!("class=\"{class}\"")), "{class}");
            assert!(svg.contains(&format!("\n.{class}{{stroke:#")), "{class}");
        }
        assert!(!svg.contains(".scale-bar") || svg.contains("class=\"scale-bar\""));
    }

    #[test]
    fn arcs_stay_arcs_and_turn_the_right_way_with_y_down() {
        let arc = |turn| Step::Arc { to: [0.0, 2.0], centre: [0.0, 0.0], turn };
        assert_eq!(path(&[Step::Move([2.0, 0.0]), arc(Turn::CounterClockwise)]), "M2 0A2 2 0 0 0 0-2");
        assert_eq!(path(&[Step::Move([2.0, 0.0]), arc(Turn::Clockwise)]), "M2 0A2 2 0 1 1 0-2");
        let whole = Step::Arc { to: [2.0, 0.0], centre: [0.0, 0.0], turn: Turn::Clockwise };
        assert_eq!(path(&[Step::Move([2.0, 0.0]), whole]).matches('A').count(), 4);
    }

    #[test]
    fn the_wire_is_as_wide_as_its_view_enlarges_it() {
        let wire = Shape::line(Class::Wire, [0.0, 0.0], [1.0, 0.0]).wide(0.12);
        let view = View::new(Extent::sized([0.0, 0.0], 50.0, 50.0), Extent::around([0.0, 0.0], 5.0, 5.0));
        let mut picture = Picture::page("wire", 50.0, 50.0);
        picture.place(view.without_scale_bar().showing(&Shared::new(Sketch::from_iter([wire]))));
        assert!(
            picture.to_svg().contains(r#"class="wire" style="stroke-width:1.2""#),
            "{}",
            picture.to_svg()
        );
    }

    #[test]
    fn equal_pictures_give_equal_bytes() {
        assert_eq!(page().to_svg(), page().to_svg());
    }

    fn page() -> Picture {
        let ring = Outline::from([5.0, 0.0]).arc_to([5.0, 0.0], [0.0, 0.0], Turn::CounterClockwise);
        let sketch = Shared::new(Sketch::from_iter([
            Shape::path(Class::Wire, ring.clone()).wide(0.2),
            Shape::path(Class::Nominal, ring.clone()),
            Shape::path(Class::Cut, ring),
            Shape::line(Class::LeadIn, [0.0, 0.0], [5.0, 0.0]),
            Shape::line(Class::Rapid, [-1.0, 0.0], [0.0, 0.0]),
            Shape::start([0.0, 0.0]),
            Shape::text(Class::Label, [0.0, 1.0], Align::Left, "start \"<1>\"").nudged([1.0, 1.0]),
        ]));
        let mut page = Picture::page("a <gear> & more", 297.0, 210.0);
        let whole =
            View::new(Extent::sized([10.0, 20.0], 130.0, 150.0), Extent::around([0.0, 0.0], 12.0, 12.0));
        let overview = page.place(whole.titled("whole").showing(&sketch));
        let detail =
            View::new(Extent::sized([150.0, 20.0], 130.0, 150.0), Extent::around([5.0, 0.0], 1.0, 1.0));
        page.place(detail.titled("detail").enlarging(overview).showing(&sketch));
        page
    }

    /// Checks that tags close in order, attributes are quoted, and no bare `<` or `&` is left.
    fn assert_well_formed(xml: &str) {
        let mut open = Vec::new();
        for piece in xml.split('<').skip(1) {
            let (tag, text) = piece.split_once('>').expect("a tag ends");
            assert!(!text.contains('>'), "{text:?}");
            for entity in piece.split('&').skip(1) {
                assert!(
                    ["amp;", "lt;", "gt;", "quot;"].iter().any(|known| entity.starts_with(known)),
                    "{entity:?}"
                );
            }
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag:?}");
            let name = tag.split([' ', '/']).find(|word| !word.is_empty()).expect("a tag has a name");
            match tag {
                _ if tag.starts_with('?') || tag.ends_with('/') => {}
                _ if tag.starts_with('/') => assert_eq!(open.pop(), Some(name)),
                _ => open.push(name),
            }
        }
        assert!(open.is_empty(), "{open:?} left open");
    }
}
