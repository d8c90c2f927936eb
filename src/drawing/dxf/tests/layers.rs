//! Layers by name, and the drawing's unit.

use super::*;

const TABLE: &str = "0 SECTION|2 TABLES|0 TABLE|2 LAYER|70 3|0 LAYER|2 OFF|70 0|62 -7|0 LAYER|2 FROZEN|70 1|62 7\
                     |0 LAYER|2 Part|70 0|62 7|0 ENDTAB|0 ENDSEC";
const CIRCLES: &str = "0 CIRCLE|8 OFF|10 0|20 0|40 1|0 CIRCLE|8 FROZEN|10 10|20 0|40 1|0 CIRCLE|8 Part|10 20|20 0|40 1\
                       |0 CIRCLE|8 Other|10 30|20 0|40 1";

fn layers(options: &Options) -> (Vec<String>, Drawing) {
    let drawing = read_text(&file_with(TABLE, CIRCLES), options);
    (drawing.contours.iter().map(|c| c.layer.clone()).collect(), drawing)
}

#[test]
fn layers_that_are_off_or_frozen_are_left_out_and_told() {
    let (found, drawing) = layers(&Options::default());
    assert_eq!(found, ["Part", "Other"]);
    assert_eq!(codes(&drawing), ["layer-off", "layer-frozen"]);
    assert!(drawing.is_fit_to_cut());
}

#[test]
fn layers_are_chosen_by_name_whatever_the_capitals() {
    let chosen = |names: &[&str]| {
        let names = names.iter().map(|name| (*name).to_string()).collect();
        layers(&Options { layers: Some(names), ..Options::default() })
    };
    let (found, drawing) = chosen(&["PART"]);
    assert_eq!(found, ["Part"]);
    assert!(codes(&drawing).contains(&"layer-not-chosen"));
    let (found, drawing) = chosen(&["Other", "Parts"]);
    assert_eq!(found, ["Other"]);
    assert!(!drawing.is_fit_to_cut());
    let fault = drawing.report.iter().find(|f| f.code == "no-layer").unwrap();
    assert_eq!(fault.message, "the drawing has no layer Parts");
    assert_eq!(fault.help, "its layers are 0, OFF, FROZEN, Part, Other");
}

#[test]
fn contours_are_joined_within_a_layer_only() {
    let drawing = read_text(
        &file("0 LINE|8 A|10 0|20 0|11 5|21 0|0 LINE|8 B|10 5|20 0|11 5|21 5|0 LINE|8 A|10 5|20 0|11 9|21 0"),
        &Options::default(),
    );
    let mut counts: Vec<(&str, usize)> =
        drawing.contours.iter().map(|c| (c.layer.as_str(), c.path.elements().len())).collect();
    counts.sort_unstable();
    assert_eq!(counts, [("A", 2), ("B", 1)]);
}

#[test]
fn a_name_is_shown_as_it_is_meant() {
    let mut text = file("0 CIRCLE|8 \\U+00D8 5|10 0|20 0|40 1").into_bytes();
    let drawing = read(text.as_slice(), &Options::default()).unwrap();
    assert_eq!(drawing.contours[0].layer, "Ø 5");
    // GBK for "part": bytes, of which none is lost.
    let at = text.windows(4).position(|w| w == b"\\U+0").unwrap();
    text.splice(at..at + 9, *b"\xc1\xe3\xbc\xfe");
    let drawing = read(text.as_slice(), &Options::default()).unwrap();
    assert_eq!(drawing.contours[0].layer, "\\xC1\\xE3\\xBC\\xFE");
}

#[test]
fn the_unit_is_the_callers_or_the_headers_or_told_to_be_assumed() {
    let circle = "0 SECTION|2 ENTITIES|0 CIRCLE|10 0|20 0|40 1|0 ENDSEC|0 EOF";
    let radius = |header: &str, unit: Option<f64>| {
        let head =
            if header.is_empty() { String::new() } else { format!("0 SECTION|2 HEADER|{header}|0 ENDSEC|") };
        let drawing = read_text(&pairs(&format!("{head}{circle}")), &Options { unit, ..Options::default() });
        let warned = drawing.report.iter().find(|f| f.code == "unit-assumed").map(|f| f.message.clone());
        (drawing.contours[0].path.extent()[1].x, drawing.units.known, warned)
    };
    assert_eq!(radius("9 $INSUNITS|70 4", None), (1.0, Known::Stated, None));
    assert_eq!(radius("9 $INSUNITS|70 1", None), (25.4, Known::Stated, None));
    assert_eq!(radius("9 $INSUNITS|70 5", None), (10.0, Known::Stated, None));
    assert_eq!(radius("9 $INSUNITS|70 13", None), (0.001, Known::Stated, None));
    assert_eq!(radius("9 $INSUNITS|70 1", Some(1.0)), (1.0, Known::Given, None));
    let assumed = |name: &str, because: &str| {
        Some(format!("the drawing does not state its unit: {name} are assumed, since {because}"))
    };
    assert_eq!(
        radius("9 $MEASUREMENT|70 0", None),
        (25.4, Known::Likely, assumed("inches", "`$MEASUREMENT` makes it likely"))
    );
    assert_eq!(
        radius("9 $INSUNITS|70 0|9 $MEASUREMENT|70 1", None),
        (1.0, Known::Likely, assumed("mm", "`$MEASUREMENT` makes it likely"))
    );
    assert_eq!(radius("", None), (1.0, Known::Assumed, assumed("mm", "nothing in it tells")));
    assert_eq!(
        radius("9 $INSUNITS|70 99", None),
        (1.0, Known::Assumed, assumed("mm", "`$INSUNITS` 99 is none that is known"))
    );
}
