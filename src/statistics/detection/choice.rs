//! What kinds of trials with right and wrong answers have in common: the correction of shares that
//! have no z, what is found of one subject, and how a relation is turned round.

use crate::{Computed, Interval};
use selvedge_foundation::named;
use selvedge_foundation::numerics::to_whole;

named! {
    /// What is done about shares of 0 and 1, whose z is infinite.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Correction {
        /// (count + ½)/(trials + 1) (Hautus 1995).
        #[default]
        LogLinear = "log-linear",
        /// 1/(2N) for 0 and 1 − 1/(2N) for 1 (Macmillan & Kaplan 1985); other shares as they are.
        Clip = "1/(2N)",
    }
    /// Its name in a table.
    pub fn name;
}

impl Correction {
    /// The share as it is corrected.
    pub(crate) fn share(self, count: u64, trials: u64) -> f64 {
        let (k, n) = (count as f64, trials as f64);
        match self {
            Self::LogLinear => (k + 0.5) / (n + 1.0),
            Self::Clip => (k / n).clamp(0.5 / n, 1.0 - 0.5 / n),
        }
    }
}

/// d′ from the share of correct choices.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The share that d′ follows from.
    pub share: f64,
    /// What was done about a share of 0 or 1; `None` if it was neither.
    pub correction: Option<Correction>,
    /// Distance of the sensations.
    pub d_prime: f64,
    /// Whether the share lies below chance.
    pub is_below_chance: bool,
    /// Standard error by the delta method, √(share(1 − share)/N)/(dPc/dd′).
    pub se: Computed,
    /// d′ of the ends of Wilson's interval of the share at 95 %.
    pub interval: Computed<Interval>,
}

/// The place where a rising function reaches `target`, to 1e-12: by false position,
/// truncated towards the middle and held so near to it that no more steps are taken than one
/// beyond those of halving (ITP, Oliveira & Takahashi 2020).
pub(crate) fn inverted(
    function: impl Fn(f64) -> f64,
    target: f64,
    [mut low, mut high]: [f64; 2],
) -> f64 {
    let off = |place: f64| function(place) - target;
    let width = high - low;
    let [mut below, mut above] = [off(low), off(high)];
    // How wide the bracket may be, in halvings.
    let mut may_be = 2.0 * width;
    while high - low > 1e-12 * high.abs().max(1.0) {
        let (half, middle) = (0.5 * (high - low), 0.5 * (low + high));
        let crossed = (high * below - low * above) / (below - above);
        let inwards = (middle - crossed).signum();
        let truncated = crossed + inwards * 0.2 * (high - low).powi(2) / width;
        let is_beyond = (middle - truncated) * inwards <= 0.0;
        let reach = 0.5 * may_be - half;
        let next = if is_beyond || crossed.is_nan() {
            middle
        } else if (truncated - middle).abs() <= reach {
            truncated
        } else {
            middle - inwards * reach
        };
        let value = off(next);
        if value < 0.0 {
            (low, below) = (next, value);
        } else {
            (high, above) = (next, value);
        }
        may_be *= 0.5;
    }
    0.5 * (low + high)
}

/// The integral of a smooth function that is nothing at both ends, by the trapezoidal rule with
/// steps of 1/32: of φ times a smooth function the error is below rounding.
pub(super) fn integral(function: impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> f64 {
    let n_steps: u32 = to_whole((32.0 * (to - from)).ceil());
    let step = (to - from) / f64::from(n_steps);
    let at = |i: u32| function(from + f64::from(i) * step);
    step * (0..=n_steps).map(at).sum::<f64>()
}
