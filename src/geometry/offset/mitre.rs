//! Outside corners run to a point: the arc about the corner becomes two straights along the tangents at its ends.

use cavalier_contours::static_aabb2d_index::Control;

use super::source::Source;
use super::{Origin, Outline};
use crate::geometry::{Element, Path, Point};

/// The outline with each corner arc replaced, where the point is within the limit and the wire may go there.
pub(super) fn sharpened(outline: Outline, source: &Source, limit: f64) -> Outline {
    let ways = outline.path.elements();
    let count = ways.len();
    let tip = |n: usize| match (outline.origins[n], ways[n]) {
        (Origin::Corner(_), Element::Arc { start, end, centre, .. }) => {
            // An arc that was cut short by something else has no tangents in common with its neighbours.
            let smooth = outline.path.is_closed() || (0 < n && n + 1 < count);
            let before = ways[(n + count - 1) % count].heading_at_end();
            let after = ways[(n + 1) % count].heading_at_start();
            let smooth = smooth
                && (before - ways[n].heading_at_start()).norm() < SMOOTH
                && (after - ways[n].heading_at_end()).norm() < SMOOTH;
            let half = (start - centre) + (end - centre);
            // Both radii and the half between them: the point lies at radius / cos(half the turn).
            let point = centre + half * (2.0 * (start - centre).norm_squared() / half.norm_squared());
            let within = (point - centre).norm() <= limit * source.left.abs();
            (smooth && within && source.is_free(start, point) && source.is_free(point, end)).then_some(point)
        }
        _ => None,
    };
    let tips: Vec<Option<Point>> = (0..count).map(tip).collect();
    if tips.iter().all(Option::is_none) {
        return outline;
    }
    let before = |n: usize| if n > 0 { Some(n - 1) } else { outline.path.is_closed().then_some(count - 1) };
    let after = |n: usize| if n + 1 < count { Some(n + 1) } else { outline.path.is_closed().then_some(0) };
    let is_line = |n: Option<usize>| n.is_some_and(|n| matches!(ways[n], Element::Line { .. }));
    let tip_at = |n: Option<usize>| n.and_then(|n| tips[n]);
    let mut elements = Vec::with_capacity(count + 4);
    let mut origins = Vec::with_capacity(count + 4);
    for (n, (way, origin)) in ways.iter().zip(&outline.origins).enumerate() {
        let mut add = |start: Point, end: Point| {
            elements.push(Element::Line { start, end });
            origins.push(*origin);
        };
        match (*way, tips[n]) {
            // A straight neighbour is only made longer; beside an arc there is a straight of its own.
            (_, Some(tip)) => {
                if !is_line(before(n)) {
                    add(way.start(), tip);
                }
                if !is_line(after(n)) {
                    add(tip, way.end());
                }
            }
            (Element::Line { start, end }, None) => {
                add(tip_at(before(n)).unwrap_or(start), tip_at(after(n)).unwrap_or(end));
            }
            (Element::Arc { .. }, None) => {
                elements.push(*way);
                origins.push(*origin);
            }
        }
    }
    match Path::new(elements) {
        Some(path) => Outline { path, origins },
        None => outline,
    }
}

impl Source {
    /// Whether the wire keeps its distance from the contour all along a straight.
    fn is_free(&self, from: Point, to: Point) -> bool {
        let least = self.left.abs() - NEAR;
        (0..=SAMPLES).all(|n| {
            let point = from + (to - from) * (n as f64 / SAMPLES as f64);
            let mut free = true;
            let mut visit = |piece: usize| {
                free &= self.piece(piece).distance(point) >= least;
                if free { Control::Continue } else { Control::Break(()) }
            };
            let _ = self.index.visit_query(
                point.x - least,
                point.y - least,
                point.x + least,
                point.y + least,
                &mut visit,
            );
            free
        })
    }
}

/// Two headings nearer than this are one, as lengths of unit vectors.
const SMOOTH: f64 = 1e-4;
/// How much nearer to the contour the library's own nodes may be, mm.
const NEAR: f64 = 1e-4;
/// Places looked at on each straight; the distance changes by less than a quarter of the offset between two.
const SAMPLES: usize = 16;

#[cfg(test)]
mod tests;
