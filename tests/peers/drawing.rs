//! ezdxf against the reader and the writer of drawings: what it draws is read as it says, and what is written it reads
//! without a word of complaint.

use dripfeed::drawing::dxf::{self, DxfWriter, Options};
use dripfeed::drawing::finding::Severity;
use dripfeed::formats::Writer;
use dripfeed::geometry::{Element, Path, Point, Sense};
use dripfeed::motion::{Act, Motion, Offset, Side, Stop, Travel};
use dripfeed::place::Spot;
use serde_json::Value;

use crate::python;

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/peers/drawing.py");

/// Runs the script and takes its answer.
fn ezdxf(arguments: &[&str]) -> Value {
    let output = python().arg(SCRIPT).args(arguments).output().expect("Python starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).expect("the script answers in JSON")
}

fn points(entity: &Value) -> Vec<Point> {
    let points = entity["points"].as_array().expect("an entity has points");
    let number = |value: &Value| value.as_f64().expect("a coordinate is a number");
    points.iter().map(|p| Point::new(number(&p[0]), number(&p[1]))).collect()
}

/// Reads a drawing ezdxf has written, and holds it against what ezdxf says of it.
fn compare(version: &str, form: &str, seed: u32) {
    let scratch = tempfile::tempdir().expect("a scratch directory");
    let file = scratch.path().join("drawing.dxf");
    let name = file.to_str().expect("its name is text");
    let said = ezdxf(&["write", name, version, form, &seed.to_string()]);
    let bytes = std::fs::read(&file).expect("the drawing is there");
    // ezdxf states no unit in files of release 12.
    let options = Options { tolerance: TOLERANCE, unit: Some(1.0), ..Options::default() };
    let drawing = dxf::read(bytes.as_slice(), &options).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    let faults: Vec<&str> = drawing
        .report
        .iter()
        .filter(|f| f.severity == Severity::Fault && !matches!(f.code, "branch" | "encloses-nothing"))
        .map(|f| f.message.as_str())
        .collect();
    assert!(faults.is_empty(), "{version} {form} {seed}: {faults:#?}");
    let entities = said["entities"].as_array().expect("there are entities");
    assert!(entities.len() > 30);
    for entity in entities {
        let what = format!("{} on {} of {version} {form} {seed}", entity["kind"], entity["layer"]);
        let paths: Vec<&Path> =
            drawing.contours.iter().filter(|c| c.layer == entity["layer"]).map(|c| &c.path).collect();
        assert!(!paths.is_empty(), "{what} is lost");
        for point in points(entity) {
            let distance = paths.iter().map(|path| path.distance(point)).fold(f64::INFINITY, f64::min);
            assert!(distance <= TOLERANCE + 1e-9, "{what}: {point} is {distance} mm beside");
        }
        // ezdxf's length is that of chords.
        let length: f64 = paths.iter().map(|path| path.length()).sum();
        let said = entity["length"].as_f64().expect("a length is a number");
        assert!((length - said).abs() <= 1e-4 + 2e-5 * said, "{what}: {length} mm, and ezdxf says {said}");
    }
}

const TOLERANCE: f64 = 0.0005;

#[test]
fn text_of_every_release_is_read_as_ezdxf_says() {
    for (seed, version) in (1..).zip(["R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"]) {
        compare(version, "asc", seed);
        compare(version, "asc", seed + 100);
    }
}

#[test]
fn binary_drawings_are_read_as_ezdxf_says() {
    for (seed, version) in (10..).zip(["R12", "R2000", "R2018"]) {
        compare(version, "bin", seed);
    }
}

/// Motions with everything a drawing has room for.
fn program() -> Vec<Motion> {
    let p = Point::new;
    let line = |start, end| Element::Line { start, end };
    let arc = |start, end, centre, sense| Element::Arc { start, end, centre, sense };
    let moves = [
        (Travel::Rapid, line(p(0.0, 0.0), p(12.345_678_9, -7.0))),
        (Travel::Cut, line(p(12.345_678_9, -7.0), p(20.0, 5.0))),
        (Travel::Cut, arc(p(20.0, 5.0), p(10.0, 15.0), p(10.0, 5.0), Sense::CounterClockwise)),
        (Travel::Cut, arc(p(10.0, 15.0), p(0.0, 5.0), p(5.0, 10.0), Sense::Clockwise)),
        (Travel::Cut, arc(p(0.0, 5.0), p(0.0, 5.0), p(-3.0, 1.0), Sense::Clockwise)),
        (Travel::Rapid, line(p(0.0, 5.0), p(1e4, 1e-3))),
        (Travel::Cut, line(p(1e4, 1e-3), p(1e4, 7.0))),
    ];
    let motion = |act| Motion { act, block: 1, spot: Spot::default() };
    let upper = Some(line(p(0.5, 5.0), p(0.5, 9.0)));
    let mut program = vec![
        motion(Act::Header(b"%".to_vec().into())),
        // GBK for "part", and what would break a file if it were not made a blank.
        motion(Act::Comment(b"\xc1\xe3\xbc\xfe\r\n0\nEOF".to_vec().into())),
        motion(Act::Offset(Offset::On { side: Side::Left, distance: Some(0.1), register: None })),
    ];
    program.extend(
        moves.map(|(travel, element)| motion(Act::Move { travel, element, upper: None, flag: None })),
    );
    let last = line(p(1e4, 7.0), p(1e4, 9.0));
    program.push(motion(Act::Move { travel: Travel::Cut, element: last, upper, flag: None }));
    program.push(motion(Act::Stop(Stop::End)));
    program
}

#[test]
fn what_is_written_ezdxf_reads_and_audits_without_an_error() {
    let (mut writer, mut text) = (DxfWriter::new(), Vec::new());
    let mut elements = Vec::new();
    for motion in program() {
        writer.write(&motion, &mut text).expect("a drawing has room for it");
        if let Act::Move { travel, element, upper, .. } = motion.act {
            elements.push((if travel == Travel::Rapid { "RAPID" } else { "CUT" }, element));
            elements.extend(upper.map(|upper| ("UPPER", upper)));
        }
    }
    writer.finish(&mut text).expect("it can be ended");
    let scratch = tempfile::tempdir().expect("a scratch directory");
    let file = scratch.path().join("program.dxf");
    std::fs::write(&file, &text).expect("the drawing is written");
    let said = ezdxf(&["read", file.to_str().expect("its name is text")]);
    assert_eq!(said["errors"], serde_json::json!([]));
    assert_eq!(said["units"], 4);
    let layers = said["layers"].as_array().expect("there are layers");
    assert!(["0", "CUT", "RAPID", "UPPER"].iter().all(|name| layers.iter().any(|layer| layer == name)));
    let entities = said["entities"].as_array().expect("there are entities");
    assert_eq!(entities.len(), elements.len());
    for (entity, (layer, element)) in entities.iter().zip(&elements) {
        assert_eq!(entity["layer"], *layer);
        for point in points(entity) {
            assert!(element.distance(point) < 1e-9, "{entity}: {point} is not on {element:?}");
        }
        let length = entity["length"].as_f64().expect("a length is a number");
        assert!((length - element.length()).abs() <= 2e-6 * length, "{entity}: {}", element.length());
    }
}
