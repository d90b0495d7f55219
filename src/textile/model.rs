//! A source that is a model: its cloth, and the probe that is drawn over it.

use std::path::Path;

use super::cloth::{Cloth, Side, portrait, profiles};
use super::manifest::Source;
use super::{TextileError, profile_file, shipped};
use crate::files::{Rgb8Image, sha256_hex};
use crate::numerics::Random;
use crate::surface::{Direction, Probe, ProfileSet};

/// Distance of a model's samples, mm.
const STEP_MM: f64 = 1.0 / 230.0;

/// What the bytes of a built textile follow from besides its recipe: this program. Raise it when a
/// model changes what it makes; most changes show in the shipped library's own hash as well.
const MODEL: &str = "selvedge models 2";

/// Says which models build: other models, other text.
pub(crate) fn version() -> String {
    let program = env!("CARGO_PKG_VERSION");
    let shipped = sha256_hex([shipped::INDEX.as_bytes()]);
    format!("{MODEL}\n{program}\n{shipped}\n")
}

/// A model cloth under the virtual tester.
#[derive(Debug)]
pub(crate) struct Model {
    cloth: Cloth,
    probe: Probe,
    random: Random,
}

impl Model {
    /// The model of a source; `None` if it was measured.
    pub(crate) fn of(source: &Source) -> Option<Self> {
        let (cloth, seed, noise_um, side) = match source {
            Source::Profiles(_) => return None,
            Source::Weave(weave) => (weave.cloth(), weave.seed, weave.noise_um, weave.side),
            Source::Knit(knit) => (knit.cloth(), knit.seed, knit.noise_um, knit.side),
        };
        let probe = Probe {
            noise_um,
            ..Probe::default()
        };
        let random = Random::new(u64::from(seed)).branch(match side {
            Side::Face => "probe",
            Side::Back => "probe on the back",
        });
        Some(Self {
            cloth,
            probe,
            random,
        })
    }

    /// The four strokes as profile files, by [`Direction::index`].
    pub(crate) fn profile_files(&self) -> Result<[String; 4], TextileError> {
        let mut texts: [String; 4] = Default::default();
        let strokes = profiles(&self.cloth, &self.probe, &self.random);
        for (direction, heights) in Direction::ALL.into_iter().zip(&strokes) {
            texts[direction.index()] =
                profile_file::write(heights, STEP_MM, Path::new(direction.key()))?;
        }
        Ok(texts)
    }

    /// The picture.
    pub(crate) fn picture(&self) -> Rgb8Image {
        portrait(&self.cloth)
    }
}

/// The profiles of four profile files, by [`Direction::index`].
pub(crate) fn profiles_of_files(texts: &[String; 4]) -> Result<ProfileSet, TextileError> {
    let mut profiles = ProfileSet::default();
    for (direction, text) in Direction::ALL.into_iter().zip(texts) {
        let profile = profile_file::read(text, Path::new(direction.key()))?;
        profiles[direction.index()] = Some(profile);
    }
    Ok(profiles)
}
