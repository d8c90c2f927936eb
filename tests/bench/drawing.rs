//! Speed of reading drawings, as a Markdown table: `cargo bench --bench drawing`.
//!
//! The drawing is made in memory: 100,000 entities in closed contours of lines, arcs, polylines with bulges, circles,
//! inserted blocks, ellipses and splines, their order shuffled so that no contour stands together. Every figure is
//! the median of five runs. With `PEER_PYTHON`, a Python that has ezdxf, the same files are read by it in the same run.
//! Nothing is asserted: machines are noisy.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

use std::fmt::Write;
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use dripfeed::drawing::dxf::{self, Drawing, Options};
use dripfeed::geometry::Point;
use dripfeed::geometry::biarc::{Elements, Fit, fit};
use dripfeed::geometry::spline::Spline;

const RUNS: usize = 5;
const ENTITIES: usize = 100_000;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench drawing`");
        return;
    }
    println!("| what | median | runs (lowest - highest) |\n|---|---|---|");
    let mixed = drawing(&mixed(ENTITIES));
    if let Some(path) = std::env::var_os("DRAWING") {
        std::fs::write(path, &mixed).unwrap();
    }
    let lines = drawing(&squares(ENTITIES));
    for (name, text) in [("mixed", &mixed), ("lines only", &lines)] {
        let read = || dxf::read(text.as_bytes(), &Options::default()).unwrap();
        let Drawing { contours, report, .. } = read();
        let elements: usize = contours.iter().map(|c| c.path.elements().len()).sum();
        eprintln!(
            "{name}: {} bytes, {} contours, {elements} elements, {} findings",
            text.len(),
            contours.len(),
            report.len()
        );
        row(&format!("{ENTITIES} entities, {name}: file to contours in order"), "s", || {
            black_box(read());
        });
        // Without layers nothing is traced or joined: what is left is reading.
        let nothing = Options { layers: Some(vec![]), ..Options::default() };
        row(&format!("{ENTITIES} entities, {name}: reading alone"), "s", || {
            black_box(dxf::read(text.as_bytes(), &nothing).unwrap());
        });
        row(&format!("{ENTITIES} entities, {name}: the `dxf` crate alone"), "s", || {
            black_box(::dxf::Drawing::load(&mut text.as_bytes()).unwrap());
        });
        if let Some(python) = std::env::var_os("PEER_PYTHON") {
            let file = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(file.path(), text).unwrap();
            let output = Command::new(python).arg("-c").arg(EZDXF).arg(file.path()).output().unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let values = String::from_utf8(output.stdout).unwrap();
            let values = values.split_whitespace().map(|value| value.parse().unwrap()).collect();
            told(&format!("{ENTITIES} entities, {name}: `ezdxf.readfile`, no contours (peer)"), "s", values);
        }
    }
    let spline = wave();
    for elements in [Elements::Biarcs, Elements::Lines, Elements::Fewest] {
        let count = fit(&spline, &Fit { elements, ..Fit::within(0.001) }).unwrap().len();
        row(&format!("a spline of 10 spans in {count} elements, {elements:?}, 1000 times"), "s", || {
            for _ in 0..1000 {
                black_box(fit(&spline, &Fit { elements, ..Fit::within(0.001) }).unwrap());
            }
        });
    }
}

/// Prints the seconds of five readings.
const EZDXF: &str = "
import sys, time, ezdxf
for _ in range(5):
    began = time.perf_counter()
    ezdxf.readfile(sys.argv[1])
    print(time.perf_counter() - began)
";

fn row(what: &str, unit: &str, mut work: impl FnMut()) {
    let values: Vec<f64> = (0..RUNS)
        .map(|_| {
            let began = Instant::now();
            work();
            began.elapsed().as_secs_f64()
        })
        .collect();
    told(what, unit, values);
}

fn told(what: &str, unit: &str, mut values: Vec<f64>) {
    values.sort_by(f64::total_cmp);
    println!(
        "| {what} | {:.3} {unit} | {RUNS} ({:.3} - {:.3}) |",
        values[RUNS / 2],
        values[0],
        values[RUNS - 1]
    );
}

fn wave() -> Spline {
    let controls: Vec<Point> =
        (0..13).map(|n| Point::new(f64::from(n), if n % 2 == 0 { 0.0 } else { 1.5 })).collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..11).map(f64::from));
    knots.extend([10.0; 3]);
    Spline::new(3, knots, &controls, &[]).unwrap()
}

fn drawing(entities: &[String]) -> String {
    let mut text = String::from(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n100\nAcDbEntity\n8\n0\n100\nAcDbBlockBegin\n2\nHOLE\n70\n0\n10\n0\n20\n0\n30\n0\n3\nHOLE\n1\n\n0\nCIRCLE\n100\nAcDbEntity\n8\n0\n100\nAcDbCircle\n10\n0\n20\n0\n30\n0\n40\n1.5\n0\nENDBLK\n100\nAcDbEntity\n8\n0\n100\nAcDbBlockEnd\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n",
    );
    text.extend(entities.iter().map(String::as_str));
    text.push_str("0\nENDSEC\n0\nEOF\n");
    text
}

fn line(a: [f64; 2], b: [f64; 2]) -> String {
    format!(
        "0\nLINE\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbLine\n10\n{}\n20\n{}\n30\n0\n11\n{}\n21\n{}\n31\n0\n",
        a[0], a[1], b[0], b[1]
    )
}

/// Parts in rows, each of 20 entities: a rounded outline of lines and arcs, and holes of every kind in it.
fn mixed(count: usize) -> Vec<String> {
    let mut entities = Vec::with_capacity(count + 20);
    let mut part = 0usize;
    while entities.len() < count {
        let (x, y) = ((part % 70) as f64 * 60.0, (part / 70) as f64 * 40.0);
        let p = |a: f64, b: f64| [x + a, y + b];
        entities.push(line(p(4.0, 0.0), p(46.0, 0.0)));
        entities.push(line(p(50.0, 26.0), p(50.0, 4.0)));
        entities.push(line(p(46.0, 30.0), p(4.0, 30.0)));
        entities.push(line(p(0.0, 4.0), p(0.0, 26.0)));
        for (cx, cy, from) in [(46.0, 4.0, 270), (46.0, 26.0, 0), (4.0, 26.0, 90), (4.0, 4.0, 180)] {
            let [cx, cy] = p(cx, cy);
            let to = from + 90;
            entities.push(format!("0\nARC\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbCircle\n10\n{cx}\n20\n{cy}\n30\n0\n40\n4\n100\nAcDbArc\n50\n{from}\n51\n{to}\n"));
        }
        for k in 0..4 {
            let [cx, cy] = p(8.0 + 8.0 * f64::from(k), 6.0);
            entities.push(format!(
                "0\nCIRCLE\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbCircle\n10\n{cx}\n20\n{cy}\n30\n0\n40\n2.25\n"
            ));
            let [cx, cy] = p(8.0 + 8.0 * f64::from(k), 24.0);
            entities.push(format!("0\nINSERT\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbBlockReference\n2\nHOLE\n10\n{cx}\n20\n{cy}\n30\n0\n50\n30\n"));
        }
        for k in 0..2 {
            let mut slot =
                String::from("0\nLWPOLYLINE\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbPolyline\n90\n4\n70\n1\n");
            let off = 11.0 * f64::from(k);
            for (a, b, bulge) in [(8.0, 13.0, 0.0), (14.0, 13.0, 1.0), (14.0, 17.0, 0.0), (8.0, 17.0, 1.0)] {
                let [a, b] = p(a + off, b);
                let _ = write!(slot, "10\n{a}\n20\n{b}\n42\n{bulge}\n");
            }
            entities.push(slot);
        }
        let [cx, cy] = p(36.0, 15.0);
        entities.push(format!(
            "0\nELLIPSE\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbEllipse\n10\n{cx}\n20\n{cy}\n30\n0\n11\n3\n21\n1\n31\n0\n40\n0.5\n41\n0\n42\n{}\n",
            std::f64::consts::TAU
        ));
        let mut spline = String::from(
            "0\nSPLINE\n100\nAcDbEntity\n8\nPARTS\n100\nAcDbSpline\n70\n8\n71\n3\n72\n11\n73\n7\n74\n0\n",
        );
        for knot in [0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4] {
            let _ = write!(spline, "40\n{knot}\n");
        }
        for (a, b) in
            [(45.0, 15.0), (45.0, 18.0), (42.0, 19.0), (41.0, 15.0), (42.0, 11.0), (45.0, 12.0), (45.0, 15.0)]
        {
            let [a, b] = p(a, b);
            let _ = write!(spline, "10\n{a}\n20\n{b}\n30\n0\n");
        }
        entities.push(spline);
        part += 1;
    }
    entities.truncate(count);
    shuffled(entities)
}

fn squares(count: usize) -> Vec<String> {
    let side = ((count / 4) as f64).sqrt().ceil() as usize;
    let entities = (0..count / 4).flat_map(|n| {
        let (x, y) = ((n % side) as f64 * 3.0, (n / side) as f64 * 3.0);
        let corners = [[x, y], [x + 2.0, y], [x + 2.0, y + 2.0], [x, y + 2.0]];
        (0..4).map(move |k| line(corners[k], corners[(k + 1) % 4]))
    });
    shuffled(entities.collect())
}

fn shuffled(mut entities: Vec<String>) -> Vec<String> {
    let mut state = 7u64;
    for n in (1..entities.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        entities.swap(n, (state >> 33) as usize % (n + 1));
    }
    entities
}
