//! Runs small programs and spells their blocks: a reading of its own, apart from the printer.
//!
//! A written word is spelled as its digits stand in the text, a computed one by its shortest exact spelling; words are
//! parted by blanks, blocks by semicolons: `G01 X1.5; X2`.

use std::collections::BTreeMap;
use std::sync::Arc;

use dripfeed::macros::block::{Amount, Block, Turn};
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::findings::MacroError;
use dripfeed::macros::number::Number;
use dripfeed::macros::options::Options;
use dripfeed::macros::program::{NoPrograms, Program, Programs};
use dripfeed::macros::run::Expansion;

/// Options as the tests take them: whatever has no point is whole, so that programs stay short.
pub(crate) fn options() -> Options {
    Options {
        pointless: dripfeed::macros::options::Pointless::Whole,
        in_force: vec![900],
        budget: 100_000,
        ..Options::default()
    }
}

/// Programs beside the main one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shelf(pub BTreeMap<u32, Vec<u8>>);

impl Programs for Shelf {
    fn load(&mut self, number: u32) -> Result<Option<Vec<u8>>, String> {
        Ok(self.0.get(&number).cloned())
    }

    fn numbers(&mut self) -> Result<Vec<u32>, String> {
        Ok(self.0.keys().copied().collect())
    }
}

/// What a program makes, or its first error; blocks made before an error stand in front of it.
pub(crate) fn made(text: &str) -> String {
    made_with(text, &options(), &mut NoPrograms)
}

pub(crate) fn made_with(text: &str, options: &Options, programs: &mut dyn Programs) -> String {
    match Program::parse(text.as_bytes(), programs, options) {
        Ok(program) => run::<Decimal>(program),
        Err(errors) => spelled(&errors[0]),
    }
}

pub(crate) fn parsed(text: &str) -> Program {
    Program::parse(text.as_bytes(), &mut NoPrograms, &options())
        .unwrap_or_else(|e| panic!("{}", spelled(&e[0])))
}

fn spelled(error: &MacroError) -> String {
    format!("error {}:{}: {error}", error.place.line, error.place.column)
}

pub(crate) fn run<N: Number>(program: Program) -> String {
    let mut expansion = Expansion::<N>::new(Arc::new(program));
    let mut block = Block::default();
    let mut blocks: Vec<String> = Vec::new();
    loop {
        match expansion.turn(1000, &mut block) {
            Ok(Turn::Block) => blocks.push(spell(expansion.program(), &block)),
            Ok(Turn::Working) => {}
            Ok(Turn::End) => return blocks.join("; "),
            Err(error) => {
                blocks.push(spelled(&error));
                return blocks.join("; ");
            }
        }
        assert!(blocks.len() <= 200_000, "the test program does not end");
    }
}

pub(crate) fn spell<N: Number>(program: &Program, block: &Block<N>) -> String {
    let mut words: Vec<String> = Vec::new();
    if block.skip > 0 {
        words.push(format!("/{}", block.skip));
    }
    if let Some(number) = block.number {
        words.push(format!("N{number}"));
    }
    for word in &block.words {
        let digits = match word.amount {
            Amount::Computed(value) => value.text(),
            Amount::Written { digits: (0, 0), number } => number.mantissa.to_string(),
            Amount::Written { digits, .. } => text(program, block.source, digits),
        };
        words.push(format!("{}{digits}", word.letter as char));
    }
    for remark in &block.remarks {
        words.push(format!("({})", text(program, block.source, *remark)));
    }
    words.join(" ")
}

fn text(program: &Program, source: u32, range: (u32, u32)) -> String {
    String::from_utf8_lossy(program.text(source, range)).into_owned()
}
