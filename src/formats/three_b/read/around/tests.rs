use super::holds_block_pattern;
use crate::formats::ReadError;
use crate::formats::three_b::read::{Entry, Item, Reader};
use crate::place::Place;

/// What a text says: each entry by its letter, with its text.
fn entries(text: &str) -> Vec<(char, String)> {
    let mut reader = Reader::new(text.as_bytes());
    let mut entries = Vec::new();
    while let Some(entry) = reader.next_entry().unwrap_or_else(|error| panic!("{text}: {error}")) {
        let kind = match entry {
            Entry::Item(Item::Block(_)) => 'B',
            Entry::Item(Item::StopWord(_)) => 'S',
            Entry::Comment => 'C',
            Entry::Header => 'H',
            Entry::Number => 'N',
        };
        entries.push((kind, String::from_utf8_lossy(reader.text()).into_owned()));
    }
    entries
}

fn refusal(text: &str) -> (String, Place) {
    let mut reader = Reader::new(text.as_bytes());
    loop {
        match reader.next_entry() {
            Ok(Some(_)) => {}
            Ok(None) => panic!("{text} is refused"),
            Err(ReadError::Program { message, place, .. }) => return (message, place),
            Err(ReadError::Io(error)) => panic!("{error}"),
        }
    }
}

#[test]
fn everything_around_blocks_is_told_with_its_own_words() {
    for (text, wanted) in [
        ("% ; one", &[('H', "%"), ('C', " one")][..]),
        ("%B1B0B1GXL1", &[('H', "%"), ('B', "B1B0B1GXL1")]),
        ("  ; one (two) ; three  \r\n", &[('C', " one (two) ; three")]),
        (";", &[('C', "")]),
        ("; \n", &[('C', "")]),
        ("(one)(two) D", &[('C', "one"), ('C', "two"), ('S', "D")]),
        (" (one \nD", &[('C', "one"), ('S', "D")]),
        ("()", &[('C', "")]),
        (" ***  \nD", &[('H', "***"), ('S', "D")]),
        ("** B12 B0 **\t\n", &[('H', "** B12 B0 **")]),
        (" Start Point = 0, 0 ; X , Y \nD", &[('H', "Start Point = 0, 0 ; X , Y"), ('S', "D")]),
        ("Block B1 = 2\n", &[('H', "Block B1 = 2")]),
        ("Date = 1 B1B2B3\n", &[]),
        ("N = 5\nD=5\nE=1", &[('H', "N = 5"), ('H', "D=5"), ('H', "E=1")]),
        ("x = 1 (B1B2B3)", &[('H', "x = 1 (B1B2B3)")]),
        (" N  12: D", &[('N', "12"), ('S', "D")]),
        ("n3 :B1B0B1GXL1", &[('N', "3"), ('B', "B1B0B1GXL1")]),
        ("  dd ; over", &[('S', "dd"), ('C', " over")]),
        (
            "B1B0B1GXL1 D(one)D%E",
            &[('B', "B1B0B1GXL1"), ('S', "D"), ('C', "one"), ('S', "D"), ('H', "%"), ('S', "E")],
        ),
    ] {
        if wanted.is_empty() {
            assert_eq!(refusal(text).0, "neither a 3B block nor a comment", "{text}");
            continue;
        }
        let wanted: Vec<_> = wanted.iter().map(|&(kind, words)| (kind, words.to_owned())).collect();
        assert_eq!(entries(text), wanted, "{text}");
    }
}

#[test]
fn every_entry_has_its_place_and_its_end() {
    let text = "%\n N  12: B1 B0\tB1GXL1 (one) D ; two\n***\n\nx = 1\nB1B0\nB1GXL1DD";
    let mut reader = Reader::new(text.as_bytes());
    let mut found = Vec::new();
    while reader.next_entry().unwrap().is_some() {
        let spot = reader.spot();
        found.push((spot.line, spot.column, spot.byte, reader.end_byte()));
    }
    let place = |words: &str, line, column| {
        let at = text.find(words).unwrap() as u64;
        (line, column, at, at + words.len() as u64)
    };
    let wanted = [
        place("%", 1, 1),
        place("N  12:", 2, 2),
        place("B1 B0\tB1GXL1", 2, 9),
        place("(one)", 2, 22),
        place("D ;", 2, 28),
        place("; two", 2, 30),
        place("***", 3, 1),
        place("x = 1", 5, 1),
        place("B1B0\nB1GXL1", 6, 1),
        place("DD", 7, 7),
    ];
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.into_iter().zip(wanted) {
        // What ends a stop word is no part of it.
        let end = if wanted.0 == 2 && wanted.1 == 28 { wanted.2 + 1 } else { wanted.3 };
        assert_eq!(found, (wanted.0, wanted.1, wanted.2, end));
    }
}

#[test]
fn what_is_neither_block_nor_remark_is_underlined_whole() {
    for (text, message, column, width) in [
        ("D\n hello world \nD", "neither a 3B block nor a comment", 2, 11),
        ("B1B0B1GXL1 hello", "neither a 3B block nor a comment", 12, 5),
        ("D\n   *B1B2B3* \n", "a block behind a `*`", 4, 8),
        ("DE = 1 B B B", "neither a 3B block nor a comment", 1, 12),
        ("N12 B1B0B1GXL1", "neither a 3B block nor a comment", 1, 14),
    ] {
        let (found, place) = refusal(text);
        assert_eq!((found.as_str(), place.column, place.width), (message, column, width), "{text}");
    }
}

#[test]
fn a_b_opens_a_block_where_a_number_or_another_b_comes_next() {
    for text in ["B 1Q", "BBQ", "B bQ", "B\n1Q"] {
        assert!(
            refusal(text).0.starts_with("expected B, found `Q`") || text == "BBQ" || text == "B bQ",
            "{text}"
        );
        assert!(!refusal(text).0.contains("neither"), "{text}");
    }
    for sign in ['-', '+', '.'] {
        assert!(refusal(&format!("B {sign}5")).0.starts_with(&format!("X holds `{sign}`")));
    }
    for text in ["BX", "B,1", "Bon = jour B B B", "B=B1B2B3"] {
        assert!(refusal(text).0.contains("neither"), "{text}");
    }
    assert!(refusal("B").0.contains("found the end of the program"));
    assert_eq!(entries("B=1"), [('H', "B=1".to_owned())]);
}

#[test]
fn three_b_with_digits_and_blanks_between_them_are_a_block_wherever_they_stand() {
    for words in ["B1B2B3", "xB1 B2\tB3", "bbb", "BBB", "B B B", "1B2BB", "BXB1B2B"] {
        assert!(holds_block_pattern(words.as_bytes()), "{words}");
    }
    for words in ["", "BB", "B1B2", "B1XB2B3", "BxBxBx", "B-1B2B", "x = 1"] {
        assert!(!holds_block_pattern(words.as_bytes()), "{words}");
    }
}
