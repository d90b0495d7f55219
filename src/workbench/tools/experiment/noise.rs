//! The masking noise that a design may ask for: a file to be played by any player.

use std::path::Path;

use crate::bench::Bench;
use crate::bench::background::{Task, finished};
use crate::tools::experiment::form::NOISE_FILE;
use crate::tools::experiment::state::Experiment;
use selvedge_experiment::MaskingNoise;
use selvedge_foundation::progress::Progress;

/// How it stands with the noise.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NoiseView {
    /// There is none yet.
    Missing,
    /// It is being written; the share done, 0…1.
    Writing(f32),
    /// It lies here.
    At(String),
}

impl NoiseView {
    /// How it stands: what is being written, and the file if it lies there.
    pub(crate) fn of(writing: Option<&Task<()>>, folder: &Path, is_there: bool) -> Self {
        match writing {
            Some(task) => Self::Writing(task.share()),
            None if is_there => Self::At(folder.join(NOISE_FILE).display().to_string()),
            None => Self::Missing,
        }
    }
}

impl Experiment {
    /// How it stands with a masking noise, where the design asks for one.
    pub(crate) fn noise(&self) -> Option<NoiseView> {
        let form = &self.form;
        let is_asked = match &self.session {
            Some(session) => session.design.course.masking_noise,
            None => (form.study.design()).is_ok_and(|design| design.course.masking_noise),
        };
        let view = || NoiseView::of(self.noise.as_ref(), &form.folder(), form.has_noise);
        is_asked.then(view)
    }

    /// Begins to write the noise into the folder of sessions.
    pub(crate) fn write_noise(&mut self, bench: &Bench) {
        if self.form.kept_folder().is_none() || self.noise.is_some() {
            return;
        }
        let folder = self.form.folder();
        let work = move |progress: &mut Progress<'_>| write_noise(&folder, progress);
        self.noise = Some(bench.executor.start("selvedge-noise", work));
    }

    /// Takes what came of it.
    pub(crate) fn poll_noise(&mut self, bench: &mut Bench) {
        match finished(&mut self.noise) {
            Some(Ok(())) => self.form.has_noise = true,
            Some(Err(line)) => bench.notices.give(line),
            None => {}
        }
    }
}

/// Writes the noise into a folder, which is made where it is missing.
fn write_noise(folder: &Path, progress: &mut Progress<'_>) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| {
        let folder = folder.display();
        format!("cannot make the folder {folder}: {error}; choose another")
    })?;
    let noise = MaskingNoise::default();
    let written = noise.write(&folder.join(NOISE_FILE), progress);
    written.map_err(|error| error.to_string())
}
