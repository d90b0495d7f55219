//! What is mapped: how unlike every two of some objects are, and how much each pair counts.

use crate::{Undefined, undefined};

/// Dissimilarities that differ by less than this share of the largest are tied: means of ranks
/// that are equal on paper differ by rounding.
const TIE_SHARE: f64 = 1e-9;
/// The two sides of a pair may differ by this share of the largest: rounding in a file.
const ROUNDING_SHARE: f64 = 1e-6;

/// How unlike every two of some objects are. Symmetric, without a diagonal; a pair may be missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Dissimilarities {
    names: Vec<String>,
    pairs: Vec<Pair>,
}

/// Two objects and how unlike they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Indices of the two, the smaller first.
    pub objects: [usize; 2],
    /// How unlike they are, ≥ 0.
    pub delta: f64,
    /// How much the pair counts, > 0.
    pub weight: f64,
}

impl Dissimilarities {
    /// From a square matrix, row by row, with weights alike. The diagonal is ignored; `None` and a
    /// weight of 0 leave a pair out, and where one side is missing the other holds. Sides that
    /// differ by rounding are averaged.
    ///
    /// # Errors
    /// Fewer than three objects; not square; a number or weight that is negative or not finite;
    /// sides that differ; objects that no chain of pairs joins; all pairs equally unlike.
    pub fn weighted(
        names: Vec<String>,
        values: &[Option<f64>],
        weights: &[f64],
    ) -> Result<Self, Undefined> {
        let n = names.len();
        if values.len() != n * n || weights.len() != n * n {
            let (v, w) = (values.len(), weights.len());
            let what = format!("{n} names need {n} × {n} numbers and weights, not {v} and {w}");
            return undefined(what);
        }
        if n < 3 {
            let what = format!("a map needs at least three objects, and this has {n}");
            return undefined(what);
        }
        let largest = values.iter().flatten().copied().fold(0.0, f64::max);
        let mut pairs = Vec::with_capacity(n * (n - 1) / 2);
        for i in 0..n {
            for j in i + 1..n {
                let sides = [values[i * n + j], values[j * n + i]];
                let weight = 0.5 * (weights[i * n + j] + weights[j * n + i]);
                let between = || format!("{} and {}", names[i], names[j]);
                let numbers = sides.iter().flatten().chain([&weight]);
                if numbers.into_iter().any(|x| !x.is_finite() || *x < 0.0) {
                    return undefined(format!("{} have a negative or endless number", between()));
                }
                let delta = match sides {
                    [Some(a), Some(b)] if (a - b).abs() > ROUNDING_SHARE * largest => {
                        let what = format!("{} differ by {a} one way and {b} the other", between());
                        return undefined(what);
                    }
                    [Some(a), Some(b)] => 0.5 * (a + b),
                    [Some(a), None] | [None, Some(a)] => a,
                    [None, None] => continue,
                };
                if weight > 0.0 {
                    let objects = [i, j];
                    pairs.push(Pair {
                        objects,
                        delta,
                        weight,
                    });
                }
            }
        }
        let all = Self { names, pairs };
        all.check()?;
        Ok(all)
    }

    /// The same where all pairs count alike.
    ///
    /// # Errors
    /// As [`Self::weighted`].
    pub fn new(names: Vec<String>, values: &[Option<f64>]) -> Result<Self, Undefined> {
        Self::weighted(names, values, &vec![1.0; values.len()])
    }

    /// The same objects and pairs with other dissimilarities, in the order of [`Self::pairs`].
    #[must_use]
    pub(super) fn with_deltas(&self, deltas: &[f64]) -> Self {
        let mut other = self.clone();
        for (pair, &delta) in other.pairs.iter_mut().zip(deltas) {
            pair.delta = delta;
        }
        other
    }

    /// What the objects are called.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of objects.
    pub fn n_objects(&self) -> usize {
        self.names.len()
    }

    /// The pairs that are there, by their objects.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Pairs that are missing.
    pub fn n_missing(&self) -> usize {
        let n = self.n_objects();
        n * (n - 1) / 2 - self.pairs.len()
    }

    /// The pairs by rising dissimilarity, in blocks that are tied.
    pub(super) fn tied_blocks(&self) -> Vec<Vec<Pair>> {
        let mut sorted = self.pairs.clone();
        sorted.sort_by(|a, b| a.delta.total_cmp(&b.delta));
        let near = TIE_SHARE * sorted.last().map_or(0.0, |pair| pair.delta);
        let mut blocks: Vec<Vec<Pair>> = Vec::new();
        for pair in sorted {
            match blocks.last_mut() {
                Some(block) if pair.delta - block[0].delta <= near => block.push(pair),
                _ => blocks.push(vec![pair]),
            }
        }
        blocks
    }

    fn check(&self) -> Result<(), Undefined> {
        let group = self.groups();
        if let Some(apart) = group.iter().position(|&g| g != group[0]) {
            let (first, other) = (&self.names[0], &self.names[apart]);
            let what = format!(
                "no chain of pairs joins {first} and {other}: the map falls into parts whose \
                 distance nothing tells"
            );
            return undefined(what);
        }
        if self.tied_blocks().len() < 2 {
            let what = "all pairs are equally unlike: they have no order to be mapped";
            return undefined(what);
        }
        Ok(())
    }

    /// For every object the smallest object that a chain of pairs joins it to.
    fn groups(&self) -> Vec<usize> {
        let mut group: Vec<usize> = (0..self.n_objects()).collect();
        for pair in &self.pairs {
            let [a, b] = pair.objects.map(|object| group[object]);
            for g in &mut group {
                if *g == a.max(b) {
                    *g = a.min(b);
                }
            }
        }
        group
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(n: usize) -> Vec<String> {
        (0..n).map(|i| format!("t{i}")).collect()
    }

    fn of(n: usize, entries: &[(usize, usize, f64)]) -> Result<Dissimilarities, Undefined> {
        let mut values = vec![None; n * n];
        for &(i, j, x) in entries {
            values[i * n + j] = Some(x);
        }
        Dissimilarities::new(names(n), &values)
    }

    #[test]
    fn what_cannot_be_mapped_is_refused_by_its_reason() {
        let reason = |found: Result<Dissimilarities, Undefined>| found.unwrap_err().reason;
        assert!(reason(of(1, &[])).contains("three objects"));
        assert!(reason(of(4, &[(0, 1, 1.0), (2, 3, 2.0)])).contains("t0 and t2"));
        assert!(reason(of(3, &[(0, 1, 1.0), (1, 2, 1.0), (0, 2, 1.0)])).contains("equally"));
        assert!(reason(of(3, &[(0, 1, 1.0), (1, 0, 1.1), (1, 2, 2.0)])).contains("one way"));
        assert!(reason(of(3, &[(0, 1, -1.0), (1, 2, 2.0)])).contains("negative"));
        assert!(reason(of(3, &[(0, 1, f64::NAN), (1, 2, 2.0)])).contains("negative"));
        assert!(reason(Dissimilarities::new(names(3), &[])).contains("3 × 3"));
    }

    #[test]
    fn a_pair_given_on_one_side_counts_and_rounding_makes_ties() {
        let found = of(
            3,
            &[(1, 0, 0.1 + 0.2), (1, 2, 0.3), (2, 1, 0.3), (2, 0, 4.0)],
        )
        .unwrap();
        assert_eq!(found.pairs().len(), 3);
        assert_eq!(found.n_missing(), 0);
        let blocks: Vec<usize> = found.tied_blocks().iter().map(Vec::len).collect();
        assert_eq!(blocks, [2, 1]);
    }
}
