//! Reading a journal back: a torn tail is cut, a bad record before it is refused with its byte.

use thiserror::Error;

use super::{Ended, FIRST_LINE, Job, Record};

/// What a journal says.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// The job.
    pub job: Job,
    /// The last block that may have been on the line.
    pub horizon: u64,
    /// The last block known to have been handed over whole.
    pub sent: u64,
    /// Segment ends and their values, in order of block.
    pub segments: Vec<(u64, String)>,
    /// The whole program's blocks and value, if it was made to its end.
    pub whole: Option<(u64, String)>,
    /// The horizon when the last run began: what earlier runs may have sent.
    pub before: u64,
    /// Whether a part of a line may stand in the control.
    pub may_be_torn: bool,
    /// How the last run ended; none if it broke off.
    pub ended: Option<Ended>,
    /// How many times the job was resumed.
    pub resumptions: u64,
    /// Bytes of the journal that are whole; what is behind them is a torn tail.
    pub whole_bytes: u64,
}

/// Why a journal cannot be used.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[non_exhaustive]
pub enum Unreadable {
    /// It does not begin as a journal.
    #[error("the file is not a dripfeed journal of version 1")]
    NotAJournal,
    /// It was cut before the job was written down.
    #[error("the journal breaks off before its first record")]
    Empty,
    /// A record is damaged, and it is not the last one.
    #[error("the journal is damaged at byte {byte}: the record there does not match its checksum")]
    Damaged {
        /// Where the record begins.
        byte: u64,
    },
    /// Records contradict each other.
    #[error("the journal contradicts itself at byte {byte}: {what}")]
    Contradiction {
        /// Where the record begins.
        byte: u64,
        /// How.
        what: &'static str,
    },
}

impl History {
    /// Reads a journal.
    ///
    /// # Errors
    ///
    /// When it is not one, holds no job yet, or is damaged before its tail.
    pub fn read(bytes: &[u8]) -> Result<Self, Unreadable> {
        let mut lines = Lines { bytes, at: 0 };
        match lines.next() {
            Some((_, line, true)) if line == FIRST_LINE.as_bytes() => {}
            Some((_, line, false)) if FIRST_LINE.as_bytes().starts_with(line) => {
                return Err(Unreadable::Empty);
            }
            None => return Err(Unreadable::Empty),
            Some(_) => return Err(Unreadable::NotAJournal),
        }
        let mut history: Option<Self> = None;
        while let Some((start, line, ended)) = lines.next() {
            let record = if ended { Record::from_line(line) } else { None };
            let Some(record) = record else {
                // The last record may be torn by a crash; one with others behind it may not.
                if lines.at < bytes.len() {
                    return Err(Unreadable::Damaged { byte: start as u64 });
                }
                break;
            };
            let byte = start as u64;
            match (&mut history, record) {
                (None, Record::Job(job)) => {
                    let before = job.from_block.saturating_sub(1);
                    history = Some(Self {
                        job,
                        horizon: before,
                        sent: before,
                        segments: Vec::new(),
                        whole: None,
                        before,
                        may_be_torn: true,
                        ended: None,
                        resumptions: 0,
                        whole_bytes: 0,
                    });
                }
                (None, _) => {
                    return Err(Unreadable::Contradiction { byte, what: "a fact comes before its job" });
                }
                (Some(_), Record::Job(_)) => {
                    return Err(Unreadable::Contradiction { byte, what: "a second job in one journal" });
                }
                (Some(history), record) => history.add(record),
            }
            if let Some(history) = &mut history {
                history.whole_bytes = lines.at as u64;
            }
        }
        history.ok_or(Unreadable::Empty)
    }

    fn add(&mut self, record: Record) {
        match record {
            Record::Job(_) => {}
            Record::Horizon { block } => self.horizon = self.horizon.max(block),
            Record::Segment { block, value } => {
                if self.segments.last().is_none_or(|(last, _)| *last < block) {
                    self.segments.push((block, value));
                }
            }
            Record::Whole { blocks, value } => self.whole = Some((blocks, value)),
            Record::Sent { block, .. } => self.sent = self.sent.max(block),
            Record::Resumed { block, .. } => {
                self.resumptions += 1;
                self.before = self.horizon;
                self.ended = None;
                self.sent = block.saturating_sub(1);
            }
            Record::Ended(ended) => {
                self.sent = ended.block;
                // A run that ended in order knows exactly how far it got; an earlier one may have gone further.
                self.horizon = self.before.max(ended.block + u64::from(ended.torn_bytes > 0));
                // One that sent nothing leaves the control as it found it.
                if ended.bytes > 0 {
                    self.may_be_torn = ended.torn_bytes > 0;
                } else if self.resumptions == 0 {
                    self.may_be_torn = false;
                }
                self.ended = Some(ended);
            }
        }
    }

    /// The job's state in a word.
    #[must_use]
    pub fn state(&self) -> &'static str {
        match self.ended.as_ref().map(|e| e.how) {
            Some(super::How::Done) => "done",
            Some(super::How::Stopped) => "stopped",
            Some(super::How::Failed) => "failed",
            None => "broken-off",
        }
    }
}

/// Lines with their start and whether an LF ended them.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<(usize, &'a [u8], bool)> {
        let start = self.at;
        let rest = self.bytes.get(start..).filter(|rest| !rest.is_empty())?;
        match rest.iter().position(|&b| b == b'\n') {
            Some(end) => {
                self.at = start + end + 1;
                Some((start, &rest[..end], true))
            }
            None => {
                self.at = self.bytes.len();
                Some((start, rest, false))
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::journal::How;

    /// A history that says no more than a journal of one job would.
    pub(in crate::journal) fn history(horizon: u64, sent: u64) -> History {
        History {
            job: job(),
            horizon,
            sent,
            segments: Vec::new(),
            whole: None,
            before: 0,
            may_be_torn: true,
            ended: None,
            resumptions: 0,
            whole_bytes: 0,
        }
    }

    pub(in crate::journal) fn job() -> Job {
        Job {
            job: "gear-1".to_owned(),
            started: "2026-01-01T00:00:00Z".to_owned(),
            version: "0.1.0".to_owned(),
            source: "gear.toml".to_owned(),
            kind: "part".to_owned(),
            source_digest: "00".to_owned(),
            machine: "generic-iso".to_owned(),
            machine_digest: "11".to_owned(),
            port: "/dev/ttyUSB0".to_owned(),
            settings: Vec::new(),
            from_block: 1,
        }
    }

    fn journal() -> (Vec<u8>, Vec<usize>) {
        let records = [
            Record::Job(job()),
            Record::Horizon { block: 16 },
            Record::Segment { block: 16, value: "aa".to_owned() },
            Record::Sent { block: 9, bytes: 200 },
            Record::Horizon { block: 48 },
            Record::Sent { block: 30, bytes: 700 },
        ];
        let mut bytes = format!("{FIRST_LINE}\n").into_bytes();
        let mut ends = Vec::new();
        for record in records {
            bytes.extend_from_slice(record.to_line().as_bytes());
            ends.push(bytes.len());
        }
        (bytes, ends)
    }

    #[test]
    fn cut_at_every_byte_it_recovers_to_a_clean_prefix() {
        let (bytes, ends) = journal();
        for cut in 0..=bytes.len() {
            let whole = ends.iter().rev().find(|&&end| end <= cut);
            match (History::read(&bytes[..cut]), whole) {
                (Ok(history), Some(&end)) => {
                    assert_eq!(history.whole_bytes, end as u64, "cut at {cut}");
                    assert_eq!(history, History::read(&bytes[..end]).unwrap());
                }
                (Err(Unreadable::Empty), None) => {}
                (other, whole) => panic!("cut at {cut}: {other:?}, {whole:?} whole"),
            }
        }
        let history = History::read(&bytes).unwrap();
        assert_eq!((history.horizon, history.sent, history.state()), (48, 30, "broken-off"));
    }

    #[test]
    fn a_damaged_record_before_the_tail_is_refused_with_its_byte() {
        let (mut bytes, ends) = journal();
        bytes[ends[1] + 5] ^= 1;
        assert_eq!(History::read(&bytes), Err(Unreadable::Damaged { byte: ends[1] as u64 }));
        assert_eq!(History::read(b"hello\n"), Err(Unreadable::NotAJournal));
    }

    #[test]
    fn an_orderly_end_says_exactly_how_far_it_got() {
        let (mut bytes, _) = journal();
        let ended = Ended {
            how: How::Stopped,
            reason: String::new(),
            block: 31,
            torn_bytes: 4,
            bytes: 600,
            at: String::new(),
        };
        bytes.extend_from_slice(Record::Ended(ended).to_line().as_bytes());
        let history = History::read(&bytes).unwrap();
        assert_eq!((history.horizon, history.sent, history.state()), (32, 31, "stopped"));
        assert!(history.may_be_torn);
    }

    #[test]
    fn a_later_run_that_sent_little_takes_nothing_back() {
        let (mut bytes, _) = journal();
        let resumed = Record::Resumed { block: 20, at: String::new(), port: String::new() };
        bytes.extend_from_slice(resumed.to_line().as_bytes());
        let ended = Ended {
            how: How::Stopped,
            reason: String::new(),
            block: 19,
            torn_bytes: 0,
            bytes: 0,
            at: String::new(),
        };
        bytes.extend_from_slice(Record::Ended(ended).to_line().as_bytes());
        let history = History::read(&bytes).unwrap();
        assert_eq!((history.horizon, history.state()), (48, "stopped"));
        assert!(
            history.may_be_torn,
            "the first run broke off, and the second sent nothing that would clear it"
        );
    }
}
