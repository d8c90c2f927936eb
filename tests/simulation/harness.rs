//! One run of sender and control on a virtual clock, bounded in steps, jumping from deadline to deadline.

use std::time::Duration;

use dripfeed::part::Part;
use dripfeed::program::{Generated, Line, Program};
use dripfeed::protocol::dc_codes::{DcCodes, Settings};
use dripfeed::protocol::pacing::Pace;
use dripfeed::protocol::{Ending, Event, ProgramEnd, Protocol, Tally};
use mock_controller::{BlockEnd, Controller, Framing, Observer, Report, Start};

/// What is run.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub(crate) baud: u32,
    pub(crate) latency: Duration,
    pub(crate) strict: bool,
    /// A window other than the pace's own: a planted mistake.
    pub(crate) window: Option<usize>,
    /// A block that is not sent: a planted mistake.
    pub(crate) skip_block: Option<u64>,
    pub(crate) dc3_parity: bool,
    pub(crate) alarm_at_block: Option<u64>,
    pub(crate) reset_at_block: Option<u64>,
    pub(crate) start_delay: Duration,
    /// How long cutting takes, in line times of the block.
    pub(crate) cutting_time: f64,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            baud: 9600,
            latency: Duration::ZERO,
            strict: false,
            window: None,
            skip_block: None,
            dc3_parity: false,
            alarm_at_block: None,
            reset_at_block: None,
            start_delay: Duration::ZERO,
            cutting_time: 1.25,
        }
    }
}

impl Setup {
    /// The pace the sender keeps.
    pub(crate) fn pace(&self) -> Pace {
        // 7E2: eleven bits a character.
        let character = Duration::from_nanos(11_000_000_000 / u64::from(self.baud));
        let mut pace = if self.strict {
            Pace::strict(character, self.latency, 10, None)
        } else {
            Pace::free(character, self.latency, 10, None)
        };
        pace.window = self.window.unwrap_or(pace.window);
        pace
    }
}

/// What came of it.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) report: Report,
    pub(crate) tally: Tally,
    pub(crate) ending: Ending,
    pub(crate) holds_seen: u64,
    pub(crate) received: Vec<u8>,
    pub(crate) blocks_made: u64,
    pub(crate) longest_block: usize,
    /// Most bytes of blocks made and not yet read by the control.
    pub(crate) most_ahead_bytes: usize,
    pub(crate) finished_at: Duration,
}

/// Keeps the text the control decoded.
#[derive(Default)]
struct Text(Vec<u8>);

impl Observer for Text {
    fn wants_pulses(&self) -> bool {
        false
    }
    fn text(&mut self, text: &[u8]) {
        self.0.extend_from_slice(text);
    }
    fn block_end(&mut self, _end: &BlockEnd) {}
}

/// The program of every run: the paper's gear.
fn program() -> Generated {
    Generated::new(&Part::default().prepare().expect("the paper's gear exists"))
}

/// Its text, one LF a line.
pub(crate) fn program_text(_setup: &Setup) -> String {
    let (mut program, mut text) = (program(), Vec::new());
    while program.pull(&mut text).expect("a gear cannot fail").is_some() {
        text.push(b'\n');
    }
    String::from_utf8(text).expect("3B is ASCII")
}

const LEADER: &[u8] = b"%\n";

/// Runs sender and control to the sender's end, and the control on until it is quiet.
pub(crate) fn run(setup: &Setup) -> Run {
    let mut control = Controller::observed(
        mock_controller::Settings {
            pace: mock_controller::Pace::Paced { baud: setup.baud, framing: Framing::SEVEN_EVEN_TWO },
            latency: setup.latency,
            dc3_parity: setup.dc3_parity,
            alarm_at_block: setup.alarm_at_block,
            reset_at_block: setup.reset_at_block,
            start: Start::After(setup.start_delay),
            cutting_time: setup.cutting_time,
            ..mock_controller::Settings::default()
        },
        Text::default(),
    )
    .expect("the settings go together");
    let settings = Settings {
        pace: setup.pace(),
        wait_for_start: true,
        start_timeout: None,
        leader: LEADER.to_vec(),
        trailer: b"%\n".to_vec(),
    };
    let mut now = Duration::ZERO;
    let mut sender = DcCodes::new(settings, now);
    let mut program = program();
    let (mut text, mut number, mut made_bytes) = (Vec::new(), 0, 0usize);
    let (mut holds_seen, mut longest_block, mut most_ahead_bytes) = (0, 0, 0);
    control.link_opened(now);
    let mut ending = None;
    for step in 0.. {
        assert!(step < 2_000_000, "the run does not end");
        control.advance(now);
        let spoken = control.receive(now);
        if spoken.is_empty() {
            sender.handle_timeout(now);
        } else {
            sender.handle_received(&spoken, now);
        }
        while sender.wants_block(now) {
            text.clear();
            match program.pull(&mut text).expect("a gear cannot fail") {
                None => sender.finish(ProgramEnd::StopWord),
                Some(line) => {
                    number += u64::from(matches!(line, Line::Block(_)));
                    text.push(b'\n');
                    if setup.skip_block == Some(number) && matches!(line, Line::Block(_)) {
                        continue;
                    }
                    longest_block = longest_block.max(text.len());
                    made_bytes += text.len();
                    sender.offer_block(number, &text);
                    // Read by the control, the leader aside; what its driver and line hold is not read.
                    let read = (control.characters_read() as usize).saturating_sub(LEADER.len());
                    most_ahead_bytes = most_ahead_bytes.max(made_bytes - read.min(made_bytes));
                }
            }
        }
        loop {
            let bytes = sender.poll_transmit(now).to_vec();
            if bytes.is_empty() {
                break;
            }
            let taken = control.send(&bytes, now);
            sender.handle_transmitted(taken, now);
            if taken < bytes.len() {
                break;
            }
        }
        while let Some(event) = sender.poll_event() {
            match event {
                Event::Held => holds_seen += 1,
                Event::Ended(end) => ending = Some(end),
                Event::Started | Event::Released { .. } | Event::Transmitted { .. } => {}
            }
        }
        if ending.is_some() {
            break;
        }
        let next = [sender.poll_timeout(now), control.next_wakeup()].into_iter().flatten().min();
        let next = next.expect("both sides wait for each other without a deadline");
        now = next.max(now + Duration::from_nanos(1));
    }
    let finished_at = now;
    control.link_closed(now);
    for step in 0.. {
        assert!(step < 2_000_000, "the control does not come to rest");
        control.advance(now);
        let Some(next) = control.next_wakeup().filter(|&next| next < finished_at + Duration::from_secs(600))
        else {
            break;
        };
        now = next.max(now + Duration::from_nanos(1));
    }
    Run {
        report: control.report(),
        tally: sender.tally(),
        ending: ending.expect("the loop ends with the sender"),
        holds_seen,
        received: std::mem::take(&mut control.observer_mut().0),
        blocks_made: number,
        longest_block,
        most_ahead_bytes,
        finished_at,
    }
}
