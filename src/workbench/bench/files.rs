//! Scenes and recordings that are opened and saved.

use std::path::PathBuf;
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::error::AppError;
use crate::bench::job::{Job, Polled};
use crate::bench::opening::{Opened, Opening, Origin, open};
use crate::bench::recording::Take;
use selvedge_render::scene::{ExplorationPath, SceneError};

impl Bench {
    /// Takes scenes and recordings that other threads bring.
    pub(crate) fn take_files(&mut self) {
        if let Some(outcome) = self.transient.opening.as_ref().and_then(Opening::poll) {
            self.transient.opening = None;
            self.take_opened(outcome);
        }
        match self.transient.reading.as_ref().map(Job::poll) {
            Some(Polled::Done(outcome)) => {
                self.transient.reading = None;
                self.take_take(outcome);
            }
            Some(Polled::BrokeOff) => self.transient.reading = None,
            Some(Polled::Working) | None => {}
        }
        match self.transient.saving.as_ref().map(Job::poll) {
            Some(Polled::Done(outcome)) => {
                self.transient.saving = None;
                self.take_saved(outcome);
            }
            Some(Polled::BrokeOff) => self.transient.saving = None,
            Some(Polled::Working) | None => {}
        }
    }

    /// Opens another scene.
    pub(crate) fn open(&mut self, origin: Origin) {
        if self.is_stepped {
            let outcome = open(origin, self.settings.preferences.rendering).map(Box::new);
            return self.take_opened(outcome);
        }
        match Opening::start(origin, self.settings.preferences.rendering, &self.ctx) {
            Ok(opening) => self.transient.opening = Some(opening),
            Err(error) => {
                let words = format!("The scene was not opened: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes a scene that was opened; when it was not, says why and keeps the last one.
    pub(crate) fn take_opened(&mut self, outcome: Result<Box<Opened>, AppError>) {
        match outcome {
            Ok(opened) => {
                if let Some(path) = &opened.path {
                    self.settings.preferences.remember_scene(path);
                }
                self.show_scene(*opened);
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    /// Opens a recorded exploration.
    pub(crate) fn open_recording(&mut self, path: PathBuf) {
        let read = move || {
            let found = ExplorationPath::read(&path);
            found.map(|found| Take::from_path(path, found))
        };
        if self.is_stepped {
            return self.take_take(read());
        }
        match Job::start("selvedge-recording", &self.ctx, read) {
            Ok(job) => self.transient.reading = Some(job),
            Err(error) => {
                let words = format!("The recording was not opened: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes an exploration that was read: it is replayed next.
    pub(crate) fn take_take(&mut self, outcome: Result<Take, SceneError>) {
        match outcome {
            Ok(take) => {
                self.take = Some(take);
                self.replay();
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    /// Saves the recording at hand.
    pub(crate) fn save_recording(&mut self, path: PathBuf) {
        let Some(take) = self.take.clone() else {
            let words = "There is no recording to save; record one first";
            return self.transient.notices.give(words);
        };
        let write = move || match take.path().write(&path) {
            Ok(()) => Ok(take.saved_as(path)),
            Err(error) => Err(error),
        };
        if self.is_stepped {
            return self.take_saved(write());
        }
        match Job::start("selvedge-save", &self.ctx, write) {
            Ok(job) => self.transient.saving = Some(job),
            Err(error) => {
                let words = format!("The recording was not saved: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes the news that a recording was saved.
    pub(crate) fn take_saved(&mut self, outcome: Result<Take, SceneError>) {
        match outcome {
            Ok(saved) => {
                // Another exploration may have been recorded meanwhile.
                let is_same = |take: &Take| Arc::ptr_eq(take.path(), saved.path());
                if self.take.as_ref().is_some_and(is_same) {
                    self.take = Some(saved);
                }
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    /// Lets the recording at hand move the display; it waits at its first tick.
    pub(crate) fn replay(&mut self) {
        let Some(take) = self.take.clone() else {
            return;
        };
        let source = selvedge_engine::InputSource::Replay(Arc::clone(take.path()));
        self.send(selvedge_engine::Command::SetSource(source));
        self.send(selvedge_engine::Command::SetLoop(self.transient.does_loop));
        self.send(selvedge_engine::Command::Seek(0));
    }
}
