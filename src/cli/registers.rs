//! What the control holds and no program says: its offset registers, where it says `D1`, and what is keyed in for 4B.

use std::collections::BTreeMap;

use clap::Args;

use super::failure::{Exit, Failure};
use super::kind::Kind;
use crate::check::wire::Known;
use crate::formats::four_b::offset::Keyed;

/// The offset registers.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct Registers {
    /// What an offset register of the control holds, such as 1=0.125; may be given again
    #[arg(long, value_name = "N=MM", value_parser = register)]
    register: Vec<(u32, f64)>,
}

impl Registers {
    /// Each register, mm.
    pub(super) fn held(&self) -> BTreeMap<u32, f64> {
        self.register.iter().copied().collect()
    }
}

/// What is keyed into the control for a 4B program.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(super) struct KeyedIn {
    /// F, the offset keyed into the control of a 4B program, mm: positive outside the outline, negative inside
    #[arg(long, value_name = "MM", value_parser = distance, allow_negative_numbers = true)]
    offset: Option<f64>,
    /// A of a 4B program, how far its taper sets the wire's upper end off, mm
    #[arg(long, value_name = "MM", value_parser = distance, allow_negative_numbers = true)]
    taper: Option<f64>,
}

impl KeyedIn {
    /// What is keyed in for a program of a kind; none where nothing is said.
    pub(super) fn of(self, input: &str, kind: Kind) -> Result<Option<Keyed>, Failure> {
        if self.offset.is_none() && self.taper.is_none() {
            return Ok(None);
        }
        if kind != Kind::FourB {
            let message =
                format!("--offset and --taper are keyed in for 4B, and {input} is {}", kind.title());
            return Err(Failure::new(Exit::Usage, message)
                .help("leave them out; G-code has --register, and convert puts an offset on any program"));
        }
        Ok(Some(Keyed { offset: self.offset.unwrap_or(0.0), taper: self.taper }))
    }
}

/// What the control knows of its wire besides a program of a kind; none where there is nothing to know.
pub(super) fn known(kind: Kind, registers: &Registers, keyed: Option<Keyed>) -> Option<Known> {
    match kind {
        Kind::Gcode | Kind::Macro => Some(Known::Registers(registers.held())),
        Kind::FourB => keyed.map(Known::Keyed),
        Kind::ThreeB | Kind::Dxf | Kind::Part => None,
    }
}

/// An offset as it is said on the command line, mm.
pub(super) fn distance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= DISTANCE_MAX => Ok(value),
        _ => Err("an offset is a length in mm, up to 100".to_owned()),
    }
}

fn register(text: &str) -> Result<(u32, f64), String> {
    let distance = |mm: &str| mm.trim().parse::<f64>().ok().filter(|mm| mm.abs() <= DISTANCE_MAX);
    let split = text.split_once('=').and_then(|(n, mm)| Some((n.trim().parse().ok()?, distance(mm)?)));
    split.ok_or_else(|| "a register is a number and what it holds in mm, such as 1=0.125".to_owned())
}

/// No wire runs farther beside its contour, mm.
const DISTANCE_MAX: f64 = 100.0;
