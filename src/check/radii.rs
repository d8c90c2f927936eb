//! Arcs whose start and end lie at different distances from the centre.
//!
//! Start, end and centre stand on a lattice of a micron, each up to √2/2 µm from where it was meant. Each radius can so be
//! wrong by √2 µm, and two of them apart by 2√2 = 2.83 µm: up to 3 µm the lattice explains it, beyond it a number is wrong.

use super::Finding;
use crate::geometry::Element;
use crate::motion::{Act, Motion};

/// How far the radii may be apart, mm.
const APART_MM: f64 = 0.003;

pub(super) fn see(motion: &Motion, tell: &mut impl FnMut(Finding)) {
    let Act::Move { element, upper, .. } = &motion.act else { return };
    for (element, which) in
        std::iter::once((element, "")).chain(upper.iter().map(|u| (u, " of the upper end")))
    {
        let Element::Arc { start, end, centre, .. } = *element else { continue };
        let (from, to) = ((start - centre).norm(), (end - centre).norm());
        if from == 0.0 && to == 0.0 {
            tell(
                Finding::error(
                    "arc-no-radius",
                    motion.spot,
                    motion.block,
                    format!("the arc{which} has no radius"),
                )
                .help("check the centre: I and J are seen from the arc's start"),
            );
        } else if (from - to).abs() > APART_MM {
            tell(
                Finding::error(
                    "arc-radii",
                    motion.spot,
                    motion.block,
                    format!(
                        "the arc{which} starts at radius {from:.4} mm and ends at {to:.4} mm, {:.1} µm apart",
                        (from - to).abs() * 1000.0
                    ),
                )
                .help("check end and centre; 3 µm is allowed for numbers rounded to the micron"),
            );
        }
    }
}
