//! What a recipe becomes: a model that a stylus was drawn over.

use std::path::Path;

use crate::error::TextileError;
use crate::profile_file;
use crate::surface::{Direction, HeightMap, Profile, ProfileSet, SurfaceError};
use selvedge_foundation::files::Rgb8Image;

/// A model of a textile, ready to be felt.
pub(crate) trait Model {
    /// Heights of the four strokes, µm, by [`Direction::index`], in travel order, and the distance
    /// of their samples along warp and weft, mm.
    fn strokes_um(&self) -> ([Vec<f64>; 4], [f64; 2]);

    /// The four strokes as profile files, by [`Direction::index`].
    fn profile_files(&self) -> Result<[String; 4], TextileError> {
        let (strokes_um, step_mm) = self.strokes_um();
        let mut texts: [String; 4] = Default::default();
        for (direction, heights) in Direction::ALL.into_iter().zip(&strokes_um) {
            let step_mm = step_mm[usize::from(direction.is_weft())];
            texts[direction.index()] =
                profile_file::write(heights, step_mm, Path::new(direction.key()))?;
        }
        Ok(texts)
    }

    /// The relief of the whole textile: heights of the model itself, without a probe; `None` where
    /// the model knows its strokes alone.
    fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        None
    }

    /// Heights over an area to look at, with points about so far apart where there is a choice.
    fn relief(&self, step_mm: f64) -> Result<HeightMap, SurfaceError>;

    /// The picture, and pixels a mm.
    fn picture(&self) -> (Rgb8Image, f64);

    /// Figures that the model found on its own surface, beside the roughness.
    fn measured(&self) -> &[(&'static str, f64)] {
        &[]
    }
}

/// The profiles of four profile files, by [`Direction::index`].
pub(crate) fn profiles_of_files(texts: &[String; 4]) -> Result<ProfileSet, TextileError> {
    let mut profiles = ProfileSet::default();
    for (direction, text) in Direction::ALL.into_iter().zip(texts) {
        let profile = Profile::read(text, Path::new(direction.key()))?;
        profiles[direction.index()] = Some(profile);
    }
    Ok(profiles)
}
