//! The masking noise that a design may ask for: played by the program, or a file for any player.
//!
//! What is played goes on while trials run and between them; a row's note says what was heard of
//! its trial.

use std::path::Path;

use crate::bench::Bench;
use crate::bench::FRAME;
use crate::bench::background::{Task, finished};
use crate::tools::experiment::form::NOISE_FILE;
use crate::tools::experiment::state::Experiment;
use selvedge_engine::{SoundOutput, SoundState};
use selvedge_experiment::{MaskingNoise, NoiseSound};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity;
use selvedge_render::single;

/// The levels that it may have, rms, dB re full scale: up to that of the file.
pub(crate) const NOISE_DB: [f64; 2] = [-60.0, MaskingNoise::LEVEL_DB];
/// At first: earphones may be loud.
const FIRST_DB: f64 = -40.0;

/// The noise as it is played.
#[derive(Debug)]
pub(crate) struct PlayedNoise {
    making: Option<Task<NoiseSound>>,
    output: Option<SoundOutput>,
    /// Rms, dB re full scale.
    pub(crate) level_db: f64,
}

impl Default for PlayedNoise {
    fn default() -> Self {
        Self {
            making: None,
            output: None,
            level_db: FIRST_DB,
        }
    }
}

impl PlayedNoise {
    /// Whether it was begun.
    pub(crate) fn is_begun(&self) -> bool {
        self.making.is_some() || self.output.is_some()
    }

    /// Ends it.
    pub(crate) fn stop(&mut self) {
        (self.making, self.output) = (None, None);
    }

    /// How it stands, once it was begun.
    pub(crate) fn state(&self) -> Option<SoundState> {
        match &self.output {
            Some(output) => Some(output.state()),
            None => self.making.as_ref().map(|_| SoundState::Opening),
        }
    }

    /// The level that is heard now, in whole dB; `None` where nothing is.
    fn heard_db(&self) -> Option<f64> {
        let is_playing = matches!(self.state(), Some(SoundState::Playing(_)));
        is_playing.then_some(self.level_db.round())
    }
}

/// What was heard of the noise since a trial began: one level after the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct HeardNoise(Vec<Option<f64>>);

impl HeardNoise {
    /// A trial begins: what was heard before is no affair of it.
    pub(crate) fn begin(&mut self) {
        self.0.drain(..self.0.len().saturating_sub(1));
    }

    /// Hears what there is now.
    pub(crate) fn hear(&mut self, level_db: Option<f64>) {
        if self.0.last() != Some(&level_db) {
            self.0.push(level_db);
        }
    }

    /// What the note of a row says of it, after what the experimenter wrote.
    pub(crate) fn noted(&self, note: &str) -> String {
        let words = |level_db: &Option<f64>| match level_db {
            Some(db) => quantity::with_unit(*db, 0, "dB re full scale"),
            None => "off".to_owned(),
        };
        let heard: Vec<String> = self.0.iter().map(words).collect();
        let heard = heard.join(", then ");
        match (note.trim(), heard.as_str()) {
            (note, "") => note.to_owned(),
            ("", heard) => format!("masking noise {heard}"),
            (note, heard) => format!("{note}; masking noise {heard}"),
        }
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_says_what_was_heard_of_a_trial_after_what_the_experimenter_wrote() {
        let mut heard = HeardNoise::default();
        assert_eq!(
            heard.noted(" a cough "),
            "a cough",
            "no design asked for it"
        );
        heard.hear(None);
        heard.hear(None);
        assert_eq!(heard.noted(""), "masking noise off");
        heard.hear(Some(-40.0));
        heard.hear(Some(-38.0));
        let words = "a cough; masking noise off, then −40 dB re full scale, then −38 dB re full \
                     scale";
        assert_eq!(heard.noted("a cough"), words);
        heard.begin();
        assert_eq!(heard.noted(""), "masking noise −38 dB re full scale");
    }
}
