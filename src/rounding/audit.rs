//! Where every model of the control would stand after each block, and how far from theory.
//!
//! The writer's own account of what it made: it runs the closed form, so it is a report, not a proof; the proof is
//! the control at the other end of the line.

use super::{Made, Role};
use crate::interpolator::{Fault, Model};
use crate::units::Position;

/// The running account.
#[derive(Clone, Debug)]
pub struct Audit {
    /// Blocks seen.
    pub blocks: u64,
    stands: [Position; 4],
    /// Where the first contour was opened; every turn comes back there.
    opened: Option<[Position; 4]>,
    /// Per model, in the order of [`Model::ALL`].
    errors: [Deviation; 4],
}

/// How far a model's path is from theory, micrometres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// The largest distance of a node from theory.
    pub node_um: f64,
    /// The distance between the last contour's end and the first one's opening.
    pub closure_um: f64,
}

impl Audit {
    /// An account that begins with the wire at `origin`.
    #[must_use]
    pub fn new(origin: Position) -> Self {
        Self { blocks: 0, stands: [origin; 4], opened: None, errors: [Deviation::default(); 4] }
    }

    /// Adds a block.
    ///
    /// # Errors
    ///
    /// When a model cannot run the block.
    pub fn add(&mut self, made: &Made) -> Result<(), Fault> {
        self.blocks += 1;
        if made.role == Role::Opening && self.opened.is_none() {
            self.opened = Some(self.stands);
        }
        let arc = matches!(made.block.motion, crate::formats::three_b::Motion::Arc(..));
        let mut before = Position::default();
        for (n, model) in Model::ALL.into_iter().enumerate() {
            // Arcs run alike under `rotated` and its neighbour `mirrored`.
            let moved =
                if arc && model == Model::Mirrored { before } else { model.displacement(&made.block)? };
            before = moved;
            self.stands[n] += moved;
            if made.at_node {
                let error = self.stands[n].distance_um(made.target);
                self.errors[n].node_um = self.errors[n].node_um.max(error);
            }
            if let (Role::Closing, true, Some(opened)) = (made.role, made.at_node, self.opened) {
                let gap = self.stands[n] - opened[n];
                let (x, y) = (gap.x.0 as f64, gap.y.0 as f64);
                self.errors[n].closure_um = (x * x + y * y).sqrt();
            }
        }
        Ok(())
    }

    /// Where the wire stands under a model.
    #[must_use]
    pub fn stands(&self, model: Model) -> Position {
        self.stands[model as usize]
    }

    /// The account of each model.
    #[must_use]
    pub fn deviations(&self) -> [(Model, Deviation); 4] {
        let mut n = 0;
        Model::ALL.map(|model| {
            n += 1;
            (model, self.errors[n - 1])
        })
    }
}
