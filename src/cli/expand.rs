//! `dripfeed expand PROGRAM`: a macro program as plain G-code, block by block.
//!
//! ```text
//! $ dripfeed expand --annotate --suppress corner-1.nc | sed -n 6,7p
//! G01 X26.980 Y20.529 Z198.172 F200           ; 13: G01 X[#101] Y[#102] Z[#103] F200
//! X26.960 Y20.747 Z198.175                    ; 13: G01 X[#101] Y[#102] Z[#103] F200
//! ```
//!
//! Blocks go to standard output as they are made, in constant memory; what is noticed goes to standard error. On an error
//! every block before it has been printed, and none after.

use std::io::Write as _;

use clap::Args;

use super::connection::{self, LineOptions};
use super::failure::Failure;
use super::feeding;
use super::kind::Kind;
use super::macros::{Forecast, Lines, MacroOptions, MacroProgram, line_of, text_of};
use crate::macros::expanded::{Expanded, Step};
use crate::macros::number::Number;
use crate::macros::starvation::Line;

/// Expand a macro program into plain G-code
#[derive(Args, Debug)]
pub(super) struct Options {
    /// A macro program, or - for standard input
    #[arg(value_name = "PROGRAM")]
    input: String,
    /// Print from this block on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    from_block: Option<u64>,
    /// Show beside each line the line that made it
    #[arg(long)]
    annotate: bool,
    /// Leave out words that say again what is in force
    #[arg(long)]
    suppress: bool,
    /// The machine it is for: how blocks are spelled, and whether its line keeps up [default: generic-iso, no line]
    #[arg(long, value_name = "NAME|FILE")]
    machine: Option<String>,
    /// The dialect of its letters: a built-in dialect or a dialect file [default: the machine's, else as on mills]
    #[arg(long, value_name = "NAME|FILE")]
    dialect: Option<String>,
    /// Any value of the profile, such as decimals=4 or macros.numbers=f64
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    macros: MacroOptions,
}

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    let line = LineOptions { set: options.set.clone(), ..LineOptions::default() };
    let profile = connection::of_macros(options.machine.as_deref(), &line)?;
    Kind::asked(&options.input, Some(Kind::Macro))?;
    let text = text_of(&options.input)?;
    let program = MacroProgram::parse(
        &options.input,
        &text,
        &options.macros,
        &profile,
        options.dialect.as_deref(),
        options.suppress,
    )?;
    drop(text);
    // What breaks is told when it is come to, behind all that is made before it.
    if let Ok(Forecast { idle: Some(failure), .. }) = program.forecast(&options.input, line_of(&profile)) {
        return Err(failure);
    }
    // Without a machine nobody knows the line.
    let line = options.machine.as_ref().map(|_| line_of(&profile));
    match program.lines() {
        Lines::Decimal(lines) => print(&program, *lines, line, options),
        Lines::Binary(lines) => print(&program, *lines, line, options),
    }
}

fn print<N: Number>(
    program: &MacroProgram,
    lines: Expanded<N>,
    line: Option<Line>,
    options: &Options,
) -> Result<(), Failure> {
    let mut lines = match line {
        Some(line) => lines.over(line),
        None => lines,
    };
    let mut out = std::io::stdout().lock();
    let mut text = Vec::with_capacity(2 * CHUNK);
    let result = print_lines(&mut lines, options, &mut out, &mut text);
    // What was made before an error is printed before it is told.
    let written = out.write_all(&text).and_then(|()| out.flush()).map_err(Failure::output);
    drop(out);
    program.say_noticed(&options.input, lines.findings());
    result.and(written)?;
    if let Some(account) = lines.account().and_then(|account| account.text()) {
        say!("warning: {account}");
    }
    Ok(())
}

fn print_lines<N: Number>(
    lines: &mut Expanded<N>,
    options: &Options,
    out: &mut std::io::StdoutLock<'static>,
    text: &mut Vec<u8>,
) -> Result<(), Failure> {
    let failed = |error| Failure::read(&options.input, error);
    let from_block = options.from_block.unwrap_or(1);
    let mut before = from_block - 1;
    let mut scratch = Vec::new();
    while before > 0 {
        match lines.skip(&mut before, FUEL, &mut scratch).map_err(failed)? {
            Step::End => return Err(feeding::no_such_block(from_block, lines.blocks())),
            Step::Block | Step::Remark | Step::Working => {}
        }
    }
    loop {
        let start = text.len();
        match lines.next_line(FUEL, text).map_err(failed)? {
            Step::Block | Step::Remark => {
                if options.annotate {
                    annotate(lines, start, text);
                }
                text.push(b'\n');
                if text.len() < CHUNK {
                    continue;
                }
            }
            // What there is can be looked at while it computes.
            Step::Working => {}
            Step::End if from_block > 1 && lines.blocks() < from_block => {
                return Err(feeding::no_such_block(from_block, lines.blocks()));
            }
            Step::End => return Ok(()),
        }
        out.write_all(text).and_then(|()| out.flush()).map_err(Failure::output)?;
        text.clear();
    }
}

/// The line's source behind it, in a column of its own.
fn annotate<N: Number>(lines: &Expanded<N>, start: usize, text: &mut Vec<u8>) {
    let (number, source, program) = lines.made_from();
    let width = (text.len() - start).next_multiple_of(ANNOTATION_STEP).max(ANNOTATION_COLUMN);
    text.resize(start + width, b' ');
    text.extend_from_slice(b"; ");
    if let Some(program) = program {
        text.extend_from_slice(format!("O{program:04} ").as_bytes());
    }
    text.extend_from_slice(format!("{number}: ").as_bytes());
    text.extend_from_slice(source.trim_ascii());
}

const FUEL: u32 = 1 << 20;
const CHUNK: usize = 1 << 16;
const ANNOTATION_COLUMN: usize = 44;
const ANNOTATION_STEP: usize = 4;
