//! The masking noise that a design may ask for: played by the program, or a file for any player.
//!
//! What is played goes on while trials run and between them; a row's note says what was heard of
//! its trial.

use std::path::Path;

use crate::bench::background::{Task, finished};
use crate::bench::{Bench, FRAME};
use crate::tools::experiment::form::NOISE_FILE;
use crate::tools::experiment::state::Experiment;
use selvedge_engine::{SoundOutput, SoundState};
use selvedge_experiment::MaskingNoise;
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity;
use selvedge_render::single;

/// How it stands with the file of the noise.
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
    /// Begins to play the noise.
    pub(crate) fn play_noise(&mut self, bench: &Bench) {
        let make = |_: &mut Progress<'_>| Ok(MaskingNoise::default().sound());
        self.played.making = Some(bench.executor.start("selvedge-noise", make));
    }

    /// Lets the noise follow its level, and the trial that waits know of it; ends it where no
    /// design asks for it.
    fn follow_noise(&mut self, bench: &mut Bench) {
        let is_asked = self.noise().is_some();
        let played = &mut self.played;
        if !is_asked {
            played.stop();
            return;
        }
        match finished(&mut played.making) {
            Some(Ok(sound)) => match SoundOutput::open(Box::new(sound)) {
                Ok(output) => played.output = Some(output),
                Err(error) => bench.notices.give(error.to_string()),
            },
            Some(Err(line)) => bench.notices.give(line),
            None => {}
        }
        if let Some(output) = &played.output {
            let gain_db = played.level_db - MaskingNoise::LEVEL_DB;
            output.set_level(single(quantity::factor_of_gain(gain_db)));
        }
        if played.state() == Some(SoundState::Opening) {
            bench.ctx.request_repaint_after(FRAME);
        }
        if let Some(session) = &mut self.session {
            session.presented.heard.hear(played.heard_db());
        }
    }

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
        self.follow_noise(bench);
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
