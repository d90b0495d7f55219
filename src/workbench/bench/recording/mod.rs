//! Recordings: explorations that are objects of their own, on disk from their first tick.
//!
//! A recording from a tick to the next knows how strong it was on every contactor and whether an
//! armed device played it; one from a path file knows only how it moves: its amplitudes depend on
//! the scene. [`Recordings`] is the list of them all.

pub(crate) mod excerpt;
pub(crate) mod file;
pub(crate) mod list;
mod rows;
pub(crate) mod running;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod tiles;

pub(crate) use crate::bench::recording::file::{About, Marker};
pub(crate) use crate::bench::recording::list::{Entry, Place, Recordings};

use std::path::{Path, PathBuf};
use std::sync::Arc;

use selvedge_engine::ApplyTicks;
use selvedge_render::scene::{ExplorationPath, Scene, SceneError};

/// Amplitudes of every contactor at every tick, after gains and before output limits.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Felt {
    /// Contactors of all displays together.
    pub(crate) n_contactors: usize,
    /// [A40, A320] of every contactor, tick for tick, µm.
    pub(crate) amplitudes_um: Vec<[f32; 2]>,
}

/// A finished exploration. Cheap to clone.
#[derive(Debug, Clone)]
pub(crate) struct Recording {
    path: Arc<ExplorationPath>,
    /// At which of its ticks a device played each row.
    apply_ticks: ApplyTicks,
    felt: Arc<Felt>,
    /// Ticks before which others are missing, rising.
    missing: Arc<[u64]>,
    about: Arc<About>,
    /// The folder that holds it, if one does.
    pub(crate) folder: Option<PathBuf>,
    file: Option<PathBuf>,
}

impl Recording {
    /// What was just recorded, as far as it was collected.
    ///
    /// # Errors
    /// Nothing was recorded.
    pub(crate) fn from_recording(
        recording: &selvedge_engine::Recording,
        about: About,
    ) -> Result<Self, SceneError> {
        let ticks = recording.ticks();
        let device_ticks = ticks
            .iter()
            .map(|tick| tick.sent.map(|sent| sent.apply_tick));
        let device_ticks: Vec<Option<u32>> = device_ticks.collect();
        let missing = missing_before(ticks.iter().map(|tick| tick.tick));
        let mut felt = Felt {
            n_contactors: recording.n_contactors(),
            amplitudes_um: Vec::with_capacity(ticks.len() * recording.n_contactors()),
        };
        for nth in 0..ticks.len() {
            felt.amplitudes_um
                .extend_from_slice(recording.amplitudes_um(nth));
        }
        let mut made = Self::felt(about, recording.to_path()?, &device_ticks, felt);
        made.missing = missing;
        Ok(made)
    }

    /// An exploration with what was felt of it, and the device's tick of every one that was sent.
    pub(crate) fn felt(
        about: About,
        path: ExplorationPath,
        device_ticks: &[Option<u32>],
        felt: Felt,
    ) -> Self {
        let was_felt = device_ticks.iter().any(Option::is_some);
        Self {
            path: Arc::new(path),
            apply_ticks: if was_felt {
                device_ticks.into()
            } else {
                ApplyTicks::default()
            },
            felt: Arc::new(felt),
            missing: Arc::default(),
            about: Arc::new(about),
            folder: None,
            file: None,
        }
    }

    /// The exploration of a path file.
    pub(crate) fn from_path(file: PathBuf, path: ExplorationPath) -> Self {
        let about = About {
            name: name_of(&file),
            ..About::default()
        };
        Self {
            path: Arc::new(path),
            apply_ticks: ApplyTicks::default(),
            felt: Arc::default(),
            missing: Arc::default(),
            about: Arc::new(about),
            folder: None,
            file: Some(file),
        }
    }

    /// The exploration to replay.
    pub(crate) fn path(&self) -> &Arc<ExplorationPath> {
        &self.path
    }

    /// At which of its ticks an armed device played each row; none at all when all of it was only
    /// shown.
    pub(crate) fn apply_ticks(&self) -> &ApplyTicks {
        &self.apply_ticks
    }

    /// Amplitudes [A40, A320] of every contactor at a tick as they were, µm; `None` when unknown.
    pub(crate) fn amplitudes_um(&self, tick: u64) -> Option<&[[f32; 2]]> {
        let n_contactors = self.felt.n_contactors;
        let start = usize::try_from(tick).ok()?.checked_mul(n_contactors)?;
        let at = start..start + n_contactors;
        self.felt.amplitudes_um.get(at).filter(|um| !um.is_empty())
    }

    /// The same of the contactors of a display of the scene; those of the first as far as known.
    pub(crate) fn display_um(
        &self,
        tick: u64,
        (scene, display): (&Scene, usize),
    ) -> Option<&[[f32; 2]]> {
        let all = self.amplitudes_um(tick)?;
        let of = scene.contactors_of(display);
        all.get(of.start..of.end.min(all.len()))
    }

    /// Whether amplitudes of a display of the scene are known.
    pub(crate) fn has_display(&self, scene: &Scene, display: usize) -> bool {
        let of = scene.contactors_of(display);
        of.start < of.end.min(self.n_contactors())
    }

    /// Contactors that amplitudes are known of; 0 when none are.
    pub(crate) fn n_contactors(&self) -> usize {
        self.felt.n_contactors
    }

    /// Ticks before which others of the engine are missing: the display was held, or no tick came.
    pub(crate) fn missing(&self) -> &[u64] {
        &self.missing
    }

    /// What people call it.
    pub(crate) fn name(&self) -> &str {
        &self.about.name
    }

    /// What it is: when it began, in which scene, with which tuning.
    pub(crate) fn about(&self) -> &About {
        &self.about
    }

    /// Puts a marker in; one that stands at its tick gives way.
    pub(crate) fn mark(&mut self, marker: Marker) {
        let markers = &mut Arc::make_mut(&mut self.about).markers;
        markers.retain(|known| known.tick != marker.tick);
        markers.push(marker);
        markers.sort_by_key(|marker| marker.tick);
        self.write_markers();
    }

    /// Takes the marker at a tick away.
    pub(crate) fn unmark(&mut self, tick: u64) {
        let markers = &mut Arc::make_mut(&mut self.about).markers;
        markers.retain(|known| known.tick != tick);
        self.write_markers();
    }

    /// Keeps the markers on the recording's page, if it has one.
    fn write_markers(&self) {
        let Some(folder) = &self.folder else { return };
        if let Ok(mut page) = About::read(folder) {
            page.markers.clone_from(&self.about.markers);
            // What cannot be written now is with the next marker.
            drop(page.write(folder));
        }
    }

    /// The same under another name.
    pub(crate) fn renamed(mut self, name: &str) -> Self {
        name.clone_into(&mut Arc::make_mut(&mut self.about).name);
        self
    }

    /// The path file that it was opened from.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }
}

/// The places in a series of engine ticks before which some are missing.
pub(crate) fn missing_before(engine_ticks: impl Iterator<Item = u64>) -> Arc<[u64]> {
    let mut before = None;
    let is_gap = |(nth, tick): (u64, u64)| {
        let before: Option<u64> = before.replace(tick);
        before
            .is_some_and(|before| tick > before + 1)
            .then_some(nth)
    };
    (0..).zip(engine_ticks).filter_map(is_gap).collect()
}

/// A file's name without its folder and ending.
pub(crate) fn name_of(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or(file.as_os_str());
    stem.to_string_lossy().into_owned()
}
