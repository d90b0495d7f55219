//! How a contactor moves along the two axes of a textile, and whether it can be felt.

use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::{MAX_SPEED_MM_PER_S, MIN_SPEED_MM_PER_S};

/// A velocity component along warp or weft, as rendering takes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Component {
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
    pub(crate) fn of(component_mm_per_s: f64) -> Self {
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
}

/// One of the two axes of a textile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    Warp,
    Weft,
}

impl Axis {
    pub(crate) const BOTH: [Self; 2] = [Self::Warp, Self::Weft];

    /// The direction of a stroke along the axis.
    pub(crate) fn direction(self, is_reverse: bool) -> Direction {
        match (self, is_reverse) {
            (Self::Warp, false) => Direction::WarpForward,
            (Self::Warp, true) => Direction::WarpReverse,
            (Self::Weft, false) => Direction::WeftForward,
            (Self::Weft, true) => Direction::WeftReverse,
        }
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
