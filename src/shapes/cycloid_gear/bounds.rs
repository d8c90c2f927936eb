//! Which gears exist: every bound of the tooth, checked before the first block.
//!
//! Each refusal names the parameter, its value and the bound it broke. The bounds follow from the formulas the paper
//! prints; the paper itself checks none of them.

use thiserror::Error;

use super::{CycloidGear, Derived, Trim};

/// Why a gear cannot be cut.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Impossible {
    /// A number is not finite or not in its plain range.
    #[error("{name} = {value} is not allowed: it must be {rule}")]
    Number {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The plain range.
        rule: &'static str,
    },
    /// The root circle has no radius.
    #[error(
        "knf = {knf} puts the root at or inside the gear's centre: with {teeth} teeth it must be below {bound:.4}"
    )]
    RootAtCentre {
        /// knf as given.
        knf: f64,
        /// The number of teeth.
        teeth: u64,
        /// The bound on knf.
        bound: f64,
    },
    /// ρ > r_c, or the flank circle does not meet the pitch circle.
    #[error(
        "kp = {kp} makes the tip flank radius {rho:.4} mm, larger than the {r_c:.4} mm circle of its centres: no radial flank touches it"
    )]
    FlankRadius {
        /// kp as given.
        kp: f64,
        /// ρ, mm.
        rho: f64,
        /// r_c, mm.
        r_c: f64,
    },
    /// The tip flank arc never reaches the pitch circle.
    #[error(
        "kp = {kp} with kr = {kr}: the tip flank arc does not reach the pitch circle, so the tooth thickness cannot be measured there; kp must be between |kr| and {bound:.4}"
    )]
    PitchCircle {
        /// kp as given.
        kp: f64,
        /// kr as given.
        kr: f64,
        /// The upper bound on kp.
        bound: f64,
    },
    /// β ≤ 0.
    #[error(
        "ks = {ks} makes the tooth too thick (β = {beta_deg:.4}° is not above 0): it must be below {bound:.4}"
    )]
    ToothTooThick {
        /// ks as given.
        ks: f64,
        /// β, degrees.
        beta_deg: f64,
        /// The bound on ks.
        bound: f64,
    },
    /// φ ≤ 0.
    #[error(
        "ks = {ks} with {teeth} teeth leaves no tooth space (φ = {phi_deg:.4}° is not above 0): ks must be below {bound:.4}, or kp smaller"
    )]
    NoSpace {
        /// ks as given.
        ks: f64,
        /// The number of teeth.
        teeth: u64,
        /// φ, degrees.
        phi_deg: f64,
        /// The bound on ks.
        bound: f64,
    },
    /// ρ ≤ R'.
    #[error("tip-radius = {tip_radius} mm is not smaller than the tip flank radius kp·m = {rho:.4} mm")]
    TipRadius {
        /// R', mm.
        tip_radius: f64,
        /// ρ, mm.
        rho: f64,
    },
    /// r_c sin β > ρ − R'.
    #[error(
        "tip-radius = {tip_radius} mm does not fit between the tip flanks: it must be at most {bound:.4} mm (lower ks or raise kp for a thicker tooth)"
    )]
    TipTooNarrow {
        /// R', mm.
        tip_radius: f64,
        /// The bound on R', mm.
        bound: f64,
    },
    /// The flank between root arc and tip flank vanishes.
    #[error(
        "knf = {knf} makes the straight flank vanish (from radius {from:.4} mm to {to:.4} mm): with these parameters knf must be above {bound:.4}"
    )]
    FlankVanishes {
        /// knf as given.
        knf: f64,
        /// Where the flank would begin, mm from the centre.
        from: f64,
        /// Where it would end.
        to: f64,
        /// The bound on knf.
        bound: f64,
    },
    /// ρ_f − EE ≤ 0.
    #[error(
        "offset = {offset} mm is too much for the tooth space: its root radius is {rho_f:.4} mm, so the largest offset that fits is below that (wire diameter plus two spark gaps below {wire:.4} mm)"
    )]
    WireTooThick {
        /// EE, mm.
        offset: f64,
        /// ρ_f, mm.
        rho_f: f64,
        /// 2 ρ_f, mm.
        wire: f64,
    },
    /// With the root trimmed, even the flanks are gone.
    #[error(
        "offset = {offset} mm closes the tooth space: trimmed flanks would meet outside the flank; it must be below {bound:.4} mm"
    )]
    SpaceClosed {
        /// EE, mm.
        offset: f64,
        /// The bound on the offset, mm.
        bound: f64,
    },
    /// Inside a cavity the two flanks of a tooth meet before they reach the root.
    #[error(
        "offset = {offset} mm is more than half the tooth where it is narrowest: the wire's path would cross itself; it must be above {bound:.4} mm"
    )]
    ToothTooNarrow {
        /// EE, mm.
        offset: f64,
        /// The bound on the offset, mm.
        bound: f64,
    },
    /// The tip flanks vanish inside a cavity.
    #[error("offset = {offset} mm makes the tip flank vanish: it must be above {bound:.4} mm")]
    TipFlankVanishes {
        /// EE, mm.
        offset: f64,
        /// The bound on the offset, mm.
        bound: f64,
    },
}

impl Impossible {
    /// What the operator can do about it, one sentence.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::WireTooThick { .. } => {
                "use a thinner wire, or allow trimming (`--trim`, `trim = true`) and accept material left in the root"
            }
            Self::SpaceClosed { .. } | Self::ToothTooNarrow { .. } | Self::TipFlankVanishes { .. } => {
                "use a thinner wire"
            }
            Self::Number { .. }
            | Self::RootAtCentre { .. }
            | Self::FlankRadius { .. }
            | Self::PitchCircle { .. }
            | Self::ToothTooThick { .. }
            | Self::NoSpace { .. }
            | Self::TipRadius { .. }
            | Self::TipTooNarrow { .. }
            | Self::FlankVanishes { .. } => {
                "`dripfeed generate --explain gear` shows every parameter with its meaning"
            }
        }
    }
}

/// The most teeth a gear may have; beyond it a step of 2π/z is no longer told apart from its neighbour to the micron.
pub(super) const TEETH_MAX: u64 = 1_000_000;

impl CycloidGear {
    /// The derived quantities of the nominal tooth.
    ///
    /// # Errors
    ///
    /// When no such tooth exists.
    pub(crate) fn derived(&self) -> Result<Derived, Impossible> {
        let Self { module, teeth, kp, kr, ks, knf, tip_radius } = *self;
        let positive = "a finite number above 0";
        for (name, value) in [("module", module), ("kp", kp), ("ks", ks), ("knf", knf)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Impossible::Number { name, value, rule: positive });
            }
        }
        for (name, value) in [("kr", kr), ("tip-radius", tip_radius)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Impossible::Number { name, value, rule: "a finite number, 0 or more" });
            }
        }
        if !(3..=TEETH_MAX).contains(&teeth) {
            return Err(Impossible::Number {
                name: "teeth",
                value: teeth as f64,
                rule: "a whole number from 3 to 1000000",
            });
        }
        let z = teeth as f64;
        let r = module * z / 2.0;
        if r > R_MAX_MM {
            return Err(Impossible::Number {
                name: "module",
                value: module,
                rule: "such that the pitch radius is at most 100 m",
            });
        }
        let r_f = r - knf * module;
        if r_f <= 0.0 {
            return Err(Impossible::RootAtCentre { knf, teeth, bound: z / 2.0 });
        }
        let (rho, r_c) = (kp * module, r - kr * module);
        if rho > r_c {
            return Err(Impossible::FlankRadius { kp, rho, r_c });
        }
        let cos_pitch = (r * r + r_c * r_c - rho * rho) / (2.0 * r * r_c);
        if !(-1.0..1.0).contains(&cos_pitch) {
            return Err(Impossible::PitchCircle { kp, kr, bound: (r + r_c) / module });
        }
        let at_pitch = libm::acos(cos_pitch);
        let beta = at_pitch - ks * module / (2.0 * r);
        if beta <= 0.0 {
            let bound = 2.0 * r * at_pitch / module;
            return Err(Impossible::ToothTooThick { ks, beta_deg: beta.to_degrees(), bound });
        }
        let theta = libm::asin(rho / r_c) - beta;
        let phi = std::f64::consts::PI / z - theta;
        if phi <= 0.0 {
            let bound = 2.0 * r * (at_pitch + std::f64::consts::PI / z - libm::asin(rho / r_c)) / module;
            return Err(Impossible::NoSpace { ks, teeth, phi_deg: phi.to_degrees(), bound });
        }
        if rho <= tip_radius {
            return Err(Impossible::TipRadius { tip_radius, rho });
        }
        let across = r_c * libm::sin(beta);
        if across > rho - tip_radius {
            return Err(Impossible::TipTooNarrow { tip_radius, bound: rho - across });
        }
        let sin_phi = libm::sin(phi);
        let rho_f = r_f * sin_phi / (1.0 - sin_phi);
        let from = (r_f + rho_f) * libm::cos(phi);
        let to = (r_c * r_c - rho * rho).sqrt();
        if to <= from {
            // from = r_f·cos φ / (1 − sin φ), linear in r_f.
            let r_f_bound = to * (1.0 - sin_phi) / libm::cos(phi);
            return Err(Impossible::FlankVanishes { knf, from, to, bound: (r - r_f_bound) / module });
        }
        Ok(Derived { r_c, r_f, rho, beta, theta, phi, rho_f })
    }
}

/// Checks the wire's offset, mm, against the tooth.
pub(super) fn offset(gear: &CycloidGear, offset: f64, trim: Trim) -> Result<(), Impossible> {
    if !offset.is_finite() {
        return Err(Impossible::Number { name: "offset", value: offset, rule: "a finite number" });
    }
    let Derived { r_c, r_f, rho, beta, theta, phi, rho_f } = gear.derived()?;
    if rho_f - offset <= 0.0 {
        if trim == Trim::Refuse {
            return Err(Impossible::WireTooThick { offset, rho_f, wire: 2.0 * rho_f });
        }
        // Along the flank the corner stands at offset / tan φ, and must stay below the flank's top.
        let flank_top = (r_c * r_c - rho * rho).sqrt();
        let bound = flank_top * libm::tan(phi);
        if offset >= bound {
            return Err(Impossible::SpaceClosed { offset, bound });
        }
    }
    // The flank begins at this distance from the gear's centre, where the tooth is narrowest.
    let bound = -(r_f + rho_f) * libm::cos(phi) * libm::tan(theta);
    if offset <= bound {
        return Err(Impossible::ToothTooNarrow { offset, bound });
    }
    if gear.tip_radius + offset <= 0.0 {
        // The trimmed tip stands on the axis where the tip flanks meet; it must lie beyond the top of the flank,
        // which it does while the flank's normal through the centre points to the near side of the axis.
        let across = r_c * libm::sin(beta);
        let bound = across / libm::cos(theta) - rho;
        if offset <= bound {
            return Err(Impossible::TipFlankVanishes { offset, bound });
        }
    }
    Ok(())
}

/// The largest pitch radius, mm: so that every coordinate stays far inside what the block arithmetic holds.
const R_MAX_MM: f64 = 100_000.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn with(change: impl FnOnce(&mut CycloidGear)) -> Impossible {
        let mut gear = CycloidGear::default();
        change(&mut gear);
        gear.derived().expect_err("such a tooth cannot exist")
    }

    #[test]
    fn every_bound_of_the_tooth_is_refused_by_name() {
        assert!(matches!(with(|g| g.ks = 3.2), Impossible::NoSpace { .. }));
        assert!(matches!(with(|g| g.ks = 5.0), Impossible::ToothTooThick { .. }));
        assert!(matches!(with(|g| g.tip_radius = 0.9), Impossible::TipRadius { .. }));
        assert!(matches!(with(|g| g.tip_radius = 0.35), Impossible::TipTooNarrow { .. }));
        assert!(matches!(with(|g| g.kp = 18.0), Impossible::FlankRadius { .. }));
        assert!(matches!(with(|g| g.kp = 0.1), Impossible::PitchCircle { .. }));
        assert!(matches!(with(|g| g.knf = 0.85), Impossible::FlankVanishes { .. }));
        assert!(matches!(with(|g| g.knf = 18.0), Impossible::RootAtCentre { .. }));
        assert!(matches!(with(|g| g.module = f64::NAN), Impossible::Number { name: "module", .. }));
        assert!(matches!(with(|g| g.teeth = 0), Impossible::Number { name: "teeth", .. }));
    }

    #[test]
    fn the_flank_vanishes_at_the_stated_bound() {
        let Impossible::FlankVanishes { bound, .. } = with(|g| g.knf = 0.5) else { panic!("wrong refusal") };
        assert!((1.003..1.005).contains(&bound), "{bound}");
        assert!(CycloidGear { knf: bound + 1e-6, ..CycloidGear::default() }.derived().is_ok());
        assert!(CycloidGear { knf: bound - 1e-6, ..CycloidGear::default() }.derived().is_err());
    }
}
