//! Arbitrary bytes, damaged drawings and texts that look like drawings, into the DXF reader; what comes of them, written
//! as a drawing and read again.

use dripfeed::drawing::dxf::{self, Drawing, DxfWriter, Options};
use dripfeed::drawing::finding::Severity;
use dripfeed::formats::{ReadError, Writer};
use dripfeed::geometry::{Element, Point};
use dripfeed::motion::Act;

/// Pairs a drawing may be made of, well and badly.
const PIECES: [&str; 48] = [
    "0\nSECTION\n2\nENTITIES\n",
    "0\nSECTION\n2\nBLOCKS\n",
    "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n",
    "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n",
    "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n0\nLAYER\n2\nA\n70\n1\n62\n7\n0\nENDTAB\n0\nENDSEC\n",
    "0\nENDSEC\n",
    "0\nEOF\n",
    "0\nLINE\n10\n0\n20\n0\n11\n10\n21\n0\n",
    "0\nLINE\n8\nA\n10\n10\n20\n0\n11\n10\n21\n10\n",
    "0\nLINE\n10\n10\n20\n10\n11\n0\n21\n0.003\n",
    "0\nARC\n10\n0\n20\n0\n40\n10\n50\n0\n51\n90\n",
    "0\nARC\n10\n0\n20\n0\n40\n1e-9\n50\n0\n51\n1e-9\n",
    "0\nARC\n10\n1e8\n20\n0\n40\n1e8\n50\n-1e300\n51\n1e300\n",
    "0\nCIRCLE\n10\n5\n20\n5\n40\n2\n",
    "0\nCIRCLE\n10\n5\n20\n5\n40\n-2\n210\n0\n220\n0\n230\n-1\n",
    "0\nELLIPSE\n10\n0\n20\n0\n11\n4\n21\n1\n40\n0.5\n41\n0\n42\n6.283185307179586\n",
    "0\nELLIPSE\n10\n0\n20\n0\n11\n1e-300\n21\n0\n40\n1e300\n",
    "0\nELLIPSE\n10\n0\n20\n0\n11\n4e3\n21\n1\n40\n1e-12\n41\n-9e99\n42\n3\n",
    "0\nLWPOLYLINE\n70\n1\n10\n0\n20\n0\n42\n1\n10\n4\n20\n0\n10\n4\n20\n4\n42\n-0.3\n",
    "0\nLWPOLYLINE\n10\n0\n20\n0\n42\n1e300\n10\n4\n20\n0\n42\n1e-300\n10\n4\n20\n4\n",
    "0\nLWPOLYLINE\n",
    "0\nPOLYLINE\n66\n1\n70\n1\n",
    "0\nVERTEX\n10\n0\n20\n0\n42\n0.5\n",
    "0\nVERTEX\n10\n7\n20\n3\n70\n16\n",
    "0\nSEQEND\n",
    "0\nSPLINE\n71\n2\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n10\n0\n20\n0\n10\n5\n20\n9\n10\n9\n20\n0\n",
    "0\nSPLINE\n71\n3\n40\n0\n40\n0\n40\n1\n40\n1\n10\n0\n20\n0\n10\n0\n20\n0\n11\n3\n21\n3\n",
    "0\nSPLINE\n71\n1\n40\n0\n40\n0\n40\n1\n40\n1\n10\n0\n20\n0\n10\n1e9\n20\n1e-9\n",
    "0\nBLOCK\n2\nB\n10\n1\n20\n1\n",
    "0\nENDBLK\n",
    "0\nINSERT\n2\nB\n10\n3\n20\n4\n50\n30\n",
    "0\nINSERT\n8\nA\n2\nb\n10\n3\n20\n4\n41\n-2\n42\n0.5\n70\n3\n71\n2\n44\n9\n45\n9\n",
    "0\nINSERT\n2\nB\n10\n0\n20\n0\n41\n0\n42\n1e200\n230\n-1\n",
    "0\nTEXT\n8\nNOTES\n1\n\u{5B57}\n",
    "999\nclockwise\n",
    "999\nentities in cutting order, each begun where the last one ended, the first at 0,0\n",
    "999\nends at 5 5\n",
    "102\n{ACAD_XDICTIONARY\n10\n5\n102\n}\n",
    "1001\nACAD\n1040\n5.0\n",
    "60\n1\n",
    "67\n1\n",
    "8\nA\n",
    "10\n5\n",
    "40\n\n",
    "70\n99999\n",
    "\n",
    "\0",
    "5000\n",
];

/// Reads bytes as a drawing, and holds what is read to its promises.
fn read(bytes: &[u8]) -> Option<Drawing> {
    let drawing = match dxf::read(bytes, &Options::default()) {
        Ok(drawing) => drawing,
        Err(ReadError::Program { place, message, help }) => {
            assert!(place.byte <= bytes.len() as u64, "{message}: {place:?}");
            assert!(place.line >= 1 && place.column >= 1 && place.width >= 1, "{place:?}");
            assert!(place.caret < place.excerpt.len(), "{place:?}");
            assert!(!message.is_empty() && !help.is_empty());
            return None;
        }
        Err(error) => panic!("{error}"),
    };
    for finding in &drawing.report {
        assert!(!finding.message.is_empty() && !finding.message.contains("NaN"), "{finding}");
    }
    assert!(!drawing.contours.is_empty() || !drawing.is_fit_to_cut(), "an empty drawing is not fit to cut");
    let finite = |p: Point| p.x.is_finite() && p.y.is_finite();
    let mut at = Point::origin();
    for motion in drawing.motions() {
        let Act::Move { element, .. } = motion.act else { continue };
        assert!(element.start() == at && finite(element.end()), "{element:?} does not go on from {at}");
        if let Element::Arc { centre, .. } = element {
            assert!(finite(centre), "{element:?}");
        }
        at = element.end();
    }
    Some(drawing)
}

/// Writes a drawing's motions as a drawing, which is then as long as the first.
fn write(drawing: &Drawing) {
    let (mut writer, mut text) = (DxfWriter::new(), Vec::new());
    let mut length = 0.0;
    for motion in drawing.motions() {
        writer.write(&motion, &mut text).expect("what was read can be written");
        if let Act::Move { element, .. } = &motion.act {
            length += element.length();
        }
    }
    writer.finish(&mut text).expect("it can be ended");
    let again = read(&text).expect("what was written can be read");
    let found: f64 = again.contours.iter().map(|contour| contour.path.length()).sum();
    assert!((found - length).abs() <= 1e-6 * (1.0 + length), "{length} mm were written and {found} mm read");
}

/// A drawing with an entity of every kind, to be damaged.
fn sound() -> Vec<u8> {
    let pieces = [2, 1, 28, 7, 10, 29, 5, 0, 7, 8, 9, 13, 15, 18, 21, 22, 22, 24, 25, 31, 33, 5, 6];
    pieces.iter().map(|&n: &usize| PIECES[n]).collect::<String>().into_bytes()
}

/// The binary form of a text, as far as its lines are what their codes say.
fn binary(text: &[u8], wide: bool) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1A\0".to_vec();
    let mut lines = text.lines();
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        let code: i16 = code.trim().parse().unwrap_or(0);
        match (wide, u8::try_from(code)) {
            (false, Ok(code)) => bytes.push(code),
            (false, Err(_)) => bytes.extend([&[255], &code.to_le_bytes()[..]].concat()),
            (true, _) => bytes.extend(code.to_le_bytes()),
        }
        match code {
            10..=59 | 210..=239 => bytes.extend(value.parse::<f64>().unwrap_or(f64::NAN).to_le_bytes()),
            60..=79 => bytes.extend(value.parse::<i16>().unwrap_or(-1).to_le_bytes()),
            _ => bytes.extend([value.as_bytes(), &[0]].concat()),
        }
    }
    bytes
}

/// Changes bytes: each two of the choice say where and into what.
fn damaged(mut bytes: Vec<u8>, choice: &[u8]) -> Vec<u8> {
    for pair in choice.chunks_exact(3) {
        let at = usize::from(u16::from_le_bytes([pair[0], pair[1]])) % bytes.len().max(1);
        match pair[2] {
            0..=15 => bytes.truncate(at),
            16..=31 => drop(bytes.drain(at..(at + 8).min(bytes.len()))),
            32..=47 => bytes.insert(at, b'\n'),
            other => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = other;
                }
            }
        }
    }
    bytes
}

#[test]
fn arbitrary_bytes_are_read_or_refused() {
    bolero::check!().for_each(|bytes: &[u8]| {
        read(bytes);
        read(&[b"AutoCAD Binary DXF\r\n\x1A\0", bytes].concat());
    });
}

#[test]
fn pieces_of_drawings_in_any_order_are_read_or_refused_and_what_is_read_can_be_written() {
    bolero::check!().for_each(|choice: &[u8]| {
        let text: String = choice.iter().map(|&n| PIECES[n as usize % PIECES.len()]).collect();
        read(text.as_bytes());
        read(&binary(text.as_bytes(), true));
        // Entities alone, in the frame that they need.
        let entities: String = choice
            .iter()
            .map(|&n| PIECES[7 + n as usize % 27])
            .filter(|piece| !piece.contains("BLK"))
            .collect();
        let framed = format!("{}{}{entities}{}{}", PIECES[2], PIECES[0], PIECES[5], PIECES[6]);
        if let Some(drawing) = read(framed.as_bytes()) {
            write(&drawing);
        }
    });
}

#[test]
fn a_damaged_drawing_is_read_or_refused() {
    assert!(read(&sound()).is_some_and(|drawing| drawing.contours.len() > 8));
    bolero::check!().for_each(|choice: &[u8]| {
        read(&damaged(sound(), choice));
        read(&damaged(binary(&sound(), false), choice));
        read(&damaged(binary(&sound(), true), choice));
    });
}

#[test]
fn a_drawing_cut_off_anywhere_is_refused() {
    for bytes in [sound(), binary(&sound(), false), binary(&sound(), true)] {
        assert!(read(&bytes).is_some());
        // The line end behind EOF may be missing.
        for end in 0..bytes.len() - 1 {
            assert!(read(&bytes[..end]).is_none(), "cut off at {end} of {}", bytes.len());
        }
    }
}

#[test]
fn long_lines_nuls_and_other_encodings_are_read_or_refused() {
    let sound = sound();
    let text = String::from_utf8(sound.clone()).expect("the pieces are text");
    let utf_16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(read(&[b"\xFF\xFE", &utf_16[..]].concat()).is_none());
    assert!(read(&utf_16).is_none());
    assert!(read(&[b"\xEF\xBB\xBF", &sound[..]].concat()).is_some());
    assert!(read(&[0; 70_000]).is_none());
    // A text of 70 000 characters is a text; a number of as many digits is a number or none.
    let long = text.replace("NOTES", &"N".repeat(70_000));
    let drawing = read(long.as_bytes()).expect("a long name is a name");
    assert!(drawing.report.iter().any(|finding| finding.severity == Severity::Note));
    read(text.replace("0.003", &format!("0.{}", "3".repeat(70_000))).as_bytes());
    read(text.replace("0.003", &"9".repeat(70_000)).as_bytes());
}
