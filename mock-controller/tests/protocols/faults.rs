//! An answer that is lost: what is sent again is cut again where nothing numbers it, and not where something does.

use mock_controller::{EndCode, Protocol, Settings};

use crate::talk::{BLOCK, Talk};
use crate::xmodem::{crc, packet};

fn message(rest: &str) -> Vec<u8> {
    let sum = format!("{rest}\r").bytes().fold(0_u8, u8::wrapping_add);
    format!("{sum:02X}{rest}\r").into_bytes()
}

fn frame(kind: u8, number: u8, payload: &str) -> Vec<u8> {
    let length = u8::try_from(payload.len()).unwrap();
    let mut body = [&[kind, 0, number, 0, length], payload.as_bytes()].concat();
    body.extend(crc(&body));
    let mut frame = vec![0x7E];
    for byte in body {
        match byte {
            0x11 | 0x13 | 0x7D | 0x7E | 0x91 | 0x93 => frame.extend([0x7D, byte ^ 0x20]),
            _ => frame.push(byte),
        }
    }
    frame.push(0x7E);
    frame
}

fn numbered(number: usize, words: &str) -> Vec<u8> {
    let line = format!("N{number} {words}");
    format!("{line}*{}\n", line.bytes().fold(0, |sum, byte| sum ^ byte)).into_bytes()
}

#[test]
fn a_lost_ack_repeats_a_block_where_nothing_numbers_it_and_not_where_something_does() {
    let one = |protocol: Protocol, message: Vec<u8>, before: &[Vec<u8>]| {
        let mut talk = Talk::with(Settings { protocol, ..Settings::unpaced() });
        for message in before {
            talk.send(message);
        }
        talk.send(&message);
        talk.send(&message);
        talk.report().blocks
    };
    let line = BLOCK.trim();
    assert_eq!(one(Protocol::Answer(mock_controller::AnswerBytes::default()), BLOCK.into(), &[]), 2);
    assert_eq!(one(Protocol::Frames { window: 1 }, frame(b'D', 1, BLOCK), &[]), 1);
    assert_eq!(one(Protocol::XmodemCrc, packet(1, BLOCK, 128, crc), &[]), 1);
    assert_eq!(one(Protocol::Marlin, numbered(1, line), &[]), 1);
    let before = [message("RDY"), message("SET")];
    assert_eq!(one(Protocol::FanucA(EndCode::Cr), message(&format!("DAT{BLOCK}")), &before), 2);
}
