//! G-code readers on arbitrary bytes, and on words thrown together.

use std::io::Cursor;

use bolero::check;
use dripfeed::formats::Writer as _;
use dripfeed::formats::gcode::dialect::{BUILT_IN, Dialect};
use dripfeed::formats::gcode::words::{self, Word};
use dripfeed::formats::gcode::{Blocks, Boundaries, Motions, Writer};
use dripfeed::geometry::Element;
use dripfeed::motion::{Act, Motion};

const ITERATIONS: usize = 4000;
/// What is taken of a program: repeats of repeats go on for ever.
const MOTIONS: usize = 2000;

/// Pieces that make and break programs.
const PIECES: [&str; 72] = [
    "\n", "\n", "\n", "\r\n", "\r", " ", "G01", "G1", "G0", "G02", "G03", "G3", "X1.", "X-2.5", "Y3.", "Y0.", "Y", "X0", "X5",
    "I1.", "I-2.5", "J", "J3.", "J-.5", "R5.", "R-4.", "G90", "G91", "G92", "G20", "G21", "G40", "G41", "G42", "D1", "H1",
    "H001=110", "H1=.5+H2", "A1.5", "T2.", "G51", "G50", "U1.", "V-1.", "K0.", "L0.", ":", "M00", "M02", "\nM02\n", "M98P1",
    "M98 P2 L3", "M99", "\nN1", "\nN2 ", "\nO1\n", "O2", "%", "(remark)", ";rest\n", "(", "/", "#1", "[", "G65", "E1", "S2", "F3.",
    "G4X1.", "1e3", "99999999999999999999", "\u{4e2d}",
];

#[test]
fn arbitrary_bytes() {
    check!().with_iterations(ITERATIONS).with_max_len(4096).for_each(|bytes: &[u8]| {
        let (choice, text) = bytes.split_first().unwrap_or((&0, &[]));
        every_reader(usize::from(*choice), text);
    });
}

#[test]
fn words_thrown_together() {
    check!().with_iterations(ITERATIONS).with_max_len(400).for_each(|bytes: &[u8]| {
        let (choice, rest) = bytes.split_first().unwrap_or((&0, &[]));
        let text: String = rest.iter().map(|b| PIECES[usize::from(*b) % PIECES.len()]).collect();
        every_reader(usize::from(*choice), text.as_bytes());
    });
}

#[test]
fn what_is_named_in_the_promise() {
    let long = [b"G01 X".as_slice(), &vec![b'1'; 70_000], b"\nM02\n"].concat();
    let gbk = b"(\xB5\xE7\xBB\xF0\xBB\xA8)\nG01 X1.\nM02\n";
    let texts: [&[u8]; 9] = [
        b"",
        b"\0\0\0%\0\nG0\x001\0X1.\0\n\0",
        b"\xFF\xFEG\x000\x001\x00",
        b"\xEF\xBB\xBFG01 X1.\n",
        gbk,
        &long,
        b"G01 X0.\nX-.5\nX+1.\nX1e3\n",
        b"G01 X999999999999999999999999999999.\n",
        b"\xC3\x28 G01 \x80",
    ];
    for text in texts {
        for choice in 0..BUILT_IN.len() {
            every_reader(choice, text);
        }
    }
    let dialect = Dialect::generic().unwrap();
    let acts: Vec<Act> = Motions::new(gbk.as_slice(), dialect.clone()).map(|m| m.unwrap().act).collect();
    assert_eq!(acts[0], Act::Comment(gbk[1..7].into()), "a remark is kept as bytes");
    let refused = |text: &[u8]| Motions::new(text, dialect.clone()).find_map(Result::err).unwrap().to_string();
    assert!(refused(&long).contains("longer than 65536"));
    assert!(refused(texts[2]).contains("UTF-16"));
    assert!(refused(texts[6]).contains("exponent"));
    assert!(refused(texts[7]).contains("too long"));
}

fn every_reader(choice: usize, text: &[u8]) {
    let dialect = Dialect::parse(BUILT_IN[choice % BUILT_IN.len()].1).unwrap();
    pieces_cover_the_line(text);
    blocks_and_boundaries_agree(&dialect, text);
    let Ok(motions) = Motions::of_file(Cursor::new(text), dialect.clone()) else { return };
    let read: Result<Vec<Motion>, _> = motions.take(MOTIONS).collect();
    let Ok(read) = read else { return };
    written_and_read_again(&dialect, &read);
}

/// Nothing of a line is lost: what no piece holds is blank, or marks a remark.
fn pieces_cover_the_line(text: &[u8]) {
    for line in text.split(|b| matches!(b, b'\n' | b'\r')) {
        let mut pieces: Vec<Word> = Vec::new();
        if words::cut(line, &mut pieces).is_err() {
            continue;
        }
        let mut at = 0;
        for piece in &pieces {
            assert!(at <= piece.at as usize && piece.at <= piece.end && piece.end as usize <= line.len());
            assert!(line[at..piece.at as usize].iter().all(is_mark), "{line:?} {pieces:?}");
            at = piece.end as usize;
        }
        assert!(line[at..].iter().all(is_mark), "{line:?} {pieces:?}");
    }
}

fn is_mark(byte: &u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0 | 0x0B | 0x0C | 0x1A | b'(' | b')' | b';')
}

fn blocks_and_boundaries_agree(dialect: &Dialect, text: &[u8]) {
    let mut boundaries = Boundaries::new(text, dialect);
    let mut blocks = Blocks::new(text, dialect);
    loop {
        let block = loop {
            match blocks.next_block() {
                Ok(Some(block)) if !block.counts => {}
                Ok(Some(block)) => break Some((block.number, block.label(), block.line.spot(0))),
                Ok(None) => break None,
                // Boundaries need not look into every line.
                Err(_) => return,
            }
        };
        let boundary = boundaries.next_boundary().unwrap().map(|b| (b.block, b.label, b.spot));
        assert_eq!(block, boundary);
        if block.is_none() {
            return;
        }
    }
}

/// What was read is written and read again the same to the micron, or the writer says why not.
fn written_and_read_again(dialect: &Dialect, read: &[Motion]) {
    let mut writer = Writer::new(dialect.clone());
    let mut text = Vec::new();
    for motion in read {
        if writer.write(motion, &mut text).is_err() {
            return;
        }
    }
    if writer.finish(&mut text).is_err() {
        return;
    }
    let shown = String::from_utf8_lossy(&text);
    let again: Vec<Motion> = Motions::of_file(Cursor::new(&text), dialect.clone())
        .unwrap()
        .map(|motion| motion.unwrap_or_else(|e| panic!("{}: {e} {e:?}\n{shown}", dialect.name)))
        .collect();
    let moves = |motions: &[Motion]| -> Vec<(Element, Option<Element>)> {
        motions
            .iter()
            .filter_map(|m| match m.act {
                Act::Move { element, upper, .. } => Some((element, upper)),
                _ => None,
            })
            .collect()
    };
    let (first, second) = (moves(read), moves(&again));
    assert_eq!(first.len(), second.len(), "{shown}");
    for ((a, a_upper), (b, b_upper)) in first.iter().zip(&second) {
        assert!((a.end() - b.end()).norm() < 0.000_75, "{a:?} {b:?}\n{shown}");
        let ends = |lower: &Element, upper: &Option<Element>| upper.map_or(lower.end(), |u| u.end());
        assert!((ends(a, a_upper) - ends(b, b_upper)).norm() < 0.002, "{a_upper:?} {b_upper:?}\n{shown}");
    }
    let others = |motions: &[Motion]| motions.iter().filter(|m| matches!(m.act, Act::Word(_) | Act::Unknown(_))).count();
    assert!(others(&again) >= others(read).min(1), "{shown}");
}
