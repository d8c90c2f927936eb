//! Long programs go through in constant memory, and what is made comes out while the rest still goes in.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::Stdio;

use crate::shop::Shop;

const SIDES: &str = "B5B0B000005GXL1\nB0B5B000005GYL2\nB5B0B000005GXL3\nB0B5B000005GYL4\n";

/// The most memory of a running process that was ever resident, KiB.
fn peak_kib(id: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).expect("Linux tells of a process");
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).expect("its peak");
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[test]
#[cfg(target_os = "linux")]
fn two_million_blocks_stay_below_64_mb_and_come_out_as_they_go_in() {
    const SQUARES: usize = 500_000;
    let shop = Shop::new();
    for (to, model) in [("gcode", "any"), ("3b", "rotated")] {
        let words = ["convert", "-", "--from", "3b", "--to", to, "--interpolator", model];
        let mut child = shop.command(&words).stdin(Stdio::piped()).spawn().unwrap();
        let id = child.id();
        let mut stdin = child.stdin.take().unwrap();
        let mut stderr = child.stderr.take().unwrap();
        let mut stdout = BufReader::new(child.stdout.take().unwrap());
        // Half a million blocks go in, and then nothing until a line has come out.
        let (half_in, comes_out) = (SIDES.repeat(SQUARES / 4), SIDES.repeat(SQUARES / 100));
        let (told, first_line) = std::sync::mpsc::channel::<()>();
        let writer = std::thread::spawn(move || {
            stdin.write_all(half_in.as_bytes()).unwrap();
            let is_out = first_line.recv_timeout(std::time::Duration::from_secs(60)).is_ok();
            for _ in 0..75 {
                stdin.write_all(comes_out.as_bytes()).unwrap();
            }
            stdin.write_all(b"DD\n").unwrap();
            is_out
        });
        let (mut line, mut lines, mut peak) = (String::new(), 0_usize, 0);
        while stdout.read_line(&mut line).unwrap() > 0 {
            lines += 1;
            if lines == 1 {
                let _ = told.send(());
            }
            if lines % 100_000 == 0 {
                peak = peak.max(peak_kib(id));
            }
            line.clear();
        }
        assert!(writer.join().unwrap(), "{to}: a line comes out before the input ends");
        let mut said = String::new();
        stderr.read_to_string(&mut said).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{said}");
        let expected = if to == "gcode" { 4 * SQUARES + 3 } else { 4 * SQUARES + 1 };
        assert_eq!(lines, expected, "{to}: {said}");
        assert!(peak > 1000 && peak < 64 * 1024, "{to}: {peak} KiB");
    }
}
