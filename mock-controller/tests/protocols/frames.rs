//! Frames, by the wire format in `docs/protocols.md` and its examples.

use mock_controller::{Protocol, Settings};

use crate::talk::{BLOCK, Talk};
use crate::xmodem::crc;

fn frame(kind: u8, number: u16, payload: &str) -> Vec<u8> {
    let mut body = vec![kind, (number >> 8) as u8, (number & 255) as u8, 0, payload.len() as u8];
    body.extend_from_slice(payload.as_bytes());
    body.extend(crc(&body));
    let mut out = vec![0x7E];
    for byte in body {
        match byte {
            0x11 | 0x13 | 0x7D | 0x7E | 0x91 | 0x93 => out.extend([0x7D, byte ^ 0x20]),
            _ => out.push(byte),
        }
    }
    out.push(0x7E);
    out
}

/// An answer of the control, its payload in bytes.
fn answer(kind: u8, number: u16, payload: &[u8]) -> Vec<u8> {
    frame(kind, number, std::str::from_utf8(payload).unwrap())
}

fn hex(bytes: &str) -> Vec<u8> {
    bytes.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect()
}

#[test]
fn the_examples_of_the_wire_format_byte_by_byte() {
    let mut talk = Talk::in_protocol(Protocol::Frames { window: 1 });
    talk.hears(hex("7E 52 00 01 00 01 01 AE 70 7E"));
    talk.send(hex("7E 44 00 01 00 0B 42 31 42 31 42 31 47 59 4C 31 0A 0F 54 7E"));
    talk.hears(hex("7E 41 00 01 00 01 01 7A 14 7E"));
    assert_eq!(talk.text(), "B1B1B1GYL1\n");
    talk.send(hex("7E 45 00 02 00 00 5C 5F 7E"));
    talk.hears(answer(b'A', 2, &[1]));
    talk.is_done(1);
}

#[test]
fn ready_is_repeated_every_5_s_and_the_last_answer_too() {
    let mut talk = Talk::in_protocol(Protocol::Frames { window: 3 });
    let ready = answer(b'R', 1, &[3]);
    talk.hears(&ready);
    talk.wait(5000);
    talk.hears(&ready);
    talk.send(frame(b'D', 1, BLOCK));
    talk.hears(answer(b'A', 1, &[3]));
    for _ in 0..3 {
        talk.wait(5000);
        talk.hears(answer(b'A', 1, &[3]));
    }
}

#[test]
fn a_block_may_be_cut_up_among_frames_and_one_flag_may_part_them() {
    let mut talk = Talk::in_protocol(Protocol::Frames { window: 4 });
    talk.heard();
    let mut both = frame(b'D', 1, &BLOCK[..5]);
    both.pop();
    both.extend(frame(b'D', 2, &BLOCK[5..]));
    talk.send(&both);
    talk.hears([answer(b'A', 1, &[4]), answer(b'A', 2, &[4])].concat());
    assert_eq!(talk.report().blocks, 1);
}

#[test]
fn broken_and_ahead_are_asked_for_once_a_second_and_what_is_had_is_not_taken_twice() {
    let mut talk = Talk::in_protocol(Protocol::Frames { window: 4 });
    talk.heard();
    let good = frame(b'D', 1, BLOCK);
    let mut flipped = good.clone();
    flipped[8] ^= 0x10;
    let lost = [&good[..9], &good[10..]].concat();
    for broken in [flipped, lost, vec![0x7E, b'D', 0x7D, 0x7E], hex("7E 44 00 7E")] {
        talk.send(&broken);
        talk.hears(answer(b'N', 1, &[]));
        talk.send(frame(b'D', 2, BLOCK));
        talk.hears([0_u8; 0]);
        talk.wait(1000);
    }
    talk.send(&good);
    talk.hears(answer(b'A', 1, &[4]));
    // Behind a frame that was taken the next N comes at once.
    talk.send(frame(b'D', 3, BLOCK));
    talk.hears(answer(b'N', 2, &[]));
    talk.send(&good);
    talk.hears(answer(b'A', 1, &[4]));
    assert_eq!((talk.report().blocks, talk.report().alarm), (1, None));
    // Kinds of another age say nothing.
    talk.send(frame(b'Q', 9, ""));
    talk.hears([0_u8; 0]);
}

#[test]
fn numbers_go_on_from_65535_to_0() {
    let mut talk = Talk::in_protocol(Protocol::Frames { window: 1 });
    talk.heard();
    let empty = "\n";
    for number in 1..=65_540_u32 {
        talk.send(frame(b'D', (number % 65_536) as u16, empty));
        let heard = talk.heard();
        assert_eq!(heard[1], b'A', "{number}");
    }
    talk.send(frame(b'D', 5, BLOCK));
    talk.hears(answer(b'A', 5, &[1]));
    assert_eq!(talk.report().blocks, 1);
}

#[test]
fn an_end_whose_answer_was_lost_is_answered_again_and_an_abort_breaks_off() {
    let mut talk = Talk::in_protocol(Protocol::Frames { window: 1 });
    talk.heard();
    talk.send(frame(b'D', 1, BLOCK));
    talk.send(frame(b'E', 2, ""));
    talk.heard();
    talk.send(frame(b'E', 2, ""));
    talk.hears(answer(b'A', 2, &[1]));
    talk.is_done(1);

    let mut talk = Talk::in_protocol(Protocol::Frames { window: 1 });
    talk.send(frame(b'D', 1, &format!("{BLOCK}B10B")));
    talk.heard();
    talk.send(frame(b'X', 0, "operator"));
    talk.wait(20_000);
    talk.hears([0_u8; 0]);
    assert_eq!((talk.report().blocks, talk.report().torn, talk.report().programs), (1, 1, 0));
}

#[test]
fn an_alarm_and_a_reset_say_why() {
    for (settings, why) in [
        (Settings::unpaced(), "format"),
        (Settings { reset_at_block: Some(2), ..Settings::unpaced() }, "reset"),
    ] {
        let mut talk = Talk::with(Settings { protocol: Protocol::Frames { window: 1 }, ..settings });
        talk.heard();
        talk.send(frame(b'D', 1, &format!("{BLOCK}{BLOCK}Q\n")));
        talk.hears(answer(b'X', 0, why.as_bytes()));
    }
}
