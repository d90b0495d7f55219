//! The log of a link: every packet both ways, every setting, arming, stop, fault, refusal and
//! change of a counter, by host and device time, one line each; and what reads it.
//!
//! Packets come from the link's threads, where they were really written and really arrived; entries
//! from the session's. All travel in bounded rings (what finds no room is counted, and the number
//! is written); a thread of its own makes lines of them a few times a second. The file only ever
//! grows at its end, so that what stands in it stays, whatever becomes of the program.

mod bodies;
mod digits;
mod earlier_digits;
mod events;
mod file;
mod line;
mod note;
mod packets;
mod read;
mod recorder;
mod tap;
#[cfg(test)]
mod virtual_log;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Builder, JoinHandle, Thread};
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, RingBuffer};

use super::BridgeError;
use crate::ArrayProfile;
pub(super) use events::event;
pub use file::LogBound;
use file::LogFile;
use line::Epoch;
pub(super) use note::{Entry, HostCounters, Note};
pub(super) use packets::HashedFrame;
pub(super) use read::{LogReader, Seen};
pub(super) use recorder::CONTINUED;
use recorder::Recorder;
use selvedge_foundation::files::sha256_hex;
use tap::Passing;
pub(super) use tap::{Body, Passed, Tap, TapEnd, tap};
#[cfg(test)]
pub(super) use virtual_log::VirtualLog;

/// Room for entries on their way: seconds of a link on which everything goes wrong.
const MAX_ENTRIES: usize = 256;
/// Stands in the first line of a link whose log has hashes of frames instead of frames.
pub(super) const HASHED: &str = " frames=hashes";
/// Between two looks at what is to be written.
const NAP: Duration = Duration::from_millis(100);

/// A log that links may write to.
#[derive(Debug)]
pub struct SessionLog {
    shared: Arc<Shared>,
    path: PathBuf,
    writer: Option<JoinHandle<()>>,
    epoch: Epoch,
    keeps_frames: bool,
    n_links: AtomicU32,
}

#[derive(Debug, Default)]
struct Shared {
    /// Ends of the rings of all links; only owners, at their beginning, and the writer ever look.
    sources: Mutex<Vec<Source>>,
    is_over: AtomicBool,
    failure: Mutex<Option<String>>,
}

/// What comes from one link.
#[derive(Debug)]
struct Source {
    number: u32,
    entries: Consumer<Entry>,
    /// Said by others than the link's owner.
    said: Vec<Entry>,
    /// Of the thread that reads and of the one that writes.
    taps: Option<[TapEnd; 2]>,
    recorder: Recorder,
    /// Of a link that is told the time: what it was told last, as far as it is known here.
    told: Option<Instant>,
}

/// One thing to write.
enum Item {
    Entry(Entry),
    Passing(Box<Passing>),
}

impl Item {
    fn at(&self) -> Instant {
        match self {
            Self::Entry(entry) => entry.at,
            Self::Passing(passing) => passing.at,
        }
    }
}

impl Source {
    /// What time it is for the link.
    fn now(&self) -> Instant {
        self.told.unwrap_or_else(Instant::now)
    }

    fn is_over(&self) -> bool {
        let is_silent = |taps: &[TapEnd; 2]| taps.iter().all(TapEnd::is_over);
        self.entries.is_abandoned() && self.taps.as_ref().is_none_or(is_silent)
    }

    /// Everything that waits, in the order of time; and how many packets found no room.
    fn take(&mut self) -> (Vec<Item>, u64) {
        let mut items = Vec::new();
        let mut n_lost = 0;
        while let Ok(entry) = self.entries.pop() {
            items.push(Item::Entry(entry));
        }
        items.extend(self.said.drain(..).map(Item::Entry));
        for tap in self.taps.iter_mut().flatten() {
            n_lost += tap.take_lost();
            let passing = std::iter::from_fn(|| tap.next());
            items.extend(passing.map(|passing| Item::Passing(Box::new(passing))));
        }
        items.sort_by_key(Item::at);
        self.told = self
            .told
            .max(items.last().map(Item::at).filter(|_| self.told.is_some()));
        (items, n_lost)
    }

    /// The lines of everything that waits.
    fn write(&mut self, lines: &mut String) {
        let (items, n_lost) = self.take();
        for item in items {
            match item {
                Item::Entry(entry) => self.recorder.entry(entry, lines),
                Item::Passing(passing) => self.recorder.passing(&passing, lines),
            }
        }
        if n_lost > 0 {
            self.recorder.lost(self.now(), n_lost, lines);
        }
        self.recorder.settle(self.now(), lines);
    }
}

impl Shared {
    fn sources(&self) -> MutexGuard<'_, Vec<Source>> {
        self.sources.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn failure(&self) -> MutexGuard<'_, Option<String>> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl SessionLog {
    /// Continues the log at `path`, or begins it.
    ///
    /// # Errors
    /// Its folder is not there; the file cannot be written; the system gives no thread.
    pub fn append(path: &Path, bound: Option<LogBound>) -> Result<Self, BridgeError> {
        let file = LogFile::open(path, bound)?;
        let shared = Arc::new(Shared::default());
        let (for_writer, epoch) = (Arc::clone(&shared), Epoch::now());
        let writer = Builder::new()
            .name(String::from("bridge-log"))
            .spawn(move || {
                if let Err(error) = write(&for_writer, file, epoch) {
                    *for_writer.failure() = Some(error.to_string());
                }
            })
            .map_err(BridgeError::Thread)?;
        Ok(Self {
            shared,
            path: path.to_path_buf(),
            writer: Some(writer),
            epoch,
            keeps_frames: true,
            n_links: AtomicU32::new(0),
        })
    }

    /// From the next link on, hashes of frames are written instead of frames.
    #[must_use]
    pub fn without_frames(mut self) -> Self {
        self.keeps_frames = false;
        self
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
        self.feed_told(target, None)
    }

    /// The same for a link that is told the time, from `told` on. What it is told has nothing to do
    /// with the system's clock: it is written as the time since the log was opened all the same.
    pub(super) fn feed_told(&self, target: &str, told: Option<Instant>) -> LogFeed {
        let (entries, end) = RingBuffer::new(MAX_ENTRIES);
        let begun = |told: Instant| told.checked_sub(self.epoch.monotonic.elapsed());
        let epoch = Epoch {
            monotonic: told.and_then(begun).unwrap_or(self.epoch.monotonic),
            ..self.epoch
        };
        let number = self.n_links.fetch_add(1, Ordering::Relaxed) + 1;
        self.shared.sources().push(Source {
            number,
            entries: end,
            said: Vec::new(),
            taps: None,
            recorder: Recorder::new(epoch, self.keeps_frames),
            told,
        });
        let writer = self.writer.as_ref().map(|writer| writer.thread().clone());
        writer.iter().for_each(Thread::unpark);
        let mut feed = LogFeed {
            entries,
            n_lost: 0,
            told,
            number,
            writer,
            shared: Arc::clone(&self.shared),
        };
        let program = selvedge_foundation::PROGRAM;
        let frames = if self.keeps_frames { "" } else { HASHED };
        let text = format!("n={number} target={target:?} program={program}{frames}");
        feed.say(event::LINK, text);
        feed
    }

    /// Says what is played on the link that was opened last, if it is open: `name` with its unit or
    /// kind, such as `scene_sha256`.
    pub fn about(&self, name: &str, value: &str) {
        if let Some(newest) = self.shared.sources().last_mut() {
            let entry = said(newest.now(), event::ABOUT, about(name, value));
            newest.said.push(entry);
        }
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
    /// When the link began, if it is told the time.
    told: Option<Instant>,
    number: u32,
    writer: Option<Thread>,
    shared: Arc<Shared>,
}

impl LogFeed {
    /// Says what is played and on what: `name` with its unit or kind, such as `scene_sha256`.
    pub fn about(&mut self, name: &str, value: &str) {
        self.say(event::ABOUT, about(name, value));
    }

    fn say(&mut self, event: &'static str, text: String) {
        let now = self.told.unwrap_or_else(Instant::now);
        self.push(said(now, event, text));
    }

    /// Says on which array, and with which settings of it.
    pub fn about_array(&mut self, profile: &ArrayProfile) {
        if let Ok(text) = profile.to_toml() {
            self.about("profile", &format!("{:?}", profile.name));
            self.about("profile_sha256", &sha256_hex([text.as_bytes()]));
        }
    }

    /// Adds an entry of now, by the host's clock alone.
    pub(super) fn note(&mut self, note: Note) {
        self.push(at(Instant::now(), note));
    }

    /// From now on what passes the port is recorded too.
    pub(super) fn follow(&self, taps: [TapEnd; 2]) {
        let mut sources = self.shared.sources();
        let source = sources
            .iter_mut()
            .find(|source| source.number == self.number);
        if let Some(source) = source {
            if let Some(writer) = &self.writer {
                for tap in &taps {
                    tap.open(writer);
                }
            }
            source.taps = Some(taps);
        }
    }

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

fn about(name: &str, value: &str) -> String {
    format!("{name}={value}")
}

/// An entry in words.
fn said(now: Instant, event: &'static str, text: String) -> Entry {
    at(now, Note::Said(event, text))
}

fn at(now: Instant, note: Note) -> Entry {
    Entry {
        at: now,
        tick: None,
        device_us: None,
        note,
    }
}

fn write(shared: &Shared, mut file: LogFile, epoch: Epoch) -> std::io::Result<()> {
    let mut order = OfLink {
        number: None,
        epoch,
    };
    loop {
        // Asked first: what was added before the end is written.
        let is_over = shared.is_over.load(Ordering::Acquire);
        let (lines, is_fed) = gather(shared, &mut order, is_over || file.is_full());
        file.add(&lines)?;
        if file.is_full() && !is_over {
            let lines = heads(shared, &mut order);
            file.make_way()?;
            file.add(&lines)?;
        }
        if is_over {
            return Ok(());
        }
        if is_fed {
            thread::park_timeout(NAP);
        } else {
            thread::park();
        }
    }
}

/// Makes lines of everything that waits; whether more may come.
fn gather(shared: &Shared, order: &mut OfLink, is_end: bool) -> (String, bool) {
    let mut lines = String::new();
    let mut sources = shared.sources();
    sources.retain_mut(|source| {
        let mut own = String::new();
        // Asked first, as above.
        let is_over = source.is_over();
        source.write(&mut own);
        if is_end || is_over {
            source.recorder.end_run(&mut own);
        }
        order.add(source.number, &own, &mut lines);
        !is_over
    });
    (lines, !sources.is_empty())
}

/// What stands at the head of another file.
fn heads(shared: &Shared, order: &mut OfLink) -> String {
    let mut lines = String::new();
    for source in shared.sources().iter_mut() {
        let mut own = String::new();
        source.recorder.head(&mut own);
        order.add(source.number, &own, &mut lines);
    }
    lines
}

/// Says whose lines come next where that changes.
struct OfLink {
    number: Option<u32>,
    epoch: Epoch,
}

impl OfLink {
    fn add(&mut self, number: u32, own: &str, lines: &mut String) {
        if own.is_empty() {
            return;
        }
        // Whose first line it is says so itself.
        if self
            .number
            .replace(number)
            .is_some_and(|last| last != number)
        {
            let entry = said(Instant::now(), event::OF_LINK, format!("n={number}"));
            line::write_entry(lines, &entry, self.epoch);
        }
        lines.push_str(own);
    }
}

#[cfg(test)]
mod tests;
