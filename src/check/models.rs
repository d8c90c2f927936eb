//! Where each model of a 3B control would stand after every block.
//!
//! Which variant of the interpolator a control runs is not documented, so a program is good when it ends up at the same
//! place under all of them. The four are run side by side in closed form; where they come to stand more than 3 µm apart
//! the program is one for a certain control only, and that is told once, with the first and the worst block.

use super::Finding;
use super::contours::{Drift, Held, Run};
use crate::formats::three_b::{Block, Motion as Instruction};
use crate::interpolator::{Fault, Model};
use crate::motion::{Act, Motion};
use crate::place::Spot;
use crate::units::{Micrometres, Position};

/// What one model would do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelAccount {
    /// The model.
    pub model: Model,
    /// The farthest that a node lies from where the `exact` model has it, µm.
    pub node_um: f64,
    /// The farthest that a contour ends from where it began, µm; none when no contour closed.
    pub closure_um: Option<f64>,
    /// Where the program ends, µm.
    pub end: Position,
}

/// Nodes may be so far apart, µm.
const SPREAD_UM: f64 = 3.0;

/// Runs the models.
#[derive(Debug)]
pub(super) struct Models {
    accounts: [ModelAccount; 4],
    blocks: u64,
    drift: Drift,
    first: Option<(u64, Spot)>,
    worst: (f64, u64),
    /// A model that could not run a block stands still there; told once a model.
    faulted: [bool; 4],
    worst_closure: Option<(f64, Model, u64, Spot)>,
}

impl Default for Models {
    fn default() -> Self {
        let account =
            |model| ModelAccount { model, node_um: 0.0, closure_um: None, end: Position::default() };
        Self {
            accounts: Model::ALL.map(account),
            blocks: 0,
            drift: Drift::default(),
            first: None,
            worst: (0.0, 0),
            faulted: [false; 4],
            worst_closure: None,
        }
    }
}

impl Models {
    /// Runs a block; returns where the models stand, seen from where the program says.
    pub(super) fn see(
        &mut self,
        motion: &Motion,
        block: Option<&Block>,
        tell: &mut impl FnMut(Finding),
    ) -> Drift {
        let (Act::Move { element, .. }, Some(block)) = (&motion.act, block) else { return self.drift };
        self.blocks += 1;
        let arc = matches!(block.motion, Instruction::Arc(..));
        let mut before = Ok(Position::default());
        for (account, faulted) in self.accounts.iter_mut().zip(&mut self.faulted) {
            // Arcs run alike under `rotated` and its neighbour `mirrored`.
            if !(arc && account.model == Model::Mirrored) {
                before = account.model.displacement(block);
            }
            match before {
                Ok(way) => account.end += way,
                Err(fault) if !std::mem::replace(faulted, true) => {
                    tell(fault_of(account.model, fault, motion))
                }
                Err(_) => {}
            }
        }
        let stands = self.accounts.map(|account| account.end);
        let spread = spread(&stands);
        if spread > SPREAD_UM {
            self.first.get_or_insert((motion.block, motion.spot));
        }
        if spread > self.worst.0 {
            self.worst = (spread, motion.block);
        }
        let exact = stands[3];
        for account in &mut self.accounts {
            account.node_um = account.node_um.max(distance(account.end, exact));
        }
        let said = element.end();
        let said = Position { x: Micrometres::nearest(said.x), y: Micrometres::nearest(said.y) };
        self.drift = stands.map(|stand| [(stand - said).x, (stand - said).y].map(clamped));
        self.drift
    }

    pub(super) fn see_run(&mut self, run: &Run<'_>) {
        let Run::Ring { ring, drift, .. } = *run else { return };
        let (Some(first), Some(last)) = (ring.first(), ring.last()) else { return };
        if self.blocks == 0 {
            return;
        }
        for (n, account) in self.accounts.iter_mut().enumerate() {
            let gap = closure_um(first, last, drift[n], n);
            account.closure_um = Some(account.closure_um.unwrap_or(0.0).max(gap));
            if gap > SPREAD_UM && self.worst_closure.is_none_or(|(worst, ..)| gap > worst) {
                self.worst_closure = Some((gap, account.model, last.block, last.spot));
            }
        }
    }

    pub(super) fn finish(&mut self, tell: &mut impl FnMut(Finding)) {
        const HELP: &str = "make the program for every control (--interpolator any), or settle which model \
                            the control runs by a calibration cut";
        if let Some((block, spot)) = self.first {
            let (worst, at) = self.worst;
            let message = format!(
                "from here on the control's models stand more than 3 µm apart, at block {at} {worst:.1} µm"
            );
            tell(Finding::warning("model-spread", spot, block, message).help(HELP));
        }
        if let Some((gap, model, block, spot)) = self.worst_closure {
            let message =
                format!("under the {} model the contour that ends here closes to {gap:.1} µm", model.name());
            tell(Finding::warning("model-closure", spot, block, message).help(HELP));
        }
    }

    /// What each model would do; nothing when no 3B block was seen.
    pub(super) fn account(&self) -> Option<[ModelAccount; 4]> {
        (self.blocks > 0).then_some(self.accounts)
    }
}

fn fault_of(model: Model, fault: Fault, motion: &Motion) -> Finding {
    let message = format!("under the {} model {fault}", model.name());
    Finding::warning("model-fault", motion.spot, motion.block, message)
        .help("a control of this kind would hang or alarm here; check G and the digit of Z")
}

/// How far a model comes to stand from where it began a ring, µm.
fn closure_um(first: &Held, last: &Held, drift: [i32; 2], model: usize) -> f64 {
    let said = (last.element.end() - first.element.start()) * 1000.0;
    let began = first.drift[model];
    let x = said.x.round() + f64::from(drift[0]) - f64::from(began[0]);
    let y = said.y.round() + f64::from(drift[1]) - f64::from(began[1]);
    (x * x + y * y).sqrt()
}

/// The largest distance between two of them, µm.
fn spread(stands: &[Position; 4]) -> f64 {
    let mut most = 0.0f64;
    for (n, a) in stands.iter().enumerate() {
        for b in &stands[n + 1..] {
            if a != b {
                most = most.max(distance(*a, *b));
            }
        }
    }
    most
}

fn distance(a: Position, b: Position) -> f64 {
    let way = a - b;
    let (x, y) = (way.x.0 as f64, way.y.0 as f64);
    (x * x + y * y).sqrt()
}

/// A drift of two metres and more is as good as any larger one.
fn clamped(way: Micrometres) -> i32 {
    way.0.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}
