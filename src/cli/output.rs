//! Where what a command makes goes: a file that is whole or not there, or standard output as it is made.

use std::fs::{self, File};
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

use super::failure::{Exit, Failure};

/// A file being written beside its name, or standard output.
pub(super) enum Output {
    Standard(io::Stdout),
    File {
        file: BufWriter<File>,
        /// Where it stands until it is whole.
        beside: PathBuf,
        path: PathBuf,
    },
}

impl Output {
    /// Standard output for none and for `-`.
    pub(super) fn open(path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path.filter(|path| *path != Path::new("-")) else {
            return Ok(Self::Standard(io::stdout()));
        };
        if path.is_dir() {
            return Err(Failure::new(Exit::Usage, format!("{} is a directory", path.display()))
                .help("name a file in it"));
        }
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        let beside = path.with_file_name(name);
        let file = File::create(&beside).map_err(|error| failed(path, &error))?;
        Ok(Self::File { file: BufWriter::new(file), beside, path: path.to_owned() })
    }

    /// Whether bytes that are no text would go to a terminal.
    pub(super) fn is_terminal(&self) -> bool {
        matches!(self, Self::Standard(out) if out.is_terminal())
    }

    /// Writes some more; what goes to standard output goes at once.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::Standard(out) => {
                let mut out = out.lock();
                out.write_all(bytes).and_then(|()| out.flush()).map_err(Failure::output)
            }
            Self::File { file, path, .. } => file.write_all(bytes).map_err(|error| failed(path, &error)),
        }
    }

    /// Gives the file its name.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        let Self::File { file, beside, path } = &mut self else { return Ok(()) };
        file.flush()
            .and_then(|()| file.get_ref().sync_all())
            .and_then(|()| fs::rename(&*beside, &*path))
            .map_err(|error| failed(path, &error))
    }
}

impl Drop for Output {
    /// What is not whole is not left lying about.
    fn drop(&mut self) {
        if let Self::File { beside, .. } = self {
            let _ = fs::remove_file(beside);
        }
    }
}

fn failed(path: &Path, error: &io::Error) -> Failure {
    Failure::new(Exit::Ours, format!("cannot write {}: {error}", path.display()))
}
