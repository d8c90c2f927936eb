//! How the text of a source is read: once for all when it is checked, verified when it is fed, later where it must wait.

use std::fs::File;
use std::io::{self, Read};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// What a file was when it was checked.
#[derive(Clone, Debug)]
pub(super) struct Stamp {
    pub(super) path: PathBuf,
    pub(super) bytes: u64,
    pub(super) modified: Option<SystemTime>,
    pub(super) digest: blake3::Hash,
}

/// A FIFO, opened when it is first read: opening it waits for whoever writes, and that wait must not be the main thread's.
pub(super) struct Later {
    pub(super) path: String,
    pub(super) file: Option<File>,
}

impl Read for Later {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let file = match self.file.take() {
            Some(file) => file,
            None => File::open(&self.path)?,
        };
        self.file.insert(file).read(buffer)
    }
}

pub(super) struct Hashing {
    pub(super) file: File,
    pub(super) hasher: blake3::Hasher,
    pub(super) bytes: u64,
}

/// The file as its reader has it, while the digest stays in reach.
pub(super) struct Shared(pub(super) Arc<Mutex<Hashing>>);

impl Read for Shared {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut hashing = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let count = hashing.file.read(buffer)?;
        hashing.hasher.update(&buffer[..count]);
        hashing.bytes += count as u64;
        Ok(count)
    }
}

/// A file read for the second time: size and time are compared at every read, the digest at the end.
pub(super) struct Verified {
    pub(super) file: File,
    pub(super) stamp: Stamp,
    pub(super) hasher: blake3::Hasher,
    pub(super) bytes: u64,
}

impl Verified {
    pub(super) fn open(stamp: Stamp) -> io::Result<Self> {
        Ok(Self { file: File::open(&stamp.path)?, stamp, hasher: blake3::Hasher::new(), bytes: 0 })
    }
}

impl Read for Verified {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let changed = || io::Error::other("the file has changed since it was checked");
        let metadata = self.file.metadata()?;
        if metadata.len() != self.stamp.bytes || metadata.modified().ok() != self.stamp.modified {
            return Err(changed());
        }
        let count = self.file.read(buffer)?;
        self.hasher.update(&buffer[..count]);
        self.bytes += count as u64;
        if count == 0 && (self.bytes != self.stamp.bytes || self.hasher.finalize() != self.stamp.digest) {
            return Err(changed());
        }
        Ok(count)
    }
}
