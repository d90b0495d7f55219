//! The routes from a cloth to what is felt of it.

use super::cloths::{Cloth, Photograph};
use super::felt::Felt;
use super::taking::Taking;
use crate::ReportError;
use crate::picture::analysed;
use crate::textiles::wrong;
use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{Method, ShadingOptions, Shape};
use selvedge_textile::picture::{Analysis, Relief, ReliefOf};
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
    /// The picture, its lattice, its mean cell, its shape by a method, scaled to the tester's SMD.
    Picture(Method),
    /// The shape of the whole picture by the linear method, no mean cell.
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
            Self::Picture(method) => format!("mean cell, {}", method.label()),
            Self::Whole => "picture as it is, linear".to_owned(),
            Self::Believed => "picture as it is, by evidence".to_owned(),
        }
    }

    pub(super) fn is_picture(self) -> bool {
        matches!(self, Self::Picture(_) | Self::Whole | Self::Believed)
    }
}

/// A cloth with what the tester reads on it and what is felt of it.
pub(super) struct Known {
    pub(super) cloth: Cloth,
    strokes: ProfileSet,
    pub(super) truth: Felt,
}

/// A known cloth that was photographed.
pub(super) struct Subject<'a> {
    pub(super) known: &'a Known,
    pub(super) taking: Taking,
    photograph: Photograph,
    analysis: Analysis,
    believed: Result<(Ensemble, HeightMap), String>,
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

impl Known {
    /// Strokes over a cloth.
    pub(super) fn of(cloth: Cloth, seed: u64) -> Result<Self, ReportError> {
        let random = Random::new(seed).branch("tester").branch(&cloth.name);
        Ok(Self {
            strokes: strokes(&cloth.map, &Probe::default(), 0.5, &random)?,
            truth: felt(&cloth.map, &cloth.name)?,
            cloth,
        })
    }
}

impl<'a> Subject<'a> {
    /// Photographs a cloth; nothing where the work was cancelled.
    pub(super) fn new(known: &'a Known, taking: Taking, seed: u64) -> Option<Self> {
        let photograph = known.cloth.photograph(&taking, seed);
        let mut subject = Self {
            known,
            taking,
            analysis: analysed(&photograph.luminance)?,
            photograph,
            believed: Err(String::new()),
        };
        subject.believed = subject.believe(&subject.analysis);
        Some(subject)
    }

    /// What is felt by a route, or in words why it ends nowhere.
    pub(super) fn felt_by(&self, way: Way) -> Result<Felt, String> {
        let name = &self.known.cloth.name;
        let strokes = &self.known.strokes;
        let made = match way {
            Way::Kes => Felt::of(vec![strokes.clone()], name),
            Way::Restoration => restored(strokes)
                .map_err(ReportError::from)
                .and_then(|profiles| Felt::of(vec![profiles], name)),
            Way::Picture(_) | Way::Whole => felt(&self.relief_of(&self.analysis, way)?, name),
            Way::Believed => felt(&self.believed.as_ref().map_err(String::clone)?.1, name),
        };
        made.map_err(|error| error.to_string())
    }

    /// The relief that a picture shows, from the picture on.
    pub(super) fn relief(&self, way: Way) -> Result<HeightMap, String> {
        let analysis = analysed(&self.photograph.luminance).ok_or("cancelled")?;
        match way {
            Way::Believed => Ok(self.believe(&analysis)?.1),
            _ => self.relief_of(&analysis, way),
        }
    }

    /// What heights are found on, as of a textile of a picture.
    fn ground(&self, analysis: &Analysis, relief_of: ReliefOf) -> Result<Brightness, String> {
        let found = analysis.found.as_ref();
        let px_per_mm = Some(1.0 / self.photograph.px_mm[0]);
        let picture = (relief_of, &analysis.luminance);
        let ground = Brightness::ground(picture, found.ok(), px_per_mm, 1);
        ground.ok_or_else(|| found.map_or_else(ToString::to_string, |_| String::new()))
    }

    /// The relief of a mean cell, or of the whole picture, as high as reads the SMD of the strokes.
    fn relief_of(&self, analysis: &Analysis, way: Way) -> Result<HeightMap, String> {
        let (relief_of, method) = match way {
            Way::Picture(method) => (ReliefOf::Cell, method),
            _ => (ReliefOf::Picture, Method::Linear),
        };
        let light = match self.taking.lamp {
            Lamp::Known { light, .. } => Some(light),
            Lamp::Unknown | Lamp::Turned { .. } => None,
        };
        let options = ShadingOptions {
            method,
            ..ShadingOptions::default()
        };
        let ground = self.ground(analysis, relief_of)?;
        let relief = Progress::unheard(|p| Relief::of(ground, light, &options, p));
        let relief = relief.map_err(|error| error.to_string())?;
        self.scaled(&relief.shape, relief.brightness.size_px)
    }

    /// Many reliefs of the whole picture, and the one that is kept.
    fn believe(&self, analysis: &Analysis) -> Result<(Ensemble, HeightMap), String> {
        let ground = self.ground(analysis, ReliefOf::Picture)?;
        let about = PictureTextile {
            name: self.known.cloth.name.clone(),
            px_per_mm: 1.0 / self.photograph.px_mm[0],
            size_px: Some(ground.size_px),
            scale: HeightScale::SmdUm(smd_um(&self.known.strokes)),
            ..PictureTextile::default()
        };
        let failed = |error: TextileError| error.to_string();
        Progress::unheard(|progress| {
            let lamp = self.taking.lamp;
            let ensemble = Ensemble::of(&ground, &about, lamp, n_threads(), progress);
            let ensemble = ensemble.map_err(failed)?;
            let shape = ensemble.shape(&about).map_err(failed)?;
            let map = self.scaled(&shape, ground.size_px)?;
            Ok((ensemble, map))
        })
    }

    /// Of warp and weft by band, the ends of the band less the truth, dB.
    pub(super) fn band_db(&self) -> Option<[[f64; 2]; 4]> {
        let (ensemble, _) = self.believed.as_ref().ok()?;
        let bands = ensemble.levels([0, 1].map(|axis| self.known.truth.axis_levels_db[axis]));
        let ends: Vec<[f64; 2]> = bands.iter().map(|&[.., low, high]| [low, high]).collect();
        ends.try_into().ok()
    }

    /// A shape of so many pixels of the picture as high as reads the SMD of the strokes.
    fn scaled(&self, shape: &Shape, size_px: [f64; 2]) -> Result<HeightMap, String> {
        let n = [shape.height_px.width(), shape.height_px.height()].map(|n| n as f64);
        let step_mm = [0, 1].map(|i| size_px[i] / n[i] * self.photograph.px_mm[i]);
        let scale = HeightScale::SmdUm(smd_um(&self.known.strokes));
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
