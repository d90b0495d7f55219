//! Statistics of experiments on people: tests, scales and maps of what was felt.
//!
//! Plain numbers in, plain numbers out: nothing here knows of textiles, files or clocks. What
//! cannot be computed is [`Undefined`] with its reason, never a number that stands for nothing.
//!
//! # Invariants
//! - no I/O, no clock, no word of textiles
//! - the one home of the distributions crate
//! - sums of squares about the mean; tails computed as tails; same input, same seed, same bytes
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod binomial;
mod bootstrap;
mod correlation;
#[cfg(test)]
mod coverage;
pub mod detection;
mod distribution;
mod effect_interval;
mod equivalence;
mod interval;
mod noncentral;
mod outcome;
mod permutation;
mod summary;
mod t_test;
pub mod variance;
mod wilcoxon;

pub use binomial::exact_binomial;
pub use bootstrap::{Bootstrap, Resampling};
pub use correlation::{pearson, pearson_r, rank_correlation, spearman};
pub(crate) use distribution::{chi_squared_upper, normal_density};
pub use distribution::{f_upper, normal_lower, normal_quantile, t_quantile_upper};
pub use equivalence::{Equivalence, power_of_t};
pub use outcome::{Computed, Freedom, Interval, Named, Outcome, Sides, Undefined};
pub(crate) use outcome::{by_chi_squared, undefined};
pub use permutation::sign_flip;
pub use summary::{Summary, mean};
pub use t_test::{TwoSamples, one_sample_t, paired_t};
pub use wilcoxon::{Ranks, wilcoxon_signed_rank};

pub mod adaptive;
pub mod mds;
pub mod procrustes;
pub mod properties;
pub mod psychometric;
pub mod ranking;
