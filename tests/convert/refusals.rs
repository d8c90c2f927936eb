//! What cannot be converted, refused word for word.
//!
//! The complete standard error of each case lies in `tests/golden/convert/NAME.txt`.

use crate::golden;
use crate::shop::Shop;

/// One refusal: the golden file's name, the exit code, the words.
struct Case(&'static str, i32, &'static str);

/// What the cases are about.
const FILES: &[(&str, &str)] = &[
    ("square.3b", "B5000B0B5000GXL1\nB0B5000B5000GYL2\nB5000B0B5000GXL3\nB0B5000B5000GYL4\nDD\n"),
    (
        "led.3b",
        "B0B3000B3000GYL2\nB5000B0B5000GXL1\nB0B5000B5000GYL2\nB9000B0B9000GXL3\nB0B5000B5000GYL4\nB4000B0B4000GXL1\n\
         B0B3000B3000GYL4\nDD\n",
    ),
    ("open.3b", "B5000B0B5000GXL1\nB0B5000B5000GYL2\nB9000B0B9000GXL1\nDD\n"),
    ("fault.3b", "B5000B0B5000GXL1\nB5000B0GXL1\nDD\n"),
    ("taper.nc", "G21 G90\nG92 X0. Y0.\nG51 A2. G01 X5.\nX9.\nG50 X0.\nM02\n"),
    ("upper.nc", "G21 G90\nG92 X0. Y0.\nG01 X5. Y0. U0.5 V0.\nM02\n"),
    ("offset.nc", "G21 G90\nG92 X0. Y0.\nG41 D7 G01 X5.\nY5.\nX0.\nY0.\nX5.\nG40 X0.\nM02\n"),
    (
        "corner.4b",
        "B5000B0B5000B0DGXL1\nB0B9000B9000GYL2\nB1000B0B1000B1000DGXNR1\nB8000B0B8000GXL3\nB0B10000B10000GYL4\nB9000B0B9000GXL1\nB5000B0B5000GXL3\nDD\n",
    ),
    ("flag.4b", "B5000BB5000B0DGXL1\nB5000B0B20000B5000DGYNR1\nB5000BB5000GXL3\nDD\n"),
    ("slot.nc", "G21 G90\nG92 X0. Y0.\nG41 D1 G01 X5.\nX10.\nY0.15\nX0.\nY0.\nX5.\nG40 X4. Y9.\nM02\n"),
    ("words.nc", "G21 G90\nG92 X0. Y0.\nG01 X5\nM02\n"),
    ("letter.txt", "Dear Bob,\n"),
    ("plate.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n5\n21\n0\n0\nENDSEC\n0\nEOF\n"),
];

const PROGRAMS: &[Case] = &[
    Case("taper-to-3b", 3, "taper.nc --dialect generic --to 3b"),
    Case("upper-end-to-3b", 3, "upper.nc --dialect generic --to 3b"),
    Case("flag-to-3b", 3, "flag.4b --to 3b"),
    Case("corner-in-4b", 3, "corner.4b --to 3b --offset 0.1"),
    Case("no-lead-in-to-4b", 3, "square.3b --to 4b --offset 0.1 --side right"),
    Case("corner-to-4b", 3, "led.3b --to 4b --offset 0.1 --side right"),
    Case("4b-taper-to-3b", 3, "flag.4b --to 3b --offset 0.1 --taper 2"),
    Case("register-unknown", 3, "offset.nc --dialect generic --to 3b"),
    Case("register-another", 3, "offset.nc --dialect generic --to 3b --register 1=0.1"),
    Case("wire-too-thick", 3, "slot.nc --dialect generic --to 3b --register 1=0.1"),
    Case("open-backwards", 3, "open.3b --reverse"),
    Case("3b-fault", 3, "fault.3b --to gcode --to-dialect generic"),
    Case("number-without-point", 3, "words.nc --dialect generic --to 3b"),
    Case("open-drawing-with-a-plan", 3, "plate.dxf --unit mm --to 3b --offset 0.1"),
    Case("start-of-gcode", 2, "offset.nc --dialect generic --start 1,1"),
];

const WORDS: &[Case] = &[
    Case("dialect-unknown", 2, "offset.nc --dialect genric --to 3b"),
    Case("to-dialect-unknown", 2, "square.3b --to gcode --to-dialect fanuk"),
    Case("dialect-file-missing", 4, "offset.nc --dialect nothing.toml --to 3b"),
    Case("dialect-of-3b", 2, "square.3b --dialect fanuc --to gcode"),
    Case("offset-from-two-sources", 2, "plate.dxf --unit mm --to 3b --offset 0.1 --passes 0.1=S1"),
    Case("side-without-offset", 2, "square.3b --side left"),
    Case("side-of-4b", 2, "flag.4b --to 3b --offset 0.1 --side left"),
    Case("offset-into-4b", 2, "flag.4b --to 4b --offset 0.1"),
    Case("plan-of-a-program", 2, "square.3b --tabs 2:0.5"),
    Case("end-of-gcode", 2, "square.3b --to gcode --end E"),
    Case("remarks-of-gcode", 2, "square.3b --to gcode --remarks brackets"),
    Case("numbers-of-dxf", 2, "square.3b --to dxf --number-step 5"),
    Case("round-corners-of-3b", 2, "square.3b --to 3b --round-corners 1"),
    Case("offset-no-number", 2, "square.3b --offset wide"),
    Case("register-no-number", 2, "offset.nc --register D1=0.1"),
    Case("start-no-point", 2, "square.3b --start 5"),
    Case("to-unknown", 2, "square.3b --to 5b"),
    Case("kind-unknown", 2, "letter.txt --to 3b"),
    Case("standard-input-unnamed", 2, "- --to 3b"),
    Case("file-missing", 3, "nothing.3b --to gcode"),
    Case("directory", 3, ". --to gcode"),
    Case("out-is-a-directory", 2, "square.3b --to gcode -o ."),
    Case("out-in-no-directory", 1, "square.3b --to gcode -o nowhere/out.nc"),
];

fn compare(cases: &[Case]) {
    let shop = Shop::new();
    for (name, text) in FILES {
        shop.write(name, text);
    }
    let files = shop.files();
    let mut different = Vec::new();
    for Case(name, code, words) in cases {
        let run = shop.run(&format!("convert {words}"));
        let said = &run.stderr;
        if let Some(difference) = golden::difference(&format!("convert/{name}.txt"), said) {
            different.push(format!("{name}: convert {words}\n{difference}"));
        }
        if run.code != Some(*code) {
            different.push(format!("{name}: exit {:?} instead of {code}", run.code));
        }
        // What is refused is named, with something to do about it.
        let is_helped = said.contains("help: ")
            || said.contains("--help")
            || matches!(*name, "directory" | "out-in-no-directory");
        if !said.contains("error: ") || !is_helped {
            different.push(format!("{name}: no error and help in\n{said}"));
        }
    }
    assert_eq!(shop.files(), files, "nothing is left behind");
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn what_a_format_has_no_word_for_is_refused_word_for_word() {
    compare(PROGRAMS);
}

#[test]
fn wrong_words_are_answered_word_for_word() {
    compare(WORDS);
}
