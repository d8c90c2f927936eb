//! What is drawn twice: the same element in the same place, in either direction.

use crate::drawing::finding::{Finding, Severity, named};
use crate::geometry::Element;

use super::Piece;
use super::grid::Grid;

/// Elements with ends and middles this close are one, mm.
const SAME: f64 = 0.0005;

/// The pieces without those that are all drawn already; larger pieces stay before smaller ones.
pub(super) fn without(pieces: Vec<Piece>, report: &mut Vec<Finding>) -> Vec<Piece> {
    let count = pieces.iter().map(|p| p.elements.len()).sum();
    let mut by_size: Vec<usize> = (0..pieces.len()).collect();
    by_size.sort_by_key(|&n| std::cmp::Reverse(pieces[n].elements.len()));
    let mut kept: Vec<(Element, usize)> = Vec::with_capacity(count);
    let mut grid = Grid::new(SAME, count);
    let mut double = vec![false; pieces.len()];
    let mut middles = Vec::new();
    for n in by_size {
        let elements = &pieces[n].elements;
        middles.clear();
        middles.extend(elements.iter().map(Element::middle));
        let mut again: Option<usize> = None;
        let mut doubles = 0;
        for (element, &middle) in elements.iter().zip(&middles) {
            let same = grid.near(middle).find(|&k| is_same(&kept[k as usize].0, element));
            // A circle begins anywhere.
            let same = same.or_else(|| {
                let opposite = is_circle(element).then(|| element.start())?;
                grid.near(opposite).find(|&k| is_same(&kept[k as usize].0, element))
            });
            if let Some(k) = same {
                doubles += 1;
                again = again.or(Some(kept[k as usize].1));
            }
        }
        if let Some(first) = again {
            let piece = &pieces[n];
            let at = elements[0].middle();
            let (here, there) = (piece.line, pieces[first].line);
            if doubles == elements.len() {
                double[n] = true;
                let message = format!("what is drawn through {} is drawn twice and used once", named(at));
                report.push(
                    Finding::new(Severity::Warning, "drawn-twice", message)
                        .help(format!("it is drawn on line {} of the file and on line {here}", there))
                        .at(at)
                        .line(here),
                );
                continue;
            }
            let message =
                format!("{doubles} of {} elements from {} on are drawn twice", elements.len(), named(at));
            report.push(
                Finding::new(Severity::Fault, "partly-drawn-twice", message)
                    .help(format!("delete one of the two: line {there} and line {here} of the file"))
                    .at(at)
                    .line(here),
            );
        }
        for (element, &middle) in elements.iter().zip(&middles) {
            let number = kept.len() as u32;
            grid.insert(middle, number);
            kept.push((*element, n));
        }
    }
    let mut double = double.into_iter();
    pieces.into_iter().filter(|_| !double.next().unwrap_or(false)).collect()
}

fn is_circle(element: &Element) -> bool {
    matches!(element, Element::Arc { start, end, .. } if start == end)
}

fn is_same(a: &Element, b: &Element) -> bool {
    let near = |p: crate::geometry::Point, q: crate::geometry::Point| (p - q).norm_squared() <= SAME * SAME;
    if is_circle(a) && is_circle(b) {
        return match (a, b) {
            (Element::Arc { centre: c, .. }, Element::Arc { centre: d, .. }) => {
                near(*c, *d) && ((a.start() - c).norm() - (b.start() - d).norm()).abs() <= SAME
            }
            _ => false,
        };
    }
    let ends = (near(a.start(), b.start()) && near(a.end(), b.end()))
        || (near(a.start(), b.end()) && near(a.end(), b.start()));
    ends && near(a.middle(), b.middle())
}
