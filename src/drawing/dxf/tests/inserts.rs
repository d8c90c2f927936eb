//! Blocks where they are inserted: moved, scaled, turned, mirrored, in rows and columns, in one another.

use std::f64::consts::PI;

use super::*;

/// An arrow on layer 0 whose base is (1, 1): a line, and a half circle to its left.
const ARROW: &str = "0 SECTION|2 BLOCKS|0 BLOCK|2 ARROW|10 1|20 1|0 LINE|8 0|10 1|20 1|11 5|21 1|0 ARC|8 0|10 5|20 2|40 1\
                     |50 270|51 90|0 ENDBLK|0 ENDSEC";

fn inserted(insert: &str) -> Vec<Path> {
    let options = Options { order: Some(Order::AsDrawn), start: Start::AsDrawn, ..Options::default() };
    let drawing = read_text(&file_with(ARROW, insert), &options);
    assert!(drawing.report.iter().all(|f| f.code == "open-end"), "{:#?}", drawing.report);
    drawing.contours.into_iter().map(|contour| contour.path).collect()
}

#[test]
fn an_insert_puts_the_blocks_base_at_its_point() {
    let arrow = &inserted("0 INSERT|2 ARROW|10 20|20 30")[0];
    assert_eq!(arrow.elements()[0], line((20.0, 30.0), (24.0, 30.0)));
    assert_arc(
        &arrow.elements()[1],
        [(24.0, 30.0), (24.0, 32.0)],
        (25.0, 31.0),
        (24.0, 31.0),
        Sense::CounterClockwise,
    );
}

#[test]
fn an_insert_scales_then_turns() {
    let arrow = &inserted("0 INSERT|2 arrow|10 20|20 30|41 2|42 2|50 90")[0];
    assert_eq!(arrow.elements()[0], line((20.0, 30.0), (20.0, 38.0)));
    assert_arc(
        &arrow.elements()[1],
        [(20.0, 38.0), (16.0, 38.0)],
        (18.0, 40.0),
        (18.0, 38.0),
        Sense::CounterClockwise,
    );
}

#[test]
fn a_negative_scale_mirrors() {
    let arrow = &inserted("0 INSERT|2 ARROW|10 0|20 0|41 -1")[0];
    assert_eq!(arrow.elements()[0], line((0.0, 0.0), (-4.0, 0.0)));
    assert_arc(&arrow.elements()[1], [(-4.0, 0.0), (-4.0, 2.0)], (-5.0, 1.0), (-4.0, 1.0), Sense::Clockwise);
}

#[test]
fn an_insert_that_looks_down_is_mirrored_with_its_point() {
    let arrow = &inserted("0 INSERT|2 ARROW|10 20|20 30|50 90|230 -1")[0];
    // Turned in its own plane, then the plane's X is the drawing's -X.
    assert_eq!(arrow.elements()[0], line((-20.0, 30.0), (-20.0, 34.0)));
    assert_arc(
        &arrow.elements()[1],
        [(-20.0, 34.0), (-18.0, 34.0)],
        (-19.0, 35.0),
        (-19.0, 34.0),
        Sense::Clockwise,
    );
}

#[test]
fn uneven_scales_make_an_arc_a_part_of_an_ellipse() {
    let arrow = &inserted("0 INSERT|2 ARROW|10 0|20 0|41 3|42 1")[0];
    for n in 0..=100 {
        let t = PI * (f64::from(n) / 100.0 - 0.5);
        let p = point(12.0 + 3.0 * libm::cos(t), 1.0 + libm::sin(t));
        assert!(arrow.distance(p) <= 0.001, "{p}");
    }
    assert!(near(arrow.end(), point(12.0, 2.0)));
    let bulge =
        "0 SECTION|2 BLOCKS|0 BLOCK|2 B|0 LWPOLYLINE|10 0|20 0|42 1|10 0|20 2|10 -5|20 2|0 ENDBLK|0 ENDSEC";
    let drawing = read_text(&file_with(bulge, "0 INSERT|2 B|10 0|20 0|42 3"), &Options::default());
    let path = &drawing.contours[0].path;
    for n in 0..=100 {
        let t = PI * (f64::from(n) / 100.0 - 0.5);
        let p = point(libm::cos(t), 3.0 + 3.0 * libm::sin(t));
        assert!(path.distance(p) <= 0.001, "{p}");
    }
}

#[test]
fn an_array_turns_as_a_whole() {
    let arrows = inserted("0 INSERT|2 ARROW|10 100|20 0|50 90|70 3|71 2|44 10|45 20");
    let starts: Vec<(f64, f64)> = arrows.iter().map(|a| (a.start().x, a.start().y)).collect();
    // Columns go up, rows to the left.
    let expected = [(100.0, 0.0), (100.0, 10.0), (100.0, 20.0), (80.0, 0.0), (80.0, 10.0), (80.0, 20.0)];
    assert_eq!(starts, expected);
}

#[test]
fn blocks_in_blocks_are_followed_with_their_own_places() {
    let nested = "0 SECTION|2 BLOCKS|0 BLOCK|2 OUTER|10 0|20 0|0 INSERT|2 INNER|10 10|20 0|50 90|0 ENDBLK\
                  |0 BLOCK|2 INNER|10 0|20 0|0 LINE|10 0|20 0|11 2|21 0|0 ENDBLK|0 ENDSEC";
    let drawing =
        read_text(&file_with(nested, "0 INSERT|2 OUTER|10 0|20 5|41 3|42 3|50 90"), &Options::default());
    assert_eq!(drawing.contours[0].path.elements(), [line((0.0, 35.0), (-6.0, 35.0))]);
}

#[test]
fn layer_0_in_a_block_is_the_layer_of_the_insert() {
    let blocks = "0 SECTION|2 BLOCKS|0 BLOCK|2 B|10 0|20 0|0 CIRCLE|8 0|10 0|20 0|40 1|0 CIRCLE|8 OWN|10 9|20 0|40 1\
                  |0 ENDBLK|0 ENDSEC";
    let drawing = read_text(&file_with(blocks, "0 INSERT|8 THEIRS|2 B|10 0|20 0"), &Options::default());
    let mut layers: Vec<&str> = drawing.contours.iter().map(|c| c.layer.as_str()).collect();
    layers.sort_unstable();
    assert_eq!(layers, ["OWN", "THEIRS"]);
}

#[test]
fn inserts_that_lead_nowhere_or_into_themselves_are_faults() {
    let told = |blocks: &str, insert: &str| {
        let drawing = read_text(&file_with(blocks, insert), &Options::default());
        drawing.report.iter().find(|f| f.severity == Severity::Fault).unwrap().message.clone()
    };
    assert_eq!(
        told("", "0 INSERT|2 X|10 0|20 0"),
        "block X is inserted, and the drawing has none of that name"
    );
    let knot = "0 SECTION|2 BLOCKS|0 BLOCK|2 A|0 INSERT|2 B|10 0|20 0|0 ENDBLK|0 BLOCK|2 B|0 INSERT|2 A|10 0|20 0|0 ENDBLK\
                |0 ENDSEC";
    assert_eq!(told(knot, "0 INSERT|2 A|10 0|20 0"), "block A is inserted in itself");
    assert_eq!(
        told(ARROW, "0 INSERT|2 ARROW|10 0|20 0|210 1|220 0|230 1"),
        "block ARROW is inserted in a tilted plane"
    );
    assert_eq!(told(ARROW, "0 INSERT|2 ARROW|10 0|20 0|42 0"), "block ARROW is inserted at a scale of 0");
    assert_eq!(
        told(ARROW, "0 INSERT|2 ARROW|10 0|20 0|70 2|71 -3"),
        "block ARROW is inserted in 2 columns and -3 rows"
    );
    let many = "0 INSERT|2 ARROW|10 0|20 0|70 30000|71 30000|44 9|45 9";
    assert_eq!(told(ARROW, many), "the drawing's inserts show more than 4000000 entities");
}
