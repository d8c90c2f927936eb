//! What drawings are read as, entity by entity, and what is told of them.

mod damage;
mod entities;
mod inserts;
mod layers;
mod program;

use super::*;
use crate::geometry::{Element, Path, Sense};

/// The text of pairs, written `0 LINE|8 PARTS|…`.
fn pairs(written: &str) -> String {
    written
        .split('|')
        .map(str::trim)
        .filter(|pair| !pair.is_empty())
        .map(|pair| {
            let (code, value) = pair.split_once(' ').unwrap_or((pair, ""));
            format!("{code}\n{value}\n")
        })
        .collect()
}

/// A drawing in mm of these entities.
fn file(entities: &str) -> String {
    file_with("", entities)
}

/// A drawing in mm of these sections and entities.
fn file_with(sections: &str, entities: &str) -> String {
    let head = "0 SECTION|2 HEADER|9 $INSUNITS|70 4|0 ENDSEC";
    pairs(&format!("{head}|{sections}|0 SECTION|2 ENTITIES|{entities}|0 ENDSEC|0 EOF"))
}

fn read_text(text: &str, options: &Options) -> Drawing {
    read(text.as_bytes(), options).unwrap_or_else(|error| panic!("{error:?}"))
}

/// The contours as they are drawn, with nothing to tell of them.
fn drawn(entities: &str) -> Vec<Path> {
    let options = Options { order: Some(Order::AsDrawn), start: Start::AsDrawn, ..Options::default() };
    let drawing = read_text(&file(entities), &options);
    let told: Vec<&Finding> = drawing.report.iter().filter(|f| f.code != "open-end").collect();
    assert!(told.is_empty(), "{told:#?}");
    drawing.contours.into_iter().map(|contour| contour.path).collect()
}

/// The only contour.
fn one(entities: &str) -> Path {
    let mut paths = drawn(entities);
    assert_eq!(paths.len(), 1, "{paths:#?}");
    paths.remove(0)
}

/// The codes of what is told, in order.
fn codes(drawing: &Drawing) -> Vec<&'static str> {
    drawing.report.iter().map(|finding| finding.code).collect()
}

fn point(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(start: (f64, f64), end: (f64, f64)) -> Element {
    Element::Line { start: point(start.0, start.1), end: point(end.0, end.1) }
}

fn near(a: Point, b: Point) -> bool {
    (a - b).norm() < 1e-12
}

#[track_caller]
fn assert_arc(element: &Element, ends: [(f64, f64); 2], middle: (f64, f64), about: (f64, f64), round: Sense) {
    let Element::Arc { start, end, centre, sense } = *element else { panic!("{element:?} is no arc") };
    let places = [(start, ends[0]), (end, ends[1]), (centre, about), (element.at(0.5), middle)];
    for (found, (x, y)) in places {
        assert!(near(found, point(x, y)), "{found} is not ({x}, {y}) in {element:?}");
    }
    assert_eq!(sense, round);
}
