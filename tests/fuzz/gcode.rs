//! G-code readers on arbitrary bytes, and on words thrown together.

use std::collections::BTreeMap;
use std::io::Cursor;

use bolero::check;
use dripfeed::formats::gcode::dialect::{BUILT_IN, Code, Dialect, Role};
use dripfeed::formats::gcode::words::{self, Kind, Word};
use dripfeed::formats::gcode::{Blocks, Boundaries, Motions, Writer};
use dripfeed::formats::{ReadError, Writer as _};
use dripfeed::geometry::Element;
use dripfeed::motion::{Act, Motion, Stop};
use dripfeed::place::Spot;

const ITERATIONS: usize = 4000;
/// What is taken of a program: repeats of repeats go on for ever.
const MOTIONS: usize = 2000;

/// Pieces that make and break programs.
const PIECES: [&str; 72] = [
    "\n",
    "\n",
    "\n",
    "\r\n",
    "\r",
    " ",
    "G01",
    "G1",
    "G0",
    "G02",
    "G03",
    "G3",
    "X1.",
    "X-2.5",
    "Y3.",
    "Y0.",
    "Y",
    "X0",
    "X5",
    "I1.",
    "I-2.5",
    "J",
    "J3.",
    "J-.5",
    "R5.",
    "R-4.",
    "G90",
    "G91",
    "G92",
    "G20",
    "G21",
    "G40",
    "G41",
    "G42",
    "D1",
    "H1",
    "H001=110",
    "H1=.5+H2",
    "A1.5",
    "T2.",
    "G51",
    "G50",
    "U1.",
    "V-1.",
    "K0.",
    "L0.",
    ":",
    "M00",
    "M02",
    "\nM02\n",
    "M98P1",
    "M98 P2 L3",
    "M99",
    "\nN1",
    "\nN2 ",
    "\nO1\n",
    "O2",
    "%",
    "(remark)",
    ";rest\n",
    "(",
    "/",
    "#1",
    "[",
    "G65",
    "E1",
    "S2",
    "F3.",
    "G4X1.",
    "1e3",
    "99999999999999999999",
    "\u{4e2d}",
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
fn an_empty_file_says_nothing() {
    for text in [&b""[..], b"\n\r\n", b"\0\0\0", b" \t \x1A", b"\xEF\xBB\xBF"] {
        everyone_reads(text);
        assert_eq!(acts(text).unwrap(), []);
    }
}

#[test]
fn nul_is_a_blank_also_within_words() {
    let text = b"\0\0%\0\nG92 X0. Y0.\nG\x001\0X\x001.\0\n\0";
    everyone_reads(text);
    assert_eq!(ends(text), [[1.0, 0.0]]);
}

#[test]
fn numbers_as_people_write_them() {
    let text = b"G92 X0. Y0.\nG01 X0.\nX-.5\nX+1.\ny -2.5\nX+0Y-0\nx00000000000000000000001.5\nY0.00000000000000000\n";
    everyone_reads(text);
    let expected = [[0., 0.], [-0.5, 0.], [1., 0.], [1., -2.5], [0., 0.], [1.5, 0.], [1.5, 0.]];
    assert_eq!(ends(text), expected);
}

#[test]
fn what_a_number_cannot_be_is_an_error_with_its_place() {
    for (text, message, column) in [
        ("G01 X1e3", "`X1`: a number with an exponent", 5),
        ("G01 X1.5E3", "`X1.5`: a number with an exponent", 5),
        ("G01 X99999999999999999999.", "`X99999999999999999999.`: the number is too long", 5),
        ("G01 X999999999999999999.", "`X999999999999999999.`: a length of more than a kilometre", 5),
        ("G01 X1000001.", "`X1000001.`: a length of more than a kilometre", 5),
        ("G91 G01 X900000.\nX900000.", "`X900000.`: leads more than a kilometre away", 1),
        ("G01 X", "`X`: a letter without its number", 5),
        ("G01 X. Y1.", "`X.`: a letter without its number", 5),
        ("G01 X - 1.", "`X -`: a letter without its number", 5),
        ("G01 X--1.", "`X-`: a letter without its number", 5),
        ("G01 X- Y1.", "`X-`: a letter without its number", 5),
        ("G01 X5", "`X5`: a length without a point: the dialect generic has no rule for it in mm", 5),
        ("G01 X1. X2.", "`X2.`: the block has this word already", 9),
        ("G41 D1 D2 G01 X1.", "`D2`: the block has this word already", 8),
    ] {
        everyone_reads(text.as_bytes());
        let (refused, spot) = acts(text.as_bytes()).unwrap_err();
        assert_eq!((refused.as_str(), spot.column), (message, column), "{text}");
    }
}

#[test]
fn a_remark_in_gbk_is_kept_as_bytes() {
    let text = b"(\xB5\xE7\xBB\xF0\xBB\xA8)\nG92 X0. Y0.\nG01 X1.\nM02\n";
    everyone_reads(text);
    assert_eq!(acts(text).unwrap()[0], Act::Comment(text[1..7].into()));
    // The second byte of a character can be a bracket or a letter: within a remark behind `;` it is neither.
    let text = b";\xC1\x5B\x81\x47\nG92 X0. Y0.\n";
    everyone_reads(text);
    assert_eq!(acts(text).unwrap()[0], Act::Comment(text[1..5].into()));
}

#[test]
fn bytes_that_are_no_word_are_told_as_unknown() {
    let text = b"\xC3\x28a)\nG92 X0. Y0. \x80\xFF\n";
    everyone_reads(text);
    let told: Vec<Act> = acts(text).unwrap();
    let expected =
        [Act::Unknown([0xC3].into()), Act::Comment((*b"a").into()), Act::Unknown([0x80, 0xFF].into())];
    assert_eq!(told, expected);
}

#[test]
fn utf_16_is_recognised_and_said() {
    for text in [&b"\xFF\xFEG\x000\x001\x00"[..], b"\xFE\xFF\x00G\x000\x001", b"\xFF\xFE"] {
        everyone_reads(text);
        assert!(acts(text).unwrap_err().0.contains("UTF-16"));
        let dialect = Dialect::generic().unwrap();
        assert!(Boundaries::new(text, &dialect).next_boundary().unwrap_err().to_string().contains("UTF-16"));
    }
}

#[test]
fn a_line_over_64_kib_is_an_error_and_not_a_buffer() {
    let dialect = Dialect::generic().unwrap();
    for end in [&b""[..], b"\nM02\n"] {
        let long = [b"G92 X0. Y0.\nG01 X".as_slice(), &vec![b'1'; 70_000], end].concat();
        everyone_reads(&long);
        let (refused, spot) = acts(&long).unwrap_err();
        assert!(refused.contains("longer than 65536"), "{refused}");
        assert_eq!(spot.line, 2);
        assert!(Boundaries::new(long.as_slice(), &dialect).any(|b| b.is_err()));
    }
    // Without end: the error comes before the source does.
    let endless = std::io::Read::chain(&b"G01 X"[..], std::io::repeat(b'1'));
    assert!(Motions::new(endless, dialect).next().unwrap().is_err());
}

#[test]
fn a_subprogram_that_repeats_for_ever_is_read_as_it_runs() {
    let text = b"G92 X0. Y0.\nG91\nM98 P1 L9999999\nM02\nO1\nM98 P2 L9999999\nM99\nO2\nG01 X1.\nX-1.\nM99\n";
    everyone_reads(text);
    let motions = Motions::of_file(Cursor::new(text), Dialect::generic().unwrap()).unwrap();
    assert!(motions.take(100_000).all(|m| m.is_ok()));
    let turning = b"M98 P1\nM02\nO1\nM98 P1\nM99\n";
    everyone_reads(turning);
    assert!(acts(turning).unwrap_err().0.contains("deep"));
}

/// What the generic dialect reads, or the first error.
fn acts(text: &[u8]) -> Result<Vec<Act>, (String, Spot)> {
    let error = |error: ReadError| match error {
        ReadError::Program { message, place, .. } => (message, place.spot()),
        other => panic!("{other}"),
    };
    Motions::of_file(Cursor::new(text), Dialect::generic().unwrap())
        .map_err(error)?
        .map(|motion| motion.map(|m| m.act).map_err(error))
        .collect()
}

fn ends(text: &[u8]) -> Vec<[f64; 2]> {
    let end = |act: Act| match act {
        Act::Move { element, .. } => Some([element.end().x, element.end().y]),
        _ => None,
    };
    acts(text).unwrap().into_iter().filter_map(end).collect()
}

fn everyone_reads(text: &[u8]) {
    for choice in 0..BUILT_IN.len() {
        every_reader(choice, text);
    }
}

fn every_reader(choice: usize, text: &[u8]) {
    let dialect = Dialect::parse(BUILT_IN[choice % BUILT_IN.len()].1).unwrap();
    pieces_cover_the_line(text);
    blocks_and_boundaries_agree(&dialect, text);
    words_are_told(&dialect, text);
    let Ok(motions) = Motions::of_file(Cursor::new(text), dialect.clone()) else { return };
    let read: Result<Vec<Motion>, _> = motions.take(MOTIONS).collect();
    let Ok(read) = read else { return };
    written_and_read_again(&dialect, &read);
    // Into another one too: its words may mean something else there.
    let other = BUILT_IN[choice / BUILT_IN.len() % BUILT_IN.len()].1;
    written_and_read_again(&Dialect::parse(other).unwrap(), &read);
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

/// Every remark, every number of a block and every word that moves nothing is told, as far as a program is read.
fn words_are_told(dialect: &Dialect, text: &[u8]) {
    let Ok(motions) = Motions::of_file(Cursor::new(text), dialect.clone()) else { return };
    let mut told: BTreeMap<u64, Vec<u8>> = BTreeMap::new();
    let mut end = u64::MAX;
    for motion in motions.take(MOTIONS) {
        match motion {
            Ok(Motion {
                act: Act::Comment(t) | Act::Header(t) | Act::Word(t) | Act::Unknown(t),
                spot,
                ..
            }) => {
                let line = told.entry(spot.line).or_default();
                line.extend_from_slice(&t);
                line.push(b'\n');
            }
            Ok(Motion { act: Act::Stop(Stop::End), spot, .. }) => end = end.min(spot.line),
            Ok(_) => {}
            Err(ReadError::Program { place, .. }) => end = end.min(place.line - 1),
            Err(other) => panic!("{other}"),
        }
    }
    let mut blocks = Blocks::new(text, dialect);
    while let Ok(Some(block)) = blocks.next_block() {
        let calls = |w: &Word| w.letter == b'M' && matches!(dialect.m_code(w), Code::Call | Code::Return);
        // Behind the end and behind calls the order is not that of the lines.
        if block.line.number > end || block.words.iter().any(calls) {
            return;
        }
        let waits = block.words.iter().any(|w| w.letter == b'G' && dialect.g_code(w) == Code::Dwell);
        for word in block.words {
            let is_text = match word.kind {
                Kind::Comment | Kind::Skip | Kind::Percent | Kind::Unknown => true,
                Kind::Word if waits && matches!(word.letter, b'X' | b'P') => false,
                Kind::Word => match word.letter {
                    b'G' => dialect.g_code(word) == Code::Kept,
                    b'M' => matches!(dialect.m_code(word), Code::Kept | Code::Unknown),
                    letter => matches!(dialect.role(letter), Role::Kept | Role::Number | Role::Unknown),
                },
                Kind::Colon | Kind::Assignment | Kind::Macro => false,
            };
            let text = word.text(block.line.bytes);
            let line = told.get(&block.line.number).map_or(&b""[..], |line| line);
            let is_there = text.is_empty() || line.windows(text.len()).any(|part| part == text);
            assert!(!is_text || is_there, "{word:?} of {:?} is not in {line:?}", block.line);
        }
    }
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
    for motion in read {
        if let Act::Word(kept) | Act::Unknown(kept) = &motion.act {
            let is_there = text.windows(kept.len()).any(|part| part == &kept[..]);
            assert!(is_there, "{:?} is not written\n{shown}", String::from_utf8_lossy(kept));
        }
    }
}
