//! grbl: ok for ok, 128 characters, and what is no answer.

use std::collections::BTreeMap;

use mock_controller::{Dialect, FaultKind, Protocol, Settings};

use crate::talk::{CAN, Talk};

const BANNER: &str = "\r\nGrbl 1.1h ['$' for help]\r\n";

fn settings() -> Settings {
    Settings { protocol: Protocol::Grbl, dialect: Dialect::Gcode, ..Settings::unpaced() }
}

#[test]
fn every_line_is_answered_an_empty_one_too() {
    let mut talk = Talk::with(settings());
    talk.hears(BANNER);
    for line in ["G21 G90\n", "G01 X1. Y0. F100\r\n", "\n", "(comment)\n", "X2.\n", "M02\n"] {
        talk.send(line);
        talk.hears("ok\r\n");
    }
    talk.is_done(2);
}

#[test]
fn real_time_characters_are_no_part_of_a_line_and_their_answer_is_none() {
    let mut talk = Talk::with(settings());
    talk.hears(BANNER);
    talk.send("G01?X1.\n");
    talk.hears("<Run|Bf:15,125>\r\nok\r\n");
    talk.send("!X2.\n?");
    talk.hears("<Hold:0|Bf:15,124>\r\n");
    assert_eq!(talk.report().blocks, 1);
    talk.send("~\n");
    talk.hears("ok\r\nok\r\n");
    assert_eq!(talk.report().blocks, 2);
    talk.send([b'X', CAN]);
    talk.hears(BANNER);
    assert_eq!(talk.report().alarm, None);
}

#[test]
fn the_129th_character_without_an_ok_is_lost_with_an_alarm() {
    let mut talk = Talk::with(settings());
    talk.hears(BANNER);
    talk.send("!".to_owned() + &" ".repeat(128));
    assert_eq!(talk.report().alarm, None);
    talk.send(" ");
    talk.has_alarm("buffer-overflow");
    talk.hears("ALARM:1\r\n");
    assert_eq!(talk.report().unread, 1);
}

#[test]
fn what_cannot_be_read_is_an_error_an_alarm_an_alarm_and_a_reset_the_banner() {
    for (settings, line, told) in [
        (settings(), "X1.Q\n", "error:20\r\n"),
        (settings(), "G99\n", "error:20\r\n"),
        (Settings { alarm_at_block: Some(1), ..settings() }, "G01 X1.\n", "ALARM:1\r\n"),
        (Settings { reset_at_block: Some(1), ..settings() }, "G01 X1.\n", BANNER),
    ] {
        let mut talk = Talk::with(settings);
        talk.hears(BANNER);
        talk.send("%\n");
        talk.hears("ok\r\n");
        talk.send(line);
        talk.hears(told);
    }
}

#[test]
fn an_ok_may_be_lost_or_doubled() {
    for (kind, heard) in [(FaultKind::XonLost, ""), (FaultKind::XonDouble, "ok\r\nok\r\n")] {
        let mut talk = Talk::with(Settings { faults: BTreeMap::from([(kind, 1.0)]), ..settings() });
        talk.hears(BANNER);
        talk.send("G01 X1.\n");
        talk.hears(heard);
        assert_eq!(talk.report().faults[kind.name()], 1);
    }
}
