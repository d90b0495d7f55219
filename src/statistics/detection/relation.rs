//! How shares of right answers follow from d′ in each kind of trial, and d′ from them: of one
//! subject, and of a group.

use super::choice::{Choice, Correction, inverted};
use super::{abx_share, choice_share, triangle_share};
use crate::distribution::t_quantile_upper;
use crate::interval::wilson;
use crate::{Computed, Interval, Undefined, undefined};
use selvedge_foundation::numerics::lowest;
use std::collections::BTreeMap;

const LEVEL: f64 = 0.95;
/// The largest d′ that a share is turned into, and that a group is given.
const MOST: [f64; 2] = [30.0, 12.0];
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
    pub interval: Computed<Interval>,
    /// Standard error of the mean: the interval's half width over Student's t.
    pub se: Computed,
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

    fn least(self, most: f64) -> f64 {
        if self.has_a_sign() { -most } else { 0.0 }
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
        let ends = [self.least(MOST[0]), MOST[0]];
        Ok(inverted(|d| self.share(d).unwrap_or(0.0), share, ends))
    }

    /// d′ of one subject, with its error and interval. Only shares of 0 and 1 are corrected.
    ///
    /// # Errors
    /// No trials, more right than trials, or as [`Self::share`].
    pub fn choice(self, right: u64, trials: u64, correction: Correction) -> Computed<Choice> {
        let ends = wilson(right, trials, LEVEL)?;
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
            Ok(Interval {
                low,
                high,
                level: LEVEL,
            })
        });
        Ok(Choice {
            correct: right,
            trials,
            chance: self.chance(),
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
    /// The mean of subjects' own d′ is biased where trials are few, because the relation is bent and
    /// cut at 0: 8 % low for triangles of which 9 of 21 are right. Here subjects are d′_s ~ N(μ, τ)
    /// with right_s ~ binomial(n_s, share(d′_s)), summed out; μ and τ are the most likely ones. The
    /// interval is where twice the logarithm of the likelihood, τ adapted, falls by no more than
    /// t²: Student's, of as many degrees of freedom as subjects less one.
    ///
    /// # Errors
    /// Fewer than two subjects, no trials, all of all answers right, or as [`Self::share`].
    pub fn group(self, subjects: &[[u64; 2]]) -> Computed<GroupDPrime> {
        if subjects.len() < 2 {
            return undefined("a group needs two subjects or more");
        }
        let [right, n] = [0, 1].map(|of| subjects.iter().map(|own| own[of]).sum::<u64>());
        let pooled = self.d_prime(right as f64 / n.max(1) as f64)?;
        let population = Likelihood::of(self, subjects)?;
        let from = self.least(MOST[1]);
        // Not from 0, where a likelihood without a sign is level.
        let start = [pooled.max(from + 0.1), 0.3];
        let best = lowest(
            |[mean, tau]| population.deviance(*mean, *tau),
            start,
            [0.3, 0.3],
        );
        let mean = if self.has_a_sign() {
            best.place[0]
        } else {
            best.place[0].abs()
        };
        let t = t_quantile_upper(0.5 * (1.0 - LEVEL), subjects.len() as f64 - 1.0)?;
        let spread = best.place[1].abs();
        let fall = |at: f64| {
            let along = lowest(
                |[tau]| population.deviance(at, *tau),
                [spread.max(0.1)],
                [0.2],
            );
            along.value - best.value - t * t
        };
        let low = if fall(from) < 0.0 {
            from
        } else {
            inverted(|at| -fall(at), 0.0, [from, mean])
        };
        let interval = if fall(MOST[1]) < 0.0 {
            undefined("no largest d′: nearly all answers are right")
        } else {
            let high = inverted(fall, 0.0, [mean, MOST[1]]);
            Ok(Interval {
                low,
                high,
                level: LEVEL,
            })
        };
        Ok(GroupDPrime {
            mean,
            spread,
            se: interval
                .as_ref()
                .map_err(Clone::clone)
                .map(|i| 0.5 * (i.high - i.low) / t),
            interval,
        })
    }
}

/// Places of a normal distribution, in standard deviations: the trapezoidal rule, exact to 1e-6.
const N_PLACES: i32 = 10;
const PLACE_STEP: f64 = 0.5;
/// Shares stand so far apart, and between them on a line: off by 2e-5 at most.
const TABLE_STEP: f64 = 1.0 / 32.0;

/// All answers of a group as a function of its mean and spread.
struct Likelihood {
    /// Right and wrong answers, and how many subjects gave them.
    subjects: Vec<([f64; 2], f64)>,
    /// Shares from −[`MOST`] on.
    shares: Vec<f64>,
}

impl Likelihood {
    fn of(relation: Relation, subjects: &[[u64; 2]]) -> Computed<Self> {
        let mut counts: BTreeMap<[u64; 2], f64> = BTreeMap::new();
        for [right, n] in subjects {
            *counts
                .entry([*right, n.saturating_sub(*right)])
                .or_default() += 1.0;
        }
        let subjects = counts.into_iter();
        let mut shares = Vec::new();
        let mut d_prime = -MOST[1];
        while d_prime <= MOST[1] {
            shares.push(relation.share(d_prime)?.clamp(SHARES[0], SHARES[1]));
            d_prime += TABLE_STEP;
        }
        Ok(Self {
            subjects: subjects
                .map(|(own, n)| (own.map(|count| count as f64), n))
                .collect(),
            shares,
        })
    }

    fn share(&self, d_prime: f64) -> f64 {
        let last = self.shares.len() - 1;
        let at = ((d_prime + MOST[1]) / TABLE_STEP).clamp(0.0, last as f64);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the table"
        )]
        let cell = (at as usize).min(last - 1);
        let along = at - cell as f64;
        self.shares[cell] * (1.0 - along) + self.shares[cell + 1] * along
    }

    /// −2 ln of the likelihood, but for a constant.
    fn deviance(&self, mean: f64, spread: f64) -> f64 {
        let places: Vec<[f64; 3]> = (-N_PLACES..=N_PLACES)
            .map(|at| {
                let z = PLACE_STEP * f64::from(at);
                let share = self.share(mean + spread * z);
                [-0.5 * z * z, share.ln(), (-share).ln_1p()]
            })
            .collect();
        let of_subject = |[right, wrong]: [f64; 2]| {
            let at = places
                .iter()
                .map(|[weight, ln_right, ln_wrong]| weight + right * ln_right + wrong * ln_wrong);
            let at: Vec<f64> = at.collect();
            let most = at.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most + at.iter().map(|ln| (ln - most).exp()).sum::<f64>().ln()
        };
        let all = self.subjects.iter().map(|(own, n)| n * of_subject(*own));
        -2.0 * all.sum::<f64>()
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
            [
                (0..21).map(|_| u64::from(random.uniform() < share)).sum(),
                21,
            ]
        };
        (0..n).map(|_| own()).collect()
    }

    #[test]
    fn a_group_is_not_biased_by_few_trials_where_the_mean_of_its_subjects_is() -> Computed<()> {
        let mut random = Random::new(5);
        let n_groups = 60;
        for truth in [[1.2, 0.0], [1.5, 0.4], [3.0, 0.5]] {
            let (mut group, mut plain, mut n_held) = (0.0, 0.0, 0);
            for _ in 0..n_groups {
                let all = subjects(&mut random, 60, truth);
                let found = Relation::Triangle.group(&all)?;
                n_held += usize::from(found.interval?.holds(truth[0]));
                group += found.mean / f64::from(n_groups);
                let own = |[right, n]: &[u64; 2]| {
                    let own = Relation::Triangle.choice(*right, *n, Correction::LogLinear);
                    own.map(|own| own.d_prime)
                };
                let own: Computed<Vec<f64>> = all.iter().map(own).collect();
                plain += crate::mean(&own?)? / f64::from(n_groups);
            }
            let [group, plain] = [group, plain].map(|mean| 100.0 * (mean / truth[0] - 1.0));
            println!(
                "{truth:?}: {group:+.1} %, the mean of subjects {plain:+.1} %; {n_held} of {n_groups}"
            );
            assert!(group.abs() < 2.5, "{truth:?}: {group} %");
            assert!(n_held >= 53, "{truth:?}: {n_held}");
        }
        Ok(())
    }

    #[test]
    fn groups_at_the_ends_are_told() -> Computed<()> {
        let guessing = Relation::Triangle.group(&[[5, 21], [7, 21], [6, 21], [8, 21]])?;
        assert!(guessing.mean < 0.01, "{guessing:?}");
        assert_eq!(guessing.interval?.low, 0.0);
        assert!(
            Relation::Triangle.group(&[[21, 21]; 4]).is_err(),
            "no largest d′"
        );
        assert!(Relation::Abx.group(&[[8, 10]]).is_err(), "one subject");
        let below = Relation::Alternatives(4).group(&[[1, 20], [2, 20], [1, 20], [2, 20]])?;
        assert!(
            below.mean < 0.0 && below.interval?.high < 0.1,
            "below chance"
        );
        Ok(())
    }
}
#[test]
fn dbg_few() {
    for all in [
        [[9, 21], [12, 21], [10, 21], [14, 21]],
        [[15, 21], [18, 21], [16, 21], [19, 21]],
        [[20, 21], [18, 21], [21, 21], [19, 21]],
        [[8, 21], [9, 21], [10, 21], [8, 21]],
    ] {
        println!("DBG {all:?} {:?}", Relation::Triangle.group(&all));
        let own: Vec<f64> = all
            .iter()
            .map(|[r, n]| {
                Relation::Triangle
                    .choice(*r, *n, Correction::LogLinear)
                    .unwrap()
                    .d_prime
            })
            .collect();
        let s = crate::Summary::of(&own).unwrap();
        println!("DBG {s:?} {:?}", s.interval(0.95));
    }
}
