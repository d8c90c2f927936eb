//! A directory of its own for each test, and the program run in it.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tempfile::TempDir;

/// What a run left behind.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

pub(crate) struct Shop {
    directory: TempDir,
}

impl Shop {
    pub(crate) fn new() -> Self {
        Self { directory: TempDir::new().expect("a directory for the test") }
    }

    /// A shop with one file in it.
    pub(crate) fn with(name: &str, text: impl AsRef<[u8]>) -> Self {
        let shop = Self::new();
        shop.write(name, text);
        shop
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub(crate) fn directory(&self) -> &Path {
        self.directory.path()
    }

    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), text).expect("a file for the test");
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect("a file of text")
    }

    /// The names of all files in it.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory()).expect("the directory is there");
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The program, to be started in this directory without a terminal.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dripfeed"));
        command
            .args(arguments)
            .current_dir(self.directory())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .env_clear()
            .env("HOME", self.directory())
            .env("XDG_STATE_HOME", self.path("state"));
        command
    }

    pub(crate) fn run(&self, words: &str) -> Run {
        let words: Vec<&str> = words.split_whitespace().collect();
        finished(self.command(&words))
    }

    /// Runs the program with a text on its standard input.
    pub(crate) fn run_with(&self, stdin: &str, words: &str) -> Run {
        let words: Vec<&str> = words.split_whitespace().collect();
        let mut child = self.command(&words).stdin(Stdio::piped()).spawn().expect("dripfeed runs");
        let mut pipe = child.stdin.take().expect("a pipe");
        let text = stdin.to_owned();
        // A program that stops at a fault reads no further; the broken pipe is then its right.
        let writer = std::thread::spawn(move || drop(pipe.write_all(text.as_bytes())));
        let output = child.wait_with_output().expect("the program ends");
        writer.join().expect("the input is written");
        told(output)
    }

    /// What `convert` with these words prints; it must do it.
    pub(crate) fn convert(&self, words: &str) -> String {
        let run = self.run(&format!("convert {words}"));
        assert_eq!(run.code, Some(0), "convert {words}: {}", run.stderr);
        run.stdout
    }
}

/// Converts one text; the words come after the name of the file.
pub(crate) fn convert(name: &str, text: &str, words: &str) -> String {
    Shop::with(name, text).convert(&format!("{name} {words}"))
}

fn finished(mut command: Command) -> Run {
    told(command.output().expect("the program under test can be started"))
}

fn told(output: std::process::Output) -> Run {
    Run {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).expect("standard output is text"),
        stderr: String::from_utf8(output.stderr).expect("standard error is text"),
    }
}
