//! Speed and memory of generation and sending, as a Markdown table: `cargo bench --bench first_light`.
//!
//! Every figure is the median of several runs; the runs are named beside it. Nothing is asserted: machines are noisy.
//! The peer of the closed form is `mock-controller`'s stepping of the same blocks, measured in the same run.

#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

use std::hint::black_box;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use dripfeed::part::{Part, Prepared, aim_named};
use dripfeed::program::{Generated, Program};

const RUNS: usize = 5;

fn main() {
    // `cargo test --all-targets` runs this too, to see that it builds.
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench --bench first_light`");
        return;
    }
    println!("| what | median | runs (lowest - highest) |\n|---|---|---|");
    generation();
    whole_processes();
    utilisation();
}

fn row(what: &str, unit: &str, mut values: Vec<f64>) {
    values.sort_by(f64::total_cmp);
    let (low, high) = (values[0], values[values.len() - 1]);
    let median = values[values.len() / 2];
    println!("| {what} | {median:.2} {unit} | {} ({low:.2} - {high:.2}) |", values.len());
}

fn seconds(work: impl FnOnce()) -> f64 {
    let began = Instant::now();
    work();
    began.elapsed().as_secs_f64()
}

fn gear(aim: &str, repeat: u64) -> Prepared {
    Part { aim: aim_named(aim).unwrap(), repeat, ..Part::default() }.prepare().unwrap()
}

fn generation() {
    const REPEAT: u64 = 8000;
    for aim in ["rotated", "mirrored", "strict", "exact", "any"] {
        let prepared = gear(aim, REPEAT);
        let rates = (0..RUNS)
            .map(|_| {
                let mut blocks = 0u64;
                let time = seconds(|| {
                    blocks = prepared.blocks().map(|made| u64::from(black_box(made).block.j.0 > 0)).sum()
                });
                blocks as f64 / time / 1e6
            })
            .collect();
        row(&format!("closed-loop 3B blocks, `{aim}`, one core"), "M/s", rates);
    }
    for aim in ["rotated", "any"] {
        let prepared = gear(aim, REPEAT);
        let rates = (0..RUNS)
            .map(|_| {
                let (mut program, mut text, mut blocks) = (Generated::new(&prepared), Vec::new(), 0u64);
                let time = seconds(|| {
                    while program.pull(&mut text).unwrap().is_some() {
                        blocks += 1;
                        if text.len() > 1 << 16 {
                            black_box(&text);
                            text.clear();
                        }
                    }
                });
                blocks as f64 / time / 1e6
            })
            .collect();
        row(&format!("the same, printed, `{aim}`"), "M/s", rates);
    }

    let blocks: Vec<_> = gear("rotated", 20).blocks().map(|made| made.block).collect();
    let closed = (0..RUNS).map(|_| {
        let model = dripfeed::interpolator::Model::Rotated;
        let time = seconds(|| {
            blocks.iter().for_each(|block| {
                let _ = black_box(model.displacement(block));
            })
        });
        time / blocks.len() as f64 * 1e9
    });
    row("end of a block by the closed form", "ns", closed.collect());
    let text: Vec<String> = gear_lines(20);
    let parsed: Vec<_> = text.iter().filter_map(|line| mock_controller::parse_block(line).ok()).collect();
    let stepped = (0..RUNS).map(|_| {
        let model = mock_controller::Model::Rotated;
        let time = seconds(|| {
            for block in &parsed {
                let _ = black_box(mock_controller::interpolator::run(model, block, |_, _| {}));
            }
        });
        time / parsed.len() as f64 * 1e9
    });
    row("the same by stepping (peer)", "ns", stepped.collect());
}

fn gear_lines(repeat: u64) -> Vec<String> {
    let (mut program, mut text, mut lines) =
        (Generated::new(&gear("rotated", repeat)), Vec::new(), Vec::new());
    while program.pull(&mut text).unwrap().is_some() {
        lines.push(String::from_utf8(std::mem::take(&mut text)).unwrap());
    }
    lines
}

fn dripfeed() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dripfeed"));
    command.stdin(Stdio::null()).stderr(Stdio::null()).stdout(Stdio::null());
    command
}

/// Waits for a child and returns its largest resident size, MB.
fn peak_mb(child: &mut Child) -> f64 {
    let path = format!("/proc/{}/status", child.id());
    let mut peak = 0.0;
    loop {
        if let Ok(status) = std::fs::read_to_string(&path) {
            let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
            let kb = line.and_then(|l| l.trim().trim_end_matches(" kB").trim().parse::<f64>().ok());
            peak = kb.map_or(peak, |kb| kb / 1024.0);
        }
        if child.try_wait().unwrap().is_some() {
            return peak;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A control that takes everything: asks once, counts bytes, says when the first one came.
fn sink(listener: TcpListener) -> std::thread::JoinHandle<(u64, Instant)> {
    std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        stream.write_all(&[0x11]).unwrap();
        let (mut buffer, mut bytes, mut first) = (vec![0; 1 << 16], 0, None);
        loop {
            match stream.read(&mut buffer) {
                Ok(0) | Err(_) => return (bytes, first.unwrap()),
                Ok(count) => {
                    first.get_or_insert_with(Instant::now);
                    bytes += count as u64;
                }
            }
        }
    })
}

fn whole_processes() {
    let directory = tempfile::tempdir().unwrap();
    // 252 blocks and more a turn: ten million and some.
    let part = directory.path().join("long.toml");
    std::fs::write(&part, "[part]\nkind = \"gear\"\nrepeat = 38000\nlead_in = \"none\"\n").unwrap();
    let journal = directory.path().join("journals");

    let mut rates = Vec::new();
    let mut peaks = Vec::new();
    for _ in 0..RUNS {
        let mut child = dripfeed().arg("generate").arg(&part).spawn().unwrap();
        let mut peak = 0.0;
        let time = seconds(|| peak = peak_mb(&mut child));
        rates.push(38_000.0 * 264.0 / time / 1e6);
        peaks.push(peak);
    }
    row("`generate` of 10 032 000 blocks to /dev/null, `any`, account of four models included", "M/s", rates);
    row("its peak resident size", "MB", peaks);

    let send = |source: &Path| {
        let (mut rates, mut peaks, mut firsts) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..RUNS {
            let listener = TcpListener::bind("127.0.0.1:0").unwrap();
            let port = format!("tcp://{}", listener.local_addr().unwrap());
            let control = sink(listener);
            let began = Instant::now();
            let mut child = dripfeed()
                .arg("send")
                .arg(source)
                .args(["--machine", "generic-iso", "--port", &port, "--journal"])
                .arg(&journal)
                .spawn()
                .unwrap();
            peaks.push(peak_mb(&mut child));
            let time = began.elapsed().as_secs_f64();
            let (bytes, first) = control.join().unwrap();
            rates.push(bytes as f64 / time / 1e6);
            firsts.push(first.duration_since(began).as_secs_f64() * 1e3);
        }
        (rates, peaks, firsts)
    };
    let (rates, peaks, firsts) = send(&part);
    row("`send` of a part of 10 032 000 blocks over TCP, unpaced", "MB/s", rates);
    row("its peak resident size", "MB", peaks);
    row("first byte at the control, from the start of the process", "ms", firsts);

    let file = directory.path().join("long.3b");
    let mut out = std::io::BufWriter::new(std::fs::File::create(&file).unwrap());
    let lines = gear_lines(1);
    let turn: String = lines.iter().filter(|l| *l != "DD").map(|l| format!("{l}\n")).collect();
    for _ in 0..300_000_000 / turn.len() + 1 {
        out.write_all(turn.as_bytes()).unwrap();
    }
    out.flush().unwrap();
    drop(out);
    let (rates, peaks, _) = send(&file);
    row("`send` of a 300 MB 3B file over TCP, unpaced, checked whole first", "MB/s", rates);
    row("its peak resident size", "MB", peaks);
}

/// The mock's binary, beside this one's sender.
fn mock() -> Command {
    let beside: PathBuf = Path::new(env!("CARGO_BIN_EXE_dripfeed")).with_file_name("mock-controller");
    assert!(beside.exists(), "{} is missing: cargo build --release --workspace", beside.display());
    Command::new(beside)
}

fn utilisation() {
    let directory = tempfile::tempdir().unwrap();
    let part = directory.path().join("small.toml");
    std::fs::write(
        &part,
        "[part]\nkind = \"gear\"\nteeth = 12\nlead_in = \"none\"\nkp = 1.6\noffset = 0.05\n",
    )
    .unwrap();
    for baud in ["4800", "9600", "19200", "38400", "57600", "115200"] {
        let (mut shares, mut overruns) = (Vec::new(), Vec::new());
        for _ in 0..RUNS {
            let report = directory.path().join("report.json");
            let link = directory.path().join("tty");
            let mut control = mock()
                .args(["--once", "--baud", baud, "--overrun-limit", "200", "--buffer", "512", "--pty"])
                .arg(&link)
                .arg("--report")
                .arg(&report)
                .stdout(Stdio::piped())
                .spawn()
                .unwrap();
            let mut ready = String::new();
            BufReader::new(control.stdout.take().unwrap()).read_line(&mut ready).unwrap();
            dripfeed()
                .arg("send")
                .arg(&part)
                .args(["--machine", "generic-iso", "--baud", baud, "--port"])
                .arg(&link)
                .arg("--journal")
                .arg(directory.path().join("journals"))
                .status()
                .unwrap();
            control.wait().unwrap();
            let report: serde_json::Value = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
            shares.push(100.0 * report["line_utilisation"].as_f64().unwrap_or(f64::NAN));
            overruns.push(report["max_overrun_bytes"].as_f64().unwrap());
        }
        row(
            &format!("line busy while not held, {baud} baud, real programs over a pseudo-terminal"),
            "%",
            shares,
        );
        row("characters after DC3 in these runs", "", overruns);
    }
}
