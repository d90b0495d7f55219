//! The reference: f64, every bin, no shortcut. Every other method is measured against it.

use std::sync::Arc;

use crate::plan::{Axis, Contacts, Counters, Feel, ScenePlan};
use selvedge_textile::surface::{BIN_SPACING_PER_MM, LocalSpectra};
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ};

/// Sums every bin of every contactor anew.
#[derive(Debug, Clone)]
pub(super) struct ReferenceEvaluator {
    filters: Filters,
    pool: Vec<Arc<LocalSpectra>>,
}

impl ReferenceEvaluator {
    pub(super) fn prepare(plan: &ScenePlan, filters: &Filters) -> Self {
        Self {
            filters: *filters,
            pool: plan.pool.clone(),
        }
    }

    /// Amplitudes of the contactors on one textile, µm.
    pub(super) fn evaluate(
        &self,
        plan: &ScenePlan,
        contacts: &Contacts<'_>,
        factors: [f64; 2],
        amplitudes_um: &mut [[f64; 2]],
        counters: &mut Counters,
    ) {
        let sums_of = |_, feel: Feel, counters: &mut Counters| {
            let powers_um2 = self.pool[feel.spectra].powers_um2(feel.point);
            let (sums, n_audible) = band_sums(powers_um2, feel.speed_mm_per_s, &self.filters);
            counters.directions_evaluated += 1;
            counters.bins_evaluated += 2 * n_audible as u64;
            let n_above = 2 * (powers_um2.len() - n_audible) as u64;
            counters.bins_above_1_khz += n_above;
            sums
        };
        evaluate_each((plan, contacts), factors, amplitudes_um, counters, sums_of);
    }
}

/// Gives every contactor on one textile its amplitudes in µm, from the band sums that `sums_of`
/// finds along each axis that it moves along.
pub(super) fn evaluate_each(
    (plan, contacts): (&ScenePlan, &Contacts<'_>),
    factors: [f64; 2],
    amplitudes_um: &mut [[f64; 2]],
    counters: &mut Counters,
    mut sums_of: impl FnMut(Axis, Feel, &mut Counters) -> [f64; 2],
) {
    let textile = &plan.textiles[contacts.textile];
    contacts.for_each_owned(amplitudes_um, |contactor, amplitudes| {
        let mut sums = [0.0; 2];
        for axis in Axis::BOTH {
            if let Some(feel) = contacts.feel(textile, axis, contactor, counters) {
                let own = sums_of(axis, feel, counters);
                (0..2).for_each(|b| sums[b] += own[b]);
            }
        }
        *amplitudes = amplitudes_of(sums, factors);
    });
}

/// `A_b = √(2 Σ)·g_b`.
#[inline]
pub(super) fn amplitudes_of(sums: [f64; 2], factors: [f64; 2]) -> [f64; 2] {
    [
        (2.0 * sums[0]).sqrt() * factors[0],
        (2.0 * sums[1]).sqrt() * factors[1],
    ]
}

/// Where bin k sounds at a speed, Hz.
#[inline]
pub(super) fn bin_frequency_hz(speed_mm_per_s: f64, k: usize) -> f64 {
    speed_mm_per_s * BIN_SPACING_PER_MM * k as f64
}

/// `Σ_k P_k H_b(f_k)²` over the bins that sound below 1 kHz, and how many do.
fn band_sums(powers_um2: &[f64], speed_mm_per_s: f64, filters: &Filters) -> ([f64; 2], usize) {
    let mut sums = [0.0; 2];
    let mut n_audible = 0;
    for (k, power) in (1..).zip(powers_um2) {
        let frequency_hz = bin_frequency_hz(speed_mm_per_s, k);
        if frequency_hz < MAX_FREQUENCY_HZ {
            n_audible += 1;
            for band in Band::ALL {
                sums[band.index()] += power * filters.power_gain(band, frequency_hz);
            }
        }
    }
    (sums, n_audible)
}
