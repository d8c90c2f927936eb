//! Arbitrary bytes, and texts that look like 3B, into the 3B reader.

use dripfeed::formats::ReadError;
use dripfeed::formats::three_b::motions::Motions;
use dripfeed::formats::three_b::read::{Entry, Item, Reader};
use dripfeed::interpolator::Model;

/// Pieces a program may be made of, well and badly.
pub(crate) const PIECES: [&[u8]; 46] = [
    b"B9900B0B9900GXL1",
    b"B9900B0B39600GYNR1",
    b"b579 b6617\nb006617 y l2",
    b"BBB9900GXL1",
    b"B0B0B5GXNR1",
    b"B99999999999B0B1GXL1",
    b"B1B2B1000000GXL1",
    b"B300B400B001000B500DDGXSR3",
    b"B300B400B001000B500GYDNR1",
    b"B0B5000B5000BDGYL2",
    b"B0B5000B5000BL0.5DDGYL2",
    // A disc from a hole, with a flag; a square with a round corner.
    b"B5000B0B5000BDGXL1B5000B0B20000B5000DGYNR1B5000B0B5000GXL3",
    b"B5000B0B5000GXL1",
    b"B0B5000B5000GYL2",
    b"B5000B0B5000GXL3",
    b"B0B5000B5000GYL4",
    b"B0B1000B1000B1000DGYNR4",
    b"B",
    b"DD",
    b"D",
    b"E\n",
    b"N  12: ",
    b"N12",
    b"; 5.000, 0.000\n",
    b"(remark)",
    b"(open",
    b")",
    b"*****\n",
    b"Start Point = 0.0, 0.0\n",
    b"Block B1B2B3 = none\n",
    b"%",
    b"\n",
    b"\r\n",
    b"\r",
    b" ",
    b"\t",
    b"\0",
    b"\x1a",
    b"\xEF\xBB\xBF",
    b"\xFF\xFE",
    // GBK for "part".
    b"(\xc1\xe3\xbc\xfe)",
    b"\xff",
    b"-1",
    b"X",
    b"4",
    b"G",
];

/// Reads everything, and follows which bytes were accounted for: every byte that is not blank lies in an entry, or behind
/// the last one where the error is. Returns the blocks.
pub(crate) fn account<B>(
    bytes: &[u8],
    mut next: impl FnMut() -> Result<Option<(B, u64, u64)>, ReadError>,
) -> Vec<B> {
    let blank = |bytes: &[u8]| bytes.iter().all(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n' | 0 | 0x1A));
    let mut read = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
    let mut entries = Vec::new();
    loop {
        match next() {
            Ok(Some((entry, from, to))) => {
                let (from, to) = (from as usize, to as usize);
                assert!(read <= from && from < to, "{read} {from} {to}");
                assert!(blank(&bytes[read..from]), "{:?} before byte {from} is lost", &bytes[read..from]);
                read = to;
                entries.push(entry);
            }
            Ok(None) => {
                assert!(blank(&bytes[read..]), "{:?} at the end is lost", &bytes[read..]);
                return entries;
            }
            Err(ReadError::Program { place, message, help }) => {
                // What is wrong is no earlier than what was read, and no later than the source.
                assert!(
                    read as u64 <= place.byte && place.byte <= bytes.len() as u64,
                    "{message}: {place:?}"
                );
                assert!(place.line >= 1 && place.column >= 1 && place.width >= 1, "{place:?}");
                assert!(place.caret < place.excerpt.len(), "{place:?}");
                assert!(!message.is_empty() && !help.is_empty());
                let lines = bytes[..place.byte as usize].iter().filter(|&&b| b == b'\n').count() as u64;
                assert_eq!(place.line, lines + 1, "{message}");
                return entries;
            }
            Err(error) => panic!("{error}"),
        }
    }
}

fn read(bytes: &[u8]) {
    let mut reader = Reader::new(bytes);
    let entries = account(bytes, || {
        Ok(reader.next_entry()?.map(|entry| (entry, reader.spot().byte, reader.end_byte())))
    });
    // The callers that want blocks and stop words alone get the same ones.
    let mut reader = Reader::new(bytes);
    for entry in &entries {
        if let Entry::Item(item) = entry {
            assert_eq!(reader.next_item().ok().flatten().as_ref(), Some(item));
        }
    }
    let blocks = entries.iter().filter(|entry| matches!(entry, Entry::Item(Item::Block(_)))).count();
    let mut told = 0;
    for motion in Motions::of_three_b(bytes, Model::Rotated).take(10_000) {
        let Ok(motion) = motion else { break };
        assert!(motion.block >= told);
        told = motion.block;
    }
    assert!(told <= blocks as u64);
}

/// A text of the pieces that bytes choose.
pub(crate) fn text_of(choice: &[u8]) -> Vec<u8> {
    choice.iter().flat_map(|&n| PIECES[n as usize % PIECES.len()]).copied().collect()
}

#[test]
fn arbitrary_bytes_are_read_or_refused_and_none_is_lost() {
    bolero::check!().for_each(|bytes: &[u8]| read(bytes));
}

#[test]
fn pieces_of_programs_in_any_order_are_read_or_refused_and_none_is_lost() {
    bolero::check!().for_each(|choice: &[u8]| read(&text_of(choice)));
}

#[test]
fn lines_over_64_kib_are_blocks_alone_or_an_error() {
    let long = |piece: &[u8]| piece.repeat(70_000 / piece.len());
    for piece in PIECES {
        for other in [&b""[..], b"\n", b"DD\n", b"; end\n"] {
            read(&[&long(piece), other].concat());
            read(&[&b"B1B0B1GXL1\n"[..], &long(piece), other, b"B1B0B1GXL1\n"].concat());
        }
    }
}

#[test]
fn a_comment_in_gbk_is_kept_as_bytes_and_utf_16_is_named() {
    let mut reader = Reader::new(&b"(\xc1\xe3\xbc\xfe)B1B0B1GXL1"[..]);
    assert_eq!(reader.next_entry().unwrap(), Some(Entry::Comment));
    assert_eq!(reader.text(), b"\xc1\xe3\xbc\xfe");
    for bytes in [&b"\xFF\xFEB\x001\x00"[..], b"\xFE\xFF\x00B\x001", b"\xFF\xFE"] {
        let refused = Reader::new(bytes).next_entry().unwrap_err().to_string();
        assert!(refused.contains("UTF-16"), "{refused}");
    }
}
