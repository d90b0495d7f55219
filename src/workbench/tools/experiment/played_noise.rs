//! The masking noise as it is played, and what a trial heard of it.

use crate::bench::background::Task;
use selvedge_engine::{SoundOutput, SoundState};
use selvedge_experiment::{MaskingNoise, NoiseSound};
use selvedge_foundation::quantity;

/// The levels that it may have, rms, dB re full scale: up to that of the file.
pub(crate) const NOISE_DB: [f64; 2] = [-60.0, MaskingNoise::LEVEL_DB];
/// At first: earphones may be loud.
const FIRST_DB: f64 = -40.0;

/// The noise as it is played.
#[derive(Debug)]
pub(crate) struct PlayedNoise {
    pub(crate) making: Option<Task<NoiseSound>>,
    pub(crate) output: Option<SoundOutput>,
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
    pub(crate) fn heard_db(&self) -> Option<f64> {
        let is_playing = matches!(self.state(), Some(SoundState::Playing { .. }));
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
