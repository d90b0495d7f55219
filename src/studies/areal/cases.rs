//! Reliefs that vary both ways: model cloths of the library, a random one like weathered ground,
//! and waves that grow across, of which every amplitude is known.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::{Effort, ReportError, textiles};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::Library;
use selvedge_textile::surface::{
    Direction, HeightMap, Probe, Surface, SurfaceError, WINDOW_LENGTH_MM,
};

/// The random relief's name.
const RANDOM: &str = "random relief";
/// Model cloths; the first when there is little time.
const CLOTHS: [&str; 4] = ["wool-twill", "jute-plain", "silk-crepe", "denim"];
/// The name of the waves.
const WAVES: &str = "waves that grow across";
/// Points of either relief either way, and the distance of the random one's, mm.
const N_POINTS: usize = 500;
const STEP_MM: f64 = 0.05;
/// Points of the waves in a window, whose middle is one of them, and their distance, mm.
const N_WINDOW: usize = 101;
const WAVES_STEP_MM: f64 = WINDOW_LENGTH_MM / N_WINDOW as f64;
/// Bins that the waves fall on, so far apart that none reaches another's, and their amplitudes in
/// the middle, µm: so flat that a wire follows them from point to point.
const LINES: [(u32, f64); 4] = [(2, 1.0), (6, 0.8), (13, 0.5), (31, 0.3)];
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
    /// Whether all amplitudes are known, along the warp.
    pub(super) is_known: bool,
}

/// The cases of a study.
pub(super) fn names(effort: Effort) -> Vec<&'static str> {
    let cloths = CLOTHS.into_iter().take(effort.pick(1, CLOTHS.len()));
    cloths.chain([RANDOM, WAVES]).collect()
}

impl Case {
    pub(super) fn of(name: &str, seed: u64) -> Result<Self, ReportError> {
        let failed = textiles::wrong(name);
        let map = match name {
            RANDOM => random_relief(seed).map_err(&failed)?,
            WAVES => waves().map_err(&failed)?,
            _ => textiles::relief(name, &Library::shipped()?.manifest(name)?.source)?,
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
            is_known: name == WAVES,
        })
    }
}

/// How much of their amplitude in the middle waves have at a place across, mm.
fn grown(w_mm: f64) -> f64 {
    0.5 + w_mm / (N_POINTS as f64 * WAVES_STEP_MM)
}

/// Waves along the warp whose amplitudes grow evenly across, so that a wire of any width that lies
/// about a place reads that of its middle.
fn waves() -> Result<HeightMap, SurfaceError> {
    let height_um = |column: usize, row: usize| {
        let turns = column as f64 / N_WINDOW as f64;
        let wave = |&(bin, um): &(u32, f64)| um * (TAU * f64::from(bin) * turns).cos();
        grown(row as f64 * WAVES_STEP_MM) * LINES.iter().map(wave).sum::<f64>()
    };
    let heights_um = Grid::from_fn(N_POINTS, N_POINTS, height_um);
    HeightMap::new(heights_um, [WAVES_STEP_MM; 2])
}

/// `[A40, A320]` of the waves at a place across and a speed along the warp, µm, in closed form. Of
/// a wave on a bin a Hamming window leaves 0.54² and twice 0.23² of its power, as parts of
/// 0.54² + 0.46²/2, on that bin and the two beside it; the filters are the default's.
pub(super) fn known_um(w_mm: f64, speed_mm_per_s: f64) -> [f64; 2] {
    // The nearest point, the sample that its window begins at, and the middle of that window.
    let n_points = ((N_POINTS - N_WINDOW) as f64 * WAVES_STEP_MM + 1e-6).floor() + 1.0;
    let point = (w_mm + 0.5 + 1e-6).floor().rem_euclid(n_points);
    let start = (point / WAVES_STEP_MM + 0.5).floor();
    let middle_mm = (start + (N_WINDOW / 2) as f64) * WAVES_STEP_MM;
    [40.0, 320.0].map(|band_hz: f64| {
        let heard = |(bin, share): (u32, f64)| {
            let hz = speed_mm_per_s * 0.23 * f64::from(bin);
            let is_heard = 0.0 < hz && hz < 1000.0;
            let octaves = (hz / band_hz).log2();
            if is_heard {
                share * (-octaves * octaves).exp2()
            } else {
                0.0
            }
        };
        let of_wave = |&(bin, um): &(u32, f64)| {
            let bins = [(bin - 1, 0.0529), (bin, 0.2916), (bin + 1, 0.0529)];
            um * um * bins.map(heard).iter().sum::<f64>() / 0.3974
        };
        grown(middle_mm) * LINES.iter().map(of_wave).sum::<f64>().sqrt()
    })
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
