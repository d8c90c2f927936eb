//! The journal: what a job may have sent, written down before the bytes go out.
//!
//! An append-only text file a job, one self-contained, checked line a fact, readable at the machine. Before a block may
//! go on the line its number is covered by a durable *horizon*; after a crash the journal may claim more than was sent,
//! never less. [`history`] reads a journal back, [`resume`] decides what may follow; both are pure. [`writer`] is the one
//! thread that writes and syncs.

#![warn(clippy::wildcard_enum_match_arm)]

pub mod history;
pub mod resume;
pub mod writer;

use serde::{Deserialize, Serialize};

/// The first line of every journal.
pub const FIRST_LINE: &str = "dripfeed-journal 1";

/// A fact.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(tag = "fact", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Record {
    /// What the job is. The first record of every journal.
    Job(Job),
    /// Intent: from now on blocks up to this one may be on the line.
    Horizon {
        /// The last block covered.
        block: u64,
    },
    /// The program's text up to here has this chained digest.
    Segment {
        /// The last block of the segment.
        block: u64,
        /// H(previous value ‖ text), hexadecimal.
        value: String,
    },
    /// The whole program's text, stop word included, has this chained digest.
    Whole {
        /// Its blocks.
        blocks: u64,
        /// See `Segment`.
        value: String,
    },
    /// Known to have been handed to the link whole.
    Sent {
        /// The last such block.
        block: u64,
        /// Bytes handed over since the job or its resumption began.
        bytes: u64,
    },
    /// The job goes on from a block the operator named.
    Resumed {
        /// The first block sent again or next.
        block: u64,
        /// When, RFC 3339.
        at: String,
        /// Where to.
        port: String,
    },
    /// The job ended.
    Ended(Ended),
}

/// What a job is: enough to make its program again.
#[derive(Clone, Debug, Deserialize, Eq, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// The job's name, also its file's.
    pub job: String,
    /// When it began, RFC 3339.
    pub started: String,
    /// The version of the program that made it.
    pub version: String,
    /// Where the program came from: a path, or `-`.
    pub source: String,
    /// `part`, `3b`.
    pub kind: String,
    /// Digest of the source's bytes; empty when it could be read only once.
    pub source_digest: String,
    /// The machine profile's name and the digest of its values.
    pub machine: String,
    /// See `machine`.
    pub machine_digest: String,
    /// Where it was sent.
    pub port: String,
    /// What was changed of the profile on the command line: baud, framing and `KEY=VALUE` pairs, in order.
    pub settings: Vec<String>,
    /// The first block sent.
    pub from_block: u64,
}

/// How a job ended.
#[derive(Clone, Debug, Deserialize, Eq, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Ended {
    /// How.
    pub how: How,
    /// In words.
    pub reason: String,
    /// The last block handed to the link whole.
    pub block: u64,
    /// Bytes of the next line that were handed over, if it was cut in two.
    pub torn_bytes: u64,
    /// Bytes handed over by this run, leader included.
    pub bytes: u64,
    /// When, RFC 3339.
    pub at: String,
}

/// How a job ended, in a word.
#[derive(Clone, Copy, Debug, Deserialize, Eq, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum How {
    /// All sent.
    Done,
    /// By the operator.
    Stopped,
    /// By the control, the link or the program.
    Failed,
}

impl Record {
    /// The record as a line: JSON, a blank, the CRC-32 of the JSON in hexadecimal, LF.
    #[must_use]
    pub fn to_line(&self) -> String {
        // Strings and integers always have a JSON form.
        let json = serde_json::to_string(self).unwrap_or_default();
        format!("{json} {:08x}\n", checksum(json.as_bytes()))
    }

    /// Reads a line without its LF; none when it is not whole and true.
    #[must_use]
    pub fn from_line(line: &[u8]) -> Option<Self> {
        let at = line.len().checked_sub(9)?;
        let (json, tail) = line.split_at(at);
        let sum = u32::from_str_radix(std::str::from_utf8(tail.strip_prefix(b" ")?).ok()?, 16).ok()?;
        if sum != checksum(json) {
            return None;
        }
        serde_json::from_slice(json).ok()
    }
}

/// CRC-32 as in ISO-HDLC (Ethernet, zip).
fn checksum(bytes: &[u8]) -> u32 {
    crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_survives_its_line_and_no_flipped_bit_does() {
        let record = Record::Horizon { block: 123_456 };
        let line = record.to_line();
        assert_eq!(Record::from_line(line.trim_end().as_bytes()), Some(record));
        for bit in 0..8 * (line.len() - 1) {
            let mut bytes = line.trim_end().as_bytes().to_vec();
            bytes[bit / 8] ^= 1 << (bit % 8);
            // A small letter in the checksum's hexadecimal may become a capital and mean the same.
            let same_sum = bytes.to_ascii_lowercase() == line.trim_end().as_bytes();
            assert!(same_sum || Record::from_line(&bytes).is_none(), "bit {bit}");
        }
    }
}
