//! The shapes of psychometric functions: how the share of answers rises with the stimulus.

use crate::distribution::{normal_lower, normal_quantile, normal_upper};
use crate::{Computed, undefined};
use selvedge_foundation::named;

named! {
    /// The shape F, which rises from 0 to 1: ½ at the threshold, 5 % and 95 % a width apart.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Family {
        /// 1/(1 + e⁻ᶻ).
        #[default]
        Logistic = "logistic",
        /// The cumulative Gaussian.
        Normal = "normal",
        /// 1 − exp(−eᶻ) over the logarithm of the stimulus, which must be above zero. Its width is
        /// a difference of natural logarithms.
        Weibull = "Weibull",
        /// 1 − exp(−eᶻ) over the stimulus as it is: the Weibull function of a stimulus in decibels.
        Gumbel = "Gumbel",
    }
    /// Its name in a table.
    pub fn name;
}

/// ln 19: the logit of 95 %.
const LOGIT: f64 = 2.944_438_979_166_440_3;
/// The z of 95 %.
const PROBIT: f64 = 1.644_853_626_951_472_2;
/// ln(−ln 0.05) and −ln(−ln 0.95): the two ends of the Gumbel function.
const GUMBEL: [f64; 2] = [1.097_188_700_364_948_7, 2.970_195_249_042_164_6];
/// ln(ln 2): its middle.
const GUMBEL_MIDDLE: f64 = -0.366_512_920_581_664_35;

impl Family {
    /// Where a stimulus lies on the scale on which widths are measured.
    pub fn place(self, x: f64) -> f64 {
        match self {
            Self::Weibull => x.ln(),
            _ => x,
        }
    }

    /// The stimulus at a place.
    pub(super) fn stimulus(self, place: f64) -> f64 {
        match self {
            Self::Weibull => place.exp(),
            _ => place,
        }
    }

    /// F and 1 − F, `z` widths above the threshold; each keeps its digits where it is small.
    pub fn shares(self, z: f64) -> [f64; 2] {
        match self {
            Self::Logistic => {
                let tail = (-(2.0 * LOGIT * z).abs()).exp();
                let [small, large] = [tail / (1.0 + tail), 1.0 / (1.0 + tail)];
                if z < 0.0 {
                    [small, large]
                } else {
                    [large, small]
                }
            }
            Self::Normal => {
                let z = 2.0 * PROBIT * z;
                [normal_lower(z), normal_upper(z)]
            }
            Self::Weibull | Self::Gumbel => {
                let hazard = ((GUMBEL[0] + GUMBEL[1]) * z + GUMBEL_MIDDLE).exp();
                [-(-hazard).exp_m1(), (-hazard).exp()]
            }
        }
    }

    /// How many widths above the threshold F is `share`.
    pub(super) fn widths_at(self, share: f64) -> Computed {
        if !(share > 0.0 && share < 1.0) {
            return undefined(format!("a share of {share} is reached nowhere"));
        }
        Ok(match self {
            Self::Logistic => (share / (1.0 - share)).ln() / (2.0 * LOGIT),
            Self::Normal => normal_quantile(share)? / (2.0 * PROBIT),
            Self::Weibull | Self::Gumbel => {
                ((-(-share).ln_1p()).ln() - GUMBEL_MIDDLE) / (GUMBEL[0] + GUMBEL[1])
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_family_is_half_at_its_threshold_and_a_width_apart_at_five_percent() -> Computed<()> {
        for family in Family::ALL {
            assert!((family.shares(0.0)[0] - 0.5).abs() < 1e-14, "{family:?}");
            let apart = family.widths_at(0.95)? - family.widths_at(0.05)?;
            assert!((apart - 1.0).abs() < 1e-14, "{family:?}: {apart}");
        }
        Ok(())
    }

    #[test]
    fn inverses_lead_back_and_tails_add_up() -> Computed<()> {
        for family in Family::ALL {
            for share in [1e-9, 0.05, 0.25, 0.5, 0.75, 0.99] {
                let [low, high] = family.shares(family.widths_at(share)?);
                assert!((low / share - 1.0).abs() < 1e-12, "{family:?} {share}");
                assert!((low + high - 1.0).abs() < 1e-15, "{family:?} {share}");
            }
            let [low, high] = family.shares(-60.0);
            assert!(low < 1e-70 && high == 1.0, "{family:?}: {low}, {high}");
            assert!(
                family.widths_at(1.0).is_err() && family.widths_at(0.0).is_err(),
                "open"
            );
        }
        Ok(())
    }

    #[test]
    fn weibull_is_gumbel_of_the_logarithm() {
        let x: f64 = 3.7;
        assert_eq!(Family::Weibull.place(x), x.ln());
        assert!((Family::Weibull.stimulus(x.ln()) - x).abs() < 1e-14, "back");
        assert_eq!(Family::Weibull.shares(0.3), Family::Gumbel.shares(0.3));
    }
}
