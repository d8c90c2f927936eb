//! YMODEM: header, data, the two EOT, and the empty header at the end.

use mock_controller::Protocol;

use crate::talk::{ACK, BLOCK, CAN, NAK, Talk};
use crate::xmodem::{crc, packet};

const EOT: u8 = 0x04;

fn header(name: &str, length: &str) -> Vec<u8> {
    let mut data = [name.as_bytes(), b"\0", length.as_bytes()].concat();
    data.resize(128, 0);
    [&[0x01, 0x00, 0xFF][..], &data, &crc(&data)].concat()
}

/// Opens a talk up to the request for packet 1.
fn opened(length: &str) -> Talk {
    let mut talk = Talk::in_protocol(Protocol::Ymodem);
    talk.hears(b"C");
    talk.send(header("gear.3b", length));
    talk.hears([ACK, b'C']);
    talk
}

#[test]
fn a_file_with_its_length_is_taken_to_the_byte() {
    let text = BLOCK.repeat(100);
    // The length may be followed by time and mode; padding behind the length would be a block if it were program.
    let mut talk = opened(&format!("{} 14302456321 100644", text.len()));
    talk.send(packet(1, &text[..1024], 1024, crc));
    talk.hears([ACK]);
    talk.send(packet(2, &format!("{}{BLOCK}", &text[1024..]), 1024, crc));
    talk.hears([ACK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([NAK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([ACK, b'C']);
    assert!(!talk.control.is_finished(), "the end of the files has not been told");
    talk.send(header("", ""));
    talk.hears([ACK]);
    assert_eq!(talk.text(), text);
    talk.is_done(100);
}

#[test]
fn two_files_are_two_programs() {
    let mut talk = opened("24");
    for file in 1..=2 {
        talk.send(packet(1, &BLOCK.repeat(2), 128, crc));
        talk.hears([ACK]);
        talk.send([EOT]);
        talk.wait(100);
        talk.hears([NAK]);
        talk.send([EOT]);
        talk.wait(100);
        talk.hears([ACK, b'C']);
        if file == 1 {
            talk.send(header("second.3b", "24"));
            talk.hears([ACK, b'C']);
        }
    }
    talk.send(header("", ""));
    talk.hears([ACK]);
    assert_eq!((talk.report().blocks, talk.report().programs), (4, 2));
}

#[test]
fn a_header_that_comes_again_and_a_packet_that_comes_again_are_not_taken_twice() {
    let mut talk = opened("24");
    talk.send(header("gear.3b", "24"));
    talk.hears([ACK, b'C']);
    for _ in 0..2 {
        talk.send(packet(1, &BLOCK.repeat(2), 128, crc));
        talk.hears([ACK]);
    }
    assert_eq!((talk.report().blocks, talk.report().alarm), (2, None));
}

#[test]
fn fewer_bytes_than_the_length_are_an_alarm() {
    let mut talk = opened("300");
    talk.send(packet(1, &format!("{}        ", BLOCK.repeat(10)), 128, crc));
    talk.hears([ACK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([NAK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([CAN, CAN]);
    talk.has_alarm("size");
}

#[test]
fn a_broken_header_is_asked_for_again_and_a_sender_without_a_last_word_is_let_go() {
    let mut talk = Talk::in_protocol(Protocol::Ymodem);
    talk.hears(b"C");
    let mut broken = header("gear.3b", "12");
    broken[5] ^= 1;
    talk.send(broken);
    talk.wait(1000);
    talk.hears(b"C");
    talk.send(header("gear.3b", "12"));
    talk.hears([ACK, b'C']);
    talk.send(packet(1, BLOCK, 128, crc));
    talk.hears([ACK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([NAK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([ACK, b'C']);
    for _ in 0..9 {
        assert!(!talk.control.is_finished());
        talk.wait(3000);
        talk.hears(b"C");
    }
    talk.wait(3000);
    talk.is_done(1);
}
