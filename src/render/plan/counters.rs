//! What ticks evaluated and what they left out.

use serde::Serialize;

/// Sums since the last reset. A "direction" is one contactor's warp or weft in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counters {
    /// Ticks.
    pub ticks: u64,
    /// Contactors on a textile.
    pub contactors_inside: u64,
    /// Contactors left out because no textile lies under them.
    pub contactors_outside: u64,
    /// Directions whose powers were evaluated or looked up.
    pub directions_evaluated: u64,
    /// Directions that repeat another of the same tick: same spectra, point and speed.
    pub(crate) directions_repeated: u64,
    /// Directions left out because they move at less than 0.01 mm/s.
    pub(crate) directions_at_rest: u64,
    /// Directions left out because they move at 1000/0.23 mm/s or faster.
    pub directions_over_speed: u64,
    /// Bins summed, both bands counted.
    pub bins_evaluated: u64,
    /// Nodes of an areal textile's tables that were made because a tick first needed them.
    pub nodes_made: u64,
    /// Bins left out because they sound at or above 1 kHz, both bands counted.
    pub(crate) bins_above_1_khz: u64,
    /// Bins left out because the filter lets less than its floor through.
    pub bins_below_floor: u64,
    /// Displays that stayed silent for a tick because they rest where they rested before.
    pub(crate) displays_standing: u64,
    /// Angles whose sine and cosine were at hand.
    pub(crate) angles_repeated: u64,
    /// Textiles left out for a display and a tick because none of its contactors reaches them.
    pub(crate) textiles_out_of_reach: u64,
    /// Contactors not asked whether they lie on a textile because their whole display does.
    pub(crate) touches_covered: u64,
    /// Contactors not evaluated on a textile within reach because they lie beside it.
    pub(crate) touches_outside: u64,
    /// Contactors not evaluated on a textile because they lie on another above.
    pub(crate) touches_beneath: u64,
    /// Speeds that were looked up for another contactor of the same tick.
    pub(crate) speeds_repeated: u64,
    /// Displays left silent for a tick because their pose held NaN or infinity.
    pub poses_not_finite: u64,
    /// Displays left silent for a tick because no pose was given.
    pub(crate) poses_missing: u64,
}

impl Counters {
    /// Counts `n` directions of one component that is not felt.
    pub(crate) fn left_out(&mut self, component: super::Component, n: u64) {
        match component {
            super::Component::AtRest => self.directions_at_rest += n,
            super::Component::TooFast => self.directions_over_speed += n,
            super::Component::Felt { .. } => {}
        }
    }
}
