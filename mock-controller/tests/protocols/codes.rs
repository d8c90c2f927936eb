//! Tape codes: images put together from the list of codes in the sources, written out here a second time.

use mock_controller::{Code, CodeTable, Protocol, Settings};

use crate::talk::Talk;

/// As the sources print them, three lines of pairs.
const EIA: &str = "\
    0 20  1 01  2 02  3 13  4 04  5 15  6 16  7 07  8 08  9 19  SP 10  . 6B  - 40  + 70  / 31  , 3B  & 0E \
    A 61  B 62  C 73  D 64  E 75  F 76  G 67  H 68  I 79  ( 1A  ) 4A  TAB 3E  EOB 80  % 0B \
    J 51  K 52  L 43  M 54  N 45  O 46  P 57  Q 58  R 49  S 32  T 23  U 34  V 25  W 26  X 37  Y 38  Z 29";

fn eia(text: &str) -> Vec<u8> {
    let words: Vec<&str> = EIA.split_whitespace().collect();
    text.chars()
        .map(|c| {
            let name = match c {
                '\n' => "EOB".to_owned(),
                ' ' => "SP".to_owned(),
                '\t' => "TAB".to_owned(),
                c => c.to_string(),
            };
            let pair = words.chunks(2).find(|pair| pair[0] == name).unwrap();
            u8::from_str_radix(pair[1], 16).unwrap()
        })
        .collect()
}

fn iso(text: &str) -> Vec<u8> {
    text.bytes().map(|byte| if byte.count_ones() % 2 == 1 { byte | 0x80 } else { byte }).collect()
}

fn in_code(code: Code) -> Talk {
    Talk::with(Settings { code, protocol: Protocol::RtsCts, ..Settings::unpaced() })
}

#[test]
fn every_character_of_eia_is_read_and_has_odd_parity() {
    let text = "%\n(0123456789 ABCDEFGHIJKLMNOPQRSTUVWXYZ.-+/,&\t)\nB10BB10GXL1\n%\n";
    let image = eia(text);
    assert!(image.iter().all(|byte| byte.count_ones() % 2 == 1));
    let mut talk = in_code(Code::Eia);
    // Leader of blanks, a DEL punched over a mistake.
    talk.send([&[0; 50][..], &image[..60], &[0x7F], &image[60..], &[0; 50]].concat());
    assert_eq!(talk.text(), text.replace("%\n", ""));
    talk.is_done(1);
}

#[test]
fn a_digit_3_in_eia_is_dc3_in_ascii_and_is_read() {
    let mut talk = in_code(Code::Eia);
    assert_eq!(eia("3"), [0x13]);
    talk.send(eia("B33BB33GXL1\nDD\n"));
    assert_eq!(talk.report().end_um, [33, 0]);
    talk.is_done(1);
}

#[test]
fn iso_is_even_and_has_no_small_letters() {
    let text = "%\n(A 1)\nB10BB10GXL1\n%\n";
    let mut talk = in_code(Code::Iso);
    talk.send([&[0; 20][..], &iso(text), &[0xFF]].concat());
    assert_eq!(talk.text(), text.replace("%\n", ""));
    talk.is_done(1);
}

#[test]
fn what_is_no_character_is_a_th_alarm_with_its_place() {
    for (code, image, found) in [
        // C is 43h: odd as it stands.
        (Code::Iso, [iso("B10"), vec![b'C']].concat(), "block 1, character 4: 43: odd parity"),
        (Code::Iso, iso("B10b"), "no character of ISO 840"),
        (Code::Iso, iso("B10;"), "no character of ISO 840"),
        (Code::Eia, [eia("B10"), vec![0x63]].concat(), "even parity"),
        (Code::Eia, [eia("B10"), vec![0x00], eia("B")].concat(), "a blank inside a block"),
        (Code::Eia, [eia("B10"), vec![0x7C]].concat(), "no character of EIA"),
    ] {
        let mut talk = in_code(code);
        talk.send(&image);
        let report = talk.report();
        assert_eq!(report.alarm.as_deref(), Some("th"), "{image:02X?}");
        assert!(report.alarm_detail.unwrap().contains(found), "{image:02X?}");
    }
}

#[test]
fn the_tv_check_counts_a_block_with_its_end() {
    for (text, alarm) in [("B10BB10GXL1\n", None), ("B10BB10GXL1 \n", Some("tv")), ("B1 BB10GXL1\r\n", None)]
    {
        let mut talk = Talk::with(Settings { tv_check: true, ..Settings::unpaced() });
        talk.send(text);
        assert_eq!(talk.report().alarm.as_deref(), alarm, "{text:?}");
    }
}

#[test]
fn a_table_of_five_channels_has_a_code_for_each_token() {
    // Invented for this test: no public table of the five-channel code is known.
    let mut table = String::from("# tokens\nNUL 00\nEOB 1F\nB 0A\nGX 0B\nGY 0C\nD 0D\nL1 10\nNR1 11\n");
    for digit in 0..10 {
        table += &format!("{digit} {:02X}\n", digit + 0x12);
    }
    // 0x1B is the digit 9, and 0x1F is free.
    let table = CodeTable::parse(&table).unwrap();
    let code = |token: u8| 0x12 + token;
    let image =
        [0, 0, 0x0A, code(1), code(0), 0x0A, 0x0A, code(1), code(0), 0x0B, 0x10, 0x1F, 0x0D, 0x0D, 0x1F];
    let mut talk = in_code(Code::Table(table));
    talk.send(image);
    assert_eq!(talk.text(), "B10BB10GXL1\nDD\n");
    talk.is_done(1);
}

#[test]
fn a_table_that_is_none_is_told_with_its_line() {
    for (table, found) in [
        ("B", "line 1: expected a token and its byte in hex"),
        ("EOB 0A\nB 1", "line 2: \"1\" is no byte in two hex digits"),
        ("EOB 0A\nB 0A", "line 2: 0A stands for two tokens"),
        ("B 0B", "no code for EOB"),
    ] {
        assert_eq!(CodeTable::parse(table).unwrap_err().to_string(), found);
    }
}
