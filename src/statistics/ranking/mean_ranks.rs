//! Rankings of alternatives by likeness to a target: mean ranks, what was taken for what, and the
//! dissimilarities that follow.

use super::preferences::check_distinct;
use crate::{Computed, Undefined, undefined};

/// One trial: alternatives ranked by likeness to a target that is one of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RankTrial {
    /// Index of the target.
    pub target: usize,
    /// Indices of the alternatives.
    pub alternatives: Vec<usize>,
    /// Their ranks in the same order, 1 the most alike: 1 … k, each once.
    pub ranks: Vec<usize>,
}

impl RankTrial {
    /// The alternatives, most alike first, as `plackett_luce` takes them.
    pub fn best_first(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.alternatives.len().min(self.ranks.len())).collect();
        order.sort_by_key(|&place| self.ranks[place]);
        order
            .iter()
            .map(|&place| self.alternatives[place])
            .collect()
    }

    fn check(&self, n_items: usize) -> Result<(), String> {
        check_distinct(n_items, &self.alternatives)?;
        let k = self.alternatives.len();
        let mut sorted = self.ranks.clone();
        sorted.sort_unstable();
        if !sorted.iter().copied().eq(1..=k) {
            return Err(format!(
                "ranks {:?} are not 1 to {k}, each once",
                self.ranks
            ));
        }
        if !self.alternatives.contains(&self.target) {
            return Err(format!("target {} is no alternative", self.target + 1));
        }
        Ok(())
    }
}

/// Sums over trials, a row a target and a column an alternative.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeanRanks {
    n_items: usize,
    counts: Vec<usize>,
    rank_sums: Vec<usize>,
    n_first: Vec<usize>,
}

/// How far mean ranks differ when target and alternative change places.
#[derive(Debug, Clone, PartialEq)]
pub struct Asymmetry {
    /// Pairs of items with |M − Mᵀ|, for those that met both ways.
    pub pairs: Vec<([usize; 2], f64)>,
    /// Their mean.
    pub mean: f64,
    /// The largest.
    pub largest: f64,
}

impl MeanRanks {
    /// Of trials with as many alternatives each.
    ///
    /// # Errors
    /// No trials; one (with its number) whose alternatives are fewer than two, unknown, repeated or
    /// of another number than in the first, whose ranks are not 1 to k, or whose target is none of
    /// its alternatives.
    pub fn of(n_items: usize, trials: &[RankTrial]) -> Computed<Self> {
        let Some(first) = trials.first() else {
            return undefined("no trials");
        };
        let k = first.alternatives.len();
        let mut all = Self {
            n_items,
            counts: vec![0; n_items * n_items],
            rank_sums: vec![0; n_items * n_items],
            n_first: vec![0; n_items * n_items],
        };
        for (index, trial) in trials.iter().enumerate() {
            let found = trial.alternatives.len();
            let right_number = if found == k {
                Ok(())
            } else {
                Err(format!("{found} alternatives, {k} in the first"))
            };
            right_number
                .and_then(|()| trial.check(n_items))
                .map_err(|why| Undefined::because(format!("trial {}: {why}", index + 1)))?;
            for (&alternative, &rank) in trial.alternatives.iter().zip(&trial.ranks) {
                let cell = trial.target * n_items + alternative;
                all.counts[cell] += 1;
                all.rank_sums[cell] += rank;
                all.n_first[cell] += usize::from(rank == 1);
            }
        }
        Ok(all)
    }

    /// Number of items: rows and columns.
    pub fn n_items(&self) -> usize {
        self.n_items
    }

    /// How often each alternative was there for each target, row by row.
    pub fn counts(&self) -> &[usize] {
        &self.counts
    }

    /// How often each alternative was ranked first for each target, row by row: what was taken for
    /// what.
    pub fn confusions(&self) -> &[usize] {
        &self.n_first
    }

    /// The mean rank of each alternative for each target, row by row; `None` where the two never
    /// met. The diagonal is the rank of the correct alternative.
    pub fn means(&self) -> Vec<Option<f64>> {
        let mean = |(&sum, &n): (&usize, &usize)| (n > 0).then(|| sum as f64 / n as f64);
        self.rank_sums.iter().zip(&self.counts).map(mean).collect()
    }

    /// Dissimilarities, row by row as [`Dissimilarities::new`] takes them: the mean of the mean
    /// ranks both ways, or the one there is; `None` on the diagonal and for pairs that never met.
    ///
    /// [`Dissimilarities::new`]: crate::mds::Dissimilarities::new
    pub fn dissimilarities(&self) -> Vec<Option<f64>> {
        let (n, means) = (self.n_items, self.means());
        let cell = |cell: usize| {
            let (i, j) = (cell / n, cell % n);
            let both = [means[i * n + j], means[j * n + i]];
            match both {
                _ if i == j => None,
                [Some(a), Some(b)] => Some(0.5 * (a + b)),
                [one, other] => one.or(other),
            }
        };
        (0..n * n).map(cell).collect()
    }

    /// Pairs that never met either way.
    pub fn n_missing(&self) -> usize {
        let n = self.n_items;
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        pairs
            .filter(|&(i, j)| self.counts[i * n + j] + self.counts[j * n + i] == 0)
            .count()
    }

    /// |M − Mᵀ|. Where targets and alternatives are of two kinds, real and virtual say, it need
    /// not be small, and a map of the symmetric part leaves it out.
    ///
    /// # Errors
    /// No pair met both ways.
    pub fn asymmetry(&self) -> Computed<Asymmetry> {
        let (n, means) = (self.n_items, self.means());
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
        let of_pair = |[i, j]: [usize; 2]| {
            let (there, back) = (means[i * n + j]?, means[j * n + i]?);
            Some(([i, j], (there - back).abs()))
        };
        let pairs: Vec<([usize; 2], f64)> = pairs.filter_map(of_pair).collect();
        if pairs.is_empty() {
            return undefined("no two items met both ways, as target and as alternative");
        }
        Ok(Asymmetry {
            mean: pairs.iter().map(|(_, a)| a).sum::<f64>() / pairs.len() as f64,
            largest: pairs.iter().fold(0.0, |most, (_, a)| a.max(most)),
            pairs,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mds::Dissimilarities;
    use selvedge_foundation::numerics::Random;

    fn trial(target: usize, alternatives: [usize; 4], ranks: [usize; 4]) -> RankTrial {
        RankTrial {
            target,
            alternatives: alternatives.to_vec(),
            ranks: ranks.to_vec(),
        }
    }

    fn three() -> Vec<RankTrial> {
        vec![
            trial(0, [0, 1, 2, 3], [1, 2, 3, 4]),
            trial(0, [3, 2, 1, 0], [1, 4, 3, 2]),
            trial(1, [0, 1, 2, 3], [4, 1, 2, 3]),
        ]
    }

    #[test]
    fn means_counts_and_confusions_are_those_by_hand() -> Computed<()> {
        let found = MeanRanks::of(5, &three())?;
        let means = found.means();
        assert_eq!(
            means[..5],
            [Some(1.5), Some(2.5), Some(3.5), Some(2.5), None]
        );
        assert_eq!(
            means[5..10],
            [Some(4.0), Some(1.0), Some(2.0), Some(3.0), None]
        );
        assert_eq!(found.counts()[..5], [2, 2, 2, 2, 0]);
        assert_eq!(found.confusions()[..5], [1, 0, 0, 1, 0]);
        assert_eq!(three()[1].best_first(), [3, 0, 1, 2]);
        Ok(())
    }

    #[test]
    fn both_ways_are_averaged_and_what_never_met_is_missing() -> Computed<()> {
        let found = MeanRanks::of(5, &three())?;
        let d = found.dissimilarities();
        assert_eq!(d[1], Some(0.5 * (2.5 + 4.0)));
        assert_eq!(d[5], d[1]);
        assert_eq!((d[2], d[10]), (Some(3.5), Some(3.5)), "one way alone");
        assert_eq!((d[0], d[4]), (None, None));
        // 2 and 3 were together but neither was the target; 4 was never there.
        assert_eq!(found.n_missing(), 5);
        let asymmetry = found.asymmetry()?;
        assert_eq!(asymmetry.pairs, [([0, 1], 1.5)]);
        assert_eq!((asymmetry.mean, asymmetry.largest), (1.5, 1.5));
        let one_target = MeanRanks::of(4, &three()[..2])?;
        assert!(one_target.asymmetry().is_err(), "one way alone");
        Ok(())
    }

    #[test]
    fn guesses_rank_the_correct_one_at_chance_and_their_table_can_be_mapped() -> Computed<()> {
        let mut random = Random::new(3);
        let guess = |target: usize| {
            let mut alternatives: Vec<usize> = (0..6).filter(|&a| a != target).collect();
            random.shuffle(&mut alternatives);
            alternatives[3] = target;
            alternatives.truncate(4);
            let mut ranks = vec![1, 2, 3, 4];
            random.shuffle(&mut ranks);
            RankTrial {
                target,
                alternatives,
                ranks,
            }
        };
        let trials: Vec<RankTrial> = (0..6).cycle().take(6000).map(guess).collect();
        let found = MeanRanks::of(6, &trials)?;
        let correct = (0..6)
            .map(|i| found.means()[7 * i])
            .collect::<Option<Vec<f64>>>();
        let mean_rank = correct.map(|means| means.iter().sum::<f64>() / 6.0);
        let n_first: usize = (0..6).map(|i| found.confusions()[7 * i]).sum();
        // Standard errors: √1.25/√6000 = 0.014 and 34 trials.
        assert!(
            mean_rank.is_some_and(|rank| (rank - 2.5).abs() < 0.06),
            "{mean_rank:?}"
        );
        assert!(n_first.abs_diff(1500) < 130, "{n_first}");
        let names = (0..6).map(|i| i.to_string()).collect();
        let mapped = Dissimilarities::new(names, &found.dissimilarities())?;
        assert_eq!((mapped.pairs().len(), found.n_missing()), (15, 0));
        Ok(())
    }

    #[test]
    fn trials_that_are_no_ranking_are_refused_with_their_number() {
        let reason = |broken: RankTrial| {
            let trials = [trial(0, [0, 1, 2, 3], [1, 2, 3, 4]), broken];
            MeanRanks::of(4, &trials).map_err(|e| e.reason).unwrap_err()
        };
        let tied = reason(trial(0, [0, 1, 2, 3], [1, 1, 3, 4]));
        assert_eq!(
            tied,
            "trial 2: ranks [1, 1, 3, 4] are not 1 to 4, each once"
        );
        let twice = reason(trial(0, [0, 1, 1, 3], [1, 2, 3, 4]));
        assert_eq!(twice, "trial 2: item 2 twice");
        let unknown = reason(trial(0, [0, 1, 2, 7], [1, 2, 3, 4]));
        assert_eq!(unknown, "trial 2: item 8 of 4");
        let mut short = trial(0, [0, 1, 2, 3], [1, 2, 3, 4]);
        short.alternatives.pop();
        assert_eq!(
            reason(short.clone()),
            "trial 2: 3 alternatives, 4 in the first"
        );
        short.alternatives.push(2);
        assert!(MeanRanks::of(4, &[short]).is_err(), "twice");
        let mut few = trial(0, [0, 1, 2, 3], [1, 2, 3, 4]);
        few.ranks.pop();
        assert!(reason(few).contains("[1, 2, 3]"), "a rank missing");
        let absent = MeanRanks::of(5, &[trial(4, [0, 1, 2, 3], [1, 2, 3, 4])]);
        let absent = absent.map_err(|e| e.reason);
        assert_eq!(
            absent,
            Err("trial 1: target 5 is no alternative".to_owned())
        );
        assert!(MeanRanks::of(4, &[]).is_err(), "no trials");
    }
}
