//! Arbitrary bytes, and programs of arbitrary pieces: refused or run, but never a panic, and never without end.

use std::sync::Arc;

use dripfeed::macros::block::{Block, Turn};
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::options::{Control, Options, Pointless, Semicolon, Skip};
use dripfeed::macros::program::{NoPrograms, Program};
use dripfeed::macros::run::Expansion;

const BLOCKS: usize = 2000;

#[test]
fn any_bytes() {
    bolero::check!().for_each(|bytes: &[u8]| {
        let Some((choice, text)) = bytes.split_first() else { return };
        everything(*choice, text);
    });
}

#[test]
fn any_pieces() {
    bolero::check!().with_type::<(u8, Vec<u8>)>().for_each(|(choice, pieces)| {
        let text: Vec<u8> =
            pieces.iter().flat_map(|n| PIECES[usize::from(*n) % PIECES.len()].bytes()).collect();
        everything(*choice, &text);
    });
}

#[test]
fn any_statements() {
    bolero::check!().with_type::<(u8, Vec<(u8, u8)>)>().for_each(|(choice, lines)| {
        let mut text = String::new();
        for (line, number) in lines {
            let line = LINES[usize::from(*line) % LINES.len()];
            text += &line.replace('@', &(number % 12).to_string());
            text.push('\n');
        }
        everything(*choice, text.as_bytes());
    });
}

/// Parses, checks and runs, whole and from a block on.
fn everything(choice: u8, text: &[u8]) {
    let options = Options {
        control: if choice & 1 == 0 { Control::Fanuc } else { Control::Haas },
        skip: if choice & 2 == 0 { Skip::Kept } else { Skip::Switches(u16::from(choice)) },
        semicolon: [Semicolon::Refused, Semicolon::EndOfBlock, Semicolon::Remark][usize::from(choice) % 3],
        pointless: [Pointless::Refused, Pointless::Whole, Pointless::LeastIncrement]
            [usize::from(choice / 3) % 3],
        repeat: (choice & 4 != 0).then_some(3),
        budget: 5000,
        in_force: if choice & 8 != 0 { vec![900, 10] } else { Vec::new() },
        ..Options::default()
    };
    let program = match Program::parse(text, &mut NoPrograms, &options) {
        Ok(program) => Arc::new(program),
        Err(errors) => {
            assert!(!errors.is_empty());
            for error in errors {
                assert!(!error.message.is_empty() && error.place.byte as usize <= text.len());
            }
            return;
        }
    };
    for finding in program.check::<Decimal>() {
        assert!(!finding.error.message.is_empty());
    }
    let all = blocks(&mut Expansion::new(Arc::clone(&program)));
    let from = all.len() / 2;
    let mut expansion = Expansion::<Decimal>::new(program);
    let mut left = from as u64;
    loop {
        match expansion.skip(&mut left, 777) {
            Ok(Turn::Working) => {}
            Ok(_) => break,
            Err(error) => panic!("{error}: the whole run had {from} blocks in front of it"),
        }
    }
    let tail = blocks(&mut expansion);
    let same = tail.iter().zip(&all[from..]).take_while(|(a, b)| a == b).count();
    assert!(
        same == all.len() - from && (tail.len() == same || all.len() == BLOCKS),
        "from {from} on, {same} are the same"
    );
}

/// The lines blocks come from, with how many words, up to a number of blocks or the first error.
fn blocks(expansion: &mut Expansion<Decimal>) -> Vec<(u64, String)> {
    let (mut block, mut made) = (Block::default(), Vec::new());
    while made.len() < BLOCKS {
        match expansion.turn(1000, &mut block) {
            Ok(Turn::Block) if block.words.is_empty() => assert!(!block.remarks.is_empty()),
            Ok(Turn::Block) => {
                let words: Vec<_> = block.words.iter().map(|word| (word.letter, word.amount)).collect();
                made.push((block.spot.line, format!("{words:?}")));
            }
            Ok(Turn::Working) => {}
            Ok(Turn::End) | Err(_) => break,
        }
    }
    made
}

const PIECES: [&str; 64] = [
    "#", "1", "2", "0", "10", "101", "500", ".", "5", "-", "+", "*", "/", "=", "[", "]", "\n", "\n", " ",
    "(", ")", ";", "X", "Y", "Z", "G", "M", "N", "O", "P", "L", "F", "I", "J", "K", "A", "IF", "THEN",
    "GOTO", "WHILE", "DO1", "END1", "DO2", "END2", "GT", "LE", "EQ", "NE", "AND", "OR", "MOD", "SQRT[",
    "SIN[", "ROUND[", "ATAN[", "G65P1", "M98P1", "M99", "O1\n", "#3000=", "#5001", "#<a>", "%", ",",
];

const LINES: [&str; 40] = [
    "#1=@",
    "#2=#1+@",
    "#1=#1-1",
    "#3=#1/#2",
    "#@=#1*2",
    "#1=SQRT[#1]",
    "#1=#0",
    "X#1",
    "G01 X[#1+@] Y#2",
    "G90",
    "G91",
    "G@ X1. F200",
    "IF[#1GT@]GOTO@",
    "IF[#1EQ#0]THEN#1=@",
    "GOTO@",
    "GOTO#1",
    "N@ X1.",
    "N@",
    "WHILE[#1LT@]DO1",
    "END1",
    "WHILE[#2NE@]DO2",
    "END2",
    "DO3",
    "END3",
    "G65 P1 A#1 B@.",
    "G66 P2 A@.",
    "G67",
    "M98 P@",
    "M97 P@",
    "M99",
    "M99 P@",
    "O@",
    "M30",
    "#[#1]=@",
    "#2=#[#1+@]",
    "#2=#5001",
    "X#4003",
    "#3006=1(A)",
    "/X@.",
    "(A)",
];
