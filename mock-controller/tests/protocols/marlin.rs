//! Marlin: numbers and sums, the vector of the sources among them.

use mock_controller::{Dialect, Protocol, Settings};

use crate::talk::Talk;

fn settings() -> Settings {
    Settings { protocol: Protocol::Marlin, dialect: Dialect::Gcode, ..Settings::unpaced() }
}

fn line(number: u64, words: &str) -> String {
    let line = format!("N{number} {words}");
    let sum = line.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("{line}*{sum}\n")
}

#[test]
fn the_vector_of_the_sources() {
    assert_eq!(line(3, "T0"), "N3 T0*57\n");
    let mut talk = Talk::with(settings());
    talk.hears("start\n");
    talk.send(line(2, "M110 N2"));
    talk.hears("ok\n");
    talk.send("N3 T0*57\n");
    talk.hears("ok\n");
    assert_eq!(talk.text(), "T0\n");
}

#[test]
fn a_program_with_numbers_comments_and_lines_without() {
    let mut talk = Talk::with(settings());
    talk.hears("start\n");
    talk.send(line(0, "M110 N0"));
    talk.hears("ok\n");
    talk.send(line(1, "G01 X1."));
    talk.hears("ok\n");
    talk.send(line(2, "X2.").replace('\n', " ; the second\n"));
    talk.hears("ok\n");
    talk.send("X3.\n");
    talk.hears("ok\n");
    talk.send(line(3, "M02"));
    talk.hears("ok\n");
    talk.is_done(3);
}

#[test]
fn what_is_wrong_is_asked_for_again_and_nothing_is_cut_twice() {
    let mut talk = Talk::with(settings());
    talk.hears("start\n");
    talk.send(line(1, "G01 X1."));
    talk.hears("ok\n");
    for (wrong, found) in [
        (line(2, "X2.").replace("X2", "X3"), "checksum mismatch"),
        (line(3, "X3."), "Line Number is not Last Line Number+1"),
        (line(1, "G01 X1."), "Line Number is not Last Line Number+1"),
        ("N2 X2.\n".to_owned(), "No Checksum with line number"),
        ("X2.*12\n".to_owned(), "No Line Number with checksum"),
    ] {
        talk.send(wrong);
        talk.hears(format!("Error:{found}, Last Line: 1\nResend: 2\nok\n"));
    }
    talk.send(line(2, "X2."));
    talk.hears("ok\n");
    assert_eq!((talk.report().blocks, talk.report().alarm), (2, None));
}

#[test]
fn an_alarm_kills_and_a_reset_starts() {
    for (settings, told) in [
        (Settings { alarm_at_block: Some(1), ..settings() }, "Error:Printer halted. kill() called!\n"),
        (Settings { reset_at_block: Some(1), ..settings() }, "start\n"),
    ] {
        let mut talk = Talk::with(settings);
        talk.hears("start\n");
        talk.send(line(1, "G01 X1."));
        talk.hears(told);
    }
}
