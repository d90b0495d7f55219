//! How shares of right answers follow from d′ in each kind of trial, and d′ from them: of one
//! subject, and of a group.

use super::choice::{Choice, Correction, inverted};
use super::{abx_share, choice_share, triangle_share};
use crate::distribution::t_quantile_upper;
use crate::{Computed, Interval, Summary, Undefined, undefined};

const LEVEL: f64 = 0.95;
/// The largest d′ that a share is turned into.
const MOST: f64 = 30.0;
/// Beyond these shares d′ has no digits that mean anything.
const SHARES: [f64; 2] = [1e-9, 1.0 - 1e-9];

/// A kind of trial with one right answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// The strongest of so many, [`choice_share`].
    Alternatives(u32),
    /// The odd one of three, [`triangle_share`].
    Triangle,
    /// Which of two a third is, [`abx_share`].
    Abx,
}

/// d′ of a group: its mean over subjects, and how subjects differ.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupDPrime {
    /// Mean over the population.
    pub mean: f64,
    /// Standard deviation of subjects' own d′.
    pub spread: f64,
    /// Of the mean.
    pub interval: Interval,
    /// Standard error of the mean: the interval's half width over Student's t.
    pub se: f64,
}

/// Shares of subjects, and how much of their variance is the chance of few trials: p(1 − p)/n.
pub(super) struct Shares {
    pub(super) own: Vec<f64>,
    pub(super) by_chance: f64,
}

impl Shares {
    pub(super) fn of(subjects: &[[u64; 2]]) -> Computed<Self> {
        if subjects.iter().any(|[count, n]| *n < 2 || count > n) {
            return undefined("a subject has less than two trials");
        }
        let share = |[count, n]: &[u64; 2]| *count as f64 / *n as f64;
        let by_chance = |own: &[u64; 2]| share(own) * (1.0 - share(own)) / (own[1] as f64 - 1.0);
        Ok(Self {
            own: subjects.iter().map(share).collect(),
            by_chance: subjects.iter().map(by_chance).sum::<f64>() / subjects.len() as f64,
        })
    }
}

impl Relation {
    /// The share of right answers by guessing.
    pub fn chance(self) -> f64 {
        match self {
            Self::Alternatives(m) => 1.0 / f64::from(m),
            Self::Triangle => 1.0 / 3.0,
            Self::Abx => 0.5,
        }
    }

    /// The share of right answers at a distance d′.
    ///
    /// # Errors
    /// Fewer than two or more than 1000 alternatives, a distance that is not finite.
    pub fn share(self, d_prime: f64) -> Computed {
        match self {
            Self::Alternatives(m) => choice_share(d_prime, m),
            Self::Triangle => Ok(triangle_share(d_prime)),
            Self::Abx => Ok(abx_share(d_prime)),
        }
    }

    /// Whether it matters which of two sensations is the stronger: where not, no distance makes the
    /// right one harder to find than a guess, and up to chance d′ is 0.
    fn has_a_sign(self) -> bool {
        matches!(self, Self::Alternatives(_))
    }

    /// The d′ of a share of right answers, to 1e-10.
    ///
    /// # Errors
    /// As [`Self::share`]; a share within 1e-9 of 1, or of 0 where d′ has a sign, or outside.
    pub fn d_prime(self, share: f64) -> Computed {
        self.share(0.0)?;
        let [low, high] = SHARES;
        let low = if self.has_a_sign() { low } else { 0.0 };
        if !(low..=high).contains(&share) {
            return undefined(format!("a share of {share} right has no finite d′"));
        }
        if !self.has_a_sign() && share <= self.chance() {
            return Ok(0.0);
        }
        let least = if self.has_a_sign() { -MOST } else { 0.0 };
        Ok(inverted(
            |d| self.share(d).unwrap_or(0.0),
            share,
            [least, MOST],
        ))
    }

    /// d′ of one subject, with its error and interval. Only shares of 0 and 1 are corrected.
    ///
    /// # Errors
    /// No trials, more right than trials, or as [`Self::share`].
    pub fn choice(self, right: u64, trials: u64, correction: Correction) -> Computed<Choice> {
        let ends = Interval::wilson(right, trials, LEVEL)?;
        let is_extreme = right == 0 || right == trials;
        let share = if is_extreme {
            correction.share(right, trials)
        } else {
            right as f64 / trials as f64
        };
        let d_prime = self.d_prime(share)?;
        let step = 1e-4;
        let slope = (self.share(d_prime + step)? - self.share(d_prime - step)?) / step / 2.0;
        let se = (share * (1.0 - share) / trials as f64).sqrt() / slope;
        let interval = self.d_prime(ends.low).and_then(|low| {
            let high = self.d_prime(ends.high)?;
            Ok(Interval::new([low, high], LEVEL))
        });
        Ok(Choice {
            share,
            correction: is_extreme.then_some(correction),
            d_prime,
            is_below_chance: share < self.chance(),
            se: (slope > 1e-6)
                .then_some(se)
                .ok_or_else(|| Undefined::because("the share hardly changes with d′ here")),
            interval,
        })
    }

    /// d′ of a group, from right answers and trials of each subject.
    ///
    /// The mean of subjects' own d′ is biased where trials are few, because the relation is bent
    /// and cut at 0: 8 % low for triangles of which 9 of 21 are right. Here it follows from the
    /// mean of subjects' shares p, less what subjects who differ bend it by: with the spread τ of
    /// d′ that is left of the spread of shares beyond p(1 − p)/n, the mean of share(d′) is that of
    /// share(μ) and ½ τ² share″(μ). Its interval is Wilson's of p, moved alike, with Student's t of
    /// as many degrees of freedom as subjects less one, and as many trials as the spread over
    /// subjects says, no more than there were.
    ///
    /// # Errors
    /// Fewer than two subjects, one without two trials, all of all answers right, or as
    /// [`Self::share`].
    pub fn group(self, subjects: &[[u64; 2]]) -> Computed<GroupDPrime> {
        let Shares { own, by_chance } = Shares::of(subjects)?;
        let shares = Summary::of(&own)?;
        let n_trials: f64 = subjects.iter().map(|[_, n]| *n as f64).sum();
        let p = shares.mean;
        let at = self.d_prime(p)?;
        let step = 1e-3;
        let [below, here, above] = [-step, 0.0, step].map(|by| self.share(at + by));
        let (below, here, above) = (below?, here?, above?);
        let slope = (above - below) / (2.0 * step);
        let bend = (above - 2.0 * here + below) / (step * step);
        let variance = (shares.sd * shares.sd - by_chance).max(0.0) / (slope * slope);
        let (spread, moved) = if slope > 1e-6 {
            (variance.sqrt(), -0.5 * variance * bend / slope)
        } else {
            (0.0, 0.0)
        };
        let least = if self.has_a_sign() { -MOST } else { 0.0 };
        let mean = |d_prime: f64| (d_prime + moved).max(least);
        let t = t_quantile_upper(0.5 * (1.0 - LEVEL), subjects.len() as f64 - 1.0)?;
        let n = (p * (1.0 - p) / (shares.se * shares.se)).min(n_trials);
        let middle = (p + 0.5 * t * t / n) / (1.0 + t * t / n);
        let half = t / (1.0 + t * t / n) * (p * (1.0 - p) / n + 0.25 * t * t / (n * n)).sqrt();
        let interval = Interval::new(
            [
                mean(self.d_prime(middle - half)?),
                mean(self.d_prime(middle + half)?),
            ],
            LEVEL,
        );
        Ok(GroupDPrime {
            mean: mean(at),
            spread,
            se: 0.5 * (interval.high - interval.low) / t,
            interval,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    /// Subjects of a population, in triads.
    fn subjects(random: &mut Random, n: usize, [mean, spread]: [f64; 2]) -> Vec<[u64; 2]> {
        let mut own = || {
            let share = triangle_share(mean + spread * random.normal());
            let right = (0..21).map(|_| u64::from(random.uniform() < share)).sum();
            [right, 21]
        };
        (0..n).map(|_| own()).collect()
    }

    #[test]
    fn a_group_is_not_biased_by_few_trials_where_the_mean_of_its_subjects_is() -> Computed<()> {
        let mut random = Random::new(5);
        let n_groups = 200;
        let own = |right| Relation::Triangle.choice(right, 21, Correction::LogLinear);
        let own: Computed<Vec<f64>> = (0..=21).map(|right| Ok(own(right)?.d_prime)).collect();
        let own = own?;
        for (n, truth) in [
            (60, [1.2, 0.0]),
            (60, [1.5, 0.4]),
            (60, [3.0, 0.5]),
            (12, [1.5, 0.3]),
        ] {
            let (mut group, mut plain, mut n_held) = (0.0, 0.0, 0);
            for _ in 0..n_groups {
                let all = subjects(&mut random, n, truth);
                let found = Relation::Triangle.group(&all)?;
                n_held += usize::from(found.interval.holds(truth[0]));
                group += found.mean / f64::from(n_groups);
                let right = all
                    .iter()
                    .map(|[right, _]| own[usize::try_from(*right).unwrap_or(0)]);
                plain += right.sum::<f64>() / n as f64 / f64::from(n_groups);
            }
            let [group, plain] = [group, plain].map(|mean| 100.0 * (mean / truth[0] - 1.0));
            println!(
                "{n} of {truth:?}: {group:+.1} %, the mean of subjects' own {plain:+.1} %; \
                 {n_held} of {n_groups} intervals hold"
            );
            assert!(group.abs() < 2.5, "{n} of {truth:?}: {group} %");
            assert!((180..=198).contains(&n_held), "{n} of {truth:?}: {n_held}");
        }
        Ok(())
    }

    #[test]
    fn groups_at_the_ends_are_told() -> Computed<()> {
        let guessing = Relation::Triangle.group(&[[5, 21], [7, 21], [6, 21], [8, 21]])?;
        assert!(guessing.mean < 0.01, "{guessing:?}");
        assert_eq!(guessing.interval.low, 0.0);
        assert!(
            Relation::Triangle.group(&[[21, 21]; 4]).is_err(),
            "no largest d′"
        );
        assert!(Relation::Abx.group(&[[8, 10]]).is_err(), "one subject");
        let below = Relation::Alternatives(4).group(&[[1, 20], [2, 20], [1, 20], [2, 20]])?;
        assert!(
            below.mean < 0.0 && below.interval.high < 0.1,
            "below chance"
        );
        Ok(())
    }
}
