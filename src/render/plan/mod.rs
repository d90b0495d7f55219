//! What a tick has to evaluate: which contactors lie on which textile, at which points, moving how
//! fast along warp and weft; and what can be left out.
//!
//! All methods share this, so they differ in nothing but how powers are found. Left out are
//! contactors outside, directions that cannot be felt, bins at or above 1 kHz or below a filter's
//! floor, and everything that was already evaluated in the same tick. [`Counters`]
//! say how much each [`Rule`] left out.

mod contact;
mod counters;
mod display;
mod motion;
mod point;

pub(super) use contact::{Contacts, Feel, Ground, Motion, OUTSIDE, TextilePlan};
pub use counters::{Counters, Rule};
pub use display::MaterialContact;
pub(super) use display::{DisplayPlan, finite_pose, is_at_rest};
pub(super) use motion::{Axis, Component};
pub(super) use point::{PointGrid, PointIndex, nearest_mm};

use std::sync::Arc;

use super::RenderScene;
use super::scene::Pose;
use selvedge_textile::surface::{Direction, LocalSpectra};

/// The textiles of a scene, and every set of spectra they use, once.
#[derive(Debug, Clone)]
pub(super) struct ScenePlan {
    pub(super) textiles: Vec<TextilePlan>,
    /// Distinct spectra; textiles and directions that share them name the same one.
    pub(super) pool: Vec<Arc<LocalSpectra>>,
}

impl ScenePlan {
    pub(super) fn of(scene: &RenderScene) -> Self {
        let mut pool: Vec<Arc<LocalSpectra>> = Vec::new();
        let mut place_of = |spectra: &Arc<LocalSpectra>| {
            let known = pool.iter().position(|other| Arc::ptr_eq(other, spectra));
            known.unwrap_or_else(|| {
                pool.push(Arc::clone(spectra));
                pool.len() - 1
            })
        };
        let mut textiles = Vec::with_capacity(scene.textiles.len());
        for placed in &scene.textiles {
            let spectra = Direction::ALL.map(|d| place_of(placed.surface.spectra(d)));
            textiles.push(TextilePlan::new(placed, spectra));
        }
        Self { textiles, pool }
    }

    /// Does something with the contacts of a display that began a tick, on one textile after the
    /// other from the topmost down, until every contactor lies on one.
    #[inline]
    pub(super) fn for_each_touched(
        &self,
        display: &mut DisplayPlan,
        pose: &Pose,
        counters: &mut Counters,
        mut act: impl FnMut(&Contacts<'_>, &mut Counters),
    ) {
        let felt = display.felt(self.textiles.len());
        let lowest = felt.start;
        for number in felt.rev() {
            let textile = &self.textiles[number];
            let Some(placing) = display.placing(&textile.ground, pose.position) else {
                counters.textiles_out_of_reach += 1;
                continue;
            };
            if let Some(contacts) =
                display.claim((&textile.ground, number), &placing, pose, counters)
            {
                act(&contacts, counters);
            }
            if display.is_taken() {
                counters.touches_beneath += ((number - lowest) * display.n_contactors()) as u64;
                break;
            }
        }
    }
}
