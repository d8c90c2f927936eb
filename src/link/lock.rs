//! One sender a port: a lock file named after the device as the system knows it.
//!
//! The operating system's own exclusivity (TIOCEXCL) does not stop root and is not kept by every driver. The lock is
//! held by the open file, so it is gone when the process is, however it ended.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

use super::LinkError;

/// A port held by this process.
#[derive(Debug)]
pub(super) struct PortLock {
    _file: File,
}

impl PortLock {
    /// Takes a device, by its canonical path.
    pub(super) fn take(device: &Path, port: &str) -> Result<Self, LinkError> {
        let path = lock_path(device);
        let io = |error: io::Error| LinkError::Settings {
            port: port.to_owned(),
            reason: format!("lock file {}: {error}", path.display()),
        };
        let mut file = open(&path).map_err(io)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut holder = String::new();
                let _ = file.read_to_string(&mut holder);
                let holder = holder.trim();
                let by = (!holder.is_empty()).then(|| format!("another dripfeed (process {holder})"));
                return Err(LinkError::Busy { port: port.to_owned(), by });
            }
            Err(TryLockError::Error(error)) => return Err(io(error)),
        }
        // The number is for whoever finds the port taken; the lock itself is what counts, on a full disk too.
        let id = std::process::id().to_string();
        let _ = file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(id.as_bytes()));
        Ok(Self { _file: file })
    }
}

/// Opens a lock file, or makes it for every user of this machine; a lock needs no permission to write.
fn open(path: &Path) -> io::Result<File> {
    if let Ok(file) = OpenOptions::new().read(true).write(true).open(path).or_else(|_| File::open(path)) {
        return Ok(file);
    }
    if let Some(directory) = path.parent() {
        std::fs::create_dir_all(directory)?;
        let _ = permit(directory, 0o1777);
    }
    let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
    let _ = permit(path, 0o666);
    Ok(file)
}

#[cfg(unix)]
fn permit(path: &Path, mode: u32) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn permit(_path: &Path, _mode: u32) -> io::Result<()> {
    Ok(())
}

/// The lock file of a device: its canonical path with `/` as `_`.
fn lock_path(device: &Path) -> PathBuf {
    let name: String = device
        .display()
        .to_string()
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '.' { c } else { '_' })
        .collect();
    // One place for every user and environment: locks in different places would not meet.
    let shared = if cfg!(unix) { PathBuf::from("/tmp") } else { std::env::temp_dir() };
    shared.join("dripfeed-locks").join(name)
}
