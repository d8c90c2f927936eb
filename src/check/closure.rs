//! Contours that do not close.
//!
//! A cut that comes back within 3 µm of a node has closed ([`super::contours`]). One that ends a little way off a node it
//! passed long before was meant to close; one that ends far from all of them is open, which a parting cut may be.

use super::Finding;
use super::contours::{CLOSED_MM, Held, Run};

/// A gap beyond this, mm, is no gap but an open cut.
const GAP_MM: f64 = 1.0;

/// A gap up to this, mm, may be the rounding of a program of differences; a larger one is a wrong number.
const ROUNDING_MM: f64 = 0.010;

/// The way round must be so many times the gap: short cuts end near each other anyway.
const WAY_PER_GAP: f64 = 10.0;

/// Looks at what chains leave.
#[derive(Debug, Default)]
pub(super) struct Closure;

impl Closure {
    pub(super) fn see(&mut self, run: &Run<'_>, tell: &mut impl FnMut(Finding)) {
        match run {
            Run::Ring { .. } | Run::Retrace(_) => {}
            Run::Rest { held, fresh, rings } => rest(held, *fresh, *rings, tell),
            Run::TooLong(held) => {
                let Some(first) = held.first() else { return };
                tell(
                    Finding::warning(
                        "not-checked",
                        first.spot,
                        first.block,
                        format!(
                            "more than {} cuts without a closed contour: closure, crossing and lead-in are not checked",
                            held.len()
                        ),
                    )
                    .help("split the program at a pause, or see that its contours close"),
                );
            }
        }
    }
}

fn rest(held: &[Held], fresh: usize, rings: u64, tell: &mut impl FnMut(Finding)) {
    let Some(last) = held.last() else { return };
    if fresh == 0 {
        return;
    }
    let end = last.element.end();
    let along = last.along() + last.element.length();
    // Behind a ring the way out need not come back to the way in.
    let from = if rings > 0 { held.len() - fresh } else { 0 };
    let nearest = held[from..]
        .iter()
        .map(|node| ((node.element.start() - end).norm(), node))
        .filter(|(gap, node)| *gap <= GAP_MM && along - node.along() >= gap * WAY_PER_GAP)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        // A contour too small to be told from its nodes.
        Some((gap, _)) if gap <= CLOSED_MM => {}
        Some((gap, node)) => {
            let message = format!(
                "the contour does not close: it ends {:.1} µm from where block {} began",
                gap * 1000.0,
                node.block
            );
            let finding = if gap <= ROUNDING_MM { Finding::warning } else { Finding::error };
            tell(
                finding("contour-gap", last.spot, last.block, message)
                    .help("check the numbers of the blocks between; 3 µm is allowed"),
            );
        }
        None if rings == 0 && held.len() > 1 => {
            let message = "the cut is open: it ends at none of the points it passed";
            tell(
                Finding::warning("contour-open", last.spot, last.block, message)
                    .help("this is right for a parting cut; a part would not come out"),
            );
        }
        None => {}
    }
}
