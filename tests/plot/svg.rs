//! A reader of just so much SVG as a plot is made of, apart from the program that writes it.
//!
//! Arcs are taken from their ends, radius and flags as the SVG specification says (implementation notes, F.6.5). Y is
//! turned up again, so that points are those of the program.

#![expect(clippy::disallowed_methods, reason = "the system's trigonometry, apart from the program's own")]

/// A picture as read.
#[derive(Debug)]
pub(crate) struct Svg {
    /// Width and height on paper, mm.
    pub(crate) size: [f64; 2],
    /// Left, bottom, width, height, in user units.
    pub(crate) view: [f64; 4],
    pub(crate) marks: Vec<Mark>,
}

/// One `path` element.
#[derive(Clone, Debug)]
pub(crate) struct Mark {
    pub(crate) class: String,
    /// The pen of its own, if it has one.
    pub(crate) pen: Option<f64>,
    pub(crate) says: Option<String>,
    /// Lines and arcs as points close to each other; each run by itself.
    pub(crate) runs: Vec<Vec<[f64; 2]>>,
}

/// Lowest and highest X and Y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) min: [f64; 2],
    pub(crate) max: [f64; 2],
}

impl Bounds {
    pub(crate) fn of(points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut all = Self { min: [f64::INFINITY; 2], max: [f64::NEG_INFINITY; 2] };
        for point in points {
            for (axis, value) in point.into_iter().enumerate() {
                all.min[axis] = all.min[axis].min(value);
                all.max[axis] = all.max[axis].max(value);
            }
        }
        assert!(all.min[0].is_finite(), "no point at all");
        all
    }

    /// The farthest that a side lies from the same side of another, µm.
    pub(crate) fn off_um(&self, other: &Self) -> f64 {
        (0..2)
            .flat_map(|axis| [self.min[axis] - other.min[axis], self.max[axis] - other.max[axis]])
            .fold(0.0, |most: f64, off| most.max(off.abs() * 1000.0))
    }
}

impl Svg {
    pub(crate) fn read(text: &str) -> Self {
        let head = tags(text, "svg").next().expect("an svg element");
        let mm =
            |name| attribute(head, name).expect(name).strip_suffix("mm").expect("mm").parse().expect(name);
        let view = numbers(attribute(head, "viewBox").expect("a viewBox"));
        let marks = tags(text, "path").map(Mark::read).collect();
        let view = [view[0], -view[1] - view[3], view[2], view[3]];
        Self { size: [mm("width"), mm("height")], view, marks }
    }

    /// The marks of a class.
    pub(crate) fn of<'a>(&'a self, class: &'a str) -> impl Iterator<Item = &'a Mark> {
        self.marks.iter().filter(move |mark| mark.class == class)
    }

    /// What texts say.
    pub(crate) fn words(&self) -> Vec<&str> {
        self.marks.iter().filter_map(|mark| mark.says.as_deref()).collect()
    }

    pub(crate) fn bounds(&self, class: &str) -> Bounds {
        Bounds::of(self.of(class).flat_map(Mark::points))
    }
}

impl Mark {
    fn read(tag: &str) -> Self {
        let pen = attribute(tag, "style").and_then(|style| style.strip_prefix("stroke-width:"));
        Self {
            class: attribute(tag, "class").expect("a class").to_owned(),
            pen: pen.map(|pen| pen.parse().expect("a number")),
            says: attribute(tag, "aria-label").map(str::to_owned),
            runs: runs(attribute(tag, "d").expect("data")),
        }
    }

    pub(crate) fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.runs.iter().flatten().copied()
    }

    /// How far a point lies from the lines of this mark, mm.
    pub(crate) fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        let pairs = self.runs.iter().flat_map(|run| run.windows(2));
        pairs.fold(f64::INFINITY, |least, pair| {
            let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
            let (dx, dy) = (bx - ax, by - ay);
            let square = dx * dx + dy * dy;
            let t =
                if square > 0.0 { (((x - ax) * dx + (y - ay) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
            least.min((x - ax - t * dx).hypot(y - ay - t * dy))
        })
    }
}

fn tags<'a>(text: &'a str, name: &'a str) -> impl Iterator<Item = &'a str> {
    text.split('<').skip(1).filter_map(move |piece| {
        let tag = piece.split_once('>').expect("a tag ends").0;
        tag.strip_prefix(name).filter(|rest| rest.starts_with(' '))
    })
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let from = tag.find(&format!(" {name}=\""))? + name.len() + 3;
    tag[from..].split_once('"').map(|(value, _)| value)
}

fn numbers(text: &str) -> Vec<f64> {
    let spaced = text.replace('-', " -");
    spaced.split_ascii_whitespace().map(|number| number.parse().expect("a number")).collect()
}

fn runs(data: &str) -> Vec<Vec<[f64; 2]>> {
    let mut runs: Vec<Vec<[f64; 2]>> = Vec::new();
    let starts: Vec<usize> =
        data.match_indices(|c: char| c.is_ascii_alphabetic()).map(|(at, _)| at).collect();
    for (n, &start) in starts.iter().enumerate() {
        let end = starts.get(n + 1).copied().unwrap_or(data.len());
        let values = numbers(&data[start + 1..end]);
        let here = runs.last().and_then(|run| run.last()).copied();
        match (&data[start..=start], &values[..]) {
            ("M", &[x, y]) => runs.push(vec![[x, -y]]),
            ("L", &[x, y]) => runs.last_mut().expect("begun").push([x, -y]),
            ("A", &[rx, ry, 0.0, large, sweep, x, y]) if rx == ry => {
                let points = arc(here.expect("begun"), [x, -y], rx, large == 1.0, sweep == 0.0);
                runs.last_mut().expect("begun").extend(points);
            }
            ("C", &[.., x, y]) => runs.last_mut().expect("begun").push([x, -y]),
            ("Z", &[]) => {
                let run = runs.last_mut().expect("begun");
                run.push(run[0]);
            }
            other => panic!("{other:?} in {data}"),
        }
    }
    runs
}

/// An arc with Y up, as points of which the outermost are on it exactly.
fn arc(from: [f64; 2], to: [f64; 2], radius: f64, large: bool, ccw: bool) -> Vec<[f64; 2]> {
    use std::f64::consts::{FRAC_PI_2, TAU};
    let (mx, my) = ((from[0] - to[0]) / 2.0, (from[1] - to[1]) / 2.0);
    let half = mx.hypot(my);
    // Radii too small for the chord are enlarged.
    let radius = radius.max(half);
    let rise = (radius * radius - half * half).max(0.0).sqrt() / half;
    let side = if large == ccw { 1.0 } else { -1.0 };
    let centre = [(from[0] + to[0]) / 2.0 + side * rise * -my, (from[1] + to[1]) / 2.0 + side * rise * mx];
    let angle = |p: [f64; 2]| (p[1] - centre[1]).atan2(p[0] - centre[0]);
    let (a, mut b) = (angle(from), angle(to));
    match ccw {
        true if b <= a => b += TAU,
        false if b >= a => b -= TAU,
        _ => {}
    }
    let at = |angle: f64| [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()];
    let mut angles: Vec<f64> = (1..64).map(|n| a + (b - a) * f64::from(n) / 64.0).collect();
    angles.extend((-8..=8).map(|n| f64::from(n) * FRAC_PI_2).filter(|q| a.min(b) < *q && *q < a.max(b)));
    angles.sort_by(|p, q| if ccw { p.total_cmp(q) } else { q.total_cmp(p) });
    let mut points: Vec<[f64; 2]> = angles.into_iter().map(at).collect();
    points.push(to);
    points
}

#[test]
fn this_reader_knows_which_way_an_arc_turns() {
    // The same two ends, all four arcs between them.
    for (data, min, max) in [
        ("M1 0A1 1 0 0 0 0-1", [0.0, 0.0], [1.0, 1.0]),
        ("M1 0A1 1 0 0 1 0-1", [0.0, 0.0], [1.0, 1.0]),
        ("M1 0A1 1 0 1 1 0-1", [-1.0, -1.0], [1.0, 1.0]),
        ("M1 0A1 1 0 1 0 0-1", [0.0, 0.0], [2.0, 2.0]),
    ] {
        let bounds = Bounds::of(runs(data).into_iter().flatten());
        assert!(bounds.off_um(&Bounds { min, max }) < 1e-6, "{data}: {bounds:?}");
    }
    assert!((runs("M1 0A1 1 0 0 0 0-1")[0][32][0] - 0.5f64.sqrt()).abs() < 0.02);
    assert!((runs("M1 0A1 1 0 0 1 0-1")[0][32][0] - (1.0 - 0.5f64.sqrt())).abs() < 0.02);
}
