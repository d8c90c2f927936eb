//! A machine's file: the options of the command line, one `key = value` a line.
//!
//! Keys are the options' names without the dashes; a switch is `true` or `false`; a value may stand in double quotes;
//! `#` begins a comment. `fault` and `offset-register` may be repeated. What is also given on the command line is taken from there.
//!
//! It is no other program's profile: unknown keys, tables and a file within the file are errors.
//!
//! ```text
//! # a slow control with a small buffer
//! baud = 4800
//! dialect = "4b"
//! wire-offset = -0.07
//! dc3-parity = true
//! ```

use std::ffi::OsString;
use std::fmt;

use clap::{ArgAction, Command};

/// A line that is no option.
#[derive(Debug)]
pub(crate) struct WrongLine {
    line: usize,
    found: String,
}

impl fmt::Display for WrongLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.found)
    }
}

/// The file a command line names, if it does.
pub(crate) fn named(words: &[OsString]) -> Option<OsString> {
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match word.to_str() {
            Some("--machine") => return words.next().cloned(),
            Some(word) => {
                if let Some(file) = word.strip_prefix("--machine=") {
                    return Some(file.into());
                }
            }
            None => {}
        }
    }
    None
}

/// The file's options as words, without those that the command line gives itself.
pub(crate) fn words(text: &str, given: &[OsString], command: &Command) -> Result<Vec<OsString>, WrongLine> {
    let is_given = |key: &str| {
        given.iter().filter_map(|word| word.to_str()?.strip_prefix("--")).any(|word| {
            let name = word.split('=').next().unwrap_or(word);
            name == key || RIVALS.iter().any(|&(a, b)| (name, key) == (a, b) || (key, name) == (a, b))
        })
    };
    let mut words = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let wrong = |found: String| WrongLine { line: index + 1, found };
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (key, value) =
            line.split_once('=').ok_or_else(|| wrong(format!("{line:?} is no key = value")))?;
        let (key, value) = (key.trim(), plain(value).ok_or_else(|| wrong(format!("unfinished {value}")))?);
        let option = command
            .get_arguments()
            .find(|option| option.get_long() == Some(key) && key != "machine")
            .ok_or_else(|| wrong(format!("unknown key {key:?}")))?;
        let switch = matches!(option.get_action(), ArgAction::SetTrue);
        let word = match (switch, value) {
            (true, "true") => format!("--{key}"),
            (true, "false") => continue,
            (true, _) => return Err(wrong(format!("{key} is true or false, not {value:?}"))),
            (false, value) => format!("--{key}={value}"),
        };
        if !is_given(key) {
            words.push(word.into());
        }
    }
    Ok(words)
}

/// The value without quotes and without a comment behind it; `None`: a quote is not closed, or more follows it.
fn plain(value: &str) -> Option<&str> {
    let value = value.trim();
    let Some(quoted) = value.strip_prefix('"') else {
        return value.split('#').next().map(str::trim);
    };
    let (inside, rest) = quoted.split_once('"')?;
    let rest = rest.trim();
    (rest.is_empty() || rest.starts_with('#')).then_some(inside)
}

/// Options that exclude each other: the one on the command line stands.
const RIVALS: [(&str, &str); 5] =
    [("unpaced", "baud"), ("unpaced", "cutting-time"), ("pty", "tcp"), ("pty", "port"), ("tcp", "port")];

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Words;

    fn read(text: &str, given: &[&str]) -> String {
        let given: Vec<OsString> = given.iter().map(OsString::from).collect();
        match words(text, &given, &Words::command()) {
            Ok(words) => words.join(" ".as_ref()).into_string().unwrap(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn lines_become_words_and_the_command_line_stands() {
        let text = "# slow\nbaud = 4800 # really\n\ndialect=\"4b\"\ndc3-parity = true\nunpaced = false\n";
        assert_eq!(read(text, &[]), "--baud=4800 --dialect=4b --dc3-parity");
        assert_eq!(read(text, &["--baud", "9600", "--dialect=3b"]), "--dc3-parity");
        assert_eq!(read(text, &["--unpaced"]), "--dialect=4b --dc3-parity");
        assert_eq!(read("fault = flip=0.1\nfault = drop=0.2", &[]), "--fault=flip=0.1 --fault=drop=0.2");
        assert_eq!(read("offset-register = D1=0.1 # rough", &[]), "--offset-register=D1=0.1");
        assert_eq!(named(&["--once".into(), "--machine=a.toml".into()]), Some("a.toml".into()));
    }

    #[test]
    fn what_is_no_option_is_told_with_its_line() {
        assert_eq!(read("\nspeed = 3", &[]), "line 2: unknown key \"speed\"");
        assert_eq!(read("[link]", &[]), "line 1: \"[link]\" is no key = value");
        assert_eq!(read("machine = \"b\"", &[]), "line 1: unknown key \"machine\"");
        assert_eq!(read("once = 1", &[]), "line 1: once is true or false, not \"1\"");
        assert_eq!(read("dialect = \"4b", &[]), "line 1: unfinished  \"4b");
    }
}
