//! The routes from a cloth to what is felt of it.

use super::cloths::{Cloth, LIGHT, Photograph};
use super::felt::Felt;
use crate::ReportError;
use crate::picture::analysed;
use crate::textiles::wrong;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::Rectangle;
use selvedge_textile::picture::shading::{Light, Method, ShadingOptions, Shape};
use selvedge_textile::surface::{AREAL_WIRE_MM, Direction, HeightMap, Probe, Profile, ProfileSet};
use selvedge_textile::{HeightScale, Reduced, ScaledRelief, TextileError, smd_um};

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
}

impl Way {
    pub(super) const ALL: [Self; 5] = [
        Self::Kes,
        Self::Restoration,
        Self::Picture(Method::Variational),
        Self::Picture(Method::Linear),
        Self::Whole,
    ];

    pub(super) fn name(self) -> String {
        match self {
            Self::Kes => "KES strokes".to_owned(),
            Self::Restoration => "KES, restored".to_owned(),
            Self::Picture(method) => format!("picture, {}", method.label()),
            Self::Whole => "picture without lattice, linear".to_owned(),
        }
    }

    pub(super) fn is_picture(self) -> bool {
        matches!(self, Self::Picture(_) | Self::Whole)
    }
}

/// A cloth with everything that routes begin with.
pub(super) struct Subject {
    pub(super) cloth: Cloth,
    pub(super) strokes: ProfileSet,
    pub(super) photograph: Photograph,
    pub(super) truth: Felt,
    cell: Result<Rectangle, String>,
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
    let wire = Probe {
        width_mm: AREAL_WIRE_MM,
        ..Probe::ideal()
    };
    let at = |share: f64| strokes(map, &wire, share, &Random::new(0));
    let sets: Result<Vec<ProfileSet>, TextileError> = PLACES.into_iter().map(at).collect();
    Felt::of(sets?, name)
}

impl Subject {
    /// Strokes over a cloth and photographs it, `side_px` pixels a side of `points_a_px` points.
    pub(super) fn new(
        cloth: Cloth,
        [side_px, points_a_px]: [usize; 2],
        seed: u64,
    ) -> Result<Self, ReportError> {
        let random = Random::new(seed).branch("tester").branch(&cloth.name);
        let strokes = strokes(&cloth.map, &Probe::default(), 0.5, &random)?;
        let photograph = cloth.photograph(side_px, points_a_px, seed);
        let truth = felt(&cloth.map, &cloth.name)?;
        Ok(Self {
            cloth,
            strokes,
            cell: mean_cell(&photograph),
            photograph,
            truth,
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
        };
        made.map_err(|error| error.to_string())
    }

    /// The relief that a picture shows, from the picture on.
    pub(super) fn relief(&self, way: Way) -> Result<HeightMap, String> {
        if way == Way::Whole {
            return self.relief_of(&self.cell, way);
        }
        self.relief_of(&mean_cell(&self.photograph), way)
    }

    /// The relief of a mean cell, or of the whole picture, as high as reads the SMD of the strokes.
    fn relief_of(&self, cell: &Result<Rectangle, String>, way: Way) -> Result<HeightMap, String> {
        let Way::Picture(method) = way else {
            let whole = &self.photograph.luminance;
            return self.shaped(whole, LIGHT, self.photograph.px_mm, Method::Linear);
        };
        let cell = cell.as_ref().map_err(String::clone)?;
        let mut brightness = cell.values.clone();
        for value in brightness.values_mut() {
            *value = value.clamp(0.0, 1.0);
        }
        // The light turns with the cell; rows are those of heights, so angles count upwards.
        let light = Light {
            tilt_deg: LIGHT.tilt_deg - cell.angle_rad.to_degrees(),
            ..LIGHT
        };
        let n = [brightness.width(), brightness.height()].map(|n| n as f64);
        let step_mm = [0, 1].map(|i| cell.size_px[i] / n[i] * self.photograph.px_mm[i]);
        self.shaped(&brightness, light, step_mm, method)
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
        let scale = HeightScale::SmdUm(smd_um(&self.strokes));
        let tester = |map: &HeightMap| strokes(map, &Probe::default(), 0.5, &Random::new(1));
        let scaled =
            ScaledRelief::of(&shape, step_mm, scale, &tester).map_err(|e| e.to_string())?;
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
