//! Whole macro programs, told in custom macro B and in the dialect of `rs274`: the same moves in the same order.
//!
//! The dialects meet in assignments, expressions, loops, conditions, subprograms with arguments and their local variables;
//! they are spelled otherwise (`WHILE … END` against O words). What `rs274` reckons in binary floating point differs from
//! decimals in the last digits only, so values are kept away from where a condition would turn on that.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fmt::Write as _;
use std::sync::Arc;

use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::expanded::{Expanded, Step};
use dripfeed::macros::form::Form;
use dripfeed::macros::options::Options;
use dripfeed::macros::printer::Printer;
use dripfeed::macros::program::{NoPrograms, Program};

use crate::gcode::{call, interpreted};

/// Half of what four decimals cannot say, on both sides, and what binary floating point adds.
const NODE: f64 = 0.000_11;

#[test]
fn random_programs_move_as_rs274_moves() {
    let (mut moves, mut programs) = (0, 0);
    for seed in 0..100 {
        let told = Told::random(seed);
        let (ours, theirs) = (ours(&told.macro_b), theirs(&told.rs274));
        assert_eq!(ours.len(), theirs.len(), "seed {seed}\n{}\n{}", told.macro_b, told.rs274);
        for (n, (our, their)) in ours.iter().zip(&theirs).enumerate() {
            for axis in 0..3 {
                let apart = (our[axis] - their[axis]).abs();
                assert!(apart <= NODE, "seed {seed}, move {n}: {our:?} {their:?}\n{}", told.macro_b);
            }
        }
        moves += ours.len();
        programs += usize::from(ours.len() > 20);
    }
    assert!(moves > 5_000 && programs > 60, "{moves} moves, {programs} programs");
}

/// The one known difference: where the sum of decimal steps decides, `rs274` goes round once more.
#[test]
fn the_papers_loop_ends_on_its_point_where_rs274_overruns() {
    let ours = ours("#1=25\nWHILE[#1GT20]DO1\n#1=#1-0.02\nG01 X#1 Y0. Z0. F1\nEND1\n");
    let theirs = theirs("#1=25\no1 while [#1 GT 20]\n#1=[#1-0.02]\nG01 X#1 Y0. Z0. F1\no1 endwhile\nM2\n");
    assert_eq!((ours.len(), theirs.len()), (250, 251));
    assert_eq!((ours[249][0], theirs[250][0]), (20.0, 19.98));
}

fn ours(text: &str) -> Vec<[f64; 3]> {
    let options = Options { pointless: dripfeed::macros::options::Pointless::Whole, ..Options::default() };
    let program = Program::parse(text.as_bytes(), &mut NoPrograms, &options)
        .unwrap_or_else(|errors| panic!("{}: {:?}\n{text}", errors[0], errors[0].place));
    let form = Form { decimals: [4, 4], ..Form::default() };
    let mut lines = Expanded::<Decimal>::new(Arc::new(program), Printer::new(form, false));
    let (mut points, mut line) = (Vec::new(), Vec::new());
    loop {
        line.clear();
        match lines.next_line(u32::MAX, &mut line).unwrap_or_else(|e| panic!("{e} {e:?}\n{text}")) {
            Step::End => return points,
            Step::Block => {}
            _ => continue,
        }
        let words = std::str::from_utf8(&line).unwrap().split(' ');
        let mut point = [0.0; 3];
        let mut is_move = false;
        for word in words {
            if let Some(axis) = "XYZ".find(&word[..1]) {
                point[axis] = word[1..].parse().unwrap();
                is_move = true;
            }
        }
        if is_move {
            points.push(point);
        }
    }
}

fn theirs(text: &str) -> Vec<[f64; 3]> {
    let calls = interpreted(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let moves = calls.lines().filter_map(call).filter(|(name, _)| *name == "STRAIGHT_FEED");
    moves.map(|(_, numbers)| [numbers[0], numbers[1], numbers[2]]).collect()
}

/// One program in both dialects.
struct Told {
    macro_b: String,
    rs274: String,
    dice: u64,
    /// O words and N numbers used.
    label: u32,
}

impl Told {
    fn random(seed: u64) -> Self {
        let mut told = Self {
            macro_b: String::from("G21 G90\n"),
            rs274: String::from("G21 G90\n"),
            dice: seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1,
            label: 100,
        };
        // Subprograms stand in front here and behind there.
        let mut behind = String::new();
        for name in [901, 902] {
            let main = (std::mem::take(&mut told.macro_b), std::mem::take(&mut told.rs274));
            told.statements(&[1, 2, 3], 5, 2, &[]);
            let body =
                (std::mem::replace(&mut told.macro_b, main.0), std::mem::replace(&mut told.rs274, main.1));
            write!(behind, "O{name}\n{}M99\n", body.0).unwrap();
            write!(told.rs274, "o{name} sub\n{}o{name} endsub\n", body.1).unwrap();
        }
        for variable in [101, 102, 103, 104, 110, 111, 112] {
            told.both(&format!("#{variable}={}.\n", variable % 7));
        }
        told.statements(&[101, 102, 103, 104], 40, 1, &[901, 902]);
        write!(told.macro_b, "M30\n{behind}").unwrap();
        told.rs274.push_str("M2\n");
        told
    }

    fn below(&mut self, bound: u64) -> u64 {
        self.dice ^= self.dice << 13;
        self.dice ^= self.dice >> 7;
        self.dice ^= self.dice << 17;
        (self.dice >> 20) % bound
    }

    fn both(&mut self, text: &str) {
        self.macro_b.push_str(text);
        self.rs274.push_str(text);
    }

    /// Statements over variables; loops count in `#110` and up, or in locals, by their depth.
    fn statements(&mut self, variables: &[u32], count: u64, depth: u32, calls: &[u32]) {
        for _ in 0..count {
            let variable = variables[self.below(variables.len() as u64) as usize];
            match self.below(10) {
                0..=2 => {
                    // Whatever it comes to, a sine of it stays small.
                    let (times, value) = (1 + self.below(40), self.expression(variables, 3));
                    self.both(&format!("#{variable}=[{times}*SIN[{value}]]\n"));
                }
                3..=5 => {
                    let [x, y, z] = [(); 3].map(|()| self.expression(variables, 2));
                    self.both(&format!("G01 X[{x}] Y[{y}] Z[{z}] F100\n"));
                }
                6 => {
                    let condition = self.condition(variables);
                    let value = self.expression(variables, 2);
                    self.label += 1;
                    writeln!(self.macro_b, "IF[{condition}]THEN #{variable}=[0.5*COS[{value}]]").unwrap();
                    let label = self.label;
                    writeln!(
                        self.rs274,
                        "o{label} if [{condition}]\n#{variable}=[0.5*COS[{value}]]\no{label} endif"
                    )
                    .unwrap();
                }
                7 => {
                    // What is not to be done is jumped over.
                    let condition = self.condition(variables);
                    self.label += 1;
                    let label = self.label;
                    writeln!(self.macro_b, "IF[{condition}]GOTO{label}").unwrap();
                    writeln!(self.rs274, "o{label} if [{condition}]\no{label} else").unwrap();
                    self.statements(variables, 2, depth + 9, &[]);
                    writeln!(self.macro_b, "N{label} #{variable}=#{variable}").unwrap();
                    writeln!(self.rs274, "o{label} endif").unwrap();
                }
                8 if depth <= 3 => {
                    let (turns, counter) = (self.below(6), if variables[0] < 100 { 20 } else { 110 } + depth);
                    self.label += 1;
                    let label = self.label;
                    self.both(&format!("#{counter}=0\n"));
                    writeln!(self.macro_b, "WHILE[#{counter}LT{turns}]DO{depth}").unwrap();
                    writeln!(self.rs274, "o{label} while [#{counter} LT {turns}]").unwrap();
                    self.statements(variables, 3, depth + 1, calls);
                    self.both(&format!("#{counter}=[#{counter}+1]\n"));
                    writeln!(self.macro_b, "END{depth}").unwrap();
                    writeln!(self.rs274, "o{label} endwhile").unwrap();
                }
                _ => {
                    let Some(name) = calls.get(self.below(2) as usize) else { continue };
                    let [a, b, c] = [(); 3].map(|()| self.expression(variables, 2));
                    writeln!(self.macro_b, "G65 P{name} A[{a}] B[{b}] C[{c}]").unwrap();
                    writeln!(self.rs274, "o{name} call [{a}] [{b}] [{c}]").unwrap();
                }
            }
        }
    }

    fn condition(&mut self, variables: &[u32]) -> String {
        let variable = variables[self.below(variables.len() as u64) as usize];
        let sign = ["GT", "LT", "GE", "LE"][self.below(4) as usize];
        // Values are whole, or sines of what is hardly ever this.
        format!("#{variable} {sign} {}.377", self.below(9))
    }

    /// In brackets throughout: how signs bind is judged elsewhere.
    fn expression(&mut self, variables: &[u32], depth: u32) -> String {
        let variable = variables[self.below(variables.len() as u64) as usize];
        if depth == 0 || self.below(5) == 0 {
            return match self.below(3) {
                0 => format!("{}.{:02}", self.below(50), self.below(100)),
                _ => format!("#{variable}"),
            };
        }
        let a = self.expression(variables, depth - 1);
        let b = self.expression(variables, depth - 1);
        match self.below(10) {
            0..=2 => format!("[{a}+{b}]"),
            3 | 4 => format!("[{a}-{b}]"),
            5 => format!("[{a}*{b}*0.1]"),
            6 => format!("[{a}/[2.5+ABS[{b}]]]"),
            7 => format!("SQRT[ABS[{a}]]"),
            8 => format!("COS[{a}]"),
            // Below 0 the makers differ: 0 to 360 degrees, or -180 to 180.
            _ => format!("ATAN[ABS[{a}]]/[1.25+ABS[{b}]]"),
        }
    }
}
