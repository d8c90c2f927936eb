use super::*;
use crate::formats::gcode::numbers::Number as Digits;
use crate::macros::decimal::Decimal;

/// A block out of words: `G01`, `X?2498e-2` for one that was computed.
fn block(text: &str) -> (Block<Decimal>, String) {
    let mut block = Block::<Decimal>::default();
    for (start, word) in words(text) {
        let letter = word.as_bytes()[0];
        let rest = &word[1..];
        if let Some(computed) = rest.strip_prefix('?') {
            let (digits, decimals) = computed.split_once("e-").unwrap_or((computed, "0"));
            let value = Decimal::written(digits.parse().unwrap(), decimals.parse().unwrap());
            block.words.push(Word { letter, amount: Amount::Computed(value) });
            continue;
        }
        let decimals = rest.split_once('.').map_or(0, |(_, behind)| behind.len()) as u8;
        let number =
            Digits { mantissa: rest.replace('.', "").parse().unwrap(), decimals, point: rest.contains('.') };
        if letter == b'N' {
            block.number = Some(number.mantissa as u64);
            continue;
        }
        let digits = (start as u32 + 1, (start + word.len()) as u32);
        block.words.push(Word { letter, amount: Amount::Written { number, digits } });
    }
    (block, text.to_owned())
}

fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split(' ').scan(0, |at, word| {
        let start = *at;
        *at += word.len() + 1;
        Some((start, word))
    })
}

fn printed(printer: &mut Printer, text: &str) -> String {
    let (block, source) = block(text);
    let mut out = Vec::new();
    assert_eq!(printer.print(&block, source.as_bytes(), &mut out), Ok(Printed::Block), "{text}");
    String::from_utf8(out).unwrap()
}

fn print_with(form: Form, text: &str) -> String {
    printed(&mut Printer::new(form, false), text)
}

#[test]
fn computed_lengths_are_rounded_once_with_halves_away_from_zero() {
    for (word, expected) in [
        ("X?2498e-2", "X24.980"),
        ("X?5e-4", "X0.001"),
        ("X?-5e-4", "X-0.001"),
        ("X?-4e-4", "X0.000"),
        ("X?49999999e-8", "X0.500"),
        ("X?0", "X0.000"),
        ("X?-12", "X-12.000"),
        ("X?1234567890123456e-15", "X1.235"),
    ] {
        assert_eq!(print_with(Form::default(), word), expected);
    }
}

#[test]
fn what_is_written_goes_out_as_it_is_but_for_its_decimals() {
    let form = Form::default;
    assert_eq!(print_with(form(), "N0012 G01 X25.5 Y7 F200"), "N12 G01 X25.500 Y7 F200");
    assert_eq!(print_with(form(), "M06 T0101 S0500"), "M06 T0101 S0500");
    assert_eq!(print_with(form(), "X-.00049 Y-.0005"), "X0.000 Y-0.001");
    let increments = Form { without_point: [Some(1_000), Some(2_540)], ..form() };
    assert_eq!(print_with(increments.clone(), "G21 X25 Y-7 Z7."), "G21 X0.025 Y-0.007 Z7.000");
    assert_eq!(print_with(increments, "G20 X25"), "G20 X0.0025");
    let units = Form { without_point: [Some(1_000_000), Some(25_400_000)], ..form() };
    assert_eq!(print_with(units.clone(), "X25"), "X25.000");
    assert_eq!(print_with(units, "G20 X25 Y?1e-5"), "G20 X25.0000 Y0.0000");
}

#[test]
fn forms_differ_in_points_zeros_blanks_and_numbers() {
    let form = Form::default;
    assert_eq!(print_with(Form { point: Point::Never, ..form() }, "G01 X?2498e-2 Y1.5"), "G01 X24980 Y1500");
    let short = Form { trailing_zeros: false, leading_zero: false, blanks: false, ..form() };
    assert_eq!(print_with(short.clone(), "N1 G01 X?2498e-2 Y?5e-1 Z?-5e-1 X?0"), "N1G01X24.98Y.5Z-.5X0.");
    assert_eq!(print_with(short, "X?25 Y?-100"), "X25.Y-100.");
    assert_eq!(print_with(Form { numbers: Numbering::Strip, ..form() }, "N1 X?1"), "X1.000");
    let mut counting =
        Printer::new(Form { numbers: Numbering::Count { step: 10, last: 25 }, ..form() }, false);
    let numbers: Vec<String> = (0..4).map(|_| printed(&mut counting, "N7 M00")).collect();
    assert_eq!(numbers, ["N10 M00", "N20 M00", "N10 M00", "N20 M00"]);
}

#[test]
fn codes_are_whole_and_a_feed_may_have_decimals() {
    let form = Form::default;
    assert_eq!(print_with(form(), "G?1 F?1255e-1 S?1500 T?2000e-3"), "G1 F125.5 S1500 T2");
    assert_eq!(print_with(form(), "G?541e-1"), "G54.1");
    for word in ["M?15e-1", "T?1e-3", "G?125e-2", "X?9000000000000000000"] {
        let (block, source) = block(word);
        let mut out = b"before".to_vec();
        let error = Printer::new(form(), false).print(&block, source.as_bytes(), &mut out).unwrap_err();
        assert!(!error.message.is_empty() && !error.help.is_empty());
        assert_eq!(out, b"before", "nothing of it is appended");
    }
}

#[test]
fn a_line_longer_than_the_controls_is_refused() {
    let form = Form { line_max: Some(19), ..Form::default() };
    assert_eq!(print_with(form.clone(), "G01 X?10 Y?10"), "G01 X10.000 Y10.000");
    let (block, source) = block("G01 X?-10 Y?10");
    assert!(Printer::new(form, false).print(&block, source.as_bytes(), &mut Vec::new()).is_err());
}

#[test]
fn remarks_follow_their_block_and_are_no_block_alone() {
    let source = "G01 (CUT) (SLOWLY)";
    let (mut made, _) = block("G01");
    made.remarks = vec![(5, 8), (11, 17)];
    let print = |made: &Block<Decimal>, form| {
        let mut out = Vec::new();
        let printed = Printer::new(form, false).print(made, source.as_bytes(), &mut out).unwrap();
        (String::from_utf8(out).unwrap(), printed)
    };
    assert_eq!(print(&made, Form::default()), (source.to_owned(), Printed::Block));
    let stripped = Form { remarks: false, ..Form::default() };
    assert_eq!(print(&made, stripped.clone()), ("G01".to_owned(), Printed::Block));
    made.words.clear();
    assert_eq!(print(&made, Form::default()), ("(CUT) (SLOWLY)".to_owned(), Printed::Remark));
    assert_eq!(print(&made, stripped), (String::new(), Printed::Nothing));
}

#[test]
fn words_in_force_are_left_out_on_request_only_where_they_say_nothing_new() {
    let mut printer = Printer::new(Form::default(), true);
    for (text, expected) in [
        ("G21 G90", "G21 G90"),
        ("G01 X?10 Y?20 F200", "G01 X10.000 Y20.000 F200"),
        ("G01 X?11 Y?20 F200", "X11.000"),
        ("G01 X?110004e-4 Y?21 F100", "Y21.000 F100"),
        ("G02 X?11 Y?21 I?1 J?0", "G02 X11.000 Y21.000 I1.000 J0.000"),
        ("G01 X?11 Y?30", "G01 Y30.000"),
        ("G01 X?11 Y?30", "G01"),
        ("G91 X?1", "G91 X1.000"),
        ("G91 X?1", "X1.000"),
        ("G90 X?12", "G90 X12.000"),
        ("G92 X?12", "G92 X12.000"),
        ("X?12", "X12.000"),
        ("X?12 Z?1", "Z1.000"),
        ("M06 T1", "M06 T1"),
        ("X?12", "X12.000"),
    ] {
        assert_eq!(printed(&mut printer, text), expected, "{text}");
    }
}

/// Against the standard library's own integers, padded.
#[test]
fn every_number_of_digits_is_spelled_as_the_standard_library_spells_it() {
    let mut value = 0x9E37_79B9_7F4A_7C15_u64;
    for n in 0..20_000u32 {
        value = value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let number = (value as i64) >> (n % 64);
        for decimals in 0..=9u8 {
            let power = 10u64.pow(u32::from(decimals));
            let (sign, size) = (if number < 0 { "-" } else { "" }, number.unsigned_abs());
            let (whole, rest) = (size / power, size % power);
            let behind =
                if decimals == 0 { String::new() } else { format!("{rest:0w$}", w = usize::from(decimals)) };
            let spelled = |trailing, leading| {
                let mut text = Vec::new();
                decimal(number, decimals, trailing, leading, &mut text);
                String::from_utf8(text).unwrap()
            };
            assert_eq!(spelled(true, true), format!("{sign}{whole}.{behind}"));
            let short = behind.trim_end_matches('0');
            assert_eq!(spelled(false, true), format!("{sign}{whole}.{short}"));
            if whole > 0 {
                assert_eq!(spelled(false, false), format!("{sign}{whole}.{short}"));
            } else {
                let zero = if short.is_empty() { "0" } else { "" };
                assert_eq!(spelled(false, false), format!("{sign}{zero}.{short}"));
            }
        }
        let mut text = Vec::new();
        signed(number, &mut text);
        assert_eq!(String::from_utf8(text).unwrap(), number.to_string());
    }
}
