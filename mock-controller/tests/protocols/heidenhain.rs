//! Heidenhain's blockwise transfer, its vector among the bytes.

use mock_controller::{Protocol, Settings};

use crate::talk::{ACK, BLOCK, NAK, Talk};

const EOT: u8 = 0x04;
const ETX: u8 = 0x03;

fn block(opens: u8, text: &str) -> Vec<u8> {
    let mut block = [&[opens], text.as_bytes(), &[0x17]].concat();
    let mut check = block.iter().copied().reduce(|a, b| a ^ b).unwrap();
    if check < 0x20 {
        block.insert(block.len() - 1, b' ');
        check ^= b' ';
    }
    block.extend([check, 0x11]);
    block
}

fn opened() -> Talk {
    let mut talk = Talk::in_protocol(Protocol::HeidenhainBcc);
    talk.hears([0_u8; 0]);
    // SOH H15E ETB has 1F for its check: a blank goes before ETB, and 3F is the check.
    assert_eq!(block(0x01, "H15E"), [0x01, b'H', b'1', b'5', b'E', b' ', 0x17, 0x3F, 0x11]);
    talk.send(block(0x01, "H15E"));
    talk.hears([ACK]);
    talk
}

#[test]
fn the_vector_of_the_sources_without_the_blank() {
    let mut talk = Talk::in_protocol(Protocol::HeidenhainBcc);
    talk.send([0x01, b'H', b'1', b'5', b'E', 0x17, 0x1F, 0x11]);
    talk.hears([ACK]);
}

#[test]
fn a_program_line_by_line_with_the_end_of_the_manual() {
    let mut talk = opened();
    for line in [BLOCK.trim(), "B10BB10GXL1\r\n", "DD"] {
        talk.send(block(0x02, line));
        talk.hears([ACK]);
    }
    talk.send([ETX, EOT]);
    talk.hears([0_u8; 0]);
    assert_eq!(talk.text().replace(' ', ""), format!("{BLOCK}{BLOCK}DD\n"));
    talk.is_done(2);
}

#[test]
fn an_end_whose_eot_was_lost_is_one_after_a_while() {
    let mut talk = opened();
    talk.send(block(0x02, BLOCK.trim()));
    talk.hears([ACK]);
    talk.send([ETX]);
    assert!(!talk.control.is_finished());
    talk.wait(2000);
    talk.is_done(1);
}

#[test]
fn a_broken_block_comes_at_most_three_times_again() {
    let mut talk = opened();
    let good = block(0x02, BLOCK.trim());
    let mut flipped = good.clone();
    flipped[3] ^= 0x01;
    talk.send(&flipped);
    talk.hears([NAK]);
    // A lost check makes DC1 the check: nothing follows, and the silence tells.
    talk.send([&good[..good.len() - 2], &[0x11]].concat());
    talk.hears([0_u8; 0]);
    talk.wait(2000);
    talk.hears([NAK]);
    talk.send(&good);
    talk.hears([ACK]);
    assert_eq!(talk.report().blocks, 1);
    for _ in 0..3 {
        talk.send(&flipped);
        talk.hears([NAK]);
    }
    talk.send(&flipped);
    talk.hears([EOT]);
    talk.has_alarm("retries");
}

#[test]
fn blocks_before_the_header_and_noise_are_refused_and_a_header_again_is_answered() {
    let mut talk = Talk::in_protocol(Protocol::HeidenhainBcc);
    talk.send(block(0x02, "B1"));
    talk.hears([NAK]);
    talk.send(b"H15E\x17\x1F\x11");
    talk.hears([NAK]);
    talk.send(block(0x01, "H15E"));
    talk.hears([ACK]);
    talk.send(block(0x01, "H15E"));
    talk.hears([ACK]);
    talk.send(block(0x02, BLOCK.trim()));
    talk.hears([ACK]);
    assert_eq!((talk.report().blocks, talk.report().alarm), (1, None));
}

#[test]
fn an_alarm_is_eot_and_the_senders_eot_breaks_off() {
    let settings =
        Settings { alarm_at_block: Some(1), protocol: Protocol::HeidenhainBcc, ..Settings::unpaced() };
    let mut talk = Talk::with(settings);
    talk.send(block(0x01, "H1E"));
    talk.hears([ACK]);
    talk.send(block(0x02, BLOCK.trim()));
    talk.hears([EOT]);
    let mut talk = opened();
    talk.send(block(0x02, "B10B"));
    talk.hears([ACK]);
    talk.send([EOT]);
    talk.hears([0_u8; 0]);
    assert_eq!((talk.report().torn, talk.report().programs, talk.report().alarm), (1, 0, None));
}
