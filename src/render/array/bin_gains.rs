//! The power gains of both filters at every bin of a speed, without a logarithm and an exponential
//! for each.
//!
//! Bin k sounds at `f = s·k` with `s = 0.23·|v|`. For the log-Gaussian filter, with `w` half its
//! width in octaves and `x = log₂(s/b)`,
//! `H_b(f)² = 2^(−(x + log₂ k)²/w²) = 2^(−x²/w²) · k^σ · 2^((2·log₂ b·log₂ k − log₂² k)/w²)` with
//! `σ = −2·log₂ s/w²`: the first factor is one number a band, the last is known before any speed,
//! and a power of k is the product of those of its prime factors, so that only primes, of which
//! there are 95 among 500 bins, take an exponential.

use super::reference::bin_frequency_hz;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, N_BINS};
use selvedge_textile::tactile::{Band, Filters};

/// Narrower filters span too many powers of two for products: they are evaluated bin by bin, and
/// so are those of the receptors.
const NARROWEST_OCTAVES: f64 = 1.2;

/// Finds the power gains of a pair of filters, speed by speed.
#[derive(Debug, Clone)]
pub(super) struct BinGains {
    filters: Filters,
    products: Option<Box<Products>>,
}

/// What the products of a log-Gaussian filter are made from.
#[derive(Debug, Clone)]
struct Products {
    /// `1/w²`, 1/octave².
    per_octave2: f64,
    /// `2^((2·log₂ b·log₂ k − log₂² k)/w²)` of every bin and band.
    shapes: Vec<[f64; 2]>,
    /// Numbers k that are prime, rising, each with `log₂ k`.
    primes: Vec<(usize, f64)>,
    /// The other numbers above 1, rising, each with two factors.
    composites: Vec<(usize, [usize; 2])>,
    /// `k^σ` at the speed at hand, by k.
    powers: Vec<f64>,
}

impl BinGains {
    /// Within 2·10⁻¹³ of the filters' own power gains, where these are above 10⁻³³.
    pub(super) fn new(filters: &Filters) -> Self {
        let products = match filters {
            Filters::LogGaussian { octaves } if *octaves >= NARROWEST_OCTAVES => {
                Some(Box::new(Products::new(0.5 * octaves)))
            }
            Filters::LogGaussian { .. } | Filters::Receptor => None,
        };
        Self {
            filters: *filters,
            products,
        }
    }

    /// The filters' own power gains to the last bit.
    pub(super) fn exact(filters: &Filters) -> Self {
        Self {
            filters: *filters,
            products: None,
        }
    }

    /// Writes the gains of the bins k = 1, 2, … at a speed, `[H_40², H_320²]`; of those in front of
    /// `first` (counted from 0) whatever is at hand.
    pub(super) fn fill(&mut self, speed_mm_per_s: f64, first: usize, gains: &mut [[f64; 2]]) {
        if let Some(products) = &mut self.products {
            return products.fill(speed_mm_per_s, gains);
        }
        for (slot, gain) in gains.iter_mut().enumerate().skip(first) {
            let frequency_hz = bin_frequency_hz(speed_mm_per_s, slot + 1);
            *gain = Band::ALL.map(|band| self.filters.power_gain(band, frequency_hz));
        }
    }
}

impl Products {
    fn new(half_width_octaves: f64) -> Self {
        let per_octave2 = half_width_octaves.powi(-2);
        let shape = |k: usize| {
            let l = (k as f64).log2();
            Band::ALL.map(|band| {
                let b = band.carrier_hz().log2();
                (per_octave2 * (2.0 * b - l) * l).exp2()
            })
        };
        let (mut primes, mut composites) = (Vec::new(), Vec::new());
        for k in 2..=N_BINS {
            let divides = |&(prime, _): &&(usize, f64)| k.is_multiple_of(*prime);
            match primes.iter().find(divides) {
                Some(&(prime, _)) => composites.push((k, [prime, k / prime])),
                None => primes.push((k, (k as f64).log2())),
            }
        }
        Self {
            per_octave2,
            shapes: (1..=N_BINS).map(shape).collect(),
            primes,
            composites,
            powers: vec![1.0; N_BINS + 1],
        }
    }

    fn fill(&mut self, speed_mm_per_s: f64, gains: &mut [[f64; 2]]) {
        let n_bins = gains.len();
        let octaves = (speed_mm_per_s * BIN_SPACING_PER_MM).log2();
        let sigma = -2.0 * octaves * self.per_octave2;
        for &(prime, log2) in self.primes.iter().take_while(|(k, _)| *k <= n_bins) {
            self.powers[prime] = (sigma * log2).exp2();
        }
        for &(k, [a, b]) in self.composites.iter().take_while(|(k, _)| *k <= n_bins) {
            self.powers[k] = self.powers[a] * self.powers[b];
        }
        let scales = Band::ALL.map(|band| {
            let x = octaves - band.carrier_hz().log2();
            (-x * x * self.per_octave2).exp2()
        });
        let known = self.powers.iter().skip(1).zip(&self.shapes);
        for (gain, (power, shape)) in gains.iter_mut().zip(known) {
            *gain = [0, 1].map(|b: usize| scales[b] * (power * shape[b]));
        }
    }
}

/// `Σ_k P_k H_b(f_k)²` of some points over the bins that have gains, and powers: bin after bin, so
/// that a sum is the same bits beside whatever others it is taken.
#[inline]
pub(super) fn sums<const N: usize>(powers_um2: [&[f64]; N], gains: &[[f64; 2]]) -> [[f64; 2]; N] {
    let shortest = powers_um2.iter().map(|powers| powers.len()).min();
    let gains = &gains[..gains.len().min(shortest.unwrap_or(0))];
    let powers_um2 = powers_um2.map(|powers| &powers[..gains.len()]);
    let mut sums = [[0.0; 2]; N];
    for (slot, gain) in gains.iter().enumerate() {
        for (sum, powers) in sums.iter_mut().zip(powers_um2) {
            sum[0] += powers[slot] * gain[0];
            sum[1] += powers[slot] * gain[1];
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::tactile::{MAX_SPEED_MM_PER_S, MIN_SPEED_MM_PER_S, n_audible_bins};

    #[test]
    fn products_are_the_filters_own_gains_at_every_speed_and_bin() {
        for octaves in [NARROWEST_OCTAVES, 2.0, 3.7] {
            let filters = Filters::LogGaussian { octaves };
            let mut making = BinGains::new(&filters);
            assert!(making.products.is_some(), "{octaves} octaves");
            let mut speed_mm_per_s = MIN_SPEED_MM_PER_S;
            while speed_mm_per_s < MAX_SPEED_MM_PER_S {
                let mut gains = vec![[0.0; 2]; n_audible_bins(speed_mm_per_s)];
                making.fill(speed_mm_per_s, 0, &mut gains);
                for (k, gain) in (1..).zip(&gains) {
                    let frequency_hz = bin_frequency_hz(speed_mm_per_s, k);
                    for (b, band) in Band::ALL.into_iter().enumerate() {
                        let expected = filters.power_gain(band, frequency_hz);
                        // What is less than f32 can tell beside 1 may be off by more.
                        let error = (gain[b] - expected).abs();
                        let is_close = error <= 2e-13 * expected.max(1e-33);
                        assert!(is_close, "{error:e} of {expected:e} at bin {k}");
                    }
                }
                speed_mm_per_s *= 1.37;
            }
        }
    }

    #[test]
    fn narrow_filters_and_those_of_receptors_are_evaluated_bin_by_bin() {
        let narrow = Filters::LogGaussian { octaves: 0.05 };
        for filters in [narrow, Filters::Receptor] {
            let mut gains = [[0.0; 2]; 43];
            BinGains::new(&filters).fill(100.0, 0, &mut gains);
            for (k, gain) in (1..).zip(gains) {
                let frequency_hz = bin_frequency_hz(100.0, k);
                let expected = Band::ALL.map(|band| filters.power_gain(band, frequency_hz));
                assert_eq!(gain, expected, "bin {k}");
            }
        }
    }

    #[test]
    fn a_sum_is_the_same_bits_alone_and_beside_others() {
        let mut gains = [[0.0; 2]; 40];
        BinGains::new(&Filters::default()).fill(70.0, 0, &mut gains);
        let powers: Vec<f64> = (0..120).map(|i| 1.0 / (1.0 + f64::from(i))).collect();
        let rows = [&powers[..50], &powers[20..70], &powers[70..]];
        let together = sums(rows, &gains);
        for (row, sum) in rows.into_iter().zip(together) {
            assert_eq!(sums([row], &gains), [sum]);
        }
        assert_eq!(sums([&powers[..1]], &gains)[0][0], powers[0] * gains[0][0]);
    }
}
