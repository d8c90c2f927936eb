//! Which contour lies in which.
//!
//! A line sweeps over the drawing from left to right: a contour is asked only about those the line crosses just then.

use crate::geometry::Point;

use super::Contour;

/// The smallest closed contour that each lies in, given what area each encloses; every contour learns its depth.
pub(super) fn parents(contours: &mut [Contour], areas: &[f64]) -> Vec<Option<usize>> {
    let extents: Vec<[Point; 2]> = contours.iter().map(|c| c.path.extent()).collect();
    // A point on the way, between two nodes: nodes are where contours touch.
    let probes: Vec<Point> = contours.iter().map(|c| c.path.elements()[0].at(0.37)).collect();
    let mut by_left: Vec<usize> = (0..contours.len()).filter(|&n| contours[n].closed).collect();
    by_left.sort_by(|&a, &b| extents[a][0].x.total_cmp(&extents[b][0].x));
    let mut by_probe: Vec<usize> = (0..contours.len()).collect();
    by_probe.sort_by(|&a, &b| probes[a].x.total_cmp(&probes[b].x));
    let mut parents = vec![None; contours.len()];
    let mut crossed: Vec<usize> = Vec::new();
    let mut next = by_left.into_iter().peekable();
    for n in by_probe {
        let probe = probes[n];
        while let Some(left) = next.next_if(|&m| extents[m][0].x <= probe.x) {
            crossed.push(left);
        }
        crossed.retain(|&m| probe.x <= extents[m][1].x);
        let mut smallest: Option<usize> = None;
        for &m in &crossed {
            let [low, high] = extents[m];
            let candidate = m != n
                && low.y <= probe.y
                && probe.y <= high.y
                && areas[m] > areas[n]
                && smallest.is_none_or(|s| areas[m] < areas[s]);
            if candidate && contours[m].path.contains(probe) {
                smallest = Some(m);
            }
        }
        parents[n] = smallest;
    }
    // A parent has a larger area than its child, so the largest learn their depth first.
    let mut by_area: Vec<usize> = (0..contours.len()).collect();
    by_area.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]));
    for n in by_area {
        contours[n].depth = parents[n].map_or(0, |parent: usize| contours[parent].depth + 1);
    }
    parents
}
