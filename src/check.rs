//! What can be found wrong with a program before it is fed.
//!
//! A [`Check`] sees every motion of a program once, in order, and hands it to small passes, each of one idea. What they
//! find is a [`Finding`]: a word that stays the same for scripts, the block and the spot, the rule broken, and what to do.
//! Everything wrong is told in one run, so many of a kind that a person can still read it; how many more there are is
//! counted.
//!
//! Passes that need a whole contour (closure, crossing, lead-in, tangency) get it from [`contours`], which holds one chain
//! of cuts at a time and says so when one is too long to hold. After something that cannot be read only syntax is
//! checked: where the wire stands is not known any more.
//!
//! It reads no file and prints nothing; `docs/check.md` lists every code with its tolerance.

pub mod contours;
pub mod wire;

mod closure;
pub mod crossing;
mod lead_in;
mod ledger;
mod limits;
mod modal;
mod models;
mod radii;
mod restart;
mod tangency;
mod tape;
mod taper;
mod travel;

use std::borrow::Cow;

use crate::formats::ReadError;
use crate::formats::three_b::Block;
use crate::motion::Motion;
use crate::place::Spot;

pub use lead_in::Kept;
pub use limits::Format;
pub use models::ModelAccount;
pub use restart::RestartPoint;
pub use travel::Travel;
pub use wire::Looked;

/// Something found.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether it must be mended or looked at.
    pub severity: Severity,
    /// A word for scripts, listed in `docs/check.md`; it keeps its meaning.
    pub code: &'static str,
    /// Where in the source; line 0 when it is about no place.
    pub spot: Spot,
    /// How many bytes of the source are meant; 0 for a whole block.
    pub width: usize,
    /// The block; 0 when it is about none.
    pub block: u64,
    /// The rule broken, in words.
    pub message: String,
    /// What to do about it.
    pub help: Cow<'static, str>,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Severity {
    /// The program must not be fed.
    Error,
    /// Someone should look.
    Warning,
}

impl Severity {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

impl Finding {
    fn error(code: &'static str, spot: Spot, block: u64, message: impl Into<String>) -> Self {
        let help = Cow::Borrowed("");
        Self { severity: Severity::Error, code, spot, width: 0, block, message: message.into(), help }
    }

    fn warning(code: &'static str, spot: Spot, block: u64, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, spot, block, message) }
    }

    fn help(mut self, help: impl Into<Cow<'static, str>>) -> Self {
        self.help = help.into();
        self
    }
}

/// What a program is checked against.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The format, for its limits.
    pub format: Format,
    /// How far the machine travels, where it is known.
    pub travel: Travel,
    /// The most the machine tilts its wire, degrees, where it is known.
    pub taper_max: Option<f64>,
    /// Which side of its contours the part is on, where it is known.
    pub kept: Option<Kept>,
    /// The code of the tape the program goes out on, where it is to be checked.
    pub tape: Option<crate::tape::Tape>,
    /// Whether to collect the blocks at which a job can be taken up.
    pub restart_points: bool,
    /// Whether to look at nothing but what can be read.
    pub syntax_only: bool,
}

/// A check in progress.
#[derive(Debug)]
pub struct Check {
    ledger: ledger::Ledger,
    blocks: u64,
    unreadable: bool,
    syntax_only: bool,
    contours: contours::Contours,
    by_contour: ByContour,
    limits: limits::Limits,
    modal: modal::Modal,
    taper: taper::Tapers,
    tape: Option<tape::Characters>,
    travel: travel::Reach,
    wire: wire::Wire,
}

/// The passes that look at contours.
#[derive(Debug)]
struct ByContour {
    closure: closure::Closure,
    crossing: crossing::Crossing,
    lead_in: lead_in::LeadIn,
    models: models::Models,
    restart: Option<restart::Restart>,
    tangency: tangency::Tangency,
}

impl ByContour {
    fn see(&mut self, run: &contours::Run<'_>, tell: &mut impl FnMut(Finding)) {
        self.closure.see(run, tell);
        self.crossing.see(run, tell);
        self.lead_in.see(run, tell);
        self.models.see_run(run);
        self.tangency.see(run, tell);
        if let Some(restart) = &mut self.restart {
            restart.see_run(run);
        }
    }
}

/// What a check has to say.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Report {
    /// What was found, in the order of the source.
    pub findings: Vec<Finding>,
    /// Findings beyond those told, by code.
    pub more: Vec<(&'static str, u64)>,
    /// Errors in all, those not told included.
    pub errors: u64,
    /// Warnings in all, those not told included.
    pub warnings: u64,
    /// Blocks seen.
    pub blocks: u64,
    /// Whether something could not be read, so that nothing was checked but syntax from there on.
    pub unreadable: bool,
    /// Whether the wire's own path was looked at.
    pub wire: wire::Looked,
    /// For 3B: what each model of the control would do.
    pub models: Option<[ModelAccount; 4]>,
    /// The blocks at which a job can be taken up, where they were asked for, and how many more there are.
    pub restart_points: Vec<RestartPoint>,
    /// Restart points beyond those listed.
    pub more_restart_points: u64,
}

impl Check {
    /// A check that has seen nothing yet.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            ledger: ledger::Ledger::default(),
            blocks: 0,
            unreadable: false,
            syntax_only: settings.syntax_only,
            contours: contours::Contours::default(),
            by_contour: ByContour {
                closure: closure::Closure,
                crossing: crossing::Crossing::default(),
                lead_in: lead_in::LeadIn::new(settings.kept),
                models: models::Models::default(),
                restart: settings.restart_points.then(restart::Restart::default),
                tangency: tangency::Tangency,
            },
            limits: limits::Limits::new(settings.format),
            modal: modal::Modal::default(),
            taper: taper::Tapers::new(settings.taper_max),
            tape: settings.tape.map(tape::Characters::new),
            travel: travel::Reach::new(settings.travel),
            wire: wire::Wire::new(settings.travel),
        }
    }

    /// Takes the next motion; with the 3B block it was read from, if it was.
    pub fn see(&mut self, motion: &Motion, block: Option<&Block>) {
        self.blocks = self.blocks.max(motion.block);
        if self.unreadable || self.syntax_only {
            return;
        }
        let ledger = &mut self.ledger;
        let wire = &mut self.wire;
        wire.see_programmed(motion);
        let mut tell = |finding| {
            wire.note(&finding);
            ledger.add(finding);
        };
        let by_contour = &mut self.by_contour;
        let drift = by_contour.models.see(motion, block, &mut tell);
        self.limits.see(motion, block, &mut tell);
        radii::see(motion, &mut tell);
        self.modal.see(motion, &mut tell);
        self.taper.see(motion, &mut tell);
        self.travel.see(motion, &mut tell);
        let state = self.modal.state();
        if let Some(restart) = &mut by_contour.restart {
            restart.see(motion, state);
        }
        by_contour.crossing.go_on(motion, &mut tell);
        self.contours.see(motion, state, drift, &mut |run| by_contour.see(&run, &mut tell));
    }

    /// Takes what the control makes of the program by its own offset, where that is known.
    pub fn see_wire(&mut self, seen: &wire::Seen<'_>) {
        if !self.unreadable && !self.syntax_only {
            let ledger = &mut self.ledger;
            self.wire.see(seen, self.travel.beyond(), &mut |finding| ledger.add(finding));
        }
    }

    /// Takes a text as it goes to the control, with the block it belongs to and where it stands.
    pub fn see_text(&mut self, text: &[u8], block: u64, spot: Spot) {
        if let Some(tape) = &mut self.tape
            && !self.syntax_only
        {
            tape.see(text, block, spot);
        }
    }

    /// Takes what was found by whoever read the program.
    pub fn add(&mut self, finding: Finding) {
        self.ledger.add(finding);
    }

    /// Takes what a reader could not read, and says whether it is worth going on.
    pub fn see_error(&mut self, error: &ReadError) -> bool {
        self.unreadable = true;
        match error {
            ReadError::Program { message, place, help } => {
                let finding = Finding::error("syntax", place.spot(), self.blocks + 1, message.clone());
                self.ledger.add(Finding { width: place.width, ..finding }.help(help.clone()));
                // A reader that stands still would say the same for ever.
                self.ledger.of("syntax") < SYNTAX_MAX
            }
            ReadError::Io(error) => {
                let message = format!("the program could not be read on: {error}");
                self.ledger.add(
                    Finding::error("unreadable", Spot::default(), self.blocks, message)
                        .help("check the file and its permissions"),
                );
                false
            }
        }
    }

    /// Takes the end of the program, and tells what was found.
    pub fn finish(mut self) -> Report {
        if !self.unreadable && !self.syntax_only {
            let ledger = &mut self.ledger;
            let mut tell = |finding| ledger.add(finding);
            let by_contour = &mut self.by_contour;
            self.contours.finish(&mut |run| by_contour.see(&run, &mut tell));
            self.modal.finish(&mut tell);
            by_contour.models.finish(&mut tell);
            self.travel.finish(&mut tell);
            self.wire.finish(&mut tell);
        }
        if let Some(tape) = &self.tape {
            let ledger = &mut self.ledger;
            tape.finish(&mut |finding| ledger.add(finding));
        }
        let (errors, warnings) = self.ledger.counts();
        let (findings, more) = self.ledger.finish();
        let (restart_points, more_restart_points) =
            self.by_contour.restart.map(restart::Restart::finish).unwrap_or_default();
        Report {
            findings,
            more,
            errors,
            warnings,
            blocks: self.blocks,
            unreadable: self.unreadable,
            wire: self.wire.looked(),
            models: self.by_contour.models.account(),
            restart_points,
            more_restart_points,
        }
    }
}

/// Faults of syntax after which a check gives up.
const SYNTAX_MAX: u64 = 1000;

#[cfg(test)]
mod tests;
