//! Findings as they come, so many of a kind and no more, so that a bad program is told in a page.

use super::{Finding, Severity};

/// The findings of one run.
#[derive(Debug, Default)]
pub(super) struct Ledger {
    findings: Vec<Finding>,
    /// How many of each code there were, those not kept included.
    counts: Vec<(&'static str, u64)>,
    errors: u64,
    warnings: u64,
}

impl Ledger {
    pub(super) fn add(&mut self, finding: Finding) {
        match finding.severity {
            Severity::Error => self.errors += 1,
            Severity::Warning => self.warnings += 1,
        }
        let at = match self.counts.iter().position(|(code, _)| *code == finding.code) {
            Some(at) => at,
            None => {
                self.counts.push((finding.code, 0));
                self.counts.len() - 1
            }
        };
        let count = &mut self.counts[at].1;
        *count += 1;
        if *count <= TOLD_MAX {
            self.findings.push(finding);
        }
    }

    /// How many findings of a code there were.
    pub(super) fn of(&self, code: &str) -> u64 {
        self.counts.iter().find(|(known, _)| *known == code).map_or(0, |(_, count)| *count)
    }

    /// Errors and warnings.
    pub(super) fn counts(&self) -> (u64, u64) {
        (self.errors, self.warnings)
    }

    /// The findings in the order of the source, and how many more there were of each code.
    pub(super) fn finish(mut self) -> (Vec<Finding>, Vec<(&'static str, u64)>) {
        // What is about no place comes last.
        self.findings.sort_by_key(|finding| (finding.spot.line == 0, finding.spot.byte, finding.block));
        let more = self.counts.into_iter().filter(|(_, count)| *count > TOLD_MAX);
        (self.findings, more.map(|(code, count)| (code, count - TOLD_MAX)).collect())
    }
}

/// Findings of one code that are told in full.
const TOLD_MAX: u64 = 20;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::Spot;

    #[test]
    fn so_many_of_a_kind_are_told_and_the_rest_counted() {
        let mut ledger = Ledger::default();
        for n in (1..=30).rev() {
            let spot = Spot { byte: n, line: n, column: 1 };
            ledger.add(Finding::warning("a", spot, n, "x"));
        }
        ledger.add(Finding::error("b", Spot::default(), 0, "y"));
        assert_eq!((ledger.of("a"), ledger.counts()), (30, (1, 30)));
        let (findings, more) = ledger.finish();
        assert_eq!((findings.len() as u64, more), (TOLD_MAX + 1, vec![("a", 10)]));
        assert!(findings.is_sorted_by_key(|f| if f.spot.line == 0 { u64::MAX } else { f.spot.line }));
    }
}
