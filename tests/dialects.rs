//! Every sample program of a dialect, read, against what it cuts: `tests/data/dialects`.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;

use dripfeed::formats::gcode::dialect::{ArcCentre, BUILT_IN, Dialect};
use dripfeed::formats::gcode::{Boundaries, Motions};
use dripfeed::geometry::{Element, Sense};
use dripfeed::motion::{Act, Motion, Offset, Side, Stop, Taper, Travel};

const SAMPLES: [(&str, &str); 9] = [
    ("generic", "generic"),
    ("fanuc", "fanuc"),
    ("charmilles", "charmilles"),
    ("charmilles-100", "charmilles"),
    ("sodick", "sodick"),
    ("mitsubishi", "mitsubishi"),
    ("agie", "agie"),
    ("integer-um", "integer-um"),
    ("integer-um-91", "integer-um"),
];

#[test]
fn every_sample_is_there_and_has_thirty_blocks() {
    let mut found: Vec<String> = std::fs::read_dir("tests/data/dialects")
        .unwrap()
        .filter_map(|entry| {
            Some(entry.unwrap().path().file_name()?.to_str()?.strip_suffix(".nc")?.to_owned())
        })
        .collect();
    found.sort();
    let mut named: Vec<&str> = SAMPLES.iter().map(|(name, _)| *name).collect();
    named.sort_unstable();
    assert_eq!(found, named);
    for (name, dialect) in SAMPLES {
        let text = sample(name, "nc");
        let dialect = Dialect::named(dialect).unwrap().unwrap();
        let blocks = Boundaries::new(text.as_slice(), &dialect).last().unwrap().unwrap().block;
        assert!(blocks >= 30, "{name}: {blocks} blocks");
    }
    for (dialect, _) in BUILT_IN {
        assert!(SAMPLES.iter().any(|(_, d)| *d == dialect), "{dialect} has no sample");
    }
}

#[test]
fn every_sample_cuts_where_it_should() {
    for (name, dialect) in SAMPLES {
        let motions = read(name, dialect);
        let mut acts = motions.iter().map(|m| &m.act);
        assert!(!acts.any(|act| matches!(act, Act::Unknown(_))), "{name}: {motions:#?}");
        let told = lines(&motions);
        let cut = String::from_utf8(sample(name, "cut")).unwrap();
        let expected: Vec<&str> = cut.lines().filter(|l| !l.starts_with('#') && !l.is_empty()).collect();
        for (n, (told, expected)) in told.iter().zip(&expected).enumerate() {
            assert!(agree(told, expected), "{name}.cut, line {}: {expected}, not {told}\n{told:?}", n + 1);
        }
        assert_eq!(told.len(), expected.len(), "{name}: {:?}", told.last());
    }
}

#[test]
fn centres_read_from_the_wrong_end_are_found_out() {
    let text = sample("charmilles-100", "nc");
    let dialect = Dialect::named("charmilles").unwrap().unwrap();
    let error = Motions::of_file(Cursor::new(text), dialect).unwrap().find_map(Result::err).unwrap();
    let dripfeed::formats::ReadError::Program { message, place, help } = error else { panic!("{error}") };
    assert_eq!(message, "the radius of the arc is 10.0000 mm at its start and 14.1421 mm at its end");
    assert_eq!(place.line, 8);
    assert!(help.contains("absolute"), "{help}");
}

fn sample(name: &str, kind: &str) -> Vec<u8> {
    std::fs::read(Path::new("tests/data/dialects").join(format!("{name}.{kind}"))).unwrap()
}

fn read(name: &str, dialect: &str) -> Vec<Motion> {
    let mut dialect = Dialect::named(dialect).unwrap().unwrap();
    if name == "charmilles-100" {
        dialect.arc_centre = ArcCentre::Absolute;
    }
    Motions::of_file(Cursor::new(sample(name, "nc")), dialect)
        .unwrap()
        .map(|motion| motion.unwrap_or_else(|e| panic!("{name}: {e} {e:?}")))
        .collect()
}

/// The motions in the words of a `.cut` file, with more digits.
fn lines(motions: &[Motion]) -> Vec<String> {
    let mut lines = Vec::new();
    for motion in motions {
        match &motion.act {
            Act::Move { travel, element, upper, flag } => {
                assert_eq!(*flag, None);
                let end = element.end();
                let mut line = match (travel, element) {
                    (Travel::Rapid, Element::Line { .. }) => "rapid",
                    (Travel::Cut, Element::Line { .. }) => "line",
                    (_, Element::Arc { sense: Sense::Clockwise, .. }) => "cw",
                    (_, Element::Arc { sense: Sense::CounterClockwise, .. }) => "ccw",
                }
                .to_owned();
                write!(line, " {:.9} {:.9}", end.x, end.y).unwrap();
                if let Element::Arc { centre, .. } = element {
                    write!(line, " {:.9} {:.9}", centre.x, centre.y).unwrap();
                }
                lines.push(line);
                if let Some(upper) = upper.map(|u| u.end()).filter(|u| (u - end).norm() > 1e-9) {
                    lines.push(format!("upper {:.9} {:.9}", upper.x, upper.y));
                }
            }
            Act::Offset(Offset::Off) => lines.push("offset off".to_owned()),
            Act::Offset(Offset::On { side, distance, register }) => {
                let register = register.map_or("value".to_owned(), |r| r.to_string());
                let distance = distance.map_or("-".to_owned(), |d| format!("{d:.9}"));
                lines.push(format!("offset {} {register} {distance}", named(*side)));
            }
            Act::Taper(Taper::Off) => lines.push("taper off".to_owned()),
            Act::Taper(Taper::On { side, angle }) => lines.push(format!("taper {} {angle:.9}", named(*side))),
            Act::Stop(stop) => lines.push(
                match stop {
                    Stop::Pause => "stop pause",
                    Stop::Optional => "stop optional",
                    Stop::End => "stop end",
                }
                .to_owned(),
            ),
            Act::Dwell(_) => lines.push("keep G4".to_owned()),
            Act::Word(text) => {
                let text = String::from_utf8(text.to_vec()).unwrap();
                // `E001=  008 …` is kept as E001=, `M15 P0` as M15; feeds, frames and heights have no line.
                let word = match text.split_once('=') {
                    Some((name, _)) => format!("{name}="),
                    None => text.split(' ').next().unwrap().to_owned(),
                };
                if !(word.starts_with('F') || word == "G54" || word == "G92") {
                    lines.push(format!("keep {word}"));
                }
            }
            Act::Comment(_) | Act::Header(_) => {}
            Act::Unknown(_) => unreachable!("looked for before"),
        }
    }
    lines
}

fn named(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

fn agree(told: &str, expected: &str) -> bool {
    let (told, expected): (Vec<&str>, Vec<&str>) =
        (told.split(' ').collect(), expected.split_whitespace().collect());
    told.len() == expected.len()
        && told.iter().zip(&expected).enumerate().all(|(n, (told, expected))| {
            match (told.parse::<f64>(), expected.parse::<f64>()) {
                (Ok(t), Ok(e)) => (t - e).abs() <= 1e-6,
                // A register is spelled with its letter; where D is the offset itself there is no register.
                _ if expected.starts_with(['D', 'H']) && n == 2 => {
                    *told == "value" || expected[1..].parse::<u32>().is_ok_and(|e| told.parse() == Ok(e))
                }
                _ => *told == *expected || told.replace("G4", "G04") == *expected,
            }
        })
}
