//! The arguments of a macro call: which letter sets which variable.
//!
//! Specification I names a variable a letter; specification II gives up to ten sets of I, J and K behind A, B and C. Which
//! is meant is seen by I, J or K standing more than once; where both set a variable, the later one holds (Fanuc
//! B-63684EN/01, page 278; the table of both in Haas 96-8000, macros).

use super::findings::{At, Fault};

/// Gives out variables for the letters of one call.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Arguments {
    /// How often I, J and K stood.
    counts: [u16; 3],
    /// The set that is being written, and the last letter of it.
    set: u16,
    last: Option<usize>,
}

impl Arguments {
    /// The local variable that the next argument sets.
    pub(super) fn variable(&mut self, letter: u8, at: At) -> Result<u16, Fault> {
        if let Some(variable) = specification_one(letter) {
            return Ok(variable);
        }
        let Some(index) = b"IJK".iter().position(|l| *l == letter) else {
            let message = format!("{} is no letter of an argument", letter as char);
            return Err(Fault::syntax(at, message, "G, L, N, O and P cannot be arguments"));
        };
        // A letter that is not behind the last one begins a set. That and its count must name the same set: `J1. I2.` and
        // `I1. I2. J3.` are forbidden by the manual and read in two ways by controls.
        if self.last.is_some_and(|last| index <= last) {
            self.set += 1;
        }
        if self.counts[index] != self.set {
            let letter = letter as char;
            return Err(Fault::syntax(
                at,
                format!("{letter} out of order among I, J and K: which variable it sets is not certain"),
                "write I, J and K in this order, and whole sets where they stand more than once",
            ));
        }
        if self.set >= 10 {
            return Err(Fault::syntax(
                at,
                "more than ten sets of I, J and K",
                "#4 to #33 are there for them",
            ));
        }
        self.counts[index] += 1;
        self.last = Some(index);
        Ok(4 + 3 * self.set + index as u16)
    }
}

/// The letters that always set the same variable.
fn specification_one(letter: u8) -> Option<u16> {
    Some(match letter {
        b'A'..=b'C' => u16::from(letter - b'A') + 1,
        b'D'..=b'F' => u16::from(letter - b'D') + 7,
        b'H' => 11,
        b'M' => 13,
        b'Q'..=b'Z' => u16::from(letter - b'Q') + 17,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variables(letters: &str) -> Result<Vec<u16>, Fault> {
        let mut arguments = Arguments::default();
        letters.bytes().map(|letter| arguments.variable(letter, At::default())).collect()
    }

    #[test]
    fn specification_one_is_the_table_of_the_manuals() {
        // Haas 96-8000 Rev AC, page 93: letters in the order of their variables.
        let letters = "ABCIJKDEFHMQRSTUVWXYZ";
        let expected = [1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 13, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26];
        assert_eq!(variables(letters).unwrap(), expected);
    }

    #[test]
    fn specification_two_counts_sets() {
        assert_eq!(variables(&format!("ABC{}", "IJK".repeat(10))).unwrap(), (1..=33).collect::<Vec<_>>());
        // Fanuc B-63684EN/01, page 278: `A1.0 B2.0 I-3.0 I4.0 D5.0`.
        assert_eq!(variables("ABIID").unwrap(), [1, 2, 4, 7, 7]);
        assert!(variables(&"IJK".repeat(11)).is_err());
    }

    #[test]
    fn what_is_read_in_two_ways_is_refused() {
        for letters in ["JI", "IIJ", "KJ", "IJIK", "G", "L", "N", "O", "P"] {
            assert!(variables(letters).is_err(), "{letters}");
        }
    }
}
