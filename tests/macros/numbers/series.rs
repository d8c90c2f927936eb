//! The functions once more, by series in whole numbers: fixed point of 70 decimals, nothing of it from `libm`.
//!
//! Slow and plain. Each function is checked against what is known of it, and against another, at the end of the file.

use num::{BigInt, BigRational, One as _, Signed as _, Zero as _};

use super::exact::{fraction, ten_to};

/// The decimals that are counted with; the last ten of them may be wrong.
const DECIMALS: u32 = 70;

/// A number in fixed point.
#[derive(Clone, Debug, Eq, PartialEq, PartialOrd)]
pub(crate) struct Fixed(BigInt);

impl Fixed {
    pub(crate) fn of(value: &BigRational) -> Self {
        Self((value * ten_to(DECIMALS)).round().to_integer())
    }

    fn whole(value: i64) -> Self {
        Self(ten_to(DECIMALS) * value)
    }

    pub(crate) fn value(&self) -> BigRational {
        fraction(self.0.clone(), DECIMALS)
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        Self(&self.0 * &other.0 / ten_to(DECIMALS))
    }

    pub(crate) fn over(&self, other: &Self) -> Self {
        Self(&self.0 * ten_to(DECIMALS) / &other.0)
    }

    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 + &other.0)
    }

    fn minus(&self, other: &Self) -> Self {
        Self(&self.0 - &other.0)
    }

    fn root(&self) -> Self {
        Self((&self.0 * ten_to(DECIMALS)).sqrt())
    }

    /// `first` and what follows from it: term `n` is the one before times `factor` over `divisor(n)`.
    fn series(first: Self, factor: &Self, divisor: impl Fn(i64) -> i64) -> Self {
        let (mut sum, mut term, mut n) = (first.clone(), first, 1);
        while !term.0.is_zero() {
            term = Self(term.times(factor).0 / divisor(n));
            sum = sum.plus(&term);
            n += 1;
        }
        sum
    }
}

/// π = 16 atan(1/5) - 4 atan(1/239) (Machin).
pub(crate) fn pi() -> Fixed {
    let arc = |n: i64| arc_series(&Fixed::whole(1).over(&Fixed::whole(n)));
    Fixed(arc(5).0 * 16 - arc(239).0 * 4)
}

/// The arc of a tangent well below 1: x - x³/3 + x⁵/5 - …
fn arc_series(x: &Fixed) -> Fixed {
    let square = x.times(x);
    let (mut sum, mut power, mut n) = (x.clone(), x.clone(), 1);
    while !power.0.is_zero() {
        power = Fixed(-power.times(&square).0);
        n += 2;
        sum = sum.plus(&Fixed(&power.0 / n));
    }
    sum
}

/// Radians of degrees, whole turns left out.
fn radians(degrees: &BigRational) -> Fixed {
    let turn = fraction(360, 0);
    let rest = degrees - (degrees / &turn).trunc() * &turn;
    Fixed::of(&rest).times(&pi()).over(&Fixed::whole(180))
}

pub(crate) fn sine(degrees: &BigRational) -> Fixed {
    let x = radians(degrees);
    let square = Fixed(-x.times(&x).0);
    Fixed::series(x, &square, |n| 2 * n * (2 * n + 1))
}

pub(crate) fn cosine(degrees: &BigRational) -> Fixed {
    let x = radians(degrees);
    let square = Fixed(-x.times(&x).0);
    Fixed::series(Fixed::whole(1), &square, |n| 2 * n * (2 * n - 1))
}

/// Degrees from -90 to 90: halved until the series is quick.
pub(crate) fn arc_tangent(of: &Fixed) -> Fixed {
    let (mut x, mut halvings) = (of.clone(), 0);
    while x.0.abs() > ten_to(DECIMALS - 2) {
        // tan(a/2) = t / (1 + sqrt(1 + t²))
        x = x.over(&Fixed::whole(1).plus(&Fixed::whole(1).plus(&x.times(&x)).root()));
        halvings += 1;
    }
    let arc = Fixed(arc_series(&x).0 << halvings);
    arc.times(&Fixed::whole(180)).over(&pi())
}

/// Degrees from -90 to 90, of -1 to 1.
pub(crate) fn arc_sine(of: &BigRational) -> Fixed {
    let missing = Fixed::of(&(BigRational::one() - of * of)).root();
    if missing.0.is_zero() {
        return Fixed(Fixed::whole(90).0 * of.numer().signum());
    }
    arc_tangent(&Fixed::of(of).over(&missing))
}

/// Degrees from 0 up to 360, of a direction.
pub(crate) fn direction(x: &BigRational, y: &BigRational) -> Fixed {
    let acute = if x.is_zero() { Fixed::whole(90) } else { arc_tangent(&Fixed::of(&(y / x).abs())) };
    match (x.is_negative(), y.is_negative()) {
        (false, false) => acute,
        (true, false) => Fixed::whole(180).minus(&acute),
        (true, true) => Fixed::whole(180).plus(&acute),
        (false, true) => Fixed::whole(360).minus(&acute),
    }
}

/// Of an argument a 2^16th of what is asked, squared 16 times; of 1/e^x where that is negative, to keep the digits.
pub(crate) fn exponential(of: &Fixed) -> Fixed {
    if of.0.is_negative() {
        return Fixed::whole(1).over(&exponential(&Fixed(-&of.0)));
    }
    let small = Fixed(&of.0 >> 16);
    let mut power = Fixed::series(Fixed::whole(1), &small, |n| n);
    for _ in 0..16 {
        power = power.times(&power);
    }
    power
}

/// By roots until it is near 1, then ln y = 2 (z + z³/3 + z⁵/5 + …) with z = (y - 1)/(y + 1).
pub(crate) fn logarithm(of: &BigRational) -> Fixed {
    let (mut y, mut roots) = (Fixed::of(of), 0);
    while y.minus(&Fixed::whole(1)).0.abs() > ten_to(DECIMALS - 2) {
        y = y.root();
        roots += 1;
    }
    let z = y.minus(&Fixed::whole(1)).over(&y.plus(&Fixed::whole(1)));
    let square = z.times(&z);
    let (mut sum, mut power, mut n) = (z.clone(), z, 1);
    while !power.0.is_zero() {
        power = power.times(&square);
        n += 2;
        sum = sum.plus(&Fixed(&power.0 / n));
    }
    Fixed(sum.0 << (roots + 1))
}

#[test]
fn the_series_give_what_is_known() {
    let near = |fixed: &Fixed, text: &str| {
        let difference = (fixed.value() - super::exact::read(text)).abs();
        assert!(difference < fraction(1, 40), "{fixed:?} is not {text}");
    };
    let whole = |n: i64| fraction(n, 0);
    near(&pi(), "3.1415926535897932384626433832795028841971694");
    near(&sine(&whole(-750)), "-0.5");
    near(&cosine(&whole(135)), "-0.7071067811865475244008443621048490392848");
    near(&arc_sine(&whole(-1)), "-90");
    near(&arc_sine(&fraction(5, 1)), "30");
    near(&arc_tangent(&Fixed::whole(-1)), "-45");
    near(&direction(&whole(1), &whole(-1)), "315");
    near(&direction(&whole(-1), &whole(-1)), "225");
    near(&exponential(&Fixed::whole(1)), "2.7182818284590452353602874713526624977572471");
    near(&exponential(&Fixed::whole(-1)), "0.3678794411714423215955237701614608674458111");
    near(&logarithm(&whole(10)), "2.3025850929940456840179914546843642076011015");
    near(&logarithm(&fraction(1, 3)), "-6.9077552789821370520539743640530926228033045");
    near(&arc_tangent(&sine(&whole(37)).over(&cosine(&whole(37)))), "37");
    near(&exponential(&logarithm(&fraction(123_456, 3))), "123.456");
}
