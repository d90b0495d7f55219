//! A source that is a model: its cloth, and the probe that is drawn over it.

use std::path::Path;

use super::cloth::{Cloth, portrait, profiles, relief_map};
use super::manifest::Source;
use super::{TextileError, profile_file};
use crate::files::Rgb8Image;
use crate::numerics::Random;
use crate::surface::{Direction, HeightMap, Probe, ProfileSet, SurfaceError};

/// Distance of a model's samples, mm.
const STEP_MM: f64 = 1.0 / 230.0;

/// Distance of the points of a model's relief, about, mm: finer than the wire can follow.
const RELIEF_STEP_MM: f64 = 0.02;

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
        let (cloth, seed, noise_um) = match source {
            Source::Profiles(_) => return None,
            Source::Weave(weave) => (weave.cloth(), weave.seed, weave.noise_um),
            Source::Knit(knit) => (knit.cloth(), knit.seed, knit.noise_um),
        };
        let probe = Probe {
            noise_um,
            ..Probe::default()
        };
        let random = Random::new(u64::from(seed)).branch("probe");
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

    /// The relief of the whole cloth, which repeats: heights of the model itself, without a probe.
    fn height_map(&self) -> Result<HeightMap, SurfaceError> {
        relief_map(&self.cloth, RELIEF_STEP_MM)
    }

    /// The picture.
    pub(crate) fn picture(&self) -> Rgb8Image {
        portrait(&self.cloth)
    }
}

impl Source {
    /// The heights over an area that the source knows; `None` if it knows profiles only. A model's
    /// relief takes a second or so.
    pub fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        Model::of(self).map(|model| model.height_map())
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
