//! Many comparisons at once.

use crate::{Computed, Outcome, paired_t, undefined};

/// Two conditions compared within subjects.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Numbers of the conditions.
    pub conditions: [usize; 2],
    /// The paired t test of the first less the second.
    pub outcome: Computed<Outcome>,
    /// Its p adjusted by Holm for all comparisons that could be computed.
    pub p_holm: Computed,
}

impl Comparison {
    /// Every condition against every other by paired t tests, one list of values a condition,
    /// subjects in the same order in each.
    ///
    /// # Errors
    /// Fewer than two conditions. A pair that cannot be computed says so itself.
    pub fn every_pair(conditions: &[Vec<f64>]) -> Computed<Vec<Self>> {
        let k = conditions.len();
        if k < 2 {
            return undefined(format!("{k} conditions make no pair"));
        }
        let pairs = (0..k).flat_map(|i| (i + 1..k).map(move |j| [i, j]));
        let compared = |[i, j]: [usize; 2]| {
            let outcome = paired_t(&conditions[i], &conditions[j]);
            Self {
                conditions: [i, j],
                p_holm: outcome.as_ref().map(|o| o.p).map_err(Clone::clone),
                outcome,
            }
        };
        let mut comparisons: Vec<Self> = pairs.map(compared).collect();
        let mut p: Vec<&mut f64> = comparisons
            .iter_mut()
            .filter_map(|c| c.p_holm.as_mut().ok())
            .collect();
        let adjusted = holm(&p.iter().map(|p| **p).collect::<Vec<f64>>());
        for (p, adjusted) in p.iter_mut().zip(adjusted) {
            **p = adjusted;
        }
        Ok(comparisons)
    }
}

/// p values adjusted for their number by Holm's method (1979), in the order given: the j-th
/// smallest times m − j + 1, none below the one before it, none above 1.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![0.0; p.len()];
    let mut least: f64 = 0.0;
    for (place, &which) in order.iter().enumerate() {
        least = least.max((p.len() - place) as f64 * p[which]).min(1.0);
        adjusted[which] = least;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_that_can_be_computed_are_adjusted_for_each_other() -> Computed<()> {
        let first = vec![1.0, 2.0, 4.0, 3.0];
        let shifted: Vec<f64> = first.iter().map(|v| v + 1.0).collect();
        let other = vec![5.0, 9.0, 6.0, 9.5];
        let found = Comparison::every_pair(&[first.clone(), shifted, other.clone()])?;
        let [constant, larger, _] = found.as_slice() else {
            return undefined("three pairs");
        };
        assert!(constant.p_holm.is_err(), "a difference without spread");
        assert_eq!(larger.conditions, [0, 2]);
        let p = paired_t(&first, &other)?.p;
        assert_eq!(larger.p_holm, Ok(2.0 * p), "two could be computed");
        assert!(Comparison::every_pair(&[first]).is_err(), "one alone");
        Ok(())
    }

    #[test]
    fn the_smallest_is_multiplied_most_and_order_is_kept() {
        assert_eq!(holm(&[0.5, 0.125, 0.03125]), [0.5, 0.25, 0.09375]);
        assert_eq!(holm(&[0.4, 0.25, 0.3]), [0.75, 0.75, 0.75], "never below");
        assert_eq!(holm(&[0.9, 0.6]), [1.0, 1.0], "never above one");
        assert!(holm(&[]).is_empty(), "nothing to adjust");
    }
}
