use std::io::ErrorKind;

use super::*;

/// A source that gives so many bytes at a time, and before each of them what is no byte.
struct Drops<'a> {
    bytes: &'a [u8],
    at_once: usize,
    before: Option<ErrorKind>,
    gave: bool,
}

impl<'a> Drops<'a> {
    fn of(bytes: &'a [u8], at_once: usize) -> Self {
        Self { bytes, at_once, before: None, gave: true }
    }
}

impl Read for Drops<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.gave = !self.gave;
        if let Some(kind) = self.before
            && !self.gave
        {
            return Err(kind.into());
        }
        let count = self.at_once.min(into.len()).min(self.bytes.len());
        let (now, rest) = self.bytes.split_at(count);
        into[..count].copy_from_slice(now);
        self.bytes = rest;
        Ok(count)
    }
}

/// Every piece of a source with its place.
fn pieces(source: impl Read) -> Result<Vec<(Vec<u8>, Spot)>, ReadError> {
    let mut pieces = Pieces::new(source);
    let mut found = Vec::new();
    while pieces.next_piece()? {
        found.push((pieces.piece().to_vec(), pieces.spot(0)));
    }
    Ok(found)
}

fn refusal(source: impl Read) -> (String, Place) {
    match pieces(source).unwrap_err() {
        ReadError::Program { message, place, .. } => (message, place),
        ReadError::Io(error) => panic!("{error}"),
    }
}

#[test]
fn a_piece_is_a_line_with_its_end_however_the_source_drips() {
    let text = b"one\n\ntwo\r\n\n\nthree";
    let lines = [(&b"one\n"[..], 0), (b"\n", 4), (b"two\r\n", 5), (b"\n", 10), (b"\n", 11), (b"three", 12)];
    for at_once in [1, 2, 3, 5, 100] {
        let found = pieces(Drops::of(text, at_once)).unwrap();
        let wanted = lines
            .iter()
            .zip(1..)
            .map(|((line, byte), n)| (line.to_vec(), Spot { byte: *byte, line: n, column: 1 }));
        assert_eq!(found, wanted.collect::<Vec<_>>(), "{at_once}");
    }
}

#[test]
fn a_read_that_is_interrupted_is_tried_again_and_one_that_fails_is_told() {
    let interrupted = Drops { before: Some(ErrorKind::Interrupted), ..Drops::of(b"one\ntwo", 2) };
    assert_eq!(pieces(interrupted).unwrap().len(), 2);
    let failed = Drops { before: Some(ErrorKind::TimedOut), ..Drops::of(b"one\ntwo", 2) };
    let Err(ReadError::Io(error)) = pieces(failed) else { panic!("the failure is told") };
    assert_eq!(error.kind(), ErrorKind::TimedOut);
}

#[test]
fn a_long_line_of_blocks_comes_in_pieces_of_whole_blocks_with_their_columns() {
    let block = "B9900B0B9900GXL1";
    let text = format!("D\n{}\nD", block.repeat(20_000));
    for at_once in [1000, LINE_BYTES_MAX, LINE_BYTES_MAX + 1, usize::MAX] {
        let found = pieces(Drops::of(text.as_bytes(), at_once)).unwrap();
        let whole: Vec<u8> = found.iter().flat_map(|(piece, _)| piece.clone()).collect();
        assert_eq!(whole, text.as_bytes());
        assert!(found.len() > 5);
        for (piece, spot) in &found[1..found.len() - 1] {
            // Line 2 begins at byte 2 of the source.
            assert_eq!((spot.line, spot.column), (2, spot.byte - 1));
            assert!(piece.len() <= LINE_BYTES_MAX && (spot.column - 1) % block.len() as u64 == 0);
        }
        assert_eq!(found.last().unwrap().1, Spot { byte: 3 + 320_000, line: 3, column: 1 });
    }
}

#[test]
fn something_within_a_piece_has_the_place_it_has_in_the_source() {
    let text = "D\n".to_owned() + &"B9900B0B9900GXL1".repeat(5000) + "\r\n";
    let mut pieces = Pieces::new(text.as_bytes());
    assert!(pieces.has_more().unwrap());
    assert!(pieces.next_piece().unwrap() && pieces.next_piece().unwrap() && pieces.next_piece().unwrap());
    let begins = pieces.byte();
    assert_eq!((begins, pieces.line()), (2 + 65_536, 2));
    assert_eq!(pieces.spot(7), Spot { byte: begins + 7, line: 2, column: 65_536 + 8 });
    let place = pieces.place(7, 3);
    assert_eq!((place.line, place.column, place.byte, place.width), (2, 65_536 + 8, begins + 7, 3));
    // The line's end is not shown, and what is wrong there is shown behind the last letter.
    let length = pieces.piece().len();
    assert!(!pieces.place(length - 1, 1).excerpt.ends_with('.'));
    assert_eq!(pieces.place(length - 1, 1).column, 65_536 + length as u64 - 1);
    assert!(!pieces.has_more().unwrap() && !pieces.next_piece().unwrap());
}

#[test]
fn whether_more_comes_is_known_before_it_is_gone_to() {
    for at_once in [1, 2, 100] {
        let mut pieces = Pieces::new(Drops::of(b"a\nb\n", at_once));
        assert!(pieces.next_piece().unwrap() && pieces.has_more().unwrap());
        assert_eq!(pieces.piece(), b"a\n");
        assert!(pieces.next_piece().unwrap() && !pieces.has_more().unwrap());
        assert_eq!(pieces.piece(), b"b\n");
        assert!(!pieces.next_piece().unwrap());
    }
}

#[test]
fn the_longest_line_is_held_and_one_byte_more_is_told_with_its_place() {
    let longest = "x".repeat(LINE_BYTES_MAX);
    for at_once in [1000, usize::MAX] {
        assert_eq!(pieces(Drops::of(longest.as_bytes(), at_once)).unwrap().len(), 1);
        let text = format!("D\n{longest}y\n");
        let (message, place) = refusal(Drops::of(text.as_bytes(), at_once));
        assert_eq!(message, "the line is longer than 65536 bytes and not of blocks alone");
        assert_eq!((place.line, place.column, place.byte), (2, 65_537, 65_538));
        assert_eq!(&place.excerpt[place.caret..], "y");
    }
    // What stands among blocks may be a remark that holds the pattern of one.
    for mark in [';', '(', '*', '=', '%'] {
        let text = format!("B1B0B1GXL1{mark}{}", "B1B0B1GXL1".repeat(7000));
        assert!(refusal(text.as_bytes()).0.contains("longer"), "{mark}");
    }
}

#[test]
fn a_piece_of_blocks_ends_behind_the_last_whole_one() {
    for (piece, wanted) in [
        ("B1B0B1GXL1B2B", Some(10)),
        ("b1b0b1gxnr4b2b0b2gxs", Some(11)),
        ("B1B0B1GXL", None),
        ("B1B0B1GXL5", None),
        ("", None),
        ("L1", Some(2)),
    ] {
        assert_eq!(end_of_last_block(piece.as_bytes()), wanted, "{piece}");
    }
}

#[test]
fn utf_16_is_named_at_the_start_and_only_there() {
    for mark in [[0xFF, 0xFE], [0xFE, 0xFF]] {
        let (message, place) = refusal(&[mark[0], mark[1], b'B', 0, b'\n'][..]);
        assert!(message.contains("UTF-16"));
        assert_eq!((place.line, place.column, place.width), (1, 1, 2));
        assert!(pieces(&[b'D', b'\n', mark[0], mark[1]][..]).is_ok());
    }
}
