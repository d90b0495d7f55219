//! Psychometric functions: how often a stimulus is felt, told right or called stronger, from
//! thresholds to the exponents of magnitude.
//!
//! ```text
//! (stimulus, answer)… ─▶ blocks ─▶ Model::fit ─▶ Fit ─▶ delta      interval by curvature
//!                                                  ├──▶ posterior  interval by Bayes' rule
//!                                                  └──▶ resample   interval and fit by simulation
//! ```
//!
//! # Invariants
//! - every stimulus is in the caller's unit; only Weibull takes its logarithm, and says so
//! - the fitted function is the mode of the posterior, and the priors stand in the fit
//! - data that say nothing of a threshold are refused; an estimate at the edge of its prior is said

mod adjustment;
mod answers;
mod comparison;
mod curve;
mod delta;
mod family;
mod fit;
mod posterior;
mod prior;
mod resample;
pub mod stevens;
mod target;
#[cfg(test)]
mod tests;

pub use adjustment::{Adjustments, Settings, Starts};
pub use answers::{Block, blocks};
pub use comparison::{Comparison, Measured};
pub use curve::Psychometric;
pub(super) use curve::scaled;
pub use family::Family;
pub use fit::{Fit, Model};
pub use posterior::Posterior;
pub use prior::Guess;
pub use resample::Resamples;
