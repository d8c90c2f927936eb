//! What is no program takes no room: comments, empty lines, headers of any length.

use mock_controller::{Dialect, Settings};

use crate::sender::{Sender, run, sha256};
use crate::watch::{four_b, watch};

#[test]
fn comments_and_empty_lines_of_any_length_do_not_fill_the_buffer() {
    let comment = "(THE SECOND OF NINE PLATES, WIRE 0.25, WATER)\n".repeat(20);
    let listing = format!("; {}\n", "0.000, ".repeat(100));
    let empty = "\n".repeat(600);
    for between in [&comment, &listing, &empty] {
        for (settings, block) in [
            (Settings::unpaced(), "B1000BB1000GXL1\n"),
            (four_b(0.0), "B1000BB1000GXL1\n"),
            (Settings { dialect: Dialect::Gcode, ..Settings::unpaced() }, "G91 G01 X1.\n"),
        ] {
            let text = format!("{block}{between}{block}{between}");
            let (report, _) = watch(settings.clone(), &format!("%\n{text}%\n"));
            let found = (report.blocks, report.end_um, report.alarm, report.programs);
            assert_eq!(found, (2, [2000, 0], None, 1), "{between}");
            // Line ends in a row are one, and the comments are part of the text.
            let digested = if between == &empty { block.repeat(2) } else { text.clone() };
            assert_eq!(report.sha256, sha256(&digested));
            // On a line that takes its time, too, with DC3 obeyed.
            let paced = Settings { dialect: settings.dialect, ..Settings::default() };
            let report = run(paced, &mut Sender::of(format!("%\n{text}%\n")));
            assert_eq!((report.blocks, report.alarm, report.programs), (2, None, 1), "{between}");
        }
    }
}

#[test]
fn a_block_without_an_end_fills_it() {
    for (settings, block) in [
        (Settings::unpaced(), "B".to_owned() + &" ".repeat(300)),
        (
            Settings { dialect: Dialect::Gcode, ..Settings::unpaced() },
            "G01 X1.".to_owned() + &" ".repeat(300),
        ),
    ] {
        let (report, _) = watch(settings, &format!("%\n{block}"));
        assert_eq!(report.alarm.as_deref(), Some("buffer-overflow"));
    }
}
