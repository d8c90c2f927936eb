//! M98 and M99: subprograms behind the main program.

use std::collections::BTreeMap;

use super::{Fault, GcodePlan, Read};
use crate::dialect::gcode::Line;

/// A fault, and the line it was found in.
type Found = (Fault, u64);

/// Where a running program stands.
enum Flow {
    Goes,
    /// M02, M30.
    Ended,
}

impl GcodePlan {
    /// Runs the rest of a program, from its first call on, now that its subprograms have been read.
    pub(super) fn run_collected(&mut self, lines: &[Read]) -> Result<(), Found> {
        let ends = |read: &Read| says(&read.line, 'M', 2) || says(&read.line, 'M', 30);
        let Some(last) = lines.iter().position(ends) else {
            let place = lines.last().map_or(0, |read| read.line.place);
            return Err((Fault::new("call", "neither M02 nor M30 before the subprograms"), place));
        };
        let (main, behind) = lines.split_at(last + 1);
        let mut subprograms: BTreeMap<i64, &[Read]> = BTreeMap::new();
        let mut rest = behind;
        while let Some(read) = rest.first() {
            let body = rest.iter().position(|read| says(&read.line, 'M', 99)).map_or(rest.len(), |at| at + 1);
            let Some(number) = number_of(&read.line, 'O') else {
                return Err((Fault::new("call", "no O in front of a subprogram"), read.line.place));
            };
            if subprograms.insert(number, &rest[..body]).is_some() {
                return Err((Fault::new("call", &format!("O{number} twice")), read.line.place));
            }
            rest = &rest[body..];
        }
        self.run(main, &subprograms, 0, &mut 0).map(|_| ())
    }

    fn run(
        &mut self,
        body: &[Read],
        subprograms: &BTreeMap<i64, &[Read]>,
        depth: u32,
        count: &mut usize,
    ) -> Result<Flow, Found> {
        for read in body {
            let line = &read.line;
            let at = |fault| (fault, line.place);
            *count += 1;
            if *count > LINES_MAX {
                return Err(at(Fault::new("call", "too many lines carried out")));
            }
            if self.is_skipped(line) {
                continue;
            }
            if says(line, 'M', 99) {
                return match depth {
                    0 => Err(at(no_caller())),
                    _ => Ok(Flow::Goes),
                };
            }
            if !says(line, 'M', 98) {
                self.carry_out(line, read.characters).map_err(at)?;
                if self.over {
                    return Ok(Flow::Ended);
                }
                continue;
            }
            let other = line.words.iter().find(|word| !matches!(word.letter, 'N' | 'M' | 'P' | 'L'));
            if let Some(word) = other {
                return Err(at(Fault::new("word", &format!("{word}: beside M98"))));
            }
            let number = number_of(line, 'P').ok_or_else(|| at(Fault::new("call", "M98 without P")))?;
            let Some(called) = subprograms.get(&number) else {
                return Err(at(Fault::new("call", &format!("no subprogram O{number}"))));
            };
            if depth == DEPTH_MAX {
                return Err(at(Fault::new("call", &format!("O{number} called {DEPTH_MAX} deep"))));
            }
            for _ in 0..number_of(line, 'L').unwrap_or(1) {
                if let Flow::Ended = self.run(called, subprograms, depth + 1, count)? {
                    return Ok(Flow::Ended);
                }
            }
        }
        Ok(Flow::Goes)
    }
}

pub(super) fn no_caller() -> Fault {
    Fault::new("call", "M99 in the main program")
}

/// Whether a line holds this code.
pub(super) fn says(line: &Line, letter: char, code: i64) -> bool {
    line.words.iter().any(|word| word.letter == letter && word.number.whole() == Some(code))
}

fn number_of(line: &Line, letter: char) -> Option<i64> {
    line.words.iter().find(|word| word.letter == letter)?.number.whole()
}

/// Most lines of a program that calls, kept or carried out. A guess; it bounds memory and time.
pub(super) const LINES_MAX: usize = 1_000_000;

/// Calls within calls: four, as on common controls.
const DEPTH_MAX: u32 = 4;
