//! The decoded program text, as it is digested: without parity, NUL, CR and `%` lines, each end of block as one LF.
//!
//! Only what the control has taken as program is here: not what label skip discarded, nor an unfinished block that was
//! dropped. So a program that was broken off and gone on with gives the digest of the whole.

use sha2::{Digest, Sha256};

use crate::observer::Observer;

#[derive(Default)]
pub(crate) struct Text {
    digest: Sha256,
    /// The last character put was an LF, or none has been put.
    at_line_start: bool,
    any: bool,
    /// The link closed, or a program ended, within a line: what comes next begins a line of its own.
    break_owed: bool,
}

impl Text {
    /// Takes up a piece. Several line ends in a row are one; at the very beginning they end nothing.
    pub(crate) fn put(&mut self, piece: &[u8], observer: &mut impl Observer) {
        let mut clean = Vec::with_capacity(piece.len() + 1);
        if std::mem::take(&mut self.break_owed) && !self.at_line_start && !piece.starts_with(b"\n") {
            clean.push(b'\n');
        }
        for &byte in piece {
            if byte == b'\n' && (self.at_line_start || !self.any) {
                continue;
            }
            clean.push(byte);
            self.any = true;
            self.at_line_start = byte == b'\n';
        }
        self.digest.update(&clean);
        observer.text(&clean);
    }

    /// What comes next begins a line of its own.
    pub(crate) fn break_line(&mut self) {
        self.break_owed = self.any;
    }

    pub(crate) fn sha256(&self) -> String {
        use std::fmt::Write as _;
        let mut hex = String::with_capacity(64);
        for byte in self.digest.clone().finalize() {
            let _ = write!(hex, "{byte:02x}");
        }
        hex
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::Unobserved;

    fn digest_of(pieces: &[&[u8]]) -> String {
        let mut text = Text::default();
        for piece in pieces {
            text.put(piece, &mut Unobserved);
        }
        text.sha256()
    }

    #[test]
    fn the_digest_of_abc_is_the_published_one() {
        // FIPS 180-4, example for one block.
        let wanted = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(digest_of(&[b"a", b"bc"]), wanted);
    }

    #[test]
    fn line_ends_in_a_row_are_one_and_the_first_of_all_is_none() {
        assert_eq!(digest_of(&[b"\n", b"a\n", b"\n\nb\n"]), digest_of(&[b"a\nb\n"]));
        assert_ne!(digest_of(&[b"a\nb\n"]), digest_of(&[b"ab\n"]));
    }

    #[test]
    fn a_broken_line_gets_its_end_once() {
        for rest in [&b"b\n"[..], b"\nb\n"] {
            let mut text = Text::default();
            text.put(b"a", &mut Unobserved);
            text.break_line();
            text.put(rest, &mut Unobserved);
            assert_eq!(text.sha256(), digest_of(&[b"a\nb\n"]));
        }
    }
}
