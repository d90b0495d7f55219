//! Tests of array rendering: the reference against a naive implementation and closed forms, the
//! fast methods against the reference, invariances, extreme cases.

mod accuracy;
mod areal;
mod closed_forms;
mod cloth;
mod extremes;
mod invariances;
mod naive;
mod places;
mod response;
mod rules;

use super::*;
use crate::{ContactorArray, PlacedSurface};
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_textile::surface::Surface;
use std::sync::Arc;

/// A surface of 120 × 120 mm at an origin, turned.
fn placed(surface: &Arc<Surface>, origin: [f64; 2], rotation_deg: f64) -> PlacedSurface {
    PlacedSurface {
        workspace_from_textile: Frame {
            origin: origin.into(),
            rotation: Rotation::from_degrees(rotation_deg),
        },
        size_mm: [120.0, 120.0],
        manifest_gain_db: 0.0,
        scene_gain_db: 0.0,
        scene_band_gains_db: [0.0; 2],
        within_mm: None,
        level: PlacedLevel::Silent,
        surface: Arc::clone(surface),
    }
}

/// The 6 × 4 array at 2 mm.
fn exeter() -> ContactorArray {
    let offset = |i: u8| {
        let (row, column) = (f64::from(i / 4), f64::from(i % 4));
        Displacement::new((column - 1.5) * 2.0, (2.5 - row) * 2.0)
    };
    ContactorArray {
        offsets: (0..24).map(offset).collect(),
        rotation_deg: 0.0,
    }
}

/// A single contactor at the display's centre.
fn single_contactor() -> ContactorArray {
    ContactorArray {
        offsets: vec![Displacement::default()],
        rotation_deg: 0.0,
    }
}

fn scene_of(textiles: Vec<PlacedSurface>, array: ContactorArray) -> RenderScene {
    RenderScene {
        textiles,
        displays: vec![array],
        ..RenderScene::default()
    }
}

/// One textile at the origin under one contactor.
fn alone(surface: &Arc<Surface>) -> RenderScene {
    scene_of(vec![placed(surface, [0.0, 0.0], 0.0)], single_contactor())
}

fn pose(position: [f64; 2], velocity: [f64; 2]) -> Pose {
    Pose {
        position: Point::from(position),
        velocity: Velocity::new(velocity[0], velocity[1]),
        ..Pose::default()
    }
}

fn renderer(scene: &RenderScene, method: Method) -> ArrayRenderer {
    ArrayRenderer::prepare(scene, method, &Accuracy::default()).unwrap()
}

/// All amplitudes of the first display at a pose.
fn amplitudes(renderer: &mut ArrayRenderer, pose: &Pose) -> Vec<[f64; 2]> {
    let frame = &renderer.tick(std::slice::from_ref(pose))[0];
    (0..frame.n_contactors())
        .map(|contactor| frame.amplitude_um(contactor))
        .collect()
}
