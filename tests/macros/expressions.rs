//! A hundred thousand random expressions against an evaluator of the test's own.
//!
//! Expressions are grown as trees, evaluated here exactly (whole numbers of 10⁻ⁿ in 128 bits), and spelled with as few
//! brackets as the precedence of the manuals leaves: functions, then `*` `/` `AND` `MOD`, then `+` `-` `OR` `XOR`, each from
//! left to right (Fanuc B-63684EN/01, page 254; the place of MOD is unverified). Leaves and trees are kept so small that
//! every result is exact; what is rounded is judged elsewhere.

use std::fmt::Write as _;

use crate::spelling::made;

const EXPRESSIONS: usize = 100_000;
const BATCH: usize = 1_000;

/// `mantissa / 10^scale`.
#[derive(Clone, Copy, Debug)]
struct Exact {
    mantissa: i128,
    scale: u32,
}

impl Exact {
    fn at(self, scale: u32) -> i128 {
        self.mantissa * 10i128.pow(scale - self.scale)
    }

    fn with(self, other: Self, of: impl Fn(i128, i128) -> i128) -> Self {
        let scale = self.scale.max(other.scale);
        Self { mantissa: of(self.at(scale), other.at(scale)), scale }
    }

    /// To a whole number: `up` of the fraction decides by its distance.
    fn whole(self, up: impl Fn(i128, i128) -> bool) -> Self {
        let one = 10i128.pow(self.scale);
        let (size, sign) = (self.mantissa.abs(), self.mantissa.signum());
        Self { mantissa: sign * (size / one + i128::from(up(size % one, one))), scale: 0 }
    }

    fn spelled(self) -> String {
        let (mut mantissa, mut scale) = (self.mantissa, self.scale);
        while scale > 0 && mantissa % 10 == 0 {
            (mantissa, scale) = (mantissa / 10, scale - 1);
        }
        let digits = format!("{:0width$}", mantissa.abs(), width = scale as usize + 1);
        let (whole, behind) = digits.split_at(digits.len() - scale as usize);
        let sign = if mantissa < 0 { "-" } else { "" };
        if behind.is_empty() { format!("{sign}{whole}") } else { format!("{sign}{whole}.{behind}") }
    }
}

/// An expression: its text, its value, how strongly its outermost sign binds (3 binds strongest).
struct Grown {
    text: String,
    value: Exact,
    binds: u8,
}

/// A generator of numbers (xorshift).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % n
    }
}

/// Blanks are free.
fn blank(dice: &mut Dice) -> &'static str {
    if dice.below(5) == 0 { " " } else { "" }
}

/// In brackets where it binds less than is wanted.
fn bound(grown: Grown, least: u8) -> String {
    if grown.binds < least { format!("[{}]", grown.text) } else { grown.text }
}

fn leaf(dice: &mut Dice) -> Grown {
    let (mantissa, scale) = (dice.below(100) as i128, dice.below(3) as u32);
    let value = Exact { mantissa, scale };
    // Written with zeros as people do, or without the one in front.
    let text = match (dice.below(4), scale) {
        (0, 1..) => format!("{}0", value_text(mantissa, scale)),
        (1, 0) => format!("{mantissa}."),
        (2, 1..) => value_text(mantissa, scale).trim_start_matches('0').to_owned(),
        _ => value_text(mantissa, scale),
    };
    Grown { text, value, binds: 3 }
}

fn value_text(mantissa: i128, scale: u32) -> String {
    let digits = format!("{mantissa:0width$}", width = scale as usize + 1);
    let (whole, behind) = digits.split_at(digits.len() - scale as usize);
    if behind.is_empty() { whole.to_owned() } else { format!("{whole}.{behind}") }
}

/// A number that is whole and not negative.
fn bits(dice: &mut Dice, leaves: u64) -> Grown {
    if leaves <= 1 {
        let mantissa = dice.below(256) as i128;
        return Grown { text: mantissa.to_string(), value: Exact { mantissa, scale: 0 }, binds: 3 };
    }
    let left = 1 + dice.below(leaves - 1);
    let (a, b) = (bits(dice, left), bits(dice, leaves - left));
    let (x, y) = (a.value.mantissa, b.value.mantissa);
    let (sign, value, binds) = match dice.below(3) {
        0 => ("AND", x & y, 2),
        1 => ("OR", x | y, 1),
        _ => ("XOR", x ^ y, 1),
    };
    let text = format!("{}{}{sign}{}{}", bound(a, binds), blank(dice), blank(dice), bound(b, binds + 1));
    Grown { text, value: Exact { mantissa: value, scale: 0 }, binds }
}

fn grow(dice: &mut Dice, leaves: u64) -> Grown {
    if leaves <= 1 {
        return leaf(dice);
    }
    let kind = dice.below(12);
    if kind < 7 {
        let left = 1 + dice.below(leaves - 1);
        let (a, b) = (grow(dice, left), grow(dice, leaves - left));
        let (sign, value, binds) = match kind {
            0..=2 => ('+', a.value.with(b.value, |a, b| a + b), 1),
            3..=4 => ('-', a.value.with(b.value, |a, b| a - b), 1),
            _ => {
                let mantissa = a.value.mantissa * b.value.mantissa;
                ('*', Exact { mantissa, scale: a.value.scale + b.value.scale }, 2)
            }
        };
        let text = format!("{}{}{sign}{}{}", bound(a, binds), blank(dice), blank(dice), bound(b, binds + 1));
        return Grown { text, value, binds };
    }
    let inner = grow(dice, leaves - 1);
    let function =
        |name: &str, inner: Grown, value| Grown { text: format!("{name}[{}]", inner.text), value, binds: 3 };
    match kind {
        // By what leaves no remainder: a half, a quarter, a fifth.
        7 => {
            let (by, times, scale) = [(2, 5, 1), (4, 25, 2), (5, 2, 1)][dice.below(3) as usize];
            let value = Exact { mantissa: inner.value.mantissa * times, scale: inner.value.scale + scale };
            Grown { text: format!("{}/{}{by}", bound(inner, 2), blank(dice)), value, binds: 2 }
        }
        8 => {
            let value = Exact { mantissa: inner.value.mantissa.abs(), ..inner.value };
            function("ABS", inner, value)
        }
        9 => {
            let value = inner.value.whole(|rest, one| 2 * rest >= one);
            function("ROUND", inner, value)
        }
        10 => {
            let is_up = dice.below(2) == 1;
            let value = inner.value.whole(|rest, _| is_up && rest > 0);
            function(if is_up { "FUP" } else { "FIX" }, inner, value)
        }
        // The root of a square, the sine of a right angle and the like.
        _ => {
            let square = dice.below(2) == 1;
            if square {
                let (side, scale) = (dice.below(1000) as i128, dice.below(2) as u32);
                let text = format!("SQRT[{}]", value_text(side * side, 2 * scale));
                Grown { text, value: Exact { mantissa: side, scale }, binds: 3 }
            } else {
                let (text, mantissa, scale) = [
                    ("SIN[30]", 5, 1),
                    ("COS[60.]", 5, 1),
                    ("SIN[90]", 1, 0),
                    ("COS[180]", -1, 0),
                    ("ATAN[1]/[1]", 45, 0),
                    ("TAN[45]", 1, 0),
                ][dice.below(6) as usize];
                Grown { text: text.to_owned(), value: Exact { mantissa, scale }, binds: 3 }
            }
        }
    }
}

fn letters(text: &str, dice: &mut Dice) -> String {
    if dice.below(4) == 0 { text.to_lowercase() } else { text.to_owned() }
}

#[test]
fn a_hundred_thousand_expressions_come_to_what_they_say() {
    let mut dice = Dice(0x5EED_0FD1_2EA3_B711);
    let mut signs = [0usize; 6];
    for batch in 0..EXPRESSIONS / BATCH {
        let (mut program, mut grown) = (String::new(), Vec::new());
        for _ in 0..BATCH {
            let leaves = 1 + dice.below(6);
            let one = if dice.below(6) == 0 { bits(&mut dice, leaves) } else { grow(&mut dice, leaves) };
            for (count, sign) in signs.iter_mut().zip(["+", "*", "XOR", "[", "FUP", "ATAN"]) {
                *count += usize::from(one.text.contains(sign));
            }
            let text = letters(&one.text, &mut dice);
            // In an address, or through a variable; ROUND in an address is another function: see the conformance table.
            if dice.below(2) == 0 && !one.text.contains("ROUND") {
                writeln!(program, "X[{text}]").unwrap();
            } else {
                writeln!(program, "#100={text}\nX#100").unwrap();
            }
            grown.push(one);
        }
        let made = made(&program);
        let made: Vec<&str> = made.split("; ").collect();
        assert_eq!(made.len(), BATCH, "batch {batch}: {}", made.last().unwrap());
        for (one, made) in grown.iter().zip(made) {
            assert_eq!(made, format!("X{}", one.value.spelled()), "{}", one.text);
        }
    }
    assert!(signs.iter().all(|count| *count > 500), "not enough of each: {signs:?}");
}

/// The oracle itself, by hand.
#[test]
fn the_evaluator_spells_and_rounds_as_on_paper() {
    let exact = |mantissa, scale| Exact { mantissa, scale };
    assert_eq!(exact(-50, 2).spelled(), "-0.5");
    assert_eq!(exact(0, 3).spelled(), "0");
    assert_eq!(exact(-25, 1).whole(|rest, one| 2 * rest >= one).spelled(), "-3");
    assert_eq!(exact(21, 1).whole(|rest, _| rest > 0).spelled(), "3");
}
