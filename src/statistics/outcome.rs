//! What a test found, as a table prints it: n, statistic, degrees of freedom, p, effect size,
//! estimate with its interval, and what a reader has to know besides.

use thiserror::Error;

use super::distribution::chi_squared_upper;

/// A number, or why there is none.
pub type Computed<T = f64> = Result<T, Undefined>;

/// Why a number cannot be computed, in words that stand in a report: `one subject alone`.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("not computable: {reason}")]
pub struct Undefined {
    /// What is missing or wrong.
    pub reason: String,
}

impl Undefined {
    /// With this reason.
    pub fn because(reason: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
        }
    }
}

/// An interval that holds the true value with confidence `level`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Confidence, such as 0.95.
    pub level: f64,
}

/// What cannot be computed, for this reason.
pub(crate) fn undefined<T>(reason: impl Into<String>) -> Computed<T> {
    Err(Undefined::because(reason))
}

impl Interval {
    /// Between its ends.
    pub fn new([low, high]: [f64; 2], level: f64) -> Self {
        Self { low, high, level }
    }

    /// That of a number that rises with what this one is of.
    #[must_use]
    pub fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Self::new([of(self.low), of(self.high)], self.level)
    }

    /// So far to either side of its middle.
    pub(crate) fn about(middle: f64, half: f64, level: f64) -> Self {
        Self::new([middle - half, middle + half], level)
    }

    /// Whether a value lies inside, ends included.
    pub fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }
}

/// A number with the name that a table heads it by: `t`, `d_z`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Named {
    /// Its symbol.
    pub symbol: &'static str,
    /// The number.
    pub value: f64,
}

impl Named {
    /// A number with its symbol.
    pub(crate) const fn of(symbol: &'static str, value: f64) -> Self {
        Self { symbol, value }
    }
}

/// Degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Freedom {
    /// The test has none: exact, by permutation or by the normal.
    None,
    /// One number: t and χ².
    One(f64),
    /// Of the effect and of the error: F.
    Two(f64, f64),
}

/// Which deviations count as evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Either way.
    Two,
    /// Larger than expected only.
    Greater,
    /// Smaller than expected only.
    Less,
}

/// The outcome of one test.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The test: `Welch t, two samples`.
    pub test: &'static str,
    /// Observations that entered, one number a group.
    pub n: Vec<usize>,
    /// The statistic.
    pub statistic: Named,
    /// Its degrees of freedom.
    pub df: Freedom,
    /// Probability under the null hypothesis of a statistic at least as extreme.
    pub p: f64,
    /// Which extremes `p` counts.
    pub sides: Sides,
    /// Size of the effect.
    pub effect: Computed<Named>,
    /// What is estimated, such as the difference of means.
    pub estimate: Computed<Named>,
    /// Interval of the estimate.
    pub interval: Computed<Interval>,
    /// Remarks for the reader: zeros left out, ties, exact or approximate.
    pub notes: Vec<String>,
}

/// A test whose statistic follows χ² and rises with what it is evidence of; `no_estimate` says why
/// it estimates nothing.
pub(crate) fn by_chi_squared(
    test: &'static str,
    n: Vec<usize>,
    (statistic, df): (Named, f64),
    effect: Computed<Named>,
    no_estimate: &str,
) -> Computed<Outcome> {
    Ok(Outcome {
        test,
        n,
        statistic,
        df: Freedom::One(df),
        p: chi_squared_upper(statistic.value, df)?,
        sides: Sides::Greater,
        effect,
        estimate: undefined(no_estimate),
        interval: undefined(no_estimate),
        notes: vec!["p by χ²".to_owned()],
    })
}
