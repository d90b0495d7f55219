//! What becomes of a recipe: its surface, what is felt of it, and its figures.

use std::sync::{Arc, OnceLock};

use crate::bench::latest::Computed;
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_foundation::quantity;
use selvedge_render::array::{PointSpread, TextileResponse};
use selvedge_textile::surface::{Direction, HeightMap, Surface};
use selvedge_textile::tactile::{Band, Filters, Levels};
use selvedge_textile::{Manifest, RecipePreview, Textile};

/// Least and largest speed of the curves, mm/s.
pub(crate) const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 1000.0];
/// Speeds of a curve, evenly apart on a logarithmic axis.
const N_SPEEDS: u8 = 49;

/// The speeds of a curve, rising, mm/s.
pub(crate) fn speeds_mm_per_s() -> impl Iterator<Item = f64> {
    let [least, most] = SPEEDS_MM_PER_S;
    let share = |i: u8| f64::from(i) / f64::from(N_SPEEDS - 1);
    (0..N_SPEEDS).map(move |i| least * (most / least).powf(share(i)))
}

/// A surface and what is felt of it, without gains.
#[derive(Debug, Clone)]
pub(crate) struct Felt {
    /// Profiles and local spectra.
    pub surface: Arc<Surface>,
    /// How strong it is as a whole.
    pub levels: Levels,
    /// Amplitudes over [`speeds_mm_per_s`], by [`Direction::index`].
    pub(crate) over_speed: [Vec<PointSpread>; 4],
    /// Its figures, in the order in which they are shown, once somebody looks.
    figures: OnceLock<Vec<Shown>>,
}

impl Felt {
    /// What is felt of a surface.
    ///
    /// # Errors
    /// The work was stopped.
    pub(crate) fn of(
        surface: &Arc<Surface>,
        filters: &Filters,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let response = TextileResponse::of_surface(surface, filters);
        let mut over_speed: [Vec<PointSpread>; 4] = Default::default();
        for direction in Direction::ALL {
            progress.step(0.95, "amplitudes")?;
            let along = |speed| response.at(velocity(direction, speed), None);
            over_speed[direction.index()] = speeds_mm_per_s().map(along).collect();
        }
        Ok(Self {
            surface: Arc::clone(surface),
            levels: Levels::of(surface, filters),
            over_speed,
            figures: OnceLock::new(),
        })
    }

    /// The profile of a direction, or of the direction that it is taken from.
    pub(crate) fn profile(
        &self,
        direction: Direction,
    ) -> Option<&selvedge_textile::surface::Profile> {
        let taken_from = self.surface.taken_from(direction);
        let own = self.surface.profile(direction);
        own.or_else(|| self.surface.profile(taken_from))
    }

    /// Its figures, in the order in which they are shown.
    pub(crate) fn figures(&self) -> &[Shown] {
        self.figures.get_or_init(|| self.worked_out())
    }

    fn worked_out(&self) -> Vec<Shown> {
        let surface = &self.surface;
        let mean = |of: &dyn Fn(&selvedge_textile::surface::Profile) -> f64| {
            let profiles = Direction::ALL.map(|direction| surface.profile(direction));
            let found: Vec<f64> = profiles.into_iter().flatten().map(of).collect();
            found.iter().sum::<f64>() / found.len().max(1) as f64
        };
        let rq = |profile: &selvedge_textile::surface::Profile| {
            let heights = profile.heights_um();
            let mean = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
            let squares: f64 = heights.iter().map(|z| (z - mean).powi(2)).sum();
            (squares / heights.len().max(1) as f64).sqrt()
        };
        let band = |band: Band| {
            let level = quantity::level_db(self.levels.mean_um[band.index()]);
            Shown::of(["A40", "A320"][band.index()], level, 1, "dB")
                .said("Mean amplitude at 100 mm/s, over all points and directions, re 1 µm")
        };
        let [low, high] = Band::ALL.map(band);
        let level = self.levels.level_db().unwrap_or(f64::NEG_INFINITY);
        let cv = self.levels.cv.map(|cv| 100.0 * cv);
        let anisotropy = self.levels.anisotropy_db;
        vec![
            Shown::of(
                "SMD",
                mean(&selvedge_textile::surface::Profile::smd_um),
                2,
                "µm",
            )
            .said("Mean absolute deviation of the heights, mean of the strokes"),
            Shown::of(
                "SMD ≤ 1 mm",
                mean(&selvedge_textile::surface::Profile::smd_official_um),
                2,
                "µm",
            )
            .said("The same without waves longer than 1 mm, as the tester reads it"),
            Shown::of("Rq", mean(&rq), 2, "µm").said("Root mean square of the heights"),
            Shown::of("Level", level, 1, "dB").said("Mean of both bands at 100 mm/s, re 1 µm"),
            low,
            high,
            Shown::of("cv 40 Hz", cv[0], 0, "%").said("How much A40 varies from place to place"),
            Shown::of("cv 320 Hz", cv[1], 0, "%").said("How much A320 varies from place to place"),
            Shown::of("Anisotropy 40 Hz", anisotropy[0], 1, "dB")
                .said("Largest over smallest mean A40 of the four directions"),
            Shown::of("Anisotropy 320 Hz", anisotropy[1], 1, "dB")
                .said("Largest over smallest mean A320 of the four directions"),
        ]
    }
}

fn velocity(direction: Direction, speed_mm_per_s: f64) -> Velocity {
    match direction {
        Direction::WarpForward => Velocity::new(speed_mm_per_s, 0.0),
        Direction::WarpReverse => Velocity::new(-speed_mm_per_s, 0.0),
        Direction::WeftForward => Velocity::new(0.0, speed_mm_per_s),
        Direction::WeftReverse => Velocity::new(0.0, -speed_mm_per_s),
    }
}

/// A figure as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shown {
    /// What people call it.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Digits after the point.
    pub decimals: usize,
    /// Its unit.
    pub unit: &'static str,
    /// What it says.
    pub what: &'static str,
}

impl Shown {
    fn of(name: &'static str, value: f64, decimals: usize, unit: &'static str) -> Self {
        Self {
            name,
            value,
            decimals,
            unit,
            what: "",
        }
    }

    fn said(self, what: &'static str) -> Self {
        Self { what, ..self }
    }
}

/// A recipe and what becomes of it.
#[derive(Debug, Clone)]
pub(crate) struct Preview {
    /// The recipe.
    pub manifest: Manifest,
    /// What is felt of it.
    pub felt: Felt,
    /// Heights over an area.
    pub relief: HeightMap,
    /// The Hurst exponent that was asked for, the one found, and the error of that.
    pub hurst: Option<[f64; 3]>,
    figures: OnceLock<Vec<Shown>>,
}

impl Preview {
    /// Makes the surface of a recipe and feels it.
    ///
    /// # Errors
    /// What is wrong, in one line; the work was stopped.
    pub(crate) fn of(
        manifest: Manifest,
        filters: &Filters,
        progress: &mut Progress<'_>,
    ) -> Result<Self, String> {
        let trial = RecipePreview::of(&manifest, progress).map_err(|error| error.to_string())?;
        let felt = Felt::of(&trial.surface, filters, progress).map_err(|stop| stop.to_string())?;
        let found = |key| {
            let mut measured = trial.measured.iter();
            measured
                .find(|(known, _)| *known == key)
                .map(|(_, value)| *value)
        };
        let asked = match &manifest.source {
            selvedge_textile::Source::Brownian(keys) => Some(keys.hurst),
            _ => None,
        };
        let hurst = asked.and_then(|asked| Some([asked, found("hurst")?, found("hurst_error")?]));
        Ok(Self {
            manifest,
            felt,
            relief: trial.relief,
            hurst,
            figures: OnceLock::new(),
        })
    }

    /// Its figures, in the order in which they are shown.
    pub(crate) fn figures(&self) -> &[Shown] {
        self.figures.get_or_init(|| self.worked_out())
    }

    fn worked_out(&self) -> Vec<Shown> {
        let mut figures = self.felt.figures().to_vec();
        let relief = [
            Shown::of("Sa", self.relief.sa_um(), 2, "µm").said(
                "Mean absolute deviation of the heights themselves, over the area, without a probe",
            ),
            Shown::of("Sq", self.relief.sq_um(), 2, "µm")
                .said("Root mean square of the heights themselves, over the area, without a probe"),
        ];
        figures.splice(3..3, relief);
        if let Some([_, found, _]) = self.hurst {
            let shown = Shown::of("Hurst exponent", found, 2, "");
            figures.insert(
                0,
                shown.said("Estimated from the strokes; beside it the one asked"),
            );
        }
        figures
    }
}

/// What a preview is wanted of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PreviewAsked {
    /// The recipe.
    pub(crate) manifest: Manifest,
    /// What it is felt through.
    pub(crate) filters: Filters,
}

/// What became of a recipe.
#[derive(Debug, Default)]
pub(crate) struct PreviewFound {
    /// The preview; where there is none, the one before.
    pub(crate) preview: Option<Arc<Preview>>,
    /// Why there is none of this recipe.
    pub(crate) refusal: Option<String>,
}

impl Computed<PreviewAsked> for PreviewFound {
    const THREAD: &str = "selvedge-lab";

    fn compute(
        asked: &PreviewAsked,
        prior: Option<(&PreviewAsked, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let made = Preview::of(asked.manifest.clone(), &asked.filters, progress);
        if made.is_err() {
            // Work that was stopped is no refusal.
            progress.step(1.0, "refused")?;
        }
        let before = || prior.and_then(|(_, found)| found.preview.clone());
        Ok(match made {
            Ok(preview) => Self {
                preview: Some(Arc::new(preview)),
                refusal: None,
            },
            Err(words) => Self {
                preview: before(),
                refusal: Some(words),
            },
        })
    }

    fn broken(_: &PreviewAsked, why: &str) -> Self {
        Self {
            preview: None,
            refusal: Some(why.to_owned()),
        }
    }

    fn serves(_: &PreviewAsked, _: &PreviewAsked) -> bool {
        true
    }
}

/// A textile of the library that the recipe is compared with.
#[derive(Debug, Clone)]
pub(crate) struct Compared {
    /// Its id.
    pub id: String,
    /// What people call it.
    pub name: String,
    /// What is felt of it.
    pub felt: Felt,
}

impl Compared {
    /// A textile, felt through `filters`.
    ///
    /// # Errors
    /// The work was stopped.
    pub(crate) fn of(
        textile: &Textile,
        filters: &Filters,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        Ok(Self {
            id: textile.id().to_owned(),
            name: textile.manifest().name.clone(),
            felt: Felt::of(textile.surface(), filters, progress)?,
        })
    }
}
