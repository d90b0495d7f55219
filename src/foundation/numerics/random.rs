//! Seeded random numbers, the same on every machine and in every thread count.
//!
//! One generator a purpose: [`Random::branch`] gives independent streams by name, so that adding a
//! draw in one place changes nothing elsewhere.

use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64;

/// A seeded generator (PCG XSL RR 128/64).
#[derive(Debug, Clone)]
pub struct Random {
    seed: u64,
    generator: Pcg64,
}

impl Random {
    /// The generator, for records of what chance was drawn from.
    pub const NAME: &str = "PCG XSL RR 128/64 (rand_pcg Pcg64)";

    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self {
            seed,
            generator: Pcg64::seed_from_u64(seed),
        }
    }

    /// An independent generator for one purpose, from the seed and a name (FNV-1a of both). It
    /// does not depend on what was drawn before.
    #[must_use]
    pub fn branch(&self, purpose: &str) -> Self {
        let start = 0xcbf2_9ce4_8422_2325_u64;
        let bytes = self.seed.to_le_bytes().into_iter().chain(purpose.bytes());
        let hash = bytes.fold(start, |h, b| {
            (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
        });
        Self::new(hash)
    }

    /// What it began with, for generators of another kind.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.generator.random::<f64>()
    }

    /// Uniform in [low, high); `low` when the interval is empty.
    pub fn uniform_in(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low).max(0.0) * self.uniform()
    }

    /// Normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.generator)
    }

    /// Uniform in 0…n−1; 0 when `n` is 0.
    pub fn index(&mut self, n: usize) -> usize {
        if n == 0 {
            0
        } else {
            self.generator.random_range(0..n)
        }
    }

    /// Puts items into an order by chance, each as likely as any other (Fisher & Yates, from the
    /// last down).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            let other = self.index(last + 1);
            items.swap(last, other);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shuffle_is_every_order_as_often_and_its_seeds_alone() {
        let mut counts = std::collections::BTreeMap::new();
        let mut random = Random::new(3);
        for _ in 0..6000 {
            let mut items = [0, 1, 2];
            random.shuffle(&mut items);
            *counts.entry(items).or_insert(0) += 1;
        }
        assert_eq!(counts.len(), 6);
        assert!(
            counts.values().all(|n| (900..1100).contains(n)),
            "{counts:?}"
        );
        let mut first: Vec<u32> = (0..20).collect();
        Random::new(2012).shuffle(&mut first);
        // Schedules of studies hang on these: they may not change.
        assert_eq!(first, GOLDEN);
    }

    const GOLDEN: [u32; 20] = [
        8, 3, 0, 10, 5, 2, 7, 13, 4, 9, 11, 1, 17, 19, 6, 16, 15, 18, 12, 14,
    ];

    #[test]
    fn same_seed_same_numbers_other_branch_other_numbers() {
        let (mut a, mut b) = (Random::new(7), Random::new(7));
        let drawn: Vec<f64> = (0..5).map(|_| a.uniform()).collect();
        assert!(drawn.iter().all(|&x| x == b.uniform()), "repeatable");
        assert!(
            a.branch("slub").uniform() != a.branch("crimp").uniform(),
            "independent"
        );
        assert_eq!(
            a.branch("slub").uniform(),
            Random::new(7).branch("slub").uniform()
        );
    }

    #[test]
    fn every_order_is_as_likely() {
        let mut random = Random::new(4);
        let mut counts = [0_u32; 3];
        for _ in 0..3000 {
            let mut values = [0, 1, 2];
            random.shuffle(&mut values);
            counts[values[0]] += 1;
            assert_eq!(values.iter().sum::<usize>(), 3, "nothing is lost");
        }
        // Standard deviation of each: 26.
        assert!(counts.iter().all(|n| n.abs_diff(1000) < 105), "{counts:?}");
    }

    #[test]
    fn normal_numbers_have_unit_variance() {
        let mut random = Random::new(1);
        let n = 20_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..n {
            let x = random.normal();
            sum += x;
            squares += x * x;
        }
        let (mean, variance) = (sum / f64::from(n), squares / f64::from(n));
        // Standard errors: 0.007 of the mean, 0.01 of the variance.
        assert!(
            mean.abs() < 0.03 && (variance - 1.0).abs() < 0.04,
            "{mean}, {variance}"
        );
    }
}
