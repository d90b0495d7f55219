//! Scenes and recordings that are opened and saved.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::{Task, finished};
use crate::bench::clips::{ClipsView, ending, said};
use crate::bench::notices::Until;
use crate::bench::opening::{Opened, Origin, open};
use crate::bench::recording::excerpt::part_of;
use crate::bench::settings::own_documents;
use selvedge_engine::{ClipKind, ClipWriter, write_clip};
use selvedge_render::{RenderScene, Replay};

impl Bench {
    /// Takes scenes and recordings that other threads bring.
    pub(crate) fn take_files(&mut self) {
        if let Some(outcome) = finished(&mut self.files.opening) {
            self.take_opened(outcome);
        }
        if let Some(outcome) = finished(&mut self.files.saving) {
            match outcome {
                Ok(line) => self.notices.give_until(Until::Read, line),
                Err(line) => self.notices.give(line),
            }
        }
    }

    /// Opens another scene.
    pub(crate) fn open(&mut self, origin: Origin) {
        let rendering = self.settings.preferences.rendering;
        let task = self.executor.start("selvedge-open", move |_| {
            let opened = open(origin, rendering).map(Box::new);
            opened.map_err(|error| error.to_string())
        });
        self.files.opening = Some(task);
        self.take_files();
    }

    /// Takes a scene that was opened; when it was not, says why and keeps the last one.
    fn take_opened(&mut self, outcome: Result<Box<Opened>, String>) {
        let restoring = self.files.restoring.take();
        match outcome {
            Ok(opened) => {
                if let Some(path) = &opened.path {
                    self.settings.preferences.remember_scene(path);
                }
                self.show_scene(*opened);
                if let Some(document) = restoring {
                    self.document = document;
                }
            }
            Err(line) => {
                if restoring.is_some() {
                    self.files.recovery.put_off();
                }
                self.notices.give(line);
            }
        }
    }

    /// Exports the path of the recording at hand, or of what is selected of it.
    pub(crate) fn save_recording(&mut self, path: PathBuf) {
        let Some(take) = self.exploration.at_hand.clone() else {
            let words = "There is no recording to export; record one first";
            return self.notices.give(words);
        };
        self.files.clips.last = path.parent().map(Path::to_owned);
        let ticks = self.exploration.selected.clone();
        let ticks = ticks.unwrap_or_else(|| 0..take.path().n_ticks());
        let task = self.executor.start("selvedge-save", move |_| {
            let is_whole = ticks == (0..take.path().n_ticks());
            let written = if is_whole {
                take.path().write(&path)
            } else {
                part_of(take.path(), ticks).and_then(|part| part.write(&path))
            };
            written.map_err(|error| error.to_string())?;
            Ok(format!("{} is written", path.display()))
        });
        self.files.saving = Some(task);
        self.take_files();
    }

    /// Lets the recording at hand move the display; it waits at its first tick.
    pub(crate) fn replay(&mut self) {
        let Some(take) = self.exploration.at_hand.clone() else {
            return;
        };
        self.log_path(take.path());
        let source = selvedge_engine::InputSource::Replay(Arc::clone(take.path()));
        self.send(selvedge_engine::Command::SetSource(source));
        self.send(selvedge_engine::Command::SetLoop(
            self.exploration.does_loop,
        ));
        self.exploration.loop_within = None;
        self.send(selvedge_engine::Command::Seek(0));
    }
}

impl Bench {
    /// How it stands with files for other programs.
    pub(crate) fn clips_view(&self) -> ClipsView {
        let task = self.files.clips.task.as_ref();
        ClipsView {
            has_take: self.exploration.at_hand.is_some(),
            share: task.map(Task::share),
        }
    }

    /// Where a file is expected to go, with its folder.
    pub(crate) fn clip_path(&self, kind: ClipKind) -> PathBuf {
        match kind {
            ClipKind::Frames => self.export_path_of(" frames", ending(kind)),
            _ => self.export_path_of("", ending(kind)),
        }
    }

    /// Where the path of the recording at hand is expected to go.
    pub(crate) fn path_file(&self) -> PathBuf {
        self.export_path_of("", "csv")
    }

    fn export_path_of(&self, what: &str, ending: &str) -> PathBuf {
        let take = self.exploration.at_hand.as_ref();
        let name = take.map_or("recording", |take| take.name());
        let stem = format!("{name}{what}")
            .to_lowercase()
            .replace([' ', '/', '\\'], "-");
        self.export_folder().join(format!("{stem}.{ending}"))
    }

    /// Where exports go: where the last one did, else beside the recording or scene, else where the
    /// user keeps documents.
    pub(crate) fn export_folder(&self) -> PathBuf {
        let take = self.exploration.at_hand.as_ref();
        let beside = take.and_then(|take| take.file());
        let beside = beside.or_else(|| self.document.path().map(PathBuf::as_path));
        let last = self.files.clips.last.as_deref();
        let folder = last.or_else(|| beside.and_then(Path::parent));
        folder.map_or_else(own_documents, Path::to_owned)
    }

    /// Renders the recording into a file; one at a time.
    pub(crate) fn write_clip_to(&mut self, kind: ClipKind, path: &Path) {
        let Some(take) = self.exploration.at_hand.clone() else {
            let words = "There is no recording to export; record one first";
            return self.notices.give(words);
        };
        if self.files.clips.task.is_some() {
            let words = "Another file is being written; wait for it, or stop it in the menu";
            return self.notices.give(words);
        }
        let scene = RenderScene::of(&self.engine_scene.loaded);
        let n_contactors = scene
            .displays
            .iter()
            .map(|display| display.offsets.len())
            .sum();
        let profile = self.engine.profile().clone();
        let (rendering, title) = (
            self.engine_scene.rendering,
            self.document.scene().name.clone(),
        );
        let (exploration, place) = (Arc::clone(take.path()), path.to_owned());
        let applied = Arc::clone(take.apply_ticks());
        self.files.clips.last = path.parent().map(Path::to_owned);
        let work = move |progress: &mut selvedge_foundation::progress::Progress<'_>| {
            let what = Replay {
                scene: &scene,
                method: rendering.method,
                accuracy: rendering.accuracy(),
                measures_error: false,
            };
            let array = (&profile, n_contactors);
            let clip = ClipWriter::of_played(&place, kind, array, &title, applied);
            clip.and_then(|clip| write_clip(clip, &what, &exploration, progress))
                .map_err(|error| error.to_string())
        };
        let task = self.executor.start("selvedge-clip", work);
        self.files.clips.task = Some(task);
    }

    /// Stops the file that is written; nothing of it is left.
    pub(crate) fn stop_clip(&self) {
        if let Some(task) = &self.files.clips.task {
            task.stop();
        }
    }

    /// Takes the news of a file. To be called every frame.
    pub(crate) fn poll_clips(&mut self) {
        if let Some(outcome) = finished(&mut self.files.clips.task) {
            let line = outcome.map_or_else(|words| words, |written| said(&written));
            self.notices.give(line);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Drive;
    use crate::bench::clips::CLIPS;
    use crate::bench::recording::Recording;
    use selvedge_foundation::geometry::Point;
    use selvedge_render::scene::{ExplorationPath, PathRow};
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_textile_that_has_changed_is_told_by_the_first_scene_as_by_later_ones() {
        let ctx = eframe::egui::Context::default();
        let folder = ScratchFolder::made("changed");
        let text = "name = \"a\"\nsize_mm = [99.0, 99.0]\n[[textile]]\nid = \"denim\"\n\
                    origin_mm = [1.0, 1.0]\nsize_mm = [9.0, 9.0]\n[content]\ndenim = \"0\"\n";
        let scene = folder.write("a.scene.toml", text);
        let n_told = |bench: &Bench| {
            let told = bench.notices.shown().iter();
            told.filter(|notice| notice.text.starts_with("denim is not what it was"))
                .map(|notice| notice.n_times)
                .sum::<u32>()
        };
        let mut bench = Bench::new(&ctx, Some(&scene), Drive::Stepped).unwrap();
        assert_eq!(n_told(&bench), 1);
        bench.open(Origin::File(scene));
        assert_eq!(n_told(&bench), 2);
        bench.open(Origin::Shipped);
        assert_eq!(n_told(&bench), 2, "nothing is stated there");
    }

    #[test]
    fn the_recording_at_hand_is_written_as_every_kind() {
        let ctx = eframe::egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        let folder = ScratchFolder::made("clips");
        let write = |bench: &mut Bench, kind| {
            let path = folder.join(format!("a.{}", ending(kind)));
            bench.write_clip_to(kind, &path);
            bench.poll_clips();
            path
        };
        let none = write(&mut bench, ClipKind::Hjif);
        assert!(!none.exists() && !bench.clips_view().has_take);
        let row = |t_s, x_mm| PathRow {
            t_s,
            position: Point::new(x_mm, 60.0),
            ..PathRow::default()
        };
        let path = ExplorationPath::new(vec![row(0.0, 40.0), row(1.0, 120.0)]).unwrap();
        // Tables would take longer than the file.
        bench.engine_scene.rendering.method = selvedge_render::array::Method::Banded;
        bench.exploration.at_hand =
            Some(Recording::from_path(folder.join("slow stroke.csv"), path));
        for (kind, _) in CLIPS {
            let path = write(&mut bench, kind);
            assert!(path.metadata().unwrap().len() > 2000, "{kind:?}");
            let last = bench.notices.shown().last().unwrap();
            assert!(last.text.ends_with("is written"), "{}", last.text);
            std::fs::remove_file(path).unwrap();
        }
        assert_eq!(
            bench.clip_path(ClipKind::Hjif),
            folder.join("slow-stroke.hjif")
        );
    }
}
