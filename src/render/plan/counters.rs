//! What ticks evaluated, and what each saving left out.

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
    /// Nodes of tables, point by point, that were made because a tick first needed them.
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

/// The savings from the coarsest to the finest, a row each: variant, name in tables, what its
/// counter counts, the counter, and what it leaves out in one sentence.
macro_rules! rules {
    ($($rule:ident $name:literal, $unit:literal $counter:ident: $what:literal;)+) => {
        /// A saving.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Rule {
            $(#[doc = $what] $rule,)+
        }

        impl Rule {
            /// All, from the coarsest to the finest.
            pub const ALL: [Self; 12] = [$(Self::$rule),+];

            /// Its name in tables.
            pub fn name(self) -> &'static str {
                match self { $(Self::$rule => $name),+ }
            }

            /// What it leaves out, one sentence.
            pub fn what(self) -> &'static str {
                match self { $(Self::$rule => $what),+ }
            }

            /// What its counter counts.
            pub fn unit(self) -> &'static str {
                match self { $(Self::$rule => $unit),+ }
            }

            /// How much it left out.
            pub fn left_out(self, counters: &Counters) -> u64 {
                match self { $(Self::$rule => counters.$counter),+ }
            }
        }
    };
}

rules! {
    Standing "standing", "displays" displays_standing:
        "A display that rests where it rested one tick before stays silent as it is.";
    SameAngle "same angle", "angles" angles_repeated:
        "Sine and cosine are taken only of an angle that changed.";
    OutOfReach "out of reach", "textiles" textiles_out_of_reach:
        "No contactor is placed on a textile whose rectangle the display cannot reach.";
    Covered "covered", "tests of a place" touches_covered:
        "A display that lies wholly on a textile is not asked contactor by contactor.";
    Outside "outside", "touches" touches_outside:
        "A contactor that is off a textile is not evaluated against it.";
    Beneath "beneath", "touches" touches_beneath:
        "A contactor that lies on a textile feels none of those beneath.";
    AtRest "at rest", "directions" directions_at_rest:
        "A direction that moves at less than 0.01 mm/s is not evaluated.";
    TooFast "too fast", "directions" directions_over_speed:
        "A direction so fast that every bin sounds at 1 kHz or above is not evaluated.";
    AboveBand "above the band", "bins" bins_above_1_khz:
        "A bin that sounds at 1 kHz or above is not summed.";
    BelowFloor "below the floor", "bins" bins_below_floor:
        "A bin that the filter lets less than its floor through is not summed (banded).";
    SamePoint "same point", "directions" directions_repeated:
        "The same spectra, point and speed are evaluated once in a tick (banded), or once for all \
         contactors of a velocity (table).";
    SameSpeed "same speed", "speeds" speeds_repeated:
        "A speed's filter gains (banded), or its place in the tables (table), are found once for \
         all contactors that share it.";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_saving_is_told_apart_by_its_name_and_its_counter() {
        let counters = Counters {
            displays_standing: 1,
            angles_repeated: 2,
            textiles_out_of_reach: 3,
            touches_covered: 4,
            touches_outside: 5,
            touches_beneath: 6,
            directions_at_rest: 7,
            directions_over_speed: 8,
            bins_above_1_khz: 9,
            bins_below_floor: 10,
            directions_repeated: 11,
            speeds_repeated: 12,
            ..Counters::default()
        };
        for (number, rule) in (1..).zip(Rule::ALL) {
            assert_eq!(rule.left_out(&counters), number, "{}", rule.name());
            assert!(rule.what().ends_with(['.', ')']), "{}", rule.what());
            let others = Rule::ALL.into_iter().filter(|other| *other != rule);
            assert!(others.into_iter().all(|other| other.name() != rule.name()));
        }
    }
}
