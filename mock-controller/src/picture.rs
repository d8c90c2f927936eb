//! What was cut, as an SVG: the wire's path, from its pulses.
//!
//! It keeps a bounded number of points however long the program is: when there are too many, points nearer together
//! than a doubled least distance go. The ends of blocks are kept like any other point.

use std::fmt::Write as _;
use std::time::Duration;

use crate::observer::{BlockEnd, Observer};

/// A picture being drawn.
#[derive(Clone, Debug)]
pub struct Picture {
    points: Vec<(i64, i64)>,
    last: (i64, i64),
    least_distance_um: i64,
}

impl Default for Picture {
    fn default() -> Self {
        Picture { points: vec![(0, 0)], last: (0, 0), least_distance_um: 1 }
    }
}

impl Picture {
    fn put(&mut self, point: (i64, i64)) {
        self.last = point;
        if !self.is_far(point) {
            return;
        }
        self.points.push(point);
        if self.points.len() > POINTS_MAX {
            self.least_distance_um *= 2;
            let points = std::mem::take(&mut self.points);
            for point in points {
                if self.points.is_empty() || self.is_far(point) {
                    self.points.push(point);
                }
            }
        }
    }

    fn is_far(&self, (x, y): (i64, i64)) -> bool {
        self.points.last().is_none_or(|&(last_x, last_y)| {
            (x - last_x).abs().max((y - last_y).abs()) >= self.least_distance_um
        })
    }

    /// The picture so far, in mm, y upwards.
    #[must_use]
    pub fn svg(&self) -> String {
        let all = || self.points.iter().chain(std::iter::once(&self.last));
        let (left, right) = all().fold((0, 0), |(low, high), &(x, _)| (low.min(x), high.max(x)));
        let (bottom, top) = all().fold((0, 0), |(low, high), &(_, y)| (low.min(y), high.max(y)));
        let margin = ((right - left).max(top - bottom) / 20).max(100);
        let (width, height) = (right - left + 2 * margin, top - bottom + 2 * margin);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"{} {} {} {}\">\n\
             <title>the path of the wire</title>\n<polyline fill=\"none\" stroke=\"#1450a0\" stroke-width=\"1\" \
             vector-effect=\"non-scaling-stroke\" stroke-linejoin=\"round\" points=\"",
            mm(width),
            mm(height),
            mm(left - margin),
            mm(-top - margin),
            mm(width),
            mm(height),
        );
        for &(x, y) in all() {
            let _ = write!(svg, "{},{} ", mm(x), mm(-y));
        }
        let dot = mm(margin / 5);
        let (end_x, end_y) = self.last;
        let _ = write!(
            svg,
            "\"/>\n<circle cx=\"0\" cy=\"0\" r=\"{dot}\" fill=\"#208020\"/>\n<circle cx=\"{}\" cy=\"{}\" r=\"{dot}\" \
             fill=\"none\" stroke=\"#c02020\" stroke-width=\"1\" vector-effect=\"non-scaling-stroke\"/>\n</svg>\n",
            mm(end_x),
            mm(-end_y),
        );
        svg
    }
}

impl Observer for Picture {
    fn pulse(&mut self, _at: Duration, _block: u64, x_um: i64, y_um: i64) {
        self.put((x_um, y_um));
    }

    fn block_end(&mut self, end: &BlockEnd) {
        self.put((end.end_um[0], end.end_um[1]));
    }
}

/// Whole µm as mm with three decimals, never "-0.000".
fn mm(um: i64) -> String {
    let sign = if um < 0 { "-" } else { "" };
    format!("{sign}{}.{:03}", um.unsigned_abs() / 1000, um.unsigned_abs() % 1000)
}

/// Most points kept; enough for a picture as wide as a wall.
const POINTS_MAX: usize = 100_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stay_bounded_and_the_end_is_drawn() {
        let mut picture = Picture::default();
        for x in 0..1_000_001 {
            picture.put((x, -x));
        }
        assert!(picture.points.len() <= POINTS_MAX);
        assert!(picture.svg().contains("1000.000,1000.000 \""));
    }

    #[test]
    fn millimetres_have_three_decimals_and_no_negative_zero() {
        assert_eq!([mm(0), mm(-1), mm(12_345)].join(" "), "0.000 -0.001 12.345");
    }
}
