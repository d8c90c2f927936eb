//! `--rounding per-block`: the paper's printed table row by row, and the same scheme for gears the paper never saw.

use mock_controller::{Axis, Block, Kind, Quadrant, parse_block};

use crate::outlines::{generate, parts};
use crate::part::PAPERS_PART;
use crate::theory::{Curve, Element, Point};

const TABLE: &str = include_str!("../data/gear-paper-table.csv");

/// One row of the table.
struct Row {
    angle: String,
    block: Block,
    printed: Block,
}

fn table() -> Vec<Row> {
    let mut lines = TABLE.lines();
    assert_eq!(lines.next(), Some("angle_deg,x_um,y_um,j_um,g,z,printed"));
    lines.map(row).collect()
}

fn row(line: &str) -> Row {
    let columns: Vec<&str> = line.split(',').collect();
    let [angle, x, y, j, g, z, printed] = columns[..] else {
        panic!("{line:?} does not have seven columns");
    };
    let block = parse_block(&format!("B{x}B{y}B{j}G{g}{z}")).expect("the columns make a block");
    let printed = parse_block(printed).expect("the printed block can be read");
    Row { angle: angle.to_owned(), block, printed }
}

/// The rows of one angle are the seven blocks of one tooth, the teeth 10° apart; the lead-in is the first block.
#[test]
fn every_row_of_the_papers_table_is_printed_in_its_place() {
    let (program, _) = generate(&PAPERS_PART, &["--rounding", "per-block"]);
    assert_eq!(program.blocks.len(), 1 + 36 * 7);
    let rows = table();
    assert_eq!(rows.len(), 29);
    let mut row_of_tooth = 0;
    let mut angle = "";
    for row in &rows {
        row_of_tooth = if row.angle == angle { row_of_tooth + 1 } else { 0 };
        angle = &row.angle;
        let number = if angle == "lead-in" {
            1
        } else {
            let degrees: usize = angle.trim_start_matches('-').parse().expect("an angle in degrees");
            2 + degrees / 10 * 7 + row_of_tooth
        };
        assert_eq!(program.blocks[number - 1], row.block, "block {number}, {angle}, row {row_of_tooth}");
    }
}

/// J of the fifth block at −20° is 776, not 770; the sixth at −350° is L4, not L1.
#[test]
fn the_table_differs_from_the_print_by_its_two_misprints_alone() {
    let differing: Vec<(String, String, String)> = table()
        .into_iter()
        .filter(|row| row.block != row.printed)
        .map(|row| (row.angle, row.printed.to_string(), row.block.to_string()))
        .collect();
    let wanted =
        [("-20", "B749B442B770GYSR1", "B749B442B776GYSR1"), ("-350", "B31B234B234GYL1", "B31B234B234GYL4")];
    assert_eq!(differing, wanted.map(|(a, b, c)| (a.to_owned(), b.to_owned(), c.to_owned())));
}

#[test]
fn any_other_gear_is_rounded_block_by_block_in_the_same_way() {
    for (name, part) in parts() {
        let (program, _) = generate(&part, &["--rounding", "per-block"]);
        let elements = part.path().elements;
        assert_eq!(program.blocks.len(), elements.len(), "{name}");
        for (index, (printed, element)) in program.blocks.iter().zip(&elements).enumerate() {
            let allowed = rounded(element);
            assert!(
                allowed.contains(printed),
                "{name}, block {}: {printed} is none of {allowed:?}",
                index + 1
            );
        }
    }
}

/// An element as the paper rounds it: X, Y and J each to the nearest µm. Two answers where two axes are equally good.
fn rounded(element: &Element) -> Vec<Block> {
    match element.curve {
        Curve::Line => rounded_line(element),
        Curve::Arc { centre, clockwise } => rounded_arc(element, centre, clockwise),
    }
}

fn rounded_line(element: &Element) -> Vec<Block> {
    let (dx, dy) = (element.end.x - element.start.x, element.end.y - element.start.y);
    let quadrant = match (whole(dx), whole(dy)) {
        (1.., 0..) => Quadrant::First,
        (..=0, 1..) => Quadrant::Second,
        (..=-1, ..=0) => Quadrant::Third,
        (0.., ..=-1) => Quadrant::Fourth,
        (0, 0) => panic!("{element:?} is shorter than 1 µm"),
    };
    let (x, y) = (size(dx), size(dy));
    let along = |g| Block { x, y, j: if g == Axis::X { x } else { y }, g, kind: Kind::Line, quadrant };
    if x == y {
        vec![along(Axis::X), along(Axis::Y)]
    } else {
        vec![along(if x > y { Axis::X } else { Axis::Y })]
    }
}

fn rounded_arc(element: &Element, centre: Point, clockwise: bool) -> Vec<Block> {
    let from = Point { x: element.start.x - centre.x, y: element.start.y - centre.y };
    let to = Point { x: element.end.x - centre.x, y: element.end.y - centre.y };
    let quadrant = match (clockwise, whole(from.x), whole(from.y)) {
        // Counter-clockwise: +X, +Y, −X, −Y belong to 1, 2, 3, 4.
        (false, 1.., 0..) | (true, 0.., 1..) => Quadrant::First,
        (false, ..=0, 1..) | (true, ..=-1, 0..) => Quadrant::Second,
        (false, ..=-1, ..=0) | (true, ..=0, ..=-1) => Quadrant::Third,
        (false, 0.., ..=-1) | (true, 1.., ..=0) => Quadrant::Fourth,
        (_, 0, 0) => panic!("{element:?} has a radius below 1 µm"),
    };
    let kind = if clockwise { Kind::Clockwise } else { Kind::CounterClockwise };
    let along = |g| {
        let j = size(travel(element, centre, g));
        Block { x: size(from.x), y: size(from.y), j, g, kind, quadrant }
    };
    if (to.x.abs() - to.y.abs()).abs() < 1e-6 {
        vec![along(Axis::X), along(Axis::Y)]
    } else {
        vec![along(if to.x.abs() < to.y.abs() { Axis::X } else { Axis::Y })]
    }
}

/// The way an arc goes along an axis, there and back counted apart: summed over chords of a ten-thousandth of it,
/// which at the turning points loses less than 1e-4 µm of a radius of 10 mm.
fn travel(element: &Element, centre: Point, g: Axis) -> f64 {
    let from_centre = |point: Point| if g == Axis::X { point.x - centre.x } else { point.y - centre.y };
    let mut places: Vec<f64> = element.sampled(10_000).into_iter().map(from_centre).collect();
    places.push(from_centre(element.end));
    places.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
}

#[expect(clippy::cast_possible_truncation, reason = "a gear is far smaller than 2^52 µm")]
fn whole(length: f64) -> i64 {
    length.round() as i64
}

fn size(length: f64) -> u32 {
    u32::try_from(whole(length).abs()).expect("a gear is far smaller than 2^32 µm")
}
