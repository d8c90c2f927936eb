//! Which variables there are, and where their values are kept.
//!
//! Everything an operation touches is a cell of one array: the locals of the level that runs, the commons, the named
//! ones, intermediate results, and the numbers of the program's text. A variable by number finds its cell without a
//! search.
//!
//! Numbers as Fanuc (B-63684EN, chapter 16) and Haas (96-8000, macros) give them. What only the machine can know is told
//! apart from what does not exist: neither is ever taken as null.

use std::ops::Range;

/// `#0` and the locals `#1`-`#33`.
pub(super) const LOCALS: Range<u16> = 0..34;
/// The locals and the names without an underscore in front: what a macro call saves.
pub(super) const FRAME: Range<u16> = 0..98;
/// `#100`-`#199` and `#500`-`#999`.
const COMMONS: Range<u16> = FRAME.end..FRAME.end + 600;
/// Results within one line.
pub(super) const RESULTS: Range<u16> = COMMONS.end..COMMONS.end + 256;
/// Names that begin with an underscore: the same on every level.
pub(super) const NAMES: Range<u16> = RESULTS.end..RESULTS.end + 256;
/// The numbers of the text.
pub(super) const CONSTANTS: u16 = NAMES.end;

/// What stands behind a number.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Variable {
    /// `#0`: always undefined.
    Null,
    /// One whose value is kept here.
    Kept(u16),
    /// `#4001`…: the G code of a group that is in force.
    Group(u8),
    /// `#4102`…: the last number behind a letter.
    Letter(u8),
    /// `#5001`…: the end of the last block, by axis from 0.
    Position(u8),
    /// `#3011`: year, month, day.
    Date,
    /// `#3012`: hour, minute, second.
    Time,
    /// `#3000`: writing it is an alarm.
    Alarm,
    /// `#3006`: writing it is a stop with a text.
    Message,
    /// One that only the machine knows.
    Machine(&'static str),
    /// None.
    None,
}

/// What a number means.
pub(super) fn variable(number: i64) -> Variable {
    match number {
        0 => Variable::Null,
        1..=33 => Variable::Kept(number as u16),
        100..=199 => Variable::Kept(COMMONS.start + (number - 100) as u16),
        500..=999 => Variable::Kept(COMMONS.start + 100 + (number - 500) as u16),
        1000..=1999 => Variable::Machine("an input or output of the machine"),
        2000..=2999 => Variable::Machine("an offset kept in the machine"),
        3000 => Variable::Alarm,
        3001 | 3002 => Variable::Machine("a timer of the machine"),
        3003..=3005 | 3007 | 3008 => Variable::Machine("a setting of the machine"),
        3006 => Variable::Message,
        3011 => Variable::Date,
        3012 => Variable::Time,
        3009..=3999 => Variable::Machine("a state of the machine"),
        4001..=4030 => Variable::Group((number - 4000) as u8),
        4102 => Variable::Letter(b'B'),
        4107 => Variable::Letter(b'D'),
        4108 => Variable::Letter(b'E'),
        4109 => Variable::Letter(b'F'),
        4111 => Variable::Letter(b'H'),
        4113 => Variable::Letter(b'M'),
        4114 => Variable::Letter(b'N'),
        4115 => Variable::Letter(b'O'),
        4119 => Variable::Letter(b'S'),
        4120 => Variable::Letter(b'T'),
        4000..=4999 => Variable::Machine("a modal state that a program's text does not tell"),
        5001..=5020 => Variable::Position((number - 5001) as u8),
        5021..=5040 => Variable::Machine("a position in the machine's own coordinates"),
        5041..=5060 => Variable::Machine("the position at this moment, offsets included"),
        5061..=5080 => Variable::Machine("where a skip signal came"),
        5081..=5999 => Variable::Machine("an offset or deviation of the machine"),
        6000..=9999 => Variable::Machine("an offset or parameter of the machine"),
        _ => Variable::None,
    }
}

/// How a cell is written in a program; none for a result or a number of the text.
pub(super) fn name_of(cell: u16, local_names: &[String], names: &[String]) -> Option<String> {
    let named = |list: &[String], at: u16| list.get(usize::from(at)).map(|name| format!("#<{name}>"));
    if LOCALS.contains(&cell) {
        Some(format!("#{cell}"))
    } else if FRAME.contains(&cell) {
        named(local_names, cell - LOCALS.end)
    } else if COMMONS.contains(&cell) {
        let at = cell - COMMONS.start;
        Some(format!("#{}", if at < 100 { at + 100 } else { at + 400 }))
    } else if NAMES.contains(&cell) {
        named(names, cell - NAMES.start)
    } else {
        None
    }
}

/// Whether a cell is one of a variable.
pub(super) fn is_variable(cell: u16) -> bool {
    cell != 0 && (cell < RESULTS.start || NAMES.contains(&cell))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variable_that_is_kept_has_a_cell_of_its_own_and_its_name_back() {
        let mut seen = std::collections::BTreeSet::new();
        for number in 0..100_000 {
            if let Variable::Kept(cell) = variable(number) {
                assert!(seen.insert(cell) && cell < RESULTS.start && is_variable(cell));
                assert_eq!(name_of(cell, &[], &[]), Some(format!("#{number}")));
            }
        }
        assert_eq!(seen.len(), 33 + 100 + 500);
    }

    #[test]
    fn what_the_machine_knows_and_what_is_nothing_are_told_apart() {
        for number in [1000, 2001, 3001, 3002, 4130, 5021, 5041, 5061, 5221, 7001] {
            assert!(matches!(variable(number), Variable::Machine(_)), "#{number}");
        }
        for number in [-1, 34, 99, 200, 499, 10_000] {
            assert_eq!(variable(number), Variable::None, "#{number}");
        }
    }
}
