//! How a return stroke is stored whose places rise: told by the cloth, which is the same both ways.
//!
//! Both readings are laid over the way out and shifted against it by up to 2 mm (the stage has
//! play). The better one is taken if it correlates well and leaves clearly less unexplained than
//! the other; textile that looks alike both ways, such as a pure sine, does not tell.

use super::ReturnOrder;
use selvedge_foundation::numerics::to_index;

/// How far the way back may be shifted against the way out, mm.
const MAX_PLAY_MM: f64 = 2.0;
/// What the better reading must reach.
const GOOD: f64 = 0.5;
/// What it may leave unexplained, as a share of what the other does.
const BETTER: f64 = 0.6;
/// What the other must leave unexplained at least.
const ALIKE: f64 = 0.02;
/// More samples than this are thinned before they are compared.
const MAX_SAMPLES: usize = 6000;

/// The order of `back`, rows as stored, given the way out; heights without tilt, `step_mm` apart.
pub(super) fn order_of(forward: &[f64], back: &[f64], step_mm: f64) -> Option<ReturnOrder> {
    let every = forward.len().max(back.len()).div_ceil(MAX_SAMPLES).max(1);
    let thin = |heights: &mut dyn Iterator<Item = &f64>| {
        heights.step_by(every).copied().collect::<Vec<f64>>()
    };
    let forward = thin(&mut forward.iter());
    let by_place = thin(&mut back.iter());
    let by_travel = thin(&mut back.iter().rev());
    let max_lag = to_index(MAX_PLAY_MM / (step_mm * every as f64));
    let [mirrored, travel] =
        [&by_place, &by_travel].map(|back| best_correlation(&forward, back, max_lag));
    let (best, other) = (mirrored.max(travel), mirrored.min(travel));
    let is_clear = 1.0 - other >= ALIKE && 1.0 - best <= BETTER * (1.0 - other);
    if best < GOOD || !is_clear {
        return None;
    }
    Some(if mirrored > travel {
        ReturnOrder::Mirrored
    } else {
        ReturnOrder::Travel
    })
}

/// The largest correlation over lags; 0 where the overlap is less than half.
fn best_correlation(one: &[f64], other: &[f64], max_lag: usize) -> f64 {
    let mut best = 0.0_f64;
    for lag in 0..=max_lag.min(one.len() / 2) {
        best = best.max(correlation(&one[lag..], other));
        best = best.max(correlation(one, other.get(lag..).unwrap_or(&[])));
    }
    best
}

fn correlation(one: &[f64], other: &[f64]) -> f64 {
    let n = one.len().min(other.len()) as f64;
    if n < 2.0 {
        return 0.0;
    }
    let pairs = || one.iter().zip(other);
    let (sum_a, sum_b) = pairs().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
    let (mean_a, mean_b) = (sum_a / n, sum_b / n);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in pairs() {
        let (a, b) = (x - mean_a, y - mean_b);
        ab += a * b;
        aa += a * a;
        bb += b * b;
    }
    if aa > 0.0 && bb > 0.0 {
        ab / (aa * bb).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    fn cloth(n: usize) -> Vec<f64> {
        let mut random = Random::new(3);
        let mut height = 0.0;
        let mut next = || {
            height = 0.95 * height + random.normal();
            height
        };
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn the_cloth_tells_how_a_return_stroke_is_stored() {
        let cloth = cloth(3000);
        let forward = &cloth[..2900];
        let shifted = &cloth[60..2960];
        let travel: Vec<f64> = shifted.iter().rev().map(|z| 0.9 * z + 1.0).collect();
        assert_eq!(
            order_of(forward, shifted, 0.01),
            Some(ReturnOrder::Mirrored)
        );
        assert_eq!(order_of(forward, &travel, 0.01), Some(ReturnOrder::Travel));
    }

    #[test]
    fn cloth_that_looks_alike_both_ways_does_not_tell() {
        let sine: Vec<f64> = (0..3000).map(|i| (f64::from(i) * 0.06).sin()).collect();
        assert_eq!(order_of(&sine, &sine, 0.01), None);
        assert_eq!(order_of(&cloth(2000), &[0.0; 2000], 0.01), None);
        assert_eq!(order_of(&[], &[], 0.01), None);
    }
}
