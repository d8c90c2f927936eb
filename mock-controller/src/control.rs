//! The control: a receiver, a bounded buffer of whole blocks, and a cutter, joined to its line.
//!
//! ```text
//!   link opens ─▶ WAITING ──start delay──▶ DC1, every 5 s until the first character ─▶ READING
//!   READING   fill ≥ xoff-at ─▶ DC3 ─▶ HELD      HELD  fill ≤ xon-at, or nothing left to cut ─▶ DC1 ─▶ READING
//!   READING, HELD   alarm ─▶ DC3 NAK ─▶ STOPPED for good        reset ─▶ DC3 SYN ─▶ DEAF until the link opens
//!   program's end received, no hold, line silent ─▶ DC3 (end of transfer); a next program may follow
//! ```
//!
//! That is the control that speaks DC codes. Where another protocol is spoken, its machine (`protocol`) says what is
//! said, and the control tells it when it is started, holds, goes on and stops (`talk`).
//!
//! Sans-IO: time is an argument and only moves by [`Controller::advance`]. The same calls at the same times give the
//! same results, always.
//!
//! Sources: domain/4, "The rules that cost parts when broken", and the contract of the command line.

mod code;
mod cutter;
mod flow;
mod input;
mod lines;
mod plan;
mod protocol;
pub(crate) mod reader;
pub mod settings;
mod source;
mod talk;
mod text;

use std::collections::VecDeque;
use std::time::Duration;

use crate::line::back::Back;
use crate::line::fault::Faults;
use crate::line::forward::{Forward, Mark};
use crate::line::utilisation::Utilisation;
use crate::observer::{BlockEnd, Observer, Unobserved};
use crate::report::Report;
use code::Decoder;
pub use code::{Code, CodeTable, NotACode};
use cutter::{Cut, Item, Queued};
use flow::Flow;
use plan::Plan;
pub use plan::gcode::{
    ArcCentre, GcodeSettings, IgnoredWords, NotARegister, NotAWord, Register, UnitWithoutPoint,
};
use protocol::Machine;
pub use protocol::{AnswerBytes, EndCode, Lines, Next, Protocol, TapePacing, UnknownProtocol};
use settings::{Settings, SettingsError};
use source::Source;
use text::Text;

/// A simulated control on a simulated line.
///
/// The driver calls [`Controller::link_opened`], then [`Controller::send`] with what the sender hands to its port,
/// [`Controller::advance`] as time passes (at the latest at [`Controller::next_wakeup`]), and
/// [`Controller::receive`] for what the sender's program can read. Every `now` is a time since the same origin and must
/// not run backwards.
pub struct Controller<O: Observer = Unobserved> {
    settings: Settings,
    now: Duration,
    forward: Forward,
    back: Back,
    /// What speaks for the control, where it is not by DC codes.
    talk: Option<Box<dyn Machine>>,
    decoder: Decoder,
    reader: Source,
    text: Text,
    faults: Faults,
    utilisation: Utilisation,
    flow: Flow,
    queue: VecDeque<Queued>,
    /// Characters of the queued blocks.
    queued_characters: usize,
    plan: Plan,
    cut: Option<Cut>,
    tally: Tally,
    observer: O,
}

/// What has been counted.
#[derive(Clone, Debug, Default)]
struct Tally {
    blocks: u64,
    pulses: u64,
    x_um: i64,
    y_um: i64,
    /// Where the wire stands at the upper guide.
    upper_um: [i64; 2],
    upper_pulses: u64,
    path_length_um: f64,
    characters: u64,
    max_overrun: u64,
    holds: u64,
    alarm: Option<&'static str>,
    alarm_detail: Option<String>,
    programs: u64,
    connections: u64,
    resets: u64,
    unread: u64,
}

impl Controller<Unobserved> {
    /// A control nobody watches.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] when the settings contradict each other.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        Controller::observed(settings, Unobserved)
    }
}

impl<O: Observer> Controller<O> {
    /// A control with someone who watches it.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] when the settings contradict each other.
    pub fn observed(settings: Settings, observer: O) -> Result<Self, SettingsError> {
        settings.validate()?;
        let mut control = Controller {
            now: Duration::ZERO,
            forward: Forward::new(settings.pace, settings.fifo_bytes),
            back: Back::new(settings.pace, settings.latency),
            talk: Protocol::machine(&settings),
            decoder: Decoder::new(settings.code.clone(), settings.tv_check),
            reader: Source::new(settings.dialect, settings.label_skip),
            text: Text::default(),
            faults: Faults::new(&settings.faults, settings.seed),
            utilisation: Utilisation::default(),
            flow: Flow::default(),
            queue: VecDeque::new(),
            queued_characters: 0,
            plan: Plan::new(&settings, [0, 0]),
            cut: None,
            tally: Tally::default(),
            observer,
            settings,
        };
        control.gate();
        Ok(control)
    }

    /// A sender is there.
    pub fn link_opened(&mut self, now: Duration) {
        self.advance(now);
        if !self.flow.link_up {
            self.flow.link_up = true;
            self.back.connect();
            self.forward.mark(Mark::Opened);
            self.advance(now);
        }
    }

    /// The sender is gone. What it has put into the FIFO still travels.
    pub fn link_closed(&mut self, now: Duration) {
        self.advance(now);
        if self.flow.link_up {
            self.flow.link_up = false;
            self.back.disconnect();
            self.forward.mark(Mark::Closed);
            self.advance(now);
        }
    }

    /// Whether the cable was pulled (fault `disconnect`) since this was last asked. The link counts as closed then.
    pub fn take_disconnected(&mut self) -> bool {
        std::mem::take(&mut self.flow.pulled)
    }

    /// Bytes the driver's FIFO has room for.
    #[must_use]
    pub fn room(&self) -> usize {
        self.forward.room()
    }

    /// Characters not yet received by the control, the one on the line included: the driver's output count.
    #[must_use]
    pub fn queued(&self) -> usize {
        self.forward.queued()
    }

    /// Puts bytes into the driver's FIFO; returns how many it took. None are taken while the link is closed.
    #[must_use]
    pub fn send(&mut self, bytes: &[u8], now: Duration) -> usize {
        self.advance(now);
        if !self.flow.link_up {
            return 0;
        }
        let accepted = self.forward.put(bytes, now);
        self.advance(now);
        accepted
    }

    /// Bytes that have reached the sender's program by `now`.
    pub fn receive(&mut self, now: Duration) -> Vec<u8> {
        self.advance(now);
        self.back.arrived(now)
    }

    /// Lets everything happen that is due by `now`, in order.
    pub fn advance(&mut self, now: Duration) {
        while let Some((at, event)) = self.next_event()
            && at <= now
        {
            self.now = self.now.max(at);
            self.handle(event);
        }
        self.now = self.now.max(now);
    }

    /// When something happens next without anybody's doing; `None`: nothing will. What the control has said counts until
    /// it has been taken by [`Controller::receive`].
    #[must_use]
    pub fn next_wakeup(&self) -> Option<Duration> {
        let event = self.next_event().map(|(at, _)| at);
        [event, self.back.arrival()].into_iter().flatten().min()
    }

    /// Blocks executed complete.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.tally.blocks
    }

    /// Where the wire stands, µm from where it stood before the first block.
    #[must_use]
    pub fn position_um(&self) -> [i64; 2] {
        [self.tally.x_um, self.tally.y_um]
    }

    /// Characters the receiver has completed.
    #[must_use]
    pub fn characters_read(&self) -> u64 {
        self.tally.characters
    }

    /// Characters in the control's buffer.
    #[must_use]
    pub fn buffered(&self) -> usize {
        self.queued_characters + self.reader.characters()
    }

    /// Whether the control has asked for silence and not yet asked to go on.
    #[must_use]
    pub fn is_holding(&self) -> bool {
        self.flow.held
    }

    /// The alarm that stopped the control.
    #[must_use]
    pub fn alarm(&self) -> Option<&str> {
        self.tally.alarm
    }

    /// Whether nothing more will come of what was sent: an alarm, or a program ended, all of it cut, and the last word
    /// of the control on its way.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        let said = self.back.is_idle() && self.back.arrival().is_none();
        let idle = self.cut.is_none() && self.queue.is_empty() && !self.in_transfer();
        let cut = self.tally.programs > 0 && idle;
        said && (self.tally.alarm.is_some() || (cut && self.flow.end_said))
    }

    /// Who watches.
    pub fn observer_mut(&mut self) -> &mut O {
        &mut self.observer
    }

    /// The settings the control was made with.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What has been received and cut so far.
    #[must_use]
    pub fn report(&self) -> Report {
        let tally = &self.tally;
        Report {
            blocks: tally.blocks,
            pulses: tally.pulses,
            end_um: [tally.x_um, tally.y_um],
            path_length_mm: tally.path_length_um / 1000.0,
            bytes: tally.characters,
            max_overrun_bytes: tally.max_overrun,
            holds: tally.holds,
            line_utilisation: self.utilisation.value(|count| self.settings.pace.time_of(count)),
            sha256: self.text.sha256(),
            alarm: tally.alarm.map(str::to_owned),
            faults: self.faults.struck(),
            alarm_detail: tally.alarm_detail.clone(),
            programs: tally.programs,
            connections: tally.connections,
            torn: self.reader.torn(),
            resets: tally.resets,
            skipped: self.reader.skipped(),
            unread: tally.unread,
            held_seconds: self.utilisation.held().as_secs_f64(),
            upper_end_um: self.settings.taper.map(|_| tally.upper_um),
            words_passed_over: self.plan.passed_over(),
            upper_pulses: self.settings.taper.map(|_| tally.upper_pulses),
        }
    }

    fn next_event(&self) -> Option<(Duration, Event)> {
        // At one instant the earlier of these goes first: characters before what is sent, so that one that completes
        // together with DC3's stop bit is no overrun.
        let mut next = None;
        let mut consider = |at: Option<Duration>, event| {
            if let Some(at) = at
                && next.is_none_or(|(earliest, _)| at < earliest)
            {
                next = Some((at, event));
            }
        };
        consider(self.character_due(), Event::Character);
        consider(self.cut.as_ref().map(|cut| cut.ends), Event::CutEnds);
        consider(self.back.completion(), Event::Sent);
        consider(self.flow.go_at, Event::Go);
        consider(self.machine_due(), Event::Machine);
        consider(self.flow.line_on_at, Event::LineOn);
        consider(self.end_of_transfer_due(), Event::EndOfTransfer);
        consider(self.forward.mark_is_due().then_some(self.now), Event::Mark);
        next
    }

    fn handle(&mut self, event: Event) {
        match event {
            Event::Character => self.character(),
            Event::CutEnds => self.finish_cut(),
            Event::Sent => self.sent(),
            Event::Go => self.go(),
            Event::EndOfTransfer => self.end_of_transfer(),
            Event::Mark => self.link_changes(),
            Event::Machine => self.machine_time(),
            Event::LineOn => self.line_on(),
        }
        self.gate();
    }

    /// Takes up what a block has done.
    fn executed(&mut self, end: &BlockEnd, length_um: f64) {
        self.tally.blocks = end.number;
        self.tally.path_length_um += length_um;
        self.observer.block_end(end);
    }

    /// Puts one item of the program at the end of the buffer.
    fn enqueue(&mut self, item: Item, characters: usize) {
        self.queued_characters += characters;
        self.queue.push_back(Queued { item, characters });
    }
}

/// What can happen next.
#[derive(Clone, Copy, Debug)]
enum Event {
    Character,
    CutEnds,
    Sent,
    Go,
    Machine,
    LineOn,
    EndOfTransfer,
    Mark,
}
