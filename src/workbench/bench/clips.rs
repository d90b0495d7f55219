//! The recording at hand on its way to a file for other programs: rendered over the scene as it is
//! felt now, on a thread of its own that shows how far it is and can be stopped.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::{Task, finished};
use selvedge_engine::{ClipKind, ClipWriter, Written, write_clip};
use selvedge_render::{RenderScene, Replay};

/// Every file that is offered, and what it is called.
pub(crate) const CLIPS: [(ClipKind, &str); 4] = [
    (ClipKind::FLOAT, "Waveform to play, 48 kHz…"),
    (ClipKind::ARCHIVE, "Waveform to keep, 8 kHz…"),
    (ClipKind::Hjif, "MPEG haptics…"),
    (ClipKind::Frames, "Frames as a table…"),
];

/// A file on its way.
#[derive(Debug, Default)]
pub(crate) struct Clips {
    task: Option<Task<Written>>,
    /// Where the last one went.
    last: Option<PathBuf>,
}

/// What the menu shows of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ClipsView {
    /// Whether there is a recording to write.
    pub(crate) has_take: bool,
    /// How far a file is, 0…1; `None` while none is written.
    pub share: Option<f32>,
}

/// How the names of such files end, without the dot.
pub(crate) fn ending(kind: ClipKind) -> &'static str {
    match kind {
        ClipKind::Wav { .. } => "wav",
        ClipKind::Hjif => "hjif",
        ClipKind::Frames => "csv",
    }
}

impl Bench {
    /// How it stands with files for other programs.
    pub(crate) fn clips_view(&self) -> ClipsView {
        let task = self.transient.clips.task.as_ref();
        ClipsView {
            has_take: self.take.is_some(),
            share: task.map(Task::share),
        }
    }

    /// Where a file is expected to go: where the last one did, else beside the recording or scene.
    pub(crate) fn clip_path(&self, kind: ClipKind) -> PathBuf {
        let name = self.take.as_ref().map_or("recording", |take| take.name());
        let beside = self.take.as_ref().and_then(|take| take.file());
        let beside = beside.or_else(|| self.document.path().map(PathBuf::as_path));
        let last = self.transient.clips.last.as_deref();
        let folder = last.or_else(|| beside.and_then(Path::parent));
        let stem = match kind {
            ClipKind::Frames => format!("{name} frames"),
            _ => name.to_owned(),
        };
        let file = format!("{}.{}", stem.to_lowercase().replace(' ', "-"), ending(kind));
        folder.map_or_else(|| PathBuf::from(&file), |folder| folder.join(&file))
    }

    /// Renders the recording into a file; one at a time.
    pub(crate) fn write_clip_to(&mut self, kind: ClipKind, path: &Path) {
        let Some(take) = self.take.clone() else {
            let words = "There is no recording to export; record one first";
            return self.transient.notices.give(words);
        };
        if self.transient.clips.task.is_some() {
            let words = "Another file is being written; wait for it, or stop it in the menu";
            return self.transient.notices.give(words);
        }
        let scene = RenderScene::of(&self.loaded);
        let n_contactors = scene
            .displays
            .iter()
            .map(|display| display.offsets.len())
            .sum();
        let profile = self.engine.profile().clone();
        let (rendering, title) = (self.rendering, self.document.scene().name.clone());
        let (exploration, place) = (Arc::clone(take.path()), path.to_owned());
        let applied = Arc::clone(take.apply_ticks());
        self.transient.clips.last = path.parent().map(Path::to_owned);
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
        self.transient.clips.task = Some(task);
    }

    /// Stops the file that is written; nothing of it is left.
    pub(crate) fn stop_clip(&self) {
        if let Some(task) = &self.transient.clips.task {
            task.stop();
        }
    }

    /// Takes the news of a file. To be called every frame.
    pub(crate) fn poll_clips(&mut self) {
        let task = &mut self.transient.clips.task;
        let was_stopped = task.as_ref().is_some_and(Task::is_stopped);
        let Some(outcome) = finished(task) else {
            return;
        };
        match outcome {
            Ok(written) => self.transient.notices.give(said(&written)),
            Err(_) if was_stopped => {}
            Err(words) => self.transient.notices.give(words),
        }
    }
}

/// What a user should know of files that are there.
fn said(written: &Written) -> String {
    let place = match &written.paths[..] {
        [first, .., last] => {
            let n_parts = written.paths.len();
            format!(
                "{} to {}, {n_parts} parts, are",
                first.display(),
                last.display()
            )
        }
        [only] => format!("{} is", only.display()),
        [] => "Nothing is".to_owned(),
    };
    match written.peak.filter(|peak| *peak > 1.0) {
        Some(peak) => format!("{place} written; it reaches {peak:.2} of full scale"),
        None => format!("{place} written"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Drive;
    use crate::bench::recording::Take;
    use selvedge_foundation::geometry::Point;
    use selvedge_render::scene::{ExplorationPath, PathRow};
    use selvedge_scratch::ScratchFolder;

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
        bench.rendering.method = selvedge_render::array::Method::Banded;
        bench.take = Some(Take::from_path(folder.join("slow stroke.csv"), path));
        for (kind, _) in CLIPS {
            let path = write(&mut bench, kind);
            assert!(path.metadata().unwrap().len() > 2000, "{kind:?}");
            let last = bench.transient.notices.shown().last().unwrap();
            assert!(last.text.ends_with("is written"), "{}", last.text);
            std::fs::remove_file(path).unwrap();
        }
        assert_eq!(
            bench.clip_path(ClipKind::Hjif),
            folder.join("slow-stroke.hjif")
        );
    }
}
