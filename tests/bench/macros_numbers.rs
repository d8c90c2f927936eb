//! Time of the operations a macro counts with, as a Markdown table: `cargo bench --bench macros_numbers`.
//!
//! Nothing is asserted. Every operation is applied to 1024 pairs of numbers read from memory; the last row is a program, the
//! corner of a rounded slot: three assignments and two roots a block, with three lengths made ready for print.

#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]
#![expect(clippy::disallowed_methods, reason = "a benchmark reads a clock")]

use std::hint::black_box;
use std::time::Instant;

use dripfeed::macros::binary::Binary;
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::{Function, Number};

const RUNS: usize = 9;
const PAIRS: usize = 1024;
const ROUNDS: usize = 1000;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench macros_numbers`");
        return;
    }
    println!("| operation | decimal, ns, median of {RUNS} | f64, ns |\n|---|---|---|");
    for ((what, decimal), (_, binary)) in table::<Decimal>().into_iter().zip(table::<Binary>()) {
        println!("| {what} | {decimal:.1} | {binary:.1} |");
    }
}

fn table<N: Number>() -> Vec<(&'static str, f64)> {
    use Function::{Exponential, Root, Sine};
    // As programs have them: lengths up to 200 with 3 decimals, steps with 2, results of functions with 15.
    let length = |n: i64| N::written(n % 200_000 + 1, 3);
    let step = |n: i64| N::written(n % 1_000 + 1, 2);
    let whole = |n: i64| N::whole(n % 50 + 1);
    let result = |n: i64| N::written(n % 1_000_000_000_000_000 + 1, 15);
    vec![
        ("+, as many decimals", time(length, length, |a, b| a.plus(b).unwrap())),
        ("-, other decimals", time(length, step, |a, b| a.minus(b).unwrap())),
        ("+, 15 decimals and 3", time(result, length, |a, b| a.plus(b).unwrap())),
        ("×", time(length, step, |a, b| a.times(b).unwrap())),
        ("×, 15 decimals by 3, rounded", time(result, length, |a, b| a.times(b).unwrap())),
        ("/, with an end", time(length, |_| N::whole(2), |a, b| a.over(b).unwrap())),
        ("/, without one", time(length, step, |a, b| a.over(b).unwrap())),
        ("MOD", time(length, whole, |a, b| a.modulo(b).unwrap())),
        ("GT", time(length, step, |a, b| a.compare(b))),
        ("3 decimals of 15 for print", time(result, whole, |a, _| a.at_decimals(3).unwrap())),
        ("SQRT", time(length, whole, |a, _| a.function(Root).unwrap())),
        ("SIN", time(length, whole, |a, _| a.function(Sine).unwrap())),
        ("EXP", time(step, whole, |a, _| a.function(Exponential).unwrap())),
        ("ATAN[]/[]", time(length, step, |a, b| a.arc_tangent(b).unwrap())),
        ("POW, whole", time(step, whole, |a, _| a.power(N::whole(3)).unwrap())),
        ("a block of the corner", corner::<N>()),
    ]
}

/// Nanoseconds of an operation.
fn time<N: Number, T>(one: impl Fn(i64) -> N, two: impl Fn(i64) -> N, operation: impl Fn(N, N) -> T) -> f64 {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 2) as i64
    };
    let pairs: Vec<(N, N)> = (0..PAIRS).map(|_| (one(random()), two(random()))).collect();
    median(|| {
        for _ in 0..ROUNDS {
            for (one, two) in &pairs {
                black_box(operation(*one, *two));
            }
        }
        PAIRS * ROUNDS
    })
}

/// Nanoseconds of a block of the corner of radius 7 around (20, 20) on a cylinder of radius 200.
fn corner<N: Number>() -> f64 {
    let [step, start, end] = [N::written(2, 2), N::whole(27), N::whole(20)].map(black_box);
    median(|| {
        let mut blocks = 0;
        for _ in 0..1000 {
            let mut x = start;
            while x.compare(end).is_gt() {
                x = x.minus(step).unwrap();
                let out = x.minus(N::whole(20)).unwrap();
                let height = N::whole(49).minus(out.times(out).unwrap()).unwrap();
                let y = height.function(Function::Root).unwrap().plus(N::whole(20)).unwrap();
                let height = N::whole(40_000).minus(x.times(x).unwrap()).unwrap();
                let z = height.function(Function::Root).unwrap();
                black_box([x, y, z].map(|length| length.at_decimals(3)));
                blocks += 1;
            }
        }
        blocks
    })
}

fn median(run: impl Fn() -> usize) -> f64 {
    let mut times: Vec<f64> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            let count = run();
            start.elapsed().as_nanos() as f64 / count as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2]
}
