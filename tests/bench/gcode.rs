//! Speed of reading G-code, layer by layer, as a Markdown table: `cargo bench --bench gcode`.
//!
//! The program is made in memory: lines and arcs, N numbers, 25 to 35 bytes a line. Nothing is asserted.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use dripfeed::formats::Writer as _;
use dripfeed::formats::gcode::{Blocks, Boundaries, Dialect, Library, Motions, Writer};
use dripfeed::formats::lines::Lines;
use dripfeed::motion::Act;

const RUNS: usize = 5;
const PROGRAM_BYTES: usize = 64 << 20;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench gcode`");
        return;
    }
    let program = program();
    let dialect = Dialect::generic().unwrap();
    let blocks = Boundaries::new(program.as_bytes(), &dialect).last().unwrap().unwrap().block;
    println!(
        "{} bytes, {blocks} blocks, {:.1} bytes a block\n",
        program.len(),
        program.len() as f64 / blocks as f64
    );
    println!("| what | MB/s, median of {RUNS} | lowest - highest |\n|---|---|---|");
    row("bytes copied (what memory allows)", &program, |text| {
        let mut chunk = [0u8; 1 << 16];
        text.as_bytes()
            .chunks(chunk.len())
            .map(|c| {
                chunk[..c.len()].copy_from_slice(c);
                u64::from(black_box(&chunk)[0])
            })
            .sum()
    });
    row("lines", &program, |text| {
        let mut lines = Lines::new(text.as_bytes());
        let mut count = 0;
        while let Some(line) = lines.next_line().unwrap() {
            count += black_box(line).bytes.len() as u64;
        }
        count
    });
    row("boundaries: blocks and N numbers", &program, |text| {
        let mut boundaries = Boundaries::new(text.as_bytes(), &dialect);
        let mut sum = 0;
        while let Some(boundary) = boundaries.next_boundary().unwrap() {
            sum += u64::from(black_box(boundary).label.unwrap_or(0));
        }
        sum
    });
    row("blocks: words, places, modal state", &program, |text| {
        let mut blocks = Blocks::new(text.as_bytes(), &dialect);
        let mut count = 0;
        while let Some(block) = blocks.next_block().unwrap() {
            count += black_box(block).words.len() as u64;
        }
        count
    });
    row("motions", &program, |text| {
        Motions::new(text.as_bytes(), dialect.clone())
            .map(|m| u64::from(matches!(black_box(m.unwrap()).act, Act::Move { .. })))
            .sum()
    });
    row("index of subprograms", &program, |text| {
        black_box(Library::index(&mut std::io::Cursor::new(text), &dialect).unwrap());
        1
    });
    row("motions, read and written again", &program, |text| {
        let mut writer = Writer::new(dialect.clone());
        let (mut out, mut count) = (Vec::new(), 0);
        for motion in Motions::new(text.as_bytes(), dialect.clone()) {
            writer.write(&motion.unwrap(), &mut out).unwrap();
            count += out.len() as u64;
            out.clear();
        }
        count
    });
}

/// One layer; an argument on the command line chooses those whose name holds it.
fn row(what: &str, program: &str, mut work: impl FnMut(&str) -> u64) {
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
fn program() -> String {
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
                n % 100_000,
                millimetres(at.0),
                millimetres(at.1),
                millimetres(sign * r)
            )
            .unwrap();
        } else {
            at = ((step * 7919) % 61_000 - 30_000, (step * 104_729) % 41_000 - 20_000);
            writeln!(text, "N{} G01 X{} Y{}", n % 100_000, millimetres(at.0), millimetres(at.1)).unwrap();
        }
        n += 10;
    }
    text.push_str("M02\n%\n");
    text
}
