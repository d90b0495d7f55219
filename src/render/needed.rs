//! Which textiles of a scene an exploration feels: no other needs to be read.
//!
//! A textile that no moving display reaches, that lies wholly under others wherever one does, or
//! that no gain lets through gives nothing, whatever its surface is. Known before any surface is,
//! from places, gains and the path alone.

use std::path::Path;

use crate::plan::{Counters, DisplayPlan, Ground, finite_pose, is_at_rest};
use crate::scene::{ExplorationPath, LoadedScene, PlacedTextile, Pose, Scene, SceneError};
use crate::{ContactorArray, GainTerms};
use selvedge_textile::BuildCache;
use selvedge_textile::tactile::{Band, Tuning};

impl LoadedScene {
    /// Reads the text of a scene file and, of the textiles that it places, those that are felt
    /// along a path: the others have their manifests and no surface. Compression to the mean level
    /// of all takes all.
    ///
    /// # Errors
    /// As [`LoadedScene::from_text`].
    pub fn from_text_along(
        (text, scene): (&str, &Path),
        cache: Option<&BuildCache>,
        path: &ExplorationPath,
    ) -> Result<Self, SceneError> {
        let felt = |scene: &Scene, tuning: &Tuning, manifest_db: &[f64]| {
            needed(scene, tuning, manifest_db, path)
        };
        Self::from_text_with(text, scene, cache, &felt)
    }
}

/// Whether each textile placed is felt along a path, with the gains of their manifests in dB.
fn needed(
    scene: &Scene,
    tuning: &Tuning,
    manifest_db: &[f64],
    path: &ExplorationPath,
) -> Vec<bool> {
    if tuning.compression > 0.0 && tuning.compression_reference_db.is_none() {
        return vec![true; scene.textiles.len()];
    }
    let mut is_needed = touched(scene, path);
    for ((is_needed, placed), manifest_db) in
        is_needed.iter_mut().zip(&scene.textiles).zip(manifest_db)
    {
        *is_needed &= is_let_through(placed, tuning, *manifest_db);
    }
    is_needed
}

/// Whether any band of a textile has a gain above −∞ dB.
fn is_let_through(placed: &PlacedTextile, tuning: &Tuning, manifest_db: f64) -> bool {
    let terms = |band: Band| {
        let scene_db = placed.gain_db + placed.band_gain_db(band);
        GainTerms::of(tuning, band, [manifest_db, scene_db])
    };
    Band::ALL.into_iter().any(|band| terms(band).factor() > 0.0)
}

/// Whether any display that moves reaches each textile where no other covers it wholly.
fn touched(scene: &Scene, path: &ExplorationPath) -> Vec<bool> {
    let ground =
        |one: &PlacedTextile| Ground::new(one.workspace_from_textile(), one.size_mm, one.within_mm);
    let grounds: Vec<Ground> = scene.textiles.iter().map(ground).collect();
    let displays = scene.displays.iter().map(ContactorArray::of);
    let mut displays: Vec<DisplayPlan> = displays.map(|array| DisplayPlan::new(&array)).collect();
    let mut poses = vec![Pose::default(); displays.len()];
    let (mut is_touched, counters) = (vec![false; grounds.len()], &mut Counters::default());
    for (_, pose) in path.ticks() {
        if is_touched.iter().all(|is_touched| *is_touched) {
            break;
        }
        path.poses_into(&pose, &mut poses);
        for (display, pose) in displays.iter_mut().zip(&poses) {
            let Some(pose) = finite_pose(pose, counters).filter(|pose| !is_at_rest(pose)) else {
                continue;
            };
            display.begin(pose.angle_deg, counters);
            for (ground, is_touched) in grounds.iter().zip(&mut is_touched).rev() {
                let placing = display.placing(ground, pose.position);
                *is_touched |= placing.is_some();
                if placing.is_some_and(|placing| placing.is_covered) {
                    break;
                }
            }
        }
    }
    is_touched
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::PathRow;
    use selvedge_foundation::geometry::Point;

    /// Three textiles of 50 mm beside each other from the left, and a fourth upon the first.
    fn scene() -> Scene {
        let placed = |(nth, x_mm): (usize, f64)| PlacedTextile {
            id: nth.to_string(),
            origin_mm: Point::new(x_mm, 0.0),
            size_mm: [50.0; 2],
            ..PlacedTextile::default()
        };
        let shipped = LoadedScene::shipped().unwrap();
        let places = [0.0, 60.0, 120.0, 0.0];
        Scene {
            textiles: places.into_iter().enumerate().map(placed).collect(),
            ..shipped.scene().clone()
        }
    }

    fn along(xs_mm: &[f64]) -> ExplorationPath {
        let row = |(n, x_mm): (u32, &f64)| PathRow {
            t_s: f64::from(n) / 40.0,
            position: Point::new(*x_mm, 25.0),
            ..PathRow::default()
        };
        ExplorationPath::new((0..).zip(xs_mm).map(row).collect()).unwrap()
    }

    #[test]
    fn what_is_felt_is_needed_and_nothing_that_is_out_of_reach_or_covered() {
        let need = |xs_mm: &[f64]| needed(&scene(), &Tuning::default(), &[0.0; 4], &along(xs_mm));
        assert_eq!(need(&[20.0, 25.0, 30.0]), [false, false, false, true]);
        let over_the_edge = need(&[40.0, 50.0, 60.0]);
        assert_eq!(over_the_edge, [true, true, false, true], "beside it, too");
        assert_eq!(need(&[80.0, 90.0]), [false, true, false, false]);
        assert_eq!(need(&[20.0; 9]), [false; 4], "it rests");
        assert_eq!(need(&[-40.0, -30.0]), [false; 4]);
    }

    #[test]
    fn what_no_gain_lets_through_is_not_needed() {
        let need = |scene: &Scene, tuning: &Tuning, manifest_db: f64| {
            needed(
                scene,
                tuning,
                &[0.0, 0.0, 0.0, manifest_db],
                &along(&[20.0, 25.0]),
            )[3]
        };
        let (silent, none) = (f64::NEG_INFINITY, Tuning::default());
        assert!(need(&scene(), &none, -60.0) && !need(&scene(), &none, silent));
        let mut muted = scene();
        muted.textiles[3].gain_40_db = silent;
        assert!(need(&muted, &none, 0.0), "320 Hz sounds");
        muted.textiles[3].gain_320_db = silent;
        assert!(!need(&muted, &none, 0.0));
        let master = Tuning {
            gain_db: silent,
            ..none
        };
        assert!(!need(&scene(), &master, 0.0));
    }

    #[test]
    fn compression_to_the_mean_of_all_takes_all() {
        let mut tuning = Tuning {
            compression: 0.5,
            compression_reference_db: None,
            ..Tuning::default()
        };
        let path = along(&[20.0, 25.0]);
        assert_eq!(needed(&scene(), &tuning, &[0.0; 4], &path), [true; 4]);
        tuning.compression_reference_db = Some(-3.0);
        let stated = needed(&scene(), &tuning, &[0.0; 4], &path);
        assert_eq!(stated, [false, false, false, true]);
    }
}
