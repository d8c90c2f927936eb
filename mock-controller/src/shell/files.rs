//! What is written while the control runs: trace, picture, decoded text, status, report.
//!
//! An error of a file is kept and told at the next tick, since nobody who watches can stop the control.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::observer::{BlockEnd, Observer};
use crate::picture::Picture;
use crate::report::Report;

/// The files asked for.
#[derive(Default)]
pub struct Files {
    trace: Option<BufWriter<File>>,
    /// Where the upper guide stands, if the trace tells of it.
    upper_um: Option<[i64; 2]>,
    has_header: bool,
    save: Option<BufWriter<File>>,
    picture: Option<(PathBuf, Picture)>,
    error: Option<io::Error>,
}

impl Files {
    /// Creates the trace and the save file now, so that a path that cannot be written is known before anything runs.
    ///
    /// # Errors
    ///
    /// What the system says, with the path.
    pub fn create(trace: Option<&Path>, save: Option<&Path>, picture: Option<&Path>) -> io::Result<Self> {
        let create = |path: &Path| File::create(path).map(BufWriter::new).map_err(|error| at(path, &error));
        let trace = trace.map(create).transpose()?;
        let picture = picture.map(|path| (path.to_owned(), Picture::default()));
        let save = save.map(create).transpose()?;
        Ok(Files { trace, save, picture, ..Files::default() })
    }

    /// The trace tells of the upper guide too: `t_s,block,x_um,y_um,u_um,v_um`, a row a pulse in the plane of the program.
    #[must_use]
    pub fn with_upper(self) -> Self {
        Files { upper_um: Some([0, 0]), ..self }
    }

    fn header(&mut self) {
        if let Some(file) = &mut self.trace
            && !std::mem::replace(&mut self.has_header, true)
        {
            let upper = if self.upper_um.is_some() { ",u_um,v_um" } else { "" };
            let outcome = writeln!(file, "t_s,block,x_um,y_um{upper}");
            self.keep(outcome);
        }
    }

    /// Hands what has been written on to the system.
    ///
    /// # Errors
    ///
    /// The first error any of the files had.
    pub fn flush(&mut self) -> io::Result<()> {
        self.header();
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        for file in [&mut self.trace, &mut self.save].into_iter().flatten() {
            file.flush()?;
        }
        Ok(())
    }

    /// Writes the picture, at the end.
    ///
    /// # Errors
    ///
    /// What the system says, with the path.
    pub fn finish(&mut self) -> io::Result<()> {
        self.flush()?;
        if let Some((path, picture)) = &self.picture {
            fs::write(path, picture.svg()).map_err(|error| at(path, &error))?;
        }
        Ok(())
    }

    fn keep(&mut self, outcome: io::Result<()>) {
        if let Err(error) = outcome {
            self.error.get_or_insert(error);
        }
    }
}

impl Observer for Files {
    fn wants_pulses(&self) -> bool {
        self.trace.is_some() || self.picture.is_some()
    }

    fn pulse(&mut self, time: Duration, block: u64, x_um: i64, y_um: i64) {
        if let Some((_, picture)) = &mut self.picture {
            picture.pulse(time, block, x_um, y_um);
        }
        self.header();
        if let Some(file) = &mut self.trace {
            let (seconds, nanoseconds) = (time.as_secs(), time.subsec_nanos());
            let outcome = match self.upper_um {
                None => writeln!(file, "{seconds}.{nanoseconds:09},{block},{x_um},{y_um}"),
                Some([u_um, v_um]) => {
                    writeln!(file, "{seconds}.{nanoseconds:09},{block},{x_um},{y_um},{u_um},{v_um}")
                }
            };
            self.keep(outcome);
        }
    }

    fn upper_pulse(&mut self, _time: Duration, _block: u64, u_um: i64, v_um: i64) {
        self.upper_um = Some([u_um, v_um]);
    }

    fn block_end(&mut self, end: &BlockEnd) {
        if let Some((_, picture)) = &mut self.picture {
            picture.block_end(end);
        }
    }

    fn text(&mut self, text: &[u8]) {
        if let Some(file) = &mut self.save {
            let outcome = file.write_all(text);
            self.keep(outcome);
        }
    }
}

/// Writes a report beside its place and then moves it there, so that a reader never sees half of one.
///
/// # Errors
///
/// What the system says, with the path.
pub fn write_report(path: &Path, report: &Report) -> io::Result<()> {
    let mut text = serde_json::to_vec_pretty(report)?;
    text.push(b'\n');
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    let beside = PathBuf::from(name);
    fs::write(&beside, text).and_then(|()| fs::rename(&beside, path)).map_err(|error| at(path, &error))
}

fn at(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}
