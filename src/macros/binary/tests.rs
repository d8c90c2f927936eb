use super::*;

#[test]
fn a_loop_by_hundredths_overruns_as_binary_controls_do() {
    let (mut x, step, end) = (number(25, 0), number(2, 2), number(20, 0));
    let mut turns = 0;
    while x.compare(end).is_gt() {
        x = x.minus(step).unwrap();
        turns += 1;
        if turns == 250 {
            assert_eq!(x.text(), "20.000000000000107");
        }
    }
    assert_eq!((turns, x.at_decimals(3)), (251, Some(19_980)));
}

#[test]
fn functions_are_in_degrees_and_leave_what_doubles_leave() {
    let of = |function, value: Binary| value.function(function).unwrap().approximate();
    assert_eq!(of(Function::Cosine, number(90, 0)), 6.123233995736766e-17);
    assert!((of(Function::Sine, number(30, 0)) - 0.5).abs() < 1e-15);
    assert!((of(Function::Tangent, number(45, 0)) - 1.0).abs() < 1e-15);
    assert_eq!(of(Function::ArcTangent, number(1, 0)), 45.0);
    assert!((of(Function::ArcCosine, number(5, 1)) - 60.0).abs() < 1e-13);
    assert_eq!(of(Function::Root, number(9, 0)), 3.0);
    assert_eq!(of(Function::Root, number(-1, 12)), 0.0);
    assert_eq!(number(-1, 0).arc_tangent(number(1, 0)).unwrap().text(), "315");
    assert_eq!(Binary(-1e-300).arc_tangent(number(1, 0)).unwrap().text(), "0");
    assert_eq!(number(2, 0).power(number(10, 0)).unwrap().text(), "1024");
    assert_eq!(number(-2, 0).power(number(3, 0)).unwrap().text(), "-8");
}

#[test]
fn what_has_no_value_is_refused() {
    let of = |function, value: Binary| value.function(function).map(Binary::text);
    assert_eq!(of(Function::Tangent, number(-270, 0)), Err(Undefined::TangentOf("-270".into())));
    assert_eq!(of(Function::Root, number(-1, 0)), Err(Undefined::RootOfNegative("-1".into())));
    assert_eq!(of(Function::Root, number(-1, 9)), Err(Undefined::RootOfNegative("-0.000000001".into())));
    assert_eq!(of(Function::ArcSine, number(11, 1)), Err(Undefined::ArcOf("ASIN", "1.1".into())));
    assert_eq!(of(Function::Logarithm, number(0, 0)), Err(Undefined::LogarithmOf("0".into())));
    assert_eq!(of(Function::Exponential, number(1000, 0)), Err(Undefined::TooLarge));
    assert_eq!(number(1, 0).over(number(0, 0)), Err(Undefined::DivisionByZero));
    assert_eq!(number(1, 0).modulo(number(0, 0)), Err(Undefined::DivisionByZero));
    assert_eq!(number(0, 0).arc_tangent(number(0, 0)), Err(Undefined::DivisionByZero));
    assert_eq!(number(-8, 0).power(number(5, 1)), Err(Undefined::PowerOf("-8".into(), "0.5".into())));
    assert_eq!(number(0, 0).power(number(-1, 0)), Err(Undefined::PowerOf("0".into(), "-1".into())));
    assert_eq!(number(15, 1).bits(Bits::Or, number(1, 0)), Err(Undefined::NotBits("OR", "1.5".into())));
}

#[test]
fn nought_has_no_sign() {
    for nought in [
        number(0, 0).negated(),
        number(0, 0).times(number(-1, 0)).unwrap(),
        number(-4, 1).rounded(Rounding::Nearest, 0).unwrap(),
        number(-9, 0).modulo(number(3, 0)).unwrap(),
    ] {
        assert_eq!(nought.text(), "0");
    }
}

#[test]
fn rounding_and_printing_take_halves_away_from_nought() {
    let round = |value: Binary, rounding, decimals| value.rounded(rounding, decimals).unwrap().text();
    assert_eq!(round(number(-25, 1), Rounding::Nearest, 0), "-3");
    assert_eq!(round(number(-31, 1), Rounding::Up, 0), "-4");
    assert_eq!(round(number(354, 2), Rounding::Down, 0), "3");
    assert_eq!(round(number(100_333, 5), Rounding::Nearest, 4), "1.0033");
    assert_eq!(round(Binary(1e300), Rounding::Nearest, 18), Binary(1e300).text());
    assert_eq!(number(125, 2).at_decimals(1), Some(13));
    assert_eq!(Binary(1e19).at_decimals(0), None);
    assert_eq!(Binary(9.0e18).as_whole(), Some(9_000_000_000_000_000_000));
    assert_eq!(number(5, 1).as_whole(), None);
    assert_eq!(number(-7, 0).modulo(number(3, 0)).unwrap().text(), "-1");
    assert_eq!(number(57, 0).function(Function::FromBcd).unwrap().text(), "39");
}

fn number(digits: i64, decimals: u8) -> Binary {
    Binary::written(digits, decimals)
}
