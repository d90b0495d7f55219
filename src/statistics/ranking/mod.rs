//! Scales from rankings and paired comparisons, and tables of what was ranked or taken for what.
//!
//! `plackett_luce` for rankings of any length, `bradley_terry` for pairs, `thurstone`
//! and [`Mosteller::of`] on the normal scale: each by maximum likelihood (but the last) with errors
//! from the observed information. A scale has no zero of its own: values sum to zero. Where an
//! estimate would be infinite the groups of items that cause it are named ([`Connection`]); only a
//! [`Prior`] that the caller asks for makes it finite.
//!
//! How well rankings agree between subjects, Kendall's W, is the effect of
//! [`friedman`](super::variance::friedman); how consistent one subject's pairs are is
//! [`Consistency`].
//!
//! Items are indices from 0 in code and numbers from 1 in words.

mod bradley_terry;
mod choices;
mod connection;
mod consistency;
mod deviance;
mod mean_ranks;
mod newton;
mod odd_one_out;
mod plackett_luce;
mod preferences;
mod scale;
#[cfg(test)]
mod tests;
mod thurstone;

pub use bradley_terry::BradleyTerry;
pub use choices::Prior;
pub use connection::Connection;
pub use consistency::{Consistency, Majority};
pub use deviance::Deviance;
pub use mean_ranks::{Asymmetry, MeanRanks, RankTrial};
pub use odd_one_out::{Grade, GradeWeights, ItemErrors, OddOneOut, PairTally, TriadAnswer};
pub use plackett_luce::PlackettLuce;
pub use preferences::Preferences;
pub use scale::{Estimate, Scale};
pub use thurstone::{Mosteller, Thurstone};
