//! Textiles, scenes and strokes that studies share: shipped textiles, lines and noise, and what a
//! renderer makes of them.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

use crate::ReportError;
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_foundation::numerics::Random;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{ArrayLayout, Geometry, Pose};
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderError, RenderScene};
use selvedge_textile::surface::{BIN_SPACING_PER_MM, HeightMap, Profile, Surface, SurfaceError};
use selvedge_textile::tactile::MAX_SPEED_MM_PER_S;
use selvedge_textile::{Library, Source, TextileError};

/// The width of every textile of a study, mm.
pub(crate) const WIDTH_MM: f64 = 120.0;
/// The step of a Kawabata recording, mm.
const STEP_MM: f64 = 1.0 / 230.0;
/// Samples of a synthetic profile: 20 mm.
const N_SAMPLES: u32 = 4600;

/// A surface of the shipped library.
pub(crate) fn shipped(id: &str) -> Result<Arc<Surface>, ReportError> {
    Ok(Arc::clone(Library::shipped()?.load(id)?.surface()))
}

/// One wave that fits the window: a single line at this bin, as good as alone.
pub(crate) fn line(bin: u16) -> Result<Arc<Surface>, ReportError> {
    let per_mm = BIN_SPACING_PER_MM * f64::from(bin);
    of_heights(|x_mm| 5.0 * (TAU * per_mm * x_mm).cos())
}

/// White noise: the same power in every bin but for chance.
pub(crate) fn noise(seed: u64) -> Result<Arc<Surface>, ReportError> {
    let mut random = Random::new(seed).branch("noise");
    of_heights(|_| 5.0 * random.normal())
}

/// A surface of these heights in µm along x in mm, the same in every direction.
pub(crate) fn of_heights(
    mut height_um: impl FnMut(f64) -> f64,
) -> Result<Arc<Surface>, ReportError> {
    let failed = wrong("a surface by formula");
    let heights = (0..N_SAMPLES).map(|i| height_um(f64::from(i) * STEP_MM));
    let profile = Profile::new(STEP_MM, heights.collect()).map_err(&failed)?;
    let surface = Surface::from_profiles([Some(profile), None, None, None], 0.0);
    Ok(Arc::new(surface.map_err(|(_, error)| failed(error))?))
}

/// What is wrong with a surface of this name.
pub(crate) fn wrong(name: &str) -> impl Fn(SurfaceError) -> TextileError {
    let path = PathBuf::from(name);
    move |source| TextileError::Surface {
        path: path.clone(),
        source,
    }
}

/// The relief that a textile's recipe makes.
pub(crate) fn relief(name: &str, source: &Source) -> Result<HeightMap, TextileError> {
    known(name, source.height_map())
}

/// Heights over an area, if the textile of this name has any.
pub(crate) fn known(
    name: &str,
    map: Option<Result<HeightMap, SurfaceError>>,
) -> Result<HeightMap, TextileError> {
    let map = map.unwrap_or(Err(SurfaceError::AllMissing));
    map.map_err(wrong(name))
}

/// A surface of a study's width with a corner at `origin`, without any gain.
pub(crate) fn placed(surface: &Arc<Surface>, origin: Point) -> PlacedSurface {
    PlacedSurface {
        workspace_from_textile: Frame {
            origin,
            rotation: Rotation::NONE,
        },
        size_mm: [WIDTH_MM; 2],
        manifest_gain_db: 0.0,
        scene_gain_db: 0.0,
        scene_band_gains_db: [0.0; 2],
        within_mm: None,
        level: PlacedLevel::Silent,
        surface: Arc::clone(surface),
    }
}

/// The 24 contactors.
pub(crate) fn exeter() -> ContactorArray {
    ContactorArray {
        offsets: Geometry::Array(ArrayLayout::Exeter24).contactors(),
        rotation_deg: 0.0,
    }
}

/// Contactors 0.1 mm apart, row by row in a square.
pub(crate) fn square(n_contactors: usize) -> ContactorArray {
    let n_columns = n_contactors.saturating_sub(1).isqrt() + 1;
    let middle = (n_columns as f64 - 1.0) / 2.0;
    let offset = |n: usize| {
        let [column, row] = [n % n_columns, n / n_columns].map(|n| n as f64);
        Displacement::new((column - middle) * 0.1, (middle - row) * 0.1)
    };
    ContactorArray {
        offsets: (0..n_contactors).map(offset).collect(),
        rotation_deg: 0.0,
    }
}

/// Textiles under one display, without gains.
pub(crate) fn scene_of(textiles: Vec<PlacedSurface>, array: ContactorArray) -> RenderScene {
    RenderScene {
        textiles,
        displays: vec![array],
        ..RenderScene::default()
    }
}

/// One surface under the 24 contactors.
pub(crate) fn scene_with(surface: &Arc<Surface>) -> RenderScene {
    scene_of(vec![placed(surface, Point::default())], exeter())
}

/// A renderer of a scene.
pub(crate) fn prepared(scene: &RenderScene, method: Method) -> Result<ArrayRenderer, RenderError> {
    ArrayRenderer::prepare(scene, method, &Accuracy::default())
}

/// Amplitudes of all displays, each at its pose, µm.
pub(crate) fn amplitudes_um(
    renderer: &mut ArrayRenderer,
    poses: &[Pose],
) -> impl Iterator<Item = [f64; 2]> {
    let frames = renderer.tick(poses).iter();
    frames
        .flat_map(|frame| (0..frame.n_contactors()).map(|contactor| frame.amplitude_um(contactor)))
}

/// Poses anywhere on one textile, with speeds spread evenly over the octaves between two, mm/s.
/// Three of four head anywhere; the fourth runs along the warp, so fast that a bin sounds within a
/// ten-thousandth of 1 kHz, where spectra are cut.
pub(crate) fn poses_between(
    speeds_mm_per_s: [f64; 2],
    n_poses: usize,
    random: &mut Random,
) -> Vec<Pose> {
    let [low, high] = speeds_mm_per_s.map(f64::ln);
    let pose = |n: usize| {
        // One speed in each of so many equal parts, so that none is left out by chance.
        let share = (n as f64 + random.uniform()) / n_poses as f64;
        let mut speed_mm_per_s = (low + (high - low) * share).exp();
        let (mut sin, mut cos) = random.uniform_in(0.0, TAU).sin_cos();
        if n % 4 == 3 {
            let nearest = (MAX_SPEED_MM_PER_S / speed_mm_per_s).round().max(1.0);
            speed_mm_per_s = MAX_SPEED_MM_PER_S / nearest * (1.0 + 1e-4 * random.normal());
            (sin, cos) = (0.0, cos.signum());
        }
        let mut place = || random.uniform_in(10.0, WIDTH_MM - 10.0);
        Pose {
            position: Point::new(place(), place()),
            velocity: Velocity::new(speed_mm_per_s * cos, speed_mm_per_s * sin),
            ..Pose::default()
        }
    };
    (0..n_poses).map(pose).collect()
}
