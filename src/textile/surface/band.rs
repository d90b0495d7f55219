//! The official band of the Kawabata surface tester: what repeats within 1 mm.
//!
//! The tester's circuit takes off what changes more slowly than 1 Hz at 1 mm/s. Its order is not
//! published in what we could read, so this is the Gaussian profile filter of ISO 16610-21 with a
//! cut-off of 1 mm, which passes half the amplitude there and shifts no phase.

use std::f64::consts::{LN_2, PI};

/// Waves longer than this are taken off, mm.
pub(crate) const OFFICIAL_CUT_OFF_MM: f64 = 1.0;

/// Values `step_mm` apart less their Gaussian mean:
/// `v − s ∗ v`, `s(x) = exp(−π (x/αλ)²)/(αλ)`, `α = √(ln 2/π)`, λ = 1 mm.
///
/// The weights reach λ to either side; at the ends those that are there are made to sum to one.
pub(crate) fn without_long_waves(step_mm: f64, values: &[f64]) -> Vec<f64> {
    let width_mm = OFFICIAL_CUT_OFF_MM * (LN_2 / PI).sqrt();
    let weight = |i: usize| (-PI * (i as f64 * step_mm / width_mm).powi(2)).exp();
    let n_values = values.len();
    let weights: Vec<f64> = (0..n_values)
        .take_while(|i| *i as f64 * step_mm <= OFFICIAL_CUT_OFF_MM)
        .map(weight)
        .collect();
    let around = |i: usize| {
        let (first, last) = (
            (i + 1).saturating_sub(weights.len()),
            (i + weights.len()).min(n_values),
        );
        let (mut sum, mut total) = (0.0, 0.0);
        for (j, value) in values[first..last].iter().enumerate() {
            let weight = weights[(first + j).abs_diff(i)];
            sum += weight * value;
            total += weight;
        }
        values[i] - sum / total
    };
    (0..n_values).map(around).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// The amplitude that is left of a wave of this length and amplitude 1, away from the ends.
    fn left_of(wavelength_mm: f64) -> f64 {
        let wave: Vec<f64> = (0..4000)
            .map(|i| (TAU * f64::from(i) * 0.01 / wavelength_mm).sin())
            .collect();
        let left = without_long_waves(0.01, &wave);
        left[1000..3000]
            .iter()
            .fold(0.0_f64, |max, value| max.max(value.abs()))
    }

    #[test]
    fn half_is_left_at_the_cut_off() {
        assert!((left_of(1.0) - 0.5).abs() < 0.005, "{}", left_of(1.0));
        assert!(left_of(0.4) > 0.98, "{}", left_of(0.4));
        assert!(left_of(10.0) < 0.01, "{}", left_of(10.0));
    }

    #[test]
    fn what_is_flat_is_gone_to_the_ends() {
        let left = without_long_waves(0.1, &[4.0; 30]);
        assert!(left.iter().all(|value| value.abs() < 1e-12), "{left:?}");
        assert!(
            without_long_waves(0.1, &[]).is_empty(),
            "nothing stays nothing"
        );
    }
}
