//! Scenes and renderers to try extreme things on.

use std::sync::Arc;

use super::case::failed;
use crate::textiles::{self, exeter, of_heights, scene_of};
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::array::{ArrayRenderer, DisplayFrame, Method};
use selvedge_render::scene::Pose;
use selvedge_render::{PlacedSurface, RenderScene};
use selvedge_textile::surface::Surface;

/// The three methods, which must agree in every extreme.
pub(super) const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

/// A surface of waves 1 mm long of this amplitude.
pub(super) fn waves(amplitude_um: f64) -> Result<Arc<Surface>, String> {
    of_heights(|x_mm| amplitude_um * (std::f64::consts::TAU * x_mm).sin()).map_err(failed)
}

/// A surface placed with its lower left corner at (0, 0).
pub(super) fn placed(surface: &Arc<Surface>, width_mm: f64) -> PlacedSurface {
    PlacedSurface {
        size_mm: [width_mm, 100.0],
        ..textiles::placed(surface, Point::default())
    }
}

/// A scene of placed surfaces and one array of 24 contactors.
pub(super) fn scene(textiles: Vec<PlacedSurface>) -> RenderScene {
    scene_of(textiles, exeter())
}

/// A scene of one textile of waves, 100 mm wide.
pub(super) fn wavy_scene() -> Result<RenderScene, String> {
    Ok(scene(vec![placed(&waves(3.0)?, 100.0)]))
}

/// A renderer of a scene.
pub(super) fn renderer(scene: &RenderScene, method: Method) -> Result<ArrayRenderer, String> {
    textiles::prepared(scene, method).map_err(failed)
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
