//! From program text to the characters on the line: code, end of block, leader and trailer.
//!
//! ISO 840 is ASCII with even parity in bit 8; with seven data bits the port's own parity does the same, and the code is
//! plain ASCII. A character the code lacks stops the job before its block is offered. EIA, five-channel and custom
//! tables are not here yet.

use thiserror::Error;

/// The code of the characters.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Code {
    /// Seven bits, bit 8 clear: for ports whose framing has its own parity, or none.
    Ascii,
    /// Even parity in bit 8, made here: for ports with eight data bits.
    Iso,
}

/// What goes round the blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    /// The code.
    pub code: Code,
    /// The end of block.
    pub end_of_block: &'static [u8],
    /// A line before the first block, empty for none.
    pub leader: String,
    /// A line after the last block, empty for none.
    pub trailer: String,
}

/// A character that has no code.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[error("character {byte:02X}h at position {position} has no code on this tape")]
pub struct Unencodable {
    /// The character.
    pub byte: u8,
    /// Its position in the block, from 1.
    pub position: usize,
}

impl Tape {
    /// Appends a line of program text and its end of block, as characters for the line.
    ///
    /// # Errors
    ///
    /// When a character has no code; nothing is appended then.
    pub fn encode(&self, text: &[u8], line: &mut Vec<u8>) -> Result<(), Unencodable> {
        if let Some(at) = text.iter().position(|&byte| !is_coded(byte)) {
            return Err(Unencodable { byte: text[at], position: at + 1 });
        }
        match self.code {
            Code::Ascii => {
                line.extend_from_slice(text);
                line.extend_from_slice(self.end_of_block);
            }
            Code::Iso => {
                line.extend(text.iter().chain(self.end_of_block).map(|&byte| with_even_parity(byte)))
            }
        }
        Ok(())
    }

    /// The leader as characters for the line.
    ///
    /// # Errors
    ///
    /// When a character has no code.
    pub fn leader(&self) -> Result<Vec<u8>, Unencodable> {
        self.line(&self.leader)
    }

    /// The leader of a program taken up again: an end of block first, so that the control drops what it may have of a torn
    /// line.
    ///
    /// # Errors
    ///
    /// When a character has no code.
    pub fn resumed_leader(&self) -> Result<Vec<u8>, Unencodable> {
        let mut line = Vec::new();
        self.encode(b"", &mut line)?;
        line.extend(self.leader()?);
        Ok(line)
    }

    /// The trailer as characters for the line.
    ///
    /// # Errors
    ///
    /// When a character has no code.
    pub fn trailer(&self) -> Result<Vec<u8>, Unencodable> {
        self.line(&self.trailer)
    }

    fn line(&self, text: &str) -> Result<Vec<u8>, Unencodable> {
        let mut line = Vec::new();
        if !text.is_empty() {
            self.encode(text.as_bytes(), &mut line)?;
        }
        Ok(line)
    }
}

/// Characters a control reads as program: capitals, digits and what block formats use. Small letters and the rest of
/// ASCII raise a TH alarm on ISO controls (Fanuc manuals, as worked out in `docs/protocols.md`).
fn is_coded(byte: u8) -> bool {
    matches!(byte, b'A'..=b'Z' | b'0'..=b'9' | b' ' | b'.' | b'-' | b'+' | b'/' | b',' | b'(' | b')' | b'%' | b':' | b'=' | b'#' | b'*' | b'[' | b']')
}

/// Bit 8 set so that the number of ones is even.
fn with_even_parity(byte: u8) -> u8 {
    byte | (((byte.count_ones() & 1) as u8) << 7)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tape(code: Code) -> Tape {
        Tape { code, end_of_block: b"\n", leader: "%".to_owned(), trailer: String::new() }
    }

    #[test]
    fn iso_carries_even_parity_and_ascii_none() {
        let mut line = Vec::new();
        tape(Code::Iso).encode(b"B1C", &mut line).unwrap();
        // B 42h and LF 0Ah have two ones; 1 (31h) and C (43h) have three.
        assert_eq!(line, [0x42, 0xB1, 0xC3, 0x0A]);
        assert_eq!(tape(Code::Ascii).leader().unwrap(), b"%\n");
        assert_eq!(tape(Code::Ascii).resumed_leader().unwrap(), b"\n%\n");
        assert_eq!(tape(Code::Ascii).trailer().unwrap(), b"");
    }

    #[test]
    fn a_character_without_a_code_is_refused_with_its_position() {
        let error = tape(Code::Ascii).encode(b"B1?", &mut Vec::new()).unwrap_err();
        assert_eq!(error, Unencodable { byte: b'?', position: 3 });
    }
}
