//! Psychometric functions: how often a stimulus is felt, told right or called stronger, from
//! thresholds to the exponents of magnitude.
//!
//! ```text
//! (stimulus, answer)… ─▶ blocks ─▶ Model::evidence ─┬▶ Model::fit      of a subject alone
//!   likelihood over a grid of functions             ├▶ Population::of  of all, and of each in it
//!                                                   └▶ Goodness::of    deviance, by simulation
//! ```
//!
//! # Invariants
//! - every stimulus is in the caller's unit; only Weibull takes its logarithm, and says so
//! - what is expected before any answer is stated in [`Model`] and `population`, and never taken
//!   from the stimuli: they are chosen by the answers
//! - data that say nothing of a threshold are refused; one that is not bracketed is said

mod adjustment;
mod answers;
mod curve;
mod evidence;
mod family;
mod fit;
mod goodness;
mod guess;
mod model;
mod population;
pub mod stevens;
#[cfg(test)]
mod tests;

pub use adjustment::{Adjustments, Settings, Starts};
pub use answers::Block;
pub use curve::Psychometric;
pub(super) use curve::scaled;
pub use evidence::Evidence;
pub use family::Family;
pub use fit::Fit;
pub use goodness::Goodness;
pub use guess::Guess;
pub use model::Model;
pub use population::{Estimate, Population};
