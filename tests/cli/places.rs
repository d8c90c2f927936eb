//! Where a fault stands: file, line and column as numbers, and a caret under the very character.

use crate::scratch::Scratch;

/// Checks `file:line:column` and the caret of a message about one place. Columns count characters from 1.
fn assert_points_at(stderr: &str, file: &str, line: usize, column: usize) {
    let place = format!("{file}:{line}:{column}");
    let says_it = stderr.match_indices(&place).any(|(at, _)| {
        let next = stderr[at + place.len()..].chars().next();
        !next.is_some_and(|c| c.is_ascii_digit())
    });
    assert_eq!(caret(stderr), Some((line, column)), "the caret in\n{stderr}");
    assert!(says_it, "no {place} in\n{stderr}");
}

/// The line shown and the column under which its caret begins.
fn caret(stderr: &str) -> Option<(usize, usize)> {
    let lines: Vec<&str> = stderr.lines().collect();
    lines.windows(2).find_map(|pair| {
        let (number, _) = pair[0].split_once('│')?;
        let number = number.trim().parse().ok()?;
        // The line below has a dot where the text has its bar; the frame around both is drawn with dashes too.
        pair[1].trim_start().strip_prefix('·')?;
        let text_begins = pair[0].chars().position(|c| c == '│')? + 2;
        let caret_begins = pair[1].chars().position(|c| matches!(c, '─' | '┬' | '^' | '▲'))?;
        Some((number, caret_begins + 1 - text_begins))
    })
}

#[test]
fn a_malformed_block_is_shown_with_line_column_and_caret() {
    for (text, line, column) in [
        ("B1B2B3GXL5\n", 1, 10),
        ("B1B2B3GXL0\nDD\n", 1, 10),
        ("B1B2GXL1\n", 1, 5),
        ("B1B2B3B4GXL1\n", 1, 7),
        ("B-1B2B3GXL1\n", 1, 2),
        ("B1.5B2B3GXL1\n", 1, 3),
        ("B1B2B3GZL1\n", 1, 8),
        ("B1B2B3GXR1\n", 1, 9),
        ("B1B2B3GXSL1\n", 1, 10),
        ("B1B0B1GXL1\nB2B0B2GXL1\n   B3B0B3GXL9\n", 3, 13),
        ("%\n(a remark)\nB1B0B1GXL1B2B0B2GXQ1\n", 3, 19),
        ("B1B0B1GXL1\r\nB2B0B2GXL1\r\nB3B0B3GQL1\r\n", 3, 8),
        ("B1B0B1GXL1 ; 0.001, 0.000\nB2B0B2GXLL ; x\n", 2, 10),
        ("B1B2\nB3GX\nL6\n", 3, 2),
        ("B1B0B1GXL1\nDD\nB1B0B1GXL1\n", 3, 1),
    ] {
        let scratch = Scratch::with(&[("bad.3b", text)]);
        let run = scratch.run(&["send", "bad.3b", "--dry-run"]);
        assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{text:?}\n{}", run.stderr);
        assert_points_at(&run.stderr, "bad.3b", line, column);
    }
}

/// The text, or its line, ends where more was expected: that is a place too.
#[test]
fn what_is_broken_off_at_the_end_of_a_line_is_shown_with_a_caret_too() {
    for (file, text) in [
        ("bad.3b", "B1B0B1GXL1\nB1B2B3GX\n"),
        ("bad.3b", "B1B0B1GXL1\nB1B2B3GX"),
        ("bad.toml", "[part]\nkind = \"gear\"\nteeth =\n"),
        ("bad.toml", "[part\nkind = \"gear\"\n"),
    ] {
        let scratch = Scratch::with(&[(file, text)]);
        let run = scratch.run(&["send", file, "--dry-run"]);
        assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{text:?}\n{}", run.stderr);
        assert!(caret(&run.stderr).is_some(), "no caret in\n{}", run.stderr);
    }
}

#[test]
fn a_malformed_block_says_what_was_expected() {
    for (text, expected) in [
        ("B1B2B3GXL5\n", "1, 2, 3 or 4"),
        ("B1B2GXL1\n", "B"),
        ("B1B2B3GZL1\n", "GX"),
        ("B1B2B3GXR1\n", "NR"),
        ("B1.5B2B3GXL1\n", "micrometres"),
    ] {
        let scratch = Scratch::with(&[("bad.3b", text)]);
        let run = scratch.run(&["send", "bad.3b", "--dry-run"]);
        let error = run.stderr.lines().next().unwrap_or_default();
        assert!(error.contains(expected), "{text:?}: {error}");
    }
}

#[test]
fn a_fault_in_a_part_file_is_shown_with_line_column_and_caret() {
    for (text, line, column) in [
        ("[part]\nkind = \"gear\"\nteeht = 36\n", 3, 1),
        ("[part]\nkind = \"gear\"\nteeth = \"many\"\n", 3, 9),
        ("[part]\nkind = \"gear\"\nteeth = 36.5\n", 3, 9),
        ("[part]\nkind = \"gear\"\n  module = nan\n", 3, 12),
        ("[part]\nkind = \"gaer\"\n", 2, 8),
        ("[part]\nkind = \"gear\"\n\n[wire]\noffset = true\n", 5, 10),
        ("[part]\nkind = \"gear\"\n[output]\nend = \"X\"\n", 4, 7),
        ("[part]\nkind = \"gear\"\ndirection = \"left\"\n", 3, 13),
        ("[part]\nkind = \"gear\"\nrepeat = -3\n", 3, 10),
        ("[part]\nkind = \"gear\"\nteeth = 36\nteeth = 37\n", 4, 1),
    ] {
        let scratch = Scratch::with(&[("gear.toml", text)]);
        let run = scratch.run(&["generate", "gear.toml"]);
        assert_eq!((run.code, run.stdout.as_str()), (Some(3), ""), "{text:?}\n{}", run.stderr);
        assert_points_at(&run.stderr, "gear.toml", line, column);
    }
}

#[test]
fn a_misspelt_key_of_a_part_file_is_answered_with_the_right_one() {
    for (text, meant) in [
        ("[part]\nkind = \"gear\"\nteeht = 36\n", "teeth"),
        ("[part]\nkind = \"gear\"\nmodul = 0.4\n", "module"),
        ("[part]\nkind = \"gear\"\ntip-radius = 0.04\n", "tip_radius"),
        ("[part]\nkind = \"gear\"\n[wire]\noffest = 0.1\n", "offset"),
        ("[part]\nkind = \"gear\"\n[output]\nroundng = \"per-block\"\n", "rounding"),
        ("[prat]\nkind = \"gear\"\n", "part"),
        ("[part]\nkind = \"gear\"\n[wires]\noffset = 0.1\n", "wire"),
    ] {
        let scratch = Scratch::with(&[("gear.toml", text)]);
        let run = scratch.run(&["generate", "gear.toml"]);
        assert_eq!(run.code, Some(3), "{text:?}");
        assert!(run.stderr.contains(&format!("did you mean `{meant}`")), "{text:?}\n{}", run.stderr);
    }
}

#[test]
fn a_fault_in_a_machine_profile_is_shown_with_line_column_and_caret() {
    for (text, line, column) in [
        ("[machine]\nname = \"m\"\n[link]\nbuad = 9600\n", 4, 1),
        ("[machine]\nname = \"m\"\n[link]\nbaud = \"fast\"\n", 4, 8),
        ("[machine]\nname = \"m\"\n[link]\nframing = \"9X3\"\n", 4, 11),
        ("[machine]\nname = \"m\"\n[protocol]\n  start = \"soon\"\n", 4, 11),
        ("[machine]\nname = \"m\"\n[protocl]\nstart = \"dc1\"\n", 3, 2),
    ] {
        let scratch = Scratch::with(&[("m.toml", text)]);
        let run = scratch.run(&["machines", "check", "m.toml"]);
        assert_eq!(run.code, Some(4), "{text:?}\n{}", run.stderr);
        assert_points_at(&run.stderr, "m.toml", line, column);
    }
}
