//! The run itself: block by block, with fuel, from any block on.

use std::sync::Arc;

use dripfeed::macros::binary::Binary;
use dripfeed::macros::block::{Block, Turn};
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::number::Number;
use dripfeed::macros::run::Expansion;

use crate::spelling::{made, parsed, run, spell};

/// Loops, calls of every kind, dropped words, remarks, a modal call, computed codes and positions.
const EVERYTHING: &str = "(START)\nG90 G01 X0. Y0.\n#1=0\nWHILE[#1LT4]DO1\nG65 P1 A[#1*2] B#9 L2\n(TURN)\nX#1 Y#9\nX#9\n\
    #1=#1+1\nEND1\nG66 P2 A1.\nX1.\nG#4003 X2.\nM08\nG67\nM98 P3\n#3006=1(LOOK)\nM97 P100\nX[#5001+1]\nM30\n\
    N100 Y[#5002+0.5]\nM99\nO1\nX#1 Z#2\n#1=#1+10\nM99\nO2\nZ#1\n#1=#1+1\nM99\nO3\n/A1.\nB1.\nM99\n";

fn counted(program: &dripfeed::macros::program::Program) -> Vec<String> {
    let mut expansion = Expansion::<Decimal>::new(Arc::new(program.clone()));
    let (mut block, mut blocks) = (Block::default(), Vec::new());
    loop {
        match expansion.turn(u32::MAX, &mut block).unwrap_or_else(|e| panic!("{e}")) {
            Turn::Block if block.words.is_empty() => {}
            Turn::Block => blocks.push(spell(program, &block)),
            Turn::Working => {}
            Turn::End => return blocks,
        }
    }
}

#[test]
fn from_any_block_on_the_rest_is_the_tail() {
    let program = parsed(EVERYTHING);
    let all = counted(&program);
    assert!(all.len() > 20, "{all:?}");
    for from in 0..=all.len() {
        for fuel in [1, 3, u32::MAX] {
            let mut expansion = Expansion::<Decimal>::new(Arc::new(program.clone()));
            let mut left = from as u64;
            while expansion.skip(&mut left, fuel).unwrap() == Turn::Working {}
            assert_eq!(left, 0);
            let (mut block, mut blocks) = (Block::default(), Vec::new());
            loop {
                match expansion.turn(fuel, &mut block).unwrap() {
                    Turn::Block if block.words.is_empty() => {}
                    Turn::Block => blocks.push(spell(&program, &block)),
                    Turn::Working => {}
                    Turn::End => break,
                }
            }
            assert_eq!(blocks, all[from..], "from {from}");
        }
    }
    let mut expansion = Expansion::<Decimal>::new(Arc::new(program));
    let mut left = all.len() as u64 + 3;
    assert_eq!(expansion.skip(&mut left, u32::MAX).unwrap(), Turn::End);
    assert_eq!(left, 3);
}

#[test]
fn little_fuel_changes_nothing() {
    let program = parsed(EVERYTHING);
    let mut expansion = Expansion::<Decimal>::new(Arc::new(program.clone()));
    let (mut block, mut blocks, mut working) = (Block::default(), Vec::new(), 0);
    loop {
        match expansion.turn(1, &mut block).unwrap() {
            Turn::Block => blocks.push(spell(&program, &block)),
            Turn::Working => working += 1,
            Turn::End => break,
        }
    }
    assert_eq!(blocks.join("; "), made(EVERYTHING));
    assert!(working > 50);
    assert_eq!(expansion.turn(0, &mut block).unwrap(), Turn::End, "the end stays the end");
}

#[test]
fn nothing_is_made_behind_an_error() {
    let mut expansion = Expansion::<Decimal>::new(Arc::new(parsed("X1.\n#1=1/#0\nX2.\n")));
    let mut block = Block::default();
    assert_eq!(expansion.turn(9, &mut block).unwrap(), Turn::Block);
    assert!(expansion.turn(9, &mut block).is_err());
    assert_eq!(expansion.turn(9, &mut block).unwrap(), Turn::End);
}

#[test]
fn a_block_knows_its_line() {
    let program = parsed("#1=0\nWHILE[#1LT2]DO1\n  N7 G01 X#1 (HERE)\n#1=#1+1\nEND1\n");
    let mut expansion = Expansion::<Decimal>::new(Arc::new(program.clone()));
    let mut block = Block::default();
    let mut sources = Vec::new();
    while expansion.turn(99, &mut block).unwrap() == Turn::Block {
        assert_eq!((block.spot.line, block.spot.column, block.number), (3, 3, Some(7)));
        assert_eq!(program.line(block.source), b"  N7 G01 X#1 (HERE)");
        assert_eq!(program.text(block.source, block.remarks[0]), b"HERE");
        sources.push(block.source);
    }
    assert_eq!(sources[0], sources[1]);
    assert_eq!(sources.len(), 2);
}

/// Blocks of a loop from a start down to an end, in decimals and in binary floating point.
fn loop_blocks<N: Number>(from: &str, to: &str, step: &str) -> (usize, String) {
    let text = format!("#1={from}\nWHILE[#1GT{to}]DO1\n#1=#1-{step}\nX#1\nEND1\n");
    let made = run::<N>(parsed(&text));
    let last = made.rsplit("; ").next().unwrap_or_default().to_owned();
    (made.split("; ").count(), last)
}

#[test]
fn decimal_loops_have_their_nominal_count_and_end_on_the_point() {
    let loops = [
        ("25", "20", "0.02", 250),
        ("27", "20", "0.02", 350),
        ("27", "25", "0.02", 100),
        ("1", "0", "0.1", 10),
        ("1", "0", "0.01", 100),
        ("1", "0", "0.001", 1000),
        ("0.3", "0", "0.1", 3),
        ("0.7", "0", "0.1", 7),
        ("2", "-2", "0.05", 80),
        ("10", "0", "0.3", 34),
        ("90", "0", "0.9", 100),
        ("360", "0", "0.25", 1440),
        ("100", "99", "0.07", 15),
        ("5.5", "3.3", "0.11", 20),
        ("-1", "-3", "0.4", 5),
        ("12.7", "0", "0.0254", 500),
        ("1", "0", "0.003", 334),
        ("0.1", "0", "0.0001", 1000),
        ("50", "0", "0.05", 1000),
        ("3", "2.4", "0.06", 10),
        ("200", "199.3", "0.07", 10),
        ("1000.001", "1000", "0.0001", 10),
    ];
    let mut differ = 0;
    for (from, to, step, count) in loops {
        let (made, last) = loop_blocks::<Decimal>(from, to, step);
        assert_eq!(made, count, "{from} {to} {step}");
        let exact = ["10", "100", "1"].contains(&from) && ["0.3", "0.07", "0.003"].contains(&step);
        assert_eq!(last == format!("X{to}"), !exact, "{from} {to} {step}: {last}");
        differ += usize::from(loop_blocks::<Binary>(from, to, step).0 != count);
    }
    assert!(differ >= 5, "binary floating point overruns in {differ} of them only");
}
