//! Fanuc's remote buffer, protocol A: sums worked out by hand where they stand in full.

use mock_controller::{EndCode, Protocol, Settings};

use crate::talk::{BLOCK, Talk};

/// S 53 + Y 59 + N 4E + CR 0D = 107: the sum is 07.
const SYN: &str = "07SYN\r";

fn message(rest: &str) -> String {
    let with_end = format!("{rest}\r");
    format!("{:02X}{with_end}", with_end.bytes().map(u32::from).sum::<u32>() % 256)
}

fn opened() -> Talk {
    let mut talk = Talk::in_protocol(Protocol::FanucA(EndCode::Cr));
    talk.hears(SYN);
    talk.send(message("RDY"));
    talk.hears(message("SAT"));
    talk.send(message("SET"));
    talk.hears(message("GTD"));
    talk
}

#[test]
fn the_sums_by_hand_with_either_end_code() {
    assert_eq!(message("SYN"), SYN);
    // 53 + 59 + 4E + 03 = FD.
    let mut talk = Talk::in_protocol(Protocol::FanucA(EndCode::Etx));
    talk.hears("FDSYN\u{3}");
    // R 52 + D 44 + Y 59 + ETX 03 = F2.
    talk.send("F2RDY\u{3}");
    // S 53 + A 41 + T 54 + ETX 03 = EB.
    talk.hears("EBSAT\u{3}");
}

#[test]
fn a_program_by_dat_wat_and_eod() {
    let mut talk = opened();
    talk.send(message(&format!("DAT{BLOCK}{}", &BLOCK[..4])));
    talk.hears(message("GTD"));
    talk.send(message("WAT"));
    talk.hears("");
    talk.wait(1000);
    talk.hears(message("GTD"));
    talk.send(message(&format!("DAT{}", &BLOCK[4..])));
    talk.hears(message("GTD"));
    assert_eq!(talk.text(), BLOCK.repeat(2));
    talk.send(message("EOD"));
    talk.hears("");
    talk.is_done(2);
}

#[test]
fn a_host_that_is_not_ready_is_asked_again_and_one_that_is_silent_too() {
    let mut talk = Talk::in_protocol(Protocol::FanucA(EndCode::Cr));
    talk.hears(SYN);
    talk.send(SYN);
    talk.hears("");
    talk.wait(1000);
    talk.hears(SYN);
    for _ in 0..30 {
        talk.wait(10_000);
        talk.hears(SYN);
    }
}

#[test]
fn a_broken_message_is_asked_for_again_and_cut_once() {
    let mut talk = opened();
    let good = message(&format!("DAT{BLOCK}"));
    let rty = message("RTY");
    talk.send(good.replace("GX", "GY"));
    talk.hears(&rty);
    // Its end lost, the silence tells.
    talk.send(&good[..good.len() - 1]);
    talk.hears("");
    talk.wait(1000);
    talk.hears(&rty);
    // An answer to nothing that was asked.
    talk.send(message("CLB"));
    talk.hears(&rty);
    talk.send(&good);
    talk.hears(message("GTD"));
    // The host may ask as well.
    talk.send(&rty);
    talk.hears(message("GTD"));
    assert_eq!((talk.report().blocks, talk.report().alarm), (1, None));
}

#[test]
fn errors_without_an_end_are_given_up() {
    let mut talk = opened();
    for _ in 0..10 {
        talk.send("00DAT\r");
        talk.hears(message("RTY"));
    }
    talk.send("00DAT\r");
    talk.hears(message("ALM"));
    talk.has_alarm("retries");
}

#[test]
fn an_alarm_and_a_reset_are_told() {
    for (settings, told) in [
        (Settings { alarm_at_block: Some(2), ..Settings::unpaced() }, "ALM"),
        (Settings { reset_at_block: Some(2), ..Settings::unpaced() }, "RST"),
    ] {
        let mut talk = Talk::with(Settings { protocol: Protocol::FanucA(EndCode::Cr), ..settings });
        talk.send(message("RDY"));
        talk.send(message("SET"));
        talk.heard();
        talk.send(message(&format!("DAT{BLOCK}{BLOCK}")));
        talk.hears(message(told));
    }
}
