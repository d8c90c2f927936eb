//! Characters the code of the tape lacks.
//!
//! What is looked at is the text as it goes to the control: for 3B and 4B the block without white space, for G-code the
//! line as it stands, remarks included. Each character is told once, where it first stands.

use super::Finding;
use crate::place::Spot;
use crate::tape::Tape;

/// Encodes each text and throws the characters away.
#[derive(Debug)]
pub(super) struct Characters {
    tape: Tape,
    line: Vec<u8>,
    missing: Vec<Missing>,
}

/// A character without a code.
#[derive(Clone, Copy, Debug)]
struct Missing {
    byte: u8,
    block: u64,
    spot: Spot,
    count: u64,
}

impl Characters {
    pub(super) fn new(tape: Tape) -> Self {
        Self { tape, line: Vec::new(), missing: Vec::new() }
    }

    pub(super) fn see(&mut self, text: &[u8], block: u64, spot: Spot) {
        let mut from = 0;
        while let Some(rest) = text.get(from..) {
            self.line.clear();
            let Err(missing) = self.tape.encode(rest, &mut self.line) else { return };
            from += missing.position;
            match self.missing.iter_mut().find(|known| known.byte == missing.byte) {
                Some(known) => known.count += 1,
                None => {
                    let at = from as u64 - 1;
                    let spot = Spot { byte: spot.byte + at, column: spot.column + at, ..spot };
                    self.missing.push(Missing { byte: missing.byte, block, spot, count: 1 });
                }
            }
        }
    }

    pub(super) fn finish(&self, tell: &mut impl FnMut(Finding)) {
        for &Missing { byte, block, spot, count } in &self.missing {
            let shown = match byte {
                b'!'..=b'~' => format!("`{}`", byte as char),
                _ => format!("{byte:02X}h"),
            };
            let more = match count {
                1 => String::new(),
                2 => ", here and in 1 more place".to_owned(),
                count => format!(", here and in {} more places", count - 1),
            };
            let message = format!("the tape's code has no character for {shown}{more}");
            let finding = Finding::error("tape-code", spot, block, message)
                .help("write it in capitals, digits and the signs of the code, or leave the remark out");
            tell(Finding { width: 1, ..finding });
        }
    }
}
