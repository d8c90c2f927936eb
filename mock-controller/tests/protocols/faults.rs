//! Checked protocols under noise: whatever the line does, what is cut is the program, once, or the control stops.
//!
//! The sender here is the simplest that is right: one message at a time, again on request or after a while.

use std::collections::BTreeMap;
use std::time::Duration;

use mock_controller::{EndCode, FaultKind, Pace, Protocol, Settings};

use crate::talk::{ACK, BLOCK, NAK, Talk};
use crate::xmodem::{crc, packet};

/// What an answer tells the sender to send next: the message with this index.
type Reads = fn(heard: &[u8], at: usize) -> Option<usize>;

/// Sends messages one at a time until the last has been answered; how many sendings it took.
fn converse(talk: &mut Talk, messages: &[Vec<u8>], reads: Reads) -> usize {
    let (mut at, mut sendings) = (0, 0);
    while at < messages.len() && talk.control.alarm().is_none() {
        assert!(sendings < 20 * messages.len() + 100, "no end at message {at}");
        sendings += 1;
        // What was said before is no answer.
        let _ = talk.control.receive(talk.now);
        talk.send(&messages[at]);
        let mut heard = Vec::new();
        for _ in 0..900 {
            talk.wait(10);
            heard.extend(talk.control.receive(talk.now));
            if let Some(next) = reads(&heard, at) {
                at = next;
                break;
            }
        }
    }
    sendings
}

fn xmodem_reads(heard: &[u8], at: usize) -> Option<usize> {
    heard.iter().find_map(|&byte| match byte {
        ACK => Some(at + 1),
        NAK | b'C' => Some(at),
        _ => None,
    })
}

fn frames_reads(heard: &[u8], at: usize) -> Option<usize> {
    let unescaped = |frame: &[u8]| {
        let mut escaped = false;
        let mut body = Vec::new();
        for &byte in frame {
            if byte == 0x7D {
                escaped = true;
            } else {
                body.push(if std::mem::take(&mut escaped) { byte ^ 0x20 } else { byte });
            }
        }
        body
    };
    let mut frames = heard.split(|&byte| byte == 0x7E).map(unescaped).filter(|frame| frame.len() > 6);
    frames.next_back().and_then(|frame| match frame[0] {
        b'A' if usize::from(frame[2]) == at + 1 => Some(at + 1),
        b'N' => Some(at),
        _ => None,
    })
}

fn marlin_reads(heard: &[u8], at: usize) -> Option<usize> {
    let heard = String::from_utf8_lossy(heard);
    if let Some((_, rest)) = heard.rsplit_once("Resend: ") {
        let (number, _) = rest.split_once('\n')?;
        // Line n is message n; only what may be asked for is.
        return number.parse().ok().filter(|&number| number == at || number == at + 1);
    }
    heard.contains("ok\n").then_some(at + 1)
}

fn fanuc_reads(heard: &[u8], at: usize) -> Option<usize> {
    let heard = String::from_utf8_lossy(heard);
    let last = heard.rsplit('\r').nth(1)?;
    match &last[last.len().checked_sub(3)?..] {
        "RTY" => Some(at),
        "SAT" | "GTD" => Some(at + 1),
        _ => None,
    }
}

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

/// A program of 60 blocks that are all different, so that one left out or cut twice is seen.
fn program() -> String {
    (1..=60).map(|k| format!("B{k}BB{k}GXL1\n")).collect()
}

fn messages(protocol: &Protocol) -> (Vec<Vec<u8>>, Reads) {
    let text = program();
    let lines = text.lines();
    match protocol {
        Protocol::XmodemCrc => {
            let pieces = text.as_bytes().chunks(128).map(|piece| std::str::from_utf8(piece).unwrap());
            let packets = (1..).zip(pieces).map(|(number, piece)| packet(number, piece, 128, crc));
            (packets.chain([vec![0x04]]).collect(), xmodem_reads)
        }
        Protocol::Frames { .. } => {
            let frames = (1..).zip(lines).map(|(number, line)| frame(b'D', number, &format!("{line}\n")));
            (frames.chain([frame(b'E', 61, "")]).collect(), frames_reads)
        }
        Protocol::Marlin => {
            let first = vec![numbered(0, "M110 N0")];
            let lines = (1..).zip(lines.chain(["DD"])).map(|(number, line)| numbered(number, line));
            (first.into_iter().chain(lines).collect(), marlin_reads)
        }
        Protocol::FanucA(_) => {
            let first = [message("RDY"), message("SET")];
            let data = lines.map(|line| message(&format!("DAT{line}\n")));
            (first.into_iter().chain(data).collect(), fanuc_reads)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_program_is_cut_once_whatever_the_line_does() {
    let protocols = [
        Protocol::XmodemCrc,
        Protocol::Frames { window: 1 },
        Protocol::Marlin,
        Protocol::FanucA(EndCode::Cr),
    ];
    for protocol in protocols {
        for (kind, rate) in [
            (FaultKind::Flip, 0.005),
            (FaultKind::Drop, 0.005),
            (FaultKind::Double, 0.005),
            (FaultKind::Insert, 0.005),
            (FaultKind::Parity, 0.005),
            (FaultKind::XonDouble, 0.4),
            (FaultKind::XonLate, 0.4),
            (FaultKind::XoffLost, 1.0),
        ] {
            let what = format!("{protocol:?} {kind}");
            let mut faults = BTreeMap::from([(kind, rate)]);
            if kind == FaultKind::XoffLost {
                faults.insert(FaultKind::Flip, 0.005);
            }
            let framing = "8N1".parse().unwrap();
            let pace = Pace::Paced { baud: 115_200, framing };
            let settings =
                Settings { protocol: protocol.clone(), faults, seed: 5, pace, ..Settings::default() };
            let mut talk = Talk::with(settings);
            talk.wait(100);
            let (messages, reads) = messages(&protocol);
            let sendings = converse(&mut talk, &messages, reads);
            talk.now += Duration::from_secs(60);
            talk.control.advance(talk.now);
            let report = talk.report();
            assert_eq!(report.alarm, None, "{what}: {:?}", report.alarm_detail);
            assert_eq!((report.blocks, report.end_um), (60, [60 * 61 / 2, 0]), "{what}, {sendings} sendings");
            assert_eq!(talk.text().replace("DD\n", ""), program(), "{what}");
            assert!(report.faults.get(kind.name()).is_some_and(|&struck| struck > 0), "{what}: {report:?}");
        }
    }
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
