//! Loops as programs have them: the decimal ones turn as often as their programmer meant, the binary ones as they do.

use dripfeed::macros::binary::Binary;
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::Number;
use num::ToPrimitive as _;

use super::exact::read;

/// What keeps a loop turning.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum While {
    /// Down to the end, which a turn reaches.
    Gt,
    /// Up to the end likewise.
    Lt,
    /// Down, and once more at the end.
    Ge,
    /// Up, and once more at the end.
    Le,
}

use While::{Ge, Gt, Le, Lt};

/// Start, step, condition, end; how often it is meant to turn; how often it turns in doubles, as Python counts them.
const LOOPS: [(&str, &str, While, &str, u64, u64); 35] = [
    ("25", "0.02", Gt, "20", 250, 251),
    ("27", "0.02", Gt, "20", 350, 351),
    ("27", "0.02", Gt, "25", 100, 101),
    ("0", "0.1", Lt, "1", 10, 11),
    ("1", "0.1", Gt, "0", 10, 11),
    ("0", "0.01", Lt, "10", 1000, 1001),
    ("10", "0.01", Gt, "0", 1000, 1001),
    ("0", "0.05", Lt, "3", 60, 61),
    ("0", "0.1", Lt, "360", 3600, 3600),
    ("0", "0.3", Lt, "90", 300, 301),
    ("0", "0.7", Lt, "7", 10, 10),
    ("-5", "0.1", Lt, "5", 100, 101),
    ("5", "0.1", Gt, "-5", 100, 101),
    ("100", "0.05", Gt, "99", 20, 21),
    ("12.7", "0.0254", Gt, "0", 500, 501),
    ("0", "0.001", Lt, "1", 1000, 1000),
    ("50", "0.001", Gt, "49", 1000, 1001),
    ("2.5", "0.025", Gt, "0", 100, 101),
    ("0", "1.1", Lt, "11", 10, 11),
    ("200", "0.015", Gt, "170", 2000, 2001),
    ("0", "0.36", Lt, "360", 1000, 1000),
    ("8", "0.008", Gt, "-8", 2000, 2000),
    ("0", "0.0001", Lt, "1", 10_000, 10_001),
    ("3.3", "0.3", Gt, "0", 11, 12),
    ("0", "0.000001", Lt, "1", 1_000_000, 1_000_000),
    ("7.07", "0.07", Gt, "0", 101, 101),
    ("0.5", "0.125", Gt, "-2", 20, 20),
    ("1000", "0.4", Gt, "960", 100, 101),
    ("0", "0.2", Le, "1", 6, 6),
    ("0", "0.1", Le, "0.3", 4, 3),
    ("0", "0.1", Le, "1", 11, 11),
    ("1", "0.01", Ge, "0", 101, 100),
    ("45", "0.15", Ge, "0", 301, 301),
    ("0", "0.06", Le, "6", 101, 101),
    ("-90", "0.9", Le, "90", 201, 200),
];

#[test]
fn decimal_loops_turn_as_often_as_meant_and_end_on_the_point() {
    for (start, step, until, end, meant, _) in LOOPS {
        let (turns, last) = turns::<Decimal>([start, step, end], until);
        assert_eq!(turns, meant, "{start} by {step} while {until:?} {end}");
        if matches!(until, Gt | Lt) {
            assert_eq!(last, Decimal::written_as(end), "{start} by {step} while {until:?} {end}");
        }
        // And what is meant is what fractions say.
        let spans = ((read(start) - read(end)) / read(step)).to_integer().to_u64_abs();
        assert_eq!(
            meant,
            spans + u64::from(matches!(until, Ge | Le)),
            "{start} by {step} while {until:?} {end}"
        );
    }
}

#[test]
fn binary_loops_overrun_or_miss_the_end_as_binary_controls_do() {
    let mut strayed = 0;
    for (start, step, until, end, meant, in_doubles) in LOOPS {
        let (turns, _) = turns::<Binary>([start, step, end], until);
        assert_eq!(turns, in_doubles, "{start} by {step} while {until:?} {end}");
        strayed += u32::from(turns != meant);
    }
    assert_eq!(strayed, 23);
}

fn turns<N: Number>([start, step, end]: [&str; 3], until: While) -> (u64, N) {
    let [mut x, step, end] = [start, step, end].map(N::written_as);
    let mut turns = 0;
    loop {
        let order = x.compare(end);
        let goes_on = match until {
            Gt => order.is_gt(),
            Lt => order.is_lt(),
            Ge => order.is_ge(),
            Le => order.is_le(),
        };
        if !goes_on {
            return (turns, x);
        }
        x = match until {
            Gt | Ge => x.minus(step),
            Lt | Le => x.plus(step),
        }
        .unwrap();
        turns += 1;
        assert!(turns < 10_000_000, "it does not end");
    }
}

/// A number as a program has it.
trait Written: Number {
    fn written_as(text: &str) -> Self {
        let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        Self::written(text.replace('.', "").parse().unwrap(), decimals as u8)
    }
}

impl<N: Number> Written for N {}

/// The size of a whole number.
trait Size {
    fn to_u64_abs(&self) -> u64;
}

impl Size for num::BigInt {
    fn to_u64_abs(&self) -> u64 {
        self.magnitude().to_u64().unwrap()
    }
}
