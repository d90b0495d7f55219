//! A psychometric function: the probability of an answer at a stimulus.

use super::Family;
use crate::{Computed, Undefined, undefined};

/// p(x) = g + (1 − g − l) F(x; m, w) (Wichmann & Hill 2001; Schütt et al. 2016).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Psychometric {
    /// The shape F.
    pub family: Family,
    /// m: the stimulus at which F is ½.
    pub threshold: f64,
    /// w: how far 5 % and 95 % of F lie apart; of Weibull in natural logarithms of the stimulus.
    pub width: f64,
    /// g: probability of the answer without any sensation, 1/m of m alternatives.
    pub guess: f64,
    /// l: probability to miss however strong the stimulus.
    pub lapse: f64,
}

impl Psychometric {
    /// The same, checked.
    ///
    /// # Errors
    /// A width that is not above 0, a threshold that is not finite (of Weibull: not above 0), a
    /// guess rate or lapse rate outside 0…1 or both together no less than 1.
    pub fn checked(self) -> Computed<Self> {
        let is_placed = self.family.place(self.threshold).is_finite();
        let is_wide = self.width > 0.0 && self.width.is_finite();
        if !(is_placed && is_wide) {
            return undefined(format!(
                "no {} function has threshold {} and width {}",
                self.family.name(),
                self.threshold,
                self.width
            ));
        }
        let is_rated = self.guess >= 0.0 && self.lapse >= 0.0 && self.guess + self.lapse < 1.0;
        is_rated.then_some(self).ok_or_else(|| {
            let reason = format!("guess rate {} with lapse rate {}", self.guess, self.lapse);
            Undefined::because(reason)
        })
    }

    /// p and 1 − p at a stimulus. Of Weibull, at 0 and below, as at nothing.
    pub(crate) fn probabilities(&self, x: f64) -> [f64; 2] {
        let place = self.family.place(x);
        self.at_place(if place.is_nan() {
            f64::NEG_INFINITY
        } else {
            place
        })
    }

    /// p and 1 − p at a place on the family's scale.
    pub fn at_place(&self, place: f64) -> [f64; 2] {
        let z = (place - self.family.place(self.threshold)) / self.width;
        scaled(self.family.shares(z), self.guess, self.lapse)
    }

    /// p at a stimulus.
    pub fn at(&self, x: f64) -> f64 {
        self.probabilities(x)[0]
    }

    /// The stimulus at which p is `share`.
    ///
    /// # Errors
    /// A share that the function does not reach: it lies between g and 1 − l.
    pub fn stimulus_at(&self, share: f64) -> Computed {
        let of_shape = (share - self.guess) / (1.0 - self.guess - self.lapse);
        self.stimulus_at_shape(of_shape).map_err(|_not_reached| {
            let top = 1.0 - self.lapse;
            let reason = format!("{share} is not between {} and {top}", self.guess);
            Undefined::because(reason)
        })
    }

    /// The stimulus at which F, freed of guesses and lapses, is `share`.
    ///
    /// # Errors
    /// A share outside (0, 1).
    pub fn stimulus_at_shape(&self, share: f64) -> Computed {
        let widths = self.family.widths_at(share)?;
        let place = self.family.place(self.threshold) + self.width * widths;
        Ok(self.family.stimulus(place))
    }
}

/// F and 1 − F with guesses and lapses.
pub(crate) fn scaled([low, high]: [f64; 2], guess: f64, lapse: f64) -> [f64; 2] {
    let span = 1.0 - guess - lapse;
    [guess + span * low, lapse + span * high]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(family: Family) -> Psychometric {
        Psychometric {
            family,
            threshold: 4.0,
            width: 1.5,
            guess: 0.25,
            lapse: 0.02,
        }
    }

    #[test]
    fn the_stimulus_of_a_share_has_that_share_in_every_family() -> Computed<()> {
        for family in Family::ALL {
            let curve = curve(family).checked()?;
            for share in [0.26, 0.5, 0.75, 0.97] {
                let x = curve.stimulus_at(share)?;
                assert!((curve.at(x) - share).abs() < 1e-13, "{family:?} {share}");
            }
            assert!(
                (curve.stimulus_at_shape(0.5)? - 4.0).abs() < 1e-13,
                "{family:?}"
            );
        }
        Ok(())
    }

    #[test]
    fn what_is_no_function_or_out_of_its_reach_is_refused() {
        let good = curve(Family::Weibull);
        assert!(good.stimulus_at(0.2).is_err(), "below chance");
        assert!(good.stimulus_at(0.99).is_err(), "above what lapses leave");
        let bad = |width, threshold, guess| {
            let curve = Psychometric {
                threshold,
                width,
                guess,
                ..good
            };
            curve.checked().is_err()
        };
        assert!(
            bad(0.0, 1.0, 0.0) && bad(1.0, -1.0, 0.0) && bad(1.0, 1.0, 0.99),
            "checked"
        );
        assert_eq!(good.at(0.0), 0.25);
        assert_eq!(good.at(-3.0), 0.25);
    }
}
