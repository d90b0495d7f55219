//! Monotone regression: the values nearest to some numbers that rise with their order, by pooling
//! what goes down (PAVA), under three rules for ties.

use std::ops::Range;

use selvedge_foundation::named;

named! {
    /// What ties in the dissimilarities ask of the distances.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Ties {
        /// Nothing: tied pairs may be at different distances (Kruskal's first way, ALSCAL's UNTIE).
        #[default]
        Primary = "primary",
        /// The same disparity for tied pairs (Kruskal's second way, ALSCAL's default).
        Secondary = "secondary",
        /// Only their mean disparities rise from block to block (de Leeuw).
        Tertiary = "tertiary",
    }
    /// Its name in files and commands.
    pub fn name;
}

/// A run of values that share their weighted mean.
#[derive(Debug, Clone, Copy)]
struct Pool {
    mean: f64,
    weight: f64,
    end: usize,
}

/// Room for regressions of one length, and the order in which ties stood last.
#[derive(Debug, Clone)]
pub(super) struct Regression {
    order: Vec<u32>,
    pools: Vec<Pool>,
    /// Means of blocks.
    means: Vec<f64>,
}

impl Regression {
    /// For `n` values.
    pub(super) fn new(n: usize) -> Self {
        Self {
            order: (0..u32::try_from(n).unwrap_or(u32::MAX)).collect(),
            pools: Vec::with_capacity(n),
            means: Vec::with_capacity(n),
        }
    }

    /// Forgets the order of ties, so that a run depends on nothing before it.
    pub(super) fn reset(&mut self) {
        for (place, number) in self.order.iter_mut().zip(0..) {
            *place = number;
        }
    }

    /// The regression of `values` with `weights` > 0, tied in `blocks`, into `fitted`.
    pub(super) fn fit(
        &mut self,
        ties: Ties,
        (values, weights): (&[f64], &[f64]),
        blocks: &[Range<usize>],
        fitted: &mut [f64],
    ) {
        match ties {
            Ties::Primary => self.primary((values, weights), blocks, fitted),
            Ties::Secondary => {
                self.pool_blocks((values, weights), blocks);
                self.over_blocks(blocks, |block, _, mean| {
                    fitted[block].fill(mean);
                });
            }
            Ties::Tertiary => {
                self.pool_blocks((values, weights), blocks);
                self.over_blocks(blocks, |block, own, mean| {
                    for i in block {
                        fitted[i] = values[i] + (mean - own);
                    }
                });
            }
        }
    }

    fn primary(
        &mut self,
        (values, weights): (&[f64], &[f64]),
        blocks: &[Range<usize>],
        fitted: &mut [f64],
    ) {
        for block in blocks.iter().filter(|block| block.len() > 1) {
            let by_value = |a: &u32, b: &u32| values[*a as usize].total_cmp(&values[*b as usize]);
            self.order[block.clone()].sort_by(by_value);
        }
        self.pools.clear();
        for (place, &i) in self.order.iter().enumerate() {
            let (mean, weight) = (values[i as usize], weights[i as usize]);
            push(&mut self.pools, mean, weight, place + 1);
        }
        let mut start = 0;
        for pool in &self.pools {
            for &i in &self.order[start..pool.end] {
                fitted[i as usize] = pool.mean;
            }
            start = pool.end;
        }
    }

    /// Pools the means of blocks.
    fn pool_blocks(&mut self, (values, weights): (&[f64], &[f64]), blocks: &[Range<usize>]) {
        self.pools.clear();
        self.means.clear();
        for (place, block) in blocks.iter().enumerate() {
            let (mean, weight) = mean_of(&values[block.clone()], &weights[block.clone()]);
            self.means.push(mean);
            push(&mut self.pools, mean, weight, place + 1);
        }
    }

    /// Every block with its own mean and that of its pool.
    fn over_blocks(&self, blocks: &[Range<usize>], mut visit: impl FnMut(Range<usize>, f64, f64)) {
        let mut start = 0;
        for pool in &self.pools {
            let pooled = start..pool.end;
            for (block, own) in blocks[pooled.clone()].iter().zip(&self.means[pooled]) {
                visit(block.clone(), *own, pool.mean);
            }
            start = pool.end;
        }
    }
}

fn mean_of(values: &[f64], weights: &[f64]) -> (f64, f64) {
    let weight: f64 = weights.iter().sum();
    let sum: f64 = values.iter().zip(weights).map(|(x, w)| x * w).sum();
    (sum / weight, weight)
}

/// Adds a value after the pools, which are merged until they rise.
fn push(pools: &mut Vec<Pool>, mean: f64, weight: f64, end: usize) {
    let mut new = Pool { mean, weight, end };
    while let Some(last) = pools.last().filter(|last| last.mean >= new.mean) {
        let weight = last.weight + new.weight;
        new.mean = (last.mean * last.weight + new.mean * new.weight) / weight;
        new.weight = weight;
        pools.pop();
    }
    pools.push(new);
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    fn fitted(ties: Ties, values: &[f64], blocks: &[Range<usize>]) -> Vec<f64> {
        let mut out = vec![0.0; values.len()];
        let weights = vec![1.0; values.len()];
        Regression::new(values.len()).fit(ties, (values, &weights), blocks, &mut out);
        out
    }

    #[test]
    fn what_goes_down_is_pooled() {
        let single: Vec<Range<usize>> = (0..5).map(|i| i..i + 1).collect();
        let found = fitted(Ties::Primary, &[1.0, 3.0, 2.0, 4.0, 0.0], &single);
        assert_eq!(found, [1.0, 2.25, 2.25, 2.25, 2.25]);
    }

    #[test]
    fn ties_by_the_three_rules() {
        let blocks = [0..2, 2..4];
        let values = [3.0, 1.0, 2.0, 6.0];
        assert_eq!(
            fitted(Ties::Primary, &values, &blocks),
            [2.5, 1.0, 2.5, 6.0]
        );
        assert_eq!(
            fitted(Ties::Secondary, &values, &blocks),
            [2.0, 2.0, 4.0, 4.0]
        );
        assert_eq!(fitted(Ties::Tertiary, &values, &blocks), values);
        let falling = [5.0, 3.0, 2.0, 0.0];
        assert_eq!(
            fitted(Ties::Tertiary, &falling, &blocks),
            [3.5, 1.5, 3.5, 1.5]
        );
    }

    /// Independent: the largest of the smallest means over upper and lower sets.
    #[test]
    fn pooling_is_the_max_min_formula() {
        let mut random = Random::new(3);
        let values: Vec<f64> = (0..20).map(|_| random.normal()).collect();
        let weights: Vec<f64> = (0..20).map(|_| random.uniform_in(0.1, 2.0)).collect();
        let single: Vec<Range<usize>> = (0..20).map(|i| i..i + 1).collect();
        let mut out = vec![0.0; 20];
        Regression::new(20).fit(Ties::Primary, (&values, &weights), &single, &mut out);
        for (i, found) in out.iter().enumerate() {
            let mean = |a: usize, b: usize| mean_of(&values[a..=b], &weights[a..=b]).0;
            let least = |a: usize| (i..20).map(|b| mean(a, b)).fold(f64::INFINITY, f64::min);
            let expected = (0..=i).map(least).fold(f64::NEG_INFINITY, f64::max);
            assert!(
                (found - expected).abs() < 1e-12,
                "{i}: {found} or {expected}"
            );
        }
    }
}
