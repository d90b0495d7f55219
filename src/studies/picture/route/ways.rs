//! The routes from a cloth to what is felt of it.

use super::cloths::{Cloth, Photograph, Taking};
use super::felt::Felt;
use crate::ReportError;
use crate::picture::analysed;
use crate::textiles::wrong;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::Rectangle;
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{Light, LightEstimate, Method, ShadingOptions, Shape};
use selvedge_textile::surface::{Direction, HeightMap, Probe, Profile, ProfileSet};
use selvedge_textile::{
    Ensemble, HeightScale, Lamp, PictureTextile, Reduced, ScaledRelief, TextileError, n_threads,
    smd_um,
};

/// Harmonics that a restored profile keeps.
const N_HARMONICS: usize = 8;
/// Where a relief is stroked, shares of its size.
const PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// A route.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// The tester's strokes as they are.
    Kes,
    /// The tester's strokes, reduced and restored.
    Restoration,
    /// The picture, its lattice, its shape by a method, scaled to the tester's SMD.
    Picture(Method),
    /// The shape of the whole picture by the linear method, no lattice and no mean cell.
    Whole,
    /// Of many reliefs of the whole picture the one that is nearest to what all are believed to
    /// feel like.
    Believed,
}

impl Way {
    pub(super) const ALL: [Self; 6] = [
        Self::Kes,
        Self::Restoration,
        Self::Picture(Method::Variational),
        Self::Picture(Method::Linear),
        Self::Whole,
        Self::Believed,
    ];

    pub(super) fn name(self) -> String {
        match self {
            Self::Kes => "KES strokes".to_owned(),
            Self::Restoration => "KES, restored".to_owned(),
            Self::Picture(method) => format!("picture, {}", method.label()),
            Self::Whole => "picture without lattice, linear".to_owned(),
            Self::Believed => "picture as it is, by evidence".to_owned(),
        }
    }

    pub(super) fn is_picture(self) -> bool {
        matches!(self, Self::Picture(_) | Self::Whole | Self::Believed)
    }
}

/// A cloth with everything that routes begin with.
pub(super) struct Subject {
    pub(super) cloth: Cloth,
    pub(super) strokes: ProfileSet,
    pub(super) photograph: Photograph,
    pub(super) truth: Felt,
    lamp: Lamp,
    cell: Result<Rectangle, String>,
    believed: Result<(Ensemble, HeightMap), String>,
}

/// The rectangle that repeats in a photograph, as the mean of all.
fn mean_cell(photograph: &Photograph) -> Result<Rectangle, String> {
    let analysis = analysed(&photograph.luminance).ok_or("cancelled")?;
    let found = analysis.found.map_err(|reason| reason.to_string())?;
    let cell = found.tile.rectangle(1.0, 1);
    cell.ok_or_else(|| "the lattice has no rectangle".to_owned())
}

fn strokes(
    map: &HeightMap,
    probe: &Probe,
    share: f64,
    random: &Random,
) -> Result<ProfileSet, TextileError> {
    let middle_mm = map.size_mm().map(|mm| share * mm);
    let strokes = map.strokes(probe, middle_mm, random);
    strokes.map_err(|(_, source)| wrong("a relief")(source))
}

/// What a wire as wide as a contactor feels of a relief at five places, without friction or noise.
fn felt(map: &HeightMap, name: &str) -> Result<Felt, ReportError> {
    let at = |share: f64| strokes(map, &Probe::contactor(), share, &Random::new(0));
    let sets: Result<Vec<ProfileSet>, TextileError> = PLACES.into_iter().map(at).collect();
    Felt::of(sets?, name)
}

impl Subject {
    /// Strokes over a cloth and photographs it.
    pub(super) fn new(cloth: Cloth, taking: &Taking, seed: u64) -> Result<Self, ReportError> {
        let random = Random::new(seed).branch("tester").branch(&cloth.name);
        let strokes = strokes(&cloth.map, &Probe::default(), 0.5, &random)?;
        let photograph = cloth.photograph(taking, seed);
        let truth = felt(&cloth.map, &cloth.name)?;
        let subject = Self {
            cloth,
            strokes,
            cell: mean_cell(&photograph),
            photograph,
            truth,
            lamp: taking.lamp,
            believed: Err(String::new()),
        };
        Ok(Self {
            believed: subject.believe(),
            ..subject
        })
    }

    /// What is felt by a route, or in words why it ends nowhere.
    pub(super) fn felt_by(&self, way: Way) -> Result<Felt, String> {
        let name = &self.cloth.name;
        let made = match way {
            Way::Kes => Felt::of(vec![self.strokes.clone()], name),
            Way::Restoration => restored(&self.strokes)
                .map_err(ReportError::from)
                .and_then(|profiles| Felt::of(vec![profiles], name)),
            Way::Picture(_) | Way::Whole => felt(&self.relief_of(&self.cell, way)?, name),
            Way::Believed => felt(&self.believed.as_ref().map_err(String::clone)?.1, name),
        };
        made.map_err(|error| error.to_string())
    }

    /// The relief that a picture shows, from the picture on.
    pub(super) fn relief(&self, way: Way) -> Result<HeightMap, String> {
        match way {
            Way::Whole => return self.relief_of(&self.cell, way),
            Way::Believed => return Ok(self.believe()?.1),
            _ => {}
        }
        self.relief_of(&mean_cell(&self.photograph), way)
    }

    /// The relief of a mean cell, or of the whole picture, as high as reads the SMD of the strokes.
    fn relief_of(&self, cell: &Result<Rectangle, String>, way: Way) -> Result<HeightMap, String> {
        let Way::Picture(method) = way else {
            let whole = &self.photograph.luminance;
            let light = self.told(whole)?;
            return self.shaped(whole, light, self.photograph.px_mm, Method::Linear);
        };
        let cell = cell.as_ref().map_err(String::clone)?;
        let mut brightness = cell.values.clone();
        for value in brightness.values_mut() {
            *value = value.clamp(0.0, 1.0);
        }
        // The light turns with the cell; rows are those of heights, so angles count upwards.
        let told = self.told(&self.photograph.luminance)?;
        let light = Light {
            tilt_deg: told.tilt_deg - cell.angle_rad.to_degrees(),
            ..told
        };
        let n = [brightness.width(), brightness.height()].map(|n| n as f64);
        let step_mm = [0, 1].map(|i| cell.size_px[i] / n[i] * self.photograph.px_mm[i]);
        self.shaped(&brightness, light, step_mm, method)
    }

    /// The light as it is told, or as it is estimated.
    fn told(&self, luminance: &Grid<f64>) -> Result<Light, String> {
        match self.lamp {
            Lamp::Known { light, .. } => Ok(light),
            Lamp::Unknown | Lamp::Turned { .. } => {
                let estimate = LightEstimate::of(luminance).map_err(|error| error.to_string())?;
                Ok(estimate.believed().light)
            }
        }
    }

    /// Many reliefs of the whole picture, and the one that is kept.
    fn believe(&self) -> Result<(Ensemble, HeightMap), String> {
        let brightness = Brightness::of_picture(&self.photograph.luminance.turned_over(), 0.0);
        let about = PictureTextile {
            name: self.cloth.name.clone(),
            px_per_mm: 1.0 / self.photograph.px_mm[0],
            scale: HeightScale::SmdUm(smd_um(&self.strokes)),
            ..PictureTextile::default()
        };
        let failed = |error: TextileError| error.to_string();
        Progress::unheard(|progress| {
            let lamp = self.lamp;
            let ensemble = Ensemble::of(&brightness, &about, lamp, n_threads(), progress);
            let ensemble = ensemble.map_err(failed)?;
            let shape = ensemble.shape(&about).map_err(failed)?;
            let map = self.scaled(&shape, self.photograph.px_mm)?;
            Ok((ensemble, map))
        })
    }

    /// Of warp and weft by band, the ends of the band less the truth, dB.
    pub(super) fn band_db(&self) -> Option<[[f64; 2]; 4]> {
        let (ensemble, _) = self.believed.as_ref().ok()?;
        let bands = ensemble.levels([0, 1].map(|axis| self.truth.axis_levels_db[axis]));
        let ends: Vec<[f64; 2]> = bands.iter().map(|&[.., low, high]| [low, high]).collect();
        ends.try_into().ok()
    }

    fn shaped(
        &self,
        brightness: &Grid<f64>,
        light: Light,
        step_mm: [f64; 2],
        method: Method,
    ) -> Result<HeightMap, String> {
        let options = ShadingOptions {
            method,
            ..ShadingOptions::default()
        };
        let shape = Progress::unheard(|progress| {
            Shape::from_shading(brightness, light, &options, progress)
        })
        .map_err(|error| error.to_string())?;
        self.scaled(&shape, step_mm)
    }

    /// A shape as high as reads the SMD of the strokes.
    fn scaled(&self, shape: &Shape, step_mm: [f64; 2]) -> Result<HeightMap, String> {
        let scale = HeightScale::SmdUm(smd_um(&self.strokes));
        let tester =
            |map: &HeightMap, _: f64| strokes(map, &Probe::default(), 0.5, &Random::new(1));
        let scaled = ScaledRelief::of(shape, step_mm, scale, &tester).map_err(|e| e.to_string())?;
        Ok(scaled.map)
    }
}

/// The forward strokes reduced and restored, as long as they were.
fn restored(strokes: &ProfileSet) -> Result<ProfileSet, TextileError> {
    let mut profiles = ProfileSet::default();
    for direction in [Direction::WarpForward, Direction::WeftForward] {
        let Some(profile) = &strokes[direction.index()] else {
            continue;
        };
        let reduced = Reduced::of(profile, N_HARMONICS)?;
        let (n, step_mm) = (profile.heights_um().len(), profile.step_mm());
        let mut random = Random::new(1).branch(direction.key());
        let heights_um = reduced.restored_um(n, step_mm, &mut random);
        let restored = Profile::new(step_mm, heights_um).map_err(wrong("a restored profile"))?;
        profiles[direction.index()] = Some(restored);
    }
    Ok(profiles)
}
