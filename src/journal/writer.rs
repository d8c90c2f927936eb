//! The one thread of a process that writes journals and waits for the disk.
//!
//! A feed asks for a horizon and goes on; the thread appends what has gathered, syncs once, and raises the durable
//! horizon. No write is made per block. A failed write or sync is not retried: the job goes on, and everyone can see that
//! its resume is no longer guaranteed.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use thiserror::Error;

use super::history::{History, Unreadable};
use super::{FIRST_LINE, Job, Record};

/// Where a journal's bytes go; a trait, so that a full disk can be put in a test.
pub trait Disk: Send {
    /// Appends bytes.
    ///
    /// # Errors
    ///
    /// As the disk says.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()>;
    /// Waits until everything appended will survive a power cut.
    ///
    /// # Errors
    ///
    /// As the disk says.
    fn sync(&mut self) -> io::Result<()>;
}

impl Disk for File {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }
}

/// Why a journal cannot be opened.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JournalError {
    /// The directory or file cannot be made or read.
    #[error("the journal {} cannot be used: {error}", .path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Another process writes it.
    #[error("the journal {} is in use by another dripfeed", .path.display())]
    InUse {
        /// Which.
        path: PathBuf,
    },
    /// It is damaged.
    #[error("{}: {error}", .path.display())]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// How.
        error: Unreadable,
    },
}

/// Creates a job's journal, its first record durable and its directory synced.
///
/// # Errors
///
/// When the disk refuses, or the job exists already.
pub fn create(directory: &Path, job: &Job) -> Result<File, JournalError> {
    let path = path_of(directory, &job.job);
    let io = |error| JournalError::Io { path: path.clone(), error };
    std::fs::create_dir_all(directory).map_err(io)?;
    let mut file = OpenOptions::new().append(true).create_new(true).open(&path).map_err(io)?;
    lock(&file, &path)?;
    let first = format!("{FIRST_LINE}\n{}", Record::Job(job.clone()).to_line());
    let written = file.write_all(first.as_bytes()).and_then(|()| file.sync_all());
    if let Err(error) = written.and_then(|()| sync_directory(directory)) {
        // A journal that says nothing would only stand in the way.
        let _ = std::fs::remove_file(&path);
        return Err(io(error));
    }
    Ok(file)
}

/// Opens a job's journal to go on with it: locked, its torn tail cut off.
///
/// # Errors
///
/// When it is in use, damaged, or the disk refuses.
pub fn reopen(directory: &Path, job: &str) -> Result<(File, History), JournalError> {
    let path = path_of(directory, job);
    let io = |error| JournalError::Io { path: path.clone(), error };
    let mut file = OpenOptions::new().read(true).write(true).open(&path).map_err(io)?;
    lock(&file, &path)?;
    let history = read(&path)?;
    file.set_len(history.whole_bytes).map_err(io)?;
    file.seek(SeekFrom::End(0)).map_err(io)?;
    Ok((file, history))
}

/// Reads a journal without locking it.
///
/// # Errors
///
/// When it is damaged or cannot be read.
pub fn read(path: &Path) -> Result<History, JournalError> {
    let bytes = std::fs::read(path).map_err(|error| JournalError::Io { path: path.to_owned(), error })?;
    History::read(&bytes).map_err(|error| JournalError::Unreadable { path: path.to_owned(), error })
}

/// Whether another process holds the journal.
#[must_use]
pub fn is_in_use(path: &Path) -> bool {
    // Shared, so that looking never stands in a writer's way for long, nor in another's who looks.
    File::open(path).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The file of a job.
#[must_use]
pub fn path_of(directory: &Path, job: &str) -> PathBuf {
    directory.join(format!("{job}.journal"))
}

fn lock(file: &File, path: &Path) -> Result<(), JournalError> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(JournalError::InUse { path: path.to_owned() }),
        Err(TryLockError::Error(error)) => Err(JournalError::Io { path: path.to_owned(), error }),
    }
}

/// A new name is durable only once its directory is. Elsewhere than on Unix a directory cannot be opened as a file, and
/// the file system journals names itself.
fn sync_directory(directory: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(directory)?.sync_all() } else { Ok(()) }
}

/// The journal thread.
#[derive(Debug)]
pub struct Writer {
    notes: Sender<Note>,
    thread: Option<JoinHandle<()>>,
}

enum Note {
    Attach(u64, Box<dyn Disk>, Arc<Shared>),
    Fact(u64, Box<Record>),
    Sync(u64),
    Detach(u64, Sender<()>),
}

#[derive(Debug, Default)]
struct Shared {
    durable: AtomicU64,
    failed: AtomicBool,
    error: Mutex<Option<String>>,
}

/// One job's end of the journal thread.
#[derive(Debug)]
pub struct Journal {
    id: u64,
    notes: Sender<Note>,
    shared: Arc<Shared>,
}

impl Writer {
    /// Starts the thread.
    ///
    /// # Errors
    ///
    /// When the system has no thread left.
    pub fn start() -> io::Result<Self> {
        let (notes, inbox) = channel();
        let thread = std::thread::Builder::new().name("journal".to_owned()).spawn(move || run(&inbox))?;
        Ok(Self { notes, thread: Some(thread) })
    }

    /// Takes on a job whose journal is open, with the horizon that is durable already.
    #[must_use]
    pub fn attach(&self, disk: Box<dyn Disk>, durable: u64) -> Journal {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        let shared = Arc::new(Shared { durable: AtomicU64::new(durable), ..Shared::default() });
        // The thread lives as long as this writer, so the note arrives.
        let _ = self.notes.send(Note::Attach(id, disk, Arc::clone(&shared)));
        Journal { id, notes: self.notes.clone(), shared }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        let (unused, _) = channel();
        drop(std::mem::replace(&mut self.notes, unused));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Journal {
    /// Writes a fact with the next sync.
    pub fn note(&self, record: Record) {
        let _ = self.notes.send(Note::Fact(self.id, Box::new(record)));
    }

    /// Asks for a durable horizon.
    pub fn intend(&self, block: u64) {
        self.note(Record::Horizon { block });
        let _ = self.notes.send(Note::Sync(self.id));
    }

    /// The last block that may go on the line. After a failure every block may: the job is worth more than its journal.
    #[must_use]
    pub fn allowed(&self) -> u64 {
        if self.shared.failed.load(Ordering::Acquire) {
            return u64::MAX;
        }
        self.shared.durable.load(Ordering::Acquire)
    }

    /// Why resume is no longer guaranteed, if it is not.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        self.shared.error.lock().ok()?.clone()
    }

    /// Writes what is left and waits for it.
    pub fn close(self) -> Option<String> {
        let _ = self.notes.send(Note::Sync(self.id));
        let (done, finished) = channel();
        let _ = self.notes.send(Note::Detach(self.id, done));
        // Ends when the thread has answered, or is gone.
        let _ = finished.recv();
        self.failure()
    }
}

struct Attached {
    id: u64,
    disk: Box<dyn Disk>,
    shared: Arc<Shared>,
    waiting: Vec<u8>,
    horizon: u64,
    sync: bool,
    detach: Option<Sender<()>>,
}

fn run(inbox: &Receiver<Note>) {
    let mut jobs: Vec<Attached> = Vec::new();
    while let Ok(first) = inbox.recv() {
        // One sync serves everything that has gathered while the last one ran.
        for note in std::iter::once(first).chain(inbox.try_iter()) {
            match note {
                Note::Attach(id, disk, shared) => {
                    let horizon = shared.durable.load(Ordering::Acquire);
                    let waiting = Vec::new();
                    jobs.push(Attached { id, disk, shared, waiting, horizon, sync: false, detach: None });
                }
                Note::Fact(id, record) => {
                    if let Some(job) = jobs.iter_mut().find(|job| job.id == id) {
                        if let Record::Horizon { block } = *record {
                            job.horizon = job.horizon.max(block);
                        }
                        job.waiting.extend_from_slice(record.to_line().as_bytes());
                    }
                }
                Note::Sync(id) => jobs.iter_mut().filter(|job| job.id == id).for_each(|job| job.sync = true),
                Note::Detach(id, done) => {
                    if let Some(job) = jobs.iter_mut().find(|job| job.id == id) {
                        job.detach = Some(done);
                    }
                }
            }
        }
        jobs.iter_mut().for_each(Attached::settle);
        jobs.retain(|job| job.detach.is_none());
    }
}

impl Attached {
    fn settle(&mut self) {
        if self.shared.failed.load(Ordering::Acquire) {
            self.waiting.clear();
        } else if self.sync {
            match self.disk.append(&self.waiting).and_then(|()| self.disk.sync()) {
                Ok(()) => self.shared.durable.store(self.horizon, Ordering::Release),
                Err(error) => {
                    if let Ok(mut words) = self.shared.error.lock() {
                        *words = Some(error.to_string());
                    }
                    self.shared.failed.store(true, Ordering::Release);
                }
            }
            self.waiting.clear();
        }
        self.sync = false;
        if let Some(done) = &self.detach {
            let _ = done.send(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::history::tests::job;
    use super::*;

    #[derive(Clone, Default)]
    struct Platter {
        bytes: Arc<Mutex<Vec<u8>>>,
        full: Arc<AtomicBool>,
    }

    impl Disk for Platter {
        fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
            if self.full.load(Ordering::SeqCst) {
                return Err(io::Error::from(io::ErrorKind::StorageFull));
            }
            self.bytes.lock().unwrap().extend_from_slice(bytes);
            Ok(())
        }
        fn sync(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn wait_until(condition: impl Fn() -> bool) {
        let mut spins = 0u64;
        while !condition() {
            std::thread::yield_now();
            spins += 1;
            assert!(spins < 500_000_000, "the journal thread did not answer");
        }
    }

    #[test]
    fn a_block_is_allowed_only_once_its_intent_is_on_the_disk() {
        let writer = Writer::start().unwrap();
        let platter = Platter::default();
        let journal = writer.attach(Box::new(platter.clone()), 0);
        assert_eq!(journal.allowed(), 0);
        journal.intend(16);
        wait_until(|| journal.allowed() == 16);
        let text = String::from_utf8(platter.bytes.lock().unwrap().clone()).unwrap();
        assert!(text.contains("\"block\":16"));
        assert_eq!(journal.close(), None);
    }

    #[test]
    fn a_full_disk_lets_the_job_go_on_and_says_so() {
        let writer = Writer::start().unwrap();
        let platter = Platter::default();
        platter.full.store(true, Ordering::SeqCst);
        let journal = writer.attach(Box::new(platter), 0);
        journal.intend(16);
        wait_until(|| journal.allowed() == u64::MAX);
        assert!(journal.failure().is_some());
    }

    #[test]
    fn a_journal_is_created_locked_read_back_and_its_torn_tail_cut() {
        let directory = tempfile::tempdir().unwrap();
        let file = create(directory.path(), &job()).unwrap();
        let path = path_of(directory.path(), "gear-1");
        assert!(is_in_use(&path));
        assert!(matches!(reopen(directory.path(), "gear-1"), Err(JournalError::InUse { .. })));
        assert!(matches!(create(directory.path(), &job()), Err(JournalError::Io { .. })));
        drop(file);
        OpenOptions::new().append(true).open(&path).unwrap().write_all(b"{\"fact\":\"hori").unwrap();
        let (mut file, history) = reopen(directory.path(), "gear-1").unwrap();
        assert_eq!(history.horizon, 0);
        file.append(Record::Horizon { block: 7 }.to_line().as_bytes()).unwrap();
        assert_eq!(read(&path).unwrap().horizon, 7);
    }
}
