//! What is read more than once, or shown again: put aside in a file without a name.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek as _, SeekFrom, Write as _};

use super::{BUFFER, Reading};
use crate::cli::failure::{Exit, Failure};
use crate::cli::macros::{self, MacroProgram};
use crate::macros::form::Point;
use crate::profile::Profile;

/// What can be read only once, copied aside as it is read, so that places in it can be shown.
pub(super) struct Copied {
    source: Box<dyn Read>,
    copy: File,
}

impl Copied {
    /// The copy, and what fills it.
    pub(super) fn open(word: &str) -> io::Result<(File, Self)> {
        let copy = aside()?;
        let source: Box<dyn Read> =
            if word == "-" { Box::new(io::stdin()) } else { Box::new(File::open(word)?) };
        Ok((copy.try_clone()?, Self { source, copy }))
    }
}

impl Read for Copied {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        // Whoever shows a place moves the position, which is one for both.
        self.copy.seek(SeekFrom::End(0))?;
        self.copy.write_all(&buffer[..count])?;
        Ok(count)
    }
}

/// A file without a name.
fn aside() -> io::Result<File> {
    let path = std::env::temp_dir().join(format!("dripfeed-{}.in", std::process::id()));
    let file = File::options().read(true).write(true).create_new(true).open(&path)?;
    // An open file stays readable without its name; where a system thinks otherwise it is left behind.
    let _ = std::fs::remove_file(&path);
    Ok(file)
}

/// What a macro program makes, in a file without a name: it is read more than once, and places in it are shown.
pub(super) fn expanded(word: &str, reading: &Reading) -> Result<File, Failure> {
    let generic = || Profile::generic_iso().map_err(|error| Failure::keys(Exit::Ours, "generic-iso", error));
    let mut profile = reading.profile.clone().map_or_else(generic, Ok)?;
    // Here it is a reader who must not mistake a length, and not the machine.
    profile.form.point = Point::Always;
    let text = macros::text_of(word)?;
    let program = MacroProgram::parse(word, &text, &reading.macros, &profile, reading.dialect(), false)?;
    let failed = |error: io::Error| Failure::new(Exit::Ours, format!("{word} cannot be expanded: {error}"));
    let mut file = BufWriter::with_capacity(BUFFER, aside().map_err(failed)?);
    let (mut line, mut bytes) = (Vec::new(), 0u64);
    let mut lines = program.lines().into_program();
    loop {
        line.clear();
        match lines.pull(&mut line).map_err(|error| Failure::program(word, error))? {
            Some(_) => line.push(b'\n'),
            None => break,
        }
        bytes += line.len() as u64;
        if bytes > EXPANDED_BYTES_MAX {
            let message = format!("{word} expands to more than {} GiB", EXPANDED_BYTES_MAX >> 30);
            return Err(Failure::new(Exit::Program, message).help(
                "`dripfeed expand` and `dripfeed send` make any length; look at a part of it with `| head`",
            ));
        }
        file.write_all(&line).map_err(failed)?;
    }
    let mut file = file.into_inner().map_err(|error| failed(error.into_error()))?;
    file.rewind().map_err(failed)?;
    Ok(file)
}

/// The most that is put aside of a macro program.
const EXPANDED_BYTES_MAX: u64 = 1 << 30;

/// Copies what can be read only once into a file without a name.
pub(super) fn put_aside(word: &str) -> io::Result<File> {
    let mut file = aside()?;
    if word == "-" {
        io::copy(&mut io::stdin().lock(), &mut file)?;
    } else {
        io::copy(&mut File::open(word)?, &mut file)?;
    }
    file.rewind()?;
    Ok(file)
}
