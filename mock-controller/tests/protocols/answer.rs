//! Answer: a block, then ACK, NAK or the request for the next.

use mock_controller::{AnswerBytes, Protocol};

use crate::talk::{ACK, BLOCK, NAK, Talk};

#[test]
fn each_block_is_answered_and_empty_lines_are_not() {
    let mut talk = Talk::in_protocol(Protocol::Answer(AnswerBytes::default()));
    talk.hears([0_u8; 0]);
    for line in ["%\n", BLOCK, "\0\0\r\n", BLOCK, "DD\n", "%\n"] {
        talk.send(line);
        let is_empty = line.starts_with('\0');
        talk.hears(if is_empty { &[][..] } else { &[ACK] });
    }
    assert_eq!(talk.text(), format!("{BLOCK}{BLOCK}DD\n"));
    talk.is_done(2);
}

#[test]
fn a_block_with_a_parity_error_is_refused_and_taken_when_it_comes_again() {
    let bytes = AnswerBytes { ack: b'+', nak: b'-', request: None };
    let mut talk = Talk::in_protocol(Protocol::Answer(bytes));
    talk.send(b"B10B\0B10GXL1\n");
    talk.hears(b"-");
    talk.send(BLOCK);
    talk.hears(b"+");
    talk.send(b"%");
    talk.is_done(1);
}

#[test]
fn a_control_that_asks_asks_for_the_first_block_too() {
    let bytes = AnswerBytes { request: Some(0x11), ..AnswerBytes::default() };
    let mut talk = Talk::in_protocol(Protocol::Answer(bytes));
    talk.hears([0x11]);
    talk.send(BLOCK);
    talk.hears([0x11]);
    talk.send(b"B10B\0\n");
    talk.hears([NAK]);
    talk.send(b"E\n");
    talk.hears([0x11]);
    talk.is_done(1);
}
