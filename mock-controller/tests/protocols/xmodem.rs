//! XMODEM: packets put together here, with a sum and a CRC of the test's own.

use std::collections::BTreeMap;

use mock_controller::{FaultKind, Protocol, Settings};

use crate::talk::{ACK, BLOCK, CAN, NAK, Talk};

const EOT: u8 = 0x04;

pub(crate) fn sum(data: &[u8]) -> Vec<u8> {
    vec![u8::try_from(data.iter().map(|&byte| u32::from(byte)).sum::<u32>() % 256).unwrap()]
}

/// The remainder of the message by x^16 + x^12 + x^5 + 1, a bit at a time from the message's end.
pub(crate) fn crc(data: &[u8]) -> Vec<u8> {
    let bits = data.iter().chain(&[0, 0]).flat_map(|&byte| (0..8).rev().map(move |bit| byte >> bit & 1));
    let remainder = bits.fold(0_u32, |remainder, bit| {
        let shifted = remainder << 1 | u32::from(bit);
        if shifted & 0x1_0000 == 0 { shifted } else { shifted ^ 0x1_1021 }
    });
    vec![u8::try_from(remainder >> 8).unwrap(), u8::try_from(remainder & 0xFF).unwrap()]
}

pub(crate) fn packet(number: u8, text: &str, size: usize, check: fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut data = text.as_bytes().to_vec();
    data.resize(size, 0x1A);
    let head = [if size == 128 { 0x01 } else { 0x02 }, number, 255 - number];
    [&head[..], &data, &check(&data)].concat()
}

#[test]
fn the_tests_own_crc_is_the_published_one() {
    assert_eq!(crc(b"123456789"), [0x31, 0xC3]);
}

#[test]
fn a_program_of_two_packets_with_a_sum() {
    let mut talk = Talk::in_protocol(Protocol::Xmodem);
    talk.hears([NAK]);
    let text = format!("{}DD\n", BLOCK.repeat(14));
    talk.send(packet(1, &text[..128], 128, sum));
    talk.hears([ACK]);
    talk.send(packet(2, &text[128..], 128, sum));
    talk.hears([ACK]);
    talk.send([EOT]);
    talk.hears([0_u8; 0]);
    talk.wait(100);
    talk.hears([ACK]);
    assert_eq!(talk.text(), text);
    talk.is_done(14);
}

#[test]
fn the_receiver_asks_every_10_s_for_a_sum_and_every_3_s_for_a_crc_without_an_end() {
    for (protocol, with, every) in
        [(Protocol::Xmodem, NAK, 10), (Protocol::XmodemCrc, b'C', 3), (Protocol::Xmodem1k, b'C', 3)]
    {
        let mut talk = Talk::in_protocol(protocol);
        talk.hears([with]);
        for _ in 0..40 {
            talk.wait(every * 1000 - 1);
            talk.hears([0_u8; 0]);
            talk.wait(1);
            talk.hears([with]);
        }
    }
}

#[test]
fn packets_of_1024_and_128_with_a_crc_and_of_1024_only_where_they_are_asked_for() {
    let long = BLOCK.repeat(80);
    let mut talk = Talk::in_protocol(Protocol::Xmodem1k);
    talk.hears(b"C");
    talk.send(packet(1, &long, 1024, crc));
    talk.hears([ACK]);
    talk.send(packet(2, BLOCK, 128, crc));
    talk.hears([ACK]);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([ACK]);
    // The text has no stop word: the transfer's end is the program's.
    talk.is_done(81);
    let mut talk = Talk::in_protocol(Protocol::XmodemCrc);
    talk.hears(b"C");
    talk.send(packet(1, &long, 1024, crc));
    talk.hears([0_u8; 0]);
    talk.wait(1000);
    talk.hears(b"C");
    assert_eq!(talk.report().blocks, 0);
}

#[test]
fn a_broken_packet_is_asked_for_again_and_cut_once() {
    let good = packet(1, BLOCK, 128, crc);
    // A bit, a byte lost, a byte too many, a number that is not its own complement.
    let mut flipped = good.clone();
    flipped[40] ^= 0x04;
    let lost = [&good[..40], &good[41..]].concat();
    let added = [&good[..40], b"B", &good[40..]].concat();
    let mut number = good.clone();
    number[2] ^= 1;
    // The number of packet 4, its SOH lost, is EOT.
    for broken in [flipped, lost, added, number, good[1..].to_vec()] {
        let mut talk = Talk::in_protocol(Protocol::XmodemCrc);
        talk.hears(b"C");
        talk.send(&good);
        talk.hears([ACK]);
        let second = packet(2, BLOCK, 128, crc);
        talk.send(&broken);
        talk.hears([0_u8; 0]);
        talk.wait(1000);
        talk.hears([NAK]);
        talk.send(&second);
        talk.hears([ACK]);
        assert_eq!((talk.report().blocks, talk.report().alarm), (2, None));
    }
}

#[test]
fn the_number_of_a_packet_whose_soh_was_lost_is_no_end() {
    let mut talk = Talk::in_protocol(Protocol::Xmodem);
    talk.hears([NAK]);
    for number in 1..=3 {
        talk.send(packet(number, BLOCK, 128, sum));
        talk.hears([ACK]);
    }
    talk.send(&packet(4, BLOCK, 128, sum)[1..]);
    talk.wait(1000);
    talk.hears([NAK]);
    assert_eq!((talk.report().programs, talk.report().blocks), (0, 3));
}

#[test]
fn a_packet_that_comes_again_is_answered_and_not_cut_again() {
    let mut talk = Talk::in_protocol(Protocol::Xmodem);
    talk.hears([NAK]);
    talk.send(packet(1, BLOCK, 128, sum));
    talk.hears([ACK]);
    talk.send(packet(1, BLOCK, 128, sum));
    talk.hears([ACK]);
    assert_eq!(talk.report().blocks, 1);
    talk.send(packet(3, BLOCK, 128, sum));
    talk.has_alarm("sequence");
    talk.hears([CAN, CAN]);
}

#[test]
fn numbers_go_on_from_255_to_0() {
    let mut talk = Talk::in_protocol(Protocol::XmodemCrc);
    talk.hears(b"C");
    for number in 1..=600_u32 {
        talk.send(packet(u8::try_from(number % 256).unwrap(), BLOCK, 128, crc));
        talk.hears([ACK]);
    }
    assert_eq!((talk.report().blocks, talk.report().alarm), (600, None));
}

#[test]
fn silence_is_asked_into_ten_times_and_then_given_up() {
    let mut talk = Talk::in_protocol(Protocol::Xmodem);
    talk.hears([NAK]);
    talk.send(packet(1, BLOCK, 128, sum));
    talk.hears([ACK]);
    for _ in 0..10 {
        talk.wait(10_000);
        talk.hears([NAK]);
    }
    talk.wait(10_000);
    talk.hears([CAN, CAN]);
    talk.has_alarm("retries");
}

#[test]
fn an_end_whose_answer_was_lost_is_answered_again_and_two_can_break_off() {
    let faults = BTreeMap::from([(FaultKind::XonLost, 1.0)]);
    let mut talk = Talk::with(Settings { protocol: Protocol::Xmodem, faults, ..Settings::unpaced() });
    talk.send(packet(1, BLOCK, 128, sum));
    talk.send([EOT]);
    talk.wait(100);
    talk.send([EOT]);
    talk.wait(100);
    talk.hears([0_u8; 0]);
    assert_eq!((talk.report().blocks, talk.report().programs), (1, 1));
    assert!(talk.report().faults["xon-lost"] >= 4, "NAK, ACK, and two for the end");

    let mut talk = Talk::in_protocol(Protocol::Xmodem);
    talk.hears([NAK]);
    talk.send(packet(1, &format!("{BLOCK}B10B"), 128, sum));
    talk.hears([ACK]);
    talk.send([CAN, CAN]);
    talk.wait(60_000);
    talk.hears([0_u8; 0]);
    let report = talk.report();
    assert_eq!((report.blocks, report.torn, report.programs, report.alarm), (1, 1, 0, None));
}

#[test]
fn an_alarm_and_a_reset_cancel() {
    for settings in [
        Settings { alarm_at_block: Some(2), ..Settings::unpaced() },
        Settings { reset_at_block: Some(2), ..Settings::unpaced() },
    ] {
        let mut talk = Talk::with(Settings { protocol: Protocol::Xmodem, ..settings });
        talk.hears([NAK]);
        talk.send(packet(1, &BLOCK.repeat(3), 128, sum));
        talk.hears([CAN, CAN]);
        assert_eq!(talk.report().blocks, 1);
    }
}
