//! What the offset registers of the control hold: no program says it where it says `D1`.

use std::collections::BTreeMap;

use clap::Args;

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

fn register(text: &str) -> Result<(u32, f64), String> {
    let distance = |mm: &str| mm.trim().parse::<f64>().ok().filter(|mm| mm.abs() <= DISTANCE_MAX);
    let split = text.split_once('=').and_then(|(n, mm)| Some((n.trim().parse().ok()?, distance(mm)?)));
    split.ok_or_else(|| "a register is a number and what it holds in mm, such as 1=0.125".to_owned())
}

/// No wire runs farther beside its contour, mm.
const DISTANCE_MAX: f64 = 100.0;
