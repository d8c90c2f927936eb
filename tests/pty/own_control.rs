//! A control of the test's own: raw bytes on the master side of a pseudo-terminal, no other program's reading of the
//! manuals in between.

use std::io::{Read, Write};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::Signal;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::bench::{Bench, PATIENCE, finish, pause, signal, verdict};

const DC1: u8 = 0x11;
const DC3: u8 = 0x13;
const NAK: u8 = 0x15;
const SYN: u8 = 0x16;

/// A pseudo-terminal whose master the test plays.
struct Control {
    master: std::fs::File,
    /// Kept open, so that the sender's comings and goings do not hang the master up.
    _slave: std::fs::File,
    port: String,
}

impl Control {
    fn new() -> Self {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let port = ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
        let slave = std::fs::OpenOptions::new().read(true).write(true).open(&port).unwrap();
        let mut settings = tcgetattr(&slave).unwrap();
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings).unwrap();
        Self { master: master.into(), _slave: slave, port }
    }

    fn say(&mut self, bytes: &[u8]) {
        self.master.write_all(bytes).unwrap();
    }

    /// The next bytes from the sender; none after `quiet` without any.
    fn hear_some(&mut self, quiet: Duration) -> Vec<u8> {
        let timeout = Timespec { tv_sec: quiet.as_secs() as i64, tv_nsec: quiet.subsec_nanos().into() };
        let mut descriptors = [PollFd::new(&self.master, PollFlags::IN)];
        if poll(&mut descriptors, Some(&timeout)).unwrap() == 0 {
            return Vec::new();
        }
        let mut buffer = [0; 64];
        let count = self.master.read(&mut buffer).unwrap();
        buffer[..count].to_vec()
    }

    /// What the sender sends until it has been quiet for a while.
    fn hear(&mut self, quiet: Duration) -> Vec<u8> {
        let (mut heard, began) = (Vec::new(), Instant::now());
        loop {
            let some = self.hear_some(quiet);
            if some.is_empty() {
                return heard;
            }
            heard.extend(some);
            assert!(began.elapsed() < PATIENCE, "the sender never stops");
        }
    }

    /// Reads until at least so many bytes were heard.
    fn hear_at_least(&mut self, count: usize) -> Vec<u8> {
        let (mut heard, began) = (Vec::new(), Instant::now());
        while heard.len() < count {
            heard.extend(self.hear_some(QUIET));
            assert!(began.elapsed() < PATIENCE, "only {} of {count} bytes came", heard.len());
        }
        heard
    }
}

const QUIET: Duration = Duration::from_millis(300);

/// A bench with a sender running towards the control.
fn begin(bench: &Bench, control: &Control, extra: &[&str]) -> (Child, Vec<u8>) {
    let part = bench.gear(8);
    let program = bench.program(&part);
    let mut arguments = vec!["send", &part, "--port", &control.port, "--baud", "38400"];
    arguments.extend(extra);
    let child = bench.dripfeed(&arguments).stderr(Stdio::piped()).spawn().unwrap();
    (child, format!("%\n{program}%\n").into_bytes())
}

#[test]
fn the_normal_case() {
    let (bench, mut control) = (Bench::new(), Control::new());
    let (child, expected) = begin(&bench, &control, &[]);
    assert_eq!(control.hear(QUIET), b"", "nothing may come before DC1");
    control.say(&[DC1]);
    assert_eq!(control.hear_at_least(expected.len()), expected);
    control.say(&[DC3]);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(control.hear(QUIET), b"");
}

#[test]
fn dc3_with_parity_stops_the_sender_and_dc1_lets_it_go_on() {
    for dc3 in [DC3, DC3 | 0x80] {
        let (bench, mut control) = (Bench::new(), Control::new());
        let (child, expected) = begin(&bench, &control, &[]);
        control.say(&[DC1]);
        let mut heard = control.hear_at_least(40);
        control.say(&[dc3]);
        heard.extend(control.hear(QUIET));
        assert!(heard.len() < expected.len() / 2, "{} bytes in spite of DC3", heard.len());
        assert_eq!(control.hear(QUIET), b"", "held means silent");
        control.say(&[DC1]);
        heard.extend(control.hear_at_least(expected.len() - heard.len()));
        assert_eq!(heard, expected);
        let (code, stderr) = verdict(&finish(child));
        assert_eq!(code, 0, "{stderr}");
        assert!(stderr.contains("held by the control"), "{stderr}");
    }
}

#[test]
fn a_doubled_dc1_starts_nothing_twice() {
    let (bench, mut control) = (Bench::new(), Control::new());
    let (child, expected) = begin(&bench, &control, &[]);
    control.say(&[DC1, DC1]);
    let mut heard = control.hear_at_least(100);
    control.say(&[DC1]);
    heard.extend(control.hear_at_least(expected.len() - heard.len()));
    assert_eq!(heard, expected);
    assert_eq!(verdict(&finish(child)).0, 0);
    assert_eq!(control.hear(QUIET), b"");
}

#[test]
fn a_late_start_is_waited_for() {
    let (bench, mut control) = (Bench::new(), Control::new());
    let (child, expected) = begin(&bench, &control, &[]);
    pause(Duration::from_secs(2));
    assert_eq!(control.hear(QUIET), b"");
    control.say(&[DC1]);
    assert_eq!(control.hear_at_least(expected.len()), expected);
    assert_eq!(verdict(&finish(child)).0, 0);
}

#[test]
fn a_profile_that_starts_at_once_needs_no_dc1() {
    let (bench, mut control) = (Bench::new(), Control::new());
    let (child, expected) = begin(&bench, &control, &["--set", "start=at-once"]);
    assert_eq!(control.hear_at_least(expected.len()), expected);
    assert_eq!(verdict(&finish(child)).0, 0);
}

#[test]
fn syn_and_nak_after_dc3_are_final_with_and_without_parity() {
    for (answer, words) in
        [(SYN, "was reset"), (0x96, "was reset"), (NAK, "raised an alarm"), (0x95, "raised an alarm")]
    {
        let (bench, mut control) = (Bench::new(), Control::new());
        let (child, _) = begin(&bench, &control, &[]);
        control.say(&[DC1]);
        control.hear_at_least(40);
        control.say(&[DC3]);
        control.hear(QUIET);
        control.say(&[answer]);
        let (code, stderr) = verdict(&finish(child));
        assert_eq!(code, 6, "{stderr}");
        assert!(stderr.contains(words), "{stderr}");
        control.say(&[DC1]);
        assert_eq!(control.hear(QUIET), b"", "nothing may follow {answer:02X}h");
    }
}

#[test]
fn a_control_that_stops_reading_at_the_stop_word_is_done() {
    let (bench, mut control) = (Bench::new(), Control::new());
    let (child, expected) = begin(&bench, &control, &["--set", "window=1"]);
    control.say(&[DC1]);
    let stop_word = expected.len() - 2;
    let mut heard = Vec::new();
    // Byte by byte at the end, so that DC3 goes out before the trailer has come.
    while heard.len() < stop_word {
        let mut byte = [0];
        control.master.read_exact(&mut byte).unwrap();
        heard.push(byte[0]);
    }
    control.say(&[DC3]);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(&heard[heard.len() - 3..], b"DD\n");
}

#[test]
fn a_second_stop_within_a_held_block_names_it_and_what_of_it_was_sent() {
    let (bench, mut control) = (Bench::new(), Control::new());
    let (child, expected) = begin(&bench, &control, &[]);
    control.say(&[DC1]);
    let mut heard = control.hear_at_least(40);
    // Held with a part of a block out; if it happens to be a whole one, a little further.
    loop {
        control.say(&[DC3]);
        heard.extend(control.hear(QUIET));
        if heard.last() != Some(&b'\n') {
            break;
        }
        control.say(&[DC1]);
        heard.extend(control.hear_some(QUIET));
    }
    let whole = heard.iter().filter(|&&byte| byte == b'\n').count() - 1;
    let torn = heard.iter().rev().take_while(|&&byte| byte != b'\n').count();
    assert_eq!(heard, expected[..heard.len()]);

    signal(&child, Signal::INT);
    assert_eq!(control.hear(QUIET), b"", "a held sender waits for the control before it finishes the block");
    signal(&child, Signal::INT);
    let (code, stderr) = verdict(&finish(child));
    assert_eq!(code, 7, "{stderr}");
    let words = format!("block {} is torn, {torn} bytes of it were sent", whole + 1);
    assert!(stderr.contains(&words), "{words}: {stderr}");
    assert_eq!(control.hear(QUIET), b"");
}
