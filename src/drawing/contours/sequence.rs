//! Pieces followed one after another as they stand, each from where the last one ended.
//!
//! For drawings that are programs. An arc of a DXF file has no direction: it is run from the end where the way has come
//! to, and the first of all from the origin, where a program begins. A circle is begun where the way stands, in the
//! sense told beside it. Where neither end of a piece is there, the way begins again, and the next piece tells at which
//! end.

use crate::drawing::finding::{Finding, Severity, named};
use crate::geometry::{Element, Point, Sense};

use super::chain::moved_end;
use super::{Chain, GAP_TOLD, Piece};

/// The contours of pieces in their own order.
pub(super) fn follow(
    pieces: Vec<Piece>,
    join: f64,
    ends_at: Option<Point>,
    report: &mut Vec<Finding>,
) -> Vec<Chain> {
    let mut chains: Vec<Chain> = Vec::new();
    let mut at = Point::origin();
    let mut pieces = pieces.into_iter().peekable();
    let mut fresh = true;
    while let Some(piece) = pieces.next() {
        let near = |a: Point, b: Point| (a - b).norm_squared() <= join * join;
        let (start, end) = (piece.start(), piece.end());
        let Piece { mut elements, layer, line, travel, clockwise } = piece;
        if let [Element::Arc { centre, .. }] = elements[..]
            && start == end
        {
            let sense = if clockwise { Sense::Clockwise } else { Sense::CounterClockwise };
            let on_circle = ((at - centre).norm() - (start - centre).norm()).abs() <= join;
            let start = if on_circle { at } else { start };
            elements = vec![Element::Arc { start, end: start, centre, sense }];
        } else {
            let backwards = match (near(start, at), near(end, at)) {
                (true, false) => false,
                (false, true) => true,
                (true, true) => (end - at).norm_squared() < (start - at).norm_squared(),
                // What the next piece begins at is the end of this one.
                (false, false) => pieces.peek().is_some_and(|next| {
                    let met = |p: Point| near(p, next.start()) || near(p, next.end());
                    met(start) && !met(end)
                }),
            };
            if backwards {
                elements = elements.into_iter().rev().map(Element::reversed).collect();
            }
        }
        let begin = elements[0].start();
        let end = elements[elements.len() - 1].end();
        let joined = near(begin, at);
        match chains.last_mut() {
            Some(chain) if joined && !fresh => {
                // An arc is written with the radius it has at its start, so the start is the point meant.
                if begin != at {
                    if (begin - at).norm() > ROUNDED {
                        let gap = (begin - at).norm();
                        let message = format!(
                            "a gap of {gap:.4} mm is closed between {} and {}",
                            named(at),
                            named(begin)
                        );
                        report.push(Finding::new(Severity::Warning, "gap-closed", message).at(at).line(line));
                    }
                    let last = chain.elements.len() - 1;
                    if is_circle(&chain.elements[last]) {
                        elements[0] = moved_end(elements[0].reversed(), at).reversed();
                    } else {
                        chain.elements[last] = moved_end(chain.elements[last], begin);
                    }
                }
                if chain.layer == layer && chain.travel == travel {
                    chain.elements.extend(elements);
                } else {
                    chains.push(Chain { elements, layer, line, travel });
                }
            }
            _ => {
                // The first of all begins at the origin to the bit.
                if fresh && begin != at && (begin - at).norm() <= ROUNDED {
                    elements[0] = moved_end(elements[0].reversed(), at).reversed();
                }
                chains.push(Chain { elements, layer, line, travel });
            }
        }
        (at, fresh) = (end, false);
    }
    if let (Some(chain), Some(end)) = (chains.last_mut(), ends_at) {
        let last = chain.elements.len() - 1;
        if (chain.elements[last].end() - end).norm() <= ROUNDED && !is_circle(&chain.elements[last]) {
            chain.elements[last] = moved_end(chain.elements[last], end);
        }
    }
    // Where a contour ends on the point where it began but for a rounding, it is closed.
    for chain in &mut chains {
        let (first, last) = (chain.elements[0].start(), chain.elements.len() - 1);
        let end = chain.elements[last].end();
        let is_off = end != first && (end - first).norm() <= ROUNDED;
        if is_off && chain.elements.len() > 1 && !is_circle(&chain.elements[last]) {
            chain.elements[last] = moved_end(chain.elements[last], first);
        }
    }
    chains
}

/// Whether an element is a full circle: with its end moved it would be an arc of next to nothing, or of next to all.
fn is_circle(element: &Element) -> bool {
    matches!(element, Element::Arc { start, end, .. } if start == end)
}

/// The end of an arc whose radii differ by a rounding to the micron lies up to this beside the point meant, mm.
const ROUNDED: f64 = 3.0 * GAP_TOLD;
