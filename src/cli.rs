//! The command line: one subcommand a file, its manual on top.
//!
//! Words are checked first, then files are read, then a port is opened. Data goes to standard output; progress, log and
//! diagnostics to standard error. The exit code says whose turn it is to act, see the list in the README.

/// Writes a line to standard error. A job does not die of a log that nobody reads any more.
macro_rules! say {
    ($($words:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($words)*);
    }};
}

mod check;
mod connection;
mod convert;
#[cfg(feature = "demo")]
mod demo;
mod dialects;
mod drawing;
mod expand;
mod failure;
mod feeding;
mod generate;
mod jobs;
mod kind;
mod machines;
mod macros;
mod motions;
mod output;
mod plan;
mod plot;
mod question;
mod registers;
mod resume;
mod screen;
mod send;
mod source;
mod spot;
mod verdict;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// Makes wire-EDM blocks on demand and drip-feeds them to a control over a serial link.
#[derive(Debug, Parser)]
#[command(name = "dripfeed", version, arg_required_else_help = true, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    #[cfg(feature = "demo")]
    Demo(demo::Options),
    Generate(generate::Options),
    Expand(expand::Options),
    Convert(Box<convert::Options>),
    Check(check::Options),
    Plot(plot::Options),
    Send(send::Options),
    Resume(resume::Options),
    Jobs(jobs::Options),
    Machines(machines::Options),
}

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    let log = env_logger::Env::new().filter_or("DRIPFEED_LOG", "off");
    let _ = env_logger::Builder::from_env(log).format_target(false).try_init();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are answers, not mistakes.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { failure::Exit::Usage as u8 } else { 0 });
        }
    };
    let result = match arguments.command {
        #[cfg(feature = "demo")]
        Command::Demo(options) => demo::run(&options),
        Command::Generate(options) => generate::run(options),
        Command::Expand(options) => expand::run(&options),
        Command::Convert(options) => convert::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Plot(options) => plot::run(&options),
        Command::Send(options) => send::run(options),
        Command::Resume(options) => resume::run(options),
        Command::Jobs(options) => jobs::run(&options),
        Command::Machines(options) => machines::run(&options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Writes to standard output; a reader that has gone ends the command quietly.
fn print(text: &[u8]) -> Result<(), Failure> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    out.write_all(text).and_then(|()| out.flush()).map_err(Failure::output)
}

/// Prints a value as one line of JSON.
fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    print(format!("{value}\n").as_bytes())
}
