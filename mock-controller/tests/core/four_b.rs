//! 4B: the control holds the offset, cuts beside the outline, and stops where the outline cannot be cut beside.
#![expect(
    clippy::disallowed_methods,
    reason = "an oracle of the test's own; no part depends on its last bit"
)]

use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Duration;

use mock_controller::{Controller, Kind, Model, Settings, SettingsError};

use crate::sender::{HOUR, Sender};
use crate::watch::{Watch, four_b, watch};
use crate::writer::{Order, Writer, ell};

/// From the centre to a circle of R 5 and back.
fn circle(words: &str) -> String {
    format!("B5000BB5000B0DGXL1\nB5000B0B20000{words}NR1\nB5000BB5000GXL3\nDD\n")
}

/// The same circle the other way round: a clockwise arc that starts on +X enters the fourth quadrant.
fn clockwise(words: &str) -> String {
    circle(words).replace("NR1", "SR4").replace("nr1", "sr4")
}

#[test]
fn the_vectors_of_the_sources_in_both_field_orders() {
    for (offset_um, flag, radius) in [
        (100.0, "D", 5100),
        (100.0, "DD", 4900),
        (-100.0, "D", 4900),
        (-100.0, "DD", 5100),
        (70.0, "D", 5070),
    ] {
        for words in
            [format!("B5000{flag}GY"), format!("B5000GY{flag}"), format!(" b5000 y {flag} ").to_lowercase()]
        {
            for program in [circle(&words), clockwise(&words)] {
                let (report, watch) = watch(four_b(offset_um), &program);
                assert_eq!((report.blocks, report.programs, report.alarm), (3, 1, None), "{program}");
                assert_eq!(report.end_um, [0, 0], "{program}");
                assert_eq!(report.pulses, 10 * radius, "{offset_um} {program}");
                let (near, far) = watch.distances(2, 0.0, 0.0);
                let radius = radius as f64;
                assert!(near > radius - 1.5 && far < radius + 1.5, "{program}: {near} {far}");
                let length = radius * (2.0 + 2.0 * PI) / 1000.0;
                assert!((report.path_length_mm - length).abs() < 1e-6, "{}", report.path_length_mm);
            }
        }
    }
}

#[test]
fn punch_and_die_have_the_outer_dimensions_of_their_offset_at_inside_and_outside_corners() {
    for (order, mirrored) in [(Order::FlagFirst, false), (Order::FlagFirst, true), (Order::AxisFirst, false)]
    {
        for model in [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact] {
            for offset in [100_i64, 73, -100, -73, 1] {
                let writer = ell(order, model, mirrored);
                let settings = Settings { interpolator: model, ..four_b(offset as f64) };
                let (report, watch) = watch(settings, &(writer.text.clone() + "DD\n"));
                let what = format!("{order:?} {mirrored} {model:?} {offset}");
                assert_eq!((report.blocks, report.programs, report.alarm), (10, 1, None), "{what}");
                assert_eq!(report.end_um, [writer.at.0, writer.at.1], "{what}");
                let [left, right, bottom, top] = watch.bounds(2..=9);
                let (left, right) = if mirrored { (-right, -left) } else { (left, right) };
                for (found, wanted) in [
                    (left, -offset),
                    (right, 20_000 + offset),
                    (bottom, 5000 - offset),
                    (top, 25_000 + offset),
                ] {
                    assert!((found - wanted).abs() <= 1, "{what}: {found} for {wanted}");
                }
                let sign = if mirrored { -1.0 } else { 1.0 };
                for (block, x, y, radius) in [
                    (3, 15_000.0, 10_000.0, 5000 + offset),
                    (4, 15_000.0, 10_000.0, 5000 + offset),
                    (5, 15_000.0, 20_000.0, 5000 - offset),
                    (6, 5000.0, 20_000.0, 5000 + offset),
                    (9, 5000.0, 10_000.0, 5000 + offset),
                ] {
                    let (near, far) = watch.distances(block, sign * x, y);
                    let radius = radius as f64;
                    assert!(near > radius - 2.5 && far < radius + 2.5, "{what}, {block}: {near} {far}");
                }
            }
        }
    }
}

/// A wavy ring of `lobes` convex and as many concave arcs about a start hole in its middle.
fn ring(lobes: i32, model: Model) -> (Writer, Vec<(f64, f64)>, f64) {
    let mut writer = Writer::new(Order::FlagFirst).in_model(model);
    let pitch = 10_000.0;
    let step = PI / f64::from(lobes);
    // Neighbouring centres touch circles of half their distance.
    let radius = pitch * (step / 2.0).sin();
    let centre = |k: i32| ((pitch * (f64::from(k) * step).cos()), (pitch * (f64::from(k) * step).sin()));
    let node = |k: i32| {
        let (a, b) = (centre(k), centre(k + 1));
        (f64::midpoint(a.0, b.0), f64::midpoint(a.1, b.1))
    };
    let start = node(-1);
    writer.lead_in(start.0.round() as i64, start.1.round() as i64, "D");
    let mut centres = Vec::new();
    for k in 0..2 * lobes {
        let (kind, flag, sweep) = match k % 2 {
            0 => (Kind::CounterClockwise, "D", PI + step),
            _ => (Kind::Clockwise, "DD", PI - step),
        };
        writer.arc(kind, flag, centre(k), node(k), sweep);
        centres.push(centre(k));
    }
    writer.line(0, 0);
    (writer, centres, radius)
}

#[test]
fn over_many_arcs_nothing_drifts() {
    for model in [Model::Rotated, Model::Strict, Model::Exact] {
        for offset in [100.0, -150.0, 33.0] {
            let (writer, centres, radius) = ring(24, model);
            let settings = Settings { interpolator: model, ..four_b(offset) };
            let (report, watch) = watch(settings, &(writer.text.clone() + "DD\n"));
            assert_eq!((report.blocks, report.alarm), (writer.blocks, None));
            assert_eq!(report.end_um, [0, 0]);
            for (k, (x, y)) in centres.into_iter().enumerate() {
                let radius = if k % 2 == 0 { radius + offset } else { radius - offset };
                let (near, far) = watch.distances(k as u64 + 2, x, y);
                assert!(near > radius - 4.0 && far < radius + 4.0, "{model:?} {k}: {near} {far} {radius}");
            }
        }
    }
}

#[test]
fn at_offset_0_every_pulse_is_that_of_the_same_program_in_3b() {
    let (writer, ..) = ring(7, Model::Rotated);
    let mut plain = writer.text.clone();
    for flag in ["DDG", "DG"] {
        plain = plain
            .lines()
            .map(|line| match line.find(flag) {
                Some(at) => {
                    format!("{}{}\n", &line[..line[..at].rfind('B').unwrap()], &line[at + flag.len() - 1..])
                }
                None => format!("{line}\n"),
            })
            .collect();
    }
    assert!(!plain.contains('D'));
    let (three, three_watch) = watch(Settings::unpaced(), &(plain + "DD\n"));
    let (four, four_watch) = watch(four_b(0.0), &(writer.text + "DD\n"));
    assert_eq!((three.blocks, three.pulses, three.alarm), (four.blocks, four.pulses, None));
    assert!(three_watch.pulses == four_watch.pulses);
}

#[test]
fn at_offset_0_a_plain_3b_program_and_a_corner_are_cut_as_they_stand() {
    let program = "%\nB10BB10GXL1B9900B0B39600GYNR1\nBBB10GYL2\nDD\n";
    let (report, _) = watch(four_b(0.0), program);
    assert_eq!((report.blocks, report.end_um, report.alarm), (3, [10, 10], None));
}

#[test]
fn the_flag_dd_is_no_end_and_the_stop_word_is() {
    for program in [
        circle("B5000DDGY"),
        circle("B5000GYDD").replace('\n', ""),
        circle("B5000DDGY").replace('\n', " ").to_lowercase(),
        circle("B5000DDGY").replace('\n', "") + "%\n",
    ] {
        let (report, _) = watch(four_b(100.0), &program);
        assert_eq!((report.blocks, report.programs, report.alarm), (3, 1, None), "{program}");
        assert_eq!(report.pulses, 49_000, "{program}");
    }
}

#[test]
fn two_contours_with_a_move_between_them_each_have_their_lead_in_and_lead_out() {
    let one = circle("B5000DGY").replace("DD\n", "");
    // Flagged lead-ins, or pauses, part the move from the lead-in.
    for (between, unflag) in [("BBB30000GXL1\n", false), ("D\nBBB30000GXL1\nD\n", true)] {
        let mut program = format!("{one}{between}{one}DD\n");
        if unflag {
            program = program.replace("B0DGXL1", "GXL1");
        }
        let (report, watch) = watch(four_b(-100.0), &program);
        assert_eq!((report.blocks, report.alarm, report.end_um), (7, None, [30_000, 0]), "{program}");
        assert_eq!(report.pulses, 30_000 + 2 * 49_000);
        assert_eq!(watch.bounds(6..=6), [25_100, 34_900, -4900, 4900]);
    }
}

#[test]
fn a_contour_may_begin_with_lines_and_overlap_its_start() {
    // The side is told only by the third element; the last line goes 1 mm past the start before the lead-out.
    let mut writer = Writer::new(Order::FlagFirst);
    let quarter = FRAC_PI_2;
    writer.line(0, 5000);
    writer.line(4000, 5000);
    writer.line(9000, 5000);
    writer.arc(Kind::CounterClockwise, "D", (9000.0, 6000.0), (10_000.0, 6000.0), quarter);
    writer.arc(Kind::CounterClockwise, "D", (9000.0, 6000.0), (9000.0, 7000.0), quarter);
    writer.line(0, 7000);
    writer.arc(Kind::CounterClockwise, "D", (0.0, 6000.0), (0.0, 5000.0), PI);
    writer.line(1000, 5000);
    writer.line(0, 0);
    let (report, watch) = watch(four_b(200.0), &(writer.text + "DD\n"));
    assert_eq!((report.blocks, report.alarm, report.end_um), (9, None, [0, 0]));
    let ends: Vec<[i64; 2]> = watch.ends.iter().map(|end| end.end_um).collect();
    assert_eq!(ends[..3], [[0, 4800], [4000, 4800], [9000, 4800]]);
    assert_eq!(ends[7], [1000, 4800]);
    assert_eq!(watch.bounds(2..=8), [-1200, 10_200, 4800, 7200]);
}

#[test]
fn what_cannot_be_cut_beside_is_an_alarm_that_says_where() {
    let lead_in = "B5000BB5000B0DGXL1\n";
    for (program, offset_um, alarm, found) in [
        // A corner.
        ("B5000B0B5000B5000DGXNR1\nBBB9000GYL2\nBBB9000GXL1\nDD\n", 100.0, "tangency", "block 3"),
        ("B5000B0B5000B5000DGXNR1\nB9000B9000B9000GXL2\nB9B9B9GXL4\nDD\n", 100.0, "tangency", "block 3"),
        ("B5000B0B5000B5000DGXNR1\nB5000B0B5000B5000DGXNR1\nDD\n", 100.0, "tangency", "block 3"),
        // The radius vanishes, is not given, or is another.
        ("B100B0B400B100DGYNR1\nDD\n", -100.0, "radius", "becomes 0 µm"),
        ("B90B0B360B90DDGYNR1\nDD\n", 100.0, "radius", "becomes -10 µm"),
        ("B5000B0B20000BDGYNR1\nDD\n", 100.0, "radius", "without R"),
        ("B5000B0B20000B5100DGYNR1\nDD\n", 100.0, "radius", "X and Y give 5000.0"),
        // The side is not told, or twice.
        ("B5000B0B20000GYNR1\nDD\n", 100.0, "flag", "without D or DD"),
        ("B5000BB5000GXL1\nDD\n", 100.0, "side", "no arc"),
        ("B5000B0B5000B5000DGXNR1\nB0B5000B5000B5000DDGYNR2\nDD\n", 100.0, "side", "other side"),
    ] {
        let (report, _) = watch(four_b(offset_um), &format!("{lead_in}{program}"));
        let detail = report.alarm_detail.unwrap_or_default();
        assert_eq!(report.alarm.as_deref(), Some(alarm), "{program}: {detail}");
        assert!(detail.contains(found), "{program}: {detail}");
        let (report, _) = watch(four_b(0.0), &format!("{lead_in}{program}"));
        assert_eq!((report.alarm, report.programs), (None, 1), "{program}");
    }
    let (report, _) = watch(four_b(100.0), "B5000B0B20000B5000DGYNR1\nDD\n");
    assert_eq!(report.alarm.as_deref(), Some("lead-in"));
    let (report, _) = watch(four_b(100.0), &format!("{lead_in}{}DD\n", "BBB100GYL2\n".repeat(1002)));
    assert_eq!((report.alarm.as_deref(), report.blocks), (Some("side"), 0));
}

#[test]
fn a_3b_control_holds_no_offset_and_knows_no_fourth_field() {
    let settings = Settings { wire_offset_um: 70.0, ..Settings::unpaced() };
    assert_eq!(settings.validate(), Err(SettingsError::WireOffsetInNumbers));
    assert!(four_b(f64::NAN).validate().is_err());
    let (report, _) = watch(Settings::unpaced(), &circle("B5000DGY"));
    assert_eq!(report.alarm.as_deref(), Some("format"));
}

#[test]
fn after_a_reset_the_outline_is_counted_from_where_the_wire_stands() {
    let program = circle("B5000DGY");
    let settings = Settings { reset_at_block: Some(2), ..four_b(100.0) };
    let mut watch = Watch::default();
    let mut control = Controller::observed(settings, &mut watch).unwrap();
    control.link_opened(Duration::ZERO);
    Sender::of(program.clone()).window(4096).feed(&mut control, Duration::ZERO, HOUR);
    assert_eq!((control.blocks(), control.position_um()), (1, [5100, 0]));
    control.link_closed(HOUR);
    control.link_opened(HOUR);
    Sender::of(program).window(4096).feed(&mut control, HOUR, 2 * HOUR);
    assert_eq!((control.blocks(), control.position_um(), control.alarm()), (4, [5100, 0], None));
    drop(control);
    assert_eq!(watch.bounds(3..=3), [0, 10_200, -5100, 5100]);
}
