//! The bench the tests work on: a scratch directory, a mock control running in it, and ways to run the sender.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Nothing in these tests takes longer; what does is stuck.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// The mock's binary, beside the sender's.
fn mock_binary() -> PathBuf {
    let path = Path::new(env!("CARGO_BIN_EXE_dripfeed")).with_file_name("mock-controller");
    assert!(path.exists(), "{} is missing: build it with `cargo test --workspace`", path.display());
    path
}

/// Options of a mock whose overrun is not what is tested: both programs share a machine that is not real-time, so a late
/// DC3 is no fault of the sender. The ten characters are shown by `simulation`, on a virtual clock.
const PATIENT: [&str; 4] = ["--overrun-limit", "200", "--buffer", "512"];

/// A scratch directory with its own journals.
pub(crate) struct Bench {
    directory: tempfile::TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { directory: tempfile::tempdir().expect("a scratch directory") }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// A file in the bench.
    pub(crate) fn file(&self, name: &str, text: &str) -> String {
        let path = self.path(name);
        std::fs::write(&path, text).expect("a file in the scratch directory");
        path.display().to_string()
    }

    /// A part file of a gear small enough for a quick job. Its lead-in keeps clear of the part.
    pub(crate) fn gear(&self, teeth: u64) -> String {
        let text = format!(
            "[part]\nkind = \"gear\"\nmodule = 0.4\nteeth = {teeth}\nkp = 1.6\nkr = 0.15\nks = 1.5\nknf = 1.5\n\
             tip_radius = 0.03\ndirection = \"cw\"\nlead_in = \"none\"\nrepeat = 1\n[wire]\noffset = 0.05\n"
        );
        self.file("gear.toml", &text)
    }

    /// The sender, with its journals in the bench.
    pub(crate) fn dripfeed(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dripfeed"));
        command.args(arguments).arg("--journal").arg(self.path("journals")).stdin(Stdio::null());
        command
    }

    /// Runs the sender to its end.
    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        finish(
            self.dripfeed(arguments)
                .stdout(Stdio::piped())
                .stderr(Stdio::piped())
                .spawn()
                .expect("dripfeed runs"),
        )
    }

    /// What `generate` prints for a part file.
    pub(crate) fn program(&self, part: &str) -> String {
        let output = Command::new(env!("CARGO_BIN_EXE_dripfeed"))
            .args(["generate", part])
            .stdin(Stdio::null())
            .output()
            .expect("dripfeed runs");
        assert!(output.status.success(), "{}", said(&output));
        String::from_utf8(output.stdout).expect("3B is ASCII")
    }

    /// The newest job's entry of `jobs --json`.
    pub(crate) fn newest_job(&self) -> serde_json::Value {
        let output = self.run(&["jobs", "--json"]);
        let jobs: serde_json::Value = serde_json::from_slice(&output.stdout).expect("jobs --json is JSON");
        jobs[0].clone()
    }

    /// A mock control on a pseudo-terminal of the bench.
    pub(crate) fn mock_on_pty(&self, arguments: &[&str]) -> Mock {
        let link = self.path("tty").display().to_string();
        let mut all = vec!["--pty", &link];
        all.extend(PATIENT);
        all.extend(arguments);
        Mock::start(self, &all)
    }

    /// A mock control behind TCP.
    pub(crate) fn mock_on_tcp(&self, arguments: &[&str]) -> Mock {
        let mut all = vec!["--tcp", "127.0.0.1:0"];
        all.extend(PATIENT);
        all.extend(arguments);
        let mut mock = Mock::start(self, &all);
        mock.port = format!("tcp://{}", mock.port);
        mock
    }
}

/// A running mock control.
pub(crate) struct Mock {
    child: Child,
    /// Where to send to.
    pub(crate) port: String,
    report: PathBuf,
    status: PathBuf,
}

impl Mock {
    fn start(bench: &Bench, arguments: &[&str]) -> Self {
        let (report, status) = (bench.path("report.json"), bench.path("status.json"));
        let mut child = Command::new(mock_binary())
            .args(arguments)
            .arg("--report")
            .arg(&report)
            .arg("--status")
            .arg(&status)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("mock-controller runs");
        let mut line = String::new();
        let stdout = child.stdout.take().expect("its output is piped");
        BufReader::new(stdout).read_line(&mut line).expect("its first line");
        let port = line.strip_prefix("ready ").expect("the first line says where").trim().to_owned();
        wait_until("the mock says how it stands", || status.exists());
        Self { child, port, report, status }
    }

    /// What it says of itself now.
    pub(crate) fn status(&self) -> serde_json::Value {
        let text = std::fs::read(&self.status).expect("a status is always there");
        serde_json::from_slice(&text).expect("a status is written whole")
    }

    /// Waits until it has cut all it received: its block count rests for a while.
    pub(crate) fn settled(&self) -> serde_json::Value {
        let mut last = self.status();
        let mut rested = 0;
        wait_until("the mock comes to rest", || {
            pause(Duration::from_millis(220));
            let status = self.status();
            rested = if status == last { rested + 1 } else { 0 };
            last = status;
            rested == 4
        });
        last
    }

    /// Waits for it to leave by itself; its exit code and report.
    pub(crate) fn finished(mut self) -> (i32, serde_json::Value) {
        let mut status = None;
        wait_until("the mock ends", || {
            status = self.child.try_wait().expect("the mock can be asked");
            status.is_some()
        });
        let status = status.expect("it ended");
        (status.code().expect("it ended by itself"), self.read_report())
    }

    /// Asks it to leave; its report.
    pub(crate) fn dismissed(self) -> serde_json::Value {
        signal(&self.child, rustix::process::Signal::TERM);
        self.finished().1
    }

    /// Kills it, as pulling the plug does.
    pub(crate) fn killed(mut self) {
        self.child.kill().expect("the mock can be killed");
        self.child.wait().expect("and is gone");
    }

    fn read_report(&self) -> serde_json::Value {
        let text = std::fs::read(&self.report).expect("a report is left");
        serde_json::from_slice(&text).expect("a report is JSON")
    }
}

impl Drop for Mock {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Waits for a process and takes what it said.
pub(crate) fn finish(child: Child) -> Output {
    let id = rustix::process::Pid::from_child(&child);
    let (done, over) = channel::<()>();
    // What hangs is killed, so that the test fails and does not.
    let watch = std::thread::spawn(move || {
        if over.recv_timeout(PATIENCE).is_err() {
            let _ = rustix::process::kill_process(id, rustix::process::Signal::KILL);
        }
    });
    let output = child.wait_with_output().expect("the process can be waited for");
    let _ = done.send(());
    watch.join().expect("the watch ends");
    output
}

/// Waits for something to come about.
pub(crate) fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < PATIENCE, "it never came about: {what}");
        pause(Duration::from_millis(5));
    }
}

/// Sends a signal to a process.
pub(crate) fn signal(child: &Child, signal: rustix::process::Signal) {
    rustix::process::kill_process(rustix::process::Pid::from_child(child), signal)
        .expect("the process is there");
}

/// Lets time pass: for the other process, never to make a check come out.
pub(crate) fn pause(time: Duration) {
    let (_keep, quiet) = channel::<()>();
    let _ = quiet.recv_timeout(time);
}

/// Everything a process said, for a failed assertion.
pub(crate) fn said(output: &Output) -> String {
    format!(
        "{}\nstdout: {}\nstderr: {}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    )
}

/// The exit code and standard error of a run.
pub(crate) fn verdict(output: &Output) -> (i32, String) {
    (output.status.code().expect("it ended by itself"), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Compares a failure's message with its golden file, `tests/golden/faults/NAME.txt`: from `error:` on, with every number
/// as N, the scratch directory as DIR, and without the torn block that a fault in mid-block may or may not leave.
///
/// Rewritten only by `DRIPFEED_BLESS=1 cargo test --test pty`.
pub(crate) fn assert_golden(bench: &Bench, name: &str, stderr: &str) {
    let error = stderr.find("error: ").map(|at| &stderr[at..]).expect("an error message");
    let mut said = error.replace(&bench.directory.path().display().to_string(), "DIR");
    if let Some(start) = said.find("; block ")
        && let Some(length) = said[start..].find(" of it were sent")
    {
        said.replace_range(start..start + length + " of it were sent".len(), "");
    }
    let mut plain = String::new();
    for c in said.chars() {
        match c {
            '0'..='9' if plain.ends_with('N') => {}
            '0'..='9' => plain.push('N'),
            c => plain.push(c),
        }
    }
    // A second job within the same second has a number behind its time.
    let plain = plain.replace("-N-N", "-N");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/faults").join(format!("{name}.txt"));
    if std::env::var_os("DRIPFEED_BLESS").is_some_and(|value| value == "1") {
        std::fs::write(&path, &plain).expect("the golden file can be written");
    }
    let golden = std::fs::read_to_string(&path).expect("a golden file, made by DRIPFEED_BLESS=1");
    assert_eq!(plain, golden, "{name}");
}
