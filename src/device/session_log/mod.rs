//! The log of a link: every setting, arming, stop, fault, refusal and change of a counter, with the
//! device's tick and the host's time, one line each.
//!
//! Entries travel from the session's thread in a bounded ring (one without room is counted, and the
//! number is written); a thread of its own makes lines of them a few times a second. The file only
//! ever grows at its end, so that what stands in it stays, whatever becomes of the program.

mod file;
mod line;
mod note;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Builder, JoinHandle};
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, RingBuffer};

use super::BridgeError;
pub use file::LogBound;
use file::LogFile;
use line::Epoch;
pub(super) use note::{Entry, HostCounters, Note};

/// Room for entries on their way: seconds of a link on which everything goes wrong.
const MAX_ENTRIES: usize = 256;
/// Between two looks at what is to be written.
const NAP: Duration = Duration::from_millis(100);

/// A log that links may write to.
#[derive(Debug)]
pub struct SessionLog {
    shared: Arc<Shared>,
    path: PathBuf,
    writer: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Shared {
    /// Ends of the rings of all links; only the owner and the writer ever look.
    feeds: Mutex<Vec<Consumer<Entry>>>,
    is_over: AtomicBool,
    failure: Mutex<Option<String>>,
}

impl Shared {
    fn feeds(&self) -> MutexGuard<'_, Vec<Consumer<Entry>>> {
        self.feeds.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn failure(&self) -> MutexGuard<'_, Option<String>> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl SessionLog {
    /// Continues the log at `path`, or begins it.
    ///
    /// # Errors
    /// The file cannot be written; the system gives no thread.
    pub fn append(path: &Path, bound: Option<LogBound>) -> Result<Self, BridgeError> {
        let file = LogFile::open(path, bound)?;
        let shared = Arc::new(Shared::default());
        let (for_writer, epoch) = (Arc::clone(&shared), Epoch::now());
        let writer = Builder::new()
            .name(String::from("bridge-log"))
            .spawn(move || write(&for_writer, file, epoch))
            .map_err(BridgeError::Thread)?;
        Ok(Self {
            shared,
            path: path.to_path_buf(),
            writer: Some(writer),
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Why nothing is written any more, if that is so.
    pub fn failure(&self) -> Option<String> {
        self.shared.failure().clone()
    }

    /// An end for one link; `target` is what it is opened to. Allocates.
    pub fn feed(&self, target: &str) -> LogFeed {
        let (entries, end) = RingBuffer::new(MAX_ENTRIES);
        self.shared.feeds().push(end);
        if let Some(writer) = &self.writer {
            writer.thread().unpark();
        }
        let mut feed = LogFeed { entries, n_lost: 0 };
        let program = selvedge_foundation::PROGRAM;
        feed.push(Entry {
            at: Instant::now(),
            tick: None,
            device_us: None,
            note: Note::Said("link", format!("target={target} program={program}")),
        });
        feed
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// Something could not be written.
    pub fn finish(mut self) -> Result<(), BridgeError> {
        self.end();
        match self.shared.failure().take() {
            None => Ok(()),
            Some(reason) => Err(BridgeError::Log {
                path: self.path.clone(),
                reason,
            }),
        }
    }

    fn end(&mut self) {
        self.shared.is_over.store(true, Ordering::Release);
        if let Some(writer) = self.writer.take() {
            writer.thread().unpark();
            // A writer that panicked has nothing left to tell.
            drop(writer.join());
        }
    }
}

impl Drop for SessionLog {
    fn drop(&mut self) {
        self.end();
    }
}

/// A link's end of a log.
#[derive(Debug)]
pub struct LogFeed {
    entries: Producer<Entry>,
    n_lost: u64,
}

impl LogFeed {
    /// Adds an entry; without room it is counted. Neither allocates nor waits.
    pub(super) fn push(&mut self, entry: Entry) {
        if self.n_lost > 0 && self.entries.slots() > 1 {
            let n_lost = std::mem::take(&mut self.n_lost);
            let missing = Entry {
                note: Note::Missing(n_lost),
                ..entry
            };
            drop(self.entries.push(missing));
        }
        self.n_lost += u64::from(self.entries.push(entry).is_err());
    }
}

fn write(shared: &Shared, mut file: LogFile, epoch: Epoch) {
    let mut lines = String::new();
    loop {
        // Asked first: what was added before the end is written.
        let is_over = shared.is_over.load(Ordering::Acquire);
        let is_fed = gather(&mut shared.feeds(), &mut lines, epoch);
        if !lines.is_empty()
            && let Err(error) = file.add(&lines)
        {
            *shared.failure() = Some(error.to_string());
            return;
        }
        lines.clear();
        if is_over {
            return;
        }
        if is_fed {
            thread::park_timeout(NAP);
        } else {
            thread::park();
        }
    }
}

/// Makes lines of all entries; whether more may come.
fn gather(feeds: &mut Vec<Consumer<Entry>>, lines: &mut String, epoch: Epoch) -> bool {
    feeds.retain_mut(|feed| {
        let is_abandoned = feed.is_abandoned();
        while let Ok(entry) = feed.pop() {
            line::write(lines, &entry, epoch);
        }
        !is_abandoned
    });
    !feeds.is_empty()
}

#[cfg(test)]
mod tests;
