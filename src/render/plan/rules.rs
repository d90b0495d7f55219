//! The savings of a tick by name: what each leaves out, what that does to amplitudes, and switches.
//!
//! Every saving may be switched off: then what it leaves out is done, and its result thrown away.
//! That is how a report shows what a saving saves, and that it changes no amplitude.

use super::{Component, Counters};

/// A saving.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Displays at rest where they stood the tick before.
    Standing,
    /// Sine and cosine of an angle that did not change.
    SameAngle,
    /// Textiles whose rectangle no contactor can reach.
    OutOfReach,
    /// Contactors of a display that lies wholly on a textile.
    Covered,
    /// Contactors off a textile.
    Outside,
    /// Contactors already on a textile above.
    Beneath,
    /// Components below 0.01 mm/s.
    AtRest,
    /// Components at which every bin sounds at or above 1 kHz.
    TooFast,
    /// Bins at or above 1 kHz.
    AboveBand,
    /// Bins below a filter's floor.
    BelowFloor,
    /// Points evaluated already in this tick.
    SamePoint,
    /// Speeds looked up already in this tick.
    SameSpeed,
}

impl Rule {
    /// All, from the coarsest to the finest.
    pub const ALL: [Self; 12] = [
        Self::Standing,
        Self::SameAngle,
        Self::OutOfReach,
        Self::Covered,
        Self::Outside,
        Self::Beneath,
        Self::AtRest,
        Self::TooFast,
        Self::AboveBand,
        Self::BelowFloor,
        Self::SamePoint,
        Self::SameSpeed,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standing => "standing",
            Self::SameAngle => "same angle",
            Self::OutOfReach => "out of reach",
            Self::Covered => "covered",
            Self::Outside => "outside",
            Self::Beneath => "beneath",
            Self::AtRest => "at rest",
            Self::TooFast => "too fast",
            Self::AboveBand => "above the band",
            Self::BelowFloor => "below the floor",
            Self::SamePoint => "same point",
            Self::SameSpeed => "same speed",
        }
    }

    /// What it leaves out, one sentence.
    pub fn what(self) -> &'static str {
        match self {
            Self::Standing => {
                "A display that rests where it rested one tick before stays silent as it is."
            }
            Self::SameAngle => "Sine and cosine are taken only of an angle that changed.",
            Self::OutOfReach => {
                "No contactor is placed on a textile whose rectangle the display cannot reach."
            }
            Self::Covered => {
                "A display that lies wholly on a textile is not asked contactor by contactor."
            }
            Self::Outside => "A contactor that is off a textile is not evaluated against it.",
            Self::Beneath => "A contactor that lies on a textile feels none of those beneath.",
            Self::AtRest => "A direction that moves at less than 0.01 mm/s is not evaluated.",
            Self::TooFast => {
                "A direction so fast that every bin sounds at 1 kHz or above is not evaluated."
            }
            Self::AboveBand => "A bin that sounds at 1 kHz or above is not summed.",
            Self::BelowFloor => {
                "A bin that the filter lets less than its floor through is not summed (banded)."
            }
            Self::SamePoint => {
                "The same spectra, point and speed are evaluated once in a tick \
                 (banded), or once for all contactors of a velocity (table)."
            }
            Self::SameSpeed => {
                "A speed's filter gains (banded), or its place in the tables (table), are \
                 found once for all contactors that share it."
            }
        }
    }

    /// What its counter counts.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Standing => "displays",
            Self::SameAngle => "angles",
            Self::OutOfReach => "textiles",
            Self::Covered | Self::Outside | Self::Beneath => "touches",
            Self::AtRest | Self::TooFast | Self::SamePoint => "directions",
            Self::AboveBand | Self::BelowFloor => "bins",
            Self::SameSpeed => "speeds",
        }
    }

    /// Whether amplitudes are the same to the bit without it; if not, they differ by no more than
    /// the renderer's bound.
    pub fn is_exact(self) -> bool {
        self != Self::BelowFloor
    }

    /// How much it left out.
    pub fn left_out(self, counters: &Counters) -> u64 {
        match self {
            Self::Standing => counters.displays_standing,
            Self::SameAngle => counters.angles_repeated,
            Self::OutOfReach => counters.textiles_out_of_reach,
            Self::Covered => counters.touches_covered,
            Self::Outside => counters.touches_outside,
            Self::Beneath => counters.touches_beneath,
            Self::AtRest => counters.directions_at_rest,
            Self::TooFast => counters.directions_over_speed,
            Self::AboveBand => counters.bins_above_1_khz,
            Self::BelowFloor => counters.bins_below_floor,
            Self::SamePoint => counters.directions_repeated,
            Self::SameSpeed => counters.speeds_repeated,
        }
    }
}

/// Which savings are in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rules(u16);

impl Default for Rules {
    /// All of them.
    fn default() -> Self {
        Self::ALL
    }
}

impl Rules {
    /// Every saving.
    pub const ALL: Self = Self((1 << Rule::ALL.len()) - 1);
    /// None: everything is evaluated.
    pub const NONE: Self = Self(0);

    /// One saving alone.
    #[must_use]
    pub fn only(rule: Rule) -> Self {
        Self::NONE.with(rule)
    }

    /// These and one more.
    #[must_use]
    pub fn with(self, rule: Rule) -> Self {
        Self(self.0 | 1 << rule as u16)
    }

    /// These but for one.
    #[must_use]
    pub fn without(self, rule: Rule) -> Self {
        Self(self.0 & !(1 << rule as u16))
    }

    /// Whether a saving is in force.
    #[inline]
    #[must_use]
    pub fn has(self, rule: Rule) -> bool {
        self.0 >> rule as u16 & 1 == 1
    }

    /// Whether each contactor is evaluated on its own textile alone.
    pub(crate) fn skip_spare_touches(self) -> bool {
        self.has(Rule::Outside) && self.has(Rule::Beneath)
    }

    /// Whether a component that is not felt is left out.
    #[inline]
    pub(crate) fn leave_out(self, component: Component) -> bool {
        match component {
            Component::Felt { .. } => false,
            Component::AtRest => self.has(Rule::AtRest),
            Component::TooFast => self.has(Rule::TooFast),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn savings_are_switched_one_by_one() {
        for rule in Rule::ALL {
            assert!(Rules::default().has(rule) && !Rules::NONE.has(rule));
            for other in Rule::ALL {
                assert_eq!(Rules::only(rule).has(other), rule == other);
                assert_eq!(Rules::ALL.without(rule).has(other), rule != other);
            }
        }
        let one_by_one = Rule::ALL.into_iter().fold(Rules::NONE, Rules::with);
        assert_eq!(one_by_one, Rules::ALL);
    }

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
