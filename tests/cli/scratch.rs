//! A directory of its own for each test, and the program run in it.

use std::io::Write as _;
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

use crate::binary::{Run, command};

/// A small whole program; its blocks are nobody's outline.
pub(crate) const PROGRAM: &str = "B579B6617B006617GYL2\nB19B222B000232GYNR4\nB11B236B000236GYL2\nDD\n";

pub(crate) struct Scratch {
    directory: TempDir,
}

impl Scratch {
    pub(crate) fn new() -> Scratch {
        Scratch { directory: TempDir::new().expect("a directory for the test") }
    }

    pub(crate) fn with(files: &[(&str, &str)]) -> Scratch {
        let scratch = Scratch::new();
        for (name, text) in files {
            scratch.write(name, text);
        }
        scratch
    }

    pub(crate) fn path(&self) -> &Path {
        self.directory.path()
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path().join(name), text).expect("a file for the test");
    }

    /// The program, to be started in this directory and with its journals in `state` there.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = command(arguments);
        command
            .current_dir(self.path())
            .env("HOME", self.path())
            .env("XDG_STATE_HOME", self.path().join("state"));
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        self.run_with("", arguments)
    }

    /// Runs the program with a text on its standard input.
    pub(crate) fn run_with(&self, stdin: &str, arguments: &[&str]) -> Run {
        let mut child = self
            .command(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program under test can be started");
        let mut pipe = child.stdin.take().expect("a pipe");
        let text = stdin.to_owned();
        // A program that stops at a fault reads no further; the broken pipe is then its right.
        let writer = std::thread::spawn(move || drop(pipe.write_all(text.as_bytes())));
        let output = child.wait_with_output().expect("the program ends");
        writer.join().expect("the input is written");
        Run {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("standard output is text"),
            stderr: String::from_utf8(output.stderr).expect("standard error is text"),
        }
    }

    /// Whether any journal has been begun here.
    pub(crate) fn has_journals(&self) -> bool {
        self.path().join("state").exists()
    }
}

/// A port somebody listens on, to see whether anybody calls.
pub(crate) struct Ear {
    listener: TcpListener,
}

impl Ear {
    pub(crate) fn new() -> Ear {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        listener.set_nonblocking(true).expect("a listener that does not wait");
        Ear { listener }
    }

    pub(crate) fn port(&self) -> String {
        format!("tcp://{}", self.listener.local_addr().expect("the listener's address"))
    }

    /// Whether somebody has connected.
    pub(crate) fn has_been_called(&self) -> bool {
        self.listener.accept().is_ok()
    }
}
