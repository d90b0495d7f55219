//! Analysis of variance: several groups or conditions at once.

mod crossed;
mod effect;
mod friedman;
mod groups;
mod holm;
mod repeated;
mod sphericity;

pub use crossed::{Answer, Crossed};
pub use effect::{Effect, Sphericity, partial_eta_squared};
pub use friedman::friedman;
pub use groups::{kruskal_wallis, one_way, welch};
pub use holm::{Comparison, holm};
pub use repeated::Repeated;
