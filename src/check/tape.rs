//! Characters the code of the tape lacks.
//!
//! What is looked at is the text as it goes to the control: for 3B and 4B the block without white space, for G-code the
//! line as it stands.

use super::Finding;
use crate::place::Spot;
use crate::tape::Tape;

/// Encodes each text and throws the characters away.
#[derive(Debug)]
pub(super) struct Characters {
    tape: Tape,
    line: Vec<u8>,
}

impl Characters {
    pub(super) fn new(tape: Tape) -> Self {
        Self { tape, line: Vec::new() }
    }

    pub(super) fn see(&mut self, text: &[u8], block: u64, spot: Spot, tell: &mut impl FnMut(Finding)) {
        self.line.clear();
        let Err(missing) = self.tape.encode(text, &mut self.line) else { return };
        let at = missing.position as u64 - 1;
        let spot = Spot { byte: spot.byte + at, column: spot.column + at, ..spot };
        let shown = if (b'!'..=b'~').contains(&missing.byte) {
            format!("`{}`", missing.byte as char)
        } else {
            format!("{:02X}h", missing.byte)
        };
        let finding =
            Finding::error("tape-code", spot, block, format!("the tape's code has no character for {shown}"))
                .help("write it in capitals, digits and the signs of the code, or leave the remark out");
        tell(Finding { width: 1, ..finding });
    }
}
