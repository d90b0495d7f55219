//! A take: a finished exploration that can be replayed, with what is drawn of it over time.
//!
//! A take from a recording knows how strong it felt; one from a path file knows only how it moves:
//! its amplitudes depend on the scene. Makes no picture and plays nothing.

pub(crate) mod strips;

pub(crate) use crate::bench::recording::strips::Strips;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use selvedge_engine::ApplyTicks;
use selvedge_render::scene::{ExplorationPath, SceneError};

/// A finished exploration. Cheap to clone.
#[derive(Debug, Clone)]
pub(crate) struct Recording {
    path: Arc<ExplorationPath>,
    /// At which of its ticks a device played each row.
    apply_ticks: ApplyTicks,
    strips: Arc<Strips>,
    name: String,
    file: Option<PathBuf>,
}

impl Recording {
    /// What was just recorded, as far as it was collected.
    ///
    /// # Errors
    /// Nothing was recorded.
    pub(crate) fn from_recording(
        recording: &selvedge_engine::Recording,
    ) -> Result<Self, SceneError> {
        let path = recording.to_path()?;
        let ticks = recording.ticks().iter().enumerate();
        let strips = Strips::felt(
            ticks.map(|(index, recorded)| (recorded.pose, recording.amplitudes_um(index))),
        );
        Ok(Self {
            path: Arc::new(path),
            apply_ticks: recording.apply_ticks(),
            strips: Arc::new(strips),
            name: "New recording".to_owned(),
            file: None,
        })
    }

    /// The exploration of a path file. Walks through all of it: an hour takes some milliseconds.
    pub(crate) fn from_path(file: PathBuf, path: ExplorationPath) -> Self {
        Self {
            strips: Arc::new(Strips::moved(&path)),
            path: Arc::new(path),
            apply_ticks: ApplyTicks::default(),
            name: name_of(&file),
            file: Some(file),
        }
    }

    /// The exploration to replay.
    pub(crate) fn path(&self) -> &Arc<ExplorationPath> {
        &self.path
    }

    /// At which of its ticks a device played each row, as long as this program knows.
    pub(crate) fn apply_ticks(&self) -> &ApplyTicks {
        &self.apply_ticks
    }

    /// What is drawn of it over time.
    pub(crate) fn strips(&self) -> &Arc<Strips> {
        &self.strips
    }

    /// What people call it.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The file that holds it.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// The same once it is in this file.
    pub(crate) fn saved_as(self, file: PathBuf) -> Self {
        Self {
            name: name_of(&file),
            file: Some(file),
            ..self
        }
    }
}

/// A file's name without its folder and ending.
fn name_of(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or(file.as_os_str());
    stem.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Drive;
    use crate::bench::command::PlayCommand;
    use crate::shell::window::Workbench;
    use selvedge_engine::Command;
    use selvedge_foundation::geometry::Point;
    use selvedge_render::scene::PathRow;

    #[test]
    fn a_recording_replays_what_was_felt() {
        let ctx = eframe::egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        window.dispatch(PlayCommand::Toggle.into());
        window.bench.engine.advance_ticks(3).unwrap();
        window.bench.engine.send(Command::StartRecording).unwrap();
        window.bench.engine.advance_ticks(60).unwrap();
        window.bench.engine.send(Command::StopRecording).unwrap();
        window.bench.engine.advance_ticks(1).unwrap();
        let recording = window.bench.engine.take_recording().unwrap();
        let take = Recording::from_recording(&recording).unwrap();
        assert!(take.file().is_none() && take.strips().has_levels());
        assert_eq!(take.strips().n_ticks(), 60);
        assert_eq!(take.path().n_ticks(), 60);
        let last = take.strips().at(59).unwrap();
        let speed = recording.ticks()[59].pose.velocity.speed_mm_per_s();
        assert!(
            (last.speed_mm_per_s - speed).abs() < 1e-3 && speed > 1.0,
            "{last:?}"
        );
        let mean_um = (0..60).filter_map(|tick| take.strips().at(tick)?.mean_um);
        assert!(
            mean_um.into_iter().any(|um| um[1] > 0.0),
            "it went over cloth"
        );
    }

    #[test]
    fn a_path_file_is_a_saved_take_without_levels() {
        let row = |t_s, x_mm| PathRow {
            t_s,
            position: Point::new(x_mm, 0.0),
            ..PathRow::default()
        };
        let path = ExplorationPath::new(vec![row(0.0, 0.0), row(1.0, 80.0)]).unwrap();
        let take = Recording::from_path(PathBuf::from("/somewhere/slow stroke.csv"), path);
        assert_eq!(take.name(), "slow stroke");
        assert!(take.file().is_some(), "it came from one");
        assert_eq!(take.strips().n_ticks(), take.path().n_ticks());
        let middle = take.strips().at(20).unwrap();
        assert!((middle.speed_mm_per_s - 80.0).abs() < 1e-3, "{middle:?}");
        assert_eq!(middle.mean_um, None);
    }

    #[test]
    fn saving_names_a_take_after_its_file() {
        let path = ExplorationPath::new(vec![PathRow::default()]).unwrap();
        let take = Recording::from_path(PathBuf::from("one.csv"), path);
        let saved = take.saved_as(PathBuf::from("/takes/two.csv"));
        assert_eq!(saved.name(), "two");
        assert_eq!(saved.file(), Some(Path::new("/takes/two.csv")));
    }
}
