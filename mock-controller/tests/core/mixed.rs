//! 4B programs hold 3B blocks: moves, lead-outs, straight sides; and the same text may run together or hold a listing's
//! comments.

use mock_controller::{Kind, Model, Settings, Taper};

use crate::watch::{four_b, watch};
use crate::writer::{Order, Writer, ell};

/// The L with its inside corner: three of its ten blocks are plain 3B.
fn mixed() -> String {
    let writer = ell(Order::FlagFirst, Model::Rotated, false);
    let plain = writer.text.lines().filter(|line| line.starts_with('B') && !line.contains('D')).count();
    assert_eq!((writer.blocks, plain), (10, 3));
    writer.text
}

#[test]
fn however_the_blocks_are_set_the_same_is_cut() {
    let text = mixed();
    for offset_um in [0.0, 100.0, -130.0] {
        let wanted = watch(four_b(offset_um), &(text.clone() + "DD\n"));
        assert_eq!((wanted.0.blocks, wanted.0.alarm, wanted.0.end_um), (10, None, [0, 0]));
        let blocks: Vec<&str> = text.lines().skip(1).collect();
        let listing: String = blocks
            .iter()
            .enumerate()
            .map(|(k, block)| format!("N {:3}: {} ; 1.000, -2.500\n", k + 1, block.replace('G', " G")))
            .collect();
        let pair = |k: usize| format!("{}{}\n", blocks[2 * k], blocks[2 * k + 1]);
        for (what, program) in [
            ("run together", format!("%\n{}DD\n", blocks.concat())),
            ("two a line", format!("%\n{}DD\n", (0..5).map(pair).collect::<String>())),
            ("small", format!("%\n{}dd\n", text.replace('%', "").to_lowercase())),
            ("a listing", format!("(PLATE 7)\n{listing}DD\n")),
            ("broken within blocks", format!("%\n{}\nDD\n", blocks.concat().replace('B', "\nB "))),
        ] {
            let found = watch(four_b(offset_um), &program);
            assert_eq!((found.0.blocks, found.0.programs, found.0.alarm), (10, 1, None), "{what}");
            assert!(found.1.pulses == wanted.1.pulses, "{what} at {offset_um}");
        }
    }
}

#[test]
fn a_plain_move_to_the_start_hole_and_back_is_not_shifted() {
    // A move, its pause for threading, the mixed contour, a pause, and the move back.
    let contour = mixed().replace("%\n", "");
    let program = format!("%\nB7000B3000B7000GXL1\nD\n{contour}D\nB7000B3000B7000GXL3\nDD\n");
    for offset in [100_i64, -130] {
        let (report, watch) = watch(four_b(offset as f64), &program);
        assert_eq!((report.blocks, report.alarm, report.end_um), (12, None, [0, 0]), "{offset}");
        assert_eq!((watch.ends[0].end_um, watch.ends[10].end_um), ([7000, 3000], [7000, 3000]));
        // The contour stands where the move has brought the wire.
        let wanted = [7000 - offset, 27_000 + offset, 8000 - offset, 28_000 + offset];
        for (found, wanted) in watch.bounds(3..=10).into_iter().zip(wanted) {
            assert!((found - wanted).abs() <= 1, "{found} for {wanted}");
        }
    }
}

#[test]
fn what_a_mixed_program_must_not_hold_stops_it_where_it_stands() {
    // A straight side one micron off makes no corner; a plain 3B arc has no radius to change.
    let text = mixed();
    let arc = text.lines().find(|line| line.contains("DDG")).unwrap();
    let plain = format!("{}{}", &arc[..arc.rfind('B').unwrap()], &arc[arc.find('G').unwrap()..]);
    let (report, _) = watch(four_b(100.0), &text.replace(arc, &plain));
    let detail = report.alarm_detail.unwrap_or_default();
    assert_eq!(report.alarm.as_deref(), Some("flag"), "{detail}");
    assert!(detail.contains(&plain), "{detail}");
    // What stands before it has been cut, and nothing after it.
    assert_eq!((report.blocks, report.programs), (4, 0));
    // At F = 0 there is nothing to change.
    assert_eq!(watch(four_b(0.0), &(text.replace(arc, &plain) + "DD\n")).0.alarm, None);
}

#[test]
fn the_wrong_flag_on_the_inside_corner_is_found_at_any_offset_but_0() {
    let text = mixed().replace("DDG", "DG") + "DD\n";
    for offset_um in [0.5, 100.0, -130.0] {
        let (report, _) = watch(four_b(offset_um), &text);
        assert_eq!(report.alarm.as_deref(), Some("side"), "{offset_um}");
    }
    assert_eq!(watch(four_b(0.0), &text).0.alarm, None);
}

#[test]
fn a_die_of_the_second_papers_measures_is_cut_at_its_f_and_taper() {
    // A reconstruction, of its measures only: an end of R 10 and corners of R 1, α = 4°, H2 = 100, F = 0.15/2 + 0.014 − 0.03 = 0.059 inside.
    let mut writer = Writer::new(Order::FlagFirst);
    let quarter = std::f64::consts::FRAC_PI_2;
    writer.lead_in(10_000, 0, "D");
    writer.arc(Kind::CounterClockwise, "D", (0.0, 0.0), (0.0, 10_000.0), quarter);
    writer.line(-20_000, 10_000);
    writer.arc(Kind::CounterClockwise, "D", (-20_000.0, 9000.0), (-21_000.0, 9000.0), quarter);
    writer.line(-21_000, -9000);
    writer.arc(Kind::CounterClockwise, "D", (-20_000.0, -9000.0), (-20_000.0, -10_000.0), quarter);
    writer.line(0, -10_000);
    writer.arc(Kind::CounterClockwise, "D", (0.0, 0.0), (10_000.0, 0.0), quarter);
    writer.line(0, 0);
    let taper = Some(Taper { degrees: 4.0, height_um: 100_000.0 });
    let settings = Settings { taper, ..four_b(-59.0) };
    let (report, watch) = watch(settings, &(writer.text + "DD\n"));
    assert_eq!((report.blocks, report.alarm, report.end_um), (9, None, [0, 0]));
    assert_eq!(report.upper_end_um, Some([0, 0]));
    // The wire leans by the same angle everywhere on the outline: 100 · tan 4° is 6.993.
    let leaning = watch.upper.iter().filter(|upper| (2..=8).contains(&upper.0));
    for &(block, [x, y], [u, v]) in leaning {
        let (across, along) = ((x - u) as f64, (y - v) as f64);
        let apart = (across * across + along * along).sqrt();
        assert!((apart - 6992.7).abs() < 8.0, "block {block}: {apart} at {x}, {y}");
    }
    for (found, wanted) in watch.bounds(2..=8).into_iter().zip([-20_941, 9941, -9941, 9941]) {
        assert!((found - wanted).abs() <= 1, "{found} for {wanted}");
    }
}
