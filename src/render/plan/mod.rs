//! What a tick has to evaluate: which contactors lie on which textile, at which points, moving how
//! fast along warp and weft; and what can be left out.
//!
//! All methods share this, so they differ in nothing but how powers are found. Left out are
//! contactors outside, directions that cannot be felt, bins at or above 1 kHz or below a filter's
//! floor, and everything that was already evaluated in the same tick. Each saving is a [`Rule`]
//! that can be switched off; counters say how much it left out.

mod contact;
mod counters;
mod display;
mod point;
mod rules;

pub(super) use contact::{Contacts, Feel, Motion, TextilePlan};
pub use counters::Counters;
pub(super) use display::DisplayPlan;
pub(super) use point::{PointGrid, PointIndex, nearest_mm, whole_part};
pub use rules::{Rule, Rules};

use std::sync::Arc;

use super::RenderScene;
use selvedge_textile::surface::{Direction, LocalSpectra};
use selvedge_textile::tactile::{MAX_SPEED_MM_PER_S, MIN_SPEED_MM_PER_S};

/// No textile: the contactor lies outside.
pub(super) const OUTSIDE: u16 = u16::MAX;

/// A velocity component along warp or weft, as rendering takes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Component {
    /// It is felt: speed in mm/s, and whether against the axis.
    Felt {
        speed_mm_per_s: f64,
        is_reverse: bool,
    },
    /// Below 0.01 mm/s.
    AtRest,
    /// At or above 1000/0.23 mm/s, or not a number.
    TooFast,
}

impl Component {
    pub(super) fn of(component_mm_per_s: f64) -> Self {
        let speed_mm_per_s = component_mm_per_s.abs();
        if speed_mm_per_s < MIN_SPEED_MM_PER_S {
            Self::AtRest
        } else if speed_mm_per_s < MAX_SPEED_MM_PER_S {
            let is_reverse = component_mm_per_s < 0.0;
            Self::Felt {
                speed_mm_per_s,
                is_reverse,
            }
        } else {
            Self::TooFast
        }
    }

    /// Its speed, or the nearest one that is felt, mm/s.
    fn nearest_felt_mm_per_s(self) -> f64 {
        match self {
            Self::Felt { speed_mm_per_s, .. } => speed_mm_per_s,
            Self::AtRest => MIN_SPEED_MM_PER_S,
            Self::TooFast => MAX_SPEED_MM_PER_S.next_down(),
        }
    }
}

/// One of the two axes of a textile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    Warp,
    Weft,
}

impl Axis {
    pub(super) const BOTH: [Self; 2] = [Self::Warp, Self::Weft];

    /// The direction of a stroke along the axis.
    pub(super) fn direction(self, is_reverse: bool) -> Direction {
        match (self, is_reverse) {
            (Self::Warp, false) => Direction::WarpForward,
            (Self::Warp, true) => Direction::WarpReverse,
            (Self::Weft, false) => Direction::WeftForward,
            (Self::Weft, true) => Direction::WeftReverse,
        }
    }
}

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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_are_felt_from_a_hundredth_to_the_first_bins_kilohertz() {
        assert_eq!(Component::of(0.0), Component::AtRest);
        assert_eq!(Component::of(-0.009_99), Component::AtRest);
        let felt = Component::Felt {
            speed_mm_per_s: 0.01,
            is_reverse: true,
        };
        assert_eq!(Component::of(-0.01), felt);
        for too_fast in [MAX_SPEED_MM_PER_S, f64::NEG_INFINITY, f64::NAN] {
            assert_eq!(Component::of(too_fast), Component::TooFast, "{too_fast}");
        }
    }
}
