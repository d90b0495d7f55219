//! Two intervals and a third that is one of them (ABX), and two that are the same or different.

use super::choice::{Choice, Correction, inverted};
use crate::distribution::{normal_lower, normal_quantile};
use crate::{Computed, Interval, undefined};

/// The largest d′ that a share is turned into.
const MOST: f64 = 30.0;

/// The share of correct matches at a distance d′ by independent looks at all three (Macmillan &
/// Creelman 2005, equation 9.5): Φ(d′/√2) Φ(d′/2) + Φ(−d′/√2) Φ(−d′/2).
pub(crate) fn abx_share(d_prime: f64) -> f64 {
    let (between, within) = (d_prime / 2.0_f64.sqrt(), d_prime / 2.0);
    normal_lower(between) * normal_lower(within) + normal_lower(-between) * normal_lower(-within)
}

impl Choice {
    /// d′ of one subject who calls pairs different whose sensations lie farther apart than a
    /// criterion k (Macmillan & Creelman 2005, chapter 9): F = 2 Φ(−k/√2), H = Φ((d′ − k)/√2) +
    /// Φ((−d′ − k)/√2).
    ///
    /// `hits` are different pairs called different and how many there were, `false_alarms` likewise
    /// of same ones. Both rates are corrected log-linearly; the interval follows from Wilson's of
    /// the hits, the criterion as it was found.
    ///
    /// # Errors
    /// No pairs of one kind, or more called different than there were.
    pub fn of_same_different(hits: [u64; 2], false_alarms: [u64; 2]) -> Computed<Self> {
        let ends = Interval::wilson(hits[0], hits[1], 0.95)?;
        Interval::wilson(false_alarms[0], false_alarms[1], 0.95)?;
        let correction = Correction::LogLinear;
        let [h, f] = [hits, false_alarms].map(|[count, n]| correction.share(count, n));
        let root = 2.0_f64.sqrt();
        let criterion = -root * normal_quantile(0.5 * f)?;
        let share =
            |d: f64| normal_lower((d - criterion) / root) + normal_lower((-d - criterion) / root);
        let d_prime_of = |rate: f64| {
            if rate <= share(0.0) {
                0.0
            } else {
                inverted(share, rate.min(1.0 - 1e-9), [0.0, MOST])
            }
        };
        let d_prime = d_prime_of(h);
        let step = 1e-4;
        let slope = (share(d_prime + step) - share(d_prime - step)) / (2.0 * step);
        let se = (h * (1.0 - h) / hits[1] as f64).sqrt() / slope;
        Ok(Self {
            share: h,
            correction: Some(correction),
            d_prime,
            is_below_chance: h < f,
            se: if slope > 1e-6 {
                Ok(se)
            } else {
                undefined("the share hardly changes with d′ here")
            },
            interval: Ok(ends.map(d_prime_of)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detection::Relation;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn matches_of_a_simulated_observer_are_as_many_as_the_share_says() {
        assert!((abx_share(0.0) - 0.5).abs() < 1e-15);
        let mut random = Random::new(3);
        for d in [0.7, 1.5, 3.0] {
            let n = 60_000_u64;
            let is_right = |_: &u64| {
                let (a, b, x) = (random.normal(), d + random.normal(), d + random.normal());
                // Whether B is the upper one, and whether X is.
                (b > a) == (x > d / 2.0)
            };
            let n_right = (0..n).filter(is_right).count() as u64;
            let found = n_right as f64 / n as f64;
            assert!((found - abx_share(d)).abs() < 0.007, "{d}: {found}");
            let back = Relation::Abx
                .choice(n_right, n, Correction::LogLinear)
                .unwrap();
            assert!((back.d_prime - d).abs() < 0.06, "{d}: {back:?}");
        }
        assert_eq!(
            Relation::Abx
                .choice(3, 10, Correction::LogLinear)
                .unwrap()
                .d_prime,
            0.0
        );
        assert!(Relation::Abx.choice(0, 0, Correction::LogLinear).is_err());
    }

    #[test]
    fn pairs_of_a_simulated_observer_lead_back_to_its_distance() {
        let mut random = Random::new(4);
        for (d, criterion) in [(1.0, 1.0), (2.0, 1.5), (3.0, 2.0)] {
            let n = 40_000_u64;
            let mut called = |apart: f64| {
                let is_called =
                    |_: &u64| (apart + random.normal() - random.normal()).abs() > criterion;
                (0..n).filter(is_called).count() as u64
            };
            let (hits, false_alarms) = (called(d), called(0.0));
            let found = Choice::of_same_different([hits, n], [false_alarms, n]).unwrap();
            assert!((found.d_prime - d).abs() < 0.08, "{d}: {found:?}");
            let interval = found.interval.unwrap();
            assert!(interval.low < found.d_prime && found.d_prime < interval.high);
        }
        assert_eq!(
            Choice::of_same_different([2, 10], [8, 10]).unwrap().d_prime,
            0.0
        );
        assert!(
            Choice::of_same_different([0, 0], [1, 10]).is_err(),
            "no different pairs"
        );
    }
}
