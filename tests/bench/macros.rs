//! Speed of macro expansion, as a Markdown table: `cargo bench --bench macros`.
//!
//! Nothing is asserted. The peers run in the same run where they are installed: `rs274` (Debian's linuxcnc-uspace), which
//! speaks another dialect of macros, and a generator in Python; and what one would write by hand in Rust.

#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]
#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::Instant;

use dripfeed::macros::binary::Binary;
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::expanded::{Expanded, Step};
use dripfeed::macros::form::Form;
use dripfeed::macros::number::Number;
use dripfeed::macros::options::Options;
use dripfeed::macros::printer::Printer;
use dripfeed::macros::program::{NoPrograms, Program};

const BLOCKS: u64 = 2_000_000;
const RUNS: usize = 5;

/// Three assignments, two roots, one block: the loop of the 2009 paper, with a step for two million blocks.
const PROGRAM: &str = "\
#110=0.0000035
#101=7
WHILE[#101GT0]DO1
#101=#101-#110
#102=SQRT[49-#101*#101]+20
#103=SQRT[40000-#101*#101]
G01 X[#101] Y[#102] Z[#103] F200
END1
";

/// The same for `rs274`.
const RS274: &str = "\
#110=0.0000035
#101=7
o1 while [#101 GT 0]
#101=[#101-#110]
#102=[SQRT[ABS[49-#101*#101]]+20]
#103=SQRT[40000-#101*#101]
G01 X[#101] Y[#102] Z[#103] F200
o1 endwhile
M2
";

/// The same in Python.
const PYTHON: &str = "
import sys, math
x, d, out = 7.0, 0.0000035, sys.stdout
while x > 0:
    x -= d
    print(f'G01 X{x:.3f} Y{math.sqrt(abs(49 - x * x)) + 20:.3f} Z{math.sqrt(40000 - x * x):.3f} F200')
";

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench macros`");
        return;
    }
    let program = Arc::new(Program::parse(PROGRAM.as_bytes(), &mut NoPrograms, &Options::default()).unwrap());
    println!("{BLOCKS} blocks of a loop of three assignments with two roots\n");
    println!("| what | million blocks/s, median of {RUNS} | lowest - highest |\n|---|---|---|");
    row("expanded and spelled, decimal", || expanded::<Decimal>(&program));
    row("expanded and spelled, binary floating point", || expanded::<Binary>(&program));
    row("run over (`--from-block`), decimal", || skipped::<Decimal>(&program));
    row("by hand in Rust: `{:.3}` of f64", by_hand);
    let directory = std::env::temp_dir().join(format!("dripfeed-bench-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let rs274 = directory.join("loop.ngc");
    std::fs::write(&rs274, RS274).unwrap();
    row("peer: rs274, interpreted and its motions printed", || {
        peer(Command::new("rs274").arg("-g").arg(&rs274))
    });
    row("peer: a generator in Python", || peer(Command::new("python3").arg("-c").arg(PYTHON)));
    let _ = std::fs::remove_dir_all(&directory);
}

fn expanded<N: Number>(program: &Arc<Program>) -> Option<u64> {
    let mut lines = Expanded::<N>::new(Arc::clone(program), Printer::new(Form::default(), false));
    let mut text = Vec::with_capacity(1 << 16);
    loop {
        match lines.next_line(u32::MAX, &mut text).unwrap() {
            Step::End => return Some(lines.blocks()),
            _ => text.push(b'\n'),
        }
        if text.len() > 60_000 {
            black_box(&text);
            text.clear();
        }
    }
}

fn skipped<N: Number>(program: &Arc<Program>) -> Option<u64> {
    let mut lines = Expanded::<N>::new(Arc::clone(program), Printer::new(Form::default(), false));
    let (mut blocks, mut scratch) = (u64::MAX, Vec::new());
    while lines.skip(&mut blocks, u32::MAX, &mut scratch).unwrap() != Step::End {}
    Some(lines.blocks())
}

fn by_hand() -> Option<u64> {
    let (mut x, step) = (black_box(7.0f64), black_box(0.000_003_5));
    let (mut text, mut blocks) = (String::with_capacity(1 << 16), 0);
    while x > 0.0 {
        x -= step;
        let (y, z) = ((49.0 - x * x).abs().sqrt() + 20.0, (40_000.0 - x * x).sqrt());
        writeln!(text, "G01 X{x:.3} Y{y:.3} Z{z:.3} F200").unwrap();
        blocks += 1;
        if text.len() > 60_000 {
            black_box(&text);
            text.clear();
        }
    }
    Some(blocks)
}

/// Runs a program with its output thrown away; none where it is not there.
fn peer(command: &mut Command) -> Option<u64> {
    let status = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success()).then_some(BLOCKS)
}

fn row(name: &str, mut run: impl FnMut() -> Option<u64>) {
    let mut speeds = Vec::new();
    for _ in 0..RUNS {
        let start = Instant::now();
        let Some(blocks) = run() else {
            println!("| {name} | not installed | |");
            return;
        };
        speeds.push(blocks as f64 / start.elapsed().as_secs_f64() / 1e6);
    }
    speeds.sort_by(f64::total_cmp);
    println!("| {name} | {:.2} | {:.2} - {:.2} |", speeds[RUNS / 2], speeds[0], speeds[RUNS - 1]);
}
