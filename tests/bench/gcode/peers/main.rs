//! Ours beside the readers of the crates `gcode` and `async-gcode`, in one run, on one program:
//! `cargo bench --manifest-path tests/bench/gcode/peers/Cargo.toml`.
//!
//! The peers are asked for as little as they give: words are counted and thrown away. They keep no modal state.

#![expect(clippy::unwrap_used, reason = "a benchmark that cannot go on has nothing to say")]

#[path = "../measured.rs"]
mod measured;

use std::hint::black_box;

use dripfeed::formats::gcode::{Blocks, Boundaries, Dialect};
use futures::executor::block_on;
use gcode::core::{
    BlockVisitor, CommandVisitor, ControlFlow, HasDiagnostics, Noop, Number, ProgramVisitor, Span, Value,
};

use measured::{RUNS, program, row};

fn main() {
    if !std::env::args().any(|argument| argument == "--bench") {
        println!("run with `cargo bench`");
        return;
    }
    let program = program();
    let dialect = Dialect::generic().unwrap();
    println!("| what | MB/s, median of {RUNS} | lowest - highest |\n|---|---|---|");
    row("dripfeed, boundaries: blocks and N numbers", &program, |text| {
        let mut boundaries = Boundaries::new(text.as_bytes(), &dialect);
        let mut sum = 0;
        while let Some(boundary) = boundaries.next_boundary().unwrap() {
            sum += u64::from(black_box(boundary).label.unwrap_or(0));
        }
        sum
    });
    row("dripfeed, blocks: words, places, modal state", &program, |text| {
        let mut blocks = Blocks::new(text.as_bytes(), &dialect);
        let mut count = 0;
        while let Some(block) = blocks.next_block().unwrap() {
            count += black_box(block).words.len() as u64;
        }
        count
    });
    row("gcode 0.7, visitor", &program, |text| {
        let mut counter = Counter::default();
        gcode::core::parse(text, &mut counter);
        assert!(counter.blocks > 2_000_000);
        black_box(counter.words)
    });
    row("async-gcode 0.3, bytes in memory", &program, |text| {
        let bytes = text.bytes().map(Result::<u8, async_gcode::Error>::Ok);
        let mut parser = async_gcode::Parser::new(futures::stream::iter(bytes));
        let (mut words, mut wrong) = (0, 0);
        block_on(async {
            while let Some(read) = parser.next().await {
                match black_box(read) {
                    Ok(_) => words += 1,
                    Err(_) => wrong += 1,
                }
            }
        });
        assert!(wrong < 3, "{wrong}");
        words
    });
}

#[derive(Default)]
struct Counter {
    blocks: u64,
    words: u64,
    diagnostics: Noop,
}

struct Block<'a>(&'a mut Counter);
struct Command<'a>(&'a mut Counter);

impl HasDiagnostics for Counter {
    fn diagnostics(&mut self) -> &mut dyn gcode::core::Diagnostics {
        &mut self.diagnostics
    }
}

impl HasDiagnostics for Block<'_> {
    fn diagnostics(&mut self) -> &mut dyn gcode::core::Diagnostics {
        &mut self.0.diagnostics
    }
}

impl HasDiagnostics for Command<'_> {
    fn diagnostics(&mut self) -> &mut dyn gcode::core::Diagnostics {
        &mut self.0.diagnostics
    }
}

impl ProgramVisitor for Counter {
    fn start_block(&mut self) -> ControlFlow<impl BlockVisitor + '_> {
        self.blocks += 1;
        ControlFlow::Continue(Block(self))
    }
}

impl BlockVisitor for Block<'_> {
    fn line_number(&mut self, n: u32, span: Span) {
        black_box((n, span));
        self.0.words += 1;
    }

    fn start_general_code(&mut self, number: Number) -> ControlFlow<impl CommandVisitor + '_> {
        black_box(number);
        self.0.words += 1;
        ControlFlow::Continue(Command(self.0))
    }

    fn start_miscellaneous_code(&mut self, number: Number) -> ControlFlow<impl CommandVisitor + '_> {
        black_box(number);
        self.0.words += 1;
        ControlFlow::Continue(Command(self.0))
    }
}

impl CommandVisitor for Command<'_> {
    fn argument(&mut self, letter: char, value: Value<'_>, span: Span) {
        black_box((letter, value, span));
        self.0.words += 1;
    }
}
