//! A talk with a control: what the test says, and what it must hear, to the byte.

use std::time::Duration;

use mock_controller::{Controller, Observer, Pace, Protocol, Report, Settings};

pub(crate) const BLOCK: &str = "B10BB10GXL1\n";
pub(crate) const ACK: u8 = 0x06;
pub(crate) const NAK: u8 = 0x15;
pub(crate) const CAN: u8 = 0x18;

#[derive(Default)]
pub(crate) struct Saved(Vec<u8>);

impl Observer for Saved {
    fn wants_pulses(&self) -> bool {
        false
    }

    fn text(&mut self, text: &[u8]) {
        self.0.extend_from_slice(text);
    }
}

pub(crate) struct Talk {
    pub(crate) control: Controller<Saved>,
    pub(crate) now: Duration,
}

impl Talk {
    /// Over a line on which characters take no time, with a control that cuts at once.
    pub(crate) fn in_protocol(protocol: Protocol) -> Talk {
        Talk::with(Settings { protocol, ..Settings::unpaced() })
    }

    pub(crate) fn with(settings: Settings) -> Talk {
        let mut control = Controller::observed(settings, Saved::default()).unwrap();
        control.link_opened(Duration::ZERO);
        Talk { control, now: Duration::ZERO }
    }

    pub(crate) fn send(&mut self, bytes: impl AsRef<[u8]>) {
        let bytes = bytes.as_ref();
        assert_eq!(self.control.send(bytes, self.now), bytes.len());
        // On a real line, until it is empty.
        let characters = self.control.queued() as u64;
        self.now += self.control.settings().pace.time_of(characters);
        self.control.advance(self.now);
    }

    /// What it has said since this was last asked.
    pub(crate) fn heard(&mut self) -> Vec<u8> {
        if self.control.settings().pace != Pace::Unpaced {
            // A word of it takes its time.
            self.now += self.control.settings().pace.time_of(16);
        }
        self.control.receive(self.now)
    }

    #[track_caller]
    pub(crate) fn hears(&mut self, wanted: impl AsRef<[u8]>) {
        let (heard, wanted) = (self.heard(), wanted.as_ref());
        assert_eq!(heard, wanted, "heard {}", String::from_utf8_lossy(&heard));
    }

    pub(crate) fn wait(&mut self, milliseconds: u64) {
        self.now += Duration::from_millis(milliseconds);
        self.control.advance(self.now);
    }

    /// The text it has taken as program.
    pub(crate) fn text(&mut self) -> String {
        String::from_utf8(self.control.observer_mut().0.clone()).unwrap()
    }

    pub(crate) fn report(&self) -> Report {
        self.control.report()
    }

    #[track_caller]
    pub(crate) fn is_done(&mut self, blocks: u64) {
        self.wait(1000);
        self.heard();
        let report = self.report();
        let found = (report.blocks, report.programs, report.alarm.as_deref(), self.control.is_finished());
        assert_eq!(found, (blocks, 1, None, true), "{:?}", report.alarm_detail);
    }

    #[track_caller]
    pub(crate) fn has_alarm(&self, name: &str) {
        assert_eq!(self.report().alarm.as_deref(), Some(name), "{:?}", self.report().alarm_detail);
    }
}
