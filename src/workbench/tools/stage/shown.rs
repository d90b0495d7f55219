//! What a frame of the stage is drawn from, and its few words.

use crate::bench::selection::Selection;
use crate::bench::settings::preferences::Loudness;
use crate::bench::stage::StageOptions;
use crate::bench::trail::Trail;
use crate::bench::view::{Cloth, EngineView, SceneView};
use crate::kit::fingers::FingerRings;
use crate::tools::stage::game::Answered;
use crate::tools::stage::machine::{Machine, Phase};
use selvedge_experiment::visits::Tally;

/// The first words stand for so long, s.
const FIRST_WORDS_S: f64 = 4.0;
/// "Most people" are at least so many.
const PEOPLE: u64 = 20;

/// What a frame is drawn from.
pub(crate) struct Shown<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) scene: &'a SceneView,
    pub(crate) live: &'a EngineView,
    pub(crate) trail: &'a Trail,
    pub(crate) selection: &'a Selection,
    pub(crate) tally: Tally,
    /// Whether nothing can be heard, and whether the array can not be felt though it should.
    pub(crate) is_deaf: bool,
    pub(crate) is_resting: bool,
    /// What was used last: a finger hides what is under it.
    pub(crate) input: &'static str,
    /// Whether anybody can type.
    pub(crate) has_keyboard: bool,
    /// Rings at fingers that hold no display.
    pub(crate) rings: &'a FingerRings,
    pub(crate) options: &'a StageOptions,
}

/// The sign of how loud it is, and how it is read out.
pub(crate) fn sound_signs(shown: &Shown<'_>) -> (&'static str, &'static str) {
    match shown.machine.choices().loudness {
        _ if shown.is_deaf => ("🔇", "Sound: there is none here"),
        None => ("🔇", "Sound: off"),
        Some(Loudness::Quiet) => ("🔈", "Sound: quiet"),
        Some(Loudness::Middle) => ("🔉", "Sound: middle"),
        Some(Loudness::Loud) => ("🔊", "Sound: loud"),
    }
}

/// The one sentence.
pub(crate) fn sentence(shown: &Shown<'_>) -> String {
    let machine = shown.machine;
    if machine.leaving_share().is_some() {
        return "Still here?".to_owned();
    }
    match machine.phase() {
        Phase::Watching => "Stroke the cloth.".to_owned(),
        Phase::Touching => touching_words(shown).to_owned(),
        Phase::Guessing(game) if game.is_over() => {
            let right = format!("{} of 3.", game.n_right());
            if shown.tally.n_guessed < PEOPLE {
                return right;
            }
            format!("{right} Most people: {:.1}", shown.tally.mean_right())
        }
        Phase::Guessing(game) => match game.answered(machine.now_s()) {
            Answered::Told { chosen, truth } => {
                let name = |cloth: usize| shown.scene.cloths.get(cloth).map_or("", short_name);
                if chosen == truth {
                    format!("{}. Yes.", name(truth))
                } else {
                    format!("No, {}.", name(truth).to_lowercase())
                }
            }
            _ => "Stroke, then tap its twin.".to_owned(),
        },
    }
}

fn touching_words(shown: &Shown<'_>) -> &'static str {
    let machine = shown.machine;
    if shown.is_resting {
        "Resting. Listen instead."
    } else if machine.chose_sound() {
        match machine.choices().loudness {
            _ if shown.is_deaf => "No sound here.",
            None => "Sound is off.",
            Some(_) => "40 Hz, heard by overtones.",
        }
    } else if machine.visit_s() < FIRST_WORDS_S {
        "Stroke the cloth."
    } else if machine.n_stroked() >= 2 {
        "Which feels rougher?"
    } else {
        "Faster? Slower?"
    }
}

/// The first word of a textile's name: what it is made of.
fn short_name(cloth: &Cloth) -> &str {
    cloth.name.split_whitespace().next().unwrap_or_default()
}
