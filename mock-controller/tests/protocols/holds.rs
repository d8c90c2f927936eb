//! Every protocol against a control that is slower than its line: it holds, loses nothing, and says nothing it should not.

use mock_controller::{AnswerBytes, EndCode, Framing, Pace, Protocol, Settings};

use crate::talk::{ACK, BLOCK, NAK, Talk};
use crate::xmodem::{packet, sum};

/// A control that takes ten times as long as the line for a block, and has room for three.
fn slow(protocol: Protocol) -> Talk {
    let framing: Framing = "8N1".parse().unwrap();
    Talk::with(Settings {
        protocol,
        pace: Pace::Paced { baud: 9600, framing },
        cutting_time: 10.0,
        buffer_bytes: 60,
        xoff_at: 30,
        xon_at: 13,
        ..Settings::default()
    })
}

/// Waits for an answer; how many milliseconds it took.
#[track_caller]
fn answer_after(talk: &mut Talk, wanted: impl AsRef<[u8]>) -> u64 {
    let mut heard = Vec::new();
    for waited in 0..600_000 {
        heard.extend(talk.control.receive(talk.now));
        if heard.ends_with(wanted.as_ref()) {
            return waited;
        }
        talk.wait(1);
    }
    panic!("never heard {:02X?}, but {heard:02X?}", wanted.as_ref());
}

#[test]
fn xmodem_holds_by_an_ack_that_does_not_come_and_a_packet_again_meanwhile_is_borne() {
    let mut talk = slow(Protocol::Xmodem);
    answer_after(&mut talk, [NAK]);
    let text = BLOCK.repeat(10);
    talk.send(packet(1, &text, 128, sum));
    // Ten blocks at 125 ms each, all but the last three of which must be cut before the packet is taken.
    talk.wait(200);
    talk.send(packet(1, &text, 128, sum));
    let waited = answer_after(&mut talk, [ACK]);
    assert!(waited > 300, "{waited}");
    talk.wait(5000);
    assert_eq!(talk.control.receive(talk.now), [0_u8; 0], "one answer, and no NAK");
    assert_eq!((talk.report().blocks, talk.report().alarm), (10, None));
    assert!(talk.report().holds > 0 && talk.report().max_overrun_bytes == 0);
}

#[test]
fn blocks_one_by_one_are_answered_as_they_are_taken() {
    for protocol in
        [Protocol::Answer(AnswerBytes::default()), Protocol::HeidenhainBcc, Protocol::FanucA(EndCode::Cr)]
    {
        let mut talk = slow(protocol.clone());
        let mut longest = 0;
        match protocol {
            Protocol::HeidenhainBcc => {
                // 01 ^ H ^ 1 ^ E ^ 17 = 2A.
                talk.send(b"\x01H1E\x17\x2A\x11");
                answer_after(&mut talk, [ACK]);
            }
            Protocol::FanucA(_) => {
                answer_after(&mut talk, "SYN\r");
                // 52 + 44 + 59 + 0D = FC; 53 + 45 + 54 + 0D = F9.
                talk.send("FCRDY\r");
                answer_after(&mut talk, "SAT\r");
                talk.send("F9SET\r");
                answer_after(&mut talk, "GTD\r");
            }
            _ => {}
        }
        for _ in 0..20 {
            match protocol {
                Protocol::HeidenhainBcc => {
                    let body = [&[0x02][..], BLOCK.trim().as_bytes(), &[0x17]].concat();
                    let check = body.iter().fold(0, |check, byte| check ^ byte);
                    talk.send([&body[..], &[check, 0x11]].concat());
                    longest = longest.max(answer_after(&mut talk, [ACK]));
                }
                Protocol::FanucA(_) => {
                    let rest = format!("DAT{BLOCK}\r");
                    let sum = rest.bytes().fold(0_u8, u8::wrapping_add);
                    talk.send(format!("{sum:02X}{rest}"));
                    longest = longest.max(answer_after(&mut talk, "GTD\r"));
                }
                _ => {
                    talk.send(BLOCK);
                    longest = longest.max(answer_after(&mut talk, [ACK]));
                }
            }
        }
        talk.wait(60_000);
        let report = talk.report();
        assert_eq!((report.blocks, report.alarm.as_deref()), (20, None), "{protocol:?}");
        assert!(report.holds > 3 && longest > 50, "{protocol:?}: {longest} {report:?}");
    }
}

#[test]
fn frames_say_that_they_hold_and_take_what_was_announced() {
    let mut talk = slow(Protocol::Frames { window: 2 });
    talk.wait(100);
    talk.control.receive(talk.now);
    let frame = |number: u8| {
        let body = [&[b'D', 0, number, 0, 36], BLOCK.repeat(3).as_bytes()].concat();
        // None of these bytes has to be escaped but perhaps those of the check.
        let check = crate::xmodem::crc(&body);
        let mut frame = [&[0x7E], &body[..]].concat();
        for byte in check {
            match byte {
                0x11 | 0x13 | 0x7D | 0x7E | 0x91 | 0x93 => frame.extend([0x7D, byte ^ 0x20]),
                _ => frame.push(byte),
            }
        }
        frame.push(0x7E);
        frame
    };
    talk.send(frame(1));
    talk.send(frame(2));
    let mut windows = Vec::new();
    let mut number = 3;
    let mut heard = Vec::new();
    for _ in 0..20_000 {
        heard.extend(talk.control.receive(talk.now));
        // A frame begins and ends with a flag.
        let flags = heard.iter().filter(|&&byte| byte == 0x7E).count();
        let whole = if flags.is_multiple_of(2) { std::mem::take(&mut heard) } else { Vec::new() };
        for answer in whole.split(|&byte| byte == 0x7E).filter(|answer| !answer.is_empty()) {
            assert_eq!(answer[0], b'A', "{answer:02X?}");
            windows.push((answer[2], answer[5]));
            let last = answer[2];
            while number <= last + answer[5] && number <= 6 {
                talk.send(frame(number));
                number += 1;
            }
        }
        talk.wait(1);
    }
    assert!(windows.iter().any(|&(_, window)| window == 0), "{windows:?}");
    assert!(windows.contains(&(6, 2)), "{windows:?}");
    let report = talk.report();
    assert_eq!((report.blocks, report.alarm, report.max_overrun_bytes), (18, None, 0));
}

#[test]
fn marlin_says_busy_every_2_s_while_it_is_full() {
    let framing: Framing = "8N1".parse().unwrap();
    let mut talk = Talk::with(Settings {
        protocol: Protocol::Marlin,
        pace: Pace::Paced { baud: 9600, framing },
        cutting_time: 400.0,
        buffer_bytes: 60,
        xoff_at: 20,
        xon_at: 11,
        ..Settings::default()
    });
    talk.wait(500);
    for _ in 0..4 {
        talk.send(BLOCK);
    }
    // Each block takes 5 s; the first is cut at once, the third fills the buffer.
    talk.wait(60_000);
    assert_eq!((talk.report().blocks, talk.report().alarm), (4, None));
    let heard = String::from_utf8(talk.control.receive(talk.now)).unwrap();
    assert_eq!(heard.matches("ok\n").count(), 4, "{heard}");
    assert!(heard.matches("echo:busy: processing\n").count() >= 2, "{heard}");
}
