//! Cloth, scenes and renderers to try extreme things on.

use std::sync::Arc;

use super::case::failed;
use selvedge_foundation::geometry::{Frame, Point, Rotation, Velocity};
use selvedge_render::array::{Accuracy, ArrayRenderer, DisplayFrame, Method};
use selvedge_render::scene::{Geometry, Pose};
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use selvedge_textile::surface::{Profile, ProfileSet, Surface};

/// Samples of the profiles: 20 mm.
const N_SAMPLES: u16 = 4600;
const STEP_MM: f64 = 1.0 / 230.0;

/// The three methods, which must agree in every extreme.
pub(super) const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

/// A surface of these heights in µm along x in mm, the same in every direction.
pub(super) fn surface(height_um: impl Fn(f64) -> f64) -> Result<Arc<Surface>, String> {
    let heights = (0..N_SAMPLES)
        .map(|i| height_um(f64::from(i) * STEP_MM))
        .collect();
    let mut profiles = ProfileSet::default();
    profiles[0] = Some(Profile::new(STEP_MM, heights).map_err(failed)?);
    let surface = Surface::from_profiles(profiles, 0.0);
    surface.map(Arc::new).map_err(|(_, error)| failed(error))
}

/// A surface of waves 1 mm long of this amplitude.
pub(super) fn waves(amplitude_um: f64) -> Result<Arc<Surface>, String> {
    surface(|x_mm| amplitude_um * (std::f64::consts::TAU * x_mm).sin())
}

/// A surface placed with its lower left corner at (0, 0).
pub(super) fn placed(surface: &Arc<Surface>, width_mm: f64) -> PlacedSurface {
    PlacedSurface {
        workspace_from_textile: Frame {
            origin: Point::new(0.0, 0.0),
            rotation: Rotation::NONE,
        },
        size_mm: [width_mm, 100.0],
        manifest_gain_db: 0.0,
        scene_gain_db: 0.0,
        level: PlacedLevel::Known(0.0),
        surface: Arc::clone(surface),
    }
}

/// A scene of placed surfaces and one array of 24 contactors.
pub(super) fn scene(textiles: Vec<PlacedSurface>) -> RenderScene {
    RenderScene {
        textiles,
        displays: vec![ContactorArray {
            offsets: Geometry::default().contactors(),
            rotation_deg: 0.0,
        }],
        ..RenderScene::default()
    }
}

/// A scene of one textile of waves, 100 mm wide.
pub(super) fn wavy_scene() -> Result<RenderScene, String> {
    Ok(scene(vec![placed(&waves(3.0)?, 100.0)]))
}

/// A renderer of a scene.
pub(super) fn renderer(scene: &RenderScene, method: Method) -> Result<ArrayRenderer, String> {
    ArrayRenderer::prepare(scene, method, &Accuracy::default()).map_err(failed)
}

/// A display at (50, 50) that moves along the warp.
pub(super) fn moving(speed_mm_per_s: f64) -> Pose {
    Pose {
        position: Point::new(50.0, 50.0),
        velocity: Velocity::new(speed_mm_per_s, 0.0),
        ..Pose::default()
    }
}

/// The smallest and the largest amplitude of a frame, µm, as the device would get them; NaN if any
/// is no number.
pub(super) fn extent_um(frame: &DisplayFrame) -> [f32; 2] {
    let all = || frame.amplitudes_um().iter().flatten().copied();
    if all().any(f32::is_nan) {
        return [f32::NAN; 2];
    }
    [
        all().fold(f32::INFINITY, f32::min),
        all().fold(0.0, f32::max),
    ]
}

/// Amplitudes in words.
pub(super) fn range_um([low, high]: [f32; 2]) -> String {
    if low == high {
        format!("{low} µm everywhere")
    } else {
        format!("{low:.3e} … {high:.3e} µm")
    }
}
