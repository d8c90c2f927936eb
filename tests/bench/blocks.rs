//! Speed of reading and writing 3B and 4B, as a Markdown table: `cargo bench --bench blocks`.
//!
//! Programs of about 64 MB in memory; every figure is the median of five runs. Nothing is asserted: machines are noisy.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

use std::hint::black_box;
use std::time::Instant;

use dripfeed::formats::Writer as _;
use dripfeed::formats::three_b::motions::Motions;
use dripfeed::formats::three_b::read::{Item, Reader};
use dripfeed::formats::three_b::write::{Form, Writer};
use dripfeed::formats::{four_b, three_b};
use dripfeed::interpolator::Model;
use dripfeed::part::{Part, aim_named};
use dripfeed::program::{Generated, Program};
use dripfeed::rounding::Aim;

const RUNS: usize = 5;
const BYTES: usize = 64 << 20;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench blocks`");
        return;
    }
    println!("| what | MB/s, median (lowest - highest) | M blocks/s |\n|---|---|---|");
    let gear = gear();
    read_3b("3B read, the paper's gear", &gear);
    let joined: Vec<u8> = gear.iter().copied().filter(|&b| b != b'\n').collect();
    read_3b("the same run together in one line", &joined);
    let blanks: Vec<u8> = listing(&gear);
    read_3b("the same as a listing: `N 12:`, blanks, `; x, y`", &blanks);
    let four = four_b(&gear);
    row("4B read, the same with R and flag on its arcs", four.len(), || {
        let mut reader = four_b::Reader::new(&four[..]);
        let mut blocks = 0u64;
        while let Some(entry) = reader.next_entry().unwrap() {
            blocks += u64::from(matches!(entry, four_b::Entry::Block(_)));
            black_box(reader.spot());
        }
        blocks
    });
    row("3B to motions", gear.len(), || {
        Motions::of_three_b(&gear[..], Model::Rotated).map(|m| black_box(m.unwrap()).block).max().unwrap()
    });
    for (name, aim) in [("rotated", Aim::One(Model::Rotated)), ("any", Aim::Any)] {
        row(&format!("3B to motions to 3B, `{name}`"), gear.len(), || {
            let mut writer = Writer::new(Form { aim, ..Form::default() });
            let mut text = Vec::new();
            for motion in Motions::of_three_b(&gear[..], Model::Rotated) {
                writer.write(&motion.unwrap(), &mut text).unwrap();
                if text.len() > 1 << 16 {
                    black_box(&text);
                    text.clear();
                }
            }
            writer.blocks()
        });
    }
}

fn read_3b(what: &str, text: &[u8]) {
    row(what, text.len(), || {
        let mut reader = Reader::new(text);
        let mut blocks = 0u64;
        while let Some(item) = reader.next_item().unwrap() {
            blocks += u64::from(matches!(item, Item::Block(_)));
            black_box(reader.spot());
        }
        blocks
    });
}

fn row(what: &str, bytes: usize, mut work: impl FnMut() -> u64) {
    let mut blocks = 0;
    let mut seconds: Vec<f64> = (0..RUNS)
        .map(|_| {
            let began = Instant::now();
            blocks = work();
            began.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    let rate = |seconds: f64| bytes as f64 / seconds / 1e6;
    let median = seconds[RUNS / 2];
    println!(
        "| {what} | {:.0} ({:.0} - {:.0}) | {:.1} |",
        rate(median),
        rate(seconds[RUNS - 1]),
        rate(seconds[0]),
        blocks as f64 / median / 1e6
    );
}

/// About 64 MB of the paper's gear, one block a line.
fn gear() -> Vec<u8> {
    let part = Part { aim: aim_named("rotated").unwrap(), repeat: 1_000_000, ..Part::default() };
    let (mut program, mut text) = (Generated::new(&part.prepare().unwrap()), Vec::new());
    while text.len() < BYTES && program.pull(&mut text).unwrap().is_some() {
        text.push(b'\n');
    }
    text
}

/// The blocks as a CAM system lists them.
fn listing(text: &[u8]) -> Vec<u8> {
    let style = three_b::Style { j_digits: 6, g_letter: true, blanks: true };
    let (mut reader, mut listing, mut n) = (Reader::new(text), Vec::new(), 0);
    while let Some(Item::Block(block)) = reader.next_item().unwrap() {
        n += 1;
        listing.extend_from_slice(format!("N{n:4}: ").as_bytes());
        style.write(&block, &mut listing);
        listing.extend_from_slice(b" ; 5.000, 0.000\n");
        if listing.len() > BYTES {
            break;
        }
    }
    listing
}

/// The blocks with R and a flag on every arc.
fn four_b(text: &[u8]) -> Vec<u8> {
    let (mut reader, mut four) = (Reader::new(text), Vec::new());
    while let Some(Item::Block(block)) = reader.next_item().unwrap() {
        let line = reader.text();
        if let three_b::Motion::Arc(sense, _) = block.motion {
            let (x, y) = (block.x.0 as f64, block.y.0 as f64);
            let g = line.iter().position(|&b| b == b'G').unwrap();
            four.extend_from_slice(&line[..g]);
            let flag = if sense == dripfeed::geometry::Sense::Clockwise { "D" } else { "DD" };
            four.extend_from_slice(format!("B{:.0}{flag}", (x * x + y * y).sqrt()).as_bytes());
            four.extend_from_slice(&line[g..]);
        } else {
            four.extend_from_slice(line);
        }
        four.push(b'\n');
        if four.len() > BYTES {
            break;
        }
    }
    four
}
