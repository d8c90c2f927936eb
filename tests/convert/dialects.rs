//! The samples of the G-code dialects: the mock compensates each by its own G41 and G42, and cuts the 3B made of it.
//!
//! The mock reads one dialect with settings, so what it has no word for and what moves nothing is taken out of the text it
//! gets: register values, conditions, labels. Tapers, and motions of the upper end, are taken out of both texts.

use mock_controller::{ArcCentre, GcodeSettings, Settings, UnitWithoutPoint};

use crate::control::{Cut, Place, assert_same_cut, cut, cut_3b, gcode};
use crate::shop::Shop;

/// A sample, and how the mock is to get it.
struct Sample {
    name: &'static str,
    dialect: &'static str,
    /// Pieces of lines that tilt the wire.
    tilts: &'static [&'static str],
    /// Whether a line moves the wire's upper end.
    leans: fn(&str) -> bool,
    /// Pieces of lines for the mock, and what stands there instead.
    for_mock: &'static [(&'static str, &'static str)],
    /// Lines the mock does not get.
    without: fn(&str) -> bool,
    /// Words the mock passes over besides those it passes over anyway.
    passed_over: &'static str,
    integers: bool,
}

const PLAIN: Sample = Sample {
    name: "generic",
    dialect: "generic",
    tilts: &[],
    leans: |_| false,
    for_mock: &[],
    without: |_| false,
    passed_over: "",
    integers: false,
};

const SAMPLES: [Sample; 9] = [
    PLAIN,
    Sample {
        name: "fanuc",
        dialect: "fanuc",
        tilts: &[" G52 T1.5", " G50 T0"],
        leans: |line| line.contains(" U") || line.contains(" V"),
        integers: true,
        ..PLAIN
    },
    Sample {
        name: "charmilles",
        dialect: "charmilles",
        tilts: &[" G52", " G51", " G50", " T1.5"],
        for_mock: &[(" I30.0 J0.0", "")],
        without: |line| line.is_empty(),
        ..PLAIN
    },
    Sample {
        name: "charmilles-100",
        dialect: "absolute.toml",
        // The mock's D0 is no offset.
        for_mock: &[("D0", "D1")],
        passed_over: "G60,G38,G39",
        ..PLAIN
    },
    Sample {
        name: "sodick",
        dialect: "sodick",
        tilts: &[" G51 A1.25", " G50 A0"],
        leans: |line| line.contains(':'),
        for_mock: &[("N0010", "O0010")],
        without: |line| line.contains('='),
        passed_over: "G54,G60,G61",
        integers: true,
    },
    Sample {
        name: "mitsubishi",
        dialect: "mitsubishi",
        leans: |line| line.contains(" U") || line.contains(" V"),
        without: |line| line.contains(" ="),
        passed_over: "L",
        ..PLAIN
    },
    Sample { name: "agie", dialect: "agie", passed_over: "G71", integers: true, ..PLAIN },
    Sample {
        name: "integer-um",
        dialect: "integer-um",
        for_mock: &[("N000", "O000")],
        without: |line| line.contains('='),
        integers: true,
        ..PLAIN
    },
    Sample {
        name: "integer-um-91",
        dialect: "integer-um",
        tilts: &["G51 A3 ", "G50 A0 "],
        without: |line| line.starts_with(['W', 'J']),
        integers: true,
        ..PLAIN
    },
];

impl Sample {
    /// The program with the wire upright.
    fn text(&self) -> String {
        let path = format!("{}/tests/data/dialects/{}.nc", env!("CARGO_MANIFEST_DIR"), self.name);
        let mut text = String::new();
        for line in std::fs::read_to_string(path).unwrap().lines().filter(|line| !(self.leans)(line)) {
            text.push_str(line);
            text.push('\n');
        }
        for tilt in self.tilts {
            assert!(text.contains(tilt), "{}: {tilt}", self.name);
            text = text.replace(tilt, "");
        }
        text
    }

    /// What the mock cuts of the program with every register at this offset, µm.
    fn cut(&self, offset_um: f64) -> Cut {
        let mut text = self.text();
        for (there, instead) in self.for_mock {
            assert!(text.contains(there), "{}: {there}", self.name);
            text = text.replace(there, instead);
        }
        let lines: Vec<&str> = text.lines().filter(|line| !(self.without)(line) && *line != "%").collect();
        let words = format!("C,E,S,H,T,P,F,M03-M29,M31-M97,{}", self.passed_over);
        let reading = GcodeSettings {
            arc_centre: match self.dialect {
                "absolute.toml" => ArcCentre::Absolute,
                _ => ArcCentre::Incremental,
            },
            unit_without_point: match self.integers {
                true => UnitWithoutPoint::Least,
                false => UnitWithoutPoint::Error,
            },
            ignored_words: words.parse().unwrap(),
            ..GcodeSettings::default()
        };
        cut(Settings { gcode: reading, ..gcode(offset_um) }, &lines.join("\n"))
    }

    /// A shop with the program in it, and the words that name it.
    fn shop(&self) -> (Shop, String) {
        let shop = Shop::with("in.nc", self.text());
        let charmilles = format!("{}/src/formats/gcode/dialects/charmilles.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(charmilles).unwrap();
        shop.write("absolute.toml", text.replace("\"from-start\"", "\"absolute\""));
        (shop, format!("in.nc --dialect {}", self.dialect))
    }
}

#[test]
fn the_wires_path_of_every_dialect_is_the_one_its_control_works_out() {
    for sample in &SAMPLES {
        let (shop, words) = sample.shop();
        for offset in [0, 50, 100] {
            let what = format!("{}, offset {offset} µm", sample.name);
            let told = sample.cut(f64::from(offset));
            let program = shop.convert(&format!("{words} --to 3b --offset 0.{offset:03}"));
            assert_same_cut(&cut_3b(&program), &told, 2, &what);
        }
    }
}

#[test]
fn what_the_registers_hold_is_the_offset_of_the_program() {
    let (shop, words) = SAMPLES[0].shop();
    let by_offset = shop.convert(&format!("{words} --to 3b --offset 0.12"));
    let by_register = shop.convert(&format!("{words} --to 3b --register 1=0.12 --register 2=0.12"));
    assert_eq!(by_offset, by_register);
    // The rough pass beside D1, the skim beside D2: each as far out as its own register says.
    let other = cut_3b(&shop.convert(&format!("{words} --to 3b --register 1=0.3 --register 2=0.1")));
    let of = |um| SAMPLES[0].cut(um);
    let rough = of(300.0);
    let half_of_rough = rough.ends.iter().position(|end| *end == [0, 0]).unwrap() / 2;
    let extents = [other.extents(), rough.extents()];
    assert!(extents[0].iter().zip(extents[1]).all(|(a, b)| (a - b).abs() <= 1), "{extents:?}");
    let skim = of(100.0);
    let near = |a: &[Place], b: &[Place]| {
        let off = |(a, b): (&Place, &Place)| (a[0] - b[0]).abs() <= 1 && (a[1] - b[1]).abs() <= 1;
        assert!(a.len() == b.len() && a.iter().zip(b).all(off), "{a:?}\n{b:?}");
    };
    near(&other.ends[..half_of_rough], &rough.ends[..half_of_rough]);
    let behind = |cut: &Cut| cut.ends[cut.ends.len() - 2..].to_vec();
    near(&behind(&other), &behind(&skim));
}

#[test]
fn gcode_with_the_wires_path_in_it_needs_no_offset() {
    for sample in &SAMPLES {
        let (shop, words) = sample.shop();
        let text = shop.convert(&format!("{words} --to gcode --to-dialect generic --offset 0.1"));
        assert!(!text.contains("G41") && !text.contains("G42"), "{}\n{text}", sample.name);
        let reading = GcodeSettings {
            ignored_words: "C,E,S,H,T,P,F,W,L,J,D,M03-M97,G38,G39,G54,G60,G61".parse().unwrap(),
            ..GcodeSettings::default()
        };
        let text: Vec<&str> = text.lines().filter(|line| !line.contains('=') && *line != "%").collect();
        let told = cut(Settings { gcode: reading, ..gcode(0.0) }, &text.join("\n"));
        assert_same_cut(&told, &sample.cut(100.0), 2, sample.name);
    }
}

#[test]
fn gcode_comes_back_from_3b_with_the_same_cut() {
    for sample in &SAMPLES {
        let (shop, words) = sample.shop();
        shop.write("wire.3b", shop.convert(&format!("{words} --to 3b --offset 0.1")));
        shop.write("back.nc", shop.convert("wire.3b --to gcode"));
        let there = cut_3b(&shop.read("wire.3b"));
        let back = cut(gcode(0.0), &shop.read("back.nc"));
        assert_same_cut(&back, &there, 2, sample.name);
        let again = cut_3b(&shop.convert("back.nc --to 3b"));
        assert_eq!(again.end(), there.end(), "{}", sample.name);
        assert_same_cut(&again, &there, 2, sample.name);
    }
}
