//! The receiver operating characteristic from ratings of confidence.

use crate::distribution::normal_quantile;
use crate::{Computed, Interval, Undefined, undefined};

/// The curve and its area.
#[derive(Debug, Clone, PartialEq)]
pub struct Roc {
    /// Shares of others and of signals rated at least so high, from (0, 0) to (1, 1), the strictest
    /// criterion first.
    pub points: Vec<[f64; 2]>,
    /// Trials with the signal and without.
    pub n: [u64; 2],
    /// Area by trapezia: the probability that a signal is rated higher than another trial, ties
    /// counted half (Bamber 1975).
    pub area: f64,
    /// Its standard error (`DeLong` and others 1988).
    pub se: Computed,
    /// Area ± 1.96 SE, cut at 0 and 1.
    pub interval: Computed<Interval>,
    /// √2 z(area): the d′ of equal normal distributions with this area.
    pub d_a: Computed,
}

impl Roc {
    /// From how often each rating was given, `sure it is not` first, to signals and to other
    /// trials.
    ///
    /// # Errors
    /// Fewer than two ratings, lists of different lengths, no trials of one kind.
    pub fn of(signals: &[u64], others: &[u64]) -> Computed<Self> {
        if signals.len() != others.len() || signals.len() < 2 {
            let (a, b) = (signals.len(), others.len());
            let reason = format!("{a} and {b} ratings: two or more of each are needed");
            return undefined(reason);
        }
        let n: [u64; 2] = [signals.iter().sum(), others.iter().sum()];
        if n.contains(&0) {
            let reason = format!("{} signals and {} other trials give no curve", n[0], n[1]);
            return undefined(reason);
        }
        let [n_signals, n_others] = n.map(|n| n as f64);
        // Of each rating: how much of the other kind lies below it, ties half.
        let (of_signals, of_others) = (shares_below(others), shares_below(signals));
        let area = weighted_mean(&of_signals, signals);
        let spread = |values: &[f64], counts: &[u64], mean: f64, n: f64| {
            let both = values.iter().zip(counts);
            let squares: f64 = both.map(|(v, &c)| c as f64 * (v - mean).powi(2)).sum();
            let is_enough = n > 1.0;
            is_enough
                .then(|| squares / (n - 1.0) / n)
                .ok_or_else(|| Undefined::because("one trial of a kind alone"))
        };
        let se = spread(&of_signals, signals, area, n_signals).and_then(|variance| {
            let variance = variance + spread(&of_others, others, 1.0 - area, n_others)?;
            let is_spread = variance > 0.0;
            is_spread
                .then(|| variance.sqrt())
                .ok_or_else(|| Undefined::because("ratings without overlap: no spread of the area"))
        });
        let level = 0.95;
        let z = normal_quantile(0.5 + 0.5 * level)?;
        let interval = se
            .clone()
            .map(|se| Interval::new([(area - z * se).max(0.0), (area + z * se).min(1.0)], level));
        let d_a = normal_quantile(area)
            .map(|z| std::f64::consts::SQRT_2 * z)
            .map_err(|_infinite| Undefined::because(format!("an area of {area} has no finite d′")));
        Ok(Self {
            points: points(signals, others, n),
            n,
            area,
            se,
            interval,
            d_a,
        })
    }
}

fn points(signals: &[u64], others: &[u64], n: [u64; 2]) -> Vec<[f64; 2]> {
    let mut counts = [0, 0];
    let mut points = Vec::with_capacity(signals.len() + 1);
    let mut push = |counts: [u64; 2]| {
        points.push([1, 0].map(|of| counts[of] as f64 / n[of] as f64));
    };
    push(counts);
    for (signal, other) in signals.iter().zip(others).rev() {
        counts = [counts[0] + signal, counts[1] + other];
        push(counts);
    }
    points
}

/// Of each rating, the share of all counts that lie below it, with half of those in it.
fn shares_below(counts: &[u64]) -> Vec<f64> {
    let n = counts.iter().sum::<u64>() as f64;
    let mut below = 0.0;
    let mut share = |&count: &u64| {
        let share = (below + 0.5 * count as f64) / n;
        below += count as f64;
        share
    };
    counts.iter().map(&mut share).collect()
}

fn weighted_mean(values: &[f64], counts: &[u64]) -> f64 {
    let sum: f64 = values.iter().zip(counts).map(|(v, &c)| v * c as f64).sum();
    sum / counts.iter().sum::<u64>() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Summary, normal_lower};
    use selvedge_foundation::numerics::Random;

    #[test]
    fn the_area_is_that_of_the_trapezia_and_of_all_pairs() -> Computed<()> {
        let (signals, others) = ([2, 3, 5, 10], [9, 5, 4, 2]);
        let found = Roc::of(&signals, &others)?;
        let trapezia: f64 = found
            .points
            .windows(2)
            .map(|w| {
                let width = w[1][0] - w[0][0];
                0.5 * width * (w[0][1] + w[1][1])
            })
            .sum();
        // Pairs won and half of those tied, of 20 × 20.
        let won = 3 * 9 + 5 * 14 + 10 * 18;
        let tied = 2 * 9 + 3 * 5 + 5 * 4 + 10 * 2;
        let pairs = (f64::from(won) + 0.5 * f64::from(tied)) / 400.0;
        assert!((found.area - trapezia).abs() < 1e-14, "{found:?}");
        assert!((found.area - pairs).abs() < 1e-14, "{found:?}");
        let last = found.points.last();
        assert_eq!(last, Some(&[1.0, 1.0]));
        Ok(())
    }

    #[test]
    fn area_and_error_are_those_of_simulated_subjects() -> Computed<()> {
        let mut random = Random::new(31);
        let d = 1.0;
        let mut rated = |mean: f64| {
            let mut counts = [0; 6];
            for _ in 0..60 {
                let felt = random.normal() + mean;
                let criteria = [-0.8, -0.1, 0.4, 1.0, 1.7];
                counts[criteria.iter().filter(|&&c| felt > c).count()] += 1;
            }
            counts
        };
        let (mut areas, mut stated) = (Vec::new(), 0.0);
        for _ in 0..1000 {
            let found = Roc::of(&rated(d), &rated(0.0))?;
            areas.push(found.area);
            stated += found.se?.powi(2) / 1000.0;
        }
        let summary = Summary::of(&areas)?;
        let smooth = normal_lower(d * std::f64::consts::FRAC_1_SQRT_2);
        // Five criteria cut the corners of the curve a little.
        assert!(
            summary.mean < smooth && smooth - summary.mean < 0.03,
            "{summary:?}"
        );
        assert!(
            (stated / summary.sd.powi(2) - 1.0).abs() < 0.15,
            "{stated} {summary:?}"
        );
        Ok(())
    }

    #[test]
    fn ratings_that_say_nothing_or_everything_are_told_apart() -> Computed<()> {
        let nothing = Roc::of(&[0, 20], &[0, 20])?;
        assert_eq!(nothing.area, 0.5);
        assert!(nothing.se.is_err(), "all answers equal");
        let everything = Roc::of(&[0, 20], &[20, 0])?;
        assert_eq!(everything.area, 1.0);
        assert!(
            everything.se.is_err() && everything.d_a.is_err(),
            "no overlap"
        );
        assert!(Roc::of(&[1, 2], &[0, 0]).is_err(), "one kind");
        assert!(Roc::of(&[1], &[1]).is_err(), "one rating");
        assert!(Roc::of(&[1, 2], &[1, 2, 3]).is_err(), "lengths");
        Ok(())
    }
}
