//! The offset of the paper's gear beside the bare library call, as a Markdown table: `cargo bench --bench offset`.
//!
//! Both work on the same 252 elements by 0.07 mm. The bare call is given the polyline ready made and nothing else; ours
//! takes a path, looks for places where it meets itself, gives the arcs their centres back, says what each element
//! runs beside and what is not reached. Rounds alternate and are short, so that what slows the machine slows both, or one
//! round of many.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

use std::hint::black_box;
use std::time::Instant;

use cavalier_contours::polyline::{PlineSource, PlineSourceMut, Polyline};
use dripfeed::geometry::offset::{Corners, offset};
use dripfeed::geometry::{Element, Path, Sense};
use dripfeed::shapes::cycloid_gear::{CycloidGear, Direction, Trim};

const ROUNDS: usize = 201;
const CALLS: u32 = 20;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench offset`");
        return;
    }
    let outline = CycloidGear::default().outline(0.0, Direction::Clockwise, Trim::Refuse).unwrap();
    let path = Path::new(outline.elements().collect()).unwrap();
    let polyline = polyline(&path);
    let mut rows: [Vec<f64>; 3] = Default::default();
    for _ in 0..ROUNDS {
        let bare = microseconds(|| drop(black_box(black_box(&polyline).parallel_offset(0.07))));
        let ours = microseconds(|| drop(black_box(offset(black_box(&path), 0.07, Corners::Round))));
        rows[0].push(bare);
        rows[1].push(ours);
        rows[2].push(ours / bare);
    }
    println!("| what | median | runs (lowest - highest) |\n|---|---|---|");
    let [bare, ours, ratio] = rows;
    row("bare call of the library, 252 elements by 0.07 mm", "µs", bare);
    row("`geometry::offset::offset`, the same", "µs", ours);
    row("ours over bare, run by run", "", ratio);
}

fn microseconds(work: impl Fn()) -> f64 {
    let began = Instant::now();
    for _ in 0..CALLS {
        work();
    }
    began.elapsed().as_secs_f64() * 1e6 / f64::from(CALLS)
}

fn row(what: &str, unit: &str, mut values: Vec<f64>) {
    values.sort_by(f64::total_cmp);
    let (low, high) = (values[0], values[values.len() - 1]);
    let median = values[values.len() / 2];
    println!("| {what} | {median:.2} {unit} | {} ({low:.2} - {high:.2}) |", values.len());
}

/// The polyline of a path whose arcs are all under half a circle.
fn polyline(path: &Path) -> Polyline {
    let mut polyline = Polyline::new_closed();
    for element in path.elements() {
        let bulge = match *element {
            Element::Line { .. } => 0.0,
            Element::Arc { sense, .. } => {
                let quarter = libm::tan(element.sweep() / 4.0);
                if sense == Sense::CounterClockwise { quarter } else { -quarter }
            }
        };
        polyline.add(element.start().x, element.start().y, bulge);
    }
    polyline
}
