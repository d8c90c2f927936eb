//! Each kind of entity, by the points it goes through.

use std::f64::consts::{PI, TAU};

use super::*;

/// The greatest distance of points from a path.
fn farthest(path: &Path, points: impl Iterator<Item = Point>) -> f64 {
    points.map(|p| path.distance(p)).fold(0.0, f64::max)
}

#[test]
fn a_line_goes_from_one_point_to_the_other() {
    assert_eq!(
        one("0 LINE|8 0|10 1.5|20 -2|30 0|11 4|21 1e1|31 0").elements(),
        [line((1.5, -2.0), (4.0, 10.0))]
    );
}

#[test]
fn an_arc_runs_counter_clockwise_between_its_angles() {
    let arc = one("0 ARC|10 1|20 2|40 5|50 270|51 450");
    assert_arc(
        &arc.elements()[0],
        [(1.0, -3.0), (1.0, 7.0)],
        (6.0, 2.0),
        (1.0, 2.0),
        Sense::CounterClockwise,
    );
    // Over the direction of 0 degrees.
    let arc = one("0 ARC|10 0|20 0|40 5|50 350|51 10");
    assert!((arc.length() - 5.0 * 20.0_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn an_arc_whose_plane_looks_down_is_mirrored_and_runs_clockwise() {
    let arc = one("0 ARC|10 1|20 2|40 5|50 0|51 90|210 0|220 0|230 -1");
    assert_arc(
        &arc.elements()[0],
        [(-6.0, 2.0), (-1.0, 7.0)],
        (-1.0 - 5.0 * 0.5_f64.sqrt(), 2.0 + 5.0 * 0.5_f64.sqrt()),
        (-1.0, 2.0),
        Sense::Clockwise,
    );
}

#[test]
fn a_circle_is_one_element_from_its_rightmost_point() {
    let circle = one("0 CIRCLE|10 1|20 2|40 5");
    assert_eq!(circle, Path::circle(point(1.0, 2.0), 5.0, Sense::CounterClockwise));
    let mirrored = one("0 CIRCLE|10 1|20 2|40 5|230 -1");
    assert_eq!(mirrored.extent()[0], point(-6.0, -3.0));
}

#[test]
fn a_bulge_is_the_tangent_of_a_quarter_of_the_angle() {
    // A slot: two straights, two half circles to the left, which a bulge of 1 says.
    let slot = one("0 LWPOLYLINE|90 4|70 1|10 0|20 0|10 10|20 0|42 1|10 10|20 4|10 0|20 4|42 1");
    assert_eq!(slot.elements().len(), 4);
    assert_arc(
        &slot.elements()[1],
        [(10.0, 0.0), (10.0, 4.0)],
        (12.0, 2.0),
        (10.0, 2.0),
        Sense::CounterClockwise,
    );
    assert!(slot.is_closed());
    assert!((slot.area() - (40.0 + 4.0 * PI)).abs() < 1e-12);
    // A quarter circle to the right, and one of 270 degrees to the left.
    let quarter = libm::tan(22.5_f64.to_radians());
    let right = one(&format!("0 LWPOLYLINE|70 0|10 0|20 0|42 {}|10 3|20 3", -quarter));
    let middle = 3.0 - 3.0 * 0.5_f64.sqrt();
    assert_arc(
        &right.elements()[0],
        [(0.0, 0.0), (3.0, 3.0)],
        (middle, 3.0 - middle),
        (3.0, 0.0),
        Sense::Clockwise,
    );
    let wide = one(&format!("0 LWPOLYLINE|10 0|20 0|42 {}|10 3|20 3", libm::tan(67.5_f64.to_radians())));
    assert!((wide.length() - 3.0 * 1.5 * PI).abs() < 1e-12);
}

#[test]
fn a_polyline_of_vertices_is_read_as_a_light_one_is() {
    let old = one(
        "0 POLYLINE|66 1|70 1|0 VERTEX|10 0|20 0|0 VERTEX|10 10|20 0|42 1|0 VERTEX|10 10|20 4|0 VERTEX|10 0|20 4|42 1\
         |0 SEQEND|8 0",
    );
    let light = one("0 LWPOLYLINE|70 1|10 0|20 0|10 10|20 0|42 1|10 10|20 4|10 0|20 4|42 1");
    assert_eq!(old, light);
    let mirrored = one("0 LWPOLYLINE|70 1|230 -1|10 0|20 0|10 10|20 0|42 1|10 10|20 4|10 0|20 4|42 1");
    assert_eq!(mirrored.extent()[0], point(-12.0, 0.0));
    assert_eq!(mirrored.sense(), Sense::Clockwise);
}

#[test]
fn the_frame_of_a_smoothed_polyline_is_not_cut() {
    let smooth = one(
        "0 POLYLINE|66 1|70 4|0 VERTEX|10 5|20 9|70 16|0 VERTEX|10 0|20 0|70 8|0 VERTEX|10 10|20 0|70 8|0 SEQEND",
    );
    assert_eq!(smooth.elements(), [line((0.0, 0.0), (10.0, 0.0))]);
}

#[test]
fn an_ellipse_is_kept_within_the_tolerance() {
    for (facing, down) in [("", false), ("|210 0|220 0|230 -1", true)] {
        let whole = one(&format!("0 ELLIPSE|10 3|20 -1|30 0|11 6|21 8|31 0|40 0.3|41 0|42 {TAU}{facing}"));
        // Its own coordinates are the drawing's, whatever way it looks.
        let at = |t: f64| {
            point(
                3.0 + 6.0 * libm::cos(t) - 2.4 * libm::sin(t),
                -1.0 + 8.0 * libm::cos(t) + 1.8 * libm::sin(t),
            )
        };
        assert!(farthest(&whole, (0..1000).map(|n| at(f64::from(n) * TAU / 1000.0))) <= 0.001);
        assert!(whole.is_closed());
        assert!((whole.area().abs() - PI * 10.0 * 3.0).abs() < 0.05, "{}", whole.area());
        assert_eq!(whole.sense(), if down { Sense::Clockwise } else { Sense::CounterClockwise });
    }
    let part = one("0 ELLIPSE|10 0|20 0|11 4|21 0|40 0.5|41 1|42 2.5");
    let at = |t: f64| point(4.0 * libm::cos(t), 2.0 * libm::sin(t));
    assert!(near(part.start(), at(1.0)) && near(part.end(), at(2.5)));
    assert!(farthest(&part, (0..100).map(|n| at(1.0 + 1.5 * f64::from(n) / 100.0))) <= 0.001);
}

#[test]
fn an_ellipse_of_equal_axes_is_one_arc() {
    let round = one(&format!("0 ELLIPSE|10 0|20 0|11 4|21 3|40 1|41 0|42 {TAU}"));
    assert_eq!(round.elements().len(), 1);
    assert!((round.length() - 10.0 * PI).abs() < 1e-9);
}

#[test]
fn a_spline_is_kept_within_the_tolerance_in_elements_that_touch_smoothly() {
    // One span of degree 3: a Bézier curve.
    let controls = [(0.0, 0.0), (2.0, 6.0), (8.0, 6.0), (10.0, -1.0)];
    let knots = "40 0|40 0|40 0|40 0|40 1|40 1|40 1|40 1";
    let points: Vec<String> = controls.iter().map(|(x, y)| format!("10 {x}|20 {y}|30 0")).collect();
    let spline = format!("0 SPLINE|70 8|71 3|72 8|73 4|{knots}|{}", points.join("|"));
    let at = |t: f64| {
        let s = 1.0 - t;
        let [a, b, c, d] = [s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t];
        let sum = |of: fn(&(f64, f64)) -> f64| {
            let [p, q, r, s] = [0, 1, 2, 3].map(|n| of(&controls[n]));
            a * p + b * q + c * r + d * s
        };
        point(sum(|p| p.0), sum(|p| p.1))
    };
    for tolerance in [0.1, 0.01, 0.001, 0.0001] {
        for elements in [Elements::Lines, Elements::Biarcs, Elements::Fewest] {
            let options = Options { tolerance, elements, ..Options::default() };
            let drawing = read_text(&file(&spline), &options);
            let path = &drawing.contours[0].path;
            assert!(farthest(path, (0..=500).map(|n| at(f64::from(n) / 500.0))) <= tolerance, "{tolerance}");
            if elements == Elements::Biarcs {
                for pair in path.elements().windows(2) {
                    let kink = crate::geometry::turn(pair[0].heading_at_end(), pair[1].heading_at_start());
                    assert!(kink.abs() < 1e-6, "{kink}");
                }
            }
        }
    }
}

#[test]
fn a_rational_spline_may_be_a_circle() {
    let h = 0.5_f64.sqrt();
    let (mut text, ring) = (
        String::from("0 SPLINE|70 12|71 2"),
        [
            (5.0, 0.0),
            (5.0, 5.0),
            (0.0, 5.0),
            (-5.0, 5.0),
            (-5.0, 0.0),
            (-5.0, -5.0),
            (0.0, -5.0),
            (5.0, -5.0),
            (5.0, 0.0),
        ],
    );
    for knot in [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4] {
        text += &format!("|40 {knot}");
    }
    for (n, _) in ring.iter().enumerate() {
        text += &format!("|41 {}", if n % 2 == 0 { 1.0 } else { h });
    }
    for (x, y) in ring {
        text += &format!("|10 {x}|20 {y}");
    }
    let circle = one(&text);
    assert_eq!(circle.elements().len(), 1, "{circle:?}");
    assert!((circle.length() - 10.0 * PI).abs() < 1e-9);
}

#[test]
fn what_cannot_be_cut_is_a_fault_with_its_kind_layer_and_line() {
    let told = |entity: &str| {
        let drawing = read_text(&file(&format!("{entity}|0 LINE|10 0|20 0|11 1|21 0")), &Options::default());
        assert!(!drawing.is_fit_to_cut());
        assert_eq!(drawing.contours.len(), 1, "the others are read all the same");
        let fault = drawing.report.iter().find(|f| f.severity == Severity::Fault).unwrap();
        assert_eq!((fault.code, fault.line), ("unusable", 16));
        fault.message.clone()
    };
    assert_eq!(
        told("0 CIRCLE|8 A|10 0|20 0|40 3|210 1|220 0|230 0"),
        "a CIRCLE on layer A cannot be cut: its plane is tilted against the drawing's"
    );
    assert_eq!(
        told("0 CIRCLE|8 A|10 0|20 0|40 0"),
        "a CIRCLE on layer A cannot be cut: its radius 0 is not positive"
    );
    assert_eq!(
        told("0 SPLINE|8 A|71 3|74 2|11 0|21 0|11 5|21 5"),
        "a SPLINE on layer A cannot be cut: it is a spline by 2 points to run through, without control points"
    );
    assert_eq!(
        told("0 SPLINE|8 A|71 3|10 0|20 0|10 5|20 5"),
        "a SPLINE on layer A cannot be cut: a spline of degree 3 has 2 control points, and needs at least 4"
    );
    assert_eq!(
        told("0 LINE|8 A|10 0|20 0|11 1e300|21 5"),
        "a LINE on layer A cannot be cut: it lies more than 100000000 mm out, or is drawn with numbers that are too large"
    );
}

#[test]
fn an_arc_that_leads_far_out_between_near_ends_is_refused_and_a_flat_one_is_not() {
    let bulge = |bulge: &str| {
        let entity = format!("0 LWPOLYLINE|8 A|10 0|20 0|42 {bulge}|10 10|20 0");
        codes(&read_text(&file(&entity), &Options::default()))
    };
    // 5 km out, and 500 km; the last is all but straight about a centre 2 500 km away.
    assert_eq!(bulge("1e6"), ["open-end", "open-end"]);
    assert_eq!(bulge("-1e8"), ["unusable", "nothing-to-cut"]);
    assert_eq!(bulge("1e-9"), ["open-end", "open-end"]);
}

#[test]
fn what_is_not_cut_is_told_by_kind_and_layer() {
    let drawing = read_text(
        &file(
            "0 TEXT|8 NOTES|10 0|20 0|1 M5|0 TEXT|8 NOTES|1 M6|0 3DFACE|8 A|10 0|20 0|0 POLYLINE|8 A|70 64|0 VERTEX\
             |10 0|20 0|0 SEQEND|0 LINE|8 A|60 1|10 0|20 0|11 1|21 0|0 LINE|8 A|67 1|10 0|20 0|11 1|21 0\
             |0 LINE|8 A|10 3|20 3|11 3|21 3|0 CIRCLE|8 A|10 0|20 0|40 1",
        ),
        &Options::default(),
    );
    assert_eq!(drawing.contours.len(), 1);
    let mut told: Vec<(Severity, String)> =
        drawing.report.iter().map(|f| (f.severity, f.message.clone())).collect();
    told.sort();
    let expected = [
        (Severity::Note, "1 entity of a paper sheet on layer A is left out"),
        (Severity::Note, "1 invisible entity on layer A is left out"),
        (Severity::Note, "2 TEXT on layer NOTES are not cut"),
        (Severity::Warning, "1 3DFACE on layer A is not cut"),
        (Severity::Warning, "1 POLYLINE mesh on layer A is not cut"),
        (Severity::Warning, "1 entity without length on layer A is left out"),
    ];
    assert_eq!(told, expected.map(|(severity, message)| (severity, message.to_string())));
}

#[test]
fn what_leaves_the_plane_is_told() {
    let drawing = read_text(&file("0 LINE|10 0|20 0|30 0|11 5|21 0|31 2"), &Options::default());
    assert!(codes(&drawing).contains(&"leaves-plane"));
    let level = read_text(&file("0 LINE|10 0|20 0|30 7|11 5|21 0|31 7"), &Options::default());
    assert!(!codes(&level).contains(&"leaves-plane"));
}
