//! The recording that is being made: a thread of its own takes it from the engine and writes it.
//!
//! Where nothing may depend on a clock the same is done once a frame. When the disk refuses, the
//! recording goes on in memory and what could not be written is tried again.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use crate::bench::background::{Executor, Task, finished};
use crate::bench::recording::{About, Marker, Recording, file::RecordingFile};

/// How often the thread looks: what the engine has then is on disk at once.
const LOOK: Duration = Duration::from_millis(250);

/// The recording that is being made.
#[derive(Debug)]
pub(crate) struct Running {
    /// What it is.
    pub(crate) about: About,
    /// What was marked so far.
    pub(crate) markers: Vec<Marker>,
    work: Work,
    failures: Receiver<String>,
}

/// How it stands with a recording.
#[derive(Debug)]
pub(crate) enum Standing {
    /// It goes on.
    Running,
    /// It is over: what was recorded, if anything was.
    Over(Option<Box<Recording>>),
}

#[derive(Debug)]
enum Work {
    Here(Box<Writer>),
    Thread(Option<Task<Option<Recording>>>),
}

/// Takes ticks from the engine and writes them.
#[derive(Debug)]
struct Writer {
    recording: selvedge_engine::Recording,
    about: About,
    /// Where recordings lie; `None` on a system without such a place.
    root: Option<PathBuf>,
    file: Option<RecordingFile>,
    n_written: usize,
    failures: SyncSender<String>,
    has_failed: bool,
}

impl Running {
    /// Begins to keep a recording in a new folder of `root`.
    pub(crate) fn start(
        executor: &Executor,
        recording: selvedge_engine::Recording,
        about: About,
        root: Option<PathBuf>,
    ) -> Self {
        let (sender, failures) = sync_channel(1);
        let mut writer = Box::new(Writer {
            recording,
            about: about.clone(),
            root,
            file: None,
            n_written: 0,
            failures: sender,
            has_failed: false,
        });
        let work = match executor {
            Executor::InLine => Work::Here(writer),
            Executor::Threads(_) => {
                Work::Thread(Some(executor.start("selvedge-recording", move |_| {
                    while !writer.step() {
                        thread::sleep(LOOK);
                    }
                    Ok(writer.finish())
                })))
            }
        };
        Self {
            about,
            markers: Vec::new(),
            work,
            failures,
        }
    }

    /// How it stands with it. Once a frame.
    pub(crate) fn poll(&mut self) -> Standing {
        let mut standing = self.look();
        if let Standing::Over(Some(recording)) = &mut standing {
            for marker in self.markers.drain(..) {
                recording.mark(marker);
            }
        }
        standing
    }

    fn look(&mut self) -> Standing {
        match &mut self.work {
            Work::Here(writer) => {
                if writer.step() {
                    Standing::Over(writer.finish().map(Box::new))
                } else {
                    Standing::Running
                }
            }
            Work::Thread(task) => match finished(task) {
                Some(kept) => Standing::Over(kept.unwrap_or_default().map(Box::new)),
                None if task.is_none() => Standing::Over(None),
                None => Standing::Running,
            },
        }
    }

    /// Why it cannot be written, once.
    pub(crate) fn failure(&self) -> Option<String> {
        self.failures.try_recv().ok()
    }
}

impl Writer {
    /// Writes what there is; whether that was all.
    fn step(&mut self) -> bool {
        self.recording.collect();
        let is_over = self.recording.has_ended();
        if let Err(line) = self.write()
            && !std::mem::replace(&mut self.has_failed, true)
        {
            // Whoever listens is told once.
            drop(self.failures.try_send(format!(
                "{line}; the recording goes on in memory: make room, or export it when it is over"
            )));
        }
        is_over
    }

    fn write(&mut self) -> Result<(), String> {
        let n_ticks = self.recording.ticks().len();
        let Some(root) = self.root.as_deref().filter(|_| n_ticks > self.n_written) else {
            return Ok(());
        };
        if self.file.is_none() {
            let (about, of) = (self.about.clone(), &self.recording);
            let sizes = [of.n_others(), of.n_contactors()];
            let created = RecordingFile::create(root, about, sizes);
            self.file = Some(created.map_err(|error| error.to_string())?);
        }
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        let appended = file.append(&self.recording, self.n_written);
        appended.map_err(|error| error.to_string())?;
        self.n_written = n_ticks;
        self.has_failed = false;
        Ok(())
    }

    /// The recording, if there is one: a recording that ended before its first tick is none.
    fn finish(&mut self) -> Option<Recording> {
        let is_whole = self.n_written == self.recording.ticks().len();
        let file = self.file.take().filter(|_| is_whole);
        let kept = file.and_then(|file| file.finish().ok());
        let (folder, about) = match kept {
            Some((folder, about)) => (Some(folder), about),
            None => (None, self.about.clone()),
        };
        let mut recording = Recording::from_recording(&self.recording, about).ok()?;
        recording.folder = folder;
        Some(recording)
    }
}
