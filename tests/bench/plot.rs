//! Time and size of pictures and checks of long programs, as a Markdown table: `cargo bench --bench plot`.
//!
//! Every figure is the median of five runs of the real binary, process start included. Nothing is asserted.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RUNS: usize = 5;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench plot`");
        return;
    }
    println!("| what | median | runs (lowest - highest) | picture | peak resident |\n|---|---|---|---|---|");
    let directory = tempfile::tempdir().unwrap();
    let many_turns = directory.path().join("turns.3b");
    generate(&["--repeat", "3800", "--lead-in", "none"], &many_turns);
    let one_turn = directory.path().join("one.3b");
    generate(&["--teeth", "140000", "--lead-in", "none", "--module", "0.3"], &one_turn);
    let many_lines = directory.path().join("lines.3b");
    lines(&many_lines, 100_000);
    let svg = directory.path().join("out.svg");
    let png = directory.path().join("out.png");
    for (name, file) in
        [("the paper's gear, 3800 turns", &many_turns), ("a gear of 140 000 teeth", &one_turn)]
    {
        let blocks = count(file);
        for (out, kind) in [(&svg, "SVG"), (&png, "PNG")] {
            for (words, how) in
                [(&[][..], "simulated cut on top"), (&["--no-simulation"][..], "program alone")]
            {
                let words = [&["plot", text(file), "--wire", "0.18", "-o", text(out)], words].concat();
                row(&format!("`plot` {kind} of {name}, {blocks} blocks, {how}"), &words, Some(out));
            }
        }
        row(&format!("`check` of {name}, {blocks} blocks"), &["check", text(file)], None);
    }
    let blocks = count(&many_lines);
    row(
        &format!("`check` of one contour of {blocks} lines, self-crossing included"),
        &["check", text(&many_lines)],
        None,
    );
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn dripfeed(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dripfeed"));
    command.args(words).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn generate(words: &[&str], to: &PathBuf) {
    let file = std::fs::File::create(to).unwrap();
    let words = [&["generate", "gear"], words].concat();
    assert!(dripfeed(&words).stdout(file).status().unwrap().success());
}

/// A star of so many points: lines only, closed, nothing crosses.
fn lines(to: &PathBuf, count: usize) {
    let mut out = std::io::BufWriter::new(std::fs::File::create(to).unwrap());
    let node = |n: usize| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (n % count) as f64 / count as f64);
        let radius = if n.is_multiple_of(2) { 400_000.0 } else { 399_900.0 };
        ((radius * cos).round() as i64, (radius * sin).round() as i64)
    };
    for n in 0..count {
        let ((ax, ay), (bx, by)) = (node(n), node(n + 1));
        let way = dripfeed::units::Position::new(bx - ax, by - ay);
        let mut text = Vec::new();
        dripfeed::formats::three_b::Style::default()
            .write(&dripfeed::formats::three_b::Block::line(way), &mut text);
        text.push(b'\n');
        out.write_all(&text).unwrap();
    }
    out.write_all(b"DD\n").unwrap();
    out.flush().unwrap();
}

fn count(file: &Path) -> usize {
    std::fs::read(file).unwrap().iter().filter(|&&byte| byte == b'\n').count() - 1
}

fn row(what: &str, words: &[&str], picture: Option<&PathBuf>) {
    let mut times = Vec::new();
    let mut peak = 0.0f64;
    for _ in 0..RUNS {
        let began = Instant::now();
        let mut child = dripfeed(words).spawn().unwrap();
        let status = format!("/proc/{}/status", child.id());
        loop {
            if let Ok(status) = std::fs::read_to_string(&status) {
                let kb = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
                let kb = kb.and_then(|kb| kb.trim().trim_end_matches(" kB").parse::<f64>().ok());
                peak = peak.max(kb.unwrap_or(0.0) / 1024.0);
            }
            if child.try_wait().unwrap().is_some() {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        times.push(began.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let size = picture.map_or_else(String::new, |path| {
        format!("{:.2} MB", std::fs::metadata(path).unwrap().len() as f64 / 1e6)
    });
    println!(
        "| {what} | {:.2} s | {RUNS} ({:.2} - {:.2}) | {size} | {peak:.0} MB |",
        times[RUNS / 2],
        times[0],
        times[RUNS - 1]
    );
}
