//! A wire tilted further than the machine's guides let it.

use super::Finding;
use crate::motion::{Act, Motion, Taper};

/// Compares each taper with the machine's limit.
#[derive(Debug)]
pub(super) struct Tapers {
    /// Degrees; none when the profile does not say.
    most: Option<f64>,
}

/// Beyond this no wire guide is known to go, degrees.
const UPRIGHT_DEGREES: f64 = 90.0;

impl Tapers {
    pub(super) fn new(most: Option<f64>) -> Self {
        Self { most }
    }

    pub(super) fn see(&self, motion: &Motion, tell: &mut impl FnMut(Finding)) {
        let Act::Taper(Taper::On { angle, .. }) = motion.act else { return };
        if angle.abs() >= UPRIGHT_DEGREES {
            let message = format!("a taper of {angle}° lays the wire flat");
            tell(
                Finding::error("taper-limit", motion.spot, motion.block, message)
                    .help("the angle is in degrees from the upright wire"),
            );
        } else if let Some(most) = self.most
            && angle.abs() > most
        {
            let message = format!("a taper of {angle}°, and the machine tilts its wire by {most}° at most");
            tell(
                Finding::error("taper-limit", motion.spot, motion.block, message)
                    .help("cut it on another machine, or correct [taper] in the machine's profile"),
            );
        }
    }
}
