//! LinuxCNC's `rs274` against the writer and the reader of G-code: the same nodes, the same arcs, no complaint.
//!
//! It prints what its interpreter would have a machine do, in the coordinates of the program, with four decimals.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use dripfeed::formats::Writer as _;
use dripfeed::formats::gcode::{Dialect, Layout, Motions, Writer};
use dripfeed::geometry::{Element, Point, Sense, Vector};
use dripfeed::motion::{Act, Motion, Travel};
use dripfeed::place::Spot;

/// How far a node may lie from ours, mm: a micron, and half of what four decimals cannot say.
const NODE: f64 = 0.001_05;
/// The same of a centre, which is moved by a micron where the radii agree better so.
const CENTRE: f64 = 0.002_2;

#[test]
fn paths_of_lines_and_arcs_are_written_as_rs274_understands_them() {
    for seed in 0..30 {
        let motions = random_path(seed);
        for layout in [
            Layout::default(),
            Layout { suppress: true, ..Layout::default() },
            Layout { number_step: Some(5), suppress: true, ..Layout::default() },
        ] {
            let mut writer = Writer::with_layout(Dialect::generic().unwrap(), layout);
            let mut text = Vec::new();
            for motion in &motions {
                writer.write(motion, &mut text).unwrap();
            }
            writer.finish(&mut text).unwrap();
            let text = String::from_utf8(text).unwrap();
            compare(&moves(motions.iter().cloned()), &text, NODE);
        }
    }
}

#[test]
fn programs_with_increments_radii_and_words_left_out_are_read_as_rs274_reads_them() {
    for seed in 100..130 {
        let text = random_program(seed);
        let read = Motions::new(text.as_bytes(), Dialect::generic().unwrap());
        let ours = moves(read.map(|m| m.unwrap_or_else(|e| panic!("{e} {e:?}\n{text}"))));
        assert!(ours.len() > 100);
        // Both read the same digits; only the print is rounded.
        compare(&ours, &text, 0.000_3);
    }
}

#[test]
fn the_sample_of_the_generic_dialect_is_read_as_rs274_reads_it() {
    let sample = std::fs::read_to_string("tests/data/dialects/generic.nc").unwrap();
    // There is no offset register here, and a dwell says its time with P.
    let mut text = sample.replace("G04 X1.5", "G04 P0.01");
    for word in ["G41 D1", "G42 D2", "G40", "S1", "S2"] {
        assert!(text.contains(word));
        text = text.replace(word, "");
    }
    let text = text.replace("X.", "X0.");
    let read = Motions::new(text.as_bytes(), Dialect::generic().unwrap());
    compare(&moves(read.map(|m| m.unwrap())), &text, 0.000_1);
}

#[test]
fn rs274_is_asked_in_earnest() {
    let text = "G21 G90\nF100.\nG92 X0. Y0.\nG01 X1. Y0.\nG02 X5. Y0. I1. J0.\nM02\n";
    assert!(canon(text).unwrap_err().contains("Radius to end of arc differs"));
    let text = "G21 G90\nF100.\nG92 X0. Y0.\nG03 X0. Y0. I-1. J0.\nM02\n";
    let [Canon::Arc { end, centre, turns }] = canon(text).unwrap()[..] else { panic!() };
    assert_eq!((end, centre, turns), (Point::new(0.0, 0.0), Point::new(-1.0, 0.0), 1));
}

fn compare(ours: &[(Travel, Element)], text: &str, node: f64) {
    let theirs = canon(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(ours.len(), theirs.len(), "{text}");
    for ((travel, element), theirs) in ours.iter().zip(&theirs) {
        match (travel, element, theirs) {
            (Travel::Rapid, Element::Line { end, .. }, Canon::Traverse(to))
            | (Travel::Cut, Element::Line { end, .. }, Canon::Feed(to)) => {
                assert!((end - to).norm() <= node, "{element:?} {theirs:?}\n{text}");
            }
            (
                Travel::Cut,
                Element::Arc { end, centre, sense, .. },
                Canon::Arc { end: to, centre: about, turns },
            ) => {
                assert!((end - to).norm() <= node, "{element:?} {theirs:?}\n{text}");
                assert!((centre - about).norm() <= node.max(CENTRE), "{element:?} {theirs:?}\n{text}");
                let expected = if *sense == Sense::CounterClockwise { 1 } else { -1 };
                assert_eq!(*turns, expected, "{element:?}\n{text}");
            }
            _ => panic!("{travel:?} {element:?} is {theirs:?}\n{text}"),
        }
    }
}

fn moves(motions: impl Iterator<Item = Motion>) -> Vec<(Travel, Element)> {
    motions
        .filter_map(|m| match m.act {
            Act::Move { travel, element, .. } => Some((travel, element)),
            _ => None,
        })
        .collect()
}

/// What `rs274` has the machine do.
#[derive(Clone, Copy, Debug)]
enum Canon {
    Traverse(Point),
    Feed(Point),
    Arc { end: Point, centre: Point, turns: i32 },
}

/// The motions `rs274` makes of a program, or what it complains about.
fn canon(text: &str) -> Result<Vec<Canon>, String> {
    let calls = interpreted(text)?;
    // The first G92 says where the program begins; the next ones shift its coordinates, and ours go on as they were.
    let (mut first, mut shift, mut shifts) = (Vector::zeros(), Vector::zeros(), 0);
    let mut motions = Vec::new();
    for (name, numbers) in calls.lines().filter_map(call) {
        let point = |n: usize| Point::new(numbers[n], numbers[n + 1]) + shift - first;
        match name {
            "SET_G92_OFFSET" => {
                shift = Vector::new(numbers[0], numbers[1]);
                // Before the program it says that there is no shift.
                if shifts <= 1 {
                    first = shift;
                }
                shifts += 1;
            }
            "STRAIGHT_TRAVERSE" => motions.push(Canon::Traverse(point(0))),
            "STRAIGHT_FEED" => motions.push(Canon::Feed(point(0))),
            _ => motions.push(Canon::Arc { end: point(0), centre: point(2), turns: numbers[4] as i32 }),
        }
    }
    Ok(motions)
}

/// What `rs274` says a machine is to do.
pub(crate) fn interpreted(text: &str) -> Result<String, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("program.nc");
    std::fs::write(&file, text).unwrap();
    // It has a piece of memory by one name: two at a time spoil it for each other.
    static ONE: Mutex<()> = Mutex::new(());
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    // -g: through the whole file at once.
    let run = Command::new("rs274").arg("-g").arg(&file).current_dir(directory.path()).output();
    let run = run.expect("rs274 is installed: Debian's linuxcnc-uspace");
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    if !run.status.success() || said.trim() != "executing" {
        return Err(format!("{}: {said}", run.status));
    }
    let calls = String::from_utf8(run.stdout).unwrap();
    assert!(calls.contains("PROGRAM_END()"), "{calls}");
    Ok(calls)
}

/// Name and numbers of a line such as `   12 N..... STRAIGHT_FEED(0.0000, 12.0000, …)`, where it is of a motion.
pub(crate) fn call(line: &str) -> Option<(&str, Vec<f64>)> {
    let (name, rest) = line.get(12..)?.trim().split_once('(')?;
    if !["SET_G92_OFFSET", "STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"].contains(&name) {
        return None;
    }
    let numbers = rest.trim_end_matches(')').split(',').map(|number| number.trim().parse().unwrap());
    Some((name, numbers.collect()))
}

/// Numbers that only look random, the same every time.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: u64) -> u64 {
        // Knuth's multiplier; the high bits are the good ones.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.below(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn sign(&mut self) -> f64 {
        if self.below(2) == 0 { 1.0 } else { -1.0 }
    }
}

/// Two hundred motions one behind the other, with nodes on no grid.
fn random_path(seed: u64) -> Vec<Motion> {
    let mut numbers = Numbers(seed);
    let mut at = Point::new(numbers.between(-50.0, 50.0), numbers.between(-50.0, 50.0));
    let mut acts = vec![Act::Word((*b"F100.").into())];
    for _ in 0..200 {
        let element = match numbers.below(8) {
            0..4 => Element::Line {
                start: at,
                end: Point::new(numbers.between(-200.0, 200.0), numbers.between(-200.0, 200.0)),
            },
            4 => Element::Line {
                start: at,
                end: at + Vector::new(numbers.between(-0.01, 0.01), numbers.between(-0.01, 0.01)),
            },
            5 => {
                let size = numbers.between(0.05, 60.0);
                arc(at, &mut numbers, size, TAU)
            }
            _ => {
                let (size, sweep) = (numbers.between(0.05, 150.0), numbers.between(0.1, TAU - 0.1));
                arc(at, &mut numbers, size, sweep)
            }
        };
        at = element.end();
        let is_rapid = matches!(element, Element::Line { .. }) && numbers.below(10) == 0;
        let travel = if is_rapid { Travel::Rapid } else { Travel::Cut };
        acts.push(Act::Move { travel, element, upper: None, flag: None });
    }
    let numbered = |(n, act)| Motion { act, block: n as u64 + 1, spot: Spot::default() };
    acts.into_iter().enumerate().map(numbered).collect()
}

/// An arc of a radius and a sweep from a point.
fn arc(start: Point, numbers: &mut Numbers, radius: f64, sweep: f64) -> Element {
    let from = numbers.between(-PI, PI);
    let about = |angle: f64| Vector::new(libm::cos(angle), libm::sin(angle)) * radius;
    let centre = start - about(from);
    let turn = numbers.sign();
    let sense = if turn > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
    let end = if sweep == TAU { start } else { centre + about(from + turn * sweep) };
    Element::Arc { start, end, centre, sense }
}

/// A program with G90 and G91, R and IJ, words in force left out, blanks here and there, and G92 in the middle.
fn random_program(seed: u64) -> String {
    let mut numbers = Numbers(seed);
    let mut text = "%\nO0100\nN1 G21G90 F100.\nG92 X0. Y0.\n".to_owned();
    // From where the last G92 said, in microns.
    let mut at = [0i64, 0];
    let mut is_relative = false;
    let mut mode = None;
    for n in 0..200u64 {
        if numbers.below(4) == 0 {
            write!(text, "N{} ", 10 * n + 10).unwrap();
        }
        if numbers.below(9) == 0 {
            is_relative = !is_relative;
            text.push_str(if is_relative { "G91 " } else { "g90" });
        } else if numbers.below(40) == 0 {
            at = [numbers.below(50_000) as i64, -(numbers.below(50_000) as i64)];
            writeln!(text, "G92 X{} Y{}", millimetres(at[0]), millimetres(at[1])).unwrap();
            continue;
        }
        let chosen = numbers.below(4);
        // In force already: left out half the time.
        if mode != Some(chosen) || numbers.below(2) == 0 {
            write!(text, "G{}{chosen} ", if numbers.below(2) == 0 { "0" } else { "" }).unwrap();
        }
        mode = Some(chosen);
        let way = [0, 1].map(|_| numbers.below(40_000) as i64 - 20_000 - at[0] / 8 + 1);
        let end = [at[0] + way[0], at[1] + way[1]];
        let told = if is_relative { way } else { end };
        write!(text, "X{}{}Y {}", millimetres(told[0]), [" ", ""][n as usize % 2], millimetres(told[1]))
            .unwrap();
        if chosen >= 2 {
            let chord = libm::sqrt((way[0] * way[0] + way[1] * way[1]) as f64);
            if numbers.below(3) > 0 {
                let radius = (chord * numbers.between(0.55, 3.0)) as i64 + 1;
                write!(text, " R{}", millimetres(radius * numbers.sign() as i64)).unwrap();
            } else {
                // Half a circle: the centre lies half-way, so the way is made even.
                let centre = [way[0] / 2, way[1] / 2];
                let even = [centre[0] * 2, centre[1] * 2];
                text.truncate(text.rfind('X').unwrap());
                let told = if is_relative { even } else { [at[0] + even[0], at[1] + even[1]] };
                write!(text, "X{} Y{}", millimetres(told[0]), millimetres(told[1])).unwrap();
                write!(text, "I{}J{}", millimetres(centre[0]), millimetres(centre[1])).unwrap();
                at = [at[0] + even[0], at[1] + even[1]];
                text.push('\n');
                continue;
            }
        }
        at = end;
        text.push_str(if n.is_multiple_of(5) { " (ON)\r\n" } else { "\n" });
    }
    text.push_str("M02\n%\n");
    text
}

fn millimetres(um: i64) -> String {
    let sign = if um < 0 { "-" } else { "" };
    format!("{sign}{}.{:03}", um.abs() / 1000, um.abs() % 1000)
}
