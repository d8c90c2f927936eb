//! What a program says besides its path comes through, or is counted on standard error.

use crate::control::{assert_same_cut, cut_3b};
use crate::shop::Shop;

const LISTING: &str = "; PUNCH 7\n***\nN   1: B5000B0B5000GXL1 ; first side\n(second side)\nN   2: B0B5000B5000GYL2\nD\n\
                       N   3: B5000B0B5000GXL3\nN   4: B0B5000B5000GYL4\nDD\n";

#[test]
fn a_3b_listing_keeps_its_remarks_where_they_are_asked_for() {
    let shop = Shop::with("in.3b", LISTING);
    let brackets = shop.run("convert in.3b --remarks brackets --numbers");
    assert_eq!(brackets.code, Some(0), "{}", brackets.stderr);
    for kept in ["(PUNCH 7)", "(first side)", "(second side)", "N   1: B", "N   4: B", "\nD\n", "DD\n"] {
        assert!(brackets.stdout.replace("( ", "(").contains(kept), "{kept}:\n{}", brackets.stdout);
    }
    let semicolons = shop.run("convert in.3b --remarks semicolons");
    for kept in ["; PUNCH 7\n", "; first side\n", "second side\n"] {
        assert!(semicolons.stdout.contains(kept), "{kept}:\n{}", semicolons.stdout);
    }
    // Read again, they are remarks still, and the cut is the same.
    for text in [&brackets.stdout, &semicolons.stdout] {
        shop.write("again.3b", text);
        let again = shop.run("convert again.3b --remarks semicolons");
        assert_eq!(again.code, Some(0), "{}", again.stderr);
        for kept in ["PUNCH 7", "first side", "second side"] {
            assert!(again.stdout.contains(kept), "{kept}:\n{}", again.stdout);
        }
        let bare = shop.convert("again.3b");
        assert!(bare.starts_with('B') && !bare.contains(['(', ';', 'N']), "{bare}");
        assert_same_cut(&cut_3b(&bare), &cut_3b(&shop.convert("in.3b")), 0, text);
    }
}

#[test]
fn numbers_are_kept_as_read_where_that_is_asked_for() {
    let listing =
        "N  10: B5000B0B5000GXL1\nB0B5000B5000GYL2\nN  30: B5000B0B5000GXL3\nN  40: B0B5000B5000GYL4\nDD\n";
    let shop = Shop::with("in.3b", listing);
    let run = shop.run("convert in.3b --numbers=as-read --interpolator rotated");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let starts: Vec<&str> = run.stdout.lines().map(|line| line.split('B').next().unwrap()).collect();
    assert_eq!(starts, ["N  10: ", "", "N  30: ", "N  40: ", "DD"]);
    assert!(!run.stderr.contains("line number"), "{}", run.stderr);
    assert!(shop.convert("in.3b --numbers").starts_with("N   1: B5000"));
}

#[test]
fn what_a_3b_program_has_no_room_for_is_counted() {
    let shop = Shop::with("in.3b", LISTING);
    let run = shop.run("convert in.3b");
    assert!(run.stderr.contains("left out: 3 comments, first in line 1\n"), "{}", run.stderr);
    assert!(run.stderr.contains("left out: 4 line numbers, first in line 3\n"), "{}", run.stderr);
    assert_eq!(run.stdout.lines().count(), 6, "{}", run.stdout);

    shop.write("in.nc", GCODE);
    let run = shop.run("convert in.nc --to 3b --register 1=0.1");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for left_out in [
        "4 header lines, first in line 1",
        "3 comments, first in line 2",
        "11 line numbers, first in line 3",
        "2 words, first in line 5",
        "1 unknown word, first in line 7",
        "1 dwell, first in line 8",
        "1 stop on request (M01), written as a stop in any case (D), first in line 11",
    ] {
        assert!(run.stderr.contains(&format!("left out: {left_out}\n")), "{left_out}: {}", run.stderr);
    }
}

const GCODE: &str = "%\nO0042 (PUNCH (7)\nN10 G21 G90\nN20 G92 X0. Y-3.\nN30 S4\n; before the cut\nN40 M60\nN50 G04 X1.5\n\
                     N60 G41 D1 G01 X0. Y0. F2.5 (lead in)\nN70 X5.\n/N80 M01\nN90 Y5.\nX0.\nN100 Y0.\nG40 Y-3.\nN110 M30\n%\n";

#[test]
fn gcode_keeps_its_numbers_remarks_frame_and_words() {
    let shop = Shop::with("in.nc", GCODE);
    let once = shop.convert("in.nc");
    let lines: Vec<&str> = once.lines().collect();
    assert_eq!((lines.first(), lines.last()), (Some(&"%"), Some(&"%")), "{once}");
    for kept in [
        "O0042",
        "PUNCH (7",
        "before the cut",
        "lead in",
        "S4",
        "M60",
        "F2.5",
        "G41 D1",
        "/N80 M01",
        "N60 ",
        "N70 ",
        "N110 M",
        "G04 X1.5",
        "G40",
    ] {
        assert!(once.contains(kept), "{kept}:\n{once}");
    }
    for number in [50, 60, 70, 90, 100, 110] {
        let count = once.lines().filter(|line| line.starts_with(&format!("N{number} "))).count();
        assert_eq!(count, 1, "N{number}:\n{once}");
    }
    // Written twice it is written the same.
    shop.write("once.nc", &once);
    assert_eq!(shop.convert("once.nc"), once);
    let numbered = shop.convert("in.nc --number-step 5");
    assert!(
        numbered.contains("\nN5 ") && numbered.contains("\nN10 ") && !numbered.contains("N110"),
        "{numbered}"
    );
}

#[test]
fn the_dialect_for_want_of_another_is_told() {
    let shop = Shop::with("in.nc", GCODE);
    let run = shop.run("convert in.nc");
    assert!(
        run.stderr.contains("G-code is read in the dialect generic, for want of another\n"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.contains("G-code is written in the dialect generic, for want of another\n"),
        "{}",
        run.stderr
    );
    let named = shop.run("convert in.nc --dialect fanuc");
    assert!(!named.stderr.contains("for want of another"), "{}", named.stderr);
}
