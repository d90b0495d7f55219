//! Rules of staircases and the shares right that they settle at.

use crate::detection::inverted;
use crate::{Computed, Undefined, undefined};

/// Up after `n_up` wrong answers in a row, down after `m_down` right ones in a row (Levitt 1971);
/// every move begins the count anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule {
    /// Wrong answers in a row that make the stimulus stronger.
    pub n_up: u32,
    /// Right answers in a row that make it weaker.
    pub m_down: u32,
}

impl Rule {
    /// One up, m down.
    pub const fn one_up(m_down: u32) -> Self {
        Self { n_up: 1, m_down }
    }

    pub(super) fn check(self) -> Computed<()> {
        let is_rule = (1..=20).contains(&self.n_up) && (1..=20).contains(&self.m_down);
        is_rule.then_some(()).ok_or_else(|| {
            let reason = format!("{} up, {} down: each is 1…20", self.n_up, self.m_down);
            Undefined::because(reason)
        })
    }

    /// The probability that the next move is down if answers are right with probability `p`: that
    /// m right ones in a row come before n wrong ones.
    pub(crate) fn down_share(self, p: f64) -> f64 {
        let q = 1.0 - p;
        let power = |x: f64, n: u32| x.powf(f64::from(n));
        let [right, wrong] = [power(p, self.m_down - 1), power(q, self.n_up - 1)];
        let down = right * (1.0 - power(q, self.n_up));
        let up = wrong * (1.0 - power(p, self.m_down));
        down / (down + up)
    }

    /// The share right at which steps up and down balance: `P(down)·down = P(up)·up`. For one up
    /// that is pᵐ = up/(up + down) (Kaernbach 1991; García-Pérez 1998).
    ///
    /// # Errors
    /// No rule, steps that are not above zero.
    pub fn target(self, up: f64, down: f64) -> Computed {
        self.check()?;
        let share = up / (up + down);
        if !(up > 0.0 && down > 0.0 && share > 0.0 && share < 1.0) {
            return undefined(format!("steps of {up} up and {down} down"));
        }
        Ok(inverted(|p| self.down_share(p), share, [0.0, 1.0]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn equal_steps_settle_at_the_targets_of_the_table() -> Computed<()> {
        for (m, target) in [(1, 0.5), (2, 0.5_f64.sqrt()), (3, 0.793_7), (4, 0.840_9)] {
            let found = Rule::one_up(m).target(1.0, 1.0)?;
            assert!(
                (found - 0.5_f64.powf(1.0 / f64::from(m))).abs() < 1e-11,
                "{m}"
            );
            assert!((found - target).abs() < 5e-5, "{found}");
            let mirrored = Rule { n_up: m, m_down: 1 }.target(1.0, 1.0)?;
            assert!((mirrored - (1.0 - found)).abs() < 1e-11, "{mirrored}");
        }
        Ok(())
    }

    #[test]
    fn unequal_steps_settle_at_the_printed_targets() -> Computed<()> {
        // Ratios of step down to step up of one-up-m-down staircases (García-Pérez 1998).
        let ratios = [0.2845, 0.5488, 0.7393, 0.8415];
        let targets = [0.7785, 0.8035, 0.8315, 0.8584];
        for (m, (ratio, target)) in (1..).zip(ratios.into_iter().zip(targets)) {
            let found = Rule::one_up(m).target(1.0, ratio)?;
            assert!((found - target).abs() < 1e-4, "{m}: {found} for {target}");
        }
        // Kaernbach: three times as far up as down finds three quarters.
        assert!(
            (Rule::one_up(1).target(3.0, 1.0)? - 0.75).abs() < 1e-11,
            "weighted"
        );
        Ok(())
    }

    #[test]
    fn the_share_of_moves_down_is_that_of_a_simulated_observer() {
        let (rule, p) = (Rule { n_up: 2, m_down: 3 }, 0.7);
        let mut random = Random::new(5);
        let mut n_down = 0;
        for _ in 0..40_000 {
            let (mut right, mut wrong) = (0, 0);
            while right < 3 && wrong < 2 {
                let is_right = random.uniform() < p;
                (right, wrong) = if is_right {
                    (right + 1, 0)
                } else {
                    (0, wrong + 1)
                };
            }
            n_down += i32::from(right == 3);
        }
        let share = f64::from(n_down) / 40_000.0;
        assert!((share - rule.down_share(p)).abs() < 0.008, "{share}");
    }

    #[test]
    fn what_is_no_rule_is_refused() {
        assert!(
            Rule { n_up: 0, m_down: 1 }.target(1.0, 1.0).is_err(),
            "none up"
        );
        assert!(Rule::one_up(2).target(0.0, 1.0).is_err(), "no step");
    }
}
