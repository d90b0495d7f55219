//! A recipe tried: the surface that the textile would have, without writing anything.

use std::path::Path;
use std::sync::Arc;

use crate::error::TextileError;
use crate::manifest::Manifest;
use crate::recipe::profiles_of_files;
use crate::surface::{HeightMap, Representation, Surface, SurfaceError};
use selvedge_foundation::progress::Progress;

/// Distance of the points of a textile's relief where only a picture is wanted, mm.
const PICTURE_STEP_MM: f64 = 0.05;

/// What becomes of a recipe: the same surface that the built textile has when it is loaded.
#[derive(Debug, Clone)]
pub struct RecipePreview {
    /// Profiles and local spectra, noise floor taken off.
    pub surface: Arc<Surface>,
    /// The heights over an area: a textile's relief, or a patch of a surface that was drawn.
    pub relief: HeightMap,
    /// Figures that the model found on its own surface.
    pub measured: Vec<(&'static str, f64)>,
}

impl RecipePreview {
    /// Makes the surface of a recipe; takes a second or so.
    ///
    /// # Errors
    /// A source that is no recipe; a surface that cannot be felt; the work was stopped.
    pub fn of(recipe: &Manifest, progress: &mut Progress<'_>) -> Result<Self, TextileError> {
        let path = Path::new("the recipe");
        let model = recipe.source.model(path)?;
        let wrong = |source: SurfaceError| TextileError::surface(path)(source);
        let floor = recipe.noise_floor_um2_mm.unwrap_or(0.0);
        progress.step(0.1, "the relief")?;
        let areal = (recipe.source.representation() == Representation::Areal)
            .then(|| model.height_map())
            .flatten();
        let (surface, relief) = if let Some(map) = areal {
            let map = map.map_err(wrong)?;
            progress.step(0.4, "spectra at every point")?;
            let surface = Surface::areal(&map, floor);
            (surface, map)
        } else {
            let relief = model.relief(PICTURE_STEP_MM).map_err(wrong)?;
            progress.step(0.3, "four strokes")?;
            let profiles = profiles_of_files(&model.profile_files()?)?;
            progress.step(0.8, "spectra")?;
            (Surface::from_profiles(profiles, floor), relief)
        };
        let surface = surface.map_err(|(_, source)| wrong(source))?;
        progress.step(0.9, "figures")?;
        Ok(Self {
            surface: Arc::new(surface),
            relief,
            measured: model.measured().to_vec(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::Store;
    use crate::surface::Direction;
    use crate::{Manifest, Textile, build};
    use selvedge_foundation::progress::{CancelFlag, Progress};

    #[test]
    fn a_trial_has_the_surface_of_the_textile_that_is_built_from_its_recipe() {
        for kind in ["weave", "fourier", "restoration"] {
            let recipe = Manifest::example(kind).unwrap();
            let trial = Progress::unheard(|progress| RecipePreview::of(&recipe, progress)).unwrap();
            let files = build(&recipe, Path::new("recipe")).unwrap();
            let store = Store::Built(Arc::new(files), Path::new("here").to_owned());
            let textile = Textile::load(&store, "built").unwrap();
            for direction in Direction::ALL {
                let [a, b] = [&trial.surface, textile.surface()].map(|surface| {
                    let profile = surface.profile(direction).unwrap();
                    (
                        profile.heights_um().to_vec(),
                        surface.spectra(direction).powers_um2(3).to_vec(),
                    )
                });
                assert_eq!(a, b, "{kind} {direction:?}");
            }
            assert!(trial.relief.sq_um() > 0.1, "{kind}");
        }
    }

    #[test]
    fn a_trial_that_is_stopped_ends_and_what_was_measured_is_refused() {
        let recipe = Manifest::example("weave").unwrap();
        let flag = CancelFlag::new();
        flag.cancel();
        let mut heard = |_: f64, _: &str| {};
        let stopped = RecipePreview::of(&recipe, &mut Progress::new(&mut heard, flag));
        assert!(matches!(stopped, Err(TextileError::Cancelled(_))));
        let text = "name = \"a\"\nconstruction = \"other\"\nfibre = \"b\"\n[source]\n\
                    kind = \"profiles\"\nwarp_forward = \"a.csv\"\n";
        let measured = Manifest::from_toml(text, Path::new("a")).unwrap();
        let refused =
            Progress::unheard(|progress| RecipePreview::of(&measured, progress)).unwrap_err();
        assert!(refused.to_string().contains("is not a recipe"), "{refused}");
    }
}
