//! Corners in a 4B contour.
//!
//! A 4B control sets its wire off by changing the radii of the arcs alone; the lines between only shift. So the contour
//! must run on without a corner at every node, or the offset contour has a gap there. Two headings may differ by 0.1°, and
//! by what the micron lattice explains: an element of length or radius r (the smaller) is known in direction to 1.5 µm / r.

use super::Finding;
use super::contours::{Held, Run};
use crate::geometry::turn;

/// Headings that differ by less run on, radians: 0.1°.
const CORNER: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// How far the lattice moves one end of an element against the other, mm.
const LATTICE_MM: f64 = 0.0015;

/// Looks at the nodes of rings that carry 4B's flag.
#[derive(Debug, Default)]
pub(super) struct Tangency;

impl Tangency {
    pub(super) fn see(&mut self, run: &Run<'_>, tell: &mut impl FnMut(Finding)) {
        let Run::Ring { ring, .. } = *run else { return };
        if !ring.iter().any(|held| held.flag.is_some()) {
            return;
        }
        let next = ring.iter().cycle().skip(1);
        for (held, next) in ring.iter().zip(next) {
            let corner = turn(held.element.heading_at_end(), next.element.heading_at_start()).abs();
            if corner > CORNER + LATTICE_MM * (1.0 / size(held) + 1.0 / size(next)) {
                tell(
                    Finding::error(
                        "not-tangent",
                        next.spot,
                        next.block,
                        format!(
                            "a corner of {:.2}° before this block: 4B can set its wire off only where the contour runs on",
                            corner.to_degrees()
                        ),
                    )
                    .help("put an arc of at least the offset into the corner"),
                );
            }
        }
    }
}

/// The length that fixes an element's direction, mm.
fn size(held: &Held) -> f64 {
    let length = held.element.length();
    held.element.radius().map_or(length, |radius| radius.min(length)).max(f64::MIN_POSITIVE)
}
