//! Speed of reading G-code, layer by layer, as a Markdown table: `cargo bench --bench gcode`.
//!
//! Nothing is asserted. Other readers of G-code, in the same run: `cargo bench --manifest-path tests/bench/gcode/peers/Cargo.toml`.

#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

#[path = "gcode/measured.rs"]
mod measured;

use std::hint::black_box;

use dripfeed::formats::Writer as _;
use dripfeed::formats::gcode::{Blocks, Boundaries, Dialect, Library, Motions, Writer};
use dripfeed::formats::lines::Lines;
use dripfeed::motion::Act;

use measured::{RUNS, program, row};

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
