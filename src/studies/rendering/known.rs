//! Amplitudes known to twenty digits, so that the reference has a place of its own: heights that
//! are whole numbers by a rule, and everything after them by arithmetic of 60 digits
//! (`tests/truth/amplitudes.py`, mpmath 1.4).

use std::sync::Arc;

use super::Case;
use crate::ReportError;
use crate::textiles::scene_with;
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::scene::Pose;
use selvedge_textile::surface::{Profile, ProfileSet, Surface};

/// What the case is called.
pub(super) const NAME: &str = "known to twenty digits";

/// Speed along the warp, mm/s, and amplitudes in µm at 40 and 320 Hz.
#[expect(
    clippy::excessive_precision,
    clippy::unreadable_literal,
    reason = "digits as they were computed"
)]
const KNOWN: [(f64, [f64; 2]); 7] = [
    (0.5, [5.2392949661319377063, 0.33194564157402109245]),
    (8.0, [1.9344202526479079562, 4.759474492570048713]),
    (20.25, [1.1552969636915149267, 3.1257876875695864762]),
    (87.5, [0.43543592925155068777, 1.6054667659498928247]),
    (120.0, [0.39817858845623539572, 1.3209549216946425712]),
    (333.25, [0.20412906192229509356, 0.55153193390280049315]),
    (1000.0, [0.028041029726176337521, 0.38401536398008647096]),
];

/// Heights of one window, µm.
fn heights_um() -> Vec<f64> {
    let height = |i: usize| ((7919 * i * i + 3 * i) % 1009) as f64 / 64.0;
    (0..1000).map(height).collect()
}

/// Every contactor feels the one point that there is, along the warp.
pub(super) fn case() -> Result<Case, ReportError> {
    let wrong = |why: String| ReportError::Study(why);
    let profile = Profile::new(1.0 / 230.0, heights_um());
    let profile = profile.map_err(|error| wrong(error.to_string()))?;
    let mut profiles = ProfileSet::default();
    profiles[0] = Some(profile);
    let surface = Surface::from_profiles(profiles, 0.0);
    let surface = surface.map_err(|(_, error)| wrong(error.to_string()))?;
    let scene = scene_with(&Arc::new(surface));
    let n_contactors = scene.displays[0].offsets.len();
    let pose = |&(speed_mm_per_s, _): &(f64, _)| {
        vec![Pose {
            position: Point::new(50.0, 50.0),
            velocity: Velocity::new(speed_mm_per_s, 0.0),
            ..Pose::default()
        }]
    };
    let exact_um = KNOWN.iter().flat_map(|(_, um)| vec![*um; n_contactors]);
    Ok(Case::known(
        NAME.to_owned(),
        scene,
        KNOWN.iter().map(pose).collect(),
        exact_um.collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textiles;
    use selvedge_render::array::Method;

    #[test]
    fn the_reference_has_thirteen_of_the_known_digits() {
        let case = case().unwrap();
        let mut reference = textiles::prepared(&case.scene, Method::Reference).unwrap();
        let mut exact_um = case.exact_um.iter();
        for poses in &case.poses {
            for found in textiles::amplitudes_um(&mut reference, poses) {
                let exact = exact_um.next().unwrap();
                for band in 0..2 {
                    let off = (found[band] / exact[band] - 1.0).abs();
                    assert!(off < 1e-13, "{off:e} at {poses:?}");
                }
            }
        }
        assert!(exact_um.next().is_none());
    }
}
