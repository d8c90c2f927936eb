//! Questions to the operator: asked on the terminal, never on standard input.

use std::io::{BufRead, BufReader, IsTerminal, Write};

use super::failure::{Exit, Failure};

/// Asks a question on the terminal. Without one, or without a yes, the command ends.
pub(super) fn ask(question: &str, yes: bool) -> Result<(), Failure> {
    if yes {
        return Ok(());
    }
    match answer(&format!("{question} [y/N] "))?.trim() {
        "y" | "Y" | "yes" => Ok(()),
        _ => Err(Failure::new(Exit::Stopped, "not confirmed; nothing was sent")),
    }
}

/// A line from the terminal, never from standard input.
pub(super) fn answer(question: &str) -> Result<String, Failure> {
    let terminal = if std::io::stderr().is_terminal() { std::fs::File::open(TERMINAL).ok() } else { None };
    let Some(terminal) = terminal else {
        let question = question.trim_end_matches("[y/N] ").trim();
        return Err(Failure::new(Exit::Usage, format!("there is no terminal to ask on: {question}"))
            .help("answer on the command line with --yes; `resume` wants --from-block N with it"));
    };
    let mut screen = std::io::stderr();
    let _ = write!(screen, "{question}").and_then(|()| screen.flush());
    let mut line = String::new();
    BufReader::new(terminal)
        .read_line(&mut line)
        .map_err(|error| Failure::new(Exit::Ours, format!("cannot read from the terminal: {error}")))?;
    Ok(line)
}

#[cfg(unix)]
const TERMINAL: &str = "/dev/tty";
#[cfg(not(unix))]
const TERMINAL: &str = "CONIN$";
