//! Scenes and recordings that are opened and saved.

use std::path::PathBuf;
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::finished;
use crate::bench::opening::{Opened, Origin, open};
use crate::bench::recording::Take;
use selvedge_render::scene::ExplorationPath;

impl Bench {
    /// Takes scenes and recordings that other threads bring.
    pub(crate) fn take_files(&mut self) {
        if let Some(outcome) = finished(&mut self.transient.opening) {
            self.take_opened(outcome);
        }
        if let Some(outcome) = finished(&mut self.transient.reading) {
            self.take_take(outcome);
        }
        if let Some(outcome) = finished(&mut self.transient.saving) {
            self.take_saved(outcome);
        }
    }

    /// Opens another scene.
    pub(crate) fn open(&mut self, origin: Origin) {
        let rendering = self.settings.preferences.rendering;
        let task = self.executor.start("selvedge-open", move |_| {
            let opened = open(origin, rendering).map(Box::new);
            opened.map_err(|error| error.to_string())
        });
        self.transient.opening = Some(task);
        self.take_files();
    }

    /// Takes a scene that was opened; when it was not, says why and keeps the last one.
    pub(crate) fn take_opened(&mut self, outcome: Result<Box<Opened>, String>) {
        match outcome {
            Ok(opened) => {
                if let Some(path) = &opened.path {
                    self.settings.preferences.remember_scene(path);
                }
                self.show_scene(*opened);
            }
            Err(line) => self.transient.notices.give(line),
        }
    }

    /// Opens a recorded exploration.
    pub(crate) fn open_recording(&mut self, path: PathBuf) {
        let task = self.executor.start("selvedge-recording", move |_| {
            let found = ExplorationPath::read(&path);
            let take = found.map(|found| Take::from_path(path, found));
            take.map_err(|error| error.to_string())
        });
        self.transient.reading = Some(task);
        self.take_files();
    }

    /// Takes an exploration that was read: it is replayed next.
    pub(crate) fn take_take(&mut self, outcome: Result<Take, String>) {
        match outcome {
            Ok(take) => {
                self.take = Some(take);
                self.replay();
            }
            Err(line) => self.transient.notices.give(line),
        }
    }

    /// Saves the recording at hand.
    pub(crate) fn save_recording(&mut self, path: PathBuf) {
        let Some(take) = self.take.clone() else {
            let words = "There is no recording to save; record one first";
            return self.transient.notices.give(words);
        };
        let task = self.executor.start("selvedge-save", move |_| {
            let written = take.path().write(&path);
            let saved = written.map(|()| take.saved_as(path));
            saved.map_err(|error| error.to_string())
        });
        self.transient.saving = Some(task);
        self.take_files();
    }

    /// Takes the news that a recording was saved.
    pub(crate) fn take_saved(&mut self, outcome: Result<Take, String>) {
        match outcome {
            Ok(saved) => {
                // Another exploration may have been recorded meanwhile.
                let is_same = |take: &Take| Arc::ptr_eq(take.path(), saved.path());
                if self.take.as_ref().is_some_and(is_same) {
                    self.take = Some(saved);
                }
            }
            Err(line) => self.transient.notices.give(line),
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
