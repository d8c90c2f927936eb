//! Damaged files: each an error with its place, none a drawing with something missing.

use super::*;

fn refused(bytes: &[u8]) -> (String, Place) {
    match read(bytes, &Options::default()) {
        Err(ReadError::Program { message, place, help }) => {
            assert!(!help.is_empty());
            (message, place)
        }
        other => panic!("{other:?}"),
    }
}

fn entity(entity: &str) -> (String, u64) {
    let (message, place) = refused(file(entity).as_bytes());
    (message, place.line)
}

#[test]
fn an_empty_file_is_refused() {
    assert_eq!(refused(b"").0, "the drawing is cut off: it ends before `0 EOF`");
    assert_eq!(refused(b"\n\n").0, "the drawing is cut off: it ends before `0 EOF`");
    assert_eq!(refused(&[0; 64]).0, "a group code is due here, a whole number up to 1071");
}

#[test]
fn a_drawing_without_an_entity_is_read_and_has_nothing_to_cut() {
    let drawing = read_text(&file(""), &Options::default());
    assert_eq!(codes(&drawing), ["nothing-to-cut"]);
    assert!(!drawing.is_fit_to_cut());
}

#[test]
fn a_file_cut_off_anywhere_is_an_error() {
    let blocks = "0 SECTION|2 BLOCKS|0 BLOCK|2 B|10 0|20 0|0 LINE|10 0|20 0|11 1|21 0|0 ENDBLK|0 ENDSEC";
    let text = file_with(
        blocks,
        "0 CIRCLE|10 0|20 0|40 1|0 POLYLINE|66 1|0 VERTEX|10 0|20 0|0 VERTEX|10 9|20 0|0 SEQEND|0 INSERT|2 B|10 0|20 0",
    );
    let whole = text.trim_end().len();
    assert!(read(&text.as_bytes()[..whole], &Options::default()).is_ok());
    for end in 0..whole {
        assert!(
            read(&text.as_bytes()[..end], &Options::default()).is_err(),
            "cut off after {:?}",
            &text[..end]
        );
    }
}

#[test]
fn a_binary_file_is_read_as_its_text_is_and_cut_off_is_an_error() {
    let text =
        file("0 LWPOLYLINE|8 A|70 1|10 0|20 0|10 5|20 0|42 0.5|10 5|20 5|0 CIRCLE|8 B|10 20|20 0|40 2");
    for wide in [false, true] {
        let mut bytes = b"AutoCAD Binary DXF\r\n\x1A\0".to_vec();
        let mut lines = text.lines();
        while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
            let code: i16 = code.parse().unwrap();
            if wide {
                bytes.extend(code.to_le_bytes());
            } else {
                bytes.push(code as u8);
            }
            match code {
                10..=59 => bytes.extend(value.parse::<f64>().unwrap().to_le_bytes()),
                60..=79 => bytes.extend(value.parse::<i16>().unwrap().to_le_bytes()),
                _ => {
                    bytes.extend(value.as_bytes());
                    bytes.push(0);
                }
            }
        }
        let read_binary = read(bytes.as_slice(), &Options::default()).unwrap();
        let expected = read_text(&text, &Options::default());
        let paths = |drawing: &Drawing| -> Vec<(String, Path)> {
            drawing.contours.iter().map(|c| (c.layer.clone(), c.path.clone())).collect()
        };
        assert_eq!(paths(&read_binary), paths(&expected));
        for end in 0..bytes.len() {
            assert!(read(&bytes[..end], &Options::default()).is_err(), "cut off at {end}");
        }
        // A transfer as text: every CR LF becomes LF.
        let position = bytes.windows(2).position(|w| w == b"\r\n").unwrap();
        bytes.remove(position);
        assert_eq!(refused(&bytes).0, "the head of the binary drawing is damaged");
    }
}

#[test]
fn numbers_are_read_in_every_spelling_and_nothing_else_is() {
    let circle = one("0 CIRCLE|10 1.|20 -.5|40 +1e1");
    assert_eq!(circle, Path::circle(point(1.0, -0.5), 10.0, Sense::CounterClockwise));
    for word in ["", "1,5", "1.5mm", "nan", "inf", "1e999", "--1", "0x10", "１"] {
        let (message, line) = entity(&format!("0 CIRCLE|10 {word}|20 0|40 1"));
        assert_eq!((message.as_str(), line), ("code 10 holds a number, and this is none", 18), "{word}");
    }
    assert_eq!(
        entity("0 LWPOLYLINE|70 40000|10 0|20 0").0,
        "code 70 holds a whole number of 16 bits, and this is none"
    );
}

#[test]
fn an_entity_that_lacks_something_is_an_error() {
    for (text, message) in [
        ("0 CIRCLE|10 0|20 0", "the CIRCLE has no code 40"),
        ("0 LINE|10 0|20 0|11 0", "the LINE has no code 21"),
        ("0 ARC|10 0|20 0|40 1|50 0", "the ARC has no code 51"),
        ("0 LINE|10 0|20 0|11 0|21 0|10 5", "code 10 is given twice in one LINE"),
        ("0 LWPOLYLINE|10 0|20 0|10 5", "the last point of the LWPOLYLINE has no Y"),
        ("0 LWPOLYLINE|10 0|10 5|20 0|20 3", "X (10) and Y (20) do not alternate"),
        ("0 LWPOLYLINE|42 1|10 0|20 0", "a bulge stands before the first vertex"),
        ("0 POLYLINE|0 VERTEX|10 0|20 0|0 LINE|10 0|20 0|11 1|21 0", "the POLYLINE has no SEQEND"),
        ("0 VERTEX|10 0|20 0", "a VERTEX stands outside of a POLYLINE"),
        ("0 INSERT|10 0|20 0", "the INSERT names no block"),
        ("8 A", "`0` and an entity are due here"),
        ("0 EOF", "`0 EOF` stands inside a section"),
    ] {
        assert_eq!(entity(text).0, message);
    }
    for (sections, message) in [
        ("0 SECTION|2 BLOCKS|0 BLOCK|10 0|0 ENDBLK|0 ENDSEC", "the block has no name"),
        ("0 SECTION|2 BLOCKS|0 BLOCK|2 B|0 LINE|10 0|20 0|11 1|21 0|0 ENDSEC", "the block has no `0 ENDBLK`"),
        ("0 SECTION|2 BLOCKS|0 BLOCK|2 B|0 ENDBLK|0 BLOCK|2 b|0 ENDBLK|0 ENDSEC", "block B is defined twice"),
        ("0 SECTION|0 ENDSEC", "the name of the section is due here"),
        ("0 LINE", "`0 SECTION` or `0 EOF` is due here"),
    ] {
        assert_eq!(refused(file_with(sections, "").as_bytes()).0, message);
    }
}

#[test]
fn damage_in_the_middle_is_shown_where_it_is() {
    let text = file("0 CIRCLE|10 0|20 0|40 1|0 LINE|10 0|20 0|11 5|21 0");
    let damaged = text.replace("11\n5\n", "11\n5\0\0\n");
    let (message, place) = refused(damaged.as_bytes());
    assert_eq!(message, "code 11 holds a number, and this is none");
    assert_eq!((place.line, place.column, place.excerpt.as_str()), (30, 1, "5.."));
    assert_eq!(&damaged.as_bytes()[place.byte as usize..][..3], b"5\0\0");
}

#[test]
fn other_encodings_and_formats_are_named() {
    let utf16: Vec<u8> = file("").encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(
        refused(&[b"\xFF\xFE", &utf16[..]].concat()).0,
        "the drawing is UTF-16, two bytes a character"
    );
    assert_eq!(refused(b"AC1027\0\0\0").0, "this is a DWG file");
    assert_eq!(refused(b"AutoCAD DXB 1.0\r\n\x1a\0").0, "this is a DXB file");
    let with_bom = [b"\xEF\xBB\xBF", file("0 CIRCLE|10 0|20 0|40 1").as_bytes()].concat();
    assert_eq!(read(with_bom.as_slice(), &Options::default()).unwrap().contours.len(), 1);
}

#[test]
fn what_stands_behind_the_end_is_told() {
    let text = file("0 CIRCLE|10 0|20 0|40 1") + "0\nSECTION\n";
    let drawing = read_text(&text, &Options::default());
    assert_eq!(codes(&drawing), ["behind-end"]);
    let blank = file("0 CIRCLE|10 0|20 0|40 1") + "\n\n\x1a";
    assert!(read(blank.as_bytes(), &Options::default()).is_ok());
}
