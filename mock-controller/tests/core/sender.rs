//! The tests' own sender: raw bytes, a window, and as much obedience as a test asks for.
//!
//! It puts bytes into the driver while the driver holds fewer than its window, and looks at what the control says the
//! instant it arrives.

use std::time::Duration;

use mock_controller::{Controller, Observer, Report, Settings};

pub(crate) struct Sender {
    pub(crate) program: Vec<u8>,
    /// Most bytes in the driver at once.
    pub(crate) window: usize,
    /// Whether DC3 stops it.
    pub(crate) obeys: bool,
    /// What the control said, and when.
    pub(crate) heard: Vec<(Duration, u8)>,
    sent: usize,
    may_send: bool,
}

impl Sender {
    pub(crate) fn of(program: impl Into<Vec<u8>>) -> Sender {
        Sender {
            program: program.into(),
            window: 1,
            obeys: true,
            heard: Vec::new(),
            sent: 0,
            may_send: false,
        }
    }

    pub(crate) fn heedless(self) -> Sender {
        Sender { obeys: false, ..self }
    }

    pub(crate) fn window(self, window: usize) -> Sender {
        Sender { window, ..self }
    }

    /// What the control said, without the times.
    pub(crate) fn codes(&self) -> Vec<u8> {
        self.heard.iter().map(|&(_, byte)| byte).collect()
    }

    pub(crate) fn has_sent_all(&self) -> bool {
        self.sent == self.program.len()
    }

    /// Feeds until nothing more happens or `until` is reached; returns the time then.
    pub(crate) fn feed<O: Observer>(
        &mut self,
        control: &mut Controller<O>,
        from: Duration,
        until: Duration,
    ) -> Duration {
        let mut now = from;
        for _ in 0..50_000_000 {
            for byte in control.receive(now) {
                self.heard.push((now, byte));
                match byte & 0x7F {
                    0x11 => self.may_send = true,
                    0x13 => self.may_send = !self.obeys,
                    0x15 | 0x16 => self.may_send = false,
                    other => panic!("the control said {other:#04x}"),
                }
            }
            while self.may_send && !self.has_sent_all() && control.queued() < self.window {
                match control.send(&self.program[self.sent..=self.sent], now) {
                    0 => break, // The cable is out.
                    accepted => self.sent += accepted,
                }
            }
            match control.next_wakeup() {
                Some(next) if next <= until => now = now.max(next),
                Some(_) => return until,
                None => return now,
            }
        }
        panic!("the simulation does not come to an end");
    }
}

pub(crate) const HOUR: Duration = Duration::from_secs(3600);

/// Runs one program over one connection.
pub(crate) fn run(settings: Settings, sender: &mut Sender) -> Report {
    let mut control = Controller::new(settings).unwrap();
    control.link_opened(Duration::ZERO);
    sender.feed(&mut control, Duration::ZERO, HOUR);
    control.report()
}

/// Runs a text at once on an unpaced line.
pub(crate) fn run_unpaced(program: &str) -> Report {
    run(Settings::unpaced(), &mut Sender::of(program).window(4096))
}

/// `blocks` blocks with a leader and a trailer: a staircase that ends at (blocks, 0) · 10 µm.
pub(crate) fn staircase(blocks: u64) -> String {
    let mut program = String::from("%\n");
    for _ in 0..blocks {
        program += "B10 B0 B000010 GX L1\n";
    }
    program + "%\n"
}

/// The digest of a text, computed apart from the control.
pub(crate) fn sha256(text: &str) -> String {
    use sha2::Digest as _;
    sha2::Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}
