//! The program that readers of G-code are measured with, and how: 64 MiB in memory, lines and arcs, N numbers, 25 to 35
//! bytes a line. The numbers have at most four digits: a peer refuses longer ones.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

pub(crate) const RUNS: usize = 5;
const PROGRAM_BYTES: usize = 64 << 20;

/// One layer; an argument on the command line chooses those whose name holds it.
pub(crate) fn row(what: &str, program: &str, mut work: impl FnMut(&str) -> u64) {
    if std::env::args().skip(1).any(|chosen| !chosen.starts_with('-') && !what.contains(&chosen)) {
        return;
    }
    let mut rates: Vec<f64> = (0..RUNS)
        .map(|_| {
            let began = Instant::now();
            black_box(work(program));
            program.len() as f64 / began.elapsed().as_secs_f64() / 1e6
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    println!("| {what} | {:.0} | {:.0} - {:.0} |", rates[RUNS / 2], rates[0], rates[RUNS - 1]);
}

/// Steps round the origin, three lines and an arc in turn.
pub(crate) fn program() -> String {
    let mut text = String::with_capacity(PROGRAM_BYTES + 64);
    text.push_str("%\nO1000\nN1 G21 G90 G92 X0. Y0.\n");
    let mut at = (0i64, 0i64);
    let mut n = 10u64;
    let millimetres =
        |um: i64| format!("{}{}.{:03}", if um < 0 { "-" } else { "" }, um.abs() / 1000, um.abs() % 1000);
    while text.len() < PROGRAM_BYTES {
        let step = n as i64;
        if n.is_multiple_of(40) {
            let r = 1000 + step % 3000;
            let sign = if at.0 > 0 { -1 } else { 1 };
            at.0 += sign * 2 * r;
            writeln!(
                text,
                "N{} G02 X{} Y{} I{} J0.",
                n % 10_000,
                millimetres(at.0),
                millimetres(at.1),
                millimetres(sign * r)
            )
            .unwrap();
        } else {
            at = ((step * 7919) % 61_000 - 30_000, (step * 104_729) % 41_000 - 20_000);
            writeln!(text, "N{} G01 X{} Y{}", n % 10_000, millimetres(at.0), millimetres(at.1)).unwrap();
        }
        n += 10;
    }
    text.push_str("M02\n%\n");
    text
}
