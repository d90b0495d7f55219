//! A source that is a model: a cloth and the probe that is drawn over it, or a surface that was
//! drawn from numbers.

use std::path::Path;

use super::cloth::{Cloth, PX_PER_MM, Side, portrait, profiles, relief_map};
use super::drawn::Drawn;
use super::manifest::Source;
use super::{TextileError, profile_file, shipped};
use crate::surface::{Direction, HeightMap, Probe, ProfileSet, SurfaceError};
use selvedge_foundation::files::{Rgb8Image, sha256_hex};
use selvedge_foundation::numerics::Random;

/// Distance of a cloth's samples, mm.
const STEP_MM: f64 = 1.0 / 230.0;

/// Distance of the points of a model's relief, about, mm: finer than the wire can follow.
const RELIEF_STEP_MM: f64 = 0.02;

/// What the bytes of a built textile follow from besides its recipe: this program. Raise it when a
/// model changes what it makes; most changes show in the shipped library's own hash as well.
const MODEL: &str = "selvedge models 2";

/// Says which models build: other models, other text.
pub(crate) fn version() -> String {
    let program = env!("CARGO_PKG_VERSION");
    let shipped = sha256_hex([shipped::INDEX.as_bytes()]);
    format!("{MODEL}\n{program}\n{shipped}\n")
}

/// A model, ready to be felt.
#[derive(Debug)]
pub(crate) enum Model {
    /// A model cloth under the virtual tester.
    Cloth {
        cloth: Box<Cloth>,
        probe: Probe,
        random: Random,
    },
    /// A surface that was drawn.
    Drawn(Box<Drawn>),
}

impl Model {
    /// The model of a source; `None` if it was measured.
    pub(crate) fn of(source: &Source) -> Result<Option<Self>, TextileError> {
        let (cloth, seed, noise_um, side) = match source {
            Source::Profiles(_) | Source::Heightmap(_) | Source::Picture(_) => return Ok(None),
            Source::Weave(weave) => (weave.cloth(), weave.seed, weave.noise_um, weave.side),
            Source::Knit(knit) => (knit.cloth(), knit.seed, knit.noise_um, knit.side),
            Source::Fourier(keys) => return Ok(Some(Self::drawn(keys.drawn()?))),
            Source::Brownian(keys) => return Ok(Some(Self::drawn(keys.drawn()?))),
            Source::Restoration(keys) => return Ok(Some(Self::drawn(keys.drawn()?))),
        };
        let probe = Probe {
            noise_um,
            ..Probe::default()
        };
        let random = Random::new(u64::from(seed)).branch(match side {
            Side::Face => "probe",
            Side::Back => "probe on the back",
        });
        Ok(Some(Self::Cloth {
            cloth: Box::new(cloth),
            probe,
            random,
        }))
    }

    fn drawn(drawn: Drawn) -> Self {
        Self::Drawn(Box::new(drawn))
    }

    /// The four strokes as profile files, by [`Direction::index`].
    pub(crate) fn profile_files(&self) -> Result<[String; 4], TextileError> {
        let (cloth, probe, random) = match self {
            Self::Drawn(drawn) => return drawn.profile_files(),
            Self::Cloth {
                cloth,
                probe,
                random,
            } => (cloth, probe, random),
        };
        let mut texts: [String; 4] = Default::default();
        let strokes = profiles(cloth, probe, random);
        for (direction, heights) in Direction::ALL.into_iter().zip(&strokes) {
            texts[direction.index()] =
                profile_file::write(heights, STEP_MM, Path::new(direction.key()))?;
        }
        Ok(texts)
    }

    /// The relief of the whole cloth, which repeats: heights of the model itself, without a probe;
    /// `None` of what is no cloth.
    pub(crate) fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        match self {
            Self::Cloth { cloth, .. } => Some(relief_map(cloth, RELIEF_STEP_MM)),
            Self::Drawn(_) => None,
        }
    }

    /// Heights over an area to look at: a cloth's relief with points about so far apart, or the
    /// patch of what was drawn.
    pub(crate) fn relief(&self, step_mm: f64) -> Result<HeightMap, SurfaceError> {
        match self {
            Self::Cloth { cloth, .. } => relief_map(cloth, step_mm),
            Self::Drawn(drawn) => Ok(drawn.patch.clone()),
        }
    }

    /// The picture, and pixels a mm.
    pub(crate) fn picture(&self) -> (Rgb8Image, f64) {
        match self {
            Self::Cloth { cloth, .. } => (portrait(cloth), PX_PER_MM),
            Self::Drawn(drawn) => drawn.picture(),
        }
    }

    /// Figures that the model found on its own surface, beside the roughness.
    pub(crate) fn measured(&self) -> &[(&'static str, f64)] {
        match self {
            Self::Cloth { .. } => &[],
            Self::Drawn(drawn) => &drawn.measured,
        }
    }
}

impl Source {
    /// The heights over an area that the source knows; `None` if it knows profiles only. A model's
    /// relief takes a second or so.
    pub fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        Model::of(self).ok().flatten()?.height_map()
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
