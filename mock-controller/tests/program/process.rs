//! The program under test, and waiting for it.

use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

pub(crate) struct Mock {
    child: Child,
    /// What followed `ready`.
    pub(crate) ready: String,
    pub(crate) directory: TempDir,
}

impl Mock {
    /// Starts it with `--report` and these words; `DIR` in a word is its directory.
    pub(crate) fn start(words: &[&str]) -> Mock {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path().to_str().unwrap().to_owned();
        let mut child = Command::new(env!("CARGO_BIN_EXE_mock-controller"))
            .args(words.iter().map(|word| word.replace("DIR", &here)))
            .arg("--report")
            .arg(directory.path().join("report.json"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let Some(ready) = line.strip_prefix("ready ") else {
            let mut error = String::new();
            child.stderr.take().unwrap().read_to_string(&mut error).unwrap();
            panic!("not ready: {line:?} {error}");
        };
        Mock { ready: ready.trim_end().to_owned(), child, directory }
    }

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub(crate) fn terminate(&self) {
        let pid = rustix::process::Pid::from_child(&self.child);
        rustix::process::kill_process(pid, rustix::process::Signal::TERM).unwrap();
    }

    /// Waits for it to leave; its exit code and its report.
    pub(crate) fn ended(&mut self) -> (i32, Value) {
        let mut status = None;
        wait_for("the program to leave", || {
            status = self.child.try_wait().unwrap();
            status.is_some()
        });
        let report = json(&self.file("report.json")).expect("a report");
        (status.unwrap().code().unwrap(), report)
    }
}

impl Drop for Mock {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub(crate) fn json(path: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// Looks until something is so.
#[expect(clippy::disallowed_methods, reason = "the program under test lives in real time")]
pub(crate) fn wait_for(what: &str, mut is_so: impl FnMut() -> bool) {
    let deadline = Instant::now() + Duration::from_secs(30);
    while !is_so() {
        assert!(Instant::now() < deadline, "waited too long for {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}
