//! Reliefs that vary both ways: model cloths of the library, and random ones like weathered ground.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::{Effort, ReportError, textiles};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::Library;
use selvedge_textile::surface::{Direction, HeightMap, Probe, Surface, SurfaceError};

/// The random relief's name.
const RANDOM: &str = "random relief";
/// Model cloths; the first when there is little time.
const CLOTHS: [&str; 4] = ["wool-twill", "jute-plain", "silk-crepe", "denim"];
/// Points of the random relief either way, and their distance, mm.
const N_POINTS: usize = 500;
const STEP_MM: f64 = 0.05;
/// Waves that the random relief is made of.
const N_WAVES: usize = 200;
/// Their wavenumbers, cycles/mm.
const WAVENUMBERS_PER_MM: [f64; 2] = [0.1, 8.0];
/// How fast their amplitudes fall with the wavenumber: that of a Brownian surface's octaves.
const HURST: f64 = 0.5;

/// A relief as it is felt.
pub(super) struct Case {
    pub(super) name: String,
    /// Along one profile a direction, read with the tester's wire of 5 mm, and with that of the
    /// areal surface.
    pub(super) economical: [Arc<Surface>; 2],
    /// At every point.
    pub(super) areal: Arc<Surface>,
}

/// The cases of a study.
pub(super) fn names(effort: Effort) -> Vec<&'static str> {
    let cloths = CLOTHS.into_iter().take(effort.pick(1, CLOTHS.len()));
    cloths.chain([RANDOM]).collect()
}

impl Case {
    pub(super) fn of(name: &str, seed: u64) -> Result<Self, ReportError> {
        let failed = textiles::wrong(name);
        let map = if name == RANDOM {
            random_relief(seed).map_err(&failed)?
        } else {
            textiles::relief(name, &Library::shipped()?.manifest(name)?.source)?
        };
        let wrong = |(_, error): (Direction, SurfaceError)| failed(error);
        let economical = |wire: Probe| {
            let middle_mm = map.size_mm().map(|mm| 0.5 * mm);
            let [warp, _, weft, _] = map.strokes(&wire, middle_mm, &Random::new(seed))?;
            Surface::from_profiles([warp, None, weft, None], 0.0).map(Arc::new)
        };
        Ok(Self {
            name: name.to_owned(),
            economical: [
                economical(Probe::ideal()).map_err(wrong)?,
                economical(Probe::contactor()).map_err(wrong)?,
            ],
            areal: Arc::new(Surface::areal(&map, 0.0).map_err(wrong)?),
        })
    }
}

/// Points of a surface, of all directions that have their own.
pub(super) fn n_points(surface: &Surface) -> usize {
    let has_own = |direction: &Direction| surface.taken_from(*direction) == *direction;
    let own = Direction::ALL.into_iter().filter(has_own);
    own.map(|direction| surface.spectra(direction).n_points())
        .sum()
}

/// Waves of all lengths and headings, smaller the shorter they are.
fn random_relief(seed: u64) -> Result<HeightMap, SurfaceError> {
    let mut random = Random::new(seed).branch("relief");
    let mut heights_um = Grid::filled(N_POINTS, N_POINTS, 0.0);
    let [low, high] = WAVENUMBERS_PER_MM.map(f64::ln);
    for _ in 0..N_WAVES {
        let per_mm = random.uniform_in(low, high).exp();
        let (sin, cos) = random.uniform_in(0.0, TAU).sin_cos();
        let phase = random.uniform_in(0.0, TAU);
        let amplitude_um = 2.0 * per_mm.powf(-HURST) / (N_WAVES as f64).sqrt() * 5.0;
        // cos(a + b) from the cosines and sines of both: none is computed at every point.
        let turns = |per_mm: f64, phase: f64| -> Vec<(f64, f64)> {
            let turn = |i: usize| (TAU * per_mm * i as f64 * STEP_MM + phase).sin_cos();
            (0..N_POINTS).map(turn).collect()
        };
        let (along, across) = (turns(per_mm * cos, phase), turns(per_mm * sin, 0.0));
        for (row, (sin_w, cos_w)) in across.iter().enumerate() {
            for (height, (sin_u, cos_u)) in heights_um.row_mut(row).iter_mut().zip(&along) {
                *height += amplitude_um * (cos_u * cos_w - sin_u * sin_w);
            }
        }
    }
    HeightMap::new(heights_um, [STEP_MM; 2])
}
