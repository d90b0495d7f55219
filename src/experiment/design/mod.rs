//! A study as its file states it: what is felt, what is asked, in which course.
//!
//! One design is one experiment; the papers' sessions are designs. A design never changes what
//! another purpose draws: all chance comes from [`Design::seed`], the subject and the purpose.

mod adaptation;
mod adapting;
mod check;
mod check_adaptation;
mod check_composition;
mod check_presentation;
mod composing;
mod composition;
mod file;
mod kind;
mod needs;
mod old;
mod parameter;
mod vocabulary;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub(crate) use adaptation::Needs;
pub(crate) use adaptation::QuestPlusTrack;
pub(crate) use adaptation::StaircaseTrack;
pub(crate) use adaptation::Track;
pub use adaptation::{Adaptation, Seeks, Stopping};
pub(crate) use composition::Sequence;
pub use composition::{
    Composition, Confidence, Form, Order, Presentation, Question, Response, Right, Sets, Shown,
    Standard,
};
pub use kind::Kind;
pub(crate) use parameter::Tunable;
pub use parameter::{Scale, TunedParameter};

use crate::named::named;
use selvedge_textile::tactile::{Band, Tuning};
use selvedge_textile::{BuildCache, Library, TextileError};

macro_rules! shipped {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../assets/designs/", $name, ".toml")),
        )
    };
}

/// The designs that are part of the program: the papers' sessions and the usual measurements.
const SHIPPED: [(&str, &str); 16] = [
    shipped!("ranking-real-target"),
    shipped!("ranking-virtual-target"),
    shipped!("odd-one-out"),
    shipped!("odd-one-out-optical"),
    shipped!("odd-one-out-pen"),
    shipped!("adjustment-two-gains"),
    shipped!("gain-matching"),
    shipped!("real-or-generated"),
    shipped!("threshold-40"),
    shipped!("threshold-320"),
    shipped!("jnd-40"),
    shipped!("jnd-320"),
    shipped!("magnitude"),
    shipped!("rating"),
    shipped!("force-or-vibration"),
    shipped!("rating-hanging"),
];

/// A study.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The study's id: letters, digits, `-` and `_`; files are named by it.
    pub study: String,
    /// Which experiment of the study this is; as the study's id.
    pub experiment: String,
    /// What people call it.
    pub title: String,
    /// What the finger lies on.
    pub medium: Medium,
    /// What all chance begins with.
    pub seed: u64,
    /// The library of the textiles, relative to the design's file; `None` is the shipped one.
    pub library: Option<PathBuf>,
    /// What is felt, in order; trials number them from 0.
    pub stimuli: Vec<Stimulus>,
    /// What is asked.
    pub composition: Composition,
    /// What surrounds the trials.
    pub course: CourseSettings,
    /// What was settled before the first subject came.
    pub rules: Rules,
    /// Gains and compression; `None` is the library's default tuning.
    pub tuning: Option<Tuning>,
    /// SHA-256 of the file's text, which says whether a log belongs to it.
    pub hash: String,
    /// The file's text, which every log carries.
    pub text: String,
}

impl Design {
    /// The names of the designs that are part of the program.
    pub fn shipped_names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// The text of a design of the program.
    pub fn shipped_text(name: &str) -> Option<&'static str> {
        let mut shipped = SHIPPED.iter();
        shipped
            .find(|(known, _)| *known == name)
            .map(|(_, text)| *text)
    }

    /// The design of the program with this name.
    pub fn shipped(name: &str) -> Option<Self> {
        let text = Self::shipped_text(name)?;
        Self::from_toml(text, Path::new(name)).ok()
    }

    /// Whether what is felt is played, on all contactors, wherever the finger is.
    pub fn plays_vibrations(&self) -> bool {
        let adaptation = self.composition.adaptation.as_ref();
        let is_played = |one: &Stimulus| matches!(one.source, Source::Vibration { .. });
        adaptation.is_some_and(Adaptation::is_vibration) || self.stimuli.iter().any(is_played)
    }

    /// The ids of its textiles, each once, in order.
    pub fn textile_ids(&self) -> Vec<String> {
        let id = |one: &Stimulus| match &one.source {
            Source::Textile { id, .. } => Some(id.clone()),
            Source::RealCloth(_) | Source::Vibration { .. } => None,
        };
        let mut ids: Vec<String> = self.stimuli.iter().filter_map(id).collect();
        ids.sort();
        ids.dedup();
        ids
    }

    /// Opens the design's library: the one that it names, seen from the folder that the design's
    /// file lies in, or the shipped one. What is built from recipes is kept in `cache`.
    ///
    /// # Errors
    /// There is no such library, or it cannot be read.
    pub fn open_library(
        &self,
        folder: &Path,
        cache: Option<&BuildCache>,
    ) -> Result<Library, TextileError> {
        let place = self
            .library
            .as_ref()
            .map(|name| Library::place(name, folder));
        Library::named_or_shipped(place.as_deref(), cache)
    }
}

named! { "medium",
    /// What the finger lies on.
    pub enum Medium {
        /// A tactile array, real or emulated.
        Array = "array",
        /// Cloth on the table.
        RealCloth = "real-cloth",
    }
}

/// Something that is felt.
#[derive(Debug, Clone, PartialEq)]
pub struct Stimulus {
    /// Its name in logs and analyses; no two share one.
    pub id: String,
    /// Which material it is or stands for; several stimuli may stand for one.
    pub material: String,
    /// Where it comes from, as the study calls it: `measured`, `picture`, …
    pub condition: String,
    /// What analyses keep it apart by, as the study calls it: `seen`, `unseen`, …; empty for none.
    pub group: String,
    /// What presents it.
    pub source: Source,
}

impl Stimulus {
    /// Whether it belongs to a group; all belong to none.
    pub(crate) fn is_of(&self, group: Option<&str>) -> bool {
        group.is_none_or(|group| self.group == group)
    }

    /// The cloth on the table that it is, or that it stands for.
    pub(crate) fn cloth(&self) -> &str {
        match &self.source {
            Source::RealCloth(cloth) => cloth,
            _ => &self.material,
        }
    }
}

/// What presents a stimulus.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// A textile of the library on the array.
    Textile {
        /// Its id in the library.
        id: String,
        /// What of it is another than in the library.
        variant: Variant,
    },
    /// A cloth on the table that goes by this name.
    RealCloth(String),
    /// A steady vibration of every contactor.
    Vibration {
        /// Its band.
        band: Band,
        /// Its level, dB re 1 µm.
        level_db: f64,
    },
}

/// How a textile that is felt differs from the library's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Variant {
    /// Gain on top of the textile's own, dB.
    pub gain_db: f64,
    /// On top of that at 40 Hz, dB.
    pub gain_40_db: f64,
    /// The same at 320 Hz.
    pub gain_320_db: f64,
    /// How it is turned, degrees counter-clockwise.
    pub rotation_deg: f64,
    /// All that a stylus feels of it is given as force: nothing vibrates.
    pub is_force_alone: bool,
}

impl Variant {
    /// With so much more of a parameter; as it is where the parameter is none of these.
    pub(crate) fn with(mut self, parameter: Tunable, value: f64) -> Self {
        match parameter {
            Tunable::Gain => self.gain_db += value,
            Tunable::Gain40 => self.gain_40_db += value,
            Tunable::Gain320 => self.gain_320_db += value,
            Tunable::Rotation => self.rotation_deg += value,
            Tunable::Level | Tunable::Compression | Tunable::Duration => {}
        }
        self
    }

    /// Its keys, values and units, in the order of files.
    pub(crate) fn numbers(&self) -> [(&'static str, f64, &'static str); 4] {
        [
            ("gain_db", self.gain_db, "dB"),
            ("gain_40_db", self.gain_40_db, "dB"),
            ("gain_320_db", self.gain_320_db, "dB"),
            ("rotation_deg", self.rotation_deg, "°"),
        ]
    }

    /// What it adds to both bands, dB.
    pub(crate) fn gains_db(&self) -> [f64; 2] {
        [self.gain_40_db, self.gain_320_db].map(|own_db| self.gain_db + own_db)
    }
}

/// What surrounds the trials.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CourseSettings {
    /// What the participant reads first.
    pub instructions: String,
    /// Trials of practice, which do not count.
    pub practice_trials: usize,
    /// A break after every so many blocks; 0 for none.
    pub(crate) break_after_blocks: usize,
    /// The least length of a break, s.
    pub(crate) break_s: f64,
    /// Whether a noise covers what the device can be heard by.
    pub masking_noise: bool,
    /// Movements that are practised first.
    pub familiarisation: Vec<Familiarisation>,
}

impl CourseSettings {
    /// Whether there are breaks, where there are blocks enough.
    pub fn has_breaks(&self) -> bool {
        self.break_after_blocks > 0
    }

    /// The least length of a break, s.
    pub fn break_s(&self) -> f64 {
        self.break_s
    }
}

/// A movement to practise.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Familiarisation {
    /// Along which course.
    pub movement: Movement,
    /// For how long, s.
    pub for_s: f64,
    /// How fast the guide moves, mm/s.
    #[serde(default = "speed")]
    pub speed_mm_per_s: f64,
}

named! { "movement",
    /// A guided movement.
    pub enum Movement {
        /// On a circle.
        Circular = "circular",
        /// To and fro on a line.
        Linear = "linear",
    }
}

/// What was settled before the first subject came, and is copied into every report.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rules {
    /// How many subjects are planned; 0 where it was left open. A plan says so by itself.
    #[serde(skip_serializing)]
    pub subjects: usize,
    /// A session with fewer complete trials is left out.
    pub(crate) least_trials: usize,
    /// A trial answered faster is left out, s.
    pub(crate) least_response_s: f64,
    /// A subject whose share of right answers is below this is left out, 0 to 1.
    pub(crate) least_share_correct: f64,
    /// A subject whose share of catch trials answered rightly is below this is left out, 0 to 1.
    pub(crate) least_share_caught: f64,
}

impl Rules {
    /// What is left out, a clause each.
    pub fn exclusions(&self) -> Vec<String> {
        let percent = |share: f64| format!("{} %", 100.0 * share);
        let all = [
            (
                self.least_trials > 0,
                format!("a session with fewer than {} trials", self.least_trials),
            ),
            (
                self.least_response_s > 0.0,
                format!("a trial answered in less than {} s", self.least_response_s),
            ),
            (
                self.least_share_correct > 0.0,
                format!(
                    "a subject with less than {} right",
                    percent(self.least_share_correct)
                ),
            ),
            (
                self.least_share_caught > 0.0,
                format!(
                    "a subject with less than {} of the catch trials right",
                    percent(self.least_share_caught)
                ),
            ),
        ];
        let is_set = |(is_set, text): (bool, String)| is_set.then_some(text);
        all.into_iter().filter_map(is_set).collect()
    }
}

fn speed() -> f64 {
    100.0
}

/// Who takes part, as schedules need to know it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Subject {
    /// The pseudonym: letters, digits, `-` and `_`.
    pub pseudonym: String,
    /// Which subject of the study this is, from 0: what is balanced over subjects goes by it.
    pub nth: usize,
    /// Which session of this subject, from 1.
    pub session: u32,
}

impl Design {
    /// Whether a text may name a study, an experiment or a subject in names of files.
    pub fn is_name(text: &str) -> bool {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        !text.is_empty() && text.len() <= 64 && text.chars().all(is_plain)
    }
}

#[cfg(test)]
mod tests;
