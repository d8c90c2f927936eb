use std::cmp::Ordering;

use super::*;

#[test]
fn twenty_five_less_two_hundred_and_fifty_steps_of_two_hundredths_is_twenty() {
    let (mut x, step, end) = (number("25"), number("0.02"), number("20"));
    let mut turns = 0;
    while x > end {
        x = x.minus(step).unwrap();
        turns += 1;
    }
    assert_eq!((turns, x.text()), (250, "20".into()));
}

#[test]
fn sums_differences_and_products_are_exact_while_they_fit() {
    assert_eq!(spelled(number("0.1").plus(number("0.2"))), "0.3");
    assert_eq!(spelled(number("25").minus(number("0.02"))), "24.98");
    assert_eq!(spelled(number("-1.5").times(number("0.002"))), "-0.003");
    assert_eq!(spelled(number("123456789.123456789").plus(number("0.000000001"))), "123456789.12345679");
    assert_eq!(spelled(number("999999999.999999999").plus(number("0.000000001"))), "1000000000");
    assert_eq!(spelled(number("1000000000").times(number("0.000000001"))), "1");
}

#[test]
fn what_does_not_fit_is_rounded_once_with_halves_to_even() {
    // Nineteen digits are held, and a half of the last becomes even.
    assert_eq!(spelled(number("4000000000000000.5").plus(number("0.0015"))), "4000000000000000.502");
    assert_eq!(spelled(number("4000000000000000.5").plus(number("0.0005"))), "4000000000000000.5");
    assert_eq!(spelled(number("4000000000000000000").plus(number("0.5"))), "4000000000000000000");
    assert_eq!(spelled(number("4000000000000000001").plus(number("0.5"))), "4000000000000000002");
    assert_eq!(spelled(number("4000000000000000001").plus(number("0.4"))), "4000000000000000001");
    assert_eq!(spelled(number("0.0000000005").times(number("0.000000001"))), "0");
    assert_eq!(spelled(number("0.0000000015").times(number("0.000000001"))), "0.000000000000000002");
    assert_eq!(spelled(number("0.0000000025").times(number("0.000000001"))), "0.000000000000000002");
}

#[test]
fn beyond_the_largest_mantissa_there_is_no_number() {
    let largest = Decimal::whole(i64::MAX);
    assert_eq!(largest.plus(number("1")), Err(Undefined::TooLarge));
    assert_eq!(spelled(largest.plus(number("0.4"))), i64::MAX.to_string());
    assert_eq!(largest.plus(number("0.5")), Err(Undefined::TooLarge), "rounded up beyond it");
    assert_eq!(number("4000000000").times(number("4000000000")), Err(Undefined::TooLarge));
    assert_eq!(largest.negated().minus(number("1")), Err(Undefined::TooLarge), "i64::MIN has no negative");
    assert_eq!(Decimal::whole(1 << 62).times(number("-2")), Err(Undefined::TooLarge));
    assert_eq!(number("1000000000000000000").over(number("0.01")), Err(Undefined::TooLarge));
    assert_eq!(Decimal::whole(i64::MIN), largest.negated());
}

#[test]
fn quotients_are_rounded_to_as_many_decimals_as_fit() {
    assert_eq!(spelled(number("1").over(number("3"))), "0.333333333333333333");
    assert_eq!(spelled(number("-2").over(number("3"))), "-0.666666666666666667");
    assert_eq!(spelled(number("10").over(number("3"))), "3.333333333333333333");
    assert_eq!(spelled(number("100").over(number("3"))), "33.33333333333333333");
    assert_eq!(spelled(number("360").over(number("7"))), "51.42857142857142857");
    assert_eq!(spelled(number("25").over(number("2"))), "12.5");
    assert_eq!(spelled(number("0").over(number("7"))), "0");
    assert_eq!(spelled(number("1").over(number("0.000000000000000003"))), "333333333333333333.3");
    assert_eq!(
        spelled(number("0.000000000000000003").over(number("2"))),
        "0.000000000000000002",
        "half to even"
    );
    assert_eq!(spelled(number("0.000000000000000001").over(number("2"))), "0");
    assert_eq!(number("1").over(number("0.00")), Err(Undefined::DivisionByZero));
}

#[test]
fn equal_values_are_equal_however_they_are_written() {
    assert_eq!(number("2.50"), number("2.5"));
    assert_eq!(number("0.000"), Decimal::ZERO);
    assert!(number("2.51") > number("2.5"));
    assert!(number("-2.51") < number("-2.5"));
    assert_eq!(number("9000000000000000000").compare(number("0.000000000000000001")), Ordering::Greater);
    assert_eq!(number("0.000000000000000001").compare(number("9000000000000000000")), Ordering::Less);
    assert_eq!(number("-9000000000000000000").compare(number("0.000000000000000001")), Ordering::Less);
    assert_eq!(number("0.000000000000000001").compare(number("-9000000000000000000")), Ordering::Greater);
}

#[test]
fn the_remainder_has_the_sign_of_what_is_divided() {
    assert_eq!(spelled(number("27").modulo(number("20"))), "7");
    assert_eq!(spelled(number("-7").modulo(number("3"))), "-1");
    assert_eq!(spelled(number("7").modulo(number("-3"))), "1");
    assert_eq!(spelled(number("1").modulo(number("0.3"))), "0.1");
    assert_eq!(
        spelled(number("9000000000000000000").modulo(number("0.000000000000000007"))),
        "0.000000000000000002"
    );
    assert_eq!(number("1").modulo(number("0.0")), Err(Undefined::DivisionByZero));
}

#[test]
fn rounding_takes_halves_away_from_nought() {
    let round = |text, rounding, decimals| spelled(number(text).rounded(rounding, decimals));
    assert_eq!(round("2.5", Rounding::Nearest, 0), "3");
    assert_eq!(round("-2.5", Rounding::Nearest, 0), "-3");
    assert_eq!(round("2.49", Rounding::Nearest, 0), "2");
    assert_eq!(round("1.00333", Rounding::Nearest, 4), "1.0033");
    assert_eq!(round("3.54", Rounding::Down, 0), "3");
    assert_eq!(round("-3.54", Rounding::Down, 0), "-3");
    assert_eq!(round("3.1", Rounding::Up, 0), "4");
    assert_eq!(round("-3.1", Rounding::Up, 0), "-4");
    assert_eq!(round("3.00", Rounding::Up, 0), "3");
    assert_eq!(round("9.223372036854775807", Rounding::Up, 0), "10");
    assert_eq!(number("2.5").at_decimals(0), Some(3));
    assert_eq!(number("-0.0005").at_decimals(3), Some(-1));
    assert_eq!(number("25").at_decimals(3), Some(25_000));
    assert_eq!(number("9223372036854775.807").at_decimals(4), None);
    assert_eq!(number("0.00").at_decimals(200), Some(0));
    assert_eq!(number("1").at_decimals(200), None);
}

#[test]
fn whole_numbers_are_known_as_such() {
    assert_eq!(number("3.000").as_whole(), Some(3));
    assert_eq!(number("-3.000").as_whole(), Some(-3));
    assert_eq!(number("3.001").as_whole(), None);
    assert_eq!(Decimal::whole(-7).as_whole(), Some(-7));
    assert_eq!(number("9.223372036854775807").as_whole(), None);
}

#[test]
fn roots_that_have_an_end_are_exact() {
    for (of, root) in [
        ("9", "3"),
        ("0.25", "0.5"),
        ("40000", "200"),
        ("1.5625", "1.25"),
        ("0.000000000000000001", "0.000000001"),
        ("9000000000000000000", "3000000000"),
        ("152415765279684.0", "12345678"),
        ("0", "0"),
        ("2", "1.414213562373095"),
        ("3", "1.732050807568877"),
        ("39304", "198.25236442474022"),
        ("0.000000000000000002", "0.000000001414214"),
    ] {
        assert_eq!(spelled(function(Function::Root, of)), root, "SQRT[{of}]");
    }
}

#[test]
fn a_root_of_nearly_nothing_is_nothing_and_of_less_an_error() {
    assert_eq!(spelled(function(Function::Root, "-0.000000000001")), "0");
    assert_eq!(spelled(function(Function::Root, "-0.000000000999999999")), "0");
    for of in ["-0.000000001", "-1"] {
        assert_eq!(function(Function::Root, of), Err(Undefined::RootOfNegative(of.into())));
    }
}

#[test]
fn sines_and_cosines_of_whole_parts_of_a_turn_are_exact() {
    for (angle, sine, cosine) in [
        ("0", "0", "1"),
        ("30", "0.5", "0.866025403784439"),
        ("45", "0.707106781186548", "0.707106781186548"),
        ("60", "0.866025403784439", "0.5"),
        ("90", "1", "0"),
        ("120.0", "0.866025403784439", "-0.5"),
        ("150", "0.5", "-0.866025403784439"),
        ("180", "0", "-1"),
        ("210", "-0.5", "-0.866025403784439"),
        ("270", "-1", "0"),
        ("300", "-0.866025403784439", "0.5"),
        ("360", "0", "1"),
        ("-30", "-0.5", "0.866025403784439"),
        ("-90", "-1", "0"),
        ("36000000000000030", "0.5", "0.866025403784439"),
        ("9.223372036854775807", "0.160283846012897", "0.987070964372529"),
        ("0.000000000000000001", "0", "1"),
    ] {
        assert_eq!(spelled(function(Function::Sine, angle)), sine, "SIN[{angle}]");
        assert_eq!(spelled(function(Function::Cosine, angle)), cosine, "COS[{angle}]");
    }
}

#[test]
fn a_tangent_is_exact_at_whole_eighths_and_missing_at_right_angles() {
    for (angle, tangent) in [
        ("0", "0"),
        ("45", "1"),
        ("135", "-1"),
        ("225", "1"),
        ("-45", "-1"),
        ("180", "0"),
        ("60", "1.73205080756888"),
        ("30", "0.577350269189626"),
        ("120", "-1.73205080756888"),
        ("-89.999", "-57295.7795072646"),
    ] {
        assert_eq!(spelled(function(Function::Tangent, angle)), tangent, "TAN[{angle}]");
    }
    for angle in ["90", "270", "-90", "450"] {
        assert_eq!(function(Function::Tangent, angle), Err(Undefined::TangentOf(angle.into())));
    }
}

#[test]
fn inverse_functions_give_degrees() {
    for (of, sine, cosine) in [
        ("0", "0", "90"),
        ("0.5", "30", "60"),
        ("1", "90", "0"),
        ("-0.5", "-30", "120"),
        ("-1", "-90", "180"),
        ("0.8", "53.130102354156", "36.869897645844"),
        // Beyond the digits of an f64: the angle of 1e-18 missing is not nothing.
        ("0.999999999999999999", "89.999999918971532", "0.000000081028468"),
    ] {
        assert_eq!(spelled(function(Function::ArcSine, of)), sine, "ASIN[{of}]");
        assert_eq!(spelled(function(Function::ArcCosine, of)), cosine, "ACOS[{of}]");
    }
    assert_eq!(function(Function::ArcSine, "1.001"), Err(Undefined::ArcOf("ASIN", "1.001".into())));
    assert_eq!(function(Function::ArcCosine, "-2"), Err(Undefined::ArcOf("ACOS", "-2".into())));
    assert_eq!(spelled(function(Function::ArcTangent, "1")), "45");
    assert_eq!(spelled(function(Function::ArcTangent, "-1")), "-45");
    assert_eq!(spelled(function(Function::ArcTangent, "0")), "0");
}

#[test]
fn the_angle_of_a_direction_goes_once_round() {
    for (y, x, angle) in [
        ("1", "1", "45"),
        ("0", "1", "0"),
        ("1", "0", "90"),
        ("1", "-1", "135"),
        ("0", "-1", "180"),
        ("-1", "-1", "225"),
        ("-1", "0", "270"),
        ("-1", "1", "315"),
        ("0.10", "0.1", "45"),
        ("3", "4", "36.869897645844"),
        ("4", "3", "53.130102354156"),
        ("-0.000000000000000001", "1", "0"),
    ] {
        assert_eq!(spelled(number(y).arc_tangent(number(x))), angle, "ATAN[{y}]/[{x}]");
    }
    assert_eq!(number("0").arc_tangent(number("0")), Err(Undefined::DivisionByZero));
}

#[test]
fn growth_and_its_inverse_are_right_to_fifteen_digits() {
    assert_eq!(spelled(function(Function::Exponential, "0")), "1");
    assert_eq!(spelled(function(Function::Exponential, "1")), "2.71828182845905");
    assert_eq!(spelled(function(Function::Exponential, "-1")), "0.367879441171442");
    assert_eq!(spelled(function(Function::Exponential, "40.5")), "388084696243620000");
    assert_eq!(function(Function::Exponential, "44"), Err(Undefined::TooLarge));
    assert_eq!(spelled(function(Function::Exponential, "-1000")), "0");
    assert_eq!(spelled(function(Function::Logarithm, "1")), "0");
    assert_eq!(spelled(function(Function::Logarithm, "10")), "2.30258509299405");
    assert_eq!(spelled(function(Function::Logarithm, "1.000000000000001")), "0.000000000000001");
    assert_eq!(function(Function::Logarithm, "0"), Err(Undefined::LogarithmOf("0".into())));
    assert_eq!(function(Function::Logarithm, "-2.50"), Err(Undefined::LogarithmOf("-2.5".into())));
}

#[test]
fn whole_powers_are_exact_while_the_digits_hold() {
    for (base, exponent, power) in [
        ("2", "10", "1024"),
        ("1.1", "2", "1.21"),
        ("-2", "3", "-8"),
        ("-1.50", "2.0", "2.25"),
        ("2", "-3", "0.125"),
        ("10", "-18", "0.000000000000000001"),
        ("0.5", "-3", "8"),
        ("7", "0", "1"),
        ("0", "3", "0"),
        ("2", "0.5", "1.4142135623731"),
        ("1.1", "20", "6.72749994932560"),
        ("1.000001", "1000000", "2.71828046931938"),
        ("-1.000001", "1000001", "-2.71828318759985"),
        ("0.1", "40", "0"),
        ("8", "0.333333333333333333", "2"),
    ] {
        let spelling = number(power).text();
        assert_eq!(spelled(number(base).power(number(exponent))), spelling, "POW[{base},{exponent}]");
    }
    assert_eq!(number("10").power(number("19")), Err(Undefined::TooLarge));
    assert_eq!(number("-8").power(number("0.5")), Err(Undefined::PowerOf("-8".into(), "0.5".into())));
    assert_eq!(number("0").power(number("-1")), Err(Undefined::PowerOf("0".into(), "-1".into())));
}

#[test]
fn bits_and_codes_are_of_whole_numbers_from_nought() {
    assert_eq!(spelled(number("12").bits(Bits::And, number("10.0"))), "8");
    assert_eq!(spelled(number("12").bits(Bits::Or, number("10"))), "14");
    assert_eq!(spelled(number("12").bits(Bits::Xor, number("10"))), "6");
    assert_eq!(number("1.5").bits(Bits::Xor, number("1")), Err(Undefined::NotBits("XOR", "1.5".into())));
    assert_eq!(number("1").bits(Bits::And, number("-1")), Err(Undefined::NotBits("AND", "-1".into())));
    assert_eq!(spelled(function(Function::ToBcd, "39")), "57");
    assert_eq!(spelled(function(Function::FromBcd, "57.0")), "39");
    assert!(
        matches!(function(Function::FromBcd, "58.5"), Err(Undefined::CodeOf("BIN", of, _)) if of == "58.5")
    );
}

#[test]
fn numbers_are_spelled_in_their_fewest_digits() {
    for (written, spelled) in
        [("25.", "25"), ("0.020", "0.02"), ("-0.0", "0"), ("-0.50", "-0.5"), ("1000", "1000")]
    {
        assert_eq!(number(written).text(), spelled);
    }
    assert_eq!(format!("{:>6}|{:<6}", number("-0.50"), number("2")), "  -0.5|2     ");
}

#[test]
fn binary_approximations_do_not_depend_on_how_a_number_is_written() {
    assert_eq!(number("0.1").approximate(), 0.1);
    assert_eq!(number("-24.98").approximate(), -24.98);
    let (short, long) = (number("900719925474099.1"), number("900719925474099.100"));
    assert_eq!(short.approximate().to_bits(), long.approximate().to_bits());
}

/// Reads a number as it is written.
fn number(text: &str) -> Decimal {
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Decimal::written(text.replace('.', "").parse().unwrap(), decimals as u8)
}

fn function(function: Function, of: &str) -> Result<Decimal, Undefined> {
    number(of).function(function)
}

fn spelled(number: Result<Decimal, Undefined>) -> String {
    number.unwrap().text()
}
