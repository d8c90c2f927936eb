//! The loop that feeds one control: source → protocol → link, with the journal before the bytes.
//!
//! Two threads a port: this loop, which alone touches the link, and a producer, which makes blocks when asked, so that a
//! slow source never delays the answer to DC3. The loop asks for blocks only when the protocol wants one and the
//! journal's durable horizon covers it; so no more is made than the window holds and one block. Stopping is a flag.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::{Link, LinkError};
use crate::journal::Record;
use crate::journal::writer::Journal;
use crate::program::{Counted, Line, Program, ProgramError, Segment, Segments};
use crate::protocol::{Command, Ending, Event, Phase, ProgramEnd, Protocol, Tally};
use crate::tape::{Tape, Unencodable};

/// What the screen shows of a running feed.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    /// What the line is doing.
    pub phase: Phase,
    /// Time since the job began.
    pub now: Duration,
    /// The last block handed over whole.
    pub block: u64,
    /// Figures of the line.
    pub tally: Tally,
    /// When the first byte was handed over.
    pub first_byte: Option<Duration>,
    /// Whether the journal still guarantees resume.
    pub journal_ok: bool,
    /// Whether a stop was asked for and the end of the block is awaited.
    pub stopping: bool,
}

/// How a feed ended.
#[derive(Debug)]
pub struct Outcome {
    /// How the conversation ended.
    pub ending: Ending,
    /// The source's fault, if it had one; unless something worse came in between, the ending is then a stop at a block
    /// boundary.
    pub source_error: Option<SourceError>,
    /// The link's own words, if it was lost.
    pub link_error: Option<LinkError>,
    /// The last state of the line.
    pub last: Snapshot,
}

/// Why the producer stopped before the program's end.
#[derive(Debug)]
pub struct SourceError {
    /// The block that could not be made.
    pub block: u64,
    /// Why.
    pub fault: SourceFault,
}

/// See [`SourceError`].
#[derive(Debug)]
pub enum SourceFault {
    /// The program is at fault.
    Program(ProgramError),
    /// A character has no code on the control's tape.
    Tape(Unencodable),
    /// The program has no block at all.
    Empty,
    /// The first block to be sent lies past the program's end.
    PastEnd {
        /// The program's blocks.
        blocks: u64,
    },
    /// The producer's thread ended without a word: our own mistake.
    ProducerDied,
}

/// What to feed.
pub struct Job {
    /// The program, from its first block.
    pub program: Box<dyn Program>,
    /// How its text becomes characters.
    pub tape: Tape,
    /// Blocks before this one are made and digested, but not sent.
    pub from_block: u64,
    /// Where the intent is written.
    pub journal: Journal,
    /// Whether blocks are made one by one: the line is paced, or the source may keep the next one waiting.
    pub one_by_one: bool,
}

/// What the rest of the process shares with a feed.
#[derive(Clone, Debug)]
pub struct Shared {
    /// How often a stop was asked for: once, stop at the block boundary; twice, at once.
    pub stops: Arc<AtomicU32>,
    /// The state of the line, refreshed at every turn of the loop.
    pub snapshot: Arc<Mutex<Snapshot>>,
}

/// A batch of blocks from the producer.
#[derive(Debug, Default)]
struct Batch {
    bytes: Vec<u8>,
    /// The end of each line in `bytes` with the number of its block; a stop word carries the number before it.
    ends: Vec<(usize, u64)>,
    segments: Vec<Segment>,
    finished: Option<(Segment, ProgramEnd)>,
    error: Option<SourceError>,
}

/// How many bytes of blocks to make, and the last block that may be made.
struct Request {
    bytes: usize,
    up_to: u64,
}

/// Runs a conversation to its end. Time is counted from `began`.
///
/// # Errors
///
/// Only when the system has no thread for the producer; everything else is an [`Outcome`].
pub fn run(
    link: &mut dyn Link,
    protocol: &mut dyn Protocol,
    job: Job,
    shared: &Shared,
    began: Instant,
) -> std::io::Result<(Outcome, Journal)> {
    let (requests, orders) = channel();
    let (batches, arrivals) = channel();
    let Job { program, tape, from_block, journal, one_by_one } = job;
    let producer = std::thread::Builder::new()
        .name("producer".to_owned())
        .spawn(move || produce(program, &tape, from_block, &orders, &batches))?;
    let mut feed = Feed {
        link,
        protocol,
        journal,
        shared,
        began,
        requests,
        arrivals,
        one_by_one,
        asked: false,
        exhausted: false,
        next_block: from_block,
        horizon: Horizon { asked: from_block.saturating_sub(1), span: HORIZON_FIRST },
        first_block: from_block,
        stops_seen: 0,
        block: from_block.saturating_sub(1),
        first_byte: None,
        source_error: None,
        link_error: None,
    };
    let ending = feed.turn_until_ended();
    let last = feed.publish();
    let Feed { journal, requests, source_error, link_error, .. } = feed;
    // The producer ends when nobody can ask any more. One that still reads from a terminal or pipe is not waited for.
    drop(requests);
    if producer.is_finished() {
        let _ = producer.join();
    }
    Ok((Outcome { ending, source_error, link_error, last }, journal))
}

struct Feed<'a> {
    link: &'a mut dyn Link,
    protocol: &'a mut dyn Protocol,
    journal: Journal,
    shared: &'a Shared,
    began: Instant,
    requests: Sender<Request>,
    arrivals: Receiver<Batch>,
    one_by_one: bool,
    asked: bool,
    exhausted: bool,
    next_block: u64,
    horizon: Horizon,
    first_block: u64,
    stops_seen: u32,
    block: u64,
    first_byte: Option<Duration>,
    source_error: Option<SourceError>,
    link_error: Option<LinkError>,
}

/// The intent written ahead: small at first, doubling until it covers about two seconds.
struct Horizon {
    asked: u64,
    span: u64,
}

impl Feed<'_> {
    #[expect(clippy::disallowed_methods, reason = "the link is where the clock is")]
    fn now(&self) -> Duration {
        Instant::now().duration_since(self.began)
    }

    fn turn_until_ended(&mut self) -> Ending {
        let mut buffer = [0; 4096];
        loop {
            self.obey();
            self.refill();
            let blocked = self.transmit();
            if let Some(ending) = self.report() {
                return ending;
            }
            self.publish();
            let now = self.now();
            let deadline =
                self.protocol.poll_timeout(now).map_or(IDLE, |at| at.saturating_sub(now)).min(IDLE);
            let wait = if blocked { BLOCKED } else { deadline };
            let received = if self.asked {
                // A batch is on its way: wait for that, and look at the line in between.
                self.await_batch(wait.min(BATCH_POLL));
                self.link.receive(&mut buffer, Duration::ZERO)
            } else {
                let waiting_for_disk = !self.exhausted && self.protocol.wants_block(now);
                self.link.receive(&mut buffer, if waiting_for_disk { wait.min(DISK_POLL) } else { wait })
            };
            let now = self.now();
            match received {
                Ok(0) => self.protocol.handle_timeout(now),
                Ok(count) => {
                    log::trace!("received {:02X?}", &buffer[..count]);
                    self.protocol.handle_received(&buffer[..count], now);
                }
                Err(error) => self.lose(error),
            }
        }
    }

    fn lose(&mut self, error: LinkError) {
        log::debug!("{error}");
        self.link_error.get_or_insert(error);
        self.protocol.handle_link_lost(self.now());
    }

    /// Passes the operator's stops on.
    fn obey(&mut self) {
        let stops = self.shared.stops.load(Ordering::Relaxed);
        while self.stops_seen < stops {
            let command = if self.stops_seen == 0 { Command::StopAtBlock } else { Command::StopNow };
            self.stops_seen += 1;
            self.protocol.handle_command(command, self.now());
        }
    }

    /// Keeps the protocol in blocks and the journal ahead of them.
    fn refill(&mut self) {
        let now = self.now();
        let tally = self.protocol.tally();
        // Waiting for the control says nothing of the rate at which blocks go out.
        let sending = self
            .first_byte
            .map_or(Duration::ZERO, |first| now.saturating_sub(first).saturating_sub(tally.held));
        self.horizon.advance(&self.journal, self.next_block, self.first_block, self.block, sending, tally);
        if self.asked {
            match self.arrivals.try_recv() {
                Ok(batch) => self.take(batch),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => self.abandon(),
            }
        }
        let up_to = self.journal.allowed();
        if !self.asked && !self.exhausted && self.next_block <= up_to && self.protocol.wants_block(now) {
            // One block where the line is paced; where it is not, as much as keeps the link busy.
            let single = self.one_by_one || self.protocol.tally().bytes <= BATCH_FROM;
            let request = Request { bytes: if single { 1 } else { BATCH_BYTES }, up_to };
            self.asked = self.requests.send(request).is_ok();
        }
    }

    fn await_batch(&mut self, wait: Duration) {
        match self.arrivals.recv_timeout(wait) {
            Ok(batch) => self.take(batch),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => self.abandon(),
        }
    }

    /// The producer is gone without a word; nothing more can be made.
    fn abandon(&mut self) {
        let fault = SourceFault::ProducerDied;
        self.take(Batch { error: Some(SourceError { block: self.next_block, fault }), ..Batch::default() });
    }

    fn take(&mut self, batch: Batch) {
        self.asked = false;
        for segment in batch.segments {
            let value = segment.value.to_hex().to_string();
            self.journal.note(Record::Segment { block: segment.block, value });
        }
        let mut start = 0;
        for (end, number) in batch.ends {
            self.protocol.offer_block(number, &batch.bytes[start..end]);
            start = end;
            self.next_block = number + 1;
        }
        if let Some((whole, end)) = batch.finished {
            self.journal.note(Record::Whole { blocks: whole.block, value: whole.value.to_hex().to_string() });
            self.exhausted = true;
            self.protocol.finish(end);
        }
        if let Some(error) = batch.error {
            // The block in hand is finished; nothing after it goes out.
            self.exhausted = true;
            self.source_error = Some(error);
            self.protocol.handle_command(Command::StopAtBlock, self.now());
        }
    }

    /// Hands over what may go; true when the link took less than it was offered.
    fn transmit(&mut self) -> bool {
        loop {
            let now = self.now();
            let bytes = self.protocol.poll_transmit(now);
            if bytes.is_empty() {
                return false;
            }
            let offered = bytes.len();
            match self.link.send(bytes) {
                Ok(0) => return true,
                Ok(count) => {
                    let now = self.now();
                    self.first_byte.get_or_insert(now);
                    self.protocol.handle_transmitted(count, now);
                    if count < offered {
                        return true;
                    }
                    if !self.exhausted && self.protocol.wants_block(now) {
                        return false;
                    }
                }
                Err(error) => {
                    self.lose(error);
                    return false;
                }
            }
        }
    }

    fn report(&mut self) -> Option<Ending> {
        while let Some(event) = self.protocol.poll_event() {
            match event {
                Event::Transmitted { block } => self.block = block,
                Event::Started => log::info!("the control asked for the program"),
                Event::Held => log::info!("held by the control after block {}", self.block),
                Event::Released { held } => log::info!("released after {:.3} s", held.as_secs_f64()),
                Event::Ended(ending) => return Some(ending),
            }
        }
        None
    }

    fn publish(&self) -> Snapshot {
        let snapshot = Snapshot {
            phase: self.protocol.phase(),
            now: self.now(),
            block: self.block,
            tally: self.protocol.tally(),
            first_byte: self.first_byte,
            journal_ok: self.journal.failure().is_none(),
            stopping: self.stops_seen > 0,
        };
        if let Ok(mut shared) = self.shared.snapshot.lock() {
            *shared = snapshot;
        }
        snapshot
    }
}

impl Horizon {
    fn advance(
        &mut self,
        journal: &Journal,
        next: u64,
        first: u64,
        sent: u64,
        sending: Duration,
        tally: Tally,
    ) {
        if next.saturating_add(self.span / 2) <= self.asked {
            return;
        }
        if sent >= first {
            journal.note(Record::Sent { block: sent, bytes: tally.bytes });
        }
        self.asked = next.saturating_add(self.span);
        journal.intend(self.asked);
        let rate = sent.saturating_sub(first) as f64 / sending.as_secs_f64().max(0.1);
        let cover = (rate * HORIZON_SECONDS) as u64;
        self.span = (self.span * 2).min(cover.max(HORIZON_FIRST));
    }
}

/// Makes blocks when asked, until nobody asks.
fn produce(
    program: Box<dyn Program>,
    tape: &Tape,
    from_block: u64,
    orders: &Receiver<Request>,
    batches: &Sender<Batch>,
) {
    let mut program = Counted::new(program);
    let mut segments = Segments::default();
    let mut text = Vec::new();
    let mut end = ProgramEnd::Block;
    while let Ok(request) = orders.recv() {
        let mut batch = Batch::default();
        // Blocks before the first to be sent are made for their digest alone.
        while batch.bytes.len() < request.bytes && program.blocks() < request.up_to {
            text.clear();
            let next = program.blocks() + 1;
            let fault = |fault| Some(SourceError { block: next, fault });
            let numbered = match program.pull(&mut text) {
                Ok(Some(numbered)) => numbered,
                Ok(None) if program.blocks() == 0 => {
                    batch.error = fault(SourceFault::Empty);
                    break;
                }
                Ok(None) if next < from_block => {
                    batch.error = fault(SourceFault::PastEnd { blocks: program.blocks() });
                    break;
                }
                Ok(None) => {
                    batch.finished = Some((segments.finish(), end));
                    break;
                }
                Err(error) => {
                    batch.error = fault(SourceFault::Program(error));
                    break;
                }
            };
            end = if numbered.line == Line::End { ProgramEnd::StopWord } else { ProgramEnd::Block };
            if numbered.goes_out_from(from_block) {
                if let Err(error) = tape.encode(&text, &mut batch.bytes) {
                    batch.error = fault(SourceFault::Tape(error));
                    break;
                }
                batch.ends.push((batch.bytes.len(), numbered.block));
            }
            batch.segments.extend(segments.add(&text, numbered.line));
        }
        let over = batch.finished.is_some() || batch.error.is_some();
        if batches.send(batch).is_err() || over {
            return;
        }
    }
}

/// The longest the loop sleeps: a stop is obeyed within this.
const IDLE: Duration = Duration::from_millis(50);
/// How long to leave a link that takes nothing.
const BLOCKED: Duration = Duration::from_millis(1);
/// How long to wait for the producer before looking at the line.
const BATCH_POLL: Duration = Duration::from_millis(1);
/// How long to wait for the journal before looking again.
const DISK_POLL: Duration = Duration::from_micros(200);
/// Bytes of a batch on an unpaced link.
const BATCH_BYTES: usize = 16_384;
/// Bytes sent block by block first, so that the first byte is not kept waiting for a whole batch.
const BATCH_FROM: u64 = 256;
/// The first horizon, in blocks.
const HORIZON_FIRST: u64 = 16;
/// How much time a horizon covers in the end.
const HORIZON_SECONDS: f64 = 2.0;
