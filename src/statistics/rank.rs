//! Ranks, with equal values sharing the mean of theirs.

/// Ranks from 1 of some values, and the sum of t³ − t over groups of t equal ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranks {
    /// The rank of each value.
    pub ranks: Vec<f64>,
    /// Σ(t³ − t): 0 without ties.
    pub(crate) tie_sum: f64,
}

impl Ranks {
    /// Of finite values.
    pub fn of(values: &[f64]) -> Self {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let mut ranks = vec![0.0; values.len()];
        let (mut start, mut tie_sum) = (0, 0.0);
        while let Some(&first) = order.get(start) {
            let is_same = |&&i: &&usize| values[i] <= values[first];
            let n_same = order[start..].iter().take_while(is_same).count();
            let t = n_same as f64;
            for &i in &order[start..start + n_same] {
                ranks[i] = start as f64 + 0.5 * (t + 1.0);
            }
            tie_sum += t * t * t - t;
            start += n_same;
        }
        Self { ranks, tie_sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_share_the_mean_of_their_ranks() {
        let found = Ranks::of(&[3.0, 1.0, 3.0, 0.0, 3.0, -0.0]);
        assert_eq!(found.ranks, [5.0, 3.0, 5.0, 1.5, 5.0, 1.5]);
        assert_eq!(found.tie_sum, 24.0 + 6.0);
        assert_eq!(Ranks::of(&[]).ranks, Vec::<f64>::new());
    }
}
